#include "app/view/texture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/system/parallel.h"

namespace tuft::app {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

constexpr std::size_t kTilesAtOnce = 8;                  // of one thread
constexpr int kVeil = 42;                                // percent of the veil's colour
constexpr std::array<int, 3> kVeilColour{64, 104, 178};  // sRGB
constexpr int kRimTexels = 2;                            // charts lie further apart than that
constexpr std::array<int, 3> kMarkColour{0, 190, 255};   // sRGB
constexpr int kMarked[] = {0, 22, 92};                   // percent of it: where there is none, ink, its rim
constexpr int kDarkMarked = 60;                          // of it on black ink: near black a little light is not seen

// Averages are of light, not of its code values.
struct SrgbTable {
    const std::array<float, 256>& decode = ink::linear_of_code();
    std::array<std::uint8_t, 4096> encode{};
    SrgbTable() {
        for (std::size_t i = 0; i < encode.size(); ++i)
            encode[i] =
                static_cast<std::uint8_t>(std::lround(255.0f * ink::srgb_encode(static_cast<float>(i) / 4095.0f)));
    }
};

const SrgbTable& srgb() {
    static const SrgbTable table;
    return table;
}

// Mean of four texels weighted by the texels of the first level that each stands for; plain where none is filled.
Rgba mean(const std::array<Rgba, 4>& of, std::array<int, 4> weight) {
    const SrgbTable& t = srgb();
    int all = weight[0] + weight[1] + weight[2] + weight[3];
    if (all == 0) weight = {1, 1, 1, 1}, all = 4;
    std::array<float, 3> light{};
    int height = all / 2;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 3; ++k) light[k] += static_cast<float>(weight[i]) * t.decode[of[i][k]];
        height += weight[i] * of[i][3];
    }
    Rgba out;
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = t.encode[static_cast<std::size_t>(std::lround(4095.0f * (light[k] / static_cast<float>(all))))];
    out[3] = static_cast<std::uint8_t>(height / all);
    return out;
}

// Halves `from` and its weights into `side`² texels.
void halve(const Rgba* from, const int* weights, Rgba* to, int* sums, std::size_t side) {
    for (std::size_t y = 0; y < side; ++y)
        for (std::size_t x = 0; x < side; ++x) {
            const std::size_t p = 4 * side * y + 2 * x, q = p + 2 * side;
            const std::array<int, 4> w{weights[p], weights[p + 1], weights[q], weights[q + 1]};
            to[side * y + x] = mean({from[p], from[p + 1], from[q], from[q + 1]}, w);
            sums[side * y + x] = w[0] + w[1] + w[2] + w[3];
        }
}

std::uint8_t code_of(float micrometres) {
    return static_cast<std::uint8_t>(
        std::lround(std::min(255.0, render::code_of_height(std::max(0.0, static_cast<double>(micrometres))))));
}

// Micrometres of liquid on and in the surface, of all layers.
std::array<float, atlas::kTileTexels> liquid_of(const stroke::Document& painting, std::uint32_t slot) {
    std::array<float, atlas::kTileTexels> wet{};
    for (const stroke::LayerTexels& layer : painting.layers().canvases())
        for (const ink::Liquid where : {ink::Liquid::film, ink::Liquid::pores})
            if (const ink::Plane* plane = layer.canvas->liquid(slot, where))
                for (std::size_t t = 0; t < atlas::kTileTexels; ++t)
                    wet[t] += static_cast<float>(1e6 * ink::kFilmUnit) * (*plane)[t];
    return wet;
}

}  // namespace

void Texture::show_wetness(bool on, const stroke::Document& painting) {
    if (wetness_ == on) return;
    wetness_ = on;
    refresh_heights(painting.appearance().stack().touched_slots(), painting);
}

Texture::Texture(const stroke::Document& painting, const ProgressFn& progress) {
    const stroke::Model& model = painting.model();
    const stroke::Appearance& shown = painting.appearance();
    report(progress, "picture of the ink", 0);
    const ink::ComposeOptions options = shown.compose_options();
    report(progress, "picture of the ink", 0.6);
    colour_ = ink::compose_srgb8(shown.stack(), model.texels, shown.substrate(), options);
    padded_ = model.texels.tiles_per_side * atlas::kTile;
    find_filled(model.texels, options.seams->gutter);
    height_.assign(static_cast<std::size_t>(colour_.size) * colour_.size, 0);
    refresh_heights(shown.stack().touched_slots(), painting);
    report(progress, "picture of the ink", 1);
}

