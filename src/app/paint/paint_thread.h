#pragma once

#include <filesystem>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "app/paint/journal_editor.h"
#include "app/paint/outside_changes.h"
#include "app/paint/stroke_painter.h"
#include "app/work/command_queue.h"
#include "app/work/commands.h"
#include "app/work/paint_context.h"
#include "app/work/update.h"

namespace tuft::app {

/// Paints on a thread of its own, so that drawing never waits for the simulation nor the simulation for drawing.
/// From its making on, only that thread touches the document.
class PaintThread {
  public:
    explicit PaintThread(PaintWork work);
    /// Finishes as `finish` does.
    ~PaintThread();
    /// Does everything that was asked for first and saves it: in `PaintWork::spare` where its own file cannot be
    /// written. Returns that path then; empty: all is in its own file, or it is lost, as `unsaved` says.
    std::filesystem::path finish();
    bool unsaved() const { return context_.work.autosave.has_unsaved(); }  ///< after `finish`

    void post(Command command) { queue_.post(std::move(command)); }
    Update take();
    /// Nothing asked for is left to do.
    bool idle() const { return queue_.idle(); }
    /// Waits until it is so, but not longer than so many seconds.
    void wait_idle(double seconds) const { queue_.wait_idle(seconds); }
    /// Stops a repainting in work; what was before stays.
    void stop_long_work() { context_.stop = true; }

    const stroke::Model& model() const { return *context_.work.model; }  ///< never changes
    const std::string& source() const { return context_.work.source; }
    const FileFrame& frame() const { return context_.work.frame; }  ///< of the model file
    /// The texture as it was at the start; once.
    render::MapPixels take_pixels() { return std::move(context_.work.pixels); }
    /// Reference images that the project carried when it was opened.
    const std::vector<io::Attachment>& carried_references() const { return carried_; }
    /// Figures of the model's atlas; nullptr while they are measured, which the first call begins.
    const atlas::AtlasReport* atlas_report();

  private:
    void run();
    void perform(Command& command);
    void save(const SaveProject& command);
    void finish_file();

    Outbox outbox_;
    PaintContext context_;
    StrokePainter strokes_;
    JournalEditor journal_;
    OutsideChanges outside_;
    CommandQueue queue_;
    std::vector<io::Attachment> carried_;
    std::shared_future<atlas::AtlasReport> measured_;
    std::filesystem::path spared_;  ///< the work is there at the end
    std::thread thread_;
};

}  // namespace tuft::app
