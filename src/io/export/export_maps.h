#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ink/composite/composite.h"
#include "stroke/painting/painting.h"

/// Single maps of a decoration as picture files.
namespace tuft::io {

/// sRGB transfer curve over linear [0, 1] (IEC 61966-2-1), in 16 bits.
ink::AtlasMap<std::uint16_t> srgb16(const ink::AtlasMap<float>& linear);

/// Names that `write_map` knows: base-colour, normal, height, roughness, pigments, palette.
const std::vector<std::string>& map_names();

/// Writes one map of what is seen, a file for each page of the atlas (`page_path`).
///
/// | map | PNG | EXR |
/// |---|---|---|
/// | base-colour | sRGB, `bits` 8 or 16 | linear RGB, half floats |
/// | normal | 16 bits, (n + 1)/2 | [−1, 1] |
/// | height | 16 bits, 0.01 µm a step | µm |
/// | roughness | 16 bits | [0, 1], half floats |
/// | pigments | none | film units, a channel for each |
/// | palette | sRGB 8 | none |
///
/// Throws `Error` for a map that this format does not hold, and where there is nothing to write.
void write_map(const std::filesystem::path& path, const std::string& name, const stroke::Document& painting,
               const ink::ComposeOptions& compose, int bits = 8);

}  // namespace tuft::io
