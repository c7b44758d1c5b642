#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "haptic/arm_check.h"
#include "haptic/device/simulated.h"
#include "haptic/hair_solver.h"
#include "haptic/servo.h"

/// \file
/// The loop in virtual time, on one thread. A simulated hand with a simulated arm paints at a place of a model. The
/// report states energies and steps of the force. The tests of `haptic` and `tuft device test` run it. The same options
/// give the same bits.
namespace tuft::haptic {

/// A place on a model where a hand paints.
struct TrialPlace {
    std::string name;
    Frame frame;  ///< on the surface: n outward, m
};

/// Places on a mesh with z up, m. `place_above`: the first hit from above its middle. `place_at_edge`: the sharpest
/// edge, or with `groove` the sharpest groove, that a ray from above meets from there along +x.
TrialPlace place_above(const mesh::SurfaceQuery& surface, std::string name);
TrialPlace place_at_edge(const mesh::SurfaceQuery& surface, std::string name, bool groove = false);

/// What the simulated hand does.
enum class HandMotion { press, press_fast, drag, circles, taps, rocking, rest, hit, slide };
inline constexpr HandMotion kPaintingMotions[] = {HandMotion::press,   HandMotion::press_fast, HandMotion::drag,
                                                  HandMotion::circles, HandMotion::taps,       HandMotion::rocking,
                                                  HandMotion::rest};
std::string_view name_of(HandMotion motion);
/// Whether hair lands at more than 0.3 m/s.
bool is_tap(HandMotion motion);

/// Returns the path of a hand: 1 s in the air, then `motion`. Painting motions press the tuft by 0.25–0.4 of its
/// length. `hit` brings the ferrule down at 0.5 m/s. `slide` draws the ferrule over the surface. `seed` 0: the plain
/// motion; else heading, pace and place vary. With hair of up to 0.2 m the root is sped up by less than 60 m/s² and
/// 500 rad/s², for which the law (law.h) holds.
HandPath hand_path(HandMotion motion, const TrialPlace& place, const brush::Preset& brush, std::uint64_t seed = 0);

/// Options of one trial.
struct TrialOptions {
    LawOptions law;
    SolverOptions solver;
    HandModel hand;
    double delay = 0, jitter = 0;  ///< s, of commands on their way to the motors
    double seconds = 4;
    std::uint64_t seed = 1;
    bool record = false;  ///< fills `TrialReport::forces`, `roots` and `arms`
};

/// Solves of a trial and what they cost.
struct TrialSolves {
    std::size_t count = 0, unconverged = 0;
    /// Evaluations of the potential in one solve, of its values and with derivatives, at most.
    int most_evaluations = 0;
    std::uint64_t evaluations = 0;  ///< of all solves together
    std::vector<float> seconds;     ///< of each
};

/// Extremes over a trial. Energies are the work of the force on the hand along the true path of the arm, not along the
/// measured one. Each contact counts from its own beginning: over an hour the arm's friction would cover any gain.
struct TrialReport {
    double least_energy = 0;       ///< J, port + wrist
    double least_with_arm = 0;     ///< J, port + wrist + losses of the arm
    double largest_step = 0;       ///< N, of |Δf| in a period beyond k_max |Δx|, with hair alone
    double largest_step_hard = 0;  ///< N, the same while ferrule or handle is on the surface, or 10 ms after
    double largest_force = 0;      ///< N
    double deepest = 0;            ///< m, of the arm behind the root while it is held on the surface
    std::size_t periods = 0, limited = 0, contacts = 0;
    TrialSolves solves;
    std::uint64_t hash = 0;    ///< of all forces
    std::vector<Vec3> forces;  ///< N, on the hand, one per period
    std::vector<SolvedPose> roots;
    std::vector<Vec3> arms;  ///< m, where the arm truly was at each of `roots`
    Vec3 last_hair{0};       ///< N, of the hair at the end
};

/// Moves the simulated hand along `path` and returns what happened. Virtual time: the same input gives the same bits.
/// Throws `Cancelled` when the process is interrupted.
TrialReport run_trial(const brush::Tuft& tuft, const mesh::SurfaceQuery& surface, const HandPath& path,
                      const TrialOptions& options);

/// Runs a trial up to `from`, s, where something goes wrong, and returns after how many periods no force leaves any
/// more; -1 where there was none before, or it did not end within 100.
int periods_to_stop(const brush::Tuft& tuft, const mesh::SurfaceQuery& surface, const HandPath& path,
                    const TrialOptions& options, TrialFault fault, double from);

/// Worst of both; counts and hashes added up.
void merge(TrialReport& into, const TrialReport& from);

}  // namespace tuft::haptic
