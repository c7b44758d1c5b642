#include "stroke/drawing/follow_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "brush/preset/preset.h"
#include "core/overloaded.h"
#include "stroke/drawing/drawing.h"
#include "stroke/placement/placement.h"

namespace tuft::stroke {
namespace {

using Mat2 = glm::dmat2;

constexpr double kSameScale = 1e-9;

bool stretches(const ModelMotion& motion) {
    return motion.stretch != Mat3(1);
}

/// Places a flat shape anew; returns the map of its plane.
Mat2 move_placement(Placement& placement, const ModelMotion& motion) {
    const Mat3 linear = motion.linear();
    const Vec3 x = glm::normalize(placement.right);
    const Vec3 y = glm::normalize(placement.down - glm::dot(placement.down, x) * x);
    const Vec3 to_x = linear * x, to_y = linear * y;
    const Vec3 right = glm::normalize(to_x);
    const Vec3 down = glm::normalize(to_y - glm::dot(to_y, right) * right);
    // Directions of any length and angle: what they say beyond their plane and turn stays as it was.
    const double skew = glm::dot(placement.down, x);
    placement.origin = motion(placement.origin);
    placement.down = skew * right + glm::dot(placement.down, y) * down;
    placement.right = glm::length(placement.right) * right;
    return Mat2(Vec2(glm::dot(to_x, right), 0), Vec2(glm::dot(to_y, right), glm::dot(to_y, down)));
}

/// The part of a map of the plane that leaves areas as large.
Mat2 without_scale(const Mat2& map) {
    return map / std::sqrt(glm::determinant(map));
}

void move_flat(StrokeSamples& trace, const ModelMotion& motion) {
    const Mat2 map = move_placement(trace.placement, motion);
    const double scale = std::sqrt(glm::determinant(map));
    if (std::abs(scale - 1) > kSameScale) transform_samples(trace, Vec2(0), scale);
    if (!stretches(motion)) return;
    const Mat2 rest = without_scale(map);
    for (StrokeSample& s : trace.samples) s.position = Vec3(rest * Vec2(s.position), s.position.z);
    for (StencilEdge& edge : trace.stencil) edge = {rest * edge.from, rest * edge.to};
}

void move_area(FlatArea& area, const ModelMotion& motion) {
    const Mat2 map = move_placement(area.placement, motion);
    const double scale = std::sqrt(glm::determinant(map));
    if (std::abs(scale - 1) > kSameScale) transform_area(area, Vec2(0), scale);
    if (!stretches(motion)) return;
    const Mat2 rest = without_scale(map);
    for (auto* paths : {&area.rings, &area.lines, &area.under})
        for (auto& path : *paths)
            for (Vec2& p : path) p = rest * p;
    area.low = rest * area.low, area.high = rest * area.high, area.reading.centre = rest * area.reading.centre;
    auto& a = area.to_unit;
    const Mat2 unit = Mat2(a[0], a[1], a[2], a[3]) * glm::inverse(rest);
    a[0] = unit[0][0], a[1] = unit[0][1], a[2] = unit[1][0], a[3] = unit[1][1];
}

void move_poses(StrokeSamples& trace, const ModelMotion& motion, const mesh::SurfaceQuery& former) {
    for (StrokeSample& s : trace.samples) {
        const Vec3 p = s.position;
        s.position = motion(p);
        if (stretches(motion))
            if (const auto foot = former.closest_point(p))
                s.position = motion(foot->position) + motion.scale * (motion.rotation * (p - foot->position));
        s.rotation = glm::normalize(motion.rotation * s.rotation);
        s.time *= motion.scale;
    }
    trace.line_width *= motion.scale;
}

std::string scaled_brush(const std::string& name, double scale) {
    if (name.empty() || std::abs(scale - 1) < kSameScale) return name;
    brush::SizedName sized = brush::sized_name(name);
    sized.factor *= scale;
    return brush::name_of(sized);
}

/// Groups of the former model, by place.
class Groups {
  public:
    Groups(const ModelChange& change, const mesh::SurfaceQuery& former) : change_(change), former_(former) {}

    ModelMotion at(const Vec3& point) const {
        if (change_.parts.empty()) return whole();
        const auto hit = former_.closest_point(point);
        return hit ? change_.of(name_of(hit->triangle)) : whole();
    }
    ModelMotion whole() const { return change_.whole.value_or(ModelMotion{}); }

