#pragma once

#include <vector>

#include "app/document/curve.h"
#include "app/document/writing.h"
#include "app/input/pointer_input.h"
#include "stroke/gesture/symmetry.h"
#include "stroke/journal/fill.h"

namespace tuft::app {

enum class Tool { brush, line, curve, writing, eraser, fill, pick, mask };

/// The tool in hand and what each tool is set to.
struct ToolState {
    Tool active = Tool::brush;
    PointerSettings pointer;
    bool pointer_down = false;  ///< a stroke is being drawn
    double pen_pressure = -1;   ///< now; below 0: no pen
    stroke::Symmetry symmetry;
    CurveInWork curve;
    CurveSettings curve_settings;
    Writing writing;
    std::vector<std::vector<PreviewPoint>> writing_preview;  ///< where the writing would lie now
    stroke::Fill fill;
};

}  // namespace tuft::app
