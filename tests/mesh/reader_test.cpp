#include <gtest/gtest.h>

#include "mesh/inspect.h"
#include "mesh/polygon_soup.h"
#include "mesh/repair.h"

namespace tuft::mesh {
namespace {

TEST(ModelFiles, LoadAsCleanSurfaces) {
    for (const char* name : {"bowl", "plate", "vase", "sheet", "sphere", "cylinder", "torus", "thin_plate"}) {
        const Surface s = build_surface(read_polygon_file(std::string(TUFT_SOURCE) + "/models/" + name + ".ply"));
        EXPECT_TRUE(describe_defects(s.report).empty()) << name;
    }
}

}  // namespace
}  // namespace tuft::mesh
