#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ink/composite/composite.h"
#include "io/image/image.h"
#include "stroke/document/document.h"

/// \file
/// Single maps of a decoration as picture files. Called by `cli` and by the studio's paint thread. Any thread; the
/// document must not change meanwhile.
namespace tuft::io {

/// Encodes linear values in [0, 1] by the curve of their space, in 16 bits.
ink::AtlasMap<std::uint16_t> encode16(const ink::AtlasMap<float>& linear, ink::ColourSpace space);

/// Options of an EXR file with linear colours of a space, in half floats. Its chromaticities are stored unless they are
/// those that EXR means by default.
ImageOptions linear_options(ink::ColourSpace space);

/// Names of the maps that `write_map` writes: base-colour, normal, height, roughness, pigments, layers, palette.
const std::vector<std::string>& map_names();

/// Options of written maps.
struct MapOptions {
    int bits = 8;          ///< of base-colour in PNG, 8 or 16
    bool profile = false;  ///< stores an ICC profile in base-colour.png, also of sRGB
};

/// Writes one map of the visible layers, one file for each atlas page (`page_path`).
///
/// | map | PNG | EXR |
/// |---|---|---|
/// | base-colour | `bits` 8 or 16 | linear RGB, half floats |
/// | normal | 16 bits, (n + 1)/2 | [−1, 1] |
/// | height | 16 bits, 0.01 µm a step | µm |
/// | roughness | 16 bits | [0, 1], half floats |
/// | pigments | none | film units, a channel for each |
/// | layers | none | `write_layers` |
/// | palette | sRGB 8 | none |
///
/// Base colours are those of `compose.space`: in PNG by the curve of the space, with its ICC profile where `profile`,
/// in EXR with its chromaticities. ACEScg needs 16 bits.
///
/// Throws `Error` for a map that the format cannot hold, and where the map is empty.
void write_map(const std::filesystem::path& path, const std::string& name, const stroke::Document& painting,
               const ink::ComposeOptions& compose, const MapOptions& options = {});

}  // namespace tuft::io
