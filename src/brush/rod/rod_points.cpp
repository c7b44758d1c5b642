#include "brush/rod/rod_points.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/ease.h"

namespace tuft::brush::rod {

namespace {

struct PointBuilder {
    const Rod& rod;
    const Law& law;
    std::span<const Obstacle> obstacles;
    const Recycled<Vec3>& node;
    ContactPoints& points;
    Recycled<Obstacle>& fine;

    int n() const { return rod.segments(); }

    /// Without the edge where x lies so far from it over one face that it feels only that one.
    Obstacle within_reach(const Obstacle& o, const Vec3& x) const {
        if (!o.at_edge()) return o;
        const double own = glm::dot(x - o.origin, o.normal), beyond = glm::dot(x - o.beyond_origin, o.beyond_normal);
        constexpr double kRoundings = 3;  // more than hair goes in one solve beside the edge's own rounding
        if (std::min(own, beyond) > -kRoundings * law.edge) return o;
        return own >= beyond ? Obstacle{o.origin, o.normal, o.radius}
                             : Obstacle{o.beyond_origin, o.beyond_normal, o.radius};
    }

    /// The two planes of a point over a crease: those of an edge near the nodes beside it, or of
    /// the nodes themselves.
    void compute_crease(std::size_t p, const PointPlace& at, const Obstacle& from, const Obstacle& to) {
        const bool inner = at.s > 0 && at.s < 1;
        const bool near_first = at.s < 1 && from.at_edge(), near_last = at.s > 0 && to.at_edge();
        if (near_first || near_last) {
            const bool both = near_first && near_last;
            const Obstacle &edge = near_first ? from : to, &other = near_first ? to : from;
            const double part = !inner ? 0 : near_first ? at.s : 1 - at.s;
            if (compute_edge(p, edge, other, both, part)) return;
            // The other node is nearer, and on a third face.
            if (both)
                compute_edge(p, other, edge, false, 0);
            else
                std::tie(fine[p].origin, fine[p].normal) = std::tie(other.origin, other.normal);
            return;
        }
        compute_parted(p, at, from, to);
    }

    /// The planes of the edge near node `a`, those that node `b` has too interpolated towards
    /// it by `part`; false when b's plane is neither of them and b nearer.
    bool compute_edge(std::size_t p, const Obstacle& a, const Obstacle& b, bool both, double part) {
        Wedge w{{a.origin, a.beyond_origin}, {a.normal, a.beyond_normal}};
        const double straight = glm::dot(b.normal, w.normal[0]), turned = glm::dot(b.normal, w.normal[1]);
        constexpr double kSame = 0.9;  // cos 26°
        if (std::max(straight, turned) < kSame) {
            if (part > 0.5) return false;
            part = 0;
        }
        const auto towards = [&](int i, const Vec3& other_origin, const Vec3& other_normal) {
            if (part == 0 || glm::dot(w.normal[i], other_normal) < kSame) return;
            w.origin[i] += part * (other_origin - w.origin[i]);
            w.normal[i] = glm::normalize(w.normal[i] + part * (other_normal - w.normal[i]));
        };
        const int first = straight >= turned ? 0 : 1;
        towards(first, b.origin, b.normal);
        if (both) towards(1 - first, b.beyond_origin, b.beyond_normal);
        points.crease[p] = {1, true, round_edge(w, law.edge)};
        return true;
    }

    /// A node's plane, or the one beyond the edge near it where that is more like n: which of the
    /// two is its own may change from step to step where it hangs over the edge.
    static Obstacle facing(const Obstacle& o, const Vec3& n) {
        if (!o.at_edge() || glm::dot(o.beyond_normal, n) <= glm::dot(o.normal, n)) return o;
        return {o.beyond_origin, o.beyond_normal, o.radius, o.origin, o.normal};
    }

    /// The planes of the nodes beside a point, or a node's own and the one next to it that
    /// differs most, where they part.
    void compute_parted(std::size_t p, const PointPlace& at, const Obstacle& from, const Obstacle& to) {
        if (at.s > 0 && at.s < 1) {
            compute_parted(p, from, to);
            return;
        }
        const int i = at.s == 0 ? at.node : at.node + 1;
        const Obstacle& own = at.s == 1 ? to : from;
        Obstacle other = facing(obstacles[i + 1 <= n() ? i + 1 : i - 1], own.normal);
        if (i > 1 && i < n()) {
            const Obstacle before = facing(obstacles[i - 1], own.normal);
            if (glm::dot(own.normal, before.normal) < glm::dot(own.normal, other.normal)) other = before;
        }
        compute_parted(p, own, other);
    }

