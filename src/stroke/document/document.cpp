#include "stroke/document/document.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/outside.h"
#include "core/overloaded.h"
#include "ink/composite/match.h"
#include "stroke/gesture/hand.h"
#include "stroke/session/session.h"

namespace tuft::stroke {
Document::Document(const Model& model, const DocumentOptions& options)
    : model_(&model),
      options_(options),
      substrate_(ink::load_substrate(options.substrate)),
      canvas_(model.texels.n_slots()),
      plan_scratch_(std::make_unique<PlanScratchPool>()) {}

Document::~Document() = default;
Document::Document(Document&&) noexcept = default;
Document& Document::operator=(Document&&) noexcept = default;

void Document::use_brush(const brush::Preset& preset) {
    brushes_[preset.name] = preset;
    held_.erase(preset.name);
}
void Document::use_ink(const ink::Ink& ink) {
    inks_[ink.name] = ink;
}

const brush::Preset& Document::brush(const std::string& name) {
    const auto found = brushes_.find(name);
    if (found != brushes_.end()) return found->second;
    return brushes_.emplace(name, brush::load_preset(name)).first->second;
}

const ink::Ink& Document::ink(const std::string& name) {
    const auto found = inks_.find(name);
    if (found != inks_.end()) return found->second;
    return inks_.emplace(name, ink::ink_named(name, substrate_, canvas_.pigments())).first->second;
}

const BrushInHand* Document::held(const std::string& brush) const {
    const auto found = held_.find(brush);
    return found == held_.end() ? nullptr : &found->second;
}

// A brush that is not held is fresh; the entry says so, for replays that hold it.
void Document::settle(PaintStroke& stroke) const {
    if (stroke.layer == kPaletteLayer) stroke.settings.film = FilmModel::wet;
    if (!stroke.erases() && !held(stroke.brush)) stroke.settings.dip = DipMode::each;
}

// The same of any entry; new layers and masks get their ids.
void Document::settle(EntryContent& content) const {
    std::visit(Overloaded{[&](PaintStroke& stroke) { settle(stroke); },
                          [&](BrushAction& action) {
                              const BrushInHand* last = held(action.brush);
                              if (!last) action.dip = DipMode::each;
                              if (last && action.ink.empty()) action.ink = last->dipped;
                          },
                          [](const Dry&) {}, [](const WashPalette&) {}, [](const Fill&) {},
                          [&](LayerEdit& edit) {
                              const bool is_new = edit.what == LayerChange::add || edit.what == LayerChange::duplicate;
                              if (is_new && edit.layer.id == 0) edit.layer.id = layers_.next_id;
                          },
                          [&](MaskEdit& edit) {
                              if (!edit.remove && edit.mask.id == 0) edit.mask.id = masks_.next_id;
                          }},
               content);
}

// A clean brush of its own, full of water: its hair lies together, it leaves nothing.
BrushInHand Document::clean_brush(const brush::Preset& preset) const {
    BrushInHand clean{brush::make_tuft(preset), {}, {}, {}};
    clean.reservoir = empty_reservoir(clean.tuft);
    ink::dip(clean.reservoir, ink::Mix{});
    return clean;
}

brush::Preset Document::preset_of(const std::string& name, brush::SpineMethod spine) {
    brush::Preset preset = brush(name);
    if (spine == brush::SpineMethod::table) preset.spine = spine;
    return preset;
}

// The brush an entry begins with: as it is held, or fresh.
BrushInHand Document::take_up(const BrushStart& start) {
    const brush::Preset preset = preset_of(start.brush, start.spine);
    const ink::Mix mix = mix_of(start.ink);
    const BrushInHand* last = start.dip == DipMode::persistent ? held(start.brush) : nullptr;
    if (last && last->tuft.preset.spine == preset.spine) return *last;
    BrushInHand fresh{brush::make_tuft(preset, start.seed), {}, start.ink, start.ink};
    fresh.reservoir = empty_reservoir(fresh.tuft);
    ink::dip(fresh.reservoir, mix);
    return fresh;
}

BrushInHand Document::take_up(const PaintStroke& stroke) {
    if (stroke.erases()) return clean_brush(preset_of(stroke.brush, stroke.settings.spine));
    BrushInHand brush = take_up(BrushStart{.brush = stroke.brush,
                                           .ink = stroke.ink,
                                           .seed = stroke.seed,
                                           .dip = stroke.settings.dip,
                                           .spine = stroke.settings.spine});
    if (stroke.ink != brush.named && stroke.ink != brush.dipped) {
        ink::rinse(brush.reservoir);
        brush::reset(brush.tuft);
        ink::dip(brush.reservoir, mix_of(stroke.ink));
        brush.dipped = stroke.ink;
    }
    brush.named = stroke.ink;
    return brush;
}

// The entry is done: the brush is as it is now, and undo knows what it and the tiles were.
void Document::put_down(std::uint64_t id, const std::string& brush, BrushInHand after, LayerTiles before) {
    Undo undo{.stroke_id = id, .brush = brush};
    undo.before.push_back(std::move(before));
    if (const auto found = held_.find(brush); found != held_.end()) {
        undo.brush_before = std::move(found->second);
        undo.bytes += sizeof(BrushInHand);
    }
    held_.insert_or_assign(brush, std::move(after));
    keep_undo(std::move(undo));
}

void Document::keep_undo(Undo undo) {
    for (const LayerTiles& of_layer : undo.before)
        for (const ink::TileSnapshot& tile : of_layer.tiles)
            undo.bytes += sizeof(ink::TileSnapshot) + tile.amounts.size() * sizeof(float);
    if (undo.canvas) undo.bytes += undo.canvas->canvas.memory_bytes();
    undo_bytes_ += undo.bytes;
    undo.pigments = std::exchange(known_pigments_, canvas_.pigments().size());
    undo_.push_back(std::move(undo));
    while (undo_bytes_ > options_.undo_bytes && undo_.size() > 1) {
        undo_bytes_ -= undo_.front().bytes;
        undo_.pop_front();
    }
}

// Pigments of what is taken back are as if they had never been met: a replay meets the others in its own order.
void Document::forget_pigments(std::size_t n) {
    known_pigments_ = n;
    if (n >= canvas_.pigments().size()) return;
    canvas_.forget_pigments(n);
    for (auto& [layer, canvas] : upper_) canvas.forget_pigments(n);
    if (palette_) palette_->canvas.forget_pigments(n);
}

void Document::act(std::uint64_t id, const BrushAction& action) {
    BrushInHand brush = take_up(BrushStart{
        .brush = action.brush, .ink = action.ink, .seed = action.seed, .dip = action.dip, .spine = action.spine});
    const Extent& extent = action.extent;
    switch (action.kind) {
        case BrushActionKind::dip:
            ink::dip(brush.reservoir, mix_of(action.ink),
                     {.depth = extent.depth, .level = extent.amount, .side = extent.side});
            brush.dipped = action.ink;
            break;
        case BrushActionKind::wipe:
            ink::wipe(brush.reservoir, extent.amount, {extent.depth, extent.side});
            break;
        case BrushActionKind::rinse:
            ink::rinse(brush.reservoir);
            brush::reset(brush.tuft);
            break;
        case BrushActionKind::reshape:
            brush::reshape(brush.tuft);
            break;
    }
    brush.tuft.ink_left = brush.reservoir.fullness();
    brush.tuft.wetness = wetness_of(brush.reservoir);
    put_down(id, action.brush, std::move(brush), {});
}

namespace {

/// Each stamp of a tuft this wide takes a tenth of a second, and a stroke thousands of them.
void check_width(const brush::Preset& preset, double texel) {
    constexpr double kWidest = 2048;  // texels
    const double width = 2 * preset.radius;
    if (width > kWidest * texel)
        throw Error(
            Message("the brush is {} mm wide, {} texels of this model, more than {}: use a larger texel size or a "
                    "smaller brush",
                    1e3 * width, static_cast<long long>(width / texel), static_cast<int>(kWidest)));
}

}  // namespace

void Document::begin(JournalEntry entry) {
    check_layer(entry);
    begin_session(std::get<PaintStroke>(entry.content));
    open_ = std::move(entry);
}

void Document::begin_session(PaintStroke stroke) {
    cancel();
    settle(stroke);
    BrushInHand brush = take_up(stroke);
    const ink::Ink& ink = stroke.erases() ? ink::Ink{} : this->ink(brush.dipped);
    const Model& model = target_model(stroke.layer);
    const ink::Substrate& substrate = substrate_of(stroke.layer);
    const double texel = model.texels.texel_size;
    check_width(brush.tuft.preset, texel);
    const bool erases = stroke.erases(), on_model = &model == model_;
    WetFilmInUse wet;
    if (stroke.settings.film == FilmModel::wet && !erases) {
        if (on_model)
            wet = {&film(stroke.mask), ink::film_params(substrate, stroke.settings.down)};
        else
            wet = {plate().film.get(), plate().params};
    }
    ink::Canvas& canvas = this->canvas(stroke.layer);
    // Masks are of the model's texels.
    const MaskTexels* mask = stroke.mask && on_model ? &this->mask(stroke.mask) : nullptr;
    const SeamLinksFn links = [this, on_model]() -> const atlas::SeamLinks& {
        return on_model ? seams() : plate().seams;
    };
    session_ = std::make_unique<StrokeSession>(SessionInput{.stroke = std::move(stroke),
                                                            .brush = std::move(brush),
                                                            .ink = ink,
                                                            .model = model,
                                                            .substrate = substrate,
                                                            .canvas = canvas,
                                                            .mask = mask,
                                                            .wet = std::move(wet),
                                                            .scratch = *plan_scratch_,
                                                            .seams = links,
                                                            .record_forces = options_.record_forces});
}

void Document::extend(std::span<const brush::Pose> poses) {
    session_->extend(poses);
}

// Ends the stroke in work without a word to the journal.
StrokeReport Document::finish_session(std::uint64_t id) {
    SessionResult result = session_->finish();
    const PaintStroke& stroke = session_->stroke();
    LayerTiles before{stroke.layer, std::move(result.before)};
    if (stroke.erases()) {
        Undo undo{.stroke_id = id};
        undo.before.push_back(std::move(before));
        keep_undo(std::move(undo));
    } else {
        put_down(id, stroke.brush, std::move(result.brush), std::move(before));
    }
    session_.reset();
    return std::move(result.report);
}

StrokeReport Document::end() {
    open_.content = session_->stroke();
    StrokeReport report = finish_session(0);
    report.stroke_id = journal_.append(std::move(open_)).id;
    undo_.back().stroke_id = report.stroke_id;
    return report;
}

void Document::cancel() {
    if (!session_) return;
    ink::Canvas& canvas = this->canvas(session_->stroke().layer);
    for (const ink::TileSnapshot& tile : session_->take_snapshots()) canvas.restore(tile);
    session_.reset();
    forget_pigments(known_pigments_);
}

HandPath Document::path_of(const PaintStroke& stroke) {
    if (!stroke.trace.flat) return {{}, spatial_poses(stroke.trace), 0};
    const brush::Preset& preset = brush(stroke.brush);
    const mesh::SurfaceQuery& query = *target_model(stroke.layer).query;
    HolderOptions options = holder_options(preset, query.mesh());
    if (stroke.settings.compensate_tip_lag) {
        auto [tip_lag, is_new] = tip_lags_.try_emplace(preset.name);
        if (is_new) tip_lag->second = measure_tip_lag(preset);
        options.tip_lag = tip_lag->second;
        TiltedTipLag& leaned = tilted_tip_lags_.try_emplace(preset.name, preset).first->second;
        options.leaned = [&leaned](double depth, const Vec2& lean) { return leaned.at(depth, lean); };
    }
    return hand_path(query, steady(stroke.trace, stroke.settings), options);
}

StrokeReport Document::draw(std::uint64_t id, const PaintStroke& stroke, const ProgressFn& progress) {
    if (stroke.trace.samples.empty()) throw Error("a stroke without samples cannot be painted");
    const HandPath path = path_of(stroke);
    const std::vector<brush::Pose>& poses = path.poses;
    begin_session(stroke);
    session_->set_progress(progress);
    session_->begin_with_set_down(path.set_down);
    try {
        for (std::size_t i = 0; i < poses.size(); ++i)
            session_->advance(std::span(poses).subspan(i, 1),
                              static_cast<double>(i + 1) / static_cast<double>(poses.size()));
        StrokeReport report = finish_session(id);
        if (stroke.trace.flat)
            report.origin_inside =
                contact::depth_inside(*target_model(stroke.layer).query, stroke.trace.placement.origin);
        return report;
    } catch (...) {
        cancel();
        throw;
    }
}

StrokeReport Document::perform(const JournalEntry& entry, const ProgressFn& progress) {
    if (!entry.as<PaintStroke>()) cancel();
    const std::uint64_t id = entry.id;
    const auto done = [id] { return StrokeReport{.stroke_id = id}; };
    return std::visit(Overloaded{[&](const PaintStroke& stroke) { return draw(id, stroke, progress); },
                                 [&](const BrushAction& action) { return act(id, action), done(); },
                                 [&](const Dry& wait) { return dry(id, wait, progress), done(); },
                                 [&](const WashPalette&) { return wash(id), done(); },
                                 [&](const Fill& fill) { return lay_fill(id, fill); },
                                 [&](const LayerEdit& edit) { return edit_layers(id, edit), done(); },
                                 [&](const MaskEdit& edit) { return edit_masks(id, edit), done(); }},
                      entry.content);
}

StrokeReport Document::paint(JournalEntry entry, const ProgressFn& progress) {
    entry.id = 0;  // none yet, whatever journal it comes from
    check_layer(entry);
    settle(entry.content);
    StrokeReport report;
    try {
        report = perform(entry, progress);
    } catch (...) {
        forget_pigments(known_pigments_);
        throw;
    }
    report.stroke_id = journal_.append(std::move(entry)).id;
    undo_.back().stroke_id = report.stroke_id;
    return report;
}

ink::ComposeOptions Document::compose_options() const {
    if (!gutter_)
        gutter_ = std::make_unique<ink::GutterPlan>(ink::plan_gutter(*model_->mesh, model_->atlas, model_->texels));
    return {.gutter = model_->atlas.gutter, .seams = gutter_.get()};
}

Vec3 Document::device_force() const {
    return session_ ? session_->device_force() : Vec3{0};
}
const brush::TuftState* Document::tuft() const {
    return session_ ? &session_->tuft() : nullptr;
}

std::vector<StrokeReport> Document::replay(std::vector<JournalEntry> entries, const ProgressFn& progress) {
    std::vector<StrokeReport> reports;
    const double all = std::max<double>(1.0, static_cast<double>(entries.size()));
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (!entries[i].hidden) {
            StrokeReport report = perform(entries[i], [&](std::string_view phase, double fraction) {
                return !progress || progress(phase, (static_cast<double>(i) + fraction) / all);
            });
            report.stroke_id = entries[i].id;
            if (entries[i].as<PaintStroke>()) reports.push_back(std::move(report));
        }
        journal_.restore(std::move(entries[i]));
    }
    return reports;
}

