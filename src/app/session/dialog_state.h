#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/input/keys.h"
#include "app/widgets/file_dialog.h"

/// \file
/// State of the dialogs. Window thread.
namespace tuft::app {

/// Settings of the export dialog.
struct ExportSettings {
    std::string preset = "Blender";
    bool relief = true, roughness = true;
    bool pigments = false;     ///< pigment maps, with EXR
    std::uint32_t size = 0;    ///< texels per side; 0: as painted
    int picture = 0;           ///< 0: none, 1: one picture, else that many round the model
    int picture_width = 1280;  ///< pixels
};

/// Dialogs that the user opens. Those that the program opens follow from `ProjectState`.
struct DialogState {
    FileDialog file;
    ExportSettings export_settings;
    bool show_export = false, show_settings = false, show_keys = false, show_about = false;
    bool show_mismatches = false;
    std::optional<Action> key_to_assign;  ///< action that gets the next key pressed
};

}  // namespace tuft::app
