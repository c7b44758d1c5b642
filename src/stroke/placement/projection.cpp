#include "stroke/placement/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>

#include "core/system/interrupt.h"
#include "stroke/placement/surface_mapping.h"

namespace tuft::stroke {

namespace {

using mesh::SurfaceQuery;

constexpr double kEdgeStep = 0.5;   // of `drape_radius`: least step of an edge, widest gap that is none
constexpr double kSheetSlope = 2;   // slope of a sheet against the plane of the drawing
constexpr double kSheetCell = 0.5;  // steps: what parts two sheets is wider than a step
constexpr double kMostSheetCells = 3e5;
constexpr double kRaySpacing = 0.125;     // steps: of the rays along a path
constexpr double kMostRaysBetween = 1e4;  // rays between two samples

/// The model as the rays of a placement see it.
class ProjectedView {
  public:
    ProjectedView(const SurfaceQuery& query, const Placement& place)
        : query_(query),
          origin_(place.origin),
          outward_(glm::normalize(glm::cross(place.down, place.right))),
          axes_(axes_across(outward_, place.right, place.down)) {}

    const Vec3& outward() const { return outward_; }
    const Axes& axes() const { return axes_; }
    Vec3 on_plane(const Vec2& flat) const { return origin_ + flat.x * axes_.right + flat.y * axes_.down; }
    Vec2 flat(const Vec3& p) const { return {glm::dot(p - origin_, axes_.right), glm::dot(p - origin_, axes_.down)}; }
    double height(const Vec3& p) const { return glm::dot(p - origin_, outward_); }

    std::optional<mesh::SurfacePoint> hit(const Vec2& flat) const {
        const Box& bounds = query_.mesh().bounds;
        const Vec3 p = on_plane(flat);
        const double above = glm::dot(bounds.centre() - p, outward_) + bounds.diagonal();
        return exact_ray(query_, p + above * outward_, -outward_, std::numeric_limits<double>::infinity());
    }

  private:
    const SurfaceQuery& query_;
    Vec3 origin_, outward_;
    Axes axes_;
};

/// Gives samples that are not on the surface the height and frame of the nearest one that is.
void fill_misses(SurfaceTrace& mapped, const ProjectedView& view) {
    std::vector<std::size_t> hits;
    for (std::size_t i = 0; i < mapped.samples.size(); ++i)
        if (mapped.samples[i].on_surface) hits.push_back(i);
    if (hits.empty()) return;
    std::size_t next = 0;
    for (std::size_t i = 0; i < mapped.samples.size(); ++i) {
        SurfaceSample& s = mapped.samples[i];
        if (s.on_surface) continue;
        while (next < hits.size() && hits[next] < i) ++next;
        std::size_t from = next < hits.size() ? hits[next] : hits.back();
        if (next > 0 && next < hits.size() &&
            s.time - mapped.samples[hits[next - 1]].time <= mapped.samples[hits[next]].time - s.time)
            from = hits[next - 1];
        const SurfaceSample& near = mapped.samples[from];
        s.on = near.on;
        s.normal = near.normal;
        s.right = near.right;
        s.down = near.down;
        s.position += glm::dot(near.position - s.position, view.outward()) * view.outward();
    }
}

/// The sheets that a view sees in a rectangle, numbered, on a grid of rays.
class VisibleSheets {
  public:
    VisibleSheets(const ProjectedView& view, const Vec2& low, const Vec2& high, double step) : low_(low), step_(step) {
        const Vec2 size = glm::max(high - low, Vec2(step));
        cell_ = std::max(kSheetCell * step, std::sqrt(size.x * size.y / kMostSheetCells));
        nx_ = static_cast<int>(size.x / cell_) + 1, ny_ = static_cast<int>(size.y / cell_) + 1;
        heights_.assign(static_cast<std::size_t>(nx_) * static_cast<std::size_t>(ny_), kNothing);
        for (int j = 0; j < ny_; ++j) {
            check_interrupt();
            for (int i = 0; i < nx_; ++i)
                if (const auto hit = view.hit(low_ + cell_ * Vec2(i, j)))
                    heights_[index(i, j)] = view.height(hit->position);
        }
        number();
    }

    /// Number of the sheet at a flat point of this height; nothing where the nearest ray saw another.
    std::optional<int> at(const Vec2& flat, double height) const {
        const Vec2 cell = glm::round((flat - low_) / cell_);
        if (!(cell.x >= 0 && cell.y >= 0 && cell.x < nx_ && cell.y < ny_)) return {};
        const std::size_t k = index(static_cast<int>(cell.x), static_cast<int>(cell.y));
        if (!(std::abs(heights_[k] - height) <= highest_step(1))) return {};
        return numbers_[k];
    }

  private:
    static constexpr double kNothing = -std::numeric_limits<double>::infinity();

    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_) + static_cast<std::size_t>(i);
    }
    double highest_step(int cells) const { return std::max(step_, kSheetSlope * cells * cell_); }

