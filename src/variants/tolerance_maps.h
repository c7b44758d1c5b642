#pragma once

#include <functional>
#include <string>
#include <vector>

#include "variants/gather.h"
#include "variants/tolerance_map.h"

/// \file
/// Tolerance maps of all decorations of a plan: for each model, stroke file, ink and brush, and each tolerance.
namespace tuft::variants {

/// Returns the model of a task. The reference is valid until the next call.
using ModelOf = std::function<const stroke::Model&(const Task& task)>;

/// Tolerance maps of one decoration.
struct MapRow {
    std::size_t planned = 0;  ///< task without deviation
    std::string name;         ///< of the decoration and the tolerance
    MoveFigures figures;
    std::filesystem::path ink, moved;  ///< pictures: probability of ink, and displacement
};

/// Draws tolerance-map-01-ink.png, tolerance-map-01-moved.png, … of all decorations whose plan and at least two samples
/// are painted, three times as wide as the variants' pictures and 480 pixels at least, and writes the figures to
/// tolerance.csv. Throws `Error` for damaged results.
std::vector<MapRow> write_tolerance_maps(const Jobs& jobs, const std::vector<Row>& rows, const ModelOf& model_of,
                                         const ProgressFn& progress = {});

}  // namespace tuft::variants
