#include "variants/workers.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <list>
#include <map>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "core/files/system_message.h"
#include "core/system/interrupt.h"

namespace tuft::variants {
namespace {

constexpr int kMostCrashes = 5;  // workers that one task may end
constexpr int kMostKills = 100;  // workers that others may end at one task; for want of memory the system does, too
constexpr int kMostIdleEnds = 5;
constexpr int kPollMs = 100;
constexpr std::size_t kLongestLine = 100;  // bytes

bool write_line(const std::string& line) {
    return ::write(STDOUT_FILENO, line.data(), line.size()) == static_cast<ssize_t>(line.size());
}

/// A started worker and the pipe from its standard output.
class Worker {
  public:
    explicit Worker(const std::vector<std::string>& command) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw Error(Message("no pipe: {}", system_message(errno)));
        pipe_ = ends[0];
        std::vector<char*> arguments;
        arguments.reserve(command.size() + 1);
        for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&files, ends[1], 1);
        posix_spawn_file_actions_addopen(&files, 2, "/dev/null", O_WRONLY, 0);
        // A process group of its own: Ctrl-C reaches this process alone, which then ends the workers.
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
        posix_spawnattr_setpgroup(&attributes, 0);
        const int failed = posix_spawn(&pid_, arguments[0], &files, &attributes, arguments.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
        ::close(ends[1]);
        if (!failed) return;
        ::close(pipe_);
        throw Error(command[0], Message("cannot be started: {}", system_message(failed)));
    }
    ~Worker() {
        if (pid_ > 0) {
            ::kill(pid_, SIGTERM);
            wait();
        }
        ::close(pipe_);
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    int pipe() const { return pipe_; }
    /// The task that it has begun and not ended.
    std::optional<std::size_t> task;

    /// Reads what there is and calls `line` for each whole line. Returns false at the end.
    template <class Fn>
    bool read_lines(Fn&& line) {
        char buffer[4096];
        const ssize_t n = ::read(pipe_, buffer, sizeof buffer);
        if (n < 0 && errno == EINTR) return true;
        if (n <= 0) return false;
        text_.append(buffer, static_cast<std::size_t>(n));
        for (std::size_t end; (end = text_.find('\n')) != std::string::npos; text_.erase(0, end + 1))
            line(std::string_view(text_).substr(0, end));
        if (text_.size() > kLongestLine) text_.clear();
        return true;
    }
    /// Waits for the end of the process; returns its status as of `waitpid`.
    int wait() {
        int status = 0;
        while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
        }
        pid_ = -1;
        return status;
    }

  private:
    pid_t pid_ = -1;
    int pipe_ = -1;
    std::string text_;
};

std::string end_of(int status) {
    return WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                               : fmt::format("exit status {}", WEXITSTATUS(status));
}

class Crew {
  public:
    Crew(const Jobs& jobs, const WorkerOptions& options) : jobs_(jobs), options_(options) {
        for (std::size_t i = 0; i < jobs.size(); ++i)
            if (jobs.state(i) == TaskState::open) ++open_;
    }

    WorkersReport run() {
        const auto n = std::min<std::size_t>({open_, static_cast<std::size_t>(std::max(options_.workers, 1)), 1024});
        for (std::size_t i = 0; i < n; ++i) workers_.emplace_back(options_.command);
        while (!workers_.empty()) {
            report(options_.progress, "variants", done());
            check_interrupt();
            wait_for_lines();
        }
        for (std::size_t i = 0; i < jobs_.size(); ++i)
            if (jobs_.state(i) == TaskState::open) ++report_.open;
        return report_;
    }

  private:
    double done() const {
        return static_cast<double>(report_.painted + report_.failed) /
               static_cast<double>(std::max(open_, std::size_t{1}));
    }

    void wait_for_lines() {
        std::vector<pollfd> pipes;
        for (const Worker& w : workers_) pipes.push_back({w.pipe(), POLLIN, 0});
        if (::poll(pipes.data(), pipes.size(), kPollMs) <= 0) return;
        std::size_t i = 0;
        for (auto w = workers_.begin(); w != workers_.end(); ++i) {
            const auto now = w++;
            if (i >= pipes.size() || pipes[i].revents == 0) continue;
            if (!now->read_lines([&](std::string_view line) { take_line(*now, line); })) bury(now);
        }
    }

    void take_line(Worker& worker, std::string_view line) {
        const std::size_t space = line.find(' ');
        if (space == std::string_view::npos) return;
        std::size_t i = 0;
        const auto [end, fault] = std::from_chars(line.data() + space + 1, line.data() + line.size(), i);
        if (fault != std::errc{} || i >= jobs_.size()) return;
        const std::string_view what = line.substr(0, space);
        worker.task.reset();
        if (what == "start") worker.task = i;
        if (what == "painted") ++report_.painted, without_task_ = 0;
        if (what == "failed") ++report_.failed, without_task_ = 0;
    }

    void bury(std::list<Worker>::iterator worker) {
        const int status = worker->wait();
        const std::optional<std::size_t> task = worker->task;
        workers_.erase(worker);
        if (WIFEXITED(status) && !task) return;  // it found nothing more to do
        ++report_.ended;
        if (!task && ++without_task_ > kMostIdleEnds)
            throw Error(fmt::format("workers end at once, with {}; try 'tuft run-task {} 0'", end_of(status),
                                    jobs_.folder().string()));
        if (task && jobs_.state(*task) == TaskState::open && is_enough(*task, status)) {
            jobs_.store_failure(*task, fmt::format("its workers end each time, the last with {}", end_of(status)));
            ++report_.failed;
        }
        workers_.emplace_back(options_.command);
    }

    bool is_enough(std::size_t task, int status) {
        const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        const bool killed =
            signal == 0 || signal == SIGKILL || signal == SIGTERM || signal == SIGHUP || signal == SIGINT;
        return killed ? ++kills_[task] >= kMostKills : ++crashes_[task] >= kMostCrashes;
    }

    const Jobs& jobs_;
    const WorkerOptions& options_;
    std::list<Worker> workers_;
    std::map<std::size_t, int> crashes_, kills_;  // by task
    int without_task_ = 0;                        // workers that ended before they began a task, one after the other
    std::size_t open_ = 0;                        // tasks at the start
    WorkersReport report_;
};

}  // namespace

bool report_start(std::size_t i) {
    return write_line(fmt::format("start {}\n", i));
}
bool report_result(std::size_t i, TaskResult ran) {
    return write_line(fmt::format("{} {}\n",
                                  ran == TaskResult::painted  ? "painted"
                                  : ran == TaskResult::failed ? "failed"
                                                              : "left",
                                  i));
}

WorkersReport run_workers(const Jobs& jobs, const WorkerOptions& options) {
    return Crew(jobs, options).run();
}

WorkersReport run_open_tasks(const Jobs& jobs, const PaintTask& paint, bool reports) {
    WorkersReport out;
    ContentHashes known;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        check_interrupt();
        if (jobs.state(i) != TaskState::open) continue;
        const PaintTask begun = [&](const Task& task) {
            if (reports && !report_start(i)) throw Cancelled();
            return paint(task);
        };
        const TaskResult ran = run_task(jobs, i, begun, known);
        if (ran == TaskResult::painted) ++out.painted;
        if (ran == TaskResult::failed) ++out.failed;
        if (ran == TaskResult::taken) ++out.open;
        if (reports && !report_result(i, ran)) throw Cancelled();
    }
    return out;
}

}  // namespace tuft::variants
