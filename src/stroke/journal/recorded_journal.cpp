#include "stroke/journal/recorded_journal.h"

#include "core/overloaded.h"

namespace tuft::stroke {
namespace {

/// Takes the entries in their order; layers and masks are named as they are called then.
class Recorder {
  public:
    explicit Recorder(RecordedJournal& out) : out_(out) {}

    void add(const JournalEntry& entry) {
        label_ = &entry.label;
        std::visit(*this, entry.content);
    }

    void operator()(const PaintStroke& stroke) {
        RecordedStroke& recorded = begin(stroke.settings);
        static_cast<StrokeSamples&>(recorded) = stroke.trace;
        recorded.brush = stroke.brush;
        recorded.ink = stroke.ink;
        recorded.seed = stroke.seed;
        recorded.erases = stroke.erases();
        set_target(recorded, stroke.layer, stroke.mask);
    }
    void operator()(const BrushAction& action) {
        RecordedStroke& recorded = prepare(action, {.spine = action.spine, .dip = action.dip});
        recorded.brush = action.brush;
        recorded.ink = action.ink;
        recorded.seed = action.seed;
    }
    void operator()(const Dry& dry) { prepare(dry, {.down = dry.down}); }
    void operator()(const WashPalette& wash) { prepare(wash, {}).on_palette = true; }
    void operator()(const Fill& fill) {
        RecordedStroke& recorded = prepare(fill, {});
        recorded.ink = fill.ink;
        set_target(recorded, fill.layer, fill.mask);
    }
    void operator()(const LayerEdit& edit) {
        apply(layers_, edit);
        out_.left_out += edit.what != LayerChange::add;
    }
    void operator()(const MaskEdit& edit) {
        apply(masks_, edit);
        ++out_.left_out;
    }
    void operator()(const PartEdit&) { ++out_.left_out; }

  private:
    RecordedStroke& begin(const StrokeSettings& settings) {
        RecordedStroke& recorded = out_.strokes.emplace_back();
        recorded.label = *label_;
        recorded.settings = settings;
        return recorded;
    }
    RecordedStroke& prepare(Preparation preparation, const StrokeSettings& settings) {
        RecordedStroke& recorded = begin(settings);
        recorded.flat = false;
        recorded.before.push_back(std::move(preparation));
        return recorded;
    }
    void set_target(RecordedStroke& recorded, std::uint32_t layer, std::uint32_t mask) const {
        recorded.on_palette = layer == kPaletteLayer;
        if (const Layer* found = layers_.find(layer); found && layers_.layers.size() > 1)
            recorded.names.layer = found->name;
        if (const Mask* found = masks_.find(mask)) recorded.names.mask = found->name;
    }

    RecordedJournal& out_;
    const std::string* label_ = nullptr;
    LayerTable layers_;
    MaskTable masks_;
};

}  // namespace

RecordedJournal record(std::span<const JournalEntry> entries) {
    RecordedJournal out;
    Recorder recorder(out);
    for (const JournalEntry& entry : entries)
        if (!entry.hidden) recorder.add(entry);
    return out;
}

}  // namespace tuft::stroke
