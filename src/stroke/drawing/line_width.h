#pragma once

#include <map>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "stroke/journal/trace.h"
#include "stroke/placement/placement.h"

/// Lines as wide as a drawing has them: how hard, and with which size of a brush, to press.
namespace tuft::stroke {

inline constexpr double kSkinFilm = 0.1e-3;  ///< metres of ink round wet hair

/// Width of the line that a wet brush draws, straight, steady and upright, over the pressure of the hand:
/// `brush::sweep_depth` at twelve depths up to the working depth, linear between, never falling, and the
/// ink round the hair to both sides.
class LineWidths {
  public:
    static constexpr double kLightest = 0.05;  ///< pressure of a line that is still whole

    /// Takes some 50 ms.
    explicit LineWidths(const brush::Preset& preset);

    double at(double pressure) const;     ///< metres; pressure 0–1
    double pressure(double width) const;  ///< kLightest–1: nearest to a width in metres
    double least() const { return at(kLightest); }
    double most() const { return at(1); }

  private:
    std::vector<double> widths_;  // metres, at pressures i / 12
};

/// Those of brushes by name (`brush::load_preset`), each found out once.
class WidthTables {
  public:
    const LineWidths& of(const std::string& brush);
    const brush::Preset& preset(const std::string& brush);
    /// An upright holder over a plane that tip_lags its line (`measure_tip_lag`).
    const HolderOptions& hold(const std::string& brush);

  private:
    std::map<std::string, brush::Preset> presets_;
    std::map<std::string, LineWidths> known_;
    std::map<std::string, HolderOptions> holds_;
};

/// From one size of a brush that is chosen for a line to the next: few brushes for many widths.
inline constexpr double kBrushSizes = 1.25;

/// The brush in the size that its name has if a pressure from 0.3 to 0.7 draws the width, else in the size
/// (`brush::scaled`; powers of `kBrushSizes`) that draws it at about 0.36, at which corners come out best: less, and
/// the tuft is long for the line and swings out; more, and it lies and cuts them. `widths` is of `name`. Sizes are held
/// to what brushes have.
std::string brush_for_width(const std::string& name, const LineWidths& widths, double width);

/// Adds what the ink of a line takes up to a box: its stencil edge, or its samples, with half of its width beside them
/// where it has one; metres, in its own frame.
void add_extent(Box& box, const Trace& trace);

/// Metres of a line with this width over which a hand that set down or lifts comes to its pressure.
double line_end(double width);

/// Lays out the pressures of a trace with made-up ones so that it draws its `line_width`, or as much less of it as they
/// are below 0.5: the hand sets down and
/// lifts within one and a half widths each, or a quarter of the line if that is less. A line that ends where it began
/// goes on along itself for as long as both take, so that no gap shows where its ends meet.
void draw_to_width(Trace& trace, const LineWidths& widths);

}  // namespace tuft::stroke
