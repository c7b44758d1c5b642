#include "app/document/writing.h"

#include <gtest/gtest.h>

#include <fstream>

#include "models.h"
#include "paths.h"

namespace tuft::app {
namespace {

Writing cross() {
    const std::string file = testing::TempDir() + "/tuft_writing_" + std::to_string(getpid()) + ".svg";
    std::ofstream(file) << "<svg width='40mm' viewBox='0 0 40 20'><line x1='0' y1='10' x2='40' y2='10'/><line x1='20' y1='0' x2='20' y2='20'/></svg>";
    Writing w = read_writing(file);
    std::filesystem::remove(file);
    return w;
}

TEST(Writing, LiesWithItsMiddleAtTheCursorTurnedAndScaled) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    Writing w = cross();
    EXPECT_NEAR(w.width, 0.040, 1e-9);
    EXPECT_NEAR(w.height, 0.020, 1e-9);
    w.scale = 1.5;
    w.turn = 0.5;
    const auto at = query.ray(mesh.bounds.centre() + Vec3(0.01, 0.02, 1), Vec3(0, 0, -1));
    ASSERT_TRUE(at);
    const auto lines = ghost_lines(query, w, place_writing(w, *at, Vec3(0, 0, 1), Vec3(1, 0, 0)));
    ASSERT_EQ(lines.size(), 2u);
    // Seen from above with x to the right, a turn goes clockwise: the line's right end sinks.
    const Vec3 right = lines[0].back().position - at->position;
    EXPECT_NEAR(right.x, 0.030 * std::cos(0.5), 1e-5);  // the walk works on single-precision vertices
    EXPECT_NEAR(right.y, -0.030 * std::sin(0.5), 1e-5);
    EXPECT_NEAR(glm::length(lines[1].front().position - lines[1].back().position), 0.030, 1e-5);
}

TEST(Writing, CharactersWithPlacesOfTheirOwnStandSideBySide) {
    const Writing w = read_writing(source_folder() + "/samples/strokes/man-bu-ren-sheng.inkml");
    EXPECT_GT(w.width, 3 * w.height);
}

}  // namespace
}  // namespace tuft::app
