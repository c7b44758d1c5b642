#include "stroke/painting/painting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/outside.h"
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
void Document::settle(Stroke& entry) const {
    if (entry.action == Action::layer &&
        (entry.edit.what == LayerChange::add || entry.edit.what == LayerChange::duplicate) && entry.edit.layer.id == 0)
        entry.edit.layer.id = layers_.next_id;
    if (entry.action == Action::mask && !entry.mask_edit.remove && entry.mask_edit.mask.id == 0)
        entry.mask_edit.mask.id = masks_.next_id;
    if (entry.layer == kPaletteLayer) entry.settings.film = "wet";
    if (!has_brush(entry.action) || entry.trace.erases) return;
    const BrushInHand* last = held(entry.trace.brush);
    if (!last) entry.settings.dip = "each";
    if (last && entry.action != Action::stroke && entry.trace.ink.empty()) entry.trace.ink = last->dipped;
}

// The brush an entry begins with.
BrushInHand Document::take_up(const Stroke& entry) {
    brush::Preset preset = brush(entry.trace.brush);
    if (entry.settings.spine == "table") preset.spine = brush::SpineMethod::table;
    if (entry.trace.erases) {
        // A clean brush of its own, full of water: its hair lies together, it leaves nothing.
        BrushInHand clean{brush::make_tuft(preset), {}, {}, {}};
        clean.reservoir = empty_reservoir(clean.tuft);
        ink::dip(clean.reservoir, ink::Mix{});
        return clean;
    }
    const std::string& named = entry.trace.ink;
    const ink::Mix mix = mix_of(named);
    const BrushInHand* last = entry.settings.dip == "carry" ? held(entry.trace.brush) : nullptr;
    if (!last || last->tuft.preset.spine != preset.spine) {
        BrushInHand fresh{brush::make_tuft(preset, entry.trace.seed), {}, named, named};
        fresh.reservoir = empty_reservoir(fresh.tuft);
        ink::dip(fresh.reservoir, mix);
        return fresh;
    }
    BrushInHand brush = *last;
    if (entry.action == Action::stroke) {
        if (named != brush.named && named != brush.dipped) {
            ink::rinse(brush.reservoir);
            brush::reset(brush.tuft);
            ink::dip(brush.reservoir, mix);
            brush.dipped = named;
        }
        brush.named = named;
    }
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

void Document::act(const Stroke& entry, const ProgressFn& progress) {
    if (entry.action == Action::dry) return dry(entry, progress);
    if (entry.action == Action::layer) return edit_layers(entry);
    if (entry.action == Action::mask) return edit_masks(entry);
    if (entry.action == Action::wash) return wash(entry);
    BrushInHand brush = take_up(entry);
    switch (entry.action) {
        case Action::dip:
            ink::dip(brush.reservoir, mix_of(entry.trace.ink),
                     {.depth = entry.extent.depth, .level = entry.extent.amount, .side = entry.extent.side});
            brush.dipped = entry.trace.ink;
            break;
        case Action::wipe:
            ink::wipe(brush.reservoir, entry.extent.amount, {entry.extent.depth, entry.extent.side});
            break;
        case Action::rinse:
            ink::rinse(brush.reservoir);
            brush::reset(brush.tuft);
            break;
        case Action::reshape:
            brush::reshape(brush.tuft);
            break;
        case Action::dry:
        case Action::layer:
        case Action::mask:
        case Action::fill:
        case Action::wash:
        case Action::stroke:
            break;
    }
    brush.tuft.ink_left = brush.reservoir.fullness();
    brush.tuft.wetness = wetness_of(brush.reservoir);
    put_down(entry.id, entry.trace.brush, std::move(brush), {});
}

namespace {

/// Each stamp of a tuft this wide takes a tenth of a second, and a stroke thousands of them.
void check_width(const brush::Preset& preset, double texel) {
    constexpr double kWidest = 2048;  // texels
    const double width = 2 * preset.radius;
    if (width > kWidest * texel)
        throw Error("the brush is " + std::to_string(1e3 * width) + " mm wide, " +
                    std::to_string(static_cast<long long>(width / texel)) + " texels of this model, more than " +
                    std::to_string(static_cast<int>(kWidest)) + ": use a larger texel size or a smaller brush");
}

}  // namespace

void Document::begin(Stroke stroke) {
    check_layer(stroke);
    begin_session(std::move(stroke));
}

void Document::begin_session(Stroke stroke) {
    cancel();
    settle(stroke);
    BrushInHand brush = take_up(stroke);
    const ink::Ink& ink = stroke.trace.erases ? ink::Ink{} : this->ink(brush.dipped);
    const Model& model = target_model(stroke);
    const ink::Substrate& substrate = substrate_of(stroke);
    const double texel = model.texels.texel_size;
    check_width(brush.tuft.preset, texel);
    const bool erases = stroke.trace.erases, on_model = &model == model_;
    WetFilmInUse wet;
    if (stroke.settings.film == "wet" && !erases) {
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
StrokeReport Document::finish_session() {
    SessionResult result = session_->finish();
    const Stroke& stroke = session_->stroke();
    LayerTiles before{stroke.layer, std::move(result.before)};
    if (stroke.trace.erases) {
        Undo undo{.stroke_id = stroke.id};
        undo.before.push_back(std::move(before));
        keep_undo(std::move(undo));
    } else {
        put_down(stroke.id, stroke.trace.brush, std::move(result.brush), std::move(before));
    }
    session_.reset();
    return std::move(result.report);
}

StrokeReport Document::end() {
    Stroke stroke = session_->stroke();
    StrokeReport report = finish_session();
    report.stroke_id = journal_.append(std::move(stroke)).id;
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

HandPath Document::path_of(const Stroke& stroke) {
    if (!stroke.trace.flat) return {{}, spatial_poses(stroke.trace), 0};
    const brush::Preset& preset = brush(stroke.trace.brush);
    const mesh::SurfaceQuery& query = *target_model(stroke).query;
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

StrokeReport Document::draw(const Stroke& stroke, const ProgressFn& progress) {
    if (stroke.action != Action::stroke) {
        cancel();
        if (stroke.action == Action::fill) return lay_fill(stroke);
        act(stroke, progress);
        return {.stroke_id = stroke.id};
    }
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
        StrokeReport report = finish_session();
        if (stroke.trace.flat)
            report.origin_inside = contact::depth_inside(*target_model(stroke).query, stroke.trace.placement.origin);
        return report;
    } catch (...) {
        cancel();
        throw;
    }
}

StrokeReport Document::paint(Stroke stroke, const ProgressFn& progress) {
    stroke.id = 0;  // none yet, whatever journal it comes from
    check_layer(stroke);
    settle(stroke);
    StrokeReport report;
    try {
        report = draw(stroke, progress);
    } catch (...) {
        forget_pigments(known_pigments_);
        throw;
    }
    report.stroke_id = journal_.append(std::move(stroke)).id;
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

std::vector<StrokeReport> Document::replay(std::vector<Stroke> strokes, const ProgressFn& progress) {
    std::vector<StrokeReport> reports;
    const double all = std::max<double>(1.0, static_cast<double>(strokes.size()));
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        if (!strokes[i].hidden) {
            StrokeReport report = draw(strokes[i], [&](std::string_view phase, double fraction) {
                return !progress || progress(phase, (static_cast<double>(i) + fraction) / all);
            });
            report.stroke_id = strokes[i].id;
            if (strokes[i].action == Action::stroke) reports.push_back(std::move(report));
        }
        journal_.restore(std::move(strokes[i]));
    }
    return reports;
}

void Document::adopt(std::vector<Stroke> strokes, ink::Canvas canvas) {
    const std::uint64_t last = strokes.empty() ? 0 : strokes.back().id;
    std::vector<LayerCanvas> canvases;
    canvases.push_back({kFirstLayer, std::move(canvas)});
    adopt(std::move(strokes), std::move(canvases), last);
}

bool Document::undo() {
    cancel();
    if (!journal_.can_undo()) return false;
    const std::uint64_t id = journal_.strokes().back().id;
    const bool hidden = journal_.strokes().back().hidden;
    const bool table_only = keeps_texels(journal_.strokes().back().action) &&
                            (journal_.strokes().back().action == Action::mask ||
                             (journal_.strokes().back().edit.what != LayerChange::remove &&
                              journal_.strokes().back().edit.what != LayerChange::merge));
    journal_.undo();
    if (hidden) return true;
    if (undo_.empty() || undo_.back().stroke_id != id) {
        if (table_only) {
            set_layers(layers_after(journal_.strokes()));
            masks_ = masks_after(journal_.strokes());
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
    if (const Stroke& stroke = journal_.strokes().back(); !stroke.hidden) draw(stroke, {});
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
    for (const Stroke& stroke : journal_.strokes())
        if (!stroke.hidden) draw(stroke, {});
}

}  // namespace tuft::stroke
