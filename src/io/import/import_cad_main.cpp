/// \file
/// `tuft-import-cad FORMAT CHORD bodies|faces`: reads one STEP or IGES file (import_cad.h, import_process.h). CHORD is
/// in metres, 0 for the default.

#include <cstdlib>
#include <string_view>

#include "io/import/import_cad.h"
#include "io/import/import_process.h"

int main(int argc, char** argv) {
    if (argc != 4) return 2;
    // The copy of an IGES file in memory, and the same opened by its name.
    const bool is_iges = std::string_view(argv[1]) == "igs";
    tuft::io::run_importer(is_iges ? 2 : 0, [&](std::span<const char> bytes) {
        const tuft::io::CadRequest request{.chord = std::strtod(argv[2], nullptr),
                                           .by_faces = std::string_view(argv[3]) == "faces"};
        return tuft::io::pack_scene(tuft::io::import_cad(argv[1], bytes, request));
    });
}
