#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <numeric>

#include "core/system/parallel.h"
#include "ink/composite/composite.h"

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels;
constexpr int kSide = atlas::kTile;

std::uint8_t unit8(float v) {
    return static_cast<std::uint8_t>((v > 0 ? (v < 1 ? v : 1) : 0) * 255 + 0.5f);
}

template <class T, int C>
using TileOut = std::array<std::array<T, C>, kN>;

/// Writes one tile of a map, clipped to its size; only texels of charts when `map` has them.
template <class T, int C>
void write_tile(AtlasMap<T>& image, const atlas::TexelMap& map, std::uint32_t slot, const TileOut<T, C>& out) {
    const atlas::TexelPlace first = atlas::texel_place(map, slot, 0);
    const auto x0 = static_cast<std::uint32_t>(first.x), y0 = static_cast<std::uint32_t>(first.y);
    const std::uint32_t columns = std::min<std::uint32_t>(kSide, image.size - x0);
    const std::uint32_t rows = std::min<std::uint32_t>(kSide, image.size - y0);
    const auto& cluster = map.tiles[slot].cluster;
    for (std::uint32_t row = 0; row < rows; ++row) {
        T* to = &image.texels[(std::size_t{y0 + row} * image.size + x0) * C];
        for (std::uint32_t column = 0; column < columns; ++column, to += C)
            if (cluster[row * kSide + column] != atlas::kNoCluster)
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
                slot != kNone && map.tiles[slot].cluster[y % kSide * kSide + x % kSide] != atlas::kNoCluster;
        }
    }
    for (int y = y0; y < std::min(size, y0 + kSide); ++y) {
        for (int x = x0; x < std::min(size, x0 + kSide); ++x) {
            const int here = (y - y0 + radius) * side + x - x0 + radius;
            if (valid[here]) continue;
            for (const Offset& o : offsets) {
                if (!valid[here + o.dy * side + o.dx]) continue;
                std::memcpy(&image.texels[(std::size_t(y) * size + x) * C],
                            &image.texels[(std::size_t(y + o.dy) * size + x + o.dx) * C], C * sizeof(T));
                break;
            }
        }
    }
}

/// Tiles of `slots` and those beside them, ascending.
std::vector<std::uint32_t> with_neighbours(const atlas::TexelMap& map, std::span<const std::uint32_t> slots) {
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

/// Linear light (or plain numbers) of a stored value, and back.
struct SrgbCode {
    float from(std::uint8_t v) const { return table[v]; }
    std::uint8_t to(float v) const { return code_of_linear(v); }
    const std::array<float, 256>& table = linear_of_code();
};
struct UnitCode {
    float from(std::uint8_t v) const { return static_cast<float>(v) / 255.0f; }
    std::uint8_t to(float v) const { return unit8(v); }
};
struct FloatCode {
    float from(float v) const { return v; }
    float to(float v) const { return v; }
};

/// Gutter texels that take something from `slots`: weighted sums of texels on both sides of
/// the seam.
template <class T, int C, class Code>
void continue_over_seams(AtlasMap<T>& image, std::span<const std::uint32_t> slots, const atlas::TexelMap& map,
                         const GutterPlan& plan, const Code& code) {
    std::vector<std::uint32_t> wanted;
    for (const std::uint32_t slot : slots)
        wanted.insert(wanted.end(), plan.entries.begin() + plan.first_of_slot[slot],
                      plan.entries.begin() + plan.first_of_slot[slot + 1]);
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    const auto place = [&](std::uint32_t texel) {
        const atlas::TexelPlace at = atlas::texel_place(map, texel / kN, texel % kN);
        return static_cast<std::size_t>((at.y * image.size + at.x) * C);
    };
    parallel_for(wanted.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t entry = wanted[i];
            std::array<float, C> sum{};
            for (std::uint32_t k = plan.gutter.start[entry]; k < plan.gutter.start[entry + 1]; ++k) {
                const T* from = &image.texels[place(plan.gutter.taps[k].texel)];
                for (int c = 0; c < C; ++c) sum[c] += plan.gutter.taps[k].weight * code.from(from[c]);
            }
            T* to = &image.texels[std::size_t{plan.gutter.texels[entry]} * C];
            for (int c = 0; c < C; ++c) to[c] = code.to(sum[c]);
        }
    });
}

