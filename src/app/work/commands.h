#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/document/lettering.h"
#include "app/document/writing.h"
#include "brush/tuft/tuft.h"
#include "io/project/attachments.h"
#include "io/sheet/painted_sheet.h"
#include "pictures/journal_film.h"
#include "render/gl/gl_camera.h"
#include "stroke/document/document.h"
#include "stroke/gesture/symmetry.h"

/// \file
/// Commands from the window to the paint thread, one struct each. They are executed in order.
namespace tuft::app {

/// Stands for the layer added last, whose command may not have run yet.
inline constexpr std::uint32_t kNewestLayer = stroke::kPaletteLayer - 1;

/// Pen down: a stroke begins with these settings.
struct BeginStroke {
    std::string brush, ink;
    stroke::Symmetry symmetry;
    bool persistent = false;                    ///< the brush keeps hair and ink of the stroke before
    bool as_it_is = false;                      ///< as `persistent`, without dipping, whatever ink is chosen
    std::uint32_t layer = stroke::kFirstLayer;  ///< or the palette
    std::uint32_t mask = 0;                     ///< id; 0: none
    bool erases = false;
    bool wet = false;        ///< ink flows and mixes
    std::string tip_ink;     ///< loaded into the tip before every stroke; empty: none
    double tip_depth = 0.3;  ///< of that ink, fraction of the tuft's length
    bool joined = false;     ///< is undone together with the step before
};
/// Dips, rinses, wipes or reshapes a brush.
struct ActOnBrush {
    stroke::BrushChange what;
    std::string brush, ink;
};
/// All layers flow and dry for a while, or all ink leaves the palette.
struct TendInk {
    std::variant<stroke::Dry, stroke::WashPalette> what;
};
/// Poses of the ferrule that continue the stroke.
struct ExtendStroke {
    std::vector<brush::Pose> poses;
    double requested_at = 0;  ///< seconds on the window's clock, returned in `ProgressStatus::done`
};
struct EndStroke {};
/// How the strokes of a drawing or of a text enter the journal.
struct GroupSettings {
    std::string name;           ///< of the group; each symmetric copy is another group; empty: no groups
    stroke::Symmetry symmetry;  ///< copies read in the same direction, also beyond a mirror plane
    std::uint32_t layer = stroke::kFirstLayer;
    std::uint32_t mask = 0;
    bool wet = false;
};
/// Paints a drawing placed on the model; one undo step.
struct PaintDrawing {
    PlacedWriting drawing;
    GroupSettings group;
};
/// Writes a text on the model; one undo step.
struct PaintText {
    writer::Text text;
    LetteringPlace place;
    std::string brush, ink;  ///< presets; an empty brush: the style's
    bool fit = false;        ///< to the outlines of the source
    GroupSettings group;
};
struct CancelStroke {};
struct UndoStroke {};
struct RedoStroke {};
/// Fills a part of the model with ink.
struct FillModel {
    std::string ink;
    stroke::Fill fill;
    std::uint32_t layer = stroke::kFirstLayer;
    std::uint32_t mask = 0;
};
/// Eyedropper: makes an ink of the mixture at a point.
struct PickInk {
    Vec3 point{0};  ///< metres, model frame or palette frame
    bool on_palette = false;
};
/// Adds a given ink to the project.
struct TakeInk {
    ink::Ink ink;
};
/// Shows strokes of one ink with another one.
struct RecolourInk {
    std::string name;
    ink::Ink wanted;
};
/// Shows the work on another substrate; nothing is painted again.
struct PreviewSubstrate {
    std::string substrate;
};
/// Creates or removes a mask.
struct ChangeMasks {
    stroke::MaskEdit edit;
    std::uint32_t with = 0;                          ///< id of a mask to combine the new one with; 0: none
    stroke::MaskKind how = stroke::MaskKind::unite;  ///< unite or intersect
};
/// Dims the surface outside a mask; 0: none.
struct ShowMask {
    std::uint32_t id = 0;
};
/// Adds, changes, moves or removes a layer.
struct ChangeLayers {
    stroke::LayerEdit edit;
};
/// Shows, hides, locks parts of the model or gives them a substrate.
struct ChangeParts {
    stroke::PartEdit edit;
};
/// Sets view and size of the layers' thumbnails.
struct LookFrom {
    render::GlCamera camera;
};
/// Sends the whole texture again.
struct SendTexture {
    bool wetness = false;  ///< the fourth channel is liquid instead of height
};
/// Stores the project under a path, where it stays open.
struct SaveProject {
    std::filesystem::path path;
};
/// Tries again to write waiting changes.
struct RetrySaving {};
/// Writes the textured model, one map or pictures, by the extension of `path`.
struct ExportModel {
    std::filesystem::path path;
    bool height = true, orm = true;        ///< maps besides the base colour
    bool pigments = false;                 ///< also pigment maps, where the path is an .exr file
    std::uint32_t size = 0;                ///< texels per side; 0: as painted
    int pictures = 0;                      ///< of the model: none, one, or that many round it
    int picture_width = 1280;              ///< pixels; 16 : 9
    double azimuth = 0, elevation = 0.45;  ///< radians, of the pictures' view
};
/// Writes what is painted, or a mask, as sheets of film. Title and progress of the request are the paint thread's.
struct ExportSheets {
    std::filesystem::path path;  ///< .pdf, .svg or .dxf
    io::SheetRequest request;
};
/// Paints the journal again on a second document and films it. The film's progress is the paint thread's.
struct ExportFilm {
    std::filesystem::path path;  ///< .mp4, .gif, or a folder of frames
    pictures::FilmOptions film;
};
/// p → to + rotation (p − from)
struct RigidMove {
    Vec3 from{0}, to{0};  ///< metres
    Quat rotation{1, 0, 0, 0};
};
/// Changes existing entries in one undo step, then repaints what depends on them.
struct EditStrokes {
    std::vector<std::uint64_t> ids = {};  ///< unknown ids are ignored
    std::optional<bool> hidden = {};
    std::optional<std::string> brush = {};  ///< name without size; each stroke keeps its own size factor
    std::optional<std::string> ink = {};    ///< of strokes, dips and fills
    std::optional<RigidMove> move = {};
    std::optional<std::string> group = {};  ///< name of their new group; empty: removes them from their groups
    bool remove = false;
};
/// Highlights the texels with ink of these entries; none: nothing.
struct HighlightStrokes {
    std::vector<std::uint64_t> ids;
};
/// Stores an attachment in the project (io/project/attachments.h), or removes it.
struct AttachToProject {
    std::string kind;
    io::Attachment attachment;
};
/// Removes an attachment of the project.
struct DetachFromProject {
    std::string kind, name;
};
/// Stores the present journal under a name.
struct TakeSnapshot {
    std::string name;
};
/// Gives a snapshot another name.
struct RenameSnapshot {
    std::string id, name;
};
/// Paints a snapshot on a second document and passes its texels to the window.
struct ShowSnapshot {
    std::string id;
};
/// Replaces the journal by a snapshot's; one undo step.
struct RestoreSnapshot {
    std::string id;
};
using Command =
    std::variant<AttachToProject, DetachFromProject, TakeSnapshot, RenameSnapshot, ShowSnapshot, RestoreSnapshot,
                 BeginStroke, ExtendStroke, EndStroke, CancelStroke, PaintDrawing, PaintText, ActOnBrush, TendInk,
                 UndoStroke, RedoStroke, SaveProject, RetrySaving, ExportModel, ExportSheets, ExportFilm, EditStrokes,
                 HighlightStrokes, FillModel, ChangeLayers, SendTexture, PickInk, TakeInk, RecolourInk,
                 PreviewSubstrate, ChangeMasks, ChangeParts, ShowMask, LookFrom>;

/// Returns true when the command changes the work. It is refused while a project is only viewed.
bool changes_work(const Command& command);

}  // namespace tuft::app
