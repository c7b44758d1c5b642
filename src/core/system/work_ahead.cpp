#include "core/system/work_ahead.h"

#include <tbb/task_group.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <utility>

#include "core/system/parallel.h"
#include "core/system/task_arena.h"

namespace tuft {

struct WorkAhead::State {
    enum class Worker { none, called, at_work };

    std::size_t n = 0, window = 0;
    std::function<void(std::size_t)> step;
    std::mutex mutex;  // of what follows
    std::condition_variable changed;
    std::size_t done = 0, allowed = 0;  // steps
    Worker worker = Worker::none;
    bool stopped = false;
    std::exception_ptr fault;
    tbb::task_group calls;

    // Performs steps up to `end`, as far as they are allowed. Precondition: `lock` is held, nobody is at work.
    void work(std::unique_lock<std::mutex>& lock, std::size_t end) {
        worker = Worker::at_work;
        while (done < std::min(end, allowed) && !stopped && !fault) {
            const std::size_t i = done;
            std::exception_ptr thrown;
            lock.unlock();
            try {
                const LoopsOnThisThread sequential;
                step(i);
            } catch (...) {
                thrown = std::current_exception();
            }
            lock.lock();
            if (thrown)
                fault = thrown;
            else
                ++done;
            changed.notify_all();
        }
        worker = Worker::none;
        changed.notify_all();
    }

    // Asks another thread to go on, unless one does. The caller may have done its work before it comes.
    void call() {
        {
            const std::lock_guard lock(mutex);
            if (thread_count() == 1 || worker != Worker::none || done >= allowed) return;
            worker = Worker::called;
        }
        task_arena().enqueue(calls.defer([this] {
            std::unique_lock lock(mutex);
            if (worker == Worker::called) work(lock, n);
        }));
    }
};

WorkAhead::WorkAhead(std::size_t n, std::size_t window, std::function<void(std::size_t)> step)
    : state_(std::make_unique<State>()) {
    state_->n = n;
    state_->window = window;
    state_->step = std::move(step);
}

WorkAhead::~WorkAhead() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->stopped = true;
    }
    task_arena().execute([this] { state_->calls.wait(); });
}

void WorkAhead::begin() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->allowed = std::min(state_->n, std::max(state_->allowed, state_->window));
    }
    state_->call();
}

void WorkAhead::wait(std::size_t i) {
    State& s = *state_;
    {
        std::unique_lock lock(s.mutex);
        s.allowed = std::min(s.n, std::max(s.allowed, i + 1 + s.window));
        while (s.done <= i && !s.fault) {
            if (s.worker == State::Worker::at_work)
                s.changed.wait(lock);
            else
                s.work(lock, i + 1);
        }
        if (s.fault) std::rethrow_exception(s.fault);
    }
    s.call();
}

}  // namespace tuft
