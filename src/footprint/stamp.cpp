#include "footprint/stamp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "atlas/log_map.h"
#include "footprint/picture.h"
#include "footprint/sweep.h"

namespace tuft::footprint {
namespace {

constexpr double kFacingAway = atlas::kLogMapMinCos;  // normals beyond this are never touched
constexpr float kAgree = 0.25f;  // of a hop: neighbours that differ by more went other ways
constexpr float kSlack = 1.1f;   // of a piece's radius: the log map stretches it a little
constexpr float kSureCos = 0.8f, kSureNormal = 0.3f;  // pieces that surely face the stamp
constexpr float kUpwind = 0.2f;       // cosine to the source of neighbours that lead on
constexpr float kNearSource = 0.5f;   // squared distance over hop below which hops are added up
constexpr float kLeastStretch = 0.6f; // and its inverse: beyond, the ways to both differ
constexpr float kOverBorder = 0.3f;  // cosine of an open border's outward direction to the source
constexpr double kShadow = 0.1;  // of its distance: what a piece behind an opening may be off by
constexpr float kDetour = 2;  // piece radii round the picture in which ways to it are looked for

enum : std::uint8_t { kOpen, kFinal, kOutside };

/// Signed angle from p to q, |p||q| = `lengths`, within 5e-5 of itself below 62°; beyond, not a
/// number. By the tangent of its half and a Padé approximant: the same bits in every library.
float angle(const Vec2f& p, const Vec2f& q, float lengths) {
    const float t = (p.x * q.y - p.y * q.x) / (p.x * q.x + p.y * q.y + lengths), t2 = t * t;
    if (!(t2 < 0.36f)) return std::numeric_limits<float>::quiet_NaN();
    return 2 * t * (105 + 55 * t2) / (105 + t2 * (90 + 9 * t2));
}

/// What the walk needs to know of a stamp.
struct Reach {
    Vec3f origin{0}, normal{0};
    float radius = 0;    ///< metres, motion included
    Vec2f lo{0}, hi{0};  ///< of the picture, motion included, metres
};

struct Walk {
    const atlas::PieceGraph& graph;
    PlanScratch& scratch;
    Reach reach;

    PlanScratch::Node& node(std::uint32_t piece) {
        PlanScratch::Node& n = scratch.nodes[piece];
        if (n.epoch != scratch.epoch) {
            n = {};
            n.epoch = scratch.epoch;
            n.key = std::numeric_limits<float>::infinity();
        }
        return n;
    }

    /// `key`: squared distance from the stamp's origin.
    void push(PlanScratch::Node& n, std::uint32_t piece, float key) {
        n.key = key;
        scratch.heap.emplace_back(key, piece);
        std::push_heap(scratch.heap.begin(), scratch.heap.end(), std::greater<>());
    }

    /// What one settled neighbour says of a piece's place.
    struct Hint {
        float weight, hop2, u, v, c, s;
        const atlas::PieceEdge* edge;
    };

    /// Place of a piece: mean of what its settled neighbours say, those in radial direction and
    /// near by first. Behind an obstacle the ways round it on both sides lead to different
    /// places; there the neighbour with most weight and those who agree with it decide. No
    /// place is nearer than the straight line in space.
    void place(const atlas::Piece& piece, std::uint32_t index, PlanScratch::Node& n) {
        std::array<Hint, 24> hints;
        std::size_t count = 0, best = 0;
        const std::uint32_t end = graph.edge_start[index + 1];
        for (std::uint32_t k = graph.edge_start[index]; k < end && count < hints.size(); ++k) {
            const atlas::PieceEdge& e = graph.edges[k];
            const PlanScratch::Node& from = scratch.nodes[e.to];
            if (from.epoch != scratch.epoch || from.state != kFinal) continue;
            const float ci = from.c * e.c + from.s * e.s, si = from.s * e.c - from.c * e.s;
            const float hu = ci * e.hop_u - si * e.hop_v, hv = si * e.hop_u + ci * e.hop_v;
            const float pu = from.u - hu, pv = from.v - hv;
            const float hh = hu * hu + hv * hv, pp = pu * pu + pv * pv, hp = hu * pu + hv * pv;
            const float cos2 = hh * pp > 0 ? hp * hp / (hh * pp) : 1.0f;
            const float weight = (cos2 * cos2 + 1e-4f) / std::sqrt(hh + 1e-20f);
            hints[count] = {weight, hh, pu, pv, ci, si, &e};
            if (weight > hints[best].weight) best = count;
            ++count;
        }
        if (count == 0) return;
        float total = 0, u = 0, v = 0, c = 0, s = 0;
        const float agree = kAgree * kAgree * hints[best].hop2;
        for (std::size_t k = 0; k < count; ++k) {
            const Hint& h = hints[k];
            const float du = h.u - hints[best].u, dv = h.v - hints[best].v;
            if (du * du + dv * dv > agree) continue;
            total += h.weight;
            u += h.weight * h.u;
            v += h.weight * h.v;
            c += h.weight * h.c;
            s += h.weight * h.s;
        }
        const float turn = std::sqrt(c * c + s * s), away = std::sqrt(u * u + v * v);
        const float straight = total * glm::length(piece.centre - reach.origin);
        const float longer = away > 0 && away < 0.999f * straight ? straight / away : 1.0f;
        n.u = longer * u / total;
        n.v = longer * v / total;
        if (!(turn > 0)) return;
        n.c = c / turn;
        n.s = s / turn;
        if (longer == 1) swing_in(std::span(hints.data(), count), piece, n);
        n.lit = is_lit(std::span(hints.data(), count), piece, n);
    }

