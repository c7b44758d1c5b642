#include "render/brush/tuft_drawing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "brush/surface/tuft_surface.h"
#include "brush/tuft/ferrule.h"
#include "core/ease.h"
#include "core/random.h"
#include "footprint/outline/outline.h"
#include "render/brush/shape_drawing.h"

namespace tuft::render {

using namespace brush;

namespace {

constexpr int kBetween = 5;  ///< sections drawn between two nodes

/// A branch drawn from its tip to the ferrule, also where it shares the trunk.
struct Strand {
    Recycled<Section> sections;
    std::size_t trunk = 0;  ///< from here on the whole tuft
};

/// Sections of every branch, refined, resting on the sheet.
std::vector<Strand> strands_of(const TuftState& state, const TuftAppearance& appearance) {
    std::vector<Strand> out;
    const std::size_t count = state.branches.size(), middle = count / 2;
    const Recycled<Section>& trunk_branch = state.branches[middle].sections;
    for (const Branch& branch : state.branches) {
        Strand strand;
        Recycled<Section> all = branch.sections;
        std::size_t trunk = 0;
        if (state.wide) {
            trunk = all.size();  // every hair keeps to its spine
        } else if (count > 1) {
            // The middle branch carries the trunk behind its own sections.
            const std::size_t own = state.branches[middle == 0 ? 1 : 0].sections.size();
            trunk = own - 1;
            if (&branch != &state.branches[middle]) {
                all.pop_back();
                all.insert(all.end(), trunk_branch.begin() + static_cast<long>(trunk), trunk_branch.end());
            }
        }
        strand.trunk = trunk * (kBetween + 1);
        strand.sections = refine_sections(all, kBetween);
        double widest = 0;
        for (std::size_t i = strand.sections.size(); i-- > 0;) {
            Section& s = strand.sections[i];
            if (i + 1 == strand.trunk && !state.wide) widest = 0;
            widest = std::max(widest, s.a);
            if (appearance.dry) {
                const double grow = widest / s.a;
                s.a *= grow;
                s.b /= grow;
            }
            const double half = std::hypot(s.a * s.e.z, s.b * s.m.z);
            s.centre.z = std::max(s.centre.z, appearance.ground + half);
        }
        out.push_back(std::move(strand));
    }
    return out;
}

constexpr double kBound =
    0.3;  ///< of the sections, from the root, over which bundles leave the even hair in the ferrule

/// A bristle's place in section i of strand k; none where it belongs to another strand.
struct Placed {
    Vec2 bound{0}, whole{0};
    BranchPlace part;

