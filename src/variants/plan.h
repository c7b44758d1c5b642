#pragma once

#include "variants/task.h"

/// \file
/// A plan of variants: models × stroke files × inks × brushes, each painted once as planned and then with the samples
/// of every tolerance. Read from TOML by `tuft variants`. samples/variants/plan.toml shows all keys.
namespace tuft::variants {

/// A plan as its file states it.
struct Plan {
    std::filesystem::path folder;  ///< of the plan's file; all files lie in it
    std::string name;
    std::uint64_t seed = 1;
    std::vector<ModelChoice> models;
    std::vector<std::string> strokes;
    std::vector<std::string> inks, brushes;  ///< one empty text: those of the stroke files
    PaintingChoice painting;
    PlacementChoice placement;
    std::vector<Tolerance> tolerances;
    std::vector<int> samples;  ///< [tolerances] deviations of each
    PictureChoice picture;
};

/// Returns the plan of a TOML text; `source` names it in messages. Throws `Error` with the line for unknown keys, wrong
/// types and values out of range, for an entry that is there twice, and for more than `kMostTasks` tasks.
Plan parse_plan(const std::string& text, const std::string& source, const std::filesystem::path& folder);

/// Reads a plan's file, at most 4 MiB.
Plan read_plan(const std::filesystem::path& file);

/// Returns the tasks, models outermost: neighbours share a model. Sample k of a tolerance has the same seed for every
/// model, stroke file, ink and brush, so that these are compared under the same deviations. Reads all files and presets
/// for their hashes; throws `Error` for one that is missing.
std::vector<Task> tasks_of(const Plan& plan);

}  // namespace tuft::variants
