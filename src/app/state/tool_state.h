#pragma once

#include <array>
#include <memory>
#include <vector>

#include "app/document/curve.h"
#include "app/document/lettering.h"
#include "app/document/writing.h"
#include "app/input/pointer.h"
#include "stroke/gesture/symmetry.h"
#include "stroke/journal/entry/fill.h"
#include "writer/layout/feature_line.h"

/// \file
/// The tools' state. Window thread.
namespace tuft::app {

enum class Tool { brush, line, curve, writing, text, eraser, fill, pick, mask };

/// Where a drawing or a text will lie.
struct DrawingPlace {
    std::vector<std::vector<PreviewPoint>> preview;      ///< its lines on the surface
    Message fault;                                       ///< why it cannot lie there
    bool snaps = true;                                   ///< to planes of symmetry and to other drawings
    std::vector<std::vector<Vec3>> guides;               ///< metres, lines along the surface that it snapped to
    std::array<double, 3> millimetres{};                 ///< position, at the cursor or as typed
    bool has_fields = false;                             ///< its position is shown in fields
    bool is_typed = false;                               ///< it is to be placed at `millimetres`
    std::shared_ptr<const mesh::SurfaceQuery> lines_of;  ///< the surface whose `lines` these are
    std::unique_ptr<writer::FeatureLines> lines;         ///< for bands along an edge; null: not looked for
    int copies = 0;                                      ///< of the band that is shown; 0: none
    double copy_width = 0;                               ///< metres, of each of them
};

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
    LetteringReader letters;  ///< reads the characters of the text
    CopyReader copies;        ///< reads the pictures that the project keeps
    DrawingPlace place;       ///< of the drawing or the text at the cursor
    stroke::Fill fill;
};

}  // namespace tuft::app
