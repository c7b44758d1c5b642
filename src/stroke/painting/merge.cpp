#include "stroke/painting/merge.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "stroke/painting/painting.h"

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
    explicit Follower(std::vector<Stroke>& entries, std::uint64_t first_free)
        : entries_(entries), next_id_(first_free), layers_(layers_after(entries)), masks_(masks_after(entries)) {
        for (const Stroke& s : entries) ids_.insert(s.id);
    }

    /// Something that is there already; only its names are learnt.
    void pass(const Stroke& mine) { learn(mine); }

    void append(Stroke entry) {
        const Stroke was = entry;
        if (entry.action == Action::layer  ? map_layer_edit(entry.edit)
            : entry.action == Action::mask ? map_mask_edit(entry.mask_edit)
                                           : map_place(entry))
            put(std::move(entry));
        learn(was);
    }

  private:
    void put(Stroke entry) {
        if (!ids_.insert(entry.id).second) entry.id = next_id_++, ids_.insert(entry.id);
        if (entry.action == Action::layer && !entry.hidden) apply(layers_, entry.edit);
        if (entry.action == Action::mask && !entry.hidden) apply(masks_, entry.mask_edit);
        entries_.push_back(std::move(entry));
    }

    // The names that layers and masks had in their own journal, for the time when they are gone.
    void learn(const Stroke& mine) {
        if (mine.action == Action::layer && mine.edit.what != LayerChange::remove &&
            mine.edit.what != LayerChange::merge)
            layer_names_[mine.edit.layer.id] = mine.edit.layer.name;
        if (mine.action == Action::mask && !mine.mask_edit.remove)
            own_masks_[mine.mask_edit.mask.id] = mine.mask_edit.mask;
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

    bool map_place(Stroke& entry) {
        const bool on_layer = entry.action == Action::stroke || entry.action == Action::fill;
        if (on_layer && entry.layer != kPaletteLayer) entry.layer = layer_for(entry.layer);
        if (on_layer && entry.mask != 0) entry.mask = mask_for(entry.mask, 0);
        return true;
    }

    Stroke action() const {
        Stroke entry;
        entry.trace.flat = false;
        return entry;
    }

    std::uint32_t layer_for(std::uint32_t id) {
        const std::uint32_t now = mapped(new_layer_, id);
        if (layers_.find(now)) return now;
        if (layers_.layers.size() >= kMaxLayers) return layers_.layers.back().id;
        Stroke entry = action();
        entry.action = Action::layer;
        const auto name = layer_names_.find(id);
        entry.edit = add_on_top(layers_, free_name(layers_, name == layer_names_.end() ? Layer{}.name : name->second));
        const std::uint32_t added = new_layer_[id] = entry.edit.layer.id;
        put(std::move(entry));
        return added;
    }

    std::uint32_t mask_for(std::uint32_t id, int depth) {
        constexpr int kDeepest = 100;  // masks of masks
        const std::uint32_t now = mapped(new_mask_, id);
        const auto known = own_masks_.find(id);
        if (masks_.find(now) || known == own_masks_.end() || depth > kDeepest) return now;
        Stroke entry = action();
        entry.action = Action::mask;
        entry.mask_edit.mask = known->second;
        Mask& mask = entry.mask_edit.mask;
        for (std::uint32_t& part : mask.of) part = mask_for(part, depth + 1);
        mask.id = masks_.next_id;
        mask.name = free_name(masks_, mask.name);
        if (!possible(masks_, entry.mask_edit)) return now;
        const std::uint32_t added = new_mask_[id] = mask.id;
        put(std::move(entry));
        return added;
    }

    std::vector<Stroke>& entries_;
    std::uint64_t next_id_;
    std::unordered_set<std::uint64_t> ids_;
    LayerTable layers_;
    MaskTable masks_;
    std::map<std::uint32_t, std::uint32_t> new_layer_, new_mask_;  // by their ids in mine
    std::map<std::uint32_t, std::string> layer_names_{{kFirstLayer, Layer{}.name}};
    std::map<std::uint32_t, Mask> own_masks_;
};

bool holds_together(std::span<const Stroke> entries) {
    LayerTable layers;
    MaskTable masks;
    try {
        for (const Stroke& s : entries) {
            if (s.hidden) continue;
            if (s.action == Action::layer) apply(layers, s.edit);
            if (s.action == Action::mask) apply(masks, s.mask_edit);
            if (s.action != Action::stroke && s.action != Action::fill) continue;
            if (s.layer != kPaletteLayer && !layers.find(s.layer)) return false;
            if (s.mask != 0 && !masks.find(s.mask)) return false;
        }
    } catch (const Error&) {
        return false;
    }
    return true;
}

std::uint64_t greatest_id(std::uint64_t most, std::span<const Stroke> entries) {
    for (const Stroke& s : entries) most = std::max(most, s.id);
    return most;
}

}  // namespace

EntryMark mark_of(const Stroke& entry) {
    const Trace& t = entry.trace;
    std::uint64_t h = hash_span(std::span<const TraceSample>(t.samples));
    const double place[] = {t.placement.origin.x, t.placement.origin.y, t.placement.origin.z,
                            t.placement.right.x,  t.placement.right.y,  t.placement.right.z,
                            t.placement.down.x,   t.placement.down.y,   t.placement.down.z};
    h = hash_bytes(place, sizeof place, h);
    const std::uint64_t rest[] = {t.seed, t.flat, static_cast<std::uint64_t>(t.placement.mapping)};
    h = hash_bytes(rest, sizeof rest, h);
    for (const std::string& text : {t.brush, t.ink, t.label, entry_json(entry)}) {
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

std::vector<EntryMark> marks_of(std::span<const Stroke> entries) {
    std::vector<EntryMark> marks;
    marks.reserve(entries.size());
    for (const Stroke& s : entries) marks.push_back(mark_of(s));
    return marks;
}

MergedJournal merge_journals(std::span<const EntryMark> base, std::vector<Stroke> mine, std::vector<Stroke> theirs) {
    const Marks was = by_id(base), own = by_id(marks_of(mine)), other = by_id(marks_of(theirs));
    std::unordered_map<std::uint64_t, const Stroke*> mine_by_id;
    for (const Stroke& s : mine) mine_by_id[s.id] = &s;
    std::uint64_t most = greatest_id(greatest_id(0, mine), theirs);
    for (const EntryMark& m : base) most = std::max(most, m.id);

    MergedJournal merged;
    for (const Stroke& s : theirs) {
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
    for (const Stroke& s : mine) {
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
