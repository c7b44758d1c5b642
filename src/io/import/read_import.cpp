#include "io/import/read_import.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/library_fault.h"
#include "core/files/system_message.h"
#include "core/system/interrupt.h"
#include "io/import/import_cad.h"
#include "io/import/import_scene.h"
#include "io/scene/file_scene.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20;

/// A program that reads models, and what a file may cost it.
struct Importer {
    const char* program;
    bool is_cad;
    rlim_t seconds, bytes;        ///< of computing and of memory, for any file
    double seconds_per_mebibyte;  ///< more, by the size of the file
    rlim_t bytes_per_byte;        ///< likewise
};
// A sound file of a million triangles has 40 MB and takes 3 s and 1 GB.
constexpr Importer kMeshes{"tuft-import", false, 20, rlim_t{1} << 30, 0.5, 64};
// The size of a CAD file does not say how many triangles its surfaces take: 2 MB may be a second or a minute.
constexpr Importer kCad{"tuft-import-cad", true, 120, rlim_t{6} << 30, 20, 200};

fs::path find_program(const Importer& importer) {
    const std::string name = importer.program;
    std::error_code ec;
    std::vector<fs::path> places;
    const fs::path program = fs::read_symlink("/proc/self/exe", ec).parent_path();
    if (!ec) {
        places.push_back(program / name);
        places.push_back(program.parent_path() / TUFT_LIBDIR / "tuft" / name);
    }
    places.push_back(data_folder().parent_path().parent_path() / TUFT_LIBDIR / "tuft" / name);
    places.push_back(fs::path(TUFT_IMPORT_BUILT) / name);
    std::string tried;
    for (const fs::path& place : places) {
        if (access(place.c_str(), X_OK) == 0) return place;
        tried += (tried.empty() ? "" : ", ") + place.string();
    }
    throw Error(Message(importer.is_cad ? "{}, which reads STEP and IGES, is not there (looked for {})"
                                        : "{}, which reads FBX and DAE, is not there (looked for {})",
                        name, tried));
}

