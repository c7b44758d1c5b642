#include "stroke/painting.h"

#include <algorithm>
#include <cmath>

#include "contact/contact.h"
#include "footprint/outline.h"
#include "ink/reservoir.h"
#include "stroke/placement.h"
#include "stroke/resample.h"
#include "stroke/stamper.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kPosesPerReport = 64;

footprint::StampOptions stamp_options(const Settings& settings) {
    footprint::StampOptions o;
    o.mapping = settings.footprint == "plane" ? footprint::Mapping::plane : footprint::Mapping::log;
    return o;
}

// Half of the width across the motion, from the picture's box: near enough for the
// ink's supply, which only asks how broad the brush paints.
double footprint_area(const footprint::Footprint& f) {
    std::size_t sum = 0;
    for (const std::uint8_t c : f.coverage) sum += c;
    return static_cast<double>(sum) / 255.0 * f.cell * f.cell;
}

}  // namespace

// The stroke in work: everything between the hand's samples and the texels.
struct Painting::Hand {
    Stroke stroke;
    brush::Tuft tuft;
    ink::Ink ink;
    ink::Reservoir reservoir;
    ink::Mix mix;
    contact::Memory memory;
    contact::Options contact_options;
    Resampler resampler;
    Stamper stamper;
    Placer placer;
    double step = 0, cell = 0;
    std::vector<brush::Pose> poses;
    StrokeReport report;
    brush::TuftState state;
    double last_time = 0;
    bool moved = false, was_touching = false;
    Frame last_frame;

    Hand(Stroke s, const brush::Preset& preset, const ink::Ink& i, const Model& model,
         ink::Canvas& canvas, double step_, double texel)
        : stroke(std::move(s)),
          tuft(brush::make_tuft(preset)),
          ink(i),
          reservoir(ink::make_reservoir(preset.capacity * 1e6)),
          mix(ink::mix_of(canvas, i)),
          resampler({.step = step_, .lever = preset.length}),
          stamper(model, canvas, stamp_options(stroke.settings)),
          placer(*model.mesh, *model.query, stroke.trace, preset),
          step(step_),
          cell(0.5 * texel) {
        contact_options.method = stroke.settings.contact == "vertices" ? contact::Method::vertices
                                                                       : contact::Method::exact;
        ink::dip(reservoir, mix);
        report.nearest = std::numeric_limits<double>::infinity();
    }
};

Painting::Painting(const Model& model, const PaintingOptions& options)
    : model_(&model),
      options_(options),
      substrate_(ink::load_substrate(options.substrate)),
      canvas_(model.texels.n_slots()) {}

Painting::~Painting() = default;
Painting::Painting(Painting&&) noexcept = default;
Painting& Painting::operator=(Painting&&) noexcept = default;

void Painting::use_brush(const brush::Preset& preset) { brushes_[preset.name] = preset; }
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

void Painting::begin(Stroke stroke) {
    cancel();
    brush::Preset preset = brush(stroke.trace.brush);
    if (stroke.settings.spine == "table") preset.spine = brush::SpineMethod::table;
    const double texel = model_->texels.texel_size;
    // A thin brush needs no finer steps than a tenth of its width.
    const double spacing = stroke.settings.spacing * texel;
    hand_ = std::make_unique<Hand>(std::move(stroke), preset, ink(stroke.trace.ink), *model_,
                                   canvas_, spacing, texel);
}

void Painting::extend(std::span<const TraceSample> samples) {
    Hand& h = *hand_;
    for (const TraceSample& sample : samples) {
        h.stroke.trace.samples.push_back(sample);
        ++h.report.samples;
        if (const auto pose = h.placer.pose(sample)) h.resampler.push(*pose, h.poses);
    }
    draw_poses();
}

void Painting::draw_poses() {
    Hand& h = *hand_;
    const auto flush = [&] {
        const double given = h.stamper.flush();
        ink::take(h.reservoir, std::min(given, h.reservoir.remaining()));
        h.report.ink_given += given;
    };
    for (const brush::Pose& pose : h.poses) {
        h.tuft.ink_left = h.reservoir.fullness();
        const double dt = h.moved ? pose.time - h.last_time : 0.0;
        contact::Result contact =
            contact::step(h.tuft, pose, *model_->query, h.memory, dt, h.contact_options);
        h.last_time = pose.time;
        h.moved = true;
        h.state = contact.tuft;
        if (contact.triangle != kNone) h.report.nearest = std::min(h.report.nearest, contact.distance);
        else h.report.nearest = std::min(h.report.nearest, contact.distance);
        if (options_.record_forces)
            h.report.forces.push_back({pose, contact.tuft.force, contact.tuft.root_moment});
        if (!contact.tuft.touching || contact.triangle == kNone) {
            h.was_touching = false;
            continue;
        }
        if (!contact.tuft.converged) ++h.report.unconverged;

        const std::vector<footprint::Outline> outlines =
            footprint::outline(contact.tuft, contact.frame);
        Stamp stamp;
        stamp.footprint = footprint::rasterise(outlines, contact.frame, contact.triangle, h.cell);
        if (stamp.footprint.empty()) {
            h.was_touching = false;
            continue;
        }
        ++h.report.stamps;
        if (h.was_touching) {
            const Vec3 d = contact.frame.origin - h.last_frame.origin;
            stamp.motion.shift = {glm::dot(d, contact.frame.t), glm::dot(d, contact.frame.b)};
        }
        h.was_touching = true;
        h.last_frame = contact.frame;
        const double area = footprint_area(stamp.footprint);
        const double moment_limit = h.tuft.preset.stiffness / h.tuft.preset.length;
        const ink::StampContact touch{
            .moment_factor = std::min(1.0, std::abs(contact.tuft.root_moment) / moment_limit),
            .width = std::sqrt(area),
            // A batch shares what is left.
            .area = area * static_cast<double>(Stamper::kBatch)};
        stamp.ink = ink::stamp_deposit(h.reservoir, h.ink, touch, substrate_);
        stamp.ink.capacity = substrate_.capacity;
        stamp.ds = h.step;
        if (h.stamper.add(std::move(stamp))) flush();
    }
    h.poses.clear();
}

