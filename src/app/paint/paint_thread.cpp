#include "app/paint/paint_thread.h"

#include <chrono>

#include "app/paint/entry_commands.h"
#include "app/paint/export_command.h"
#include "app/paint/film_and_sheets.h"
#include "app/paint/highlight_command.h"
#include "app/paint/ink_commands.h"
#include "app/paint/snapshot_commands.h"
#include "core/overloaded.h"

namespace tuft::app {
namespace {

constexpr std::chrono::seconds kLookOutsideEvery{1};
// Seconds of a hand that is ahead of its ink: so many poses are bent beside their deposit, and shown together.
constexpr double kJoined = 1.0 / 30;

}  // namespace

PaintThread::PaintThread(PaintWork work)
    : context_(std::move(work), outbox_),
      strokes_(context_),
      journal_(context_, strokes_),
      outside_(context_),
      carried_(context_.work.autosave.attachments(io::kReferences)),
      carried_copies_(context_.work.autosave.attachments(io::kCopies)),
      part_names_(stroke::part_names(*context_.work.model->mesh)) {
    thread_ = std::thread([this] { run(); });
}

PaintThread::~PaintThread() {
    finish();
}

std::filesystem::path PaintThread::finish() {
    queue_.close();
    if (thread_.joinable()) thread_.join();
    return spared_;
}

const atlas::AtlasReport* PaintThread::atlas_report() {
    const stroke::Model& model = *context_.work.model;
    if (model.atlas_report.charts > 0) return &model.atlas_report;
    if (!measured_.valid())
        measured_ =
            std::async(std::launch::async, [&model] { return atlas::measure(*model.mesh, model.atlas); }).share();
    return measured_.wait_for(std::chrono::seconds(0)) == std::future_status::ready ? &measured_.get() : nullptr;
}

Update PaintThread::take() {
    // Counted first: what is done by then is in the update.
    const std::size_t waiting = queue_.waiting();
    Update update = outbox_.take();
    update.status.progress.waiting = waiting;
    surface_ = update.status.surface;
    return update;
}

std::shared_ptr<const mesh::SurfaceQuery> PaintThread::shared_surface() const {
    if (surface_) return surface_;
    return {std::shared_ptr<void>(), model().query.get()};
}

void PaintThread::run() {
    Command command;
    for (;;) {
        const CommandQueue::Next next = queue_.wait(command, kLookOutsideEvery);
        if (next == CommandQueue::Next::closed) break;
        if (next == CommandQueue::Next::nothing) {
            outside_.poll();
            continue;
        }
        try {
            perform(command);
        } catch (const Cancelled&) {
            outbox_.report("Stopped; everything is as it was.");
            context_.publisher.publish(true);
        } catch (const std::exception& error) {
            context_.work.document->cancel();
            strokes_.drop_loads();
            outbox_.report(message_of(error));
            context_.publisher.publish(true);
        }
        if (!queue_.pending()) context_.publisher.draw_thumbnails();
        if (context_.work.autosave.has_unsaved()) outside_.poll();
    }
    finish_file();
}

void PaintThread::finish_file() {
    PaintWork& work = context_.work;
    if (work.document->session()) strokes_.end();
    outside_.poll();
    Autosave& autosave = work.autosave;
    autosave.retry(work.source, work.frame, *work.document);
    if (autosave.has_unsaved() && !work.spare.empty() &&
        autosave.start(work.spare, work.source, work.frame, *work.document).empty())
        spared_ = work.spare;
    autosave.store_canvas(*work.document);
}

void PaintThread::save(const SaveProject& command) {
    PaintWork& work = context_.work;
    const Message fault = work.autosave.start(command.path, work.source, work.frame, *work.document);
    outbox_.report(fault.empty() ? Message("Saved as {}", command.path.string()) : fault);
    context_.publisher.publish();
    if (fault.empty()) return;
    outbox_.change([&](Update& update) { update.events.not_saved = {command.path, fault}; });
}

void PaintThread::perform(Command& command) {
    PaintContext& context = context_;
    PaintWork& work = context.work;
    Publisher& publisher = context.publisher;
    context.stop = false;
    if (work.autosave.viewing() && changes_work(command))
        return outbox_.report("This project is only looked at; File > Save as... makes a copy to work on.");
    std::visit(Overloaded{[&](BeginStroke& c) { strokes_.begin(c); },
                          [&](ExtendStroke& c) { strokes_.extend(c, queue_.join(c, kJoined)); },
                          [&](EndStroke&) { strokes_.end(); },
                          [&](CancelStroke&) { strokes_.cancel(); },
                          [&](PaintDrawing& c) { strokes_.paint_drawing(c); },
                          [&](PaintText& c) { strokes_.paint_text(c); },
                          [&](UndoStroke&) { journal_.undo(); },
                          [&](RedoStroke&) { journal_.redo(); },
                          [&](EditStrokes& c) { journal_.edit(c); },
                          [&](ActOnBrush& c) { act_on_brush(context, journal_, c); },
                          [&](TendInk& c) { tend_ink(context, journal_, c); },
                          [&](FillModel& c) { fill_model(context, journal_, c); },
                          [&](ChangeLayers& c) { change_layers(context, journal_, c); },
                          [&](ChangeMasks& c) { change_masks(context, journal_, c); },
                          [&](ChangeParts& c) { change_parts(journal_, c); },
                          [&](ShowMask& c) { show_mask(context, c); },
                          [&](PickInk& c) { pick_ink(context, c); },
                          [&](TakeInk& c) { add_ink(context, std::move(c.ink)); },
                          [&](RecolourInk& c) { recolour(context, c); },
                          [&](PreviewSubstrate& c) { preview_substrate(context, c); },
                          [&](LookFrom& c) { publisher.look_from(c.camera); },
                          [&](SendTexture& c) {
                              publisher.publish();
                              work.texture->show_wetness(c.wetness, *work.document);
                              publisher.send_texture();
                          },
                          [&](HighlightStrokes& c) { highlight_strokes(context, c, queue_); },
                          [&](ExportModel& c) { export_model(context, c); },
                          [&](ExportSheets& c) { export_sheets(context, std::move(c)); },
                          [&](ExportFilm& c) { export_film(context, std::move(c)); },
                          [&](SaveProject& c) { save(c); },
                          [&](RetrySaving&) {
                              work.autosave.retry(work.source, work.frame, *work.document);
                              publisher.publish();
                          },
                          [&](AttachToProject& c) {
                              work.autosave.attach(c.kind, c.attachment);
                              publisher.publish();
                          },
                          [&](DetachFromProject& c) {
                              work.autosave.detach(c.kind, c.name);
                              publisher.publish_snapshots();
                              publisher.publish();
                          },
                          [&](TakeSnapshot& c) { take_snapshot(context, c); },
                          [&](RenameSnapshot& c) { rename_snapshot(context, c); },
                          [&](ShowSnapshot& c) { show_snapshot(context, c); },
                          [&](RestoreSnapshot& c) { restore_snapshot(context, journal_, c); }},
               command);
}

}  // namespace tuft::app
