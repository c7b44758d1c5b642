#include "stroke/journal/tables.h"

#include <map>
#include <utility>

#include "core/error.h"

namespace tuft::stroke {
namespace {

/// Where a stroke or a fill goes.
struct Target {
    std::uint32_t *layer, *mask;
    const PlaceNames* names;
};

template <class Content>
Target target_in(Content& content) {
    return {&content.layer, &content.mask, &content.names};
}

/// Nothing for kinds that go nowhere, and on the palette, which has neither layers nor masks.
std::optional<Target> target_of(JournalEntry& entry) {
    if (on_palette(entry)) return {};
    if (PaintStroke* stroke = entry.as<PaintStroke>()) return target_in(*stroke);
    if (Fill* fill = entry.as<Fill>()) return target_in(*fill);
    return {};
}

}  // namespace

LayerTable layers_after(std::span<const JournalEntry> entries) {
    LayerTable table;
    for (const JournalEntry& entry : entries)
        if (const LayerEdit* edit = entry.as<LayerEdit>(); edit && !entry.hidden) apply(table, *edit);
    return table;
}

MaskTable masks_after(std::span<const JournalEntry> entries) {
    MaskTable table;
    for (const JournalEntry& entry : entries)
        if (const MaskEdit* edit = entry.as<MaskEdit>(); edit && !entry.hidden) apply(table, *edit);
    return table;
}

PartTable parts_after(std::span<const JournalEntry> entries) {
    PartTable table;
    for (const JournalEntry& entry : entries)
        if (const PartEdit* edit = entry.as<PartEdit>(); edit && !entry.hidden) apply(table, *edit);
    return table;
}

std::uint32_t last_mask_on(std::span<const JournalEntry> entries, std::uint32_t layer) {
    std::map<std::uint32_t, std::uint32_t> masks;  // by layer
    for (const JournalEntry& entry : entries) {
        if (entry.hidden) continue;
        if (entry.as<PaintStroke>() || entry.as<Fill>()) masks[layer_of(entry)] = mask_of(entry);
        const LayerEdit* edit = entry.as<LayerEdit>();
        if (!edit) continue;
        // A copy is wet as far as the original; of two merged layers the mask of the upper one goes on.
        if (edit->what == LayerChange::duplicate) masks[edit->layer.id] = masks[edit->other];
        if (edit->what == LayerChange::merge && masks[edit->layer.id]) masks[edit->other] = masks[edit->layer.id];
    }
    return masks[layer];
}

bool fits(std::span<const JournalEntry> entries, std::uint64_t id) {
    for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
        if (entry->id == id) return true;
        if (!keeps_texels(kind_of(*entry))) return false;
    }
    return entries.empty() && id == 0;
}

std::vector<JournalEntry> onto_named_layers(std::vector<JournalEntry> entries, LayerTable table,
                                            const std::string& name) {
    std::vector<JournalEntry> out;
    for (JournalEntry& entry : entries) {
        if (const std::optional<Target> target = target_of(entry)) {
            const std::string& wanted = target->names->layer.empty() ? name : target->names->layer;
            if (!wanted.empty() && !table.find(wanted)) {
                const LayerEdit edit = add_on_top(table, wanted);
                apply(table, edit);
                out.emplace_back(edit);
            }
            if (!wanted.empty()) *target->layer = table.find(wanted)->id;
        }
        out.push_back(std::move(entry));
    }
    return out;
}

void keep_to_named_masks(std::vector<JournalEntry>& entries, const MaskTable& table, const std::string& name) {
    for (JournalEntry& entry : entries) {
        const std::optional<Target> target = target_of(entry);
        if (!target) continue;
        const std::string& wanted = target->names->mask.empty() ? name : target->names->mask;
        if (wanted.empty()) continue;
        const Mask* mask = table.find(wanted);
        if (!mask) throw Error(Message("there is no mask '{}'; make it with 'tuft mask'", wanted));
        *target->mask = mask->id;
    }
}

}  // namespace tuft::stroke
