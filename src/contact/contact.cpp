#include "contact/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "contact/columns.h"
#include "contact/node_contact.h"
#include "contact/obb.h"
#include "contact/planes_at_rest.h"
#include "core/ease.h"

namespace tuft::contact {
namespace {

using brush::ContactPlane;

/// What the parts of one step share.
struct Step {
    const mesh::SurfaceQuery& surface;
    brush::Pose pose;  // as given, or moved off the surface
    const Options& options;
    NodeContactOptions search;
    double radius = 0;        // of the tuft, metres
    double pad = 0;           // metres of hair or foam, pressed flat under the ferrule
    double near = 0;          // metres: farther than this nothing of the tuft can touch
    NodeContact root;         // of the ferrule's mouth
    Recycled<Vec3> nodes;     // predicted, at `pose`
    bool foam = false;        // a sponge
    bool tip_jumped = false;  // the tip went so far that its hair did not slide there
};

NodeContact find_root_contact(const Step& w, const Memory& memory, double length) {
    const Vec3& root = w.pose.position;
    // A hand that touched has not left the object's front within a tuft's length.
    const bool known = memory.touching && glm::length(root - memory.root) < 2 * length;
    const Vec3 from = known ? memory.outside : find_outside_point(w.surface, root, -w.pose.axis(), w.search);
    return find_node_contact(w.surface, {root, from, known ? memory.side : 1}, w.search);
}

/// Moves the ferrule's mouth off the surface that it would go through, by `mouth_clearance`. Returns how far it would
/// be below the surface, metres.
double move_off_surface(Step& w) {
    constexpr int kPasses = 4;
    const double inside = std::max(0.0, -w.root.height);
    for (int pass = 0; pass < kPasses && w.root.triangle != kNone; ++pass) {
        const Vec3& n = w.root.plane.normal;
        const double needed = mouth_clearance(n, w.pose.axis(), w.pad) - w.root.height;
        if (needed <= w.search.lift) break;
        w.pose.position += needed * n;
        w.root = find_node_contact(w.surface, {w.pose.position, w.root.outside, w.root.side}, w.search);
    }
    return inside;
}

Recycled<Vec3> section_centres(const brush::Branch& branch) {
    Recycled<Vec3> out;
    for (const brush::Section& s : branch.sections) out.push_back(s.centre);
    return out;
}

/// Contacts of the tuft's nodes, tip first, spine after spine, each from the ferrule; sub-spines, which follow in the
/// list, start from the trunk. `known`: of all spines.
Recycled<NodeContact> find_tuft_contacts(const Step& w, const brush::TuftBend& tuft, std::span<const Vec3> nodes,
                                         const KnownContacts& known = {}) {
    if (w.foam) return find_column_contacts(w.surface, w.pose, w.root, nodes, w.search);
    Recycled<NodeContact> out;
    for (const brush::Spine& spine : tuft.spines) {
        const std::size_t first = out.size(), count = spine.rest.radius.size();
        const auto part = [&](auto all) {
            return all.size() >= first + count ? all.subspan(first, count) : decltype(all){};
        };
        const Recycled<NodeContact> own =
            find_chain_contacts(w.surface, w.root, nodes.subspan(first, count), w.near, w.search,
                                {part(known.contacts), part(known.nodes), known.still});
        out.insert(out.end(), own.begin(), own.end());
    }
    if (nodes.size() == out.size()) return out;
    const std::size_t trunk = out.size();
    const std::size_t sub_spine = (nodes.size() - trunk) / 3;
    for (std::size_t first = trunk; first < nodes.size(); first += sub_spine) {
        const auto points = nodes.subspan(first, sub_spine);
        const NodeContact& start = out[std::min(sub_spine, trunk) - 1];  // the trunk's node they leave from
        const Recycled<NodeContact> more = find_chain_contacts(w.surface, start, points, w.near, w.search);
        out.insert(out.end(), more.begin(), more.end());
    }
    return out;
}

/// Radii at rest of the nodes of all spines, in their order, metres.
Recycled<double> node_radii(const brush::Tuft& tuft) {
    Recycled<double> out;
    for (const brush::Spine& spine : tuft.spines)
        out.insert(out.end(), spine.rest.radius.rbegin(), spine.rest.radius.rend());
    return out;
}

/// Nodes of each spine.
Recycled<std::size_t> spine_lengths(const brush::Tuft& tuft) {
    Recycled<std::size_t> out;
    for (const brush::Spine& spine : tuft.spines) out.push_back(spine.rest.radius.size());
    return out;
}

/// Walls that the side nodes of the spines meet: a ray from the spine to a little beyond each, where
/// the spine is near a surface. Empty where there is none.
Recycled<ContactPlane> find_side_walls(const Step& w, const brush::Tuft& tuft, std::span<const NodeContact> contacts) {
    constexpr double kBeyond = 1e-3;  // metres a side may grow in one step
    const Recycled<Vec3> sides = brush::predicted_sides(tuft, w.pose);
    const Recycled<double> radii = node_radii(tuft);
    Recycled<ContactPlane> walls;
    if (sides.size() != 2 * radii.size() || contacts.size() < radii.size()) return walls;
    for (std::size_t k = 0; k < sides.size(); ++k) {
        const NodeContact& node = contacts[k / 2];
        const double radius = radii[k / 2];
        if (node.triangle == kNone || node.height > 1.5 * radius) continue;
        const Vec3 path = sides[k] - node.outside;
        const double reach = glm::length(path);
        if (reach < 1e-9) continue;
        const auto hit = w.surface.ray(node.outside, path / reach, 0, reach + kBeyond);
        if (!hit || std::abs(glm::dot(hit->face_normal, node.plane.normal)) > 0.9) continue;
        if (walls.empty()) {
            // Away from any side: no wall.
            walls.assign(sides.size(), {node.plane.origin, Vec3{0}});
        }
        const double front = glm::dot(hit->face_normal, path) < 0 ? 1 : -1;
        walls[k] = {hit->position, front * hit->face_normal};
    }
    return walls;
}

bool any_in_groove(std::span<const NodeWalls> walls) {
    return std::any_of(walls.begin(), walls.end(), [](const NodeWalls& n) { return n.in_groove(); });
}

/// Planes and walls as `brush::step` takes them.
struct StepPlanes {
    Recycled<ContactPlane> planes, walls;

