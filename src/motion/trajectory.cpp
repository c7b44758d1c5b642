#include "motion/trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace tuft::motion {
namespace {

constexpr double kPathTolerance = 5e-6;  // metres
constexpr double kPaceTolerance = 1e-3;  // seconds
constexpr std::size_t kLongestRun = 64;  // points left out in a row
constexpr double kCheckStep = 2e-3;      // metres
constexpr double kTravelStep = 5e-3;     // metres between waypoints
constexpr double kFree = 1e-3;           // metres of the holder's first ball above the mouth that may touch

/// The tool: what moves with the ferrule.
struct Tool {
    Holder holder;
    double tuft_length = 0, tuft_radius = 0;
};

Vec3 up_of(const brush::Pose& pose) {
    return -pose.axis();
}

double lean_of(const brush::Pose& pose) {
    return std::acos(std::clamp(up_of(pose).z, -1.0, 1.0));
}

/// Returns where the holder is inside the model at a pose, if it is.
std::optional<Vec3> hit_of_holder(const mesh::SurfaceQuery& query, const Holder& holder, const brush::Pose& pose) {
    for (double s = holder.radius + kFree; s < holder.length; s += holder.radius) {
        const auto near = query.closest_point(pose.position + s * up_of(pose), holder.radius);
        if (near && near->distance < holder.radius) return near->position;
    }
    return std::nullopt;
}

/// Whether the whole tool, its tuft straight, stays `kTravelGap` off the model.
bool is_clear(const mesh::SurfaceQuery& query, const Tool& tool, const brush::Pose& pose) {
    for (double s = -tool.tuft_length; s < tool.holder.length; s += std::max(1e-3, tool.tuft_radius)) {
        const double radius =
            (s < 0 ? tool.tuft_radius * std::min(1.0, 1 + s / tool.tuft_length) : tool.holder.radius) + kTravelGap;
        if (query.closest_point(pose.position + s * up_of(pose), radius)) return false;
    }
    return true;
}

/// The poses of a polyline at steps of at most `step` metres, or 5°, without times.
std::vector<brush::Pose> densified(const std::vector<brush::Pose>& corners, double step) {
    std::vector<brush::Pose> poses{corners.front()};
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const double n =
            std::ceil(std::max(glm::length(corners[i + 1].position - corners[i].position) / step,
                               angle_between(corners[i].rotation, corners[i + 1].rotation) / (std::numbers::pi / 36)));
        for (int k = 1; k <= n; ++k) {
            poses.push_back(brush::interpolate(corners[i], corners[i + 1], k / n));
            poses.back().time = 0;
        }
    }
    return poses;
}

bool is_clear(const mesh::SurfaceQuery& query, const Tool& tool, const std::vector<brush::Pose>& corners) {
    const std::vector<brush::Pose> poses = densified(corners, kCheckStep);
    return std::all_of(poses.begin(), poses.end(), [&](const brush::Pose& p) { return is_clear(query, tool, p); });
}

