#include "decal/nest.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atlas/pack/pack_strip.h"

namespace tuft::decal {
namespace {

constexpr double kLeastCell = 5e-4;           // metres
constexpr double kMostAcross = 2000;          // cells
constexpr std::uint32_t kEndless = 1u << 20;  // rows of a roll

}  // namespace

std::vector<NestPlace> nest(const std::vector<NestItem>& items, const Vec2& area, double gap) {
    const double cell = std::max(kLeastCell, area.x / kMostAcross);
    const auto width = static_cast<std::uint32_t>(area.x / cell + 1e-9);
    const std::uint32_t rows = area.y > 0 ? static_cast<std::uint32_t>(area.y / cell + 1e-9) : kEndless;
    std::vector<std::size_t> order(items.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return area_of(items[a].shapes[0]) > area_of(items[b].shapes[0]);
    });
    std::vector<atlas::Strip> pages;
    std::vector<NestPlace> places(items.size());
    for (const std::size_t i : order) {
        std::vector<atlas::Mask> masks;
        bool possible = false;
        for (const Ring& ring : items[i].shapes) {
            atlas::Shape shape;
            shape.border = &ring;
            masks.push_back(atlas::make_masks(shape, 1, 0, cell, false)[0]);
            possible |= masks.back().width <= width && masks.back().height <= rows;
        }
        if (!possible) continue;
        NestPlace& place = places[i];
        for (std::size_t page = 0; !place.fits; ++page) {
            if (page == pages.size()) pages.emplace_back(width, atlas::reach_by_row(gap / cell));
            std::uint32_t lowest = kNone;
            atlas::Strip::Spot best;
            for (std::size_t k = 0; k < masks.size(); ++k) {
                if (masks[k].width > width || masks[k].height > rows) continue;
                const atlas::Strip::Spot spot = pages[page].find(masks[k], 0, rows);
                if (spot.y == kNone || spot.y + masks[k].height >= lowest) continue;
                lowest = spot.y + masks[k].height;
                best = spot;
                place.orientation = k;
            }
            if (lowest == kNone) continue;
            pages[page].place(masks[place.orientation], best);
            place.fits = true;
            place.page = page;
            place.offset = cell * Vec2(best.x, best.y) - masks[place.orientation].corner;
        }
    }
    return places;
}

}  // namespace tuft::decal
