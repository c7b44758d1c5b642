#include "io/import/import_process.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <new>
#include <string>
#include <string_view>

#include "io/import/import_scene.h"

namespace tuft::io {
namespace {

/// Few files or none, and no longer than the one who waits for it. What computing and memory it may take is set from
/// outside. Returns where the result goes: standard output is the same as standard error from here on.
int restrain(unsigned n_files) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int result = dup(1);
    if (result < 0 || dup2(2, 1) < 0) std::_Exit(3);
    const rlim_t most = static_cast<rlim_t>(result) + 1 + n_files;
    const rlimit streams{most, most};
    setrlimit(RLIMIT_NOFILE, &streams);
    return result;
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

void write_output(int to, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n = write(to, bytes.data(), bytes.size());
        if (n <= 0) std::_Exit(3);
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
}

}  // namespace

void run_importer(unsigned n_files, const std::function<std::vector<char>(std::span<const char>)>& import) {
    const int result = restrain(n_files);
    std::string fault;
    try {
        const std::vector<char> packed = import(read_input());
        write_output(result, {packed.data(), packed.size()});
        std::_Exit(0);  // what the library holds is not given back piece by piece
    } catch (const std::bad_alloc&) {
        fault = kTooMuchMemory;
    } catch (const std::exception& e) {
        fault = e.what();
    } catch (...) {
        fault = "";
    }
    write_output(result, "fault: " + fault);
    std::_Exit(1);
}

}  // namespace tuft::io
