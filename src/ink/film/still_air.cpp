#include "ink/film/still_air.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "core/random.h"
#include "core/simd.h"
#include "core/system/parallel.h"
#include "ink/elementary.h"

namespace tuft::ink::wet {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kCube = 1.5e-3f;  // metres: rims of drops and lines show in less
constexpr float kRoot2 = 1.4142136f;
constexpr float kReach = 1.5f;    // cubes over which what patches give off is shared out
constexpr double kEnough = 1e-6;  // of the first residual's square: the sum's error is as small as that
constexpr int kMostRounds = 60;
constexpr float kLeastBulge = 1e-4f;
constexpr std::size_t kGrain = 8;   // tiles
constexpr double kSeconds = 4;      // for which factors hold, where they are 1
constexpr double kLeastAge = 0.25;  // s: factors are not looked for more often, however wet areas grow
constexpr double kGrown = 1.25;     // tiles, over those of before
// Steps are doubled while less than these parts of what the rates say dry in them, in the mean and at most.
constexpr double kAsFast = 1.4, kFastest = 8, kSlowest = 16;
constexpr float kBlockPart = 0.4f;  // of a cube: blocks are smaller, by which its inside is resolved
// A charge that lies evenly on a square of side 1 has the mean potential kSquare, in units of which one at its middle
// has 1 / (2 π r); on a disc kEven times that of one that finds its own place, 1 / 4 R. Between two squares it is
// higher than between their middles by kNear (s / r)²: with it, the potential of a square follows from its quarters'.
// Of patches beside each other: kWide follows from two lines end to end, 2 ln 2 / r; squares side by side, 1.12 / r,
// have it too. Where they overlap it is as of lines at most.
constexpr float kWide = 12, kWidest = 0.15f;
constexpr double kSquare = 0.4732, kEven = 1.081, kNear = 0.113;
constexpr double kSpread = 6;            // side of a square squared, over the mean square of distances from its middle
constexpr float kSmooth = 1.2f * kCube;  // radius of tiles whose factors follow from those at their corners

/// Column j of K.
TUFT_CLONES void column_of(float* __restrict k, const VapourPatches& patches, std::size_t j, float thickness) {
    const std::size_t n = patches.size();
    const float *x = patches.x.data(), *y = patches.y.data(), *z = patches.z.data();
    const float *nx = patches.nx.data(), *ny = patches.ny.data(), *nz = patches.nz.data(),
                *radius = patches.radius.data();
    const float *xx = patches.xx.data(), *yy = patches.yy.data(), *zz = patches.zz.data(), *xy = patches.xy.data(),
                *yz = patches.yz.data(), *zx = patches.zx.data();
    const float x1 = x[j], y1 = y[j], z1 = z[j], u = nx[j], v = ny[j], w = nz[j], radius1 = radius[j];
    const float xx1 = xx[j], yy1 = yy[j], zz1 = zz[j], xy1 = xy[j], yz1 = yz[j], zx1 = zx[j];
    const float screen = 1 / (2 * kPi * thickness);
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) {
        const float dx = x[i] - x1, dy = y[i] - y1, dz = z[i] - z1;
        const float square = dx * dx + dy * dy + dz * dz + 1e-20f;
        const float far = 4 * kPi * kPi * square, near = 16 * radius[i] * radius1;
        const float plane = 1 / std::sqrt(std::sqrt(far * far + near * near));
        const float all = (xx[i] + xx1) + (yy[i] + yy1) + (zz[i] + zz1);
        const float along = ((xx[i] + xx1) * dx * dx + (yy[i] + yy1) * dy * dy + (zz[i] + zz1) * dz * dz +
                             2 * ((xy[i] + xy1) * dx * dy + (yz[i] + yz1) * dy * dz + (zx[i] + zx1) * dz * dx)) /
                            square;
        const float wide = smaller((3 * along - all) / (2 * (square + all)), kWidest), more = positive(wide);
        const float bulge = dx * (nx[i] - u) + dy * (ny[i] - v) + dz * (nz[i] - w);
        const float q = smaller(larger(bulge / (2 * std::sqrt(square)), kLeastBulge), 1);
        const float over_plane = plane * (1 + wide + kWide * more * more);
        k[i] = over_plane * (1 - q * log_of(1 + 1 / q)) * exp_minus(screen / over_plane);
    }
    const float own = 1 / (4 * radius1), wide_by = kPi * radius1 / (2 * thickness);
    k[j] = own * larger(exp_minus(screen / own), 2 / wide_by * (1 - 1 / wide_by));
}

