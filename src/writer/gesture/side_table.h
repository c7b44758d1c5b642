#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "writer/gesture/sides.h"

/// \file
/// Sides of a stroke predicted from its centre line and its neighbours: a table of means of a typeface by class of
/// stroke. Called for characters whose source states no outline.
namespace tuft::writer {

/// What a stroke's sides are predicted from: numbers of the order of 1.
///
/// Per stroke: 1; ln of the number of strokes; the middle of the centre line in the square; its place in the order of
/// writing; ln of the length of all strokes; distances to the nearest other centre line, at most 120 units: at the
/// ends, beyond them, and to the left and the right at five places; deviation of the direction at head and tail, over
/// 12, 24 and 48 units, from that of the segment. Per segment: ln of its length, its square, the deviation of its
/// direction from the middle of its code, the bow, the deviation of its first and its third quarter from the chord.
std::vector<double> stroke_features(const StrokeLine& line, const Glyph& glyph, std::size_t stroke);
std::size_t count_features(std::size_t n_segments);

/// Sides by class of stroke, as a regression on `stroke_features`: with x the standardised features, clamped to ±4,
///
///     sides = mean + basisᵀ (output tanh(hidden x + hidden_bias) + direct x + bias),
///
/// fitted by least squares to the strokes of a typeface (tests/writer/learn_sides.py) onto principal components of the
/// sides. Strokes of a class that is not in the table are predicted segment by segment, by code and by whether the
/// segment begins or ends the stroke ("-H-").
class SideTable {
  public:
    /// Reads a table (models/README.md). Throws `Error` for a damaged file.
    static SideTable load(const std::filesystem::path& path);
    static SideTable parse(std::string_view text, const std::string& source);

    /// Returns the predicted sides of a stroke, units, at least 1; fans at least 0. `round_sides` of a
    /// round one, but in Han characters. Where the line is of a pen (`Glyph::of_pen`), a side is at most 5/4 of the
    /// stroke's median one and 8 units: those at corners and hooks, along the bisector of a typeface's line, would
    /// become balls.
    StrokeSides predict(const StrokeLine& line, const Glyph& glyph, std::size_t stroke) const;
    bool has(const std::string& stroke_class) const { return models_.contains(stroke_class); }

    /// The regression of one class.
    struct Model {
        std::size_t n_features = 0, n_outputs = 0, n_hidden = 0, rank = 0;
        std::vector<double> feature_mean, feature_scale;  ///< [features]
        std::vector<double> mean, basis;                  ///< [outputs], [rank × outputs], units
        std::vector<double> hidden, hidden_bias;          ///< [hidden × features], [hidden]
        std::vector<double> output, bias, direct;         ///< [rank × hidden], [rank], [rank × features]
        std::vector<double> evaluate(const std::vector<double>& features) const;
    };

  private:
    std::map<std::string, Model> models_;
};

inline constexpr double kRoundTurn = 2.4;  ///< radians

/// Returns whether a segment of a line turns by more than `kRoundTurn` on its way, as strokes of kana do. In regular
/// script hooks do (己) where their corner is too blunt to end a segment.
bool is_round(const StrokeLine& line);

/// Returns the sides of a round stroke, to which no table applies. With y of its direction, 1 upwards,
///
///     half = 24 (3 − y) / 4 units.
///
/// Its head is blunt; its tail tapers over a sixth of the stroke.
StrokeSides round_sides(const StrokeLine& line);

/// Sides as one row: left and right of each segment, then the fans of head and tail.
std::vector<double> row_of(const StrokeSides& sides);
StrokeSides sides_of(const std::vector<double>& row, std::size_t n_segments);

}  // namespace tuft::writer
