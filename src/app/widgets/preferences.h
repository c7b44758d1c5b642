#pragma once

#include "app/input/keys.h"
#include "app/widgets/ui.h"

/// \file
/// The user's preferences. Window thread.
namespace tuft::app {

/// Program whose mouse buttons rotate and move the view.
enum class Keymap { blender, maya };

/// Settings of a SpaceMouse.
struct SpaceMouseSettings {
    double speed = 1;        ///< factor
    bool level = true;       ///< retains the horizon
    bool moves_eye = false;  ///< the cap moves the camera; false: the model
    bool seen = false;       ///< a device is connected
};

/// Settings for all models.
struct Preferences {
    UiSettings ui;         ///< applied by `Ui` between two frames
    bool restyle = false;  ///< `ui` changed and is to be applied
    Keymap keymap = Keymap::blender;
    KeyTable keys;
    SpaceMouseSettings space_mouse;
};

}  // namespace tuft::app
