#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/document/colours.h"
#include "app/paint/paint_thread.h"
#include "app/state/brush_settings.h"

/// \file
/// Inks, materials and the palette. Window thread.
namespace tuft::app {

enum class PaletteTool { brush, pour, pick };

/// State of the palette panel.
struct PaletteState {
    bool shown = false;
    PaletteTool tool = PaletteTool::brush;
    double radius = 0.008;  ///< metres, of a poured pool
    stroke::PalettePicture picture;
    bool fresh = false;                          ///< the picture is not uploaded yet
    unsigned texture = 0;                        ///< OpenGL name; 0: none yet
    double x = 0, y = 0, width = 0, height = 0;  ///< pixels, of its picture; width 0: not drawn
    brush::TuftState tuft;                       ///< of the brush on the palette
};

/// Available inks and materials, and how the work is shown.
struct ColourState {
    std::vector<std::string> shipped, substrates;  ///< names of presets
    std::vector<ink::Ink> own;                     ///< of this project
    ColourChoice choice;                           ///< of the colour window
    Appearance appearance;
    std::string edited;  ///< ink whose recipe is open
    ink::Ink recipe;     ///< as its sliders stand
    PaletteState palette;
};

/// Returns an ink of this project or a shipped one; nullptr when it cannot be read.
const ink::Ink* find_ink(const ColourState& colours, const std::string& name);
/// Returns the pigments of these entries, as far as their inks are known.
std::vector<ink::Pigment> pigments_in_use(const ColourState& colours, std::span<const StrokeLine> lines);
/// Chooses a mixture as the ink. It becomes part of the project with the first stroke.
void take_mix(ColourState& colours, BrushSettings& brush, ink::Ink ink);
/// Adds the chosen ink to the project, if it is a mixture that is not part of it yet. Without a model it does nothing.
void bring_in_colour(ColourState& colours, const std::string& ink_in_hand, PaintThread* work);
/// Takes a finished match from the finder.
void poll_colour(ColourState& colours, BrushSettings& brush);
/// Shows or hides the palette. While it is shown, the brush is persistent.
void show_palette(PaletteState& palette, BrushSettings& brush, StatusMessage& status, bool on);

}  // namespace tuft::app
