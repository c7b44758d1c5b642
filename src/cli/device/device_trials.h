#pragma once

#include <string>
#include <vector>

#include "cli/device/device.h"
#include "cli/steps/console.h"
#include "haptic/trial.h"

/// \file
/// What `tuft device test --simulate` tries: motions of a simulated hand with an arm, on all cores. Trials do not
/// depend on each other, and their results are merged in order.
namespace tuft::cli {

/// Where hands try.
struct Places {
    std::vector<ContactModel> models;
    std::vector<const mesh::SurfaceQuery*> surface;  ///< [place]
    std::vector<haptic::TrialPlace> place;
};

/// The shipped models with their edges and grooves, or `--model` and its sharpest edge.
Places places_of(const DeviceWork& a);

/// Returns the options of one trial that the arguments state.
haptic::TrialOptions trial_options(const DeviceWork& a, const brush::Preset& preset);

/// How many trials of one kind are done, and their CPU time, s.
struct TrialsDone {
    std::size_t count = 0;
    double cpu_seconds = 0;
};

/// Worst figures of several trials.
struct Trials {
    haptic::TrialReport worst;                     ///< `seconds`: of the solves of the plain motions
    TrialsDone motions, hands, hours;              ///< `hours`: one for each minute
    bool complete = true;                          ///< not interrupted
    std::string least_energy_at, largest_step_at;  ///< brush, place and motion; random hands with their number
};

/// All motions at all places with each brush; then `--hands` random hands and `--hours` of painting. Where the process
/// is interrupted, the first trials of each kind up to one that is not done; the figures of so many trials do not
/// depend on when or whether that happened.
Trials run_trials(const DeviceWork& a, const Places& places, Console& console);

}  // namespace tuft::cli