    StepPlanes(std::span<const NodeWalls> nodes, std::size_t in_spines, const Recycled<ContactPlane>& beside)
        : walls(beside) {
        for (const NodeWalls& n : nodes) planes.push_back(n.own.wedge);
        if (!any_in_groove(nodes)) return;
        const ContactPlane none{.normal = Vec3{0}};
        if (walls.empty()) walls.assign(2 * in_spines, none);
        for (const NodeWalls& n : nodes.first(in_spines)) walls.push_back(n.in_groove() ? n.across.wedge : none);
    }
};

constexpr double kStill = 0.1;        // of the error that planes may have: nodes that move less are at rest
constexpr int kMostRestSearches = 3;  // between two faces the planes of one rest lead to the other, and back

bool are_still(std::span<const Vec3> before, std::span<const Vec3> now, const Options& options) {
    if (before.size() != now.size()) return false;
    for (std::size_t i = 0; i < now.size(); ++i)
        if (glm::distance(before[i], now[i]) > kStill * options.refresh_error) return false;
    return true;
}

/// A tuft that was bent against planes.
struct Bent {
    brush::TuftState state;
    Recycled<ContactPlane> planes;   // of the last solve
    Recycled<Vec3> nodes;            // where they lie now, as `brush::predicted_nodes`
    Recycled<NodeContact> contacts;  // of the spines' nodes where they lie now, or none
};

/// Steps a tuft whose nodes are where they came to rest, on the planes of that rest. Returns nothing, and leaves the
/// tuft as it was, where they do not stay there.
std::optional<Bent> step_at_rest(const Step& w, brush::Tuft& tuft, double dt, const Memory& memory) {
    thread_local brush::TuftBend before;  // keeps its memory
    before = tuft;
    Bent bent{.state = brush::step(tuft, w.pose, memory.rest.planes, dt, memory.rest.walls)};
    bent.nodes = brush::predicted_nodes(tuft, w.pose);
    if (!bent.state.converged || !are_still(memory.rest.nodes, bent.nodes, w.options)) {
        static_cast<brush::TuftBend&>(tuft) = before;
        return {};
    }
    KnownContacts known{.contacts = memory.contacts};
    if (memory.rest.verified) known.nodes = memory.rest.nodes, known.still = kStill * w.options.refresh_error;
    bent.planes = memory.rest.planes;
    bent.contacts = find_tuft_contacts(w, before, bent.nodes, known);
    bent.contacts.resize(memory.contacts.size());
    return bent;
}

/// A tuft bent against the walls that its nodes were given.
struct Attempt {
    Recycled<NodeWalls> walls;
    StepPlanes planes;
    brush::TuftState state;
    Recycled<Vec3> nodes;  // where they lie then
};

/// What the attempts of one step have in common.
struct RestSearch {
    const Step& w;
    double dt;
    Recycled<double> radii;  // of the spines' nodes
    Recycled<std::size_t> lengths;
    Recycled<ContactPlane> beside;  // walls of the sides

