#include "app/input/pointer_input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "brush/tuft/ferrule.h"
#include "core/ease.h"
#include "core/first_order_lag.h"
#include "stroke/placement/surface_mapping.h"

namespace tuft::app {
namespace {

constexpr double kRise = 0.05;    // seconds in which the pressure follows
constexpr double kLift = 0.06;    // seconds of the lift
constexpr double kFrame = 0.004;  // seconds between the poses made between two aims
constexpr double kReport = 0.01;  // seconds between a tablet's reports while something changes, at most
constexpr double kJump = 0.004;   // metres between two aims that may be an edge of the outline
constexpr double kGrazing = 6;    // times further on a slanting surface than across the view
constexpr double kMaxTilt = 1.2;  // radians
constexpr double kMostFelt = 0.008,
                 kFeltOfModel = 0.02;  // metres round the aim, and part of the model's diagonal, at most
constexpr double kShallow = 0.2;       // of how far gaps are felt: what is less deep is relief, and followed
constexpr double kBent = 0.5;          // of it: how far two sides of a gap may lie out of one plane
constexpr int kPairs = 12;             // of rays round the aim
constexpr std::size_t kAgreeing = 3;   // of them that must lie on ground
constexpr double kKnown = 3;           // pixels after which the direction of a clean stroke is known
constexpr double kRestTime = 0.15;     // seconds after which a hand that rests presses straight down
constexpr double kSetDown = 0.05;      // seconds in which a clean stroke is pressed down
constexpr double kTouch = 0.7;         // of the pressure, that it is pressed down with; the rest comes along the path
// Pressed down in place, the tip is pushed back behind the first place by this part of the tuft's length, at pressure
// 1; the holder goes as far ahead of it there, and loses that over this part of the length. A fast start pulls the tip
// along.
constexpr double kSpread = 0.1, kSpreadGone = 0.2;
constexpr double kTips = 0.12,
                 kTipTurns = 4;   // radians that the holder is tipped ahead at first, over so many `tip_lag_turn`
constexpr double kSlowest = 0.2;  // seconds in which it arrives at its end, at most
constexpr double kFlick = 1.5;  // of the working depth: a distance to the end on which the brush lifts by the next part
constexpr double kFlickLift = 0.75;  // of its pressure; the rest goes at the end
constexpr double kSlanting = 0.35;   // cosine to the line of sight under which a gap and an edge look alike
// Behind an edge hair that was pressed onto the rim would hook over it: the stroke goes on lightly, by this part of its
// pressure's path, and is pressed down over this part of the tuft's length.
constexpr double kLightly = 0.2, kOverAnEdge = 0.08;
constexpr double kWall = 0.25, kLip = 0.55;  // radians from the mean normal: of a wall beside a lip at most, of a lip
constexpr double kAhead = 0.5;       // of the radius that a holder levels: how far ahead the ground is looked at
constexpr double kSameGround = 1.5;  // radii round the aim in which a place belongs to the ground that a holder levels

Vec3 facing(const mesh::SurfacePoint& p, const Aim& aim) {
    return glm::dot(p.normal, aim.ray.direction) < 0 ? p.normal : -p.normal;
}

/// `path` projected onto the plane of the levelled surface: by the part `start` (0–1) along the line of sight, else
/// along the normal. A stroke that begins on a lip goes far along the surface's normal before it is on the wall. Its
/// direction is that of the wall. A stroke that ends on a lip retains its direction.
Vec3 along_surface(const Vec3& path, const Vec3& normal, const Aim& aim, double start) {
    const double facing = -glm::dot(aim.ray.direction, normal);
    const Vec3 onto = glm::mix(-normal, aim.ray.direction / std::max(facing, kSlanting),
                               start * smooth_step((facing - kSlanting) / kSlanting));
    return path + glm::dot(path, normal) * onto;
}

}  // namespace

double pen_depth(const PointerSettings& s, double pressure) {
    return std::pow(std::clamp((pressure - s.pen_least) / std::max(1e-3, s.pen_full - s.pen_least), 0.0, 1.0),
                    s.pen_gamma);
}

std::optional<mesh::SurfacePoint> aim_at(const mesh::SurfaceQuery& surface, const Aim& aim) {
    double from = 0;
    for (int i = 0; i < 64; ++i) {
        auto hit = surface.ray(aim.ray.origin, aim.ray.direction, from);
        if (!hit || glm::dot(Vec4(hit->position, 1), Vec4(aim.section)) <= 0) return hit;
        from = hit->distance + 1e-6;
    }
    return std::nullopt;
}

// Of even directions over the place, by the cosine, the part that meets a back: all inside of a closed body, none over
// a sheet, 0.36 in half a pipe.
bool is_through_a_hole(const mesh::SurfaceQuery& surface, const mesh::SurfacePoint& hit, const Aim& aim) {
    if (glm::dot(hit.normal, aim.ray.direction) <= 0) return false;
    constexpr int kRays = 64;
    constexpr double kSurrounded = 0.4, kGoldenAngle = 2.399963229728653;
    const Vec3 normal = facing(hit, aim);
    const Vec3 from = hit.position + 1e-5 * surface.mesh().bounds.diagonal() * normal;
    const Frame f = make_frame(from, normal);
    int backs = 0;
    for (int i = 0; i < kRays; ++i) {
        const double out = (i + 0.5) / kRays, turn = kGoldenAngle * i;
        const Vec3 direction =
            std::sqrt(out) * (std::cos(turn) * f.t + std::sin(turn) * f.b) + std::sqrt(1 - out) * f.n;
        const auto met = surface.ray(from, direction);
        if (met && glm::dot(met->normal, direction) > 0) ++backs;
    }
    return backs > kSurrounded * kRays;
}

PointerInput::PointerInput(const mesh::SurfaceQuery& surface, const brush::Preset& preset,
                           const PointerSettings& settings, TipLag lag)
    : surface_(surface),
      holder_(stroke::holder_options(preset, surface.mesh())),
      settings_(settings),
      wide_(brush::can_be_turned(preset)),
      reach_(std::min({2 * preset.radius, kMostFelt, kFeltOfModel * surface.mesh().bounds.diagonal()})) {
    holder_.tip_lag = std::move(lag.upright);
    holder_.tip_lag_change = std::move(lag.tilted);
}

// The level of what lies round a gap under the aim; nothing where there is none. `centre`: metres to the aim's own hit.
std::optional<AimedSurface> PointerInput::find_gap(const Aim& aim, double centre) const {
    struct Pair {
        double depth;
        Vec3 normal;
    };
    std::vector<Pair> pairs;
    for (int i = 0; i < kPairs; ++i) {
        const double angle = std::numbers::pi * i / kPairs;
        const Vec3 side = reach_ * (std::cos(angle) * aim.view_right + std::sin(angle) * aim.view_up);
        Aim one = aim, other = aim;
        one.ray.origin += side;
        other.ray.origin -= side;
        const auto a = aim_at(surface_, one), b = aim_at(surface_, other);
        if (!a || !b) continue;
        // On one ground, flat or evenly bent: each lies as far out of the other's plane. Else it is a rim or a step.
        const Vec3 na = facing(*a, aim), nb = facing(*b, aim), chord = b->position - a->position;
        const double out_a = glm::dot(na, chord), out_b = glm::dot(nb, chord);
        if (std::abs(out_a + out_b) < kShallow * reach_ && std::abs(out_a) < kBent * reach_)
            pairs.push_back({0.5 * (a->distance + b->distance), na + nb});
    }
    if (pairs.size() < kAgreeing) return std::nullopt;
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.depth < b.depth; });
    const double level = pairs[pairs.size() / 2].depth;
    Vec3 normal(0);
    std::size_t agree = 0;
    for (const Pair& pair : pairs)
        if (std::abs(pair.depth - level) < kShallow * reach_) normal += pair.normal, ++agree;
    const bool gap = agree >= kAgreeing && level < centre - kShallow * reach_ &&
                     glm::dot(normal, -aim.ray.direction) > kSlanting * glm::length(normal);
    if (!gap) return std::nullopt;
    return AimedSurface{.position = aim.ray.origin + level * aim.ray.direction,
                        .normal = glm::normalize(normal),
                        .distance = level,
                        .bridged = true};
}

