#include "ink/film/sheet_flow.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "ink/film/tile/fibres.h"

namespace tuft::ink::wet {
namespace {

constexpr double kGravity = 9.81, kDensity = 1000;   // m/s², kg/m³
constexpr double kLeastSheetSteepness = 0.1;         // sin α: as for beads
constexpr double kShortRun = 0.05;                   // seconds: as long as a step with beads
constexpr double kLookEvery = 0.25;                  // seconds
constexpr double kMostTexels = 8;                    // that liquid goes in one sweep: less than a tile
constexpr double kMargin = 4;                        // texels more than the thickest liquid goes in a run
constexpr double kRamp = 0.2;                        // of what a line bears: so far about it a column begins to run
constexpr double kRough = 0.2, kRoughLength = 6e-3;  // of what a line bears; metres: so far apart tongues are
constexpr double kDiagonalReach = 1.6;               // of the sides'
constexpr double kBothSides = 5e-3, kWide = 8e-3,
                 kBehind = 3e-3;       // metres: so much more line the sides of a tongue are; half widths
constexpr std::size_t kMostSpare = 2;  // times the tiles that matter
constexpr int kMostIterations = 60;

/// A texel's downhill direction and the sides that are open.
struct Sides {
    Vec3 here{0}, down{0};        ///< down along the surface, sin α long
    std::array<bool, 4> open{};   ///< right, above, left, below
    std::array<Vec3, 4> there{};  ///< their positions, where open
};
constexpr std::array<std::array<int, 2>, 4> kSides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

/// The derivative of the position to the right, or upwards; 0: no such neighbour.
Vec3 derivative(const Sides& a, std::size_t side) {
    const bool on = a.open[side], back = a.open[side + 2];
    if (on && back) return 0.5 * (a.there[side] - a.there[side + 2]);
    if (on) return a.there[side] - a.here;
    return back ? a.here - a.there[side + 2] : Vec3{0};
}

/// A direction on the surface in texels per metre.
Vec2 in_texels(const Sides& a, const Vec3& direction) {
    const Vec3 x = derivative(a, 0), y = derivative(a, 1);
    const double g11 = glm::dot(x, x), g12 = glm::dot(x, y), g22 = glm::dot(y, y), det = g11 * g22 - g12 * g12;
    const double dx = glm::dot(x, direction), dy = glm::dot(y, direction);
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
        : tiles_(tiles),
          map_(tiles.map),
          here_(tiles.medium(), tiles.map.texel_size),
          there_(tiles.medium(), tiles.map.texel_size),
          down_(down),
          near_seam_(near_seam),
          slot_(slot) {}

    Downhill make() {
        const auto& cluster = map_.tiles[slot_].cluster;
        for (int t = 0; t < kTexels; ++t) {
            out_.start[static_cast<std::size_t>(t)] = static_cast<std::uint16_t>(out_.edges.size());
            if (cluster[t] == atlas::kNoCluster) continue;
            const Sides a = look_beside(t);
            const double steep = glm::length(a.down);
            out_.elevation[t] = elevation(a.here);
            if (steep < kLeastSheetSteepness) continue;
            out_.steepness[t] = static_cast<float>(steep);
            const Vec3 across = glm::cross(Vec3(map_.normal(slot_, t)), a.down) / steep;
            out_.across[static_cast<std::size_t>(t)] = Vec2f(in_texels(a, across));
            out_.along[static_cast<std::size_t>(t)] = Vec2f(in_texels(a, a.down / steep));
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

    Sides look_beside(int t) const {
        Sides a;
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

    void add(const atlas::TexelRef& to, double conductance) {
        out_.edges.push_back({to.slot, to.texel, static_cast<float>(conductance)});
    }
    bool is_lower(const atlas::TexelRef& to, const Vec3& here) const {
        return elevation(Vec3(map_.position(to.slot, to.texel))) < elevation(here);
    }

    /// To the side next to the direction, and to the corner beyond which it lies.
    void through_neighbours(int t, const Sides& a) {
        const Vec2 d = in_texels(a, a.down);
        const double x = std::abs(d.x), y = std::abs(d.y), most = std::max(x, y);
        if (!(most > 0)) return;
        const std::size_t across = d.x > 0 ? 0 : 2, along = d.y > 0 ? 1 : 3, side = x > y ? across : along;
        const double all = static_cast<double>(map_.tiles[slot_].area[t]) * most, part = std::min(x, y) / most;
        const atlas::TexelRef to = a.open[side] ? neighbour(t, kSides[side][0], kSides[side][1]) : atlas::TexelRef{},
                              corner = neighbour(t, d.x > 0 ? 1 : -1, d.y > 0 ? 1 : -1);
        const bool to_side = to.valid() && is_lower(to, a.here);
        const bool to_corner = part > 0 && corner.valid() && (a.open[across] || a.open[along]) &&
                               is_lower(corner, a.here) && is_near(t, corner, a.here);
        if (to_side) add(to, all * (to_corner ? 1 - part : 1) * passes(t, to));
        if (to_corner) add(corner, all * (to_side ? part : 1) * passes(t, corner));
    }
    /// Fraction over the edge of a stencil.
    double passes(int t, const atlas::TexelRef& to) const {
        const auto& free = tiles_.medium().free;
        return free ? passing(free(slot_, t), free(to.slot, to.texel)) : 1;
    }
    bool is_near(int t, const atlas::TexelRef& to, const Vec3& here) const {
        if (passes(t, to) == 0) return false;
        return glm::distance(Vec3(map_.position(to.slot, to.texel)), here) <=
               kDiagonalReach * static_cast<double>(std::max(map_.reach[slot_], map_.reach[to.slot]));
    }

    /// By what lies lower, through the cells' faces.
    void through_faces(int t, const Sides& a) {
        const bool uneven = tiles_.medium().unevenness > 0;
        const double root = uneven ? root_of({slot_, static_cast<std::uint8_t>(t)}, here_) : 1;
        const auto give = [&](const atlas::TexelRef& to, double conductance) {
            if (!to.valid() || !(conductance > 0)) return;
            const double drop = static_cast<double>(elevation(a.here)) -
                                static_cast<double>(elevation(Vec3(map_.position(to.slot, to.texel))));
            // Of the faces' conductance; fibres do not slow what is above them.
            if (drop > 0) add(to, conductance * drop / (uneven ? root * root_of(to, there_) : 1));
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

    double root_of(const atlas::TexelRef& at, EaseOfFlow& ease) const {
        return ease.root_at(Vec3(map_.position(at.slot, at.texel)), Vec3(map_.normal(at.slot, at.texel)));
    }

    const TileList& tiles_;
    const atlas::TexelMap& map_;
    EaseOfFlow here_, there_;
    Vec3 down_;
    const std::vector<std::uint8_t>& near_seam_;
    std::uint32_t slot_;
    Downhill out_;
};

}  // namespace

void SheetFlow::start(const FilmParams& params, const TileList& tiles, bool again) {
    const auto numbers = [](const FilmParams& p) {
        return std::array{p.threshold, p.pin, p.weight.hysteresis, p.ripples.tension};
    };
    if (!(params.weight.hysteresis > 0)) {
        if (params_.weight.hysteresis > 0) release();
        params_ = params;
        return;
    }
    if (params.weight.down != params_.weight.down || tiles.faces_version() != faces_version_ || downhill_.empty()) {
        downhill_.clear();
        downhill_.resize(tiles.map.n_slots());
        steep_.assign(tiles.map.n_slots(), 0);
        slots_.clear();
    }
    if (!again || numbers(params) != numbers(params_)) slots_.clear();
    faces_version_ = tiles.faces_version();
    params_ = params;
    if (!again) ran_ = true, waited_ = 0;
}

void SheetFlow::release() {
    downhill_.clear();
    slots_ = {};
    nodes_ = {};
    edges_ = {};
    wet_ = {};
    w_ = pores_ = weight_on_ = mobile_ = {};
    inflow_ = {};
    pigment_ = {};
    runs_ = changed_ = {};
}

double SheetFlow::rate() const {
    return kDensity * kGravity * kFilmUnit * kFilmUnit / (3 * params_.ripples.viscosity);
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

bool SheetFlow::is_steep(TileList& tiles, std::uint32_t slot) {
    if (steep_[slot] == 0) {
        steep_[slot] = 1;
        for (int t = 0; t < kTexels && steep_[slot] == 1; ++t)
            if (tiles.map.tiles[slot].cluster[t] != atlas::kNoCluster &&
                glm::length(glm::cross(Vec3(tiles.map.normal(slot, t)), params_.weight.down)) >= kLeastSheetSteepness)
                steep_[slot] = 2;
    }
    return steep_[slot] == 2;
}

/// Those with liquid that may run, and those around them that it may reach. Whether they are others than before.
bool SheetFlow::choose_tiles(TileList& tiles, double seconds) {
    const atlas::TexelMap& map = tiles.map;
    std::vector<std::uint32_t> slots;
    double most = 0;
    for (const Active& tile : tiles.list) {
        if (!(static_cast<double>(tile.outcome.most_w) > rest()) || !is_steep(tiles, tile.slot)) continue;
        slots.push_back(tile.slot);
        most = std::max(most, static_cast<double>(tile.outcome.most_w));
    }
    const double texels = rate() * most * most * seconds / map.texel_size;
    const auto n = static_cast<std::int64_t>(map.tiles_per_side);
    marked_.resize(map.n_slots(), 0);
    for (const std::uint32_t slot : slots) marked_[slot] = 1;
    const auto add = [&](std::uint32_t slot) {
        if (slot != kNone && !std::exchange(marked_[slot], std::uint8_t{1})) slots.push_back(slot);
    };
    std::size_t from = 0;
    for (double reached = 0; from < slots.size() && reached <= texels + kMargin; reached += kSide) {
        const std::size_t to = slots.size();
        for (; from < to; ++from) {
            const std::int64_t at = map.tile_of_slot[slots[from]], x = at % n, y = at / n;
            for (std::int64_t row = std::max<std::int64_t>(y - 1, 0); row < std::min(y + 2, n); ++row)
                for (std::int64_t column = std::max<std::int64_t>(x - 1, 0); column < std::min(x + 2, n); ++column)
                    add(map.slot_of_tile[static_cast<std::size_t>(row * n + column)]);
            const std::uint32_t slot = slots[from];
            for (std::uint32_t l = tiles.seams.start[slot]; l < tiles.seams.start[slot + 1]; ++l)
                add(tiles.seams.links[l].other_slot);
        }
    }
    for (const std::uint32_t slot : slots) marked_[slot] = 0;
    std::sort(slots.begin(), slots.end());
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
            edges_.push_back({.to = tile * kTexels + edge.texel,
                              .conductance = edge.conductance,
                              .level = downhill_[edge.slot]->steepness[edge.texel] == 0,
                              .per_area = 1 / static_cast<double>(map.tiles[edge.slot].area[edge.texel])});
            node.conductance += edge.conductance;
        }
        node.last = static_cast<std::uint32_t>(edges_.size());
        nodes_.push_back(node);
    }
}

void SheetFlow::read_planes(const Canvas& canvas, int pigments) {
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
bool SheetFlow::find_columns(const TileList& tiles) {
    const double weight = kDensity * kGravity * kFilmUnit, thin = rest();
    weight_on_.assign(w_.size(), 0);
    mobile_.assign(w_.size(), 0);
    wet_.clear();
    for (std::uint32_t i = 0; i < nodes_.size(); ++i)
        if (w_[nodes_[i].id] > thin) wet_.push_back(i);
    for (const std::uint32_t i : wet_) {
        const Node& n = nodes_[i];
        weight_on_[n.id] += weight * w_[n.id] * static_cast<double>(n.area) * static_cast<double>(n.steepness);
        if (!(n.conductance > 0)) continue;
        const double part = weight_on_[n.id] / static_cast<double>(n.conductance);
        for (std::uint32_t e = n.first; e < n.last; ++e)
            if (w_[edges_[e].to] > thin) weight_on_[edges_[e].to] += part * static_cast<double>(edges_[e].conductance);
    }
    bool any = false;
    for (std::size_t i = wet_.size(); i-- > 0;) {
        const Node& n = nodes_[wet_[i]];
        if (!(n.conductance > 0)) continue;
        double sum = 0, dry = 0;
        for (std::uint32_t e = n.first; e < n.last; ++e) {
            const auto conductance = static_cast<double>(edges_[e].conductance);
            if (w_[edges_[e].to] > thin)
                sum += conductance * edge_moves(edges_[e], 0);
            else
                dry += conductance;
        }
        if (dry > 0) sum += dry * front_moves(tiles, n);
        mobile_[n.id] = sum / static_cast<double>(n.conductance);
        any = any || sum > 0;
    }
    if (any) drag();
    return any;
}

/// 0–1: whether liquid goes through an edge; `front`: where it is dry.
double SheetFlow::edge_moves(const Edge& edge, double front) const {
    return !(w_[edge.to] > rest()) ? front : edge.level ? 1 : mobile_[edge.to];
}

/// 0–1: whether a line next to dry surface gives way to what hangs on it.
double SheetFlow::front_moves(const TileList& tiles, const Node& n) const {
    const double pull = weight_on_[n.id] * static_cast<double>(n.steepness) / static_cast<double>(n.conductance);
    const auto gives = [&](double line) { return std::clamp((pull / line - 1 + kRamp) / (2 * kRamp), 0.0, 1.0); };
    const auto line = static_cast<double>(n.line);
    return gives(line) > 0 ? gives(line * (1 + kBothSides / width(tiles, n))) : 0;
}

/// Metres through liquid from a texel on along `direction`, texels per metre; `most` where it does not end before.
double SheetFlow::through_liquid(const TileList& tiles, const atlas::TexelPlace& from, const Vec2& direction,
                                 double most) const {
    const double texels = std::max(std::abs(direction.x), std::abs(direction.y));
    double reached = 0;
    for (int i = 1; i / texels < most; ++i) {
        const Vec2 by = i / texels * direction;
        const atlas::TexelRef at = atlas::texel_ref(tiles.map, from.x + std::lround(by.x), from.y + std::lround(by.y));
        const std::uint32_t tile = at.valid() ? tile_of_[at.slot] : kNone;
        if (tile == kNone) return most;  // a seam, or far from here: as if it went on
        if (!(w_[tile * kTexels + at.texel] > rest())) return reached;
        reached = i / texels;
    }
    return most;
}

/// Metres of liquid across the stream a little behind the front, up to 2 kWide.
double SheetFlow::width(const TileList& tiles, const Node& n) const {
    const Downhill& from = *downhill_[slots_[n.id / kTexels]];
    const Vec2 across(from.across[n.id % kTexels]), down(from.along[n.id % kTexels]);
    if (!(glm::dot(across, across) > 0 && glm::dot(down, down) > 0)) return 2 * kWide;
    atlas::TexelPlace place = atlas::texel_place(tiles.map, slots_[n.id / kTexels], n.id % kTexels);
    const Vec2 by = -through_liquid(tiles, place, -down, kBehind) * down;
    place.x += std::lround(by.x), place.y += std::lround(by.y);
    return through_liquid(tiles, place, across, kWide) + through_liquid(tiles, place, -across, kWide) +
           tiles.map.texel_size;
}

/// What runs takes along what it runs into, beside columns that hold.
void SheetFlow::drag() {
    inflow_.assign(w_.size(), {});
    for (const std::uint32_t i : wet_) {
        const Node& n = nodes_[i];
        if (!(n.conductance > 0)) continue;
        const auto& [in, moving] = inflow_[n.id];
        if (in > 0) mobile_[n.id] = std::max(mobile_[n.id], moving / in);
        for (std::uint32_t e = n.first; e < n.last; ++e) {
            const auto part = static_cast<double>(edges_[e].conductance);
            inflow_[edges_[e].to][0] += part;
            inflow_[edges_[e].to][1] += part * mobile_[n.id];
        }
    }
}

/// From the highest texel to the lowest. `rate`: k dt.
void SheetFlow::sweep(double rate, int pigments) {
    const double thin = rest();
    std::vector<std::pair<const Edge*, double>> through;  // edges, and m · conductance
    for (const Node& n : nodes_) {
        const double all = w_[n.id], moves = mobile_[n.id], area = n.area;
        if (!(all > thin) || !(moves > 0)) continue;
        through.clear();
        double conductance = 0;
        for (std::uint32_t e = n.first; e < n.last; ++e) {
            const Edge& edge = edges_[e];
            if (!(w_[edge.to] > 0) && !(all > static_cast<double>(n.entry))) continue;
            through.emplace_back(&edge, static_cast<double>(edge.conductance) * edge_moves(edge, moves));
            conductance += through.back().second;
        }
        if (!(conductance > 0)) continue;
        const auto left = static_cast<double>(static_cast<float>(thinned(all, rate * conductance / area)));
        if (!(left < all)) continue;
        const double carried = (all - left) / std::max(all + pores_[n.id], params_.grip);
        for (const auto& [edge, part] : through) {
            const double taken = part / conductance * area * edge->per_area;  // film units there over one here
            changed_[edge->to / kTexels] = 1;
            if (!(w_[edge->to] > thin)) mobile_[edge->to] = std::max(mobile_[edge->to], moves);
            w_[edge->to] += taken * (all - left);
            for (int p = 0; p < pigments; ++p) {
                auto& pigment = pigment_[static_cast<std::size_t>(p)];
                pigment[edge->to] += taken * carried * pigment[n.id];
            }
        }
        for (int p = 0; p < pigments; ++p) pigment_[static_cast<std::size_t>(p)][n.id] *= 1 - carried;
        w_[n.id] = left;
        changed_[n.id / kTexels] = 1;
    }
}

std::vector<std::uint32_t> SheetFlow::store(Canvas& canvas, int pigments, const WetFilm::BeforeFn& before) {
    std::vector<std::uint32_t> written;
    runs_.resize(w_.size());
    for (std::size_t i = 0; i < w_.size(); ++i) runs_[i] = mobile_[i] > 0;
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        const std::size_t first = i * kTexels;
        if (!changed_[i]) continue;
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
    fast_ = false;
    if (!(params_.weight.hysteresis > 0)) return {};
    waited_ += seconds;
    if (!ran_ && waited_ < kLookEvery * (1 - 1e-9)) return {};
    if (near_seam_.empty()) mark_seams(tiles);
    // Where none ran the last time, none moved in what has passed, and steps may have been long.
    seconds = std::min(seconds, ran_ ? kLookEvery : kShortRun);
    if (choose_tiles(tiles, seconds)) make_nodes(tiles);
    waited_ = 0;
    ran_ = false;
    if (slots_.empty()) return {};
    const int pigments = static_cast<int>(canvas.pigments().size());
    read_planes(canvas, pigments);
    ran_ = find_columns(tiles);
    if (!ran_) return {};
    double most = 0;
    for (std::size_t i = 0; i < w_.size(); ++i)
        if (mobile_[i] > 0) most = std::max(most, w_[i]);
    const double texels = rate() * most * most * seconds / tiles.map.texel_size;
    fast_ = texels > 1;
    changed_.assign(slots_.size(), 0);
    const int sweeps = std::max(1, static_cast<int>(std::ceil(texels / kMostTexels)));
    for (int i = 0; i < sweeps; ++i) sweep(rate() * seconds / sweeps, pigments);
    return store(canvas, pigments, before);
}

bool SheetFlow::runs_at(std::uint32_t slot, int texel) const {
    if (runs_.empty()) return false;
    const auto at = std::lower_bound(slots_.begin(), slots_.end(), slot);
    return at != slots_.end() && *at == slot &&
           runs_[static_cast<std::size_t>(at - slots_.begin()) * kTexels + static_cast<std::size_t>(texel)];
}

}  // namespace tuft::ink::wet
