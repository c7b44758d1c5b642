#pragma once

#include <vector>

#include "io/image/image_codec.h"

/// \file
/// PNG files by libpng (ISO/IEC 15948). They are encoded and decoded in the program itself: OpenImageIO's shared
/// objects take 0.25 s to load, longer than a small picture.
namespace tuft::io {

/// Encodes 1–4 channels of 8 or 16 bits; floats in [0, 1] become 16 bits, rounded, and NaN becomes 0. Does not throw.
ImageFault encode_png(const EncodeRequest& request, std::vector<unsigned char>& out);

/// Decodes any PNG file: palettes become RGB, transparent colours alpha, 1–4 bits 8. Samples are scaled to the wanted
/// type and rounded, floats to [0, 1]; colours and alpha stay as stored. Channel names are Y, A, R, G, B. Does not
/// throw.
ImageFault decode_png(const DecodeRequest& request, DecodedImage& out);

}  // namespace tuft::io
