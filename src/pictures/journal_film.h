#pragma once

#include <vector>

#include "io/image/film_file.h"
#include "render/picture/camera_path.h"
#include "render/picture/picture.h"
#include "stroke/document/document.h"

/// \file
/// A journal painted again before a camera, as a time-lapse with the bent tuft in it. Called by `tuft film` and by the
/// studio. Any thread that has the document.
namespace tuft::pictures {

/// What is filmed, and how.
struct FilmOptions {
    double seconds = 20;  ///< length without the end
    double speed = 0;  ///< instead: times as fast as the hand, whose strokes count as 0.2 to 8 s each; 0: by `seconds`
    double frames_per_second = 25;
    double still_seconds = 2;        ///< of the finished work at the end
    bool brush = true;               ///< the brush of the stroke in work is in the picture
    render::CameraPath path;         ///< at least one key
    render::PictureOptions picture;  ///< size and lights of the frames; its view and samples are those of the last one
    ProgressFn progress;
};

/// Length of a film.
struct FilmLength {
    int frames = 0;           ///< with those of the end
    double work_seconds = 0;  ///< for which the hand was at work
};

/// Returns the length of a film. Throws `Error` where nothing is painted or it would last more than ten hours.
FilmLength measure_film(const std::vector<stroke::JournalEntry>& entries, const FilmOptions& options);

/// Paints the entries with `painting`, which has no journal yet, and gives the frames to `sink`. Frame k of n shows the
/// state after k/(n − 1) of the work. The last frame shows the finished work, to the bit as `render_with_glass` draws
/// it from the path's end. Where the camera stands only the pixels that read a changed tile are drawn anew. Frames from
/// which it moves on have fewer rays and interpolated light (`PictureOptions::light_step`). The same frames for any
/// number of threads. Throws what `sink` throws, and `Cancelled`.
void film_journal(stroke::Document& painting, std::vector<stroke::JournalEntry> entries, const FilmOptions& options,
                  io::FilmSink& sink);

}  // namespace tuft::pictures
