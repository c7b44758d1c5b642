#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/system/progress.h"

/// \file
/// The lock of a project: one process at a time may change it. Called by `Project` and, before long work, by `cli`.
/// Any thread.
namespace tuft::io {

/// The process that holds a project, as its lock file states.
struct LockHolder {
    std::string program;  ///< such as "tuft-studio"; empty: not stated
    long process = 0;     ///< its id on `host`; 0: not stated
    std::string host;     ///< empty: this machine
};

/// Returns "tuft-studio (process 4242)", "tuft (process 17 on workbench)" or "another program".
Message name_of(const LockHolder& holder);

/// Another process holds the project. The message names the process and the remedy.
class ProjectInUse : public Error {
  public:
    ProjectInUse(const std::filesystem::path& project, LockHolder holder);
    const LockHolder& holder() const { return holder_; }

  private:
    LockHolder holder_;
};

/// The right of this process to change a project. Copies share it; all locks of the process on one project are one
/// lock.
///
/// It is an advisory lock (flock) on the hidden file .NAME.lock beside the project, symbolic links resolved. The file
/// states program, process and host. The system releases the lock however the process ends. The file of a killed
/// process is reused; the last owner removes it. `Project::changed_outside` detects programs that ignore the lock.
class ProjectLock {
  public:
    /// Takes the lock. The project need not exist. Waits at most `patience` for another program to end, except for the
    /// studio. Throws `ProjectInUse`; `Error` when the folder is not writable or its file system has no locks;
    /// `Cancelled`.
    explicit ProjectLock(const std::filesystem::path& project, std::chrono::milliseconds patience = {},
                         const ProgressFn& progress = {});

  private:
    class File;
    std::shared_ptr<File> file_;
};

}  // namespace tuft::io
