#include "atlas/pack/pack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "atlas/pack/pack_mask.h"
#include "atlas/pack/pack_strip.h"
#include "core/random.h"

namespace tuft::atlas {
namespace {

constexpr double kSmallest = 0.25;           // texels: extent below which a chart is enlarged
constexpr double kLeastUse = 1e-3;           // part of the page that charts must cover to "fit"
constexpr std::uint32_t kCells = 1024;       // cells per side of the page that masks are made on, at most
constexpr std::uint32_t kCoarseCells = 256;  // the same while searching
constexpr std::uint32_t kRoughCells = 128;   // where layouts of a few charts are only compared
constexpr std::size_t kFewCharts = 48;
constexpr std::uint32_t kMiddleCells = 512;  // and for a second search from where that ends
constexpr double kStep = 1.01;               // by which the search raises the scale
constexpr double kFineStep = 1.003;          // the same in the second search
constexpr double kFinerGain = 1.03;          // of the scale that finer masks usually allow
constexpr double kFinerFall = 0.996;         // steps down from there
constexpr double kOverhang = 1.3;            // height of the strip while searching, over the page's
constexpr int kSecondShare = 3;              // of the trials, that the second search gets
constexpr double kTrials = 8000;             // charts placed while searching, about
constexpr double kCoarseTrials = 800;        // the same when layouts are only compared
constexpr int kStarts = 3;                   // searches, of which the best counts
constexpr int kMostRounds = 2;               // of patient searches, for as long as less than this part
constexpr double kGoodEnough = 0.655;        // of the page is covered,
constexpr double kWithinReach = 0.96;        // but not less than this part of that
constexpr int kFineTurns = 4;                // parts of a right angle by which a patient search turns charts

constexpr double kAllOrNothing = -1;  // excess with which the first chart that finds no place ends it

struct Layout {
    double excess = 0;                   // sum of area × rows beyond the page, all of the strip's without a place
    std::uint32_t first_beyond = kNone;  // the first chart that reaches beyond the page
    std::uint32_t rows = 0;              // cells, up to the highest chart of the first page
    double scale = 0;
    std::vector<Placement> placements;
    std::vector<std::uint8_t> placed;  // [n_charts]
    std::vector<std::uint32_t> page;   // [n_charts]
    std::uint32_t pages = 1;           // that were begun

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

/// A place for a chart.
struct Found {
    const Mask* mask = nullptr;
    Strip::Spot spot;
    std::uint32_t top = kNone;  // rows up to its upper edge
};

/// A page as it is being filled.
struct Filling {
    Strip strip;
    std::unordered_map<std::uint64_t, std::uint32_t> lowest;  // row, by the mask's hash

    Filling(std::uint32_t cells, std::vector<int> reach) : strip(cells, std::move(reach)) {}

    void clear() {
        strip.clear();
        lowest.clear();
    }

    /// The place of all turns of a chart where its middle lies lowest.
    Found find(const std::vector<Mask>& turned, std::uint32_t most_rows) {
        Found best;
        double least = std::numeric_limits<double>::infinity();
        for (const Mask& mask : turned) {
            std::uint32_t& from = lowest[mask.hash];
            const double rows = std::ceil(least - mask.middle) - 1 + mask.height;
            const auto limit = static_cast<std::uint32_t>(std::clamp<double>(rows, 0, most_rows));
            if (from + mask.height > limit) continue;
            const Strip::Spot s = strip.find(mask, from, limit);
            if (s.y == kNone) continue;
            from = s.y;
            least = s.y + mask.middle;
            best = {&mask, s, s.y + mask.height};
        }
        return best;
    }
};

/// What is filled in the search for the largest scale.
struct Target {
    Page page;
    std::uint32_t pages = 1;
    double step = 1.01;  // by which the scale is raised; 1: once it fits, it is done
};

class Packer {
  public:
    Packer(const std::vector<std::vector<Vec2>>& borders, std::uint32_t gutter, const ProgressFn& progress)
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

    /// Empties page p, the next one to be filled; does nothing for one of the `n_filled` before.
    void begin_page(const Page& page, std::uint32_t p, std::uint32_t& n_filled) {
        if (p < n_filled) return;
        ++n_filled;
        if (p < filling_.size())
            filling_[p].clear();
        else
            filling_.emplace_back(page.cells, reach_by_row(static_cast<double>(gutter_) / page.cell));
    }

