#include "stroke/painting/stroke_batch.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "core/system/interrupt.h"
#include "core/system/parallel.h"
#include "stroke/gesture/hand.h"
#include "stroke/painting/paint_stroke.h"
#include "stroke/painting/perform_entry.h"
#include "stroke/painting/tile_reach.h"

namespace tuft::stroke {

/// A stroke of a batch.
struct StrokeBatch::Stroke {
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
constexpr std::size_t kSamplesPerThread = 100'000;  // of a batch
// Bytes that forecasts hold: some 500 poses of a round brush, 100 of a wide one.
constexpr std::size_t kForecastPerThread = std::size_t{16} << 20;

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

bool paints_beside_others(const JournalEntry& entry) {
    if (entry.hidden) return true;
    const PaintStroke* stroke = entry.as<PaintStroke>();
    if (!stroke || stroke->layer == kPaletteLayer || stroke->trace.samples.empty()) return false;
    if (stroke->erases()) return true;
    return stroke->settings.dip == DipMode::each && stroke->settings.film != FilmModel::wet;
}

StrokeBatch::StrokeBatch(PaintedModel& painted) : painted_(painted), budget_(std::make_unique<ForecastBudget>()) {
    budget_->most = kForecastPerThread * static_cast<std::size_t>(thread_count());
}

StrokeBatch::~StrokeBatch() = default;

void StrokeBatch::take_in(std::span<JournalEntry> entries, const PrepareFn& prepare) {
    const auto threads = static_cast<std::size_t>(thread_count());
    if (threads == 1) return;
    const std::size_t most = std::min(entries.size(), kStrokesPerThread * threads);
    strokes_.reserve(most);  // what sessions begin with refers to the tiles of their strokes
    std::size_t samples = 0;
    for (std::size_t i = 0; i < most && paints_beside_others(entries[i]); ++i) {
        JournalEntry& entry = entries[i];
        if (!entry.hidden) samples += entry.get<PaintStroke>().trace.samples.size();
        if (i > 0 && samples > kSamplesPerThread * threads) break;
        Stroke& planned = strokes_.emplace_back();
        planned.entry = &entry;
        bool beside = true;
        try {
            if (prepare) prepare(entry, i);
            beside = entry.hidden || plan(planned);
        } catch (const Error&) {
            beside = false;
        }
        if (beside) continue;
        strokes_.pop_back();
        break;
    }
}

std::size_t StrokeBatch::size() const {
    return strokes_.size();
}

// Returns false where the stroke must be painted by itself; where it cannot be painted at all, it throws then.
bool StrokeBatch::plan(Stroke& planned) {
    const PaintStroke& stroke = planned.stroke();
    const brush::Preset& preset = painted_.materials.brush(stroke.brush);
    if (!stroke.erases() && painted_.materials.ink(stroke.ink).yield > 0) return false;
    planned.holder = holder_of(painted_, stroke);
    planned.preset = &preset;
    planned.spacing = pose_spacing(stroke, preset, stroke.erases() ? ink::Ink{} : painted_.materials.ink(stroke.ink),
                                   painted_.model.texels.texel_size);
    PaintStroke settled = stroke;
    settle(painted_, settled);
    planned.start = brush_start(painted_, settled);
    planned.input.emplace(session_input(painted_, std::move(settled), &planned.tiles));
    if (!stroke.erases()) planned.input->ink = painted_.materials.ink(stroke.ink);  // a fresh brush
    planned.canvas = &painted_.layers.canvas(stroke.layer);
    planned.n_pigments = painted_.layers.pigments().size();
    return true;
}

// The path of a stroke, and the tiles that it may use.
void StrokeBatch::plan_path(Stroke& planned) const {
    const PaintStroke& stroke = planned.stroke();
    const double texel = painted_.model.texels.texel_size;
    planned.path = stroke.trace.flat
                       ? hand_path(painted_.surface(), steady(stroke.trace, stroke.settings), planned.holder)
                       : HandPath{{}, spatial_poses(stroke.trace), 0};
    const std::vector<brush::Pose>& poses = planned.path.poses;
    planned.parts =
        parts_of_path(poses, std::max(kLeastPart * planned.spacing, 0.5 * brush::tuft_width(*planned.preset)));
    planned.tiles = painted_.scratch.tile_reach->tiles_at(
        reached_places(painted_.surface(), poses, planned.parts, *planned.preset, texel));
}

void StrokeBatch::start_session(Stroke& planned) const {
    planned.input->brush = take_up(painted_, planned.input->stroke, planned.start);
    planned.session = std::make_unique<StrokeSession>(std::move(*planned.input));
    planned.input.reset();
}

void StrokeBatch::paint_step(Stroke& stroke, std::size_t step, const ProgressFn& progress) const {
    StrokeSession& session = *stroke.session;
    const std::span<const brush::Pose> poses = stroke.path.poses;
    if (step == 0) {
        begin_path(session, stroke.path, progress);
        if (std::unique_ptr<StrokeForecast> forecast = session.forecast(poses)) {
            forecast->compute(thread_count() > kFewThreads, *budget_);
            session.use(std::move(forecast));
        }
        return;
    }
    const std::size_t part = step - 1;
    session.set_part(static_cast<std::uint32_t>(part));
    if (part < stroke.parts.size())
        return paint_poses(session, poses, part ? stroke.parts[part - 1] : 0, stroke.parts[part]);
    stroke.result = session.finish();
    note_origin(stroke.result->report, stroke.stroke(), painted_.surface());
}

void StrokeBatch::paint(const ProgressFn& progress) {
    if (!painted_.scratch.tile_reach)
        painted_.scratch.tile_reach = std::make_unique<TileReach>(painted_.model.texels, painted_.model.clusters);
    std::atomic<std::size_t> first_fault{strokes_.size()};
    const auto guarded = [&](std::size_t i, const auto& work) {
        if (strokes_[i].hidden() || i >= first_fault) return;
        try {
            work(strokes_[i]);
        } catch (...) {
            strokes_[i].fault = std::current_exception();
            std::size_t first = first_fault;
            while (i < first && !first_fault.compare_exchange_weak(first, i)) {
            }
        }
    };
    BatchProgress shown(strokes_.size(), progress);
    const auto shown_of = [&shown](std::size_t i) -> ProgressFn {
        return [&shown, i](std::string_view phase, double part) { return shown.set(i, phase, part); };
    };
    run_tasks(std::vector<std::vector<std::uint32_t>>(strokes_.size()), [&](std::size_t i) {
        guarded(i, [&](Stroke& stroke) {
            report(shown_of(i), "painting", 0);
            start_session(stroke);
            plan_path(stroke);
        });
    });
    const BatchOrder order = order_by_tiles(std::span(strokes_).first(first_fault), painted_.model.texels.n_slots());
    run_tasks(order.before, [&](std::size_t k) {
        const auto [i, step] = order.steps[k];
        guarded(i, [&, i = i, step = step](Stroke& stroke) { paint_step(stroke, step, shown_of(i)); });
    });
}

// Strokes that are painted, some in part, but whose turn does not come.
void StrokeBatch::take_back() {
    for (auto stroke = strokes_.rbegin(); stroke != strokes_.rend(); ++stroke) {
        if (!stroke->session) continue;
        const auto before = stroke->result ? std::move(stroke->result->before) : stroke->session->take_snapshots();
        for (const ink::TileSnapshot& tile : before) stroke->canvas->restore(tile);
    }
    painted_.forget_pigments();
}

std::size_t StrokeBatch::append(const AppendFn& append) {
    std::size_t i = 0;
    try {
        for (; i < strokes_.size() && !strokes_[i].fault; ++i) {
            JournalEntry& entry = *strokes_[i].entry;
            StrokeReport report;
            if (!entry.hidden)
                report = put_down(painted_, entry.id, strokes_[i].stroke(), std::move(*strokes_[i].result),
                                  strokes_[i].n_pigments);
            append(entry, std::move(report));
        }
        if (i < strokes_.size()) std::rethrow_exception(strokes_[i].fault);
    } catch (const OutsideTiles&) {
        take_back();
    } catch (...) {
        take_back();
        throw;
    }
    return i;
}

}  // namespace tuft::stroke
