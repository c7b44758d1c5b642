#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stroke/document/brushes_in_hand.h"
#include "stroke/document/paint_target.h"
#include "stroke/document/undo_history.h"
#include "stroke/journal/journal.h"
#include "stroke/layers/appearance.h"
#include "stroke/layers/layer_stack.h"
#include "stroke/layers/mask_set.h"
#include "stroke/layers/materials.h"
#include "stroke/layers/model_film.h"
#include "stroke/layers/palette.h"
#include "stroke/layers/part_set.h"
#include "stroke/session/report.h"
#include "stroke/surface/model.h"

/// \file
/// A decorated model: its journal, and the texels made from it. The studio, `tuft` and the tests paint through
/// `Document`; there is no second path. `samples/hello` is the smallest program that does.
namespace tuft::stroke {

/// Options of `Document`.
struct DocumentOptions {
    std::string substrate = "porcelain";              ///< name of a shipped one; `Document::use` takes any other
    std::size_t undo_bytes = std::size_t{256} << 20;  ///< of retained tiles; older entries are undone by replay
    bool record_forces = false;                       ///< fills `StrokeReport::forces`
    DiskCache tip_lags = shared_tip_lag_cache();      ///< of measured tip lags
};

class FlatTexels;
struct FillResult;
struct HandPath;
class PathAhead;
class PlanScratchPool;
struct SessionInput;
struct SessionResult;
class StrokeSession;
class TileReach;
struct TileUse;
struct WetFilmInUse;

/// Called with an entry that has been performed and appended to the journal, in the journal's order, by the thread that
/// waits for the document.
using EntryDoneFn = std::function<void(const JournalEntry& entry, StrokeReport report)>;

/// Called after every pose of a stroke in work, with the part of its path that is painted, 0–1. Thread of the document.
using PoseFn = std::function<void(const StrokeSession& session, double part)>;

/// A journal and what its entries make: layers, masks, palette, and the brushes in hand. Each entry is performed once,
/// in order; the same entries give the same bits, for any number of threads. `model` must outlive the document. Its
/// parts refer to each other, so it is neither copied nor moved. One thread at a time.
class Document {
  public:
    explicit Document(const Model& model, const DocumentOptions& options = {});
    ~Document();
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    const Model& model() const { return model_; }
    const Journal& journal() const { return journal_; }
    const LayerStack& layers() const { return layers_; }
    /// A stroke or fill that names a mask leaves the texels outside it as they are. What it leaves wet does not flow
    /// over the mask's edge: the mask stays on the layer until something is painted there with another mask or none.
    const MaskSet& masks() const { return masks_; }
    /// Hidden parts are as if they were not there: strokes go through to what lies behind them, and drawings are placed
    /// on what is seen. Locked parts are touched and get no ink. An eraser takes none from either.
    const PartSet& parts() const { return parts_; }
    /// Strokes and fills with the layer `kPaletteLayer` go onto it, with wet ink; `WashPalette` cleans it. It is no
    /// part of `layers`.
    const Palette& palette() const { return palette_; }
    const Materials& materials() const { return materials_; }
    /// Brushes as the last entry with them left them. None is held after `adopt`.
    const BrushesInHand& brushes() const { return brushes_; }
    Appearance& appearance() { return appearance_; }
    const Appearance& appearance() const { return appearance_; }

    /// Takes a preset in the place of others of its name, for entries from now on (a project brings its own). A brush
    /// of that name is no longer held.
    void use(const brush::Preset& preset);
    void use(const ink::Ink& ink) { materials_.use(ink); }
    void use(const ink::Substrate& substrate) { materials_.use(substrate); }
    /// `Materials::mix_together`.
    void mix_together(const std::map<std::string, double>& weights) { materials_.mix_together(weights); }
    /// `Materials::forget_inks`. No entry of the journal may name one of them.
    void forget_inks(const std::vector<std::string>& names) { materials_.forget_inks(names); }