    NodeRadii node_radius(const brush::Tuft& tuft) const { return {radii, radii[tuft.trunk().rest.radius.size() - 1]}; }
};

Attempt bend_against(Recycled<NodeWalls> walls, const RestSearch& in, brush::Tuft& tuft, brush::StepStart& start) {
    StepPlanes planes(walls, in.radii.size(), in.beside);
    brush::TuftState state = brush::step(tuft, in.w.pose, planes.planes, in.dt, planes.walls, &start);
    return {std::move(walls), std::move(planes), std::move(state), brush::predicted_nodes(tuft, in.w.pose)};
}

/// Bends the tuft against the walls that were predicted, looks where its nodes came to rest, and bends it again where
/// the walls were off. `verified` becomes the contacts of the spines' nodes there, if the walls agree with them.
Attempt find_rest(Recycled<NodeWalls> walls, const Recycled<NodeContact>& predicted, const RestSearch& in,
                  brush::Tuft& tuft, Recycled<NodeContact>& verified) {
    thread_local brush::TuftBend before, solved;  // keep their memory
    thread_local brush::StepStart start;
    const Step& w = in.w;
    const NodeRadii node_radius = in.node_radius(tuft);
    const bool was_split = tuft.split;
    before = tuft;
    start.known = start.in_parts = false;
    Attempt last = bend_against(std::move(walls), in, tuft, start);
    for (int pass = 0; pass < w.options.max_refreshes && last.state.touching; ++pass) {
        if (tuft.split != was_split && last.nodes.size() < w.nodes.size()) break;
        const auto compared = std::span(last.nodes).first(w.nodes.size());
        Recycled<NodeContact> found =
            find_tuft_contacts(w, before, compared, {predicted, w.nodes, 0.5 * w.options.refresh_error});
        const NodesAtRest rest{compared, found, node_radius, in.lengths};
        const PlaneErrors errors = find_plane_errors(last.walls, rest);
        if (errors.worst < w.options.refresh_error) {
            verified = std::move(found);
            verified.resize(in.radii.size());
            break;
        }
        Recycled<NodeWalls> renewed = last.walls;
        renew_walls(renewed, last.walls, errors.near, rest);
        std::swap(static_cast<brush::TuftBend&>(tuft), solved);
        static_cast<brush::TuftBend&>(tuft) = before;
        Attempt next = bend_against(std::move(renewed), in, tuft, start);
        next.state.work += last.state.work;
        // Between two faces of a rim the planes at the new places may leave no rest: the solve ends anywhere, with a
        // force of many newtons. The planes before are off by less than a tuft moves in a sample.
        if (!next.state.converged && last.state.converged) {
            last.state.work = next.state.work;
            std::swap(static_cast<brush::TuftBend&>(tuft), solved);
            break;
        }
        last = std::move(next);
    }
    return last;
}

/// Bends the tuft to where its nodes rest on the surface, and stores that rest for the next sample.
Bent solve(const Step& w, brush::Tuft& tuft, double dt, Memory& memory) {
    Rest& rest = memory.rest;
    const bool still = are_still(rest.nodes, w.nodes, w.options);
    if (still && (rest.verified || rest.searches >= kMostRestSearches)) {
        if (auto bent = step_at_rest(w, tuft, dt, memory)) return std::move(*bent);
    }
    RestSearch in{w, dt, node_radii(tuft), spine_lengths(tuft), {}};
    Recycled<NodeContact> predicted = find_tuft_contacts(w, tuft, w.nodes, {.contacts = memory.contacts});
    in.beside = find_side_walls(w, tuft, predicted);
    Recycled<NodeWalls> walls =
        find_chain_walls(w.surface, {in.lengths, w.nodes, predicted, in.radii, memory.walls}, w.search);
    rest.nodes.clear();
    rest.searches = still ? rest.searches + 1 : 1;

    Bent out;
    Attempt last = find_rest(std::move(walls), predicted, in, tuft, out.contacts);
    rest.verified = !out.contacts.empty();
    if (last.state.converged) {
        rest.planes = last.planes.planes;
        rest.walls = last.planes.walls;
        rest.nodes = last.nodes;
    }
    memory.walls.clear();
    if (any_in_groove(last.walls))
        memory.walls.assign(last.walls.begin(), last.walls.begin() + static_cast<long>(in.radii.size()));
    if (!rest.verified) predicted.resize(in.radii.size());
    memory.contacts = rest.verified ? out.contacts : std::move(predicted);
    out.planes = std::move(last.planes.planes);
    out.state = std::move(last.state);
    out.nodes = std::move(last.nodes);
    return out;
}

/// One plane for all nodes: the tip snapped to the weighted mean of the nearest vertices.
Bent solve_by_vertices(const Step& w, brush::Tuft& tuft, double dt, Sphere& sphere) {
    Bent out;
    const Vec3 tip = w.nodes.front();
    const Vec3 holder = w.pose.position - tuft.preset.length * w.pose.axis();
    const WeightedDistance d = weighted_distance(w.surface, tip, holder, w.options.nearest_vertices);
    if (d.found) out.planes.assign(1, {snap_tip(tip, d), d.normal});
    out.state = brush::step(tuft, w.pose, out.planes, dt);
    out.nodes = brush::predicted_nodes(tuft, w.pose);
    if (d.found) sphere = expand_ball(outline_points(out.state));
    return out;
}

/// Contacts of every section of every branch of the solved tuft. Of a whole tuft these are the contacts of the rod's
/// nodes, from which the sections' centres differ along the planes' normals, and along the surface by what friction
/// drags the sides. `solved`, of which `trunk` holds these contacts if they are known, lies at `nodes`.
Recycled<Recycled<NodeContact>> find_section_contacts(const Step& w, const brush::Tuft& solved,
                                                      const brush::TuftState& tuft, std::span<const Vec3> nodes,
                                                      Recycled<NodeContact> trunk) {
    Recycled<Recycled<NodeContact>> out;
    if (tuft.branches.size() == 1) {
        const std::size_t count = tuft.branches[0].sections.size();
        if (trunk.size() != count && nodes.size() >= count)
            trunk = w.foam ? find_column_contacts(w.surface, w.pose, w.root, nodes.first(count), w.search)
                           : find_chain_contacts(w.surface, w.root, nodes.first(count), w.near, w.search);
        out.push_back(std::move(trunk));
        return out;
    }
    if (tuft.wide) {
        if (trunk.size() != nodes.size()) trunk = find_tuft_contacts(w, solved, nodes);
        for (std::size_t b = 0, first = 0; b < tuft.branches.size(); ++b) {
            const auto begin = trunk.begin() + static_cast<long>(first);
            const std::size_t count = tuft.branches[b].sections.size();
            out.emplace_back(begin, begin + static_cast<long>(count));
            first += count;
        }
        return out;
    }
    // The branch that reaches the ferrule first; the others start where it is nearest.
    Recycled<std::size_t> order;
    for (std::size_t b = 0; b < tuft.branches.size(); ++b) order.push_back(b);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return tuft.branches[a].sections.size() > tuft.branches[b].sections.size();
    });
    out.resize(tuft.branches.size());
    for (const std::size_t b : order) {
        const Recycled<Vec3> points = section_centres(tuft.branches[b]);
        NodeContact start = w.root;
        if (b != order.front() && !points.empty()) {
            const Recycled<NodeContact>& first = out[order.front()];
            const std::size_t at = std::min(points.size(), first.size());
            if (at > 0) start = first[at - 1];
        }
        out[b] = find_chain_contacts(w.surface, start, points, w.near, w.search);
    }
    return out;
}

