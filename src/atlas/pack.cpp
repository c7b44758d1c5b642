#include "atlas/pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "core/hash.h"
#include "core/random.h"

namespace tuft::atlas {
namespace {

constexpr double kSmallest = 0.25;   // texels: extent below which a chart is enlarged
constexpr double kLeastUse = 1e-3;   // part of the page that charts must cover to "fit"
constexpr std::uint32_t kCells = 1024;  // cells per side of the page that masks are made on, at most
constexpr std::uint32_t kCoarseCells = 512;  // the same while searching
constexpr double kStep = 1.01;          // by which the search raises the scale
constexpr double kTrials = 8000;       // charts placed while searching, about

struct Run {
    std::uint32_t row, first, last;
    bool operator==(const Run&) const = default;
};

/// The cells that a chart touches, as runs in rows.
struct Mask {
    std::vector<Run> runs;  // in the order they are tested
    std::uint32_t width = 0, height = 0;
    double c = 1, s = 0;
    Vec2 corner{0};  // of the rotated, scaled chart, texels
    std::uint64_t hash = 0;  // of the runs
};

double cross(const Vec2& o, const Vec2& a, const Vec2& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

/// A chart's hull and how it lies in its smallest rectangle.
struct Shape {
    const std::vector<Vec2>* border = nullptr;
    double angle = 0;   // turns the longer side of the smallest rectangle onto x
    double area = 0;    // of the polygon
    double extent = 0;  // longer side of the rectangle
};

Shape make_shape(const std::vector<Vec2>& border) {
    Shape shape;
    shape.border = &border;
    for (std::size_t i = 0; i < border.size(); ++i)
        shape.area += 0.5 * cross(border[0], border[i], border[(i + 1) % border.size()]);
    const std::vector<Vec2> hull = convex_hull(border);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Vec2 d = hull[(i + 1) % hull.size()] - hull[i];
        const double length = glm::length(d);
        if (!(length > 0)) continue;
        Vec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
        for (const Vec2& p : hull) {
            const Vec2 q = Vec2(glm::dot(p, d), d.x * p.y - d.y * p.x) / length;
            lo = glm::min(lo, q);
            hi = glm::max(hi, q);
        }
        const Vec2 side = hi - lo;
        if (side.x * side.y < best) {
            best = side.x * side.y;
            shape.extent = std::max(side.x, side.y);
            shape.angle = -std::atan2(d.y, d.x) + (side.y > side.x ? std::numbers::pi / 2 : 0);
        }
    }
    return shape;
}

Mask make_mask(const Shape& shape, double scale, double angle, double cell) {
    Mask mask;
    mask.c = std::cos(angle);
    mask.s = std::sin(angle);
    std::vector<Vec2> p(shape.border->size());
    Vec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2& q = (*shape.border)[i];
        p[i] = scale * Vec2(mask.c * q.x - mask.s * q.y, mask.s * q.x + mask.c * q.y);
        lo = glm::min(lo, p[i]);
        hi = glm::max(hi, p[i]);
    }
    mask.corner = lo;
    for (Vec2& q : p) q = (q - lo) / cell;
    const Vec2 side = (hi - lo) / cell;
    mask.width = static_cast<std::uint32_t>(side.x) + 1;
    mask.height = static_cast<std::uint32_t>(side.y) + 1;
    const std::size_t words = (mask.width + 63) / 64;
    std::vector<std::uint64_t> bits(words * mask.height, 0);
    std::vector<std::vector<double>> crossings(mask.height);
    const auto fill = [&](std::size_t row, double a, double b) {
        const auto first = static_cast<std::size_t>(std::max(a, 0.0));
        const auto last = std::min<std::size_t>(static_cast<std::size_t>(std::max(b, 0.0)),
                                                mask.width - 1);
        for (std::size_t w = first / 64; w <= last / 64; ++w) {
            std::uint64_t m = ~std::uint64_t{0};
            if (w == first / 64) m &= ~std::uint64_t{0} << (first % 64);
            if (w == last / 64) m &= ~std::uint64_t{0} >> (63 - last % 64);
            bits[row * words + w] |= m;
        }
    };
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2 a = p[i], b = p[(i + 1) % p.size()];
        const double y0 = std::min(a.y, b.y), y1 = std::max(a.y, b.y);
        const double slope = y1 > y0 ? (b.x - a.x) / (b.y - a.y) : 0;
        const auto last = std::min(static_cast<std::uint32_t>(y1), mask.height - 1);
        for (auto row = static_cast<std::uint32_t>(y0); row <= last; ++row) {
            double xa = std::min(a.x, b.x), xb = std::max(a.x, b.x);
            if (y1 > y0) {  // every cell of this row that the edge touches
                const double u = a.x + slope * (std::clamp<double>(row, y0, y1) - a.y);
                const double v = a.x + slope * (std::clamp<double>(row + 1.0, y0, y1) - a.y);
                xa = std::max(xa, std::min(u, v) - 1e-9);
                xb = std::min(xb, std::max(u, v) + 1e-9);
            }
            fill(row, xa, xb);
            const double middle = row + 0.5;
            if ((a.y <= middle) != (b.y <= middle))
                crossings[row].push_back(a.x + slope * (middle - a.y));
        }
    }
    for (std::uint32_t row = 0; row < mask.height; ++row) {
        auto& x = crossings[row];
        std::sort(x.begin(), x.end());
        for (std::size_t i = 0; i + 1 < x.size(); i += 2) fill(row, x[i], x[i + 1]);
        for (std::uint32_t i = 0; i < mask.width; ++i) {
            if (!(bits[row * words + i / 64] >> (i % 64) & 1)) continue;
            const std::uint32_t first = i;
            while (i + 1 < mask.width && (bits[row * words + (i + 1) / 64] >> ((i + 1) % 64) & 1)) ++i;
            mask.runs.push_back({row, first, i});
        }
    }
    // The widest runs of sparse rows first: most places are ruled out by the first few tests.
    const auto stride = [&](const Run& r) {
        return std::min(std::countr_zero(r.row | 1u << 31), 4);
    };
    std::stable_sort(mask.runs.begin(), mask.runs.end(), [&](const Run& a, const Run& b) {
        if (stride(a) != stride(b)) return stride(a) > stride(b);
        return a.last - a.first > b.last - b.first;
    });
    mask.hash = hash_bytes(mask.runs.data(), mask.runs.size() * sizeof(Run));
    return mask;
}

