#include "stroke/painting/apply_area.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/system/parallel.h"
#include "ink/exchange/erase.h"

namespace tuft::stroke {
namespace {

constexpr int kScanLines = 16;  // scan lines a cell
constexpr std::size_t kMostCells = std::size_t{1} << 26;

/// An edge that crosses scan lines; up or down.
struct ScanEdge {
    Vec2 from, to;  ///< cells; from.y < to.y
    int turn;       ///< +1 where the ring runs towards +y
};

std::vector<ScanEdge> scan_edges(const FlatArea& area, const Vec2& low, double cell) {
    std::vector<ScanEdge> edges;
    for (const auto& ring : area.rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 a = (ring[i] - low) / cell, b = (ring[i + 1 < ring.size() ? i + 1 : 0] - low) / cell;
            if (a.y < b.y) edges.push_back({a, b, 1});
            if (a.y > b.y) edges.push_back({b, a, -1});
        }
    std::sort(edges.begin(), edges.end(), [](const ScanEdge& a, const ScanEdge& b) {
        return std::pair(a.from.y, a.from.x) < std::pair(b.from.y, b.from.x);
    });
    return edges;
}

/// Adds what lies right of x on one scan line to the differences of a row of cells, `sign` times.
void add_step(std::vector<float>& row, double x, float sign) {
    x = std::clamp(x, 0.0, static_cast<double>(row.size() - 2));
    const auto i = static_cast<std::size_t>(x);
    const auto part = static_cast<float>(x - static_cast<double>(i));
    row[i] += sign * (1 - part);
    row[i + 1] += sign * part;
}

/// Mixture of the stops round a parameter.
struct StopBlend {
    std::size_t stop = 0;  ///< the one before
    double towards = 0;    ///< to the next one
};
StopBlend blend_at(const std::vector<AreaStop>& stops, double t) {
    std::size_t next = 0;
    while (next < stops.size() && stops[next].at <= t) ++next;
    if (next == 0) return {0, 0};
    if (next == stops.size()) return {stops.size() - 1, 0};
    const double from = stops[next - 1].at, to = stops[next].at;
    return {next - 1, (t - from) / (to - from)};
}

/// Films and removal of one tile.
struct TileArea {
    alignas(64) std::array<float, atlas::kTileTexels> cover{}, remove{};
    std::array<StopBlend, atlas::kTileTexels> blend{};
    bool any = false;
};

/// Coverage of texels `width` wide by an area and by what it reaches under.
class AreaCover {
  public:
    AreaCover(const FlatArea& area, const SurfaceLattice& lattice, double width)
        : width_(width), own_(raster_of(area, lattice, 0.5 * width)) {
        if (area.under.empty()) return;
        under_.emplace(FlatArea{.rings = area.under, .placement = {}, .stops = {}}, own_);
    }

    double at(const Vec2& p) const {
        const double own = own_.mean(p, width_);
        if (!under_ || own >= 1 || !is_near(p)) return own;
        return std::min(1.0, own + under_->mean(p, width_));
    }
    Vec2f low() const { return Vec2f(own_.low() - 2 * width_); }
    Vec2f high() const { return Vec2f(own_.high() + 2 * width_); }

  private:
    // A texel a width from the area may lie partly beyond the later one's edge.
    bool is_near(const Vec2& p) const {
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                if (own_.mean(p + width_ * Vec2(x, y), width_) > 0) return true;
        return false;
    }

