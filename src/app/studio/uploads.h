#pragma once

#include "app/session/session.h"

/// \file
/// Pictures on their way to the graphics card.
namespace tuft::app {

/// The palette's, where it changed.
void upload_palette(PaletteState& palette);
/// Those of the layers. While the view is `still` they are asked for anew from where the model is seen.
void upload_thumbnails(Session& s, bool still);

}  // namespace tuft::app
