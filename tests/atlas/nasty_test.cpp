#include <gtest/gtest.h>

#include <cmath>

#include "atlas/atlas.h"
#include "core/error.h"
#include "nasty_meshes.h"
#include "wrecked_meshes.h"

namespace tuft::atlas {
namespace {

void expect_atlas(const mesh::TriangleMesh& mesh) {
    UnwrapOptions options;
    options.size = 128;
    Unwrapped u;
    ASSERT_NO_THROW(u = unwrap(mesh, options));
    ASSERT_EQ(u.atlas.corner_uvs.size(), 3 * mesh.n_triangles());
    EXPECT_EQ(u.report.flips, 0u);
    EXPECT_EQ(u.report.overlapping_texels, 0u);
    EXPECT_EQ(u.report.zero_area_triangles, 0u);
    EXPECT_GE(u.report.smallest_gap, 4);
    EXPECT_GT(u.report.utilisation, 0);
    EXPECT_TRUE(u.atlas.texel_size > 0 && std::isfinite(u.atlas.texel_size));
}

TEST(Unwrap, AnyCleanMeshGetsAnAtlas) {
    const auto meshes = test::nasty_meshes();
    EXPECT_GE(meshes.size(), 50u);
    for (const test::NastyMesh& nasty : meshes) {
        SCOPED_TRACE(nasty.name);
        expect_atlas(nasty.mesh);
    }
}

TEST(Unwrap, AnyWreckedMeshGetsAnAtlas) {
    const auto files = test::wrecked_meshes();
    EXPECT_GE(files.size(), 70u);
    for (const test::WreckedMesh& file : files) {
        SCOPED_TRACE(file.name);
        mesh::Surface surface;
        ASSERT_NO_THROW(surface = mesh::build_surface(file.soup));
        ASSERT_GT(surface.mesh.n_triangles(), 0u);
        expect_atlas(surface.mesh);
    }
}

}  // namespace
}  // namespace tuft::atlas
