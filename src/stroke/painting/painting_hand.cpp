#include "stroke/painting/painting_hand.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ease.h"
#include "core/simd.h"
#include "footprint/hair.h"
#include "footprint/slip.h"
#include "ink/touch/stir.h"
#include "stroke/hand/line_width.h"

namespace tuft::stroke {
namespace {

// Bending moment of a firm press over B0/L: what a hand reaches at the working depth.
constexpr double kFirmPress = 0.1;
constexpr double kSpeedLength = 2e-3;   // metres of travel over which the hand's speed is taken
// Metres of ink under hair that holds half of what closes its gaps, over twice that; what holds more fills the grain
// of bisque, then that of paper.
constexpr double kGrainFilm = 7.5e-6;
constexpr double kRests = 1;            // rms heights over the mean of the grain that dry hair is held up by its hills
constexpr double kSoakLength = 0.2e-3;    // metres of travel over which ink comes to the parts of the hair that touch
constexpr double kLieLength = 1e-3;     // metres of hair on the surface that turn the grid of its ink
constexpr double kApart = 0.05;         // mean lack of wetness of the bundles at which all of a tuft touches by single hairs
constexpr double kSplays = 0.4;         // lack of wetness at which no water holds the tip together

footprint::StampOptions stamp_options(const Settings& settings) {
    footprint::StampOptions o;
    o.mapping = settings.footprint == "plane" ? footprint::Mapping::plane : footprint::Mapping::log;
    return o;
}

}  // namespace

TUFT_CLONES static std::uint32_t sum_of(const std::uint8_t* coverage, int n) {
    std::uint32_t sum = 0;
    for (int i = 0; i < n; ++i) sum += coverage[i];
    return sum;
}

double footprint_area(const footprint::Footprint& f) {
    std::size_t sum = 0;
    for (std::size_t row = 0; row < f.coverage.size(); row += static_cast<std::size_t>(f.width))
        sum += sum_of(f.coverage.data() + row, f.width);
    return static_cast<double>(sum) / 255.0 * f.cell * f.cell;
}

Painting::Hand::Hand(Stroke s, BrushInHand held, const ink::Ink& i, const Model& on, ink::Canvas& canvas,
                     const ink::Substrate& ground, PlanRooms& rooms, double step_, double texel)
    : stroke(std::move(s)),
      model(&on),
      substrate(&ground),
      tuft(std::move(held.tuft)),
      ink(i),
      reservoir(held.reservoir),
      dipped(std::move(held.dipped)),
      resampler({.step = step_, .lever = tuft.preset.length}),
      stamper(on, canvas, stamp_options(stroke.settings), ground, rooms),
      step(step_),
      cell(0.5 * texel) {
    tape = LaidTape(*on.query, stroke.trace);
    contact_options.method = stroke.settings.contact == "vertices" ? contact::Method::vertices
                                                                   : contact::Method::exact;
    report.nearest = std::numeric_limits<double>::infinity();
}

void Painting::Hand::flush() {
    const double given = stamper.flush(film_progress);
    float sum = 0;
    for (const float t : touch) sum += t;
    for (float& t : touch) t /= sum;
    pay(owed);
    owed = given;
    instalment = given / static_cast<double>(Stamper::kBatch);
    owed_by = std::move(touch);
    touch.clear();
    if (!by_hair) pay(owed);
    report.ink_given += given;
}

void Painting::Hand::pay(double amount) {
    amount = std::min(amount, owed);
    if (!(amount > 0)) return;
    ink::take(reservoir, amount, owed_by);
    owed -= amount;
}

void Painting::Hand::move_on(const brush::Pose& pose, double dt) {
    const double way = glm::length(pose.position - last_position);
    travel += way;
    if (dt > 0) speed += -std::expm1(-way / kSpeedLength) * (way / dt - speed);
}

void Painting::Hand::bend(brush::TuftState now, const brush::Pose& pose) {
    const auto& before = state.branches;
    const std::size_t cells = reservoir.n_cells();
    if (!before.empty() && !now.branches.empty() && ink::is_mixed(reservoir)) {
        const std::vector<brush::Section>& was = before[0].sections;
        const std::vector<brush::Section>& is = now.branches[0].sections;
        const Quat carried = pose.rotation * glm::inverse(last_rotation);
        std::vector<Vec2> bent(cells, Vec2{0});
        for (std::size_t c = 0; c < cells && was.size() == is.size() && !is.empty(); ++c) {
            const double begin = c ? reservoir.layout.cell_ends[c - 1] : 0;
            const double from_root = 0.5 * (begin + reservoir.layout.cell_ends[c]);
            const auto i = static_cast<std::size_t>((1 - from_root) * static_cast<double>(is.size() - 1) + 0.5);
            const Vec3 turn = is[i].tangent - carried * was[i].tangent;
            bent[c] = {glm::dot(turn, is[i].e), glm::dot(turn, is[i].m)};
        }
        ink::stir(reservoir, bent, tuft.preset.radius);
    }
    state = std::move(now);
    last_rotation = pose.rotation;
}

double Painting::Hand::stress(const contact::Result& contact) const {
    const double limit = kFirmPress * tuft.preset.stiffness / tuft.preset.length;
    return std::min(1.0, std::abs(contact.tuft.root_moment) / limit);
}

void Painting::Hand::place_nodes(Stamp& stamp, std::span<const footprint::Trail> trails,
                                 std::span<const footprint::Outline> outlines) {
    // A tip that stands on the surface has no direction: then it keeps the one it had.
    Vec2 lie = kLieLength * axis;
    for (const footprint::Trail& trail : trails) lie += trail.cuts.front().centre - trail.cuts.back().centre;
    if (glm::length(lie) > 1e-9) axis = glm::normalize(lie);
    std::vector<Vec2> places;
    for (const footprint::Outline& o : outlines) {
        places.insert(places.end(), o.left.begin(), o.left.end());
        places.insert(places.end(), o.right.begin(), o.right.end());
        places.push_back(o.tip);
        places.push_back(o.tail);
    }
    stamp.grid = ink::touch_grid(places, axis);
    std::vector<ink::HairSample> samples;
    for (const footprint::HairTouch& t :
         footprint::hair_touches(trails, tuft.bundles, static_cast<int>(state.branches.size())))
        samples.push_back({t.bundle, t.at, t.along, t.length});
    nodes = ink::node_touch(reservoir, stamp.grid, samples, touched);
}

double Painting::Hand::lay_mixed(const Stamp& stamp) {
    stamper.expose(stamp);
    const ink::NodeMixes mixes =
        ink::mixes_within(reservoir, nodes, static_cast<double>(stamp.ink.target), footprint_area(stamp.footprint));
    const ink::NodeContents given = stamper.lay(stamp.ink, mixes, stamp.ds);
    ink::spend(reservoir, given, nodes);
    double sum = 0;
    for (const ink::Reservoir::Content& node : given)
        for (const double v : node) sum += v;
    return sum;
}

ink::Drain Painting::Hand::drain(const brush::Pose& pose, const Vec3& contact) const {
    const Vec3 way = contact - pose.position, &down = stroke.settings.down;
    const double weight = glm::length(down) * glm::length(way);
    // All of it from a tuft that hangs, half from a level one, whose underside it runs along.
    return {.length = tuft.preset.length, .radius = tuft.preset.radius,
            .slope = weight > 0 ? 0.5 + 0.5 * glm::dot(way, down) / weight : 0};
}

Stamp Painting::Hand::make_stamp(const contact::Result& contact, double dt) {
    const int branches = static_cast<int>(contact.tuft.branches.size());
    std::vector<footprint::Trail> trails = footprint::trails(
        contact.tuft, contact.frame, contact.branch_planes, tuft.preset.length, kSkinFilm);
    touched = footprint::touched_cells(trails, tuft.bundles, branches, reservoir.layout.cell_ends);
    touch.resize(touched.size(), 0);
    for (std::size_t i = 0; i < touch.size(); ++i) touch[i] += touched[i];

    // Saturation and film of each bundle along what touches of the tuft.
    const std::size_t n = reservoir.n_bundles(), cells = reservoir.n_cells();
    std::vector<double> saturation(n, 0), wetness(n), depth(cells, 0);
    for (std::size_t i = 0; i < touched.size(); ++i) depth[i % cells] += static_cast<double>(touched[i]);
    double mean = 0, lack = 0;
    // Which hair touches with which part of it flickers from stamp to stamp: threads of ink would break in dashes.
    const double soaks = -std::expm1(-(travel - parted) / kSoakLength);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t c = 0; c < cells; ++c) saturation[k] += depth[c] * reservoir.saturation(k * cells + c);
        wetness[k] = footprint::wetness_of_bundle(saturation[k], tuft.bundles.holds[k], speed);
        if (soaked.size() == n) wetness[k] = std::lerp(soaked[k], wetness[k], soaks);
        mean += wetness[k] / static_cast<double>(n);
        lack += std::max(0.0, 1 - wetness[k]) / static_cast<double>(n);
    }
    soaked = wetness;
    brush::part_bundles(tuft.bundles, tuft.preset, stress(contact), saturation, travel - parted, dt);
    parted = travel;

    Stamp stamp;
    // On the palette the pool itself fills the gaps of dry hair.
    const bool closed = !(lack > 0) || stroke.layer == kPaletteLayer;
    by_hair = !closed;
    closed_area = 0;
    const double amount = closed ? 0 : std::clamp((1 - mean) / kSplays, 0.0, 1.0);
    footprint::splay(trails, tracks, slid, tuft.preset.length, amount);
    std::vector<footprint::Trail> lying;
    if (!closed) {
        if (!was_touching) lay.clear();
        footprint::carry(lay, lay_frame, contact.frame);
        lying = trails;
    }
    if (!contact.planes.empty())
        footprint::cover_foot(trails, brush::foot_of(tuft, contact.planes.front()), contact.frame, kSkinFilm);
    std::vector<footprint::Outline> outlines;
    for (const footprint::Trail& trail : trails) {
        footprint::Outline o = footprint::outline_of(trail, footprint::OutlineOptions{}.points);
        if (o.left.size() >= 3) outlines.push_back(std::move(o));
    }
    if (closed) {
        stamp.footprint = footprint::rasterise(outlines, contact.frame, contact.triangle, cell);
    } else {
        const Vec2 onward(contact.frame.to_local(contact.frame.origin + course)), way(contact.frame.to_local(contact.frame.origin + went));
        const double lengths = glm::length(onward) * glm::length(way);
        const double swings = lengths > 0 ? std::abs(onward.x * way.y - onward.y * way.x) / lengths : 0;
        footprint::HairMarks marks = footprint::hair_marks(trails, outlines, tuft.bundles, branches,
                                                           {wetness, travel, heading, lay, lands, onward, swings}, contact.frame, contact.triangle, cell);
        stamp.footprint = std::move(marks.footprint);
        stamp.by_hair = true;
        stamp.apart = static_cast<float>(smooth_step(lack / kApart));
        const double dry = std::max(1e-3, 1 - mean);
        stamp.grain_film = kGrainFilm * 2 * mean / (dry * dry) - kRests * static_cast<double>(substrate->relief) * dry;
        closed_area = marks.closed_area;
    }
    tape.cut_off(stamp.footprint);
    lay = std::move(lying);
    lay_frame = contact.frame;
    if (wet || mixed || paste) place_nodes(stamp, trails, outlines);
    if ((paste || wet) && !trails.empty()) {
        const Vec2 e(trails.front().cuts[trails.front().cuts.size() / 2].e);
        turned = axis.x * e.y - axis.y * e.x < 0 ? -1 : 1;
    }
    return stamp;
}

}  // namespace tuft::stroke