    /// Performs the entry and appends it to the journal. Throws `Error`, before anything is changed, for an unknown
    /// brush, ink, layer or mask, a locked layer, a stroke without samples. Throws `Cancelled` when `progress` stops
    /// it; then nothing has changed either.
    ///
    /// With `DipMode::each` an entry begins with a clean, straight, full brush, with `DipMode::persistent` with the
    /// brush in hand (`BrushesInHand::take_up_for_stroke`). A brush that is not held is fresh: its entry is stored as
    /// "each", so that a replay is the same.
    StrokeReport paint(JournalEntry entry, const ProgressFn& progress = {});

    /// The same for each entry in turn. Strokes with fresh brushes and still ink are painted side by side where the
    /// tiles that they can reach differ; the bits are those of `paint` one after the other. When an entry throws, those
    /// before it are done, and those from it on are not. `progress` is called from one thread at a time, not always
    /// the same.
    void paint(std::vector<JournalEntry> entries, const EntryDoneFn& done, const ProgressFn& progress = {});

    /// Throws the `Error` of `paint` for a stroke of the model that is too large: its brush is too wide for the texels,
    /// or its path is at least twice the longest that is painted. Paints nothing and maps nothing to the surface.
    void check_size(const JournalEntry& entry);
    /// Throws the `Error` of `paint` for an entry whose layer, mask or part is missing, or whose layer is locked.
    void check_layer(const JournalEntry& entry) const;

    /// The same in pieces for a hand in space: `begin`, any number of `extend`, then `end` or `cancel`, which takes the
    /// stroke back. `entry` holds a `PaintStroke`, whose samples may be empty.
    void begin(JournalEntry entry);
    /// `painted`: called after every few stamps; it may read the document.
    void extend(std::span<const brush::Pose> poses, const std::function<void()>& painted = {});
    StrokeReport end();
    void cancel();
    /// The stroke begun; null between strokes.
    const StrokeSession* session() const { return in_work_.session.get(); }

    /// Takes over a stored journal, ids kept, and performs what is not hidden. Returns a report per stroke.
    std::vector<StrokeReport> replay(std::vector<JournalEntry> entries, const ProgressFn& progress = {});
    /// Lets `watcher` see strokes while they are painted; null: none. Watched strokes are painted one after the other;
    /// the bits are the same. Texels are up to 8 stamps behind the brush. It may read the document, not change it.
    void watch_poses(PoseFn watcher) { watcher_ = std::move(watcher); }
    /// Takes over a stored journal with the texels of layers and palette as they were after entry `last`; performs what
    /// came after it. Throws `Error` for texels of another atlas, and where `fits` does not hold or layers are missing:
    /// then the journal must be replayed.
    void adopt(std::vector<JournalEntry> entries, std::vector<LayerCanvas> canvases, std::uint64_t last);

    /// Takes the last entry back, or performs the last one taken back again. Returns false when there is none. Costs a
    /// copy of the tiles it changed, or a replay of everything once `undo_bytes` are used up.
    bool undo();
    bool redo();
    /// See `Journal::restore_undone`.
    void restore_undone(std::vector<JournalEntry> undone) { journal_.restore_undone(std::move(undone)); }

  private:
    void settle(PaintStroke& stroke) const;
    void settle(EntryContent& content) const;

    StrokeReport perform(const JournalEntry& entry, const ProgressFn& progress, PathAhead* path = nullptr);
    StrokeReport draw(std::uint64_t id, const PaintStroke& stroke, const HandPath& path, const ProgressFn& progress);
    void act(std::uint64_t id, const BrushAction& action);
    void dry(std::uint64_t id, const Dry& wait, const ProgressFn& progress);
    void wash(std::uint64_t id);
    StrokeReport fill(std::uint64_t id, const Fill& fill);
    FillResult fill_area(const Fill& fill);
    void edit_layers(std::uint64_t id, const LayerEdit& edit);
    void edit_masks(std::uint64_t id, const MaskEdit& edit);
    void edit_parts(std::uint64_t id, const PartEdit& edit);
    void set_parts(PartTable table);

