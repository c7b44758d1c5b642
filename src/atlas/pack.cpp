#include "atlas/pack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "atlas/pack_mask.h"
#include "atlas/pack_strip.h"
#include "core/random.h"

namespace tuft::atlas {
namespace {

constexpr double kSmallest = 0.25;  // texels: extent below which a chart is enlarged
constexpr double kLeastUse = 1e-3;  // part of the page that charts must cover to "fit"
constexpr std::uint32_t kCells =
    1024;  // cells per side of the page that masks are made on, at most
constexpr std::uint32_t kCoarseCells = 512;  // the same while searching
constexpr double kStep = 1.01;               // by which the search raises the scale
constexpr double kFineStep = 1.003;          // the same on fine masks
constexpr double kOverhang = 1.3;  // height of the strip while searching, over the page's
constexpr int kFineShare = 6;                // of the trials, that fine masks get
constexpr double kTrials = 8000;             // charts placed while searching, about
constexpr double kCoarseTrials = 800;        // the same when layouts are only compared
constexpr int kStarts = 3;                   // searches, of which the best counts

struct Layout {
    double excess = 0;  // sum of area × rows beyond the page, all of the strip's without a place
    std::uint32_t first_beyond = kNone;  // the first chart that reaches beyond the page
    std::uint32_t rows = 0;              // cells, up to the highest chart
    double scale = 0;
    std::vector<Placement> placements;
    std::vector<std::uint8_t> placed;  // [n_charts]

    bool complete() const { return scale > 0 && first_beyond == kNone; }
    bool all_placed() const { return std::find(placed.begin(), placed.end(), 0) == placed.end(); }
};

/// What the search varies: which chart comes when, and how each is turned to begin with.
struct Plan {
    std::vector<std::uint32_t> order;
    std::vector<double> turn;  // radians, added to the smallest rectangle's angle
};

/// A square page as masks see it.
struct Page {
    std::uint32_t size;   // texels per side
    std::uint32_t cell;   // texels per cell
    std::uint32_t cells;  // per side, within the margin
};

class Packer {
  public:
    Packer(const std::vector<std::vector<Vec2>>& borders, std::uint32_t gutter,
           const ProgressFn& progress)
        : gutter_(gutter), progress_(progress) {
        for (const auto& border : borders) {
            shapes_.push_back(make_shape(border));
            area_ += shapes_.back().area;
        }
        plan_.order.resize(shapes_.size());
        plan_.turn.assign(shapes_.size(), 0);
        std::iota(plan_.order.begin(), plan_.order.end(), 0u);
        std::stable_sort(plan_.order.begin(), plan_.order.end(),
                         [&](auto a, auto b) { return shapes_[a].area > shapes_[b].area; });
        cache_.resize(shapes_.size());
    }

    double area() const { return area_; }

    Page page(std::uint32_t size, std::uint32_t most_cells) const {
        Page page{size, std::max(1u, (size + most_cells - 1) / most_cells), 0};
        if (size > 2 * margin()) page.cells = (size - 2 * margin()) / page.cell;
        return page;
    }

    /// Fills a strip as wide as the page, at most `limit` times as high; gives up when its
    /// excess is beyond `hopeless`.
    Layout fill(const Page& page, double scale, double limit,
                double hopeless = std::numeric_limits<double>::infinity()) {
        Layout layout;
        layout.scale = scale;
        layout.placements.resize(shapes_.size());
        layout.placed.assign(shapes_.size(), 0);
        const double cell = page.cell;
        const auto most_rows = static_cast<std::uint32_t>(limit * page.cells);
        Strip strip(page.cells, reach_of_gutter(page.cell));
        std::unordered_map<std::uint64_t, std::uint32_t> lowest;  // row, by the mask's hash
        for (const std::uint32_t i : plan_.order) {
            const Masks& masks = masks_of(i, scale, cell);
            const Mask* best = nullptr;
            Strip::Spot spot;
            std::uint32_t best_top = most_rows + 1;
            for (const Mask& mask : masks.turned) {
                std::uint32_t& from = lowest[mask.hash];
                if (from + mask.height >= best_top) continue;
                const Strip::Spot s = strip.find(mask, from, std::min(best_top - 1, most_rows));
                if (s.y == kNone) continue;
                from = s.y;
                best_top = s.y + mask.height;
                spot = s;
                best = &mask;
            }
            if (best == nullptr || best_top > page.cells) {
                if (layout.first_beyond == kNone) layout.first_beyond = i;
                layout.excess += shapes_[i].area * (std::min(best_top, most_rows) - page.cells);
                if (layout.excess > hopeless) break;
                if (best == nullptr) continue;
            }
            strip.place(*best, spot);
            layout.placed[i] = 1;
            layout.placements[i] = {masks.chart_scale, best->c, best->s,
                                    Vec2(spot.x, spot.y) * cell + Vec2(margin()) - best->corner};
        }
        layout.rows = strip.top();
        return layout;
    }