    void compute_parted(std::size_t p, const Obstacle& a, const Obstacle& b) {
        const double alike = glm::dot(a.normal, b.normal);
        constexpr double kAlike = 0.985, kApart = 0.90;  // 10° and 26°, as over smooth surfaces
        const double share = smooth_step((kAlike - alike) / (kAlike - kApart));
        if (share <= 0) return;
        Crease& c = points.crease[p];
        c.share = share;
        // Closest points that coincide are of an edge.
        c.convex = glm::dot(b.origin - a.origin, a.normal - b.normal) < 1e-9;
        c.edge = round_edge({{a.origin, b.origin}, {a.normal, b.normal}}, law.edge);
    }

    /// Places, planes, radii and tributary lengths of the contact points.
    void compute_points() {
        const int per = law.points_per_segment;
        compute_places(per);
        if (obstacles.empty()) return;
        fine.resize(points.place.size());
        points.crease.resize(fine.size());
        for (Crease& c : points.crease) c.share = 0;
        points.weight.assign(fine.size(), 0);
        bool alike_before = true;  // inboard of the point
        for (std::size_t p = 0; p < fine.size(); ++p) {
            const PointPlace& at = points.place[p];
            const Obstacle &from = obstacles[at.node], &to = obstacles[at.node + 1];
            const bool edge = from.at_edge() || to.at_edge(), alike = !edge && from.normal == to.normal;
            if (alike && (at.s > 0 || alike_before)) {
                compute_plane(p, at, from, to, from.normal);
            } else if (edge) {
                const Vec3 x = points.stencil[p].at(node);
                compute_point(p, at, within_reach(from, x), within_reach(to, x));
            } else {
                compute_point(p, at, from, to);
            }
            alike_before = alike;
            if (p + 1 < fine.size()) {
                const double half = 0.5 * rod.length[at.node] / per;
                points.weight[p] += half;
                points.weight[p + 1] += half;
            }
        }
    }

    void compute_places(int per) {
        const PointGrid& placed = points.placed;
        if (placed.length == rod.length && placed.per_segment == per && placed.round == rounded(law)) {
            points.place.resize(points.walls_from);
            points.stencil.resize(points.walls_from);
            return;
        }
        points.placed = {rod.length, per, rounded(law)};
        points.place.clear();
        points.walls_from = static_cast<std::size_t>(n()) * per + 1;
        for (int j = 0; j < n(); ++j) {
            for (int t = 0; t < per; ++t) points.place.push_back({j, static_cast<double>(t) / per});
        }
        points.place.push_back({n() - 1, 1.0});
        points.stencil.clear();
        for (const PointPlace& at : points.place)
            points.stencil.push_back(stencil_at(rod, rounded(law), at.node, at.s));
    }

    void compute_point(std::size_t p, const PointPlace& at, const Obstacle& a, const Obstacle& b) {
        const Vec3 normal_sum = (1 - at.s) * a.normal + at.s * b.normal;
        const double size = glm::length(normal_sum);
        compute_plane(p, at, a, b, size > 1e-6 ? normal_sum / size : a.normal);
        if (law.edge > 0) compute_crease(p, at, a, b);
    }

    void compute_plane(std::size_t p, const PointPlace& at, const Obstacle& a, const Obstacle& b, const Vec3& normal) {
        fine[p].origin = (1 - at.s) * a.origin + at.s * b.origin;
        fine[p].normal = normal;
        fine[p].radius = (1 - at.s) * a.radius + at.s * b.radius;
    }

    /// End compliance of each contact point: 1/k_e, k_e = 2 P s_e^-2 per length
    /// so that a straight end takes the buckling load P at s_e.
    void compute_compliance() {
        points.compliance.assign(fine.size(), 0);
        if (law.normal.end_compliance <= 0 || law.normal.hard || rod.buckling <= 0) return;
        const double soft = law.normal.end_compliance * law.normal.end_compliance / (2 * rod.buckling);
        double from_tip = 0;
        for (std::size_t p = fine.size(); p-- > 1;) {
            const double window = 1 - from_tip / (4 * law.normal.end_compliance);
            if (window <= 0) break;
            points.compliance[p] = soft * window * window / points.weight[p];
            from_tip += rod.length[points.place[p - 1].node] / law.points_per_segment;
        }
    }

