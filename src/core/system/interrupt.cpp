#include "core/system/interrupt.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <system_error>
#include <vector>

#include "core/error.h"

namespace tuft {
namespace {

std::atomic<bool> g_interrupted{false};

struct List {
    std::mutex mutex;
    std::vector<std::filesystem::path> paths;
};

List& unfinished() {
    static auto* list = new List;  // outlives every thread that may look at it
    return *list;
}

}  // namespace

void request_interrupt() noexcept {
    g_interrupted.store(true, std::memory_order_relaxed);
}
bool interrupted() noexcept {
    return g_interrupted.load(std::memory_order_relaxed);
}
void check_interrupt() {
    if (interrupted()) throw Cancelled();
}

Unfinished::Unfinished(std::filesystem::path path) : path_(std::filesystem::absolute(path)) {
    List& list = unfinished();
    const std::lock_guard lock(list.mutex);
    list.paths.push_back(path_);
}

Unfinished::~Unfinished() {
    List& list = unfinished();
    const std::lock_guard lock(list.mutex);
    const auto at = std::find(list.paths.begin(), list.paths.end(), path_);
    if (at != list.paths.end()) list.paths.erase(at);
}

void remove_unfinished() noexcept {
    List& list = unfinished();
    const std::lock_guard lock(list.mutex);
    std::error_code ignored;
    for (const std::filesystem::path& path : list.paths) {
        std::filesystem::remove_all(path, ignored);
        std::filesystem::remove(path.string() + "-journal", ignored);  // SQLite's, of a project
    }
}

}  // namespace tuft