void Texture::find_filled(const atlas::TexelMap& map, const atlas::Gutter& gutter) {
    filled_.assign(std::size_t{map.tiles_per_side} * map.tiles_per_side, {});
    parallel_for(map.n_slots(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slot = begin; slot < end; ++slot)
            for (std::size_t t = 0; t < atlas::kTileTexels; ++t)
                if (map.tiles[slot].cluster[t] != atlas::kNoCluster) filled_[map.tile_of_slot[slot]].set(t);
    });
    for (const std::uint32_t texel : gutter.texels) {
        const std::size_t x = texel % gutter.size, y = texel / gutter.size;
        filled_[y / atlas::kTile * map.tiles_per_side + x / atlas::kTile].set(y % atlas::kTile * atlas::kTile +
                                                                              x % atlas::kTile);
    }
}

void Texture::refresh_heights(std::span<const std::uint32_t> slots, const stroke::Document& painting) {
    const atlas::TexelMap& map = painting.model().texels;
    const ink::Stack stack = painting.appearance().stack();
    const std::size_t size = colour_.size;
    parallel_for(slots.size(), kTilesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (const std::uint32_t slot : slots.subspan(begin, end - begin)) {
            const auto [x0, y0] = atlas::texel_place(map, slot, 0);
            std::array<float, atlas::kTileTexels> height{};
            if (wetness_)
                height = liquid_of(painting, slot);
            else if (stack.touched(slot))
                height = ink::shade_tile(stack, slot, painting.appearance().substrate(), false).height;
            for (std::size_t t = 0; t < atlas::kTileTexels; ++t) {
                const std::size_t x = static_cast<std::size_t>(x0) + t % atlas::kTile,
                                  y = static_cast<std::size_t>(y0) + t / atlas::kTile;
                if (x < size && y < size && map.tiles[slot].cluster[t] != atlas::kNoCluster)
                    height_[y * size + x] = code_of(height[t]);
            }
        }
    });
    for (const std::uint32_t slot : slots) continue_over_seams(height_, slot, painting);
}

// Gutter texels that take something from the slot take it now.
void Texture::continue_over_seams(std::vector<std::uint8_t>& values, std::uint32_t slot,
                                  const stroke::Document& painting) const {
    const atlas::TexelMap& map = painting.model().texels;
    const ink::GutterPlan& plan = *painting.appearance().compose_options().seams;
    const std::size_t size = colour_.size;
    for (std::uint32_t e = plan.first_of_slot[slot]; e < plan.first_of_slot[slot + 1]; ++e) {
        const std::uint32_t entry = plan.entries[e];
        float sum = 0;
        for (std::uint32_t k = plan.gutter.start[entry]; k < plan.gutter.start[entry + 1]; ++k) {
            const atlas::GutterTap& tap = plan.gutter.taps[k];
            const atlas::TexelPlace at =
                atlas::texel_place(map, tap.texel / atlas::kTileTexels, tap.texel % atlas::kTileTexels);
            sum += tap.weight * static_cast<float>(values[static_cast<std::size_t>(at.y) * size + at.x]);
        }
        values[plan.gutter.texels[entry]] = static_cast<std::uint8_t>(std::clamp(sum, 0.0f, 255.0f));
    }
}

void Texture::show_veil(const stroke::MaskTexels* mask, const stroke::Document& painting) {
    veil_.clear();
    if (!mask) return;
    const atlas::TexelMap& map = painting.model().texels;
    const std::size_t size = colour_.size;
    veil_.assign(size * size, 0);
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) {
        const auto [x0, y0] = atlas::texel_place(map, slot, 0);
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const std::size_t x = static_cast<std::size_t>(x0 + t % atlas::kTile),
                              y = static_cast<std::size_t>(y0 + t / atlas::kTile);
            if (x < size && y < size && map.tiles[slot].cluster[static_cast<std::size_t>(t)] != atlas::kNoCluster)
                veil_[y * size + x] = static_cast<std::uint8_t>(255 - mask->coverage(slot, t));
        }
    }
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot) continue_over_seams(veil_, slot, painting);
}

