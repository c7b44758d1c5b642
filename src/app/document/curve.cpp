#include "app/document/curve.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/ease.h"
#include "core/error.h"
#include "stroke/gesture/roll.h"
#include "stroke/placement/surface_mapping.h"
#include "stroke/placement/tip_lag.h"
#include "stroke/placement/turn_back.h"

namespace tuft::app {
namespace {

constexpr double kReach = 0.005;    // metres, besides half a span
constexpr double kTangent = 0.001;  // metres to both sides over which the direction is taken
constexpr double kSample = 0.004;   // seconds between two samples of the hand
constexpr std::size_t kMostSamples = 50'000;

Vec3 spline(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3, double u) {
    const auto knot = [](const Vec3& a, const Vec3& b) { return std::max(1e-6, std::sqrt(glm::distance(a, b))); };
    const double t1 = knot(p0, p1), t2 = t1 + knot(p1, p2), t3 = t2 + knot(p2, p3), t = t1 + u * (t2 - t1);
    const auto mix = [t](const Vec3& a, const Vec3& b, double ta, double tb) {
        return ((tb - t) * a + (t - ta) * b) / (tb - ta);
    };
    const Vec3 a1 = mix(p0, p1, 0, t1), a2 = mix(p1, p2, t1, t2), a3 = mix(p2, p3, t2, t3);
    return mix(mix(a1, a2, 0, t2), mix(a2, a3, t1, t3), t1, t2);
}

CurveSample project_sample(const mesh::SurfaceQuery& query, const Vec3& p, const Vec3& outward, double reach) {
    CurveSample place{.position = p, .normal = outward, .on = false};
    const Vec3 from = p + reach * outward;
    double start = 0;
    for (int i = 0; i < 16; ++i) {
        const auto hit = query.ray(from, -outward, start, 2 * reach);
        if (!hit) return place;
        if (glm::dot(hit->normal, outward) > 0) return {.position = hit->position, .normal = hit->normal, .on = true};
        start = hit->distance + 1e-6;
    }
    return place;
}

// Place at a length along the curve; before and after it goes on straight.
CurveSample at_length(std::span<const CurveSample> curve, double s) {
    const auto above =
        std::lower_bound(curve.begin(), curve.end(), s, [](const CurveSample& c, double v) { return c.along < v; });
    const std::size_t i = std::clamp<std::size_t>(static_cast<std::size_t>(above - curve.begin()), 1, curve.size() - 1);
    const CurveSample &a = curve[i - 1], &b = curve[i];
    const double u = (s - a.along) / std::max(1e-9, b.along - a.along), v = std::clamp(u, 0.0, 1.0);
    return {.position = a.position + u * (b.position - a.position),
            .normal = glm::normalize(glm::mix(a.normal, b.normal, v)),
            .along = s,
            .pressure = glm::mix(a.pressure, b.pressure, v)};
}

std::vector<brush::Pose> poses_along(const mesh::SurfaceQuery& query, std::span<const CurveSample> curve,
                                     const CurveHand& hand) {
    const double length = curve.back().along - curve.front().along,
                 step = std::max(hand.settings.speed * kSample, length / kMostSamples);
    const auto n = static_cast<std::size_t>(std::max(2.0, std::ceil(length / step)));
    std::vector<stroke::SurfaceSample> samples;
    stroke::RollFollower follower;
    std::optional<stroke::BladeRoll> blade;
    std::optional<stroke::FollowedTurn> hair;  // as in stroke::compensate_tip_lag
    std::vector<stroke::TipLagSample> lags;
    for (std::size_t i = 0; i <= n; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(n), s = curve.front().along + part * length;
        const double press = hand.pressure * at_length(curve, s).pressure *
                             smooth_step(part / std::max(1e-3, hand.settings.taper_in)) *
                             smooth_step((1 - part) / std::max(1e-3, hand.settings.taper_out));
        const CurveSample place = at_length(curve, s);
        // The hand runs straight ahead, and under a lean aside: the tuft is dragged behind it, along the curve.
        const Vec3 chord = at_length(curve, s + kTangent).position - at_length(curve, s - kTangent).position;
        const stroke::Axes axes = stroke::axes_across(place.normal, hand.right, hand.down);
        const Vec2 ahead{glm::dot(chord, axes.right), glm::dot(chord, axes.down)};
        stroke::SurfaceSample sample{.position = place.position,
                                     .normal = place.normal,
                                     .right = axes.right,
                                     .down = axes.down,
                                     .time = part * length / hand.settings.speed,
                                     .pressure = press,
                                     .tilt = hand.tilt,
                                     .roll = hand.roll};
        const Vec3 gone = samples.empty() ? Vec3(0) : place.position - samples.back().position;
        if (hand.roll_follow) {
            sample.roll += stroke::follow_stroke(follower, 0, {glm::dot(gone, axes.right), glm::dot(gone, axes.down)});
        }
        if (glm::length(ahead) > 1e-9) {
            const Vec2 way = glm::normalize(ahead);
            if (hand.holder.lean > 0 && hand.tilt == Vec2(0))
                sample.tilt = stroke::lean_of_make(hand.holder, sample.roll, way);
            if (hand.holder.blade_landing > 0) {
                if (!blade) blade.emplace(hand.holder.tip_lag_turn, sample.roll);
                blade->follow(sample.roll, glm::length(gone));
                sample.roll = blade->roll();
            }
            double turned = sample.roll;
            if (hand.holder.turned) {
                const double angle = std::atan2(-way.y, way.x);
                if (!hair) hair.emplace(hand.holder.tuft_length, sample.roll - angle);
                turned = hair->follow(sample.roll - angle, glm::length(gone)) + angle;
            }
            if (!(press > 0) && hair) hair->lift();
            if (press > 0) sample.tip_lag = stroke::tip_lag_at(hand.holder, press, sample.tilt, turned, way);
        }
        if (const auto on = query.closest_point(place.position, 0.01)) {
            sample.on = *on;
            sample.on_surface =
                glm::dot(on->normal, place.normal) > 0 && glm::distance(on->position, place.position) < 1e-3;
        }
        const Vec2 way = glm::length(ahead) > 1e-9 ? glm::normalize(ahead) : Vec2{0};
        lags.push_back({way, part * length, std::min(press, 1.0) * hand.holder.working_depth,
                        sample.roll - std::atan2(-way.y, way.x), sample.tip_lag});
        samples.push_back(sample);
    }
    stroke::shorten_tip_lag_at_end(lags, hand.holder);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i].tip_lag = lags[i].tip_lag;
    return stroke::pose_holder(query, samples, hand.holder);
}

}  // namespace

