#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "variants/plan.h"
#include "variants/result.h"

/// \file
/// The folder of a plan's tasks and results, shared by any number of processes and machines:
///
///     plan.json          name, folder of the plan, hashes of all tasks
///     tasks/000000.json  a task (task.h); its file is locked while one process paints it
///     results/HASH/      result.json, coverage.bin, picture.png; made beside its place and renamed
///     results/HASH.failed  why a task cannot be painted
///
/// A task is done when results/HASH exists: a killed process leaves nothing that counts. Plans that share tasks share
/// their results. The folder must lie on a disk with flock, such as local ones and NFSv4.
namespace tuft::variants {

/// How far a task is.
enum class TaskState { open, done, failed };

/// A task's lock; released when it or its process ends.
class TaskLock {
  public:
    explicit TaskLock(int file) : file_(file) {}
    ~TaskLock();
    TaskLock(TaskLock&& other) noexcept : file_(other.file_) { other.file_ = -1; }
    TaskLock& operator=(TaskLock&&) = delete;

  private:
    int file_;
};

/// All functions throw `Error` for files that cannot be read or written.
class Jobs {
  public:
    /// Opens a folder made by `lay_out`.
    explicit Jobs(const std::filesystem::path& folder);

    const std::filesystem::path& folder() const { return folder_; }
    const std::filesystem::path& plan_folder() const { return plan_folder_; }  ///< in which a plan's files lie
    const std::string& name() const { return name_; }
    std::size_t size() const { return hashes_.size(); }
    const std::string& hash(std::size_t i) const { return hashes_[i]; }

    Task task(std::size_t i) const;
    TaskState state(std::size_t i) const;
    std::filesystem::path result_folder(std::size_t i) const;
    /// Returns nothing when another process has the task.
    std::optional<TaskLock> lock(std::size_t i) const;

    /// Stores a result, or why there is none; the caller holds the lock. What is there already stays.
    void store(std::size_t i, const Outcome& outcome) const;
    void store_failure(std::size_t i, const std::string& why) const;
    void forget_failure(std::size_t i) const;
    std::string failure(std::size_t i) const;

    /// Return what `store` wrote. Throw `Error` where it is damaged: files are checked against their hashes.
    Figures figures(std::size_t i) const;
    Coverage coverage(std::size_t i) const;
    bool has_picture(std::size_t i) const;
    std::filesystem::path picture(std::size_t i) const;
    /// Removes a damaged result, so that its task is open again. Returns whether there was one.
    bool remove_damaged(std::size_t i) const;

  private:
    std::filesystem::path task_file(std::size_t i) const;
    std::filesystem::path failure_file(std::size_t i) const;
    std::vector<char> checked_file(std::size_t i, const char* name) const;

    std::filesystem::path folder_, plan_folder_;
    std::string name_;
    std::vector<std::string> hashes_;
};

/// Writes the tasks of a plan into a folder, which is new, empty, or of an earlier plan; results stay. Throws `Error`
/// for any other folder.
Jobs lay_out(const Plan& plan, const std::vector<Task>& tasks, const std::filesystem::path& folder);

/// Paints a task. Throws `Error` where it cannot be painted.
using PaintTask = std::function<Outcome(const Task& task)>;

/// What running a task came to.
enum class TaskResult {
    painted,
    done_before,
    taken,  ///< by another process
    failed,
};

/// Runs a task that is not done: locks it, checks that its files are those that it was made for (`known`:
/// `contents_of`), paints it and stores the result or the failure. Other exceptions than `Error` pass; the task stays
/// open then.
TaskResult run_task(const Jobs& jobs, std::size_t i, const PaintTask& paint, ContentHashes& known);

}  // namespace tuft::variants
