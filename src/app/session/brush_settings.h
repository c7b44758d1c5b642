#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/widgets/status_message.h"
#include "core/geometry/types.h"

namespace tuft::app {

class PaintThread;
struct StrokeLine;

/// The brush in hand and its ink.
struct BrushSettings {
    std::vector<std::string> presets;  ///< names of the shipped brushes
    std::string preset = "wolf-medium", ink = "carbon";
    std::string remembered;   ///< brush that is stored for this model
    bool persistent = false;  ///< hair and ink last from stroke to stroke
    bool wet = false;         ///< ink flows, mixes and dries
    bool erases = false;      ///< the stroke being drawn takes ink off
    bool two_inks = false;    ///< the tip has another ink than the belly
    std::string tip_ink = "carbon";
    double tip_depth = 0.3;  ///< part of the tuft's length
    double dip_depth = 1;    ///< likewise, of Dip and Wipe
    double dip_side = 0;     ///< of the tuft's width, from the right flank (> 0) or the left; 0: all
};

/// Metres: how wide a line a model's first brush shall draw, and the brush of that hair that does at a pressure.
double first_line_width(const Box& box);
std::string first_brush(const std::vector<std::string>& brushes, const std::string& hair_of, double pressure,
                        double width);
/// Takes the brush that a person last had in hand for this model, else that of the last of `lines`, else one in the
/// size of the model.
void choose_brush(BrushSettings& brush, const PaintThread& work, std::span<const StrokeLine> lines, double pressure);
/// Stores the brush in hand for the next time with this model, where a person chose it. Without a model: nothing.
void remember_brush(BrushSettings& brush, const PaintThread* work);
/// Whether the brush in hand has a ferrule that is wider than thick (brush/tuft/ferrule.h).
bool has_wide_ferrule(const BrushSettings& brush);
/// Takes the brush in hand in another size, times that of its make, within what there is.
void size_brush(BrushSettings& brush, StatusMessage& status, double factor);

}  // namespace tuft::app
