#include "io/project/project_schema.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "io/project/project_db.h"
#include "stroke/surface/model.h"

namespace tuft::io {
namespace {

struct Table {
    const char* name;
    bool always;  ///< every project has it
    const char* columns;
};

// No program ever wrote other texts: a change of one is a new table, or the old text stays here too.
constexpr Table kTables[] = {
    {"meta", true, "(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID"},
    {"model", true,
     "(id INTEGER PRIMARY KEY CHECK(id = 1), source TEXT NOT NULL, unit TEXT NOT NULL, "
     "hash INTEGER NOT NULL, vertices INTEGER NOT NULL, triangles INTEGER NOT NULL, groups TEXT NOT NULL, "
     "atlas_size INTEGER NOT NULL, gutter INTEGER NOT NULL, texel_size REAL NOT NULL, "
     "charts INTEGER NOT NULL, uvs_from_file INTEGER NOT NULL)"},
    {"arrays", true,
     "(owner TEXT NOT NULL, name TEXT NOT NULL, count INTEGER NOT NULL, data BLOB NOT NULL, "
     "PRIMARY KEY(owner, name))"},
    {"presets", true, "(kind TEXT NOT NULL, name TEXT NOT NULL, toml TEXT NOT NULL, PRIMARY KEY(kind, name))"},
    {"strokes", true,
     "(ordinal INTEGER PRIMARY KEY AUTOINCREMENT, id INTEGER NOT NULL UNIQUE, "
     "brush TEXT NOT NULL, ink TEXT NOT NULL, seed INTEGER NOT NULL, label TEXT NOT NULL, "
     "settings TEXT NOT NULL, hidden INTEGER NOT NULL, flat INTEGER NOT NULL, laying TEXT NOT NULL, "
     "placement BLOB NOT NULL, sample_count INTEGER NOT NULL, samples BLOB NOT NULL)"},
    {"pigments", true, "(plane INTEGER PRIMARY KEY, name TEXT NOT NULL, toml TEXT NOT NULL)"},
    {"tiles", true, "(slot INTEGER PRIMARY KEY, planes INTEGER NOT NULL, amounts BLOB NOT NULL)"},
    {"films", false,
     "(slot INTEGER NOT NULL, film INTEGER NOT NULL, planes INTEGER NOT NULL, amounts BLOB NOT NULL, "
     "PRIMARY KEY(slot, film))"},
    {"layer_tiles", false,
     "(layer INTEGER NOT NULL, slot INTEGER NOT NULL, planes INTEGER NOT NULL, amounts BLOB NOT NULL, "
     "PRIMARY KEY(layer, slot))"},
    {"layer_films", false,
     "(layer INTEGER NOT NULL, slot INTEGER NOT NULL, film INTEGER NOT NULL, planes INTEGER NOT NULL, "
     "amounts BLOB NOT NULL, PRIMARY KEY(layer, slot, film))"},
};
// What SQLite makes for AUTOINCREMENT.
constexpr Table kSequence{"sqlite_sequence", false, "(name,seq)"};

constexpr std::size_t kMostSchemaText = 4096;
constexpr std::int64_t kMostObjects = 64;

std::string sql_of(const Table& table) {
    return std::string("CREATE TABLE ") + table.name + table.columns;
}

// White space is one blank, or none beside brackets and commas.
std::string squeezed(const std::string& sql) {
    std::string out;
    for (const char c : sql) {
        const bool blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
        if (blank && (out.empty() || out.back() == ' ' || out.back() == '(' || out.back() == ',')) continue;
        if ((c == '(' || c == ')' || c == ',') && !out.empty() && out.back() == ' ') out.pop_back();
        out += blank ? ' ' : c;
    }
    return out;
}

const Table* find_table(const std::string& name) {
    for (const Table& table : kTables)
        if (name == table.name) return &table;
    return name == kSequence.name ? &kSequence : nullptr;
}

}  // namespace

void create_tables(SQLite::Database& db) {
    for (const Table& table : kTables)
        if (table.always) db.exec(sql_of(table));
}

void create_table(SQLite::Database& db, const std::string& name) {
    if (!db.tableExists(name)) db.exec(sql_of(*find_table(name)));
}

void check_schema(SQLite::Database& db, const std::filesystem::path& path) {
    SQLite::Statement row(
        db, "SELECT type, name, tbl_name, sql FROM sqlite_master LIMIT " + std::to_string(kMostObjects + 1));
    std::set<std::string> found;
    for (std::int64_t n = 0; row.executeStep(); ++n) {
        const auto text = [&](int column) {
            return text_of(row.getColumn(column), kMostSchemaText, path, "a table's description");
        };
        const std::string type = text(0), name = text(1), on = text(2);
        const Table* table = find_table(type == "index" ? on : name);
        bool good = n < kMostObjects && table;
        if (good && type == "index")
            good = row.getColumn(3).isNull() && name.starts_with("sqlite_autoindex_");
        else if (good)
            good = type == "table" && on == name && squeezed(text(3)) == squeezed(sql_of(*table));
        if (!good)
            damaged(path, Message("it holds the {} '{}' as no tuft project does, and is not opened", type.substr(0, 20),
                                  name.substr(0, 60)));
        if (type == "table") found.insert(name);
    }
    for (const Table& table : kTables)
        if (table.always && !found.contains(table.name))
            damaged(path, Message("its table '{}' is missing", table.name));
}

void restrain(SQLite::Database& db) {
    sqlite3* const handle = db.getHandle();
    constexpr std::pair<int, int> kSwitches[] = {{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                                 {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                                 {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
                                                 {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                                 {SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
                                                 {SQLITE_DBCONFIG_DQS_DDL, 0},
                                                 {SQLITE_DBCONFIG_DQS_DML, 0}};
    constexpr std::pair<int, int> kLimits[] = {
        {SQLITE_LIMIT_LENGTH, 1'000'000'000}, {SQLITE_LIMIT_SQL_LENGTH, 20'000}, {SQLITE_LIMIT_COLUMN, 16},
        {SQLITE_LIMIT_EXPR_DEPTH, 16},        {SQLITE_LIMIT_COMPOUND_SELECT, 2}, {SQLITE_LIMIT_VDBE_OP, 5000},
        {SQLITE_LIMIT_FUNCTION_ARG, 8},       {SQLITE_LIMIT_ATTACHED, 0},        {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 64},
        {SQLITE_LIMIT_VARIABLE_NUMBER, 16},   {SQLITE_LIMIT_TRIGGER_DEPTH, 1},   {SQLITE_LIMIT_WORKER_THREADS, 0}};
    for (const auto& [what, on] : kSwitches) sqlite3_db_config(handle, what, on, nullptr);
    for (const auto& [what, most] : kLimits) sqlite3_limit(handle, what, most);
    // A file that is cut off while it is mapped would end the program.
    db.exec("PRAGMA mmap_size = 0; PRAGMA cell_size_check = ON; PRAGMA temp_store = MEMORY;");
}

namespace {

constexpr int kTickSteps = 1000;
// Steps of SQLite's machine: some millions for what is not the file's, and a few for each of its bytes; reading a
// project takes 0.02 a byte.
constexpr std::uintmax_t kFreeTicks = 20'000, kBytesPerTick = 300;

}  // namespace

CallBudget::CallBudget(sqlite3* db) : db_(db) {
    sqlite3_progress_handler(
        db, kTickSteps, [](void* self) { return static_cast<CallBudget*>(self)->tick(); }, this);
}

void CallBudget::begin(std::uintmax_t bytes, bool hears) {
    left_ = kFreeTicks + bytes / kBytesPerTick;
    hears_ = hears;
    spent_ = false;
}

int CallBudget::tick() {
    spent_ = left_ == 0;
    left_ -= !spent_;
    return spent_ || (hears_ && progress_ && !progress_("reading", 0));
}

// SQLite looks at no progress while it checks pages, but it can be interrupted.
std::string CallBudget::check_pages(SQLite::Database& db) {
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false, stopped = false;
    std::thread watch;
    if (progress_)
        watch = std::thread([&] {
            std::unique_lock lock(mutex);
            while (!ended.wait_for(lock, std::chrono::milliseconds(100), [&] { return done; })) {
                if (stopped || progress_("reading", 0)) continue;
                stopped = true;
                sqlite3_interrupt(db_);
            }
        });
    const auto end = [&] {
        if (!watch.joinable()) return;
        {
            const std::lock_guard lock(mutex);
            done = true;
        }
        ended.notify_all();
        watch.join();
    };
    try {
        std::string verdict = db.execAndGet("PRAGMA quick_check(1)").getString();
        end();
        if (stopped) throw Cancelled();
        return verdict.substr(0, verdict.find('\n'));
    } catch (...) {
        end();
        throw;
    }
}

std::string text_of(const SQLite::Column& column, std::size_t most, const std::filesystem::path& path,
                    const char* what) {
    if (column.getBytes() < 0 || static_cast<std::size_t>(column.getBytes()) > most)
        damaged(path, Message("{} is too long", std::string(what)));
    return column.getString();
}

void check_memory(const std::filesystem::path& path, std::uintmax_t bytes) {
    constexpr std::uintmax_t kNoMatter = std::uintmax_t{64} << 20;
    if (bytes < kNoMatter || bytes < stroke::available_memory()) return;
    throw Error(path.string(), Message("does not fit into memory: what is in it takes {} MiB", bytes >> 20));
}

}  // namespace tuft::io