    Placed(const Bundles& bundles, const Bristle& b, int branches)
        : bound(b.place), whole(place_of(bundles, b)), part(in_branch(bundles, whole, branches)) {}
    std::optional<Vec2> at(const Strand& strand, std::size_t k, std::size_t i) const {
        if (i >= strand.trunk) {
            const auto last = static_cast<double>(strand.sections.size() - 1);
            return glm::mix(bound, whole, smooth_step((last - static_cast<double>(i)) / (kBound * last)));
        }
        // Between the last section of its own and the trunk's first it goes straight.
        const bool joins = strand.trunk < strand.sections.size();
        if (part.branch != static_cast<int>(k) || (joins && i + kBetween + 1 > strand.trunk)) return std::nullopt;
        return part.place;
    }
};

Vec3 point_of(const Section& s, const Vec2& place) {
    return s.centre + 0.97 * (s.a * place.x * s.e + s.b * place.y * s.m);
}

/// Hair of a row at a place of section i of strand k: between two spines it is the mean of where both have it, so that
/// a row that is sheared ends in one slanted edge.
Vec3 point_in_row(const std::vector<Strand>& strands, std::size_t k, std::size_t i, const Vec2& place) {
    constexpr double kChord = 0.8862269254527580;  // half the width of a strip, see brush::in_branch
    const auto at = [&](std::size_t strand, double x) {
        const Section& s = strands[strand].sections[i];
        const Vec3 broad = s.turn.x * s.a * s.e + s.turn.y * s.b * s.m,
                   thick = s.turn.x * s.b * s.m - s.turn.y * s.a * s.e;
        return s.centre + 0.97 * (x * broad + place.y * thick);
    };
    const Vec3 own = at(k, place.x);
    const bool next = place.x > 0;
    if (next ? k + 1 == strands.size() : k == 0) return own;
    const std::size_t beside = next ? k + 1 : k - 1;
    if (strands[beside].sections.size() != strands[k].sections.size()) return own;
    return glm::mix(own, at(beside, place.x + (next ? -2 : 2) * kChord), 0.5 * std::abs(place.x) / kChord);
}

/// Metres by which the hair of a row ends beyond the end of its spine: that of a toe or a blade differs in length from
/// one side of a strip to the other.
double beyond_spine(const Tuft& tuft, const HairLengths& lengths, const Placed& placed) {
    const double own = tuft.spines[static_cast<std::size_t>(placed.part.branch)].rest.length;
    return tuft.preset.length * (lengths.at(placed.whole.x) - own);
}

/// First section from the tip on, from `stop`, that lies `cut` metres or more from the tip.
std::size_t first_left(const Recycled<Section>& sections, std::size_t stop, double cut) {
    std::size_t i = 0;
    for (double gone = 0; i + 2 < sections.size() && gone < cut; ++i)
        gone += glm::distance(sections[i].centre, sections[i + 1].centre);
    return std::max(i, stop);
}

/// `from`: the first section that is filled.
void fill_silhouette(BrushCanvas& canvas, const Strand& strand, const BrushView& view, const Vec3& colour,
                     std::size_t from) {
    constexpr int kRound = 16;
    constexpr double kUnder = 0.88;  // of the section: no rim where the outermost hair happens to lie further in
    constexpr double kRoot = 0.5;
    std::vector<Vec2> before, now;
    for (std::size_t i = from; i < strand.sections.size(); ++i) {
        // Like its hair a branch goes straight from its last section to the trunk's first.
        if (strand.trunk < strand.sections.size() && i < strand.trunk && i + kBetween + 1 > strand.trunk) continue;
        const Section& s = strand.sections[i];
        const Vec2 centre = view(s.centre);
        // Round a branch's root it lies within the hair, which runs straight past it.
        const double from_root = std::abs(static_cast<double>(i) - static_cast<double>(strand.trunk)) / (kBetween + 1);
        const double under = strand.trunk > 0 ? std::lerp(kRoot, kUnder, smooth_step(from_root / 3)) : kUnder;
        const Vec2 e = under * s.a * view.scale * Vec2{glm::dot(s.e, view.right), -glm::dot(s.e, view.up)};
        const Vec2 m = under * s.b * view.scale * Vec2{glm::dot(s.m, view.right), -glm::dot(s.m, view.up)};
        std::vector<Vec2> round;
        for (int k = 0; k < kRound; ++k) {
            const double w = 2 * std::numbers::pi * k / kRound;
            round.push_back(centre + std::cos(w) * e + std::sin(w) * m);
        }
        fill_polygon(canvas, round, colour);
        const Vec2 t{glm::dot(s.tangent, view.right), -glm::dot(s.tangent, view.up)};
        const double size = glm::length(t);
        const Vec2 across = size > 1e-6 ? Vec2{-t.y, t.x} / size : Vec2{1, 0};
        const Vec2 half = std::hypot(glm::dot(e, across), glm::dot(m, across)) * across;
        now = {centre + half, centre - half};
        if (i > from) {
            const Vec2 quad[] = {before[0], now[0], now[1], before[1]};
            fill_polygon(canvas, quad, colour);
        }
        before = now;
    }
}

void draw_tuft_hair(BrushCanvas& canvas, const Tuft& tuft, const TuftState& state, const BrushView& view,
                    const TuftAppearance& appearance) {
    if (tuft.carried) return draw_shape(canvas, state.shape, view);
    const std::vector<Strand> strands = strands_of(state, appearance);
    const int count = static_cast<int>(strands.size());
    // A row ends in the ends of its hair, not in those of its spines.
    const std::size_t from = state.strips && count > 1 ? kBetween + 1 : 0;
    if (!appearance.dry)
        for (const Strand& strand : strands) fill_silhouette(canvas, strand, view, linear_colour(78, 55, 40), from);
    const std::vector<Bristle>& bristles = tuft.bundles.bristles;
    std::vector<Placed> placed;
    std::vector<double> near;
    const Vec3 viewer = view.toward();
    for (const Bristle& b : bristles) {
        placed.emplace_back(tuft.bundles, b, count);
        const Strand& strand = strands[static_cast<std::size_t>(placed.back().part.branch)];
        const Section& s = strand.sections[strand.sections.size() / 3];
        near.push_back(glm::dot(
            point_of(s, strand.sections.size() / 3 < strand.trunk ? placed.back().part.place : placed.back().whole),
            viewer));
    }
    std::vector<std::size_t> order(bristles.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return near[a] < near[b]; });
    const Vec3 light = glm::normalize(0.75 * view.up - 0.45 * view.right + 0.5 * viewer);
    Random random(tuft.bundles.seed + 7);
    std::vector<double> shade(bristles.size());
    for (double& s : shade) s = random.uniform(-0.2, 0.2);
    const bool unequal = state.strips && (tuft.preset.toe > 0 || tuft.preset.slant > 0);
    const HairLengths lengths(tuft.preset);
    std::vector<Vec2> line;
    std::vector<double> width;
    for (const std::size_t h : order) {
        const Placed& p = placed[h];
        const auto k = static_cast<std::size_t>(p.part.branch);
        const Recycled<Section>& fine = strands[k].sections;
        const double readiness = bristles[h].readiness, n = static_cast<double>(fine.size());
        // Hairs end at unequal lengths; water draws all of them to the point.
        const double outward = state.strips ? std::abs(p.whole.y) : glm::length(p.whole);
        const double short_by = appearance.dry ? 0.16 * readiness : 0.3 * readiness * readiness * outward;
        const double beyond = unequal ? beyond_spine(tuft, lengths, p) : 0;
        const std::size_t stop = first_left(fine, static_cast<std::size_t>(short_by * n), -beyond);
        line.clear();
        width.clear();
        double lit = 0;
        const double ahead = stop == 0 ? std::max(0.0, beyond) / tuft.preset.length : 0;
        for (std::size_t i = stop; i < fine.size(); ++i) {
            const std::optional<Vec2> at = p.at(strands[k], k, i);
            if (!at) continue;
            const Vec3 place = state.strips ? point_in_row(strands, k, i, *at) : point_of(fine[i], *at);
            if (i == 0 && ahead > 0) {
                Vec3 end = place + beyond * fine[i].tangent;
                end.z = std::max(end.z, appearance.ground);
                line.push_back(view(end));
                width.push_back(0.5);
            }
            line.push_back(view(place));
            const double from_end = static_cast<double>(i - stop) / n + ahead;
            width.push_back(0.5 + (appearance.dry ? 0.7 : 1.1) * std::min(1.0, 4 * from_end));
            lit += glm::dot(at->x * fine[i].e + at->y * fine[i].m, light);
        }
        if (line.size() < 2) continue;
        lit /= static_cast<double>(line.size() - (stop == 0 && ahead > 0 ? 1 : 0));
        const double tone = std::clamp(0.42 + 0.5 * lit + shade[h], 0.0, 1.0);
        stroke_line(canvas, line, width, glm::mix(linear_colour(48, 32, 22), linear_colour(206, 168, 120), tone), 0.8);
    }
}

/// A turned piece along the holder's axis, from one height over the mouth to another, metres.
struct Turned {
    double from, to, from_radius, to_radius;
    Vec3 dark, light;
};

/// What of a turned piece faces the viewer, and the end that does.
void fill_turned(BrushCanvas& canvas, const Turned& piece, const Pose& pose, const BrushView& view) {
    constexpr int kShades = 48;
    const Vec3 up = -pose.axis(), viewer = view.toward();
    Vec3 side = glm::cross(up, viewer);
    side = glm::length(side) > 1e-6 ? glm::normalize(side) : view.right;
    const Vec3 front = glm::cross(side, up);
    const auto rim = [&](double height, double radius, double w) {
        return view(pose.position + height * up + radius * (std::sin(w) * side + std::cos(w) * front));
    };
    const double lean = 0.25 * glm::dot(side, view.right);
    std::vector<Vec2> lower, upper;
    for (int k = 0; k <= kShades; ++k) {
        const double w = std::numbers::pi * (static_cast<double>(k) / kShades - 0.5);
        lower.push_back(rim(piece.from, piece.from_radius, w));
        upper.push_back(rim(piece.to, piece.to_radius, w));
    }
    for (int k = 0; k < kShades; ++k) {
        const double w = std::numbers::pi * ((k + 0.5) / kShades - 0.5);
        const double shade = std::max(0.0, 0.8 * std::cos(w) - lean * std::sin(w));
        // To the far edge: the next one covers the rest, and no paper shows between two.
        std::vector<Vec2> strip(lower.begin() + k, lower.end());
        strip.insert(strip.end(), upper.rbegin(), upper.rend() - k);
        fill_polygon(canvas, strip, glm::mix(piece.dark, piece.light, shade));
    }
    const bool top = glm::dot(up, viewer) > 0;
    std::vector<Vec2> end;
    end.reserve(2 * kShades);
    for (int k = 0; k < 2 * kShades; ++k)
        end.push_back(rim(top ? piece.to : piece.from, top ? piece.to_radius : piece.from_radius,
                          std::numbers::pi * k / kShades));
    fill_polygon(canvas, end, glm::mix(piece.dark, piece.light, top ? 0.5 : 0));
}

}  // namespace

