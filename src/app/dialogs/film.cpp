#include <imgui.h>

#include <algorithm>
#include <numbers>

#include "app/dialogs/dialogs.h"

namespace tuft::app {
namespace {

struct FilmFormat {
    const char *name, *extension, *note;
};
constexpr FilmFormat kFilmFormats[] = {
    {"MP4", ".mp4", "H.264, for every player; made by the program ffmpeg"},
    {"GIF", ".gif", "For pages that show nothing else; made by the program ffmpeg"},
    {"Pictures", "", "A folder with a PNG picture for each frame"},
};

const FilmFormat& film_format(const std::string& name) {
    const auto at = std::find_if(std::begin(kFilmFormats), std::end(kFilmFormats),
                                 [&](const FilmFormat& f) { return name == f.name; });
    return at == std::end(kFilmFormats) ? kFilmFormats[0] : *at;
}

render::CameraPath film_path(const std::string& camera, const render::View& seen) {
    constexpr double kQuarter = std::numbers::pi / 2;
    const auto from = [&](double azimuth, double elevation) {
        render::View view = seen;
        view.azimuth = azimuth;
        view.elevation = elevation;
        return view;
    };
    if (camera == "Turntable") return render::turntable_path(seen);
    if (camera == "All four sides")
        return render::standing_path(
            {from(0, 0), from(kQuarter, 0), from(2 * kQuarter, 0), from(3 * kQuarter, 0), seen});
    if (camera == "Front, top, as seen now") return render::standing_path({from(0, 0), from(0, kQuarter), seen});
    return {{1, seen}};
}

/// How long the film is.
void length_rows(Ui& ui, FilmSettings& c) {
    constexpr float kWidth = 330;
    dialog_row(ui, "Length");
    static const std::vector<std::string> kinds{"Of so many seconds", "By the hand's time"};
    std::string kind = kinds[c.by_speed ? 1 : 0];
    if (ui.combo("Length", kind, kinds, 200)) c.by_speed = kind == kinds[1];
    if (c.by_speed)
        ui.named_slider("Times as fast", c.speed, {0.5, 200, "%.1f"},
                        "As the hand, whose strokes count as 0.2 to 8 s each", ui.px(kWidth));
    else
        ui.named_slider("Seconds", c.seconds, {1, 300, "%.0f s"}, "Without its end", ui.px(kWidth));
    ui.named_slider("The finished work", c.still, {0, 20, "%.0f s"}, "For so long it is shown at the end",
                    ui.px(kWidth));
}

/// The pictures of the film.
void frame_rows_of_film(Ui& ui, FilmSettings& c) {
    dialog_row(ui, "Size");
    static const std::vector<std::string> widths{"640", "1280", "1920", "3840"};
    std::string width = std::to_string(c.width);
    if (ui.combo("Film width", width, widths, 100)) {
        c.width = std::stoi(width);
        c.height = c.width * 9 / 16;
    }
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("\xc3\x97 %d", c.height);
    dialog_row(ui, "Frame rate");
    std::string rate = std::to_string(c.frames_per_second);
    if (ui.combo("Frame rate", rate, {"12", "25", "30", "50", "60"}, 100)) c.frames_per_second = std::stoi(rate);
    dialog_row(ui, "Camera");
    static const std::vector<std::string> cameras{"As seen now", "Turntable", "All four sides",
                                                  "Front, top, as seen now"};
    ui.combo("Camera", c.camera, cameras, 200);
    dialog_row(ui, "");
    ui.toggle("The brush in the picture", c.brush, "Else the ink alone");
}

}  // namespace

ExportFilm film_command(const FilmSettings& c, const Orbit& seen_from, const std::filesystem::path& path) {
    ExportFilm command{path, {}};
    pictures::FilmOptions& film = command.film;
    film.seconds = c.seconds;
    film.speed = c.by_speed ? c.speed : 0;
    film.frames_per_second = c.frames_per_second;
    film.still_seconds = c.still;
    film.brush = c.brush;
    film.picture.width = c.width;
    film.picture.height = c.height;
    film.picture.view.azimuth = seen_from.azimuth;
    film.picture.view.elevation = seen_from.elevation;
    film.path = film_path(c.camera, film.picture.view);
    return command;
}

void film_dialog(Session& s) {
    if (!s.dialogs.show_film || !s.paint_thread) return;
    if (!begin_dialog(s.ui, "Film of the work", 460)) return end_dialog(s.ui);
    Ui& ui = s.ui;
    FilmSettings& c = s.dialogs.film_settings;
    dialog_row(ui, "Format");
    std::vector<std::string> formats;
    for (const FilmFormat& format : kFilmFormats) formats.emplace_back(format.name);
    ui.combo("Format", c.format, formats, 200);
    const FilmFormat& format = film_format(c.format);
    ui.note(ui.tr(format.note));
    length_rows(ui, c);
    frame_rows_of_film(ui, c);
    end_dialog_with_file(s, s.dialogs.show_film, FileDialog::Purpose::film, format.extension);
}

}  // namespace tuft::app
