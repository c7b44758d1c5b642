#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "ink/colour/pigments.h"
#include "ink/composite/match.h"
#include "stroke/layers/layer_stack.h"
#include "stroke/placement/tip_lag.h"

/// \file
/// What a document is painted with and on: brushes and inks by their names, and the substrate. Called by `Document`
/// for every entry; commands and projects bring presets of their own.
namespace tuft::stroke {

/// Brushes and inks by name, and the substrate. A name stands for the preset last given to `use`, else for the shipped
/// one, which is read at the first call. Not safe in several threads: reading loads.
class Materials {
  public:
    /// `substrate`: name of a shipped one. `layers` must outlive it. `tip_lags`: cache of measured tip lags. Throws
    /// `Error` as `ink::load_substrate` does.
    Materials(const std::string& substrate, const LayerStack& layers, DiskCache tip_lags = {})
        : layers_(layers), substrate_(ink::load_substrate(substrate)), tip_lags_(std::move(tip_lags)) {}

    /// A preset in the place of others of its name, for strokes painted from now on.
    void use(const ink::Ink& ink) { inks_.insert_or_assign(ink.name, ink); }
    void use(const brush::Preset& preset) { brushes_.insert_or_assign(preset.name, Brush{preset, {}}); }
    void use(const ink::Substrate& substrate) {
        substrate_ = substrate;
        searches_.reset();
    }

    /// Returns the brush of this name; throws `Error` when there is none.
    const brush::Preset& brush(const std::string& name) const { return find_brush(name).preset; }
    /// Returns the ink of this name; throws `Error` when there is none. A colour `#rrggbb` is an ink, too: the nearest
    /// mix on the substrate, of pigments for which the document's layers have planes (`ink::ink_named`).
    const ink::Ink& ink(const std::string& name) const;
    /// Returns whether an ink of this name was given to `use`, mixed or asked for.
    bool has_ink(const std::string& name) const { return inks_.contains(name); }
    /// Mixes the inks of a drawing's colours (`#rrggbb`) from pigments that suit all of them together
    /// (`ink::choose_pigments`), because a canvas has planes for few. Those already known stay. Without it each is
    /// mixed when it is first asked for, and the last ones get what is left.
    void mix_together(const std::map<std::string, double>& weights);
    /// Inks of these names are as if they had never been asked for. No layer may hold any.
    void forget_inks(const std::vector<std::string>& names);
    /// What the ink is painted on.
    const ink::Substrate& substrate() const { return substrate_; }

    /// Returns how a holder of this brush is led over `mesh` (`holder_options`); with `compensate_tip_lag` ahead of the
    /// ink by the tip lag of the brush, measured where it is met first (`TiltedTipLag`). The options refer to these
    /// materials.
    HolderOptions holder(const std::string& brush, const mesh::TriangleMesh& mesh, bool compensate_tip_lag) const;

  private:
    struct Brush {
        brush::Preset preset;
        std::unique_ptr<TiltedTipLag> tip_lag;  ///< at its first use
    };
    std::vector<ink::Pigment> pigments_in_use() const;
    Brush& find_brush(const std::string& name) const;

    const LayerStack& layers_;
    ink::Substrate substrate_;
    DiskCache tip_lags_;
    mutable std::map<std::string, Brush> brushes_;
    mutable std::map<std::string, ink::Ink> inks_;
    mutable std::optional<ink::MixSearches> searches_;  ///< of inks that colours name
};

}  // namespace tuft::stroke