TUFT_CLONES void add_column(float* __restrict to, const float* __restrict k, float part, std::size_t n) {
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) to[i] += k[i] * part;
}

/// Adds what a patch has at (x, y, z) to the texels near by.
TUFT_CLONES void add_patch(float* __restrict flux, float* __restrict rate, const atlas::TexelShape& shape,
                           const std::array<float, 3>& at, float over_square, float patch_flux, float patch_rate) {
    const float *px = shape.px.data(), *py = shape.py.data(), *pz = shape.pz.data();
    const float x = at[0], y = at[1], z = at[2];
#pragma GCC ivdep
    for (int t = 0; t < kTexels; ++t) {
        const float dx = px[t] - x, dy = py[t] - y, dz = pz[t] - z;
        const float inside = positive(1 - (dx * dx + dy * dy + dz * dz) * over_square);
        flux[t] += patch_flux * (inside * inside);
        rate[t] += patch_rate * (inside * inside);
    }
}

/// From the values at the corner texels.
TUFT_CLONES void fill_tile(float* __restrict out, const std::array<float, 4>& at) {
    constexpr float kPart = 1.0f / (kSide - 1);
    for (int row = 0; row < kSide; ++row) {
        const float up = static_cast<float>(row) * kPart;
        const float left = at[0] + (at[2] - at[0]) * up, right = at[1] + (at[3] - at[1]) * up;
        const float slope = (right - left) * kPart;
        for (int x = 0; x < kSide; ++x) out[row * kSide + x] = left + slope * static_cast<float>(x);
    }
}

double product(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

double own_potential(double area) {
    return kSquare / std::sqrt(area);
}
/// Between two charges of `spread` s², each with the potential `own` of its own.
double potential(double square, double spread_a, double spread_b, double own_a, double own_b) {
    square = std::max(square, 1e-12);
    const double far = (1 + kNear * 0.5 * (spread_a + spread_b) / square) / (2 * std::numbers::pi * std::sqrt(square));
    return std::min(far, std::sqrt(own_a * own_b));
}
double square_of(const Vec3& a) {
    return glm::dot(a, a);
}

}  // namespace

std::vector<float> still_air_fluxes(const VapourPatches& patches, float thickness) {
    const std::size_t n = patches.size();
    std::vector<float> k(n * n), flux(n, 0.0f), missing(n, 1.0f), scaled(n), direction(n), changed(n);
    for (std::size_t j = 0; j < n; ++j) column_of(&k[j * n], patches, j, thickness);
    const auto scale = [&] {
        for (std::size_t i = 0; i < n; ++i) scaled[i] = missing[i] / k[i * n + i];
        return product(missing, scaled);
    };
    double size = scale();
    direction = scaled;
    const double enough = kEnough * size;
    for (int round = 0; round < kMostRounds && size > enough; ++round) {
        std::fill(changed.begin(), changed.end(), 0.0f);
        for (std::size_t j = 0; j < n; ++j) add_column(changed.data(), &k[j * n], direction[j], n);
        const double bend = product(direction, changed);
        if (!(bend > 0)) break;
        add_column(flux.data(), direction.data(), static_cast<float>(size / bend), n);
        add_column(missing.data(), changed.data(), static_cast<float>(-size / bend), n);
        const double before = size;
        size = scale();
        const auto part = static_cast<float>(size / before);
        for (std::size_t i = 0; i < n; ++i) direction[i] = scaled[i] + part * direction[i];
    }
    for (float& f : flux) f = std::max(f, 0.0f);
    return flux;
}

std::size_t StillAir::KeyHash::operator()(const Key& k) const {
    std::uint64_t h = k.side;
    for (const std::int32_t c : k.cube) h = hash_bits(h, static_cast<std::uint64_t>(static_cast<std::int64_t>(c)));
    return h;
}

void StillAir::start(const FilmParams& params, const atlas::TexelMap& map) {
    params_ = params;
    used_ = params.drying.vapour > 0 && params.drying.still_air > 0 && params.drying.evaporation > 0;
    if (!used_) return forget();
    places_.resize(map.n_slots());
    planes_.resize(map.n_slots());
    factors_.resize(map.n_slots());
}

void StillAir::forget() {
    factors_.clear();
    found_ = false;
    slower_ = 1;
}

