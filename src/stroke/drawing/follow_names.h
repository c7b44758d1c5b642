#pragma once

#include <vector>

#include "core/message.h"
#include "mesh/triangle_mesh.h"
#include "stroke/journal/entry/entry.h"

/// \file
/// Names of parts that follow a revised model. Called by `tuft replay --model` and by the studio, before
/// `find_change`. Any thread.
namespace tuft::stroke {

/// Entries with the names of the revised model's parts.
struct NamedEntries {
    std::vector<JournalEntry> entries;
    std::vector<Message> notes;  ///< on masks that cover nothing any more, and parts that became one
};

/// Gives the groups of the former model the names that their parts have in the revised one: what a part is called there
/// depends on the others that share its material (mesh/part_groups.h).
///
/// Parts are found by their places in both files' scenes: by object and material (equal ones in the order of the
/// files); those that are left among the revised groups that are left, by object, then by name, then by material, also
/// where as many parts of one material have no object any more. A former group is all revised groups of its parts: each
/// has its state, and a mask of it holds them all. Where several former parts are one, it is hidden
/// or locked where all of them were. A group whose parts are gone keeps a name that the revised model lacks, and masks
/// leave it out unless it is their last. Where the revised file has no scene, former groups that it lacks get the names
/// of `mesh::with_part_groups`.
NamedEntries follow_names(std::vector<JournalEntry> entries, mesh::TriangleMesh& former,
                          const mesh::TriangleMesh& revised);

}  // namespace tuft::stroke