std::optional<AimedSurface> PointerInput::find_surface(const Aim& aim) const {
    const auto hit = aim_at(surface_, aim);
    if (const auto gap = find_gap(aim, hit ? hit->distance : std::numeric_limits<double>::infinity())) return gap;
    if (!hit) return std::nullopt;
    AimedSurface found{.position = hit->position, .normal = levelled_normal(aim, *hit), .distance = hit->distance};
    found.back = glm::dot(hit->normal, aim.ray.direction) > 0;
    found.inside = is_through_a_hole(surface_, *hit, aim);
    return found;
}

// On a lip a few millimetres wide, the normal of the wall beside it: the mean over what is seen of the ground within
// the radius that a holder levels (stroke/placement/levelling.h), where the surface's own is far from it. On the wall
// it is the surface's own, with the lip in that radius or without.
Vec3 PointerInput::levelled_normal(const Aim& aim, const mesh::SurfacePoint& hit) const {
    const double furthest = kSameGround * holder_.steady;
    Vec3 mean = facing(hit, aim);
    const Vec3 own = mean;
    for (int i = 0; i < 2 * kPairs && furthest > 0; ++i)
        for (const double part : {0.5, 1.0}) {
            const double angle = std::numbers::pi * i / kPairs;
            Aim beside = aim;
            beside.ray.origin +=
                part * holder_.steady * (std::cos(angle) * aim.view_right + std::sin(angle) * aim.view_up);
            const auto at = aim_at(surface_, beside);
            const double away = at ? glm::distance(at->position, hit.position) / furthest : 1;
            if (away < 1) mean += part * (1 - away * away) * facing(*at, aim);
        }
    if (!(glm::length(mean) > 1e-6)) return own;
    mean = glm::normalize(mean);
    const double angle = std::acos(std::clamp(glm::dot(own, mean), -1.0, 1.0));
    return glm::normalize(glm::mix(own, mean, smooth_step((angle - kWall) / (kLip - kWall))));
}