/// A path from a to b round the model.
std::vector<brush::Pose> path_round(const mesh::TriangleMesh& mesh, const Tool& tool, const brush::Pose& a,
                                    const brush::Pose& b, double clearance) {
    const Vec3 centre = mesh.bounds.centre();
    const double radius = 0.5 * mesh.bounds.diagonal() + tool.tuft_length + tool.holder.radius + clearance;
    const auto out = [&](const brush::Pose& pose) {
        const Vec3 d = pose.position - centre, up = up_of(pose);
        const double along = glm::dot(d, up);
        const double rest = along * along - glm::dot(d, d) + radius * radius;
        const double t = rest > 0 ? std::max(0.0, -along + std::sqrt(rest)) : 0;
        return brush::Pose{pose.position + t * up, pose.rotation, 0};
    };
    const brush::Pose outer_a = out(a), outer_b = out(b);
    std::vector<brush::Pose> corners{a, outer_a};
    const auto arc = [&](const brush::Pose& from, const brush::Pose& to) {
        std::vector<brush::Pose> poses;
        const Vec3 p = glm::normalize(from.position - centre), q = glm::normalize(to.position - centre);
        const double angle = std::acos(std::clamp(glm::dot(p, q), -1.0, 1.0));
        const int n = std::max(1, static_cast<int>(angle / 0.05));
        for (int k = 1; k <= n; ++k) {
            const double t = static_cast<double>(k) / n;
            const Vec3 d = angle > 3.13 || angle < 1e-6
                               ? p + t * (q - p)
                               : (std::sin((1 - t) * angle) * p + std::sin(t * angle) * q) / std::sin(angle);
            const double r = glm::length(from.position - centre) * (1 - t) + glm::length(to.position - centre) * t;
            poses.push_back({centre + r * d, glm::slerp(from.rotation, to.rotation, t), 0});
        }
        return poses;
    };
    std::vector<brush::Pose> over = arc(outer_a, outer_b);
    const bool below = std::any_of(over.begin(), over.end() - 1, [&](const brush::Pose& pose) {
        return pose.position.z < mesh.bounds.lo.z && pose.position.z < std::min(outer_a.position.z, outer_b.position.z);
    });
    const Vec3 p = glm::normalize(outer_a.position - centre), q = glm::normalize(outer_b.position - centre);
    if (below || glm::dot(p, q) < -0.9) {
        const brush::Pose top{centre + Vec3(0, 0, radius), glm::slerp(outer_a.rotation, outer_b.rotation, 0.5), 0};
        over = arc(outer_a, top);
        const std::vector<brush::Pose> down = arc(top, outer_b);
        over.insert(over.end(), down.begin(), down.end());
    }
    corners.insert(corners.end(), over.begin(), over.end());
    corners.push_back(b);
    return corners;
}

/// Leaves out points that lie on the line between those that stay, in space, at the unbent tip and on the hand's clock:
/// hair trails by its speed, so that a pace lost is a tip elsewhere.
std::vector<Waypoint> thinned(const std::vector<Waypoint>& points, double tuft_length) {
    const double turn = kPathTolerance / tuft_length;
    std::vector<Waypoint> kept{points.front()};
    const auto fits = [&](std::size_t from, std::size_t to) {
        const brush::Pose &a = points[from].pose, &b = points[to].pose;
        const Vec3 d = b.position - a.position;
        const double square = glm::dot(d, d);
        double last = 0;
        for (std::size_t i = from + 1; i < to; ++i) {
            const brush::Pose& p = points[i].pose;
            const double t = square > 0 ? glm::dot(p.position - a.position, d) / square : 0;
            if (t < last || t > 1) return false;  // the path turns back
            last = t;
            if (glm::length(a.position + t * d - p.position) > kPathTolerance ||
                angle_between(glm::slerp(a.rotation, b.rotation, t), p.rotation) > turn ||
                std::abs(std::lerp(a.time, b.time, t) - p.time) > kPaceTolerance)
                return false;
        }
        return true;
    };
    for (std::size_t from = 0; from + 1 < points.size();) {
        std::size_t to = from + 1;
        while (to + 1 < points.size() && to - from < kLongestRun && fits(from, to + 1)) ++to;
        kept.push_back(points[to]);
        from = to;
    }
    return kept;
}

std::string title_of(const StrokePath& stroke) {
    return std::to_string(stroke.id) + (stroke.label.empty() ? "" : " '" + stroke.label + "'");
}

/// One after the other, the clock running.
class Planner {
  public:
    Planner(const mesh::SurfaceQuery& query, const MotionOptions& options) : query_(query), options_(options) {}

