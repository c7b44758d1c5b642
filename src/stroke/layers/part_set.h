#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ink/colour/substrate_map.h"
#include "stroke/journal/entry/parts.h"
#include "stroke/layers/mask_set.h"

/// \file
/// Parts of a document's model: which are visible, locked, and of which substrate. `Document` changes the table, entry
/// by entry; contact, texels and appearance follow it.
namespace tuft::stroke {

/// Returns the names of a mesh's parts: of its groups that have triangles, each once, in the order of the groups.
std::vector<std::string> part_names(const mesh::TriangleMesh& mesh);

/// Throws `Error` for a name that no part of the mesh has, with the nearest one.
void check_part_names(const mesh::TriangleMesh& mesh, const std::vector<std::string>& names);

/// Table of parts and what follows from it. Names that the mesh lacks have no effect, so that a journal can be painted
/// on a revised model. Not safe in several threads: reading evaluates.
class PartSet {
  public:
    /// All parts visible, open and of the document's substrate. `model` must outlive it.
    explicit PartSet(const Model& model) : model_(&model) {}

    const PartTable& table() const { return table_; }
    /// Carries the edit out; returns the table before. Throws `Error` and changes nothing where `apply` does.
    PartTable edit(const PartEdit& edit);
    /// Takes the table of this journal after another entry.
    void set_table(PartTable table);

    /// Returns the surface of the visible parts, for contact and picking. Without hidden parts it is the model's. The
    /// model must outlive it. Cost of the first call after a part was hidden or shown: 0.25 s per million triangles.
    std::shared_ptr<const mesh::SurfaceQuery> surface() const;
    /// Returns [n_triangles] 1 for triangles of hidden parts; empty: none is hidden.
    std::vector<std::uint8_t> hidden_triangles() const;

    /// Returns the texels that may change within mask `id` of `masks` (0: none): those of the mask on parts that are
    /// neither hidden nor locked. Null: all. Throws `Error` as `MaskSet::texels` does.
    const MaskTexels* open_texels(std::uint32_t id, const MaskSet& masks) const;
    /// Forgets what was evaluated with a mask that changes.
    void release_mask(std::uint32_t id) { open_.erase(id); }

    /// Returns the substrates of the texels; null where all parts have the document's. Throws `Error` for more than
    /// `kMaxPartSubstrates` different ones.
    const ink::SubstrateMap* substrates() const;
    /// Returns the substrate of a triangle's part; null: the document's.
    const ink::Substrate* substrate_at(std::uint32_t triangle) const;
    /// Returns for each triangle the transmission of its part's substrate, [n_triangles]; empty: none lets light pass.
    std::vector<float> transmission(const ink::Substrate& document) const;

  private:
    const Part* part_of(std::uint32_t triangle) const;
    std::vector<std::string> names_where(auto&& is) const;
    MaskTexels texels_of(const std::vector<std::string>& parts) const;
    ink::SubstrateMap make_substrates() const;

    const Model* model_;
    PartTable table_;
    mutable std::vector<std::string> names_;  ///< of the mesh's parts; empty: not asked for
    mutable std::shared_ptr<const mesh::SurfaceQuery> surface_;
    mutable std::map<std::uint32_t, MaskTexels> open_;  ///< by id of the mask
    mutable std::optional<ink::SubstrateMap> substrates_;
};

}  // namespace tuft::stroke