const float* StillAir::of(std::uint32_t slot, Plane& buffer) const {
    if (!used_ || factors_[slot].kind == Kind::unknown) return nullptr;
    if (factors_[slot].kind == Kind::plane) return planes_[slot]->data();
    fill_tile(buffer.data(), factors_[slot].at);
    return buffer.data();
}

const StillAir::Place& StillAir::place_of(const atlas::TexelMap& map, std::uint32_t slot) {
    if (places_[slot]) return *places_[slot];
    places_[slot] = std::make_unique<Place>();
    Place& place = *places_[slot];
    atlas::TexelShape buffer;
    const atlas::TexelShape& shape = atlas::shape_of(map, slot, buffer);
    const auto& cluster = map.tiles[slot].cluster;
    const auto at = [&](int t) { return Vec3f(shape.px[t], shape.py[t], shape.pz[t]); };
    constexpr std::array kCorners{0, kSide - 1, kTexels - kSide, kTexels - 1};
    for (std::size_t i = 0; i < 4; ++i) place.corners[i] = at(kCorners[i]);
    place.radius = -1;
    Vec3f low{0}, high{0};
    for (int t = 0; t < kTexels; ++t) {
        if (cluster[t] == atlas::kNoCluster) continue;
        low = place.radius < 0 ? at(t) : glm::min(low, at(t));
        high = place.radius < 0 ? at(t) : glm::max(high, at(t));
        place.radius = 0;
    }
    place.middle = 0.5f * (low + high);
    if (!(place.radius < 0)) place.radius = glm::length(0.5f * (high - low));
    place.smooth =
        place.radius < kSmooth && std::all_of(cluster.begin(), cluster.end(), [](std::uint8_t c) { return c == 0; });
    return place;
}

/// What each texel of a tile that is wet gives off by its rate, film · m²/s; 0 where there is no liquid.
void StillAir::find_rates(const TileList& tiles, std::span<const Sources> sources, const Active& tile,
                          Plane& rates) const {
    const auto gather_liquid = [&](Field& field, std::size_t k) {
        static constexpr Plane kDry{};
        std::array<const float*, 9> planes;
        bool any = false;
        for (std::size_t i = 0; i < 9; ++i) {
            const Plane* plane = tile.around[i] == kNone ? nullptr : sources[tile.around[i]].liquid[k];
            any = any || plane;
            planes[i] = (plane ? plane : &kDry)->data();
        }
        if (any) gather_field(field, planes);
        return any;
    };
    Field total, pores;
    if (!gather_liquid(total, 0)) total.fill(0);
    if (gather_liquid(pores, 1))
        for (std::size_t k = 0; k < total.size(); ++k) total[k] += pores[k];
    const FilmDrying& drying = params_.drying;
    rates.fill(0);
    if (drying.rim_evaporation > 0)
        rim_slopes(rates.data(), total, *tile.faces.geometry, static_cast<float>(drying.rim_depth));
    const auto even = static_cast<float>(drying.evaporation);
    const auto rim = static_cast<float>(drying.rim_evaporation / (tiles.map.texel_size * drying.rim_depth));
    const atlas::TexelTile& texels = tiles.map.tiles[tile.slot];
    for (int row = 0; row < kSide; ++row)
        for (int x = 0; x < kSide; ++x) {
            const int t = row * kSide + x;
            rates[t] = total[field_at(x, row)] > 0 ? (even + rim * rates[t]) * texels.area[t] : 0.0f;
        }
}

