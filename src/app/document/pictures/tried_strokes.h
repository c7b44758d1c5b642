#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <future>
#include <map>
#include <string>
#include <vector>

#include "app/document/pictures/small_picture.h"
#include "core/files/disk_cache.h"
#include "pictures/tried_stroke.h"

/// \file
/// Pictures of a stroke of each brush (pictures/tried_stroke.h). Window thread; strokes are painted on another one.
namespace tuft::app {

/// Paints a stroke of a brush when its picture is first asked for, one at a time, and stores it in the user's cache
/// folder by the content of the preset without its name. One that is not stored is painted when nothing else was to do
/// for a second: a program that starts, and a hand that paints, have the processor for themselves. `texture` and
/// `release` need the window's OpenGL context.
class TriedStrokes {
  public:
    TriedStrokes() : cache_(cache_folder("brushes")) {}
    ~TriedStrokes();

    /// Returns the texture of the brush's picture; 0 while there is none. `reading`: another number where the brush may
    /// be another one than at the last call; the picture is then painted anew.
    unsigned texture(const std::string& brush, std::uint64_t reading);
    /// Takes what was painted, and begins the next one where `may_paint`; else stops the one in work, which is begun
    /// again later. Returns at once.
    void update(bool may_paint);
    bool busy() const { return painting_.valid() || !wanted_.empty(); }
    /// Frees the textures; they are made again from the pictures.
    void release();

  private:
    struct Picture {
        SmallPicture picture{///< empty: not painted yet, or the preset cannot be read
                             .width = pictures::TriedStroke::kWidth,
                             .height = pictures::TriedStroke::kHeight};
        unsigned texture = 0;
        std::uint64_t reading = 0;
    };
    struct PictureRequest {
        std::string brush;
        std::uint64_t reading = 0;
        bool to_paint = false;  ///< it is not stored
    };
    struct Painted {
        PictureRequest request;
        std::vector<std::uint8_t> rgb;
        bool stopped = false;
        bool missing = false;  ///< from the cache; it is painted later
    };
    Painted paint(PictureRequest request) const;
    void want(PictureRequest request);

    DiskCache cache_;
    std::map<std::string, Picture> pictures_;  ///< of all that were asked for
    std::deque<PictureRequest> wanted_;
    std::chrono::steady_clock::time_point busy_at_ = std::chrono::steady_clock::now();  ///< something else was to do
    std::atomic<bool> stop_{false};
    std::future<Painted> painting_;
};

}  // namespace tuft::app
