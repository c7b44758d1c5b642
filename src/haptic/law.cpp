#include "haptic/law.h"

#include <algorithm>
#include <cmath>

#include "core/first_order_lag.h"

namespace tuft::haptic {
namespace {

constexpr double T = kPeriod;
constexpr double kRootMass = 0.02;       // m, kg
constexpr double kVelocityTime = 4e-3;   // s, of the low-pass of v_x: B count / T would be 0.3 N of noise
constexpr double kCourse = 16;           // periods in which the course of a fast arm becomes another
constexpr double kRest = 200;            // periods, at most, in which x comes to what is measured of an arm that stands
constexpr double kEased = 10;            // periods in which x of a slow one comes to where it was not expected
constexpr double kFadeStiffness = 1000;  // N/m
constexpr double kRootStiffness = 2 * kRootMass / (T * T);  // N/m
constexpr double kFadeFree = 0.01;                          // N that g may jump in a period
constexpr double kFadeRate = 0.06;                          // N by which the offset falls in a period
constexpr double kRestoreTime = 0.15;                       // s
constexpr double kTankKeeps = 30e-6;      // e_0, J, of what came in and is stored nowhere; in the air, at least
constexpr double kTankStiffness = 1.25;   // of K: what a full spring gives is never held back
constexpr double kPlannedFall = 0.9;      // of k_max: a hand that speeds up meanwhile makes the fall steeper
constexpr std::size_t kPlannedAhead = 2;  // periods: the middle of a fall
constexpr double kFallFree = 0.08;        // N that a force may fall in a period at rest
constexpr double kStep = 0.1;             // N that a force may change by in a period at rest
constexpr double kReserve = 0.5;          // of the work of a period: counts change by it what is planned
constexpr double kMostDelayed = 12;       // periods
constexpr double kLeast = 0.5e-6;         // J to which an empty tank is filled, so that it does not lock at no force
constexpr double kMostLent = 0.8e-6;      // J of it in a contact
constexpr double kFlicker = 1.8;          // counts that a position at rest flickers by, on two axes at once
constexpr double kWithin = 0.5;           // counts from what is measured to x, but for what goes into it slowly
constexpr double kStopped = 1.5;          // counts that an arm would have moved on by
constexpr double kStill = 1000;           // periods
constexpr double kCountError = 0.5;       // counts between a measured and a true position, along an axis
constexpr double kCountedShare = 0.3;     // of a change of force that is counted at once
constexpr double kMostAcceleration = 60;  // m/s², of a hand
constexpr double kMostTurning = 500;      // rad/s², of a wrist
constexpr double kFrictionShare = 0.7;  // of the arm's friction: an arm that has worn in has less than its maker states
constexpr double kFree = 1e-3;          // N below which a force is none

/// `v` no longer than `most`.
Vec3 limited(const Vec3& v, double most) {
    const double size = glm::length(v);
    return size > most ? v * (most / size) : v;
}

/// Δx̂: the motion of the arm in the j-th period from the last one on, m. Two low passes in a row of τ = 4 ms lag by τ a
/// and 2 τ a of a speed that grows by a m/s²: their difference takes the lag away. A count stirs it up by 0.4 of a
/// count in the next period, by a whole one in the 13th.
Vec3 expected_motion(const LawState& s, std::size_t j) {
    const double ahead = 1 + static_cast<double>(j) * std::expm1(T / kVelocityTime);
    return T * (s.arm.velocity + ahead * (s.arm.velocity - s.arm.velocity_before));
}

/// d⁺ along one axis of the device, m, from d − Δx_c; `course` is v_c along it. `came`: a count has come.
double follow_axis(double count, bool came, double d, CountedAxis& axis, double& course) {
    axis.lasted = std::min(axis.lasted + 1, kStill);
    if (came) axis = {.lasted = 0, .before = axis.lasted, .came = std::abs(course)};
    const double n = std::max(axis.before, axis.lasted), next = d + T * course;
    const double missed = std::clamp(next, -kWithin * count, kWithin * count) - next;
    // Counts of a slow hand come one by one: what was not expected of them goes into x in some periods.
    const double mended = missed / std::clamp(n / 3, 1.0, kEased);
    course += mended / (T * std::max(kCourse, n));
    d = std::clamp(next + mended, -count, count);
    // An arm that still moved would have come to another count by now. One that stands may be anywhere between two.
    if (axis.lasted == kStill || T * axis.came * axis.lasted > kStopped * count) {
        const double share = 1 / std::clamp(axis.before, kCourse, kRest);
        d -= share * d;
        course -= share * course;
    }
    return d;
}

/// Moves x on, and returns by what.
Vec3 follow_arm(const LawOptions& options, LawState& s, const LawInput& in) {
    ArmMotion& arm = s.arm;
    const double count = options.limits.count * options.scale, passed = settled_part(T, kVelocityTime);
    const Quat to_device = glm::conjugate(in.axes);
    const Vec3 before = arm.position, counted = to_device * (in.arm - arm.measured);
    Vec3 d = to_device * (before - in.arm), course = to_device * arm.course;
    for (int i = 0; i < 3; ++i)
        d[i] = follow_axis(count, std::abs(counted[i]) > 0.5 * count, d[i], arm.axes[static_cast<std::size_t>(i)],
                           course[i]);
    arm.measured = in.arm;
    arm.position = in.arm + in.axes * d;
    arm.course = in.axes * course;
    const Vec3 moved = arm.position - before;
    arm.velocity += (moved / T - arm.velocity) * passed;
    arm.velocity_before += (arm.velocity - arm.velocity_before) * passed;
    return moved;
}

/// r: how far the root at `root` went by itself against `jump`, m, while the arm made `moved`.
double gone_against(const LawState& s, const Vec3& jump, const Vec3& moved, const Vec3& root) {
    const double size = glm::length(jump);
    if (!(size > 0)) return 0;
    const Vec3 back = s.fade.root - root;
    return std::max(0.0, std::min(glm::dot(back, jump), glm::dot(back + moved, jump)) / size);
}

/// Step 2.
Vec3 faded(const LawOptions& options, LawState& s, const Vec3& g, const Vec3& root) {
    const Vec3 jump = g - s.fade.force;
    const double size = glm::length(jump), old = glm::length(s.fade.offset);
    s.fade.offset = old > kFadeRate ? s.fade.offset * (1 - kFadeRate / old) : Vec3{0};
    if (size == 0 && root == s.fade.root) return g + s.fade.offset;  // no new answer
    const Vec3 moved = s.arm.position - s.fade.arm;
    const double allowed = std::min(options.limits.max_stiffness / options.scale, kFadeStiffness) * glm::length(moved) +
                           kRootStiffness * gone_against(s, jump, moved, root) + kFadeFree;
    if (size > allowed) s.fade.offset -= jump * (1 - allowed / size);
    s.fade.arm = s.arm.position;
    s.fade.root = root;
    s.fade.force = g;
    return g + s.fade.offset;
}

/// What bounds do to the root that they stop.
struct BoundReaction {
    Vec3 moment{0};     ///< N·m, about the root
    bool hard = false;  ///< a bound stopped it
};

/// Keeps root and velocity to the free side of all bounds.
BoundReaction hold_to_bounds(const LawOptions& options, const HairAnswer& hair, Vec3& root, Vec3& velocity) {
    constexpr int kPasses = 4;  // bounds of a corner or a gap push against each other
    BoundReaction held;
    for (int pass = 0; pass < kPasses; ++pass) {
        bool moved = false;
        for (std::size_t i = 0; i < hair.n_bounds; ++i) {
            const RootBound& b = hair.bounds[i];
            const double miss = b.height - glm::dot(b.normal, root);
            if (miss <= 0) continue;
            root += miss * b.normal;
            const double into = -glm::dot(b.normal, velocity);
            if (into > 0) {
                velocity += into * b.normal;
                const double sliding = glm::length(velocity), stopped = options.hard_friction * into;
                Vec3 impulse = into * b.normal;
                if (sliding > 1e-12) {
                    const Vec3 drag = velocity * (std::min(stopped, sliding) / sliding);
                    velocity -= drag;
                    root -= T * drag;
                    impulse -= drag;
                }
                held.moment += glm::cross(b.lever, impulse * (kRootMass / T));
            }
            moved = held.hard = true;
        }
        if (!moved) break;
    }
    return held;
}

/// The force that was sent i periods ago, from 1 on.
const Vec3& sent_before(const LawState& s, std::size_t i) {
    return s.sent.ring[(s.sent.n + s.sent.ring.size() - i) % s.sent.ring.size()];
}

/// The force that acted in the last period, N: of those with each of two delays, which are not known to a period, the
/// one that took more energy from the tank, where what is measured moved by `counted`.
const Vec3& acted_over(const LawState& s, const Vec3& counted) {
    const Vec3& acted = sent_before(s, s.sent.delay + 1);
    if (s.sent.delay == 0) return acted;
    const Vec3& later = sent_before(s, s.sent.delay + 2);
    return glm::dot(later, counted) > glm::dot(acted, counted) ? later : acted;
}

/// f_r, N: what the arm's friction takes back from a force that moves it. Only with restore, which gives the hand more
/// than it has pressed into the coupling.
double paid_by_friction(const LawOptions& options) {
    return options.restore ? kFrictionShare * options.limits.friction : 0;
}

/// |v|₁ along the axes of the device.
double along_axes(const LawInput& in, const Vec3& v) {
    const Vec3 parts = glm::abs(glm::conjugate(in.axes) * v);
    return parts.x + parts.y + parts.z;
}

/// Step 6 before the force of this period: what the last one has given over the path `moved` of x from x_c + `d`.
void settle_tank(const LawOptions& options, LawState& s, const LawInput& in, const Vec3& moved, const Vec3& d) {
    const double count = options.limits.count * options.scale;
    // acted · moved + (acted − before) · d, and what the next period adds of it: acted · (moved + d − d⁺).
    const Vec3 acted = acted_over(s, moved + d - (s.arm.position - s.arm.measured));
    // What counts stir up in a force goes against their error and takes no energy: it is smoothed out.
    const Vec3 change = kCountedShare * (acted - s.tank.counted_force);
    s.tank.energy -=
        glm::dot(acted, moved) + glm::dot(acted - s.tank.acted, d) + kCountError * count * along_axes(in, change);
    s.tank.acted = acted;
    s.tank.counted_force += change;
    if (const double path = glm::distance(s.arm.position, s.tank.played); path > kFlicker * count) {
        s.tank.landed += path;
        s.tank.energy += paid_by_friction(options) * std::max(0.0, path - count);
        s.tank.played = s.arm.position;
    }
    s.tank.energy -= glm::dot(s.moment, turn_between(s.arm.rotation, in.rotation));
}

/// Step 6: what the tank holds at the beginning of a contact, and at most in one, where hair has stored `stored` J.
void fill_tank(LawState& s, bool was_free, double stored) {
    if (s.free) {
        // A spring that the fade drew out is no income.
        s.tank.energy = std::clamp(s.tank.energy, kTankKeeps, kTankKeeps + s.coupled);
        s.tank.lent = 0;
        return;
    }
    if (was_free) {
        s.tank.energy = s.coupled;
        s.tank.landed = 0;
    }
    // What the hair lost is not kept for later, but for e_0; hair that has taken a set may have less than none.
    s.tank.energy = std::min(s.tank.energy, kTankKeeps + std::max(0.0, stored) + s.coupled);
    if (const double lends = std::min(kLeast - s.tank.energy, kMostLent - s.tank.lent); lends > 0) {
        s.tank.energy += lends;
        s.tank.lent += lends;
    }
}

/// k, N/m.
double tank_stiffness(const LawOptions& options) {
    return std::min(kPlannedFall * options.limits.max_stiffness / options.scale, kTankStiffness * coupling_of(options));
}

/// a of a hand at rest, m: the path that it can make while a force acts.
double path_from_rest(const LawOptions& options, const LawState& s) {
    return kMostAcceleration * T * T * static_cast<double>(1 + s.sent.delay) + options.limits.count * options.scale;
}

/// w, J. A spring of K that is pressed by x has brought in ½ K x², less ½ count K x for counts, and needs K x a: it
/// lacks ½ K b² at most, at x = b, and nothing from x = 2 b on.
double landing_loan(const LawOptions& options, const LawState& s) {
    const double b = path_from_rest(options, s) + kCountError * options.limits.count * options.scale;
    return 0.5 * coupling_of(options) * b * b * std::clamp(2 - 0.5 * s.tank.landed / b, 0.0, 1.0);
}

/// By what a spring of k_max follows the last period's motion `moved`, N. A velocity is late, a motion has counts in
/// it: the lesser is never more than the motion by much.
double following_force(const LawOptions& options, const LawState& s, const Vec3& moved) {
    return options.limits.max_stiffness / options.scale *
           std::min(glm::length(moved), glm::length(expected_motion(s, 0)));
}

/// Periods until a force acts, by the longer of two delays.
std::size_t periods_on_the_way(const LawState& s) {
    return s.sent.delay > 0 ? s.sent.delay + 1 : 0;
}

/// e′, J.
double energy_left(const LawOptions& options, const LawState& s) {
    double pending = 0;  // what forces on their way will take, by the longer of two delays
    const std::size_t n = periods_on_the_way(s);
    for (std::size_t i = 1; i <= n; ++i)
        pending += std::max(0.0, glm::dot(sent_before(s, i), expected_motion(s, n + 1 - i)));
    return std::max(0.0, s.tank.energy + landing_loan(options, s) - pending);
}

/// a: the path along `u` that the hand can make while a force acts, m, where it makes `moved` in a period.
double path_ahead(const LawOptions& options, const LawState& s, const Vec3& moved, const Vec3& u) {
    return glm::dot(moved, u) + path_from_rest(options, s);
}

/// P: the force of a spring of k that gives `left` J back over parts of `ahead` m.
double spring_force(double k, double left, double ahead) {
    if (ahead <= 0) return std::sqrt(2 * k * left) - k * ahead;  // against it, the tank only fills
    const double fall = k * ahead, whole = left / (fall * ahead);
    const double n = std::floor(std::sqrt(0.25 + 2 * whole) - 0.5);  // n (n + 1) / 2 <= whole
    return left / ((n + 1) * ahead) + 0.5 * n * fall;
}

/// Step 6: the greatest force along `u` that the tank lets out. Never more than `left` pays for. Above that a force
/// that ends is planned by the motion without counts, and where counts have hidden what it costs, falls no faster for
/// it.
double most_force(const LawOptions& options, const LawState& s, double left, const Vec3& moved, const Vec3& u) {
    const double last = std::max(0.0, glm::dot(s.force, u));
    const Vec3 next = expected_motion(s, periods_on_the_way(s) + kPlannedAhead);
    const double kept = left - kReserve * last * std::max(0.0, glm::dot(next, u));
    const double planned = spring_force(tank_stiffness(options), std::max(0.0, kept), path_ahead(options, s, next, u));
    const double paid = paid_by_friction(options),
                 most = std::max(planned + paid, last - following_force(options, s, moved) - kFallFree),
                 ahead = path_ahead(options, s, moved, u);
    return ahead > 0 ? std::min(most, left / ahead + paid) : most;
}

/// Step 6: `f`, no more than the tank lets out. Takes from `left` J what it may need.
Vec3 limit_to_tank(const LawOptions& options, const LawState& s, const Vec3& moved, const Vec3& f, double& left) {
    const double size = glm::length(f);
    if (!(size > 0)) return f;
    const Vec3 u = f / size;
    const Vec3 let = limited(f, most_force(options, s, left, moved, u));
    left = std::max(0.0, left - glm::length(let) * std::max(0.0, path_ahead(options, s, moved, u)));
    return let;
}

/// Step 6 of a moment, which may take `left` J while the wrist goes on turning by `turned` a period.
Vec3 limited_moment(const Vec3& moment, double left, const Vec3& turned) {
    const double size = glm::length(moment);
    if (!(size > 0)) return moment;
    const double ahead = glm::dot(turned, moment / size) + kMostTurning * T * T;
    return ahead > 0 ? limited(moment, left / ahead) : moment;
}

}  // namespace

double coupling_of(const LawOptions& options) {
    return coupling_for_delay(options.limits, options.delay) / options.scale;
}

Vec3 turn_between(const Quat& before, const Quat& now) {
    Quat turn = now * glm::conjugate(before);
    if (turn.w < 0) turn = -turn;
    const Vec3 v{turn.x, turn.y, turn.z};
    const double s = glm::length(v);
    return s > 1e-12 ? v * (2 * std::atan2(s, turn.w) / s) : 2.0 * v;
}

void restart_law(LawState& state, const Vec3& arm, const Quat& rotation) {
    state = {};
    state.started = true;
    state.arm.measured = state.arm.position = state.root.position = state.fade.root = state.fade.arm =
        state.tank.played = arm;
    state.arm.rotation = rotation;
    state.tank.energy = kTankKeeps;
}

LawOutput step_law(const LawOptions& options, LawState& s, const LawInput& in) {
    if (!s.started) restart_law(s, in.arm, in.rotation);
    const double K = coupling_of(options), B = 2 * std::sqrt(K * kRootMass), m = kRootMass;
    const Vec3 d = s.arm.position - s.arm.measured;
    const Vec3 moved = follow_arm(options, s, in), turned = turn_between(s.arm.rotation, in.rotation);
    s.sent.delay = static_cast<std::size_t>(std::clamp(std::ceil(options.delay / T - 1e-9), 0.0, kMostDelayed));
    settle_tank(options, s, in, moved, d);
    s.arm.rotation = in.rotation;

    const double gain = options.gain * in.trust;
    const Vec3 hair = in.hair ? gain * in.hair->force : Vec3{0};
    const Vec3 g = faded(options, s, hair, in.hair ? in.hair->pose.position : s.fade.root);
    const Vec3 pull = K * (s.arm.position + s.root.restored - s.root.position) + B * s.arm.velocity + g;
    Vec3 velocity = (m * s.root.velocity + T * pull) / (m + T * (K * T + B));
    Vec3 root = s.root.position + T * velocity;
    BoundReaction held;
    if (in.hair) held = hold_to_bounds(options, *in.hair, root, velocity);
    s.root.position = root;
    s.root.velocity = velocity;
    const Vec3 stretch = root - s.arm.position - s.root.restored;
    Vec3 f = K * stretch + B * (velocity - s.arm.velocity);
    if (options.restore) s.root.restored += (T / kRestoreTime) * (s.arm.position - root);

    const double wanted = glm::length(f);
    f = limited(f, std::min(options.limits.max_force, options.most_force)) * in.pass;
    // A blow of the ferrule is felt as one. What safety fades gets smaller at once, but does not grow in a step.
    const bool fades = in.pass < 1 || in.trust < 1;
    if (!held.hard && (!fades || glm::length(f) > glm::length(s.force)))
        f = s.force + limited(f - s.force, following_force(options, s, moved) + kStep);

    const bool touching = in.hair && (in.hair->touching || held.hard || in.hair->force != Vec3{0});
    s.coupled = 0.5 * K * glm::dot(stretch, stretch) + 0.5 * m * glm::dot(velocity, velocity);
    const bool was_free = s.free;
    s.free = !touching && glm::length(s.fade.offset) < kFree;
    if (s.free) s.root.restored *= 1 - T / kRestoreTime;
    fill_tank(s, was_free, in.hair ? gain * in.hair->stored : 0);
    LawOutput out{.root = root, .hard = held.hard};
    double left = energy_left(options, s);
    const Vec3 let = limit_to_tank(options, s, moved, f, left);
    out.limited = let != f;
    f = let;
    const double kept = wanted > 0 ? std::min(1.0, glm::length(f) / wanted) : in.pass;
    s.force = f;
    s.sent.ring[s.sent.n++ % s.sent.ring.size()] = f;
    s.moment = in.hair ? limited_moment(kept * (gain * in.hair->moment + held.moment), left, turned) : Vec3{0};
    out.force = f;
    if (options.limits.max_torque > 0) out.torque = limited(s.moment, options.limits.max_torque);
    return out;
}

}  // namespace tuft::haptic
