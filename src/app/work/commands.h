#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/document/writing.h"
#include "brush/tuft/tuft.h"
#include "io/project/attachments.h"
#include "render/gl/gl_camera.h"
#include "stroke/document/document.h"
#include "stroke/gesture/symmetry.h"

/// \file
/// What the window asks the paint thread to do: a struct for each command. They are done in order.
namespace tuft::app {

/// In the place of a layer: the one added last, which may still be requested.
inline constexpr std::uint32_t kNewestLayer = stroke::kPaletteLayer - 1;

struct BeginStroke {
    std::string brush, ink;
    stroke::Symmetry symmetry;
    bool persistent = false;                    ///< goes on with the hair and ink of the stroke before
    bool as_it_is = false;                      ///< with what is in the brush, whatever ink is chosen; where it is held
    std::uint32_t layer = stroke::kFirstLayer;  ///< or the palette
    std::uint32_t mask = 0;                     ///< kept to; 0: none
    bool erases = false;                        ///< takes ink off
    bool wet = false;                           ///< ink that flows and mixes
    std::string tip_ink;                        ///< every stroke begins with this one in the tip; empty: with one ink
    double tip_depth = 0.3;                     ///< of it, part of the tuft's length
    bool joined = false;                        ///< is undone together with the one before it
};
/// Dips, rinses, wipes or combs a brush, or lets the ink dry.
struct ActOnBrush {
    stroke::EntryKind action = stroke::EntryKind::dip;
    std::string brush, ink;
    double seconds = 0;          ///< of drying; 0: until all is dry
    stroke::Extent extent = {};  ///< of a dip or a wipe
};
struct ExtendStroke {
    std::vector<brush::Pose> poses;
    double asked = 0;  ///< seconds on the window's clock, comes back in `Update::done`
};
struct EndStroke {};
/// Paints a drawing that has been placed on the model; undone together.
struct PaintDrawing {
    PlacedWriting drawing;
    std::string name;  ///< its strokes are a group of this name, each symmetric copy another one; empty: no groups
    stroke::Symmetry symmetry;  ///< the drawing reads the same way in each copy, also beyond a mirror plane
    std::uint32_t layer = stroke::kFirstLayer;
    std::uint32_t mask = 0;
    bool wet = false;
};
struct CancelStroke {};
struct UndoStroke {};
struct RedoStroke {};
/// Lays ink over a part of the model.
struct FillModel {
    std::string ink;
    stroke::Fill fill;
    std::uint32_t layer = stroke::kFirstLayer;
    std::uint32_t mask = 0;
};
/// The eyedropper: what lies at a place becomes an ink of its own.
struct PickInk {
    Vec3 point{0};  ///< metres, frame of the model or the palette
    bool on_palette = false;
};
/// Takes an ink in from outside.
struct TakeInk {
    ink::Ink ink;
};
/// Shows what is painted with one ink as if it were another one.
struct RecolourInk {
    std::string name;
    ink::Ink wanted;
};
/// Shows the work on another material; nothing is painted anew.
struct PreviewSubstrate {
    std::string substrate;
};
/// Makes or ends a mask.
struct ChangeMasks {
    stroke::MaskEdit edit;
    std::uint32_t with = 0;  ///< a new one: another mask that it is taken together with; 0: none
    stroke::MaskKind how = stroke::MaskKind::unite;  ///< or intersect
};
/// Veils what a mask leaves out; 0: nothing.
struct ShowMask {
    std::uint32_t id = 0;
};
/// Adds, changes, moves or removes a layer.
struct ChangeLayers {
    stroke::LayerEdit edit;
};
/// From where the layers' small pictures are seen, and how large they are.
struct LookFrom {
    render::GlCamera camera;
};
/// Hands over the whole texture anew.
struct SendTexture {
    bool wetness = false;  ///< its fourth channel: the liquid, not the ink's height
};
struct SaveProject {
    std::filesystem::path path;
};
/// Tries once more to write what could not be written.
struct RetrySaving {};
struct ExportModel {
    std::filesystem::path path;
    bool height = true, orm = true;        ///< maps besides the base colour
    bool pigments = false;                 ///< likewise, where the path is an .exr file
    std::uint32_t size = 0;                ///< texels per side; 0: as painted
    int pictures = 0;                      ///< of the model beside it: none, one, or that many all round
    int picture_width = 1280;              ///< pixels; 16 : 9
    double azimuth = 0, elevation = 0.45;  ///< radians, from where they are seen
};
/// p → to + rotation (p − from)
struct RigidMove {
    Vec3 from{0}, to{0};  ///< metres
    Quat rotation{1, 0, 0, 0};
};
/// Changes entries that are already there, all at once and undone as one; the rest is painted again.
struct EditStrokes {
    std::vector<std::uint64_t> ids = {};  ///< others than the journal's are left aside
    std::optional<bool> hidden = {};
    std::optional<std::string> brush = {};  ///< name without a size: each stroke keeps its own factor
    std::optional<std::string> ink = {};    ///< of strokes, dips and fills
    std::optional<RigidMove> move = {};
    std::optional<std::string> group = {};  ///< makes them a group of that name; empty: takes them out of theirs
    bool remove = false;
};
/// Highlights the texels that these entries leave ink on; none: nothing.
struct HighlightStrokes {
    std::vector<std::uint64_t> ids;
};
/// Keeps something along with the work (io/project/attachments.h), or takes it out.
struct AttachToProject {
    std::string kind;
    io::Attachment attachment;
};
struct DetachFromProject {
    std::string kind, name;
};
/// Keeps the journal as it is now under a name.
struct TakeSnapshot {
    std::string name;
};
struct RenameSnapshot {
    std::string id, name;
};
/// Paints a snapshot beside the work and hands over its picture.
struct ShowSnapshot {
    std::string id;
};
/// Puts a snapshot in the place of the journal; undone as one.
struct RestoreSnapshot {
    std::string id;
};
using Command =
    std::variant<AttachToProject, DetachFromProject, TakeSnapshot, RenameSnapshot, ShowSnapshot, RestoreSnapshot,
                 BeginStroke, ExtendStroke, EndStroke, CancelStroke, PaintDrawing, ActOnBrush, UndoStroke, RedoStroke,
                 SaveProject, RetrySaving, ExportModel, EditStrokes, HighlightStrokes, FillModel, ChangeLayers,
                 SendTexture, PickInk, TakeInk, RecolourInk, PreviewSubstrate, ChangeMasks, ShowMask, LookFrom>;

/// The command changes the work. Who only looks at a project may not ask for it.
bool changes_work(const Command& command);

}  // namespace tuft::app
