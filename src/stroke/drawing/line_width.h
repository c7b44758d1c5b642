#pragma once

#include <map>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "stroke/journal/entry/samples.h"
#include "stroke/placement/placement.h"

/// \file
/// Widths of lines: the pressure and the size of a brush that draw a given width. Called by drawing.h and long_lines.h.
namespace tuft::stroke {

inline constexpr double kSkinFilm = 0.1e-3;  ///< metres of ink round wet hair

/// Width of the straight line that a wet, upright brush draws, by pressure: `brush::sweep_depth` at the lightest and at
/// twelve more depths up to the working depth, linear between them, monotone, plus `kSkinFilm` on both sides.
class LineWidths {
  public:
    static constexpr double kLightest = 0.05;  ///< least pressure of a line without gaps

    /// Cost: about 50 ms.
    explicit LineWidths(const brush::Preset& preset);

    /// Returns the width at a pressure in [0, 1], metres.
    double at(double pressure) const;
    /// Returns the pressure in [kLightest, 1] whose width is nearest to `width`, metres.
    double pressure(double width) const;
    double least() const { return at(kLightest); }
    double most() const { return at(1); }

  private:
    struct Knot {
        double pressure = 0, width = 0;  // width in metres
    };
    std::vector<Knot> knots_;  // ascending in pressure, from 0 to 1
};

/// Widths, presets and holders of brushes by name, each made at its first use. Throws `Error` as `brush::load_preset`.
class WidthTables {
  public:
    /// Returns the widths of a brush, measured when they are first requested, and its preset.
    const LineWidths& of(const std::string& brush);
    const brush::Preset& preset(const std::string& brush);
    /// Returns options of a holder over a plane that compensates the tip lag (`TiltedTipLag`), as
    /// `Materials::holder` does where a stroke is painted.
    const HolderOptions& holder(const std::string& brush);

  private:
    std::map<std::string, brush::Preset> presets_;
    std::map<std::string, LineWidths> known_;
    std::map<std::string, HolderOptions> holds_;
};

/// Ratio of neighbouring sizes of a brush that are chosen for lines: few brushes for many widths.
inline constexpr double kBrushSizes = 1.25;

/// Returns `name` if a pressure from 0.3 to 0.7 draws `width` (metres). Else returns the name of the size
/// (`brush::scaled`, powers of `kBrushSizes`) that draws it at a pressure of about 0.36. Corners come out best at that
/// pressure: at less, the tuft is long for the line and swings out; at more, it lies flat and cuts them. `widths` is
/// that of `name`. Sizes are clamped to the range of presets.
std::string brush_for_width(const std::string& name, const LineWidths& widths, double width);

/// Adds the ink of a line to a box: its stencil, else its outline, else its samples with half of the line width around
/// them. Metres, frame of the trace.
void add_extent(Box& box, const StrokeSamples& trace);

/// Returns the length over which the pressure of a line of this width rises or falls at its ends, metres.
double line_end(double width);

/// Sets the pressures of a trace with made-up ones so that it draws its `line_width`, times twice the former pressure
/// where that is below 0.5. The hand sets down and lifts within 1.5 widths each, at most a quarter of the line. A
/// closed line is continued along itself by both lengths, so that no gap shows where its ends meet.
void draw_to_width(StrokeSamples& trace, const LineWidths& widths);

}  // namespace tuft::stroke
