#include "stroke/pointer/pointer_input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "brush/tuft/ferrule.h"
#include "core/ease.h"
#include "core/first_order_lag.h"
#include "stroke/placement/surface_mapping.h"

namespace tuft::stroke {
namespace {

constexpr double kPenRise = 0.004;  // seconds in which the brush follows a pen's pressure
constexpr double kLift = 0.06;      // seconds of the lift
constexpr double kFrame = 0.004;    // seconds between the poses made between two aims
constexpr double kReport = 0.01;    // seconds between a tablet's reports while something changes, at most
constexpr double kJump = 0.004;     // metres between two aims that may be an edge of the outline
constexpr double kGrazing = 6;      // times further on a slanting surface than across the view
constexpr double kMaxTilt = 1.2;    // radians
constexpr double kMostFelt = 0.008,
                 kFeltOfModel = 0.02;  // metres round the aim, and part of the model's diagonal, at most
constexpr double kKnown = 3;           // pixels after which the direction of a clean stroke is known
constexpr double kRestTime = 0.15;     // seconds after which a hand that rests presses straight down
constexpr double kSetDown = 0.05;      // seconds in which a clean stroke is pressed down
constexpr double kPressedDown = 0.7;   // of the pressure, that it is pressed down with; the rest comes along the path
// Pressed down in place, the tip is pushed back behind the first place by this part of the tuft's length, at pressure
// 1; the holder goes as far ahead of it there, and loses that over this part of the length. A fast start pulls the tip
// along: at this speed, m/s, all of it.
constexpr double kSpread = 0.1, kSpreadGone = 0.2, kFastStart = 0.25;
constexpr double kTips = 0.12,
                 kTipTurns = 4;   // radians that the holder is tipped ahead at first, over so many `tip_lag_turn`
constexpr double kSlowest = 0.2;  // seconds in which it arrives at its end, at most
constexpr double kFlick = 1.5;  // of the working depth: a distance to the end on which the brush lifts by the next part
constexpr double kFlickLift = 0.75;  // of its pressure; the rest goes at the end
// Behind an edge hair that was pressed onto the rim would hook over it: the stroke goes on lightly, by this part of its
// pressure's path, and is pressed down over this part of the tuft's length.
constexpr double kLightly = 0.2, kOverAnEdge = 0.08;
constexpr double kSlowestCatchUp = 0.02, kCatchUpSpacing = 2.5e-4;  // m/s; metres between poses
constexpr double kAhead = 0.5;  // of the radius that a holder levels: how far ahead the surface is looked at

/// Half of the tip lag across the broad side, metres: a flat trails half as far on its edge.
double half_lag(const HolderOptions& holder, double pressure) {
    return (holder.turned ? 1 : 0.5) * tip_lag_length(holder.tip_lag, pressure * holder.working_depth);
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

PointerInput::PointerInput(const mesh::SurfaceQuery& surface, const brush::Preset& preset,
                           const PointerSettings& settings, BrushTipLag lag)
    : surface_(surface),
      holder_(holder_options(preset, surface.mesh())),
      options_{settings, pressure_options(settings), position_filter(settings)},
      view_(surface, std::min({2 * preset.radius, kMostFelt, kFeltOfModel * surface.mesh().bounds.diagonal()}),
            holder_.steady),
      radius_(preset.radius),
      wide_(brush::can_be_turned(preset)) {
    holder_.tip_lag = std::move(lag.upright);
    holder_.tip_lag_change = std::move(lag.tilted);
}

// Along the middle of the holder and four lines round it. Near the place lies the surface itself, with what grain and
// curvature it has.
bool PointerInput::has_room(const Vec3& at, const Vec3& along) const {
    constexpr double kNear = 0.15;  // of the tuft's length
    const double length = holder_.tuft_length + holder_.hover, near = kNear * length;
    const Vec3 foot = at + near * along;
    if (surface_.ray(foot, along, 0, length - near)) return false;
    const Frame f = make_frame(at, along);
    for (const Vec3& side : {f.t, -f.t, f.b, -f.b}) {
        // Behind a wall beside the place, such as within a step, a line would leave through its top.
        if (surface_.ray(foot, side, 0, radius_)) continue;
        if (surface_.ray(foot + radius_ * side, along, 0, length - near)) return false;
    }
    return true;
}

std::optional<AimedSurface> PointerInput::find_surface(const Aim& aim) const {
    constexpr int kLeans = 8;
    auto found = view_.find(aim);
    if (!found || has_room(found->position, found->normal)) return found;
    const Vec3 normal = found->normal, eye = -aim.ray.direction;
    for (int i = 1; i <= kLeans; ++i) {
        const Vec3 leant = glm::normalize(glm::mix(normal, eye, static_cast<double>(i) / kLeans));
        if (!has_room(found->position, leant)) continue;
        found->normal = leant;
        break;
    }
    return found;
}

// The smoothed point cuts the corners of a curved surface: it is brought back. Over a gap the nearest
// place is an edge beside it; there it stays where it is. Returns by how much it moved.
Vec3 PointerInput::onto_surface() {
    constexpr double kFurthest = 5e-3;
    const auto is_met = [&](const mesh::SurfacePoint& p) {
        return (glm::dot(p.normal, point_.normal) < 0) == side_.on_back.value_or(false);
    };
    auto on = surface_.closest_point(point_.position, kFurthest);
    // In a thin wall its other side may be nearer.
    if (on && !is_met(*on))
        on = surface_.ray(point_.position + kFurthest * point_.normal, -point_.normal, 0, 2 * kFurthest);
    if (!on || !is_met(*on)) return Vec3(0);
    const Vec3 offset = on->position - point_.position;
    const bool sideways =
        glm::length(offset - glm::dot(offset, point_.normal) * point_.normal) > 0.5 * glm::length(offset);
    if (motion_.bridged >= 0 && motion_.time - motion_.bridged < 5 * options_.pointer.smoothing + 2 * kFrame &&
        sideways)
        return Vec3(0);
    const double side = glm::dot(on->normal, point_.normal) < 0 ? -1 : 1;
    point_.position = on->position;
    if (options_.pointer.string > 0) point_.normal = side * on->normal;
    return offset;
}

brush::Pose PointerInput::pose_at(const Aim& aim, const Vec3& point, const Vec3& normal, double pressure,
                                  double time) const {
    const Vec2 leant = lean_of_make(aim, normal);
    const Vec2 tilt = glm::clamp(aim.tilt.value_or(options_.pointer.tilt) + leant, -kMaxTilt, kMaxTilt);
    const auto along = [&](const Vec3& v) {
        const Vec3 d = v - glm::dot(v, normal) * normal;
        return glm::length(d) > 1e-6 ? glm::normalize(d) : Vec3(0);
    };
    const auto tipped_after = [&](double gone) {
        return std::max(0.0, kTips - glm::length(leant)) * (1 - smooth_step(gone / (kTipTurns * holder_.tip_lag_turn)));
    };
    const Vec3 up =
        glm::normalize(normal + std::tan(tilt.x) * along(aim.view_right) + std::tan(tilt.y) * along(aim.view_up) +
                       tipped_after(motion_.gone) * strings_.dragged.string +
                       turns_.back.turned_back() * tipped_after(turns_.back.since_turn()) * trails(aim).string);
    const double down = pressed(aim, pressure), carried = turns_.back.lift().carried(glm::length(trails(aim).string));
    const double height =
        holder_.tuft_length + (pressure > 0 ? carried * holder_.hover - down * holder_.working_depth : holder_.hover);
    return {.position = point + ahead_of(aim, normal, down) + height * up,
            .rotation = rotation_at(aim, normal, up),
            .time = time};
}

// As the tilt of the settings: where neither the pen nor the settings lean the holder.
Vec2 PointerInput::lean_of_make(const Aim& aim, const Vec3& normal) const {
    if (!(holder_.lean > 0) || aim.tilt || options_.pointer.tilt != Vec2(0)) return Vec2(0);
    const Axes axes = axes_across(normal, aim.view_right, -aim.view_up);
    const Vec3& string = trails(aim).string;
    const Vec3 to = glm::mix(strings_.leant.string, string, turns_.back.lift().leans_over(glm::length(string)));
    const Vec2 ahead{glm::dot(to, axes.right), glm::dot(to, axes.down)};
    const Vec2 lean = stroke::lean_of_make(holder_, roll_at(aim), ahead);
    return {lean.x, -lean.y};
}

// What is left of a pressure where the path turns back.
double PointerInput::pressed(const Aim& aim, double pressure) const {
    return pressure * turns_.back.lift().pressed(glm::length(trails(aim).string));
}

// Of the ferrule, on the surface: where a make leans that is set down without a direction.
Vec3 PointerInput::across(const Aim& aim) const {
    if (!holder_.across) return Vec3(0);
    const Axes axes = axes_across(point_.normal, aim.view_right, -aim.view_up);
    return -std::sin(roll_at(aim)) * axes.right - std::cos(roll_at(aim)) * axes.down;
}

double PointerInput::roll_at(const Aim& aim) const {
    return options_.pointer.roll +
           (options_.pointer.roll_follow && turns_.follower.started ? turns_.follower.roll : -aim.turn);
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
    const Vec3 x = parallel_transport(axes_across(normal, aim.view_right, -aim.view_up).right, normal, up);
    return turned(glm::normalize(glm::quat_cast(Mat3(x, glm::cross(up, x), up))), roll_of_ferrule(aim));
}

// The holder has gone on: it turns as the pen does, and after its stroke. Its hair follows.
void PointerInput::turn_holder(const Aim& aim, const Vec3& motion) {
    if (!wide_) return;
    const Axes axes = axes_across(point_.normal, aim.view_right, -aim.view_up);
    if (options_.pointer.roll_follow)
        follow_stroke(turns_.follower, -aim.turn, {glm::dot(motion, axes.right), glm::dot(motion, axes.down)});
    if (holder_.blade_landing > 0 && is_clean(aim)) {
        if (!turns_.blade) turns_.blade.emplace(holder_.tip_lag_turn, roll_at(aim));
        turns_.blade->follow(roll_at(aim), glm::length(motion));
    }
    const Vec2 ahead{glm::dot(strings_.dragged.string, axes.right), glm::dot(strings_.dragged.string, axes.down)};
    if (!holder_.turned || glm::length(ahead) < 1e-9) return;
    const double turn = roll_at(aim) - std::atan2(-ahead.y, ahead.x);
    if (!turns_.followed) turns_.followed.emplace(holder_.tuft_length, turn);
    turns_.followed->follow(turn, glm::length(motion));
    if (!(turns_.back.lift().pressed(glm::length(strings_.dragged.string)) > 0)) turns_.followed->lift();
}

// Where the holder is for ink at the point: ahead along the string, and under a lean aside.
Vec3 PointerInput::ahead_of(const Aim& aim, const Vec3& normal, double pressure) const {
    const double taut = glm::length(strings_.dragged.string);
    if (holder_.tip_lag.empty() || !(pressure > 0) || taut < 1e-9) return Vec3(0);
    const Axes axes = axes_across(normal, aim.view_right, -aim.view_up);
    const Vec2 ahead{glm::dot(strings_.dragged.string, axes.right), glm::dot(strings_.dragged.string, axes.down)};
    if (glm::length(ahead) < 1e-9) return Vec3(0);
    const Vec2 tilt = options_.pointer.tilt + lean_of_make(aim, normal);
    const double roll =
        turns_.followed ? turns_.followed->turn() + std::atan2(-ahead.y, ahead.x) : roll_of_ferrule(aim);
    const Vec2 lag = std::lerp(taut, 1.0, turns_.back.lift().back) *
                     tip_lag_at(holder_, pressure, {tilt.x, -tilt.y}, roll, glm::normalize(ahead));
    const double spread =
        pressure * motion_.spread * (1 - smooth_step(motion_.gone / (kSpreadGone * holder_.tuft_length)));
    return lag.x * axes.right + lag.y * axes.down + spread * strings_.dragged.string;
}

// A pen that presses more trails by more: its string grows as taut as it is.
void PointerInput::grow_string() {
    if (!is_lifted_at_turns(holder_)) return;
    const double reach = std::max(holder_.tip_lag_turn, half_lag(holder_, steadying_.press.pressure));
    strings_.trailing.position -= (reach - strings_.trailing_reach) * strings_.trailing.string;
    strings_.trailing_reach = reach;
}

// The point has moved: what it drags follows on the strings, along the surface.
void PointerInput::drag(const Aim& aim) {
    const auto follow = [&](DraggedPoint& dragged, double reach) {
        Vec3 offset = along_surface(point_.position - dragged.position, point_.normal, aim, at_start());
        if (const double length = glm::length(offset); length > reach) offset *= reach / length;
        dragged.position = point_.position - offset;
        dragged.string = offset / reach;
    };
    const double lean = lean_string(holder_);
    if (is_clean(aim))
        follow(strings_.dragged, holder_.tip_lag_turn);
    else if (is_lifted_at_turns(holder_))
        follow(strings_.trailing, strings_.trailing_reach);
    follow(strings_.leant, lean);
    if (!is_lifted_at_turns(holder_)) return;
    const DraggedPoint& dragged = trails(aim);
    if (is_clean(aim))
        turns_.back.follow(point_.position, dragged.string, holder_.tip_lag_turn, kLiftedTurns);
    else
        turns_.back.follow(point_.position, dragged.string, strings_.trailing_reach, kLiftedPenTurns);
    // Hair that is lifted is set down leaning to its other side.
    const TurnLift& lift = turns_.back.lift();
    if (lift.back >= 1 && glm::length(dragged.string) < lift.air)
        strings_.leant = {point_.position - lean * dragged.string, dragged.string};
}

double PointerInput::goal_pressure(const Aim& aim) const {
    const double travel = kLightly + motion_.gone / (kOverAnEdge * holder_.tuft_length);
    const double landed = side_.over_edge ? smooth_step(travel / (1 + kLightly)) : 1;
    return landed * (aim.pressure >= 0 ? pen_depth(options_.pointer, aim.pressure)
                                       : pressure_goal(steadying_.press, options_.by_motion));
}

void PointerInput::settle_pressure(const Aim& aim, double travel, double dt) {
    PressureState& press = steadying_.press;
    track_motion(press, travel, dt, options_.by_motion);
    const double follow = aim.pressure >= 0 ? kPenRise : options_.by_motion.follow;
    press.pressure += settled_part(dt, follow) * (goal_pressure(aim) - press.pressure);
}

void PointerInput::pen_down(const Aim& aim, const AimedSurface& hit, const Vec3& towards,
                            std::vector<StrokeStep>& steps) {
    down_ = true;
    goal_.position = point_.position = hit.position;
    point_.normal = hit.normal;
    motion_ = {.start = aim.time};
    steadying_ = {};
    steadying_.position = {.started = true, .raw = hit.position, .value = hit.position};
    if (options_.pointer.string > 0) {
        Aim at = aim;
        pull_on_string(at, hit.position);
    }
    turns_.follower = {};
    turns_.followed.reset();
    turns_.blade.reset();
    strings_.dragged = {point_.position - holder_.tip_lag_turn * towards, towards};
    strings_.trailing = {point_.position, Vec3(0)};
    strings_.trailing_reach = holder_.tip_lag_turn;
    turns_.back = {};
    turn_holder(aim, Vec3(0));
    const Vec3 leans = towards != Vec3(0) ? towards : across(aim);
    strings_.leant = {point_.position - lean_string(holder_) * leans, leans};
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
    if (!hit || glm::distance(hit->position, at.position) > kSameSurface * reach) return at.normal;
    const Vec3 normal = view_.normal(ahead, *hit);
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
    PressureState& press = steadying_.press;
    press.speed = length / std::max(kFrame, last.aim.time - first.aim.time);
    if (!side_.over_edge)
        motion_.spread = kSpread * holder_.tuft_length * (1 - std::min(1.0, press.speed / kFastStart));
    const double pressure = (glm::length(strings_.dragged.string) > 0 ? kPressedDown : 1.0) * goal_pressure(first.aim);
    const int n = static_cast<int>(std::ceil(kSetDown / kFrame));
    StrokeStep step;
    for (int i = 1; i <= n; ++i) {
        motion_.time = kSetDown * i / n;
        press.pressure = pressure * i / n;
        step.poses.push_back(pose_at(first.aim, point_.position, point_.normal, press.pressure, motion_.time));
    }
    steadying_.position.time = motion_.time;
    for (std::size_t i = 1; i < waiting.size(); ++i) {
        if (waiting[i].surface.bridged) motion_.bridged = motion_.time;
        const Vec3 normal = normal_at_start(waiting[i].aim, waiting[i].surface, strings_.dragged.string);
        follow(waiting[i].aim, waiting[i].surface.position, normal, step.poses);
        goal_.normal = waiting[i].surface.normal;
    }
    steps.push_back(std::move(step));
}

// Returns the place of the tip, and gives the aim the pen's pressure and tilt of that place. Where the tip rests, a pen
// presses and turns it as it is now.
Vec3 PointerInput::pull_on_string(Aim& aim, const Vec3& hand) {
    const Vec3 before = steadying_.string.tip;
    const bool began = steadying_.string.started;
    const StrokeSample tip = pull(steadying_.string,
                                  {.position = hand,
                                   .pressure = aim.pressure,
                                   .tilt = aim.tilt.value_or(options_.pointer.tilt),
                                   .roll = aim.turn},
                                  options_.pointer.string);
    if (began && tip.position == before) {
        aim.pressure = std::max(aim.pressure, tip.pressure);
        return tip.position;
    }
    if (aim.pressure >= 0) aim.pressure = tip.pressure;
    if (aim.tilt) aim.tilt = tip.tilt;
    aim.turn = tip.roll;
    return tip.position;
}

void PointerInput::follow(const Aim& aim, const Vec3& goal, const Vec3& normal, std::vector<brush::Pose>& poses) {
    const double span = std::max(1e-4, aim.time - motion_.start - motion_.time);
    const int steps = std::clamp(static_cast<int>(std::ceil(span / kFrame)), 1, 64);
    const Vec3 from = goal_.position;
    for (int i = 0; i < steps; ++i) {
        Aim at = aim;
        Vec3 target = from + static_cast<double>(i + 1) / steps * (goal - from);
        if (options_.pointer.string > 0) target = pull_on_string(at, target);
        step(at, target, normal, span / steps, poses);
    }
    goal_.position = goal;
}

void PointerInput::step(const Aim& aim, const Vec3& target, const Vec3& normal, double dt,
                        std::vector<brush::Pose>& poses) {
    const Vec3 before = point_.position;
    point_.position = filter(steadying_.position, target, motion_.time + dt, options_.filter);
    const bool leans_ahead = glm::dot(normal - point_.normal, strings_.dragged.string) > 0;
    const double constant = std::max(0.01, options_.pointer.smoothing) * (leans_ahead ? 1 - at_start() : 1);
    point_.normal = glm::normalize(point_.normal + settled_part(dt, constant) * (normal - point_.normal));
    // The string's end lies on the surface too.
    steadying_.string.tip += onto_surface();
    steadying_.position.value = point_.position;
    const Vec3 after = point_.position;
    const int parts = parts_of(aim, after - before);
    for (int i = 1; i <= parts; ++i) {
        const Vec3 from = i > 1 ? point_.position : before;
        point_.position = i < parts ? glm::mix(before, after, static_cast<double>(i) / parts) : after;
        drag(aim);
        turn_holder(aim, point_.position - from);
        const double travel = glm::distance(from, point_.position);
        motion_.gone += travel;
        settle_pressure(aim, travel, dt / parts);
        grow_string();
        motion_.time += dt / parts;
        poses.push_back(pose_at(aim, point_.position, point_.normal, steadying_.press.pressure, motion_.time));
    }
}

// Where a path turns back, the hair is lifted and set down within two lengths of a string, which a fast hand passes in
// one step.
int PointerInput::parts_of(const Aim& aim, const Vec3& motion) const {
    constexpr double kPartsOfString = 6, kMostParts = 24;
    const Vec3& string = trails(aim).string;
    const bool slack = glm::dot(string, motion) < 0 || glm::length(string) < 1 - 1e-9;
    if (!is_lifted_at_turns(holder_) || !slack || string == Vec3(0)) return 1;
    const double reach = is_clean(aim) ? holder_.tip_lag_turn : strings_.trailing_reach;
    return static_cast<int>(std::clamp(std::ceil(kPartsOfString * glm::length(motion) / reach), 1.0, kMostParts));
}

// Where a pen leaves, the tip goes along its string to it, through the pressures between them.
void PointerInput::catch_up(std::vector<brush::Pose>& poses) {
    std::vector<StrokeSample> left;
    const double speed = std::max(steadying_.press.speed, kSlowestCatchUp);
    let_go(steadying_.string, motion_.time, speed, kCatchUpSpacing, left);
    for (const StrokeSample& s : left) {
        Aim at = aim_;
        at.pressure = s.pressure;
        if (at.tilt) at.tilt = s.tilt;
        at.turn = s.roll;
        step(at, s.position, goal_.normal, s.time - motion_.time, poses);
    }
}

std::vector<StrokeStep> PointerInput::move(const Aim& aim) {
    std::vector<StrokeStep> steps;
    options_.by_motion = pressure_options(options_.pointer, aim.metres_per_pixel);
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
        if (is_clean(aim)) hit->normal = normal_at_start(aim, *hit, strings_.dragged.string);
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
    const double seconds = std::clamp(2 * remaining / std::max(steadying_.press.speed, 1e-6), kFrame, kSlowest),
                 start = steadying_.press.pressure;
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
        const double pressure = start * (1 - kFlickLift * flick * (1 - left));
        motion_.time += seconds / n;
        poses.push_back(pose_at(aim_, point_.position, point_.normal, pressure, motion_.time));
        steadying_.press.pressure = pressure;
    }
}

std::vector<StrokeStep> PointerInput::lift() {
    std::vector<StrokeStep> steps;
    if (!waiting_.empty()) set_down(steps);
    if (!down_) return steps;
    constexpr int count = 12;
    StrokeStep step;
    if (is_clean(aim_))
        arrive(step.poses);
    else if (options_.pointer.string > 0)
        catch_up(step.poses);
    const double start = steadying_.press.pressure;
    for (int i = 1; i <= count; ++i) {
        const double s = static_cast<double>(i) / count;
        motion_.time += kLift / count;
        step.poses.push_back(
            pose_at(aim_, point_.position, point_.normal, i == count ? 0.0 : start * (1 - s), motion_.time));
    }
    down_ = false;
    turns_.follower = {};
    turns_.blade.reset();
    turns_.back = {};
    steps.push_back(std::move(step));
    steps.push_back({StrokeStep::Kind::end, {}});
    return steps;
}

std::optional<brush::Pose> PointerInput::hover(const Aim& aim) const {
    const auto hit = find_surface(aim);
    if (!hit || hit->inside) return std::nullopt;
    return pose_at(aim, hit->position, hit->normal, 0, aim.time);
}

}  // namespace tuft::stroke
