#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "stroke/layers/appearance.h"
#include "stroke/layers/layer_stack.h"
#include "stroke/layers/mask_set.h"
#include "stroke/layers/materials.h"
#include "stroke/layers/model_film.h"
#include "stroke/layers/palette.h"
#include "stroke/layers/part_set.h"
#include "stroke/painting/brushes_in_hand.h"
#include "stroke/painting/paint_target.h"
#include "stroke/painting/undo_history.h"
#include "stroke/surface/model.h"

/// \file
/// A model with all that the entries of a journal change. `Document` holds one. What an entry does to it is in
/// perform_entry.h, for strokes in paint_stroke.h and stroke_batch.h.
namespace tuft::stroke {

class FlatTexels;
class PlanScratchPool;
class TileReach;

/// Options of `Document`.
struct DocumentOptions {
    std::string substrate = "porcelain";              ///< name of a shipped one; `Document::use` takes any other
    std::size_t undo_bytes = std::size_t{256} << 20;  ///< of retained tiles; older entries are undone by replay
    bool record_forces = false;                       ///< fills `StrokeReport::forces`
    DiskCache tip_lags = shared_tip_lag_cache();      ///< of measured tip lags
};

/// What is computed once and used by many entries.
struct PaintScratch {
    std::unique_ptr<FlatTexels> flat_texels;  ///< of the last area
    std::unique_ptr<PlanScratchPool> plans;
    std::unique_ptr<TileReach> tile_reach;  ///< of the model, made for the first batch of strokes
    std::shared_ptr<Drapes> drapes;         ///< of the visible surface
};

/// Layers, masks, parts, palette and the brushes in hand, as the last entry left them, and what the last entries
/// changed. The parts refer to each other, so it is neither copied nor moved. One thread at a time.
struct PaintedModel {
    /// `model` must outlive it. Throws `Error` as `ink::load_substrate` does.
    PaintedModel(const Model& model, const DocumentOptions& options);
    ~PaintedModel();
    PaintedModel(const PaintedModel&) = delete;
    PaintedModel& operator=(const PaintedModel&) = delete;

    /// Of the visible parts.
    const mesh::SurfaceQuery& surface() const { return *parts.surface(); }
    /// Returns the canvas of a layer, or of the palette.
    ink::Canvas& canvas(std::uint32_t layer);
    PaintTarget target(std::uint32_t layer, std::uint32_t mask);
    /// Returns the film of wet ink, kept within a mask (0: free).
    ink::WetFilm& film_within(std::uint32_t mask);
    /// Returns the ink of this name by planes of the canvases; a pigment that is new gets a plane.
    ink::Mix mix_of(const std::string& ink);
    brush::Preset preset_of(const std::string& brush, brush::SpineMethod spine) const;

    /// Takes another table of parts, and forgets what was made for the former one.
    void set_parts(PartTable table);
    /// Holds what an entry that is done has changed, for undo.
    void record(UndoRecord record);
    void take_back(UndoRecord record);
    void restore(const std::vector<LayerTiles>& tiles);
    /// Forgets pigments that only entries met which failed or were taken back: a replay meets the others in its own
    /// order.
    void forget_pigments();
    /// As before the first entry.
    void clear();

    const Model& model;
    bool record_forces;
    LayerStack layers;
    MaskSet masks;
    PartSet parts;
    Palette palette;
    Materials materials;
    BrushesInHand brushes;
    Appearance appearance;
    ModelFilm film;
    UndoHistory history;
    PaintScratch scratch;
};

}  // namespace tuft::stroke
