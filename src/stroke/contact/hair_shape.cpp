#include "stroke/contact/hair_shape.h"

#include <algorithm>
#include <cmath>

#include "footprint/outline/hair.h"
#include "stroke/drawing/line_width.h"

namespace tuft::stroke {
namespace {

constexpr double kCourse = 2e-3;           // metres of travel over which the hand's course is taken
constexpr double kLeastSpacing = 0.09e-3;  // metres between hairs at the edge: a hair and the ink that adheres to it

SurfacePath next_path(const SurfacePath& last, const Vec3& position, const Frame& frame) {
    SurfacePath path{true, last.travel, {}, position};
    if (!last.touching) return path;
    Vec3 step = position - last.position;
    step -= glm::dot(step, frame.n) * frame.n;
    const double along = glm::length(step);
    path.travel += along;
    path.course = std::exp(-along / kCourse) * last.course + step;
    return path;
}

/// Direction of the hand; before it moves, that in which its hair trails it.
Vec2 direction_of(const SurfacePath& path, const Recycled<footprint::Trail>& trails, const Frame& frame) {
    const Vec2 course{glm::dot(path.course, frame.t), glm::dot(path.course, frame.b)};
    if (glm::length(course) > 1e-9) return glm::normalize(course);
    Vec2 back{0};
    for (const footprint::Trail& t : trails) back += t.cuts.back().centre - t.cuts.front().centre;
    return glm::length(back) > 1e-9 ? glm::normalize(back) : Vec2{1, 0};
}

}  // namespace

void LastHair::store(const brush::Tuft& tuft, const brush::Pose& at, const HairShape& hair,
                     const contact::Result& contact) {
    constexpr int kMostMissed = 2;
    if (touches(contact))
        hand = hair.hand;
    else
        hand.touching = false;
    if (!tuft.wide()) return;
    if (!touches(contact)) {
        if (++missed > kMostMissed) trails.clear();
        return;
    }
    missed = 0;
    trails = hair.trails;
    frame = contact.frame;
    root = at.position;
}

HairShape find_hair(const brush::Tuft& tuft, const contact::Result& contact, const LastHair& last) {
    HairShape hair;
    hair.hand = next_path(last.hand, tuft.pose.position, contact.frame);
    if (!brush::is_foam(tuft.preset))
        hair.trails =
            footprint::find_trails(contact.tuft, contact.frame, contact.branch_planes, tuft.preset.length, kSkinFilm);
    footprint::fill_rows(hair.trails);
    if (!contact.planes.empty() && !tuft.carried) hair.upright = brush::upright_hair_of(tuft, contact.planes.front());
    hair.edge = {.spacing = std::max(tuft.preset.hair_diameter, kLeastSpacing),
                 .seed = tuft.bundles.seed,
                 .travel = hair.hand.travel,
                 .foot = Vec2(contact.frame.to_local(tuft.pose.position)),
                 .direction = direction_of(hair.hand, hair.trails, contact.frame)};
    if (!last.trails.empty()) {
        const Vec2 hand(contact.frame.to_local(contact.frame.origin + tuft.pose.position - last.root));
        hair.leapt = footprint::leapt_trails(hair.trails, contact.frame, last.trails, last.frame, hand);
    }
    return hair;
}

footprint::RoughEdge edge_of(const HairShape& hair, const ClosedHairOptions& options) {
    return options.rough ? footprint::RoughEdge{hair.edge, options.grain} : footprint::RoughEdge{};
}

void close_hair(HairShape& hair, const contact::Result& contact, const ClosedHairOptions& options) {
    Recycled<footprint::Trail> trails = hair.trails;
    footprint::cover_upright_hair(trails, hair.upright, contact.frame, kSkinFilm);
    hair.outlines = footprint::outlines_of(trails, footprint::OutlineOptions{}.points, hair.leapt);
    hair.closed =
        footprint::rasterise(hair.outlines, {contact.frame, contact.triangle, options.cell}, edge_of(hair, options));
}

}  // namespace tuft::stroke
