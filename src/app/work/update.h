#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/document/pictures/thumbnails.h"
#include "app/document/snapshots.h"
#include "app/view/texture.h"
#include "core/message.h"
#include "stroke/document/document.h"

/// \file
/// Updates from the paint thread to the window. Plain data.
namespace tuft::app {

/// What an entry of the journal changes for some parts of the model.
struct PartChange {
    enum class What { hidden, shown, locked, unlocked, made_of, as_model };
    What what = What::hidden;
    std::string substrate;  ///< of `made_of`
    std::vector<std::string> names;

    bool operator==(const PartChange&) const = default;
};

/// The path of a stroke in a unit square.
struct PathSketch {
    std::vector<Vec3f> points;  ///< x, y in [0, 1], y down; z: pressure in [0, 1]
    bool flat = false;          ///< in the frame of a drawing; false: seen along the mean normal of the surface
    Vec2 centre{0};             ///< metres, point of the drawing at (0.5, 0.5)
    double span = 0;            ///< metres, length of [0, 1]
};

/// A journal entry in the list.
struct StrokeLine {
    std::uint64_t id = 0;
    stroke::EntryKind action = stroke::EntryKind::stroke;
    std::optional<stroke::LayerChange> change;  ///< of a layer
    std::vector<PartChange> part_changes;       ///< of parts
    std::string brush, ink, label;
    stroke::EntryGroup group;
    bool hidden = false, erases = false, on_palette = false, is_area = false;
    double length = 0;  ///< metres, of the path
    PathSketch path;
    std::optional<stroke::Placement> placement;  ///< of a drawing that lies on the model
};

/// A point on the outline of highlighted ink.
struct OutlinePoint {
    Vec3f position{0}, normal{0, 0, 1};  ///< metres; unit
};

/// How the work is shown, apart from the journal.
struct Appearance {
    std::map<std::string, ink::Ink> recolours;  ///< by name of the ink in the journal
    std::string substrate, painted_on;          ///< shown; of the journal
    float roughness = 0.1f;                     ///< of the bare surface, as shown
    ink::Substrate document;                    ///< the shown one
    bool is_preview = false;                    ///< it is seen in place of those of the parts
};

/// State of the document.
struct DocumentStatus {
    stroke::LayerTable layers;
    stroke::MaskTable masks;
    stroke::PartTable parts;
    bool can_undo = false, can_redo = false;
    bool wet = false;         ///< some ink is wet
    double undo_seconds = 0;  ///< duration of the last undo
};

/// State of the brush last painted with.
struct BrushStatus {
    brush::TuftState tuft;                              ///< during a stroke; else without branches
    bool on_palette = false;                            ///< `tuft` is on the palette
    double fullness = 1;                                ///< ink over capacity, 0–1
    double wetness = 1;                                 ///< of the hair, 0 dry … 1 wet
    std::optional<std::array<std::uint8_t, 3>> colour;  ///< sRGB of a full film of that ink
};

/// Progress of the paint thread.
struct ProgressStatus {
    double done = 0;          ///< latest `ExtendStroke::requested_at` that is painted
    std::size_t waiting = 0;  ///< commands not finished yet
    std::string busy;         ///< name of running long work, or ""
    double fraction = 0;      ///< of it, 0–1
};

/// State of the project file.
struct FileStatus {
    std::filesystem::path project;
    Message trouble;          ///< why saving fails, or empty
    std::size_t unsaved = 0;  ///< strokes in memory only
    bool behind = false;      ///< some change of an entry is in memory only
    bool viewing = false;     ///< read-only, because another program works on the project
};

/// What the paint thread reports of its state. The newest replaces those before.
struct PaintStatus {
    std::shared_ptr<const mesh::SurfaceQuery> surface;  ///< of the visible parts; null before the first update
    DocumentStatus document;
    BrushStatus brush;
    ProgressStatus progress;
    FileStatus file;
};

/// A failed save.
struct SaveFailure {
    std::filesystem::path path;
    Message reason;
};

/// Events since the last update.
struct PaintEvents {
    TexelUpdate texels;
    std::optional<std::vector<StrokeLine>> strokes;
    std::vector<Message> messages;
    std::optional<stroke::PalettePicture> palette;
    std::vector<Thumbnail> thumbnails;              ///< changed ones
    std::optional<std::vector<ink::Ink>> own_inks;  ///< of this project, besides the shipped ones
    std::optional<Appearance> appearance;
    std::optional<std::vector<SnapshotLine>> snapshots;
    std::optional<SnapshotPicture> snapshot_picture;
    std::optional<std::vector<OutlinePoint>> outline;  ///< of the highlighted entries
    std::string picked;                                ///< name of an ink just picked or added
    std::optional<SaveFailure> not_saved;
    bool from_outside = false;  ///< another program contributed to the change
};

/// One message of the paint thread: what happened once, and its state.
struct Update {
    PaintEvents events;
    PaintStatus status;
};

/// Returns the list line of an entry.
StrokeLine stroke_line(const stroke::JournalEntry& stroke);
/// Returns what an edit changes in the parts of `before`, each kind of change once, in the order of the edit.
std::vector<PartChange> part_changes(const stroke::PartTable& before, const stroke::PartEdit& edit);

}  // namespace tuft::app
