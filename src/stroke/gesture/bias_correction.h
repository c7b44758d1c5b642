#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// \file
/// A writer's bias: the difference of the strokes that they write from those that they mean, learned from pairs and
/// corrected in later strokes. Called by `tuft bias` and `tuft paint --bias`. Source: the user manipulability component
/// of [Xu2004], here with ratios for pressure and differences for position and tilt: independent of the origin,
/// and finite where the pen barely touches.
namespace tuft::stroke {

/// A piece of a sample stroke: features that other pieces are compared with, and its correction as cubic Bézier curves
/// over the piece, by four control values each.
struct BiasPiece {
    static constexpr int kPoints = 12;                 ///< at even arc length
    double length = 0;                                 ///< metres
    double begin = 0, end = 1;                         ///< place in its stroke, parts of the stroke's length
    std::array<Vec2, kPoints> shape{};                 ///< (point − centre) / length
    std::array<double, kPoints> pressure{};            ///< 0–1
    std::array<Vec2, kPoints> tilt{};                  ///< radians
    std::array<double, 4> pressure_ratio{1, 1, 1, 1};  ///< intended over written, in [1/2, 2]
    std::array<Vec2, 4> shift{};                       ///< metres, intended minus written, after `linear`
    std::array<Vec2, 4> tilt_change{};                 ///< radians, intended minus written
};

/// What a writer's strokes are corrected by.
struct BiasCorrection {
    glm::dmat2 linear{1};  ///< map of flat positions about the centre of strokes written together
    std::vector<BiasPiece> pieces;
};

/// Learns a bias from pairs; `intended[i]` is what `written[i]` was meant to be. Consecutive strokes with one placement
/// (a character, a line) are taken together: their common displacement is no bias. The linear map (slant, width) is a
/// least-squares fit over points paired by arc length, regularised towards the identity; its singular values lie in
/// [1/2, 2]. The rest is stored per piece; pieces are about 6 mm long and overlap by half. Throws `Error` if the counts
/// differ, are 0, or a stroke is not flat.
BiasCorrection learn_bias(std::span<const RecordedStroke> intended, std::span<const RecordedStroke> written);

/// Returns the strokes corrected: by the linear map, then every piece by the corrections of the four most similar
/// pieces, weighted by similarity (shape and heading, length, place in the stroke, pressure, tilt). Strokes in space
/// and times do not change.
std::vector<RecordedStroke> correct_bias(const BiasCorrection& bias, std::vector<RecordedStroke> traces);

/// A bias as a TOML file, and back. `source` is the file's name in errors. Throws `Error` with the line for unknown
/// keys, wrong types and values out of range.
std::string bias_toml(const BiasCorrection& bias);
BiasCorrection parse_bias(std::string_view text, const std::string& source);
BiasCorrection load_bias(const std::filesystem::path& path);

}  // namespace tuft::stroke
