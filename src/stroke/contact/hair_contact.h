#pragma once

#include "contact/contact.h"
#include "core/system/recycled.h"
#include "footprint/outline/hair.h"
#include "ink/exchange/contact_nodes.h"
#include "stroke/contact/hair_shape.h"
#include "stroke/contact/hair_tone.h"
#include "stroke/contact/motion_tracker.h"
#include "stroke/contact/stamp.h"
#include "stroke/contact/tuft_in_hand.h"

/// \file
/// From the bent tuft to the footprint of a stamp. Called by `StrokeSession`; deposit models read the cells and nodes
/// of the ink that touches.

namespace tuft::stroke {

/// Options of the footprints of a stroke.
struct HairContactOptions {
    ClosedHairOptions closed;    ///< also gives cells and grain of other footprints
    bool always_closed = false;  ///< ink on the surface, such as a pool, fills the gaps of dry hair
    bool places_nodes = false;   ///< computes the stamp's grid, for ink that varies over the footprint
    bool tones = false;          ///< computes the stamp's film by place across the hair
};

/// The touching hair at one pose. Its footprint is one closed patch where the hair is wet enough to close its gaps,
/// else the sum of its hairs.
class HairContact {
  public:
    explicit HairContact(const HairContactOptions& options) : options_(options) {}
    const HairContactOptions& options() const { return options_; }

    /// Returns the stamp of the next pose with footprint, separation and grid; the caller sets motion and ink. Splits
    /// and merges the tuft's bundles by their wetness. `hair`: of this contact; `dt`: seconds since the pose before.
    Stamp make_stamp(TuftInHand& tuft, const contact::Result& contact, HairShape hair, const MotionTracker& motion,
                     double dt);

    /// Cells of the reservoir that touch, with weights of sum 1; and the nodes of the stamp's grid, with
    /// `places_nodes`.
    const ink::ContactCells& cells() const { return cells_; }
    const ink::NodeContact& nodes() const { return nodes_; }
    /// Returns the cells over all stamps since the last call, with weights of sum 1.
    ink::ContactCells take_cells_since();
    /// Direction of the hair on the surface, unit, contact frame.
    const Vec2& axis() const { return axis_; }
    /// 1: the section's +x is at the end of the patch's width; −1: at its beginning.
    double orientation() const { return orientation_; }
    bool by_hair() const { return by_hair_; }
    /// Area of the outlines of a stamp with gaps, m²; 0: it has none.
    double closed_area() const { return closed_area_; }
    /// Returns the part of its outlines that `area` (m²) covers; 1 for a closed patch.
    double coverage(double area) const { return closed_area_ > 0 ? area / closed_area_ : 1; }

  private:
    struct Wetness {
        Recycled<double> of_bundle;
        double mean = 0, lack = 0;  ///< over the bundles; `lack`: mean of max(0, 1 − wetness)
    };
    /// Draws the footprint of a tuft with a geometry of its own, or of foam.
    void draw_shape(Stamp& stamp, const TuftInHand& tuft, const footprint::TouchingHair& hair,
                    const contact::Result& contact, const MotionTracker& motion, const Wetness& wetness);
    Wetness bundle_wetness(TuftInHand& tuft, const MotionTracker& motion, double stress, double dt);
    /// Draws the footprint hair by hair.
    void draw_hairs(Stamp& stamp, const footprint::TouchingHair& hair, const contact::Result& contact,
                    const MotionTracker& motion, const Wetness& wetness);
    /// Sets what part of each cell of the bundles touches, and adds it to what touched since it was taken.
    void find_cells(const TuftInHand& tuft, const contact::Result& contact, std::span<const footprint::Trail> trails);
    /// Sets the stamp's film by place across the hair, by the part of it that is closed.
    void add_tone(Stamp& stamp, const TuftInHand& tuft, const footprint::TouchingHair& hair, const HairShape& shape,
                  const contact::Result& contact, const MotionTracker& motion);
    /// Computes the grid of the stamp and what hair touches at its nodes.
    void place_nodes(Stamp& stamp, const TuftInHand& tuft, const footprint::TouchingHair& hair,
                     const contact::Result& contact);

    HairContactOptions options_;
    ink::ContactCells cells_, cells_since_;
    ink::NodeContact nodes_;
    Recycled<double> soaked_;              // wetness of each bundle at its last contact
    double updated_at_ = 0;                // travel at which wetness and splitting were last updated
    footprint::HairTracks tracks_;         // of the hair on the surface
    Recycled<footprint::Trail> previous_;  // trails of the last stamp by hair, in `previous_frame_`
    Frame previous_frame_;
    Recycled<signed char> sides_;  // see footprint::keep_sides
    HairTone tone_;                // with `tones`
    bool by_hair_ = false;
    double closed_area_ = 0;
    Vec2 axis_{1, 0};
    double orientation_ = 1;
};

}  // namespace tuft::stroke
