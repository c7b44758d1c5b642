#include "stroke/surface/flat_texels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/system/parallel.h"
#include "stroke/placement/surface_mapping.h"

namespace tuft::stroke {
namespace {

constexpr double kGridStep = 2e-3;  // metres between nodes
constexpr int kFewestNodes = 33;    // nodes along a side
constexpr int kMostNodes = 400;     // likewise
constexpr double kFacing = 0.3;     // cosine of the angle between texel and grid, below which a texel faces away
constexpr double kWall = -0.2;      // the same where walls are reached
constexpr double kStep = 0.5, kGapStep = 0.15;              // rise between connected neighbours, over their distance
constexpr double kGapFacing = 0.9;                          // cosine between the normals at both sides of a gap
constexpr double kBallSlack = 1.001, kBallRounding = 1e-6;  // of clusters' radii, which are floats; metres
constexpr double kCutHeight = 0.25;                         // of the grid's reach, off its surface
constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();

/// The drawing's rectangle on the surface, as nodes of a grid. A draped one lies on the smoothed surface: nodes that
/// dip into a shut line would bend all cells around it.
class SurfaceGrid {
  public:
    SurfaceGrid(const mesh::SurfaceQuery& surface, const FlatFrame& frame) {
        const Vec2 low = frame.low, high = frame.high;
        const Vec2 size = glm::max(high - low, Vec2(1e-6));
        for (int k = 0; k < 2; ++k)
            n_[k] = std::clamp(static_cast<int>(std::ceil(size[k] / kGridStep)) + 1, kFewestNodes, kMostNodes);
        // One more node around: no texel of the rectangle is past the last one.
        step_ = size / Vec2(n_[0] - 1, n_[1] - 1);
        low_ = low - step_;
        n_[0] += 2, n_[1] += 2;
        StrokeSamples nodes{.placement = frame.placement};
        for (int j = 0; j < n_[1]; ++j)
            for (int i = 0; i < n_[0]; ++i) nodes.samples.push_back({.position = Vec3(low_ + step_ * Vec2(i, j), 0)});
        if (frame.placement.mapping == SurfaceMapping::drape) {
            nodes_ = map_draped(surface, nodes, nullptr, &over_).samples;
        } else {
            nodes_ = map_to_surface(surface, nodes).samples;
            for (const SurfaceSample& s : nodes_) over_.push_back(s.position);
        }
        if (frame.edges == AreaEdges::cut) keep_connected();
        build_mesh();
    }

    bool empty() const { return mesh_.triangles.empty(); }
    double reach() const { return reach_; }
    /// Off its surface, metres: what is farther belongs to another part.
    double cut_height() const { return kCutHeight * reach_; }
    const Box& bounds() const { return mesh_.bounds; }
    const mesh::SurfaceQuery& query() const { return *query_; }
    Vec2 flat(const Vec2& cell) const { return low_ + step_ * cell; }
    SurfaceLattice lattice() const {
        SurfaceLattice out{low_, step_, n_[0], n_[1], over_, {}};
        for (const SurfaceSample& s : nodes_) out.on_surface.push_back(s.on_surface);
        return out;
    }

    /// Place in cells of a point of the mesh.
    Vec2 cell_of(const mesh::SurfacePoint& at) const {
        const auto& t = mesh_.triangles[at.triangle];
        const auto node = [&](std::uint32_t k) { return Vec2(int(k) % n_[0], int(k) / n_[0]); };
        return (1 - at.b1 - at.b2) * node(t[0]) + at.b1 * node(t[1]) + at.b2 * node(t[2]);
    }

