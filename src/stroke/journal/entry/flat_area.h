#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "stroke/journal/entry/samples.h"

/// \file
/// Flat areas of a drawing. An area is masked, the ink in it is taken away, and an even or graded film is deposited.
/// Part of `Fill`; painting/apply_area.h puts them onto texels.
namespace tuft::stroke {

/// Colour of an area at a parameter of its gradient.
struct AreaStop {
    double at = 0;  ///< parameter, 0–1
    std::string ink;
    double opacity = 1;  ///< part of the ink below that is taken away, 0–1
    double film = -1;    ///< film units; < 0: what a full brush leaves, times the opacity

    bool operator==(const AreaStop&) const = default;
};

/// Where an area ends on the model, at shut lines, openings and edges.
enum class AreaEdges {
    facing,    ///< all that lies before the drawing and faces it, other parts behind an opening too
    cut,       ///< what is connected with the middle of the drawing, over gaps up to `kWidestGap`: it ends as cut at
               ///< steps, openings and edges, and goes on beyond a shut line
    run_over,  ///< as `facing`, and the walls of edges and gaps
};
/// Metres, of a shut line that a drawing passes.
inline constexpr double kWidestGap = 6e-3;

/// Continuation of a gradient beyond its ends (SVG 1.1, 13.2.2).
enum class AreaSpread { pad, reflect, repeat };

/// Parameter t of an area's gradient at a point q = A (x, y, 1) of its unit space.
enum class AreaGradient {
    none,    ///< t = 0
    linear,  ///< t = q.x
    radial,  ///< the circle of radius t about (1 − t) focus passes through q (SVG 1.1, 13.2.3)
    image,   ///< t is the darkness of `FlatArea::image` at q, bilinear between the middles of its pixels
};

/// A picture over the unit square of an area, (0, 0) its upper left corner.
struct AreaImage {
    int width = 0, height = 0;
    std::vector<std::uint8_t> darkness;  ///< 255: dark; rows from the top. [width height]

    bool operator==(const AreaImage&) const = default;
};
inline constexpr int kMaxAreaSide = 1024;  ///< pixels, of a picture

/// Part of a drawing that is read, such as text: all areas of one part stay readable in a mirrored copy.
struct AreaReading {
    std::string part;  ///< name; empty: the area is mirrored
    Vec2 centre{0};    ///< of the part, metres

    bool operator==(const AreaReading&) const = default;
};

/// A closed flat area with an even or a graded film. Lengths in metres, frame of flat samples (x right, y down).
struct FlatArea {
    std::vector<std::vector<Vec2>> rings;  ///< closed: the last point is joined to the first
    bool even_odd = false;                 ///< rule for what the rings enclose; else nonzero
    /// Of what is drawn as lines: their middles, open. A draped line is as wide on the model as it is drawn
    /// (surface/even_lines.h). Empty: a shape of its own.
    std::vector<std::vector<Vec2>> lines = {};
    /// Closed rings (nonzero): what later areas of the drawing cover beside an edge that they share with this one. The
    /// area reaches a texel under them, as printers trap: their edges then show no substrate.
    std::vector<std::vector<Vec2>> under = {};
    Placement placement;
    bool placed = false;  ///< the file gives a placement
    AreaEdges edges = AreaEdges::facing;
    Vec2 low{0}, high{0};  ///< bounds of the drawing that it is part of
    AreaReading reading;
    std::vector<AreaStop> stops;  ///< ascending, at least one
    AreaGradient gradient = AreaGradient::none;
    AreaSpread spread = AreaSpread::pad;
    std::array<double, 6> to_unit{1, 0, 0, 1, 0, 0};  ///< A: q = (a₀ x + a₂ y + a₄, a₁ x + a₃ y + a₅)
    Vec2 focus{0};                                    ///< radial: |focus| < 1
    AreaImage image;                                  ///< image

    bool operator==(const FlatArea&) const = default;
};

inline constexpr std::size_t kMaxAreaPoints = 2'000'000;
inline constexpr std::size_t kMaxAreaStops = 1000;

/// Throws `Error` for points out of range, more than the limits, no stop, and parameters that are no numbers. All
/// points count.
void check_area(const FlatArea& area);

/// Returns t at a flat point, in [0, 1] after the spread. Of a picture the mean over a square of side `width` metres,
/// from at most 8 × 8 points.
double along_area(const FlatArea& area, const Vec2& point, double width = 0);

/// Maps an area by p' = scale (p − centre); `mirrored` then flips x. As `transform_samples`.
void transform_area(FlatArea& area, const Vec2& centre, double scale, bool mirrored = false);

/// Areas as JSON text (flat_area_json.h), and back. Back throws `Error` where it cannot be read.
std::string text_of(const FlatArea& area);
FlatArea area_of_text(const std::string& text);

}  // namespace tuft::stroke