    /// Fills pages one after the other, each chart on the first that has room for it. The last
    /// is a strip, at most `limit` times as high as wide; gives up when the excess there is
    /// beyond `hopeless`.
    Layout fill(const Page& page, double scale, double limit, std::uint32_t pages = 1,
                double hopeless = std::numeric_limits<double>::infinity()) {
        Layout layout;
        layout.scale = scale;
        layout.placements.resize(shapes_.size());
        layout.placed.assign(shapes_.size(), 0);
        layout.page.assign(shapes_.size(), 0);
        std::vector<Filling>& filled = filling_;
        if (page.cell != last_.target.cell || page.size != last_.target.size) filled.clear();
        std::uint32_t n_filled = 0;
        const Filled::Target target{page.size, page.cell, scale, limit, pages, turns_};
        bool as_before = target == last_.target;  // the plan up to here
        last_.target = target;
        for (std::size_t at = 0; at < plan_.order.size(); ++at) {
            const std::uint32_t i = plan_.order[at];
            const Masks& masks = masks_of(i, scale, page.cell);
            const auto last_row = [&](std::uint32_t p) {
                return p + 1 == pages ? static_cast<std::uint32_t>(limit * page.cells) : page.cells;
            };
            Found found;
            std::uint32_t p = 0;
            as_before = as_before && at < last_.steps.size() && last_.steps[at].chart == i &&
                        last_.steps[at].turn == plan_.turn[i];
            if (as_before) {
                p = last_.steps[at].page;
                found = last_.steps[at].found;
                for (std::uint32_t q = 0; q < std::min(p + 1, pages); ++q) begin_page(page, q, n_filled);
                if (found.mask != nullptr) found.mask = &masks.turned[last_.steps[at].orientation];
            } else {
                for (; p < pages; ++p) {
                    begin_page(page, p, n_filled);
                    found = filled[p].find(masks.turned, last_row(p));
                    if (found.mask != nullptr) break;
                }
                last_.steps.resize(at);
                const auto orientation = found.mask == nullptr ? 0 : found.mask - masks.turned.data();
                last_.steps.push_back({i, plan_.turn[i], static_cast<std::size_t>(orientation), found, p});
            }
            const std::uint32_t most_rows = last_row(pages - 1);
            if (found.mask == nullptr || found.top > page.cells) {
                if (layout.first_beyond == kNone) layout.first_beyond = i;
                layout.excess += shapes_[i].area * (std::min(found.top, most_rows) - page.cells);
                if (layout.excess > hopeless) break;
                if (found.mask == nullptr) continue;
            }
            filled[p].strip.place(*found.mask, found.spot);
            layout.placed[i] = 1;
            layout.page[i] = p;
            layout.placements[i] = {
                masks.chart_scale, found.mask->c, found.mask->s,
                Vec2(found.spot.x, found.spot.y) * double(page.cell) + Vec2(margin()) - found.mask->corner};
        }
        layout.pages = std::max(n_filled, 1u);
        if (n_filled > 0) layout.rows = filled[0].strip.top();
        return layout;
    }

    /// The largest scale found at which everything fits the page: after a first fit, a
    /// search on coarse masks raises the scale step by step and looks for an order and
    /// turns that fit. Not complete when nothing fits.
    Layout largest(std::uint32_t size, std::uint32_t pages, Search search) {
        const double full = size * std::sqrt(pages / area_);
        const double least = std::sqrt(kLeastUse) * full;
        const bool rough = search == Search::coarse && shapes_.size() <= kFewCharts;
        const Page coarse = page(size, rough ? kRoughCells : kCoarseCells);
        const Page fine = page(size, kCells);
        Layout best;
        if (fine.cells == 0) return best;
        double step = 0.97;
        for (double scale = 0.85 * full; !best.complete(); scale *= step) {
            if (scale < least) scale = least;
            Layout layout = fill(coarse, scale, 1, pages, kAllOrNothing);
            if (layout.complete()) best = std::move(layout);
            if (scale == least) break;
            if (scale < 0.6 * full) step = 0.9;
        }
        if (!best.complete()) {
            best = fill(fine, least, 1, pages);
            return best;
        }
        if (search == Search::quick) return best;
        Random random(shapes_.size());
        const Layout first = best;
        const Plan first_plan = plan_;
        const bool patient = search == Search::patient;
        turns_ = patient ? kFineTurns : 1;
        for (int round = 0; round < (patient ? kMostRounds : 1); ++round) {
            plan_ = first_plan;
            Layout found = search_once(first, {coarse, pages, kStep}, search, random);
            if (found.scale > best.scale) best = std::move(found);
            report(progress_, "pack", (round + 1.0) / kMostRounds);
            const double use = best.scale * best.scale / (full * full);
            if (use > kGoodEnough || use < kWithinReach * kGoodEnough) break;
        }
        turns_ = 1;
        report(progress_, "pack", 1);
        return best;
    }

