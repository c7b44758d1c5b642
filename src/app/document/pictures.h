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

namespace tuft::app {

/// Small pictures of models and projects: read from the state folder, or drawn once in the
/// background and kept there. The textures belong to the window's context.
class Pictures {
  public:
    static constexpr int kWidth = 240, kHeight = 160;

    Pictures();
    ~Pictures();

    /// Texture with the picture of this file, 0 while there is none. Asks for it at the
    /// first call that is not made at rest.
    unsigned texture(const std::filesystem::path& file);
    /// Keeps a picture (RGB, row 0 at the top) as that of a file; it is made smaller.
    void keep(const std::filesystem::path& file, int width, int height, std::vector<std::uint8_t> rgb);
    /// Drops what has been asked for, so that the machine is free for other work.
    void rest();
    /// Takes up work again; before it, nothing new is asked for.
    void go_on() { stop_ = false; }
    bool busy() const;
    /// Frees the textures; needs the context.
    void release();

  private:
    struct Picture {
        std::vector<std::uint8_t> rgb;
        unsigned texture = 0;
        bool asked = false, fresh = false;
    };
    struct Job {
        std::string file;
        int width = 0, height = 0;
        std::vector<std::uint8_t> rgb;  ///< to be kept; empty: to be found or drawn
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
