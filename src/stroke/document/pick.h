#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stroke/document/document.h"

/// \file
/// The eyedropper. Called by `tuft inspect` and by the studio's pipette.
namespace tuft::stroke {

/// One film of a texel, film units by pigment plane.
struct PickedFilm {
    std::uint32_t layer = kFirstLayer;
    int film = ink::kOpenFilm;  ///< as in `ink::Canvas`, from the soaked one to the open one
    std::array<double, ink::kMaxPigments> amounts{};
};

/// Ink at a point of a surface.
struct Pick {
    mesh::SurfacePoint at;  ///< nearest to the point given
    atlas::TexelRef texel;
    std::vector<PickedFilm> films;                    ///< of the layers shown, the lowest first, none empty
    std::array<double, ink::kMaxPigments> amounts{};  ///< Σ of `films`, by plane of `LayerStack::pigments`
    double liquid = 0;                                ///< film units, on the surface and in its pores
};

/// Returns the ink at the surface point nearest to `point` (metres, model frame), of the layers shown. Throws `Error`
/// for a model without a surface.
Pick pick(const Document& document, const Vec3& point);
/// The same on the palette, in its frame.
Pick pick_on_palette(const Document& document, const Vec3& point);

/// Returns an ink called `name` that is all pigment, in the proportions picked, and leaves a film as thick, 0.05 to 8
/// film units; nothing where the surface is bare. `pigments`: of the document's layers.
std::optional<ink::Ink> picked_ink(const Pick& pick, std::span<const ink::Pigment> pigments, const std::string& name);

}  // namespace tuft::stroke
