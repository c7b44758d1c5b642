#include "app/document/pictures/state_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <tuple>

#include "core/error.h"
#include "core/files/files.h"
#include "core/hash.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::size_t kRecentFiles = 12;

fs::path made(fs::path folder) {
    std::error_code ec;
    fs::create_directories(folder, ec);
    return folder;
}

void write_lines(const fs::path& path, const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += line + '\n';
    write_file(path, text.data(), text.size());
}

std::vector<std::string> read_lines(const fs::path& path) {
    std::vector<std::string> lines;
    std::ifstream in(path);
    for (std::string line; lines.size() < 100 && std::getline(in, line);) lines.push_back(line);
    return lines;
}

// Seconds since 1970; 0 where the file does not say it.
std::int64_t changed_at(const fs::path& file) {
    struct stat status {};
    return ::stat(file.c_str(), &status) == 0 ? static_cast<std::int64_t>(status.st_mtime) : 0;
}

// True when no living program holds the note's lock.
bool abandoned(const fs::path& note) {
    const int file = ::open(note.c_str(), O_RDWR | O_CLOEXEC);
    if (file < 0) return false;
    const bool free = ::flock(file, LOCK_EX | LOCK_NB) == 0;
    ::close(file);
    return free;
}

}  // namespace

fs::path state_folder() {
    fs::path base;
    if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
        base = state;
    else if (const char* home = std::getenv("HOME"); home && *home)
        base = fs::path(home) / ".local" / "state";
    const fs::path folder = made(base / "tuft");
    if (!base.empty() && ::access(folder.c_str(), W_OK) == 0) return folder;
    std::error_code ec;
    const fs::path temporary = fs::temp_directory_path(ec);
    return made((ec ? fs::path("/tmp") : temporary) / ("tuft-" + std::to_string(::getuid())));
}

SessionNote::SessionNote() {
    const fs::path folder = made(state_folder() / "sessions");
    path_ = folder / (std::to_string(::getpid()) + ".note");
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file_ >= 0) ::flock(file_, LOCK_EX | LOCK_NB);
    clear();
}

SessionNote::~SessionNote() {
    if (file_ < 0) return;
    if (::lseek(file_, 0, SEEK_END) == 0) ::unlink(path_.c_str());
    ::close(file_);
}

fs::path SessionNote::new_project(const std::string& name) {
    fs::path path;
    do
        path = made(state_folder() / "sessions") /
               (name + "-" + std::to_string(::getpid()) + "-" + std::to_string(++made_) + ".tuft");
    while (fs::exists(path));
    return path;
}

void SessionNote::write(const fs::path& project, const std::string& source) {
    if (file_ < 0) return;
    const std::string text = fs::absolute(project).string() + '\n' + source + '\n';
    if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, text.data(), text.size(), 0) < 0) return;
    ::fsync(file_);
}

void SessionNote::clear() {
    if (file_ >= 0 && ::ftruncate(file_, 0) != 0) return;
}

std::vector<LostWork> find_lost_work() {
    std::vector<LostWork> found;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(state_folder() / "sessions", ec)) {
        if (entry.path().extension() != ".note" || !abandoned(entry.path())) continue;
        const std::vector<std::string> lines = read_lines(entry.path());
        if (lines.size() >= 2 && fs::exists(lines[0]))
            found.push_back({entry.path(), lines[0], lines[1], changed_at(lines[0])});
        else
            fs::remove(entry.path(), ec);
    }
    std::sort(found.begin(), found.end(), [](const LostWork& a, const LostWork& b) {
        return std::tie(b.changed, a.project) < std::tie(a.changed, b.project);
    });
    return found;
}

void forget_lost_work(const LostWork& work, bool remove_project) {
    std::error_code ec;
    fs::remove(work.note, ec);
    if (remove_project && is_unnamed(work.project)) fs::remove(work.project, ec);
}

bool is_unnamed(const fs::path& project) {
    std::error_code ec;
    return !project.empty() &&
           fs::weakly_canonical(project, ec).parent_path() == fs::weakly_canonical(state_folder() / "sessions", ec);
}

std::vector<fs::path> recent_projects() {
    std::vector<fs::path> projects;
    for (const std::string& line : read_lines(state_folder() / "recent"))
        if (fs::exists(line)) projects.emplace_back(line);
    return projects;
}

void remember_project(const fs::path& project) {
    const fs::path path = fs::absolute(project);
    std::vector<std::string> lines{path.string()};
    for (const fs::path& other : recent_projects())
        if (other != path && lines.size() < kRecentFiles) lines.push_back(other.string());
    try {
        write_lines(state_folder() / "recent", lines);
    } catch (const Error&) {
        // Only the list of recent projects is older then.
    }
}

fs::path picture_path(const fs::path& file) {
    std::error_code ec;
    const std::string name = fs::absolute(file).string();
    char key[20];
    std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(hash_bytes(name.data(), name.size())));
    return made(state_folder() / "pictures") / (std::string(key) + ".png");
}

}  // namespace tuft::app
