#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "brush/state/tuft_state.h"
#include "brush/tuft/upright_hair.h"
#include "core/system/recycled.h"
#include "footprint/outline/outline.h"

/// \file
/// Sections of the tuft projected onto the touched surface: input of the outlines and of the single hairs. Called
/// by `stroke` for every stamp.
namespace tuft::footprint {

/// A section in the stamp's coordinates (u, v) and its height over the surface.
struct Cut {
    Vec2 centre{0};       ///< metres, projection of the section's centre
    double z = 0;         ///< metres, height of the centre
    double a = 0, b = 0;  ///< metres, semi-axes with the film
    Vec3 e{1, 0, 0};      ///< unit axes: (u, v, height)
    Vec3 m{0, 0, 1};
    Vec2 turn{1, 0};  ///< where a strip's broad side is, see brush::Section
    /// Metres, (u, v), along the hair: by how much a strip between spines of other lengths goes aslant and bends to its
    /// edges, see `bent`.
    Vec2 slant{0}, bow{0};
    Vec2 drop{0};          ///< metres, (u, v), by how much the free edge of a toe lies further back than that
    double free_side = 1;  ///< of that edge: 1 at +broad, −1 at −broad
    /// How far a strip touches from its middle towards −broad and +broad, over its half width there. Negative where all
    /// that touches lies beyond the middle.
    Vec2 reach{1, 1};
    /// Metres, (u, v), along the hair: by how much that ends of `reach` towards −broad and +broad lie further ahead.
    /// Hair of a toe that is about to leave the surface stands over the foot of its unbent tip.
    Vec2 ahead_lo{0}, ahead_hi{0};

    double half_height() const { return std::sqrt(a * a * e.z * e.z + b * b * m.z * m.z); }
    double overlap() const { return half_height() - z; }
    /// Point of the ellipse at ω, and of its inside.
    Vec2 at(double cos_w, double sin_w) const { return centre + a * cos_w * Vec2(e) + b * sin_w * Vec2(m); }
    /// Axes of a strip's hair, metres: of a place (x, y) in it, see brush::in_branch, the point is
    /// centre + x broad + y thick.
    Vec3 broad() const { return turn.x * (a * e) + turn.y * (b * m); }
    Vec3 thick() const { return turn.x * (b * m) - turn.y * (a * e); }
    /// How far along the hair the place x of a strip's section lies from its broad axis: s slant + (1 − s²) bow, where
    /// s is −1 and 1 at its edges. The drop ends along the hair, as an ellipse does.
    Vec2 bent(double x) const {
        const double s = std::clamp(x / kStripChord, -1.0, 1.0);
        const Vec2 spline = s * slant + (1 - s * s) * bow;
        return drop == Vec2{0} ? spline : spline + drop_part(s * free_side) * drop;
    }
    /// By how much the place x lies ahead for the ends of `reach`.
    Vec2 ahead(double x) const {
        const double end = kStripChord * (x < 0 ? reach.x : reach.y);
        const double part = end > 1e-9 ? std::min(std::abs(x) / end, 1.0) : 0;
        return part * part * (x < 0 ? ahead_lo : ahead_hi);
    }
    bool has_ahead() const { return ahead_lo != Vec2{0} || ahead_hi != Vec2{0}; }
    bool is_bent() const { return slant != Vec2{0} || bow != Vec2{0} || drop != Vec2{0} || has_ahead(); }
    /// Part of the drop at s, counted towards the free edge.
    static double drop_part(double s) {
        const double from_inner = 0.5 * (1 + s);
        return 1 - std::sqrt(std::max(0.0, 1 - from_inner * from_inner * from_inner));
    }

    static constexpr double kStripChord = 0.8862269254527580;  ///< √π/2, see brush::in_branch
};

/// Half axes of an ellipse of hair, metres, and the turn of its broad side as in `brush::Section`.
struct EllipseAxes {
    Vec3 e{0}, m{0};
    Vec2 turn{1, 0};
};

/// Returns the axes of the ellipse p(ω) = cos ω · broad + sin ω · thick, of its four turns the one nearest to `turn`.
EllipseAxes ellipse_of(const Vec3& broad, const Vec3& thick, const Vec2& turn);

/// The section at the part f of the way between two, linear in all that it has.
Cut cut_between(const Cut& p, const Cut& q, double f);

/// Of each cut of a trail, by how much the gap to a neighbouring branch is wider than ink bridges, metres; see
/// brush::Opening.
struct TrailOpening {
    int branch = 0;
    Recycled<double> width;
};

/// A part of one branch that touches the surface, from tip side to root side.
struct Trail {
    int branch = 0;                   ///< of the tuft
    Recycled<Cut> cuts;               ///< close together at both ends
    Recycled<double> along;           ///< position of each cut along the hair, fraction of the length from the root
    std::size_t trunk = 0;            ///< index of the first cut of the whole tuft, after those of the sub-spine
    double length = 1;                ///< of the branch's hair over the tuft's
    bool strip = false;               ///< a spine of a row: its hair fills a rectangle, not a disc
    Recycled<Vec2> corners;           ///< of that strip, see brush::Branch
    double edge_short = 0;            ///< metres, see brush::Branch
    double pressed = 0;               ///< metres of the unbent tip below the surface at the tip
    Vec2 foot{0};                     ///< metres, (u, v), of the unbent tip
    Recycled<TrailOpening> openings;  ///< to neighbours that follow in brush::TuftState::openings

