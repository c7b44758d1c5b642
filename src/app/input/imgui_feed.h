#pragma once

#include <vector>

#include "app/input/events.h"

/// \file
/// Feeds input events to Dear ImGui. Window thread.
namespace tuft::app {

/// Sets Dear ImGui up for `feed_imgui`. Call it once, after its context exists.
void start_imgui_feed();

/// Removes the events of one frame from the queue, passes them to ImGui and returns them in order. All movements since
/// the last frame come at once. A press of a button or key ends the frame: the element under the cursor is then known,
/// and a quick press and release are two frames. `dt`: seconds since the last frame.
std::vector<Event> feed_imgui(EventQueue& queue, int width, int height, double dt);

}  // namespace tuft::app