// The smoothed point cuts the corners of a curved surface: it is brought back. Over a gap the nearest
// place is an edge beside it; there it stays where it is.
void PointerInput::onto_surface() {
    constexpr double kFurthest = 5e-3;
    const auto is_met = [&](const mesh::SurfacePoint& p) {
        return (glm::dot(p.normal, point_.normal) < 0) == side_.on_back.value_or(false);
    };
    auto on = surface_.closest_point(point_.position, kFurthest);
    // In a thin wall its other side may be nearer.
    if (on && !is_met(*on))
        on = surface_.ray(point_.position + kFurthest * point_.normal, -point_.normal, 0, 2 * kFurthest);
    if (!on || !is_met(*on)) return;
    const Vec3 offset = on->position - point_.position;
    const bool sideways =
        glm::length(offset - glm::dot(offset, point_.normal) * point_.normal) > 0.5 * glm::length(offset);
    if (motion_.bridged >= 0 && motion_.time - motion_.bridged < 5 * settings_.smoothing + 2 * kFrame && sideways)
        return;
    const double side = glm::dot(on->normal, point_.normal) < 0 ? -1 : 1;
    point_.position = on->position;
    if (settings_.string > 0) point_.normal = side * on->normal;
}

brush::Pose PointerInput::pose_at(const Aim& aim, const Vec3& point, const Vec3& normal, double pressure,
                                  double time) const {
    const Vec2 leant = lean_of_make(aim, normal);
    const Vec2 tilt = glm::clamp(aim.tilt.value_or(settings_.tilt) + leant, -kMaxTilt, kMaxTilt);
    const auto along = [&](const Vec3& v) {
        const Vec3 d = v - glm::dot(v, normal) * normal;
        return glm::length(d) > 1e-6 ? glm::normalize(d) : Vec3(0);
    };
    const double tipped = std::max(0.0, kTips - glm::length(leant)) *
                          (1 - smooth_step(motion_.gone / (kTipTurns * holder_.tip_lag_turn)));
    const Vec3 up = glm::normalize(normal + std::tan(tilt.x) * along(aim.view_right) +
                                   std::tan(tilt.y) * along(aim.view_up) + tipped * dragged_.string);
    const double height = holder_.tuft_length + (pressure > 0 ? -pressure * holder_.working_depth : holder_.hover);
    return {.position = point + ahead_of(aim, normal, pressure) + height * up,
            .rotation = rotation_at(aim, normal, up),
            .time = time};
}

