// Writes exported models for checks by other programs: write_samples FOLDER
#include <cstdio>

#include "core/error.h"
#include "sample_model.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    using namespace tuft::io;
    using namespace tuft::io::testing;
    const std::filesystem::path folder = argv[1];
    try {
        std::filesystem::create_directories(folder);
        const tuft::mesh::TriangleMesh mesh = cylinder();
        const tuft::atlas::Atlas atlas = cylinder_atlas(mesh);
        export_model(folder / "relief.glb", mesh, atlas, pattern_maps(64));
        export_model(folder / "flat.glb", mesh, atlas, pattern_maps(64, true));
        export_model(folder / "with files.gltf", mesh, atlas, pattern_maps(64));
        export_model(folder / "七上八下.glb", mesh, atlas, {pattern_maps(16).base_colour, {}, {}});
    } catch (const tuft::Error& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
    return 0;
}
