#pragma once

#include <vector>

#include "cli/arguments/arguments.h"
#include "stroke/document/document.h"

/// \file
/// Visibility, lock and substrate of a model's parts by the command line. Called by `tuft paint`, `write` and `part`.
namespace tuft::cli {

/// Returns what the options change in `table`, as one entry or none. Throws `Error` for a part that the mesh lacks and
/// for an unknown substrate, `UsageError` for what is no PART=NAME.
std::vector<stroke::PartEdit> part_edits(const PartChoice& choice, const stroke::PartTable& table,
                                         const mesh::TriangleMesh& mesh);

/// The model's queries see the visible parts alone while this exists. One thread.
class VisibleParts {
  public:
    VisibleParts(stroke::Model& model, const stroke::PartTable& table);
    ~VisibleParts();
    VisibleParts(const VisibleParts&) = delete;
    VisibleParts& operator=(const VisibleParts&) = delete;

  private:
    stroke::Model& model_;
    std::unique_ptr<mesh::SurfaceQuery> whole_;
};

}  // namespace tuft::cli