    /// Where a point lies over the bilinear patches: Gauss–Newton from a place nearby.
    struct Foot {
        Vec2 cell{0};
        Vec3 offset{0}, normal{0, 0, 1};  ///< from the foot to the point; unit
        double lowest = 0, highest = 0;   ///< of the surface at the nodes around, along the normal, metres
    };
    std::optional<Foot> foot(const Vec3& p, Vec2 cell) const {
        // Over an edge where patches meet, each may have the foot beyond the other's end: shorter steps end at the
        // edge.
        constexpr int kSteps = 16, kWhole = 6;
        constexpr double kAtEdge = 0.5;  // cells
        for (int k = 0; k < kSteps; ++k) {
            if (!(cell.x >= 0 && cell.y >= 0 && cell.x <= n_[0] - 1 && cell.y <= n_[1] - 1)) return {};
            const int i = std::min(static_cast<int>(cell.x), n_[0] - 2),
                      j = std::min(static_cast<int>(cell.y), n_[1] - 2);
            const double u = cell.x - i, v = cell.y - j;
            const SurfaceSample &a = node(i, j), &b = node(i + 1, j), &c = node(i, j + 1), &d = node(i + 1, j + 1);
            if (!(a.on_surface || b.on_surface || c.on_surface || d.on_surface)) return {};
            const Vec3 &pa = over_[index(i, j)], &pb = over_[index(i + 1, j)], &pc = over_[index(i, j + 1)],
                       &pd = over_[index(i + 1, j + 1)];
            const Vec3 x = glm::mix(glm::mix(pa, pb, u), glm::mix(pc, pd, u), v);
            const Vec3 du = glm::mix(pb - pa, pd - pc, v);
            const Vec3 dv = glm::mix(pc - pa, pd - pb, u);
            const Vec3 off = p - x;
            const double uu = glm::dot(du, du), uv = glm::dot(du, dv), vv = glm::dot(dv, dv), det = uu * vv - uv * uv;
            if (!(det > 1e-6 * uu * vv)) return {};
            const double x1 = glm::dot(off, du), x2 = glm::dot(off, dv);
            const Vec2 change((vv * x1 - uv * x2) / det, (uu * x2 - uv * x1) / det);
            const double most = std::max(std::abs(change.x), std::abs(change.y));
            const bool converged = most < 1e-4, at_edge = k + 1 == kSteps && most < kAtEdge;
            if (converged || at_edge) {
                Foot foot{
                    converged ? cell + change : cell, off,
                    glm::normalize(glm::mix(glm::mix(a.normal, b.normal, u), glm::mix(c.normal, d.normal, u), v))};
                const auto range =
                    std::minmax({glm::dot(a.position - pa, foot.normal), glm::dot(b.position - pb, foot.normal),
                                 glm::dot(c.position - pc, foot.normal), glm::dot(d.position - pd, foot.normal)});
                foot.lowest = range.first, foot.highest = range.second;
                return foot;
            }
            cell += std::ldexp(1.0, std::min(0, kWhole - k)) * glm::clamp(change, Vec2(-2), Vec2(2));
        }
        return {};
    }

  private:
    const SurfaceSample& node(int i, int j) const { return nodes_[index(i, j)]; }

    bool connected(const SurfaceSample& a, const SurfaceSample& b, bool over_gap) const {
        const Vec3 d = b.position - a.position;
        const double length = glm::length(d), one = std::abs(glm::dot(d, a.normal)),
                     other = std::abs(glm::dot(d, b.normal));
        if (!over_gap) return std::min(one, other) <= kStep * length;
        return length <= kWidestGap && std::max(one, other) <= kGapStep * length &&
               glm::dot(a.normal, b.normal) > kGapFacing;
    }

    /// Leaves the nodes that are connected with the origin's on the surface.
    void keep_connected() {
        const std::vector<char> kept = find_connected();
        // A node beside them continues their surface, so that texels up to the rim have a place on the grid.
        const std::vector<SurfaceSample> found = nodes_;
        const std::vector<Vec3> over = over_;
        for (int j = 0; j < n_[1]; ++j)
            for (int i = 0; i < n_[0]; ++i) {
                if (kept[index(i, j)]) continue;
                nodes_[index(i, j)].on_surface = false;
                for (const auto& [x, y] : kAround) {
                    if (!inside(i + 2 * x, j + 2 * y) || !kept[index(i + x, j + y)]) continue;
                    const SurfaceSample &near = found[index(i + x, j + y)], &far = found[index(i + 2 * x, j + 2 * y)];
                    const bool goes_on = kept[index(i + 2 * x, j + 2 * y)];
                    const Vec3 on = step_.x * double(-x) * near.right + step_.y * double(-y) * near.down;
                    nodes_[index(i, j)].position = near.position + (goes_on ? near.position - far.position : on);
                    const Vec3 &over_near = over[index(i + x, j + y)], &over_far = over[index(i + 2 * x, j + 2 * y)];
                    over_[index(i, j)] = over_near + (goes_on ? over_near - over_far : on);
                    nodes_[index(i, j)].normal = near.normal;
                    break;
                }
            }
    }