/// A strip of cells; level k of a row tells whether any of 2^k cells from x on is taken.
class Strip {
  public:
    Strip(std::uint32_t width, int reach_rows, std::vector<int> reach)
        : width_(width), words_(width / 64 + 1), reach_rows_(reach_rows), reach_(std::move(reach)) {
        while ((1u << (levels_ + 1)) <= width_) ++levels_;
        ++levels_;
    }

    /// The lowest row, from `from_row` on, where the mask fits below `limit`; x the leftmost there.
    struct Spot { std::uint32_t x = 0, y = kNone; };
    Spot find(const Mask& mask, std::uint32_t from_row, std::uint32_t limit) {
        Spot spot;
        if (mask.width > width_) return spot;
        const std::uint32_t places = width_ - mask.width + 1;
        std::vector<std::uint64_t> valid((places + 63) / 64);
        std::size_t killer = 0;
        for (std::uint32_t y = from_row; y + mask.height <= limit; ++y) {
            std::fill(valid.begin(), valid.end(), ~std::uint64_t{0});
            if (places % 64 != 0) valid.back() = ~std::uint64_t{0} >> (64 - places % 64);
            bool any = block(mask.runs[killer], y, valid);
            for (std::size_t r = 0; any && r < mask.runs.size(); ++r) {
                any = block(mask.runs[r], y, valid);
                if (!any) killer = r;
            }
            if (!any) continue;
            for (std::size_t w = 0; w < valid.size(); ++w)
                if (valid[w] != 0) {
                    spot = {static_cast<std::uint32_t>(64 * w + std::countr_zero(valid[w])), y};
                    return spot;
                }
        }
        return spot;
    }

    void place(const Mask& mask, const Spot& spot) {
        std::uint32_t low = kNone, high = 0;
        for (const Run& run : mask.runs)
            for (int d = -reach_rows_; d <= reach_rows_; ++d) {
                const std::int64_t row = std::int64_t{spot.y} + run.row + d;
                if (row < 0) continue;
                const int e = reach_[static_cast<std::size_t>(std::abs(d))];
                const auto y = static_cast<std::uint32_t>(row);
                grow(y + 1);
                take(y, std::int64_t{spot.x} + run.first - e, std::int64_t{spot.x} + run.last + e);
                low = std::min(low, y);
                high = std::max(high, y);
            }
        for (std::uint32_t y = low; y <= high && low != kNone; ++y) rebuild(y);
        top_ = std::max(top_, spot.y + mask.height);
    }

