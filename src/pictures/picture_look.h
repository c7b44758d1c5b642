#pragma once

#include "render/picture/glass.h"
#include "render/picture/picture.h"
#include "stroke/document/document.h"

/// \file
/// A painted model as product pictures show it. Called by the commands and the studio. Any thread that has the
/// document.
namespace tuft::pictures {

/// Surface of a model as a picture shows it, with its maps.
struct PictureLook {
    render::Appearance appearance;  ///< its maps are those below
    ink::AtlasMap<float> colour, height;
    ink::AtlasMap<float> roughness;  ///< of parts with substrates of their own; empty: that of the finish
    ink::AtlasMap<std::uint8_t> transmission = {};  ///< empty: no part is of glass

    /// Sets the maps of `appearance` after they were made or replaced.
    void point_to_maps(const stroke::Model& model);
};
/// Returns what is painted on a model, or without `painting` the bare one, with a height map where `raking`.
/// `material`: of the whole bare surface; empty: the painting's and its parts', else porcelain.
PictureLook make_look(const stroke::Model& model, const stroke::Document* painting, const std::string& material,
                      bool raking);
/// Returns which triangles are of glass or hidden. `look` must outlive it.
render::Glass glass_of(const PictureLook& look, const stroke::Document& painting);

}  // namespace tuft::pictures
