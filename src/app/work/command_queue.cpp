#include "app/work/command_queue.h"

#include <utility>

namespace tuft::app {

void CommandQueue::post(Command command) {
    {
        const std::lock_guard lock(mutex_);
        queue_.push_back(std::move(command));
    }
    wake_.notify_all();
}

void CommandQueue::close() {
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
    }
    wake_.notify_all();
}

bool CommandQueue::idle() const {
    const std::lock_guard lock(mutex_);
    return queue_.empty() && !working_;
}

void CommandQueue::wait_idle(double seconds) const {
    std::unique_lock lock(mutex_);
    rests_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return queue_.empty() && !working_; });
}

std::size_t CommandQueue::waiting() const {
    const std::lock_guard lock(mutex_);
    return queue_.size() + (working_ ? 1 : 0);
}

bool CommandQueue::pending() const {
    const std::lock_guard lock(mutex_);
    return !queue_.empty();
}

bool CommandQueue::interrupts() const {
    const std::lock_guard lock(mutex_);
    return closed_ || !queue_.empty();
}

bool CommandQueue::join(ExtendStroke& command, double seconds) {
    const std::lock_guard lock(mutex_);
    for (;;) {
        ExtendStroke* next = queue_.empty() ? nullptr : std::get_if<ExtendStroke>(&queue_.front());
        if (!next) return false;
        std::vector<brush::Pose>& poses = command.poses;
        if (!poses.empty() && !next->poses.empty() && next->poses.back().time - poses.front().time > seconds)
            return true;
        poses.insert(poses.end(), next->poses.begin(), next->poses.end());
        command.requested_at = next->requested_at;
        queue_.pop_front();
    }
}

CommandQueue::Next CommandQueue::wait(Command& command, std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    working_ = false;
    if (queue_.empty()) rests_.notify_all();
    const bool due = wake_.wait_for(lock, patience, [this] { return closed_ || !queue_.empty(); });
    working_ = true;
    if (!due) return Next::nothing;
    if (queue_.empty()) return Next::closed;
    command = std::move(queue_.front());
    queue_.pop_front();
    return Next::command;
}

}  // namespace tuft::app
