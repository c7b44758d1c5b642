#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "io/project.h"
#include "stroke/painting.h"

namespace tuft::app {

/// What the window works on: a model being painted and the project file that keeps it.
/// Opening runs in the background; everything else belongs to the window's thread.
class Document {
  public:
    Document();
    ~Document();

    struct Options {
        std::string unit = "mm";
        std::uint32_t atlas_size = 2048;
        std::string substrate = "porcelain";
    };
    /// Starts reading a model or a project; what was open stays until that is done.
    void open(const std::filesystem::path& path, const Options& options);
    void cancel_opening();
    bool opening() const { return job_ != nullptr; }
    /// Phase and part done of the opening in work.
    std::pair<std::string, double> opening_progress() const;
    /// Takes over what was opened, once it is ready: true when the document changed.
    /// A failure is left in `message`.
    bool poll();

    stroke::Painting* painting() { return painting_.get(); }
    const stroke::Model* model() const { return model_.get(); }
    const std::filesystem::path& project_path() const { return project_path_; }

    void begin(const std::string& brush, const std::string& ink);
    void extend(std::span<const brush::Pose> poses);
    /// Ends the stroke; it is in the project file before this returns.
    void end();
    void undo();
    void redo();
    /// Keeps the project under another name from now on.
    void save_as(const std::filesystem::path& path);
    void export_model(const std::filesystem::path& path);

    std::string message;      ///< one line for the person, the last thing that happened

  private:
    struct Job;
    void start_project(const std::filesystem::path& path);
    void keep(const stroke::Stroke& stroke);

    std::unique_ptr<Job> job_;
    std::unique_ptr<stroke::Model> model_;
    std::unique_ptr<stroke::Painting> painting_;
    std::optional<io::Project> project_;
    std::filesystem::path project_path_;
    std::string source_, unit_ = "mm";
};

}  // namespace tuft::app
