#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/query/surface_query.h"
#include "stroke/document/document.h"
#include "stroke/placement/model_motion.h"

/// \file
/// Fit of strokes to a revised model: where their ink lies, and which of them no longer fit. Called by `tuft replay
/// --model` and when the studio opens a project on a revised model.
namespace tuft::stroke {

/// How far the ink of a stroke lies from its former place. Metres.
struct InkDisplacement {
    double median = 0, most = 0;
    std::optional<double> on_model;  ///< median, from its former point moved by the model's motion; none: no motion
};

/// Part of a path where both models have ink. Metres, along the path.
struct CommonPath {
    double former = 0, revised = 0;  ///< its length on each model
    double stretched = 0;            ///< of `former`, where 5 mm became more than a quarter longer or shorter
};

/// How a stroke, or an area of a drawing, made on a former model lies on a revised one. Lengths in metres; path lengths
/// are those of the ink's path on the former model, of an area along its rings. The ink of a sample is where a flat
/// trace is mapped to, and where the axis of a holder in space meets the surface.
struct StrokeFit {
    std::uint64_t stroke = 0;  ///< id of its entry
    bool area = false;         ///< of a drawing
    bool reached = false;      ///< the former model was within a tuft's length of the ferrule's mouth somewhere
    double length = 0;         ///< length of the path
    double lost = 0;           ///< of it, where the revised model has no surface for the ink
    double buried = 0;         ///< of it, where the revised surface lies above the ferrule's mouth
    double depth = 0;          ///< in space: median depth of the unbent tip in the former model, of the rest
    double deeper = 0;         ///< in space: median increase of that depth
    bool flat = false;         ///< a flat stroke, mapped anew onto the revised model
    bool followed = false;     ///< the entry on the revised model is not that on the former one
    InkDisplacement moved;
    CommonPath common;

    /// Part of the path without ink, 0–1.
    double missing() const { return length > 0 ? (lost + buried) / length : 0; }
};

/// Returns why a revised model is too small to be painted on, as a sentence for people; empty where it is not. Too
/// small: the diagonal of its box is less than a quarter of the former one and less than the length of a tuft that
/// painted. Each stamp would then reach the whole model, a thousand times the work, and nothing would fit. `length_of`
/// returns the tuft length of a brush, metres. Hidden strokes and those on the palette do not count.
Message size_fault(const std::vector<JournalEntry>& entries,
                   const std::function<double(const std::string& brush)>& length_of, const mesh::SurfaceQuery& former,
                   const mesh::SurfaceQuery& revised);

/// The same of new strokes, which have no former model. The model is too small where its diagonal is less than a
/// quarter of the drawing's and less than the length of a tuft that paints it. The drawing: all flat strokes, as
/// placed. Strokes in space do not count.
Message size_fault(const std::vector<JournalEntry>& entries,
                   const std::function<double(const std::string& brush)>& length_of, const mesh::SurfaceQuery& model);

/// Returns a doubt about the unit of a revised model, as a sentence for people: its diagonal is less than a quarter or
/// more than four times the former one. Empty where there is none. It may be meant: strokes and areas follow a model
/// that was scaled.
Message size_doubt(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised);

/// The same of new strokes and areas: the drawing's diagonal, as placed, is more than three times the model's.
Message size_doubt(const std::vector<JournalEntry>& entries, const mesh::SurfaceQuery& model);

/// What a journal was made on, and what it comes to lie on. The references must outlive it.
struct Revision {
    const mesh::SurfaceQuery &former, &revised;
    ModelChange change = {};  ///< of the model
};

/// Compares two models along strokes: the entries on the former one, and `followed`, what became of them
/// (`follow_model`; the same entries where they stay), on the revised one. At each sample of a stroke in space, rays
/// from the ferrule's mouth along its axis, one tuft length to both sides, find the surfaces; flat strokes are mapped
/// onto both models, and so are the rings of areas (`ring_samples`, some 20,000 points in all). `length_of` returns the
/// tuft length of a brush, metres. Hidden entries and those on the palette are left out. Cost: two rays per sample, or
/// two mappings. Precondition: as many followed as entries.
std::vector<StrokeFit> compare_fit(const std::vector<JournalEntry>& entries, const std::vector<JournalEntry>& followed,
                                   const std::function<double(const std::string& brush)>& length_of,
                                   const Revision& revision);

/// Returns the rings of an area as a flat trace, points 2 mm apart, farther where that would be more than about `most`.
/// Pressure is 0 at the first point of each ring, else 1.
inline constexpr double kMostRingPoints = 200;
StrokeSamples ring_samples(const FlatArea& area, double most = kMostRingPoints);

/// Returns why a stroke no longer fits, as a sentence for people; empty where it fits. It does not fit if
/// - more than 10 % of its path have no ink, or
/// - in space, its depth changed by more than half and by more than 0.2 mm, or
/// - it moved (flat and not followed, or relative to a model or part that moved) by more than 1 mm and by more than 1 %
///   of its path: the width of a fine brush's line, and more than another triangulation moves it, or
/// - more than 10 % of its path are longer or shorter by more than a quarter.
Message mismatch_reason(const StrokeFit& fit);

/// A stroke, or an area of a drawing, that does not fit a revised model.
struct StrokeMismatch {
    std::uint64_t stroke = 0;  ///< id of its entry
    Message reason;            ///< for people
    bool area = false;         ///< of a drawing
};
/// Returns the mismatches of a replay on the revised model: strokes that touched nothing, and those with a
/// `mismatch_reason`, then areas with one; both in the journal's order.
std::vector<StrokeMismatch> find_mismatches(const std::vector<StrokeReport>& reports,
                                            const std::vector<StrokeFit>& fits);

/// Fit of all strokes and areas of a journal.
struct FitTotal {
    std::size_t strokes = 0, mismatches = 0;  ///< both with the areas
    bool areas = false;                       ///< there are some
    InkDisplacement moved;                    ///< medians over the strokes, and largest
    double missing = 0, stretched = 0;        ///< parts of the path of all strokes, 0–1
};
FitTotal total_of(const std::vector<StrokeFit>& fits, const std::vector<StrokeMismatch>& mismatches);

/// Returns the fit as a sentence: "12 of 40 strokes no longer fit: they lie 20.0 mm from where they lay (31.2 mm at
/// most), 4 % of their ink is missing, 0 % of it is stretched or squeezed by more than a quarter".
Message describe(const FitTotal& total);

}  // namespace tuft::stroke
