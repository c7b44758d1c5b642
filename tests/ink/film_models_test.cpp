#include <gtest/gtest.h>

#include <string>

#include "atlas/texels/seam_links.h"
#include "ink/film/film.h"
#include "mesh/repair/repair.h"
#include "paths.h"

// The wet film on the shipped models, whose charts meet in every way that charts do.

namespace tuft::ink {
namespace {

TEST(WetFilm, UniformWaterStaysUniformOverEverySeamOfEveryModel) {
    for (const std::string name :
         {"bowl", "car", "cylinder", "plate", "sheet", "sphere", "thin_plate", "torus", "vase"}) {
        const mesh::TriangleMesh mesh =
            mesh::build_surface(mesh::read_polygon_file(source_folder() + "/models/" + name + ".ply"), {}).mesh;
        const atlas::Atlas atlas = atlas::unwrap(mesh, {.size = 256}).atlas;
        const atlas::TexelMap map = atlas::build_texel_map(mesh, atlas);
        const atlas::SeamLinks links = atlas::build_seam_links(mesh, atlas, map);
        WetFilm film(map, links);
        Canvas canvas(map.n_slots());
        canvas.add_pigment(load_ink("carbon").parts[0].pigment);
        const auto each = [&](auto&& visit) {
            for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
                for (int t = 0; t < atlas::kTileTexels; ++t)
                    if (map.tiles[slot].cluster[t] != atlas::kNoCluster) visit(slot, t);
        };
        each([&](std::uint32_t slot, int t) {
            canvas.touch_liquid(slot, Liquid::film)[t] = 2;
            canvas.touch(slot, 0)[t] = 0.7f;
        });
        FilmParams p;
        p.threshold = p.pin = p.drying.evaporation = p.shortest_step = 0;
        p.mobility = 1e-8;
        p.mixing = 1e-9;
        p.pores.capacity = 5;
        film.advance(canvas, 5, p);
        double water = 0, ink = 0;
        each([&](std::uint32_t slot, int t) {
            water = std::max(water, std::abs(double((*canvas.liquid(slot, Liquid::film))[t]) - 2));
            double sum = 0;
            for (int layer = 0; layer < kFilms; ++layer)
                if (const Plane* w = canvas.film_plane(slot, layer, 0)) sum += double((*w)[t]);
            ink = std::max(ink, std::abs(sum - 0.7));
        });
        // Rounding of single precision, an ulp or so a step.
        EXPECT_LT(water, 2e-6) << name;
        EXPECT_LT(ink, 1e-6) << name;
    }
}

}  // namespace
}  // namespace tuft::ink