    std::uint32_t top() const { return top_; }

  private:
    std::uint64_t* level(std::uint32_t y, int k) {
        return rows_.data() + (std::size_t{y} * levels_ + k) * words_;
    }

    void grow(std::uint32_t rows) {
        if (rows <= n_rows_) return;
        rows_.resize(std::size_t{rows} * levels_ * words_, 0);
        for (; n_rows_ < rows; ++n_rows_)  // cells beyond the right edge are taken
            for (int k = 0; k < levels_; ++k)
                for (std::uint32_t x = width_; x < 64 * words_; ++x)
                    level(n_rows_, k)[x / 64] |= std::uint64_t{1} << (x % 64);
    }

    void take(std::uint32_t y, std::int64_t first, std::int64_t last) {
        const auto a = static_cast<std::size_t>(std::max<std::int64_t>(first, 0));
        const auto b = static_cast<std::size_t>(std::min<std::int64_t>(last, width_ - 1));
        std::uint64_t* row = level(y, 0);
        for (std::size_t w = a / 64; w <= b / 64; ++w) {
            std::uint64_t m = ~std::uint64_t{0};
            if (w == a / 64) m &= ~std::uint64_t{0} << (a % 64);
            if (w == b / 64) m &= ~std::uint64_t{0} >> (63 - b % 64);
            row[w] |= m;
        }
    }

    static std::uint64_t shifted(const std::uint64_t* row, std::size_t words, std::size_t w,
                                 std::size_t shift) {
        const std::size_t i = w + shift / 64;
        const std::size_t bit = shift % 64;
        const std::uint64_t lo = i < words ? row[i] : ~std::uint64_t{0};
        if (bit == 0) return lo;
        const std::uint64_t hi = i + 1 < words ? row[i + 1] : ~std::uint64_t{0};
        return lo >> bit | hi << (64 - bit);
    }

    void rebuild(std::uint32_t y) {
        for (int k = 1; k < levels_; ++k) {
            const std::uint64_t* from = level(y, k - 1);
            std::uint64_t* to = level(y, k);
            for (std::size_t w = 0; w < words_; ++w)
                to[w] = from[w] | shifted(from, words_, w, std::size_t{1} << (k - 1));
        }
    }

    /// Clears the places where the run hits something; false when none is left.
    bool block(const Run& run, std::uint32_t y, std::vector<std::uint64_t>& valid) {
        const std::uint32_t row = y + run.row;
        if (row >= n_rows_) return true;
        const std::uint32_t length = run.last - run.first + 1;
        const int k = std::bit_width(length) - 1;
        const std::uint64_t* taken = level(row, k);
        const std::size_t a = run.first, b = run.last + 1 - (std::size_t{1} << k);
        std::uint64_t any = 0;
        for (std::size_t w = 0; w < valid.size(); ++w) {
            if (valid[w] == 0) continue;
            valid[w] &= ~(shifted(taken, words_, w, a) | shifted(taken, words_, w, b));
            any |= valid[w];
        }
        return any != 0;
    }

    std::uint32_t width_;
    std::size_t words_;
    int reach_rows_;
    std::vector<int> reach_;  // cells blocked on both sides of a taken one, by row distance
    int levels_ = 0;
    std::uint32_t n_rows_ = 0, top_ = 0;
    std::vector<std::uint64_t> rows_;
};

struct Layout {
    double unplaced = 0;      // area of the charts that found no place
    std::uint32_t first_unplaced = kNone;
    std::uint32_t rows = 0;   // cells, up to the highest chart
    double scale = 0;
    std::vector<Placement> placements;

