#include "stroke/placement/placement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "stroke/gesture/tractrix.h"
#include "stroke/placement/holder.h"
#include "stroke/placement/levelling.h"
#include "stroke/placement/projection.h"
#include "stroke/placement/smoothed_surface.h"
#include "stroke/placement/surface_mapping.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::stroke {

namespace {

constexpr double kTremble = 1.0 / 32;  // of the levelled path: a hand that trembles within it rests

/// Height of the surface ahead over the plane at a place; 0 where there is none within as much.
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

bool is_bent_across(const brush::Preset& preset) {
    return brush::has_broad_side(preset) && preset.lean > 0 && preset.slant == 0;
}

bool has_lag_by_turn(const brush::Preset& preset) {
    return brush::has_broad_side(preset) && !is_bent_across(preset) && preset.slant == 0;
}

HolderOptions holder_options(const brush::Preset& preset) {
    return {.tuft_length = preset.length,
            .working_depth = working_depth(preset),
            .hover = 0.1 * preset.length,
            .steady = 0,
            .tip_lag = {},
            // A fine tuft turns sooner, and a blade is led by its painter along its line.
            .tip_lag_turn = std::min(preset.slant > 0 ? 0.4e-3 : HolderOptions{}.tip_lag_turn, 0.075 * preset.length),
            .blade_landing = preset.slant > 0 ? 0.4 * preset.length : 0,
            .lean = preset.lean,
            .across = is_bent_across(preset),
            .foam = brush::is_foam(preset),
            .turned = has_lag_by_turn(preset),
            .toe = preset.toe,
            .toe_end = preset.toe > 0 ? 0.5 * preset.width : 0};
}

HolderOptions holder_options(const brush::Preset& preset, const mesh::TriangleMesh& mesh) {
    HolderOptions options = holder_options(preset);
    options.steady = std::min(drape_radius(mesh), 0.4 * preset.length);  // a fine tuft follows finer detail
    return options;
}

brush::Pose pose_holder(const Vec3& place, double height, const HolderPose& held, const HolderOptions& options) {
    const double lean = std::min(glm::length(held.tilt), options.max_tilt);
    const Vec2 tilt = lean > 0 ? held.tilt * (lean / glm::length(held.tilt)) : Vec2{0};
    const Vec3 up = glm::normalize(held.normal + std::tan(tilt.x) * held.right + std::tan(tilt.y) * held.down);
    // The shortest rotation: one that keeps x level turns it out of the lean, by a degree and more, which is twice the
    // line of a blade.
    const Vec3 level = lean > 0 ? parallel_transport(into_plane(held.right, held.normal), held.normal, up)
                                : into_plane(held.right, up);
    const Vec3 x = held.roll == 0 ? level : std::cos(held.roll) * level + std::sin(held.roll) * glm::cross(up, level);
    brush::Pose pose;
    pose.position = place + (height - held.depth) * held.normal + options.tuft_length * up;
    pose.rotation = glm::normalize(glm::quat_cast(Mat3(x, glm::cross(up, x), up)));
    pose.time = held.time;
    return pose;
}

namespace {

/// `lifted`: flags of samples over which the brush is carried as high as they lie, whatever is below; may be empty.
std::vector<brush::Pose> pose_holder(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples,
                                     const HolderOptions& options, const std::vector<bool>& lifted) {
    std::vector<brush::Pose> poses;
    poses.reserve(samples.size());
    const std::vector<double> along = travelled(samples, kTremble * options.steady);
    const std::vector<LevelledSurface> levelled = level_surface(query, samples, along, options.steady);
    const std::vector<double> depths = tip_depths(samples, options);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const SurfaceSample& s = samples[i];
        const LevelledSurface& level = levelled[i];
        const Axes axes = axes_across(level.normal, s.right, s.down);
        const Vec3 ahead = s.tip_lag.x * axes.right + s.tip_lag.y * axes.down;
        double height = lifted.empty() || !lifted[i] ? level.height : 0;
        // A tuft that has not trailed yet touches where the hand is.
        if (const double tip_lag = glm::length(s.tip_lag); along[i] < tip_lag)
            height += (1 - along[i] / tip_lag) * rise(query, s.position, ahead, level.normal, options.steady);
        poses.push_back(pose_holder(s.position + ahead, height,
                                    {level.normal, axes.right, axes.down, depths[i], s.tilt, s.roll, s.time}, options));
    }
    return poses;
}

}  // namespace

std::vector<brush::Pose> pose_holder(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples,
                                     const HolderOptions& options) {
    return pose_holder(query, samples, options, {});
}

std::vector<brush::Pose> spatial_poses(const StrokeSamples& trace) {
    std::vector<brush::Pose> poses;
    poses.reserve(trace.samples.size());
    for (const StrokeSample& s : trace.samples) poses.push_back({s.position, glm::normalize(s.rotation), s.time});
    return poses;
}

