#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// What the program remembers between runs: work in hand, recent projects, settings and
/// small pictures, under $XDG_STATE_HOME/tuft (else ~/.local/state/tuft).
namespace tuft::app {

/// The folder, made when it is not there; the system's temporary folder when it cannot be.
std::filesystem::path state_folder();

/// Says which project is being worked on. While the program runs it holds a lock on the
/// note; a note without a lock was left by a program that was killed.
class SessionNote {
  public:
    SessionNote();
    ~SessionNote();
    SessionNote(const SessionNote&) = delete;
    SessionNote& operator=(const SessionNote&) = delete;

    /// A fresh place for work that has no name yet.
    std::filesystem::path new_project(const std::string& name);
    void write(const std::filesystem::path& project, const std::string& source);
    /// The work is safe under a name, or there is none: nothing will be offered.
    void clear();

  private:
    std::filesystem::path path_;
    int file_ = -1;
    int made_ = 0;
};

/// Work that a killed program left behind.
struct LostWork {
    std::filesystem::path note, project;
    std::string source;
};
std::vector<LostWork> find_lost_work();
/// Takes the note away; and the project too, when it lies in the state folder.
void forget_lost_work(const LostWork& work, bool remove_project);

/// Whether this project lies in the state folder, so has no name of its own yet.
bool is_unnamed(const std::filesystem::path& project);

std::vector<std::filesystem::path> recent_projects();
void remember_project(const std::filesystem::path& project);

/// Where the small picture of a file is kept.
std::filesystem::path picture_path(const std::filesystem::path& file);

}  // namespace tuft::app
