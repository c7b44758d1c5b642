#include "footprint/stamp/walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

#include "atlas/texels/log_map.h"

namespace tuft::footprint {
namespace {

constexpr double kFacingAway = atlas::kLogMapMinCos;  // normals beyond this are never touched
constexpr float kAgree = 0.25f;                       // of a hop: neighbours that differ by more went other paths
constexpr float kUpwind = 0.2f;                       // cosine to the source of neighbours that lead on
constexpr float kNearSource = 0.5f;                   // squared distance over hop below which hops are added up
constexpr float kLeastStretch = 0.6f;                 // and its inverse: beyond, the paths to both differ
constexpr float kOverBorder = 0.3f;                   // cosine of an open border's outward direction to the source
constexpr float kDetour = 2;     // cluster radii round the picture in which paths to it are looked for
constexpr float kFold = 0.99f;   // of the straight line in space: places nearer than that are occluded over themselves
constexpr float kLater = 1.05f;  // of the squared distance expected: the cluster's turn comes later
// Paths that bend round a corner (see bent_path).
constexpr float kShortest = 0.95f;                 // of the straight line in space: a shorter path is none
constexpr float kBackward = 0.03f, kRound = 0.1f;  // of a hop: ends nearer than it began by so much
constexpr float kCorner = 0.8f;                    // of a hop, what it adds to a path that bends
constexpr float kBeside = 1.6f;                    // cluster radii: the source may lie beside the cluster itself
constexpr float kBetween = 0.8f;                   // of the distance it began at: may lead between two neighbours

constexpr float kSureCos = 0.8f, kSureNormal = 0.3f;  // clusters that surely face the stamp

constexpr std::uint32_t kMostEdges = 64;  // of a cluster that are looked at

/// Signed angle from p to q, |p||q| = `lengths`, within 5e-5 of itself below 62°; beyond, not a
/// number. By the tangent of its half and a Padé approximant: the same bits in every library.
float angle(const Vec2f& p, const Vec2f& q, float lengths) {
    const float t = (p.x * q.y - p.y * q.x) / (p.x * q.x + p.y * q.y + lengths), t2 = t * t;
    if (!(t2 < 0.36f)) return std::numeric_limits<float>::quiet_NaN();
    return 2 * t * (105 + 55 * t2) / (105 + t2 * (90 + 9 * t2));
}

/// What clusters of smooth surface hold to.
struct SmoothLimits {
    const Frame& frame;
    double most_off;
};

struct Walk {
    const atlas::ClusterGraph& graph;
    PlanScratch& scratch;
    const Reach& reach;
    std::uint32_t start;                   ///< the cluster touched
    const SmoothLimits* smooth = nullptr;  ///< the walk ends where the surface is not
    std::size_t occluded = 0;              ///< clusters that no straight path leads to

    PlanScratch::Node& node(std::uint32_t cluster) { return node_of(scratch, cluster); }

    /// `key`: squared distance from the stamp's origin.
    void push(PlanScratch::Node& n, std::uint32_t cluster, float key) {
        n.key = key;
        scratch.heap.emplace_back(key, cluster);
        std::push_heap(scratch.heap.begin(), scratch.heap.end(), std::greater<>());
    }

    /// Position of a cluster as one settled neighbour has it.
    struct Hint {
        float weight, hop2, u, v, c, s;
        float bent;  ///< length of the path where it is not straight, else 0
        const atlas::ClusterEdge* edge;
    };

    /// Positions of a cluster as its settled neighbours have it.
    struct Hints {
        std::array<Hint, 24> hint;
        std::size_t count = 0, best = 0;  ///< `best`: of the greatest weight
        bool straight = false;            ///< straight paths lead to the cluster: those that bend do not count

        std::span<const Hint> all() const { return {hint.data(), count}; }
    };

