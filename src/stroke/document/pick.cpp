#include "stroke/document/pick.h"

#include <algorithm>

#include "atlas/texels/cluster_graph.h"

namespace tuft::stroke {
namespace {

Pick pick_at(const Vec3& point, const Model& model, const mesh::SurfaceQuery& surface,
             std::span<const LayerTexels> layers) {
    const auto at = surface.closest_point(point);
    if (!at) throw Error("there is no surface to look at");
    Pick pick;
    pick.at = *at;
    pick.texel = atlas::texel_at(*model.mesh, model.atlas, model.texels, at->triangle, at->position);
    if (!pick.texel.valid()) return pick;
    const std::uint32_t slot = pick.texel.slot;
    const std::uint8_t t = pick.texel.texel;
    for (const LayerTexels& layer : layers) {
        const ink::Canvas& canvas = *layer.canvas;
        for (int film = 0; film < ink::kFilms; ++film) {
            PickedFilm picked{.layer = layer.layer, .film = film, .amounts = {}};
            bool any = false;
            for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p) {
                const ink::Plane* w = canvas.film_plane(slot, film, p);
                picked.amounts[p] = w ? static_cast<double>((*w)[t]) : 0;
                pick.amounts[p] += picked.amounts[p];
                any = any || picked.amounts[p] > 0;
            }
            if (any) pick.films.push_back(picked);
        }
        for (const ink::Liquid where : {ink::Liquid::film, ink::Liquid::pores})
            if (const ink::Plane* w = canvas.liquid(slot, where)) pick.liquid += static_cast<double>((*w)[t]);
    }
    return pick;
}

}  // namespace

Pick pick(const Document& document, const Vec3& point) {
    return pick_at(point, document.model(), *document.parts().surface(), document.appearance().shown_layers());
}

Pick pick_on_palette(const Document& document, const Vec3& point) {
    const Model& model = document.palette().model();
    const LayerTexels texels{kPaletteLayer, document.palette().canvas()};
    return pick_at(point, model, *model.query, std::span(&texels, 1));
}

std::optional<ink::Ink> picked_ink(const Pick& pick, std::span<const ink::Pigment> pigments, const std::string& name) {
    constexpr double kThinnest = 0.05, kThickest = 8;  // film units that a brush leaves
    double all = 0;
    for (const double a : pick.amounts) all += a;
    if (!(all > 1e-6)) return std::nullopt;
    ink::Ink ink{.name = name, .title = "picked from the surface"};
    double left = 1;  // rounding never makes it more than whole
    for (std::size_t p = 0; p < pigments.size(); ++p) {
        const double part = std::min(left, pick.amounts[p] / all);
        if (!(part > 0)) continue;
        left -= part;
        ink.parts.push_back({pigments[p], part});
    }
    ink.film = std::clamp(all, kThinnest, kThickest);
    return ink;
}

}  // namespace tuft::stroke
