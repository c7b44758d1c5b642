#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/system/progress.h"
#include "stroke/journal/entry/entry.h"
#include "stroke/painting/painted_model.h"
#include "stroke/session/report.h"

/// \file
/// Strokes side by side. A stroke that begins with a fresh brush depends on the model and on the ink in the tiles it
/// uses, and changes nothing else. So the strokes of a batch are painted at the same time, part by part of their paths:
/// a part waits until every earlier stroke is done with the tiles that it may use. A stroke that leaves the tiles
/// planned for it is taken back with those after it, and painted by itself. The bits are those of one after the other.
namespace tuft::stroke {

struct ForecastBudget;

/// Returns whether an entry can be painted in a batch. A brush that persists, wet ink and paste depend on more than
/// tiles. Layer and presets are checked when it is planned.
bool paints_beside_others(const JournalEntry& entry);

/// The strokes of one batch. Thread of the document.
class StrokeBatch {
  public:
    /// Called for an entry before it is planned; `ahead`: entries of the batch before it.
    using PrepareFn = std::function<void(JournalEntry& entry, std::size_t ahead)>;
    /// Called for an entry that is done.
    using AppendFn = std::function<void(JournalEntry& entry, StrokeReport report)>;

    explicit StrokeBatch(PaintedModel& painted);
    ~StrokeBatch();
    StrokeBatch(const StrokeBatch&) = delete;
    StrokeBatch& operator=(const StrokeBatch&) = delete;

    /// Takes in strokes from the first of these entries on, which must outlive it; none where there is one thread.
    void take_in(std::span<JournalEntry> entries, const PrepareFn& prepare);
    std::size_t size() const;
    /// Paints them. Faults are kept for `append`.
    void paint(const ProgressFn& progress);
    /// Appends strokes up to the first one that must be painted by itself, and takes the others back. Returns their
    /// number. Throws what the first one that failed threw, those before it appended.
    std::size_t append(const AppendFn& append);

  private:
    struct Stroke;
    bool plan(Stroke& planned);
    void plan_path(Stroke& planned) const;
    void start_session(Stroke& planned) const;
    void paint_step(Stroke& stroke, std::size_t step, const ProgressFn& progress) const;
    void take_back();

    PaintedModel& painted_;
    std::unique_ptr<ForecastBudget> budget_;
    std::vector<Stroke> strokes_;
};

}  // namespace tuft::stroke
