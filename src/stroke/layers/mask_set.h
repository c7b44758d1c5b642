#pragma once

#include <cstdint>
#include <map>

#include "stroke/journal/entry/mask.h"
#include "stroke/surface/mask_texels.h"

/// \file
/// Masks of a document: their table, and their coverage of the model's texels. `Document` changes the table, entry by
/// entry; strokes, fills and drying keep within the coverage.
namespace tuft::stroke {

/// Table of masks, and the texels of those that were asked for. Not safe in several threads: reading evaluates.
class MaskSet {
  public:
    /// No masks. `model` must outlive it.
    explicit MaskSet(const Model& model) : model_(&model) {}

    const MaskTable& table() const { return table_; }
    /// Returns the coverage of the model's texels by a mask, evaluated at the first call. Throws `Error` when there
    /// is none of this id, or as `evaluate` does.
    const MaskTexels& texels(std::uint32_t id) const;

    /// Carries the edit out; returns the table before. The coverage of that id is evaluated anew: after an undo, an
    /// id may come back with another mask. Throws `Error` and changes nothing where `apply` does.
    MaskTable edit(const MaskEdit& edit);
    /// Takes the table of this journal after another entry.
    void set_table(MaskTable table) { table_ = std::move(table); }

  private:
    const Model* model_;
    MaskTable table_;
    mutable std::map<std::uint32_t, MaskTexels> texels_;  ///< by id; addresses stay while the map grows
};

}  // namespace tuft::stroke
