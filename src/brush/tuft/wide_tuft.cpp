#include "brush/tuft/wide_tuft.h"

#include <algorithm>
#include <cmath>

#include "brush/rod/rod_points.h"
#include "brush/tuft/flanks.h"
#include "brush/tuft/tuft_sections.h"

namespace tuft::brush {

namespace {

constexpr double kShear = 0.4;                 ///< k_s over k_n
constexpr double kFilled = 0.2;                ///< wetness from which the film between two spines is closed
constexpr double kThinnest = 1e-3;             ///< m, of hair that neighbours slide past
constexpr double kHairPart = 0.55;             ///< φ, volume of hair in a packed tuft
constexpr double kWaterWeight = 9810;          ///< ρ g, N/m³
constexpr int kLeastIterations = 30;           ///< of a part of a step
constexpr double kTouch = 0.8862269254527580;  ///< √π/2: half the pitch of a strip over its ellipse's semi-axis

/// The part of `all` that belongs to each spine, `per` for each node; the same one for all, or none, where `all` holds
/// no more than one.
std::span<const ContactPlane> part_of(std::span<const ContactPlane> all, std::size_t first, std::size_t count) {
    return all.size() > 1 ? all.subspan(first, count) : all;
}

/// Walls of all spines: two beside each node, then, or not, one across from each.
struct AllWalls {
    std::span<const ContactPlane> beside, across;

    AllWalls(std::span<const ContactPlane> walls, const Tuft& tuft) {
        std::size_t nodes = 0;
        for (const Spine& spine : tuft.spines) nodes += spine.rest.radius.size();
        if (walls.empty()) return;
        beside = walls.first(2 * nodes);
        across = walls.subspan(2 * nodes);
    }
};

/// Tangents and broad axes of the nodes of a spine, unit, root first.
struct NodeAxes {
    Recycled<Vec3> along, broad;

    explicit NodeAxes(const rod::Memory& memory) : along(node_tangents(memory)), broad(broad_axes(memory, along)) {}
};

/// Obstacles of one spine (root first) from its planes (tip first). The tuft's reach depends on the direction.
Recycled<rod::Obstacle> obstacles_of_wide(const Preset& p, const Spine& spine, const NodeAxes& axes,
                                          std::span<const ContactPlane> planes) {
    return obstacles_from(p, spine, planes, [&](std::size_t i, const Vec3& normal) {
        return rest_reach(spine, i, axes.broad[i], axes.along[i], normal);
    });
}

/// Half-width of the spread section of each node in a direction of the ferrule frame across the hair, without
/// neighbours, metres, root first.
Recycled<double> spread_half_widths(const Spine& spine, const Vec2& direction) {
    Recycled<double> out;
    const std::size_t count = spine.rest.radius.size();
    if (spine.sides.flank.size() != 2 * count || spine.sides.position.size() != 2 * count) return out;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t k = 2 * (count - 1 - i);
        const Vec3 across = spine.sides.position[k] - spine.sides.position[k + 1];
        const double size = glm::length(across);
        const double a = 0.5 * (spine.sides.flank[k] + spine.sides.flank[k + 1]);
        const double r = spine.rest.radius[i];
        const Vec3 broadside = direction.x * spine.broad[i] + direction.y * spine.across[i];
        const double along = size > 0 ? std::abs(glm::dot(broadside, across) / size) : 1;
        out.push_back(std::hypot(a * along, r * r / a * std::sqrt(std::max(0.0, 1 - along * along))));
    }
    return out;
}

/// Height of the wet film between two spines over that of the law, for their resting sections at a node and at the
/// mouth.
struct FilmHeight {
    double radius = 1, face = 0;  ///< m, of the tuft, and as in FerruleNeighbours
    Vec2 first_root{1}, second_root{1};

    double at(const Vec2& first, const Vec2& second) const {
        if (face <= 0) return std::min({1.0, first.y / radius, second.y / radius});
        return 0.5 * face / radius * std::min(first.y / first_root.y, second.y / second_root.y);
    }
};

/// One solve of all spines, with what it needs.
struct Coupled {
    Recycled<rod::Law> laws;
    Recycled<Recycled<rod::Obstacle>> obstacles;
    Recycled<Recycled<rod::Wall>> walls;
    Recycled<rod::CoupledPair> pairs;