    void collect_hints(const atlas::TexelCluster& cluster, std::uint32_t index, Hints& out) const {
        const float least = least_place2(cluster);
        std::size_t n_settled = 0;
        const std::uint32_t first = graph.edge_start[index];
        const std::uint32_t end = std::min(graph.edge_start[index + 1], first + kMostEdges);
        // Listed first: which ones are settled no processor guesses.
        std::array<std::uint32_t, kMostEdges> settled;
        for (std::uint32_t k = first; k < end; ++k) {
            const PlanScratch::Node& from = scratch.nodes[graph.edges[k].to];
            settled[n_settled] = k;
            n_settled += (from.epoch == scratch.epoch) & (from.state == kFinal);
        }
        for (std::size_t i = 0; i < n_settled && out.count < out.hint.size(); ++i) {
            const atlas::ClusterEdge& e = graph.edges[settled[i]];
            const PlanScratch::Node& from = scratch.nodes[e.to];
            const float ci = from.c * e.c + from.s * e.s, si = from.s * e.c - from.c * e.s;
            const float hu = ci * e.hop_u - si * e.hop_v, hv = si * e.hop_u + ci * e.hop_v;
            const float pu = from.u - hu, pv = from.v - hv;
            const float hh = hu * hu + hv * hv, pp = pu * pu + pv * pv, hp = hu * pu + hv * pv;
            const float bent = bent_path(e.to, cluster, pp, hh, least);
            if (bent > 0 && out.straight) continue;
            if (bent == 0 && !out.straight) {
                out.straight = true;
                out.count = out.best = 0;
            }
            const float cos2 = hh * pp > 0 ? hp * hp / (hh * pp) : 1.0f;
            const float weight = ((hp < 0 ? cos2 * cos2 : 0.0f) + 1e-4f) / std::sqrt(hh + 1e-20f);
            out.hint[out.count] = {weight, hh, pu, pv, ci, si, bent, &e};
            if (weight > out.hint[out.best].weight) out.best = out.count;
            ++out.count;
        }
    }

    /// Position of a cluster: mean of the hints of its settled neighbours, those in radial direction and near by first.
    /// Behind an obstacle the paths round it on both sides lead to different positions; there the neighbour of the
    /// greatest weight and those who agree with it decide. Paths that bend round a corner count where no straight one
    /// leads. No position is nearer than the straight line in space.
    void place(const atlas::TexelCluster& cluster, std::uint32_t index, PlanScratch::Node& n) {
        Hints hints;
        collect_hints(cluster, index, hints);
        if (hints.count == 0) return;
        const float bent = hints.straight ? 0 : round_corner(hints.all(), hints.best);
        const Hint& best = hints.hint[hints.best];
        float total = 0, u = 0, v = 0, c = 0, s = 0;
        const float agree = kAgree * kAgree * best.hop2;
        for (const Hint& h : hints.all()) {
            const float du = h.u - best.u, dv = h.v - best.v;
            if (du * du + dv * dv > agree) continue;
            total += h.weight;
            u += h.weight * h.u;
            v += h.weight * h.v;
            c += h.weight * h.c;
            s += h.weight * h.s;
        }
        const float turn = std::sqrt(c * c + s * s), away = std::sqrt(u * u + v * v);
        const float straight = total * std::max(glm::length(cluster.centre - reach.origin), bent);
        const float longer = away > 0 && away < 0.999f * straight ? straight / away : 1.0f;
        occluded += bent > 0 || away < kFold * straight;
        n.u = longer * u / total;
        n.v = longer * v / total;
        if (!(turn > 0)) return;
        n.c = c / turn;
        n.s = s / turn;
        if (longer == 1) place_by_polar(hints.all(), cluster, n);
        n.lit = is_lit(hints.all(), cluster, n);
    }

    /// Squared distance below which a place is no path over the surface but a fold laid over itself:
    /// no path is shorter than the straight line in space.
    float least_place2(const atlas::TexelCluster& cluster) const {
        const Vec3f d = cluster.centre - reach.origin;
        return kShortest * kShortest * glm::dot(d, d);
    }

