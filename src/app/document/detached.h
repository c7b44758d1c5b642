#pragma once

#include <chrono>
#include <future>
#include <thread>
#include <type_traits>
#include <utility>

/// \file
/// Work on files that may never answer, such as those of a network disk that is gone. Any thread.
namespace tuft::app {

/// Runs `work` on a thread that nobody waits for: unlike that of `std::async`, the result can be dropped before it is
/// there. `work` owns all that it uses.
template <typename Work>
std::future<std::invoke_result_t<Work>> run_detached(Work work) {
    std::packaged_task<std::invoke_result_t<Work>()> task(std::move(work));
    std::future<std::invoke_result_t<Work>> result = task.get_future();
    std::thread(std::move(task)).detach();
    return result;
}

/// Called before the result is dropped: work that is nearly done ends first, so that none runs when the program ends;
/// work that never answers is left alone after 0.2 s.
template <typename Result>
void wait_briefly(const std::future<Result>& work) {
    if (work.valid()) work.wait_for(std::chrono::milliseconds(200));
}

}  // namespace tuft::app