/// Sets a tile's blocks and the shares of its rates.
void StillAir::look_at(const TileList& tiles, std::span<const Sources> sources, std::size_t index) {
    const Active& active = tiles.list[index];
    Tile& tile = tiles_[index];
    tile.blocks.clear();
    tile.shares.fill(0);
    const Place& place = place_of(tiles.map, active.slot);
    if (!active.wet() || !active.faces.geometry) return;
    Plane own;
    if (!place.smooth && !planes_[active.slot]) planes_[active.slot] = std::make_unique<Plane>();
    Plane& rates = place.smooth ? own : *planes_[active.slot];
    find_rates(tiles, sources, active, rates);
    atlas::TexelShape buffer;
    const atlas::TexelShape& shape = atlas::shape_of(tiles.map, active.slot, buffer);
    const atlas::TexelTile& texels = tiles.map.tiles[active.slot];
    // Blocks by cluster: charts that meet in a tile lie apart.
    const int across = kSide / side_, per_cluster = across * across;
    std::vector<Block>& blocks = tile.blocks;
    constexpr float kPart = 1.0f / (kSide - 1);
    for (int row = 0; row < kSide; ++row) {
        float sum = 0, moment = 0;
        for (int x = 0; x < kSide; ++x) {
            const int t = row * kSide + x;
            if (!(rates[t] > 0)) continue;
            const std::size_t cluster = texels.cluster[t], b = cluster * per_cluster + row / side_ * across + x / side_;
            if (blocks.size() <= b) blocks.resize((cluster + 1) * per_cluster);
            Block& block = blocks[b];
            const float area = texels.area[t];
            block.area += area;
            block.rate += rates[t];
            block.at += area * Vec3f(shape.px[t], shape.py[t], shape.pz[t]);
            block.normal += area * Vec3f(shape.nx[t], shape.ny[t], shape.nz[t]);
            sum += rates[t];
            moment += rates[t] * (static_cast<float>(x) * kPart);
        }
        const auto up = static_cast<double>(static_cast<float>(row) * kPart);
        const double right = moment, left = static_cast<double>(sum) - right;
        tile.shares[0] += left * (1 - up), tile.shares[1] += right * (1 - up);
        tile.shares[2] += left * up, tile.shares[3] += right * up;
    }
    std::erase_if(blocks, [](const Block& b) { return !(b.area > 0); });
    for (Block& b : blocks) b.at /= b.area;
}

StillAir::Key StillAir::key_of(const Block& block, float cube) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(block.normal[i]) > std::abs(block.normal[axis])) axis = i;
    Key key{.cube = {}, .side = static_cast<std::uint8_t>(2 * axis + (block.normal[axis] > 0))};
    for (int i = 0; i < 3; ++i)
        key.cube[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(std::floor(block.at[i] / cube));
    return key;
}

/// Sets a tile's pieces.
void StillAir::cut(Tile& tile, float cube) {
    tile.pieces.clear();
    std::vector<std::uint32_t> piece_of(tile.blocks.size());
    for (std::size_t i = 0; i < tile.blocks.size(); ++i) {
        const Block& b = tile.blocks[i];
        const Key key = key_of(b, cube);
        std::uint32_t at = 0;
        while (at < tile.pieces.size() && !(tile.pieces[at].key == key)) ++at;
        if (at == tile.pieces.size()) tile.pieces.push_back({.key = key});
        Piece& piece = tile.pieces[at];
        const auto area = static_cast<double>(b.area);
        piece_of[i] = at;
        piece.area += area;
        piece.rate += static_cast<double>(b.rate);
        piece.at += area * Vec3(b.at);
        piece.normal += Vec3(b.normal);
    }
    for (Piece& piece : tile.pieces) piece.at /= piece.area;
    for (std::size_t i = 0; i < tile.blocks.size(); ++i) {
        const Block& a = tile.blocks[i];
        Piece& piece = tile.pieces[piece_of[i]];
        const auto area = static_cast<double>(a.area);
        const double own = own_potential(area);
        piece.energy += area * area * own;
        const Vec3 d = Vec3(a.at) - piece.at;
        const std::array<double, 6> squares{d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x};
        for (std::size_t k = 0; k < 6; ++k) piece.squares[k] += area / piece.area * squares[k];
        piece.spread += area / piece.area * (area + kSpread * square_of(d));
        for (std::size_t j = 0; j < i; ++j) {
            if (piece_of[j] != piece_of[i]) continue;
            const Block& b = tile.blocks[j];
            const auto other = static_cast<double>(b.area);
            piece.energy += 2 * area * other *
                            potential(square_of(Vec3(a.at) - Vec3(b.at)), area, other, own, own_potential(other));
        }
    }
}

/// Of a patch with its middle at `at`.
void StillAir::push_spread(VapourPatches& p, std::span<Piece* const> pieces, const Vec3& at, double area) {
    std::array<double, 6> sum{};
    for (const Piece* piece : pieces) {
        const Vec3 d = piece->at - at;
        const std::array<double, 6> own{d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x};
        for (std::size_t i = 0; i < 6; ++i) sum[i] += piece->area / area * (piece->squares[i] + own[i]);
    }
    std::size_t i = 0;
    for (auto* to : {&p.xx, &p.yy, &p.zz, &p.xy, &p.yz, &p.zx}) to->push_back(static_cast<float>(sum[i++]));
}