    /// Where all paths bend: the shortest of them and its length; 0 where neighbours on both sides of the
    /// straight path agree, so that it leads between them.
    float round_corner(std::span<const Hint> hints, std::size_t& best) const {
        for (std::size_t k = 0; k < hints.size(); ++k)
            if (hints[k].bent < hints[best].bent) best = k;
        const PlanScratch::Node& from = scratch.nodes[hints[best].edge->to];
        const float place2 = hints[best].u * hints[best].u + hints[best].v * hints[best].v;
        if (place2 < kBetween * kBetween * (from.u * from.u + from.v * from.v)) return hints[best].bent;
        const float agree = kAgree * kAgree * hints[best].hop2, x = side_of(hints[best]);
        for (const Hint& h : hints) {
            const float du = h.u - hints[best].u, dv = h.v - hints[best].v;
            if (du * du + dv * dv <= agree && side_of(h) * x < 0) return 0;
        }
        return hints[best].bent;
    }

    /// Signed: side of the straight path to its position on which the neighbour lies that gives the hint.
    float side_of(const Hint& h) const {
        const PlanScratch::Node& from = scratch.nodes[h.edge->to];
        return h.u * from.v - h.v * from.u;
    }

    /// A straight path from the source over a settled cluster to the next ends further away than the cluster
    /// lies, and no nearer than the straight line in space. Where folds unrolled over each other say
    /// otherwise, the true path bends round a corner; its length is taken to be the cluster's distance and
    /// `kCorner` of the hop. 0: the path is straight.
    float bent_path(std::uint32_t last, const atlas::TexelCluster& next, float place2, float hop2, float least2) const {
        const PlanScratch::Node& from = scratch.nodes[last];
        const float from2 = from.u * from.u + from.v * from.v;
        if (place2 >= from2 && place2 >= least2) return 0;
        // Over an opening the surface goes on as if there were none.
        if (last == start || !from.lit || next.outward != Vec3f{0}) return 0;
        const float beside = kBeside * graph.clusters[last].radius;
        if (from2 < beside * beside) return 0;
        const float place = std::sqrt(place2), far = std::sqrt(from2), hop = std::sqrt(hop2);
        const float back = place2 < least2 ? 1.0f : std::min((far - place) / hop - kBackward, kRound) / kRound;
        return back > 0 ? place + back * (far + kCorner * hop - place) : 0;
    }

    /// Returns true when straight paths lead from the source to the cluster, and no opening of the mesh lies
    /// between: its own open border does not face the source, and the neighbour next to the path is lit.
    bool is_lit(std::span<const Hint> hints, const atlas::TexelCluster& cluster, const PlanScratch::Node& n) const {
        bool lit = true;
        for (const Hint& h : hints) lit = lit && scratch.nodes[h.edge->to].lit;
        if (lit && cluster.outward == Vec3f{0}) return true;
        const float d = std::sqrt(n.u * n.u + n.v * n.v);
        const float sx = -(n.c * n.u + n.s * n.v), sy = -(n.c * n.v - n.s * n.u);
        const Vec3f b = glm::cross(cluster.normal, cluster.tangent);
        const Vec3f to_source = sx * cluster.tangent + sy * b;
        if (glm::dot(cluster.outward, to_source) > kOverBorder * d * glm::length(cluster.outward)) return false;
        const Hint* nearest = nullptr;
        float most = -2;
        for (const Hint& h : hints) {
            const float cos = (h.edge->hop_u * sx + h.edge->hop_v * sy) / (d * std::sqrt(h.hop2));
            if (!(cos > most)) continue;
            most = cos;
            nearest = &h;
        }
        return !nearest || scratch.nodes[nearest->edge->to].lit;
    }