/// Computes the tiles of `slots` by `appearance(slot)` and then the gutter that depends on them.
template <class T, int C, class Fn, class Code>
void refresh(AtlasMap<T>& image, std::span<const std::uint32_t> slots, const atlas::TexelMap& map,
             const ComposeOptions& options, Fn&& appearance, const Code& code) {
    report(options.progress, "colour", 0);
    constexpr std::size_t kBatch = 4096;
    for (std::size_t first = 0; first < slots.size(); first += kBatch) {
        const std::size_t count = std::min(kBatch, slots.size() - first);
        parallel_for(count, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = first + begin; i < first + end; ++i)
                write_tile<T, C>(image, map, slots[i], appearance(slots[i]));
        });
        report(options.progress, "colour",
               0.8 * static_cast<double>(first + count) / static_cast<double>(slots.size()));
    }
    const int radius = static_cast<int>(std::min<std::uint32_t>(options.gutter, kSide));
    if (options.seams) {
        continue_over_seams<T, C>(image, slots, map, *options.seams, code);
    } else if (radius > 0) {
        const std::vector<Offset> offsets = ring_offsets(radius);
        const std::vector<std::uint32_t> tiles = with_neighbours(map, slots);
        parallel_for(tiles.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) fill_gutter<T, C>(image, map, tiles[i], radius, offsets);
        });
    }
    report(options.progress, "colour", 1);
}

