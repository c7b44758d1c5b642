#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "app/document/autosave.h"
#include "app/document/snapshots.h"
#include "app/document/thumbnails.h"
#include "app/document/writing.h"
#include "app/view/texture.h"
#include "stroke/gesture/symmetry.h"
#include "stroke/painting/fit.h"
#include "stroke/painting/painting.h"

namespace tuft::app {

/// In the place of a layer: the one added last, which may still be asked for.
inline constexpr std::uint32_t kNewestLayer = stroke::kPaletteLayer - 1;

/// What the painter is asked to do; it does so in order.
struct BeginStroke {
    std::string brush, ink;
    stroke::Symmetry symmetry;
    bool carry = false;                         ///< goes on with the hair and ink of the stroke before
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
    stroke::Action action = stroke::Action::dip;
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
struct RetryKeeping {};
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
                 SaveProject, RetryKeeping, ExportModel, EditStrokes, HighlightStrokes, FillModel, ChangeLayers,
                 SendTexture, PickInk, TakeInk, RecolourInk, PreviewSubstrate, ChangeMasks, ShowMask, LookFrom>;

/// A stroke for the list.
struct StrokeLine {
    std::uint64_t id = 0;
    stroke::Action action = stroke::Action::stroke;
    std::string brush, ink, label;
    stroke::EntryGroup group;
    bool hidden = false, erases = false, on_palette = false;
    double length = 0;       ///< metres of the hand's way
    std::vector<Vec3f> way;  ///< x, y in [0, 1] (y down), z: pressure in [0, 1]
    bool flat = false;       ///< `way` is in the frame of a drawing
    Vec2 way_centre{0};      ///< metres: of the way (0.5, 0.5) there
    double way_span = 0;     ///< metres: of [0, 1]
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

/// What changed since the last look.
struct Update {
    std::optional<render::MapPixels> pixels;  ///< the whole texture, older than the tiles
    std::vector<render::TilePixels> tiles;
    std::optional<std::vector<StrokeLine>> strokes;
    std::vector<std::string> messages;
    std::optional<brush::TuftState> tuft;                     ///< of the stroke in work; no branches: none
    double done = 0;                                          ///< the latest `ExtendStroke::asked` that is painted
    std::size_t waiting = 0;                                  ///< commands not done yet
    std::string busy;                                         ///< long work being done, ""
    double fraction = 0;                                      ///< of it
    double undo_seconds = 0;                                  ///< that the last undo took
    double fullness = 1;                                      ///< ink in the brush last painted with, of its capacity
    std::optional<std::array<std::uint8_t, 3>> brush_colour;  ///< sRGB of a full film of it
    std::optional<stroke::PalettePicture> palette;            ///< what changed on it
    bool on_palette = false;                                  ///< `tuft` is there
    bool can_undo = false, can_redo = false;
    stroke::LayerTable layers;
    bool from_outside = false;  ///< another program had a part in the change
    stroke::MaskTable masks;
    std::vector<Thumbnail> thumbnails;              ///< of layers, those that changed
    std::optional<std::vector<ink::Ink>> own_inks;  ///< of this work, beside the shipped ones
    std::optional<Appearance> looks;
    std::optional<std::vector<SnapshotLine>> snapshots;
    std::optional<SnapshotPicture> snapshot_picture;
    std::optional<std::vector<OutlinePoint>> outline;  ///< of what was asked to be highlighted
    std::string picked;                                ///< name of an ink just picked up or taken in
    bool wet = false;                                  ///< some ink is
    std::optional<std::pair<std::filesystem::path, std::string>>
        not_saved;           ///< where a project could not be saved, and why
    std::string trouble;     ///< why work is not being kept, ""
    std::size_t unkept = 0;  ///< strokes that wait in memory for that
    bool behind = false;     ///< and so does a change of one
    bool viewing = false;    ///< another program works on the project; it is only looked at
    std::filesystem::path project;
};

/// Paints on a thread of its own, so that drawing never waits for the simulation nor the
/// simulation for drawing. From its making on, only that thread touches the painting.
class PaintThread {
  public:
    struct Work {
        std::unique_ptr<stroke::Model> model;
        std::unique_ptr<stroke::Document> painting;
        std::unique_ptr<Texture> texture;
        render::MapPixels pixels;  ///< what the texture shows at the start, for the graphics card
        Autosave autosave;
        std::string source;
        FileFrame frame;                                 ///< of the model file
        std::vector<stroke::StrokeMismatch> mismatches;  ///< of a revised model: strokes that do not fit it
        std::vector<std::string> fit;                    ///< and how all of them lie on it, for people
        std::filesystem::path spare;                     ///< a file for work that cannot be kept in its own at the end
        std::string note;                                ///< for the person who opened it
    };
    explicit PaintThread(Work work);
    /// Finishes as `finish` does.
    ~PaintThread();
    /// Does everything that was asked for first and keeps it: in `Work::spare` where its own file cannot
    /// be written. Returns that path then; empty: all is in its own file, or it is lost, as `unkept` says.
    std::filesystem::path finish();
    bool unkept() const { return work_.autosave.unkept(); }  ///< after `finish`

