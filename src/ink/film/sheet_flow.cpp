#include "ink/film/sheet_flow.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "ink/film/tile/fibres.h"

namespace tuft::ink::wet {
namespace {

constexpr double kGravity = 9.81, kDensity = 1000;   // m/s², kg/m³
constexpr double kLeastSheetSteepness = 0.1;         // sin α: as for beads
constexpr double kLeastWeight = 0.5;                 // of what enters dry texels: thinner liquid does not get anywhere
constexpr double kLookEvery = 0.25;                  // seconds
constexpr double kMostTexels = 8;                    // that liquid goes in one sweep: less than a tile
constexpr double kRamp = 0.2;                        // of what a line bears: so far about it a column begins to run
constexpr double kRough = 0.2, kRoughLength = 6e-3;  // of what a line bears; metres: so far apart tongues are
constexpr double kDiagonalReach = 1.6;               // of the sides'
constexpr std::size_t kMostSpare = 2;                // times the tiles that matter
constexpr int kMostIterations = 60;

/// A texel's downhill direction and the sides that are open.
struct Around {
    Vec3 here{0}, down{0};        ///< down along the surface, sin α long
    std::array<bool, 4> open{};   ///< right, above, left, below
    std::array<Vec3, 4> there{};  ///< their positions, where open
};
constexpr std::array<std::array<int, 2>, 4> kSides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// The derivative of the position to the right, or upwards; 0: no such neighbour.
Vec3 derivative(const Around& a, std::size_t side) {
    const bool on = a.open[side], back = a.open[side + 2];
    if (on && back) return 0.5 * (a.there[side] - a.there[side + 2]);
    if (on) return a.there[side] - a.here;
    return back ? a.here - a.there[side + 2] : Vec3{0};
}

/// The direction in texels per metre: where a point on the surface goes that goes by `down`.
Vec2 in_texels(const Around& a) {
    const Vec3 x = derivative(a, 0), y = derivative(a, 1);
    const double g11 = glm::dot(x, x), g12 = glm::dot(x, y), g22 = glm::dot(y, y), det = g11 * g22 - g12 * g12;
    const double dx = glm::dot(x, a.down), dy = glm::dot(y, a.down);
    if (!(g11 > 0) && !(g22 > 0)) return {0, 0};
    if (!(g22 > 0)) return {dx / g11, 0};
    if (!(g11 > 0)) return {0, dy / g22};
    if (!(det > 1e-6 * g11 * g22)) return {0, 0};
    return {(g22 * dx - g12 * dy) / det, (g11 * dy - g12 * dx) / det};
}

/// Root w of w + c w³ = all, from above: Newton's method falls towards it.
double thinned(double all, double c) {
    double w = all;
    for (int i = 0; i < kMostIterations; ++i) {
        const double square = c * w * w, next = (all + 2 * square * w) / (1 + 3 * square);
        if (!(next < w)) break;
        w = next;
    }
    return w;
}

/// Orders from the highest to the lowest, then by tile and texel.
std::uint64_t order_key(float elevation, std::uint32_t id) {
    const auto bits = std::bit_cast<std::uint32_t>(-elevation);
    const std::uint32_t ascending = bits >> 31 ? ~bits : bits | 0x80000000u;
    return std::uint64_t{ascending} << 32 | id;
}

class DownhillMaker {
  public:
    DownhillMaker(const TileList& tiles, const Vec3& down, const std::vector<std::uint8_t>& near_seam,
                  std::uint32_t slot)
        : tiles_(tiles), map_(tiles.map), down_(down), near_seam_(near_seam), slot_(slot) {}

