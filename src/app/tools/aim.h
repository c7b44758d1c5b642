#pragma once

#include "app/input/events.h"
#include "app/input/pointer.h"
#include "app/session/session.h"

/// \file
/// From cursor positions to rays. Window thread.
namespace tuft::app {

/// Returns the camera of the model's view; without a model that of a box of two metres.
render::GlCamera camera_of(const Session& s);
/// Returns the aim of an event over the open model.
Aim aim_of(const Session& s, const Event& e);

}  // namespace tuft::app
