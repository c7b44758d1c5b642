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

/// Settings of the dialog for decal sheets.
struct DecalSettings {
    std::string format = "PDF";
    std::string film = "Water-slide decal";               ///< kind that the three values below came from
    double max_strain = 0.03;                             ///< of the film
    double bleed = 0.003, overlap = 0.001, join = 0.010;  ///< metres
    std::string page = "A4";
    int dpi = 300;
    std::string mask;  ///< name; empty: all that is painted
    bool plates = false, strain_map = false, along_grain = false;
    bool outlines = false;   ///< of areas of one ink, instead of pictures
    bool fragments = false;  ///< pieces too small to be laid, too
};

/// Settings of the dialog for films.
struct FilmSettings {
    std::string format = "MP4";
    std::string camera = "As seen now";
    int width = 1280, height = 720;  ///< pixels
    bool by_speed = false;
    double seconds = 20;  ///< length without its end, or
    double speed = 10;    ///< times as fast as the hand
    double still = 2;     ///< seconds of the finished work at the end
    int frames_per_second = 25;
    bool brush = true;
};

/// Dialogs that the user opens. Those that the program opens follow from `ProjectState`.
struct DialogState {
    FileDialog file;
    ExportSettings export_settings;
    DecalSettings decal_settings;
    FilmSettings film_settings;
    bool show_decals = false, show_film = false;
    bool show_export = false, show_settings = false, show_keys = false, show_about = false;
    bool show_mismatches = false;
    std::optional<Action> key_to_assign;  ///< action that gets the next key pressed
};

}  // namespace tuft::app
