#include "stroke/journal/entries.h"

#include <algorithm>
#include <utility>

namespace tuft::stroke {
namespace {

std::vector<BrushAction> actions_before(const Trace& trace, const std::vector<Stroke>& entries,
                                        const EntryOptions& options) {
    const auto is_first = [&] {
        return std::none_of(entries.begin(), entries.end(),
                            [&](const Stroke& s) { return s.trace.brush == trace.brush; });
    };
    std::vector<BrushAction> actions;
    if (!options.prepare.empty() && !trace.samples.empty() && (options.settings.dip == "each" || is_first()))
        actions = options.prepare;
    actions.insert(actions.end(), trace.before.begin(), trace.before.end());
    return actions;
}

Stroke action_entry(const BrushAction& care, const Trace& trace, const Settings& settings) {
    Stroke entry{.settings = settings, .action = care.action, .seconds = care.seconds, .extent = care.extent};
    entry.trace.flat = false;
    entry.trace.brush = trace.brush;
    entry.trace.seed = trace.seed;  // lays the hair of a fresh one
    entry.trace.ink = care.ink.empty() ? trace.ink : care.ink;
    entry.trace.layer = trace.layer;
    entry.trace.mask = trace.mask;
    entry.fill = care.fill;
    if (trace.on_palette && care.action == Action::fill) entry.layer = kPaletteLayer;
    return entry;
}

}  // namespace

void append_entries(std::vector<Stroke>& entries, std::vector<Trace> traces, const EntryOptions& options) {
    for (Trace& trace : traces) {
        if (!options.brush.empty()) trace.brush = options.brush;
        if (!options.ink.empty()) trace.ink = options.ink;
        if (trace.ink.empty()) trace.ink = options.other_ink;
        // What is done with a brush shows in the stroke after it: that goes on with this brush.
        const bool own = !trace.settings.empty();
        Settings settings = own ? settings_from_json(trace.settings) : options.settings;
        const std::string dip = settings.dip;
        for (const BrushAction& care : actions_before(trace, entries, options)) {
            entries.push_back(action_entry(care, trace, settings));
            if (has_brush(care.action)) settings.dip = "carry";
        }
        trace.before.clear();
        if (trace.samples.empty()) continue;
        if (own) settings.dip = dip;
        Stroke stroke{.settings = settings};
        if (trace.flat && !trace.pressed) stroke.settings.pressure = options.pressure;
        trace.erases = trace.erases || options.erases;
        if (trace.on_palette) stroke.layer = kPaletteLayer;
        stroke.trace = std::move(trace);
        entries.push_back(std::move(stroke));
    }
}

}  // namespace tuft::stroke
