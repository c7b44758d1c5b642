#include "stroke/surface/flat_sheet.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/error.h"

/// Flat sheets to measure on.
namespace tuft::stroke {
namespace {

/// In any plane a texel lies where the header says, faces along n and has the area of its square; the sheet's texels
/// are those whose centres it covers.
TEST(FlatSheet, TexelsLieInTheirPlaces) {
    const FlatSheet sheet{.frame = make_frame({0.1, -0.2, 0.3}, glm::normalize(Vec3(1, 2, -2))),
                          .low = {-0.0102, -0.0052},
                          .high = {0.0102, 0.0052},
                          .columns = 6,
                          .rows = 3,
                          .texels = 128,
                          .texel = 2e-4,
                          .corner = {-0.0128, -0.0128}};
    const Model model = make_flat_sheet(sheet);
    std::size_t covered = 0;
    for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot)
        for (std::uint32_t t = 0; t < atlas::kTileTexels; ++t) {
            const atlas::TexelPlace at = atlas::texel_place(model.texels, slot, t);
            if (!atlas::texel_ref(model.texels, at.x, at.y).valid()) continue;
            ++covered;
            const Vec2 place = sheet.corner + sheet.texel * (Vec2(at.x, at.y) + 0.5);
            // Floats of a corner of 0.4 m: 3e-8 m, a few of them.
            EXPECT_LT(glm::distance(Vec3(model.texels.position(slot, t)), sheet.frame.to_world(Vec3(place, 0))), 1e-7);
            // Normals of triangles with corners off by that, over 3 mm.
            EXPECT_LT(glm::distance(Vec3(model.texels.normal(slot, t)), sheet.frame.n), 1e-4);
            EXPECT_NEAR(static_cast<double>(model.texels.tiles[slot].area[t]) / (sheet.texel * sheet.texel), 1, 1e-3);
        }
    EXPECT_EQ(covered, 102u * 52u) << "20.4 by 10.4 mm";
}

TEST(FlatSheet, ASheetWithoutAreaOrOutsideItsAtlasIsRefused) {
    EXPECT_THROW(make_flat_sheet({.frame = {}}), std::invalid_argument);
    EXPECT_THROW(make_flat_sheet({.frame = {}, .high = Vec2(0.1)}), std::invalid_argument) << "51.2 mm of texels";
    EXPECT_THROW(make_flat_sheet({.frame = {}, .high = Vec2(0.01), .corner = Vec2(1e-3)}), std::invalid_argument);
}

}  // namespace
}  // namespace tuft::stroke
