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

/// \file
/// The thread that owns the document and paints. Drawing and simulation never wait for each other.
namespace tuft::app {

/// Runs the paint thread. Only that thread accesses the document while this lives. Methods are for the window thread.
class PaintThread {
  public:
    explicit PaintThread(PaintWork work);
    /// Calls `finish`.
    ~PaintThread();
    /// Executes all posted commands and saves; in `PaintWork::spare` where the project's file cannot be written.
    /// Returns the path of the spare file then, else "". `unsaved` says whether work was lost.
    std::filesystem::path finish();
    bool unsaved() const { return context_.work.autosave.has_unsaved(); }  ///< after `finish`

    void post(Command command) { queue_.post(std::move(command)); }
    Update take();
    /// True when no command waits or runs.
    bool idle() const { return queue_.idle(); }
    /// Waits until `idle`, at most that many seconds.
    void wait_idle(double seconds) const { queue_.wait_idle(seconds); }
    /// Cancels running long work; the state before it stays.
    void stop_long_work() { context_.stop = true; }

    const stroke::Model& model() const { return *context_.work.model; }  ///< never changes
    /// Names of the model's parts.
    const std::vector<std::string>& part_names() const { return part_names_; }
    /// Returns the surface of the visible parts at the last `take`. The reference holds until another `take`.
    const mesh::SurfaceQuery& surface() const { return surface_ ? *surface_ : *model().query; }
    std::shared_ptr<const mesh::SurfaceQuery> shared_surface() const;
    const std::string& source() const { return context_.work.source; }
    const FileFrame& frame() const { return context_.work.frame; }  ///< of the model file
    /// Returns the initial texture, once.
    render::MapPixels take_pixels() { return std::move(context_.work.pixels); }
    /// Reference images of the project when it was opened.
    const std::vector<io::Attachment>& carried_references() const { return carried_; }
    /// Copied characters of the project when it was opened.
    const std::vector<io::Attachment>& carried_copies() const { return carried_copies_; }
    /// Returns figures of the model's atlas; nullptr while they are measured. The first call starts that.
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
    std::vector<io::Attachment> carried_, carried_copies_;
    std::vector<std::string> part_names_;
    std::shared_ptr<const mesh::SurfaceQuery> surface_;  ///< of the last `take`
    std::shared_future<atlas::AtlasReport> measured_;
    std::filesystem::path spared_;  ///< the spare file, when it was used
    std::thread thread_;
};

}  // namespace tuft::app
