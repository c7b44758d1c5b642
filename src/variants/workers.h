#pragma once

#include <string>
#include <vector>

#include "core/system/progress.h"
#include "variants/jobs.h"

/// \file
/// Tasks on all cores of this machine: worker processes that may end at any time, and the process that starts them.
namespace tuft::variants {

/// What a worker says of a task on its standard output, one line each: "start 17", "painted 17", "failed 17".
/// `report_result` writes one; it returns false where nobody reads it.
bool report_start(std::size_t i);
bool report_result(std::size_t i, TaskResult ran);

/// Worker processes to start.
struct WorkerOptions {
    std::vector<std::string> command;  ///< a worker's command line; command[0] is a path. It runs all open tasks that
                                       ///< no other process has
    int workers = 1;
    ProgressFn progress;  ///< called several times a second
};

/// What the workers did.
struct WorkersReport {
    std::size_t painted = 0, failed = 0;  ///< by these workers
    std::size_t ended = 0;                ///< workers that were killed or crashed, and were replaced
    std::size_t open = 0;                 ///< tasks that other processes have still
};

/// Runs the open tasks of `jobs` by worker processes until none is left. A worker that ends early is replaced; a task
/// at which five crashed, or a hundred were killed, is marked as failed. Throws `Cancelled` when `progress` stops it,
/// and `Error` where workers cannot be started; the workers are ended first.
WorkersReport run_workers(const Jobs& jobs, const WorkerOptions& options);

/// Runs every open task that no other process has, in order, as a worker: with reports where `reports`. Returns how
/// many were painted and failed.
WorkersReport run_open_tasks(const Jobs& jobs, const PaintTask& paint, bool reports);

}  // namespace tuft::variants