void Document::adopt(std::vector<JournalEntry> entries, ink::Canvas canvas) {
    const std::uint64_t last = entries.empty() ? 0 : entries.back().id;
    std::vector<LayerCanvas> canvases;
    canvases.push_back({kFirstLayer, std::move(canvas)});
    adopt(std::move(entries), std::move(canvases), last);
}

namespace {

/// Whether the tables of layers and masks are all that the entry changes: no texel was taken away.
bool changes_tables_only(const JournalEntry& entry) {
    const LayerEdit* edit = entry.as<LayerEdit>();
    return entry.as<MaskEdit>() || (edit && edit->what != LayerChange::remove && edit->what != LayerChange::merge);
}

}  // namespace

bool Document::undo() {
    cancel();
    if (!journal_.can_undo()) return false;
    const JournalEntry& entry = journal_.entries().back();
    const std::uint64_t id = entry.id;
    const bool hidden = entry.hidden, table_only = changes_tables_only(entry);
    journal_.undo();
    if (hidden) return true;
    if (undo_.empty() || undo_.back().stroke_id != id) {
        if (table_only) {
            set_layers(layers_after(journal_.entries()));
            masks_ = masks_after(journal_.entries());
        } else {
            repaint_all();
        }
        return true;
    }
    Undo& last = undo_.back();
    take_back_layers(last);
    if (last.brush_before)
        held_.insert_or_assign(last.brush, std::move(*last.brush_before));
    else if (!last.brush.empty())
        held_.erase(last.brush);
    forget_pigments(last.pigments);
    undo_bytes_ -= last.bytes;
    undo_.pop_back();
    return true;
}

bool Document::redo() {
    cancel();
    if (!journal_.redo()) return false;
    if (const JournalEntry& entry = journal_.entries().back(); !entry.hidden) perform(entry, {});
    return true;
}

void Document::repaint_all() {
    for (const LayerTexels& layer : canvases()) touch_look(layer.layer);
    canvas_.clear();
    upper_.clear();
    if (palette_) palette_->canvas.clear();
    layers_ = {};
    masks_ = {};
    held_.clear();
    undo_.clear();
    undo_bytes_ = 0;
    forget_pigments(0);
    for (const JournalEntry& entry : journal_.entries())
        if (!entry.hidden) perform(entry, {});
}

}  // namespace tuft::stroke
