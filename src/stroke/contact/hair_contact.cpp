#include "stroke/contact/hair_contact.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/ease.h"
#include "footprint/outline/hair.h"
#include "footprint/outline/section_outline.h"
#include "footprint/outline/slip.h"
#include "stroke/drawing/line_width.h"

namespace tuft::stroke {
namespace {

// Metres of ink under hair that holds half of what closes its gaps, over twice that; what holds more fills the grain
// of bisque, then that of paper.
constexpr double kGrainFilm = 7.5e-6;
constexpr double kHeldUp = 1;           // rms heights over the mean of the grain that dry hair is held up by its hills
constexpr double kSoakLength = 0.2e-3;  // metres of travel over which ink comes to the parts of the hair that touch
constexpr double kAxisLength = 1e-3;    // metres of hair on the surface that turn the grid of its ink
// Mean lack of wetness of the bundles at which all of a tuft touches by single hairs.
constexpr double kSeparateLack = 0.05;
constexpr double kSpreadLack = 0.4;  // lack of wetness at which no water holds the tip together
// Sine of the angle between hair and its motion from which on it gathers, and from which on it gathers no more; part of
// its width that it then has.
constexpr double kGathersFrom = 0.2, kGathersFull = 0.55, kGathered = 0.3;
constexpr double kGathersLack = 0.1;  // lack of wetness from which it does so fully; wet hair keeps its outline

/// Returns the direction of a row of spines on the surface, from the first that touches to the last; zero: none.
Vec2 row_of(std::span<const footprint::Trail> trails) {
    if (trails.empty() || !trails.front().strip) return Vec2{0};
    const auto [first, last] =
        std::minmax_element(trails.begin(), trails.end(),
                            [](const footprint::Trail& p, const footprint::Trail& q) { return p.branch < q.branch; });
    return last->cuts[last->cuts.size() / 2].centre - first->cuts[first->cuts.size() / 2].centre;
}

/// Returns how much the hair is drawn across itself, 0–1, over its last millimetre: where the hand pivots.
double pivot_of(std::span<const footprint::Trail> trails, const MotionTracker& motion, const Frame& frame) {
    Vec2 lie{0};
    for (const footprint::Trail& trail : trails) lie += trail.cuts.front().centre - trail.cuts.back().centre;
    const Vec2 course(frame.to_local(frame.origin + motion.hair_course));
    const double size = glm::length(lie) * glm::length(course);
    if (!(size > 1e-12)) return 0;
    const double sine = std::abs(lie.x * course.y - lie.y * course.x) / size;
    return smooth_step((sine - kGathersFrom) / (kGathersFull - kGathersFrom));
}

}  // namespace

ink::ContactCells HairContact::take_cells_since() {
    float sum = 0;
    for (const float t : cells_since_) sum += t;
    for (float& t : cells_since_) t /= sum;
    return std::exchange(cells_since_, {});
}

HairContact::Wetness HairContact::bundle_wetness(TuftInHand& tuft, const MotionTracker& motion, double stress,
                                                 double dt) {
    const ink::Reservoir& reservoir = tuft.brush.reservoir;
    brush::Bundles& bundles = tuft.brush.tuft.bundles;
    const std::size_t n = reservoir.n_bundles(), n_cells = reservoir.n_cells();
    Recycled<double> saturation(n, 0), depth(n_cells, 0);
    for (std::size_t i = 0; i < cells_.size(); ++i) depth[i % n_cells] += static_cast<double>(cells_[i]);
    Wetness wetness{.of_bundle = Recycled<double>(n)};
    // Which hair touches with which part of it flickers from stamp to stamp: threads of ink would break in dashes.
    const double soaks = -std::expm1(-(motion.travel - updated_at_) / kSoakLength);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t c = 0; c < n_cells; ++c)
            if (depth[c] > 0) saturation[k] += depth[c] * reservoir.saturation(k * n_cells + c);
        double& wet = wetness.of_bundle[k];
        wet = footprint::wetness_of_bundle(saturation[k], bundles.holds[k], motion.speed);
        if (soaked_.size() == n) wet = std::lerp(soaked_[k], wet, soaks);
        wetness.mean += wet / static_cast<double>(n);
        wetness.lack += std::max(0.0, 1 - wet) / static_cast<double>(n);
    }
    soaked_ = wetness.of_bundle;
    brush::split_bundles(bundles, tuft.preset(), stress, saturation, motion.travel - updated_at_, dt);
    updated_at_ = motion.travel;
    return wetness;
}