    bool complete() const { return scale > 0 && first_unplaced == kNone; }
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
        std::stable_sort(plan_.order.begin(), plan_.order.end(), [&](auto a, auto b) {
            return shapes_[a].area > shapes_[b].area;
        });
        cache_.resize(shapes_.size());
    }

    double area() const { return area_; }

    Page page(std::uint32_t size, std::uint32_t most_cells) const {
        Page page{size, std::max(1u, (size + most_cells - 1) / most_cells), 0};
        if (size > 2 * margin()) page.cells = (size - 2 * margin()) / page.cell;
        return page;
    }

    /// Fills a strip as wide as the page, at most `limit` times as high; gives up when
    /// charts of more than `hopeless` area found no place.
    Layout fill(const Page& page, double scale, double limit,
                double hopeless = std::numeric_limits<double>::infinity()) {
        Layout layout;
        layout.scale = scale;
        layout.placements.resize(shapes_.size());
        const double cell = page.cell;
        const auto most_rows = static_cast<std::uint32_t>(limit * page.cells);
        const std::vector<int> reach = reach_of_gutter(page.cell);
        Strip strip(page.cells, static_cast<int>(reach.size()) - 1, reach);
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
            if (best == nullptr) {
                if (layout.first_unplaced == kNone) layout.first_unplaced = i;
                layout.unplaced += shapes_[i].area;
                if (layout.unplaced > hopeless) break;
                continue;
            }
            strip.place(*best, spot);
            layout.placements[i] = {masks.chart_scale, best->c, best->s,
                                    Vec2(spot.x, spot.y) * cell + Vec2(margin()) - best->corner};
        }
        layout.rows = strip.top();
        return layout;
    }

    /// The largest scale found at which everything fits the page: after a first fit, a
    /// search on coarse masks raises the scale step by step and looks for an order and
    /// turns that fit, then the masks are refined. Not complete when nothing fits.
    Layout largest(std::uint32_t size, bool quick) {
        const int trials = std::clamp(static_cast<int>(kTrials / std::max<std::size_t>(shapes_.size(), 1)), 8, 300);
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
        if (quick) return best;
        Random random(shapes_.size());
        double unplaced = std::numeric_limits<double>::infinity();
        std::uint32_t failed = kNone;
        double target = kStep * best.scale;
        for (int trial = 0; trial < trials; ++trial) {
            if (trial % 8 == 0) report(progress_, "pack", 0.9 * trial / trials);
            const Plan before = plan_;
            if (trial > 0) vary(random, failed);
            Layout layout = fill(coarse, target, 1, unplaced);
            if (layout.complete()) {
                best = std::move(layout);
                target = kStep * best.scale;
                unplaced = std::numeric_limits<double>::infinity();
                failed = kNone;
            } else if (layout.unplaced <= unplaced) {
                unplaced = layout.unplaced;
                failed = layout.first_unplaced;
            } else {
                plan_ = before;
            }
        }
        if (fine.cell < coarse.cell) {
            for (double scale = 1.03 * best.scale; scale > best.scale; scale *= 0.996) {
                Layout layout = fill(fine, scale, 1);
                if (!layout.complete()) continue;
                best = std::move(layout);
                break;
            }
        }
        return best;
    }

    /// All charts at a given scale within the page.
    Layout at_scale(std::uint32_t size, double scale, double limit) {
        return fill(page(size, kCells), scale, limit);
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
            plan_.turn[order[pick()]] =
                kind < 0.75 ? 0 : random.uniform(0, std::numbers::pi / 2);
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

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    std::vector<Vec2> hull(2 * points.size());
    std::size_t k = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        while (k >= 2 && cross(hull[k - 2], hull[k - 1], points[i]) <= 0) --k;
        hull[k++] = points[i];
    }
    const std::size_t lower = k + 1;
    for (std::size_t i = points.size() - 1; i-- > 0;) {
        while (k >= lower && cross(hull[k - 2], hull[k - 1], points[i]) <= 0) --k;
        hull[k++] = points[i];
    }
    hull.resize(k > 1 ? k - 1 : k);
    return hull;
}

Packing pack(const std::vector<std::vector<Vec2>>& borders, const PackOptions& options) {
    Packing packing;
    Packer packer(borders, options.gutter, options.progress);
    if (options.size > 0) {
        Layout layout = packer.largest(options.size, options.quick);
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
        if (layout.complete() && layout.rows <= cells) {
            packing.fits = true;
            packing.placements = std::move(layout.placements);
            break;
        }
        const double filled = layout.complete() ? static_cast<double>(layout.rows) / cells : 2;
        size = std::max(packing.size + 15.0, packing.size * std::sqrt(filled) * 0.995);
    }
    return packing;
}

}  // namespace tuft::atlas
