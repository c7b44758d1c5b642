#include "decal/print_surface.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <set>
#include <unordered_map>

#include "atlas/flatten/flatten.h"
#include "atlas/seams/half_edges.h"
#include "core/geometry/segment.h"
#include "core/system/interrupt.h"

namespace tuft::decal {
namespace {

constexpr double kInside = -1e-9;             // barycentric weights of points on an edge, rounding
constexpr double kSlack = 1e-9;               // metres, more than rounding changes a distance
constexpr double kPainted = 0.5;              // coverage: the soft edge of paint beside a rim does not run on
constexpr double kBesideRim = 1e-6;           // metres
constexpr std::uint32_t kFacesAtOnce = 1000;  // between two looks for an interrupt
constexpr std::size_t kMostListed = 32;       // cells that list a triangle, on average

/// Walks over the seams and lays down triangle after triangle.
class Strip {
  public:
    Strip(const FilmMesh& film, const Panel& panel, const std::function<double(std::uint32_t)>& reach)
        : film_(film), panel_(panel), reach_(reach), twin_(atlas::twin_half_edges(film.mesh)) {
        used_.assign(film.mesh.n_triangles(), 0);
        for (const std::uint32_t t : panel.chart.triangles) used_[t] = 1;
        chart_ = panel.chart;
        flat_ = panel.flat;
        own_label_ = film.label[panel.chart.triangles[0]];
    }

    void grow() {
        std::vector<Entry> first;
        for (std::uint32_t h = 0; h < panel_.is_seam.size(); ++h) {
            if (!panel_.is_seam[h]) continue;
            const std::uint32_t g = twin_[3 * panel_.chart.triangles[h / 3] + h % 3];
            if (film_.label[g / 3] == own_label_) continue;  // a slit of the panel itself
            const std::uint32_t a = panel_.chart.faces[h / 3][(h % 3 + 1) % 3], b = panel_.chart.faces[h / 3][h % 3];
            first.push_back({0, g, a, b});
            seams_.push_back({flat_[a], flat_[b], glm::min(flat_[a], flat_[b]), glm::max(flat_[a], flat_[b])});
        }
        std::sort(seams_.begin(), seams_.end(), [](const Seam& a, const Seam& b) { return a.lo.x < b.lo.x; });
        for (const Seam& s : seams_) widest_ = std::max(widest_, s.hi.x - s.lo.x);
        for (const Entry& e : first) enter(e.half, e.first, e.second);
        while (!queue_.empty()) {
            const Entry e = queue_.top();
            queue_.pop();
            if (used_[e.half / 3]) continue;
            add(e);
        }
        relax();
    }

    const atlas::ChartMesh& chart() const { return chart_; }
    const std::vector<Vec2>& flat() const { return flat_; }

  private:
    struct Entry {
        double distance;
        std::uint32_t half;           // of the film mesh, in the triangle that is entered
        std::uint32_t first, second;  // chart vertices of its two ends
        bool operator<(const Entry& o) const { return distance != o.distance ? distance > o.distance : half > o.half; }
    };

    /// An edge of a seam, laid flat.
    struct Seam {
        Vec2 a, b;
        Vec2 lo, hi;  // its box
    };

    /// How far an edge that is laid flat lies from the seams, where that is less than `reach`; else `reach` or more.
    /// Cost: the seams whose span in x comes within reach.
    double seam_distance(const Vec2& a, const Vec2& b, double reach) const {
        const Vec2 lo = glm::min(a, b), hi = glm::max(a, b);
        const double far = reach + kSlack;
        double least = std::numeric_limits<double>::infinity();
        auto at = std::lower_bound(seams_.begin(), seams_.end(), lo.x - far - widest_,
                                   [](const Seam& s, double x) { return s.lo.x < x; });
        for (; at != seams_.end() && at->lo.x <= hi.x + far && least > 0; ++at) {
            const Vec2 gap = glm::max(glm::max(at->lo - hi, lo - at->hi), Vec2(0));
            if (glm::length(gap) > std::min(least, reach) + kSlack) continue;
            least = std::min({least, segment_distance(at->a, at->b, a), segment_distance(at->a, at->b, b),
                              segment_distance(a, b, at->a), segment_distance(a, b, at->b)});
        }
        return least;
    }