    /// How entries that are performed in turn enter the journal.
    struct EntrySteps {
        std::function<void(JournalEntry& entry, std::size_t ahead)> prepare;  // `ahead`: entries not yet appended
        std::function<void(JournalEntry& entry, StrokeReport report)> append;
    };
    struct BatchStroke;
    void perform_all(std::vector<JournalEntry>& entries, const EntrySteps& steps, const ProgressFn& progress);
    bool paints_beside_others(const JournalEntry& entry) const;
    std::vector<BatchStroke> plan_batch(std::span<JournalEntry> entries, const EntrySteps& steps);
    bool plan_stroke(BatchStroke& stroke);
    void plan_path(BatchStroke& planned) const;
    void start_session(BatchStroke& planned) const;
    void paint_step(BatchStroke& stroke, std::size_t step, const ProgressFn& progress) const;
    void paint_batch(std::vector<BatchStroke>& batch, const ProgressFn& progress);
    std::size_t append_batch(std::vector<BatchStroke>& batch, const EntrySteps& steps);
    void take_back(std::span<BatchStroke> batch);

    HandPath path_of(const PaintStroke& stroke);
    std::unique_ptr<PathAhead> plan_path_ahead(const JournalEntry& entry);
    std::unique_ptr<StrokeSession> make_session(PaintStroke stroke);
    SessionInput session_input(PaintStroke stroke, const std::vector<TileUse>* plan);
    StrokeReport finish_session(std::uint64_t id);
    StrokeReport put_down(std::uint64_t id, const PaintStroke& stroke, SessionResult result, std::size_t n_pigments);
    BrushStart brush_start(const PaintStroke& stroke);
    BrushInHand take_up(const PaintStroke& stroke, const BrushStart& start) const;
    WetFilmInUse wet_film_for(const PaintStroke& stroke, const PaintTarget& target);

    const mesh::SurfaceQuery& surface() const { return *parts_.surface(); }
    ink::WetFilm& film_within(std::uint32_t mask);
    ink::Canvas& canvas(std::uint32_t layer);
    PaintTarget target(std::uint32_t layer, std::uint32_t mask);
    ink::Mix mix_of(const std::string& ink);
    brush::Preset preset_of(const std::string& brush, brush::SpineMethod spine) const;
    HolderOptions holder_of(const PaintStroke& stroke);
    std::uint32_t stencil_mask_on(std::uint32_t layer, std::uint64_t before) const;

    void record(UndoRecord record);
    void take_back(UndoRecord record);
    void restore(const std::vector<LayerTiles>& tiles);
    void forget_pigments();
    void repaint_all();

    /// What is computed once and used by many entries.
    struct Scratch {
        std::unique_ptr<FlatTexels> flat_texels;  ///< of the last area
        std::unique_ptr<PlanScratchPool> plans;
        std::unique_ptr<TileReach> tile_reach;  ///< of the model, made for the first batch of strokes
        std::shared_ptr<Drapes> drapes;         ///< of the visible surface
    };
    struct StrokeInWork {
        std::unique_ptr<StrokeSession> session;
        JournalEntry entry;  ///< its header, from `begin` to `end`
    };

    const Model& model_;
    DocumentOptions options_;
    Journal journal_;
    LayerStack layers_;
    MaskSet masks_;
    PartSet parts_;
    Palette palette_;
    Materials materials_;
    BrushesInHand brushes_;
    Appearance appearance_;
    ModelFilm film_;
    UndoHistory history_;
    Scratch scratch_;
    StrokeInWork in_work_;
    PoseFn watcher_;
};

/// Texels of all layers, and of the palette where there is something on it: what a project stores.
std::vector<LayerTexels> all_canvases(const Document& document);

}  // namespace tuft::stroke
