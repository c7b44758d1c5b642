#pragma once

#include <vector>

#include "contact/contact.h"
#include "footprint/outline/cuts.h"
#include "ink/exchange/contact_nodes.h"
#include "stroke/contact/motion_tracker.h"
#include "stroke/contact/stamp.h"
#include "stroke/contact/tuft_in_hand.h"

namespace tuft::stroke {

struct HairContactOptions {
    double cell = 1e-4;          ///< metres, of footprints
    bool always_closed = false;  ///< what lies there fills the gaps of dry hair, as a pool does
    bool places_nodes = false;   ///< ink differs over the footprint: find the grid of its nodes
    double relief = 0;           ///< metres, rms height of the substrate's grain
};

/// The hair that touches at one pose: from the bent tuft to a footprint, in one closed shape where the hair is wet
/// enough to close its gaps, hair by hair where it is not.
class HairContact {
  public:
    explicit HairContact(const HairContactOptions& options) : options_(options) {}

    /// Makes the stamp of the next pose: its footprint, how far it is single hairs, its grid. Its motion and ink are
    /// the caller's. Splits and merges the tuft's bundles by their wetness. `dt`: seconds since the pose before.
    Stamp make_stamp(TuftInHand& tuft, const contact::Result& contact, const MotionTracker& motion, double dt);

    /// Which cells of the hair touch, parts that sum to one; nodes of the stamp's grid, where they were asked for.
    const ink::ContactCells& cells() const { return cells_; }
    const ink::NodeContact& nodes() const { return nodes_; }
    /// The same summed over the stamps since it was last taken, parts that sum to one.
    ink::ContactCells take_cells_since();
    /// Unit, of the hair on the surface in the contact frame.
    const Vec2& axis() const { return axis_; }
    /// The section's +x is at the end of the patch's width (1) or at its beginning (-1).
    double orientation() const { return orientation_; }
    bool by_hair() const { return by_hair_; }
    /// m² of the outlines of a stamp with gaps; 0: it has none.
    double closed_area() const { return closed_area_; }
    /// Part of the outlines of its hair that `area` (m²) covers; 1 where no single hairs are drawn.
    double coverage(double area) const { return closed_area_ > 0 ? area / closed_area_ : 1; }

  private:
    struct Wetness {
        std::vector<double> of_bundle;
        double mean = 0, lack = 0;  ///< over the bundles; `lack`: mean of what each lacks of 1
    };
    Wetness bundle_wetness(TuftInHand& tuft, const MotionTracker& motion, double stress, double dt);
    void draw_hairs(Stamp& stamp, const TuftInHand& tuft, const contact::Result& contact, const MotionTracker& motion,
                    const Wetness& wetness, std::span<const footprint::Trail> trails,
                    std::span<const footprint::Outline> outlines);
    void place_nodes(Stamp& stamp, const TuftInHand& tuft, std::span<const footprint::Trail> trails,
                     std::span<const footprint::Outline> outlines);

    HairContactOptions options_;
    ink::ContactCells cells_, cells_since_;
    ink::NodeContact nodes_;
    std::vector<double> soaked_;              // wetness of each bundle at its last contact
    double updated_at_ = 0;                   // travel at which wetness and splitting were last updated
    footprint::HairTracks tracks_;            // of the hair that lies there
    std::vector<footprint::Trail> previous_;  // trails of the last stamp by hair, in `previous_frame_`
    Frame previous_frame_;
    bool by_hair_ = false;
    double closed_area_ = 0;
    Vec2 axis_{1, 0};
    double orientation_ = 1;
};

}  // namespace tuft::stroke
