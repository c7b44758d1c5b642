#pragma once

#include <span>
#include <string>
#include <vector>

#include "stroke/journal/entry.h"

/// \file
/// The tables of layers and masks that a journal's entries make.
namespace tuft::stroke {

/// The layers that these entries of a journal make. Throws `Error` where one cannot be.
LayerTable layers_after(std::span<const JournalEntry> entries);

/// The masks that they make.
MaskTable masks_after(std::span<const JournalEntry> entries);

/// The mask that was last painted through on a layer by these entries; 0: none.
std::uint32_t last_mask_on(std::span<const JournalEntry> entries, std::uint32_t layer);

/// Whether texels stored after entry `id` show all these entries, but for changes of
/// layers and masks since, so that `Document::adopt` takes them.
bool fits(std::span<const JournalEntry> entries, std::uint64_t id);

/// Gives each stroke and fill the layer that its names say (or `name` where they say none; empty: the
/// one it has), before it an entry that adds the layer on top where it is not there yet.
std::vector<JournalEntry> onto_named_layers(std::vector<JournalEntry> entries, LayerTable table,
                                            const std::string& name = {});

/// Gives each stroke and fill the mask that its names say, or `name` where they say none. Throws
/// `Error` for a mask that is not there.
void keep_to_named_masks(std::vector<JournalEntry>& entries, const MaskTable& table, const std::string& name = {});

}  // namespace tuft::stroke
