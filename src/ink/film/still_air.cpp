#include "ink/film/still_air.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "core/random.h"
#include "core/simd.h"
#include "core/system/parallel.h"
#include "ink/elementary.h"

#define TUFT_INLINE inline __attribute__((always_inline))

namespace tuft::ink::wet {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kCube = 1.5e-3f;  // metres: rims of drops and lines show in less
constexpr float kRoot2 = 1.4142136f;
constexpr float kReach = 1.5f;    // cubes over which what patches give off is shared out
constexpr double kEnough = 1e-6;  // of the first residual's square: the sum's error is as small as that
constexpr int kMostRounds = 60;
constexpr float kLeastBulge = 1e-4f;
constexpr float kLeastArea = 1e-13f;  // m²: a patch that is hardly wet
constexpr std::size_t kGrain = 8;     // tiles

/// Column j of K.
TUFT_CLONES void column_of(float* __restrict k, const VapourPatches& patches, std::size_t j) {
    const std::size_t n = patches.size();
    const float *x = patches.x.data(), *y = patches.y.data(), *z = patches.z.data();
    const float *nx = patches.nx.data(), *ny = patches.ny.data(), *nz = patches.nz.data(), *area = patches.area.data();
    const float x1 = x[j], y1 = y[j], z1 = z[j], u = nx[j], v = ny[j], w = nz[j], area1 = area[j] + kLeastArea;
#pragma GCC ivdep
    for (std::size_t i = 0; i < n; ++i) {
        const float dx = x[i] - x1, dy = y[i] - y1, dz = z[i] - z1;
        const float square = dx * dx + dy * dy + dz * dz;
        const float far = 4 * kPi * kPi * square;
        const float near = 256 / (kPi * kPi) * ((area[i] + kLeastArea) * area1);
        const float plane = 1 / std::sqrt(std::sqrt(far * far + near));
        const float bulge = dx * (nx[i] - u) + dy * (ny[i] - v) + dz * (nz[i] - w);
        const float q = smaller(larger(bulge / (2 * std::sqrt(square) + 1e-12f), kLeastBulge), 1);
        k[i] = plane * (1 - q * log_of(1 + 1 / q));
    }
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

double product(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

/// The cube that a place lies in, and the side that a normal faces.
struct Key {
    std::array<std::int32_t, 3> cube;
    std::uint8_t side;

    bool operator==(const Key&) const = default;
};
struct KeyHash {
    std::size_t operator()(const Key& k) const {
        std::uint64_t h = k.side;
        for (const std::int32_t c : k.cube) h = hash_bits(h, static_cast<std::uint64_t>(static_cast<std::int64_t>(c)));
        return h;
    }
};
Key key_of(const Vec3f& at, const Vec3f& normal, float cube) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
    Key key{.cube = {}, .side = static_cast<std::uint8_t>(2 * axis + (normal[axis] > 0))};
    for (int i = 0; i < 3; ++i)
        key.cube[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(std::floor(at[i] / cube));
    return key;
}

}  // namespace

std::vector<float> still_air_fluxes(const VapourPatches& patches) {
    const std::size_t n = patches.size();
    std::vector<float> k(n * n), flux(n, 0.0f), missing(n, 1.0f), scaled(n), direction(n), changed(n);
    for (std::size_t j = 0; j < n; ++j) column_of(&k[j * n], patches, j);
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

void StillAir::start(const FilmParams& params, const atlas::TexelMap& map) {
    params_ = params;
    used_ = params.drying.vapour > 0 && params.drying.evaporation > 0;
    factor_ = greatest_ = 1;
    planes_.resize(map.n_slots());
    for (auto& plane : planes_) plane.reset();
    otherwise_.fill(1);
}

const float* StillAir::of(std::uint32_t slot) const {
    if (!used_) return nullptr;
    return (planes_[slot] ? *planes_[slot] : otherwise_).data();
}

/// Sets a tile's blocks, and its plane to the rate of each texel times its area.
void StillAir::look_at(const TileList& tiles, std::span<const Sources> sources, std::size_t index) {
    const Active& active = tiles.list[index];
    Tile& tile = tiles_[index];
    tile.given = 0;
    tile.greatest = 0;
    tile.wet = active.wet();
    atlas::TexelShape buffer;
    const atlas::TexelShape& shape = atlas::shape_of(tiles.map, active.slot, buffer);
    const atlas::TexelTile& texels = tiles.map.tiles[active.slot];
    const auto at = [&](int t) { return Vec3f(shape.px[t], shape.py[t], shape.pz[t]); };
    int first = 0;
    while (first < kTexels && texels.cluster[first] == atlas::kNoCluster) ++first;
    if (first == kTexels) return;
    Vec3f low = at(first), high = low;
    for (int t = first; t < kTexels; ++t)
        if (texels.cluster[t] != atlas::kNoCluster) low = glm::min(low, at(t)), high = glm::max(high, at(t));
    tile.middle = 0.5f * (low + high);
    tile.radius = glm::length(0.5f * (high - low));
    if (!planes_[active.slot]) planes_[active.slot] = std::make_unique<Plane>();
    Plane &rates = *planes_[active.slot], &areas = tile.areas;
    rates.fill(0);
    areas.fill(0);
    if (!tile.wet) return;
    Work work;
    static constexpr Plane kDry{};
    for (std::size_t k = 0; k < 2; ++k) {
        std::array<const float*, 9> planes;
        for (std::size_t i = 0; i < 9; ++i) {
            const Plane* plane = active.around[i] == kNone ? nullptr : sources[active.around[i]].liquid[k];
            planes[i] = (plane ? plane : &kDry)->data();
        }
        gather_field(k == 0 ? work.w : work.s, planes);
    }
    const auto depth = static_cast<float>(params_.drying.rim_depth);
    find_rim_slopes(work, *active.faces.geometry, depth);
    const auto even = static_cast<float>(params_.drying.evaporation);
    const auto rim =
        static_cast<float>(params_.drying.rim_evaporation / (tiles.map.texel_size * params_.drying.rim_depth));
    for (int t = 0; t < kTexels; ++t)
        if (const float total = work.total[field_of(t)]; total > 0) {
            const float rate = even + rim * work.rim_slope[t];
            rates[t] = std::min(rate, total / static_cast<float>(kSeconds)) * texels.area[t];
            areas[t] = std::min(1.0f, total / (rate * static_cast<float>(kSeconds))) * texels.area[t];
        }
}

/// Sums the wet texels up into patches. Whether these are few enough.
bool StillAir::gather(const TileList& tiles, float cube) {
    std::unordered_map<Key, std::size_t, KeyHash> patch_of;
    VapourPatches& p = patches_;
    p = {};
    rates_.clear();
    Key last{};
    std::size_t patch = kNone;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        if (!tiles_[i].wet) continue;
        const std::uint32_t slot = tiles.list[i].slot;
        const Plane& rates = *planes_[slot];
        atlas::TexelShape buffer;
        const atlas::TexelShape& shape = atlas::shape_of(tiles.map, slot, buffer);
        for (int t = 0; t < kTexels; ++t) {
            if (!(rates[t] > 0)) continue;
            const Vec3f at(shape.px[t], shape.py[t], shape.pz[t]), normal(shape.nx[t], shape.ny[t], shape.nz[t]);
            if (const Key key = key_of(at, normal, cube); patch == kNone || !(key == last)) {
                const auto [found, is_new] = patch_of.try_emplace(key, p.size());
                if (is_new) {
                    if (p.size() == kMostPatches) return false;
                    for (auto* of : {&p.x, &p.y, &p.z, &p.nx, &p.ny, &p.nz, &p.area, &rates_}) of->push_back(0);
                }
                last = key;
                patch = found->second;
            }
            const float area = tiles_[i].areas[t];
            p.area[patch] += area;
            rates_[patch] += rates[t];
            p.x[patch] += area * at.x, p.y[patch] += area * at.y, p.z[patch] += area * at.z;
            p.nx[patch] += area * normal.x, p.ny[patch] += area * normal.y, p.nz[patch] += area * normal.z;
        }
    }
    for (std::size_t i = 0; i < p.size(); ++i) {
        p.x[i] /= p.area[i], p.y[i] /= p.area[i], p.z[i] /= p.area[i];
        const float length = std::max(glm::length(Vec3f(p.nx[i], p.ny[i], p.nz[i])), 1e-30f);
        p.nx[i] /= length, p.ny[i] /= length, p.nz[i] /= length;
    }
    return true;
}

/// Sets a tile's plane to the factors.
void StillAir::interpolate(const atlas::TexelMap& map, std::uint32_t slot, Tile& tile) {
    if (!planes_[slot]) return;
    atlas::TexelShape buffer;
    const atlas::TexelShape& shape = atlas::shape_of(map, slot, buffer);
    Plane flux, rate;
    flux.fill(0), rate.fill(0);
    const float reach = kReach * cube_, limit = tile.radius + reach;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
        const Vec3f at(patches_.x[i], patches_.y[i], patches_.z[i]), d = at - tile.middle;
        if (glm::dot(d, d) < limit * limit)
            add_patch(flux.data(), rate.data(), shape, {at.x, at.y, at.z}, 1 / (reach * reach), fluxes_[i], rates_[i]);
    }
    Plane& plane = *planes_[slot];
    for (int t = 0; t < kTexels; ++t) {
        const float own = plane[t], factor = rate[t] > 0 ? flux[t] / rate[t] : otherwise_[0];
        tile.given += static_cast<double>(own * factor);
        if (own > 0) tile.greatest = std::max(tile.greatest, factor);
        plane[t] = factor;
    }
}

void StillAir::find(const TileList& tiles, std::span<const Sources> sources) {
    tiles_.resize(tiles.list.size());
    parallel_for(tiles_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) look_at(tiles, sources, i);
    });
    factor_ = greatest_ = 1;
    float cube = kCube;
    while (!gather(tiles, cube)) cube *= kRoot2;
    cube_ = cube;
    fluxes_ = still_air_fluxes(patches_);
    const auto vapour = static_cast<float>(params_.drying.vapour);
    double flux = 0, rate = 0;
    for (std::size_t i = 0; i < fluxes_.size(); ++i) {
        flux += static_cast<double>(fluxes_[i] *= vapour);
        rate += static_cast<double>(rates_[i]);
    }
    otherwise_.fill(rate > 0 ? static_cast<float>(flux / rate) : 1);
    parallel_for(tiles_.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) interpolate(tiles.map, tiles.list[i].slot, tiles_[i]);
    });
    double given = 0;
    float most = 0;
    for (const Tile& tile : tiles_) given += tile.given, most = std::max(most, tile.greatest);
    if (!(given > 0)) return;
    factor_ = flux / given;
    greatest_ = factor_ * static_cast<double>(most);
}

}  // namespace tuft::ink::wet
