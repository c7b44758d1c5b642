#pragma once

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "ink/canvas/canvas.h"
#include "ink/colour/pigments.h"
#include "ink/composite/composite.h"
#include "ink/film/film.h"
#include "stroke/contact/tuft_in_hand.h"
#include "stroke/document/palette.h"
#include "stroke/journal/journal.h"
#include "stroke/journal/tables.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/tip_lag.h"
#include "stroke/session/report.h"
#include "stroke/surface/mask_texels.h"
#include "stroke/surface/model.h"

namespace tuft::stroke {

struct DocumentOptions {
    std::string substrate = "porcelain";              ///< preset name; `use_substrate` takes any other
    std::size_t undo_bytes = std::size_t{256} << 20;  ///< kept copies of tiles; older strokes undo by replay
    bool record_forces = false;
};

/// One film of a texel, film units by pigment plane.
struct PickedFilm {
    std::uint32_t layer = kFirstLayer;
    int film = ink::kOpenFilm;  ///< as in ink::Canvas, from the soaked one to the open one
    std::array<double, ink::kMaxPigments> amounts{};
};

/// What lies on the surface at a point.
struct Pick {
    mesh::SurfacePoint at;  ///< nearest to the point asked for
    atlas::TexelRef texel;
    std::vector<PickedFilm> films;                    ///< of the layers to be seen, the lowest first, none empty
    std::array<double, ink::kMaxPigments> amounts{};  ///< of them all, by plane of `Document::canvas`
    double liquid = 0;                                ///< film units, on the surface and in it
};

class PlanScratchPool;
class StrokeSession;
class Document;

/// Draws what the palette of a painting looks like: all of it, or only these slots anew.
void refresh(PalettePicture& picture, const Document& painting);
void refresh(PalettePicture& picture, const Document& painting, std::span<const std::uint32_t> slots);

/// A model being painted: its journal and the texels made from it. The model must
/// outlive it. All strokes take one path, whether they come from a file, a project or a
/// hand that moves right now: sample → resample → contact → brush → footprint → ink.
class Document {
  public:
    explicit Document(const Model& model, const DocumentOptions& options = {});
    ~Document();
    Document(Document&&) noexcept;
    Document& operator=(Document&&) noexcept;

    /// Presets that take the place of the shipped ones of the same name, for the strokes
    /// that are painted from now on (a project brings its own).
    void use_brush(const brush::Preset& preset);
    void use_ink(const ink::Ink& ink);
    const brush::Preset& brush(const std::string& name);
    /// A colour `#rrggbb` is an ink, too: the nearest mix (ink/composite/match.h) on the substrate.
    const ink::Ink& ink(const std::string& name);

    /// Paints a whole stroke, or does an action with its brush, and appends it to the
    /// journal. Throws `Error` for a stroke that names an unknown brush or ink or has no
    /// samples, before anything is changed.
    ///
    /// With `settings.dip` "each" the entry begins with a clean, straight, full brush. With
    /// "persistent" it begins with hair and ink as the last entry with that brush left them; it is
    /// washed and dipped anew where a stroke names another ink than the stroke before and the
    /// brush was not dipped into that one. A brush that this painting does not hold yet is
    /// fresh: its entry is kept in the journal as "each", so that a replay is the same.
    StrokeReport paint(JournalEntry entry, const ProgressFn& progress = {});

    /// The same in pieces for poses in space: `begin`, any number of `extend`, `end`.
    /// `entry` holds a `PaintStroke`, whose samples may be empty. `cancel` takes it back instead.
    void begin(JournalEntry entry);
    void extend(std::span<const brush::Pose> poses);
    StrokeReport end();
    void cancel();
    bool in_stroke() const { return session_ != nullptr; }
    /// The bent tuft at the last sample, for drawing it; empty between strokes.
    const brush::TuftState* tuft() const;
    /// What a haptic device shall give at the last sample, newtons; 0 between strokes.
    Vec3 device_force() const;

    /// The brush as the last entry with it left it; null when this painting does not hold it.
    const BrushInHand* held(const std::string& brush) const;

    /// Takes over a stored journal, ids kept, and paints what is not hidden. One report per
    /// stroke painted, none for actions.
    std::vector<StrokeReport> replay(std::vector<JournalEntry> strokes, const ProgressFn& progress = {});

    /// Takes over a stored journal together with the texels it once made. Throws `Error`
    /// when they were made for another texel map. The brushes are not held then.
    void adopt(std::vector<JournalEntry> strokes, ink::Canvas canvas);
    /// The same with the texels of every layer as they were after entry `stroke_id`. Throws
    /// `Error` also when something else than changes of layers came after it, or when layers are
    /// missing: then it must be replayed.
    void adopt(std::vector<JournalEntry> strokes, std::vector<LayerCanvas> canvases, std::uint64_t stroke_id);

