#include "io/project/commit_queue.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace tuft::io {

struct CommitQueue::State {
    explicit State(Project& to) : project(to) {}

    Project& project;
    std::mutex mutex;  // of what follows
    std::condition_variable changed;
    std::vector<stroke::JournalEntry> added;
    bool committing = false, ends = false;
    std::exception_ptr fault;
    std::thread thread;

    void commit_all() {
        std::unique_lock lock(mutex);
        for (;;) {
            changed.wait(lock, [this] { return ends || (!added.empty() && !fault); });
            if (added.empty() || fault) return;
            const std::vector<stroke::JournalEntry> strokes = std::exchange(added, {});
            committing = true;
            lock.unlock();
            std::exception_ptr thrown;
            try {
                project.append(strokes);
            } catch (...) {
                thrown = std::current_exception();
            }
            lock.lock();
            committing = false;
            fault = thrown;
            changed.notify_all();
        }
    }

    void check() const {
        if (fault) std::rethrow_exception(fault);
    }
};

CommitQueue::CommitQueue(Project& project) : state_(std::make_unique<State>(project)) {
    project.listen({});
    state_->thread = std::thread([this] { state_->commit_all(); });
}

CommitQueue::~CommitQueue() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->ends = true;
    }
    state_->changed.notify_all();
    state_->thread.join();
}

void CommitQueue::add(const stroke::JournalEntry& stroke) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->check();
        state_->added.push_back(stroke);
    }
    state_->changed.notify_all();
}

void CommitQueue::finish() {
    std::unique_lock lock(state_->mutex);
    state_->changed.wait(lock, [this] { return state_->fault || (state_->added.empty() && !state_->committing); });
    state_->check();
}

}  // namespace tuft::io