// As `settings_.tilt`: where neither the pen nor the settings lean the holder.
Vec2 PointerInput::lean_of_make(const Aim& aim, const Vec3& normal) const {
    if (!(holder_.lean > 0) || aim.tilt || settings_.tilt != Vec2(0)) return Vec2(0);
    const stroke::Axes axes = stroke::axes_across(normal, aim.view_right, -aim.view_up);
    const Vec2 ahead{glm::dot(leant_.string, axes.right), glm::dot(leant_.string, axes.down)};
    const Vec2 lean = stroke::lean_of_make(holder_, roll_at(aim), ahead);
    return {lean.x, -lean.y};
}

// Of the ferrule, on the surface: where a make leans that is set down without a direction.
Vec3 PointerInput::across(const Aim& aim) const {
    if (!holder_.across) return Vec3(0);
    const stroke::Axes axes = stroke::axes_across(point_.normal, aim.view_right, -aim.view_up);
    return -std::sin(roll_at(aim)) * axes.right - std::cos(roll_at(aim)) * axes.down;
}

double PointerInput::roll_at(const Aim& aim) const {
    return settings_.roll + (settings_.roll_follow && turns_.follower.started ? turns_.follower.roll : -aim.turn);
}

double PointerInput::roll_of_ferrule(const Aim& aim) const {
    return turns_.blade ? turns_.blade->roll() : roll_at(aim);
}

// A wide ferrule has its broad side across the view; a round one lies as it may.
Quat PointerInput::rotation_at(const Aim& aim, const Vec3& normal, const Vec3& up) const {
    const auto turned = [](const Quat& q, double roll) {
        return roll == 0 ? q : glm::normalize(q * glm::angleAxis(roll, Vec3(0, 0, 1)));
    };
    if (!wide_) {
        const Frame f = make_frame(Vec3(0), up);
        return turned(glm::normalize(glm::quat_cast(Mat3(f.t, f.b, f.n))), -aim.turn);
    }
    const Vec3 x = parallel_transport(stroke::axes_across(normal, aim.view_right, -aim.view_up).right, normal, up);
    return turned(glm::normalize(glm::quat_cast(Mat3(x, glm::cross(up, x), up))), roll_of_ferrule(aim));
}

// The holder has gone on: it turns as the pen does, and after its stroke. Its hair follows.
void PointerInput::turn_holder(const Aim& aim, const Vec3& motion) {
    if (!wide_) return;
    const stroke::Axes axes = stroke::axes_across(point_.normal, aim.view_right, -aim.view_up);
    if (settings_.roll_follow)
        stroke::follow_stroke(turns_.follower, -aim.turn, {glm::dot(motion, axes.right), glm::dot(motion, axes.down)});
    if (holder_.blade_landing > 0 && is_clean(aim)) {
        if (!turns_.blade) turns_.blade.emplace(holder_.tip_lag_turn, roll_at(aim));
        turns_.blade->follow(roll_at(aim), glm::length(motion));
    }
    const Vec2 ahead{glm::dot(dragged_.string, axes.right), glm::dot(dragged_.string, axes.down)};
    if (!holder_.turned || glm::length(ahead) < 1e-9) return;
    const double turn = roll_at(aim) - std::atan2(-ahead.y, ahead.x);
    if (!turns_.followed) turns_.followed.emplace(holder_.tuft_length, turn);
    turns_.followed->follow(turn, glm::length(motion));
}

// Where the holder is for ink at the point: ahead along the string, and under a lean aside.
Vec3 PointerInput::ahead_of(const Aim& aim, const Vec3& normal, double pressure) const {
    const double taut = glm::length(dragged_.string);
    if (holder_.tip_lag.empty() || !(pressure > 0) || taut < 1e-9) return Vec3(0);
    const stroke::Axes axes = stroke::axes_across(normal, aim.view_right, -aim.view_up);
    const Vec2 ahead{glm::dot(dragged_.string, axes.right), glm::dot(dragged_.string, axes.down)};
    if (glm::length(ahead) < 1e-9) return Vec3(0);
    const Vec2 tilt = settings_.tilt + lean_of_make(aim, normal);
    const double roll =
        turns_.followed ? turns_.followed->turn() + std::atan2(-ahead.y, ahead.x) : roll_of_ferrule(aim);
    const Vec2 lag = taut * stroke::tip_lag_at(holder_, pressure, {tilt.x, -tilt.y}, roll, glm::normalize(ahead));
    const double spread =
        pressure * motion_.spread * (1 - smooth_step(motion_.gone / (kSpreadGone * holder_.tuft_length)));
    return lag.x * axes.right + lag.y * axes.down + spread * dragged_.string;
}