/// Metres between the surface and a tuft that hangs free, sections taken for balls.
double surface_distance(const Step& w, const brush::TuftState& tuft) {
    double best = std::numeric_limits<double>::infinity();
    for (const brush::Branch& branch : tuft.branches)
        for (const brush::Section& s : branch.sections) {
            const double r = std::sqrt(s.a * s.b);
            if (const auto q = w.surface.closest_point(s.centre, best + r)) best = std::min(best, q->distance - r);
        }
    return std::max(best, 0.0);
}

/// A place that goes with the hair from `last` and drifts to the middle of the contact over half a radius of travel, so
/// that it does not jump when sections come and go.
Vec3 follow_middle(const Step& w, const Memory& memory, const Vec3& last, const Vec3& travel, const Vec3& middle) {
    if (!memory.touching) return middle;
    const Vec3 moved_on = last + travel;
    const double moved = std::max(glm::length(travel), glm::length(w.pose.position - memory.root));
    if (glm::length(middle - moved_on) > 4 * w.radius) return middle;
    return moved_on + (1 - std::exp(-moved / (0.5 * w.radius))) * (middle - moved_on);
}

/// Sums over the touching sections, weighted by how deep they reach into the surface.
struct ContactSums {
    Vec3 origin{0}, travel{0};              // metres, not divided by `weight`
    Vec3 normal{0};                         // of the planes, not divided by `weight`
    double weight = 0;                      // m²
    double gap = 0;                         // metres between the surface and the section nearest to it
    const NodeContact* heaviest = nullptr;  // of the section of the greatest weight
    const NodeContact* lowest = nullptr;    // of the section nearest to the surface; null: none within reach
};

