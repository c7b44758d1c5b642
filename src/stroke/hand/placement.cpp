#include "stroke/hand/placement.h"

#include <algorithm>
#include <cmath>

#include "stroke/hand/ground.h"
#include "stroke/hand/hold.h"
#include "stroke/hand/laying.h"
#include "stroke/hand/lead.h"

namespace tuft::stroke {

namespace {

/// The surface as a steady hand takes it, for each sample.
struct Steady {
    Vec3 normal;
    double height = 0;  ///< metres above the sample, along `normal`
};

/// The mean of the normals within `steady` of travel, as far to one side as to the other, so that ends do not pull.
std::vector<Steady> steady_normals(std::span<const LaidSample> samples, std::span<const double> along, double steady) {
    constexpr std::size_t kMost = 64;  // samples looked at to each side
    constexpr double kNear = 0.5;      // radians: normals further off belong to a groove's wall
    std::vector<Steady> held;
    held.reserve(samples.size());
    std::vector<std::size_t> window;
    std::size_t first = 0, last = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Steady h{samples[i].normal, 0};
        while (along[i] - along[first] > steady) ++first;
        while (last + 1 < samples.size() && along[last + 1] - along[i] <= steady) ++last;
        const double reach = std::min(along[i] - along[first], along[last] - along[i]);
        window.clear();
        const std::size_t stride = std::max<std::size_t>(1, (last - first) / (2 * kMost));
        for (std::size_t j = first; j <= last; j += stride)
            if (std::abs(along[j] - along[i]) <= reach) window.push_back(j);
        if (window.size() > 2) {
            Vec3 mean{0};
            for (const std::size_t j : window) mean += samples[j].normal;
            for (int pass = 0; pass < 3 && glm::length(mean) > 0; ++pass) {
                const Vec3 axis = glm::normalize(mean);
                mean = Vec3(0);
                for (const std::size_t j : window) {
                    const double off = std::acos(std::clamp(glm::dot(axis, samples[j].normal), -1.0, 1.0));
                    mean += std::max(0.0, 1 - off * off / (kNear * kNear)) * samples[j].normal;
                }
            }
            if (glm::length(mean) > 0) h.normal = glm::normalize(mean);
        }
        held.push_back(h);
    }
    return held;
}

/// The heights: the ground is felt at nodes along the way, and a straight line through those within `kSoft` of the
/// radius, the nearest counting most, is what the hand does.
void level_out(const mesh::SurfaceQuery& query, std::span<const LaidSample> samples, std::span<const double> along,
               double radius, std::vector<Steady>& held) {
    constexpr double kApart = 1.0 / 16, kSoft = 0.25;  // radii
    if (radius <= 0) return;
    struct Node {
        double along;
        Vec3 level;
    };
    std::vector<Node> nodes;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!nodes.empty() && i + 1 < samples.size() && along[i] - nodes.back().along < kApart * radius) continue;
        const double up = level_at(query, samples[i].position, held[i].normal, radius);
        nodes.push_back({along[i], samples[i].position + up * held[i].normal});
    }
    std::size_t first = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        while (first + 1 < nodes.size() && nodes[first].along < along[i] - kSoft * radius) ++first;
        double w = 0, x = 0, xx = 0, z = 0, xz = 0;
        for (std::size_t k = first; k < nodes.size() && nodes[k].along <= along[i] + kSoft * radius; ++k) {
            const double s = nodes[k].along - along[i], weight = 1 - std::abs(s) / (1.001 * kSoft * radius);
            if (weight <= 0) continue;
            const double up = glm::dot(nodes[k].level - samples[i].position, held[i].normal);
            w += weight, x += weight * s, xx += weight * s * s, z += weight * up, xz += weight * s * up;
        }
        const double det = w * xx - x * x;
        held[i].height = w <= 0 ? 0 : det > 1e-9 * w * xx ? (z * xx - x * xz) / det : z / w;
    }
}

