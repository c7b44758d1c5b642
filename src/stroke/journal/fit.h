#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "mesh/surface_query.h"
#include "stroke/painting/painting.h"

namespace tuft::stroke {

/// How a stroke whose poses were made on one model lies on another one. Lengths in metres;
/// ways are those of the ferrule while the straight tuft reached the former model.
struct StrokeFit {
    std::uint64_t stroke = 0;
    bool reached = false; ///< the former model was within a tuft's length of the mouth somewhere
    double way = 0;       ///< in all
    double lost = 0;      ///< of it, where the straight tuft does not reach the other model
    double buried = 0;    ///< of it, where the other model's surface lies above the ferrule's mouth
    double depth = 0;     ///< median depth of the straight tip in the former model, of what is neither
    double deeper = 0;    ///< median of how much deeper it lies in the other one; below 0: less deep
};

/// Compares the surfaces along the hair: at each sample rays leave the ferrule's mouth along
/// its axis, one tuft's length to both sides. `length_of` gives a brush's tuft length. Only
/// strokes with poses in space; others are laid on the model anew and fit by themselves.
/// Hidden strokes are left out. Cost: two rays a sample.
std::vector<StrokeFit> compare_fit(const std::vector<Stroke>& strokes, const std::function<double(const std::string& brush)>& length_of,
                                   const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised);

/// Why a stroke does not fit any more, in a sentence for people; "" when it fits: less than a
/// tenth of its way is lost or buried, and its depth changed by less than half of what it was.
std::string misfit_reason(const StrokeFit& fit);

/// A stroke that does not fit another model any more.
struct Misfit {
    std::uint64_t stroke = 0;
    std::string reason;   ///< English, for people
};
/// Of a replay on the other model (its reports) and its fits, in the journal's order: strokes that
/// touch nothing any more, and those for which `misfit_reason` has one.
std::vector<Misfit> find_misfits(const std::vector<StrokeReport>& reports, const std::vector<StrokeFit>& fits);

}  // namespace tuft::stroke