    /// Three climbs from `first`, of which the best goes on with finer masks.
    Layout search_once(const Layout& first, const Target& coarse, Search search, Random& random) {
        const int trials = search == Search::coarse ? this->trials(kCoarseTrials, 64) : this->trials(kTrials, 300);
        const std::uint32_t size = coarse.page.size, pages = coarse.pages;
        const Plan first_plan = plan_;
        Layout best = first;
        Plan best_plan = plan_;
        for (int start = 0; start < kStarts; ++start) {
            Layout layout = first;
            plan_ = first_plan;
            climb(coarse, trials / kStarts, random, layout);
            if (layout.scale <= best.scale) continue;
            best = std::move(layout);
            best_plan = plan_;
        }
        plan_ = best_plan;
        if (search == Search::coarse) {
            climb({coarse.page, pages, kFineStep}, trials / kSecondShare, random, best);
            return best;
        }
        const Page middle = page(size, kMiddleCells), fine = page(size, kCells);
        if (middle.cell < coarse.page.cell) {
            refine(middle, pages, best);
            climb({middle, pages, kFineStep}, trials / kSecondShare, random, best);
        }
        if (fine.cell < middle.cell) refine(fine, pages, best);
        return best;
    }

    /// The same plan on finer masks, which leave less room between charts: far less where charts are about as narrow
    /// as the coarse cells.
    void refine(const Page& page, std::uint32_t pages, Layout& best) {
        const auto fits = [&](double scale) {
            Layout layout = fill(page, scale, 1, pages, kAllOrNothing);
            if (!layout.complete()) return false;
            best = std::move(layout);
            return true;
        };
        double too_large = kFinerGain * best.scale;
        if (!fits(too_large)) {
            for (double scale = kFinerFall * too_large; scale > best.scale; scale *= kFinerFall)
                if (fits(scale)) return;
            return;
        }
        do too_large *= kFinerGain;
        while (fits(too_large));
        while (best.scale < kFinerFall * too_large) {
            const double middle = 0.5 * (best.scale + too_large);
            if (!fits(middle)) too_large = middle;
        }
    }

    /// Raises the scale of a layout step by step, looking for an order and turns that fit:
    /// fewer and smaller charts, less far beyond the page's edge.
    void climb(const Target& target, int trials, Random& random, Layout& best) {
        double excess = std::numeric_limits<double>::infinity();
        std::uint32_t failed = kNone;
        bool climbing = true;  // the plan as it is has not failed at the target yet
        for (int trial = 0; trial < trials; ++trial) {
            const Plan before = plan_;
            const Filled filled_before = last_;
            if (!climbing) vary(random, failed);
            Layout layout = fill(target.page, target.step * best.scale, kOverhang, target.pages, excess);
            climbing = layout.complete();
            if (climbing) {
                best = std::move(layout);
                excess = std::numeric_limits<double>::infinity();
                if (target.step == 1) return;
            } else if (layout.excess <= excess) {
                excess = layout.excess;
                failed = layout.first_beyond;
            } else {
                plan_ = before;
                last_ = filled_before;
            }
        }
    }

    /// All charts at a given scale within the page.
    Layout at_scale(std::uint32_t size, double scale, double limit) { return fill(page(size, kCells), scale, limit); }

    /// Charts of a given scale on as many pages as they need, up to `most`; with more than area
    /// alone asks for, an order is sought that needs one less.
    Layout on_pages(std::uint32_t size, double scale, std::uint32_t most) {
        constexpr double kFull = 0.8;  // of what charts cover at best
        const Page fine = page(size, kCells);
        Layout layout = fill(fine, scale, 1, most);
        Random random(shapes_.size());
        while (layout.complete() && layout.pages > 1 &&
               area_ * scale * scale < kFull * size * double(size) * (layout.pages - 1)) {
            Layout fewer;
            fewer.scale = scale;
            climb({fine, layout.pages - 1, 1}, trials(kCoarseTrials, 64), random, fewer);
            if (!fewer.complete() || fewer.placements.empty()) break;
            layout = std::move(fewer);
        }
        return layout;
    }

    /// Charts that have no place on an empty page, ascending.
    std::vector<std::uint32_t> too_large(std::uint32_t size, double scale) {
        const Page fine = page(size, kCells);
        std::vector<std::uint32_t> too_large;
        for (std::uint32_t i = 0; i < shapes_.size(); ++i) {
            const std::vector<Mask>& turned = masks_of(i, scale, fine.cell).turned;
            if (std::none_of(turned.begin(), turned.end(),
                             [&](const Mask& m) { return m.width <= fine.cells && m.height <= fine.cells; }))
                too_large.push_back(i);
        }
        return too_large;
    }

