#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/document/colours.h"
#include "app/paint/paint_thread.h"
#include "app/session/brush_settings.h"

namespace tuft::app {

enum class PaletteTool { brush, pour, pick };

/// The palette's panel.
struct PaletteState {
    bool shown = false;
    PaletteTool tool = PaletteTool::brush;
    double radius = 0.008;  ///< metres, of a pool that is poured
    stroke::PalettePicture picture;
    bool fresh = false;                          ///< the picture changed
    unsigned texture = 0;                        ///< OpenGL name; 0: none yet
    double x = 0, y = 0, width = 0, height = 0;  ///< pixels: where its picture is; width 0: nowhere
    brush::TuftState tuft;                       ///< pressed on it
};

/// Inks and materials to choose from, and what the work is shown with.
struct ColourState {
    std::vector<std::string> shipped, substrates;  ///< names of presets
    std::vector<ink::Ink> own;                     ///< of this work
    ColourChoice choice;                           ///< chosen on the wheel, and the mix found for it
    Appearance appearance;
    std::string edited;  ///< ink whose recipe is open
    ink::Ink recipe;     ///< as its sliders stand
    PaletteState palette;
};

/// An ink of this work, or a shipped one; nullptr when it cannot be read.
const ink::Ink* find_ink(const ColourState& colours, const std::string& name);
/// Pigments that these strokes have, as far as their inks are known.
std::vector<ink::Pigment> pigments_in_use(const ColourState& colours, std::span<const StrokeLine> lines);
/// Takes a mix into the hand. It becomes part of the work when something is painted with it.
void take_mix(ColourState& colours, BrushSettings& brush, ink::Ink ink);
/// Makes the ink in hand part of the work, if it is a mix that is not yet. Without a model: nothing.
void bring_in_colour(ColourState& colours, const std::string& ink_in_hand, PaintThread* work);
/// Takes over a mix that was found.
void poll_colour(ColourState& colours, BrushSettings& brush);
/// Shows the palette or puts it away. With it out, the brush keeps what is in it.
void show_palette(PaletteState& palette, BrushSettings& brush, StatusMessage& status, bool on);

}  // namespace tuft::app
