#include <algorithm>

#include "core/hash.h"
#include "ink/texels/merge.h"
#include "stroke/document/document.h"

/// What a painting does with its layers.
namespace tuft::stroke {

ink::Canvas& Document::canvas(std::uint32_t layer) {
    if (layer == kPaletteLayer) {
        ink::Canvas& canvas = plate().canvas;
        for (std::size_t p = canvas.pigments().size(); p < canvas_.pigments().size(); ++p)
            canvas.add_pigment(canvas_.pigments()[p]);
        return canvas;
    }
    if (!layers_.find(layer)) throw Error(Message("there is no layer {}", layer));
    if (layer == kFirstLayer) return canvas_;
    ink::Canvas& canvas = upper_.at(layer);
    for (std::size_t p = canvas.pigments().size(); p < canvas_.pigments().size(); ++p)
        canvas.add_pigment(canvas_.pigments()[p]);
    return canvas;
}

std::vector<LayerTexels> Document::canvases() const {
    std::vector<LayerTexels> all;
    for (const Layer& layer : layers_.layers)
        all.push_back({layer.id, layer.id == kFirstLayer ? &canvas_ : &upper_.at(layer.id)});
    return all;
}

std::vector<LayerTexels> Document::shown_layers() const {
    std::vector<LayerTexels> shown;
    for (const LayerTexels& texels : canvases()) {
        const Layer& layer = *layers_.find(texels.layer);
        const bool is =
            shown_.empty() ? layer.visible : std::find(shown_.begin(), shown_.end(), layer.id) != shown_.end();
        if (is && layer.opacity > 0) shown.push_back(texels);
    }
    return shown;
}

ink::Stack Document::stack() const {
    ink::Stack stack{std::vector<ink::LayerView>{}};
    if (!previewed_substrate_) stack.ground = &model_->ground;  // another substrate is seen whole
    for (const LayerTexels& texels : shown_layers())
        stack.layers.push_back({texels.canvas, static_cast<float>(layers_.find(texels.layer)->opacity),
                                layers_.find(texels.layer)->blend});
    return stack;
}

void Document::show_only(std::vector<std::uint32_t> layers) {
    for (const std::uint32_t layer : layers)
        if (!layers_.find(layer)) throw Error(Message("there is no layer {}", layer));
    shown_ = std::move(layers);
    for (const Layer& layer : layers_.layers) touch_look(layer.id);
}

std::uint64_t Document::hash() const {
    const std::vector<LayerTexels> texels = canvases();
    if (texels.size() == 1) return texels[0].canvas->hash();
    std::uint64_t h = 0;
    for (const LayerTexels& layer : texels) {
        const std::uint64_t part[] = {layer.layer, layer.canvas->hash()};
        h = hash_bytes(part, sizeof part, h);
    }
    return h;
}

// All that the layer covers is to be drawn anew.
void Document::touch_look(std::uint32_t layer) {
    const ink::Canvas& canvas = layer == kFirstLayer ? canvas_ : upper_.at(layer);
    const std::vector<std::uint32_t> slots = canvas.touched_slots();
    changed_.insert(changed_.end(), slots.begin(), slots.end());
}

std::vector<std::uint32_t> Document::take_dirty() {
    std::vector<std::uint32_t> dirty = canvas_.take_dirty();
    if (upper_.empty() && changed_.empty()) return dirty;
    for (auto& [layer, canvas] : upper_) {
        const std::vector<std::uint32_t> more = canvas.take_dirty();
        dirty.insert(dirty.end(), more.begin(), more.end());
    }
    dirty.insert(dirty.end(), changed_.begin(), changed_.end());
    changed_.clear();
    std::sort(dirty.begin(), dirty.end());
    dirty.erase(std::unique(dirty.begin(), dirty.end()), dirty.end());
    return dirty;
}

// Before the hand begins: what it may not do. A replay may, since the lock came after it.
void Document::check_layer(const JournalEntry& entry) const {
    if (!entry.as<PaintStroke>() && !entry.as<Fill>()) return;
    if (on_palette(entry)) return;
    const std::uint32_t id = layer_of(entry), mask = mask_of(entry);
    const Layer* layer = layers_.find(id);
    if (!layer) throw Error(Message("there is no layer {} to paint on", id));
    if (mask && !masks_.find(mask)) throw Error(Message("there is no mask {}", mask));
    if (layer->locked) throw Error(Message("layer '{}' is locked; unlock it or paint on another one", layer->name));
}

void Document::edit_layers(std::uint64_t entry_id, const LayerEdit& edit) {
    Undo undo{.stroke_id = entry_id, .layers = layers_};
    const std::uint32_t id = edit.layer.id;
    if (edit.what == LayerChange::merge) canvas(id);  // knows all pigments now
    apply(layers_, edit);
    switch (edit.what) {
        case LayerChange::add:
            upper_.emplace(id, ink::Canvas(model_->texels.n_slots()));
            break;
        case LayerChange::change:
            touch_look(id);
            break;
        case LayerChange::duplicate: {
            const ink::Canvas copy = canvas(edit.other);
            upper_.emplace(id, copy);
            touch_look(id);
            break;
        }
        case LayerChange::merge:
            undo.canvas.emplace(take_texels(id));
            undo.before.push_back(merge_texels(edit.other, undo.canvas->canvas));
            break;
        case LayerChange::remove:
            undo.canvas.emplace(take_texels(id));
            break;
    }
    keep_undo(std::move(undo));
}

// Texels of a layer that ends.
LayerCanvas Document::take_texels(std::uint32_t id) {
    touch_look(id);
    LayerCanvas taken{id, ink::Canvas(model_->texels.n_slots())};
    if (id == kFirstLayer) {
        for (const ink::Pigment& p : canvas_.pigments()) taken.canvas.add_pigment(p);
        std::swap(taken.canvas, canvas_);
    } else {
        taken.canvas = std::move(upper_.at(id));
        upper_.erase(id);
    }
    return taken;
}

// What the lower layer held where ink is laid on it.
LayerTiles Document::merge_texels(std::uint32_t into, const ink::Canvas& from) {
    ink::Canvas& lower = canvas(into);
    LayerTiles before{into, {}};
    for (const std::uint32_t slot : from.touched_slots()) before.tiles.push_back(lower.snapshot(slot));
    ink::lay_films(lower, from);
    return before;
}

// Another table; layers that it does not have go, with their texels.
void Document::set_layers(LayerTable table) {
    const bool same_layers = table.layers.size() == layers_.layers.size();
    for (std::size_t i = 0; i < layers_.layers.size(); ++i) {
        const Layer& layer = layers_.layers[i];
        const Layer* now = table.find(layer.id);
        const bool moved = same_layers && now && now - table.layers.data() != static_cast<std::ptrdiff_t>(i);
        if (!now || *now != layer || moved) touch_look(layer.id);
        if (!now) upper_.erase(layer.id);
    }
    layers_ = std::move(table);
}

// The tiles, the table and the texels of layers as they were before.
void Document::take_back_layers(Undo& undo) {
    for (const LayerTiles& before : undo.before) {
        if (before.tiles.empty()) continue;
        ink::Canvas& canvas = this->canvas(before.layer);
        for (const ink::TileSnapshot& tile : before.tiles) canvas.restore(tile);
    }
    if (undo.masks) masks_ = std::move(*undo.masks);
    if (!undo.layers) return;
    set_layers(std::move(*undo.layers));
    if (!undo.canvas) return;
    const std::uint32_t id = undo.canvas->layer;
    if (id == kFirstLayer) {
        // The pigments met since then stay known, in their planes.
        for (const ink::Pigment& p : canvas_.pigments()) undo.canvas->canvas.add_pigment(p);
        canvas_ = std::move(undo.canvas->canvas);
    } else {
        upper_.insert_or_assign(id, std::move(undo.canvas->canvas));
    }
    apply_recolours();
    touch_look(id);
}

void Document::adopt(std::vector<JournalEntry> strokes, std::vector<LayerCanvas> canvases, std::uint64_t stroke_id) {
    for (const LayerCanvas& layer : canvases) {
        const Model& model = layer.layer == kPaletteLayer ? plate().model : *model_;
        if (layer.canvas.n_slots() != model.texels.n_slots()) throw Error("the stored texels belong to another atlas");
    }
    if (!fits(strokes, stroke_id)) throw Error("the stored texels belong to other strokes");
    const auto last =
        std::find_if(strokes.begin(), strokes.end(), [stroke_id](const JournalEntry& s) { return s.id == stroke_id; });
    const auto rest = last == strokes.end() ? last : last + 1;
    LayerTable table = layers_after({strokes.begin(), rest});
    MaskTable masks = masks_after({strokes.begin(), rest});
    ink::Canvas first(model_->texels.n_slots());
    std::map<std::uint32_t, ink::Canvas> upper;
    if (palette_) palette_->canvas.clear();
    for (LayerCanvas& layer : canvases) {
        if (layer.layer == kFirstLayer)
            first = std::move(layer.canvas);
        else if (layer.layer == kPaletteLayer)
            plate().canvas = std::move(layer.canvas);
        else
            upper.insert_or_assign(layer.layer, std::move(layer.canvas));
    }
    for (const auto& [id, canvas] : upper) {
        if (!table.find(id)) throw Error("the stored texels belong to other layers");
        // One list of pigments for all: the first canvas' own, or where there is none, theirs.
        for (const ink::Pigment& p : canvas.pigments()) first.add_pigment(p);
    }
    for (const Layer& layer : table.layers)
        if (layer.id != kFirstLayer) upper.try_emplace(layer.id, ink::Canvas(model_->texels.n_slots()));
    canvas_ = std::move(first);
    upper_ = std::move(upper);
    layers_ = std::move(table);
    masks_ = std::move(masks);
    held_.clear();
    undo_.clear();
    undo_bytes_ = 0;
    known_pigments_ = canvas_.pigments().size();
    for (auto s = rest; s != strokes.end(); ++s)
        if (!s->hidden) perform(*s, {});
    for (JournalEntry& entry : strokes) journal_.restore(std::move(entry));
    apply_recolours();
}

}  // namespace tuft::stroke
