#pragma once

#include <vector>

#include "core/geometry/bounds.h"
#include "stroke/journal/journal.h"
#include "writer/layout/text_layout.h"

/// \file
/// Drawings repeated along a path on a model: ornament bands, stripes along a feature line. Called by `tuft paint
/// --along` and by the studio; the same drawing along the same path gives the same journal.
namespace tuft::writer {

/// Most copies along a path.
inline constexpr int kMostCopies = 1000;

/// Part of a step, to either side of a copy's middle, over which the direction of its path is taken.
inline constexpr double kBandReach = 0.25;

/// How a drawing is to be repeated.
struct BandOptions {
    int repeats = 0;        ///< 0: as many as the path has room for, made to meet
    double width = 0;       ///< metres, of a copy; 0: as it is drawn
    bool mirrored = false;  ///< each copy from left to right
    double texel = 0;       ///< metres, by which the ends of copies that meet are lapped
};

/// A drawing's copies on a path of length L: N of them, L / N apart.
struct Band {
    int repeats = 1;    ///< N
    double step = 0;    ///< metres between middles along the path, L / N
    double scale = 1;   ///< of a copy, times the drawing
    double width = 0;   ///< metres, of a copy
    double height = 0;  ///< metres, of a copy
    double lap = 0;     ///< metres at either end of copies that meet
    bool mirrored = false;
};

/// Closes a path whose ends are less than a hundredth of its length apart.
void close_where_ends_meet(ModelPath& path);

/// Returns the copies of a drawing of this extent (metres) on a path of `length` metres. Without a number N is the
/// number nearest to `length` over the width, and the copies are scaled to meet; with one they meet, too, unless their
/// width is given. Throws `Error` where path or drawing has no length.
Band band_of(double length, const Box& extent, const BandOptions& options);

/// Where a copy lies.
struct BandPlace {
    stroke::Placement placement;  ///< origin on the path, right along it; draped
    double curvature = 0;         ///< 1/m, geodesic curvature of the path there, as `stroke::bend_point` takes it
};
/// Returns the places of all copies. On a closed path the first one lies where the path begins, on an open one half a
/// step from its end. Directions are taken over a quarter of a step to either side.
std::vector<BandPlace> band_places(const ModelPath& path, const Band& band);

/// Returns a line of the drawing as it lies in the frame of a copy's place: moved by −`centre`, scaled, mirrored and
/// bent. For previews.
std::vector<Vec2> line_in_band(const std::vector<Vec2>& line, const Vec2& centre, const Band& band, double curvature);

/// Returns the entries once for each place. Flat traces and areas without a placement of their own, with `all` also
/// those with one, are placed there (`stroke::place_drawing`) about `centre`, lapped and bent by the curvature; their
/// mappings do not change.
std::vector<stroke::JournalEntry> repeat_along(const std::vector<stroke::JournalEntry>& entries,
                                               const std::vector<BandPlace>& places, const Vec2& centre,
                                               const Band& band, bool all);

}  // namespace tuft::writer