    void enter(std::uint32_t half, std::uint32_t first, std::uint32_t second) {
        if (used_[half / 3]) return;
        const double reach = reach_(film_.label[half / 3]);
        const double distance = seam_distance(flat_[first], flat_[second], reach);
        if (distance >= reach) return;
        queue_.push({distance, half, first, second});
    }

    void add(const Entry& e) {
        const std::uint32_t t = e.half / 3;
        used_[t] = 1;
        const std::uint32_t apex = film_.mesh.triangles[t][(e.half % 3 + 2) % 3];
        const Vec3 a = chart_.position[e.first], b = chart_.position[e.second];
        const Vec3 c = Vec3(film_.mesh.positions[apex]) - origin();
        auto [it, fresh] = vertex_.emplace(apex, static_cast<std::uint32_t>(chart_.position.size()));
        if (fresh) {
            const Vec3 x = b - a, y = c - a;
            const double along = glm::dot(x, y) / glm::dot(x, x);
            const double across = glm::length(glm::cross(x, y)) / glm::dot(x, x);
            const Vec2 u = flat_[e.second] - flat_[e.first];
            chart_.position.push_back(c);
            flat_.push_back(flat_[e.first] + along * u + across * Vec2(-u.y, u.x));
        }
        const std::uint32_t third = it->second;
        std::array<std::uint32_t, 3> face;
        face[e.half % 3] = e.first;
        face[(e.half % 3 + 1) % 3] = e.second;
        face[(e.half % 3 + 2) % 3] = third;
        chart_.faces.push_back(face);
        chart_.triangles.push_back(t);
        for (const std::uint32_t h : {mesh::next_half(e.half), mesh::prev_half(e.half)}) {
            const std::uint32_t g = twin_[h];
            if (g != kNone && film_.label[g / 3] != own_label_) enter(g, face[(h % 3 + 1) % 3], face[h % 3]);
        }
    }

    Vec3 origin() const { return film_.mesh.position(panel_.chart.triangles[0], 0); }

    void relax() {
        const std::size_t n_own = panel_.chart.faces.size();
        if (chart_.faces.size() == n_own) return;
        std::vector<std::uint32_t> ring(chart_.faces.size() - n_own);
        std::iota(ring.begin(), ring.end(), static_cast<std::uint32_t>(n_own));
        std::vector<Vec2> relaxed = flat_;
        atlas::arap(chart_, relaxed, {.iterations = 20}, ring);
        const auto finite = [](const Vec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); };
        if (std::all_of(relaxed.begin(), relaxed.end(), finite)) flat_ = std::move(relaxed);
    }

    const FilmMesh& film_;
    const Panel& panel_;
    const std::function<double(std::uint32_t)>& reach_;
    std::vector<std::uint32_t> twin_;
    std::vector<std::uint8_t> used_;
    std::uint32_t own_label_ = 0;
    atlas::ChartMesh chart_;
    std::vector<Vec2> flat_;
    std::unordered_map<std::uint32_t, std::uint32_t> vertex_;  // of the film mesh, in the strip
    std::priority_queue<Entry> queue_;
    std::vector<Seam> seams_;  // of the panel, by the lower end of their span in x
    double widest_ = 0;        // of those spans, metres
};

/// Finds the rims whose box comes within a box: a grid with about as many cells as there are rims.
class RimGrid {
  public:
    explicit RimGrid(std::span<const GapRim> rims) : rims_(rims) {
        Vec2 hi = lo_ = rims[0].a;
        double extent = 0;
        for (const GapRim& rim : rims) {
            const Vec2 from = glm::min(rim.a, rim.b), to = glm::max(rim.a, rim.b);
            lo_ = glm::min(lo_, from), hi = glm::max(hi, to);
            extent += std::max(to.x - from.x, to.y - from.y);
        }
        const auto n = static_cast<double>(rims.size());
        const Vec2 size = hi - lo_;
        cell_ = std::max({std::sqrt(size.x * size.y / n), std::max(size.x, size.y) / n, extent / n, 1e-9});
        width_ = static_cast<std::size_t>(size.x / cell_) + 1;
        cells_.resize(width_ * (static_cast<std::size_t>(size.y / cell_) + 1));
        for (std::uint32_t r = 0; r < rims.size(); ++r)
            each_cell(glm::min(rims[r].a, rims[r].b), glm::max(rims[r].a, rims[r].b),
                      [&](std::vector<std::uint32_t>& cell) { cell.push_back(r); });
    }

