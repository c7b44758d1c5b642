#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/message.h"

/// \file
/// Report of the content that an SVG drawing loses on import. Called by svg.cpp only.
namespace tuft::io {

/// Kinds of loss, in the order in which they are reported.
enum class SvgLoss {
    text,      ///< characters without a font
    text_end,  ///< characters beyond the end of their path
    image,
    damaged_path,
    foreign,
    missing_use,
    outside_use,
    missing_paint,
    clip,
    mask,
    filter,
    gradient,
    pattern,
    marker,
    opacity,
    overlap,
    blend,
    white,
    frame,
    transform,
    animation,
    script,
    rule,
};
inline constexpr std::size_t kSvgLosses = static_cast<std::size_t>(SvgLoss::rule) + 1;

/// Counts lost content by kind. One thread at a time.
class SvgLosses {
  public:
    void add(SvgLoss loss) { ++counts_[static_cast<std::size_t>(loss)]; }
    /// Adds a colour of a drawn element, as the file writes it.
    void add_colour(const std::string& colour);
    /// Adds a font family that is not installed, and the one that replaces it.
    void add_font(const std::string& missing, const std::string& used);
    /// Adds a picture that cannot be read, with its name.
    void add_image(const Message& why) { images_.push_back(why); }
    /// Returns one line for each kind found, with its count, one for each missing font, and one for the colours
    /// where any is not black.
    std::vector<Message> lines() const;

  private:
    std::array<std::size_t, kSvgLosses> counts_{};
    std::vector<std::pair<std::string, std::string>> fonts_;  // missing and used, in the order found
    std::vector<Message> images_;                             // in the order found
    std::vector<std::string> colours_;                        // in the order found
    std::set<std::string> known_;
};

}  // namespace tuft::io
