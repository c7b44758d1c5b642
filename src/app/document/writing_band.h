#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/document/curve.h"
#include "app/document/writing.h"
#include "writer/layout/band.h"
#include "writer/layout/feature_line.h"

/// \file
/// A drawing repeated along a line of the model before it is painted. Called by tools/writing_tool.h. Window thread.
namespace tuft::app {

/// A line on the model and the copies of a drawing on it.
struct WritingBand {
    writer::ModelPath path;
    writer::Band band;
    std::vector<writer::BandPlace> places;
    Vec3 at{0};  ///< metres, the place that the line was looked for at, as options state it
};

/// What a band is laid on.
struct BandSurface {
    const mesh::SurfaceQuery& query;
    writer::FeatureLines& lines;
    std::span<const CurvePoint> curve;  ///< set last with the tool Curve
    double texel = 0;                   ///< metres
};

/// Returns the copies of the drawing on the line that `writing.along` names at the surface point `at` (metres): the
/// feature line nearest to it, the level section through it, or the curve. Precondition: it names one. Throws `Error`
/// where there is no such line.
WritingBand lay_band(const Writing& writing, const BandSurface& surface, const Vec3& at);

/// Returns all copies on the surface, as `preview_lines` returns one; a frame for each where they are too many lines to
/// follow a cursor.
std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query, const Writing& writing,
                                                     const WritingBand& band, std::size_t most = 3000);

/// Returns the copies as journal entries, as `placed_writing` returns one.
PlacedWriting placed_writing(const Writing& writing, const WritingBand& band, const WritingHand& hand);

/// Returns the options of `tuft paint` that paint the same; for a curve without its line.
std::string place_words(const Writing& writing, const WritingBand& band);

}  // namespace tuft::app