    /// Of one solve, where it starts, and what part of the iterations of a step it may take.
    struct Start {
        int parts = 1;                     ///< of the step's motion
        const StepStart* found = nullptr;  ///< null: extrapolated
    };

    rod::CoupledResult solve(Tuft& tuft, const Pose& pose, std::span<const ContactPlane> planes,
                             std::span<const ContactPlane> all_walls, double dt, const Start& start) {
        const Preset& p = tuft.preset;
        const std::size_t k_all = tuft.spines.size();
        laws.clear();
        obstacles.clear();
        walls.clear();
        const auto [beside, across] = AllWalls(all_walls, tuft);
        std::size_t first = 0;
        for (const Spine& spine : tuft.spines) {
            const std::size_t count = spine.rest.radius.size();
            laws.push_back(law_of(p, tuft.wetness, 1 / spine.rest.share, dt));
            int& most = laws.back().limits.max_iterations;
            if (start.parts > 1) most = std::max(kLeastIterations, most / start.parts);
            const NodeAxes axes(spine.memory);
            obstacles.push_back(obstacles_of_wide(p, spine, axes, part_of(planes, first, count)));
            walls.push_back(flank_walls(p, spine, pose.rotation, part_of(beside, 2 * first, 2 * count), tuft.wetness));
            if (!across.empty())
                add_walls_across(obstacles_of_wide(p, spine, axes, part_of(across, first, count)), walls.back());
            first += count;
        }
        Recycled<rod::CoupledRod> rods;
        for (std::size_t k = 0; k < k_all; ++k) {
            Spine& spine = tuft.spines[k];
            rods.push_back({&spine.rod,
                            &spine.memory,
                            spine_clamp(p, spine, pose),
                            obstacles[k],
                            &laws[k],
                            {},
                            walls[k],
                            start.found ? &start.found->guess[k] : nullptr});
        }
        make_pairs(tuft);
        for (std::size_t k = 0; start.found && k < pairs.size(); ++k) pairs[k].guess = start.found->pair_force[k];
        return rod::solve_coupled(rods, pairs, coupling_of(p, tuft.wetness));
    }

  private:
    void make_pairs(Tuft& tuft) {
        const double length = tuft.preset.length;
        pairs.clear();
        for (Beside& beside : tuft.beside) {
            const Spine &first = tuft.spines[beside.first], &second = tuft.spines[beside.second];
            const Vec2& direction = beside.direction;
            const Recycled<double> left = spread_half_widths(first, direction),
                                   right = spread_half_widths(second, direction);
            // The clamp's second axis is −y.
            rod::CoupledPair pair{
                .first = beside.first, .second = beside.second, .direction = {direction.x, -direction.y}};
            const FilmHeight film{tuft.preset.radius, beside.face, first.rest.section.front(),
                                  second.rest.section.front()};
            for (std::size_t i = 0; i < beside.distance.size(); ++i) {
                pair.touching.push_back(beside.distance[i] / length);
                const Vec2 &l = first.rest.section[i], &r = second.rest.section[i];
                const double grown =
                    i < left.size() && i < right.size() ? kTouch * (left[i] + right[i] - l.x - r.x) : 0;
                pair.spread.push_back((beside.distance[i] + std::max(0.0, grown)) / length);
                pair.film.push_back(film.at(l, r));
                pair.depth.push_back(std::max(l.y + r.y, kThinnest) / length);
            }
            for (const double s : beside.shift) pair.rest_shift.push_back(s / length);
            pair.memory = &beside.memory;
            pairs.push_back(std::move(pair));
        }
    }
};

double bend_of_tip(const Spine& spine) {
    return std::acos(std::clamp(glm::dot(spine.memory.tangent.back(), spine.memory.clamp.tangent), -1.0, 1.0));
}

/// Where the spines that lie already went, across the ferrule's axis; zero while all stand.
Vec3 side_taken(const Tuft& tuft) {
    constexpr double kLies = 0.2;  // radians
    Vec3 sum{0};
    for (const Spine& spine : tuft.spines) {
        const Vec3 &axis = spine.memory.clamp.tangent, &tip = spine.memory.tangent.back();
        const Vec3 across = tip - glm::dot(tip, axis) * axis;
        if (glm::length(across) > kLies) sum += across;
    }
    return glm::length(sum) > kLies ? glm::normalize(sum) : Vec3{0};
}

/// Nearly straight hair falls to one side with all its spines: to where others lie already, else behind the hand's
/// motion, else across the broad side.
void break_symmetries(Tuft& tuft, const Pose& from, const Pose& to, std::span<const ContactPlane> planes) {
    const Vec3 taken = side_taken(tuft);
    std::size_t first = 0;
    for (Spine& spine : tuft.spines) {
        const std::size_t count = spine.rest.radius.size();
        double length = 0;
        for (const double l : spine.rod.length) length += l;
        const rod::Clamp clamp = spine_clamp(tuft.preset, spine, to);
        // The hair of a ring falls outwards all round; that of a row to one side.
        const bool outward = !has_broad_side(tuft.preset) && glm::length(spine.rest.root) > 0;
        break_symmetry(tuft.preset, spine, from, to, part_of(planes, first, count),
                       {.tip = tuft.preset.length * (clamp.position + length * clamp.tangent),
                        .aside = outward ? glm::normalize(spine.rest.root) : Vec3{0, 1, 0},
                        .taken = outward ? Vec3{0} : taken});
        first += count;
    }
}

}  // namespace