namespace {

/// A ferrule with a wide mouth, pressed from a round tube: from its mouth to the height where it is round.
void fill_wide_ferrule(BrushCanvas& canvas, const Preset& p, const Pose& pose, const BrushView& view, double height,
                       double radius) {
    constexpr int kSides = 96;
    const Vec3 viewer = view.toward(), up = -pose.axis();
    const auto round = [&](int k) { return 2 * std::numbers::pi * k / kSides; };
    const auto at = [&](int k, bool top) {
        const double w = round(k), c = std::cos(w), s = std::sin(w);
        const double q = 2 / p.corner;
        const Vec2 mouth{0.5 * p.width * std::copysign(std::pow(std::abs(c), q), c),
                         1.06 * p.radius * std::copysign(std::pow(std::abs(s), q), s)};
        const Vec2 flat = top ? radius * Vec2{c, s} : 1.03 * mouth;
        return pose.position + pose.rotation * Vec3{flat.x, flat.y, 0} + (top ? height : 0) * up;
    };
    const Vec3 dark = linear_colour(28, 28, 32), light = linear_colour(165, 165, 174);
    // What lies behind the sides, so that no paper shows between two.
    for (int k = 0; k < kSides / 2; ++k) {
        const int other = kSides - 1 - k;
        const Vec2 slice[] = {view(at(k, false)), view(at(other, false)), view(at(other, true)), view(at(k, true))};
        fill_polygon(canvas, slice, glm::mix(dark, light, 0.5));
    }
    for (int k = 0; k < kSides; ++k) {
        const Vec3 p0 = at(k, false), p1 = at(k + 1, false), q0 = at(k, true), q1 = at(k + 1, true);
        const Vec3 out = glm::cross(p1 - p0, q0 - p0);
        const double size = glm::length(out);
        if (!(size > 0) || glm::dot(out, viewer) <= 0) continue;
        const double facing = glm::dot(out, viewer) / size;
        const Vec2 quad[] = {view(p0), view(p1), view(q1), view(q0)};
        fill_polygon(canvas, quad, glm::mix(dark, light, 0.15 + 0.75 * facing * facing));
    }
}

}  // namespace