    std::vector<char> find_connected() const {
        std::vector<char> kept(nodes_.size(), 0);
        std::vector<std::pair<int, int>> open;
        double nearest = std::numeric_limits<double>::infinity();
        for (int j = 0; j < n_[1]; ++j)
            for (int i = 0; i < n_[0]; ++i)
                if (const double d = glm::length(flat({i, j})); node(i, j).on_surface && d < nearest)
                    nearest = d, open = {{i, j}};
        const int reach = std::max(1, static_cast<int>(kWidestGap / std::min(step_.x, step_.y)));
        for (const auto& [i, j] : open) kept[index(i, j)] = 1;
        while (!open.empty()) {
            const auto [i, j] = open.back();
            open.pop_back();
            for (const auto& [x, y] : kAround)
                for (int k = 1; k <= reach && inside(i + k * x, j + k * y); ++k) {
                    const SurfaceSample& next = node(i + k * x, j + k * y);
                    if (!next.on_surface || !connected(node(i, j), next, k > 1)) continue;
                    if (char& known = kept[index(i + k * x, j + k * y)]; !known)
                        known = 1, open.emplace_back(i + k * x, j + k * y);
                    break;
                }
        }
        return kept;
    }

    static constexpr std::pair<int, int> kAround[] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                                      {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    bool inside(int i, int j) const { return i >= 0 && j >= 0 && i < n_[0] && j < n_[1]; }
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(n_[0]) + static_cast<std::size_t>(i);
    }

    void build_mesh() {
        for (const SurfaceSample& s : nodes_) {
            mesh_.positions.emplace_back(s.position);
            mesh_.bounds.add(s.position);
        }
        const auto add = [&](int a, int b, int c) {
            const std::array<std::uint32_t, 3> t{std::uint32_t(a), std::uint32_t(b), std::uint32_t(c)};
            const Vec3 &pa = nodes_[t[0]].position, &pb = nodes_[t[1]].position, &pc = nodes_[t[2]].position;
            const bool on = nodes_[t[0]].on_surface || nodes_[t[1]].on_surface || nodes_[t[2]].on_surface;
            if (!on || !(glm::length(glm::cross(pb - pa, pc - pa)) > 0)) return;
            mesh_.triangles.push_back(t);
            for (const std::uint32_t k : t) mesh_.corner_normals.emplace_back(nodes_[k].normal);
            for (const auto& [from, to] : {std::pair(pa, pb), std::pair(pb, pc), std::pair(pc, pa)})
                reach_ = std::max(reach_, std::min(glm::distance(from, to), 2 * glm::length(step_)));
        };
        for (int j = 0; j + 1 < n_[1]; ++j)
            for (int i = 0; i + 1 < n_[0]; ++i) {
                const int k = j * n_[0] + i;
                add(k, k + 1, k + n_[0] + 1);
                add(k, k + n_[0] + 1, k + n_[0]);
            }
        mesh_.neighbours.assign(3 * mesh_.triangles.size(), kNone);
        if (!mesh_.triangles.empty()) query_.emplace(mesh_);
    }

    int n_[2] = {0, 0};
    Vec2 step_{0}, low_{0};
    std::vector<SurfaceSample> nodes_;
    std::vector<Vec3> over_;  // the nodes on the surface that the drawing lies on; metres
    mesh::TriangleMesh mesh_;
    std::optional<mesh::SurfaceQuery> query_;
    double reach_ = 0;  // metres
};

/// Texels of one tile over the grid.
class TileUnfolding {
  public:
    TileUnfolding(const SurfaceGrid& grid, double texel, AreaEdges edges)
        : grid_(grid),
          slack_(0.3 * texel + 0.02 * grid.reach()),
          highest_(edges == AreaEdges::cut ? grid.cut_height() + texel : grid.reach()),
          facing_(edges == AreaEdges::run_over ? kWall : kFacing) {}

