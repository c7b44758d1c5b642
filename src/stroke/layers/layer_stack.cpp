#include "stroke/layers/layer_stack.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "ink/composite/recolour.h"
#include "ink/texels/merge.h"

namespace tuft::stroke {

const Layer& LayerStack::layer(std::uint32_t id) const {
    const Layer* layer = table_.find(id);
    if (!layer) throw Error(Message("there is no layer {}", id));
    return *layer;
}

const ink::Canvas& LayerStack::canvas(std::uint32_t id) const {
    layer(id);
    return id == kFirstLayer ? first_ : upper_.at(id);
}

ink::Canvas& LayerStack::canvas(std::uint32_t id) {
    layer(id);
    if (id == kFirstLayer) return first_;
    ink::Canvas& canvas = upper_.at(id);
    for (std::size_t p = canvas.pigments().size(); p < pigments().size(); ++p) canvas.add_pigment(pigments()[p]);
    return canvas;
}

std::vector<LayerTexels> LayerStack::canvases() const {
    std::vector<LayerTexels> all;
    for (const Layer& layer : table_.layers) all.push_back({layer.id, &canvas(layer.id)});
    return all;
}

std::uint64_t LayerStack::hash() const {
    const std::vector<LayerTexels> texels = canvases();
    if (texels.size() == 1) return texels[0].canvas->hash();
    std::uint64_t h = 0;
    for (const LayerTexels& layer : texels) {
        const std::uint64_t part[] = {layer.layer, layer.canvas->hash()};
        h = hash_bytes(part, sizeof part, h);
    }
    return h;
}

LayerBackup LayerStack::edit(const LayerEdit& edit) {
    LayerBackup before{.table = table_, .canvas = {}, .merged = {}};
    const std::uint32_t id = edit.layer.id;
    if (edit.what == LayerChange::merge) canvas(id);  // knows all pigments now
    apply(table_, edit);
    switch (edit.what) {
        case LayerChange::add:
            upper_.emplace(id, ink::Canvas(first_.n_slots()));
            break;
        case LayerChange::change:
            mark_changed(id);
            break;
        case LayerChange::duplicate: {
            const ink::Canvas copy = canvas(edit.other);
            upper_.emplace(id, copy);
            mark_changed(id);
            break;
        }
        case LayerChange::merge:
            before.canvas.emplace(take_canvas(id));
            before.merged.emplace(merge_canvas(edit.other, before.canvas->canvas));
            break;
        case LayerChange::remove:
            before.canvas.emplace(take_canvas(id));
            break;
    }
    return before;
}

// The first layer's canvas stays for its list of pigments.
LayerCanvas LayerStack::take_canvas(std::uint32_t id) {
    LayerCanvas taken{id, ink::Canvas(first_.n_slots())};
    if (id == kFirstLayer) {
        mark_changed(first_.touched_slots());
        for (const ink::Pigment& p : pigments()) taken.canvas.add_pigment(p);
        std::swap(taken.canvas, first_);
    } else {
        mark_changed(upper_.at(id).touched_slots());
        taken.canvas = std::move(upper_.at(id));
        upper_.erase(id);
    }
    return taken;
}

// Returns what the lower layer held where it is written to.
LayerTiles LayerStack::merge_canvas(std::uint32_t into, const ink::Canvas& from) {
    ink::Canvas& lower = canvas(into);
    LayerTiles before{into, {}};
    for (const std::uint32_t slot : from.touched_slots()) before.tiles.push_back(lower.snapshot(slot));
    ink::merge_films(lower, from);
    return before;
}

void LayerStack::restore(LayerBackup before) {
    if (before.merged)
        for (const ink::TileSnapshot& tile : before.merged->tiles) canvas(before.merged->layer).restore(tile);
    set_table(std::move(before.table));
    if (!before.canvas) return;
    const std::uint32_t id = before.canvas->layer;
    ink::Canvas& canvas = before.canvas->canvas;
    mark_changed(canvas.touched_slots());
    if (id == kFirstLayer) {
        for (const ink::Pigment& p : pigments()) canvas.add_pigment(p);
        first_ = std::move(canvas);
    } else {
        upper_.insert_or_assign(id, std::move(canvas));
    }
}

void LayerStack::set_table(LayerTable table) {
    const bool same_layers = table.layers.size() == table_.layers.size();
    for (std::size_t i = 0; i < table_.layers.size(); ++i) {
        const Layer& layer = table_.layers[i];
        const Layer* now = table.find(layer.id);
        const bool moved = same_layers && now && now - table.layers.data() != static_cast<std::ptrdiff_t>(i);
        if (!now || *now != layer || moved) mark_changed(layer.id);
        if (!now) upper_.erase(layer.id);
    }
    table_ = std::move(table);
}

void LayerStack::replace(LayerTable table, std::vector<LayerCanvas> canvases) {
    ink::Canvas first(first_.n_slots());
    std::map<std::uint32_t, ink::Canvas> upper;
    for (LayerCanvas& layer : canvases) {
        if (layer.layer == kFirstLayer)
            first = std::move(layer.canvas);
        else if (table.find(layer.layer))
            upper.insert_or_assign(layer.layer, std::move(layer.canvas));
        else
            throw Error("the stored texels belong to other layers");
    }
    // One list of pigments for all: the first canvas' own, or where there is none, theirs.
    for (const auto& [id, canvas] : upper)
        for (const ink::Pigment& p : canvas.pigments()) first.add_pigment(p);
    for (const Layer& layer : table.layers)
        if (layer.id != kFirstLayer) upper.try_emplace(layer.id, ink::Canvas(first_.n_slots()));
    first_ = std::move(first);
    upper_ = std::move(upper);
    table_ = std::move(table);
}

void LayerStack::clear() {
    mark_changed();
    first_.clear();
    upper_.clear();
    table_ = {};
}

void LayerStack::forget_pigments(std::size_t n) {
    first_.forget_pigments(n);
    for (auto& [id, canvas] : upper_) canvas.forget_pigments(n);
}

void LayerStack::recolour(const ink::Ink& painted, const ink::Ink& wanted) {
    ink::recolour(first_, painted, wanted);
    for (auto& [id, canvas] : upper_) ink::recolour(canvas, painted, wanted);
}

void LayerStack::mark_changed(std::uint32_t id) {
    mark_changed(canvas(id).touched_slots());
}

void LayerStack::mark_changed() {
    for (const Layer& layer : table_.layers) mark_changed(layer.id);
}

void LayerStack::mark_changed(const std::vector<std::uint32_t>& slots) {
    changed_.insert(changed_.end(), slots.begin(), slots.end());
}

std::vector<std::uint32_t> LayerStack::take_dirty() {
    std::vector<std::uint32_t> dirty = first_.take_dirty();
    if (upper_.empty() && changed_.empty()) return dirty;
    for (auto& [id, canvas] : upper_) {
        const std::vector<std::uint32_t> more = canvas.take_dirty();
        dirty.insert(dirty.end(), more.begin(), more.end());
    }
    dirty.insert(dirty.end(), changed_.begin(), changed_.end());
    changed_.clear();
    std::sort(dirty.begin(), dirty.end());
    dirty.erase(std::unique(dirty.begin(), dirty.end()), dirty.end());
    return dirty;
}

}  // namespace tuft::stroke
