#pragma once

#include "app/input/events.h"
#include "app/session/session.h"

/// \file
/// Tools that click or drag over the model and do not paint: fill, eyedropper, masks, moving entries. Window thread.
namespace tuft::app {

/// Perform a click of the tools Fill, Pick and Mask at the event's place. The lasso of Mask follows the pointer until
/// the button comes up.
void press_fill(Session& s, const Event& e);
void press_pick(Session& s, const Event& e);
void press_mask(Session& s, const Event& e);
void move_lasso(Session& s, const Event& e);
void release_lasso(Session& s);
/// Begins to move the selected entries. Returns false unless `JournalState::move_on_drag`.
bool press_move(Session& s, const Event& e);
void drag_move(Session& s, const Event& e);
void release_move(Session& s, const Event& e);

}  // namespace tuft::app