    Vec2f at(const Vec3& p, const Vec3& normal) {
        std::optional<SurfaceGrid::Foot> foot = has_last_ ? grid_.foot(p, last_) : std::nullopt;
        if (!foot || !lies(*foot, normal)) {
            const auto near = grid_.query().closest_point(p, grid_.reach());
            if (!near) return Vec2f(kNowhere);
            foot = grid_.foot(p, grid_.cell_of(*near));
            if (!foot || !lies(*foot, normal)) return Vec2f(kNowhere);
        }
        last_ = foot->cell;
        has_last_ = true;
        return Vec2f(grid_.flat(foot->cell));
    }

  private:
    bool lies(const SurfaceGrid::Foot& foot, const Vec3& normal) const {
        const double height = glm::dot(foot.offset, foot.normal);
        return glm::dot(normal, foot.normal) > facing_ && height >= foot.lowest - highest_ &&
               height <= foot.highest + highest_ &&
               glm::length(foot.offset - height * foot.normal) <= slack_ + 0.2 * std::abs(height);
    }

    const SurfaceGrid& grid_;
    double slack_, highest_, facing_;
    Vec2 last_{0};
    bool has_last_ = false;
};

/// Takes `at(tile's shape, texel)` for the texels of charts; tiles without one that is reached are dropped. Only tiles
/// of which `near` holds for a ball round the texels of a cluster are looked at: the others may lie in a file as yet.
template <class Near, class Fill>
std::vector<FlatTexels::Tile> gather_tiles(const Model& model, const Near& near, const Fill& fill) {
    const atlas::TexelMap& map = model.texels;
    std::vector<std::unique_ptr<FlatTexels::Tile>> found(map.n_slots());
    parallel_for(map.n_slots(), 16, [&](std::size_t begin, std::size_t end) {
        atlas::TexelShape buffer;
        for (std::size_t slot = begin; slot < end; ++slot) {
            const std::size_t first = map.cluster_start[slot];
            const auto clusters =
                std::span(model.clusters.clusters).subspan(first, map.cluster_start[slot + 1] - first);
            if (std::ranges::none_of(clusters, [&](const atlas::TexelCluster& c) {
                    return near(Vec3(c.centre), kBallSlack * static_cast<double>(c.radius) + kBallRounding);
                }))
                continue;
            const atlas::TexelShape& shape = atlas::shape_of(map, static_cast<std::uint32_t>(slot), buffer);
            FlatTexels::Tile tile{.slot = static_cast<std::uint32_t>(slot)};
            if (!fill(shape, map.tiles[slot], tile)) continue;
            tile.low = Vec2f(std::numeric_limits<float>::infinity());
            tile.high = -tile.low;
            for (const Vec2f& p : tile.at)
                if (p.x == p.x) tile.low = glm::min(tile.low, p), tile.high = glm::max(tile.high, p);
            if (tile.low.x <= tile.high.x) found[slot] = std::make_unique<FlatTexels::Tile>(tile);
        }
    });
    std::vector<FlatTexels::Tile> tiles;
    for (const auto& tile : found)
        if (tile) tiles.push_back(*tile);
    return tiles;
}

Vec3 position_in(const atlas::TexelShape& s, int t) {
    return {double(s.px[t]), double(s.py[t]), double(s.pz[t])};
}
Vec3 normal_in(const atlas::TexelShape& s, int t) {
    return {double(s.nx[t]), double(s.ny[t]), double(s.nz[t])};
}

/// Whether a ball meets the box round the grid.
bool near_grid(const SurfaceGrid& grid, const Vec3& centre, double radius) {
    return glm::all(glm::lessThanEqual(centre, grid.bounds().hi + grid.reach() + radius)) &&
           glm::all(glm::greaterThanEqual(centre, grid.bounds().lo - grid.reach() - radius));
}

/// Whether a texel of the tile may lie over the grid.
bool reaches(const SurfaceGrid& grid, const atlas::TexelShape& shape, const atlas::TexelTile& tile) {
    Box box;
    for (int t = 0; t < atlas::kTileTexels; ++t)
        if (tile.cluster[t] != atlas::kNoCluster) box.add(position_in(shape, t));
    if (box.empty() || !glm::all(glm::lessThanEqual(box.lo, grid.bounds().hi + grid.reach())) ||
        !glm::all(glm::greaterThanEqual(box.hi, grid.bounds().lo - grid.reach())))
        return false;
    return grid.query().closest_point(box.centre(), 0.5 * box.diagonal() + grid.reach()).has_value();
}

}  // namespace

FlatTexels::FlatTexels(const Model& model, const mesh::SurfaceQuery& surface, const FlatFrame& frame) : frame_(frame) {
    if (frame.placement.mapping == SurfaceMapping::project)
        project(model, surface);
    else
        unfold(model, surface);
}

void FlatTexels::unfold(const Model& model, const mesh::SurfaceQuery& surface) {
    const SurfaceGrid grid(surface, frame_);
    if (grid.empty()) return;
    if (frame_.placement.mapping == SurfaceMapping::drape) lattice_ = grid.lattice();
    const auto near = [&](const Vec3& centre, double radius) { return near_grid(grid, centre, radius); };
    tiles_ = gather_tiles(model, near, [&](const atlas::TexelShape& shape, const atlas::TexelTile& in, Tile& out) {
        if (!reaches(grid, shape, in)) return false;
        TileUnfolding unfolding(grid, model.texels.texel_size, frame_.edges);
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            // There and back by rows: each texel begins beside the last one.
            const int row = t / atlas::kTile, column = t % atlas::kTile;
            const int k = row * atlas::kTile + (row % 2 ? atlas::kTile - 1 - column : column);
            out.at[k] = in.cluster[k] == atlas::kNoCluster ? Vec2f(kNowhere)
                                                           : unfolding.at(position_in(shape, k), normal_in(shape, k));
        }
        return true;
    });
}

