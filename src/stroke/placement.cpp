#include "stroke/placement.h"

#include <algorithm>
#include <cmath>

#include "brush/sweep.h"
#include "stroke/laying.h"

namespace tuft::stroke {

namespace {

double lead_length(std::span<const Lead> table, double depth) {
    if (table.empty()) return 0;
    if (depth <= table.front().depth)
        return table.front().depth > 0 ? table.front().length * depth / table.front().depth
                                       : table.front().length;
    for (std::size_t i = 1; i < table.size(); ++i) {
        const Lead &a = table[i - 1], &b = table[i];
        if (depth <= b.depth)
            return a.length + (b.length - a.length) * (depth - a.depth) / (b.depth - a.depth);
    }
    return table.back().length;
}

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

std::vector<Lead> drag_lead(const brush::Preset& preset) {
    std::vector<double> depths;
    for (const double part : {0.05, 0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0})
        depths.push_back(part * working_depth(preset));
    std::vector<Lead> lead{{0, 0}};
    for (const brush::SweepRow& row : brush::sweep_depth(preset, depths))
        lead.push_back({row.depth, std::max(0.0, row.offset + 0.5 * row.width)});
    return lead;
}

namespace {

/// What a lean adds to the lead, `along` the path; that is 1 long where the string is taut.
Vec2 leaned_lead(const HoldOptions& options, const Vec2& tilt, double depth, const Vec2& along) {
    const double taut = glm::length(along), lean = glm::length(tilt);
    if (taut < 1e-9 || lean <= 0) return Vec2{0};
    const Vec2 ahead = along / taut, left{ahead.y, -ahead.x};  // y of a trace is down
    const Vec2 held = tilt * (std::min(lean, options.max_tilt) / lean);
    const Vec2 up{std::tan(held.x), std::tan(held.y)};
    const Vec2 more = options.leaned(depth, {std::atan(glm::dot(up, ahead)), std::atan(glm::dot(up, left))});
    return taut * (more.x * ahead + more.y * left);
}

// The hand of a trace that begins pressed goes the lead while it presses: the tip touches where the trace
// begins and trails from there. Set down from above it would bend to any side, and a tuft that is
// pushed before the hand turns over only after centimetres.
void set_down(Trace& trace, const HoldOptions& options) {
    constexpr double kStep = 2.5e-4;                 // metres between samples
    constexpr double kShortest = 0.01, kLongest = 0.3;  // seconds
    constexpr double kWay = 3e-3;                    // metres over which the pace is taken
    const TraceSample first = trace.samples.front();
    const double way = lead_length(options.lead, std::clamp(first.pressure, 0.0, 1.0) * options.working_depth);
    const int n = static_cast<int>(std::min(std::ceil(way / kStep), 100.0));
    if (n < 2) return;
    double gone = 0, taken = 0;
    for (std::size_t i = 1; i < trace.samples.size() && gone < kWay; ++i) {
        gone += glm::length(trace.samples[i].position - trace.samples[i - 1].position);
        taken = trace.samples[i].time - first.time;
    }
    if (gone <= 0) return;
    const double duration = std::clamp(taken / gone * way, kShortest, kLongest);
    for (TraceSample& s : trace.samples) s.time += duration;
    std::vector<TraceSample> touch(static_cast<std::size_t>(n), first);
    for (int i = 0; i < n; ++i) {
        TraceSample& s = touch[static_cast<std::size_t>(i)];
        s.pressure = first.pressure * i / n;
        s.time = first.time + duration * i / n;
    }
    trace.samples.insert(trace.samples.begin(), touch.begin(), touch.end());
}

}  // namespace

Trace lead_hand(Trace trace, const HoldOptions& options) {
    if (options.lead.empty() || trace.samples.empty() || !trace.flat) return trace;
    set_down(trace, options);
    // The hand knows where it is going to start: the string is taut from the first touch.
    const Vec2 first(trace.samples.front().position);
    Vec2 dragged = first;
    for (const TraceSample& s : trace.samples) {
        const Vec2 way = Vec2(s.position) - first;
        if (glm::length(way) >= 0.5 * options.lead_turn) {
            dragged = first - way * (options.lead_turn / glm::length(way));
            break;
        }
    }
    for (TraceSample& s : trace.samples) {
        const Vec2 p(s.position);
        Vec2 string = p - dragged;
        const double length = glm::length(string);
        if (length > options.lead_turn) {
            string *= options.lead_turn / length;
            dragged = p - string;
        }
        const double depth = std::clamp(s.pressure, 0.0, 1.0) * options.working_depth;
        Vec2 ahead = p + (lead_length(options.lead, depth) / options.lead_turn) * string;
        if (options.leaned) ahead += leaned_lead(options, s.tilt, depth, string / options.lead_turn);
        s.position = Vec3(ahead, s.position.z);
    }
    return trace;
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