/// `centres`: of all sections now; `before`: at the last sample, or empty.
ContactSums sum_sections(const Recycled<Recycled<NodeContact>>& contacts, const brush::TuftState& tuft,
                         std::span<const Vec3> centres, std::span<const Vec3> before) {
    ContactSums out;
    out.gap = std::numeric_limits<double>::infinity();
    std::size_t at_centre = 0;
    double most = 0;
    for (std::size_t b = 0; b < contacts.size(); ++b) {
        const Recycled<brush::Section>& sections = tuft.branches[b].sections;
        for (std::size_t i = 0; i < sections.size(); ++i) {
            const NodeContact& node = contacts[b][i];
            const std::size_t k = at_centre++;
            if (node.triangle == kNone) continue;
            const double under = node.height - std::sqrt(sections[i].a * sections[i].b);  // as the rod's contacts
            if (under < out.gap) {
                out.gap = under;
                out.lowest = &node;
            }
            const std::size_t next = i + 1 < sections.size() ? i + 1 : i, prev = i > 0 ? i - 1 : 0;
            const double share = 0.5 * glm::length(sections[next].centre - sections[prev].centre);
            const double weight = std::max(0.0, 1e-5 - under) * share;
            out.origin += weight * node.plane.origin;
            out.normal += weight * node.plane.normal;
            if (!before.empty()) out.travel += weight * (centres[k] - before[k]);
            out.weight += weight;
            if (weight > most) {
                most = weight;
                out.heaviest = &node;
            }
        }
    }
    return out;
}

/// The part of `v` along a plane with the normal n, of any length.
Vec3 along_plane(const Vec3& v, const Vec3& n) {
    const double size2 = glm::dot(n, n);
    return size2 > 0 ? v - (glm::dot(v, n) / size2) * n : v;
}

/// The surface under the middle of the touching hair: where the hair goes on from the last frame, which lies on the
/// surface. Over a gap that place comes back to the lip at every step that is shorter than half of the gap, and the ink
/// with it, while the hair goes on: there it is where the hair went, not moved onto the surface meanwhile.
NodeContact find_middle(const Step& w, Memory& memory, const Vec3& travel, const ContactSums& sums) {
    constexpr double kBehind = 0.05;  // of the radius, along the surface; off it both differ over any curved one
    const Vec3 middle = sums.origin / sums.weight;
    const auto under = [&](const Vec3& p) {
        return find_node_contact(w.surface, {p, sums.heaviest->outside, sums.heaviest->side}, w.search);
    };
    const Vec3 on = follow_middle(w, memory, memory.origin, travel, middle);
    memory.centre = follow_middle(w, memory, memory.centre, travel, middle);
    if (glm::length(along_plane(memory.centre - on, sums.normal)) > kBehind * w.radius) {
        const NodeContact lip = under(memory.centre);
        const Vec3 off = memory.centre - lip.plane.origin, aside = along_plane(off, sums.normal);
        // In a gutter the middle is above the walls.
        const bool above = glm::dot(off, sums.normal) > glm::length(aside) * glm::length(sums.normal);
        if (lip.triangle != kNone && !above) return lip;
    }
    return under(on);
}

