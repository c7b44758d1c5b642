#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "ink/exchange/deposit.h"
#include "stroke/journal/entry/layers.h"

/// \file
/// Layers of a document: their table and their texels. `Document` changes them, entry by entry; everything that shows,
/// exports or stores a document reads them.
namespace tuft::stroke {

/// What a `LayerEdit` changed, as it was before.
struct LayerBackup {
    LayerTable table;
    std::optional<LayerCanvas> canvas;  ///< of the layer that ended
    std::optional<LayerTiles> merged;   ///< tiles of the layer that another one was merged into
};

/// Table and canvases of all layers. Every canvas has one slot for each tile of the model's texel map. The canvas of
/// the first layer lists the pigments of the whole document; the canvas of any other layer gets the same pigments in
/// the same planes when it is asked for to be written to.
///
/// Not safe to change in one thread while another one reads.
class LayerStack {
  public:
    /// One empty layer, `kFirstLayer`. `n_slots`: of the model's texel map.
    explicit LayerStack(std::size_t n_slots) : first_(n_slots) {}

    const LayerTable& table() const { return table_; }
    /// Returns the layer; throws `Error` when there is none of this id.
    const Layer& layer(std::uint32_t id) const;
    /// Returns the texels of a layer; throws `Error` when there is none of this id.
    const ink::Canvas& canvas(std::uint32_t id = kFirstLayer) const;
    ink::Canvas& canvas(std::uint32_t id = kFirstLayer);
    /// Texels of all layers, the lowest first.
    std::vector<LayerTexels> canvases() const;
    /// Pigments met by any entry so far, in the order of the planes.
    const std::vector<ink::Pigment>& pigments() const { return first_.pigments(); }
    /// Returns the fractions of an ink by plane. Pigments that are new are added; throws `Error` for a ninth one.
    ink::Mix mix_of(const ink::Ink& ink) { return ink::mix_of(first_, ink); }
    /// Hash of the texels of all layers; of one layer alone, that of its canvas.
    std::uint64_t hash() const;

    /// Carries the edit out on table and texels. Returns what it changed. Throws `Error` and changes nothing where
    /// `apply` does. Precondition: a new layer's id is not 0.
    LayerBackup edit(const LayerEdit& edit);
    /// Takes the last edit back. Pigments met since then stay, in their planes.
    void restore(LayerBackup before);
    /// Takes another table of layers that exist already. Layers that it lacks go, with their texels.
    void set_table(LayerTable table);
    /// Replaces all layers. Layers of the table without a canvas are empty. Throws `Error` and changes nothing for a
    /// canvas of a layer that the table lacks.
    void replace(LayerTable table, std::vector<LayerCanvas> canvases);
    /// Removes all texels and all layers but the first, empty one. Pigments stay.
    void clear();
    /// Removes pigments from the last one until `n` are left, as far as they have no amounts.
    void forget_pigments(std::size_t n);
    /// Calls `ink::recolour` on every canvas.
    void recolour(const ink::Ink& painted, const ink::Ink& wanted);

    /// Marks all that the layer, or every layer, covers as changed in appearance.
    void mark_changed(std::uint32_t id);
    void mark_changed();
    /// Marks these slots likewise.
    void mark_changed(const std::vector<std::uint32_t>& slots);
    /// Returns the slots whose films or appearance changed since the last call, ascending.
    std::vector<std::uint32_t> take_dirty();

  private:
    LayerCanvas take_canvas(std::uint32_t id);
    LayerTiles merge_canvas(std::uint32_t into, const ink::Canvas& from);

    LayerTable table_;
    ink::Canvas first_;                           ///< of kFirstLayer; lists the pigments even when that layer is gone
    std::map<std::uint32_t, ink::Canvas> upper_;  ///< of the other layers, by id
    std::vector<std::uint32_t> changed_;          ///< slots that look otherwise though their films are the same
};

}  // namespace tuft::stroke
