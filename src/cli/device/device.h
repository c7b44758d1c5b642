#pragma once

#include <memory>
#include <string>

#include "cli/arguments/arguments.h"
#include "haptic/device/device.h"
#include "haptic/loop.h"
#include "haptic/trial.h"

/// \file
/// Functions that the commands of `tuft device` share. Main thread.
namespace tuft::cli {

/// A model that the simulated or real arm touches.
struct ContactModel {
    std::unique_ptr<mesh::TriangleMesh> mesh;
    std::unique_ptr<mesh::SurfaceQuery> surface;
};
/// Reads a model; `file` may be the name of a shipped one, such as "bowl".
ContactModel load_contact_model(const std::filesystem::path& file);

/// Where the simulated hand of the arguments goes: along `--follow`, or `motion` at a place.
haptic::HandPath hand_of(const DeviceWork& arguments, haptic::HandMotion motion, const haptic::TrialPlace& place,
                         const brush::Preset& preset);
/// Throws `UsageError` for an unknown name.
haptic::HandMotion motion_named(const std::string& name);

/// The brush `name` in the hand, bent as `--spine` says.
brush::Preset brush_in_hand(const DeviceWork& arguments, const std::string& name);

/// s, of a force on its way besides the delay.
double jitter_of(const DeviceWork& arguments);
haptic::SolverOptions solver_options(const DeviceWork& arguments, const brush::Preset& preset);

/// Opens the arm of the arguments, simulated with `path` or real. `state` becomes its first state. Throws `Error` where
/// no service answers within 3 s.
std::unique_ptr<haptic::Device> open_device(const DeviceWork& arguments, const haptic::HandPath& path,
                                            haptic::DeviceState& state);

/// Runs the loop for `seconds`, or until the arm has failed for half a second. Returns that fault,
/// or none.
haptic::Fault run_for(haptic::Loop& loop, double seconds);

/// Returns the workspace in which the arm at `state` has the tuft's root at `root`.
haptic::Workspace workspace_at(const haptic::DeviceState& state, const Vec3& root);

/// Performs `tuft device test`. Returns the exit status.
int test_device(const DeviceWork& arguments);

}  // namespace tuft::cli