  private:
    /// The steps of the last filling, which the next one repeats for as long as its plan is the
    /// same.
    struct Filled {
        struct Target {
            std::uint32_t size = 0, cell = 0;
            double scale = 0, limit = 0;
            std::uint32_t pages = 0;
            int turns = 1;
            bool operator==(const Target&) const = default;
        };
        struct Step {
            std::uint32_t chart;
            double turn;
            std::size_t orientation;  // which of the chart's masks
            Found found;
            std::uint32_t page;
        };
        Target target;
        std::vector<Step> steps;
    };

    /// The masks of one chart in four directions times `turns`, for one scale and turn.
    struct Masks {
        double scale = 0, cell = 0, turn = 0, chart_scale = 0;
        int turns = 0;
        std::vector<Mask> turned;
    };

    /// How many layouts are tried: fewer with many charts.
    int trials(double charts, int most) const {
        return std::clamp(static_cast<int>(charts / static_cast<double>(shapes_.size() + 1)), 9, most);
    }

    std::uint32_t margin() const { return (gutter_ + 1) / 2; }

    const Masks& masks_of(std::uint32_t i, double scale, double cell) {
        const auto known = [&](const Masks& m) {
            return m.scale == scale && m.cell == cell && m.turn == plan_.turn[i] && m.turns == turns_;
        };
        auto& [m, former] = cache_[i];
        const Shape& shape = shapes_[i];
        if (known(m)) return m;
        std::swap(m, former);  // a turn that was tried is often taken back
        if (known(m)) return m;
        m.scale = scale;
        m.cell = cell;
        m.turn = plan_.turn[i];
        m.turns = turns_;
        m.chart_scale = std::max(scale, shape.extent > 0 ? kSmallest / shape.extent : scale);
        const bool all = shape.extent * m.chart_scale >= 2 * cell;
        m.turned.clear();
        for (int k = 0; k < (all ? turns_ : 1); ++k) {
            const double turn = m.turn + k * std::numbers::pi / (2 * turns_);
            std::vector<Mask> masks = make_masks(shape, m.chart_scale, shape.angle + turn, cell, all);
            std::move(masks.begin(), masks.end(), std::back_inserter(m.turned));
        }
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
            const auto earlier =
                static_cast<std::ptrdiff_t>(random.uniform() * static_cast<double>(at - order.begin()));
            std::rotate(order.begin() + earlier, at, at + 1);
            if (kind < 0.15) plan_.turn[failed] = random.uniform(0, std::numbers::pi / 2);
        } else if (kind < 0.65) {
            std::swap(order[pick()], order[pick()]);
        } else {
            plan_.turn[order[pick()]] = kind < 0.75 ? 0 : random.uniform(0, std::numbers::pi / 2);
        }
    }

    std::uint32_t gutter_;
    ProgressFn progress_;
    std::vector<Shape> shapes_;
    std::vector<std::array<Masks, 2>> cache_;  // by chart, the last two
    Filled last_;
    std::vector<Filling> filling_;  // kept from one filling to the next
    Plan plan_;
    int turns_ = 1;  // of a right angle that each place is tried with
    double area_ = 0;
};

}  // namespace

Packing pack(const std::vector<std::vector<Vec2>>& borders, const PackOptions& options) {
    Packing packing;
    Packer packer(borders, options.gutter, options.progress);
    if (options.size > 0 && (options.pages == 1 || options.texels_per_unit == 0)) {
        Layout layout = packer.largest(options.size, options.pages, options.search);
        packing.size = options.size;
        packing.fits = layout.complete();
        packing.pages = layout.pages;
        packing.texels_per_unit = layout.scale;
        packing.placements = std::move(layout.placements);
        if (options.pages > 1) {
            packing.page = std::move(layout.page);
            return packing;
        }
        // A page too small for the gutters: grow it until charts cover their least part.
        for (double size = options.size; !packing.fits && size < 1e6; size *= 1.25) {
            packing.size = static_cast<std::uint32_t>(size * 1.25 / 16 + 1) * 16;
            const double least = std::sqrt(kLeastUse / packer.area()) * packing.size;
            if (packer.at_scale(packing.size, least, 1).complete()) break;
        }
        return packing;
    }
    packing.texels_per_unit = options.texels_per_unit;
    if (options.pages > 1) {
        packing.size = options.size;
        packing.too_large = packer.too_large(options.size, options.texels_per_unit);
        if (!packing.too_large.empty()) return packing;
        Layout layout = packer.on_pages(options.size, options.texels_per_unit, options.pages);
        packing.fits = layout.complete();
        packing.pages = layout.pages;
        packing.placements = std::move(layout.placements);
        packing.page = std::move(layout.page);
        return packing;
    }
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