    void number() {
        numbers_.assign(heights_.size(), -1);
        std::vector<std::pair<int, int>> open;
        int sheet = 0;
        for (int j = 0; j < ny_; ++j)
            for (int i = 0; i < nx_; ++i) {
                if (heights_[index(i, j)] == kNothing || numbers_[index(i, j)] >= 0) continue;
                open.assign(1, {i, j});
                numbers_[index(i, j)] = sheet;
                while (!open.empty()) {
                    const auto [x, y] = open.back();
                    open.pop_back();
                    spread(x, y, sheet, open);
                }
                ++sheet;
            }
    }

    void spread(int x, int y, int sheet, std::vector<std::pair<int, int>>& open) {
        const double from = heights_[index(x, y)];
        for (const int away : {1, 2})  // over a gap that one ray falls into
            for (const auto& [dx, dy] : {std::pair(away, 0), {-away, 0}, {0, away}, {0, -away}}) {
                const int i = x + dx, j = y + dy;
                if (i < 0 || j < 0 || i >= nx_ || j >= ny_) continue;
                const std::size_t k = index(i, j);
                if (numbers_[k] >= 0 || !(std::abs(heights_[k] - from) <= highest_step(away))) continue;
                numbers_[k] = sheet;
                open.emplace_back(i, j);
            }
    }

    Vec2 low_;
    double step_, cell_ = 0;  // metres
    int nx_ = 0, ny_ = 0;
    std::vector<double> heights_;  // metres above the drawing's plane
    std::vector<int> numbers_;
};

/// A place of a path: a sample, or one between two.
struct PathPoint {
    Vec2 flat{0};
    double along = 0;              // metres of path
    std::optional<double> height;  // metres above the drawing's plane; nothing: the ray hits nothing
    bool pressed = false;
};

/// Points of a path at its samples and, at most `spacing` apart, between them.
struct ProjectedPath {
    std::vector<PathPoint> points;
    std::vector<std::size_t> of_sample;  // index of each sample's point
};

ProjectedPath refine_path(const ProjectedView& view, const StrokeSamples& trace, const SurfaceTrace& mapped,
                          double spacing) {
    ProjectedPath path;
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        check_interrupt();
        const StrokeSample& s = trace.samples[i];
        const Vec2 to(s.position);
        if (i > 0) {
            const PathPoint from = path.points.back();
            const double length = glm::distance(from.flat, to);
            const int n = static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, kMostRaysBetween));
            for (int k = 1; k < n; ++k) {
                const double part = static_cast<double>(k) / n;
                PathPoint p{
                    glm::mix(from.flat, to, part), from.along + part * length, {}, from.pressed && s.pressure > 0};
                if (const auto hit = view.hit(p.flat)) p.height = view.height(hit->position);
                path.points.push_back(p);
            }
            path.points.push_back({to, from.along + length, {}, s.pressure > 0});
        } else {
            path.points.push_back({to, 0, {}, s.pressure > 0});
        }
        if (mapped.samples[i].on_surface) path.points.back().height = view.height(mapped.samples[i].position);
        path.of_sample.push_back(path.points.size() - 1);
    }
    return path;
}

/// Points `first` to `last` of a path, between which it crosses no edge.
struct SheetRun {
    std::size_t first = 0, last = 0;
};

/// Divides a path where it crosses an edge.
std::vector<SheetRun> divide_at_edges(std::span<const PathPoint> points, double step) {
    const double gap = (1 + 2 * kRaySpacing) * step;  // between points on both sides of one that is a step wide
    std::vector<SheetRun> runs;
    const auto join = [&](std::size_t i) {
        const PathPoint& p = points[i];
        if (!runs.empty() && runs.back().last + 1 == i) {
            const PathPoint& before = points[i - 1];
            if (std::abs(*p.height - *before.height) <= std::max(step, kSheetSlope * (p.along - before.along))) {
                runs.back().last = i;
                return true;
            }
        }
        for (std::size_t r = runs.size(); r-- > 0 && p.along - points[runs[r].last].along <= gap;)
            if (std::abs(*p.height - *points[runs[r].last].height) <= step) {
                runs.resize(r + 1);
                runs[r].last = i;
                return true;
            }
        return false;
    };
    for (std::size_t i = 0; i < points.size(); ++i)
        if (points[i].height && !join(i)) runs.push_back({i, i});
    return runs;
}