void HairContact::draw_hairs(Stamp& stamp, const footprint::TouchingHair& hair, const contact::Result& contact,
                             const MotionTracker& motion, const Wetness& wetness) {
    const Frame& frame = contact.frame;
    const Vec2 of_hand(frame.to_local(frame.origin + motion.hand_course)),
        of_hair(frame.to_local(frame.origin + motion.hair_course));
    const double lengths = glm::length(of_hand) * glm::length(of_hair);
    const double apart = smooth_step(wetness.lack / kSeparateLack);
    const footprint::HairInk ink{
        .wet = wetness.of_bundle,
        .travel = motion.travel,
        .direction = motion.hair_direction,
        .before = previous_,
        .press_share = motion.press_share,
        .course = of_hand,
        .sine_to_course = lengths > 0 ? std::abs(of_hand.x * of_hair.y - of_hand.y * of_hair.x) / lengths : 0,
        .apart = apart,
        .sides = sides_};
    footprint::HairMarks marks = footprint::draw_hair_marks(hair, ink, {frame, contact.triangle, options_.closed.cell});
    stamp.footprint = std::move(marks.footprint);
    stamp.by_hair = true;
    stamp.separation = static_cast<float>(apart);
    const double dry = std::max(1e-3, 1 - wetness.mean);
    stamp.grain_film = kGrainFilm * 2 * wetness.mean / (dry * dry) - kHeldUp * options_.closed.grain.relief * dry;
    closed_area_ = marks.closed_area;
}

// A carried shape: its mesh as a closed patch, in streaks of the hair where that is half dry; foam with its pores; its
// polylines hair by hair.
void HairContact::draw_shape(Stamp& stamp, const TuftInHand& tuft, const footprint::TouchingHair& hair,
                             const contact::Result& contact, const MotionTracker& motion, const Wetness& wetness) {
    const brush::CarriedShape& carried = *tuft.brush.tuft.carried;
    const brush::TuftShape& shape = contact.tuft.shape;
    const footprint::ShapeOptions options{.film = kSkinFilm, .wetness = std::min(1.0, wetness.mean)};
    if (!carried.lines.empty()) {
        const footprint::LineInk ink{wetness.of_bundle, motion.travel, hair.bundles.seed};
        const Recycled<footprint::Polygon> hairs =
            footprint::hair_polygons(carried, shape, contact.frame, tuft.preset().hair_diameter, ink, options);
        stamp.footprint = footprint::rasterise_polygons(hairs, contact.frame, contact.triangle, options_.closed.cell);
        return;
    }
    footprint::Footprint section =
        footprint::rasterise_polygons(footprint::section_polygons(carried, shape, contact.frame, options),
                                      contact.frame, contact.triangle, options_.closed.cell);
    if (brush::is_foam(tuft.preset())) footprint::open_pores(carried, shape, options, section);
    if (brush::is_foam(tuft.preset()) || !by_hair_) {
        stamp.footprint = std::move(section);
        return;
    }
    draw_hairs(stamp, hair, contact, motion, wetness);
    footprint::clip_footprint(stamp.footprint, section);
}

void HairContact::place_nodes(Stamp& stamp, const TuftInHand& tuft, const footprint::TouchingHair& hair,
                              const contact::Result& contact) {
    // A tip that stands on the surface has no direction: then it keeps the one it had. The ink of a row of spines
    // varies along the row, whether its edge stands on the surface or its hair lies there.
    Vec2 lie = kAxisLength * axis_;
    for (const footprint::Trail& trail : hair.trails) lie += trail.cuts.front().centre - trail.cuts.back().centre;
    const Vec2 row = row_of(hair.trails);
    if (glm::length(row) > 1e-6) lie = (glm::dot(Vec2{-row.y, row.x}, lie) < 0 ? -1.0 : 1.0) * Vec2{-row.y, row.x};
    if (glm::length(lie) > 1e-9) axis_ = glm::normalize(lie);
    Recycled<Vec2> places;
    for (const footprint::Outline& outline : hair.outlines) {
        places.insert(places.end(), outline.left.begin(), outline.left.end());
        places.insert(places.end(), outline.right.begin(), outline.right.end());
        places.push_back(outline.tip);
        places.push_back(outline.tail);
    }
    const brush::CarriedShape* carried = tuft.brush.tuft.carried.get();
    const Recycled<footprint::HairContactPoint> points =
        carried ? footprint::shape_contact_points(*carried, contact.tuft.shape, contact.frame, kSkinFilm)
                : footprint::hair_contact_points(hair.trails, hair.bundles, hair.branches);
    if (carried)
        for (const footprint::HairContactPoint& t : points) places.push_back(t.at);
    stamp.grid = ink::make_contact_grid(places, axis_);
    Recycled<ink::HairSample> samples;
    for (const footprint::HairContactPoint& t : points) samples.push_back({t.bundle, t.at, t.along, t.length});
    const bool in_row = glm::length(row) > 1e-6;
    nodes_ = ink::node_contact(tuft.brush.reservoir, stamp.grid, samples, cells_,
                               in_row ? ink::NodesWithoutHair::column : ink::NodesWithoutHair::nearest);
    if (hair.trails.empty()) return;
    const Recycled<footprint::Cut>& cuts = hair.trails.front().cuts;
    const Vec2 e(cuts[cuts.size() / 2].e);
    orientation_ = axis_.x * e.y - axis_.y * e.x < 0 ? -1 : 1;
}

