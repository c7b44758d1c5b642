#include "brush/tuft/tuft_sections.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "brush/tuft/shape/lateral.h"
#include "core/cubic.h"
#include "core/ease.h"

namespace tuft::brush {

Recycled<Vec3> node_tangents(const rod::Memory& m) {
    const std::size_t n = m.tangent.size();
    Recycled<Vec3> t(n + 1);
    for (std::size_t i = 0; i <= n; ++i) {
        const Vec3& inner = i == 0 ? m.clamp.tangent : m.tangent[i - 1];
        const Vec3& outer = i == n ? m.tangent[n - 1] : m.tangent[i];
        const Vec3 sum = inner + outer;
        const double size = glm::length(sum);
        t[i] = size > 1e-6 ? sum / size : outer;
    }
    return t;
}

Recycled<Vec3> broad_axes(const rod::Memory& m, std::span<const Vec3> t) {
    Recycled<Vec3> out(t.size());
    Vec3 x = m.clamp.side, from = m.clamp.tangent;
    for (std::size_t i = 0; i < t.size(); ++i) {
        x = parallel_transport(x, from, t[i]);
        x = glm::normalize(x - glm::dot(x, t[i]) * t[i]);
        from = t[i];
        out[i] = x;
    }
    return out;
}

namespace {

/// Cosine below which directions count as perpendicular: a hand that moves exactly along its holder's x leaves the sign
/// to rounding, and with it on which side which hair comes to lie.
constexpr double kPerpendicular = 1e-4;

struct Wide {
    std::size_t node = 0;
    Vec3 direction{1, 0, 0};
};

/// Where the wide axis is known best, and its direction there.
Wide wide_axis(const SectionInput& in, const Recycled<Vec3>& t) {
    const Vec3 kept = in.rotation * in.spine.sides.direction;
    Wide best;
    double most = 0;
    for (std::size_t i = 1; i < t.size() && !in.obstacles.empty(); ++i) {
        const Vec3 across = glm::cross(t[i], in.obstacles[i].normal);
        const double weight = in.result.normal_force[i] * glm::length(across);
        if (weight > most) {
            most = weight;
            best = {i, across};
        }
    }
    if (most <= 0 && in.wide()) {
        best = {0, in.spine.memory.clamp.side};
    } else if (most <= 0) {
        Vec3 bend{0};
        const rod::Memory& m = in.spine.memory;
        for (std::size_t j = 0; j < m.tangent.size(); ++j) {
            bend += glm::cross(j == 0 ? m.clamp.tangent : m.tangent[j - 1], m.tangent[j]);
        }
        if (glm::length(bend) > 0.02)
            best = {0, bend};
        else
            best = {0, kept};
    }
    Vec3& e = best.direction;
    e -= glm::dot(e, t[best.node]) * t[best.node];
    if (glm::length(e) < 1e-9) e = glm::cross(t[best.node], in.rotation * Vec3{0.36, 0.48, 0.8});
    e = glm::normalize(e);
    Vec3 at_node = kept;
    for (std::size_t i = 0; i < best.node; ++i) at_node = parallel_transport(at_node, t[i], t[i + 1]);
    if (glm::dot(at_node, e) < -kPerpendicular) e = -e;
    return best;
}

}  // namespace

namespace {

/// Relative indentation of the hair round each node, 0 to 1, root first: indentation over radius, mean
/// over the hair that the node stands for (its hat function), along the cubic through the nodes; hair that stands
/// on the surface is not pressed flat. A contact that comes in between two nodes so begins smoothly at both.
Recycled<double> indentation_of(const SectionInput& in, const Recycled<Vec3>& t) {
    constexpr int kPoints = 6;  // per segment
    const std::size_t count = in.node.size();
    Recycled<double> out(count, 0);
    if (in.obstacles.empty()) return out;
    Recycled<double> z(count), c(count);
    for (std::size_t i = 0; i < count; ++i) {
        z[i] = glm::dot(in.node[i] - in.obstacles[i].origin, in.obstacles[i].normal);
        c[i] = glm::dot(t[i], in.obstacles[i].normal);
    }
    for (std::size_t j = 0; j + 1 < count; ++j) {
        const double l = in.spine.rod.length[j];
        for (int k = 0; k < kPoints; ++k) {
            const double f = (k + 0.5) / kPoints;
            const double r = std::lerp(in.obstacles[j].radius, in.obstacles[j + 1].radius, f);
            const double depth = r - hermite_between(z[j], z[j + 1], l * c[j], l * c[j + 1], f);
            if (r <= 0 || depth <= 0) continue;
            const double lean = std::lerp(c[j], c[j + 1], f);
            const double indentation = std::min(depth / r, 1.0) * (1 - lean * lean) * l / kPoints;
            out[j] += (1 - f) * indentation / in.spine.rod.weight[j];
            out[j + 1] += f * indentation / in.spine.rod.weight[j + 1];
        }
    }
    out.front() = 0;
    return out;
}

constexpr double kDry = 0.7;      ///< stretch springs of dry hair over those of wet hair
constexpr double kReach = 0.045;  ///< of the length, λ of the side nodes
constexpr double kWall = 100;     ///< stiffness of a wall over that of the springs
constexpr double kFinest = 1e-5;  ///< m, radius of a tuft's point at least
constexpr double kSides =
    0.03;  ///< of k_c, the stretch springs: water holds hair together by some 0.3 N/m a millimetre
constexpr double kSideDrag = 1.0;  ///< of kSides: share of the friction across a section that its side nodes take
constexpr double kGrip =
    0.05;  ///< of the length, distance along the hair over which a contact takes the hair beyond it along
constexpr double kFree = 0.1;   ///< of r, height off the surface from which hair beyond the contact is free of it
constexpr double kLying = 0.6;  ///< height over b at which wet hair lies by its own weight

/// How far each centre comes down along its plane's normal, metres, root first. A flattened
/// section keeps its lower side where the contact has it, so the centre sinks by r - b, but
/// not below the surface; what the contact's give let sink is lifted onto it; this fades within r off
/// the surface, beyond the contact within kFree r. The free end beyond the contact comes down with the contact, and by
/// the wet film's thickness more, until it touches: all of it from kGrip behind the place on where the hair comes to
/// touch.
Recycled<double> lowering(const SectionInput& in, const Recycled<Section>& sections) {
    const std::size_t count = sections.size();
    Recycled<double> down(count, 0);
    if (in.obstacles.empty()) return down;
    const double film = in.preset.adhesion > 0 ? in.wetness * in.preset.adhesion_range : 0;
    double at = 0, gap_before = 0;  // along the hair; how far the hair's side is off the surface there
    double touch = -1;              // where the hair comes to touch
    double give = 0;                // by which the contact comes down
    for (std::size_t i = 1; i < count; ++i) {
        const Section& s = sections[count - 1 - i];
        const rod::Obstacle& o = in.obstacles[i];
        const double z = glm::dot(s.centre - o.origin * in.preset.length, o.normal);
        const double r = in.wide() ? o.radius * in.preset.length : in.spine.rest.radius[i];
        const double upright = std::abs(glm::dot(s.m, o.normal));
        const double l = in.spine.rod.length[i - 1], gap = z - r;
        if (touch < 0 && gap < 0) touch = i > 1 ? at + l * gap_before / (gap_before - gap) : at;
        at += l;
        gap_before = gap;
        double height = std::numeric_limits<double>::infinity();
        if (touch >= 0) {
            const double tail = smooth_step((at - touch) / kGrip) * (give + film);
            // Comes to lie without a kink, so that the patch's end moves evenly with depth.
            const double lying = kLying * s.b * upright, h = z - tail - lying;
            height = std::min(z, lying + 0.5 * (h + std::hypot(h, s.b)));
        }
        const double fade = (touch >= 0 ? kFree : 1) * r, sinks = (r - s.b) * upright;
        const double near = fade > 0 ? std::clamp(1 - gap / fade, 0.0, 1.0) : gap < 0 ? 1 : 0;
        // Deeper than the tuft is thick it is not give: it is within the model, and stays there.
        height = std::max(std::min(0.0, z + in.preset.radius), std::min(height, z - near * sinks));
        down[i] = z - height;
        give += near * (down[i] - give);
    }
    return down;
}

}  // namespace

namespace {

/// Half-widths of the sections to the side of e and to the other, metres, root first.
struct Widths {
    Recycled<double> plus, minus;
    Recycled<double> free_plus, free_minus;  ///< without walls
    LateralShift shift;
    double spread_energy = 0;
    Recycled<Vec2> turn;  ///< as in Section
};

/// Half-widths of the resting sections along e and across it, metres, root first; and where their broad side is, as in
/// Section.
struct Rest {
    Recycled<double> along, across;
    Recycled<Vec2> turn;
};

Rest rest_of(const SectionInput& in, const Recycled<Vec3>& t, const Recycled<Vec3>& e) {
    if (!in.wide()) return {in.spine.rest.radius, in.spine.rest.radius, Recycled<Vec2>(e.size(), {1, 0})};
    Rest out;
    const Recycled<Vec3> own = in.broad.empty() ? broad_axes(in.spine.memory, t) : Recycled<Vec3>{};
    const std::span<const Vec3> x = in.broad.empty() ? std::span<const Vec3>(own) : in.broad;
    for (std::size_t i = 0; i < e.size(); ++i) {
        const Vec2& rest = in.spine.rest.section[i];
        const double broad = rest.x * glm::dot(e[i], x[i]), thick = rest.y * glm::dot(e[i], glm::cross(x[i], t[i]));
        const double along = std::hypot(broad, thick);
        out.along.push_back(along);
        out.across.push_back(along > 0 ? rest.x * rest.y / along : 0);
        // Of each point of the resting ellipse the part along e.
        out.turn.push_back(along > 0 ? Vec2{broad, -thick} / along : Vec2{1, 0});
    }
    return out;
}

/// How far, beyond its resting half-width r, a side node may go out along `direction` before it meets the place between
/// its spine and a neighbour where the hair of both touches.
double clearance_beside(const Neighbour& beside, std::size_t node, const Vec3& direction, double r) {
    constexpr double kFaces = 0.5;  // cosine to the neighbour from which it is in the way
    if (node >= beside.apart.size()) return std::numeric_limits<double>::infinity();
    const Vec3& apart = beside.apart[node];
    const double distance = glm::length(apart), nearing = glm::dot(apart, direction);
    if (nearing < kFaces * distance) return std::numeric_limits<double>::infinity();
    return distance * distance / nearing * beside.part[node] - r;
}

/// How far, beyond its rest radius, a side node may go out along `direction` before it meets a wall;
/// planes that lean away less than 20° are the ground the section lies on.
double clearance(const SectionInput& in, std::size_t node, const ContactPlane& wall, const Vec3& direction, double r) {
    constexpr double kGround = 0.34;  // sin 20°
    const double nearing = -glm::dot(direction, wall.normal);
    if (nearing < kGround) return std::numeric_limits<double>::infinity();
    const Vec3 x = in.node[node] * in.preset.length;
    return glm::dot(x - wall.origin, wall.normal) / nearing - r;
}

/// Loads of the side nodes, root first.
struct SideLoads {
    Recycled<double> at;  ///< metres from the mouth
    LateralSide plus, minus;
    LateralFriction friction;
};

/// Computes what pushes the side nodes out, as if it worked against the wet stretch springs alone:
/// r (κ1 |m|/M_e0 + κ2 k_F + κ3 i); how far they can go; and the friction of the surface along e.
SideLoads side_loads(const SectionInput& in, const Recycled<Vec3>& t, const Recycled<Vec3>& e, const Rest& rest) {
    const Preset& p = in.preset;
    const std::size_t count = e.size();
    const double yield = (p.yield > 0 ? p.yield : 1) / in.share;
    const double newton = p.stiffness / (p.length * p.length);
    const double of_tuft = in.wide() ? in.share : 1;
    const double k_f = std::min(1.0, p.force_gain * glm::length(in.result.force) * of_tuft * newton / p.force_limit);
    const Recycled<double> indentation = indentation_of(in, t);
    const double wet = kSides * p.transverse_stiffness;
    SideLoads out;
    auto& [at, plus, minus, friction] = out;
    at.assign(count, 0);
    plus = {Recycled<double>(count, 0), Recycled<double>(count, std::numeric_limits<double>::infinity())};
    const double root = in.spine.rest.root_width;
    if (root > 0) plus.root = side_of_width(rest.along.front(), root, p.flatten_max);
    minus = plus;
    friction = {Recycled<double>(count, 0), Recycled<double>(count, 0), in.spine.sides.slips};
    for (std::size_t i = 0; i < count; ++i) {
        if (i > 0) at[i] = at[i - 1] + in.spine.rod.length[i - 1] * p.length;
        const double moment = i + 1 < count ? in.result.moment[i] : 0;
        // The ferrule holds the hair round for some radii from its mouth.
        const double out_of_ferrule = at[i] / (2.5 * p.radius);
        const double held = in.share > 1 && !in.wide() ? 1 : 1 - std::exp(-out_of_ferrule * out_of_ferrule);
        const double widen =
            held * (p.flatten_moment * moment / yield + p.flatten_force * k_f + p.flatten_contact * indentation[i]);
        const Vec3 wall = in.result.wall_force.empty() ? Vec3{0} : in.result.wall_force[i];
        friction.most[i] = kSides * kSideDrag * std::abs(glm::dot(in.result.contact_force[i] - wall, e[i])) * newton /
                           (in.spine.rod.weight[i] * p.length);
        if (i < in.spine.sides.shift.size()) friction.stuck[i] = in.spine.sides.shift[i];
        if (i < in.result.slip.size()) friction.stuck[i] -= p.length * glm::dot(in.result.slip[i], e[i]);
        if (!in.walls.empty() && i > 0) {
            const std::size_t from_tip = 2 * (count - 1 - i);
            plus.clear[i] = clearance(in, i, in.walls[from_tip], e[i], rest.along[i]);
            minus.clear[i] = clearance(in, i, in.walls[from_tip + 1], -e[i], rest.along[i]);
        }
        for (const Neighbour& beside : in.neighbours) {
            plus.clear[i] = std::min(plus.clear[i], clearance_beside(beside, i, e[i], rest.along[i]));
            minus.clear[i] = std::min(minus.clear[i], clearance_beside(beside, i, -e[i], rest.along[i]));
        }
        plus.push[i] = minus.push[i] = wet * rest.across[i] * widen;
    }
    return out;
}

/// Half-widths of the sections in equilibrium of the side nodes.
Widths side_nodes(const SectionInput& in, const Recycled<Vec3>& t, const Recycled<Vec3>& e) {
    const Preset& p = in.preset;
    const std::size_t count = e.size();
    const Rest rest = rest_of(in, t, e);
    const double wet = kSides * p.transverse_stiffness;
    LateralSprings springs{
        .stretch = wet * (kDry + (1 - kDry) * in.wetness), .bend = wet, .reach = kReach * p.length, .wall = kWall};
    for (const double r : rest.along) springs.taper.push_back(std::max(r, kFinest));
    auto [at, plus, minus, friction] = side_loads(in, t, e, rest);
    Widths out;
    out.turn = rest.turn;
    const LateralRow row = lateral_row(at, springs);
    out.shift = drag_lateral(row, friction);
    const Recycled<double>& shift = out.shift.shift;
    const bool walled = !in.walls.empty() || in.wide();
    for (std::size_t i = 0; i < count && walled; ++i) {
        plus.clear[i] -= shift[i];
        minus.clear[i] += shift[i];
    }
    LateralSide free = plus;
    free.clear.assign(count, std::numeric_limits<double>::infinity());
    out.free_plus = solve_lateral(row, free);
    out.free_minus = out.free_plus;
    out.plus = walled ? solve_lateral(row, plus) : out.free_plus;
    out.minus = walled ? solve_lateral(row, minus) : out.plus;
    out.spread_energy = stored_at_rest(at, springs, plus, out.plus) + stored_at_rest(at, springs, minus, out.minus);
    for (std::size_t i = 0; i < count; ++i) {
        const double r = rest.along[i];
        out.free_plus[i] = half_width(r, out.free_plus[i] + shift[i], p.flatten_max);
        out.free_minus[i] = half_width(r, out.free_minus[i] - shift[i], p.flatten_max);
        out.plus[i] = half_width(r, out.plus[i] + shift[i], p.flatten_max);
        out.minus[i] = half_width(r, out.minus[i] - shift[i], p.flatten_max);
    }
    return out;
}

/// Factor ≥ 1 on both semi-axes of each section, root first, by which ink at the point is wider than its hair. The drop
/// that hangs there has the radius ρ; pressed to the depth δ of the straight hair's point it wets ρ tanh(δ/2ρ). It
/// reaches 4 ρ up the hair, where the tuft is as thick as the drop, and carries no force.
Recycled<double> drop_factors(const SectionInput& in) {
    const double rho = in.wetness * in.preset.tip_drop;
    Recycled<double> out(in.node.size(), 1);
    if (in.obstacles.empty() || rho <= 0 || in.wide() || in.share > 1) return out;
    const double length = in.preset.length;
    const rod::Obstacle& obstacle = in.obstacles.back();
    const rod::Clamp& clamp = in.spine.memory.clamp;
    const auto height = [&](const Vec3& x) { return length * glm::dot(x - obstacle.origin, obstacle.normal); };
    const double hair = std::accumulate(in.spine.rod.length.begin(), in.spine.rod.length.end(), 0.0);
    const double depth = std::max(0.0, -height(clamp.position + hair * clamp.tangent));
    const double gap = height(in.node.back()) - in.spine.rest.radius.back();
    const double wet = rho * std::tanh(depth / (2 * rho)) * std::clamp(1 - gap / rho, 0.0, 1.0);
    double from_tip = 0;
    for (std::size_t i = out.size(); i-- > 0 && from_tip < 4 * rho;) {
        const double r = in.spine.rest.radius[i];
        if (r > 0) out[i] = std::hypot(1.0, wet * (1 - from_tip / (4 * rho)) / r);
        if (i > 0) from_tip += length * in.spine.rod.length[i - 1];
    }
    return out;
}

}  // namespace

double side_stiffness(double wetness) {
    return kSides * (kDry + (1 - kDry) * wetness) * kWall / (1 + kWall);
}

SectionOutput make_sections(const SectionInput& in) {
    const Preset& p = in.preset;
    const rod::Memory& m = in.spine.memory;
    const std::size_t count = m.node.size();
    const Recycled<Vec3> t = in.along.empty() ? node_tangents(m) : Recycled<Vec3>(in.along.begin(), in.along.end());
    const Wide wide = wide_axis(in, t);
    Recycled<Vec3> e(count);
    e[wide.node] = wide.direction;
    for (std::size_t i = wide.node + 1; i < count; ++i) e[i] = parallel_transport(e[i - 1], t[i - 1], t[i]);
    for (std::size_t i = wide.node; i-- > 0;) e[i] = parallel_transport(e[i + 1], t[i + 1], t[i]);
    for (std::size_t i = 0; i < count; ++i) e[i] = glm::normalize(e[i] - glm::dot(e[i], t[i]) * t[i]);

    Widths widths = side_nodes(in, t, e);
    SectionOutput out;
    out.aside = std::move(widths.shift.shift);
    out.slips = std::move(widths.shift.slips);
    out.aside_energy = widths.shift.stored;
    out.spread_energy = widths.spread_energy;
    out.sections.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double r = in.spine.rest.radius[i];
        Section& section = out.sections[count - 1 - i];
        section.a = 0.5 * (widths.plus[i] + widths.minus[i]);
        section.b = r > 0 ? r * r / section.a : 0;
        section.tangent = t[i];
        section.e = e[i];
        section.turn = widths.turn[i];
        section.m = glm::cross(e[i], t[i]);
        section.centre = in.node[i] * p.length + 0.5 * (widths.plus[i] - widths.minus[i]) * e[i];
        section.moment = (i + 1 < count ? in.result.moment[i] : 0) * p.stiffness / p.length;
        section.pressure =
            in.result.normal_force[i] / in.spine.rod.weight[i] * p.stiffness / (p.length * p.length * p.length);
    }
    const Recycled<double> down = lowering(in, out.sections);
    for (std::size_t i = 1; i < count && !in.obstacles.empty(); ++i) {
        out.sections[count - 1 - i].centre -= down[i] * in.obstacles[i].normal;
    }
    const Recycled<double> drop = drop_factors(in);
    for (std::size_t i = 0; i < count; ++i) {
        out.sections[count - 1 - i].a *= drop[i];
        out.sections[count - 1 - i].b *= drop[i];
    }
    const Quat back = glm::conjugate(in.rotation);
    for (std::size_t i = count; i-- > 0;) {
        const Vec3 x = (in.node[i] - in.node[0]) * p.length;
        out.sides.push_back(back * (x + widths.plus[i] * e[i]));
        out.sides.push_back(back * (x - widths.minus[i] * e[i]));
        out.flank.push_back(widths.free_plus[i]);
        out.flank.push_back(widths.free_minus[i]);
    }
    out.wide = back * e[0];
    return out;
}

}  // namespace tuft::brush