/// A file without a name, in memory.
class MemoryFile {
  public:
    MemoryFile() : fd_(memfd_create("tuft", MFD_CLOEXEC)) {
        if (fd_ < 0) throw Error(Message("no memory for a file: {}", system_message(errno)));
    }
    ~MemoryFile() { close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    int fd() const { return fd_; }
    void write_all(const std::vector<char>& bytes) const {
        for (std::size_t at = 0; at < bytes.size();) {
            const ssize_t n = write(fd_, bytes.data() + at, bytes.size() - at);
            if (n <= 0) throw Error(Message("no memory for a file of {} bytes", bytes.size()));
            at += static_cast<std::size_t>(n);
        }
    }
    std::vector<char> read_all() const {
        struct stat about {};
        std::vector<char> bytes(fstat(fd_, &about) == 0 ? static_cast<std::size_t>(about.st_size) : 0);
        std::size_t have = 0;
        while (have < bytes.size()) {
            const ssize_t n = pread(fd_, bytes.data() + have, bytes.size() - have, static_cast<off_t>(have));
            if (n <= 0) break;
            have += static_cast<std::size_t>(n);
        }
        bytes.resize(have);
        return bytes;
    }

  private:
    int fd_;
};

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitised = true;
#elif defined(__has_feature)
constexpr bool kSanitised = __has_feature(address_sanitizer);
#else
constexpr bool kSanitised = false;
#endif

/// What one file may cost.
struct Cost {
    rlim_t seconds = 0;  ///< of computing
    rlim_t bytes = 0;    ///< of memory, and of what is handed over
    /// Longer than a machine with so much else to do takes for it: the importer waits for something that never comes.
    std::chrono::seconds patience() const { return std::chrono::seconds(10 * seconds); }
};

/// By the size of the file, and within what this process may take itself.
Cost cost_of(std::size_t file_bytes, const Importer& importer) {
    const auto own = [](__rlimit_resource what) {
        rlimit bounds{};
        return getrlimit(what, &bounds) == 0 ? bounds.rlim_cur : RLIM_INFINITY;
    };
    const double mebibytes = static_cast<double>(file_bytes) / kMebibyte;
    const rlim_t seconds = importer.seconds + static_cast<rlim_t>(importer.seconds_per_mebibyte * mebibytes);
    const rlim_t bytes = importer.bytes + importer.bytes_per_byte * file_bytes;
    return {.seconds = std::clamp<rlim_t>(own(RLIMIT_CPU) - 1, 1, seconds),
            .bytes = std::min({bytes, own(RLIMIT_AS), own(RLIMIT_FSIZE)})};
}

/// A started importer; it is ended where this is left early.
class Child {
  public:
    Child(const fs::path& file, std::vector<std::string> words, int input, int output) : program_(file.string()) {
        const std::string& program = program_;
        std::vector<char*> arguments{program_.data()};
        for (std::string& word : words) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, input, 0);
        posix_spawn_file_actions_adddup2(&files, output, 1);
        posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
        // A process group of its own: Ctrl-C reaches this process alone, which then ends the other. What passes a limit
        // ends it, though this process goes on.
        sigset_t limits;
        sigemptyset(&limits);
        sigaddset(&limits, SIGXCPU);
        sigaddset(&limits, SIGXFSZ);
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
        posix_spawnattr_setpgroup(&attributes, 0);
        posix_spawnattr_setsigdefault(&attributes, &limits);
        const int failed = posix_spawn(&pid_, program.c_str(), &files, &attributes, arguments.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
        if (failed) throw Error(program, Message("cannot be started: {}", system_message(failed)));
    }
    ~Child() { end(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    void limit(const Cost& cost) const {
        limit(RLIMIT_CORE, 0, 0);
        limit(RLIMIT_CPU, cost.seconds, cost.seconds + 1);  // SIGXCPU, which gives the reason, before SIGKILL
        limit(RLIMIT_FSIZE, cost.bytes, cost.bytes);
        if (!kSanitised) limit(RLIMIT_AS, cost.bytes, cost.bytes);  // its shadow memory is larger than any limit
    }

    /// Its status as of `waitpid`; nothing where patience ends. Throws `Cancelled` where the program is to stop.
    std::optional<int> wait(std::chrono::seconds patience) {
        const auto latest = std::chrono::steady_clock::now() + patience;
        int status = 0;
        for (std::chrono::microseconds pause{500};; pause = std::min(2 * pause, std::chrono::microseconds{20'000})) {
            const pid_t ended = waitpid(pid_, &status, WNOHANG);
            if (ended == pid_) return pid_ = 0, status;
            if (ended < 0 && errno != EINTR) return pid_ = 0, 0;  // SIGCHLD is ignored here: its output decides
            check_interrupt();
            if (std::chrono::steady_clock::now() > latest) return end(), std::nullopt;
            std::this_thread::sleep_for(pause);
        }
    }

  private:
    void limit(__rlimit_resource what, rlim_t soft, rlim_t hard) const {
        const rlimit bounds{soft, hard};
        if (prlimit(pid_, what, &bounds, nullptr) == 0 || errno == ESRCH) return;
        const int failed = errno;
        rlimit own{};  // that it has set itself by now: a lower one cannot be raised, and needs not
        if (failed == EPERM && prlimit(pid_, what, nullptr, &own) == 0 && own.rlim_max < hard) return;
        throw Error(program_, Message("cannot be limited: {}", system_message(failed)));
    }
    /// With what it started itself.
    void end() {
        if (pid_ <= 0) return;
        kill(-pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
        pid_ = 0;
    }

    std::string program_;
    pid_t pid_ = 0;
};

/// Why nothing was read, of an importer that did not end by itself or whose patience ended.
Message failure(std::optional<int> status, const Cost& cost) {
    if (!status) return "is damaged: reading it does not come to an end";
    switch (WTERMSIG(*status)) {
        case SIGXCPU:
            return Message("is damaged: reading it took more than {} s", cost.seconds);
        case SIGXFSZ:
            return Message("is damaged: reading it gave more than {} MiB", cost.bytes / kMebibyte);
        case SIGKILL:
            return "cannot be read: its reader was ended from outside; is memory short?";
        default:
            return "is damaged: reading it failed";
    }
}

/// What the importer says, in words that have a translation. It may be damaged itself: its own words are compared.
Message fault_of(std::string_view words) {
    for (const char* own : kImportFaults)
        if (words == own) return Message(own);
    for (const char* own : kCadFaults)
        if (words == own) return Message(own);
    return Message("cannot be read: {}", library_fault(words));
}

mesh::PolygonSoup read_import(const Importer& importer, std::vector<std::string> words, const std::vector<char>& bytes,
                              const fs::path& path) {
    const std::string name = path.string();
    const Cost cost = cost_of(bytes.size(), importer);
    const MemoryFile input, output;
    input.write_all(bytes);
    Child child(find_program(importer), std::move(words), input.fd(), output.fd());
    child.limit(cost);
    const std::optional<int> status = child.wait(cost.patience());
    if (!status || WIFSIGNALED(*status)) throw Error(name, failure(status, cost));
    const std::vector<char> result = output.read_all();
    constexpr std::string_view kFault = "fault: ";
    const std::string_view said(result.data(), result.size());
    if (said.starts_with(kFault)) throw Error(name, fault_of(said.substr(kFault.size())));
    if (WEXITSTATUS(*status) != 0) throw Error(name, "is damaged: reading it failed");
    return soup_of(unpack_scene(result, name), path);
}

}  // namespace

mesh::PolygonSoup read_fbx(const std::vector<char>& bytes, const fs::path& path) {
    return read_import(kMeshes, {"fbx"}, bytes, path);
}

mesh::PolygonSoup read_dae(const std::vector<char>& bytes, const fs::path& path) {
    return read_import(kMeshes, {"dae"}, bytes, path);
}

mesh::PolygonSoup read_cad(CadFormat format, const std::vector<char>& bytes, const fs::path& path,
                           const CadReading& how) {
    std::array<char, 32> chord{};
    const auto end = std::to_chars(chord.data(), chord.data() + chord.size(), how.chord).ptr;
    return read_import(kCad,
                       {format == CadFormat::step ? "stp" : "igs", std::string(chord.data(), end),
                        how.groups == CadGroups::faces ? "faces" : "bodies"},
                       bytes, path);
}

}  // namespace tuft::io