    Downhill make() {
        const auto& cluster = map_.tiles[slot_].cluster;
        for (int t = 0; t < kTexels; ++t) {
            out_.start[static_cast<std::size_t>(t)] = static_cast<std::uint16_t>(out_.edges.size());
            if (cluster[t] == atlas::kNoCluster) continue;
            const Around a = look_around(t);
            const double steep = glm::length(a.down);
            out_.elevation[t] = elevation(a.here);
            if (steep < kLeastSheetSteepness) continue;
            out_.steepness[t] = static_cast<float>(steep);
            out_.steep = true;
            out_.roughness[t] = static_cast<float>(1 + kRough * place_noise(a.here, kRoughLength));
            if (near_seam_[slot_ * std::size_t{kTexels} + static_cast<std::size_t>(t)])
                through_faces(t, a);
            else
                through_neighbours(t, a);
        }
        out_.start[kTexels] = static_cast<std::uint16_t>(out_.edges.size());
        return std::move(out_);
    }

  private:
    float elevation(const Vec3& at) const { return static_cast<float>(-glm::dot(down_, at)); }
    const Geometry& geometry() const { return *tiles_.geometry[slot_]; }

    int side_face(int t, std::size_t side) const {
        const int column = t % kSide, row = t / kSide;
        switch (side) {
            case 0:
                return geometry().gx[static_cast<std::size_t>(Geometry::right_of(column, row))];
            case 1:
                return geometry().gy[static_cast<std::size_t>(t + kSide)];
            case 2:
                return geometry().gx[static_cast<std::size_t>(Geometry::right_of(column - 1, row))];
            default:
                return geometry().gy[static_cast<std::size_t>(t)];
        }
    }
    atlas::TexelRef neighbour(int t, int x, int y) const {
        const atlas::TexelPlace place = atlas::texel_place(map_, slot_, static_cast<std::uint32_t>(t));
        return atlas::texel_ref(map_, place.x + x, place.y + y);
    }

    Around look_around(int t) const {
        Around a;
        a.here = Vec3(map_.position(slot_, t));
        const Vec3 n(map_.normal(slot_, t));
        a.down = down_ - n * glm::dot(n, down_);
        for (std::size_t side = 0; side < 4; ++side) {
            if (side_face(t, side) == 0) continue;
            const atlas::TexelRef to = neighbour(t, kSides[side][0], kSides[side][1]);
            if (!to.valid()) continue;
            a.open[side] = true;
            a.there[side] = Vec3(map_.position(to.slot, to.texel));
        }
        return a;
    }

    void add(const atlas::TexelRef& to, double ease) {
        out_.edges.push_back({to.slot, to.texel, static_cast<float>(ease)});
    }
    bool is_lower(const atlas::TexelRef& to, const Vec3& here) const {
        return elevation(Vec3(map_.position(to.slot, to.texel))) < elevation(here);
    }

    /// To the side next to the direction, and to the corner beyond which it lies.
    void through_neighbours(int t, const Around& a) {
        const Vec2 d = in_texels(a);
        const double x = std::abs(d.x), y = std::abs(d.y), most = std::max(x, y);
        if (!(most > 0)) return;
        const std::size_t across = d.x > 0 ? 0 : 2, along = d.y > 0 ? 1 : 3, side = x > y ? across : along;
        const double all = static_cast<double>(map_.tiles[slot_].area[t]) * most, part = std::min(x, y) / most;
        const atlas::TexelRef to = a.open[side] ? neighbour(t, kSides[side][0], kSides[side][1]) : atlas::TexelRef{},
                              corner = neighbour(t, d.x > 0 ? 1 : -1, d.y > 0 ? 1 : -1);
        const bool to_side = to.valid() && is_lower(to, a.here);
        const bool to_corner = part > 0 && corner.valid() && (a.open[across] || a.open[along]) &&
                               is_lower(corner, a.here) && is_near(t, corner, a.here);
        if (to_side) add(to, all * (to_corner ? 1 - part : 1));
        if (to_corner) add(corner, all * (to_side ? part : 1));
    }
    bool is_near(int t, const atlas::TexelRef& to, const Vec3& here) const {
        const auto& free = tiles_.medium().free;
        if (free && passing(free(slot_, t), free(to.slot, to.texel)) == 0) return false;
        return glm::distance(Vec3(map_.position(to.slot, to.texel)), here) <=
               kDiagonalReach * static_cast<double>(std::max(map_.reach[slot_], map_.reach[to.slot]));
    }

