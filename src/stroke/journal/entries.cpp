#include "stroke/journal/entries.h"

#include <algorithm>
#include <utility>

#include "core/overloaded.h"

namespace tuft::stroke {
namespace {

std::vector<Preparation> preparations_of(const RecordedStroke& stroke, const std::vector<JournalEntry>& entries,
                                         const EntryOptions& options) {
    const auto is_first = [&] {
        return std::none_of(entries.begin(), entries.end(), [&](const JournalEntry& e) {
            return has_brush(kind_of(e)) && brush_of(e) == stroke.brush;
        });
    };
    std::vector<Preparation> all;
    if (!options.prepare.empty() && !stroke.samples.empty() && (options.settings.dip == DipMode::each || is_first()))
        all = options.prepare;
    all.insert(all.end(), stroke.before.begin(), stroke.before.end());
    return all;
}

EntryContent prepared(const Preparation& preparation, const RecordedStroke& stroke, const StrokeSettings& settings) {
    return std::visit(Overloaded{[&](BrushAction action) -> EntryContent {
                                     action.brush = stroke.brush;
                                     if (action.ink.empty()) action.ink = stroke.ink;
                                     action.seed = stroke.seed;
                                     action.dip = settings.dip;
                                     action.spine = settings.spine;
                                     return action;
                                 },
                                 [&](Dry dry) -> EntryContent {
                                     dry.down = settings.down;
                                     return dry;
                                 },
                                 [](const WashPalette& wash) -> EntryContent { return wash; },
                                 [&](Fill fill) -> EntryContent {
                                     if (fill.ink.empty()) fill.ink = stroke.ink;
                                     if (stroke.on_palette) fill.layer = kPaletteLayer;
                                     fill.names = stroke.names;
                                     return fill;
                                 }},
                      preparation);
}

}  // namespace

void append_entries(std::vector<JournalEntry>& entries, std::vector<RecordedStroke> strokes,
                    const EntryOptions& options) {
    for (RecordedStroke& recorded : strokes) {
        if (!options.brush.empty()) recorded.brush = options.brush;
        if (!options.ink.empty()) recorded.ink = options.ink;
        if (recorded.ink.empty()) recorded.ink = options.other_ink;
        // What is done with a brush shows in the stroke after it: that goes on with this brush.
        StrokeSettings settings = recorded.settings.value_or(options.settings);
        const DipMode dip = settings.dip;
        for (const Preparation& preparation : preparations_of(recorded, entries, options)) {
            entries.emplace_back().content = prepared(preparation, recorded, settings);
            entries.back().group.name = recorded.group;
            if (std::holds_alternative<BrushAction>(preparation)) settings.dip = DipMode::persistent;
        }
        if (recorded.samples.empty()) continue;
        if (recorded.settings) settings.dip = dip;
        if (recorded.flat && !recorded.pressed) settings.pressure = options.pressure;
        JournalEntry& entry = entries.emplace_back();
        entry.label = std::move(recorded.label);
        entry.group.name = recorded.group;
        StrokeSamples& samples = recorded;
        entry.content = PaintStroke{.trace = std::move(samples),
                                    .brush = std::move(recorded.brush),
                                    .ink = std::move(recorded.ink),
                                    .seed = recorded.seed,
                                    .tool = recorded.erases || options.erases ? Tool::eraser : Tool::brush,
                                    .layer = recorded.on_palette ? kPaletteLayer : kFirstLayer,
                                    .settings = settings,
                                    .names = std::move(recorded.names)};
    }
}

}  // namespace tuft::stroke
