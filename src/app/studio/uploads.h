#pragma once

#include "app/session/session.h"

/// \file
/// Uploads of pictures to the graphics card. Window thread, with the OpenGL context current.
namespace tuft::app {

/// Uploads the palette's picture when it changed.
void upload_palette(PaletteState& palette);
/// Uploads changed thumbnails of layers. While the view is `still`, requests thumbnails from its direction.
void upload_thumbnails(Session& s, bool still);

}  // namespace tuft::app