    /// By what lies lower, through the cells' faces.
    void through_faces(int t, const Around& a) {
        const auto give = [&](const atlas::TexelRef& to, double conductance) {
            if (!to.valid() || !(conductance > 0)) return;
            const double drop = static_cast<double>(elevation(a.here)) -
                                static_cast<double>(elevation(Vec3(map_.position(to.slot, to.texel))));
            if (drop > 0) add(to, conductance * drop);
        };
        for (std::size_t side = 0; side < 4; ++side)
            if (a.open[side])
                give(neighbour(t, kSides[side][0], kSides[side][1]),
                     side_face(t, side) * static_cast<double>(kConductanceUnit));
        if (const auto& gd = geometry().gd) {
            const int column = t % kSide, row = t / kSide;
            for (const int back : {0, 1}) {
                const int up = (*gd)[static_cast<std::size_t>(Geometry::corner_of(column - back, row - back))],
                          down = -(*gd)[static_cast<std::size_t>(Geometry::corner_of(column - 1 + back, row - back))];
                give(neighbour(t, 1 - 2 * back, 1 - 2 * back), up * static_cast<double>(kDiagonalUnit));
                give(neighbour(t, 2 * back - 1, 1 - 2 * back), down * static_cast<double>(kDiagonalUnit));
            }
        }
        const auto links =
            std::span(tiles_.seams.links)
                .subspan(tiles_.seams.start[slot_], tiles_.seams.start[slot_ + 1] - tiles_.seams.start[slot_]);
        for (const atlas::SeamLink& l : links) {
            if (l.texel != t) continue;
            give({l.other_slot, l.other_texel}, static_cast<double>(l.weight));
        }
    }

    const TileList& tiles_;
    const atlas::TexelMap& map_;
    Vec3 down_;
    const std::vector<std::uint8_t>& near_seam_;
    std::uint32_t slot_;
    Downhill out_;
};

}  // namespace

void SheetFlow::start(const FilmParams& params, const TileList& tiles, bool again) {
    if (params.weight.down != params_.weight.down || downhill_.empty()) {
        downhill_.clear();
        downhill_.resize(tiles.map.n_slots());
    }
    params_ = params;
    if (!again) ran_ = true, waited_ = 0;
    slots_.clear();
}

void SheetFlow::mark_seams(const TileList& tiles) {
    near_seam_.assign(tiles.map.n_slots() * kTexels, 0);
    const auto mark = [&](std::uint32_t slot, int texel) {
        near_seam_[slot * std::size_t{kTexels} + static_cast<std::size_t>(texel)] = 1;
    };
    constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}};
    for (std::uint32_t slot = 0; slot < tiles.map.n_slots(); ++slot) {
        for (std::uint32_t i = tiles.seams.start[slot]; i < tiles.seams.start[slot + 1]; ++i)
            mark(slot, tiles.seams.links[i].texel);
        for (std::uint32_t i = tiles.seams.face_start[slot]; i < tiles.seams.face_start[slot + 1]; ++i) {
            const atlas::SeamFace& f = tiles.seams.faces[i];
            mark(slot, f.texel);
            const atlas::TexelPlace at = atlas::texel_place(tiles.map, slot, f.texel);
            if (const atlas::TexelRef to =
                    atlas::texel_ref(tiles.map, at.x + kSteps[f.direction][0], at.y + kSteps[f.direction][1]);
                to.valid())
                mark(to.slot, to.texel);
        }
    }
}

const Downhill& SheetFlow::downhill(TileList& tiles, std::uint32_t slot) {
    if (!downhill_[slot]) {
        auto& g = tiles.geometry[slot];
        if (!g) g = std::make_unique<Geometry>(make_geometry(tiles.map, tiles.seams, slot, tiles.medium()));
        downhill_[slot] =
            std::make_unique<Downhill>(DownhillMaker(tiles, params_.weight.down, near_seam_, slot).make());
    }
    return *downhill_[slot];
}