    /// Whether straight ways lead from the source to the piece, and no opening of the mesh lies
    /// between: its own open border does not face the source, and the neighbour next to the way is lit.
    bool is_lit(std::span<const Hint> hints, const atlas::Piece& piece, const PlanScratch::Node& n) const {
        bool lit = true;
        for (const Hint& h : hints) lit = lit && scratch.nodes[h.edge->to].lit;
        if (lit && piece.outward == Vec3f{0}) return true;
        const float d = std::sqrt(n.u * n.u + n.v * n.v);
        const float sx = -(n.c * n.u + n.s * n.v), sy = -(n.c * n.v - n.s * n.u);
        const Vec3f b = glm::cross(piece.normal, piece.tangent);
        const Vec3f to_source = sx * piece.tangent + sy * b;
        if (glm::dot(piece.outward, to_source) > kOverBorder * d * glm::length(piece.outward)) return false;
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

    /// Carries distance and angle on from two settled neighbours with the source between them
    /// (geodesic polar coordinates, Melvær and Reimers 2012): the circles of their distances meet
    /// in the unfolded source, and angles at it are in proportion to angles at the origin. Where the
    /// surface curves, adding up hops would turn the piece by the curvature that they enclose.
    void swing_in(std::span<const Hint> hints, const atlas::Piece& piece, PlanScratch::Node& n) {
        const float d = std::sqrt(n.u * n.u + n.v * n.v);
        if (!(d > 0)) return;
        // Towards the source, in the piece's frame.
        const float sx = -(n.c * n.u + n.s * n.v) / d, sy = -(n.c * n.v - n.s * n.u) / d;
        const Hint *left = nullptr, *right = nullptr;
        float left_cos = kUpwind, right_cos = kUpwind;
        for (const Hint& h : hints) {
            const float du = h.u - n.u, dv = h.v - n.v;
            if (du * du + dv * dv > kAgree * kAgree * h.hop2) continue;
            const float x = h.edge->hop_u, y = h.edge->hop_v, length = std::sqrt(h.hop2);
            const float cos = (x * sx + y * sy) / length;
            const bool is_left = sx * y - sy * x > 0;
            if (is_left && cos > left_cos) {
                left = &h;
                left_cos = cos;
            } else if (!is_left && cos > right_cos) {
                right = &h;
                right_cos = cos;
            }
        }
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
        if (far < 0.999f * glm::length(piece.centre - reach.origin)) return;
        n.u = far * eu;
        n.v = far * ev;
        const float ex = -source.x / far, ey = -source.y / far;
        n.c = eu * ex + ev * ey;
        n.s = ev * ex - eu * ey;
        n.stretch = stretch;
    }

    bool faces_away(const atlas::Piece& piece) const {
        const float c = glm::dot(piece.normal, reach.normal);
        if (c > kFacingAway) return false;
        return std::acos(std::max(c, -1.0f)) - std::acos(std::min(piece.cone_cos, 1.0f)) >
               std::acos(static_cast<float>(kFacingAway));
    }

    /// The piece's disc and the picture have a point in common.
    bool in_picture(const atlas::Piece& piece, const PlanScratch::Node& n) const {
        const float r = kSlack * piece.radius;
        const float du = std::max({reach.lo.x - n.u, n.u - reach.hi.x, 0.0f});
        const float dv = std::max({reach.lo.y - n.v, n.v - reach.hi.y, 0.0f});
        return du * du + dv * dv <= r * r;
    }

    /// Worth a visit where one neighbour sees it: in the picture or on a way into it. Its final
    /// place may be a little nearer.
    bool near_picture(const atlas::Piece& piece, float u, float v) const {
        const float r = kDetour * piece.radius;
        const float du = std::max({std::min(reach.lo.x, 0.0f) - u, u - std::max(reach.hi.x, 0.0f), 0.0f});
        const float dv = std::max({std::min(reach.lo.y, 0.0f) - v, v - std::max(reach.hi.y, 0.0f), 0.0f});
        const float far = reach.radius + (kSlack + kAgree) * piece.radius;
        return du * du + dv * dv <= r * r && u * u + v * v <= far * far;
    }

    /// Dijkstra over the pieces by distance from the stamp's origin; leaves those that the
    /// picture reaches in scratch.reached, in order of their numbers.
    void run(std::uint32_t first) {
        scratch.reached.clear();
        while (!scratch.heap.empty()) {
            std::pop_heap(scratch.heap.begin(), scratch.heap.end(), std::greater<>());
            const auto [key, i] = scratch.heap.back();
            scratch.heap.pop_back();
            PlanScratch::Node& n = scratch.nodes[i];
            if (n.state != kOpen || key > n.key) continue;
            const atlas::Piece& piece = graph.pieces[i];
            if (i != first) place(piece, i, n);
            const float distance = std::sqrt(n.u * n.u + n.v * n.v);
            n.state = kOutside;
            if (distance - kSlack * piece.radius > reach.radius || faces_away(piece)) continue;
            n.state = kFinal;
            if (in_picture(piece, n)) scratch.reached.push_back(i);
            for (std::uint32_t k = graph.edge_start[i]; k < graph.edge_start[i + 1]; ++k) {
                const atlas::PieceEdge& e = graph.edges[k];
                PlanScratch::Node& other = node(e.to);
                if (other.state != kOpen) continue;
                const float u = n.u + n.c * e.hop_u - n.s * e.hop_v;
                const float v = n.v + n.s * e.hop_u + n.c * e.hop_v;
                const float distance2 = u * u + v * v;
                if (distance2 < other.key && near_picture(graph.pieces[e.to], u, v))
                    push(other, e.to, distance2);
            }
        }
        std::sort(scratch.reached.begin(), scratch.reached.end());
    }
};

void begin_walk(PlanScratch& scratch, std::size_t n_pieces) {
    if (scratch.nodes.size() != n_pieces || scratch.epoch == kNone) {
        scratch.nodes.assign(n_pieces, {});
        scratch.epoch = 0;
    }
    ++scratch.epoch;
    scratch.heap.clear();
}

std::array<float, 3> to_array(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Frame of texels whose log map in `frame` lands at `place` + turn · (u, v) in the stamp.
PieceFrame picture_frame(const Frame& frame, const Vec2& place, const Vec2& turn,
                         const Footprint& footprint) {
    PieceFrame f;
    const double scale = 1 / footprint.cell;
    f.origin = to_array(frame.origin);
    f.normal = to_array(frame.n);
    f.tu = to_array(scale * (turn.x * frame.t - turn.y * frame.b));
    f.tv = to_array(scale * (turn.y * frame.t + turn.x * frame.b));
    f.u0 = static_cast<float>((place.x - footprint.lo.x) * scale - 0.5);
    f.v0 = static_cast<float>((place.y - footprint.lo.y) * scale - 0.5);
    return f;
}

/// Sub-poses for no point to go further than `sub_pose` between them; 0: nothing moves.
double poses_wanted(const Footprint& footprint, const Motion& motion, double texel_size,
                    const StampOptions& options) {
    const double travel = glm::length(motion.shift) + std::abs(motion.turn) * footprint.radius;
    if (!(travel > 0)) return 0;
    const double step = options.sub_pose * texel_size;
    return step > 0 ? std::ceil(travel / step) : 1;
}

/// Poses of the picture at the middles of equal parts of the motion. At a part σ before
/// its end a texel at (u, v) sees the picture's point x = R(σ turn) ((u, v) + σ shift).
std::vector<SubPose> spread_poses(const Footprint& footprint, const Motion& motion,
                                  double texel_size, const StampOptions& options) {
    const double wanted = poses_wanted(footprint, motion, texel_size, options);
    if (!(wanted > 0)) return {SubPose{}};
    const int n =
        static_cast<int>(std::clamp(wanted, 1.0, double(std::max(options.max_sub_poses, 1))));
    std::vector<SubPose> poses(n);
    const Vec2 zero = footprint.lo / footprint.cell + 0.5;  // cell (0, 0) in cells from the origin
    for (int k = 0; k < n; ++k) {
        const double rest = 1 - (k + 0.5) / n;
        const double c = std::cos(rest * motion.turn), s = std::sin(rest * motion.turn);
        const Vec2 p = zero + rest * motion.shift / footprint.cell;
        const auto cos = static_cast<float>(c), sin = static_cast<float>(s);
        poses[k] = {cos, -sin, sin, cos, static_cast<float>(c * p.x - s * p.y - zero.x),
                    static_cast<float>(s * p.x + c * p.y - zero.y)};
    }
    return poses;
}

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

Frame frame_of(const atlas::Piece& piece) {
    Frame f;
    f.origin = Vec3(piece.centre);
    f.n = Vec3(piece.normal);
    f.t = Vec3(piece.tangent);
    f.b = glm::cross(f.n, f.t);
    return f;
}

/// Distance between where one stamp frame and the walk put a piece's centre, metres.
double disagreement(const Frame& frame, const atlas::Piece& piece, const PlanScratch::Node& n) {
    if (glm::dot(Vec3(piece.normal), frame.n) <= atlas::kLogMapMinCos)
        return std::numeric_limits<double>::infinity();
    return glm::length(atlas::log_map(frame, Vec3(piece.centre), Vec3(piece.normal)) -
                       Vec2(n.u, n.v));
}

/// Lists the reached pieces that the picture may cover, with what is known of its coverage
/// there, and takes the greatest disagreement; scratch.reached is left with those listed.
void list_pieces(const atlas::PieceGraph& graph, const Footprint& footprint, const Motion& motion,
                 PlanScratch& scratch, StampJobs& jobs) {
    BlockTally& tally = scratch.tally;
    tally.count(footprint);
    const auto cell = static_cast<float>(footprint.cell);
    const Vec2f zero = Vec2f(footprint.lo / footprint.cell + 0.5);
    const Vec2f half_way = Vec2f(0.5 * motion.shift);
    const Vec3f normal(footprint.frame.n);
    std::size_t n = 0;
    jobs.frames.reserve(scratch.reached.size());
    for (const std::uint32_t i : scratch.reached) {
        const atlas::Piece& piece = graph.pieces[i];
        const PlanScratch::Node& at = scratch.nodes[i];
        PieceFrame f;
        const double apart = disagreement(footprint.frame, piece, at);
        if (jobs.mapping == Mapping::log) {
            // Wherever its texels lie in either mode and in whatever pose, and the next cell.
            const Vec2f place = Vec2f{at.u, at.v} + half_way;
            const float way = glm::length(half_way), r = kSlack * piece.radius;
            const float swing = static_cast<float>(std::abs(motion.turn)) * (glm::length(place) + way + r);
            const float reach = (r + static_cast<float>(apart) + way + swing) / cell + 1.5f;
            const Vec2f centre = place / cell - zero;
            const Cover cover = tally.look(centre, reach);
            if (cover == Cover::empty) continue;
            f.full = piece.cone_cos > kSureCos && glm::dot(piece.normal, normal) > kSureNormal &&
                     cover == Cover::full;
        }
        // Behind an opening the walk itself is in doubt: it went round.
        if (at.lit || apart > kShadow * static_cast<double>(glm::length(Vec2f{at.u, at.v})))
            jobs.discrepancy = std::max(jobs.discrepancy, apart);
        if (jobs.tiles.empty() || jobs.tiles.back().slot != piece.slot)
            jobs.tiles.push_back({piece.slot, static_cast<std::uint32_t>(jobs.frames.size()), 0});
        ++jobs.tiles.back().count;
        f.piece = piece.index;
        f.first_row = piece.first_row;
        f.last_row = piece.last_row;
        jobs.frames.push_back(f);
        scratch.reached[n++] = i;
    }
    scratch.reached.resize(n);
    jobs.discrepancy /= std::max(footprint.radius, 1e-12);
}

/// Stretches the picture's axes across the radial direction.
void stretch_frame(PieceFrame& f, const PlanScratch::Node& at) {
    const float d2 = at.u * at.u + at.v * at.v;
    if (!(d2 > 0)) return;
    const float more = at.stretch - 1;
    const float tt = more * at.v * at.v / d2, tr = -more * at.u * at.v / d2, rr = more * at.u * at.u / d2;
    for (int k = 0; k < 3; ++k) {
        const float u = f.tu[k], v = f.tv[k];
        f.tu[k] = u + tt * u + tr * v;
        f.tv[k] = v + tr * u + rr * v;
    }
}

/// Gives each piece the frame it needs when they have their own.
void place_pieces(const atlas::PieceGraph& graph, const Footprint& footprint,
                  const PlanScratch& scratch, StampJobs& jobs) {
    for (std::size_t k = 0; k < jobs.frames.size(); ++k) {
        const PlanScratch::Node& at = scratch.nodes[scratch.reached[k]];
        const PieceFrame& old = jobs.frames[k];
        PieceFrame f = picture_frame(frame_of(graph.pieces[scratch.reached[k]]), Vec2(at.u, at.v),
                                     Vec2(at.c, at.s), footprint);
        if (at.stretch != 1) stretch_frame(f, at);
        f.piece = old.piece;
        f.first_row = old.first_row;
        f.last_row = old.last_row;
        f.full = old.full;
        jobs.frames[k] = f;
    }
}

}  // namespace

StampJobs plan_stamp(const Surface& surface, const Footprint& footprint, const Motion& motion,
                     const StampOptions& options, PlanScratch& scratch, StampJobs recycled) {
    StampJobs jobs = std::move(recycled);
    jobs.frames.clear();
    jobs.tiles.clear();
    jobs.sub_poses.clear();
    jobs.gain = 1;
    jobs.discrepancy = 0;
    jobs.piecewise = false;
    jobs.mapping = options.mapping;
    jobs.isa = options.isa;
    if (footprint.empty() || footprint.width < 2 || footprint.height < 2) return jobs;
    const atlas::TexelRef contact = atlas::texel_at(surface.mesh, surface.atlas, surface.texels,
                                                    footprint.triangle, footprint.frame.origin);
    if (!contact.valid()) return jobs;

    const std::uint32_t first = surface.texels.piece_start[contact.slot] +
                                surface.texels.tiles[contact.slot].piece[contact.texel];
    const atlas::Piece& first_piece = surface.pieces.pieces[first];
    begin_walk(scratch, surface.pieces.n_pieces());
    Walk walk{surface.pieces, scratch, reach_of(footprint, motion)};

    // The walk starts in the tangent plane of the surface itself: the stamp's normal may be
    // a mean over a crease.
    Frame start = footprint.frame;
    start.n = glm::normalize(Vec3(surface.texels.normal(contact.slot, contact.texel)));
    start.t = parallel_transport(footprint.frame.t, footprint.frame.n, start.n);
    start.b = glm::cross(start.n, start.t);
    const Vec2 place = atlas::log_map(start, Vec3(first_piece.centre), Vec3(first_piece.normal));
    const Vec2 turn =
        atlas::carried_direction(start, Vec3(first_piece.tangent), Vec3(first_piece.normal));
    PlanScratch::Node& n = walk.node(first);
    walk.push(n, first, 0);
    n.u = static_cast<float>(place.x);
    n.v = static_cast<float>(place.y);
    n.c = static_cast<float>(turn.x);
    n.s = static_cast<float>(turn.y);
    walk.run(first);
    if (scratch.reached.empty()) return jobs;

    jobs.stamp_frame = picture_frame(footprint.frame, Vec2{0}, Vec2{1, 0}, footprint);
    const double texel_size = surface.texels.texel_size;
    const bool swept = motion.turn == 0 && options.prefix_sums > 0 &&
                       poses_wanted(footprint, motion, texel_size, options) >= options.prefix_sums;
    if (!swept) jobs.sub_poses = spread_poses(footprint, motion, texel_size, options);
    list_pieces(surface.pieces, footprint, motion, scratch, jobs);
    if (jobs.discrepancy > std::min(options.enter, options.leave))
        place_pieces(surface.pieces, footprint, scratch, jobs);
    const Vec2f to_cells = Vec2f(footprint.lo / footprint.cell + 0.5);
    const Vec2f lo = walk.reach.lo / float(footprint.cell) - to_cells - 2.0f;
    const Vec2f hi = walk.reach.hi / float(footprint.cell) - to_cells + 2.0f;
    jobs.reach_lo = {lo.x, lo.y};
    jobs.reach_hi = {hi.x, hi.y};
    if (swept) {
        sweep(footprint, motion.shift, jobs, scratch.sweep);
        return jobs;
    }
    jobs.width = footprint.width - 1;
    jobs.height = footprint.height - 1;
    pack_picture(footprint, jobs.pairs);
    return jobs;
}

bool choose_mode(StampJobs& jobs, bool piecewise_before, const StampOptions& options) {
    jobs.piecewise = jobs.mapping == Mapping::log &&
                     jobs.discrepancy > (piecewise_before ? options.leave : options.enter);
    return jobs.piecewise;
}

}  // namespace tuft::footprint
