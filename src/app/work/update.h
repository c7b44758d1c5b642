#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/document/snapshots.h"
#include "app/document/thumbnails.h"
#include "app/view/texture.h"
#include "core/message.h"
#include "stroke/document/document.h"

/// \file
/// What the paint thread reports to the window.
namespace tuft::app {

/// A stroke for the list.
struct StrokeLine {
    std::uint64_t id = 0;
    stroke::EntryKind action = stroke::EntryKind::stroke;
    std::string brush, ink, label;
    stroke::EntryGroup group;
    bool hidden = false, erases = false, on_palette = false;
    double length = 0;        ///< metres of the path
    std::vector<Vec3f> path;  ///< x, y in [0, 1] (y down), z: pressure in [0, 1]
    bool flat = false;        ///< `path` is in the frame of a drawing
    Vec2 path_centre{0};      ///< metres: of the path (0.5, 0.5) there
    double path_span = 0;     ///< metres: of [0, 1]
};

/// A place at the rim of highlighted ink.
struct OutlinePoint {
    Vec3f position{0}, normal{0, 0, 1};  ///< metres; unit
};

/// How the work is shown, apart from how it was painted.
struct Appearance {
    std::map<std::string, ink::Ink> recolours;  ///< by the name of the ink painted with
    std::string substrate, painted_on;
    float roughness = 0.1f;  ///< of the bare surface, as shown
};

/// The document as it is now.
struct DocumentStatus {
    stroke::LayerTable layers;
    stroke::MaskTable masks;
    bool can_undo = false, can_redo = false;
    bool wet = false;         ///< some ink is
    double undo_seconds = 0;  ///< that the last undo took
};

/// The brush last painted with.
struct BrushStatus {
    brush::TuftState tuft;                              ///< of the stroke in work; no branches: none
    bool on_palette = false;                            ///< `tuft` is there
    double fullness = 1;                                ///< ink in it, of its capacity
    std::optional<std::array<std::uint8_t, 3>> colour;  ///< sRGB of a full film of that ink
};

/// How far the thread is.
struct ProgressStatus {
    double done = 0;          ///< the latest `ExtendStroke::asked` that is painted
    std::size_t waiting = 0;  ///< commands not done yet
    std::string busy;         ///< long work being done, ""
    double fraction = 0;      ///< of it
};

/// The project file.
struct FileStatus {
    std::filesystem::path project;
    Message trouble;          ///< why work is not being saved; empty: it is
    std::size_t unsaved = 0;  ///< strokes that wait in memory for that
    bool behind = false;      ///< and so does a change of one
    bool viewing = false;     ///< another program works on the project; it is only looked at
};

struct PaintStatus {
    DocumentStatus document;
    BrushStatus brush;
    ProgressStatus progress;
    FileStatus file;
};

/// A project could not be saved.
struct SaveFailure {
    std::filesystem::path path;
    Message reason;
};

/// What happened since the last look.
struct PaintEvents {
    TexelUpdate texels;
    std::optional<std::vector<StrokeLine>> strokes;
    std::vector<Message> messages;
    std::optional<stroke::PalettePicture> palette;
    std::vector<Thumbnail> thumbnails;              ///< of layers, those that changed
    std::optional<std::vector<ink::Ink>> own_inks;  ///< of this work, beside the shipped ones
    std::optional<Appearance> appearance;
    std::optional<std::vector<SnapshotLine>> snapshots;
    std::optional<SnapshotPicture> snapshot_picture;
    std::optional<std::vector<OutlinePoint>> outline;  ///< of what was asked to be highlighted
    std::string picked;                                ///< name of an ink just picked up or taken in
    std::optional<SaveFailure> not_saved;
    bool from_outside = false;  ///< another program had a part in the change
};

struct Update {
    PaintEvents events;
    PaintStatus status;
};

/// The list entry of a stroke.
StrokeLine stroke_line(const stroke::JournalEntry& stroke);

}  // namespace tuft::app
