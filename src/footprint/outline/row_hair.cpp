#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/ease.h"
#include "footprint/outline/cuts.h"

// Hair between the spines of a row.
namespace tuft::footprint {
namespace {

constexpr double kMostSpread = 3;    // times its width, that a strip is spread to one side
constexpr double kGives = 0.3;       // of it, up to which hair that touches its neighbours is not spread wholly
constexpr double kOneLength = 0.01;  // of the tuft's length, by which spines of one length differ at most
// Cosine from a section's wide axis to its broad side up to which it stands on its edge, and from which on it does not.
constexpr double kOnEdge = 0.6, kOnBroadSide = 0.8;
// Sine of the angle between a row and its hair up to which hair is not spread: there it lies on its neighbour's.
constexpr double kAlongRow = 0.2, kAcrossRow = 0.5;
// Part of a strip's broad axis that lies on the surface, and sine of the angle between it and its hair, from which on
// its ends follow its neighbours'.
constexpr double kLies = 0.6, kLiesFlat = 0.8, kAcrossHair = 0.5, kSquare = 0.8;
constexpr double kMostAslant = 2;  // times its half width, that a strip's edge lies from its broad axis
// The same of a free edge, beyond the last spine, from which its place is taken: further ahead it leaves a corner where
// a row rolls.
constexpr double kEdgeAslant = 0.5, kEdgeAbreast = 1, kEdgeAhead = 2.5;
constexpr double kStraight = 0.01;  // of its half width
constexpr double kTurning = 0.15;   // cosine from a broad axis to its row below which it is between both directions

/// Broad half of a section on one side of its spine, metres, (u, v, height): `to` by `part` in place of its own.
struct Half {
    Vec3 to{0};
    double part = 0;
};

/// Both halves of a section, towards the spine that follows in its row and towards the one before it.
struct Halves {
    Half next, last;
    Vec2 row{0};                           ///< metres, along the row from neighbour to neighbour
    double widens = 0;                     ///< 0–1: it only widens, at its own height
    std::optional<Vec2> to_next, to_last;  ///< metres, (u, v), midway to the neighbours
};

/// Direction across a section, unit: that of its hair.
Vec3 hair_of(const Cut& cut) {
    const Vec3 normal = glm::cross(cut.e, cut.m);
    const double size = glm::length(normal);
    return size > 0 ? normal / size : Vec3{0};
}

/// The half that reaches midway to a neighbour, where that is further than the section is wide itself. `differ`: of the
/// lengths of both hairs, 0–1; then what touches lies apart along the hair for that, and a section only widens, unless
/// it stands on its edge.
Half half_to(const Cut& own, const Cut& beside, double differ) {
    const Vec3 between(0.5 * (beside.centre - own.centre), 0), broad = own.broad();
    const double size = glm::dot(Vec2(broad), Vec2(broad));
    const Vec3 along = size > 1e-18 ? glm::dot(between, broad) / size * broad : Vec3{0};
    const Vec3 midway = glm::mix(between, along, differ);
    const double width = Trail::kStripChord * glm::length(own.broad()), distance = glm::length(midway);
    if (!(width > 1e-9) || distance <= width) return {};
    const double beyond = std::min(distance / width, kMostSpread) - 1;
    const double across = glm::length(glm::cross(hair_of(own), midway / distance));
    const double lies = smooth_step((std::abs(own.turn.x) - kOnEdge) / (kOnBroadSide - kOnEdge));
    return {std::min(1.0, kMostSpread * width / distance) / Trail::kStripChord * midway,
            smooth_step(beyond / kGives) * smooth_step((across - kAlongRow) / (kAcrossRow - kAlongRow)) *
                std::lerp(1.0, lies, differ)};
}

/// Gives a section other axes of its hair: their ellipse, of the axes that differ least from its own. `widens`: as in
/// Halves.
void set_axes(Cut& cut, const Vec3& broad, const Vec3& thick, double widens) {
    const auto [e, m, turn] = ellipse_of(broad, thick, cut.turn);
    const double a = glm::length(e), b = glm::length(m);
    if (!(std::max(a, b) > 1e-9)) return;
    const Vec3 hair = hair_of(cut);
    const double before = cut.half_height();
    cut.a = a;
    cut.b = b;
    // The cap of an edge ends without thickness.
    cut.e = a > 1e-9 ? e / a : glm::cross(m / b, hair);
    cut.m = b > 1e-9 ? m / b : glm::cross(hair, cut.e);
    cut.turn = turn;
    // What comes to lie flat keeps the part of its height that is on the surface.
    if (before > 0) cut.z *= std::lerp(cut.half_height() / before, 1.0, widens);
}

/// 1 where a section's broad axis points along its row, −1 against it; between, where it is spread by `part`, a section
/// across its row has no side that is the outer one.
double way_along(const Vec2& row, const Vec3& broad, double part) {
    const double size = glm::length(row) * glm::length(broad);
    const double cosine = size > 0 ? glm::dot(row, Vec2(broad)) / size : 1;
    return std::lerp(cosine < 0 ? -1.0 : 1.0, std::clamp(cosine / kTurning, -1.0, 1.0), part);
}

/// Takes the halves where they lie, at constant area.
void spread_section(Cut& cut, const Halves& halves) {
    const Half &next = halves.next, &last = halves.last;
    if (next.part <= 0 && last.part <= 0) return;
    const Vec3 thick = cut.thick(), hair = hair_of(cut);
    const double part = std::max(next.part, last.part);
    // Sections turn by half a turn where the tuft bends to the other side.
    const double way = way_along(halves.row, cut.broad(), part);
    const Vec3 own = way * cut.broad();
    const Vec3 up = glm::mix(own, next.to, next.part), down = glm::mix(-own, last.to, last.part);
    const Vec3 broad = (way < 0 ? -0.5 : 0.5) * (up - down);
    const double width = std::max(glm::length(broad), glm::length(cut.broad()) / kMostSpread);
    const Vec3 across = glm::cross(hair, broad);
    const double size = glm::length(across);
    if (!(size > 1e-9)) return;
    const double area = glm::length(glm::cross(cut.broad(), thick));
    // The hair of a turned section leans to one side of its strip; spread hair stands up.
    const double leans = glm::dot(thick, cut.broad()) / std::max(glm::dot(cut.broad(), cut.broad()), 1e-18);
    cut.centre += 0.5 * Trail::kStripChord * Vec2(up + down);
    // The middle moves, what touches does not.
    const double to_up = glm::length(up), to_down = glm::length(down), mean = 0.5 * (to_up + to_down);
    double &reach_up = way < 0 ? cut.reach.x : cut.reach.y, &reach_down = way < 0 ? cut.reach.y : cut.reach.x;
    reach_up = (reach_up * to_up - 0.5 * (to_up - to_down)) / mean;
    reach_down = (reach_down * to_down + 0.5 * (to_up - to_down)) / mean;
    set_axes(cut, broad, area / (width * size) * across + (1 - part) * leans * broad, halves.widens);
}

/// Bends a spread section along its hair, a unit vector on the surface, so that its edges lie midway to its neighbours
/// there. `spine`: where the section's spine is, (u, v). `missing`: metres, of the hair at the free edge of an
/// outermost strip.
void bend_section(Cut& cut, const Halves& halves, const Vec2& spine, const Vec2& hair, double missing) {
    if (!halves.to_next && !halves.to_last) return;
    const Vec2 broad(cut.broad());
    const double half = Cut::kStripChord * glm::length(broad);
    if (!(half > 1e-9)) return;
    const double lies = glm::length(broad) / glm::length(cut.broad());
    const double across = std::abs(broad.x * hair.y - broad.y * hair.x) / glm::length(broad);
    // A section square to its row is between both directions.
    const double way = way_along(halves.row, cut.broad(), 1);
    const double part = std::abs(way) * smooth_step((lies - kLies) / (kLiesFlat - kLies)) *
                        smooth_step((across - kAcrossHair) / (kSquare - kAcrossHair));
    if (part <= 0) return;
    const bool with_row = way >= 0;
    const auto& right = with_row ? halves.to_next : halves.to_last;
    const auto& left = with_row ? halves.to_last : halves.to_next;
    // Along the hair from the broad axis: the spine and both edges. An edge without a neighbour goes on straight.
    const auto along = [&](const Vec2& place, double side) {
        return glm::dot(place - cut.centre - side * Cut::kStripChord * broad, hair);
    };
    const double middle = along(spine, 0);
    const double r = right ? along(*right, 1) : 2 * middle - along(*left, -1);
    const double l = left ? along(*left, -1) : 2 * middle - r;
    const auto bounded = [&](double x) { return std::clamp(x, -kMostAslant * half, kMostAslant * half); };
    const double mean = part * bounded(0.5 * (r + l)), slant = part * bounded(0.5 * (r - l)),
                 bow = part * bounded(0.5 * (middle - 0.5 * (r + l)));
    // What is missing at the free edge beyond what the straight line goes back by.
    const bool drops = missing > 0 && !(right && left);
    const double drop = drops ? bounded(std::max(0.0, missing * part + (right ? l : r) - middle)) : 0;
    if (std::max({std::abs(mean), std::abs(slant), std::abs(bow), drop}) < kStraight * half) return;
    cut.centre += mean * hair;
    cut.slant = slant * hair;
    cut.bow = bow * hair;
    if (!drops) return;
    cut.drop = -drop * hair;
    cut.free_side = right ? -1 : 1;
}

/// Metres of a trail's hair that touch.
double touching_hair(const Trail& trail) {
    const Cut &tip = trail.cuts.front(), &heel = trail.cuts.back();
    return glm::length(Vec3(tip.centre - heel.centre, tip.z - heel.z));
}

/// Metres of the tuft's hair, by what touches of a trail.
double hair_metres(const Trail& trail) {
    const double touching = trail.along.empty() ? 0 : trail.along.front() - trail.along.back();
    return touching > 1e-9 ? touching_hair(trail) / touching : 0;
}

/// Part of an outermost strip's half width, −1 to 1 towards its free edge, up to which the hair of a toe touches: that
/// is long enough to reach the surface, or lies on it beside the spine's. `straight`: metres, by which the line through
/// its spine and its neighbour's goes back from spine to edge.
double toe_reach(const Trail& trail, double straight) {
    constexpr int kSteps = 16;
    const double drop = trail.edge_short - straight, lying = touching_hair(trail);
    // Hair that touches with its point alone does not lie.
    const double lies = smooth_step(0.5 * lying / trail.cuts.front().half_height());
    const double reaches = std::max(trail.pressed, std::lerp(trail.pressed, lying, lies));
    if (trail.edge_short <= reaches) return 1;
    double before = -straight;
    for (int i = 1 - kSteps; i <= kSteps; ++i) {
        const double s = static_cast<double>(i) / kSteps, missing = s * straight + drop * Cut::drop_part(s);
        if (missing > reaches) return (i - 1 + std::clamp((reaches - before) / (missing - before), 0.0, 1.0)) / kSteps;
        before = missing;
    }
    return 1;
}

/// Ends what touches of an outermost strip at `reach` of its half width on its free side.
void bound_toe(Cut& cut, const Halves& halves, double reach) {
    if (halves.to_next.has_value() == halves.to_last.has_value()) return;
    const bool with_row = way_along(halves.row, cut.broad(), 1) >= 0, free_with_row = !halves.to_next;
    double& side = free_with_row == with_row ? cut.reach.y : cut.reach.x;
    side = std::min(side, reach);
}

/// Lets the hair at the free edge of an outermost strip stand over its foot, as little as it is bent. `hair`: as in
/// `bend_section`.
void stand_ahead(Cut& cut, const Trail& trail, const Halves& halves, const Vec2& hair) {
    if (halves.to_next.has_value() == halves.to_last.has_value() || !(trail.pressed > 0)) return;
    const Vec2 broad(cut.broad());
    const double size = glm::length(broad), half = Cut::kStripChord * size;
    if (!(half > 1e-9)) return;
    const double across = std::abs(broad.x * hair.y - broad.y * hair.x) / size;
    const double part = smooth_step((size / glm::length(cut.broad()) - kLies) / (kLiesFlat - kLies)) *
                        smooth_step((across - kEdgeAslant) / (kEdgeAbreast - kEdgeAslant));
    const double unbent = 1 - std::sqrt(std::max(0.0, 1 - trail.edge_short / trail.pressed));
    const double ahead = part * unbent * glm::dot(trail.foot - cut.centre, hair), most = kEdgeAhead * half;
    const bool with_row = way_along(halves.row, cut.broad(), 1) >= 0, free_with_row = !halves.to_next;
    (free_with_row == with_row ? cut.ahead_hi : cut.ahead_lo) = std::clamp(ahead, -most, most) * hair;
    cut.drop *= 1 - part;
}

/// Whether `other` is the next in its row, and as many of its sections are known.
bool is_followed_by(const Trail& trail, const Trail& other) {
    return trail.cuts.size() == other.cuts.size() &&
           std::any_of(trail.openings.begin(), trail.openings.end(),
                       [&](const TrailOpening& opening) { return opening.branch == other.branch; });
}

}  // namespace

void fill_rows(Recycled<Trail>& trails) {
    Recycled<Recycled<Halves>> halves;
    Recycled<double> straight(trails.size(), 0.0);  // metres, half of what a neighbour's hair is longer
    for (const Trail& trail : trails) halves.emplace_back(trail.cuts.size());
    for (std::size_t k = 0; k < trails.size(); ++k)
        for (std::size_t l = 0; l < trails.size(); ++l) {
            if (!trails[k].strip || !is_followed_by(trails[k], trails[l])) continue;
            const double longer = 0.5 * (trails[l].length - trails[k].length);
            straight[k] = std::max(0.0, hair_metres(trails[k]) * longer);
            straight[l] = std::max(0.0, hair_metres(trails[l]) * -longer);
            const double differ = smooth_step(std::abs(trails[l].length - trails[k].length) / kOneLength);
            for (std::size_t i = 0; i < trails[k].cuts.size(); ++i) {
                const Cut &p = trails[k].cuts[i], &q = trails[l].cuts[i];
                for (Halves* h : {&halves[k][i], &halves[l][i]}) {
                    h->widens = std::max(h->widens, differ);
                    h->row += q.centre - p.centre;
                }
                halves[k][i].next = half_to(p, q, differ);
                halves[l][i].last = half_to(q, p, differ);
                halves[k][i].to_next = halves[l][i].to_last = 0.5 * (p.centre + q.centre);
            }
        }
    for (std::size_t k = 0; k < trails.size(); ++k) {
        Trail& trail = trails[k];
        const Vec2 run = trail.cuts.front().centre - trail.cuts.back().centre;
        const double length = glm::length(run);
        const double reach = trail.edge_short > 0 ? toe_reach(trail, straight[k]) : 1;
        for (std::size_t i = 0; i < trail.cuts.size(); ++i) {
            const Vec2 spine = trail.cuts[i].centre;
            spread_section(trail.cuts[i], halves[k][i]);
            if (reach < 1) bound_toe(trail.cuts[i], halves[k][i], reach);
            if (!(length > 1e-9)) continue;
            // All hair of a row leaves the surface side by side; so less is missing nearer to there.
            const double from_heel = glm::dot(spine - trail.cuts.back().centre, run) / (length * length);
            const double missing = trail.edge_short * std::clamp(from_heel, 0.0, 1.0);
            bend_section(trail.cuts[i], halves[k][i], spine, run / length, missing);
            if (trail.edge_short > 0) stand_ahead(trail.cuts[i], trail, halves[k][i], run / length);
        }
    }
}

}  // namespace tuft::footprint
