#include "io/model/read_import.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <string_view>
#include <thread>

#include "core/error.h"
#include "core/system/files.h"
#include "core/system/interrupt.h"
#include "core/text/text.h"
#include "io/model/file_scene.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

constexpr const char* kProgram = "tuft-import";
constexpr std::size_t kMebibyte = std::size_t{1} << 20;

const fs::path& importer() {
    static const fs::path found = [] {
        std::error_code ec;
        std::vector<fs::path> places;
        const fs::path program = fs::read_symlink("/proc/self/exe", ec).parent_path();
        if (!ec) {
            places.push_back(program / kProgram);
            places.push_back(program.parent_path() / TUFT_LIBDIR / "tuft" / kProgram);
        }
        places.push_back(data_folder().parent_path().parent_path() / TUFT_LIBDIR / "tuft" / kProgram);
        places.emplace_back(TUFT_IMPORT_BUILT);
        std::string tried;
        for (const fs::path& place : places) {
            if (access(place.c_str(), X_OK) == 0) return place;
            tried += (tried.empty() ? "" : ", ") + place.string();
        }
        throw Error(Message("{}, which reads FBX and DAE, is not there (looked for {})", std::string(kProgram), tried));
    }();
    return found;
}

/// A file without a name, in memory.
class MemoryFile {
  public:
    MemoryFile() : fd_(memfd_create("tuft", MFD_CLOEXEC)) {
        if (fd_ < 0) throw Error(Message("no memory for a file: {}", std::strerror(errno)));
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

/// A started importer; it is ended where this is left early.
class Child {
  public:
    Child(const char* format, std::size_t seconds, std::size_t memory, int input, int output) {
        const std::string program = importer().string(), s = std::to_string(seconds), m = std::to_string(memory);
        std::string name = format;
        char* const arguments[] = {const_cast<char*>(program.c_str()), name.data(), const_cast<char*>(s.c_str()),
                                   const_cast<char*>(m.c_str()), nullptr};
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_adddup2(&files, input, 0);
        posix_spawn_file_actions_adddup2(&files, output, 1);
        posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
        // A process group of its own: Ctrl-C reaches this process alone, which then ends the other.
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        posix_spawnattr_setpgroup(&attributes, 0);
        const int failed = posix_spawn(&pid_, program.c_str(), &files, &attributes, arguments, environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
        if (failed) throw Error(program, Message("cannot be started: {}", std::strerror(failed)));
    }
    ~Child() {
        if (pid_ <= 0) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Its status as of `waitpid`. Throws `Cancelled` where the program is to stop.
    int wait() {
        int status = 0;
        for (std::chrono::microseconds pause{500};; pause = std::min(2 * pause, std::chrono::microseconds{20'000})) {
            const pid_t ended = waitpid(pid_, &status, WNOHANG);
            if (ended == pid_) return pid_ = 0, status;
            if (ended < 0 && errno != EINTR) return pid_ = 0, -1;
            check_interrupt();
            std::this_thread::sleep_for(pause);
        }
    }

  private:
    pid_t pid_ = 0;
};

mesh::PolygonSoup read_import(const char* format, const std::vector<char>& bytes, const fs::path& path) {
    const std::string name = path.string();
    // A sound file of a million triangles has 40 MB and takes 3 s and 1 GB.
    const std::size_t seconds = 20 + bytes.size() / kMebibyte / 2;
    const std::size_t memory = (std::size_t{1} << 30) + 64 * bytes.size();
    const MemoryFile input, output;
    input.write_all(bytes);
    const int status = Child(format, seconds, memory, input.fd(), output.fd()).wait();
    if (status < 0 || WIFSIGNALED(status)) {
        const int signal = status < 0 ? 0 : WTERMSIG(status);
        throw Error(name, signal == SIGXCPU || signal == SIGKILL
                              ? Message("is damaged: reading it took more than {} s", seconds)
                              : Message("is damaged: reading it failed"));
    }
    const std::vector<char> result = output.read_all();
    if (WEXITSTATUS(status) == 0) return soup_of(unpack_scene(result, name), path);
    std::string_view fault(result.data(), result.size());
    if (!fault.starts_with("fault: ")) throw Error(name, "is damaged: reading it failed");
    throw Error(name, excerpt(fault.substr(7), 200));
}

}  // namespace

mesh::PolygonSoup read_fbx(const std::vector<char>& bytes, const fs::path& path) {
    return read_import("fbx", bytes, path);
}

mesh::PolygonSoup read_dae(const std::vector<char>& bytes, const fs::path& path) {
    return read_import("dae", bytes, path);
}

}  // namespace tuft::io
