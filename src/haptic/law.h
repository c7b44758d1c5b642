#pragma once

#include <array>

#include "core/geometry/types.h"
#include "haptic/device/limits.h"
#include "haptic/hair_answer.h"

/// \file
/// The law of the force, one period T = 1 ms at a time: from the place of the arm and the force of the hair to the
/// force on the hand. Pure: no clock, no thread, no memory allocation. `Servo` (servo.h) calls it.
///
/// Frame: world, metres at the brush. x is the arm, y the virtual root of the tuft, which a coupling holds to the arm.
/// Hair is solved at y, and the stroke is painted from y. The arm reads its place, x_c, in counts along its own axes.
/// x goes on between them by its course v_c, axis by axis: x = x_c + d,
///
///     d⁺ = d + T v_c − Δx_c + c,   c = (0 or what lacks to |d⁺| = ½ count) / clamp(n / 3, 1, 10),
///     v_c += c / (T max(16, n)),
///
/// n the periods since the last count or from that before to it, whichever are more. Where 1.5 counts should have come
/// and none has, the arm stands: d falls to 0 in 16 to 200 periods, and then is wrong by half a count at most. So
/// counts stir up neither spring nor damper, however slow the hand is, and x does not flicker between two of them. In
/// each period:
///
/// 1. g = G F(y, q).
/// 2. Fade. What g jumps beyond a = min(k_max, 1000 N/m) |Δx| + 2 m/T² r + 0.01 N goes into an offset o −= jump − a;
///    |o| falls by 0.06 N a period; g += o. r is how far the root went by itself against the jump: the lesser of its
///    way and its way relative to the arm along −jump, at least 0. Hair that is a spring H answers Δy by −H Δy, and
///    |H Δy|² <= h Δy · H Δy where it is no stiffer than h: r 2 m/T² is what hair does that is half as stiff as step 3
///    bears. Late, it would make the root swing. Δx and Δy are those since the answer before, where answers are late.
/// 3. Coupling, implicit [Colgate1995], [Adams1999]:
///
///        v⁺ = (m v + T (K (x + s − y) + B v_x + g)) / (m + T (K T + B)),   y += T v⁺,
///        f = K (y − x − s) + B (v⁺ − v_x),
///
///    m = 0.02 kg, B = 2 √(K m), v_x low-passed at 4 ms. y keeps to the free side of the bounds of ferrule and handle
///    (a proxy [Ruspini1997]); along them acts Coulomb friction. The arm never shows more than K.
/// 4. Restore, optional: s += (T / 0.15 s) (x − y) takes the softness of the coupling away in the long run. The hand
///    has then pressed a softer spring than the hair that it feels. The friction of the arm pays for it:
///    e += f_r (|Δx′| − count), x′ following x behind a play of 1.8 counts, and f_r = 0.7 f_c is added to the limits of
///    |f| in step 6. Port and wrist alone may then give energy back.
/// 5. Clamp to the device and to 7.9 N. A moment is scaled with its force. While only hair touches, f changes by at
///    most k_max |Δx̂| + 0.1 N, but for a fade, in which it may get smaller at once: the damper alone gives 0.3 N in a
///    period to a hand that turns round at 60 m/s².
/// 6. Tank (a passivity observer and controller [Hannaford2002]): e −= f₋ · Δx + Δf₋ · d + ½ count |Δf̄|₁,
///    e −= G τ · Δθ. f₋ is the force that acted, sent as long ago as the delay says (of two periods the worse), f̄ the
///    same low-passed at 3 ms, d that of the period's beginning. By Abel's summation the second term turns the work
///    along x into that along x_c, and the third, a sum over the axes of the device, pays for what counts hide: the
///    true place is within half a count of x_c along each. e <= e_0 + G stored + ½ K |y − x − s|² + ½ m v², e_0 = 30
///    µJ. A contact begins with e = ½ K |y − x − s|² + ½ m v², which came from the hand. An empty tank is filled to 0.5
///    µJ, with 0.8 µJ at most in a contact, from which a hand that moves fills it by itself. When free, e is at least
///    e_0.
///
///        |f| <= min(e′ / a, max(P, |f₋₁| − k_max |Δx̂| − 0.08 N)),   a = Δx · f̂ + 60 m/s² T² (1 + delay / T) + count,
///        P = e″ / ((n + 1) â) + n k â / 2,  n the most with k â² n (n + 1) / 2 <= e″,   k = min(0.9 k_max, 1.25 K).
///
///    e′ is e + w less what forces on their way will take, by the longer of two delays. It keeps e >= 0. P lets a force
///    that ends with its energy fall by k â a period at most: it takes the motion Δx̂ that goes on as the arm has sped
///    up (â as a, with Δx̂), and e″ = e′ − ½ f₋₁ · Δx̂. f₋₁ is the force of the period before. Where
///    â <= 0 the tank only fills: P = √(2 k e″) − k â. Where a <= 0, e′ / a sets no limit. Δx̂ is of the last period in
///    k_max |Δx̂|, where it is not more than |Δx|, and of the second next one, behind the delay, in â and e″.
///    A landing lends w = ½ K b², b = ½ count + a of a hand at rest: so much a spring of K lacks, pressed slowly from
///    nothing, to keep what the limit of |f| asks for. w ends linearly between 2 b and 4 b of the contact's path.
///
///        |G τ| <= (e′ − |f| a) / (Δθ · τ̂ + 500 rad/s² T²):   hair that works on the wrist draws on the same tank.
///
/// It holds while the hand accelerates by less than 60 m/s² and the wrist by less than 500 rad/s².
namespace tuft::haptic {

/// Constants of the law.
struct LawOptions {
    DeviceLimits limits;
    double gain = 15;                 ///< G: force on the hand over force of the hair
    double delay = 0;                 ///< s, of the whole loop; see `coupling_for_delay`
    double scale = 1;                 ///< metres of the brush per metre of the arm
    bool restore = false;             ///< step 4
    double hard_friction = 0.2;       ///< Coulomb coefficient of lacquered wood on glaze, assumed
    double most_force = kForceLimit;  ///< N
};

/// Counts along an axis of the device.
struct CountedAxis {
    double lasted = 0;  ///< periods since the last one came
    double before = 0;  ///< periods from the one before to it
    double came = 0;    ///< m/s, |v_c| along the axis then
};

/// The arm in the period before.
struct ArmMotion {
    Vec3 position{0};  ///< x, m
    Vec3 measured{0};  ///< x_c, m
    Vec3 course{0};    ///< v_c, m/s
    std::array<CountedAxis, 3> axes{};
    Quat rotation{1, 0, 0, 0};  ///< q
    Vec3 velocity{0};           ///< v_x, m/s, low-passed
    Vec3 velocity_before{0};    ///< m/s, v_x low-passed once more: 4 ms behind it
};

/// The virtual root of the tuft.
struct RootMotion {
    Vec3 position{0};  ///< y, m
    Vec3 velocity{0};  ///< v, m/s
    Vec3 restored{0};  ///< s, m
};

/// Step 2.
struct Fade {
    Vec3 force{0};   ///< g before the fade, N
    Vec3 offset{0};  ///< o, N
    Vec3 root{0};    ///< m, where that force was solved
    Vec3 arm{0};     ///< m, x when it came
};

/// The forces of the last periods, N.
struct SentForces {
    std::array<Vec3, 16> ring{};  ///< f
    std::size_t n = 0;            ///< sent so far
    std::size_t delay = 0;        ///< periods until a force acts
};

/// Step 6.
struct EnergyTank {
    double energy = 0;      ///< e, J
    double lent = 0;        ///< J, to an empty tank in this contact
    double landed = 0;      ///< m, path of x′ since the contact began
    Vec3 played{0};         ///< x′, m
    Vec3 acted{0};          ///< f₋ of the period before, N
    Vec3 counted_force{0};  ///< f̄, N
};

/// State of the law between two periods.
struct LawState {
    bool started = false;
    ArmMotion arm;
    RootMotion root;
    Fade fade;
    EnergyTank tank;
    SentForces sent;
    Vec3 force{0};       ///< f, N
    Vec3 moment{0};      ///< of hair and handle about the root, N·m, scaled as the force is
    double coupled = 0;  ///< J, in the spring of the coupling and the moving root
    bool free = true;    ///< neither hair nor ferrule touches
};

/// Input of one period.
struct LawInput {
    Vec3 arm{0};                       ///< x_c, m, world
    Quat rotation{1, 0, 0, 0};         ///< q
    Quat axes{1, 0, 0, 0};             ///< turns the axes of the device, along which it counts, into the world
    const HairAnswer* hair = nullptr;  ///< newest answer, or none yet
    double trust = 1;                  ///< of the answer: 1 fresh … 0 too old; scales its force
    double pass = 1;  ///< of the force: 0 on a fault or a pause … 1; scales what leaves, before the tank
};

/// Result of one period.
struct LawOutput {
    Vec3 force{0};         ///< f on the hand, N, world
    Vec3 torque{0};        ///< N·m, world; 0 for an arm without torque
    Vec3 root{0};          ///< y, m, of the next pose to solve
    bool hard = false;     ///< ferrule or handle is on the surface
    bool limited = false;  ///< the tank held the force back
};

/// Begins at an arm that stands at x, in the air.
void restart_law(LawState& state, const Vec3& arm, const Quat& rotation);

/// One period. The first call after construction restarts.
LawOutput step_law(const LawOptions& options, LawState& state, const LawInput& input);

/// K of these options in the world frame, N/m.
double coupling_of(const LawOptions& options);

/// Rotation vector of the turn from `before` to `now`, rad, world frame.
Vec3 turn_between(const Quat& before, const Quat& now);

}  // namespace tuft::haptic