void HairContact::add_tone(Stamp& stamp, const TuftInHand& tuft, const footprint::TouchingHair& hair,
                           const HairShape& shape, const contact::Result& contact, const MotionTracker& motion) {
    if (!motion.touching) tone_.clear();
    const double contrast = 1 - static_cast<double>(stamp.separation);
    if (!(contrast > 0)) return;
    tone_.update(shape.edge, options_.closed.cell, tuft.brush.reservoir, hair.bundles,
                 [&] { return footprint::hair_contact_points(hair.trails, hair.bundles, hair.branches); });
    stamp.tone = tone_.at(shape.edge, contact.frame, contrast);
}

void HairContact::find_cells(const TuftInHand& tuft, const contact::Result& contact,
                             std::span<const footprint::Trail> trails) {
    const brush::Bundles& bundles = tuft.brush.tuft.bundles;
    const std::vector<double>& ends = tuft.brush.reservoir.layout.cell_ends;
    if (const brush::CarriedShape* carried = tuft.brush.tuft.carried.get())
        cells_ = footprint::shape_contact_cells(
            footprint::shape_contact_points(*carried, contact.tuft.shape, contact.frame, kSkinFilm),
            bundles.place.size(), ends);
    else
        cells_ = footprint::contact_cells(trails, bundles, static_cast<int>(contact.tuft.branches.size()), ends);
    cells_since_.resize(cells_.size(), 0);
    for (std::size_t i = 0; i < cells_since_.size(); ++i) cells_since_[i] += cells_[i];
}

Stamp HairContact::make_stamp(TuftInHand& tuft, const contact::Result& contact, HairShape shape,
                              const MotionTracker& motion, double dt) {
    const double length = tuft.preset().length;
    const brush::Bundles& bundles = tuft.brush.tuft.bundles;
    const brush::CarriedShape* carried = tuft.brush.tuft.carried.get();
    const bool by_lines = carried && !carried->lines.empty();
    const auto branches = static_cast<int>(contact.tuft.branches.size());
    if (!motion.touching) tracks_ = {};
    Recycled<footprint::Trail>& trails = shape.trails;
    find_cells(tuft, contact, trails);
    const Wetness wetness = bundle_wetness(tuft, motion, tuft.stress(), dt);

    by_hair_ = wetness.lack > 0 && !options_.always_closed && !brush::is_foam(tuft.preset()) && !by_lines;
    closed_area_ = 0;
    if (!by_hair_ && !shape.closed) close_hair(shape, contact, options_.closed);
    const double spread = by_hair_ ? std::clamp((1 - wetness.mean) / kSpreadLack, 0.0, 1.0) : 0;
    const double pivot =
        spread > 0 && !brush::has_broad_side(tuft.preset()) ? pivot_of(trails, motion, contact.frame) : 0;
    footprint::spread_trails(trails, tracks_, {motion.hair_travel, length, spread * (1 - pivot)});
    if (pivot > 0) {
        const double gathers = pivot * std::clamp((1 - wetness.mean) / kGathersLack, 0.0, 1.0);
        footprint::gather_trails(trails, std::lerp(1.0, kGathered, gathers));
    }
    Recycled<footprint::Trail> uncovered;  // without the upright hair
    if (by_hair_) {
        if (!motion.touching) previous_.clear();
        footprint::change_frame(previous_, previous_frame_, contact.frame);
        uncovered = trails;
    }
    if (!motion.touching) sides_.clear();
    footprint::keep_sides(trails, sides_);
    footprint::cover_upright_hair(trails, shape.upright, contact.frame, kSkinFilm);
    Recycled<footprint::Trail> drawn;  // with what leapt since the pose before
    if (by_hair_) {
        shape.outlines = footprint::outlines_of(trails, footprint::OutlineOptions{}.points, shape.leapt);
        drawn = footprint::trails_passed(trails, shape.leapt);
        drawn.insert(drawn.end(), trails.begin(), trails.end());
    }
    const footprint::TouchingHair hair{trails, shape.outlines, bundles, branches, edge_of(shape, options_.closed)};
    footprint::TouchingHair passed = hair;
    passed.trails = drawn;
    Stamp stamp;
    if (carried)
        draw_shape(stamp, tuft, hair, contact, motion, wetness);
    else if (by_hair_)
        draw_hairs(stamp, passed, contact, motion, wetness);
    else
        stamp.footprint = std::move(*shape.closed);
    stamp.leapt = !shape.leapt.empty();
    if (options_.tones && !carried) add_tone(stamp, tuft, hair, shape, contact, motion);
    previous_ = std::move(uncovered);
    previous_frame_ = contact.frame;
    if (options_.places_nodes) place_nodes(stamp, tuft, hair, contact);
    return stamp;
}

}  // namespace tuft::stroke
