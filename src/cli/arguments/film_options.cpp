#include <algorithm>
#include <array>
#include <string_view>

#include "cli/arguments/options.h"

namespace tuft::cli {
namespace {

/// Names and values of the given options that change the frames of a film.
std::vector<std::string> given_options(const CLI::App& command) {
    constexpr std::array<std::string_view, 5> kSameFrames{"output", "threads", "json", "quiet", "no-cache"};
    std::vector<std::string> words;
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0) continue;
        const std::string name = option->get_single_name();
        if (std::find(kSameFrames.begin(), kSameFrames.end(), name) != kSameFrames.end()) continue;
        words.push_back(name);
        words.insert(words.end(), option->results().begin(), option->results().end());
    }
    return words;
}

}  // namespace

CLI::App* add_film(CLI::App& app, Film& film) {
    auto* s = app.add_subcommand("film", "film how a project was painted, as a time-lapse with the brush in it");
    s->add_option("PROJECT", film.replay.project, "project file (.tuft)")->required();
    s->add_option("-o,--output", film.output,
                  ".mp4 or .gif (by ffmpeg, where it is installed), else a folder for the frames (.png); frames that "
                  "were stopped are continued by the same command")
        ->required();
    s->final_callback([s, &film] { film.given = given_options(*s); });
    auto* seconds = s->add_option("--seconds", film.seconds, "length of the film without its end (default: 20)")
                        ->check(number_in(0.1, 3600.0));
    s->add_option("--speed", film.speed,
                  "instead: so many times as fast as the hand, whose strokes count as 0.2 to 8 s each")
        ->check(number_in(0.1, 1e4))
        ->excludes(seconds);
    s->add_option("--fps", film.frames_per_second, "frames a second (default: 25)")->check(number_in(1.0, 120.0));
    s->add_option("--end", film.still_seconds, "seconds for which the finished work is shown (default: 2)")
        ->check(number_in(0.0, 600.0));
    s->add_option("--camera", film.camera,
                  "still (default); turntable: one turn; views to stand at, each for equal times: front, right, back, "
                  "left, top, bottom or view (that of --view), such as front,top,view; or key frames (.toml)")
        ->type_name("PATH");
    s->add_flag("--no-brush", film.no_brush, "film the ink alone");
    allow_shipped(s->add_option("--model", film.replay.model, "paint onto this revised mesh instead"));
    s->add_option("--brush", film.replay.brush, "use this brush for every stroke");
    s->add_option("--ink", film.replay.ink,
                  "use this ink for every stroke: a name, a .toml file or a colour such as '#c03020'");
    add_surface(s, film.replay.surface);
    add_cache(s, film.replay.surface);
    add_camera(s, film.replay.view);
    return s;
}

}  // namespace tuft::cli
