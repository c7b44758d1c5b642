#include "atlas/texels/border_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

#include "atlas/texels/seams.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

constexpr double kSpacing = 0.5;         // texels between samples of a seam
constexpr double kSearch = 1.9;          // texels from the seam to texels beside it
constexpr double kFarthest = 1.45;       // diagonals of a texel: whoever is farther off has no face with it
constexpr double kReachDiagonals = 3;    // `TexelMap::reach` over that diagonal
constexpr double kGhost = 1.1;           // of a texel's side: where no texel is so near, the surface ends
constexpr double kLeastDistance = 0.35;  // of a texel's side, between texels over a seam: less would ask for steps
                                         // of time too short for all

constexpr double kLeastArea = 0.25, kMostArea = 2;  // of a whole texel: many seams at once
constexpr double kTapRadius = 1.5;                  // of a texel's side
constexpr double kLeastPlane = 0.02;                // of a unit cube's determinant

/// Texel b over the seam as seen from texel a, and the other way round; metres, in their tangent
/// planes. a before b.
struct Crossing {
    TexelRef a, b;
    Vec3f ab{0}, ba{0};
    float path = 0;  ///< metres, from a over the seam to b
};

/// A texel over the seam as seen from one beside it; metres, in its tangent plane.
struct Opposite {
    TexelRef ref;
    Vec3f to{0};
};

/// Orders pairs of texels by slot, then texel. Slots are below 2^20: atlases have 16384² texels at
/// most.
std::uint64_t pair_key(const TexelRef& a, const TexelRef& b) {
    const auto place = [](const TexelRef& t) { return std::uint64_t{t.slot} << 8 | t.texel; };
    return place(a) << 32 | place(b);
}

bool before(const TexelRef& a, const TexelRef& b) {
    return std::tie(a.slot, a.texel) < std::tie(b.slot, b.texel);
}

Vec2 texel_centre(const TexelMap& map, const TexelRef& ref) {
    const TexelPlace at = texel_place(map, ref.slot, ref.texel);
    return {double(at.x) + 0.5, double(at.y) + 0.5};
}

TexelRef texel_off(const TexelMap& map, const TexelRef& ref, int dx, int dy) {
    const Vec2 c = texel_centre(map, ref);
    return texel_ref(map, static_cast<std::int64_t>(c.x) + dx, static_cast<std::int64_t>(c.y) + dy);
}

/// Next to each other inside the atlas, corners included.
bool grid_neighbours(const TexelMap& map, const TexelRef& a, const TexelRef& b) {
    const Vec2 d = glm::abs(texel_centre(map, a) - texel_centre(map, b));
    return std::max(d.x, d.y) < 1.5;
}

/// A texel beside the seam, by its place along it and across it.
struct Beside {
    TexelRef ref;
    double along = 0, across = 0;  ///< metres; across: > 0 on the texel's own side
};

/// One side of a point on a seam.
struct SeamPlace {
    std::uint32_t chart = kNone;
    Vec2 uv{0};                 ///< texels
    Vec3 position{0};           ///< metres
    Vec3 along{0}, inwards{0};  ///< unit, along the seam and into the chart
};

void find_beside(const TexelMap& map, const SeamPlace& place, std::vector<Beside>& found) {
    const auto& [chart, uv, position, along, inwards] = place;
    found.clear();
    const auto x0 = static_cast<std::int64_t>(std::ceil(uv.x - 0.5 - kSearch)),
               x1 = static_cast<std::int64_t>(std::floor(uv.x - 0.5 + kSearch));
    const auto y0 = static_cast<std::int64_t>(std::ceil(uv.y - 0.5 - kSearch)),
               y1 = static_cast<std::int64_t>(std::floor(uv.y - 0.5 + kSearch));
    for (std::int64_t y = y0; y <= y1; ++y)
        for (std::int64_t x = x0; x <= x1; ++x) {
            const Vec2 d = Vec2(double(x) + 0.5, double(y) + 0.5) - uv;
            if (glm::dot(d, d) > kSearch * kSearch) continue;
            const TexelRef ref = texel_ref(map, x, y);
            if (!ref.valid()) continue;
            const std::uint8_t cluster = map.tiles[ref.slot].cluster[ref.texel];
            if (map.cluster_chart[map.cluster_start[ref.slot] + cluster] != chart) continue;
            const Vec3 v = Vec3(map.position(ref.slot, ref.texel)) - position;
            const double reach = kSearch * static_cast<double>(map.reach[ref.slot]);
            if (glm::dot(v, v) > reach * reach) continue;
            const double t = glm::dot(v, along), n = std::sqrt(std::max(0.0, glm::dot(v, v) - t * t));
            found.push_back({ref, t, glm::dot(v, inwards) < 0 ? -n : n});
        }
}

