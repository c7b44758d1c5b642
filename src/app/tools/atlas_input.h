#pragma once

#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"

/// \file
/// Input over the atlas view. Window thread.
namespace tuft::app {

/// Returns true when the event is over the atlas view.
bool in_atlas(const AtlasView& atlas, const Event& e);
/// Returns the UV of the surface under the cursor over the model; nothing where the cursor is not over the model.
std::optional<Vec2> atlas_cursor(const Session& s, const Event* cursor);
void zoom_atlas(AtlasView& atlas, const Event& e);
/// Turns the model so that the surface point of a UV is seen along its normal.
void look_at_uv(Session& s, const Vec2& uv);

}  // namespace tuft::app
