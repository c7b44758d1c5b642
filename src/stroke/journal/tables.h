#pragma once

#include <span>
#include <string>
#include <vector>

#include "stroke/journal/entry/entry.h"

/// \file
/// Tables of layers and masks from the entries of a journal, and names in stroke files resolved by them.
namespace tuft::stroke {

/// Returns the table of layers after these entries of a journal. Throws `Error` for an edit that cannot be.
LayerTable layers_after(std::span<const JournalEntry> entries);

/// Returns the table of masks likewise.
MaskTable masks_after(std::span<const JournalEntry> entries);

/// Returns the table of parts likewise.
PartTable parts_after(std::span<const JournalEntry> entries);

/// Returns the id of the mask through which these entries last painted on a layer; 0: none.
std::uint32_t last_mask_on(std::span<const JournalEntry> entries, std::uint32_t layer);

/// Whether only edits of layers, masks and parts come after entry `id`, so that `Document::adopt` can take texels
/// stored after it.
bool fits(std::span<const JournalEntry> entries, std::uint64_t id);

/// Sets the layer of each stroke and fill by its `names`, else to the layer called `name`; an empty `name` changes
/// none. Inserts an entry that adds a missing layer on top before the first stroke or fill that needs it.
std::vector<JournalEntry> onto_named_layers(std::vector<JournalEntry> entries, LayerTable table,
                                            const std::string& name = {});

/// Sets the mask of each stroke and fill by its `names`, else to the mask called `name`. Throws `Error` for a mask that
/// does not exist.
void keep_to_named_masks(std::vector<JournalEntry>& entries, const MaskTable& table, const std::string& name = {});

}  // namespace tuft::stroke