    /// Half the thickness of the hair at x in [−1, 1] of a section, over b.
    double chord(double x) const { return strip ? kStripChord : std::sqrt(std::max(0.0, 1 - x * x)); }

    static constexpr double kStripChord = Cut::kStripChord;
};

/// Part of a trail.
struct TrailPart {
    const Trail& trail;              ///< of which it is a part
    std::size_t begin = 0, end = 0;  ///< cuts [begin, end)
};

/// Returns the touching parts of all branches, cut into sections; see `outlines_of` (outline.h) for the arguments.
/// `length` is the tuft's, metres. Between two spines of a row the underside is linear at equal distances from the
/// ferrule, between spines of one length at rest at equal parts of their hair: where one touches by o > 0 and the other
/// is o' above the surface, what touches ends at o / (o + o') of the way. So a row that lands or leaves spine by spine
/// goes out evenly to its sides (`Cut::reach`).
Recycled<Trail> find_trails(const brush::TuftState& tuft, const Frame& frame, std::span<const NodePlanes> planes,
                            double length, double film);

/// Half-widths of a dry tuft along the track of its hair, at position = slid − along · length, metres. Friction
/// holds hair on the surface. Hair therefore follows the track of the hair before it, towards the root; pressing
/// and lifting neither spreads nor closes it. The track is the hair's, not the hand's: lifted hair straightens and
/// advances to its point below the hand.
struct HairTracks {
    /// Widths of one branch.
    struct Track {
        long long first = 0;      ///< index of the position of width[0]
        Recycled<float> width;    ///< metres; negative: no hair yet
        double front = 0;         ///< mean position that the widest sections have reached, metres
        double front_width = -1;  ///< half-width there, metres; negative: none yet
    };
    Recycled<Track> tracks;  ///< two per branch: sub-spine, trunk
};

/// Position and share of the hair that `spread_trails` spreads.
struct SpreadOptions {
    double slid = 0;    ///< metres, displacement of the hair since the first touch of its tracks
    double length = 0;  ///< metres, of the tuft
    double amount = 1;  ///< 0: no change; 1: hair on the surface has the width of its track
};

/// Widens the trails of a dry tuft. Hair on the surface takes the width of the widest part of the tuft at the time it
/// passed that position, and is flattened accordingly. A steady drag has the same width up to its tip. A tuft pressed
/// straight down does not change. A lifted tuft narrows with a slope of at most 0.35.
void spread_trails(Recycled<Trail>& trails, HairTracks& tracks, const SpreadOptions& options);

/// Narrows the sections of trails to `part` of their width, 0–1, at constant area: hair that is drawn across itself
/// draws together behind its point.
void gather_trails(Recycled<Trail>& trails, double part);

/// Spreads the sections of spines of a row as far as midway to their neighbours, flat on the surface and at constant
/// area. Hair that is set between two spines lies between them: its edge is at X = (F_k + F_{k+1}) / 2, taken at equal
/// parts of what touches. A section turned by half a turn is spread as the same hair is. A row that stands aslant to
/// its hair so keeps one edge. To three times their width at most. Spines that differ in length widen only, along their
/// own broad sides. Along the hair the ends of the strips lie on the quadratic B-spline of the spines: from midway to
/// midway, M₋, F_k, M₊ the control points of each, so that the toe of a filbert is one smooth curve. At
/// the free edge of an outermost strip of a toe the hair ends earlier, by `Trail::edge_short`. Where less than that
/// touches, the edge is still in the air.
void fill_rows(Recycled<Trail>& trails);

/// Adds the upright hair round the foot of the axis, by `foot.share`: a straight taper from the widest section to
/// the axis' foot, with a round end. Without it the point, which touches first and then slides aside, leaves a
/// spur. For an unsplit tuft.
void cover_upright_hair(Recycled<Trail>& trails, const brush::UprightHair& foot, const Frame& frame, double film);

/// Returns the outline of a trail; without points when the trail is too small.
Outline outline_of(const Trail& trail, int points);

/// Returns the outlines whose union is the contact patch, one for each trail. Where ink joins spines of a ferrule,
/// there is also one for what lies between two of them (in a ring: three), at equal parts of their hair. A row has one
/// more, over the heels of all that are joined. `before`: of `leapt_trails`; what leapt has an outline of all that it
/// passed over.
Recycled<Outline> outlines_of(std::span<const Trail> trails, int points, std::span<const Trail> before = {});

/// Returns the trails of the pose before in the frame of `trails`, where a patch leapt: from pose to pose, apart from
/// the motion of the hand, a part of it moved by more than 0.15 of its own extent in that direction. The edge of hair
/// that stands touches in a line that slips away by millimetres for a tenth of a millimetre of press. Empty where none
/// leapt. `frame_before`: of `before`; `hand`: displacement of the hand, metres, (u, v) of `frame`.
Recycled<Trail> leapt_trails(std::span<const Trail> trails, const Frame& frame, std::span<const Trail> before,
                             const Frame& frame_before, const Vec2& hand);

/// Returns trails between those of the pose before, `before` of `leapt_trails`, and `trails`, pose by pose, none of
/// which leaps to the next: where hair leaves a mark each, all that it passed over. Linear in the sections at equal
/// places of a trail.
Recycled<Trail> trails_passed(std::span<const Trail> trails, std::span<const Trail> before);

}  // namespace tuft::footprint