/// In the plane of the triangle, at right angles to its edge, length 1; zero where the triangle is none.
Vec3 inwards_of(const mesh::TriangleMesh& mesh, std::uint32_t triangle, int corner, const Vec3& along) {
    const Vec3 third = mesh.position(triangle, (corner + 2) % 3) - mesh.position(triangle, corner);
    const Vec3 in = third - glm::dot(third, along) * along;
    const double length = glm::length(in);
    return length > 0 ? in / length : Vec3{0};
}

/// Scratch memory of `find_crossings`; one per thread.
struct CrossingScratch {
    std::vector<SeamSample> samples;
    std::array<std::vector<Beside>, 2> beside;
};

/// Adds all pairs of texels over one edge of the mesh.
void find_crossings(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, const SeamEdge& edge,
                    CrossingScratch& scratch, std::vector<Crossing>& found) {
    auto& [samples, beside] = scratch;
    const Vec3 from = mesh.position(edge.triangle_a, edge.corner_a),
               to = mesh.position(edge.triangle_a, (edge.corner_a + 1) % 3);
    const double length = glm::length(to - from);
    if (!(length > 0)) return;
    const Vec3 along = (to - from) / length;
    const Vec3 in_a = inwards_of(mesh, edge.triangle_a, edge.corner_a, along),
               in_b = inwards_of(mesh, edge.triangle_b, edge.corner_b, along);
    samples.clear();
    sample_seam(mesh, atlas, edge, kSpacing, samples);
    for (const SeamSample& s : samples) {
        find_beside(map, {atlas.triangle_chart[edge.triangle_a], s.a.uv, s.position, along, in_a}, beside[0]);
        if (beside[0].empty()) continue;
        find_beside(map, {atlas.triangle_chart[edge.triangle_b], s.b.uv, s.position, along, in_b}, beside[1]);
        for (const Beside& a : beside[0])
            for (const Beside& b : beside[1]) {
                const double along_ab = b.along - a.along, across = a.across + b.across;
                const double farthest = kFarthest / kReachDiagonals *
                                        static_cast<double>(std::min(map.reach[a.ref.slot], map.reach[b.ref.slot]));
                if (along_ab * along_ab + across * across > farthest * farthest || a.ref == b.ref ||
                    grid_neighbours(map, a.ref, b.ref))
                    continue;
                const Vec3f ab(along_ab * along - across * in_a), ba(-along_ab * along - across * in_b);
                const auto path = static_cast<float>(std::hypot(a.along, a.across) + std::hypot(b.along, b.across));
                if (before(a.ref, b.ref))
                    found.push_back({a.ref, b.ref, ab, ba, path});
                else
                    found.push_back({b.ref, a.ref, ba, ab, path});
            }
    }
}

/// Keeps the shortest path of each pair, the first found of equal ones; in order of the pairs.
void retain_shortest(std::vector<Crossing>& crossings) {
    struct Key {
        std::uint64_t pair;
        float path;
        std::uint32_t index;
    };
    std::vector<Key> keys(crossings.size());
    for (std::uint32_t i = 0; i < keys.size(); ++i)
        keys[i] = {pair_key(crossings[i].a, crossings[i].b), crossings[i].path, i};
    std::sort(keys.begin(), keys.end(), [](const Key& x, const Key& y) {
        return std::tie(x.pair, x.path, x.index) < std::tie(y.pair, y.path, y.index);
    });
    keys.erase(std::unique(keys.begin(), keys.end(), [](const Key& x, const Key& y) { return x.pair == y.pair; }),
               keys.end());
    std::vector<Crossing> kept;
    kept.reserve(keys.size());
    for (const Key& k : keys) kept.push_back(crossings[k.index]);
    crossings = std::move(kept);
}

