#pragma once

#include "app/input/keys.h"
#include "app/widgets/ui.h"

namespace tuft::app {

/// Whose mouse buttons turn and move the view.
enum class Keymap { blender, maya };

struct SpaceMouseSettings {
    double speed = 1;
    bool level = true;       ///< the horizon stays level
    bool moves_eye = false;  ///< else the model goes where the cap goes
    bool seen = false;       ///< one is connected
};

/// What a person sets once, for every model.
struct Preferences {
    UiSettings ui;         ///< `Ui` takes them over between two frames
    bool restyle = false;  ///< and has to do so
    Keymap keymap = Keymap::blender;
    KeyTable keys;
    SpaceMouseSettings space_mouse;
};

}  // namespace tuft::app