    double width_;
    AreaRaster own_;
    std::optional<AreaRaster> under_;
};

void find_cover(TileArea& out, const FlatTexels::Tile& tile, const FlatArea& area, const AreaCover& cover,
                double width) {
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const Vec2 p(tile.at[t]);
        if (!(p.x == p.x)) continue;
        const double c = cover.at(p);
        if (c < 1.0 / 512) continue;
        out.cover[t] = static_cast<float>(c);
        out.blend[t] = area.stops.size() > 1 ? blend_at(area.stops, along_area(area, p, width)) : StopBlend{};
        out.any = true;
    }
}

/// The part of what a texel holds that goes before the coat comes: its cover times the opacity there.
void set_removal(TileArea& part, const std::vector<AreaStop>& stops) {
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const auto [stop, towards] = part.blend[t];
        const double next = stops[std::min(stop + 1, stops.size() - 1)].opacity;
        const double opacity = stops[stop].opacity + towards * (next - stops[stop].opacity);
        part.remove[t] = part.cover[t] * static_cast<float>(opacity);
    }
}

/// The films of the coat from one stop to the next. Returns whether there is any.
bool set_films(ink::Coat& coat, const TileArea& part, std::size_t stop, std::span<const double> films) {
    const double from = films[stop], to = films[std::min(stop + 1, films.size() - 1)];
    bool any = false;
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        const auto [own, towards] = part.blend[t];
        const double film = from + towards * (to - from);
        coat.film[t] = own == stop ? part.cover[t] * static_cast<float>(film) : 0.0f;
        // Amounts, not fractions, are linear: the thicker film has more of a say.
        coat.towards[t] = own == stop && film > 0 ? static_cast<float>(towards * to / film) : 0.0f;
        any = any || coat.film[t] > 0;
    }
    return any;
}

}  // namespace

AreaRaster::AreaRaster(const FlatArea& area, double cell, const AreaRaster* same) : cell_(cell) {
    Vec2 low(HUGE_VAL), high(-HUGE_VAL);
    for (const auto& ring : area.rings)
        for (const Vec2& p : ring) low = glm::min(low, p), high = glm::max(high, p);
    if (!(low.x < high.x && low.y < high.y)) return;
    const Vec2 size = high - low;
    if (same) {
        constexpr int kAround = 8;  // cells: it is read up to 5 beside the other
        cell_ = same->cell_;
        low_ = same->low_ - kAround * cell_;
        width_ = same->width_ + 2 * kAround;
        height_ = same->height_ + 2 * kAround;
    } else {
        cell_ = std::max(cell_, std::sqrt(size.x * size.y / double(kMostCells)));
        cell_ = std::max({cell_, size.x / 1e6, size.y / 1e6});
        low_ = low - cell_;
        width_ = static_cast<int>(std::ceil(size.x / cell_)) + 2;
        height_ = static_cast<int>(std::ceil(size.y / cell_)) + 2;
    }
    coverage_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
    const std::vector<ScanEdge> edges = scan_edges(area, low_, cell_);
    std::vector<std::size_t> active;
    std::vector<std::pair<double, int>> crossings;
    std::vector<float> row(static_cast<std::size_t>(width_) + 2);  // differences of neighbours
    std::size_t next = 0;
    for (int j = 0; j < height_; ++j) {
        std::fill(row.begin(), row.end(), 0.0f);
        for (int k = 0; k < kScanLines; ++k) {
            const double y = j + (k + 0.5) / kScanLines;
            while (next < edges.size() && edges[next].from.y <= y) active.push_back(next++);
            std::erase_if(active, [&](std::size_t e) { return edges[e].to.y <= y; });
            crossings.clear();
            for (const std::size_t e : active) {
                const ScanEdge& edge = edges[e];
                const double t = (y - edge.from.y) / (edge.to.y - edge.from.y);
                crossings.emplace_back(edge.from.x + t * (edge.to.x - edge.from.x), edge.turn);
            }
            std::sort(crossings.begin(), crossings.end());
            int winding = 0;
            for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
                winding += crossings[i].second;
                if (area.even_odd ? i % 2 == 0 : winding != 0)
                    add_step(row, crossings[i].first, 1), add_step(row, crossings[i + 1].first, -1);
            }
        }
        std::uint8_t* out = &coverage_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_)];
        float sum = 0;
        for (int i = 0; i < width_; ++i) {
            sum += row[static_cast<std::size_t>(i)];
            out[i] = static_cast<std::uint8_t>(std::lround(std::clamp(255.0f / kScanLines * sum, 0.0f, 255.0f)));
        }
    }
}

