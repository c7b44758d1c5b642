#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "brush/preset/preset.h"
#include "brush/tuft/tuft.h"
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
    /// Takes the maximum of the coverage and that of ink of the same cells. Where half of a cell was covered before,
    /// its time stays.
    void add(const PlaneInk& later);
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

/// Draws one trace after the other with the same brush, each on an empty plane. Poses that a trace has in common with
/// the last drawn one, from the first on, are not drawn again; the ink is the same to the bit.
class PlaneDrawing {
  public:
    /// Arguments as those of `plane_ink`.
    PlaneDrawing(const brush::Preset& preset, const HolderOptions& hold, double step, double cell);
    /// Returns the ink of a trace, until the next call.
    const PlaneInk& draw(const StrokeSamples& trace);
    /// Returns the ink of a trace that is drawn up to the time `until`, together with the ink that the last drawn trace
    /// left from its own time `resume` on (seconds; up to `kKeepEvery` poses more). That is nearly the ink of a trace
    /// that differs from the last drawn one in a short part, which ends well before these times.
    const PlaneInk& draw_part(const StrokeSamples& trace, double until, double resume);
    /// Draws the rest of the trace of `draw_part`, and returns its ink.
    const PlaneInk& finish();

    static constexpr std::size_t kKeepEvery = 16;  ///< poses

  private:
    /// `kKeepEvery` poses, the last one of a trace perhaps fewer.
    struct Block {
        brush::TuftBend before;
        PlaneInk ink;  // theirs alone
    };
    void begin(const StrokeSamples& trace);
    void draw_until(double time);
    void add_stamp(const brush::Pose& pose, double dt, PlaneInk& ink);

    HolderOptions hold_;
    double step_;
    brush::Tuft tuft_;
    brush::TuftBend fresh_;
    PlaneInk ink_;
    std::vector<brush::Pose> last_poses_;  // of the last drawn trace
    std::vector<Block> last_blocks_;
    std::vector<brush::Pose> poses_;  // of the trace in work
    std::size_t n_shared_ = 0;        // blocks of the last drawn trace with which it begins
    std::vector<Block> blocks_;       // those after them
    std::size_t next_ = 0;            // pose
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
