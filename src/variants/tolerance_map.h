#pragma once

#include <string>
#include <vector>

#include "render/picture/picture.h"
#include "stroke/surface/model.h"
#include "variants/result.h"

/// \file
/// How far a decoration moves under the spread of hands and placements: statistics over the samples of a tolerance, per
/// texel and as a whole, and pictures of them on the model.
namespace tuft::variants {

/// Figures of the whole decoration over all samples. Areas in mm², lengths in mm.
struct MoveFigures {
    std::size_t samples = 0;
    double planned_mm2 = 0;  ///< painted as planned
    double always_mm2 = 0;   ///< painted in at least 95 % of the samples
    double ever_mm2 = 0;     ///< painted in more than 5 % of them
    double overlap = 1;      ///< mean of (area painted in both) / (area painted in either) of sample and plan
    double rms_mm = 0;       ///< root mean square distance of a place of the drawing from where it was planned
    double most_95_mm = 0;   ///< that 95 % of these distances are below
    double most_mm = 0;      ///< the largest of them
};

/// Collects samples of one decoration on one model. `model` must outlive it.
class ToleranceMap {
  public:
    /// Throws `Error` for a coverage of another model or atlas.
    ToleranceMap(const stroke::Model& model, Coverage planned);

    /// Adds a sample. Throws `Error` for one of another model or of other strokes.
    void add(const Coverage& sample);

    MoveFigures figures() const;

    /// Returns the box of the places of the drawing, as planned.
    Box box() const;

    /// Part of the samples in which each texel is painted, [256 n_slots].
    std::vector<float> probability() const;
    /// Root mean square displacement of the place of the drawing that is nearest to each texel, metres, [256 n_slots];
    /// 0 where no sample paints.
    std::vector<float> displacement() const;

  private:
    double overlap_with_plan(const Coverage& sample) const;

    const stroke::Model& model_;
    Coverage planned_;
    std::size_t n_ = 0;
    std::vector<std::uint16_t> count_;  // [256 n_slots] samples that paint the texel
    std::vector<double> squares_;       // [feet] sum of squared distances, m²
    std::vector<float> distances_;      // m, of all samples
    double overlap_ = 0;                // sum
};

/// What a picture of a map shows.
struct MapPicture {
    std::string title;
    std::string unit;                ///< of the scale, such as "mm"
    double lowest = 0, highest = 1;  ///< of the scale
    std::vector<float> values;       ///< [256 n_slots] on that scale; NaN: bare
    Vec3f body{0.8f};                ///< linear colour of the bare model
    std::vector<double> view_deg;    ///< [2] azimuth and elevation
    Box around;                      ///< metres, to look at; empty: the whole model
    int width = 960, height = 720;   ///< pixels; 480 x 360 holds the scale
};

/// Draws values of texels on the model by colour, with their scale at the right.
render::Image draw_map(const stroke::Model& model, const MapPicture& picture, const ProgressFn& progress = {});

}  // namespace tuft::variants