StrokeReport Painting::end() {
    Hand& h = *hand_;
    h.resampler.finish(h.poses);
    draw_poses();
    const double given = h.stamper.flush();
    ink::take(h.reservoir, std::min(given, h.reservoir.remaining()));
    h.report.ink_given += given;
    h.report.ink_left = h.reservoir.remaining();
    if (h.report.touched()) h.report.nearest = 0;
    const Stroke& kept = journal_.append(std::move(h.stroke));
    h.report.stroke_id = kept.id;
    keep_undo(kept.id, h.stamper.take_before());
    StrokeReport report = std::move(h.report);
    hand_.reset();
    return report;
}

void Painting::cancel() {
    if (!hand_) return;
    for (const ink::TileSnapshot& tile : hand_->stamper.take_before()) canvas_.restore(tile);
    hand_.reset();
}

StrokeReport Painting::paint(Stroke stroke, const ProgressFn& progress) {
    const std::vector<TraceSample> samples = std::move(stroke.trace.samples);
    stroke.trace.samples.clear();
    if (samples.empty()) throw Error("a stroke without samples cannot be painted");
    begin(std::move(stroke));
    try {
        for (std::size_t i = 0; i < samples.size(); i += kPosesPerReport) {
            const std::size_t n = std::min(kPosesPerReport, samples.size() - i);
            extend(std::span(samples).subspan(i, n));
            tuft::report(progress, "painting", static_cast<double>(i + n) / static_cast<double>(samples.size()));
        }
    } catch (...) {
        cancel();
        throw;
    }
    return end();
}

const brush::TuftState* Painting::tuft() const { return hand_ ? &hand_->state : nullptr; }

std::vector<StrokeReport> Painting::replay(std::vector<Stroke> strokes, const ProgressFn& progress) {
    std::vector<StrokeReport> reports;
    double done = 0;
    const double all = std::max<double>(1.0, static_cast<double>(strokes.size()));
    for (Stroke& stroke : strokes) {
        const std::uint64_t id = stroke.id;
        if (stroke.hidden) {
            journal_.restore(std::move(stroke));
        } else {
            reports.push_back(paint(std::move(stroke), [&](std::string_view phase, double f) {
                return !progress || progress(phase, (done + f) / all);
            }));
            if (id != 0) {
                journal_.renumber_last(id);
                reports.back().stroke_id = id;
                if (!undo_.empty()) undo_.back().stroke_id = id;
            }
        }
        done += 1;
    }
    return reports;
}

void Painting::keep_undo(std::uint64_t id, std::vector<ink::TileSnapshot> before) {
    Undo undo{.stroke_id = id, .before = std::move(before)};
    for (const ink::TileSnapshot& tile : undo.before)
        undo.bytes += sizeof(ink::TileSnapshot) + tile.amounts.size() * sizeof(float);
    undo_bytes_ += undo.bytes;
    undo_.push_back(std::move(undo));
    while (undo_bytes_ > options_.undo_bytes && undo_.size() > 1) {
        undo_bytes_ -= undo_.front().bytes;
        undo_.pop_front();
    }
}

bool Painting::undo() {
    cancel();
    if (!journal_.can_undo()) return false;
    const Stroke& last = journal_.strokes().back();
    const std::uint64_t id = last.id;
    const bool hidden = last.hidden;
    journal_.undo();
    if (hidden) return true;
    if (!undo_.empty() && undo_.back().stroke_id == id) {
        for (const ink::TileSnapshot& tile : undo_.back().before) canvas_.restore(tile);
        undo_bytes_ -= undo_.back().bytes;
        undo_.pop_back();
    } else {
        repaint_all();
    }
    return true;
}

bool Painting::redo() {
    cancel();
    if (!journal_.redo()) return false;
    Stroke stroke = journal_.take_last();
    if (stroke.hidden) {
        journal_.restore(std::move(stroke));
        return true;
    }
    const std::uint64_t id = stroke.id;
    journal_.hold_redo([&] { paint(std::move(stroke)); });
    journal_.renumber_last(id);
    if (!undo_.empty()) undo_.back().stroke_id = id;
    return true;
}

void Painting::repaint_all() {
    std::vector<Stroke> strokes = journal_.strokes();
    Journal undone = journal_;
    canvas_.clear();
    undo_.clear();
    undo_bytes_ = 0;
    journal_ = Journal();
    replay(std::move(strokes));
    journal_.adopt_undone(std::move(undone));
}

}  // namespace tuft::stroke