std::vector<CurveSample> project_curve(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points,
                                       int per_span) {
    std::vector<CurveSample> curve;
    if (points.size() < 2) return curve;
    const std::size_t last = points.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
        const CurvePoint &a = points[i], &b = points[i + 1];
        const Vec3 before = i ? points[i - 1].position : 2.0 * a.position - b.position;
        const Vec3 after = i + 1 < last ? points[i + 2].position : 2.0 * b.position - a.position;
        const double reach = kReach + 0.5 * glm::distance(a.position, b.position);
        for (int k = i ? 1 : 0; k <= per_span; ++k) {
            const double u = static_cast<double>(k) / per_span;
            const Vec3 outward = glm::mix(a.outward, b.outward, u);
            const Vec3 p = spline(before, a.position, b.position, after, u);
            CurveSample place =
                project_sample(query, p, glm::length(outward) > 1e-6 ? glm::normalize(outward) : a.outward, reach);
            place.pressure = glm::mix(a.pressure, b.pressure, u);
            place.along = curve.empty() ? 0 : curve.back().along + glm::distance(curve.back().position, place.position);
            curve.push_back(place);
        }
    }
    return curve;
}

writer::ModelPath path_of_curve(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points) {
    writer::ModelPath path;
    for (const CurveSample& s : project_curve(query, points)) {
        if (!s.on) break;
        path.points.push_back(s.position);
        path.normals.push_back(s.normal);
    }
    if (path.points.size() < 2)
        throw Error(Message("There is no curve: set its points with the tool Curve, then come back to this one"));
    return path;
}

std::vector<std::vector<brush::Pose>> curve_poses(const mesh::SurfaceQuery& query, std::span<const CurvePoint> points,
                                                  const CurveHand& hand) {
    const std::vector<CurveSample> curve = project_curve(query, points);
    std::vector<std::vector<brush::Pose>> strokes;
    for (std::size_t i = 0; i < curve.size();) {
        if (!curve[i].on) {
            ++i;
            continue;
        }
        std::size_t end = i;
        while (end < curve.size() && curve[end].on) ++end;
        if (end - i >= 2 && curve[end - 1].along - curve[i].along > 1e-4)
            strokes.push_back(poses_along(query, std::span(curve).subspan(i, end - i), hand));
        i = end;
    }
    return strokes;
}

}  // namespace tuft::app