    void add(const StrokePath& stroke, std::size_t index) {
        const Tool tool{options_.holder, stroke.tuft_length, stroke.tuft_radius};
        std::vector<Waypoint> points = thinned(stroke.points, tool.tuft_length);
        for (Waypoint& p : points) {
            check(stroke, p.pose);
            p.hand_time = p.pose.time - stroke.points.front().pose.time;
        }
        const auto lifted = [&](const brush::Pose& pose) {
            return brush::Pose{pose.position + (stroke.tuft_length + options_.clearance) * up_of(pose), pose.rotation,
                               0};
        };
        const brush::Pose above = lifted(points.front().pose), after = lifted(points.back().pose);
        for (const auto& [from, to] : {std::pair{above, points.front().pose}, std::pair{points.back().pose, after}})
            for (const brush::Pose& pose : densified({from, to}, kCheckStep)) check(stroke, pose);
        if (!trajectory_.moves.empty()) travel(tool, stroke, index, above);
        append(MoveKind::approach, index, poses_of(densified({above, points.front().pose}, kTravelStep)), {});
        std::vector<double> pace;
        for (std::size_t i = 0; i + 1 < points.size(); ++i)
            pace.push_back(std::max(0.0, points[i + 1].pose.time - points[i].pose.time));
        const brush::Pose last = points.back().pose;
        append(MoveKind::stroke, index, std::move(points), pace);
        append(MoveKind::retract, index, poses_of(densified({last, after}, kTravelStep)), {});
    }

    Trajectory finish() { return std::move(trajectory_); }

  private:
    static std::vector<Waypoint> poses_of(const std::vector<brush::Pose>& poses) {
        std::vector<Waypoint> points;
        points.reserve(poses.size());
        for (const brush::Pose& p : poses) points.push_back({p, Vec3(0)});
        return points;
    }

    void check(const StrokePath& stroke, const brush::Pose& pose) const {
        const std::optional<Vec3> hit = hit_of_holder(query_, options_.holder, pose);
        if (!hit) return;
        const Vec3 mm = 1000.0 * *hit;
        throw Error(
            Message("stroke {}: the holder would hit the model at {}, {}, {} mm; choose a thinner or shorter one "
                    "or lean the brush",
                    title_of(stroke), std::lround(mm.x), std::lround(mm.y), std::lround(mm.z)));
    }

    void travel(const Tool& tool, const StrokePath& stroke, std::size_t index, const brush::Pose& to) {
        const brush::Pose from = trajectory_.moves.back().points.back().pose;
        std::vector<brush::Pose> corners{from, to};
        if (!is_clear(query_, tool, corners)) {
            corners = path_round(query_.mesh(), tool, from, to, options_.clearance);
            if (!is_clear(query_, tool, corners))
                throw Error(Message("stroke {}: no path clear of the model leads to it", title_of(stroke)));
        }
        append(MoveKind::travel, index, poses_of(densified(corners, kTravelStep)), {});
    }

    void append(MoveKind kind, std::size_t stroke, std::vector<Waypoint> points, std::span<const double> pace) {
        retime(points, options_.limits, pace);
        const double start = trajectory_.seconds();
        for (Waypoint& p : points) p.pose.time += start;
        trajectory_.moves.push_back({kind, stroke, std::move(points)});
    }

    const mesh::SurfaceQuery& query_;
    const MotionOptions& options_;
    Trajectory trajectory_;
};

}  // namespace

const char* name_of(MoveKind kind) {
    constexpr const char* kNames[] = {"approach", "stroke", "retract", "travel"};
    return kNames[static_cast<int>(kind)];
}

double make_upright(StrokePath& stroke) {
    double most = 0;
    for (const Waypoint& p : stroke.points) most = std::max(most, lean_of(p.pose));
    if (most > kMostStraightened) return most;
    for (Waypoint& p : stroke.points) {
        const Vec3 up = up_of(p.pose), z(0, 0, 1), about = glm::cross(up, z);
        const double sine = glm::length(about);
        p.pose.position += stroke.tuft_length * (z - up);
        if (sine > 0) p.pose.rotation = glm::normalize(glm::angleAxis(lean_of(p.pose), about / sine) * p.pose.rotation);
    }
    return most;
}

Trajectory plan(const mesh::SurfaceQuery& query, const std::vector<StrokePath>& strokes, const MotionOptions& options) {
    Planner planner(query, options);
    for (std::size_t i = 0; i < strokes.size(); ++i)
        if (!strokes[i].points.empty()) planner.add(strokes[i], i);
    return planner.finish();
}

}  // namespace tuft::motion
