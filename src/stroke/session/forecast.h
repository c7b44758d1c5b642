#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "contact/contact.h"
#include "core/system/work_ahead.h"
#include "stroke/contact/hair_shape.h"
#include "stroke/contact/tuft_in_hand.h"

/// \file
/// Bending and contact of a stroke's hair, computed before its ink is deposited. Both do not depend on the ink of wet
/// hair. `StrokeSession` uses a forecast as long as the hair is wet. Strokes of a batch are forecast at the same time.
/// Another thread forecasts a single stroke a little ahead of its ink. It does the same for the known poses of a hand
/// that paints.
namespace tuft::stroke {

/// Contact and hair at one pose of a path, as the session would compute them.
struct PoseForecast {
    brush::Pose pose;
    contact::Result contact;
    HairShape hair;  ///< of a tuft that touches
};

/// Memory that the forecasts of a batch hold together, about. It must outlive them.
struct ForecastBudget {
    std::size_t most = 0;  ///< bytes, from which on none computes ahead
    std::atomic<std::size_t> held{0};
};

/// The hair of one stroke along its path.
///
/// Bending depends on the ink in two respects. The wetness is 1 from `kWetFullness` on. Splitting comes sooner with
/// less ink. A forecast assumes wetness 1 and the least ink that is wet. It ends where the tuft splits.
class StrokeForecast {
  public:
    struct Options {
        contact::Options contact;
        ClosedHairOptions closed;
    };

    /// Returns true for a tuft that can be forecast: not split, hair in a ferrule, bent by the rods of `brush/rod`.
    static bool serves(const brush::Tuft& tuft) { return !tuft.split && !tuft.model && !tuft.carried; }

    /// `path`: poses of the resampled path. `tuft`: as the stroke begins. Computes nothing yet.
    StrokeForecast(brush::Tuft tuft, std::vector<brush::Pose> path, const mesh::SurfaceQuery& surface,
                   const Options& options);
    ~StrokeForecast();
    StrokeForecast(const StrokeForecast&) = delete;
    StrokeForecast& operator=(const StrokeForecast&) = delete;

    /// Computes poses up to the end of the path or of the budget, some at least; `next` computes those after them.
    /// With `closes` their footprints of wet hair, too, which hair that dries on its way does not need from there on.
    /// Cost: that of bending at every pose, and of outlines. Once, before `next`.
    void compute(bool closes, ForecastBudget& budget);
    /// Instead of `compute`: lets another thread compute poses while `next` returns those before, some 100 ahead.
    void compute_ahead();
    /// Instead of both: appends poses to the path, and lets another thread compute them all while `next` returns those
    /// before; up to four it computes itself. Precondition: `next` has returned all poses of the path, or null.
    void follow(std::vector<brush::Pose> poses);

    /// Returns the forecast of the next pose where it is valid for this pose and this hair, else null. The result may
    /// be moved from; it is valid until the next call. `closes`: the footprint of wet hair will be needed.
    PoseForecast* next(const brush::Pose& pose, const brush::Tuft& hair, bool closes);
    /// Sets the hair and the memory of the contact to what they are after the poses returned by `next`. Bundles,
    /// wetness and ink of `hair` stay. Cost: bending at up to 32 poses.
    void catch_up(brush::Tuft& hair, contact::Memory& memory);

  private:
    /// Some poses of the path, and the hair before the first of them.
    struct Part {
        brush::Tuft hair;
        contact::Memory memory;
        std::vector<PoseForecast> poses;  ///< up to where the tuft splits
        std::size_t bytes = 0;            ///< of the budget
    };
    double seconds_before(std::size_t i) const;
    contact::Result bend(brush::Tuft& hair, contact::Memory& memory, std::size_t i) const;
    void cut_path(std::size_t part_poses);
    void compute_part(std::size_t k, bool closes);
    void compute_within_budget();
    void release(Part& part);
    void close_together(Part& part, std::size_t from) const;

    const mesh::SurfaceQuery& surface_;
    Options options_;
    std::vector<brush::Pose> path_;  ///< of a hand that paints: the poses appended last
    std::optional<double> earlier_;  ///< time of the pose before the path; none: the path begins the stroke
    std::size_t part_poses_ = 0;     ///< of every part but the last
    std::vector<Part> parts_;
    std::size_t next_ = 0;
    brush::Tuft hair_;  ///< after the poses computed so far
    contact::Memory memory_;
    LastHair last_;
    std::unique_ptr<WorkAhead> ahead_;  ///< uses the others; null: no thread computes ahead
    ForecastBudget* budget_ = nullptr;  ///< of a batch
    std::size_t computed_ = 0;          ///< parts, in a batch
    bool closes_ = false;               ///< likewise
};

}  // namespace tuft::stroke
