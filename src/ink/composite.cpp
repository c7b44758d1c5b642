#include "ink/composite.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "ink/simd.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kSide = atlas::kTile;
using Texels = std::array<float, kN>;

/// exp(-x) for x ≥ 0, 1.5e-7 relative: 2^-n by exponent bits, Taylor polynomial on the
/// rest. Written out so that it vectorises and gives the same bits everywhere.
inline float exp_minus(float x) {
    const float y = (x < 80.0f ? x : 80.0f) * 1.44269504f;
    const int n = static_cast<int>(y + 0.5f);
    const float f = (static_cast<float>(n) - y) * 0.693147181f;  // |f| ≤ 0.347
    float e = 1.0f / 5040;
    e = e * f + 1.0f / 720;
    e = e * f + 1.0f / 120;
    e = e * f + 1.0f / 24;
    e = e * f + 1.0f / 6;
    e = e * f + 0.5f;
    e = e * f + 1.0f;
    e = e * f + 1.0f;
    return e * std::bit_cast<float>((127 - n) << 23);
}

TUFT_CLONES void add_scaled(float* __restrict sum, const float* __restrict w, float factor) {
    for (int t = 0; t < kN; ++t) sum[t] += factor * w[t];
}

/// `layer` and `over` of kubelka_munk.h for K X and S X per texel; `k` becomes R.
TUFT_CLONES void film_over(float* __restrict k, const float* __restrict s, float r_substrate) {
    for (int t = 0; t < kN; ++t) {
        const float y2 = k[t] * (k[t] + 2 * s[t]);
        const float y = std::sqrt(y2);
        const float e = exp_minus(y);
        const float e2 = e * e;
        const float series = 1 - y2 * (0.333333333f - y2 * (0.133333333f - y2 * 0.0539682540f));
        const float ratio = (1 - e2) / ((1 + e2) * (y + 1e-30f));
        const float u = y2 < 0.01f ? series : ratio;
        const float inverse = 1 / (1 + (k[t] + s[t]) * u);
        const float r0 = s[t] * u * inverse;
        const float transmitted = 2 * e / (1 + e2) * inverse;
        const float open = 1 - r0 * r_substrate;
        k[t] = r0 + transmitted * transmitted * r_substrate / (open > 1e-7f ? open : 1e-7f);
    }
}

/// The dry film covers the substrate's microfacets within a fraction of a film unit.
TUFT_CLONES void blend_roughness(float* __restrict roughness, const float* __restrict weighted,
                                 const float* __restrict film, float substrate) {
    for (int t = 0; t < kN; ++t) {
        const float covered = 1 - exp_minus(4 * film[t]);
        const float mean = weighted[t] / (film[t] > 1e-12f ? film[t] : 1e-12f);
        roughness[t] = substrate + (mean - substrate) * covered;
    }
}

const std::array<std::uint8_t, 65536>& srgb_table() {
    static const auto table = [] {
        std::array<std::uint8_t, 65536> t{};
        for (int i = 0; i < 65536; ++i)
            t[i] = static_cast<std::uint8_t>(std::lround(255 * srgb_encode(i / 65535.0f)));
        return t;
    }();
    return table;
}

std::uint8_t encode8(float linear) {
    const float c = linear > 0 ? (linear < 1 ? linear : 1) : 0;
    return srgb_table()[static_cast<int>(c * 65535 + 0.5f)];
}

std::uint8_t unit8(float v) {
    return static_cast<std::uint8_t>((v > 0 ? (v < 1 ? v : 1) : 0) * 255 + 0.5f);
}

template <class T, int C>
using TileOut = std::array<std::array<T, C>, kN>;

/// Writes one tile of a map, clipped to its size; only texels of charts when `map` has them.
template <class T, int C>
void write_tile(AtlasMap<T>& image, const atlas::TexelMap& map, std::uint32_t slot,
                const TileOut<T, C>& out) {
    const std::uint32_t tile = map.tile_of_slot[slot];
    const std::uint32_t x0 = tile % map.tiles_per_side * kSide, y0 = tile / map.tiles_per_side * kSide;
    const std::uint32_t columns = std::min<std::uint32_t>(kSide, image.size - x0);
    const std::uint32_t rows = std::min<std::uint32_t>(kSide, image.size - y0);
    const auto& piece = map.tiles[slot].piece;
    for (std::uint32_t row = 0; row < rows; ++row) {
        T* to = &image.texels[(std::size_t{y0 + row} * image.size + x0) * C];
        for (std::uint32_t column = 0; column < columns; ++column, to += C)
            if (piece[row * kSide + column] != atlas::kNoPiece)
                std::memcpy(to, out[row * kSide + column].data(), C * sizeof(T));
    }
}

struct Offset {
    int dx, dy;
};