std::vector<render::TilePixels> Texture::show_marks(Marks marks, const stroke::Document& painting) {
    const atlas::TexelMap& map = painting.model().texels;
    std::vector<atlas::TexelPlace> inked;
    for (const auto& [slot, tile] : marks)
        for (std::uint32_t t = 0; t < atlas::kTileTexels; ++t)
            if (tile[t] == kInked) inked.push_back(atlas::texel_place(map, slot, t));
    for (const auto& [x0, y0] : inked)
        for (int dy = -kRimTexels; dy <= kRimTexels; ++dy)
            for (int dx = -kRimTexels; dx <= kRimTexels; ++dx) {
                if (dx * dx + dy * dy > kRimTexels * kRimTexels) continue;
                const atlas::TexelRef ref = atlas::texel_ref(map, x0 + dx, y0 + dy);
                if (!ref.valid()) continue;
                std::uint8_t& mark = marks[ref.slot][ref.texel];
                if (mark == kNotMarked) mark = kRim;
            }
    std::set<std::uint32_t> changed;
    for (const auto& [tile, old] : marks_of_tile_) changed.insert(tile);
    marks_ = std::move(marks);
    marks_of_tile_.clear();
    for (const auto& [slot, tile] : marks_) marks_of_tile_[map.tile_of_slot[slot]] = &tile;
    for (const auto& [tile, fresh] : marks_of_tile_) changed.insert(tile);
    return tiles_at(std::vector(changed.begin(), changed.end()), map);
}

void Texture::refresh_all(const stroke::Document& painting) {
    const stroke::Appearance& shown = painting.appearance();
    colour_ = ink::compose_srgb8(shown.stack(), painting.model().texels, shown.substrate(), shown.compose_options());
    refresh_heights(shown.stack().touched_slots(), painting);
}

std::array<std::uint8_t, 4> Texture::texel(std::size_t x, std::size_t y) const {
    const std::size_t at = y * colour_.size + x;
    Rgba out{colour_.texels[3 * at], colour_.texels[3 * at + 1], colour_.texels[3 * at + 2], height_[at]};
    if (!veil_.empty() && veil_[at] != 0)
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = static_cast<std::uint8_t>(out[c] + veil_[at] * kVeil * (kVeilColour[c] - out[c]) / (255 * 100));
    if (marks_of_tile_.empty()) return out;
    const auto marked =
        marks_of_tile_.find(static_cast<std::uint32_t>(y / atlas::kTile * (padded_ / atlas::kTile) + x / atlas::kTile));
    if (marked == marks_of_tile_.end()) return out;
    const Mark mark = static_cast<Mark>((*marked->second)[y % atlas::kTile * atlas::kTile + x % atlas::kTile]);
    int part = kMarked[mark];
    if (mark == kInked) part = kDarkMarked + (part - kDarkMarked) * std::max({out[0], out[1], out[2]}) / 255;
    if (part > 0)
        for (std::size_t c = 0; c < 3; ++c)
            out[c] = static_cast<std::uint8_t>(out[c] + part * (kMarkColour[c] - out[c]) / 100);
    return out;
}

render::TilePixels Texture::tile(std::uint32_t index) const {
    render::TilePixels out;
    out.tile = index;
    const std::size_t per_side = padded_ / atlas::kTile, size = colour_.size;
    const std::size_t x0 = index % per_side * atlas::kTile, y0 = index / per_side * atlas::kTile;
    for (std::size_t t = 0; t < atlas::kTileTexels; ++t) {
        const std::size_t x = std::min(size - 1, x0 + t % atlas::kTile), y = std::min(size - 1, y0 + t / atlas::kTile);
        out.rgba[t] = texel(x, y);
    }
    std::array<int, render::TilePixels::kStart.back()> weights;
    for (std::size_t t = 0; t < atlas::kTileTexels; ++t) weights[t] = filled_[index][t];
    for (std::size_t level = 1; level < render::kTextureLevels; ++level) {
        const auto finer = static_cast<std::size_t>(render::TilePixels::kStart[level - 1]),
                   here = static_cast<std::size_t>(render::TilePixels::kStart[level]);
        halve(&out.rgba[finer], &weights[finer], &out.rgba[here], &weights[here],
              static_cast<std::size_t>(atlas::kTile) >> level);
    }
    return out;
}