Recycled<Spine> make_spines(const Preset& p, const Profile& profile) {
    const std::vector<double> whole = spine_segments(p.segments, 0.25 + 0.75 * p.hardness);
    Recycled<Spine> out;
    for (const FerruleSpine& set : ferrule_spines(p)) {
        // The nodes of all spines face each other; a shorter one ends where its hair does.
        Recycled<double> lengths;
        double s = 0;
        for (std::size_t j = 0; j < whole.size() && s < set.length - 1e-12; ++j) {
            const bool last = j + 1 == whole.size() || s + whole[j] + 0.5 * whole[j + 1] > set.length;
            lengths.push_back(last ? set.length - s : whole[j]);
            s += lengths.back();
        }
        Recycled<double> fractions = lengths;
        for (double& l : fractions) l /= set.length;
        rod::Rod rod = rod::make_rod(profile, fractions);
        rod.plastic_share = p.plastic_share;
        for (std::size_t j = 0; j < lengths.size(); ++j) {
            rod.length[j] = lengths[j];
            rod.stiffness[j] *= set.share / set.length;
            rod.yield[j] *= set.length;
        }
        for (double& w : rod.weight) w *= set.length;
        rod.buckling *= set.share / (set.length * set.length);
        Spine spine;
        spine.rest.root = {set.x, set.y, 0};
        spine.rest.strip = strip_corners(p, set);
        spine.rest.length = set.length;
        spine.rest.edge_short = set.edge_short;
        spine.rest.lean = set.lean;
        spine.rest.share = set.share;
        spine.rod = std::move(rod);
        spine.memory = rod::make_memory(spine.rod, spine_clamp(p, spine, {}));
        double u = 0;
        for (std::size_t i = 0; i <= lengths.size(); ++i) {
            spine.rest.section.push_back(rest_half_widths(p, set, std::min(u, set.length)));
            spine.rest.radius.push_back(std::sqrt(spine.rest.section[i].x * spine.rest.section[i].y));
            if (i < lengths.size()) u += lengths[i];
        }
        out.push_back(std::move(spine));
    }
    return out;
}

Recycled<Beside> make_beside(const Preset& p, std::span<const Spine> spines) {
    Recycled<Beside> out;
    for (const FerruleNeighbours& pair : ferrule_neighbours(p)) {
        Beside beside{.first = pair.first, .second = pair.second, .direction = pair.direction, .face = pair.face};
        const rod::Memory &first = spines[pair.first].memory, &second = spines[pair.second].memory;
        const Recycled<Vec3>&x = first.node, &y = second.node;
        const Vec3 t = glm::normalize(first.clamp.tangent + second.clamp.tangent);
        for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
            const Vec3 d = y[i] - x[i];
            beside.distance.push_back(p.length * glm::length(d - glm::dot(d, t) * t));
            if (i == 0) continue;
            const Vec3 mean = 0.5 * (first.tangent[i - 1] + second.tangent[i - 1]);
            beside.shift.push_back(p.length * glm::dot(mean, d));
        }
        out.push_back(std::move(beside));
    }
    return out;
}

rod::Clamp spine_clamp(const Preset& p, const Spine& spine, const Pose& pose) {
    const double c = std::cos(spine.rest.lean), s = std::sin(spine.rest.lean);
    return {(pose.position + pose.rotation * spine.rest.root) / p.length, pose.rotation * Vec3{s, 0, -c},
            pose.rotation * Vec3{c, 0, s}};
}

