#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/system/progress.h"

/// Who may change a project: one process at a time.
namespace tuft::io {

/// The process that has a project, as its lock file says.
struct LockHolder {
    std::string program;  ///< such as "tuft-studio"; empty: the file does not say
    long process = 0;     ///< its id on `host`; 0: the file does not say
    std::string host;     ///< empty: this machine
};

/// "tuft-studio (process 4242)", "tuft (process 17 on workbench)", "another program".
Message name_of(const LockHolder& holder);

/// Another process has the project. The message names it and says what to do.
class ProjectInUse : public Error {
  public:
    ProjectInUse(const std::filesystem::path& project, LockHolder holder);
    const LockHolder& holder() const { return holder_; }

  private:
    LockHolder holder_;
};

/// The right of this process to change a project; copies share it, and so do all locks that
/// the process takes on the same project. It is an advisory lock (flock) on the hidden file
/// .NAME.lock beside the project, links resolved, which holds program, process and host. The
/// system lets go of it however the process ends; a file that a killed process left is taken
/// over, and the last owner removes it. Programs that do not ask for it are noticed by
/// `Project::changed_outside`.
class ProjectLock {
  public:
    /// Takes the lock, also of a project that is not there yet. Waits up to `patience` for a
    /// program that is about to end: not for the studio. Throws `ProjectInUse`; `Error` when
    /// the folder cannot be written into, or its file system has no locks; `Cancelled`.
    explicit ProjectLock(const std::filesystem::path& project, std::chrono::milliseconds patience = {},
                         const ProgressFn& progress = {});

  private:
    class File;
    std::shared_ptr<File> file_;
};

}  // namespace tuft::io
