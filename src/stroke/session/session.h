#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "stroke/deposit/deposit_model.h"
#include "stroke/gesture/hand.h"
#include "stroke/gesture/resample.h"
#include "stroke/journal/entry.h"
#include "stroke/session/report.h"
#include "stroke/surface/surface_stencil.h"

namespace tuft::stroke {

/// What a stroke is painted with and onto. What is referred to must outlive the session.
struct SessionInput {
    PaintStroke stroke;  ///< settings and stencil; its samples may still be empty
    BrushInHand brush;   ///< as the stroke begins
    ink::Ink ink;        ///< that the brush was dipped into
    const Model& model;
    const ink::Substrate& substrate;
    ink::Canvas& canvas;               ///< of the stroke's layer
    const MaskTexels* mask = nullptr;  ///< what may be changed; null: everything
    WetFilmInUse wet;                  ///< a film for strokes with wet ink
    PlanScratchPool& scratch;
    SeamLinksFn seams;  ///< of the model; asked for at most once, at the end
    bool record_forces = false;
};

/// A finished stroke.
struct SessionResult {
    StrokeReport report;
    BrushInHand brush;                      ///< as the stroke left it
    std::vector<ink::TileSnapshot> before;  ///< the tiles that it wrote to as they were, by slot
};

/// Metres between two poses of a stroke with this ink on a model of this texel size.
double pose_spacing(const PaintStroke& stroke, const ink::Ink& ink, double texel);

/// One stroke, from pen down to pen up:
///
///     sample → resample → contact → brush → footprint → deposit
///
/// Poses of a hand or a replay go in, texels of one layer change. The poses of a flat stroke are those of its whole
/// prepared gesture; poses in space are smoothed and stabilised here, as they come. The texels are the same whether the
/// poses come one by one or all at once, and for any number of threads.
class StrokeSession {
  public:
    explicit StrokeSession(SessionInput input);
    StrokeSession(const StrokeSession&) = delete;
    StrokeSession& operator=(const StrokeSession&) = delete;

    /// Asked before every stamp whether to go on, and between the steps of long ones; a stop throws `Cancelled`.
    void set_progress(ProgressFn progress) { progress_ = std::move(progress); }
    /// Throws `Error` where these poses, which are all of the stroke's, are a longer path than is painted.
    void check_length(std::span<const brush::Pose> poses) const;
    /// Paints on. `done`: part of the stroke that is reported as done.
    void advance(std::span<const brush::Pose> poses, double done = 0);
    /// The first `poses` of those to come set the brush down; the stroke's own samples come after them.
    void begin_with_set_down(std::size_t poses) { forces_.before_first = poses; }
    /// Poses of a hand in space: kept as samples of the stroke, then painted.
    void extend(std::span<const brush::Pose> poses);
    /// Paints what is left and ends the stroke.
    SessionResult finish();
    /// The tiles that were written to so far as they were, by slot: to take the stroke back.
    std::vector<ink::TileSnapshot> take_snapshots() { return target_.take_snapshots(); }

    const PaintStroke& stroke() const { return input_.stroke; }
    /// The bent tuft at the last pose.
    const brush::TuftState& tuft() const { return tuft_.state; }
    /// What a haptic device shall give at the last pose, newtons.
    const Vec3& device_force() const { return contact_.device_force; }

  private:
    /// From samples to even poses.
    struct Path {
        GestureFilter steady;
        Resampler resampler;
        std::vector<brush::Pose> poses;  // not painted yet
        double time = 0;                 // of the last pose painted
        bool started = false;
    };
    struct ContactState {
        contact::Memory memory;
        contact::Options options;
        Vec3 device_force{0};
    };
    /// What is recorded of the forces, where it is asked for.
    struct ForceLog {
        std::vector<brush::Pose> samples;  // as they were resampled
        std::vector<ForceRecord> poses;    // at every pose of the resampled path
        std::size_t before_first = 0;      // samples before the stroke's own
    };
    ResampleOptions path_options() const;
    std::unique_ptr<DepositModel> make_deposit();
    std::vector<ForceRecord> forces_at_samples() const;
    void paint_poses();
    void step(const brush::Pose& pose);
    contact::Result bend_on_surface(const brush::Pose& pose, double dt);
    void set_motion(Stamp& stamp, const ContactMotion& moved, double area) const;
    void set_ink(Stamp& stamp, double area) const;
    void note_dryness(double film, double displacement);

    SessionInput input_;
    bool mixed_ = false;  // the tuft holds several inks, or thicker ink on one side
    double spacing_ = 0;  // metres between poses
    TuftInHand tuft_;
    Path path_;
    ContactState contact_;
    MotionTracker motion_;
    HairContact hair_;
    SurfaceStencil stencil_;
    StampTarget target_;
    std::unique_ptr<DepositModel> deposit_;
    ForceLog forces_;
    StrokeReport report_;
    ProgressFn progress_;
    double done_ = 0;                       // part of the stroke
    double wet_from_ = 0;                   // metres of the hand's path up to the last stamp that lacked ink
    std::optional<ink::Reservoir> refill_;  // what the tuft holds before every pose; none: it runs dry
};

}  // namespace tuft::stroke