// The point has moved: what it drags follows on the strings, along the surface.
void PointerInput::drag(const Aim& aim) {
    const auto follow = [&](DraggedPoint& dragged, double reach) {
        Vec3 offset = along_surface(point_.position - dragged.position, point_.normal, aim, at_start());
        if (const double length = glm::length(offset); length > reach) offset *= reach / length;
        dragged.position = point_.position - offset;
        dragged.string = offset / reach;
    };
    if (is_clean(aim)) follow(dragged_, holder_.tip_lag_turn);
    follow(leant_, stroke::lean_string(holder_));
}

double PointerInput::goal_pressure(const Aim& aim) const {
    const double travel = kLightly + motion_.gone / (kOverAnEdge * holder_.tuft_length);
    const double landed = side_.over_edge ? smooth_step(travel / (1 + kLightly)) : 1;
    if (aim.pressure >= 0) return landed * pen_depth(settings_, aim.pressure);
    const double slow = 1.0 - settings_.speed_effect * std::min(1.0, motion_.speed / settings_.fast);
    const double rested = settings_.dwell_effect * std::min(1.0, motion_.rest / settings_.dwell);
    return landed * std::clamp(settings_.pressure * slow + rested, 0.02, 1.0);
}

void PointerInput::pen_down(const Aim& aim, const AimedSurface& hit, const Vec3& towards,
                            std::vector<StrokeStep>& steps) {
    down_ = true;
    goal_.position = point_.position = hit.position;
    point_.normal = hit.normal;
    motion_.bridged = -1;
    motion_.start = aim.time;
    motion_.time = motion_.speed = motion_.rest = motion_.pressure = motion_.gone = 0;
    motion_.spread = 0;
    turns_.follower = {};
    turns_.followed.reset();
    turns_.blade.reset();
    dragged_ = {point_.position - holder_.tip_lag_turn * towards, towards};
    turn_holder(aim, Vec3(0));
    const Vec3 leans = towards != Vec3(0) ? towards : across(aim);
    leant_ = {point_.position - stroke::lean_string(holder_) * leans, leans};
    steps.push_back({StrokeStep::Kind::begin, {}});
    steps.push_back({StrokeStep::Kind::poses, {pose_at(aim, point_.position, point_.normal, 0, 0)}});
}

// A clean stroke is asked for: nothing is touched until its direction is known.
void PointerInput::wait(const Aim& aim, const AimedSurface& hit, std::vector<StrokeStep>& steps) {
    waiting_.push_back({aim, hit});
    aim_ = aim;
    goal_.position = hit.position;
    goal_.normal = hit.normal;
    const bool known = glm::distance(hit.position, waiting_.front().surface.position) >= kKnown * aim.metres_per_pixel;
    if (known || aim.time - waiting_.front().aim.time > kRestTime) set_down(steps);
}

double PointerInput::at_start() const {
    return 1 - smooth_step(motion_.gone / std::max(holder_.steady, 1e-6));
}

// At its start a clean stroke has the normal of what lies ahead, where that leans further ahead: over the rounding of a
// lip a holder by the lip's own normal stands so that its tip is ahead on the wall that it goes down, and hair pushed
// against its lie swings aside.
Vec3 PointerInput::normal_at_start(const Aim& aim, const AimedSurface& at, const Vec3& towards) const {
    const double reach = kAhead * holder_.steady, start = at_start();
    if (!(glm::length(towards) > 1e-6 && reach > 0 && start > 0)) return at.normal;
    Aim ahead = aim;
    ahead.ray.origin += reach * glm::normalize(towards);
    const auto hit = aim_at(surface_, ahead);
    if (!hit || glm::distance(hit->position, at.position) > kSameGround * reach) return at.normal;
    const Vec3 normal = levelled_normal(ahead, *hit);
    if (glm::dot(normal, towards) <= glm::dot(at.normal, towards)) return at.normal;
    return glm::normalize(glm::mix(at.normal, normal, start));
}

