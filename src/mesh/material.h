#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/types.h"

/// What a model's file says of the colour of its faces, before any ink.
namespace tuft::mesh {

/// A picture that lies on faces by their UVs, row 0 at the top (v = 1).
struct Picture {
    std::string name;         ///< for people
    std::vector<char> bytes;  ///< as it was found: PNG, JPEG or TIFF
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  ///< [3 width * height] sRGB-encoded, opaque
};

/// The colour of a group of faces: colour times picture times vertex colours, in linear light.
struct Material {
    Vec3f colour{1};                         ///< sRGB-encoded, in [0, 1]
    std::shared_ptr<const Picture> picture;  ///< null: none
    bool tinted = false;                     ///< by vertex colours also where it has a picture (glTF); else there only
                                             ///< where it has none
};

}  // namespace tuft::mesh
