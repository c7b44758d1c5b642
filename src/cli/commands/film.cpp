#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands/film_camera.h"
#include "cli/commands/revision.h"
#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/files/disk_cache.h"
#include "core/files/files.h"
#include "io/image/film_file.h"
#include "io/project/appearance.h"
#include "io/project/restore.h"
#include "pictures/journal_film.h"

/// `tuft film`: the journal painted again before a camera.
namespace tuft::cli {
namespace {

pictures::FilmOptions film_options(const Film& a, const stroke::Model& model, Console& console) {
    return {.seconds = a.seconds,
            .speed = a.speed,
            .frames_per_second = a.frames_per_second,
            .still_seconds = a.still_seconds,
            .brush = !a.no_brush,
            .path = camera_path(a.camera, a.replay.view, model),
            .picture = picture_options(a.replay.view, model),
            .progress = console.progress()};
}

/// Names all that the frames depend on: the options, and the content of each file that one of them names.
std::string content_of(const Film& a) {
    CacheKey key("film 1");
    std::error_code ec;
    for (const std::string& word : a.given) {
        key.add_text(word);
        if (!std::filesystem::is_regular_file(word, ec)) continue;
        const std::vector<char> bytes = read_file(word);
        key.add_array(std::span<const char>(bytes));
    }
    return "frames of a film that was not finished: " + fmt::format("{:016x}{:016x}\n", key.high(), key.low());
}

void print_result(const Film& a, const pictures::FilmLength& length) {
    if (a.common.json)
        print_json(nlohmann::json{{"project", a.replay.project.string()},
                                  {"wrote", a.output.string()},
                                  {"frames", length.frames},
                                  {"seconds", length.frames / a.frames_per_second},
                                  {"work_seconds", length.work_seconds}});
    else
        fmt::print("filmed {:.0f} s of work in {} frames, {:.1f} s\nwrote {}\n", length.work_seconds, length.frames,
                   length.frames / a.frames_per_second, a.output.string());
}

}  // namespace

int run(const Film& a) {
    if (!a.output.extension().empty() && !io::is_film_file(a.output))
        throw UsageError(a.output.string() + ": a film is .mp4, .gif or a folder, whose name has no extension");
    io::check_film(a.output);
    if (io::is_film_file(a.output))
        check_output(a.output);
    else
        check_folder(a.output);
    Console console(a.common.quiet);
    const auto project = open_project(a.replay.project, io::Access::read, console, model_cache(a.replay.surface));
    const stroke::Model model = replay_model(a.replay, *project, console);
    stroke::Document painting(model, {.tip_lags = tip_lag_cache(a.replay.surface)});
    painting.use(project->substrate);
    io::use_presets(project->file, painting);
    io::apply_recolouring(project->file, painting);
    std::vector<stroke::JournalEntry> entries = replay_strokes(a.replay, *project, painting).followed;
    const pictures::FilmOptions options = film_options(a, model, console);
    const pictures::FilmLength length = pictures::measure_film(entries, options);
    io::write_film(a.output,
                   {.width = a.replay.view.width,
                    .height = a.replay.view.height,
                    .frames_per_second = a.frames_per_second,
                    .content = content_of(a)},
                   [&](io::FilmSink& sink) { pictures::film_journal(painting, std::move(entries), options, sink); });
    console.clear();
    print_result(a, length);
    return 0;
}

}  // namespace tuft::cli
