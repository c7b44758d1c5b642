#include "stroke/placement.h"

#include <algorithm>
#include <cmath>

#include "stroke/laying.h"
#include "stroke/lead.h"

namespace tuft::stroke {

namespace {

/// The surface as a steady hand takes it.
struct Ground {
    Vec3 normal;
    double height = 0;  ///< metres above the sample, along `normal`
};

std::vector<Ground> level_out(std::span<const LaidSample> samples, double steady) {
    constexpr std::size_t kMost = 64;  // samples looked at to each side
    constexpr double kNear = 0.5;      // radians: normals further off belong to a groove's wall
    std::vector<double> along(samples.size(), 0);
    for (std::size_t i = 1; i < samples.size(); ++i)
        along[i] = along[i - 1] + glm::length(samples[i].position - samples[i - 1].position);

    std::vector<Ground> grounds;
    grounds.reserve(samples.size());
    std::vector<std::size_t> window;
    std::vector<double> heights;
    std::size_t first = 0, last = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Ground g{samples[i].normal, 0};
        while (along[i] - along[first] > steady) ++first;
        while (last + 1 < samples.size() && along[last + 1] - along[i] <= steady) ++last;
        // As far to one side as to the other, so that ends do not pull.
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
                    const double off =
                        std::acos(std::clamp(glm::dot(axis, samples[j].normal), -1.0, 1.0));
                    mean += std::max(0.0, 1 - off * off / (kNear * kNear)) * samples[j].normal;
                }
            }
            if (glm::length(mean) > 0) g.normal = glm::normalize(mean);
            heights.clear();
            for (const std::size_t j : window)
                heights.push_back(glm::dot(samples[j].position - samples[i].position, g.normal));
            std::nth_element(heights.begin(), heights.begin() + std::ptrdiff_t(heights.size() / 2),
                             heights.end());
            g.height = heights[heights.size() / 2];
        }
        grounds.push_back(g);
    }
    return grounds;
}

}  // namespace

double working_depth(const brush::Preset& preset) {
    return 0.5 * preset.length;
}

HoldOptions hold_options(const brush::Preset& preset) {
    return {.tuft_length = preset.length,
            .working_depth = working_depth(preset),
            .hover = 0.1 * preset.length,
            .lead = {}};
}

std::vector<brush::Pose> hold(std::span<const LaidSample> samples, const HoldOptions& options) {
    std::vector<brush::Pose> poses;
    poses.reserve(samples.size());
    const std::vector<Ground> grounds = level_out(samples, options.steady);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const LaidSample& s = samples[i];
        const Ground& ground = grounds[i];
        const Axes axes = axes_across(ground.normal, s.right, s.down);
        const double lean = std::min(glm::length(s.tilt), options.max_tilt);
        const Vec2 tilt = lean > 0 ? s.tilt * (lean / glm::length(s.tilt)) : Vec2{0};
        const Vec3 up = glm::normalize(ground.normal + std::tan(tilt.x) * axes.right +
                                       std::tan(tilt.y) * axes.down);
        const double depth = s.pressure > 0 ? s.pressure * options.working_depth : -options.hover;
        const Vec3 x = into_plane(axes.right, up);
        brush::Pose pose;
        pose.position =
            s.position + (ground.height - depth) * ground.normal + options.tuft_length * up;
        pose.rotation = glm::normalize(glm::quat_cast(Mat3(x, glm::cross(up, x), up)));
        pose.time = s.time;
        poses.push_back(pose);
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
    HandPath path;
    path.laid = lay(query, lead_hand(trace, options));
    path.poses = hold(path.laid.samples, options);
    return path;
}

}  // namespace tuft::stroke
