#pragma once

#include <map>
#include <string>
#include <vector>

#include "brush/preset.h"
#include "stroke/trace.h"

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

    double at(double pressure) const;      ///< metres; pressure 0–1
    double pressure(double width) const;   ///< kLightest–1: nearest to a width in metres
    double least() const { return at(kLightest); }
    double most() const { return at(1); }

  private:
    std::vector<double> widths_;  // metres, at pressures i / 12
};

/// Those of brushes by name (`brush::load_preset`), each found out once.
class WidthTables {
  public:
    const LineWidths& of(const std::string& brush);

  private:
    std::map<std::string, LineWidths> known_;
};

/// The brush in the size that its name has if a pressure from 0.1 to 0.7 draws the width, else in the size
/// (`brush::scaled`; powers of 1.25) that draws it at about 0.5. `widths` is of `name`. Sizes are held to
/// what brushes have.
std::string brush_for_width(const std::string& name, const LineWidths& widths, double width);

/// Brings the middle of a trace's made-up pressures (0.5, see `io::InkmlOptions`) to the one that draws its
/// `line_width`, and with it, in proportion, where they swell in and taper out.
void press_to_width(Trace& trace, const LineWidths& widths);

}  // namespace tuft::stroke
