#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stroke/journal/journal.h"
#include "stroke/painting/painted_model.h"
#include "stroke/session/report.h"

/// \file
/// A decorated model: its journal, and the texels made from it. The studio, `tuft` and the tests paint through
/// `Document`; there is no second path. `samples/hello` is the smallest program that does.
namespace tuft::stroke {

struct HandPath;
class PathAhead;
class StrokeSession;

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

    const Model& model() const { return painted_.model; }
    const Journal& journal() const { return journal_; }
    const LayerStack& layers() const { return painted_.layers; }
    /// A stroke or fill that names a mask leaves the texels outside it as they are. What it leaves wet does not flow
    /// over the mask's edge: the mask stays on the layer until something is painted there with another mask or none.
    const MaskSet& masks() const { return painted_.masks; }
    /// Hidden parts are as if they were not there: strokes go through to what lies behind them, and drawings are placed
    /// on what is seen. Locked parts are touched and get no ink. An eraser takes none from either.
    const PartSet& parts() const { return painted_.parts; }
    /// Strokes and fills with the layer `kPaletteLayer` go onto it, with wet ink; `WashPalette` cleans it. It is no
    /// part of `layers`.
    const Palette& palette() const { return painted_.palette; }
    const Materials& materials() const { return painted_.materials; }
    /// Brushes as the last entry with them left them. None is held after `adopt`.
    const BrushesInHand& brushes() const { return painted_.brushes; }
    Appearance& appearance() { return painted_.appearance; }
    const Appearance& appearance() const { return painted_.appearance; }

    /// Takes a preset in the place of others of its name, for entries from now on (a project brings its own). A brush
    /// of that name is no longer held.
    void use(const brush::Preset& preset);
    void use(const ink::Ink& ink) { painted_.materials.use(ink); }
    void use(const ink::Substrate& substrate) { painted_.materials.use(substrate); }
    /// `Materials::mix_together`.
    void mix_together(const std::map<std::string, double>& weights) { painted_.materials.mix_together(weights); }
    /// `Materials::forget_inks`. No entry of the journal may name one of them.
    void forget_inks(const std::vector<std::string>& names) { painted_.materials.forget_inks(names); }

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
    void check_size(const JournalEntry& entry) const;
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
    /// How entries that are performed in turn enter the journal.
    struct EntrySteps {
        std::function<void(JournalEntry& entry, std::size_t ahead)> prepare;  // `ahead`: entries not yet appended
        std::function<void(JournalEntry& entry, StrokeReport report)> append;
    };
    StrokeReport perform(const JournalEntry& entry, const ProgressFn& progress, PathAhead* path = nullptr);
    void perform_all(std::vector<JournalEntry>& entries, const EntrySteps& steps, const ProgressFn& progress);
    StrokeReport draw(std::uint64_t id, const PaintStroke& stroke, const HandPath& path, const ProgressFn& progress);
    StrokeReport finish_session(std::uint64_t id);
    std::span<const JournalEntry> entries_before(std::uint64_t id) const;
    void repaint_all();

    struct StrokeInWork {
        std::unique_ptr<StrokeSession> session;
        JournalEntry entry;  ///< its header, from `begin` to `end`
    };

    Journal journal_;
    PaintedModel painted_;
    StrokeInWork in_work_;
    PoseFn watcher_;
};

/// Texels of all layers, and of the palette where there is something on it: what a project stores.
std::vector<LayerTexels> all_canvases(const Document& document);

}  // namespace tuft::stroke
