#include "stroke/journal/merge.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "core/overloaded.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/tables.h"

namespace tuft::stroke {
namespace {

using Marks = std::unordered_map<std::uint64_t, std::uint64_t>;  // content by id

Marks by_id(std::span<const EntryMark> marks) {
    Marks out;
    for (const EntryMark& m : marks) out[m.id] = m.content;
    return out;
}

bool is_in(const Marks& marks, const EntryMark& mark) {
    const auto at = marks.find(mark.id);
    return at != marks.end() && at->second == mark.content;
}

template <class Table>
std::string free_name(const Table& table, const std::string& name) {
    std::string out = name;
    for (int n = 2; table.find(std::string_view(out)); ++n)
        out = name.substr(0, kMaxNameBytes - 12) + " (" + std::to_string(n) + ")";
    return out;
}

/// Puts entries of one journal behind another one, whose layers and masks may differ.
class Follower {
  public:
    explicit Follower(std::vector<JournalEntry>& entries, std::uint64_t first_free)
        : entries_(entries), next_id_(first_free), layers_(layers_after(entries)), masks_(masks_after(entries)) {
        for (const JournalEntry& s : entries) ids_.insert(s.id);
    }

    /// Something that is there already; only its names are learnt.
    void pass(const JournalEntry& mine) { learn(mine); }

    void append(JournalEntry entry) {
        const JournalEntry was = entry;
        const bool is_possible = std::visit(
            Overloaded{[&](PaintStroke& stroke) { return map_target(stroke); }, [](const BrushAction&) { return true; },
                       [](const Dry&) { return true; }, [](const WashPalette&) { return true; },
                       [&](Fill& fill) { return map_target(fill); },
                       [&](LayerEdit& edit) { return map_layer_edit(edit); },
                       [&](MaskEdit& edit) { return map_mask_edit(edit); }, [](const PartEdit&) { return true; }},
            entry.content);
        if (is_possible) put(std::move(entry));
        learn(was);
    }

  private:
    void put(JournalEntry entry) {
        if (!ids_.insert(entry.id).second) entry.id = next_id_++, ids_.insert(entry.id);
        if (const LayerEdit* edit = entry.as<LayerEdit>(); edit && !entry.hidden) apply(layers_, *edit);
        if (const MaskEdit* edit = entry.as<MaskEdit>(); edit && !entry.hidden) apply(masks_, *edit);
        entries_.push_back(std::move(entry));
    }

    // The names that layers and masks had in their own journal, for the time when they are gone.
    void learn(const JournalEntry& mine) {
        if (const LayerEdit* edit = mine.as<LayerEdit>();
            edit && edit->what != LayerChange::remove && edit->what != LayerChange::merge)
            layer_names_[edit->layer.id] = edit->layer.name;
        if (const MaskEdit* edit = mine.as<MaskEdit>(); edit && !edit->remove) own_masks_[edit->mask.id] = edit->mask;
    }

    static std::uint32_t mapped(const std::map<std::uint32_t, std::uint32_t>& map, std::uint32_t id) {
        const auto at = map.find(id);
        return at == map.end() ? id : at->second;
    }

    static bool possible(auto table, const auto& edit) {
        try {
            apply(table, edit);
        } catch (const Error&) {
            return false;
        }
        return true;
    }

    bool map_layer_edit(LayerEdit& edit) {
        Layer& layer = edit.layer;
        edit.other = mapped(new_layer_, edit.other);
        if (edit.what == LayerChange::add || edit.what == LayerChange::duplicate) {
            new_layer_[layer.id] = layers_.next_id;
            layer.id = layers_.next_id;
            layer.name = free_name(layers_, layer.name);
            edit.place = std::min(edit.place, static_cast<std::uint32_t>(layers_.layers.size()));
        } else {
            layer.id = mapped(new_layer_, layer.id);
            edit.place = std::min(edit.place, static_cast<std::uint32_t>(layers_.layers.size() - 1));
        }
        return possible(layers_, edit);
    }

    bool map_mask_edit(MaskEdit& edit) {
        Mask& mask = edit.mask;
        if (edit.remove) {
            mask.id = mapped(new_mask_, mask.id);
        } else {
            for (std::uint32_t& part : mask.of) part = mask_for(part, 0);
            new_mask_[mask.id] = masks_.next_id;
            mask.id = masks_.next_id;
            mask.name = free_name(masks_, mask.name);
        }
        return possible(masks_, edit);
    }

    bool map_target(auto& content) {
        if (content.layer != kPaletteLayer) content.layer = layer_for(content.layer);
        if (content.mask != 0) content.mask = mask_for(content.mask, 0);
        return true;
    }

    std::uint32_t layer_for(std::uint32_t id) {
        const std::uint32_t now = mapped(new_layer_, id);
        if (layers_.find(now)) return now;
        if (layers_.layers.size() >= kMaxLayers) return layers_.layers.back().id;
        const auto name = layer_names_.find(id);
        const LayerEdit edit =
            add_on_top(layers_, free_name(layers_, name == layer_names_.end() ? Layer{}.name : name->second));
        const std::uint32_t added = new_layer_[id] = edit.layer.id;
        put(edit);
        return added;
    }

