#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/input/keys.h"
#include "app/widgets/file_dialog.h"

namespace tuft::app {

struct ExportSettings {
    std::string preset = "Blender";
    bool relief = true, roughness = true;
    bool pigments = false;     ///< their amounts, with EXR maps
    std::uint32_t size = 0;    ///< texels per side; 0: as painted
    int picture = 0;           ///< 0: none, 1: a still, else that many pictures all round
    int picture_width = 1280;  ///< pixels
};

/// Dialogs that a person opens. Those that the program opens follow from `ProjectState`.
struct DialogState {
    FileDialog file;
    ExportSettings export_settings;
    bool show_export = false, show_settings = false, show_keys = false, show_about = false;
    bool show_mismatches = false;
    std::optional<Act> key_to_assign;  ///< action that the next key is given to
};

}  // namespace tuft::app