render::MapPixels Texture::pixels() const {
    render::MapPixels map;
    map.size = padded_;
    const std::size_t padded = padded_, per_side = padded / atlas::kTile;
    for (std::size_t level = 0; level < render::kTextureLevels; ++level)
        map.levels[level].resize((padded >> level) * (padded >> level));
    parallel_for(per_side * per_side, 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t index = begin; index < end; ++index) {
            const render::TilePixels one = tile(static_cast<std::uint32_t>(index));
            for (std::size_t level = 0; level < render::kTextureLevels; ++level) {
                const std::size_t side = static_cast<std::size_t>(atlas::kTile) >> level, stride = padded >> level;
                const Rgba* from = &one.rgba[static_cast<std::size_t>(render::TilePixels::kStart[level])];
                Rgba* to = &map.levels[level][index / per_side * side * stride + index % per_side * side];
                for (std::size_t y = 0; y < side; ++y) std::copy_n(from + y * side, side, to + y * stride);
            }
        }
    });
    return map;
}

std::vector<render::TilePixels> Texture::refresh(std::span<const std::uint32_t> slots,
                                                 const stroke::Document& painting) {
    if (slots.empty()) return {};
    const stroke::Model& model = painting.model();
    const stroke::Appearance& shown = painting.appearance();
    const ink::ComposeOptions options = shown.compose_options();
    ink::refresh_srgb8(colour_, slots, shown.stack(), model.texels, shown.substrate(), options);
    refresh_heights(slots, painting);
    return tiles_at(ink::refreshed_tiles(slots, model.texels, options), model.texels);
}

std::vector<render::TilePixels> Texture::tiles_at(std::span<const std::uint32_t> indices, const atlas::TexelMap& map) {
    std::vector<render::TilePixels> tiles(indices.size());
    parallel_for(tiles.size(), kTilesAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) tiles[i] = tile(indices[i]);
    });
    for (render::TilePixels& tile : tiles) tile.boxes = boxes_of(tile.tile, map);
    return tiles;
}

// The coarsest level has one texel per tile, and filtering reaches half a tile beyond it. What lies there need
// not lie together on the model: parts far from each other get boxes of their own.
const std::vector<render::GlBox>& Texture::boxes_of(std::uint32_t index, const atlas::TexelMap& map) {
    const auto [at, is_new] = boxes_.try_emplace(index);
    std::vector<render::GlBox>& boxes = at->second;
    if (!is_new) return boxes;
    constexpr int kReach = atlas::kTile / 2;
    const auto texel = static_cast<float>(map.texel_size);
    const float widest = 4 * atlas::kTile * texel;
    const int per_side = static_cast<int>(map.tiles_per_side);
    const int x0 = static_cast<int>(index) % per_side * atlas::kTile,
              y0 = static_cast<int>(index) / per_side * atlas::kTile;
    const int most = per_side * atlas::kTile;
    for (int y = std::max(0, y0 - kReach); y < std::min(most, y0 + atlas::kTile + kReach); ++y)
        for (int x = std::max(0, x0 - kReach); x < std::min(most, x0 + atlas::kTile + kReach); ++x) {
            const atlas::TexelRef ref = atlas::texel_ref(map, x, y);
            if (!ref.valid()) continue;
            const Vec3f centre = map.position(ref.slot, ref.texel), lo = centre - 2 * texel, hi = centre + 2 * texel;
            const auto near = std::ranges::find_if(boxes, [&](const render::GlBox& b) {
                const Vec3f size = glm::max(b.hi, hi) - glm::min(b.lo, lo);
                return std::max({size.x, size.y, size.z}) <= widest;
            });
            if (near == boxes.end())
                boxes.push_back({lo, hi});
            else
                *near = {glm::min(near->lo, lo), glm::max(near->hi, hi)};
        }
    return boxes;
}

}  // namespace tuft::app