    /// Pieces of the points that lie over a convex crease.
    void compute_pieces() {
        if (law.normal.hard) return;
        points.piece.resize(fine.size());
        for (std::size_t p = 0; p < fine.size(); ++p) {
            if (points.crease[p].share > 0 && points.crease[p].convex) compute_pieces(static_cast<int>(p));
        }
    }

    void compute_pieces(int p) {
        const int per = law.points_per_segment;
        for (int k = 0; k < kPieces; ++k) {
            HairPiece& piece = points.piece[p][k];
            const double offset = (k + 0.5) / kPieces - 0.5;
            const int first = offset < 0 ? p - 1 : p, other = offset < 0 ? p - 1 : p + 1;
            piece.weight = 0;
            if (first < 0 || first >= per * n()) continue;
            const int j = first / per;
            piece.at = stencil_at(rod, rounded(law), j, (p + offset) / per - j);
            piece.weight = rod.length[j] / (per * kPieces);
            piece.radius = fine[p].radius + std::abs(offset) * (fine[other].radius - fine[p].radius);
            piece.compliance = points.compliance[p] * points.weight[p] / piece.weight;
        }
    }

    /// The edge of a wall whose point is the last one, which is a piece of its own.
    void add_edge(const Wall& w) {
        const std::size_t p = fine.size() - 1;
        const Obstacle near =
            within_reach({w.origin, w.normal, w.radius, w.beyond_origin, w.beyond_normal}, points.stencil[p].at(node));
        std::tie(fine[p].origin, fine[p].normal) = std::tie(near.origin, near.normal);
        if (!near.at_edge()) return;
        points.crease[p] = {
            1, true, round_edge({{near.origin, near.beyond_origin}, {near.normal, near.beyond_normal}}, law.edge)};
        points.piece.resize(fine.size());
        points.piece[p] = {};
        points.piece[p][0] = {points.stencil[p], points.weight[p], w.radius, 0};
    }

    /// Points of their own on the nodes.
    void add_walls(std::span<const Wall> walls) {
        if (fine.empty() || law.normal.hard) return;
        for (const Wall& w : walls) {
            const PointPlace at = w.node < n() ? PointPlace{w.node, 0} : PointPlace{n() - 1, 1};
            points.place.push_back(at);
            points.stencil.push_back(stencil_at(rod, rounded(law), at.node, at.s));
            points.crease.push_back({});
            points.compliance.push_back(0);
            points.weight.push_back(w.share * rod.weight[w.node]);
            constexpr double kNowhere = -1e6;  // lengths
            fine.push_back({w.origin, w.normal, w.share > 0 ? w.radius : kNowhere});
            if (w.share > 0 && law.edge > 0) add_edge(w);
        }
    }
};

}  // namespace

Stencil stencil_at(const Rod& rod, bool round, int j, double s) {
    const int n = rod.segments(), k = s < 0.5 ? j : j + 1;  // the node that it belongs to
    Stencil out;
    out.first = std::clamp(k - 1, 0, std::max(0, n - 2));
    out.count = std::min(3, n + 1);
    if (!round || k == 0 || k == n) {
        const int inner = j - out.first;
        out.w[inner] = 1 - s;
        out.w[inner + 1] = s;
        out.d[inner] = 1 / rod.length[j];
        out.d[inner + 1] = -1 / rod.length[j];
        return out;
    }
    const double before = rod.length[k - 1], after = rod.length[k], half = 0.5 * (before + after);
    const double t = (j < k ? (s - 0.5) * before : 0.5 * before + s * after) / half, u = 1 - t;
    out.w[0] = 0.5 * u * u;
    out.w[2] = 0.5 * t * t;
    out.w[1] = 1 - out.w[0] - out.w[2];
    out.d[0] = u / before;
    out.d[1] = t / after - u / before;
    out.d[2] = -t / after;
    return out;
}

Recycled<Vec3> curve_nodes(const Rod& rod, const Recycled<Vec3>& node) {
    Recycled<Vec3> x(node.begin(), node.end());
    for (int j = 1; j < rod.segments(); ++j) x[j] = stencil_at(rod, true, j, 0).at(node);
    return x;
}

void compute_points(std::span<const Obstacle> obstacles, const Recycled<Vec3>& node, Frozen& frozen,
                    Recycled<Obstacle>& fine, std::span<const Wall> walls) {
    fine.clear();
    PointBuilder builder{*frozen.rod, *frozen.law, obstacles, node, frozen.points, fine};
    builder.compute_points();
    builder.compute_compliance();
    builder.compute_pieces();
    builder.add_walls(walls);
}

}  // namespace tuft::brush::rod
