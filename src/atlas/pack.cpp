#include "atlas/pack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "core/hash.h"

namespace tuft::atlas {
namespace {

constexpr double kSmallest = 0.25;   // texels: extent below which a chart is enlarged
constexpr double kLeastUse = 0.01;   // part of the page that charts must cover to "fit"
constexpr std::uint32_t kCells = 1024;  // cells per side of the page that masks are made on, at most

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
    // Rows far from each other first: most places are ruled out by the first few tests.
    std::stable_sort(mask.runs.begin(), mask.runs.end(), [&](const Run& a, const Run& b) {
        const auto rank = [&](const Run& r) {
            const std::uint32_t from_end = std::min(r.row, mask.height - 1 - r.row);
            return std::countr_zero(r.row | 1024u) * -100000 + static_cast<int>(from_end);
        };
        return rank(a) < rank(b);
    });
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
    bool placed = false;      // all charts, below the limit
    std::uint32_t rows = 0;   // cells
    std::vector<Placement> placements;
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
        order_.resize(shapes_.size());
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
            return shapes_[a].area > shapes_[b].area;
        });
    }

    double area() const { return area_; }

    std::uint32_t margin() const { return (gutter_ + 1) / 2; }
    std::uint32_t cell(std::uint32_t size) const { return (size + kCells - 1) / kCells; }
    std::uint32_t cells(std::uint32_t size) const {
        const std::uint32_t free = size > 2 * margin() ? size - 2 * margin() : 0;
        return free / cell(size);
    }

    /// Fills a strip as wide as the page, at most `limit` times as high.
    Layout fill(std::uint32_t size, double scale, double limit) const {
        Layout layout;
        const std::uint32_t cell = this->cell(size), width = cells(size);
        const auto rows = static_cast<std::uint32_t>(limit * width);
        if (width == 0) return layout;
        // Cells d apart (in x and y) are nearer than the gutter when |(max(d − 1, 0)) cell| < gutter.
        const double g = static_cast<double>(gutter_) / cell;
        std::vector<int> reach;
        for (int dy = 0; std::max(dy - 1, 0) < g; ++dy) {
            const double left = g * g - std::pow(std::max(dy - 1, 0), 2);
            int dx = 0;
            while (std::pow(std::max(dx, 0), 2) < left) ++dx;  // dx + 1 is still too near
            reach.push_back(dx);
        }
        if (gutter_ == 0) reach.assign(1, 0);
        Strip strip(width, static_cast<int>(reach.size()) - 1, reach);

        layout.placements.resize(shapes_.size());
        std::unordered_map<std::uint64_t, std::uint32_t> lowest;  // by the mask's hash
        for (const std::size_t i : order_) {
            const Shape& shape = shapes_[i];
            const double chart_scale =
                std::max(scale, shape.extent > 0 ? kSmallest / shape.extent : scale);
            Mask best;
            Strip::Spot spot;
            std::uint32_t best_top = rows + 1;
            const int turns = shape.extent * chart_scale < 2 * cell ? 1 : 8;
            for (int k = 0; k < turns; ++k) {
                Mask mask = make_mask(shape, chart_scale,
                                      shape.angle + k % 4 * (std::numbers::pi / 2) +
                                          k / 4 * (std::numbers::pi / 4), cell);
                const std::uint64_t key =
                    hash_bytes(mask.runs.data(), mask.runs.size() * sizeof(Run));
                std::uint32_t& from = lowest[key];
                if (from + mask.height >= best_top) continue;
                const Strip::Spot s = strip.find(mask, from, std::min(best_top - 1, rows));
                if (s.y == kNone) continue;
                from = s.y;
                best_top = s.y + mask.height;
                spot = s;
                best = std::move(mask);
            }
            if (spot.y == kNone) return layout;
            strip.place(best, spot);
            Placement& p = layout.placements[i];
            p = {chart_scale, best.c, best.s,
                 Vec2(spot.x, spot.y) * double(cell) + Vec2(margin()) - best.corner};
        }
        layout.placed = true;
        layout.rows = strip.top();
        return layout;
    }

    /// The largest scale at which everything fits the page; nothing placed if none does.
    std::pair<Layout, double> largest(std::uint32_t size) const {
        const double side = size;
        const double least = std::sqrt(kLeastUse / area_) * side;
        double low = 0, high = std::sqrt(1 / area_) * side;
        double scale = 0.85 * high;
        Layout best;
        for (int trial = 0; trial < 12 && scale >= least; ++trial) {
            report(progress_, "pack", trial / 12.0);
            Layout layout = fill(size, scale, 2);
            const double filled = layout.placed
                                      ? static_cast<double>(layout.rows) / cells(size)
                                      : 2.5;
            if (layout.placed && layout.rows <= cells(size)) {
                low = scale;
                best = std::move(layout);
            } else {
                high = std::min(high, scale);
            }
            if (low > 0 && high < 1.004 * low) break;
            const double guess = scale / std::sqrt(filled);
            const double slack = 0.001 * scale;
            if (low > 0)
                scale = guess > low + slack && guess < high - slack ? guess : 0.5 * (low + high);
            else
                scale = std::max(std::min(0.98 * guess, 0.98 * high),
                                 scale > least ? least : 0.5 * least);
        }
        return {std::move(best), low};
    }

  private:
    std::uint32_t gutter_;
    ProgressFn progress_;
    std::vector<Shape> shapes_;
    std::vector<std::size_t> order_;
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
    const Packer packer(borders, options.gutter, options.progress);
    if (options.size > 0) {
        auto [layout, scale] = packer.largest(options.size);
        packing.size = options.size;
        packing.fits = layout.placed;
        packing.texels_per_unit = scale;
        packing.placements = std::move(layout.placements);
        // A page too small for the gutters: grow it until charts cover their least part.
        for (double size = options.size; !packing.fits && size < 1e6; size *= 1.25) {
            packing.size = static_cast<std::uint32_t>(size * 1.25 / 16 + 1) * 16;
            const double least = std::sqrt(kLeastUse / packer.area()) * packing.size;
            const Layout trial = packer.fill(packing.size, least, 1);
            if (trial.placed) break;
        }
        return packing;
    }
    packing.texels_per_unit = options.texels_per_unit;
    double size = std::sqrt(packer.area() / 0.75) * options.texels_per_unit;
    for (int trial = 0; trial < 24; ++trial) {
        report(options.progress, "pack", trial / 24.0);
        packing.size = static_cast<std::uint32_t>(size / 16 + 1) * 16;
        Layout layout = packer.fill(packing.size, options.texels_per_unit, 2);
        if (layout.placed && layout.rows <= packer.cells(packing.size)) {
            packing.fits = true;
            packing.placements = std::move(layout.placements);
            break;
        }
        const double filled =
            layout.placed ? static_cast<double>(layout.rows) / packer.cells(packing.size) : 2;
        size = std::max(packing.size + 15.0, packing.size * std::sqrt(filled) * 0.995);
    }
    return packing;
}

}  // namespace tuft::atlas