void draw_brush(BrushCanvas& canvas, const PosedTuft& posed, const BrushView& view, double length,
                const TuftAppearance& appearance) {
    const auto& [tuft, state, pose] = posed;
    const Preset& p = tuft.preset;
    const double r = has_broad_side(p) ? std::max(1.3 * p.radius, 0.3 * p.width)
                     : is_foam(p)      ? 0.32 * p.radius
                                       : 1.12 * rest_radius(p, 0);
    const Turned handle{
        0.2 * p.length, length, 0.92 * r, 0.9 * r, linear_colour(96, 66, 34), linear_colour(222, 184, 120)};
    const Turned ferrule{0, 0.22 * p.length, r, 1.04 * r, linear_colour(28, 28, 32), linear_colour(150, 150, 158)};
    const bool into_mouth = glm::dot(pose.axis(), view.toward()) > 0;
    if (has_broad_side(p)) {
        Turned out = handle;
        out.from = std::max(ferrule.to, 0.6 * p.width);
        if (into_mouth) fill_turned(canvas, out, pose, view);
        if (into_mouth) fill_wide_ferrule(canvas, p, pose, view, out.from, r);
        draw_tuft_hair(canvas, tuft, state, view, appearance);
        if (!into_mouth) fill_wide_ferrule(canvas, p, pose, view, out.from, r);
        if (!into_mouth) fill_turned(canvas, out, pose, view);
    } else if (into_mouth) {
        fill_turned(canvas, handle, pose, view);
        fill_turned(canvas, ferrule, pose, view);
        draw_tuft_hair(canvas, tuft, state, view, appearance);
    } else {
        // The near rim hides the roots; the handle stands in the ferrule.
        draw_tuft_hair(canvas, tuft, state, view, appearance);
        fill_turned(canvas, ferrule, pose, view);
        Turned out = handle;
        out.from = ferrule.to;
        fill_turned(canvas, out, pose, view);
    }
}

