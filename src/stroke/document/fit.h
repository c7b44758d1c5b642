#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/query/surface_query.h"
#include "stroke/document/document.h"
#include "stroke/journal/model_motion.h"

namespace tuft::stroke {

/// How a stroke that was made on one model lies on another one. Lengths in metres; those of paths
/// are of the ink's path on the former model. The place of a sample's ink is where a flat trace is
/// draped or projected, and where the axis of a holder in space meets the surface.
struct StrokeFit {
    std::uint64_t stroke = 0;
    bool reached = false;        ///< the former model was within a tuft's length of the mouth somewhere
    double way = 0;              ///< in all
    double lost = 0;             ///< of it, where there is no surface for the ink in the other model
    double buried = 0;           ///< of it, where the other model's surface lies above the ferrule's mouth
    double depth = 0;            ///< median depth of the straight tip in the former model, of what is
                                 ///< neither; in space only
    double deeper = 0;           ///< median of how much deeper it lies in the other one; below 0: less deep
    bool flat = false;           ///< laid on the model anew, in the place of the former one
    double moved = 0;            ///< median way of the place of the ink from one model to the other
    double moved_most = 0;       ///< and the longest
    std::optional<double> slid;  ///< median distance from where the ink's place on the former model
                                 ///< went; without a motion: nothing
    double kept = 0;             ///< length of the path where both models have ink, on the former one
    double kept_now = 0;         ///< the same on the other one
    double stretched = 0;        ///< of `kept`, where 5 mm of it are more than a quarter longer or shorter now

    double missing() const { return way > 0 ? (lost + buried) / way : 0; }  ///< part of the ink's path, 0–1
};

/// Why a revised model is too small to be painted on, in a sentence for people; "" where it is not. It is too small
/// where its bounding box has a diagonal less than a quarter of the former one's and less than the length of a tuft
/// that painted: each stamp would reach the whole model, a thousand times the work of the former one, and nothing would
/// fit. Hidden strokes and the palette's are left out.
Message size_fault(const std::vector<JournalEntry>& entries,
                   const std::function<double(const std::string& brush)>& length_of, const mesh::SurfaceQuery& former,
                   const mesh::SurfaceQuery& revised);

/// Compares the surfaces along the hair: at each sample of a stroke in space rays leave the
/// ferrule's mouth along its axis, one tuft's length to both sides; flat strokes are laid on both
/// models. `length_of` gives a brush's tuft length, `motion` how the model moved as a whole. Hidden
/// strokes and the palette's are left out. Cost: two rays a sample, or twice what laying takes.
std::vector<StrokeFit> compare_fit(const std::vector<JournalEntry>& entries,
                                   const std::function<double(const std::string& brush)>& length_of,
                                   const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised,
                                   const std::optional<ModelMotion>& motion = {});

/// Why a stroke does not fit any more, in a sentence for people; "" when it fits. Reported is what
/// shows:
/// - more than a tenth of its path without ink;
/// - in space, a depth changed by more than half of what it was, and by more than 0.2 mm;
/// - its place moved (flat), or left its place on a model that was moved as a whole, by more than 1
/// mm and by more than
///   1 % of its path: as wide as a fine brush's line, more than a mesh of other triangles moves it;
/// - more than a tenth of its path longer or shorter by more than a quarter.
Message mismatch_reason(const StrokeFit& fit);

/// A stroke that does not fit another model any more.
struct StrokeMismatch {
    std::uint64_t stroke = 0;
    Message reason;  ///< for people
};
/// Of a replay on the other model (its reports) and its fits, in the journal's order: strokes that
/// touch nothing any more, and those for which `mismatch_reason` has one.
std::vector<StrokeMismatch> find_mismatches(const std::vector<StrokeReport>& reports,
                                            const std::vector<StrokeFit>& fits);

/// All strokes of a replay on another model together.
struct FitTotal {
    std::size_t strokes = 0, mismatches = 0;
    double moved = 0, moved_most = 0;   ///< metres: median over the strokes, longest
    std::optional<double> slid;         ///< metres: median over the strokes
    double missing = 0, stretched = 0;  ///< parts of the path of all ink, 0–1
};
FitTotal total_of(const std::vector<StrokeFit>& fits, const std::vector<StrokeMismatch>& mismatches);

/// In a sentence: "12 of 40 strokes no longer fit: they lie 20.0 mm from where they lay (31.2 mm at
/// most), 4 % of their ink is missing, 0 % of it is stretched or squeezed by more than a quarter".
Message describe(const FitTotal& total);

}  // namespace tuft::stroke