/// Those with liquid that may get somewhere, and those around them. Whether they are others than before.
bool SheetFlow::choose_tiles(TileList& tiles) {
    const auto least = static_cast<float>(kLeastWeight * (params_.threshold + params_.pin));
    std::vector<std::uint32_t> slots;
    const auto n = static_cast<std::int64_t>(tiles.map.tiles_per_side);
    for (const Active& tile : tiles.list) {
        if (tile.outcome.most_w < least || !downhill(tiles, tile.slot).steep) continue;
        const std::int64_t at = tiles.map.tile_of_slot[tile.slot], x = at % n, y = at / n;
        for (std::int64_t row = std::max<std::int64_t>(y - 1, 0); row < std::min(y + 2, n); ++row)
            for (std::int64_t column = std::max<std::int64_t>(x - 1, 0); column < std::min(x + 2, n); ++column)
                if (const std::uint32_t slot = tiles.map.slot_of_tile[static_cast<std::size_t>(row * n + column)];
                    slot != kNone)
                    slots.push_back(slot);
        for (const SeamNeighbour& other : tile.seams.others)
            if (other.linked) slots.push_back(other.slot);
    }
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    const bool enough = std::includes(slots_.begin(), slots_.end(), slots.begin(), slots.end());
    if (enough && slots_.size() <= kMostSpare * slots.size()) return false;
    slots_ = std::move(slots);
    return true;
}

void SheetFlow::make_nodes(TileList& tiles) {
    const atlas::TexelMap& map = tiles.map;
    std::vector<std::uint64_t> keys;
    tile_of_.assign(map.n_slots(), kNone);
    for (std::uint32_t i = 0; i < slots_.size(); ++i) {
        tile_of_[slots_[i]] = i;
        const Downhill& from = downhill(tiles, slots_[i]);
        for (std::uint32_t t = 0; t < kTexels; ++t)
            if (map.tiles[slots_[i]].cluster[t] != atlas::kNoCluster)
                keys.push_back(order_key(from.elevation[t], i * kTexels + t));
    }
    std::sort(keys.begin(), keys.end());
    nodes_.clear();
    edges_.clear();
    const double line = params_.weight.hysteresis * params_.ripples.tension;
    for (const std::uint64_t key : keys) {
        const auto id = static_cast<std::uint32_t>(key);
        const std::uint32_t slot = slots_[id / kTexels], texel = id % kTexels;
        const Downhill& from = *downhill_[slot];
        const double grain = static_cast<double>(tiles.geometry[slot]->grain[field_of(static_cast<int>(texel))]);
        Node node{.id = id,
                  .first = static_cast<std::uint32_t>(edges_.size()),
                  .area = map.tiles[slot].area[texel],
                  .steepness = from.steepness[texel],
                  .entry = static_cast<float>(params_.threshold + params_.pin * grain),
                  .line = static_cast<float>(line) * from.roughness[texel]};
        for (std::size_t e = from.start[texel]; e < from.start[texel + 1]; ++e) {
            const Downhill::Edge& edge = from.edges[e];
            const std::uint32_t tile = tile_of_[edge.slot];
            if (tile == kNone) continue;
            edges_.push_back({tile * kTexels + edge.texel, edge.ease,
                              1 / static_cast<double>(map.tiles[edge.slot].area[edge.texel])});
            node.ease += edge.ease;
        }
        node.last = static_cast<std::uint32_t>(edges_.size());
        nodes_.push_back(node);
    }
}

