/// \file
/// `tuft-import`: reads one FBX or DAE file (import_scene.h). It gets the file as standard input, opens no other, and
/// writes a packed `io::FileScene`, or a line that begins with "fault: ", to standard output. read_import.cpp starts
/// it, and limits its time and memory.

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <csignal>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "io/model/import_scene.h"

namespace tuft::io {
namespace {

/// No file, and no longer than the one who waits for it. What computing and memory it may take is set from outside.
void restrain() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const rlimit streams{3, 3};
    setrlimit(RLIMIT_NOFILE, &streams);
}

std::vector<char> read_input() {
    struct stat about {};
    std::vector<char> bytes(fstat(0, &about) == 0 ? static_cast<std::size_t>(about.st_size) : 0);
    std::size_t have = 0;
    while (have < bytes.size()) {
        const ssize_t n = pread(0, bytes.data() + have, bytes.size() - have, static_cast<off_t>(have));
        if (n <= 0) break;
        have += static_cast<std::size_t>(n);
    }
    bytes.resize(have);
    return bytes;
}

void write_output(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = write(1, bytes.data(), bytes.size());
        if (n <= 0) std::_Exit(3);
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

}  // namespace
}  // namespace tuft::io

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    tuft::io::restrain();
    std::string fault;
    try {
        Assimp::Importer& importer = *new Assimp::Importer;
        tuft::io::prepare_importer(importer, argv[1]);
        const std::vector<char> packed = tuft::io::import_scene(importer, argv[1], tuft::io::read_input());
        tuft::io::write_output({packed.data(), packed.size()});
        std::_Exit(0);  // what Assimp holds is not given back piece by piece
    } catch (const std::bad_alloc&) {
        fault = tuft::io::kTooMuchMemory;
    } catch (const std::exception& e) {
        fault = e.what();
    } catch (...) {
        fault = "";
    }
    tuft::io::write_output("fault: " + fault);
    std::_Exit(1);
}
