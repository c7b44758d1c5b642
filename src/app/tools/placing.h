#pragma once

#include <optional>
#include <vector>

#include "app/document/writing.h"
#include "app/input/events.h"
#include "app/session/session.h"
#include "app/work/commands.h"

/// \file
/// What tools have in common that place something flat on the model. Window thread.
namespace tuft::app {

/// A point of the surface for the middle of what is placed.
struct PlacingSpot {
    Vec3 at, normal, eye;                        ///< metres; unit, towards the eye; unit, direction to the eye
    std::vector<std::vector<Vec3>> guides = {};  ///< of what it snapped to
};

/// Returns the spot under the cursor, snapped where that is on; nothing off the model and under a dialog.
std::optional<PlacingSpot> spot_at(const Session& session, const Event* cursor);
/// Returns the spot nearest to the place that was typed. Shows a message and returns nothing for one that is not finite
/// or far beside the model.
std::optional<PlacingSpot> typed_spot(Session& session);

/// Returns how what is placed enters the journal: on the active layer, within the active mask.
GroupSettings group_settings(const Session& session, const std::string& name);

/// Shows a place in the fields, metres.
void show_place(ToolState& tools, const Vec3& at);

/// Sets which points of a preview the model does not occlude.
void find_seen(std::vector<std::vector<PreviewPoint>>& lines, const Session& session);

}  // namespace tuft::app
