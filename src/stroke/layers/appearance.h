#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ink/composite/composite.h"
#include "stroke/layers/materials.h"
#include "stroke/layers/palette.h"
#include "stroke/layers/part_set.h"

/// \file
/// How a document is shown, apart from what was painted: layers alone, another substrate, other colours. Maps, exports
/// and the window's texture are made from `stack`, `substrate` and `compose_options`.
namespace tuft::stroke {

/// Nothing here paints anew or changes an amount of ink. Not safe in several threads: reading plans the gutter.
class Appearance {
  public:
    /// All must outlive it.
    Appearance(const Model& model, const Materials& materials, LayerStack& layers, Palette& palette,
               const PartSet& parts)
        : model_(model), materials_(materials), layers_(layers), palette_(palette), parts_(parts) {}

    /// Layers to be seen with their texels, the lowest first: the visible ones, or those of `show_only`, of an opacity
    /// above 0.
    std::vector<LayerTexels> shown_layers() const;
    /// The same for `ink::compose_*`, over the model's base colours and the substrates of its parts; over a previewed
    /// substrate without either.
    ink::Stack stack() const;
    /// What the ink is shown on: the previewed substrate, else the one painted on.
    const ink::Substrate& substrate() const { return previewed_ ? *previewed_ : materials_.substrate(); }
    /// Options for `ink::compose_*`, gutters continued over the seams. Their plan is made at the first call (0.3–1 s)
    /// and belongs to this.
    ink::ComposeOptions compose_options() const;

    /// Shows these layers alone, whatever the table says; none: what the table says. Throws `Error` for an id that is
    /// not there.
    void show_only(std::vector<std::uint32_t> layers);
    /// Shows the ink on another substrate; nothing: on the one painted on.
    void preview_substrate(std::optional<ink::Substrate> substrate);
    bool has_preview_substrate() const { return previewed_.has_value(); }
    /// Shows what was and will be painted with ink `name` as `wanted` (ink/composite/recolour.h). Throws `Error` for
    /// an unknown name.
    void recolour(const std::string& name, const ink::Ink& wanted);
    const std::map<std::string, ink::Ink>& recolours() const { return recolours_; }
    /// Recolours all canvases again, after pigments came to them.
    void apply_recolours();

    /// Returns the slots of the model whose films or appearance changed since the last call, ascending.
    std::vector<std::uint32_t> take_dirty() { return layers_.take_dirty(); }
    /// The same of the palette.
    std::vector<std::uint32_t> take_palette_dirty() { return palette_.take_dirty(); }
    /// Reports these slots, or all that have ink, at the next call, too.
    void mark_changed(const std::vector<std::uint32_t>& slots) { layers_.mark_changed(slots); }
    void mark_all_changed() { layers_.mark_changed(); }

  private:
    const Model& model_;
    const Materials& materials_;
    LayerStack& layers_;
    Palette& palette_;
    const PartSet& parts_;
    std::vector<std::uint32_t> shown_;  ///< of `show_only`
    std::optional<ink::Substrate> previewed_;
    std::map<std::string, ink::Ink> recolours_;  ///< by the name of the ink painted with
    mutable std::unique_ptr<ink::GutterPlan> gutter_;
};

}  // namespace tuft::stroke
