#pragma once

#include <array>
#include <vector>

#include "contact/contact.h"
#include "contact/node_contact.h"
#include "haptic/hair_answer.h"

/// \file
/// Hair and ferrule at one pose of the root: the force of the hair, and the bounds that ferrule and handle set to the
/// root. The solver's thread calls it (loop.h), and the trial in virtual time (trial.h). Deterministic.
namespace tuft::haptic {

/// What the hand feels besides hair. Plain data.
struct AddedForces {
    double proximity = 0;     ///< N on the hair's scale, rises over the last millimetre before the hair touches
    double yield_stress = 0;  ///< τ_y, Pa, of paste under the hair
    bool operator==(const AddedForces&) const = default;
};

/// Options of `HairSolver`.
struct SolverOptions {
    contact::Options contact;
    AddedForces added;
    double handle_length = 0.15;  ///< m, from the ferrule's mouth
    double ferrule_wall = 5e-4;   ///< m, by which ferrule and handle are thicker than the tuft's root
};

/// The hair under the hand: a tuft on a surface, bent pose after pose.
class HairSolver {
  public:
    /// `surface` must outlive the object.
    HairSolver(brush::Tuft tuft, const mesh::SurfaceQuery& surface, const SolverOptions& options = {});

    /// Bends the tuft at `pose`. The time since the last one is the difference of their ticks. Never throws for a
    /// finite pose. Cost: that of `contact::step` and up to 10 µs for the ferrule.
    HairAnswer solve(const RootPose& pose);

    /// What the stroke has made of the hair: 0 dry … 1 wet, and ink over capacity.
    void set_ink(double wetness, double ink_left);
    void set_added(const AddedForces& added) { options_.added = added; }
    const AddedForces& added() const { return options_.added; }
    const brush::Tuft& tuft() const { return tuft_; }
    /// The bent tuft of the last solve, for drawing it.
    const brush::TuftState& state() const { return state_; }

  private:
    /// A point of ferrule or handle that must not pass the surface.
    struct Station {
        Vec3 place{0};      // m, in the holder's frame from the root
        double radius = 0;  // m; < 0: `contact::mouth_clearance`
        Vec3 outside{0};    // m, world: where it last was in front of the surface
        Vec3 last{0};       // m, world: where it last was looked for
        double clear = 0;   // m, distance from the surface there, at least
        double side = 1;
    };

    void restart(const RootPose& pose);
    void bound_root(const RootPose& pose, HairAnswer& answer);
    Vec3 paste_drag(const Vec3& velocity) const;

    brush::Tuft tuft_;
    const mesh::SurfaceQuery& surface_;
    SolverOptions options_;
    contact::Memory memory_;
    brush::TuftState state_;
    std::vector<Station> stations_;
    RootPose last_;
    bool started_ = false;
};

}  // namespace tuft::haptic
