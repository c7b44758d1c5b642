#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "cli/arguments/arguments.h"
#include "cli/steps/console.h"
#include "stroke/document/document.h"

/// \file
/// Coloured drawings on their way to the model: what inks reach, detail and copies, for `tuft paint`. Main thread.
namespace tuft::cli {

/// Returns what each ink that is named by a colour reaches: colour, reached colour, ΔE2000, in the order of use.
nlohmann::json inks_json(const std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting);
/// The same as a line for a person; nothing for a drawing without such inks.
void note_inks(const std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting, Console& console);

/// Returns the texel size that the finest detail of the drawing's areas needs, metres: a third of the least mean width
/// 2 A / P of an area with at least 1 % of the drawing's outline; as placed with `arguments`, 0 without areas.
double texel_for_detail(std::vector<stroke::JournalEntry>& strokes, const Paint& arguments);
/// Says that detail is finer than three texels, with the size that it needs.
void note_detail(std::vector<stroke::JournalEntry>& strokes, double texel, Console& console);

/// Returns what `--edges` asks of areas.
stroke::AreaEdges edges_of(const Paint& arguments);
/// With `--edges end-before`: puts masks clear of edges before the strokes, which then keep to them and to their own.
void keep_clear_of_edges(std::vector<stroke::JournalEntry>& strokes, const stroke::MaskTable& masks,
                         const Paint& arguments);

/// Appends the symmetric copies that the arguments ask for, about the middle of the model. Ids of their groups follow
/// those of `strokes`.
void add_copies(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model, const Paint& arguments);

}  // namespace tuft::cli
