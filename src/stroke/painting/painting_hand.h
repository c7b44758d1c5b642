#pragma once

#include "contact/contact.h"
#include "footprint/cuts.h"
#include "stroke/hand/hand.h"
#include "stroke/hand/resample.h"
#include "stroke/painting/painting.h"
#include "stroke/painting/stamper.h"
#include "stroke/painting/tape.h"
#include "stroke/painting/wet_hand.h"

/// The stroke in work; included by sources of this room only.
namespace tuft::stroke {

/// m² of the patch by its coverage.
double footprint_area(const footprint::Footprint& f);

/// Everything between the hand's samples and the texels.
struct Painting::Hand {
    Stroke stroke;
    const Model* model = nullptr;          // that it is drawn on: the painting's, or the palette
    const ink::Substrate* substrate = nullptr;
    brush::Tuft tuft;
    ink::Ink ink;
    ink::Reservoir reservoir;
    std::string dipped;
    SteadyHand steady;
    contact::Memory memory;
    contact::Options contact_options;
    Resampler resampler;
    Stamper stamper;
    double step = 0, cell = 0;
    std::vector<brush::Pose> poses;
    StrokeReport report;
    ProgressFn progress;   // asked before every stamp whether to go on,
    ProgressFn film_progress;  // and before every step of the film meanwhile, every few hundred tiles of a batch
    double done = 0;       // of the samples
    brush::TuftState state;
    double last_time = 0;
    double speed = 0, travel = 0;  // m/s; metres drawn so far
    std::vector<double> soaked;    // wetness of each bundle where it touched last
    double slid = 0;               // metres that hair went over the surface since it was touched
    Vec2 heading{0};               // unit, of the hair's last motion over it; zero before the first
    Vec3 course{0};  // of the hand over the surface, world: the sum of its last millimetres, but
                     // what it goes by pressing or lifting
    Vec3 went{0};                  // of the hair that touches, likewise over a shorter way
    double lands = 0;              // 0–1: how much of the hand's last motion was pressing or lifting
    footprint::HairTracks tracks;  // of the hair that lies there
    LaidTape tape;                 // that it keeps within
    std::vector<footprint::Trail> lay;  // of the last stamp by hair, in the frame `lay_frame`
    Frame lay_frame;
    ink::Touch touched;            // by the last stamp
    ink::Touch touch;              // of the stamps since the last flush, summed
    double owed = 0, instalment = 0;  // film·m² of the last batch that the reservoir still holds; of it each stamp takes so much
    ink::Touch owed_by;            // of the stamps of that batch
    bool by_hair = false;          // the last stamp has gaps
    double closed_area = 0;        // m², of the last stamp with its gaps; 0: it has none
    double parted = 0;             // travel up to which bundles have parted
    bool mixed = false;            // the tuft holds several inks, or thicker ink on one side
    ink::NodeTouch nodes;          // of the last stamp, with mixed or wet ink
    Vec2 axis{1, 0};               // of the hair on the surface, in the contact frame
    bool moved = false, was_touching = false;
    bool paste = false;            // the ink stands as it is put
    std::vector<double> tines;     // how firmly each bundle lies, over the firmest
    double combed = 0;             // travel up to which they are known
    double turned = 1;             // the section's +x is at the end of the patch's width; -1: at its begin
    std::optional<WetHand> wet;  ///< with wet ink
    Vec3 force{0};  // to the hand
    Vec3 last_position{0};
    Quat last_rotation{1, 0, 0, 0};

    Hand(Stroke s, BrushInHand held, const ink::Ink& i, const Model& on, ink::Canvas& canvas,
         const ink::Substrate& ground, PlanRooms& rooms, double step_, double texel);

    /// Lays down the stamps that were added, and takes their ink from the tuft: hair that is half dry shows every
    /// hundredth of its ink, and gives a batch's evenly over the next.
    void flush();
    /// Takes so much of what is owed.
    void pay(double amount);
    void move_on(const brush::Pose& pose, double dt);
    /// Bending since the last pose mixes what the bundles hold; keeps the tuft as it is now.
    void bend(brush::TuftState now, const brush::Pose& pose);
    /// k = |M| / M_max of the ink's laws.
    double stress(const contact::Result& contact) const;

    /// Lays the grid of mixed ink over the outlines, and the hair on it.
    void place_nodes(Stamp& stamp, std::span<const footprint::Trail> trails,
                     std::span<const footprint::Outline> outlines);
    /// Lays down a stamp of mixed ink. Returns the ink given, film·m².
    double lay_mixed(const Stamp& stamp);

    /// How what hangs on the tuft runs to where it touches.
    ink::Drain drain(const brush::Pose& pose, const Vec3& contact) const;
    /// Lays down a stamp of paste, in which the bundles leave furrows. Returns the ink given less
    /// what was taken, film·m².
    double lay_paste(Stamp& stamp, double stress);
    /// The bundles over the width of the patch.
    std::vector<ink::Tine> comb();

    /// The hair on the surface: `touched`, and the footprint with the gaps that lack of ink leaves.
    Stamp make_stamp(const contact::Result& contact, double dt);
};

}  // namespace tuft::stroke