// Presses the tuft down at the first place, then goes on to where the cursor is by now.
void PointerInput::set_down(std::vector<StrokeStep>& steps) {
    const std::vector<Waiting> waiting = std::move(waiting_);
    waiting_.clear();
    const Waiting& first = waiting.front();
    const Waiting& last = waiting.back();
    const Vec3 motion =
        along_surface(last.surface.position - first.surface.position, first.surface.normal, first.aim, 1);
    const double length = glm::length(motion);
    const Vec3 towards = length >= 0.5 * kKnown * last.aim.metres_per_pixel ? motion / length : Vec3(0);
    motion_.gone = 0;
    AimedSurface surface = first.surface;
    surface.normal = normal_at_start(first.aim, surface, towards);
    pen_down(first.aim, surface, towards, steps);
    motion_.start -= kSetDown;  // as if it had begun earlier: it lags no further behind
    motion_.speed = length / std::max(kFrame, last.aim.time - first.aim.time);
    if (!side_.over_edge)
        motion_.spread = kSpread * holder_.tuft_length * (1 - std::min(1.0, motion_.speed / settings_.fast));
    const double pressure = (glm::length(dragged_.string) > 0 ? kTouch : 1.0) * goal_pressure(first.aim);
    const int n = static_cast<int>(std::ceil(kSetDown / kFrame));
    StrokeStep step;
    for (int i = 1; i <= n; ++i) {
        motion_.time = kSetDown * i / n;
        motion_.pressure = pressure * i / n;
        step.poses.push_back(pose_at(first.aim, point_.position, point_.normal, motion_.pressure, motion_.time));
    }
    for (std::size_t i = 1; i < waiting.size(); ++i) {
        if (waiting[i].surface.bridged) motion_.bridged = motion_.time;
        const Vec3 normal = normal_at_start(waiting[i].aim, waiting[i].surface, dragged_.string);
        follow(waiting[i].aim, waiting[i].surface.position, normal, step.poses);
        goal_.normal = waiting[i].surface.normal;
    }
    steps.push_back(std::move(step));
}

void PointerInput::follow(const Aim& aim, const Vec3& goal, const Vec3& normal, std::vector<brush::Pose>& poses) {
    const double span = std::max(1e-4, aim.time - motion_.start - motion_.time);
    const int steps = std::clamp(static_cast<int>(std::ceil(span / kFrame)), 1, 64);
    const double dt = span / steps;
    for (int i = 0; i < steps; ++i) {
        const Vec3 before = point_.position;
        Vec3 target = goal_.position + static_cast<double>(i + 1) / steps * (goal - goal_.position),
             pace = (goal - goal_.position) / span;
        if (settings_.string > 0) {
            const double away = glm::distance(target, point_.position);
            target = away > settings_.string
                         ? point_.position + (1 - settings_.string / away) * (target - point_.position)
                         : point_.position;
            pace = Vec3(0);
        }
        // Low-pass of a goal that moves evenly, solved exactly: y' = (x - y) / τ, x' = pace.
        const Vec3 behind = target - settings_.smoothing * pace;
        point_.position = behind + (1 - settled_part(dt, settings_.smoothing)) * (point_.position - behind + pace * dt);
        const bool leans_ahead = glm::dot(normal - point_.normal, dragged_.string) > 0;
        const double constant = std::max(0.01, settings_.smoothing) * (leans_ahead ? 1 - at_start() : 1);
        point_.normal = glm::normalize(point_.normal + settled_part(dt, constant) * (normal - point_.normal));
        onto_surface();
        drag(aim);
        turn_holder(aim, point_.position - before);
        motion_.gone += glm::distance(before, point_.position);
        const double v = glm::distance(before, point_.position) / dt;
        motion_.speed += settled_part(dt, 0.05) * (v - motion_.speed);
        motion_.rest = motion_.speed < 0.004 ? motion_.rest + dt : 0;
        motion_.pressure +=
            settled_part(dt, aim.pressure >= 0 ? 0.004 : kRise) * (goal_pressure(aim) - motion_.pressure);
        motion_.time += dt;
        poses.push_back(pose_at(aim, point_.position, point_.normal, motion_.pressure, motion_.time));
    }
    goal_.position = goal;
}