/// The crossings as both of their texels see them.
class Opposites {
  public:
    explicit Opposites(std::vector<Crossing> crossings) : crossings_(std::move(crossings)) {
        sides_.reserve(2 * crossings_.size());
        for (std::uint32_t i = 0; i < crossings_.size(); ++i) {
            const Crossing& c = crossings_[i];
            sides_.push_back({pair_key(c.a, c.b), 2 * i});
            sides_.push_back({pair_key(c.b, c.a), 2 * i + 1});
        }
        std::sort(sides_.begin(), sides_.end(), [](const Side& x, const Side& y) { return x.pair < y.pair; });
        for (std::size_t i = 0; i < sides_.size(); ++i)
            if (i == 0 || sides_[i].pair >> 32 != sides_[i - 1].pair >> 32) start_.push_back(i);
        start_.push_back(sides_.size());
    }

    /// Texels with one over a seam.
    std::size_t n_texels() const { return start_.size() - 1; }

    TexelRef texel(std::size_t i) const {
        const std::uint64_t place = sides_[start_[i]].pair >> 32;
        return {static_cast<std::uint32_t>(place >> 8), static_cast<std::uint8_t>(place & 255)};
    }

    /// Those over seams from texel i.
    void list(std::size_t i, std::vector<Opposite>& over) const {
        over.clear();
        for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) {
            const Crossing& c = crossings_[sides_[k].index / 2];
            if (sides_[k].index % 2 == 0)
                over.push_back({c.b, c.ab});
            else
                over.push_back({c.a, c.ba});
        }
    }

  private:
    struct Side {
        std::uint64_t pair;
        std::uint32_t index;  // twice the crossing's, and one more as b sees it
    };
    std::vector<Crossing> crossings_;
    std::vector<Side> sides_;
    std::vector<std::size_t> start_;
};

/// A convex cell: its corners, and what stands behind the side that starts there.
struct Polygon {
    static constexpr int kMost = 64;
    std::array<Vec2, kMost> corner;
    std::array<int, kMost> behind;
    int n = 0;

    /// Takes away what lies nearer to `site` than to the origin.
    void cut(const Vec2& site, int id) {
        std::array<double, kMost> inside;  // > 0
        const double half = 0.5 * glm::dot(site, site);
        bool all = true;
        for (int i = 0; i < n; ++i) {
            inside[i] = half - glm::dot(corner[i], site);
            all &= inside[i] > 0;
        }
        if (all) return;
        Polygon out;
        for (int i = 0; i < n; ++i) {
            const int next = i + 1 < n ? i + 1 : 0;
            const Vec2 &p = corner[i], &q = corner[next];
            const double a = inside[i], b = inside[next];
            if (a > 0) out.add(p, behind[i]);
            if ((a > 0) != (b > 0)) out.add(p + a / (a - b) * (q - p), a > 0 ? id : behind[i]);
        }
        n = out.n;
        std::copy_n(out.corner.begin(), n, corner.begin());
        std::copy_n(out.behind.begin(), n, behind.begin());
    }
    void add(const Vec2& p, int id) {
        if (n == kMost) return;
        corner[n] = p;
        behind[n++] = id;
    }
    double area() const {
        double twice = 0;
        for (int i = 0; i < n; ++i) {
            const Vec2 &p = corner[i], &q = corner[(i + 1) % n];
            twice += p.x * q.y - p.y * q.x;
        }
        return 0.5 * twice;
    }
};

struct Site {
    Vec2 at{0};    ///< metres
    TexelRef ref;  ///< not valid: a texel that might be there
    bool over = false;
};

struct Frame {
    Vec3 x, y;

    explicit Frame(const Vec3& normal) {
        const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        x = glm::normalize(axis - glm::dot(axis, normal) * normal);
        y = glm::cross(normal, x);
    }
    Vec2 operator()(const Vec3& v) const { return {glm::dot(v, x), glm::dot(v, y)}; }
};

struct Sites {
    std::vector<Site> all;
    std::array<Vec2, 4>
        missing{};  ///< to the sides: where a neighbour of the grid would be; 0: it is there, or nothing is
};