    /// The largest scale found at which everything fits the page: after a first fit, a
    /// search on coarse masks raises the scale step by step and looks for an order and
    /// turns that fit, three times from the same start; then the masks are refined. Not
    /// complete when nothing fits.
    Layout largest(std::uint32_t size, Search search) {
        const double per_chart = search == Search::full ? kTrials : kCoarseTrials;
        const int trials =
            std::clamp(static_cast<int>(per_chart / static_cast<double>(shapes_.size() + 1)), 9,
                       search == Search::full ? 300 : 48);
        const double full = size / std::sqrt(area_);
        const double least = std::sqrt(kLeastUse) * full;
        const Page coarse = page(size, kCoarseCells), fine = page(size, kCells);
        Layout best;
        if (fine.cells == 0) return best;
        double step = 0.97;
        for (double scale = 0.85 * full; !best.complete(); scale *= step) {
            if (scale < least) scale = least;
            Layout layout = fill(coarse, scale, 1);
            if (layout.complete()) best = std::move(layout);
            if (scale == least) break;
            if (scale < 0.6 * full) step = 0.9;
        }
        if (!best.complete()) {
            best = fill(fine, least, 1);
            return best;
        }
        if (search == Search::quick) return best;
        Random random(shapes_.size());
        const Layout first = best;
        const Plan first_plan = plan_;
        Plan best_plan = plan_;
        for (int start = 0; start < kStarts; ++start) {
            Layout layout = first;
            plan_ = first_plan;
            climb(coarse, kStep, trials / kStarts, random, layout);
            report(progress_, "pack", 0.8 * (start + 1) / kStarts);
            if (layout.scale <= best.scale) continue;
            best = std::move(layout);
            best_plan = plan_;
        }
        plan_ = best_plan;
        if (search == Search::coarse || fine.cell == coarse.cell) return best;
        for (double scale = 1.03 * best.scale; scale > best.scale; scale *= 0.996) {
            Layout layout = fill(fine, scale, 1);
            if (!layout.complete()) continue;
            best = std::move(layout);
            break;
        }
        climb(fine, kFineStep, trials / kFineShare, random, best);
        report(progress_, "pack", 1);
        return best;
    }

    /// Raises the scale of a layout step by step, looking for an order and turns that fit:
    /// fewer and smaller charts, less far beyond the page's edge.
    void climb(const Page& page, double step, int trials, Random& random, Layout& best) {
        double excess = std::numeric_limits<double>::infinity();
        std::uint32_t failed = kNone;
        bool climbing = true;  // the plan as it is has not failed at the target yet
        for (int trial = 0; trial < trials; ++trial) {
            const Plan before = plan_;
            if (!climbing) vary(random, failed);
            Layout layout = fill(page, step * best.scale, kOverhang, excess);
            climbing = layout.complete();
            if (climbing) {
                best = std::move(layout);
                excess = std::numeric_limits<double>::infinity();
            } else if (layout.excess <= excess) {
                excess = layout.excess;
                failed = layout.first_beyond;
            } else {
                plan_ = before;
            }
        }
    }

    /// All charts at a given scale within the page.
    Layout at_scale(std::uint32_t size, double scale, double limit) {
        return fill(page(size, kCells), scale, limit);
    }

    /// Charts on as many pages as they need, up to `most`; see `Packing`.
    Packing on_pages(std::uint32_t size, std::uint32_t most_cells, double scale,
                     std::uint32_t most) {
        Packing packing;
        packing.size = size;
        packing.texels_per_unit = scale;
        packing.placements.resize(shapes_.size());
        packing.page.assign(shapes_.size(), 0);
        const std::vector<std::uint32_t> order = plan_.order;
        std::uint32_t used = 0;
        for (; !plan_.order.empty() && used <= most; ++used) {
            const Layout layout = fill(page(size, most_cells), scale, 1);
            std::vector<std::uint32_t> left;
            for (const std::uint32_t i : plan_.order) {
                if (!layout.placed[i]) {
                    left.push_back(i);
                    continue;
                }
                packing.placements[i] = layout.placements[i];
                packing.page[i] = used;
            }
            if (left.size() == plan_.order.size()) {  // not even on a page of their own
                packing.too_large = std::move(left);
                std::sort(packing.too_large.begin(), packing.too_large.end());
                break;
            }
            plan_.order = std::move(left);
        }
        packing.pages = std::max(used, 1u);
        packing.fits = plan_.order.empty() && used <= most;
        plan_.order = order;
        return packing;
    }

    /// The largest scale at which all charts lie on `most` pages, by steps of 1.5 %.
    Packing fill_pages(std::uint32_t size, std::uint32_t most, Search search) {
        const double full = size * std::sqrt(most / area_);
        Packing packing;
        for (double scale = 0.92 * full; scale > std::sqrt(kLeastUse) * full; scale *= 0.985) {
            report(progress_, "pack", std::clamp((0.92 * full / scale - 1) / 0.3, 0.0, 1.0));
            packing = on_pages(size, search == Search::full ? kCells : kCoarseCells, scale, most);
            if (packing.fits) break;
        }
        return packing;
    }

