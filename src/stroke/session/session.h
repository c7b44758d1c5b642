#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "stroke/deposit/deposit_model.h"
#include "stroke/gesture/hand.h"
#include "stroke/gesture/resample.h"
#include "stroke/journal/entry/entry.h"
#include "stroke/session/forecast.h"
#include "stroke/session/report.h"
#include "stroke/surface/surface_stencil.h"

/// \file
/// One stroke, from pen down to pen up. `Document` makes a session for each stroke.

namespace tuft::stroke {

/// What a stroke is painted with and onto. All that is referred to must outlive the session.
struct SessionInput {
    PaintStroke stroke;  ///< settings and stencil; its samples may still be empty
    BrushInHand brush;   ///< as the stroke begins
    ink::Ink ink;        ///< dipped into
    const Model& model;
    const mesh::SurfaceQuery& surface;  ///< that the brush touches
    const ink::Substrate& substrate;
    ink::Canvas& canvas;                            ///< of the stroke's layer
    const MaskTexels* mask = nullptr;               ///< texels that may change; null: all
    const ink::SubstrateMap* substrates = nullptr;  ///< of the model's parts; null: `substrate` everywhere
    const TilePlan* plan = nullptr;  ///< tiles that may be used, or the session throws `OutsideTiles`; null: all
    WetFilmInUse wet;                ///< for strokes with wet ink
    PlanScratchPool& scratch;
    SeamLinksFn seams;           ///< of the model; called at most once, at the end
    bool record_forces = false;  ///< fills `StrokeReport::forces`
};

/// A finished stroke.
struct SessionResult {
    StrokeReport report;
    BrushInHand brush;                      ///< after the stroke
    std::vector<ink::TileSnapshot> before;  ///< tiles that it wrote to, before the stroke, ascending by slot
};

/// Metres between two poses of a stroke with this brush and ink on a model of this texel size. The unit of the stroke's
/// spacing is a texel, or for a wide brush a 128th of the tuft's width: over as short a path its footprint hardly
/// changes, and each stamp is swept on from the one before.
double pose_spacing(const PaintStroke& stroke, const brush::Preset& preset, const ink::Ink& ink, double texel);

/// Paints one stroke:
///
///     sample → resample → contact → brush → footprint → deposit
///
/// Poses go in, texels of one layer change. Poses of a flat stroke are those of its prepared gesture (`hand_path`);
/// poses in space are smoothed and stabilised here. The bits are the same for poses one by one or all at once, and for
/// any number of threads.
class StrokeSession {
  public:
    explicit StrokeSession(SessionInput input);
    StrokeSession(const StrokeSession&) = delete;
    StrokeSession& operator=(const StrokeSession&) = delete;

    /// Called before every stamp, and between steps of long ones; false stops by `Cancelled`.
    void set_progress(ProgressFn progress) { progress_.ask = std::move(progress); }
    /// Throws `Error` where these poses, which are all of the stroke's, are a longer path than is painted.
    void check_length(std::span<const brush::Pose> poses) const;
    /// Returns a forecast of the stroke along all of its poses, not computed yet, or null where its brush allows none.
    /// Before the first `advance`; safe beside other sessions.
    std::unique_ptr<StrokeForecast> forecast(std::span<const brush::Pose> poses) const;
    /// Takes a forecast of the poses that come. The bits are the same as without.
    void use(std::unique_ptr<StrokeForecast> forecast) { contact_.forecast = std::move(forecast); }
    /// Lets another thread compute bending and contact of the poses that come by `extend`, ahead of their ink. The bits
    /// are the same as without. Before the first `extend`.
    void forecast_hand();
    /// Paints the next poses. `done`: part of the stroke to be reported, 0–1.
    void advance(std::span<const brush::Pose> poses, double done = 0);
    /// Sets the part of the path that comes next, for the plan of tiles.
    void set_part(std::uint32_t part) { target_.set_part(part); }
    /// Declares that the first `poses` set the brush down; the stroke's own samples come after them.
    void begin_with_set_down(std::size_t poses) { forces_.before_first = poses; }
    /// Appends poses of a hand in space to the stroke's samples and paints them. Calls `painted` after every few
    /// stamps.
    void extend(std::span<const brush::Pose> poses, const std::function<void()>& painted = {});
    /// Paints the remaining poses and ends the stroke.
    SessionResult finish();
    /// Returns the tiles written to so far as they were before, ascending by slot, to take the stroke back.
    std::vector<ink::TileSnapshot> take_snapshots() { return target_.take_snapshots(); }

    const PaintStroke& stroke() const { return input_.stroke; }
    /// The bent tuft at the last pose, for drawing it.
    const brush::TuftState& tuft() const { return tuft_.state; }
    /// The brush itself; its pose is the last one.
    const brush::Tuft& brush() const { return tuft_.brush.tuft; }
    /// Force for a haptic device at the last pose, newtons, world frame.
    const Vec3& device_force() const { return contact_.device_force; }

  private:
    /// From samples to even poses.
    struct Path {
        explicit Path(const ResampleOptions& options) : spacing(options.step), resampler(options) {}

        double spacing;  // metres between poses
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
        std::unique_ptr<StrokeForecast> forecast;
        bool follows = false;  // the forecast gets the poses as they come
        HairShape hair;        // at the last pose that touched
        LastHair last;
    };
    /// What is recorded of the forces, where it is asked for.
    struct ForceLog {
        std::vector<brush::Pose> samples;  // as they were resampled
        std::vector<ForceRecord> poses;    // at every pose of the resampled path
        std::size_t before_first = 0;      // samples before the stroke's own
    };
    struct Progress {
        ProgressFn ask;
        double done = 0;  // part of the stroke

        bool go_on() const { return !ask || ask("painting", done); }
    };
    bool holds_mixed_ink() const;
    ResampleOptions path_options() const;
    std::unique_ptr<DepositModel> make_deposit();
    std::vector<ForceRecord> forces_at_samples() const;
    brush::Pose next_pose(Path& path, const brush::Pose& pose) const;
    void resample(std::span<const brush::Pose> poses);
    void paint_poses(const std::function<void()>& painted = {});
    void step(const brush::Pose& pose);
    contact::Result bend_on_surface(const brush::Pose& pose, double dt);
    contact::Result next_contact(const brush::Pose& pose, double dt);
    void leave_forecast();
    void set_motion(Stamp& stamp, const ContactMotion& moved, double area) const;
    void set_ink(Stamp& stamp, double area) const;
    ink::DepositParams deposit_from(const ink::Reservoir& tuft, const Stamp& stamp, double area) const;
    void note_dryness(const Stamp& stamp, double area, double closed, double displacement);

    SessionInput input_;
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
    Progress progress_;
    double wet_from_ = 0;  // metres of the hand's path up to the last stamp that lacked ink
    ink::Reservoir ink_at_start_;
    std::optional<ink::Reservoir> refill_;  // what the tuft holds before every pose; none: it runs dry
};

}  // namespace tuft::stroke
