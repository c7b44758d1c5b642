#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stroke/journal/trace.h"

/// A writer's bias: how the strokes they make differ from those they mean, learned from
/// pairs and taken back on strokes to come. After Xu's user manipulability component (Xu et
/// al., A Solid Model Based Virtual Hairy Brush, and its book chapter, 5.5.1.2), with
/// ratios for the pressure and differences for position and tilt, so that nothing depends
/// on an origin or blows up where the pen barely touches.
namespace tuft::stroke {

/// A piece of a sample stroke: what the writer did, to be compared with, and what to do
/// about it: cubic Bézier curves over the piece, by their four control values.
struct BiasPiece {
    static constexpr int kPoints = 12;                 ///< at even arc length
    double length = 0;                                 ///< metres
    double begin = 0, end = 1;                         ///< place in its stroke, parts of its length
    std::array<Vec2, kPoints> shape{};                 ///< about its middle, over its length
    std::array<double, kPoints> pressure{};            ///< 0–1
    std::array<Vec2, kPoints> tilt{};                  ///< radians
    std::array<double, 4> pressure_ratio{1, 1, 1, 1};  ///< intended over written, in [1/2, 2]
    std::array<Vec2, 4> shift{};                       ///< metres, intended minus written, after `linear`
    std::array<Vec2, 4> tilt_change{};                 ///< radians, intended minus written
};

struct BiasCorrection {
    glm::dmat2 linear{1};  ///< of flat positions about the middle of what is written together
    std::vector<BiasPiece> pieces;
};

/// Learns from pairs: `intended[i]` is what `written[i]` was meant to be. Strokes that follow
/// each other with one placement belong together (a character, a line): where they lie as a
/// whole is no bias. The linear map (slant, width) is a least-squares fit, paired by arc length
/// and drawn to the identity where the strokes say nothing; its stretches lie in [1/2, 2].
/// What it leaves is kept piece by piece, pieces of about 6 mm that overlap by half.
/// Throws `Error` when the counts differ, there are none, or a stroke is not flat.
BiasCorrection learn_bias(std::span<const Trace> intended, std::span<const Trace> written);

/// What was meant by these strokes: linear map, then for every piece the corrections of the
/// four pieces most like it, weighted by likeness (shape and heading, length, place in the stroke,
/// pressure, tilt). Strokes in space stay as they are. Times stay.
std::vector<Trace> correct_bias(const BiasCorrection& bias, std::vector<Trace> traces);

/// As a TOML file and back; `source` names it in errors. Throws `Error` with the line for
/// unknown keys, wrong types and values out of range.
std::string bias_toml(const BiasCorrection& bias);
BiasCorrection parse_bias(std::string_view text, const std::string& source);
BiasCorrection load_bias(const std::filesystem::path& path);

}  // namespace tuft::stroke
