#include "io/project/project_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <sstream>
#include <thread>

#include "core/files/system_message.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

constexpr std::chrono::milliseconds kLockRetry{40}, kOwnPatience{1000};
constexpr std::size_t kMostShown = 64;  // bytes of a name that is shown
constexpr const char* kStudio = "tuft-studio";

std::string host_name() {
    char name[256] = "";
    if (::gethostname(name, sizeof name - 1) != 0) return "";
    return name;
}

// A name from a file that anybody may have written.
std::string readable(std::string word) {
    std::erase_if(word, [](unsigned char c) { return c < 0x20 || c == 0x7f; });
    return word.substr(0, kMostShown);
}

LockHolder read_holder(int file) {
    char text[512] = "";
    const ssize_t size = ::pread(file, text, sizeof text - 1, 0);
    LockHolder holder;
    std::istringstream lines(std::string(text, size > 0 ? static_cast<std::size_t>(size) : 0));
    std::string process;
    if (!std::getline(lines, holder.program) || !std::getline(lines, process) || !std::getline(lines, holder.host))
        return {};
    holder.program = readable(holder.program);
    holder.host = readable(holder.host);
    holder.process = std::max(0L, std::strtol(process.c_str(), nullptr, 10));
    if (holder.host == readable(host_name())) holder.host.clear();
    return holder;
}

void write_holder(int file) {
    const std::string text =
        std::string(program_invocation_short_name) + '\n' + std::to_string(::getpid()) + '\n' + host_name() + '\n';
    // A lock without a record is a lock all the same.
    if (::ftruncate(file, 0) == 0 && ::pwrite(file, text.data(), text.size(), 0) < 0) return;
}

fs::path without_links(const fs::path& project) {
    std::error_code ec;
    const fs::path whole = fs::absolute(project, ec), real = fs::weakly_canonical(whole, ec);
    return ec || real.empty() ? whole : real;
}

bool same_file(int file, int folder, const std::string& name) {
    struct stat open {
    }, named{};
    return ::fstat(file, &open) == 0 && ::fstatat(folder, name.c_str(), &named, AT_SYMLINK_NOFOLLOW) == 0 &&
           open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

}  // namespace

Message name_of(const LockHolder& holder) {
    if (holder.program.empty()) return "another program";
    if (holder.process <= 0) return holder.program;
    if (holder.host.empty()) return Message("{} (process {})", holder.program, holder.process);
    return Message("{} (process {} on {})", holder.program, holder.process, holder.host);
}

ProjectInUse::ProjectInUse(const fs::path& project, LockHolder holder)
    : Error(project.string(),
            Message("{} is working on it; close it there, or work on a copy of the file", name_of(holder))),
      holder_(std::move(holder)) {}

/// The lock file, locked. Its folder stays open, so that it is found again when the folder is moved.
class ProjectLock::File {
  public:
    explicit File(const fs::path& project, const fs::path& real) : name_("." + real.filename().string() + ".lock") {
        folder_ = ::open(real.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
        if (folder_ < 0) {
            const std::string where = real.parent_path().string();
            throw Error(project.string(), errno == ENOENT ? Message("its folder '{}' does not exist", where)
                                                          : Message("its folder '{}' cannot be opened: {}", where,
                                                                    system_message(errno)));
        }
        try {
            while (!take(project)) {
            }
        } catch (...) {
            close();
            throw;
        }
        write_holder(file_);
    }
    ~File() {
        if (same_file(file_, folder_, name_)) ::unlinkat(folder_, name_.c_str(), 0);
        close();
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

  private:
    // False where the file went away meanwhile.
    bool take(const fs::path& project) {
        constexpr int kFlags = O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
        file_ = ::openat(folder_, name_.c_str(), kFlags | O_RDWR | O_CREAT, 0666);
        const bool foreign = file_ < 0 && errno == EACCES;  // left by another person, perhaps
        if (foreign) file_ = ::openat(folder_, name_.c_str(), kFlags | O_RDONLY);
        if (file_ < 0 && foreign && errno == ENOENT) errno = EACCES;
        if (file_ < 0) {
            if (errno == EACCES || errno == EROFS || errno == EPERM)
                throw Error(project.string(), "cannot be changed: nothing may be written into its folder");
            if (errno == ENOSPC || errno == EDQUOT)
                throw Error(project.string(), "cannot be changed: the disk is full");
            throw Error(project.string(),
                        Message("its lock file '{}' cannot be opened: {}", name_, system_message(errno)));
        }
        if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
            if (errno == EINTR) return closed_again();
            if (errno == EWOULDBLOCK) throw ProjectInUse(project, read_holder(file_));
            throw Error(project.string(), Message("cannot be locked against other programs where it lies ({}); copy it "
                                                  "to a disk of this machine and work there",
                                                  system_message(errno)));
        }
        if (!same_file(file_, folder_, name_)) return closed_again();
        if (!foreign) return true;
        // Nobody's any more, but not to be written: a new one takes its place.
        if (::unlinkat(folder_, name_.c_str(), 0) != 0)
            throw Error(project.string(),
                        Message("its lock file '{}' is another person's and cannot be removed", name_));
        return closed_again();
    }
    bool closed_again() {
        ::close(file_);
        file_ = -1;
        return false;
    }
    void close() {
        if (file_ >= 0) ::close(file_);
        ::close(folder_);
    }

    std::string name_;
    int folder_ = -1, file_ = -1;
};

ProjectLock::ProjectLock(const fs::path& project, std::chrono::milliseconds patience, const ProgressFn& progress) {
    static std::mutex mutex;
    static std::map<fs::path, std::weak_ptr<File>> held;
    const fs::path real = without_links(project);
    const auto start = std::chrono::steady_clock::now();
    for (;;) {
        try {
            const std::lock_guard guard(mutex);
            std::weak_ptr<File>& mine = held[real];
            file_ = mine.lock();
            if (!file_) mine = file_ = std::make_shared<File>(project, real);
            return;
        } catch (const ProjectInUse& in_use) {
            // This process may be about to let go of it on another thread.
            const LockHolder& holder = in_use.holder();
            const bool own = holder.process == ::getpid() && holder.host.empty();
            const auto longest = own                         ? std::max(patience, kOwnPatience)
                                 : holder.program == kStudio ? std::chrono::milliseconds{}
                                                             : patience;
            if (std::chrono::steady_clock::now() - start >= longest) throw;
        }
        report(progress, "reading", 0);
        std::this_thread::sleep_for(kLockRetry);
    }
}

}  // namespace tuft::io
