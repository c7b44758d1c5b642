#include "app/paint/film_and_sheets.h"

#include <algorithm>
#include <cstdio>

#include "io/image/film_file.h"
#include "io/sheet/sheet_files.h"

namespace tuft::app {

void export_sheets(PaintContext& context, ExportSheets command) {
    command.request.sheet.title = command.path.stem().string();
    command.request.sheet.progress = context.progress("Making decal sheets");
    const decal::Sheet sheet = io::make_painted_sheet(*context.work.document, command.request);
    const std::vector<std::filesystem::path> written = io::write_sheet(command.path, sheet);
    double strain = 0;
    for (const decal::Piece& piece : sheet.pieces) strain = std::max(strain, piece.strain);
    char percent[16];
    std::snprintf(percent, sizeof percent, "%.1f", 100 * strain);
    Message result("Pieces of film: {}, strained by {} % at most; {}", sheet.pieces.size(), std::string(percent),
                   written.front().string());
    if (sheet.left_out.fragments > 0)
        result = Message("Pieces of film: {}, strained by {} % at most, without {} fragments; {}", sheet.pieces.size(),
                         std::string(percent), sheet.left_out.fragments, written.front().string());
    const auto mixed = static_cast<std::size_t>(
        std::ranges::count_if(sheet.pieces, [](const decal::Piece& piece) { return !piece.outlined; }));
    if (command.request.sheet.outlines && mixed > 0)
        result = command.request.sheet.prints
                     ? Message("{}; of several inks and so as pictures: {} pieces", result, mixed)
                     : Message("{}; of several inks and so without outlines: {} pieces", result, mixed);
    context.outbox.report(result);
    context.publisher.publish();
}

void export_film(PaintContext& context, ExportFilm command) {
    command.film.progress = context.progress("Filming");
    command.film.progress("film", 0);
    const std::vector<stroke::JournalEntry>& entries = context.work.document->journal().entries();
    pictures::measure_film(entries, command.film);
    io::check_film(command.path);
    stroke::Document painting(*context.work.model);
    context.take_presets(painting, {});
    const io::FilmFormat format{.width = command.film.picture.width,
                                .height = command.film.picture.height,
                                .frames_per_second = command.film.frames_per_second};
    io::write_film(command.path, format,
                   [&](io::FilmSink& sink) { pictures::film_journal(painting, entries, command.film, sink); });
    context.outbox.report(Message("Exported {}", command.path.string()));
    context.publisher.publish();
}

}  // namespace tuft::app
