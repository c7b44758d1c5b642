#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "brush/preset/preset.h"
#include "brush/state/tuft_state.h"
#include "core/system/recycled.h"

/// \file
/// Interface of the brush models of the source papers. A model is one way to bend the spine of a tuft. `Tuft` holds
/// one where the preset's `spine` names it; `step` (brush/tuft/tuft.h) calls it in place of the rod.
namespace tuft::brush {

/// Input of one step.
struct SpineModelInput {
    Pose pose;  ///< of the ferrule at the end of the step
    /// One for each of `nodes()` in that order, or one for all, or none (free in air).
    std::span<const ContactPlane> planes;
    double dt = 0;       ///< seconds since the last step, finite, >= 0
    double wetness = 1;  ///< 0 dry … 1 wet
};

/// Model of one spine with its sections. It has `segments + 1` nodes, at rest at the arc lengths of `spine_segments`
/// (profile.h), so that node k stands for the same hair in every model. Deterministic: the same calls give the same
/// bits. The laws that every model keeps are in tests/brush/papers_test.cpp.
class SpineModel {
  public:
    virtual ~SpineModel() = default;

    /// The first copy that a thread keeps must not allocate either.
    static void* operator new(std::size_t bytes) { return take_block(bytes); }
    static void operator delete(void* block, std::size_t bytes) { return_block(block, bytes); }

    /// Returns a copy with the whole state: a copy of a `Tuft` is a snapshot.
    virtual std::unique_ptr<SpineModel> clone() const = 0;
    /// Takes the whole state of `other` over without allocating. False, and unchanged: it cannot.
    virtual bool assign(const SpineModel& /*other*/) { return false; }

    /// Returns the nodes of the last step, metres, world, tip first, root last. [segments + 1] Before the first step
    /// these are the nodes of a straight tuft at `Pose{}`.
    virtual Recycled<Vec3> nodes() const = 0;

    /// Moves the ferrule to `input.pose` and bends the tuft against the planes. The caller straightens the model at
    /// the first pose before. Fills of the result: one branch with a section at each of `nodes()`, or several branches
    /// as below; force, moment, root_moment, normal_force, converged, iterations, and of `energy` what the model has.
    /// `touching` and `device_force` are the caller's. Sections have unit, mutually normal e, tangent and m = e ×
    /// tangent, and a, b >= 0; a section cuts the surface where the hair touches. Never throws; the result is finite
    /// and the work bounded.
    ///
    /// Several branches: all but the middle one, index count/2, have equally many sections. The middle one goes on to
    /// the root. Their ink shares sum to 1. `nodes()` stay those of the trunk.
    virtual TuftState step(const SpineModelInput& input) = 0;

    /// Makes the tuft straight at `pose`, without set, split or contact.
    virtual void straighten(const Pose& pose) = 0;

  protected:
    SpineModel() = default;
    SpineModel(const SpineModel&) = default;
    SpineModel& operator=(const SpineModel&) = default;
};

/// Returns the model that `preset.spine` names, straight at `Pose{}`. Null for `rod` and `table`, which live in
/// brush/tuft.
std::unique_ptr<SpineModel> make_spine_model(const Preset& preset);

/// A SpineModel with value semantics: a copy is a clone. Empty: no model.
class SpineModelCopy {
  public:
    SpineModelCopy() = default;
    explicit SpineModelCopy(std::unique_ptr<SpineModel> model) : model_(std::move(model)) {}
    SpineModelCopy(const SpineModelCopy& other) : model_(other.model_ ? other.model_->clone() : nullptr) {}
    SpineModelCopy(SpineModelCopy&&) noexcept = default;
    SpineModelCopy& operator=(const SpineModelCopy& other) {
        if (model_ && other.model_ && (model_ == other.model_ || model_->assign(*other.model_))) return *this;
        return *this = SpineModelCopy(other);
    }
    SpineModelCopy& operator=(SpineModelCopy&&) noexcept = default;

    explicit operator bool() const { return model_ != nullptr; }
    SpineModel* operator->() { return model_.get(); }
    const SpineModel* operator->() const { return model_.get(); }

  private:
    std::unique_ptr<SpineModel> model_;
};

}  // namespace tuft::brush
