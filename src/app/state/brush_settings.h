#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "app/document/pictures/tried_strokes.h"
#include "app/state/brush_shelf.h"
#include "app/widgets/status_message.h"
#include "core/geometry/types.h"

/// \file
/// The chosen brush and ink. Window thread.
namespace tuft::app {

class PaintThread;
struct StrokeLine;

/// The chosen brush, its ink and how it paints.
struct BrushSettings {
    std::vector<std::string> presets;  ///< names of the shipped brushes, then files of own ones
    std::string preset = "wolf-medium", ink = "carbon";
    std::string remembered;   ///< brush stored for this model
    bool persistent = false;  ///< hair and ink last from stroke to stroke
    bool wet = false;         ///< ink flows, mixes and dries
    bool erases = false;      ///< the current stroke erases
    bool two_inks = false;    ///< the tip has another ink than the belly
    std::string tip_ink = "carbon";
    double tip_depth = 0.3;  ///< of the tip's ink, fraction of the tuft's length
    double dip_depth = 1;    ///< of Dip and Wipe, fraction of the tuft's length
    BrushShelf shelf;        ///< all of `presets`
    TriedStrokes tried;      ///< pictures of strokes
    double dip_side = 0;     ///< of Dip and Wipe, fraction of the width from the right flank (> 0) or the left; 0: all
};

/// Takes a brush of the list in its own size. Throws `Error` where it cannot be read.
void take_brush(BrushSettings& brush, const std::string& name);
/// Adds the brush of a TOML file to the list, where it is not in it, takes it, and remembers it for the next start.
/// Throws `Error` for a file that is no brush.
void take_own_brush(BrushSettings& brush, const std::filesystem::path& file);
/// Takes the brush of a file off the list, at the next start too. The file stays.
void forget_own_brush(BrushSettings& brush, const std::string& name);
/// Returns the files of brushes that were added before, also those that are missing.
std::vector<std::string> remembered_own_brushes();
/// Returns the line width in metres for the first brush on a model, and the brush of the same hair as `hair_of` that
/// draws it at `pressure`.
double first_line_width(const Box& box);
std::string first_brush(const std::vector<std::string>& brushes, const std::string& hair_of, double pressure,
                        double width);
/// Chooses the brush last used for this model, else that of the last of `lines`, else one to the size of the model.
/// Returns what is wrong with the one last used; empty: nothing.
Message choose_brush(BrushSettings& brush, const PaintThread& work, std::span<const StrokeLine> lines, double pressure);
/// Stores the chosen brush for this model, where the user chose it. Without a model it does nothing. One that
/// `choose_brush` took in place of a brush whose file is missing is not stored: that one is taken again when it is
/// back.
void remember_brush(BrushSettings& brush, const PaintThread* work);
/// Returns whether turning the brush about its axis matters: `brush::can_be_turned`.
bool brush_can_be_turned(BrushSettings& brush);
/// Multiplies the brush's size by `factor`, within the sizes that exist.
void size_brush(BrushSettings& brush, StatusMessage& status, double factor);

}  // namespace tuft::app