/// Offsets within `radius` texels, nearest first.
std::vector<Offset> ring_offsets(int radius) {
    std::vector<Offset> offsets;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            if ((dx || dy) && dx * dx + dy * dy <= radius * radius) offsets.push_back({dx, dy});
    std::stable_sort(offsets.begin(), offsets.end(), [](const Offset& a, const Offset& b) {
        return a.dx * a.dx + a.dy * a.dy < b.dx * b.dx + b.dy * b.dy;
    });
    return offsets;
}

/// Gives the texels of one tile that belong to no chart the value of the nearest one that does.
template <class T, int C>
void fill_gutter(AtlasMap<T>& image, const atlas::TexelMap& map, std::uint32_t tile, int radius,
                 const std::vector<Offset>& offsets) {
    const int size = static_cast<int>(image.size);
    const int x0 = static_cast<int>(tile % map.tiles_per_side) * kSide;
    const int y0 = static_cast<int>(tile / map.tiles_per_side) * kSide;
    const int side = kSide + 2 * radius;
    std::vector<std::uint8_t> valid(static_cast<std::size_t>(side) * side, 0);
    for (int y = std::max(0, y0 - radius); y < std::min(size, y0 + kSide + radius); ++y) {
        for (int x = std::max(0, x0 - radius); x < std::min(size, x0 + kSide + radius); ++x) {
            const std::uint32_t slot =
                map.slot_of_tile[static_cast<std::size_t>(y / kSide) * map.tiles_per_side + x / kSide];
            valid[(y - y0 + radius) * side + x - x0 + radius] =
                slot != kNone &&
                map.tiles[slot].piece[y % kSide * kSide + x % kSide] != atlas::kNoPiece;
        }
    }
    for (int y = y0; y < std::min(size, y0 + kSide); ++y) {
        for (int x = x0; x < std::min(size, x0 + kSide); ++x) {
            const int here = (y - y0 + radius) * side + x - x0 + radius;
            if (valid[here]) continue;
            for (const Offset& o : offsets) {
                if (!valid[here + o.dy * side + o.dx]) continue;
                std::memcpy(&image.texels[(std::size_t(y) * size + x) * C],
                            &image.texels[(std::size_t(y + o.dy) * size + x + o.dx) * C],
                            C * sizeof(T));
                break;
            }
        }
    }
}

/// Tiles of `slots` and those beside them, ascending.
std::vector<std::uint32_t> with_neighbours(const atlas::TexelMap& map,
                                           std::span<const std::uint32_t> slots) {
    std::vector<std::uint8_t> wanted(map.slot_of_tile.size(), 0);
    const int n = static_cast<int>(map.tiles_per_side);
    for (const std::uint32_t slot : slots) {
        const int tx = static_cast<int>(map.tile_of_slot[slot]) % n;
        const int ty = static_cast<int>(map.tile_of_slot[slot]) / n;
        for (int y = std::max(0, ty - 1); y <= std::min(n - 1, ty + 1); ++y)
            for (int x = std::max(0, tx - 1); x <= std::min(n - 1, tx + 1); ++x)
                wanted[static_cast<std::size_t>(y) * n + x] = 1;
    }
    std::vector<std::uint32_t> tiles;
    for (std::size_t i = 0; i < wanted.size(); ++i)
        if (wanted[i]) tiles.push_back(static_cast<std::uint32_t>(i));
    return tiles;
}

/// Computes the tiles of `slots` by `look(slot)` and then the gutter near them.
template <class T, int C, class Fn>
void refresh(AtlasMap<T>& image, std::span<const std::uint32_t> slots, const atlas::TexelMap& map,
             const ComposeOptions& options, Fn&& look) {
    report(options.progress, "colour", 0);
    constexpr std::size_t kBatch = 4096;
    for (std::size_t first = 0; first < slots.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, slots.size() - first);
        parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = first + begin; i < first + end; ++i)
                write_tile<T, C>(image, map, slots[i], look(slots[i]));
        });
        report(options.progress, "colour", 0.8 * static_cast<double>(first + count) / static_cast<double>(slots.size()));
    }
    const int radius = static_cast<int>(std::min<std::uint32_t>(options.gutter, kSide));
    if (radius > 0) {
        const std::vector<Offset> offsets = ring_offsets(radius);
        const std::vector<std::uint32_t> tiles = with_neighbours(map, slots);
        parallel_for(tiles.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                fill_gutter<T, C>(image, map, tiles[i], radius, offsets);
        });
    }
    report(options.progress, "colour", 1);
}

