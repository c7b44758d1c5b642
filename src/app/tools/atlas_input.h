#pragma once

#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"

namespace tuft::app {

bool in_atlas(const AtlasView& atlas, const Event& e);
/// Where the cursor over the model lies in the atlas beside it; null: the cursor is not over the model.
std::optional<Vec2> atlas_cursor(const Session& s, const Event* cursor);
void zoom_atlas(AtlasView& atlas, const Event& e);
/// Turns the model so that a place of the atlas is seen from straight above it.
void look_at_uv(Session& s, const Vec2& uv);

}  // namespace tuft::app
