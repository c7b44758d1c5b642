#pragma once

#include <filesystem>
#include <string>

#include "core/system/progress.h"

struct sqlite3;
namespace SQLite {
class Database;
class Column;
}  // namespace SQLite

/// \file
/// Safe opening of untrusted project databases: schema check, restrictions, step budget. Included by project*.cpp only.
/// One thread at a time per database.
namespace tuft::io {

/// Creates the tables that every project has. `create_table` creates one of the optional tables where it is missing.
void create_tables(SQLite::Database& db);
void create_table(SQLite::Database& db, const std::string& name);

/// Throws `Error` where the schema holds an object other than the tables of a project and SQLite's own indices for
/// them. Each table must be as this or an earlier version of the program wrote it, up to white space. Views, triggers,
/// virtual tables, computed columns and other checks are refused.
void check_schema(SQLite::Database& db, const std::filesystem::path& path);

/// Restricts SQLite so that it runs no code of the file: defensive mode, no trusted schema, no views, no triggers, no
/// attached files, tight limits on statements. Call it before any other use of the database.
void restrain(SQLite::Database& db);

/// Stops a running call on request, or when it takes more steps than reading a file of its size can take. A damaged
/// B-tree may otherwise have endlessly many leaves. The database must not outlive it.
class CallBudget {
  public:
    explicit CallBudget(sqlite3* db);
    CallBudget(const CallBudget&) = delete;
    CallBudget& operator=(const CallBudget&) = delete;

    void listen(ProgressFn progress) { progress_ = std::move(progress); }
    const ProgressFn& progress() const { return progress_; }
    /// Begins a call. `bytes` is the size of the file. With `hears` the progress function may stop the call.
    void begin(std::uintmax_t bytes, bool hears);
    bool spent() const { return spent_; }  ///< true when the last call exceeded its budget
    /// Checks all pages of the file. Returns "ok", else the fault. The progress function is called every 0.1 s.
    std::string check_pages(SQLite::Database& db);

  private:
    int tick();

    sqlite3* db_;
    ProgressFn progress_;
    std::uintmax_t left_ = 0;  ///< thousands of steps left
    bool hears_ = false, spent_ = false;
};

/// Returns the text of a column. Throws `Error` where it is longer than `most` bytes.
std::string text_of(const SQLite::Column& column, std::size_t most, const std::filesystem::path& path,
                    const char* what);

/// Throws `Error` where fewer than `bytes` bytes of memory are available.
void check_memory(const std::filesystem::path& path, std::uintmax_t bytes);

}  // namespace tuft::io
