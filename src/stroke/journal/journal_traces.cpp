#include "stroke/journal/journal_traces.h"

namespace tuft::stroke {

JournalTraces traces_of(std::span<const Stroke> entries) {
    JournalTraces out;
    LayerTable layers;
    MaskTable masks;
    for (const Stroke& entry : entries) {
        if (entry.hidden) continue;
        if (entry.action == Action::layer || entry.action == Action::mask) {
            if (entry.action == Action::layer)
                apply(layers, entry.edit);
            else
                apply(masks, entry.mask_edit);
            out.left_out += entry.action == Action::mask || entry.edit.what != LayerChange::add;
            continue;
        }
        Trace trace = entry.trace;
        trace.settings = to_json(entry.settings);
        trace.on_palette = entry.layer == kPaletteLayer || entry.action == Action::wash;
        trace.before.clear();
        if (const Layer* layer = layers.find(entry.layer); layer && layers.layers.size() > 1) trace.layer = layer->name;
        if (const Mask* mask = masks.find(entry.mask)) trace.mask = mask->name;
        if (entry.action != Action::stroke) {
            trace.flat = false;
            trace.samples.clear();
            trace.before.push_back({entry.action, entry.trace.ink, entry.seconds, entry.fill, entry.extent});
        }
        out.traces.push_back(std::move(trace));
    }
    return out;
}

}  // namespace tuft::stroke
