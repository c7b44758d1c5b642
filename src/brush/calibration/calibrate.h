#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brush/calibration/sweep.h"
#include "core/system/progress.h"

/// \file
/// Fit of a brush's constants to a measured sweep, with what the sweep says about each of them. Called by `tuft brush
/// calibrate`.
///
/// The fit is the maximum of the posterior density. Each constant has a prior: a normal density of its logarithm, from
/// the shipped brushes and from measured hair, within bounds that the material sets. With z the constants in units of
/// the prior's standard deviation, and s the repeatability of a column,
///
///     F(z) = Σ ((model − measured) / s)² + Σ z²
///
/// is minimised. What the measured lines do not determine stays where the prior has it.
///
/// Method: F at points spread evenly over the prior (Roberts' additive recurrence), then least squares by Gauss and
/// Newton with Marquardt's damping from the best of them. Neither depends on the constants of the start that are
/// fitted. Uncertainties are those of the linearised model: covariance (JᵀJ/σ² + 1)⁻¹, J the Jacobian of the
/// residuals over s by z, σ² the greater of 1 and the reduced sum of squares.
///
/// Sources: [Marquardt1963]; [Tarantola2005] for prior and posterior.
namespace tuft::brush {

/// Returns the repeatability of lines read with a ruler, one standard deviation of each column, metres: that of
/// [Wang2020], 1.4, 0.5 and 0.7 mm with hair of 30 mm, in proportion to the hair's length.
SweepRow ruler_repeatability(double length);

/// Options of `calibrate`.
struct CalibrateOptions {
    std::optional<SweepRow> repeatability;  ///< metres, > 0; default: `ruler_repeatability`
    int max_evaluations = 1500;             ///< sweeps of all depths; at least 60 are made
    ProgressFn progress;
};

/// A fitted constant.
struct FittedConstant {
    std::string key;           ///< as in preset files, "radius_mm"
    double value = 0;          ///< in the file's unit
    double low = 0, high = 0;  ///< 95 % interval, in the file's unit, within the bounds
    double determined = 0;     ///< 1 − σ/σ_prior: 0 the data say nothing, 1 they say all
};

/// Result of `calibrate`.
struct Calibration {
    Preset preset;
    SweepRow rms;          ///< root mean square residual of each column, metres; NaN where not measured (depth unused)
    double cost = 0;       ///< the greatest rms over repeatability of the measured columns
    double objective = 0;  ///< F
    int evaluations = 0;   ///< sweeps made
    std::vector<FittedConstant> constants;  ///< in the order of preset files
    /// Singular values of J, falling. A value above 1 is a combination of constants that the data determine better
    /// than the prior; one far below 1 is a combination that they do not determine.
    std::vector<double> singular;
};

/// Fits radius, taper, stiffness along the hair, side stiffness, flattening, friction and wet film. All other constants
/// are those of `start`, but for the adhesion of the wet film: that of the shipped brushes or none, whichever fits.
/// Preconditions: the hair length of `start` is that of the measured brush; `start` is a round tuft of hair. Throws
/// `Error` when it is not, or for fewer than four measured rows. Deterministic. Cost: about 20 ms per evaluation.
Calibration calibrate(const Preset& start, std::span<const SweepRow> measured, const CalibrateOptions& options = {});

}  // namespace tuft::brush