rod::CouplingLaw coupling_of(const Preset& p, double wetness) {
    const double unit = p.stiffness / std::pow(p.length, 4);  // N/m² of force per length and displacement
    rod::CouplingLaw law;
    const double contact = kHairModulus * face_over_pitch(p);
    law.contact = contact / unit;
    law.spread = 0.5 * side_stiffness(wetness) * p.transverse_stiffness / p.spines / unit;
    law.shear = kShear * law.contact;
    law.friction = p.hair_friction;
    const double film = 2 * p.surface_tension * 2 * p.radius * std::min(1.0, wetness / kFilled);
    law.film = film / (unit * p.length * p.length);
    if (film > 0) {
        const double menisci = 4 * p.surface_tension * kHairPart * (1 - wetness) / ((1 - kHairPart) * p.hair_diameter);
        const double suction = kWaterWeight * p.length + menisci;
        law.film_range = std::max(2 * p.surface_tension / suction, std::sqrt(12 * film / contact)) / p.length;
    }
    return law;
}

double rest_reach(const Spine& spine, std::size_t i, const Vec3& x, const Vec3& t, const Vec3& n) {
    const Vec2& rest = spine.rest.section[i];
    const double a = rest.x * glm::dot(n, x), b = rest.y * glm::dot(n, glm::cross(x, t)),
                 c = std::min(rest.x, rest.y) * glm::dot(n, t);
    return std::sqrt(a * a + b * b + c * c);
}

namespace {

/// What follows from the motion of the ferrule to one pose.
struct Followed {
    rod::CoupledResult result;      ///< of the last part of the motion
    SolverWork work;                ///< all parts together
    Recycled<Recycled<Vec3>> slip;  ///< of each spine, all parts together
    double dissipation = 0;         ///< all parts together
};

/// A motion of the ferrule, and what it meets.
struct Motion {
    Pose from, to;
    std::span<const ContactPlane> planes, walls;
    double dt = 0;  ///< s
};

/// Solves the spines where the ferrule came from `m.from` to `m.to`, and adds what follows from it.
void follow_part(Tuft& tuft, const Motion& m, const Coupled::Start& start, Coupled& coupled, Followed& out) {
    break_symmetries(tuft, m.from, m.to, m.planes);
    out.result = coupled.solve(tuft, m.to, m.planes, m.walls, m.dt, start);
    out.dissipation += out.result.dissipation;
    out.work += out.result.work;
    for (std::size_t i = 0; i < tuft.spines.size(); ++i) {
        const rod::Result& r = out.result.rods[i];
        tuft.spines[i].pressed = r.contact_energy;
        out.dissipation += r.dissipation;
        out.slip[i].resize(r.slip.size(), Vec3{0});
        for (std::size_t j = 0; j < r.slip.size(); ++j) out.slip[i][j] += r.slip[j];
    }
}

/// Notes how the spines stand before the last part of the motion, of `dt` seconds, which begins at `from`.
void note_start(const Tuft& tuft, const Pose& from, double dt, const Followed& passed, StepStart& start) {
    start.spines = tuft.spines;
    start.pairs.clear();
    for (const Beside& beside : tuft.beside) start.pairs.push_back(beside.memory);
    start.from = from;
    start.dt = dt;
    start.dissipation = passed.dissipation;
    start.slip = passed.slip;
}

/// Takes the spines back to before the last part of the motion. Returns where that begins.
Pose take_start(const StepStart& start, Tuft& tuft, double& dt, Followed& passed) {
    tuft.spines = start.spines;
    for (std::size_t k = 0; k < tuft.beside.size(); ++k) tuft.beside[k].memory = start.pairs[k];
    dt = start.dt;
    passed.dissipation = start.dissipation;
    passed.slip = start.slip;
    return start.from;
}

/// Moves the ferrule to `m.to` in parts that are small enough to be followed.
Followed follow_pose(Tuft& tuft, const Motion& m, Coupled& coupled, StepStart* start) {
    const Preset& p = tuft.preset;
    Followed out;
    out.slip.resize(tuft.spines.size());
    Motion last = m;
    if (start && start->known && start->in_parts) {
        last.from = take_start(*start, tuft, last.dt, out);
    } else {
        double bend = 0;
        for (const Spine& spine : tuft.spines) bend = std::max(bend, bend_of_tip(spine));
        const int parts = m.planes.empty() ? 1 : count_substeps(p, m.from, m.to, bend);
        last.dt = m.dt / parts;
        for (int k = 1; k < parts; ++k) {
            last.to = interpolate(m.from, m.to, static_cast<double>(k) / parts);
            // With all passes: a blade that lands with too little friction between its spines falls to its side.
            follow_part(tuft, last, {parts}, coupled, out);
            last.from = last.to;
        }
        last.to = m.to;
        if (start) start->in_parts = parts > 1;
        if (start && parts > 1) note_start(tuft, last.from, last.dt, out, *start);
    }
    follow_part(tuft, last, {1, start && start->known ? start : nullptr}, coupled, out);
    return out;
}

/// Solved spines: [spines].
struct Bent {
    Recycled<Recycled<Vec3>> node;  ///< [n+1] on the rounded hair
    Recycled<NodeAxes> axes;
};

/// Stores the axes of every spine in the frame of the ferrule.
Bent store_axes(Tuft& tuft, const Quat& rotation) {
    Bent out;
    const Quat back = glm::conjugate(rotation);
    for (Spine& spine : tuft.spines) {
        out.node.push_back(rod::curve_nodes(spine.rod, spine.memory.node));
        const NodeAxes& axes = out.axes.emplace_back(spine.memory);
        const std::size_t count = axes.along.size();
        spine.broad.resize(count);
        spine.across.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            spine.across[i] = back * glm::cross(axes.broad[i], axes.along[i]);
            spine.broad[i] = back * axes.broad[i];
        }
    }
    return out;
}