/// Finds the contact frame under the middle of the touching sections, and the distance to touch. The weights of the
/// sections let it move continuously.
void find_frame(const Step& w, const Recycled<Recycled<NodeContact>>& contacts, Memory& memory, Result& result) {
    Recycled<Vec3> centres;
    for (const brush::Branch& branch : result.tuft.branches)
        for (const brush::Section& s : branch.sections) centres.push_back(s.centre);
    const bool followed = memory.touching && memory.centres.size() == centres.size() && !w.tip_jumped;
    const ContactSums sums = sum_sections(contacts, result.tuft, centres,
                                          followed ? std::span<const Vec3>(memory.centres) : std::span<const Vec3>{});
    if (memory.touching && sums.weight > 0)
        result.travel = followed ? sums.travel / sums.weight : w.pose.position - memory.root;
    memory.centres = std::move(centres);
    if (!sums.lowest) return;
    result.distance = result.tuft.touching ? 0 : std::max(0.0, sums.gap);
    if (sums.gap > w.options.tolerance) result.distance = surface_distance(w, result.tuft);
    NodeContact at = *sums.lowest;
    if (sums.weight > 0) {
        const NodeContact middle = find_middle(w, memory, result.travel, sums);
        if (middle.triangle != kNone) at = middle;
    }
    result.triangle = at.triangle;
    // Along the ferrule, not along an axis of space: the footprint's picture turns with the hand.
    if (!memory.touching) memory.heading = w.pose.rotation * Vec3{1, 0, 0};
    result.frame = make_frame(at.plane.origin, at.plane.normal, memory.heading);
    memory.heading = result.frame.t;
    memory.origin = result.frame.origin;
    if (!(sums.weight > 0)) memory.centre = memory.origin;
}

Vec3 device_force(const brush::Preset& preset, const Result& result, const Options& options) {
    Vec3 force = brush::device_force(preset, result.tuft);
    if (result.triangle != kNone && options.tolerance > 0) {
        const double ramp = std::clamp((1 - result.distance / options.tolerance) / 0.1, 0.0, 1.0);
        force += ramp * options.proximity_force * result.frame.n;
    }
    const double size = glm::length(force);
    return size > preset.force_limit ? force * (preset.force_limit / size) : force;
}

/// Arguments of `step`, and whether `lower_tuft` calls it.
struct StepInput {
    const brush::Pose& pose;
    double dt = 0;  // s
    const Options& options;
    bool lowers = false;
};

Result take_step(brush::Tuft& tuft, const mesh::SurfaceQuery& surface, Memory& memory, const StepInput& input);

/// Presses a tuft that has not touched yet down to a pose: straight hair that begins pressed flat has no shape near
/// enough to start the solve from.
void lower_tuft(brush::Tuft& tuft, const Step& w, Memory& memory) {
    constexpr int kSteps = 16;
    for (int i = 0; i < kSteps; ++i) {
        brush::Pose lifted = w.pose;
        lifted.position += (1 - static_cast<double>(i) / kSteps) * tuft.preset.length * w.root.plane.normal;
        take_step(tuft, w.surface, memory, {lifted, 0, w.options, true});
    }
    memory.touching = false;  // the next pose is the first
}

/// Bends a tuft that no surface is near.
void step_in_air(brush::Tuft& tuft, const Step& w, const StepInput& input, Result& result) {
    result.tuft = brush::step(tuft, w.pose, {}, input.dt);
    result.inside = std::max(result.inside, depth_inside(w.surface, input.pose.position));
    const auto nearest = w.surface.closest_point(w.nodes.front());
    result.distance = nearest ? nearest->distance : std::numeric_limits<double>::infinity();
}

