#include "io/project/restore.h"

#include "stroke/journal/tables.h"

namespace tuft::io {

void use_presets(const Project& project, stroke::Document& painting) {
    const std::string file = project.path().string();
    for (const auto& [name, toml] : project.brushes()) {
        brush::Preset preset = brush::parse_preset(toml, file + ": brush " + name);
        preset.name = name;
        painting.use(preset);
    }
    for (const auto& [name, toml] : project.inks()) {
        ink::Ink ink = ink::parse_ink(toml, file + ": ink " + name);
        ink.name = name;
        painting.use(ink);
    }
}

void restore_strokes(const Project& project, stroke::Document& painting, const ProgressFn& progress) {
    std::vector<stroke::JournalEntry> strokes;
    std::optional<SavedCanvases> saved;
    project.read_together([&] {
        strokes = project.strokes();
        saved = project.load_canvases(painting.model().texels.n_slots());
    });
    if (saved && stroke::fits(strokes, saved->stroke_id)) {
        painting.adopt(std::move(strokes), std::move(saved->layers), saved->stroke_id);
        return;
    }
    painting.replay(std::move(strokes), progress);
}

}  // namespace tuft::io
