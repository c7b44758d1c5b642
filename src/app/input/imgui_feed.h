#pragma once

#include <vector>

#include "app/input/events.h"

namespace tuft::app {

/// Prepares Dear ImGui to be fed by `feed_imgui`.
void start_imgui_feed();

/// Takes the events of one frame off the queue, hands them to ImGui and returns them in
/// order. All movements since the last frame come at once; a press of a button or key is
/// the last event of its frame, so that what lies under the cursor is known when it is
/// looked at, and a quick press and release are seen as two.
std::vector<Event> feed_imgui(EventQueue& queue, int width, int height, double dt);

}  // namespace tuft::app
