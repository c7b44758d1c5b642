#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

/// \file
/// Small pictures of models and projects, for the start page and file dialogs.
namespace tuft::app {

/// Reads pictures from the state folder, or draws them once on a thread of its own and stores them there. Methods are
/// for the window thread; `texture` and `release` need its OpenGL context.
class Pictures {
  public:
    static constexpr int kWidth = 240, kHeight = 160;

    Pictures();
    ~Pictures();

    /// Returns the texture with the picture of a file; 0 while there is none. The first call requests it, except while
    /// paused.
    unsigned texture(const std::filesystem::path& file);
    /// Stores a picture (RGB, row 0 at the top), scaled down, as that of a file.
    void keep(const std::filesystem::path& file, int width, int height, std::vector<std::uint8_t> rgb);
    /// Drops pending requests and accepts no new ones, to free the processor for painting.
    void pause();
    /// Accepts requests again.
    void resume() { stop_ = false; }
    /// Whether pictures are still made.
    bool busy() const;
    /// Frees the textures.
    void release();

  private:
    struct Picture {
        std::vector<std::uint8_t> rgb;
        unsigned texture = 0;
        bool requested = false, fresh = false;
    };
    struct Job {
        std::string file;
        int width = 0, height = 0;
        std::vector<std::uint8_t> rgb;  ///< to store; empty: to read or draw
    };
    void run();
    std::vector<std::uint8_t> make(const Job& job);

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::map<std::string, Picture> pictures_;
    std::deque<Job> jobs_;
    bool quit_ = false, working_ = false;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace tuft::app
