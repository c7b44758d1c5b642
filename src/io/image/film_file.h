#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/image/image.h"

/// \file
/// Films as files: numbered pictures in a folder, or MPEG-4 (H.264) and GIF by the program ffmpeg, where it is
/// installed. Called by `tuft film`.
namespace tuft::io {

/// Size and rate of a film.
struct FilmFormat {
    int width = 0, height = 0;  ///< pixels
    double frames_per_second = 25;
    std::string content;  ///< one line that names all that its frames depend on; empty: never continued
};

/// Takes the frames of a film in order.
class FilmSink {
  public:
    virtual ~FilmSink() = default;
    /// Whether the next frame is there from a film that was stopped. The caller then leaves it out, by `pass`.
    virtual bool has_next() const { return false; }
    virtual void pass() {}
    /// 8-bit sRGB, 3 channels, of the format's size. Throws `Error` where it cannot be written.
    virtual void add(const PixelView& frame) = 0;
};

/// Whether `path` names a film for ffmpeg: .mp4 or .gif; else it is a folder of frames.
bool is_film_file(const std::filesystem::path& path);

/// Throws `Error` where a film cannot be written there: ffmpeg is not installed, or the folder has the frames of a film
/// that was finished.
void check_film(const std::filesystem::path& path);

/// Calls `draw` with a sink for a film at `path`.
///
/// A film file is written beside its place and renamed after the last frame. ffmpeg gets raw frames through a pipe and
/// its arguments as a list; no shell is involved. It is ended where `draw` throws, and nothing is left. Odd widths and
/// heights of an .mp4 get one more column or row of black, which H.264 needs. A GIF has a palette for each frame.
///
/// A folder is made where there is none; its frames are frame-00001.png …, each written atomically. The file
/// unfinished-film.txt stands beside them until the last one and holds `format.content`. Where `draw` throws
/// `Cancelled`, or the process is killed, the frames stay, and the next film of that content goes on after them; one of
/// another content throws `Error`. After any other error the frames are removed. Throws `Error`.
void write_film(const std::filesystem::path& path, const FilmFormat& format,
                const std::function<void(FilmSink& sink)>& draw);

}  // namespace tuft::io