void SheetFlow::load(const Canvas& canvas, int pigments) {
    const auto take = [&](std::vector<double>& to, auto&& plane_of) {
        to.resize(slots_.size() * kTexels);
        for (std::size_t i = 0; i < slots_.size(); ++i) {
            const auto at = to.begin() + static_cast<std::ptrdiff_t>(i * kTexels);
            if (const Plane* plane = plane_of(slots_[i]))
                std::copy(plane->begin(), plane->end(), at);
            else
                std::fill_n(at, kTexels, 0.0);
        }
    };
    take(w_, [&](std::uint32_t slot) { return canvas.liquid(slot, Liquid::film); });
    take(pores_, [&](std::uint32_t slot) { return canvas.liquid(slot, Liquid::pores); });
    pigment_.resize(static_cast<std::size_t>(pigments));
    for (int p = 0; p < pigments; ++p)
        take(pigment_[static_cast<std::size_t>(p)], [&](std::uint32_t slot) { return canvas.plane(slot, p); });
}

/// What hangs on each texel, and from the fronts upwards which of it runs. Whether any does.
bool SheetFlow::find_columns() {
    const double weight = kDensity * kGravity * kFilmUnit, thin = rest();
    load_.assign(w_.size(), 0);
    moves_.assign(w_.size(), 0);
    for (const Node& n : nodes_) {
        if (!(w_[n.id] > thin)) continue;
        load_[n.id] += weight * w_[n.id] * static_cast<double>(n.area) * static_cast<double>(n.steepness);
        if (!(n.ease > 0)) continue;
        const double part = load_[n.id] / static_cast<double>(n.ease);
        for (std::uint32_t e = n.first; e < n.last; ++e)
            if (w_[edges_[e].to] > thin) load_[edges_[e].to] += part * static_cast<double>(edges_[e].ease);
    }
    bool any = false;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        const Node& n = nodes_[i];
        if (!(w_[n.id] > thin) || !(n.ease > 0)) continue;
        const double pull = load_[n.id] * static_cast<double>(n.steepness) / static_cast<double>(n.ease),
                     front = std::clamp((pull / static_cast<double>(n.line) - 1 + kRamp) / (2 * kRamp), 0.0, 1.0);
        double sum = 0;
        for (std::uint32_t e = n.first; e < n.last; ++e)
            sum += static_cast<double>(edges_[e].ease) * (w_[edges_[e].to] > thin ? moves_[edges_[e].to] : front);
        moves_[n.id] = sum / static_cast<double>(n.ease);
        any = any || sum > 0;
    }
    if (any) drag();
    return any;
}

/// What runs takes along what it runs into, beside columns that hold.
void SheetFlow::drag() {
    const double thin = rest();
    came_.assign(w_.size(), {});
    for (const Node& n : nodes_) {
        if (!(w_[n.id] > thin) || !(n.ease > 0)) continue;
        const auto& [ease, moving] = came_[n.id];
        if (ease > 0) moves_[n.id] = std::max(moves_[n.id], moving / ease);
        for (std::uint32_t e = n.first; e < n.last; ++e) {
            const auto part = static_cast<double>(edges_[e].ease);
            came_[edges_[e].to][0] += part;
            came_[edges_[e].to][1] += part * moves_[n.id];
        }
    }
}

/// From the highest texel to the lowest. `rate`: k dt.
void SheetFlow::sweep(double rate, int pigments) {
    const double thin = rest();
    for (const Node& n : nodes_) {
        const double all = w_[n.id], moves = moves_[n.id];
        if (!(all > thin) || !(moves > 0)) continue;
        const double entry = static_cast<double>(n.entry) * static_cast<double>(n.ease);
        const auto enters = [&](const Edge& e) { return all * static_cast<double>(e.ease) > entry || w_[e.to] > 0; };
        double ease = 0;
        for (std::uint32_t e = n.first; e < n.last; ++e)
            if (enters(edges_[e])) ease += static_cast<double>(edges_[e].ease);
        if (!(ease > 0)) continue;
        const auto left =
            static_cast<double>(static_cast<float>(thinned(all, moves * rate * ease / static_cast<double>(n.area))));
        if (!(left < all)) continue;
        const double out = (all - left) * static_cast<double>(n.area) / ease,
                     carried = (all - left) / std::max(all + pores_[n.id], params_.grip);
        for (std::uint32_t e = n.first; e < n.last; ++e) {
            const Edge& edge = edges_[e];
            if (!enters(edge)) continue;
            const double part = static_cast<double>(edge.ease) * edge.per_area;
            if (!(w_[edge.to] > thin)) moves_[edge.to] = std::max(moves_[edge.to], moves);
            for (int p = 0; p < pigments; ++p) {
                auto& pigment = pigment_[static_cast<std::size_t>(p)];
                pigment[edge.to] += part * carried * pigment[n.id] * static_cast<double>(n.area) / ease;
            }
        }
        // Only now: what enters dry texels is decided by what was there.
        for (std::uint32_t e = n.first; e < n.last; ++e)
            if (const Edge& edge = edges_[e]; enters(edge))
                w_[edge.to] += static_cast<double>(edge.ease) * edge.per_area * out;
        for (int p = 0; p < pigments; ++p) pigment_[static_cast<std::size_t>(p)][n.id] *= 1 - carried;
        w_[n.id] = left;
    }
}

