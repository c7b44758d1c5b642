#pragma once

#include <filesystem>
#include <string>

#include "core/system/progress.h"

struct sqlite3;
namespace SQLite {
class Database;
class Column;
}  // namespace SQLite

/// What a project's database may hold, and how one that anybody may have made is opened.
/// Included by project*.cpp only.
namespace tuft::io {

/// Makes the tables that every project has; one of those that some have, where it is missing.
void create_tables(SQLite::Database& db);
void create_table(SQLite::Database& db, const std::string& name);

/// Throws `Error` where the database holds anything but the tables of a project, each as this
/// program and all before it wrote it (white space aside), and the indices that SQLite makes for
/// them: a view, a trigger, a virtual table, a column that is computed, a check of another kind.
void check_schema(SQLite::Database& db, const std::filesystem::path& path);

/// Has SQLite run nothing that the file brings: defensive mode, no trusted schema, no views, no
/// triggers, no attached files, tight limits on what a statement may be. Call it before anything
/// else is asked of the database.
void restrain(SQLite::Database& db);

/// Stops what the database does when somebody asks for it, or when a call takes more steps than
/// any reading of a file of its size does (a damaged tree may have more ends than atoms in the
/// world). The database must not outlive it.
class Overseer {
  public:
    explicit Overseer(sqlite3* db);
    Overseer(const Overseer&) = delete;
    Overseer& operator=(const Overseer&) = delete;

    void listen(ProgressFn progress) { progress_ = std::move(progress); }
    const ProgressFn& progress() const { return progress_; }
    /// A new call begins; `bytes` is the size of the file; `hears`: whoever listens may stop it.
    void begin(std::uintmax_t bytes, bool hears);
    bool spent() const { return spent_; }  ///< the last call was stopped for its length
    /// Whether all pages of the file are in order: "ok", else what is not. Heard within a tenth of a second.
    std::string check_pages(SQLite::Database& db);

  private:
    int tick();

    sqlite3* db_;
    ProgressFn progress_;
    std::uintmax_t left_ = 0;  ///< thousands of steps
    bool hears_ = false, spent_ = false;
};

/// The text of a column; throws `Error` where it is longer than `most` bytes.
std::string text_of(const SQLite::Column& column, std::size_t most, const std::filesystem::path& path,
                    const char* what);

/// Throws `Error` where so many bytes are not free.
void check_memory(const std::filesystem::path& path, std::uintmax_t bytes);

}  // namespace tuft::io
