#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/message.h"
#include "io/project/project.h"
#include "stroke/document/document.h"
#include "stroke/document/merge.h"

namespace tuft::app {

/// Keeps the work on disk: every finished stroke goes into the project file at once.
/// What cannot be written (disk full, folder gone) waits in memory and is tried again with
/// the next stroke. Where another program changed the file nothing is written on top of that:
/// `overtaken`. Nothing here throws; `trouble` says what is wrong.
class Autosave {
  public:
    /// Goes on with a project that is open already and holds the entries that these were made from.
    void adopt(io::Project project, std::vector<stroke::EntryMark> on_disk);
    /// Looks at a project that another program works on: nothing is written until `start` gives the
    /// work a file of its own.
    void view(io::Project project, std::vector<stroke::EntryMark> on_disk);
    bool viewing() const { return viewing_; }
    /// Takes the presets of another project, for strokes that come from it.
    void take_presets(const io::Project& project);
    /// Writes everything to a new project at `path` and keeps that one from now on. On
    /// failure the old one stays and the reason is returned, else an empty one.
    Message start(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                  stroke::Document& painting);

    /// There is no file that can be written: all waits in memory, and `start` is tried again before each stroke.
    /// `has_work`: there is something already that no file holds.
    void start_later(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                     const Message& fault, bool has_work = false);

    /// `start` in the place of the file there is, which rows alone cannot bring up to date.
    void rewrite(const std::string& source, const FileFrame& frame, stroke::Document& painting);

    /// The presets as a replay of the file will read them; call before a stroke uses them. Empty: none.
    void prepare(stroke::Document& painting, const std::string& brush, const std::string& ink);
    void add(const stroke::JournalEntry& stroke);
    /// Adds what an adopted file does not have yet: these entries, and presets.
    void catch_up(std::span<const stroke::JournalEntry> entries);
    /// Stores what the painting is shown as.
    void store_appearance(const stroke::Document& painting);
    /// Stores what goes along with the work (io/project/attachments.h), in the place of one of that kind and name; and
    /// takes it out.
    void attach(const std::string& kind, const io::Attachment& attachment);
    void detach(const std::string& kind, const std::string& name);
    std::vector<io::Attachment> attachments(const std::string& kind) const;  ///< by name
    std::optional<io::Attachment> attachment(const std::string& kind, const std::string& name) const;
    /// Takes over what another project carries.
    void take_attachments(const io::Project& project);
    void remove(std::uint64_t id);
    void set_hidden(std::uint64_t id, bool hidden);
    /// A change could not be written: the file has another journal until `start` writes it anew.
    bool behind() const { return behind_; }
    /// Tries once more to write what waits.
    void retry(const std::string& source, const FileFrame& frame, stroke::Document& painting);
    /// Some of the work is in memory only.
    bool has_unsaved() const { return !viewing_ && (!pending_.empty() || behind_); }

    /// Another program changed the file, or put another one in its place, since it was last read or
    /// written here; looks, and costs microseconds.
    bool overtaken();
    /// The file as it is now. Nothing where it cannot be opened; `trouble` says why.
    std::optional<io::Project> read_again();
    /// The entries as they were last read or written here.
    const std::vector<stroke::EntryMark>& on_disk() const { return on_disk_; }
    /// Stores the texels, so that the next opening needs no replay. Not beside another journal.
    void store_canvas(const stroke::Document& painting);

    std::filesystem::path path() const { return project_ ? project_->path() : std::filesystem::path{}; }
    std::vector<std::string> inks() const;  ///< names of those that the project holds
    const Message& trouble() const { return trouble_; }
    std::size_t waiting() const { return pending_.size(); }

  private:
    template <class Action>
    void attempt(const Action& action);
    template <class Action>
    void change(const Action& action);
    void flush();
    void append(std::span<const stroke::JournalEntry> strokes);

    struct Wanted {
        std::filesystem::path path;
        std::string source;
        FileFrame frame;
        Message fault;  ///< why it is not there yet
    };
    std::optional<io::Project> project_;
    std::optional<Wanted> wanted_;
    std::vector<stroke::JournalEntry> pending_;
    std::vector<stroke::EntryMark> on_disk_;
    std::map<std::string, std::string> brushes_, inks_;                       ///< TOML by name
    std::map<std::pair<std::string, std::string>, io::Attachment> attached_;  ///< by kind and name
    Message trouble_;
    bool behind_ = false, overtaken_ = false, viewing_ = false;
};

}  // namespace tuft::app
