#pragma once

#include "stroke/drawing/line_width.h"
#include "stroke/placement/placement.h"

/// Lines of a drawing, fitted until their ink lies where it is wanted.
namespace tuft::stroke {

/// A flat trace with made-up pressures (`draw_to_width`) whose ink covers the discs of its
/// pressures' widths round its samples, as nearly as a hand gets there by trying: it draws the line
/// on a plane (`plane_ink`), looks by how much the edge of the ink is off along the edge of what is
/// wanted, and moves its way and presses otherwise there, a few times. Only where the line turns
/// sharply within a width; ends, straight and gently bent lines stay as they are. At turns of more
/// than some 100 degrees, at which a tuft that lies turns over, it begins by lifting. The best of
/// all tries counts: what comes out is never worse. Deterministic. Some 0.1 ms for every tenth of a
/// width and try; a trace without turns is not tried at all. What lies under `area` is not looked
/// at, nor is a trace of which that is all.
class DrawnArea;
Trace fit_trajectory(Trace trace, const brush::Preset& preset, const LineWidths& widths, const HolderOptions& options,
                     const DrawnArea* area = nullptr);

/// All lines of a drawing by the brushes that they name, with their `line_width`s: each looks at
/// what of its edge does not lie under others of its ink and place.
void fit_trajectory(std::span<Trace* const> drawing, WidthTables& tables);

}  // namespace tuft::stroke
