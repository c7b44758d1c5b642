#pragma once

#include <cstdint>
#include <span>

namespace tuft::fuzz {

/// Makes a tiny mesh, an atlas and some strokes from the bytes, and paints them: all settings that
/// change the path are drawn from them, too. The ink left is finite and not negative, and painting
/// again leaves the same bits.
void run_paint(std::span<const std::uint8_t> input);

}  // namespace tuft::fuzz