    /// In ascending order.
    const std::vector<std::uint32_t>& within(const Vec2& lo, const Vec2& hi) {
        found_.clear();
        each_cell(lo, hi, [&](const std::vector<std::uint32_t>& cell) {
            for (const std::uint32_t r : cell) {
                const GapRim& rim = rims_[r];
                if (std::min(rim.a.x, rim.b.x) <= hi.x && std::min(rim.a.y, rim.b.y) <= hi.y &&
                    std::max(rim.a.x, rim.b.x) >= lo.x && std::max(rim.a.y, rim.b.y) >= lo.y)
                    found_.push_back(r);
            }
        });
        std::sort(found_.begin(), found_.end());
        found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
        return found_;
    }

  private:
    void each_cell(const Vec2& lo, const Vec2& hi, auto&& use) {
        const std::size_t height = cells_.size() / width_;
        const auto of = [&](double at, std::size_t n) {
            return static_cast<std::size_t>(std::clamp(at / cell_, 0.0, static_cast<double>(n - 1)));
        };
        const Vec2 from = lo - lo_, to = hi - lo_;
        if (to.x < 0 || to.y < 0 || from.x > static_cast<double>(width_) * cell_ ||
            from.y > static_cast<double>(height) * cell_)
            return;
        for (std::size_t y = of(from.y, height); y <= of(to.y, height); ++y)
            for (std::size_t x = of(from.x, width_); x <= of(to.x, width_); ++x) use(cells_[y * width_ + x]);
    }

    std::span<const GapRim> rims_;
    Vec2 lo_{0};
    double cell_ = 1;
    std::size_t width_ = 1;
    std::vector<std::vector<std::uint32_t>> cells_;
    std::vector<std::uint32_t> found_;
};

/// Gives the faces of gaps their rims.
void add_rims(PrintSurface& surface, const std::vector<std::uint8_t>& in_gap) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> open_side;  // of an edge, as a gap's face has it
    for (std::uint32_t t = 0; t < surface.faces.size(); ++t)
        for (std::size_t k = 0; k < 3 && !in_gap[t]; ++k)
            open_side[{surface.faces[t][(k + 1) % 3], surface.faces[t][k]}] = t;
    std::vector<GapRim>& all = surface.rims;
    for (std::uint32_t t = 0; t < surface.faces.size(); ++t)
        for (std::size_t k = 0; k < 3 && in_gap[t]; ++k) {
            const std::uint32_t a = surface.faces[t][k], b = surface.faces[t][(k + 1) % 3];
            if (const auto at = open_side.find({a, b}); at != open_side.end())
                all.push_back({surface.flat[a], surface.flat[b], {at->second}});
        }
    if (all.empty()) return;
    surface.rims_of.resize(surface.faces.size());
    RimGrid grid(all);
    for (std::uint32_t t = 0; t < surface.faces.size(); ++t) {
        if (t % kFacesAtOnce == 0) check_interrupt();
        const Vec2 a = surface.flat[surface.faces[t][0]], b = surface.flat[surface.faces[t][1]],
                   c = surface.flat[surface.faces[t][2]];
        const double around = in_gap[t] ? surface.run_on : kLip;
        const Vec2 lo = glm::min(a, glm::min(b, c)) - around, hi = glm::max(a, glm::max(b, c)) + around;
        for (const std::uint32_t r : grid.within(lo, hi)) {
            if (in_gap[t])
                surface.rims_of[t].push_back(r);
            else if (t != all[r].faces[0])
                all[r].faces.push_back(t);
        }
    }
}

}  // namespace

