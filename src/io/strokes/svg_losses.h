#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

/// \file
/// What a drawing loses on its way from an SVG file to brush strokes, for telling a person.
namespace tuft::io {

/// Kinds of loss, in the order in which they are reported.
enum class SvgLoss {
    text,
    image,
    foreign,
    missing_use,
    outside_use,
    missing_paint,
    clip,
    mask,
    filter,
    gradient,
    pattern,
    dash,
    marker,
    opacity,
    blend,
    scaled_width,
    white,
    frame,
    transform,
    animation,
    script,
    rule,
};
inline constexpr std::size_t kSvgLosses = static_cast<std::size_t>(SvgLoss::rule) + 1;

/// Counts what is lost.
class SvgLosses {
  public:
    void add(SvgLoss loss) { ++counts_[static_cast<std::size_t>(loss)]; }
    /// A colour that something is drawn in, as the file writes it.
    void add_colour(const std::string& colour);
    /// One line for each kind that was met, with its count; one more for the colours where they are
    /// more than black.
    std::vector<std::string> lines() const;

  private:
    std::array<std::size_t, kSvgLosses> counts_{};
    std::vector<std::string> colours_;  // in the order met
    std::set<std::string> known_;
};

}  // namespace tuft::io