/// Number of the sheet under each run.
std::vector<int> sheets_of(const ProjectedView& view, std::span<const PathPoint> points, std::span<const SheetRun> runs,
                           const Box& model, double step) {
    Vec2 low(std::numeric_limits<double>::infinity()), high = -low, least = low, most = high;
    for (const SheetRun& run : runs)
        for (std::size_t i = run.first; i <= run.last; ++i)
            low = glm::min(low, points[i].flat), high = glm::max(high, points[i].flat);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p(corner & 1 ? model.hi.x : model.lo.x, corner & 2 ? model.hi.y : model.lo.y,
                     corner & 4 ? model.hi.z : model.lo.z);
        least = glm::min(least, view.flat(p)), most = glm::max(most, view.flat(p));
    }
    // What leads round an edge is hardly further from the path than the path is long.
    const double round = std::max({high.x - low.x, high.y - low.y, step});
    const VisibleSheets sheets(view, glm::max(low - round, least), glm::min(high + round, most), step);
    std::vector<int> out;
    for (const SheetRun& run : runs) {
        std::map<int, std::size_t> seen;
        for (std::size_t i = run.first; i <= run.last; ++i)
            if (points[i].height)
                if (const auto sheet = sheets.at(points[i].flat, *points[i].height)) ++seen[*sheet];
        const auto best = std::max_element(seen.begin(), seen.end(),
                                           [](const auto& a, const auto& b) { return a.second < b.second; });
        out.push_back(best != seen.end() ? best->first : -1 - static_cast<int>(out.size()));
    }
    return out;
}

/// The runs on the sheet of the stroke.
std::vector<SheetRun> runs_of_stroke(const ProjectedView& view, std::span<const PathPoint> points, const Box& model,
                                     double step) {
    std::vector<SheetRun> runs = divide_at_edges(points, step);
    if (runs.size() < 2) return runs;
    const std::vector<int> sheets = sheets_of(view, points, runs, model, step);
    std::map<int, double> pressed;
    for (std::size_t r = 0; r < runs.size(); ++r)
        for (std::size_t i = runs[r].first; i < runs[r].last; ++i)
            if (points[i].pressed) pressed[sheets[r]] += points[i + 1].along - points[i].along;
    int own = sheets.front();
    if (sheets.back() != own)
        for (const int sheet : sheets)
            if (pressed[sheet] > pressed[own]) own = sheet;
    std::vector<SheetRun> out;
    for (std::size_t r = 0; r < runs.size(); ++r)
        if (sheets[r] == own) out.push_back(runs[r]);
    return out;
}

}  // namespace

SurfaceTrace map_projected(const SurfaceQuery& query, const StrokeSamples& trace) {
    const ProjectedView view(query, trace.placement);
    SurfaceTrace mapped;
    if (const auto near = query.closest_point(trace.placement.origin)) mapped.origin_gap = near->distance;
    mapped.samples.reserve(trace.samples.size());
    for (const StrokeSample& s : trace.samples) {
        check_interrupt();
        SurfaceSample out = hand_data(s);
        out.position = view.on_plane(Vec2(s.position));
        out.normal = view.outward();
        out.right = view.axes().right;
        out.down = view.axes().down;
        if (const auto hit = view.hit(Vec2(s.position))) {
            out.on = *hit;
            out.position = out.on.position;
            out.normal = out.on.normal;
            const Axes here = axes_across(out.normal, view.axes().right, view.axes().down);
            out.right = here.right;
            out.down = here.down;
        } else {
            out.on_surface = false;
            ++mapped.missed;
        }
        mapped.samples.push_back(out);
    }
    fill_misses(mapped, view);
    return mapped;
}

std::vector<bool> leave_other_sheets(const SurfaceQuery& query, const StrokeSamples& trace, SurfaceTrace& mapped) {
    if (trace.placement.mapping != SurfaceMapping::project) return {};
    const ProjectedView view(query, trace.placement);
    const double step = kEdgeStep * drape_radius(query.mesh());
    const ProjectedPath path = refine_path(view, trace, mapped, kRaySpacing * step);
    const std::vector<SheetRun> runs = runs_of_stroke(view, path.points, query.mesh().bounds, step);
    std::vector<bool> left(trace.samples.size(), !runs.empty());
    for (std::size_t i = 0, r = 0; i < left.size(); ++i) {
        while (r < runs.size() && runs[r].last < path.of_sample[i]) ++r;
        if (r < runs.size() && runs[r].first <= path.of_sample[i]) left[i] = false;
    }
    bool changed = false;
    for (std::size_t i = 0; i < left.size(); ++i)
        if (left[i] && mapped.samples[i].on_surface) {
            mapped.samples[i].on_surface = false;
            ++mapped.missed;
            changed = true;
        }
    if (!changed) return left;
    std::vector<double> seen;
    for (const SurfaceSample& s : mapped.samples) seen.push_back(view.height(s.position));
    fill_misses(mapped, view);
    // Over all that the ray hits until the stroke comes back: hair reaches further than a sample.
    for (std::size_t i = 0; i < left.size();) {
        std::size_t end = i;
        double over = 0;
        for (; end < left.size() && left[end]; ++end)
            over = std::max(over, seen[end] - view.height(mapped.samples[end].position));
        for (; i < end; ++i) mapped.samples[i].position += over * view.outward();
        if (i < left.size()) ++i;
    }
    return left;
}

}  // namespace tuft::stroke
