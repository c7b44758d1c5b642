#include "footprint/folds.h"

#include <algorithm>
#include <cmath>

#include "atlas/texels/log_map.h"
#include "atlas/texels/seams.h"
#include "mesh/shortest_ways.h"

namespace tuft::footprint {
namespace {

constexpr double kFewFolds = 0.01;  // of the pieces: fewer are left where the walk placed them
constexpr double kBeyond = 1.1;     // of the reach: pieces that begin there
constexpr std::size_t kMostWindows = 120'000;  // some 20 ms
constexpr double kBeside = 1e-3;  // of a triangle: what places in the atlas are rounded by

Vec3 face_normal(const mesh::TriangleMesh& mesh, std::uint32_t triangle) {
    const Vec3 a = mesh.position(triangle, 0);
    return glm::normalize(
        glm::cross(mesh.position(triangle, 1) - a, mesh.position(triangle, 2) - a));
}

/// Looks for centres of pieces in a triangle: of those whose place in the atlas has a centre
/// inside, or nearly, the one that puts it nearest to where it is counts.
class Seating {
  public:
    Seating(const Surface& surface, Seats& seats) : surface_(surface), seats_(seats) {
        seats.clear();
    }

    void look(std::uint32_t t) {
        const Vec2 a = atlas::corner_texels(surface_.atlas, t, 0);
        const Vec2 b = atlas::corner_texels(surface_.atlas, t, 1) - a;
        const Vec2 c = atlas::corner_texels(surface_.atlas, t, 2) - a;
        const double det = b.x * c.y - b.y * c.x;
        if (!std::isfinite(a.x + a.y) || !(std::abs(det) > 0) || !std::isfinite(1 / det)) return;
        const Vec2 lo = a + glm::min(Vec2{0}, glm::min(b, c));
        const Vec2 hi = a + glm::max(Vec2{0}, glm::max(b, c));
        const std::int64_t x1 = tile(hi.x), y1 = tile(hi.y);
        for (std::int64_t y = tile(lo.y); y <= y1; ++y)
            for (std::int64_t x = tile(lo.x); x <= x1; ++x) {
                const std::uint32_t slot = surface_.texels.slot_of_tile[static_cast<std::size_t>(
                    y * surface_.texels.tiles_per_side + x)];
                if (slot == kNone) continue;
                const auto& first = surface_.texels.piece_start;
                for (std::uint32_t i = first[slot]; i < first[slot + 1]; ++i) {
                    const atlas::Piece& piece = surface_.pieces.pieces[i];
                    if (piece.chart != surface_.atlas.triangle_chart[t]) continue;
                    const Vec2 d =
                        Vec2(double(x) * atlas::kTile + piece.centre_texel % atlas::kTile + 0.5,
                             double(y) * atlas::kTile + piece.centre_texel / atlas::kTile + 0.5) -
                        a;
                    sit(i, t, (d.x * c.y - d.y * c.x) / det, (b.x * d.y - b.y * d.x) / det);
                }
            }
    }

  private:
    std::int64_t tile(double texels) const {
        const auto last = static_cast<std::int64_t>(surface_.texels.tiles_per_side) - 1;
        return std::clamp(static_cast<std::int64_t>(std::floor(texels / atlas::kTile)),
                          std::int64_t{0}, last);
    }

    void sit(std::uint32_t piece, std::uint32_t t, double w1, double w2) {
        const double w0 = 1 - w1 - w2;
        if (std::min({w0, w1, w2}) < -kBeside) return;
        const Vec3 off = w0 * surface_.mesh.position(t, 0) + w1 * surface_.mesh.position(t, 1) +
                         w2 * surface_.mesh.position(t, 2) -
                         Vec3(surface_.pieces.pieces[piece].centre);
        seats_.sit(piece, t, glm::dot(off, off));
    }

    const Surface& surface_;
    Seats& seats_;
};

struct Folds {
    const mesh::TriangleMesh& mesh;
    const mesh::ShortestWays& ways;
    const Frame& from;
    Vec3 normal;  ///< of the triangle at its origin

    bool place(const atlas::Piece& piece, std::uint32_t triangle, PlanScratch::Node& n) const {
        if (triangle == kNone) return false;
        const mesh::ShortestWays::Way way = ways.to(triangle, Vec3(piece.centre));
        if (!std::isfinite(way.length)) return false;
        const Vec2 leaves = atlas::carried_direction(from, way.leaves, normal);
        const Vec2 arrives = atlas::carried_direction(atlas::frame_of(piece), way.arrives,
                                                      face_normal(mesh, triangle));
        n.u = static_cast<float>(way.length * leaves.x);
        n.v = static_cast<float>(way.length * leaves.y);
        n.c = static_cast<float>(glm::dot(leaves, arrives));
        n.s = static_cast<float>(arrives.x * leaves.y - arrives.y * leaves.x);
        return true;
    }
};

}  // namespace

void Seats::clear() {
    numbers_.clear();
    seats_.clear();
}

void Seats::sit(std::uint32_t piece, std::uint32_t triangle, double off2) {
    const auto [seat, is_new] = numbers_.number(piece);
    if (is_new)
        seats_.push_back({triangle, off2});
    else if (off2 < seats_[seat].off2)
        seats_[seat] = {triangle, off2};
}

void place_folds(const Surface& surface, std::uint32_t triangle, const Frame& from,
                 const Reach& reach, const Start& start, std::size_t folded, PlanScratch& scratch) {
    const auto n_pieces = static_cast<double>(scratch.reached.size());
    if (folded == 0 || static_cast<double>(folded) < kFewFolds * n_pieces) return;
    mesh::ShortestWays& ways = scratch.ways;
    const double radius = kBeyond * static_cast<double>(reach.radius);
    if (!ways.spread(surface.mesh, triangle, from.origin, radius, kMostWindows)) return;
    Seating seating(surface, scratch.seats);
    for (std::size_t i = 0; i < ways.n_faces(); ++i) seating.look(ways.triangle(i));
    const Folds folds{surface.mesh, ways, from, face_normal(surface.mesh, triangle)};
    const atlas::PieceGraph& graph = surface.pieces;
    begin_walk(scratch, graph.n_pieces());
    std::vector<std::uint32_t> open{start.piece};
    place_start(scratch, start).state = kFinal;
    scratch.reached.clear();
    for (std::size_t i = 0; i < open.size(); ++i) {
        const std::uint32_t index = open[i];
        const atlas::Piece& piece = graph.pieces[index];
        PlanScratch::Node& n = node_of(scratch, index);
        const bool placed = folds.place(piece, scratch.seats.of(index), n);
        const float distance = std::sqrt(n.u * n.u + n.v * n.v);
        if (index != start.piece &&
            (!placed || distance - kPieceSlack * piece.radius > reach.radius ||
             faces_away(reach, piece)))
            continue;
        if (in_picture(reach, piece, n)) scratch.reached.push_back(index);
        for (std::uint32_t k = graph.edge_start[index]; k < graph.edge_start[index + 1]; ++k) {
            PlanScratch::Node& other = node_of(scratch, graph.edges[k].to);
            if (other.state != kOpen) continue;
            other.state = kFinal;
            open.push_back(graph.edges[k].to);
        }
    }
    std::sort(scratch.reached.begin(), scratch.reached.end());
}

}  // namespace tuft::footprint