/// Bends the tuft on the surface and finds frame, planes and travel.
void step_on_surface(brush::Tuft& tuft, Step& w, double dt, Memory& memory, Result& result) {
    const brush::Preset& preset = tuft.preset;
    Bent bent =
        w.options.method == Method::exact ? solve(w, tuft, dt, memory) : solve_by_vertices(w, tuft, dt, result.sphere);
    result.tuft = std::move(bent.state);
    result.planes = std::move(bent.planes);
    const Recycled<Recycled<NodeContact>> contacts =
        find_section_contacts(w, tuft, result.tuft, bent.nodes, std::move(bent.contacts));
    for (const Recycled<NodeContact>& branch : contacts) {
        result.branch_planes.emplace_back();
        for (const NodeContact& c : branch) result.branch_planes.back().push_back(c.plane);
    }
    constexpr double kJump = 0.2;  // of the length, in one sample and beside the hand's own motion
    w.tip_jumped = glm::distance(w.nodes.front(), bent.nodes.front()) > kJump * preset.length;
    find_frame(w, contacts, memory, result);
    if (w.options.method == Method::vertices && result.triangle != kNone && result.tuft.touching) {
        const Vec3 holder = w.pose.position - preset.length * w.pose.axis();
        result.patch = effective_patch(w.surface.mesh(), result.triangle, result.sphere, holder);
        result.frame = make_frame(result.frame.origin, result.patch.normal, memory.heading);
        memory.heading = result.frame.t;
    }
}

Result take_step(brush::Tuft& tuft, const mesh::SurfaceQuery& surface, Memory& memory, const StepInput& input) {
    Result result;
    const brush::Preset& preset = tuft.preset;
    const Options& options = input.options;
    Recycled<Vec3> nodes = brush::predicted_nodes(tuft, input.pose);
    // A wide ferrule reaches half its width to the sides; its nodes lie within that of each other's.
    const double thick = 1.2 * preset.radius * std::max(1.0, preset.flatten_max) +
                         0.5 * preset.width / static_cast<double>(std::max<std::size_t>(1, tuft.spines.size()));
    const bool near = overlap(obb_of(nodes, thick + options.tolerance), obb_of(surface.mesh().bounds));

    Step w{surface, input.pose, options, {}, preset.radius, ferrule_pad(preset), 0, {}, std::move(nodes)};
    w.foam = brush::is_foam(preset);
    w.search.smooth = &memory.smooth;
    w.search.reach = 2 * preset.length + thick + preset.width;
    w.near = 1.2 * preset.radius + options.tolerance + 1e-3;
    if (near) {
        w.root = find_root_contact(w, memory, preset.length);
        result.inside = move_off_surface(w);
        const bool lowers = result.inside > 0 && !memory.touching && !input.lowers;
        if (lowers) lower_tuft(tuft, w, memory);
        if (lowers || w.pose.position != input.pose.position) w.nodes = brush::predicted_nodes(tuft, w.pose);
        if (w.foam) move_to_columns(w.surface, w.pose, w.root, preset.length, w.nodes);
    }
    const bool reachable =
        near && w.root.triangle != kNone && w.root.height < preset.length + w.near + 0.5 * preset.width;
    if (!reachable) {
        step_in_air(tuft, w, input, result);
        memory.touching = false;
        memory.rest = {};
        memory.contacts.clear();
        memory.walls.clear();
    } else {
        step_on_surface(tuft, w, input.dt, memory, result);
        memory.touching = result.tuft.touching;
        memory.root = input.pose.position;
        memory.outside = w.root.outside;
        memory.side = w.root.side;
    }
    result.device_force = device_force(preset, result, options);
    return result;
}

}  // namespace

double ferrule_pad(const brush::Preset& preset) {
    return brush::is_foam(preset) ? 0.04 * preset.length : 0.5 * preset.radius;
}

double mouth_clearance(const Vec3& n, const Vec3& axis, double pad) {
    constexpr double kBeside = 0.2, kBefore = 0.5;  // cosines of the normal to the handle
    return pad * smooth_step((-glm::dot(n, axis) - kBeside) / (kBefore - kBeside));
}

Result step(brush::Tuft& tuft, const brush::Pose& pose, const mesh::SurfaceQuery& surface, Memory& memory, double dt,
            const Options& options) {
    return take_step(tuft, surface, memory, {pose, dt, options});
}

}  // namespace tuft::contact