PrintSurface extend(const FilmMesh& film, const Panel& panel, const std::function<double(std::uint32_t label)>& reach) {
    return extend(film, panel, reach, {}, 0);
}

PrintSurface extend(const FilmMesh& film, const Panel& panel, const std::function<double(std::uint32_t label)>& reach,
                    std::span<const std::uint8_t> in_gap, double run_on) {
    Strip strip(film, panel, reach);
    strip.grow();
    PrintSurface surface;
    surface.faces = strip.chart().faces;
    surface.n_own = panel.chart.faces.size();
    surface.flat = strip.flat();
    for (const std::uint32_t t : strip.chart().triangles) {
        surface.source.push_back(film.source[t]);
        surface.weights.push_back(film.weights[t]);
    }
    for (const Stretch& s : measure_stretch(strip.chart(), surface.flat))
        surface.strain.push_back(static_cast<float>(s.strain()));
    if (!in_gap.empty() && run_on > 0) {
        std::vector<std::uint8_t> here;
        for (const std::uint32_t t : strip.chart().triangles) here.push_back(in_gap[t]);
        surface.run_on = run_on;
        add_rims(surface, here);
    }
    return surface;
}

namespace {

std::optional<ModelPoint> locate_in(const PrintSurface& surface, std::size_t t, const Vec2& p) {
    const auto& f = surface.faces[t];
    const Vec2 a = surface.flat[f[0]], x = surface.flat[f[1]] - a, y = surface.flat[f[2]] - a, d = p - a;
    const double det = x.x * y.y - x.y * y.x;
    if (!(det > 0)) return std::nullopt;
    const double b = (d.x * y.y - d.y * y.x) / det, c = (x.x * d.y - x.y * d.x) / det;
    if (b < kInside || c < kInside || 1 - b - c < kInside) return std::nullopt;
    ModelPoint point{surface.source[t], {}};
    for (std::size_t k = 0; k < 3; ++k)
        point.weights[k] =
            (1 - b - c) * surface.weights[t][0][k] + b * surface.weights[t][1][k] + c * surface.weights[t][2][k];
    return point;
}

}  // namespace

PrintedPoint printed_at(const PrintSurface& surface, const CoverageFn& coverage, std::size_t t, const Vec2& p,
                        const Weights& weights) {
    const PrintedPoint own{surface.source[t], weights, coverage(surface.source[t], weights)};
    if (surface.rims_of.empty() || surface.rims_of[t].empty() || own.coverage >= 1) return own;
    double least = surface.run_on;
    const GapRim* nearest = nullptr;
    for (const std::uint32_t r : surface.rims_of[t])
        if (const double d = segment_distance(surface.rims[r].a, surface.rims[r].b, p); d < least)
            least = d, nearest = &surface.rims[r];
    if (!nearest) return own;
    const Vec2 along = nearest->b - nearest->a, out = Vec2(along.y, -along.x) / glm::length(along);
    const Vec2 rim = glm::mix(nearest->a, nearest->b, nearest_part(nearest->a, nearest->b, p));
    PrintedPoint most = own;
    for (const double before : {kBesideRim, kLip})
        for (const std::uint32_t face : nearest->faces)
            if (const auto there = locate_in(surface, face, rim + before * out)) {
                const double cover = coverage(there->triangle, there->weights);
                if (cover > std::max(most.coverage, kPainted)) most = {there->triangle, there->weights, cover};
                break;
            }
    return most;
}

std::optional<ModelPoint> locate(const PrintSurface& surface, const Vec2& p) {
    for (std::size_t t = 0; t < surface.faces.size(); ++t)
        if (const auto point = locate_in(surface, t, p)) return point;
    return std::nullopt;
}

