#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// \file
/// State that the program retains between runs: unsaved work, recent projects, settings and small pictures, under
/// $XDG_STATE_HOME/tuft (else ~/.local/state/tuft). Any thread.
namespace tuft::app {

/// Returns the folder and creates it when missing. Returns the system's temporary folder where that fails.
std::filesystem::path state_folder();

/// A file that names the project being worked on. The program locks it while it runs. A file without a lock was left by
/// a killed program.
class SessionNote {
  public:
    SessionNote();
    ~SessionNote();
    SessionNote(const SessionNote&) = delete;
    SessionNote& operator=(const SessionNote&) = delete;

    /// Returns an unused path for work without a name.
    std::filesystem::path new_project(const std::string& name);
    void write(const std::filesystem::path& project, const std::string& source);
    /// Removes the file: the work is saved under a name, or there is none.
    void clear();

  private:
    std::filesystem::path path_;
    int file_ = -1;
    int made_ = 0;
};

/// Work of a killed program.
struct LostWork {
    std::filesystem::path note, project;
    std::string source;
    std::int64_t changed = 0;  ///< when the project was last written, seconds since 1970
};
/// Returns what killed programs left, the latest first.
std::vector<LostWork> find_lost_work();
/// Removes the note; with `remove_project` also the project, when it is in the state folder.
void forget_lost_work(const LostWork& work, bool remove_project);

/// Returns true when the project is in the state folder, so that it has no name of its own yet.
bool is_unnamed(const std::filesystem::path& project);

/// Returns the projects opened last, the newest first.
std::vector<std::filesystem::path> recent_projects();
/// Puts the project first in that list.
void remember_project(const std::filesystem::path& project);

/// Returns the path of the stored small picture of a file.
std::filesystem::path picture_path(const std::filesystem::path& file);

}  // namespace tuft::app
