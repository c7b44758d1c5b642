#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "brush/preset/preset.h"
#include "core/system/interrupt.h"
#include "core/system/parallel.h"
#include "stroke/document/document.h"
#include "stroke/document/paint_path.h"
#include "stroke/document/path_ahead.h"
#include "stroke/document/tile_reach.h"
#include "stroke/session/session.h"

/// Many entries in turn. A stroke that begins with a fresh brush depends on the model and on the ink in the tiles it
/// uses, and changes nothing else. So the strokes of a batch are painted side by side, part by part of their paths: a
/// part waits until every earlier stroke is done with the tiles that it may use. A stroke that leaves the tiles planned
/// for it is taken back with those after it, and painted by itself.
namespace tuft::stroke {

/// A stroke of a batch.
struct Document::BatchStroke {
    JournalEntry* entry = nullptr;
    std::size_t n_pigments = 0;     // that the document has met with it
    ink::Canvas* canvas = nullptr;  // of its layer
    const brush::Preset* preset = nullptr;
    HolderOptions holder;
    HandPath path;
    double spacing = 0;              // metres between the poses of the resampled path
    std::vector<std::size_t> parts;  // ends of the parts of the path, in poses
    TilePlan tiles;
    BrushStart start;
    std::optional<SessionInput> input;  // until the session is made
    std::unique_ptr<StrokeSession> session;
    std::optional<SessionResult> result;
    std::exception_ptr fault;

    const PaintStroke& stroke() const { return entry->get<PaintStroke>(); }
    bool hidden() const { return entry->hidden; }
    std::size_t n_steps() const { return parts.size() + 2; }  // forecast, parts of the path, end of the stroke
};

namespace {

constexpr std::size_t kStrokesPerThread = 32;
// Strokes that wait for each other's tiles keep so many threads at work. With more, footprints are computed before the
// ink of the strokes below is there, those that dry hair will not use, too.
constexpr int kFewThreads = 4;
constexpr std::size_t kSamplesPerThread = 100'000;  // of a batch: bounds the poses that are held

// Ink of a stamp is deposited up to 8 stamps later (StampBatch).
constexpr double kLeastPart = 16;  // poses of the resampled path

/// One step of one stroke of a batch.
struct BatchStep {
    std::uint32_t stroke = 0, step = 0;
};

/// The steps of all strokes, by stroke, and for each the steps that must be done before.
struct BatchOrder {
    std::vector<BatchStep> steps;
    std::vector<std::vector<std::uint32_t>> before;
};

template <class Strokes>
BatchOrder order_by_tiles(const Strokes& batch, std::size_t n_slots) {
    BatchOrder order;
    std::map<std::uint32_t, std::vector<std::uint32_t>> last_of_layer;  // step that uses each tile last
    for (std::uint32_t i = 0; i < batch.size(); ++i) {
        if (batch[i].hidden()) continue;
        const auto first = static_cast<std::uint32_t>(order.steps.size());
        for (std::uint32_t k = 0; k < batch[i].n_steps(); ++k) {
            order.steps.push_back({i, k});
            order.before.emplace_back();
            if (k > 0) order.before.back().push_back(first + k - 1);
        }
        std::vector<std::uint32_t>& last = last_of_layer[batch[i].stroke().layer];
        last.resize(n_slots, kNone);
        for (const TileUse& use : batch[i].tiles) {
            if (last[use.slot] != kNone) order.before[first + 1 + use.first].push_back(last[use.slot]);
            last[use.slot] = first + 1 + use.last;
        }
        for (std::size_t k = first; k < order.steps.size(); ++k) {
            std::ranges::sort(order.before[k]);
            order.before[k].erase(std::unique(order.before[k].begin(), order.before[k].end()), order.before[k].end());
        }
    }
    return order;
}

/// Progress of strokes painted at the same time. Threads report in turn. A thread does not wait while another reports.
class BatchProgress {
  public:
    BatchProgress(std::size_t strokes, const ProgressFn& report) : done_(strokes), report_(report) {}

    /// Returns false once the work shall stop.
    bool set(std::size_t stroke, std::string_view phase, double fraction) {
        done_[stroke] = fraction;
        if (interrupted()) stopped_ = true;
        const std::unique_lock turn(mutex_, std::try_to_lock);
        if (turn && report_ && !stopped_) {
            double sum = 0;
            for (const std::atomic<double>& part : done_) sum += part;
            if (!report_(phase, sum / static_cast<double>(done_.size()))) stopped_ = true;
        }
        return !stopped_;
    }