template <class T, int C, class Fn>
AtlasMap<T> compose(const Canvas& canvas, const atlas::TexelMap& map,
                    const std::array<T, C>& background, const ComposeOptions& options, Fn&& look) {
    AtlasMap<T> image{.size = map.size, .channels = C, .texels = {}};
    image.texels.resize(std::size_t{map.size} * map.size * C);
    for (std::size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = background[i % C];
    refresh<T, C>(image, canvas.touched_slots(), map, options, look);
    return image;
}

TileOut<std::uint8_t, 3> srgb8_of(const TileLook& look) {
    TileOut<std::uint8_t, 3> out;
    for (int t = 0; t < kN; ++t)
        for (int b = 0; b < 3; ++b) out[t][b] = encode8(look.colour[b][t]);
    return out;
}

}  // namespace

static_assert(kBands == 3, "with more bands, look_of_tile has to go from spectrum to RGB");

TileLook look_of_tile(const Canvas& canvas, std::uint32_t slot, const Substrate& substrate) {
    TileLook look;
    alignas(64) std::array<Texels, kBands> s{};
    alignas(64) Texels film{}, rough{};
    for (Texels& k : look.colour) k.fill(0);
    look.height.fill(0);
    const std::vector<Pigment>& pigments = canvas.pigments();
    for (int p = 0; p < static_cast<int>(pigments.size()); ++p) {
        const Plane* w = canvas.plane(slot, p);
        if (!w) continue;
        for (int b = 0; b < kBands; ++b) {
            add_scaled(look.colour[b].data(), w->data(), pigments[p].k[b]);
            add_scaled(s[b].data(), w->data(), pigments[p].s[b]);
        }
        add_scaled(look.height.data(), w->data(), pigments[p].height * 1e6f);
        add_scaled(rough.data(), w->data(), pigments[p].roughness);
        add_scaled(film.data(), w->data(), 1.0f);
    }
    for (int b = 0; b < kBands; ++b)
        film_over(look.colour[b].data(), s[b].data(), substrate.reflectance[b]);
    blend_roughness(look.roughness.data(), rough.data(), film.data(), substrate.roughness);
    return look;
}

AtlasMap<std::uint8_t> compose_srgb8(const Canvas& canvas, const atlas::TexelMap& map,
                                     const Substrate& substrate, const ComposeOptions& options) {
    std::array<std::uint8_t, 3> background;
    for (int b = 0; b < 3; ++b) background[b] = encode8(substrate.reflectance[b]);
    return compose<std::uint8_t, 3>(canvas, map, background, options, [&](std::uint32_t slot) {
        return srgb8_of(look_of_tile(canvas, slot, substrate));
    });
}

void refresh_srgb8(AtlasMap<std::uint8_t>& image, std::span<const std::uint32_t> slots,
                   const Canvas& canvas, const atlas::TexelMap& map, const Substrate& substrate,
                   const ComposeOptions& options) {
    refresh<std::uint8_t, 3>(image, slots, map, options, [&](std::uint32_t slot) {
        return srgb8_of(look_of_tile(canvas, slot, substrate));
    });
}

AtlasMap<float> compose_linear(const Canvas& canvas, const atlas::TexelMap& map,
                               const Substrate& substrate, const ComposeOptions& options) {
    return compose<float, 3>(
        canvas, map, substrate.reflectance, options, [&](std::uint32_t slot) {
            const TileLook look = look_of_tile(canvas, slot, substrate);
            TileOut<float, 3> out;
            for (int t = 0; t < kN; ++t)
                for (int b = 0; b < 3; ++b) out[t][b] = look.colour[b][t];
            return out;
        });
}

AtlasMap<float> compose_height(const Canvas& canvas, const atlas::TexelMap& map,
                               const ComposeOptions& options) {
    return compose<float, 1>(canvas, map, {0.0f}, options, [&](std::uint32_t slot) {
        const TileLook look = look_of_tile(canvas, slot, Substrate{});
        TileOut<float, 1> out;
        for (int t = 0; t < kN; ++t) out[t][0] = look.height[t];
        return out;
    });
}

AtlasMap<std::uint8_t> compose_orm8(const Canvas& canvas, const atlas::TexelMap& map,
                                    const Substrate& substrate, const ComposeOptions& options) {
    const std::array<std::uint8_t, 3> background{255, unit8(substrate.roughness),
                                                 unit8(substrate.metallic)};
    return compose<std::uint8_t, 3>(canvas, map, background, options, [&](std::uint32_t slot) {
        const TileLook look = look_of_tile(canvas, slot, substrate);
        TileOut<std::uint8_t, 3> out;
        for (int t = 0; t < kN; ++t) {
            // Ink hides the substrate's metal as it hides its microfacets.
            float film = 0;
            for (int p = 0; substrate.metallic > 0 && p < static_cast<int>(canvas.pigments().size()); ++p)
                if (const Plane* w = canvas.plane(slot, p)) film += (*w)[t];
            out[t] = {255, unit8(look.roughness[t]),
                      unit8(substrate.metallic * exp_minus(4 * film))};
        }
        return out;
    });
}

float srgb_encode(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float srgb_decode(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace tuft::ink