void FlatTexels::project(const Model& model, const mesh::SurfaceQuery& surface) {
    const Placement& placement = frame_.placement;
    const Vec2 low = frame_.low, high = frame_.high;
    const AreaEdges edges = frame_.edges;
    const Vec3 outward = glm::normalize(glm::cross(placement.down, placement.right));
    const Axes axes = axes_across(outward, placement.right, placement.down);
    const double facing = edges == AreaEdges::run_over ? kWall : kFacing;
    std::optional<SurfaceGrid> grid;
    if (edges == AreaEdges::cut) grid.emplace(surface, frame_);
    if (grid && grid->empty()) return;
    // With right and down of the other hand the reader is on the other side.
    const double texel = model.texels.texel_size, far = 4 * model.mesh->bounds.diagonal();
    const Vec2 margin(2 * texel);
    const auto near = [&](const Vec3& centre, double radius) {
        const Vec3 d = centre - placement.origin;
        const Vec2 flat(glm::dot(d, axes.right), glm::dot(d, axes.down)), beyond = margin + radius;
        return glm::all(glm::greaterThanEqual(flat, low - beyond)) && glm::all(glm::lessThanEqual(flat, high + beyond));
    };
    tiles_ = gather_tiles(model, near, [&](const atlas::TexelShape& shape, const atlas::TexelTile& in, Tile& out) {
        if (grid && !reaches(*grid, shape, in)) return false;
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            out.at[t] = Vec2f(kNowhere);
            if (in.cluster[t] == atlas::kNoCluster) continue;
            const Vec3 p = position_in(shape, t), n = normal_in(shape, t), d = p - placement.origin;
            const Vec2 flat(glm::dot(d, axes.right), glm::dot(d, axes.down));
            if (glm::any(glm::lessThan(flat, low - margin)) || glm::any(glm::greaterThan(flat, high + margin)))
                continue;
            if (grid && !grid->query().closest_point(p, grid->cut_height() + texel)) continue;
            if (glm::dot(n, outward) <= facing || surface.occluded(p + 2 * texel * n, outward, 0, far)) continue;
            out.at[t] = Vec2f(flat);
        }
        return true;
    });
}

}  // namespace tuft::stroke