    /// The two hints on both sides of the source that point most to it; null: none.
    struct Beside {
        const Hint *left = nullptr, *right = nullptr;
    };
    static Beside beside_source(std::span<const Hint> hints, const PlanScratch::Node& n, float d) {
        // Towards the source, in the cluster's frame.
        const float sx = -(n.c * n.u + n.s * n.v) / d, sy = -(n.c * n.v - n.s * n.u) / d;
        Beside out;
        float left_cos = kUpwind, right_cos = kUpwind;
        for (const Hint& h : hints) {
            const float du = h.u - n.u, dv = h.v - n.v;
            if (du * du + dv * dv > kAgree * kAgree * h.hop2) continue;
            const float x = h.edge->hop_u, y = h.edge->hop_v, length = std::sqrt(h.hop2);
            const float cos = (x * sx + y * sy) / length;
            const bool is_left = sx * y - sy * x > 0;
            const bool more_left = is_left & (cos > left_cos), more_right = !is_left & (cos > right_cos);
            out.left = more_left ? &h : out.left;
            left_cos = more_left ? cos : left_cos;
            out.right = more_right ? &h : out.right;
            right_cos = more_right ? cos : right_cos;
        }
        return out;
    }

    /// Computes distance and angle from two settled neighbours with the source between them (geodesic polar
    /// coordinates [Melvaer2012]): the circles of their distances meet in the unfolded source, and angles at
    /// it are in proportion to angles at the origin. Where the surface curves, adding up hops would turn the cluster by
    /// the curvature that they enclose.
    void place_by_polar(std::span<const Hint> hints, const atlas::TexelCluster& cluster, PlanScratch::Node& n) {
        const float d = std::sqrt(n.u * n.u + n.v * n.v);
        if (!(d > 0)) return;
        const auto [left, right] = beside_source(hints, n, d);
        if (!left || !right) return;
        const PlanScratch::Node &a = scratch.nodes[left->edge->to], &b = scratch.nodes[right->edge->to];
        const Vec2f pa{left->edge->hop_u, left->edge->hop_v}, pb{right->edge->hop_u, right->edge->hop_v};
        const Vec2f ab = pb - pa;
        const float da2 = a.u * a.u + a.v * a.v, db2 = b.u * b.u + b.v * b.v, l2 = glm::dot(ab, ab);
        if (!(l2 > 0) || std::min(da2, db2) < kNearSource * l2) return;
        const float x = (da2 - db2 + l2) / (2 * l2);
        const float y2 = da2 / l2 - x * x;
        if (!(y2 > 0)) return;
        // The source lies beyond the line a–b from here.
        const Vec2f across{-ab.y, ab.x};
        const float side = glm::dot(across, pa) > 0 ? 1.0f : -1.0f;
        const Vec2f source = pa + x * ab + side * std::sqrt(y2) * across;
        const Vec2f ra = pa - source, rb = pb - source;
        const float da = std::sqrt(da2), db = std::sqrt(db2), far = glm::length(source);
        const float here = angle(ra, rb, da * db);
        const float stretch = angle({a.u, a.v}, {b.u, b.v}, da * db) / here;
        if (!(stretch > kLeastStretch && stretch < 1 / kLeastStretch)) return;
        const float turned = stretch * angle(ra, -source, da * far);
        if (!(std::abs(turned) < 1)) return;
        const float x2 = turned * turned;
        const float sin = turned * (1 - x2 / 6 * (1 - x2 / 20 * (1 - x2 / 42)));
        const float cos = 1 - x2 / 2 * (1 - x2 / 12 * (1 - x2 / 30 * (1 - x2 / 56)));
        const float eu = (cos * a.u - sin * a.v) / da, ev = (sin * a.u + cos * a.v) / da;
        if (far < 0.999f * glm::length(cluster.centre - reach.origin)) return;
        n.u = far * eu;
        n.v = far * ev;
        const float ex = -source.x / far, ey = -source.y / far;
        n.c = eu * ex + ev * ey;
        n.s = ev * ex - eu * ey;
        n.stretch = stretch;
    }

    /// Returns true where a neighbour puts the cluster in the picture or on a path into it. Its final position may be
    /// a little nearer.
    bool is_near_picture(const atlas::TexelCluster& cluster, float u, float v) const {
        const float r = kDetour * cluster.radius;
        const float du = std::max({std::min(reach.lo.x, 0.0f) - u, u - std::max(reach.hi.x, 0.0f), 0.0f});
        const float dv = std::max({std::min(reach.lo.y, 0.0f) - v, v - std::max(reach.hi.y, 0.0f), 0.0f});
        const float far = reach.radius + (kClusterSlack + kAgree) * cluster.radius;
        return du * du + dv * dv <= r * r && u * u + v * v <= far * far;
    }

