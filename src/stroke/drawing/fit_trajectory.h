#pragma once

#include "stroke/drawing/line_width.h"
#include "stroke/journal/entry/entry.h"
#include "stroke/placement/placement.h"

/// \file
/// Iterative correction of a hand's path until its ink covers a line of a drawing. Called by `press_to_widths`.
namespace tuft::stroke {

class DrawnArea;

/// The area of a drawing, and which of its lines is fitted.
struct FittedLine {
    const DrawnArea* area = nullptr;  ///< null: the line is alone
    std::size_t number = 0;
};

/// Corrects a flat trace with made-up pressures (`draw_to_width`) so that its ink covers the target: the union of discs
/// with the widths of its pressures round its samples. Each iteration draws the trace on a plane (`plane_ink`),
/// measures the distance of the ink's edge along the target's edge, and moves samples and pressures against it.
/// Corrects only where the line turns sharply within a width; ends, straight and gently bent parts do not change. At
/// turns of more than about 100°, where a tuft turns over, the first iteration lifts it. Returns the best iteration, or
/// the trace itself. Edges under other lines of `line.area` do not count. Deterministic. Cost: 0.1 ms per tenth of a
/// width and iteration, from before the first sharp turn until behind the last one by 2.5 widths and what the tuft
/// needs to follow its holder; none without sharp turns.
StrokeSamples fit_trajectory(StrokeSamples trace, const brush::Preset& preset, const LineWidths& widths,
                             const HolderOptions& options, const FittedLine& line = {});

/// Corrects all lines of a drawing with the brushes that they name and their `line_width`s. Edges under other lines of
/// the same ink and placement do not count. Lines are fitted side by side.
void fit_trajectory(std::span<PaintStroke* const> drawing, WidthTables& tables);

}  // namespace tuft::stroke
