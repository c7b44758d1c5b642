#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ink/composite/composite.h"
#include "stroke/document/document.h"

/// \file
/// Single maps of a decoration as picture files. Called by `cli` and by the studio's paint thread. Any thread; the
/// document must not change meanwhile.
namespace tuft::io {

/// Encodes linear values in [0, 1] by the sRGB transfer curve (IEC 61966-2-1), in 16 bits.
ink::AtlasMap<std::uint16_t> srgb16(const ink::AtlasMap<float>& linear);

/// Names of the maps that `write_map` writes: base-colour, normal, height, roughness, pigments, palette.
const std::vector<std::string>& map_names();

/// Writes one map of the visible layers, one file for each atlas page (`page_path`).
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
/// Throws `Error` for a map that the format cannot hold, and where the map is empty.
void write_map(const std::filesystem::path& path, const std::string& name, const stroke::Document& painting,
               const ink::ComposeOptions& compose, int bits = 8);

}  // namespace tuft::io