    /// Pushes the open neighbours of a settled cluster.
    void push_neighbours(std::uint32_t i, const PlanScratch::Node& n) {
        for (std::uint32_t k = graph.edge_start[i]; k < graph.edge_start[i + 1]; ++k) {
            const atlas::ClusterEdge& e = graph.edges[k];
            PlanScratch::Node& other = node(e.to);
            if (other.state != kOpen) continue;
            const float u = n.u + n.c * e.hop_u - n.s * e.hop_v;
            const float v = n.v + n.s * e.hop_u + n.c * e.hop_v;
            const float distance2 = u * u + v * v;
            const atlas::TexelCluster& next = graph.clusters[e.to];
            const float hop2 = e.hop_u * e.hop_u + e.hop_v * e.hop_v;
            const float bent = bent_path(i, next, distance2, hop2, least_place2(next));
            const float key2 = bent > 0 ? bent * bent : distance2;
            if (key2 < other.key && is_near_picture(next, u, v)) push(other, e.to, key2);
        }
    }

    bool is_smooth(const atlas::TexelCluster& cluster, const PlanScratch::Node& n) const {
        return n.state == kFinal && occluded == 0 && n.lit && cluster.outward == Vec3f{0} &&
               is_facing(cluster, reach.normal) && disagreement(smooth->frame, cluster, n) <= smooth->most_off;
    }