std::vector<StrokeStep> PointerInput::move(const Aim& aim) {
    std::vector<StrokeStep> steps;
    auto hit = find_surface(aim);
    if (hit && !hit->bridged) {
        if (!side_.on_back && !hit->inside) side_.on_back = hit->back;
        if (!side_.on_back || hit->back != *side_.on_back) hit.reset();
    }
    // A small movement of the cursor that goes far on the model crossed an edge of its outline.
    const double expected = drawing() && hit ? glm::distance(aim.ray.origin, aim_.ray.origin) +
                                                   glm::distance(aim.ray.direction, aim_.ray.direction) * hit->distance
                                             : 0;
    if (drawing() && (!hit || glm::distance(hit->position, goal_.position) > kJump + kGrazing * expected)) {
        steps = lift();
        side_.over_edge = true;
    }
    if (!hit) return steps;
    if (!down_ && is_clean(aim)) {
        wait(aim, *hit, steps);
        return steps;
    }
    if (!down_) {
        pen_down(aim, *hit, Vec3(0), steps);
    } else {
        StrokeStep step;
        // A tablet reports what changes: where it was silent, the pen was held still until shortly before.
        if (aim.pressure >= 0 && aim_.pressure >= 0 && aim.time - aim_.time > 2 * kReport) {
            Aim still = aim_;
            still.time = aim.time - kReport;
            follow(still, goal_.position, goal_.normal, step.poses);
        }
        if (hit->bridged) motion_.bridged = motion_.time;
        if (is_clean(aim)) hit->normal = normal_at_start(aim, *hit, dragged_.string);
        follow(aim, hit->position, hit->normal, step.poses);
        steps.push_back(std::move(step));
    }
    aim_ = aim;
    goal_.normal = hit->normal;
    return steps;
}

// What the smoothing, or the string, kept the hand behind the cursor. It slows down evenly from the speed that it has,
// and the pressure goes as what is left of the path, as far as that is longer than the hand needs to stop anyway.
void PointerInput::arrive(std::vector<brush::Pose>& poses) {
    const Vec3 from = point_.position;
    const double remaining = glm::distance(goal_.position, from);
    if (remaining < 0.25 * aim_.metres_per_pixel) return;
    const double seconds = std::clamp(2 * remaining / std::max(motion_.speed, 1e-6), kFrame, kSlowest),
                 start = motion_.pressure;
    const int n = static_cast<int>(std::ceil(seconds / kFrame));
    const double flick = std::min(1.0, remaining / (kFlick * holder_.working_depth));
    for (int i = 1; i <= n; ++i) {
        const double t = static_cast<double>(i) / n, left = (1 - t) * (1 - t);
        const Vec3 before = point_.position;
        point_.position = from + (1 - left) * (goal_.position - from);
        point_.normal = glm::normalize(point_.normal + t * (goal_.normal - point_.normal));
        onto_surface();
        drag(aim_);
        turn_holder(aim_, point_.position - before);
        motion_.gone += glm::distance(before, point_.position);
        motion_.pressure = start * (1 - kFlickLift * flick * (1 - left));
        motion_.time += seconds / n;
        poses.push_back(pose_at(aim_, point_.position, point_.normal, motion_.pressure, motion_.time));
    }
}

std::vector<StrokeStep> PointerInput::lift() {
    std::vector<StrokeStep> steps;
    if (!waiting_.empty()) set_down(steps);
    if (!down_) return steps;
    constexpr int count = 12;
    StrokeStep step;
    if (is_clean(aim_)) arrive(step.poses);
    const double start = motion_.pressure;
    for (int i = 1; i <= count; ++i) {
        const double s = static_cast<double>(i) / count;
        motion_.time += kLift / count;
        step.poses.push_back(
            pose_at(aim_, point_.position, point_.normal, i == count ? 0.0 : start * (1 - s), motion_.time));
    }
    down_ = false;
    turns_.follower = {};
    turns_.blade.reset();
    steps.push_back(std::move(step));
    steps.push_back({StrokeStep::Kind::end, {}});
    return steps;
}

std::optional<brush::Pose> PointerInput::hover(const Aim& aim) const {
    const auto hit = find_surface(aim);
    if (!hit || hit->inside) return std::nullopt;
    return pose_at(aim, hit->position, hit->normal, 0, aim.time);
}

}  // namespace tuft::app