/// Makes patches of the pieces of all tiles. Whether these are few enough.
bool StillAir::gather(float cube) {
    std::unordered_map<Key, std::uint32_t, KeyHash> patch_of;
    pieces_.clear();
    for (Tile& tile : tiles_)
        for (Piece& piece : tile.pieces) {
            const auto next = static_cast<std::uint32_t>(patch_of.size());
            piece.patch = patch_of.try_emplace(piece.key, next).first->second;
            if (patch_of.size() > kMostPatches) return false;
            pieces_.push_back(&piece);
        }
    cube_ = cube;
    std::stable_sort(pieces_.begin(), pieces_.end(),
                     [](const Piece* a, const Piece* b) { return a->patch < b->patch; });
    VapourPatches& p = patches_;
    p = {};
    rates_.clear();
    for (std::size_t first = 0, last = 0; first < pieces_.size(); first = last) {
        while (last < pieces_.size() && pieces_[last]->patch == pieces_[first]->patch) ++last;
        double area = 0, rate = 0, energy = 0;
        Vec3 at{0}, normal{0};
        for (std::size_t i = first; i < last; ++i) {
            const Piece& a = *pieces_[i];
            area += a.area, rate += a.rate, at += a.area * a.at, normal += a.normal, energy += a.energy;
            for (std::size_t j = first; j < i; ++j) {
                const Piece& b = *pieces_[j];
                energy += 2 * a.area * b.area *
                          potential(square_of(a.at - b.at), a.spread, b.spread, a.energy / (a.area * a.area),
                                    b.energy / (b.area * b.area));
            }
        }
        at /= area;
        normal /= std::max(glm::length(normal), 1e-30);
        p.x.push_back(static_cast<float>(at.x)), p.y.push_back(static_cast<float>(at.y));
        p.z.push_back(static_cast<float>(at.z));
        p.nx.push_back(static_cast<float>(normal.x)), p.ny.push_back(static_cast<float>(normal.y));
        p.nz.push_back(static_cast<float>(normal.z));
        // No shape of its area gives off less than a disc.
        const double radius = std::max(area * area * kEven / (4 * energy), std::sqrt(area / std::numbers::pi));
        p.radius.push_back(static_cast<float>(radius));
        push_spread(p, std::span(pieces_).subspan(first, last - first), at, area);
        rates_.push_back(static_cast<float>(rate));
    }
    return true;
}

/// Sets the factors of a slot by the patches near by. `tile`: what is wet on it; null: not needed.
void StillAir::set_factors(const atlas::TexelMap& map, std::uint32_t slot, Tile* tile) {
    const Place& place = place_of(map, slot);
    Factors& out = factors_[slot];
    out.kind = place.smooth ? Kind::corners : Kind::plane;
    if (!place.smooth) return fill_plane(map, slot, tile);
    const float reach = kReach * cube_, limit = place.radius + reach, over_square = 1 / (reach * reach);
    std::array<float, 4> flux{}, rate{};
    for (std::size_t i = 0; i < patches_.size(); ++i) {
        const Vec3f at(patches_.x[i], patches_.y[i], patches_.z[i]), d = at - place.middle;
        if (!(glm::dot(d, d) < limit * limit)) continue;
        for (std::size_t c = 0; c < 4; ++c) {
            const Vec3f from = place.corners[c] - at;
            const float inside = positive(1 - glm::dot(from, from) * over_square), weight = inside * inside;
            flux[c] += fluxes_[i] * weight, rate[c] += rates_[i] * weight;
        }
    }
    const float all = rate[0] + rate[1] + rate[2] + rate[3];
    const float otherwise = all > 0 ? (flux[0] + flux[1] + flux[2] + flux[3]) / all : 1;
    for (std::size_t c = 0; c < 4; ++c) {
        out.at[c] = rate[c] > 0 ? flux[c] / rate[c] : otherwise;
        if (!tile || tile->blocks.empty()) continue;
        tile->given += tile->shares[c] * static_cast<double>(out.at[c]);
        tile->greatest = std::max(tile->greatest, out.at[c]);
    }
}