double AreaRaster::at(const Vec2& point) const {
    const Vec2 q = (point - low_) / cell_ - 0.5;
    if (!(q.x > -1 && q.y > -1 && q.x < width_ && q.y < height_)) return 0;
    const int i = static_cast<int>(std::floor(q.x)), j = static_cast<int>(std::floor(q.y));
    const double u = q.x - i, v = q.y - j;
    const auto cell = [&](int x, int y) -> double {
        if (x < 0 || y < 0 || x >= width_ || y >= height_) return 0;
        return coverage_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    };
    return ((1 - v) * ((1 - u) * cell(i, j) + u * cell(i + 1, j)) +
            v * ((1 - u) * cell(i, j + 1) + u * cell(i + 1, j + 1))) /
           255;
}

double AreaRaster::mean(const Vec2& point, double width) const {
    const double d = 0.25 * width;
    return 0.25 *
           (at(point + Vec2(-d, -d)) + at(point + Vec2(d, -d)) + at(point + Vec2(-d, d)) + at(point + Vec2(d, d)));
}

AreaRaster raster_of(const FlatArea& area, const SurfaceLattice& lattice, double cell) {
    if (area.lines.empty() || lattice.at.empty()) return AreaRaster(area, cell);
    FlatArea even = area;
    even.rings = even_rings(area, lattice);
    return AreaRaster(even, cell);
}

FillResult apply_area(const Fill& fill, const PaintTarget& target, const FlatTexels& texels,
                      std::span<const ink::Mix> mixes, std::span<const double> films) {
    const FlatArea& area = *fill.area;
    const atlas::TexelMap& map = target.model.texels;
    const double width = map.texel_size;
    const AreaCover cover(area, texels.lattice(), width);
    const Vec2f low = cover.low(), high = cover.high();
    std::vector<const FlatTexels::Tile*> tiles, masked;
    for (const FlatTexels::Tile& tile : texels.tiles())
        if (tile.low.x <= high.x && tile.low.y <= high.y && tile.high.x >= low.x && tile.high.y >= low.y)
            (target.mask && target.mask->none(tile.slot) ? masked : tiles).push_back(&tile);

    std::vector<TileArea> parts(tiles.size());
    parallel_for(tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            find_cover(parts[i], *tiles[i], area, cover, width);
            if (parts[i].any && target.mask) target.mask->apply(tiles[i]->slot, parts[i].cover);
            set_removal(parts[i], area.stops);
        }
    });
    FillResult result;
    for (std::size_t i = 0; i < tiles.size(); ++i)
        if (parts[i].any) result.before.push_back(target.canvas.snapshot(tiles[i]->slot));
    result.met = !result.before.empty() || std::ranges::any_of(masked, [&](const FlatTexels::Tile* tile) {
        TileArea part;
        find_cover(part, *tile, area, cover, width);
        return part.any;
    });

    std::vector<ink::Amounts> deposited(tiles.size());
    parallel_for(tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
        ink::Coat coat;
        for (std::size_t i = begin; i < end; ++i) {
            const TileArea& part = parts[i];
            if (!part.any) continue;
            const std::uint32_t slot = tiles[i]->slot;
            ink::take_part(target.canvas, slot, map.tiles[slot].area, part.remove);
            for (std::size_t stop = 0; stop < area.stops.size(); ++stop) {
                if (!set_films(coat, part, stop, films)) continue;
                coat.first = mixes[stop];
                coat.second = mixes[std::min(stop + 1, area.stops.size() - 1)];
                deposited[i] += ink::add_coat(target.canvas, slot, map.tiles[slot].area, coat, target.capacity(slot));
            }
        }
    });
    for (const ink::Amounts& a : deposited) result.ink_given += a.sum();
    return result;
}

}  // namespace tuft::stroke