    std::uint32_t mask_for(std::uint32_t id, int depth) {
        constexpr int kDeepest = 100;  // masks of masks
        const std::uint32_t now = mapped(new_mask_, id);
        const auto known = own_masks_.find(id);
        if (masks_.find(now) || known == own_masks_.end() || depth > kDeepest) return now;
        MaskEdit edit{.mask = known->second};
        Mask& mask = edit.mask;
        for (std::uint32_t& part : mask.of) part = mask_for(part, depth + 1);
        mask.id = masks_.next_id;
        mask.name = free_name(masks_, mask.name);
        if (!possible(masks_, edit)) return now;
        const std::uint32_t added = new_mask_[id] = mask.id;
        put(std::move(edit));
        return added;
    }

    std::vector<JournalEntry>& entries_;
    std::uint64_t next_id_;
    std::unordered_set<std::uint64_t> ids_;
    LayerTable layers_;
    MaskTable masks_;
    std::map<std::uint32_t, std::uint32_t> new_layer_, new_mask_;  // by their ids in mine
    std::map<std::uint32_t, std::string> layer_names_{{kFirstLayer, Layer{}.name}};
    std::map<std::uint32_t, Mask> own_masks_;
};

bool holds_together(std::span<const JournalEntry> entries) {
    LayerTable layers;
    MaskTable masks;
    try {
        for (const JournalEntry& s : entries) {
            if (s.hidden) continue;
            if (const LayerEdit* edit = s.as<LayerEdit>()) apply(layers, *edit);
            if (const MaskEdit* edit = s.as<MaskEdit>()) apply(masks, *edit);
            if (!s.as<PaintStroke>() && !s.as<Fill>()) continue;
            if (!on_palette(s) && !layers.find(layer_of(s))) return false;
            if (mask_of(s) != 0 && !masks.find(mask_of(s))) return false;
        }
    } catch (const Error&) {
        return false;
    }
    return true;
}

std::uint64_t greatest_id(std::uint64_t most, std::span<const JournalEntry> entries) {
    for (const JournalEntry& s : entries) most = std::max(most, s.id);
    return most;
}

}  // namespace

EntryMark mark_of(const JournalEntry& entry) {
    const StrokeSamples& t = samples_of(entry);
    std::uint64_t h = hash_span(std::span<const StrokeSample>(t.samples));
    const double place[] = {t.placement.origin.x, t.placement.origin.y, t.placement.origin.z,
                            t.placement.right.x,  t.placement.right.y,  t.placement.right.z,
                            t.placement.down.x,   t.placement.down.y,   t.placement.down.z};
    h = hash_bytes(place, sizeof place, h);
    const std::uint64_t rest[] = {seed_of(entry), t.flat, static_cast<std::uint64_t>(t.placement.mapping)};
    h = hash_bytes(rest, sizeof rest, h);
    for (const std::string& text : {brush_of(entry), ink_of(entry), entry.label, entry_json(entry)}) {
        const std::size_t size = text.size();
        h = hash_bytes(text.data(), size, hash_bytes(&size, sizeof size, h));
    }
    EntryMark mark{entry.id, h};
    set_hidden(mark, entry.hidden);
    return mark;
}

void set_hidden(EntryMark& mark, bool hidden) {
    if (hidden != mark.hidden) mark.content = ~mark.content;
    mark.hidden = hidden;
}

std::vector<EntryMark> marks_of(std::span<const JournalEntry> entries) {
    std::vector<EntryMark> marks;
    marks.reserve(entries.size());
    for (const JournalEntry& s : entries) marks.push_back(mark_of(s));
    return marks;
}

MergedJournal merge_journals(std::span<const EntryMark> base, std::vector<JournalEntry> mine,
                             std::vector<JournalEntry> theirs) {
    const Marks was = by_id(base), own = by_id(marks_of(mine)), other = by_id(marks_of(theirs));
    std::unordered_map<std::uint64_t, const JournalEntry*> mine_by_id;
    for (const JournalEntry& s : mine) mine_by_id[s.id] = &s;
    std::uint64_t most = greatest_id(greatest_id(0, mine), theirs);
    for (const EntryMark& m : base) most = std::max(most, m.id);

    MergedJournal merged;
    for (const JournalEntry& s : theirs) {
        const EntryMark mark = mark_of(s);
        const auto ours = mine_by_id.find(s.id);
        const bool before = was.contains(s.id);
        merged.news += !is_in(own, mark) && !is_in(was, mark);
        if (before && ours == mine_by_id.end() && is_in(was, mark)) {  // taken out here
            merged.altered = true;
        } else if (before && ours != mine_by_id.end() && own.at(s.id) != was.at(s.id) &&
                   own.at(s.id) != mark.content) {  // changed here
            merged.altered = true;
            merged.entries.push_back(*ours->second);
        } else {
            merged.entries.push_back(s);
        }
    }
    for (const EntryMark& m : base) merged.news += own.contains(m.id) && !other.contains(m.id);
    if (merged.altered && !holds_together(merged.entries)) {
        merged.entries = theirs;
        merged.altered = false;
    }
    merged.from_theirs = merged.altered ? 0 : merged.entries.size();
    Follower follower(merged.entries, most + 1);
    for (const JournalEntry& s : mine) {
        const EntryMark mark{s.id, own.at(s.id)};
        const bool changed = !is_in(was, mark);
        // In theirs already: where it was, or written there by this side without its knowing.
        const bool there = is_in(other, mark) || (was.contains(s.id) && other.contains(s.id));
        if (changed && !there)
            follower.append(s);
        else
            follower.pass(s);
    }
    return merged;
}

}  // namespace tuft::stroke