/// Returns the spines beside spine k.
Neighbours neighbours_of(const Tuft& tuft, std::size_t k, const Recycled<Recycled<Vec3>>& node) {
    Neighbours neighbours;
    for (const Beside& beside : tuft.beside) {
        const auto one = static_cast<std::size_t>(beside.first), two = static_cast<std::size_t>(beside.second);
        if (one != k && two != k) continue;
        const Recycled<Vec3>& other = node[one == k ? two : one];
        Neighbour& neighbour = neighbours.emplace_back();
        for (std::size_t i = 0; i < std::min(node[k].size(), other.size()); ++i) {
            neighbour.apart.push_back(tuft.preset.length * (other[i] - node[k][i]));
            neighbour.part.push_back(tuft.spines[k].rest.section[i].x / beside.distance[i]);
        }
    }
    return neighbours;
}

}  // namespace

SolvedSpines solve_spines(Tuft& tuft, const Pose& to, std::span<const ContactPlane> planes,
                          std::span<const ContactPlane> walls, double dt, StepStart* start) {
    const Preset& p = tuft.preset;
    Coupled coupled;
    auto [result, work, slip, dissipation] = follow_pose(tuft, {tuft.pose, to, planes, walls, dt}, coupled, start);
    SolvedSpines out;
    out.dissipation = dissipation;
    out.work = work;
    out.coupling_energy = result.energy;
    out.film_range = p.length * coupling_of(p, tuft.wetness).film_range * (tuft.wetness > 0 ? 1 : 0);
    const Bent bent = store_axes(tuft, to.rotation);
    std::size_t first = 0;
    for (std::size_t k = 0; k < tuft.spines.size(); ++k) {
        Spine& spine = tuft.spines[k];
        result.rods[k].slip = slip[k];
        const Neighbours neighbours = neighbours_of(tuft, k, bent.node);
        const std::size_t count = spine.rest.radius.size();
        const SpineStep step{.preset = p,
                             .clamp = spine.memory.clamp,
                             .rotation = to.rotation,
                             .walls = part_of(AllWalls(walls, tuft).beside, 2 * first, 2 * count),
                             .wetness = tuft.wetness,
                             .share = 1 / spine.rest.share};
        out.spines.push_back(finish_spine(step, spine,
                                          {.result = std::move(result.rods[k]),
                                           .node = bent.node[k],
                                           .obstacles = coupled.obstacles[k],
                                           .along = bent.axes[k].along,
                                           .broad = bent.axes[k].broad},
                                          neighbours));
        first += count;
    }
    for (std::size_t k = 0; k < tuft.beside.size(); ++k) {
        Beside& beside = tuft.beside[k];
        beside.gap = result.pairs[k].gap;
        for (double& g : beside.gap) g *= p.length;
    }
    return out;
}

}  // namespace tuft::brush