template <class T, int C, class Fn, class Code>
AtlasMap<T> compose(std::span<const std::uint32_t> slots, const atlas::TexelMap& map,
                    const std::array<T, C>& background, const ComposeOptions& options, Fn&& appearance,
                    const Code& code) {
    AtlasMap<T> image{.size = map.size, .channels = C, .texels = {}};
    image.texels.resize(std::size_t{map.size} * map.size * C);
    for (std::size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = background[i % C];
    refresh<T, C>(image, slots, map, options, appearance, code);
    return image;
}

/// Slots with ink, or with a substrate of a part.
std::vector<std::uint32_t> own_slots(const Stack& stack) {
    std::vector<std::uint32_t> slots = stack.touched_slots();
    if (!stack.substrates) return slots;
    std::vector<std::uint32_t> differing, all;
    for (std::uint32_t slot = 0; slot < stack.substrates->of_slot.size(); ++slot)
        if (stack.differs(slot)) differing.push_back(slot);
    std::set_union(slots.begin(), slots.end(), differing.begin(), differing.end(), std::back_inserter(all));
    return all;
}

/// Slots whose colour is not that of the substrate that a call states.
std::vector<std::uint32_t> coloured_slots(const Stack& stack) {
    if (!stack.has_base_colour()) return own_slots(stack);
    std::vector<std::uint32_t> all(stack.base_colour->tiles.size());
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

/// Film units on a texel, all films and pigments together, of each layer what is seen of it.
float film_on(const Stack& stack, std::uint32_t slot, int texel) {
    float sum = 0;
    for (const LayerView& layer : stack.layers)
        for (int film = kFirstDryFilm; film < kFilms; ++film)
            for (int p = 0; p < static_cast<int>(layer.canvas->pigments().size()); ++p)
                if (const Plane* w = layer.canvas->film_plane(slot, film, p)) sum += layer.opacity * (*w)[texel];
    return sum;
}

const Substrate& substrate_at(const Stack& stack, std::uint32_t slot, int texel, const Substrate& document) {
    if (!stack.substrates) return document;
    const auto mixed = stack.substrates->of_texel.find(slot);
    if (mixed == stack.substrates->of_texel.end()) return stack.substrates->of(slot, document);
    return stack.substrates->at(mixed->second[static_cast<std::size_t>(texel)], document);
}

/// What ink leaves of a property of the substrate: it hides metal and glass as it hides the microfacets.
float uncovered(const Stack& stack, std::uint32_t slot, int texel, float property) {
    return property > 0 ? property * std::exp(-4 * film_on(stack, slot, texel)) : property;
}

TileOut<std::uint8_t, 3> srgb8_of(const TileAppearance& appearance) {
    TileOut<std::uint8_t, 3> out;
    for (int t = 0; t < kN; ++t)
        for (int b = 0; b < 3; ++b) out[t][b] = code_of_linear(appearance.colour[b][t]);
    return out;
}

/// Of texels without ink, far from any chart.
Rgb bare_colour(const Substrate& substrate, ColourSpace space) {
    if (space == ColourSpace::srgb) return substrate.reflectance;
    return into_gamut(transform(from_linear_srgb(space), substrate.reflectance), space);
}

TileOut<float, 3> linear_of(const TileAppearance& appearance) {
    TileOut<float, 3> out;
    for (int t = 0; t < kN; ++t)
        for (int b = 0; b < 3; ++b) out[t][b] = appearance.colour[b][t];
    return out;
}

}  // namespace

AtlasMap<std::uint8_t> compose_srgb8(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                     const ComposeOptions& options) {
    const Rgb bare = bare_colour(substrate, options.space);
    std::array<std::uint8_t, 3> background;
    for (int b = 0; b < 3; ++b) background[b] = code_of_linear(bare[b]);
    return compose<std::uint8_t, 3>(
        coloured_slots(stack), map, background, options,
        [&](std::uint32_t slot) { return srgb8_of(shade_tile(stack, slot, substrate, true, options.space)); },
        SrgbCode{});
}

void refresh_srgb8(AtlasMap<std::uint8_t>& image, std::span<const std::uint32_t> slots, const Stack& stack,
                   const atlas::TexelMap& map, const Substrate& substrate, const ComposeOptions& options) {
    refresh<std::uint8_t, 3>(
        image, slots, map, options,
        [&](std::uint32_t slot) { return srgb8_of(shade_tile(stack, slot, substrate, true, options.space)); },
        SrgbCode{});
}

AtlasMap<float> compose_linear(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                               const ComposeOptions& options) {
    return compose<float, 3>(
        coloured_slots(stack), map, bare_colour(substrate, options.space), options,
        [&](std::uint32_t slot) { return linear_of(shade_tile(stack, slot, substrate, true, options.space)); },
        FloatCode{});
}

void refresh_linear(AtlasMap<float>& image, std::span<const std::uint32_t> slots, const Stack& stack,
                    const atlas::TexelMap& map, const Substrate& substrate, const ComposeOptions& options) {
    refresh<float, 3>(
        image, slots, map, options,
        [&](std::uint32_t slot) { return linear_of(shade_tile(stack, slot, substrate, true, options.space)); },
        FloatCode{});
}

std::vector<std::uint32_t> refreshed_tiles(std::span<const std::uint32_t> slots, const atlas::TexelMap& map,
                                           const ComposeOptions& options) {
    if (!options.seams && options.gutter > 0) return with_neighbours(map, slots);
    std::vector<std::uint32_t> tiles;
    for (const std::uint32_t slot : slots) {
        tiles.push_back(map.tile_of_slot[slot]);
        if (!options.seams) continue;
        const GutterPlan& plan = *options.seams;
        for (std::uint32_t e = plan.first_of_slot[slot]; e < plan.first_of_slot[slot + 1]; ++e) {
            const std::uint32_t texel = plan.gutter.texels[plan.entries[e]];
            tiles.push_back(texel / map.size / kSide * map.tiles_per_side + texel % map.size / kSide);
        }
    }
    std::sort(tiles.begin(), tiles.end());
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
    return tiles;
}

AtlasMap<float> compose_height(const Stack& stack, const atlas::TexelMap& map, const ComposeOptions& options) {
    return compose<float, 1>(
        stack.touched_slots(), map, {0.0f}, options,
        [&](std::uint32_t slot) {
            const TileAppearance appearance = shade_tile(stack, slot, Substrate{}, false);
            TileOut<float, 1> out;
            for (int t = 0; t < kN; ++t) out[t][0] = appearance.height[t];
            return out;
        },
        FloatCode{});
}

AtlasMap<float> compose_roughness(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                  const ComposeOptions& options) {
    return compose<float, 1>(
        own_slots(stack), map, {substrate.roughness}, options,
        [&](std::uint32_t slot) {
            const TileAppearance appearance = shade_tile(stack, slot, substrate, false);
            TileOut<float, 1> out;
            for (int t = 0; t < kN; ++t) out[t][0] = appearance.roughness[t];
            return out;
        },
        FloatCode{});
}

AtlasMap<float> compose_amounts(const Stack& stack, const atlas::TexelMap& map, const ComposeOptions& options) {
    std::size_t n = 0;
    for (const LayerView& layer : stack.layers) n = std::max(n, layer.canvas->pigments().size());
    AtlasMap<float> all{.size = map.size, .channels = static_cast<int>(n), .texels = {}};
    all.texels.resize(std::size_t{map.size} * map.size * n);
    for (std::size_t p = 0; p < n; ++p) {
        const AtlasMap<float> one = compose<float, 1>(
            stack.touched_slots(), map, {0.0f}, options,
            [&](std::uint32_t slot) {
                TileOut<float, 1> out{};
                for (const LayerView& layer : stack.layers)
                    for (int film = 0; film < kFilms; ++film)
                        if (const Plane* w = layer.canvas->film_plane(slot, film, static_cast<int>(p)))
                            for (int t = 0; t < kN; ++t) out[t][0] += layer.opacity * (*w)[t];
                return out;
            },
            FloatCode{});
        for (std::size_t i = 0; i < one.texels.size(); ++i) all.texels[i * n + p] = one.texels[i];
    }
    return all;
}

AtlasMap<std::uint8_t> compose_orm8(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                    const ComposeOptions& options) {
    const std::array<std::uint8_t, 3> background{255, unit8(substrate.roughness), unit8(substrate.metallic)};
    return compose<std::uint8_t, 3>(
        own_slots(stack), map, background, options,
        [&](std::uint32_t slot) {
            const TileAppearance appearance = shade_tile(stack, slot, substrate, false);
            TileOut<std::uint8_t, 3> out;
            for (int t = 0; t < kN; ++t) {
                const float metallic = substrate_at(stack, slot, t, substrate).metallic;
                out[t] = {255, unit8(appearance.roughness[t]), unit8(uncovered(stack, slot, t, metallic))};
            }
            return out;
        },
        UnitCode{});
}

bool has_transmission(const Stack& stack, const Substrate& substrate) {
    const auto passes = [](const Substrate& s) { return s.transmission > 0; };
    return passes(substrate) || (stack.substrates && std::ranges::any_of(stack.substrates->others, passes));
}

AtlasMap<std::uint8_t> compose_transmission8(const Stack& stack, const atlas::TexelMap& map, const Substrate& substrate,
                                             const ComposeOptions& options) {
    if (!has_transmission(stack, substrate)) return {.size = map.size, .channels = 1, .texels = {}};
    return compose<std::uint8_t, 1>(
        own_slots(stack), map, {unit8(substrate.transmission)}, options,
        [&](std::uint32_t slot) {
            TileOut<std::uint8_t, 1> out;
            for (int t = 0; t < kN; ++t)
                out[t] = {unit8(uncovered(stack, slot, t, substrate_at(stack, slot, t, substrate).transmission))};
            return out;
        },
        UnitCode{});
}

GutterPlan plan_gutter(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas, const atlas::TexelMap& map) {
    GutterPlan plan;
    plan.gutter = atlas::build_gutter(mesh, atlas, map, atlas.gutter);
    const atlas::Gutter& gutter = plan.gutter;
    std::vector<std::vector<std::uint32_t>> of_slot(map.n_slots());
    for (std::uint32_t entry = 0; entry < gutter.texels.size(); ++entry)
        for (std::uint32_t k = gutter.start[entry]; k < gutter.start[entry + 1]; ++k) {
            std::vector<std::uint32_t>& list = of_slot[gutter.taps[k].texel / kN];
            if (list.empty() || list.back() != entry) list.push_back(entry);
        }
    plan.first_of_slot.push_back(0);
    for (const std::vector<std::uint32_t>& list : of_slot) {
        plan.entries.insert(plan.entries.end(), list.begin(), list.end());
        plan.first_of_slot.push_back(static_cast<std::uint32_t>(plan.entries.size()));
    }
    return plan;
}

}  // namespace tuft::ink