    /// Takes the last stroke back, or paints the last one taken back again; false when
    /// there is none. Costs a copy of the tiles it touched, or a replay of everything
    /// once `undo_bytes` are used up.
    bool undo();
    bool redo();
    /// See `Journal::restore_undone`.
    void restore_undone(std::vector<JournalEntry> undone) { journal_.restore_undone(std::move(undone)); }

    const Journal& journal() const { return journal_; }
    const Model& model() const { return *model_; }
    /// The texels of the layer that every painting begins with.
    const ink::Canvas& canvas() const { return canvas_; }
    ink::Canvas& canvas() { return canvas_; }
    /// The same of any layer; throws `Error` when there is none of this id. All layers have the
    /// same pigments in the same planes once they have been asked for here.
    ink::Canvas& canvas(std::uint32_t layer);
    /// Of all layers, the lowest first.
    std::vector<LayerTexels> canvases() const;
    /// The layers now. They are changed by entries with a `LayerEdit`, which
    /// costs no texel; undo and redo go over them as over strokes.
    const LayerTable& layers() const { return layers_; }
    /// The same and the palette, where there is something on it: what a project stores.
    std::vector<LayerTexels> all_canvases() const;
    /// What is to be seen: the visible layers, or those of `show_only`.
    ink::Stack stack() const;
    /// Shows these layers alone, whatever the table says; empty: as it says. Not kept.
    void show_only(std::vector<std::uint32_t> layers);
    /// The masks now; entries with a `MaskEdit` change them. A stroke or fill that names one in
    /// `mask` leaves everything outside it as it is. What it leaves wet does not flow over the
    /// mask's edge either: the mask stays on the layer, as stencil edge does, until something is painted there
    /// with another one or none.
    const MaskTable& masks() const { return masks_; }
    /// The mask on this model's texels; made at the first call and kept. Throws `Error` when there
    /// is none of this id, or when it cannot be on this mesh.
    const MaskTexels& mask(std::uint32_t id);

    /// The eyedropper: what lies at the surface point nearest to `point`.
    Pick pick(const Vec3& point) const;
    /// The same on the palette, in its frame.
    Pick pick_palette(const Vec3& point);

    /// The texels of the palette; null while nothing was put on it. Strokes and fills with the
    /// layer `kPaletteLayer` go onto it, always with wet ink; `WashPalette` cleans it. It is
    /// no part of `hash`, `canvases` and `stack`.
    const ink::Canvas* palette() const { return palette_ ? &palette_->canvas : nullptr; }
    /// The plate; made at the first call.
    const Model& palette_model() { return plate().model; }
    /// Slots of the palette whose look changed since the last call, ascending.
    std::vector<std::uint32_t> take_palette_dirty();
    /// An ink that is all pigment, in the proportions picked, and leaves as thick a film; nothing
    /// where the surface is bare. Take it up by `use_ink`.
    std::optional<ink::Ink> ink_of(const Pick& pick, const std::string& name) const;

    /// Hash of the texels of all layers; of one layer as its canvas has it.
    std::uint64_t hash() const;
    /// What the maps show the ink on: what it was painted on, unless `preview_substrate` said otherwise.
    const ink::Substrate& substrate() const { return previewed_substrate_ ? *previewed_substrate_ : substrate_; }
    const ink::Substrate& painted_on() const { return substrate_; }
    void use_substrate(const ink::Substrate& substrate) { substrate_ = substrate; }
    /// Shows the ink on another substrate; nothing is painted anew, no amount changes.
    void preview_substrate(std::optional<ink::Substrate> substrate);
    bool has_preview_substrate() const { return previewed_substrate_.has_value(); }
    /// Shows what was and will be painted with ink `name` as if it were `wanted`
    /// (ink/recolour.h). Amounts, and what replays paint, stay as they are.
    void recolour(const std::string& name, const ink::Ink& wanted);
    const std::map<std::string, ink::Ink>& recolours() const { return recolours_; }
    /// How maps are made of this painting: gutters continued over the seams. The plan behind
    /// it is made at the first call (0.3–1 s) and belongs to the painting.
    ink::ComposeOptions compose_options() const;
    /// Slots whose look changed since the last call, ascending.
    std::vector<std::uint32_t> take_dirty();

    friend void refresh(PalettePicture& picture, const Document& painting, std::span<const std::uint32_t> slots);