/// The same texel by texel. The slot's plane holds the tile's rates before.
void StillAir::fill_plane(const atlas::TexelMap& map, std::uint32_t slot, Tile* tile) {
    const Place& place = *places_[slot];
    const float reach = kReach * cube_, limit = place.radius + reach;
    Plane fluxes, rates;
    fluxes.fill(0), rates.fill(0);
    atlas::TexelShape buffer;
    const atlas::TexelShape& shape = atlas::shape_of(map, slot, buffer);
    for (std::size_t i = 0; i < patches_.size(); ++i) {
        const Vec3f at(patches_.x[i], patches_.y[i], patches_.z[i]), d = at - place.middle;
        if (glm::dot(d, d) < limit * limit)
            add_patch(fluxes.data(), rates.data(), shape, {at.x, at.y, at.z}, 1 / (reach * reach), fluxes_[i],
                      rates_[i]);
    }
    float flux = 0, rate = 0;
    for (int t = 0; t < kTexels; ++t)
        if (map.tiles[slot].cluster[t] != atlas::kNoCluster) flux += fluxes[t], rate += rates[t];
    const float otherwise = rate > 0 ? flux / rate : 1;
    if (!planes_[slot]) planes_[slot] = std::make_unique<Plane>();
    for (int t = 0; t < kTexels; ++t) {
        float& own = (*planes_[slot])[t];
        const float factor =
            map.tiles[slot].cluster[t] != atlas::kNoCluster && rates[t] > 0 ? fluxes[t] / rates[t] : otherwise;
        if (tile && !tile->blocks.empty() && own > 0) {
            tile->given += static_cast<double>(own * factor);
            tile->greatest = std::max(tile->greatest, factor);
        }
        own = factor;
    }
}

void StillAir::complete(const atlas::TexelMap& map, std::uint32_t slot) {
    if (used_ && found_ && factors_[slot].kind == Kind::unknown) set_factors(map, slot, nullptr);
}

void StillAir::look(const TileList& tiles, std::span<const Sources> sources) {
    if (!used_) return;
    const auto wet = static_cast<std::size_t>(
        std::count_if(tiles.list.begin(), tiles.list.end(), [](const Active& tile) { return tile.wet(); }));
    const bool grown = age_ >= kLeastAge && static_cast<double>(wet) > kGrown * static_cast<double>(n_wet_);
    if (found_ && known_for_ > 0 && !grown) return;
    n_wet_ = wet;
    find(tiles, sources);
    found_ = true;
    age_ = 0;
    known_for_ = kSeconds * slower_;
}

void StillAir::find(const TileList& tiles, std::span<const Sources> sources) {
    side_ = 4;
    while (side_ > 1 && side_ * tiles.map.texel_size > static_cast<double>(kBlockPart * kCube)) side_ /= 2;
    tiles_.resize(tiles.list.size());
    const auto each = [&](auto&& fn) {
        parallel_for(tiles_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) fn(i);
        });
    };
    each([&](std::size_t i) { look_at(tiles, sources, i); });
    float area = 0;
    for (const Tile& tile : tiles_)
        for (const Block& block : tile.blocks) area += block.area;
    float cube = std::max(kCube, std::sqrt(area / static_cast<float>(kMostPatches)));
    for (;; cube *= kRoot2) {
        each([&](std::size_t i) { cut(tiles_[i], cube); });
        if (gather(cube)) break;
    }
    fluxes_ = still_air_fluxes(patches_, static_cast<float>(params_.drying.still_air));
    double flux = 0;
    for (float& f : fluxes_) flux += static_cast<double>(f *= static_cast<float>(params_.drying.vapour));
    each([&](std::size_t i) {
        tiles_[i].given = 0, tiles_[i].greatest = 0;
        set_factors(tiles.map, tiles.list[i].slot, &tiles_[i]);
    });
    double given = 0, rate = 0;
    for (const float r : rates_) rate += static_cast<double>(r);
    float most = 0;
    for (const Tile& tile : tiles_) given += tile.given, most = std::max(most, tile.greatest);
    factor_ = given > 0 ? flux / given : 1;
    slower_ = 1;
    const double mean = rate > 0 ? flux / rate : 1, greatest = factor_ * static_cast<double>(most);
    while (slower_ < kSlowest && mean * slower_ < kAsFast && greatest * slower_ < kFastest) slower_ *= 2;
}

void StillAir::slow_down(Step& step) const {
    if (!used_ || !found_) return;
    step.drying.evaporation *= static_cast<float>(factor_);
    step.drying.rim *= static_cast<float>(factor_);
}

}  // namespace tuft::ink::wet
