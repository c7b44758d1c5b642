#include "stroke/painting/painting.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/contact.h"
#include "core/ease.h"
#include "stroke/hand/hand.h"
#include "stroke/painting/painting_hand.h"

namespace tuft::stroke {
namespace {

constexpr double kLeap = 0.5;  // of a patch's size: beyond, single marks would part

// Metres: furrows and edges of paste are rounded over more than a tenth of a millimetre.
constexpr double kPasteStep = 1e-4, kPasteCell = 4e-5;

constexpr double kCourse = 2e-3, kSwing = 1e-3;  // metres of travel over which the hand's course is taken, and the hair's
constexpr double kComesToLie = 2e-3;  // metres of travel after a press in which hair turns to where it is drawn
// Parts of the hand's motion that are up or down, from one to the other of which it presses or lifts.
constexpr double kSlants = 0.2, kPlunges = 0.5;

/// Hair is wet while it holds ink; the last quarter of its fill leaves it to dry.
double wetness_of(const ink::Reservoir& reservoir) {
    constexpr double kWet = 0.25;
    const double x = std::clamp(reservoir.fullness() / kWet, 0.0, 1.0);
    return x * (2 - x);
}

ink::Reservoir empty_reservoir(const brush::Tuft& tuft) {
    brush::HairCells cells = brush::hair_cells(tuft.preset);
    return ink::make_reservoir(tuft.preset.capacity * 1e6, {.bundles = tuft.bundles.place,
                                                           .cell_ends = std::move(cells.ends),
                                                           .cell_rooms = std::move(cells.rooms)});
}

}  // namespace

Painting::Painting(const Model& model, const PaintingOptions& options)
    : model_(&model),
      options_(options),
      substrate_(ink::load_substrate(options.substrate)),
      canvas_(model.texels.n_slots()),
      plan_rooms_(std::make_unique<PlanRooms>()) {}

Painting::~Painting() = default;
Painting::Painting(Painting&&) noexcept = default;
Painting& Painting::operator=(Painting&&) noexcept = default;

void Painting::use_brush(const brush::Preset& preset) {
    brushes_[preset.name] = preset;
    held_.erase(preset.name);
}
void Painting::use_ink(const ink::Ink& ink) { inks_[ink.name] = ink; }

const brush::Preset& Painting::brush(const std::string& name) {
    const auto found = brushes_.find(name);
    if (found != brushes_.end()) return found->second;
    return brushes_.emplace(name, brush::load_preset(name)).first->second;
}

const ink::Ink& Painting::ink(const std::string& name) {
    const auto found = inks_.find(name);
    if (found != inks_.end()) return found->second;
    return inks_.emplace(name, ink::load_ink(name)).first->second;
}

const BrushInHand* Painting::held(const std::string& brush) const {
    const auto found = held_.find(brush);
    return found == held_.end() ? nullptr : &found->second;
}

// A brush that is not held is fresh; the entry says so, for replays that hold it.
void Painting::settle(Stroke& entry) const {
    if (entry.action == Action::layer && entry.edit.what == LayerChange::add && entry.edit.layer.id == 0)
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
BrushInHand Painting::take_up(const Stroke& entry) {
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
void Painting::put_down(std::uint64_t id, const std::string& brush, BrushInHand after, LayerTiles before) {
    Undo undo{.stroke_id = id, .brush = brush};
    undo.before.push_back(std::move(before));
    if (const auto found = held_.find(brush); found != held_.end()) {
        undo.brush_before = std::move(found->second);
        undo.bytes += sizeof(BrushInHand);
    }
    held_.insert_or_assign(brush, std::move(after));
    keep_undo(std::move(undo));
}

void Painting::keep_undo(Undo undo) {
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
void Painting::forget_pigments(std::size_t n) {
    known_pigments_ = n;
    if (n >= canvas_.pigments().size()) return;
    canvas_.forget_pigments(n);
    for (auto& [layer, canvas] : upper_) canvas.forget_pigments(n);
    if (palette_) palette_->canvas.forget_pigments(n);
}

void Painting::act(const Stroke& entry, const ProgressFn& progress) {
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
        case Action::wipe: ink::wipe(brush.reservoir, entry.extent.amount, {entry.extent.depth, entry.extent.side}); break;
        case Action::rinse:
            ink::rinse(brush.reservoir);
            brush::reset(brush.tuft);
            break;
        case Action::reshape: brush::reshape(brush.tuft); break;
        case Action::dry:
        case Action::layer:
        case Action::mask:
        case Action::fill:
        case Action::wash:
        case Action::stroke: break;
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

void Painting::begin(Stroke stroke) {
    check_layer(stroke);
    begin_hand(std::move(stroke));
}

void Painting::begin_hand(Stroke stroke) {
    cancel();
    settle(stroke);
    BrushInHand brush = take_up(stroke);
    const ink::Ink& ink = stroke.trace.erases ? ink::Ink{} : this->ink(brush.dipped);
    const Model& model = ground_of(stroke);
    const ink::Substrate& substrate = substrate_of(stroke);
    const double texel = model.texels.texel_size;
    check_width(brush.tuft.preset, texel);
    const bool paste = ink.yield > 0;
    const double spacing = std::max(stroke.settings.spacing * texel, paste ? kPasteStep : 0.0);
    ink::Canvas& canvas = this->canvas(stroke.layer);
    // Masks are of the model's texels.
    const bool masked = stroke.mask && stroke.layer != kPaletteLayer;
    const MaskTexels* mask = masked ? &this->mask(stroke.mask) : nullptr;
    hand_ = std::make_unique<Hand>(std::move(stroke), std::move(brush), ink, model, canvas, substrate,
                                   *plan_rooms_, spacing, texel);
    hand_->stamper.keep_to(mask);
    hand_->mixed = !hand_->stroke.trace.erases && ink::is_mixed(hand_->reservoir);
    hand_->paste = paste;
    if (paste) hand_->cell = std::max(hand_->cell, kPasteCell);
    const Settings& settings = hand_->stroke.settings;
    if (settings.film != "wet" || hand_->stroke.trace.erases) return;
    if (&model == model_) hand_->wet.emplace(film(hand_->stroke.mask), canvas, ink::film_params(substrate, settings.down));
    else hand_->wet.emplace(*plate().film, canvas, plate().params);
}

void Painting::extend(std::span<const brush::Pose> poses) {
    Trace piece{.flat = false};
    for (const brush::Pose& pose : poses)
        piece.samples.push_back({.time = pose.time, .position = pose.position, .rotation = pose.rotation});
    std::vector<TraceSample>& samples = hand_->stroke.trace.samples;
    samples.insert(samples.end(), piece.samples.begin(), piece.samples.end());
    advance(spatial_poses(piece));  // as a replay will see them, to the bit
}

void Painting::advance(std::span<const brush::Pose> poses) {
    for (const brush::Pose& pose : poses) {
        ++hand_->report.samples;
        const bool as_is = hand_->stroke.trace.flat;  // then the whole trace was steadied
        hand_->resampler.push(as_is ? pose : steady(hand_->steady, pose, hand_->stroke.settings), hand_->poses);
    }
    draw_poses();
}

void Painting::draw_poses() {
    Hand& h = *hand_;
    for (const brush::Pose& pose : h.poses) {
        tuft::report(h.progress, "painting", h.done);
        h.tuft.ink_left = h.reservoir.fullness();
        h.tuft.wetness = wetness_of(h.reservoir);
        const double dt = h.moved ? pose.time - h.last_time : 0.0;
        ink::flow(h.reservoir, dt, h.by_hair ? ink::FlowTo::now : ink::FlowTo::whole_step);
        // A hair that painted before comes through the air, as it sprang back.
        if (!h.moved && h.tuft.posed) brush::step(h.tuft, pose, {}, 0);
        contact::Result contact =
            contact::step(h.tuft, pose, *h.model->query, h.memory, dt, h.contact_options);
        h.force = contact.hand_force;
        h.last_time = pose.time;
        h.moved = true;
        if (h.wet) h.wet->pass(h.stamper, dt, h.film_progress);
        h.bend(contact.tuft, pose);
        h.report.nearest = std::min(h.report.nearest, contact.distance);
        if (options_.record_forces)
            h.report.forces.push_back({pose, contact.tuft.force, h.force,
                                       contact.tuft.moment, contact.tuft.root_moment});
        if (!contact.tuft.touching || contact.triangle == kNone) {
            h.was_touching = false;
            continue;
        }
        if (!contact.tuft.converged) ++h.report.unconverged;

        if (h.was_touching) h.move_on(pose, dt);
        const Vec3 way = h.was_touching ? pose.position - h.last_position : Vec3{0};
        const auto flat = [&](const Vec3& v) { return Vec2{glm::dot(v, contact.frame.t), glm::dot(v, contact.frame.b)}; };
        const Vec2 shift = flat(way);
        if (!h.was_touching) h.tracks = {};
        // The hair's own way: hair that is lifted goes on along its track while the hand stands or turns back.
        const Vec2 drawn = h.was_touching ? flat(contact.travel) : Vec2{0};
        const double slid = glm::length(drawn);
        h.slid += slid;
        if (slid > 0) h.heading = drawn / slid;
        const double along = glm::length(shift);
        h.went = h.was_touching ? std::exp(-slid / kSwing) * h.went + drawn.x * contact.frame.t + drawn.y * contact.frame.b : Vec3{0};
        const double up = std::abs(glm::dot(way, contact.frame.n));
        const double plunges = up > 0 ? smooth_step((up / (up + along) - kSlants) / (kPlunges - kSlants)) : 0;
        // Pressed or lifted, a tuft that is held to a line moves to take in or give back its lead:
        // that is no course.
        const double goes = 1 - plunges * std::min(1.0, glm::length(h.course) / kCourse);
        h.course = h.was_touching
                       ? std::exp(-goes * along / kCourse) * h.course +
                             goes * (shift.x * contact.frame.t + shift.y * contact.frame.b)
                       : Vec3{0};
        h.lands = std::max(plunges, h.was_touching ? std::exp(-along / kComesToLie) * h.lands : 0);
        if (h.by_hair) h.pay(h.instalment);
        Stamp stamp = h.make_stamp(contact, dt);
        if (stamp.footprint.empty()) {
            h.was_touching = false;
            continue;
        }
        const double area = footprint_area(stamp.footprint);
        if (!h.tape.empty() && !(area > 0)) {  // on the tape
            h.was_touching = true;
            h.last_position = pose.position;
            continue;
        }
        ++h.report.stamps;
        // The hand's way, not the frame's: the patch also grows and shrinks. Hair that lies by itself may swing round.
        // And a patch that leaps by more than it is long, as a tip does that springs back while it is lifted, leaves its
        // line along its own way.
        const double leap = smooth_step(glm::length(drawn - shift) / std::sqrt(std::max(area, 1e-30)) / kLeap);
        stamp.motion.shift = glm::mix(shift, drawn, std::max(leap, static_cast<double>(stamp.apart)));
        // Dry hair leaves ink by the way it is drawn: where it only comes to touch a tip that leans would print a speck
        // that its stroke, which begins where it has been pressed aside, does not reach.
        stamp.ds = h.was_touching ? h.step : (1 - static_cast<double>(stamp.apart)) * h.step;
        h.was_touching = true;
        h.last_position = pose.position;
        const ink::StampContact touch{
            .moment_factor = h.stress(contact),
            .width = h.closed_area > 0 ? area / std::sqrt(h.closed_area) : std::sqrt(area),
            // A batch shares what is left; mixed ink comes stamp by stamp.
            .area = area * (h.mixed || h.paste ? 1.0 : static_cast<double>(Stamper::kBatch)),
            .owed = h.owed,
            .by_hair = static_cast<double>(stamp.apart),
            .touch = h.touched};
        stamp.ink = ink::stamp_deposit(h.reservoir, h.ink, touch, *h.substrate);
        stamp.ink.capacity = std::max(h.substrate->capacity, static_cast<float>(ink::standing_film(h.ink.yield)));
        if (h.stroke.trace.erases) stamp.erases = 2 + 2 * touch.moment_factor;  // sooner than ink is given: tips rub off what tips left
        if (h.paste) {
            h.report.ink_given += h.lay_paste(stamp, touch.moment_factor);
            continue;
        }
        if (h.wet) {
            h.report.ink_given += h.wet->lay(
                h.stamper, stamp, h.reservoir, h.touched, h.nodes, h.comb(),
                {touch.moment_factor, std::abs(glm::dot(contact.tuft.force, contact.frame.n))},
                h.drain(pose, contact.frame.origin));
            continue;
        }
        if (h.mixed) {
            h.report.ink_given += h.lay_mixed(stamp);
            continue;
        }
        if (h.stamper.add(std::move(stamp))) h.flush();
    }
    h.poses.clear();
}

// Ends the stroke in work without a word to the journal.
StrokeReport Painting::finish_hand() {
    Hand& h = *hand_;
    h.resampler.finish(h.poses);
    draw_poses();
    h.flush();
    h.pay(h.owed);
    atlas::SeamLinks of_palette;
    const auto links = [&]() -> const atlas::SeamLinks& {
        if (h.model == model_) return seams();
        return of_palette = atlas::build_seam_links(*h.model->mesh, h.model->atlas, h.model->texels);
    };
    if (h.paste) h.stamper.level(links(), ink::levelling_length(h.ink.yield, h.ink.film * ink::kFilmUnit));
    else if (!h.wet && !h.stroke.trace.erases && h.stamper.on_relief()) h.stamper.pool(links(), h.ink.film, h.ink.strength());
    if (h.stroke.trace.erases && this->canvas(h.stroke.layer).wet()) h.stamper.blot(links());
    if (h.wet) h.wet->end(h.stamper, h.reservoir, h.touched, h.nodes, h.film_progress);
    h.report.ink_left = h.reservoir.remaining();
    if (h.report.touched()) h.report.nearest = 0;
    h.report.removed = h.stamper.erased();
    const std::string name = h.stroke.trace.brush;
    if (h.stroke.trace.erases) {
        Undo undo{.stroke_id = h.stroke.id};
        undo.before.push_back({h.stroke.layer, h.stamper.take_before()});
        keep_undo(std::move(undo));
    } else
        put_down(h.stroke.id, name, {std::move(h.tuft), h.reservoir, h.dipped, h.stroke.trace.ink},
             {h.stroke.layer, h.stamper.take_before()});
    StrokeReport report = std::move(h.report);
    hand_.reset();
    return report;
}

StrokeReport Painting::end() {
    Stroke stroke = hand_->stroke;
    StrokeReport report = finish_hand();
    report.stroke_id = journal_.append(std::move(stroke)).id;
    undo_.back().stroke_id = report.stroke_id;
    return report;
}

void Painting::cancel() {
    if (!hand_) return;
    ink::Canvas& canvas = this->canvas(hand_->stroke.layer);
    for (const ink::TileSnapshot& tile : hand_->stamper.take_before()) canvas.restore(tile);
    hand_.reset();
    forget_pigments(known_pigments_);
}

std::vector<brush::Pose> Painting::poses_of(const Stroke& stroke) {
    if (!stroke.trace.flat) return spatial_poses(stroke.trace);
    const brush::Preset& preset = brush(stroke.trace.brush);
    const mesh::SurfaceQuery& query = *ground_of(stroke).query;
    HoldOptions options = hold_options(preset, query.mesh());
    if (stroke.settings.lead) {
        auto [lead, is_new] = leads_.try_emplace(preset.name);
        if (is_new) lead->second = drag_lead(preset);
        options.lead = lead->second;
        LeanedLead& leaned = leaned_leads_.try_emplace(preset.name, preset).first->second;
        options.leaned = [&leaned](double depth, const Vec2& lean) { return leaned.at(depth, lean); };
    }
    return hand_path(query, steady(stroke.trace, stroke.settings), options).poses;
}

StrokeReport Painting::draw(const Stroke& stroke, const ProgressFn& progress) {
    if (stroke.action != Action::stroke) {
        cancel();
        if (stroke.action == Action::fill) return lay_fill(stroke);
        act(stroke, progress);
        return {.stroke_id = stroke.id};
    }
    if (stroke.trace.samples.empty()) throw Error("a stroke without samples cannot be painted");
    const std::vector<brush::Pose> poses = poses_of(stroke);
    begin_hand(stroke);
    hand_->progress = progress;
    if (progress)
        hand_->film_progress = [&progress, &h = *hand_](std::string_view, double) { return progress("painting", h.done); };
    try {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            advance(std::span(poses).subspan(i, 1));
            hand_->done = static_cast<double>(i + 1) / static_cast<double>(poses.size());
        }
        return finish_hand();
    } catch (...) {
        cancel();
        throw;
    }
}

StrokeReport Painting::paint(Stroke stroke, const ProgressFn& progress) {
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

ink::ComposeOptions Painting::compose_options() const {
    if (!gutter_)
        gutter_ = std::make_unique<ink::GutterPlan>(
            ink::plan_gutter(*model_->mesh, model_->atlas, model_->texels));
    return {.gutter = model_->atlas.gutter, .seams = gutter_.get()};
}

Vec3 Painting::hand_force() const { return hand_ ? hand_->force : Vec3{0}; }
const brush::TuftState* Painting::tuft() const { return hand_ ? &hand_->state : nullptr; }

std::vector<StrokeReport> Painting::replay(std::vector<Stroke> strokes, const ProgressFn& progress) {
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

void Painting::adopt(std::vector<Stroke> strokes, ink::Canvas canvas) {
    const std::uint64_t last = strokes.empty() ? 0 : strokes.back().id;
    std::vector<LayerCanvas> canvases;
    canvases.push_back({kFirstLayer, std::move(canvas)});
    adopt(std::move(strokes), std::move(canvases), last);
}

bool Painting::undo() {
    cancel();
    if (!journal_.can_undo()) return false;
    const std::uint64_t id = journal_.strokes().back().id;
    const bool hidden = journal_.strokes().back().hidden;
    const bool table_only = keeps_texels(journal_.strokes().back().action) &&
                            (journal_.strokes().back().action == Action::mask ||
                             journal_.strokes().back().edit.what != LayerChange::remove);
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
    if (last.brush_before) held_.insert_or_assign(last.brush, std::move(*last.brush_before));
    else if (!last.brush.empty()) held_.erase(last.brush);
    forget_pigments(last.pigments);
    undo_bytes_ -= last.bytes;
    undo_.pop_back();
    return true;
}

bool Painting::redo() {
    cancel();
    if (!journal_.redo()) return false;
    if (const Stroke& stroke = journal_.strokes().back(); !stroke.hidden) draw(stroke, {});
    return true;
}

void Painting::repaint_all() {
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