  private:
    std::vector<std::atomic<double>> done_;
    const ProgressFn& report_;
    std::mutex mutex_;
    std::atomic<bool> stopped_{false};
};

}  // namespace

// A brush that persists, wet ink and paste depend on more than tiles. Layer and presets are checked when it is planned.
bool Document::paints_beside_others(const JournalEntry& entry) const {
    if (entry.hidden) return true;
    const PaintStroke* stroke = entry.as<PaintStroke>();
    if (!stroke || stroke->layer == kPaletteLayer || stroke->trace.samples.empty()) return false;
    if (stroke->erases()) return true;
    return stroke->settings.dip == DipMode::each && stroke->settings.film != FilmModel::wet;
}

// Returns false where the stroke must be painted by itself; where it cannot be painted at all, it throws then.
bool Document::plan_stroke(BatchStroke& planned) {
    const PaintStroke& stroke = planned.stroke();
    const brush::Preset& preset = materials_.brush(stroke.brush);
    if (!stroke.erases() && materials_.ink(stroke.ink).yield > 0) return false;
    planned.holder = holder_of(stroke);
    planned.preset = &preset;
    planned.spacing = pose_spacing(stroke, preset, stroke.erases() ? ink::Ink{} : materials_.ink(stroke.ink),
                                   model_.texels.texel_size);
    PaintStroke settled = stroke;
    settle(settled);
    planned.start = brush_start(settled);
    planned.input.emplace(session_input(std::move(settled), &planned.tiles));
    if (!stroke.erases()) planned.input->ink = materials_.ink(stroke.ink);  // a fresh brush
    planned.canvas = &layers_.canvas(stroke.layer);
    planned.n_pigments = layers_.pigments().size();
    return true;
}

// Strokes from the first of these entries on that can be painted side by side; none where there is one thread, or where
// each is watched.
std::vector<Document::BatchStroke> Document::plan_batch(std::span<JournalEntry> entries, const EntrySteps& steps) {
    const auto threads = static_cast<std::size_t>(thread_count());
    std::vector<BatchStroke> batch;
    if (threads == 1 || watcher_) return batch;
    const std::size_t most = std::min(entries.size(), kStrokesPerThread * threads);
    batch.reserve(most);  // what sessions begin with refers to the tiles of their strokes
    std::size_t samples = 0;
    for (std::size_t i = 0; i < most && paints_beside_others(entries[i]); ++i) {
        JournalEntry& entry = entries[i];
        if (!entry.hidden) samples += entry.get<PaintStroke>().trace.samples.size();
        if (i > 0 && samples > kSamplesPerThread * threads) break;
        BatchStroke& planned = batch.emplace_back();
        planned.entry = &entry;
        bool beside = true;
        try {
            if (steps.prepare) steps.prepare(entry, i);
            beside = entry.hidden || plan_stroke(planned);
        } catch (const Error&) {
            beside = false;
        }
        if (beside) continue;
        batch.pop_back();
        break;
    }
    return batch;
}

// The path of a stroke, and the tiles that it may use.
void Document::plan_path(BatchStroke& planned) const {
    const PaintStroke& stroke = planned.stroke();
    const double texel = model_.texels.texel_size;
    planned.path = stroke.trace.flat ? hand_path(surface(), steady(stroke.trace, stroke.settings), planned.holder)
                                     : HandPath{{}, spatial_poses(stroke.trace), 0};
    const std::vector<brush::Pose>& poses = planned.path.poses;
    planned.parts =
        parts_of_path(poses, std::max(kLeastPart * planned.spacing, 0.5 * brush::tuft_width(*planned.preset)));
    planned.tiles =
        scratch_.tile_reach->tiles_at(reached_places(surface(), poses, planned.parts, *planned.preset, texel));
}

void Document::start_session(BatchStroke& planned) const {
    planned.input->brush = take_up(planned.input->stroke, planned.start);
    planned.session = std::make_unique<StrokeSession>(std::move(*planned.input));
    planned.input.reset();
}

void Document::paint_step(BatchStroke& stroke, std::size_t step, const ProgressFn& progress) const {
    StrokeSession& session = *stroke.session;
    const std::span<const brush::Pose> poses = stroke.path.poses;
    if (step == 0) {
        begin_path(session, stroke.path, progress);
        if (std::unique_ptr<StrokeForecast> forecast = session.forecast(poses)) {
            forecast->compute(thread_count() > kFewThreads);
            session.use(std::move(forecast));
        }
        return;
    }
    const std::size_t part = step - 1;
    session.set_part(static_cast<std::uint32_t>(part));
    if (part < stroke.parts.size())
        return paint_poses(session, poses, part ? stroke.parts[part - 1] : 0, stroke.parts[part]);
    stroke.result = session.finish();
    note_origin(stroke.result->report, stroke.stroke(), surface());
}

void Document::paint_batch(std::vector<BatchStroke>& batch, const ProgressFn& progress) {
    if (!scratch_.tile_reach) scratch_.tile_reach = std::make_unique<TileReach>(model_.texels, model_.clusters);
    std::atomic<std::size_t> first_fault{batch.size()};
    const auto guarded = [&](std::size_t i, const auto& work) {
        if (batch[i].hidden() || i >= first_fault) return;
        try {
            work(batch[i]);
        } catch (...) {
            batch[i].fault = std::current_exception();
            std::size_t first = first_fault;
            while (i < first && !first_fault.compare_exchange_weak(first, i)) {
            }
        }
    };
    BatchProgress shown(batch.size(), progress);
    const auto shown_of = [&shown](std::size_t i) -> ProgressFn {
        return [&shown, i](std::string_view phase, double part) { return shown.set(i, phase, part); };
    };
    run_tasks(std::vector<std::vector<std::uint32_t>>(batch.size()), [&](std::size_t i) {
        guarded(i, [&](BatchStroke& stroke) {
            report(shown_of(i), "painting", 0);
            start_session(stroke);
            plan_path(stroke);
        });
    });
    const BatchOrder order = order_by_tiles(std::span(batch).first(first_fault), model_.texels.n_slots());
    run_tasks(order.before, [&](std::size_t k) {
        const auto [i, step] = order.steps[k];
        guarded(i, [&, i = i, step = step](BatchStroke& stroke) { paint_step(stroke, step, shown_of(i)); });
    });
}

// Strokes that are painted, some in part, but whose turn does not come.
void Document::take_back(std::span<BatchStroke> batch) {
    for (auto stroke = batch.rbegin(); stroke != batch.rend(); ++stroke) {
        if (!stroke->session) continue;
        const auto before = stroke->result ? std::move(stroke->result->before) : stroke->session->take_snapshots();
        for (const ink::TileSnapshot& tile : before) stroke->canvas->restore(tile);
    }
    forget_pigments();
}

// Appends strokes up to the first one that must be painted by itself. Returns their number.
std::size_t Document::append_batch(std::vector<BatchStroke>& batch, const EntrySteps& steps) {
    std::size_t i = 0;
    try {
        for (; i < batch.size() && !batch[i].fault; ++i) {
            JournalEntry& entry = *batch[i].entry;
            StrokeReport report;
            if (!entry.hidden)
                report = put_down(entry.id, batch[i].stroke(), std::move(*batch[i].result), batch[i].n_pigments);
            steps.append(entry, std::move(report));
        }
        if (i < batch.size()) std::rethrow_exception(batch[i].fault);
    } catch (const OutsideTiles&) {
        take_back(batch);
    } catch (...) {
        take_back(batch);
        throw;
    }
    return i;
}

void Document::perform_all(std::vector<JournalEntry>& entries, const EntrySteps& steps, const ProgressFn& progress) {
    cancel();
    const double all = std::max<double>(1.0, static_cast<double>(entries.size()));
    std::size_t i = 0;
    // Reports the next `n` entries.
    const auto part_of = [&](std::size_t n) -> ProgressFn {
        return [&progress, all, n, first = i](std::string_view phase, double part) {
            return !progress || progress(phase, (static_cast<double>(first) + part * static_cast<double>(n)) / all);
        };
    };
    std::unique_ptr<PathAhead> path;  // of entry i, or null
    while (i < entries.size()) {
        std::vector<BatchStroke> batch = plan_batch(std::span(entries).subspan(i), steps);
        if (batch.size() > 1) {
            paint_batch(batch, part_of(batch.size()));
            const std::size_t appended = append_batch(batch, steps);
            i += appended;
            if (appended > 0) path.reset();
            if (appended == batch.size()) continue;
        }
        JournalEntry& entry = entries[i];
        if (steps.prepare) steps.prepare(entry, 0);
        const std::unique_ptr<PathAhead> own = std::exchange(path, nullptr);
        if (thread_count() > 1 && i + 1 < entries.size() && !paints_beside_others(entries[i + 1]))
            path = plan_path_ahead(entries[i + 1]);
        StrokeReport report = entry.hidden ? StrokeReport{} : perform(entry, part_of(1), own.get());
        steps.append(entry, std::move(report));
        ++i;
    }
}

}  // namespace tuft::stroke