std::vector<std::uint32_t> SheetFlow::store(Canvas& canvas, int pigments, const WetFilm::BeforeFn& before) {
    std::vector<std::uint32_t> written;
    runs_.resize(w_.size());
    for (std::size_t i = 0; i < w_.size(); ++i) runs_[i] = moves_[i] > 0;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        const std::size_t first = i * kTexels;
        const auto begin = runs_.begin() + static_cast<std::ptrdiff_t>(first);
        if (std::find(begin, begin + kTexels, 1) == begin + kTexels) continue;
        const std::uint32_t slot = slots_[i];
        written.push_back(slot);
        if (before) before(slot);
        canvas.mark_dirty(slot);
        const auto put = [&](Plane& plane, const std::vector<double>& from) {
            for (std::size_t t = 0; t < kTexels; ++t) plane[t] = static_cast<float>(from[first + t]);
        };
        put(canvas.touch_liquid(slot, Liquid::film), w_);
        for (int p = 0; p < pigments; ++p) {
            const auto& from = pigment_[static_cast<std::size_t>(p)];
            const auto at = from.begin() + static_cast<std::ptrdiff_t>(first);
            if (std::any_of(at, at + kTexels, [](double a) { return a > 0; })) put(canvas.touch(slot, p), from);
        }
    }
    return written;
}

std::vector<std::uint32_t> SheetFlow::run(Canvas& canvas, TileList& tiles, double seconds,
                                          const WetFilm::BeforeFn& before) {
    runs_.clear();
    waited_ += seconds;
    if (!ran_ && waited_ < kLookEvery * (1 - 1e-9)) return {};
    if (near_seam_.empty()) mark_seams(tiles);
    if (choose_tiles(tiles)) make_nodes(tiles);
    waited_ = 0;
    ran_ = false;
    if (slots_.empty()) return {};
    const int pigments = static_cast<int>(canvas.pigments().size());
    load(canvas, pigments);
    ran_ = find_columns();
    if (!ran_) return {};
    const double k = kDensity * kGravity * kFilmUnit * kFilmUnit / (3 * params_.ripples.viscosity);
    double most = 0;
    for (std::size_t i = 0; i < w_.size(); ++i)
        if (moves_[i] > 0) most = std::max(most, w_[i]);
    const double texels = k * most * most * seconds / tiles.map.texel_size;
    const int sweeps = std::max(1, static_cast<int>(std::ceil(texels / kMostTexels)));
    for (int i = 0; i < sweeps; ++i) sweep(k * seconds / sweeps, pigments);
    return store(canvas, pigments, before);
}

bool SheetFlow::runs_at(std::uint32_t slot, int texel) const {
    if (runs_.empty()) return false;
    const auto at = std::lower_bound(slots_.begin(), slots_.end(), slot);
    return at != slots_.end() && *at == slot &&
           runs_[static_cast<std::size_t>(at - slots_.begin()) * kTexels + static_cast<std::size_t>(texel)];
}

}  // namespace tuft::ink::wet