namespace {

/// How far a section's outline reaches over its centre and under it.
double reach_of(const Section& s) {
    return std::hypot(s.a * s.e.z, s.b * s.m.z);
}

bool meets_sheet(const Section& s) {
    const double reach = reach_of(s);
    return reach > 0 && std::abs(s.centre.z) <= reach;
}

Section between(const Section& p, const Section& q, double f) {
    Section s = p;
    s.centre = glm::mix(p.centre, q.centre, f);
    s.e = glm::normalize(glm::mix(p.e, q.e, f));
    s.m = glm::normalize(glm::mix(p.m, q.m, f));
    s.a = std::lerp(p.a, q.a, f);
    s.b = std::lerp(p.b, q.b, f);
    return s;
}

/// Those of the sections that meet the sheet, and more up to where the tuft only just does: there
/// the patch is round, as wide as the square root of the distance from its end.
Recycled<Section> touching(const Recycled<Section>& sections) {
    constexpr int kRound = 12;
    Recycled<Section> out;
    const auto add_end = [&](const Section& in, const Section& off, bool towards) {
        double meets = 0, misses = 1;
        for (int i = 0; i < 30; ++i) {
            const double f = 0.5 * (meets + misses);
            (meets_sheet(between(in, off, f)) ? meets : misses) = f;
        }
        for (int k = 1; k <= kRound; ++k) {
            const double part = static_cast<double>(towards ? kRound + 1 - k : k) / kRound;
            out.push_back(between(in, off, meets * part * (2 - part)));
        }
    };
    for (std::size_t i = 0; i < sections.size(); ++i) {
        const bool now = meets_sheet(sections[i]), before = i > 0 && meets_sheet(sections[i - 1]);
        if (i > 0 && now && !before) add_end(sections[i], sections[i - 1], true);
        if (now) out.push_back(sections[i]);
        if (i > 0 && before && !now) add_end(sections[i - 1], sections[i], false);
    }
    return out;
}

}  // namespace

void draw_patch(BrushCanvas& canvas, const Tuft& tuft, const TuftState& state, const BrushView& view, double y,
                const TuftAppearance& appearance) {
    const Vec3 ink = linear_colour(24, 22, 24);
    const auto plan = [&](const Vec3& p) {
        return Vec2{view.foot.x + view.scale * (p.x - view.origin.x), y + view.scale * (p.y - view.origin.y)};
    };
    if (tuft.carried) return draw_shape_patch(canvas, tuft, state.shape, view, y);
    if (appearance.dry) {
        // The lines of the bristles that lie on the sheet.
        TuftAppearance as_pressed = appearance;
        as_pressed.ground = -1;
        const std::vector<Strand> strands = strands_of(state, as_pressed);
        const double width = 0.6;
        for (const Bristle& b : tuft.bundles.bristles) {
            const Placed placed(tuft.bundles, b, static_cast<int>(strands.size()));
            const auto k = static_cast<std::size_t>(placed.part.branch);
            std::vector<Vec2> line;
            for (std::size_t i = 0; i < strands[k].sections.size(); ++i) {
                const Section& s = strands[k].sections[i];
                const std::optional<Vec2> at = placed.at(strands[k], k, i);
                if (!at || at->y * s.m.z > 0) continue;
                const double chord =
                    state.strips ? std::sqrt(std::numbers::pi) / 2 : std::sqrt(std::max(0.0, 1 - at->x * at->x));
                const double under = chord * s.b * std::abs(s.m.z);
                if (s.centre.z + s.a * at->x * s.e.z - under <= 1e-4) line.push_back(plan(point_of(s, *at)));
            }
            stroke_line(canvas, line, {&width, 1}, ink, 0.85);
        }
        return;
    }
    if (state.wide) {
        // The patch as it is painted: strips, and the skin between those that ink joins.
        for (const footprint::Outline& outline : footprint::outlines_of(state, Frame{})) {
            std::vector<Vec2> points;
            for (const Vec2& q : footprint::curve_points(outline)) points.push_back(plan({q, 0}));
            fill_polygon(canvas, points, ink);
        }
        return;
    }
    for (const Branch& branch : state.branches) {
        std::vector<Vec2> left, right;
        for (const Section& s : touching(refine_sections(branch.sections, kBetween))) {
            const double ne = s.a * s.e.z, nm = s.b * s.m.z, reach = reach_of(s);
            const double middle = std::atan2(nm, ne), half = std::acos(std::clamp(-s.centre.z / reach, -1.0, 1.0));
            Vec3 q[2];
            for (int k = 0; k < 2; ++k) {
                const double w = middle + (k == 0 ? -half : half);
                q[k] = s.centre + s.a * std::cos(w) * s.e + s.b * std::sin(w) * s.m;
            }
            if (q[0].y > q[1].y) std::swap(q[0], q[1]);
            left.push_back(plan(q[0]));
            right.push_back(plan(q[1]));
        }
        left.insert(left.end(), right.rbegin(), right.rend());
        fill_polygon(canvas, left, ink);
    }
}

}  // namespace tuft::render
