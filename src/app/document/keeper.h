#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/project.h"
#include "stroke/painting/painting.h"

namespace tuft::app {

/// Keeps the work on disk: every finished stroke goes into the project file at once.
/// What cannot be written (disk full, folder gone) waits in memory and is tried again with
/// the next stroke. Nothing here throws; `trouble` says what is wrong.
class Keeper {
  public:
    /// Goes on with a project that is open already.
    void adopt(io::Project project);
    /// Takes the presets of another project, for strokes that come from it.
    void take_presets(const io::Project& project);
    /// Writes everything to a new project at `path` and keeps that one from now on. On
    /// failure the old one stays, the reason is returned, else "".
    std::string start(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                      stroke::Painting& painting);

    /// There is no file that can be written: all waits in memory, and `start` is tried again before each stroke.
    void start_later(const std::filesystem::path& path, const std::string& source, const FileFrame& frame, const std::string& fault);

    /// `start` in the place of the file there is, which rows alone cannot bring up to date.
    void rewrite(const std::string& source, const FileFrame& frame, stroke::Painting& painting);

    /// The presets as a replay of the file will read them; call before a stroke uses them. Empty: none.
    void prepare(stroke::Painting& painting, const std::string& brush, const std::string& ink);
    void add(const stroke::Stroke& stroke);
    /// Stores what the painting is shown as.
    void store_looks(const stroke::Painting& painting);
    void remove(std::uint64_t id);
    void set_hidden(std::uint64_t id, bool hidden);
    /// A change could not be written: the file has another journal until `start` writes it anew.
    bool behind() const { return behind_; }
    /// Stores the texels, so that the next opening needs no replay. Not beside another journal.
    void store_canvas(const stroke::Painting& painting);

    std::filesystem::path path() const { return project_ ? project_->path() : std::filesystem::path{}; }
    std::vector<std::string> inks() const;  ///< names of those that the project holds
    const std::string& trouble() const { return trouble_; }
    std::size_t waiting() const { return pending_.size(); }

  private:
    template <class Action>
    void attempt(const Action& action);
    template <class Action>
    void change(const Action& action);
    void flush();

    struct Wanted {
        std::filesystem::path path;
        std::string source;
        FileFrame frame;
        std::string fault;        ///< why it is not there yet
    };
    std::optional<io::Project> project_;
    std::optional<Wanted> wanted_;
    std::vector<stroke::Stroke> pending_;
    std::map<std::string, std::string> brushes_, inks_;  ///< TOML by name
    std::string trouble_;
    bool behind_ = false;
};

}  // namespace tuft::app
