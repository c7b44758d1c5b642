#pragma once

#include <array>
#include <vector>

#include "app/document/curve.h"
#include "app/document/lettering.h"
#include "app/document/writing.h"
#include "app/input/pointer_input.h"
#include "stroke/gesture/symmetry.h"
#include "stroke/journal/entry/fill.h"

/// \file
/// The tools' state. Window thread.
namespace tuft::app {

enum class Tool { brush, line, curve, writing, text, eraser, fill, pick, mask };

/// The active tool and the settings of each tool.
struct ToolState {
    Tool active = Tool::brush;
    PointerSettings pointer;
    bool pointer_down = false;  ///< a stroke is being drawn
    double pen_pressure = -1;   ///< present, 0–1; negative: no pen
    stroke::Symmetry symmetry;
    CurveInWork curve;
    CurveSettings curve_settings;
    Writing writing;
    Lettering lettering;
    LetteringReader letters;                                 ///< reads the characters of the text
    CopyReader copies;                                       ///< reads the pictures that the project keeps
    std::vector<std::vector<PreviewPoint>> writing_preview;  ///< lines of the drawing or the text at the cursor
    Message place_fault;                                     ///< why the text cannot lie at the cursor
    bool snap = true;                            ///< drawings snap to planes of symmetry and to other drawings
    std::vector<std::vector<Vec3>> snap_guides;  ///< metres, lines along the surface that the drawing snapped to
    std::array<double, 3> place_mm{};            ///< of the drawing at the cursor, or as typed
    bool shows_place = false;                    ///< of the drawing, in fields
    bool place_typed = false;                    ///< to be placed there
    stroke::Fill fill;
};

}  // namespace tuft::app
