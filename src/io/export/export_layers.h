#pragma once

#include <filesystem>

#include "stroke/document/document.h"

/// \file
/// Layers of a decoration as files for painting programs: OpenRaster and EXR. Called by `tuft export`. Any thread; the
/// document must not change meanwhile.
namespace tuft::io {

/// Writes the layers of the atlas, one file for each page (`page_path`).
///
/// Films of pigment are not pictures with an alpha channel. A layer's picture is therefore found from the colours B
/// below it and C with it, per texel: of all (c, α) that give C = B + α (c − B) with c in [0, 1] it has the least α.
///
/// - `.ora` (OpenRaster 0.0.6): `mergedimage.png`, `Thumbnails/thumbnail.png`, and a PNG for each layer over one of the
///   substrate, in 8 bits; `stack.xml` has name, opacity, visibility and composite-op. α is divided by the opacity;
///   what that leaves above 1 is cut. Layers that multiply or glaze get `svg:multiply` with C = B (1 − α + α c). Codes
///   are mixed as they are stored, as readers do.
/// - `.exr`: channels R, G, B of the whole picture, and for each visible layer NAME.R … NAME.A, premultiplied, opacity
///   included; the substrate is the lowest. Linear, half floats. "Over" from the lowest up gives the whole.
///
/// Colours are those of `compose.space`; PNGs have its ICC profile, EXR its chromaticities. Throws `Error` for ACEScg
/// in 8 bits, for another extension, for an EXR of more than 15 layers, and where a file cannot be written.
void write_layers(const std::filesystem::path& path, const stroke::Document& painting,
                  const ink::ComposeOptions& compose);

}  // namespace tuft::io
