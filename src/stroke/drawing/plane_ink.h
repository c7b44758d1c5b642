#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "brush/preset/preset.h"
#include "brush/tuft/tuft.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/footprint.h"
#include "stroke/placement/placement.h"

/// \file
/// Ink of a trace on a plane, without texels. Called by fit_trajectory.h, which compares it with the drawing.
namespace tuft::stroke {

/// Coverage of the plane in square cells of `cell` metres, stored in sparse tiles.
class PlaneInk {
  public:
    explicit PlaneInk(double cell) : cell_(cell) {}

    /// Takes the maximum of the coverage and a footprint at `time` (seconds). The footprint has cells of the same size,
    /// in the plane's frame.
    void add(const footprint::Footprint& footprint, double time);
    /// Returns the coverage at a point (metres), 0–1, bilinear between centres of cells.
    double at(const Vec2& p) const;
    /// Returns the time at which half of the cell at a point was first covered, seconds; negative: never.
    double when(const Vec2& p) const;
    /// Copies the coverage of a row of cells, from cell (i, j) on, whose centre is cell · (i + ½, j + ½).
    void copy_row(std::int64_t i, std::int64_t j, std::span<float> to) const;
    /// Returns the mean place of the covered area, metres; nothing where there is none.
    std::optional<Vec2> centre() const;
    double cell() const { return cell_; }

  private:
    static constexpr int kTile = 32;  // cells
    struct Tile {
        std::array<std::uint8_t, kTile * kTile> coverage{};
        std::array<float, kTile * kTile> first{};
    };
    const Tile* tile(std::int64_t i, std::int64_t j, std::size_t& cell) const;
    double value(std::int64_t i, std::int64_t j) const;

    double cell_;
    std::unordered_map<std::uint64_t, Tile> tiles_;
};

/// Draws one trace after the other with the same brush, which is made once, each on an empty plane.
class PlaneDrawing {
  public:
    /// Arguments as those of `plane_ink`.
    PlaneDrawing(const brush::Preset& preset, const HolderOptions& hold, double step, double cell);
    /// Returns the ink of a trace, until the next call.
    const PlaneInk& draw(const StrokeSamples& trace);
    /// Bends the tuft along a trace up to a time (seconds) and keeps that state for `draw_part`. Returns the ink up to
    /// there, until the next call.
    const PlaneInk& keep(const StrokeSamples& trace, double time);
    /// Returns the ink of the part of a trace from the kept state on up to a time, until the next call. Precondition:
    /// up to the time of the kept state the trace is the one that was kept.
    const PlaneInk& draw_part(const StrokeSamples& trace, double until);
    /// Returns the ink of what follows on the last part that was drawn or kept, until the next call. `trace`: that of
    /// the part.
    const PlaneInk& draw_rest(const StrokeSamples& trace);

  private:
    struct State {
        brush::TuftBend bend;
        Recycled<footprint::Trail> before;
        Vec3 root{0};
        int missed = 0;
        std::size_t poses = 0;  // behind it
        double time = 0;        // seconds, of the last of them
    };
    std::vector<brush::Pose> poses_of(const StrokeSamples& trace) const;
    void begin(const State& from);
    void draw_on(const std::vector<brush::Pose>& poses, State from, double until);
    void add_stamp(const brush::Pose& pose, double dt);

    HolderOptions hold_;
    double step_;
    brush::Tuft tuft_;
    State fresh_, kept_, last_;  // before a trace, at what is kept, at the end of the last drawing
    PlaneInk ink_;
    Recycled<footprint::Trail> before_;  // of the pose before, of a tuft with several spines
    Vec3 root_{0};                       // metres, there
    int missed_ = 0;                     // poses since then
};

/// Returns the area that a full brush touches along a flat trace on a plane. Frame: metres, x to the right, y up (−y of
/// the trace). Holder (`compensate_tip_lag`, `pose_holder`), resampling, tuft and outlines are those of a stroke on a
/// model, in steps of `step` metres. Cost: 0.1 ms per step.
PlaneInk plane_ink(const StrokeSamples& trace, const brush::Preset& preset, const HolderOptions& options, double step,
                   double cell);

/// Returns where the ink of a dot has its middle on a plane, metres to the right and down of the mean place of its
/// samples; pressure is their weight. `options.dot_place` is left aside. Cost: some milliseconds.
Vec2 middle_of_dot(const StrokeSamples& dot, const brush::Preset& preset, HolderOptions options);

}  // namespace tuft::stroke
