#pragma once

#include <span>
#include <vector>

#include "brush/tuft/tuft_state.h"
#include "brush/tuft/upright_hair.h"
#include "footprint/outline/outline.h"

/// The tuft's sections seen from the surface they touch: what outlines and hair are made of.
namespace tuft::footprint {

/// A section seen from the surface: everything in the stamp's (u, v) and height over it.
struct Cut {
    Vec2 centre{0};       ///< metres, foot of the section's centre
    double z = 0;         ///< metres, height of the centre
    double a = 0, b = 0;  ///< metres, semi-axes with the film
    Vec3 e{1, 0, 0};      ///< unit axes: (u, v, height)
    Vec3 m{0, 0, 1};

    double half_height() const { return std::sqrt(a * a * e.z * e.z + b * b * m.z * m.z); }
    double overlap() const { return half_height() - z; }
    /// Point of the ellipse at ω, and of its inside.
    Vec2 at(double cos_w, double sin_w) const { return centre + a * cos_w * Vec2(e) + b * sin_w * Vec2(m); }
};

/// A stretch of one branch that touches the surface, from its tip side to its root side.
struct Trail {
    int branch = 0;             ///< of the tuft
    std::vector<Cut> cuts;      ///< close together at both ends
    std::vector<double> along;  ///< place of each cut along the hair, part of the length from the root
    std::size_t trunk = 0;      ///< from this cut on it is the whole tuft, not the sub-spine
};

/// The stretches that touch, each cut into sections; see `outline` for the arguments.
/// `length` is the tuft's, metres.
std::vector<Trail> trails(const brush::TuftState& tuft, const Frame& frame, std::span<const NodePlanes> planes,
                          double length, double film);

/// Where the hair of a dry tuft lies on the surface: half widths of the tuft by place on the track that its hair
/// is drawn along, place = slid − along · length, metres. Friction holds what lies there, so hair follows in the track
/// of the hair before it, towards the root, and is neither swept aside nor drawn together while the tuft is pressed and
/// lifted. The way is the hair's, not the hand's: lifted, it straightens and goes on to its point where the hand
/// stands.
struct HairTracks {
    struct Track {
        long long first = 0;       ///< number of the place of width[0]
        std::vector<float> width;  ///< metres; negative: no hair has lain there yet
        double passed = 0;         ///< the place up to which the widest sections have come, on the mean, metres
        double passing = -1;       ///< its half width there; negative: nowhere yet
    };
    std::vector<Track> tracks;  ///< of each branch two: its sub-spine, the trunk
};

/// Spreads a tuft that no water holds to a point: hair that lies on the surface has the width that the tuft had
/// where it is widest as that passed the place, as far as `amount` (0–1) goes, and lies as much flatter. `slid`:
/// metres that hair went over the surface since the touch that `tracks` began with. A steady drag is as wide up to its
/// tip; a tuft pressed straight down lies as it came; one that is lifted takes its stiff hair with it, which leaves it
/// by a slope of 0.35 at most. `length` is the tuft's, metres.
void spread_trails(std::vector<Trail>& trails, HairTracks& tracks, double slid, double length, double amount);

/// Hair round the foot of the axis: goes on from the widest section by a straight taper to where the axis meets
/// the surface, and ends round there, as far as `foot.share` goes. Without it the point, which touches first and
/// then slides aside to where the tuft lies, would leave a spur. For a tuft in one cluster.
void cover_upright_hair(std::vector<Trail>& trails, const brush::UprightHair& foot, const Frame& frame, double film);

/// The outline of a trail; without points when it is too small for one.
Outline outline_of(const Trail& trail, int points);

}  // namespace tuft::footprint
