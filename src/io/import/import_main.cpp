/// \file
/// `tuft-import FORMAT`: reads one FBX or DAE file (import_scene.h, import_process.h).

#include <assimp/Importer.hpp>

#include "io/import/import_process.h"
#include "io/import/import_scene.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    tuft::io::run_importer(0, [&](std::span<const char> bytes) {
        Assimp::Importer& importer = *new Assimp::Importer;
        tuft::io::prepare_importer(importer, argv[1]);
        return tuft::io::import_scene(importer, argv[1], bytes);
    });
}