/// Height of the ground ahead over the plane at a place; 0 where there is none within as much.
double rise(const mesh::SurfaceQuery& query, const Vec3& place, const Vec3& ahead, const Vec3& normal, double steady) {
    const double most = glm::length(ahead);
    const auto hit = exact_ray(query, place + ahead + most * normal, -normal, 2 * most);
    if (!hit || glm::dot(hit->face_normal, normal) <= 0) return 0;
    const double up = glm::dot(hit->position - place, normal);
    return steady > 0 ? up + level_at(query, hit->position, normal, steady) : up;
}

}  // namespace

double working_depth(const brush::Preset& preset) {
    return 0.5 * preset.length;
}

HoldOptions hold_options(const brush::Preset& preset) {
    return {.tuft_length = preset.length,
            .working_depth = working_depth(preset),
            .hover = 0.1 * preset.length,
            .steady = 0,
            .lead = {},
            .lead_turn = std::min(HoldOptions{}.lead_turn, 0.075 * preset.length)};  // a fine tuft turns sooner
}

HoldOptions hold_options(const brush::Preset& preset, const mesh::TriangleMesh& mesh) {
    HoldOptions options = hold_options(preset);
    options.steady = std::min(drape_radius(mesh), 0.4 * preset.length);  // a fine tuft feels finer ground
    return options;
}

brush::Pose hold_over(const Vec3& place, double height, const Held& held, const HoldOptions& options) {
    const double lean = std::min(glm::length(held.tilt), options.max_tilt);
    const Vec2 tilt = lean > 0 ? held.tilt * (lean / glm::length(held.tilt)) : Vec2{0};
    const Vec3 up = glm::normalize(held.normal + std::tan(tilt.x) * held.right + std::tan(tilt.y) * held.down);
    const double depth = held.pressure > 0 ? held.pressure * options.working_depth : -options.hover;
    const Vec3 x = into_plane(held.right, up);
    brush::Pose pose;
    pose.position = place + (height - depth) * held.normal + options.tuft_length * up;
    pose.rotation = glm::normalize(glm::quat_cast(Mat3(x, glm::cross(up, x), up)));
    pose.time = held.time;
    return pose;
}

std::vector<brush::Pose> hold(const mesh::SurfaceQuery& query, std::span<const LaidSample> samples,
                              const HoldOptions& options) {
    std::vector<brush::Pose> poses;
    poses.reserve(samples.size());
    const std::vector<double> along = travelled(samples);
    std::vector<Steady> held = steady_normals(samples, along, options.steady);
    level_out(query, samples, along, options.steady, held);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const LaidSample& s = samples[i];
        const Steady& ground = held[i];
        const Axes axes = axes_across(ground.normal, s.right, s.down);
        const Vec3 ahead = s.lead.x * axes.right + s.lead.y * axes.down;
        double height = ground.height;
        // A tuft that has not trailed yet touches where the hand is.
        if (const double lead = glm::length(s.lead); along[i] < lead)
            height += (1 - along[i] / lead) * rise(query, s.position, ahead, ground.normal, options.steady);
        poses.push_back(hold_over(s.position + ahead, height, {ground.normal, axes.right, axes.down, s.pressure, s.tilt, s.time}, options));
    }
    return poses;
}

std::vector<brush::Pose> spatial_poses(const Trace& trace) {
    std::vector<brush::Pose> poses;
    poses.reserve(trace.samples.size());
    for (const TraceSample& s : trace.samples)
        poses.push_back({s.position, glm::normalize(s.rotation), s.time});
    return poses;
}

HandPath hand_path(const mesh::SurfaceQuery& query, const Trace& trace,
                   const HoldOptions& options) {
    if (!trace.flat) return {{}, spatial_poses(trace)};
    // Laid is where the ink is to be: over a hollow, the surface ahead leans otherwise.
    const Trace led = lead_hand(trace, options);
    const std::size_t touching = led.samples.size() - trace.samples.size();  // at the first sample's place
    Trace ink = led;
    for (std::size_t i = 0; i < ink.samples.size(); ++i) ink.samples[i].position = trace.samples[i - std::min(i, touching)].position;
    HandPath path;
    path.laid = lay(query, ink);
    for (std::size_t i = 0; i < ink.samples.size(); ++i)
        path.laid.samples[i].lead = Vec2(led.samples[i].position - ink.samples[i].position);
    path.poses = hold(query, path.laid.samples, options);
    return path;
}

}  // namespace tuft::stroke
