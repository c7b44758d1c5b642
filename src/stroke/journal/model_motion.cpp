#include "stroke/journal/model_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/text/units.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kModelPoints = 600;  // of each model
constexpr double kCountsAs = 0.02;         // of the diagonal: farther is as far as it gets
constexpr double kSameShape = 0.002;       // of the diagonal, mean distance of models of one shape
constexpr double kBetter = 0.5;            // of the distance that a smaller motion leaves
constexpr double kSamePlace = 1e-4;        // of the diagonal, mean distance of models of which neither moved
constexpr double kSameBox = 0.02;          // of a box's side
constexpr double kSameSize = 0.002;        // of a size: not another one

// Points even over the area, the same at each call.
std::vector<Vec3> points_of(const mesh::TriangleMesh& mesh) {
    std::vector<double> until(mesh.n_triangles());
    double area = 0;
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 a = mesh.position(t, 0);
        area += 0.5 * glm::length(glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a));
        until[t] = area;
    }
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < kModelPoints && area > 0; ++i) {
        const double at = area * (static_cast<double>(i) + uniform(1, i)) / kModelPoints;
        const auto t = static_cast<std::uint32_t>(
            std::min<std::ptrdiff_t>(std::upper_bound(until.begin(), until.end(), at) - until.begin(),
                                     static_cast<std::ptrdiff_t>(until.size()) - 1));
        const double r = std::sqrt(uniform(2, i)), s = uniform(3, i);
        points.push_back((1 - r) * mesh.position(t, 0) + r * (1 - s) * mesh.position(t, 1) +
                         r * s * mesh.position(t, 2));
    }
    return points;
}

struct Side {
    const mesh::SurfaceQuery& query;
    Box box;
    std::vector<Vec3> points;

    explicit Side(const mesh::SurfaceQuery& q) : query(q), box(q.mesh().bounds), points(points_of(q.mesh())) {}
};

double distance(const mesh::SurfaceQuery& query, const Vec3& p, double most) {
    const auto hit = query.closest_point(p, most);
    return hit ? std::min(most, hit->distance) : most;
}

// Mean distance of the models, metres of the revised one.
double gap(const Side& former, const Side& revised, const ModelMotion& motion) {
    const double most = kCountsAs * revised.box.diagonal();
    double sum = 0;
    for (const Vec3& p : former.points) sum += distance(revised.query, motion(p), most);
    for (const Vec3& p : revised.points)
        sum += motion.scale * distance(former.query, motion.back(p), most / motion.scale);
    return sum / static_cast<double>(std::max<std::size_t>(1, former.points.size() + revised.points.size()));
}

// The 24 turns that take axes to axes, the smallest first.
std::vector<Quat> axis_turns() {
    std::vector<Quat> turns;
    const double r = std::sqrt(0.5);
    for (const double w : {1.0, r, 0.5, 0.0})
        for (const double x : {-1.0, -r, -0.5, 0.0, 0.5, r, 1.0})
            for (const double y : {-1.0, -r, -0.5, 0.0, 0.5, r, 1.0})
                for (const double z : {-1.0, -r, -0.5, 0.0, 0.5, r, 1.0}) {
                    if (std::abs(w * w + x * x + y * y + z * z - 1) > 1e-9) continue;
                    const Vec3 e = Quat(w, x, y, z) * Vec3(1, 2, 4);  // of a turn of axes all parts are whole
                    if (glm::length(e - glm::round(e)) > 1e-9) continue;
                    const bool twice = std::ranges::any_of(turns, [&](const Quat& q) {
                        return std::abs(std::abs(glm::dot(q, Quat(w, x, y, z))) - 1) < 1e-9;
                    });
                    if (!twice) turns.emplace_back(w, x, y, z);
                }
    return turns;
}

// The turned box fitted onto the other one; nothing where they are of different proportions.
std::optional<ModelMotion> fitted(const Box& former, const Box& revised, const Quat& turn) {
    const Vec3 size = glm::abs(turn * former.size()), wanted = revised.size();
    double scale = glm::length(wanted) / std::max(1e-30, glm::length(size));
    if (!std::isfinite(scale) || !(scale > 0)) return std::nullopt;
    for (int k = 0; k < 3; ++k)
        if (std::abs(scale * size[k] - wanted[k]) > kSameBox * glm::length(wanted)) return std::nullopt;
    if (std::abs(scale - 1) < kSameSize) scale = 1;
    return ModelMotion{.from = former.centre(), .to = revised.centre(), .rotation = turn, .scale = scale};
}

}  // namespace

std::optional<ModelMotion> find_motion(const mesh::SurfaceQuery& former_query,
                                       const mesh::SurfaceQuery& revised_query) {
    const Side former(former_query), revised(revised_query);
    const double same = kSameShape * revised.box.diagonal();
    double least = gap(former, revised, {});
    std::optional<ModelMotion> found;
    for (const Quat& turn : axis_turns()) {
        if (least < kSamePlace * revised.box.diagonal()) break;
        const auto motion = fitted(former.box, revised.box, turn);
        if (!motion) continue;
        const double left = gap(former, revised, *motion);
        if (left > same || left > kBetter * least) continue;
        least = left;
        found = motion;
    }
    return found;
}

Vec3 shift_of(const ModelMotion& motion) {
    return motion.to - motion.from;
}

double turn_of(const ModelMotion& motion) {
    return 2 * std::acos(std::min(1.0, std::abs(motion.rotation.w)));
}

Message describe(const ModelMotion& motion) {
    std::vector<Message> parts;
    const Vec3 shift = shift_of(motion) / kMillimetre;
    // Another size about the origin moves the middle too: the size says that.
    const Vec3 by_size = (motion.scale - 1) * (motion.rotation * motion.from) / kMillimetre +
                         (motion.rotation * motion.from - motion.from) / kMillimetre;
    const bool about_origin = glm::length(shift - by_size) < 0.05;
    if (turn_of(motion) > 1e-6)
        parts.push_back(Message("turned by {} degrees", fmt::format("{:.0f}", turn_of(motion) / kDegree)));
    if (motion.scale != 1) parts.push_back(Message("{} times as large", fmt::format("{:.4g}", motion.scale)));
    if (parts.empty() || !about_origin)
        parts.push_back(
            Message("shifted by ({}) mm", fmt::format("{:.1f}, {:.1f}, {:.1f}", shift.x, shift.y, shift.z)));
    if (parts.size() == 1) return parts[0];
    if (parts.size() == 2) return Message("{} and {}", parts[0], parts[1]);
    return Message("{}, {} and {}", parts[0], parts[1], parts[2]);
}

}  // namespace tuft::stroke
