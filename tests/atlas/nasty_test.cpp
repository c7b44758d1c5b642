#include <gtest/gtest.h>

#include "atlas/atlas.h"
#include "core/error.h"
#include "nasty_meshes.h"

namespace tuft::atlas {
namespace {

TEST(Unwrap, AnyCleanMeshGetsAnAtlas) {
    const auto meshes = test::nasty_meshes();
    EXPECT_GE(meshes.size(), 50u);
    for (const test::NastyMesh& nasty : meshes) {
        SCOPED_TRACE(nasty.name);
        UnwrapOptions options;
        options.size = 256;
        Unwrapped u;
        ASSERT_NO_THROW(u = unwrap(nasty.mesh, options));
        EXPECT_EQ(u.report.flips, 0u);
        EXPECT_EQ(u.report.overlapping_texels, 0u);
        EXPECT_EQ(u.report.roomless_triangles, 0u);
        EXPECT_GE(u.report.smallest_gap, 4);
    }
}

}  // namespace
}  // namespace tuft::atlas