/// The eight of the grid and those over seams; where neither is, whole texels end.
Sites sites_of(const TexelMap& map, const TexelRef& here, std::span<const Opposite> over) {
    const Vec3 position(map.position(here.slot, here.texel));
    const Frame frame(Vec3(map.normal(here.slot, here.texel)));
    const auto reach = static_cast<double>(map.reach[here.slot]);
    constexpr std::array<std::array<int, 2>, 8> kAround{
        {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
    std::array<Site, 8> grid;
    Sites result;
    std::vector<Site>& sites = result.all;
    sites.push_back({Vec2{0}, here});
    for (int i = 0; i < 8; ++i) {
        const TexelRef ref = texel_off(map, here, kAround[i][0], kAround[i][1]);
        if (!ref.valid()) continue;
        const Vec3 apart = Vec3(map.position(ref.slot, ref.texel)) - position;
        const double most = i < 4 ? reach : 1.5 * reach;
        if (glm::dot(apart, apart) > most * most) continue;
        grid[i] = {frame(apart), ref};
        sites.push_back(grid[i]);
    }
    for (const Opposite& o : over) sites.push_back({frame(Vec3(o.to)), o.ref, true});
    const std::size_t real = sites.size();
    for (int i = 0; i < 8; ++i) {
        const Site& across = grid[i ^ 2];
        if (grid[i].ref.valid() || !across.ref.valid()) continue;
        const double near = kGhost * kGhost * glm::dot(across.at, across.at) * (i < 4 ? 1 : 0.5);
        if (std::none_of(sites.begin(), sites.begin() + static_cast<std::ptrdiff_t>(real),
                         [&](const Site& s) { return glm::dot(s.at + across.at, s.at + across.at) < near; }))
            sites.push_back({-across.at, {}});
        else if (i < 4)
            result.missing[i] = -across.at;
    }
    return result;
}

/// Weights of the sites for the value at a place: a plane through those around it by moving least squares.
void tap(const Sites& sites, int side, const TexelRef& here, double scale, std::vector<BorderTap>& taps) {
    const Vec2 at = sites.missing[side];
    if (at == Vec2{0}) return;
    // Normal matrix of 1, x, y.
    std::array<double, 6> m{};
    const auto weight_of = [&](const Vec2& d) {
        const double left = std::max(0.0, 1 - glm::dot(d, d) / (kTapRadius * kTapRadius));
        return left * left;
    };
    const auto offset = [&](const Site& s) { return (s.at - at) / scale; };
    for (const Site& s : sites.all) {
        if (!s.ref.valid()) continue;
        const Vec2 d = offset(s);
        const double w = weight_of(d);
        m[0] += w, m[1] += w * d.x, m[2] += w * d.y, m[3] += w * d.x * d.x, m[4] += w * d.x * d.y,
            m[5] += w * d.y * d.y;
    }
    // First row of its inverse, over the determinant.
    const double c0 = m[3] * m[5] - m[4] * m[4], c1 = m[2] * m[4] - m[1] * m[5], c2 = m[1] * m[4] - m[2] * m[3];
    const double det = m[0] * c0 + m[1] * c1 + m[2] * c2;
    const bool plane = det > kLeastPlane * m[0];
    if (!(m[0] > 0)) return;
    for (const Site& s : sites.all) {
        if (!s.ref.valid()) continue;
        const Vec2 d = offset(s);
        const double w = weight_of(d) * (plane ? (c0 + c1 * d.x + c2 * d.y) / det : 1 / m[0]);
        if (w != 0) taps.push_back({here, s.ref, static_cast<std::uint8_t>(side), w, s.over});
    }
}

struct Cell {
    double area = 0;
    std::vector<BorderTap> taps;
    std::vector<BorderFace> faces;  ///< of this cell: a is its texel
};

/// `only_area`: without taps and faces.
Cell cell_of(const TexelMap& map, const TexelRef& here, std::span<const Opposite> over, bool only_area) {
    const Sites all = sites_of(map, here, over);
    const std::vector<Site>& sites = all.all;
    const double side = std::sqrt(static_cast<double>(map.tiles[here.slot].area[here.texel]));
    Polygon polygon;
    for (const Vec2& corner : {Vec2{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) polygon.add(1.5 * side * corner, -1);
    for (std::size_t i = 0; i < sites.size(); ++i)
        if (glm::dot(sites[i].at, sites[i].at) > 1e-6 * side * side) polygon.cut(sites[i].at, static_cast<int>(i));
    Cell cell;
    cell.area = std::clamp(polygon.area(), kLeastArea * side * side, kMostArea * side * side);
    if (only_area) return cell;
    for (int i = 0; i < polygon.n; ++i) {
        if (polygon.behind[i] < 0) continue;
        const Site& s = sites[polygon.behind[i]];
        if (!s.ref.valid()) continue;
        const double length = glm::length(polygon.corner[(i + 1) % polygon.n] - polygon.corner[i]);
        const double least = s.over ? kLeastDistance * side : 0.0;
        cell.faces.push_back(
            {here, s.ref, length / std::max(glm::length(s.at), least), glm::length(s.at) / side, s.over});
    }
    for (int i = 0; i < 4; ++i) tap(all, i, here, side, cell.taps);
    return cell;
}

std::vector<Crossing> find_all_crossings(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map) {
    const std::vector<SeamEdge> seams = find_seams(mesh, atlas);
    constexpr std::size_t kChunk = 64;
    std::vector<std::vector<Crossing>> by_chunk((seams.size() + kChunk - 1) / kChunk);
    parallel_for(by_chunk.size(), 1, [&](std::size_t begin, std::size_t end) {
        CrossingScratch scratch;
        for (std::size_t chunk = begin; chunk < end; ++chunk) {
            const std::size_t last = std::min(seams.size(), (chunk + 1) * kChunk);
            for (std::size_t e = chunk * kChunk; e < last; ++e)
                find_crossings(mesh, atlas, map, seams[e], scratch, by_chunk[chunk]);
            retain_shortest(by_chunk[chunk]);
            by_chunk[chunk].shrink_to_fit();
        }
    });
    std::vector<Crossing> crossings;
    std::size_t n_crossings = 0;
    for (const auto& c : by_chunk) n_crossings += c.size();
    crossings.reserve(n_crossings);
    for (auto& c : by_chunk) {
        crossings.insert(crossings.end(), c.begin(), c.end());
        c = {};
    }
    retain_shortest(crossings);
    return crossings;
}

/// Stores the faces of all cells, each once. Each cell gives half of its faces: on curved surfaces the two do not quite
/// agree.
void store_faces(const std::vector<std::vector<BorderFace>>& faces, BorderCells& result) {
    const auto is_cell = [&](const TexelRef& t) {
        const auto at = std::lower_bound(result.cells.begin(), result.cells.end(), t,
                                         [](const BorderCell& c, const TexelRef& r) { return before(c.texel, r); });
        return at != result.cells.end() && at->texel == t;
    };
    for (const auto& of : faces)
        for (BorderFace f : of) {
            if (!f.over_seam && !is_cell(f.b)) continue;
            f.conductance *= 0.5;
            f.distance *= 0.5;
            if (before(f.b, f.a)) std::swap(f.a, f.b);
            result.faces.push_back(f);
        }
    const auto key = [](const BorderFace& f) { return std::tie(f.a.slot, f.a.texel, f.b.slot, f.b.texel); };
    std::stable_sort(result.faces.begin(), result.faces.end(),
                     [&](const BorderFace& x, const BorderFace& y) { return key(x) < key(y); });
    std::size_t n = 0;
    for (const BorderFace& f : result.faces) {
        if (n > 0 && key(result.faces[n - 1]) == key(f))
            result.faces[n - 1].conductance += f.conductance, result.faces[n - 1].distance += f.distance;
        else
            result.faces[n++] = f;
    }
    result.faces.resize(n);
}

}  // namespace

BorderCells build_border_cells(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map,
                               bool only_cells) {
    const Opposites opposites(find_all_crossings(mesh, atlas, map));
    BorderCells result;
    result.cells.resize(opposites.n_texels());
    constexpr std::size_t kBlock = 256;
    std::vector<std::vector<BorderFace>> faces((result.cells.size() + kBlock - 1) / kBlock);
    std::vector<std::vector<BorderTap>> taps(faces.size());
    parallel_for(faces.size(), 1, [&](std::size_t begin, std::size_t end) {
        std::vector<Opposite> over;
        for (std::size_t block = begin; block < end; ++block)
            for (std::size_t i = block * kBlock; i < std::min(result.cells.size(), (block + 1) * kBlock); ++i) {
                opposites.list(i, over);
                const TexelRef here = opposites.texel(i);
                const Cell cell = cell_of(map, here, over, only_cells);
                result.cells[i] = {here, cell.area};
                faces[block].insert(faces[block].end(), cell.faces.begin(), cell.faces.end());
                taps[block].insert(taps[block].end(), cell.taps.begin(), cell.taps.end());
            }
    });
    if (only_cells) return result;
    for (const auto& t : taps) result.taps.insert(result.taps.end(), t.begin(), t.end());
    store_faces(faces, result);
    return result;
}

}  // namespace tuft::atlas