  private:
    struct Undo {
        std::uint64_t stroke_id = 0;
        std::vector<LayerTiles> before;
        std::optional<LayerTable> layers;         ///< before an edit of them
        std::optional<MaskTable> masks;           ///< before an edit of them
        std::optional<LayerCanvas> canvas;        ///< that the edit took away
        std::string brush;                        ///< empty: none had a part in it
        std::optional<BrushInHand> brush_before;  ///< nothing: it was not held
        std::size_t pigments = 0;                 ///< known before the entry
        std::size_t bytes = 0;
    };
    /// How an entry takes its brush up.
    struct BrushStart {
        const std::string &brush, &ink;
        std::uint64_t seed = 0;
        DipMode dip = DipMode::each;
        brush::SpineMethod spine = brush::SpineMethod::rod;
    };

    StrokeReport perform(const JournalEntry& entry, const ProgressFn& progress);
    StrokeReport draw(std::uint64_t id, const PaintStroke& stroke, const ProgressFn& progress);
    StrokeReport finish_session(std::uint64_t id);
    void act(std::uint64_t id, const BrushAction& action);
    void dry(std::uint64_t id, const Dry& wait, const ProgressFn& progress);
    void take_back(const std::vector<LayerTiles>& before);
    ink::WetFilm& film(std::uint32_t mask);
    std::uint32_t stencil_mask_on(std::uint32_t layer, std::uint64_t before_id) const;
    const atlas::SeamLinks& seams();
    Palette& plate();
    void wash(std::uint64_t id);
    const Model& target_model(std::uint32_t layer);
    const ink::Substrate& substrate_of(std::uint32_t layer) const;
    Pick pick_at(const Vec3& point, const Model& model, std::span<const LayerTexels> layers) const;
    void edit_layers(std::uint64_t entry_id, const LayerEdit& edit);
    LayerCanvas take_texels(std::uint32_t id);
    LayerTiles merge_texels(std::uint32_t into, const ink::Canvas& from);
    StrokeReport lay_fill(std::uint64_t id, const Fill& fill);
    void edit_masks(std::uint64_t entry_id, const MaskEdit& edit);
    std::vector<LayerTexels> shown_layers() const;
    void take_back_layers(Undo& undo);
    void set_layers(LayerTable table);
    void check_layer(const JournalEntry& entry) const;
    void touch_look(std::uint32_t layer);
    void begin_session(PaintStroke stroke);
    void settle(PaintStroke& stroke) const;
    void settle(EntryContent& content) const;
    BrushInHand take_up(const BrushStart& start);
    BrushInHand take_up(const PaintStroke& stroke);
    BrushInHand clean_brush(const brush::Preset& preset) const;
    brush::Preset preset_of(const std::string& name, brush::SpineMethod spine);
    void put_down(std::uint64_t id, const std::string& brush, BrushInHand after, LayerTiles before);
    void keep_undo(Undo undo);
    void forget_pigments(std::size_t n);
    ink::Mix mix_of(const std::string& ink);
    void apply_recolours();
    void repaint_all();
    HandPath path_of(const PaintStroke& stroke);

    const Model* model_;
    DocumentOptions options_;
    ink::Substrate substrate_;
    std::optional<ink::Substrate> previewed_substrate_;
    std::map<std::string, ink::Ink> recolours_;   ///< by the name of the ink painted with
    ink::Canvas canvas_;                          ///< of kFirstLayer
    std::map<std::uint32_t, ink::Canvas> upper_;  ///< of the other layers
    LayerTable layers_;
    std::unique_ptr<Palette> palette_;  ///< made when something is put on it
    MaskTable masks_;
    std::map<std::uint32_t, MaskTexels> mask_texels_;  ///< of those that were asked for
    std::vector<std::uint32_t> shown_;                 ///< of `show_only`
    std::vector<std::uint32_t> changed_;               ///< slots whose look changed, not their films
    Journal journal_;
    std::map<std::string, brush::Preset> brushes_;
    std::map<std::string, ink::Ink> inks_;
    std::map<std::string, BrushInHand> held_;
    std::map<std::string, std::vector<TipLag>> tip_lags_;  ///< by brush
    std::map<std::string, TiltedTipLag> tilted_tip_lags_;  ///< by brush
    std::deque<Undo> undo_;
    std::size_t undo_bytes_ = 0;
    std::size_t known_pigments_ = 0;  ///< by the entries of the journal
    std::unique_ptr<PlanScratchPool> plan_scratch_;
    std::unique_ptr<StrokeSession> session_;   ///< the stroke in work
    JournalEntry open_;                        ///< its header, from `begin` to `end`
    std::unique_ptr<ink::WetFilm> film_;       ///< made when something is wet
    std::uint32_t film_mask_ = 0;              ///< the mask that it keeps within
    std::unique_ptr<atlas::SeamLinks> seams_;  ///< made for it, or for paste
    mutable std::unique_ptr<ink::GutterPlan> gutter_;
};

}  // namespace tuft::stroke