    /// Dijkstra over the clusters by distance from the stamp's origin; leaves those that the
    /// picture reaches in scratch.reached, in order of their numbers. Returns false where it ends early.
    bool run() {
        scratch.reached.clear();
        while (!scratch.heap.empty()) {
            std::pop_heap(scratch.heap.begin(), scratch.heap.end(), std::greater<>());
            const auto [key, i] = scratch.heap.back();
            scratch.heap.pop_back();
            PlanScratch::Node& n = scratch.nodes[i];
            if (n.state != kOpen || key > n.key) continue;
            const atlas::TexelCluster& cluster = graph.clusters[i];
            if (i != start) place(cluster, i, n);
            const float distance = std::sqrt(n.u * n.u + n.v * n.v);
            // Its turn comes later where the neighbours put it further away than the first of them did.
            if (distance * distance > kLater * key && i != start) {
                if (distance - kClusterSlack * cluster.radius > reach.radius)
                    n.state = kOutside;
                else
                    push(n, i, distance * distance);
                continue;
            }
            n.state = kOutside;
            if (distance - kClusterSlack * cluster.radius > reach.radius) continue;
            if (!faces_away(reach, cluster)) n.state = kFinal;
            if (smooth && !is_smooth(cluster, n)) return false;
            if (n.state != kFinal) continue;
            if (in_picture(reach, cluster, n)) scratch.reached.push_back(i);
            push_neighbours(i, n);
        }
        std::sort(scratch.reached.begin(), scratch.reached.end());
        return true;
    }
};

}  // namespace

Reach reach_of(const Footprint& footprint, const Motion& motion) {
    Reach reach;
    const double swing = std::abs(motion.turn) * footprint.radius;
    reach.origin = Vec3f(footprint.frame.origin);
    reach.normal = Vec3f(footprint.frame.n);
    reach.radius = static_cast<float>(footprint.radius + glm::length(motion.shift));
    const Vec2 hi = footprint.lo + footprint.cell * Vec2(footprint.width, footprint.height);
    reach.lo = Vec2f(footprint.lo - glm::max(motion.shift, Vec2{0}) - swing);
    reach.hi = Vec2f(hi - glm::min(motion.shift, Vec2{0}) + swing);
    return reach;
}

std::uint32_t cluster_of(const atlas::TexelMap& texels, const atlas::TexelRef& texel) {
    return texels.cluster_start[texel.slot] + texels.tiles[texel.slot].cluster[texel.texel];
}

Start start_of(const Surface& surface, const Footprint& footprint, const atlas::TexelRef& contact) {
    Start start;
    start.triangle = footprint.triangle;
    start.cluster = cluster_of(surface.texels, contact);
    const atlas::TexelCluster& cluster = surface.clusters.clusters[start.cluster];
    Frame& frame = start.frame;
    frame = footprint.frame;
    frame.n = glm::normalize(Vec3(surface.texels.normal(contact.slot, contact.texel)));
    frame.t = parallel_transport(footprint.frame.t, footprint.frame.n, frame.n);
    frame.b = glm::cross(frame.n, frame.t);
    start.place = Vec2f(atlas::log_map(frame, Vec3(cluster.centre), Vec3(cluster.normal)));
    start.turn = Vec2f(atlas::transport_direction(frame, Vec3(cluster.tangent), Vec3(cluster.normal)));
    return start;
}

PlanScratch::Node& node_of(PlanScratch& scratch, std::uint32_t cluster) {
    PlanScratch::Node& n = scratch.nodes[cluster];
    if (n.epoch != scratch.epoch) {
        n = {};
        n.epoch = scratch.epoch;
        n.key = std::numeric_limits<float>::infinity();
    }
    return n;
}

double disagreement(const Frame& frame, const atlas::TexelCluster& cluster, const PlanScratch::Node& n) {
    if (glm::dot(Vec3(cluster.normal), frame.n) <= atlas::kLogMapMinCos) return std::numeric_limits<double>::infinity();
    return glm::length(atlas::log_map(frame, Vec3(cluster.centre), Vec3(cluster.normal)) - Vec2(n.u, n.v));
}

bool is_facing(const atlas::TexelCluster& cluster, const Vec3f& normal) {
    return cluster.cone_cos > kSureCos && glm::dot(cluster.normal, normal) > kSureNormal;
}

bool faces_away(const Reach& reach, const atlas::TexelCluster& cluster) {
    const float c = glm::dot(cluster.normal, reach.normal);
    if (c > kFacingAway) return false;
    return std::acos(std::max(c, -1.0f)) - std::acos(std::min(cluster.cone_cos, 1.0f)) >
           std::acos(static_cast<float>(kFacingAway));
}

bool in_picture(const Reach& reach, const atlas::TexelCluster& cluster, const PlanScratch::Node& n) {
    const float r = kClusterSlack * cluster.radius;
    const float du = std::max({reach.lo.x - n.u, n.u - reach.hi.x, 0.0f});
    const float dv = std::max({reach.lo.y - n.v, n.v - reach.hi.y, 0.0f});
    return du * du + dv * dv <= r * r;
}

void begin_walk(PlanScratch& scratch, std::size_t n_clusters) {
    if (scratch.epoch == kNone) {
        scratch.nodes.clear();
        scratch.epoch = 0;
    }
    if (scratch.nodes.size() < n_clusters) scratch.nodes.resize(n_clusters);
    ++scratch.epoch;
    scratch.heap.clear();
}

PlanScratch::Node& place_start(PlanScratch& scratch, const Start& start) {
    PlanScratch::Node& n = node_of(scratch, start.cluster);
    n.u = start.place.x;
    n.v = start.place.y;
    n.c = start.turn.x;
    n.s = start.turn.y;
    return n;
}

std::size_t walk_clusters(const atlas::ClusterGraph& graph, const Reach& reach, const Start& start,
                          PlanScratch& scratch) {
    begin_walk(scratch, graph.n_clusters());
    Walk walk{graph, scratch, reach, start.cluster};
    walk.push(place_start(scratch, start), start.cluster, 0);
    walk.run();
    return walk.occluded;
}

bool walk_smooth(const atlas::ClusterGraph& graph, const Reach& reach, const Start& start, const Frame& frame,
                 double most_off, PlanScratch& scratch) {
    begin_walk(scratch, graph.n_clusters());
    const SmoothLimits limits{frame, most_off};
    Walk walk{graph, scratch, reach, start.cluster, &limits};
    walk.push(place_start(scratch, start), start.cluster, 0);
    return walk.run();
}

}  // namespace tuft::footprint
