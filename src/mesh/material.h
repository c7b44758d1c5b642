#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Colours of a model's faces as its file states them, before any ink. Readers fill them; `ink` bakes them into the
/// base colour.
namespace tuft::mesh {

/// A texture image, mapped by UVs; row 0 is at the top (v = 1).
struct Picture {
    std::string name;         ///< for people
    std::vector<char> bytes;  ///< the encoded file: PNG, JPEG or TIFF
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< [3 width * height] sRGB-encoded, opaque
};

/// Colour of a group of faces: the product of colour, picture and vertex colours in linear light.
struct Material {
    Vec3f colour{1};                         ///< sRGB-encoded, in [0, 1]
    std::shared_ptr<const Picture> picture;  ///< null: none
    bool tinted = false;  ///< vertex colours apply also where there is a picture (glTF); otherwise only without one
};

}  // namespace tuft::mesh