SurfaceLocator::SurfaceLocator(const PrintSurface& surface) : surface_(surface) {
    if (surface.flat.empty()) {
        start_.assign(2, 0);
        return;
    }
    Vec2 hi = lo_ = surface.flat[0];
    for (const Vec2& p : surface.flat) lo_ = glm::min(lo_, p), hi = glm::max(hi, p);
    const Vec2 size = hi - lo_;
    const auto n = static_cast<double>(std::max<std::size_t>(surface.faces.size(), 1));
    cell_ = std::max({std::sqrt(size.x * size.y / n), std::max(size.x, size.y) / n, 1e-9});
    // A point that counts as inside may lie a little off its triangle.
    const auto cells_of = [&](std::size_t t) {
        const auto& f = surface.faces[t];
        const Vec2 a = surface.flat[f[0]], b = surface.flat[f[1]], c = surface.flat[f[2]];
        const Vec2 from = glm::min(a, glm::min(b, c)), to = glm::max(a, glm::max(b, c));
        const Vec2 around = -2 * kInside * (to - from);
        return std::pair(cell_of(from.x - around.x, from.y - around.y), cell_of(to.x + around.x, to.y + around.y));
    };
    const auto each_cell = [&](std::size_t t, auto&& use) {
        const auto [first, last] = cells_of(t);
        for (std::size_t y = first / width_; y <= last / width_; ++y)
            for (std::size_t x = first % width_; x <= last % width_; ++x) use(y * width_ + x);
    };
    // Boxes of needles overlap in many cells: in wider ones they are fewer.
    const std::size_t most = kMostListed * surface.faces.size();
    for (;; cell_ *= 2) {
        width_ = static_cast<std::size_t>(size.x / cell_) + 1;
        height_ = static_cast<std::size_t>(size.y / cell_) + 1;
        std::size_t listed = 0;
        for (std::size_t t = 0; t < surface.faces.size() && listed <= most; ++t) {
            const auto [first, last] = cells_of(t);
            listed += (last / width_ - first / width_ + 1) * (last % width_ - first % width_ + 1);
        }
        if (listed <= most) break;
    }
    start_.assign(width_ * height_ + 1, 0);
    for (std::size_t t = 0; t < surface.faces.size(); ++t) each_cell(t, [&](std::size_t i) { ++start_[i + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    triangles_.resize(start_.back());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t t = 0; t < surface.faces.size(); ++t)
        each_cell(t, [&](std::size_t i) { triangles_[next[i]++] = static_cast<std::uint32_t>(t); });
}

std::size_t SurfaceLocator::cell_of(double x, double y) const {
    const auto along = [&](double at, std::size_t n) {
        return static_cast<std::size_t>(std::clamp(at / cell_, 0.0, static_cast<double>(n - 1)));
    };
    return along(y - lo_.y, height_) * width_ + along(x - lo_.x, width_);
}

std::optional<ModelPoint> SurfaceLocator::locate(const Vec2& p) const {
    const std::size_t i = cell_of(p.x, p.y);
    for (std::size_t k = start_[i]; k < start_[i + 1]; ++k)
        if (const auto point = locate_in(surface_, triangles_[k], p)) return point;
    return std::nullopt;
}

Vec2 flat_direction(const atlas::ChartMesh& chart, std::span<const Vec2> flat, const Vec3& direction) {
    Vec2 sum(0);
    double area = 0;
    for (const auto& f : chart.faces) {
        const Vec3 x = chart.position[f[1]] - chart.position[f[0]], y = chart.position[f[2]] - chart.position[f[0]];
        const Vec2 u = flat[f[1]] - flat[f[0]], v = flat[f[2]] - flat[f[0]];
        // The direction's tangential part is α x + β y.
        const double xx = glm::dot(x, x), xy = glm::dot(x, y), yy = glm::dot(y, y), det = xx * yy - xy * xy;
        if (!(det > 0)) continue;
        const double dx = glm::dot(direction, x), dy = glm::dot(direction, y);
        const double a = 0.5 * std::sqrt(det);
        sum += a * ((dx * yy - dy * xy) / det * u + (dy * xx - dx * xy) / det * v);
        area += a;
    }
    return area > 0 ? sum / area : Vec2(0);
}

}  // namespace tuft::decal
