#pragma once

#include <cstdint>
#include <span>

#include "core/system/progress.h"
#include "stroke/journal/entry/entry.h"
#include "stroke/painting/painted_model.h"
#include "stroke/session/report.h"

/// \file
/// What each kind of entry does to a painted model, but for strokes (paint_stroke.h). `Document` performs entries by
/// them.
namespace tuft::stroke {

/// Perform the content of entry `id` and record what it changed. Throw `Error` for what the model does not have, and
/// `Cancelled` when `progress` stops them; then nothing has changed.
void perform_action(PaintedModel& painted, std::uint64_t id, const BrushAction& action);
/// All layers dry, each within the mask that it was last painted through by the entries `earlier`.
void perform_drying(PaintedModel& painted, std::uint64_t id, const Dry& wait, std::span<const JournalEntry> earlier,
                    const ProgressFn& progress);
void perform_wash(PaintedModel& painted, std::uint64_t id);
StrokeReport perform_fill(PaintedModel& painted, std::uint64_t id, const Fill& fill);
void edit_layers(PaintedModel& painted, std::uint64_t id, const LayerEdit& edit);
void edit_masks(PaintedModel& painted, std::uint64_t id, const MaskEdit& edit);
void edit_parts(PaintedModel& painted, std::uint64_t id, const PartEdit& edit);

/// Throws `Error` for an entry whose layer, mask or part the model lacks, or whose layer is locked: what a hand may not
/// do. A replay may, since the lock came after it.
void check_layer(const PaintedModel& painted, const JournalEntry& entry);

/// Makes an entry say what it will do, for a replay: a brush that is not held is fresh (`DipMode::each`), and new
/// layers and masks get their ids.
void settle(const PaintedModel& painted, PaintStroke& stroke);
void settle(const PaintedModel& painted, EntryContent& content);

}  // namespace tuft::stroke