    void post(Command command);
    Update take();
    /// Nothing asked for is left to do.
    bool idle() const;
    /// Waits until it is so, but not longer than so many seconds.
    void wait_idle(double seconds) const;
    /// Stops a repainting in work; what was before stays.
    void stop_long_work() { stop_ = true; }

    const stroke::Model& model() const { return *work_.model; }  ///< never changes
    /// The texture as it was at the start; once.
    render::MapPixels take_pixels() { return std::move(work_.pixels); }
    /// What the project carried of a kind when it was opened.
    const std::vector<io::Attachment>& carried_references() const { return carried_; }
    /// Figures of the model's atlas; nullptr while they are measured, which the first call begins.
    const atlas::AtlasReport* atlas_report();
    const std::string& source() const { return work_.source; }
    const FileFrame& frame() const { return work_.frame; }  ///< of the model file

  private:
    /// An entry of the journal that was changed, or taken out.
    struct Change {
        std::size_t at = 0;  ///< its place in the journal before
        stroke::Stroke before;
        std::optional<stroke::Stroke> after;  ///< none: taken out
        bool in_rows = false;                 ///< the file's rows can follow it; else it is written anew
    };
    /// The whole journal, before and after.
    struct Journals {
        std::vector<stroke::Stroke> before, after;
    };
    /// What one undo takes back.
    struct Step {
        std::size_t made = 0;              ///< entries at the journal's end
        std::vector<Change> changes;       ///< or these, in the journal's order
        std::optional<Journals> journals;  ///< or this
        bool joined = false;               ///< and the step before it
    };
    void run();
    void perform(Command& command);
    void begin(const BeginStroke& command);
    void extend(const ExtendStroke& command);
    void end();
    void cancel();
    void drop_loads();
    void fill(const FillModel& command);
    void act(stroke::Stroke entry);
    void change_layers(const ChangeLayers& command);
    void change_masks(const ChangeMasks& command);
    void show_mask(const ShowMask& command);
    void pick(const PickInk& command);
    void add_ink(ink::Ink ink);
    void recolour(const RecolourInk& command);
    void preview_substrate(const PreviewSubstrate& command);
    void send_pixels();
    void send_tiles(std::vector<render::TilePixels> tiles);
    void publish_looks();
    void look_at_brush();
    std::uint32_t layer_of(std::uint32_t asked) const;
    void draw_thumbnails();
    void load_tip(const BeginStroke& command, std::size_t& made);
    void paint_drawing(PaintDrawing& command);
    void care(const ActOnBrush& command);
    void undo();
    void redo();
    void edit(const EditStrokes& command);
    void highlight(const HighlightStrokes& command);
    void rewrite(std::vector<stroke::Stroke> strokes);
    void put(const std::vector<Change>& changes, bool back);
    void put_journal(const std::vector<stroke::Stroke>& entries);
    void publish_snapshots();
    void take_snapshot(const TakeSnapshot& command);
    void rename_snapshot(const RenameSnapshot& command);
    void show_snapshot(const ShowSnapshot& command);
    void restore_snapshot(const RestoreSnapshot& command);
    std::vector<stroke::Stroke> snapshot_entries(const std::string& id) const;
    void take_presets(stroke::Document& painting, const std::vector<stroke::Stroke>& entries);
    void replace_painting(std::unique_ptr<stroke::Document> painting);
    void look_outside();
    void take_outside();
    void leave_file();
    bool follow(const io::Project& file, std::span<const stroke::Stroke> theirs);
    void paint_merged(const io::Project& file, const stroke::MergedJournal& merged);
    void export_model(const ExportModel& command);
    void export_maps(const ExportModel& command, const stroke::Document& painting, const ink::ComposeOptions& compose);
    void export_strokes(const std::filesystem::path& path);
    void draw_pictures(const ExportModel& command, const stroke::Document& painting);
    void publish(bool strokes_changed = false);
    void say(std::string message);
    ProgressFn progress(const std::string& name);

    Work work_;
    std::shared_future<atlas::AtlasReport> measured_;
    BeginStroke current_;
    std::size_t loads_ = 0;                      ///< entries that loaded the brush for the stroke in work
    std::vector<stroke::Stroke> undone_before_;  ///< them, of the journal
    std::vector<ink::Ink> own_inks_;
    stroke::WidthTables widths_;
    stroke::PalettePicture palette_;
    Thumbnails thumbnails_;
    std::optional<std::array<std::uint8_t, 3>> brush_colour_;
    double undo_seconds_ = 0;
    double asked_ = 0, last_publish_ = 0;
    std::vector<io::Attachment> carried_;  ///< reference images at the start
    std::vector<Step> steps_, undone_;     ///< the last one at the back
    std::vector<StrokeLine> lines_;

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    mutable std::condition_variable rests_;
    std::deque<Command> queue_;
    Update update_;
    bool working_ = false, quit_ = false;
    std::atomic<bool> stop_{false};
    std::filesystem::path spared_;  ///< the work is there at the end
    std::thread thread_;
};

/// The list entry of a stroke.
StrokeLine stroke_line(const stroke::Stroke& stroke);

}  // namespace tuft::app