    /// That of the group which more than half of the ink lies on.
    ModelMotion of(const StrokeSamples& trace) const {
        if (change_.parts.empty() || trace.samples.empty()) return whole();
        std::map<std::string, std::size_t> counts;
        std::size_t all = 0;
        const auto count = [&](std::uint32_t triangle) { ++counts[name_of(triangle)], ++all; };
        if (trace.flat) {
            for (const SurfaceSample& s : map_to_surface(former_, trace).samples)
                if (s.on_surface && s.pressure > 0) count(s.on.triangle);
        } else {
            for (const StrokeSample& s : trace.samples)
                if (const auto hit = former_.closest_point(s.position)) count(hit->triangle);
        }
        for (const auto& [name, n] : counts)
            if (2 * n > all) return change_.of(name);
        return whole();
    }

  private:
    const std::string& name_of(std::uint32_t triangle) const {
        const mesh::TriangleMesh& mesh = former_.mesh();
        return mesh.group_names[mesh.triangle_groups[triangle]];
    }

    const ModelChange& change_;
    const mesh::SurfaceQuery& former_;
};

void move_mask(Mask& mask, const ModelMotion& motion) {
    mask.direction = motion.rotation * mask.direction;
    for (Vec3& p : mask.points) p = motion(p);
    mask.view.origin = motion(mask.view.origin);
    mask.view.right = motion.rotation * mask.view.right;
    mask.view.up = motion.rotation * mask.view.up;
    if (!mask.view.perspective)
        for (Vec2& p : mask.polygon) p *= motion.scale;
}

void move_fill(Fill& fill, const Groups& groups) {
    const ModelMotion motion = fill.area                    ? groups.at(fill.area->placement.origin)
                               : fill.region == Region::all ? groups.whole()
                                                            : groups.at(fill.at);
    fill.from = motion(fill.from), fill.to = motion(fill.to), fill.at = motion(fill.at);
    if (fill.area) move_area(*fill.area, motion);
}

void move_stroke(PaintStroke& stroke, const Groups& groups, const mesh::SurfaceQuery& former) {
    const ModelMotion motion = groups.of(stroke.trace);
    if (stroke.trace.flat)
        move_flat(stroke.trace, motion);
    else
        move_poses(stroke.trace, motion, former);
    stroke.brush = scaled_brush(stroke.brush, motion.scale);
}

/// Fills gaps with the value nearest in the row.
std::vector<double> without_gaps(const std::vector<std::optional<double>>& values) {
    std::vector<double> out(values.size(), 0);
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t d = 0; d < values.size(); ++d) {
            if (i >= d && values[i - d]) {
                out[i] = *values[i - d];
                break;
            }
            if (i + d < values.size() && values[i + d]) {
                out[i] = *values[i + d];
                break;
            }
        }
    return out;
}

}  // namespace

std::vector<JournalEntry> follow_model(std::vector<JournalEntry> entries, const ModelChange& change,
                                       const mesh::SurfaceQuery& former) {
    if (change.none()) return entries;
    const Groups groups(change, former);
    const double scale = groups.whole().scale;
    for (JournalEntry& entry : entries) {
        if (on_palette(entry)) continue;
        std::visit(Overloaded{[&](PaintStroke& s) { move_stroke(s, groups, former); },
                              [&](BrushAction& a) { a.brush = scaled_brush(a.brush, scale); },
                              [&](Fill& f) { move_fill(f, groups); },
                              [&](MaskEdit& m) {
                                  if (!m.remove) move_mask(m.mask, groups.whole());
                              },
                              [](Dry&) {}, [](WashPalette&) {}, [](LayerEdit&) {}, [](PartEdit&) {}},
                   entry.content);
    }
    return entries;
}

ModelMotion motion_of(const StrokeSamples& trace, const ModelChange& change, const mesh::SurfaceQuery& former) {
    return Groups(change, former).of(trace);
}

JournalEntry pull_onto(const JournalEntry& entry, JournalEntry moved, double length, const mesh::SurfaceQuery& former,
                       const mesh::SurfaceQuery& revised) {
    const PaintStroke* was = entry.as<PaintStroke>();
    PaintStroke* is = moved.as<PaintStroke>();
    if (!was || !is || was->trace.flat || was->trace.samples.size() != is->trace.samples.size()) return moved;
    const std::vector<brush::Pose> before = spatial_poses(was->trace), now = spatial_poses(is->trace);
    std::vector<std::optional<double>> steps(before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const auto former_hit = former.ray(before[i].position, before[i].axis(), 0, length);
        if (!former_hit) continue;
        const Vec3 axis = now[i].axis();
        const auto hit = revised.ray(now[i].position - length * axis, axis, 0, 3 * length);
        if (hit) steps[i] = hit->distance - length - former_hit->distance;
    }
    const std::vector<double> filled = without_gaps(steps);
    for (std::size_t i = 0; i < filled.size(); ++i) is->trace.samples[i].position += filled[i] * now[i].axis();
    return moved;
}

}  // namespace tuft::stroke