  private:
    /// The masks of one chart in four directions, for one scale and turn.
    struct Masks {
        double scale = 0, cell = 0, turn = 0, chart_scale = 0;
        std::vector<Mask> turned;
    };

    std::uint32_t margin() const { return (gutter_ + 1) / 2; }

    const Masks& masks_of(std::uint32_t i, double scale, double cell) {
        Masks& m = cache_[i];
        const Shape& shape = shapes_[i];
        if (m.scale == scale && m.cell == cell && m.turn == plan_.turn[i]) return m;
        m.scale = scale;
        m.cell = cell;
        m.turn = plan_.turn[i];
        m.chart_scale = std::max(scale, shape.extent > 0 ? kSmallest / shape.extent : scale);
        m.turned.clear();
        const int turns = shape.extent * m.chart_scale < 2 * cell ? 1 : 4;
        for (int k = 0; k < turns; ++k)
            m.turned.push_back(make_mask(shape, m.chart_scale,
                                         shape.angle + m.turn + k * (std::numbers::pi / 2), cell));
        return m;
    }

    /// A chance change of the plan: what found no place comes earlier, two charts change
    /// places, one is turned. Large charts are changed more often.
    void vary(Random& random, std::uint32_t failed) {
        auto& order = plan_.order;
        const auto pick = [&] {
            const double u = random.uniform();
            return static_cast<std::size_t>(u * u * static_cast<double>(order.size()));
        };
        const double kind = random.uniform();
        if (failed != kNone && kind < 0.3) {
            const auto at = std::find(order.begin(), order.end(), failed);
            const auto earlier = static_cast<std::ptrdiff_t>(
                random.uniform() * static_cast<double>(at - order.begin()));
            std::rotate(order.begin() + earlier, at, at + 1);
            if (kind < 0.15) plan_.turn[failed] = random.uniform(0, std::numbers::pi / 2);
        } else if (kind < 0.65) {
            std::swap(order[pick()], order[pick()]);
        } else {
            plan_.turn[order[pick()]] = kind < 0.75 ? 0 : random.uniform(0, std::numbers::pi / 2);
        }
    }

    /// Cells to block on both sides of a taken one, by row distance: those less than a
    /// gutter away. Cells d apart (in x and y) have |(max(d − 1, 0)) cell| between them.
    std::vector<int> reach_of_gutter(std::uint32_t cell) const {
        std::vector<int> reach;
        const double g = static_cast<double>(gutter_) / cell;
        for (int dy = 0; std::max(dy - 1, 0) < g; ++dy) {
            const double left = g * g - std::pow(std::max(dy - 1, 0), 2);
            int dx = 0;
            while (dx * dx < left) ++dx;
            reach.push_back(dx);
        }
        if (reach.empty()) reach.push_back(0);
        return reach;
    }

    std::uint32_t gutter_;
    ProgressFn progress_;
    std::vector<Shape> shapes_;
    std::vector<Masks> cache_;
    Plan plan_;
    double area_ = 0;
};

}  // namespace

Packing pack(const std::vector<std::vector<Vec2>>& borders, const PackOptions& options) {
    Packing packing;
    Packer packer(borders, options.gutter, options.progress);
    if (options.pages > 1)
        return options.texels_per_unit > 0
                   ? packer.on_pages(options.size, kCells, options.texels_per_unit, options.pages)
                   : packer.fill_pages(options.size, options.pages, options.search);
    if (options.size > 0) {
        Layout layout = packer.largest(options.size, options.search);
        packing.size = options.size;
        packing.fits = layout.complete();
        packing.texels_per_unit = layout.scale;
        packing.placements = std::move(layout.placements);
        // A page too small for the gutters: grow it until charts cover their least part.
        for (double size = options.size; !packing.fits && size < 1e6; size *= 1.25) {
            packing.size = static_cast<std::uint32_t>(size * 1.25 / 16 + 1) * 16;
            const double least = std::sqrt(kLeastUse / packer.area()) * packing.size;
            if (packer.at_scale(packing.size, least, 1).complete()) break;
        }
        return packing;
    }
    packing.texels_per_unit = options.texels_per_unit;
    double size = std::sqrt(packer.area() / 0.75) * options.texels_per_unit;
    for (int trial = 0; trial < 24; ++trial) {
        report(options.progress, "pack", trial / 24.0);
        packing.size = static_cast<std::uint32_t>(size / 16 + 1) * 16;
        const std::uint32_t cells = packer.page(packing.size, kCells).cells;
        Layout layout = packer.at_scale(packing.size, options.texels_per_unit, 2);
        if (layout.complete()) {
            packing.fits = true;
            packing.placements = std::move(layout.placements);
            break;
        }
        const double filled = layout.all_placed() ? static_cast<double>(layout.rows) / cells : 2;
        size = std::max(packing.size + 15.0, packing.size * std::sqrt(filled) * 0.995);
    }
    return packing;
}

}  // namespace tuft::atlas
