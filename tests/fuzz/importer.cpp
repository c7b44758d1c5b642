#include "importer.h"

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/Importer.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

#include "io/import/import_cad.h"
#include "io/import/import_scene.h"
#include "promise.h"

extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*)());

namespace tuft::fuzz {
namespace {

constexpr std::size_t kMostInput = std::size_t{1} << 16, kMostOutput = std::size_t{1} << 24;
constexpr rlim_t kMemory = rlim_t{1} << 30;  // that a process may take beyond what it began with
constexpr int kPatience = 2000;              // milliseconds
constexpr int kRuns = 5000;                  // of one process: the libraries lose memory

enum class Stage : int { reading, walking, done };

/// Memory of both processes.
struct Shared {
    std::atomic<Stage> stage;
    std::size_t in = 0, out = 0;
    char input[kMostInput], output[kMostOutput];
};

Shared& shared() {
    static Shared* const memory =
        static_cast<Shared*>(mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    promise(memory != MAP_FAILED, "there is memory for the importer");
    return *memory;
}

rlim_t memory_now() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

/// Signals and reports are this process's own, not libFuzzer's.
void become_importer() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int s : {SIGSEGV, SIGBUS, SIGABRT, SIGILL, SIGFPE, SIGINT, SIGTERM, SIGALRM, SIGXFSZ, SIGUSR1, SIGUSR2})
        signal(s, SIG_DFL);
    if (__sanitizer_set_death_callback) __sanitizer_set_death_callback(nullptr);
    const rlim_t most = memory_now() + kMemory;
    const rlimit memory{most, most}, core{0, 0};
    setrlimit(RLIMIT_AS, &memory);
    setrlimit(RLIMIT_CORE, &core);
}

/// One for all files of a format: its readers and steps take longer to make than most files to read.
Assimp::Importer& importer_of(const std::string& format) {
    static std::map<std::string, Assimp::Importer> importers;
    const bool is_new = !importers.contains(format);
    Assimp::Importer& importer = importers[format];
    if (is_new) io::prepare_importer(importer, format.c_str());
    return importer;
}

void import_one(const char* format) {
    Shared& s = shared();
    s.out = 0;
    s.stage = Stage::reading;
    try {
        const bool is_cad = std::strcmp(format, "stp") == 0 || std::strcmp(format, "igs") == 0;
        const std::span<const char> input(s.input, s.in);
        const std::vector<char> packed =
            is_cad ? io::pack_scene(io::import_cad(format, input, {}))
                   : io::import_scene(importer_of(format), format, input, [&] { s.stage = Stage::walking; });
        s.stage = Stage::done;
        if (packed.size() <= kMostOutput) {
            std::memcpy(s.output, packed.data(), packed.size());
            s.out = packed.size();
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "refused: %s\n", error.what());
    }
    s.stage = Stage::done;
}

[[noreturn]] void serve(int line) {
    become_importer();
    char format[4] = {};
    while (read(line, format, 3) == 3) {
        import_one(format);
        if (write(line, format, 1) != 1) break;
    }
    _exit(0);
}

class Child {
  public:
    ~Child() { end(); }

    /// Whether the importer came to an end by itself.
    bool run(const char* format) {
        if (runs_++ >= kRuns) end();
        if (pid_ == 0) start();
        if (write(line_, format, 3) != 3) return end(), false;
        pollfd answer{line_, POLLIN, 0};
        char got = 0;
        if (poll(&answer, 1, kPatience) == 1 && read(line_, &got, 1) == 1) return true;
        end();
        return false;
    }

  private:
    void start() {
        int lines[2];
        promise(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, lines) == 0, "there is a line to the importer");
        // What it says of its end would stand between libFuzzer's lines; a broken promise is run again, alone.
        std::fflush(nullptr);
        pid_ = fork();
        promise(pid_ >= 0, "the importer starts");
        if (pid_ == 0) {
            close(lines[0]);
            if (!std::getenv("TUFT_FUZZ_LOUD") && !std::freopen("/dev/null", "w", stderr)) _exit(1);
            serve(lines[1]);
        }
        close(lines[1]);
        line_ = lines[0];
        runs_ = 1;
    }
    void end() {
        if (pid_ <= 0) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
        close(line_);
        pid_ = 0;
    }

    pid_t pid_ = 0;
    int line_ = -1, runs_ = 0;
};

}  // namespace

std::vector<char> import_in_child(const char* format, std::span<const std::uint8_t> input) {
    static Child child;
    if (input.size() > kMostInput) return {};
    Shared& s = shared();
    std::memcpy(s.input, input.data(), input.size());
    s.in = input.size();
    // Once more in a fresh process: a busy machine, or what Assimp lost before, may have ended the first one.
    for (int attempt = 0; attempt < 2; ++attempt) {
        s.stage = Stage::reading;
        if (child.run(format)) return {s.output, s.output + s.out};
        if (s.stage == Stage::reading) return {};
    }
    promise(false, "what walks through Assimp's scene does not crash (TUFT_FUZZ_LOUD=1 shows where)");
    return {};
}

}  // namespace tuft::fuzz
