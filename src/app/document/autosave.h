#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/message.h"
#include "io/project/project.h"
#include "stroke/document/document.h"
#include "stroke/journal/merge.h"

/// \file
/// Continuous saving of the work. Owned by the paint thread; created by `Opening` on its thread.
namespace tuft::app {

/// Appends every finished stroke to the project file at once. Changes that cannot be written (disk full, folder
/// missing) wait in memory; the next stroke tries again. Nothing is written over another program's changes: see
/// `overtaken`. Methods do not throw; `trouble` returns the fault. One thread at a time.
class Autosave {
  public:
    /// Continues an open project. `on_disk`: marks of its entries.
    void adopt(io::Project project, std::vector<stroke::EntryMark> on_disk);
    /// Views a project that another program works on. Nothing is written until `start` creates a new file.
    void view(io::Project project, std::vector<stroke::EntryMark> on_disk);
    bool viewing() const { return viewing_; }
    /// Copies the presets of another project, for strokes that come from it.
    void take_presets(const io::Project& project);
    /// Writes everything to a new project at `path` and continues that one. Returns an empty message, or the fault;
    /// then the old project stays.
    Message start(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                  stroke::Document& painting);

    /// Keeps all changes in memory and tries `start` before each stroke, because no file can be written. `has_work`:
    /// some work is in no file yet.
    void start_later(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                     const Message& fault, bool has_work = false);

    /// Writes the current file anew, for changes that appended rows cannot express.
    void rewrite(const std::string& source, const FileFrame& frame, stroke::Document& painting);

    /// Stores the presets as a replay will read them. Call it before a stroke uses them. Empty: none.
    void prepare(stroke::Document& painting, const std::string& brush, const std::string& ink);
    void add(const stroke::JournalEntry& stroke);
    /// Appends entries, and presets, that an adopted file does not have yet.
    void catch_up(std::span<const stroke::JournalEntry> entries);
    /// Stores the painting's recolouring and shown substrate.
    void store_appearance(const stroke::Document& painting);
    /// Stores an attachment (io/project/attachments.h), in place of one of the same kind and name; and removes it.
    void attach(const std::string& kind, const io::Attachment& attachment);
    void detach(const std::string& kind, const std::string& name);
    std::vector<io::Attachment> attachments(const std::string& kind) const;  ///< by name
    std::optional<io::Attachment> attachment(const std::string& kind, const std::string& name) const;
    /// Copies the attachments of another project.
    void take_attachments(const io::Project& project);
    void remove(std::uint64_t id);
    void set_hidden(std::uint64_t id, bool hidden);
    /// True after a change that could not be written: the file has another journal until `start` writes it anew.
    bool behind() const { return behind_; }
    /// Tries again to write all waiting changes.
    void retry(const std::string& source, const FileFrame& frame, stroke::Document& painting);
    /// True while some of the work is in memory only.
    bool has_unsaved() const { return !viewing_ && (!pending_.empty() || behind_); }

    /// Returns true when another program changed or replaced the file since it was last read or written here. Cost:
    /// some microseconds.
    bool overtaken();
    /// Opens the file in its present state. Returns nothing where it cannot be opened; `trouble` has the fault.
    std::optional<io::Project> read_again();
    /// Marks of the entries as last read or written here.
    const std::vector<stroke::EntryMark>& on_disk() const { return on_disk_; }
    /// Stores the texels, so that the next opening needs no replay. Skipped while the file has another journal.
    void store_canvas(const stroke::Document& painting);

    std::filesystem::path path() const { return project_ ? project_->path() : std::filesystem::path{}; }
    std::vector<std::string> inks() const;                   ///< names of the project's inks
    const Message& trouble() const { return trouble_; }      ///< last fault, one line; "": none
    std::size_t waiting() const { return pending_.size(); }  ///< strokes in memory only

  private:
    template <class Action>
    void attempt(const Action& action);
    template <class Action>
    void change(const Action& action);
    void flush();
    void append(std::span<const stroke::JournalEntry> strokes);

    struct PendingProject {
        std::filesystem::path path;
        std::string source;
        FileFrame frame;
        Message fault;  ///< why it does not exist yet
    };
    std::optional<io::Project> project_;
    std::optional<PendingProject> wanted_;
    std::vector<stroke::JournalEntry> pending_;
    std::vector<stroke::EntryMark> on_disk_;
    std::map<std::string, std::string> brushes_, inks_;                       ///< TOML by name
    std::map<std::pair<std::string, std::string>, io::Attachment> attached_;  ///< by kind and name
    Message trouble_;
    bool behind_ = false, overtaken_ = false, viewing_ = false;
};

}  // namespace tuft::app