namespace {

constexpr double kPathReach = 3e-3;  // metres to both sides of a sample over which its path's direction is taken
constexpr double kMostTurn = 0.5;    // radians by which a mapping turns a path against its axes; beyond, it is torn

/// Turns the rolls of a trace so that the ferrule lies to its path on the surface as it did to the flat one: a mapping
/// turns a path against the axes that it carries along, by a degree or two where a projected surface leans. A blade as
/// long as a sword's draws twice its line at one degree.
void keep_rolls_to_path(std::span<const StrokeSample> flat, std::span<SurfaceSample> mapped) {
    if (std::none_of(flat.begin(), flat.end(), [](const StrokeSample& s) { return s.roll != 0; })) return;
    const std::vector<double> along = travelled(flat);
    std::size_t a = 0, b = 0;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        while (along[i] - along[a] > kPathReach) ++a;
        while (b + 1 < flat.size() && along[b] - along[i] < kPathReach) ++b;
        const Vec2 drawn(flat[b].position - flat[a].position);
        const Vec3 path = mapped[b].position - mapped[a].position;
        const Vec2 on_surface{glm::dot(path, mapped[i].right), glm::dot(path, mapped[i].down)};
        if (!(glm::length(drawn) > 0.1 * kPathReach) || !(glm::length(on_surface) > 0.1 * kPathReach)) continue;
        const double turn = std::atan2(drawn.x * on_surface.y - drawn.y * on_surface.x, glm::dot(drawn, on_surface));
        mapped[i].roll -= std::clamp(turn, -kMostTurn, kMostTurn);
    }
}

/// Points of other sheets that the rays of a stroke's samples hit; nothing on its own sheet and where they hit none.
using OtherSheets = std::vector<std::optional<Vec3>>;

/// Keeps the hand from leading the ink over an edge with another sheet within `reach` (metres) behind it: the tuft
/// would hang into the gap and touch that. At the edge the tip is over it.
void shorten_tip_lag(const std::vector<bool>& left, const OtherSheets& others, double reach,
                     std::span<SurfaceSample> mapped) {
    const double never = std::numeric_limits<double>::infinity();
    double edge = never, other = never;  // metres of path to the edge ahead, and from there to what is behind it
    for (std::size_t i = left.size(); i-- > 0;) {
        SurfaceSample& s = mapped[i];
        const double gone = i + 1 < left.size() ? glm::distance(s.position, mapped[i + 1].position) : 0;
        if (left[i]) {
            const bool near = others[i] && glm::distance(s.position, *others[i]) < reach;
            const bool last = i + 1 == left.size() || !left[i + 1];
            other = near ? 0 : last ? never : other + gone;
            continue;
        }
        // The last step off the sheet is also one up: the edge is beside the last sample.
        if (i + 1 < left.size()) edge = left[i + 1] ? 0 : edge + gone;
        const double tip_lag = glm::length(s.tip_lag);
        if (edge < tip_lag && other < reach) s.tip_lag *= edge / tip_lag;
    }
}

/// Lifts the brush where a stroke has left its sheet. The hand waits ahead until the stroke has caught up with it. A
/// brush pressed down at once where the stroke comes back would bend to any side: it is pressed as it goes on, so that
/// it trails.
void lift_off_sheet(const std::vector<bool>& left, std::span<SurfaceSample> mapped) {
    double ahead = 0;                                       // metres by which the hand still leads
    double back = std::numeric_limits<double>::infinity();  // metres since the stroke came back
    for (std::size_t i = 0; i < left.size(); ++i) {
        SurfaceSample& s = mapped[i];
        const double tip_lag = glm::length(s.tip_lag);
        const double gone = i > 0 ? glm::distance(s.position, mapped[i - 1].position) : 0;
        if (left[i]) {
            s.pressure = 0;
            back = 0;
            ahead = std::max(0.0, ahead - gone);
            if (tip_lag > ahead) s.tip_lag *= ahead / tip_lag;
            continue;
        }
        if (i > 0 && !left[i - 1]) back += gone;
        if (!(back < tip_lag)) {
            ahead = tip_lag;
            continue;
        }
        s.pressure *= back / tip_lag;
        s.tip_lag *= std::lerp(std::min(ahead / tip_lag, 1.0), 1.0, back / tip_lag);
    }
}

}  // namespace

HandPath hand_path(const mesh::SurfaceQuery& query, const StrokeSamples& samples, const HolderOptions& options) {
    if (!samples.flat) return {{}, spatial_poses(samples), 0};
    const StrokeSamples trace = add_turn_samples(samples, options);
    // The mapped samples are where the ink is to be: over a hollow, the surface ahead leans otherwise.
    const StrokeSamples led = compensate_tip_lag(lean_holder(trace, options), options);
    HandPath path;
    path.set_down = led.samples.size() - trace.samples.size();
    const StrokeSamples lifted = lift_off(led, options);
    StrokeSamples ink = lifted;
    for (std::size_t i = 0; i < ink.samples.size(); ++i) {
        const std::size_t own = std::clamp(i, path.set_down, led.samples.size() - 1) - path.set_down;
        ink.samples[i].position = trace.samples[own].position;
    }
    path.mapped = map_to_surface(query, ink, options.drapes.get());
    OtherSheets others;
    for (const SurfaceSample& s : path.mapped.samples)
        others.push_back(s.on_surface ? std::optional(s.position) : std::nullopt);
    const std::vector<bool> left = leave_other_sheets(query, ink, path.mapped);
    keep_rolls_to_path(ink.samples, path.mapped.samples);
    for (std::size_t i = 0; i < ink.samples.size(); ++i)
        path.mapped.samples[i].tip_lag = Vec2(lifted.samples[i].position - ink.samples[i].position);
    // Hair is thicker than its tip: over another sheet it is carried twice as high.
    const Vec3 outward = glm::normalize(glm::cross(trace.placement.down, trace.placement.right));
    for (std::size_t i = 0; i < left.size(); ++i)
        if (left[i]) path.mapped.samples[i].position += options.hover * outward;
    shorten_tip_lag(left, others, options.tuft_length, path.mapped.samples);
    lift_off_sheet(left, path.mapped.samples);
    path.poses = pose_holder(query, path.mapped.samples, options, left);
    return path;
}

}  // namespace tuft::stroke
