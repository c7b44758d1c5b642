#include "io/project.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <fcntl.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/files.h"
#include "core/memory.h"
#include "io/project_db.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

constexpr int kBusyMilliseconds = 2000;

constexpr const char* kSchema = R"(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE model(id INTEGER PRIMARY KEY CHECK(id = 1), source TEXT NOT NULL, unit TEXT NOT NULL,
  hash INTEGER NOT NULL, vertices INTEGER NOT NULL, triangles INTEGER NOT NULL, groups TEXT NOT NULL,
  atlas_size INTEGER NOT NULL, gutter INTEGER NOT NULL, texel_size REAL NOT NULL,
  charts INTEGER NOT NULL, uvs_from_file INTEGER NOT NULL);
CREATE TABLE arrays(owner TEXT NOT NULL, name TEXT NOT NULL, count INTEGER NOT NULL, data BLOB NOT NULL,
  PRIMARY KEY(owner, name));
CREATE TABLE presets(kind TEXT NOT NULL, name TEXT NOT NULL, toml TEXT NOT NULL, PRIMARY KEY(kind, name));
CREATE TABLE strokes(ordinal INTEGER PRIMARY KEY AUTOINCREMENT, id INTEGER NOT NULL UNIQUE,
  brush TEXT NOT NULL, ink TEXT NOT NULL, seed INTEGER NOT NULL, label TEXT NOT NULL,
  settings TEXT NOT NULL, hidden INTEGER NOT NULL, flat INTEGER NOT NULL, laying TEXT NOT NULL,
  placement BLOB NOT NULL, sample_count INTEGER NOT NULL, samples BLOB NOT NULL);
CREATE TABLE pigments(plane INTEGER PRIMARY KEY, name TEXT NOT NULL, toml TEXT NOT NULL);
CREATE TABLE tiles(slot INTEGER PRIMARY KEY, planes INTEGER NOT NULL, amounts BLOB NOT NULL);
)";

/// Whether the project was moved away under our hands, which SQLite calls many names; "" when it is there.
std::string why_gone(const std::filesystem::path& path) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (::access(folder.c_str(), F_OK) != 0) return "its folder is not there any more; was it moved?";
    return ::access(path.c_str(), F_OK) != 0 ? "is not there any more; was it moved?" : "";
}

/// Where SQLite only says that a file could not be opened; it writes beside the project too.
std::string why_not_opened(const std::filesystem::path& path) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (::access(path.c_str(), R_OK) != 0) return "may not be read; change its permissions";
    if (::access(folder.c_str(), W_OK) != 0) return "cannot be changed: nothing may be written into its folder";
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return std::string("cannot be opened: ") + std::strerror(errno);
    ::close(file);
    return "cannot be opened together with its '" + path.filename().string() + "-journal' file; is that a folder, or somebody else's?";
}

/// What SQLite says, in words for people.
[[noreturn]] void rethrow(const SQLite::Exception& e, const std::filesystem::path& path) {
    const std::string name = path.string();
    const int code = e.getErrorCode();
    if (const std::string gone = why_gone(path); !gone.empty() && (code == SQLITE_READONLY || code == SQLITE_IOERR || code == SQLITE_CANTOPEN))
        throw Error(name, gone);
    switch (code) {
        case SQLITE_FULL:
            throw Error(name, "cannot be written: the disk is full");
        case SQLITE_READONLY:
            throw Error(name, "cannot be written: it is read-only");
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            throw Error(name, "is in use by another program");
        case SQLITE_IOERR:
            throw Error(name, std::string("cannot be read or written: ") + e.what());
        case SQLITE_CANTOPEN:
            throw Error(name, why_not_opened(path));
        case SQLITE_NOMEM:
            throw Error(name, "does not fit into memory");
        case SQLITE_CONSTRAINT:
            throw Error(name, std::string("refuses the change: ") + e.what());
        default:
            throw Error(name, std::string("the project is damaged: ") + e.what());
    }
}

/// Runs `fn`, turning SQLite's exceptions into `Error`s that name the file.
template <class Fn>
auto guarded(const std::filesystem::path& path, Fn&& fn) {
    try {
        return fn();
    } catch (const SQLite::Exception& e) {
        rethrow(e, path);
    }
}

std::uint32_t big_endian(const char* bytes) {
    std::uint32_t v = 0;
    for (int i = 0; i < 4; ++i) v = v << 8 | static_cast<unsigned char>(bytes[i]);
    return v;
}

struct Header {
    bool sqlite = false;
    std::uint32_t application = 0, version = 0;
};

/// The head of a SQLite file, read without SQLite so that nothing of a foreign file runs.
Header header_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    char head[100] = {};
    file.read(head, sizeof head);
    if (file.gcount() != sizeof head || std::memcmp(head, "SQLite format 3", 16) != 0) return {};
    return {.sqlite = true, .application = big_endian(head + 68), .version = big_endian(head + 60)};
}

void set_pragmas(SQLite::Database& db) {
    db.setBusyTimeout(kBusyMilliseconds);
    db.exec(
        "PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON; PRAGMA temp_store = MEMORY;");
    sqlite3_db_config(db.getHandle(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(db.getHandle(), SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    // The rollback journal keeps a project one file; each commit reaches the disk.
    db.exec("PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL; PRAGMA foreign_keys = OFF;");
}

void put_meta(SQLite::Database& db, const char* key, const std::string& value) {
    SQLite::Statement s(db, "INSERT OR REPLACE INTO meta(key, value) VALUES(?, ?)");
    s.bind(1, key);
    s.bind(2, value);
    s.exec();
}

std::string get_meta(SQLite::Database& db, const char* key) {
    SQLite::Statement s(db, "SELECT value FROM meta WHERE key = ?");
    s.bind(1, key);
    return s.executeStep() ? s.getColumn(0).getString() : "";
}

void put_preset(SQLite::Database& db, const char* kind, const PresetText& preset) {
    SQLite::Statement s(db, "INSERT OR REPLACE INTO presets(kind, name, toml) VALUES(?, ?, ?)");
    s.bind(1, kind);
    s.bind(2, preset.first);
    s.bind(3, preset.second);
    s.exec();
}

std::vector<PresetText> get_presets(SQLite::Database& db, const char* kind) {
    SQLite::Statement s(db, "SELECT name, toml FROM presets WHERE kind = ? ORDER BY name");
    s.bind(1, kind);
    std::vector<PresetText> presets;
    while (s.executeStep())
        presets.emplace_back(s.getColumn(0).getString(), s.getColumn(1).getString());
    return presets;
}

/// A project of that name that was killed leaves a rollback journal; SQLite would play it
/// into the new file.
void settle_old_journal(const fs::path& path) {
    const fs::path journal = path.string() + "-journal";
    std::error_code ec;
    if (!fs::exists(journal, ec)) return;
    try {
        SQLite::Database old(path.string(), SQLite::OPEN_READWRITE);
        old.execAndGet("SELECT count(*) FROM sqlite_master");
    } catch (const SQLite::Exception&) {
        // Not a database any more: the journal is of no use to anybody.
    }
    fs::remove(journal, ec);
}

}  // namespace

struct Project::State {
    fs::path path;
    SQLite::Database db;

    explicit State(const fs::path& p) : path(p), db(p.string(), SQLite::OPEN_READWRITE) {}

    template <class Fn>
    auto run(Fn&& fn) {
        return guarded(path, [&] { return fn(db); });
    }
    /// All of `fn` or nothing.
    template <class Fn>
    void change(Fn&& fn) {
        guarded(path, [&] {
            SQLite::Transaction transaction(db);
            fn(db);
            transaction.commit();
        });
    }
};

Project::Project(std::unique_ptr<State> state) : state_(std::move(state)) {}
Project::~Project() = default;
Project::Project(Project&&) noexcept = default;
Project& Project::operator=(Project&&) noexcept = default;

Project Project::create(const fs::path& path, const ModelToWrite& model, const std::function<void(Project&)>& fill) {
    write_atomically(path, [&](const fs::path& temporary) {
        std::error_code ec;
        fs::remove(temporary, ec);
        guarded(path, [&] {
            SQLite::Database db(temporary.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
            // Nothing to protect yet: the file gets its name when it is complete.
            db.exec(
                "PRAGMA journal_mode = OFF; PRAGMA synchronous = FULL; PRAGMA page_size = 8192;");
            db.exec("PRAGMA application_id = " + std::to_string(kApplicationId) +
                    "; PRAGMA user_version = " + std::to_string(kFirstFormat) + ";");
            SQLite::Transaction transaction(db);
            db.exec(kSchema);
            put_meta(db, "written_by", std::string("tuft ") + TUFT_VERSION);
            put_preset(db, "substrate", {"", model.substrate});
            store_model(db, model);
            transaction.commit();
        });
        if (fill) {
            Project filled = open(temporary);
            filled.state_->path = path;  // for messages
            fill(filled);
        }
        settle_old_journal(path);
    });
    release_free_memory();
    return open(path);
}

Project Project::open(const fs::path& path) {
    std::error_code ec;
    if (!fs::exists(path, ec)) throw Error(path.string(), "no such file");
    if (fs::is_directory(path, ec)) throw Error(path.string(), "is a folder, not a project");
    if (::access(path.c_str(), R_OK) != 0) throw Error(path.string(), "may not be read; change its permissions");
    const Header header = header_of(path);
    if (!header.sqlite) throw Error(path.string(), "is not a tuft project");
    if (header.application != kApplicationId)
        throw Error(path.string(), "is a database, but not a tuft project");
    if (header.version > kProjectFormat)
        throw Error(path.string(), "was written by a newer tuft (format " +
                                       std::to_string(header.version) + ", this one reads up to " +
                                       std::to_string(kProjectFormat) +
                                       "); update tuft to open it");
    return guarded(path, [&] {
        auto state = std::make_unique<State>(path);
        set_pragmas(state->db);
        const std::string verdict = state->db.execAndGet("PRAGMA quick_check(1)").getString();
        if (verdict != "ok") damaged(path, verdict.substr(0, verdict.find('\n')));
        return Project(std::move(state));
    });
}

const fs::path& Project::path() const {
    return state_->path;
}

int Project::format() const {
    return state_->run(
        [](SQLite::Database& db) { return db.execAndGet("PRAGMA user_version").getInt(); });
}

std::string Project::written_by() const {
    return state_->run([](SQLite::Database& db) { return get_meta(db, "written_by"); });
}

ProjectModel Project::model() const {
    return state_->run([&](SQLite::Database& db) {
        ProjectModel model = load_model(db, state_->path);
        for (const PresetText& preset : get_presets(db, "substrate"))
            model.substrate = preset.second;
        return model;
    });
}

std::uint64_t Project::model_hash() const {
    return state_->run([&](SQLite::Database& db) {
        SQLite::Statement s(db, "SELECT hash FROM model WHERE id = 1");
        if (!s.executeStep()) damaged(state_->path, "it has no model");
        return static_cast<std::uint64_t>(s.getColumn(0).getInt64());
    });
}

void Project::put_brush(const PresetText& preset) {
    state_->change([&](SQLite::Database& db) { put_preset(db, "brush", preset); });
}

void Project::put_ink(const PresetText& preset) {
    state_->change([&](SQLite::Database& db) { put_preset(db, "ink", preset); });
}

void Project::put_substrate(const std::string& toml) {
    state_->change([&](SQLite::Database& db) { put_preset(db, "substrate", {"", toml}); });
}

std::vector<PresetText> Project::brushes() const {
    return state_->run([](SQLite::Database& db) { return get_presets(db, "brush"); });
}

std::vector<PresetText> Project::inks() const {
    return state_->run([](SQLite::Database& db) { return get_presets(db, "ink"); });
}

void Project::put_recolour(const PresetText& preset) {
    state_->change([&](SQLite::Database& db) { put_preset(db, "recolour", preset); });
}

std::vector<PresetText> Project::recolours() const {
    return state_->run([](SQLite::Database& db) { return get_presets(db, "recolour"); });
}

void Project::put_shown_substrate(const std::string& toml) {
    state_->change([&](SQLite::Database& db) { put_preset(db, "shown substrate", {"", toml}); });
}

std::string Project::shown_substrate() const {
    return state_->run([](SQLite::Database& db) {
        const std::vector<PresetText> stored = get_presets(db, "shown substrate");
        return stored.empty() ? std::string() : stored.front().second;
    });
}

void Project::append(std::span<const stroke::Stroke> strokes) {
    state_->change([&](SQLite::Database& db) { store_strokes(db, state_->path, strokes); });
}

namespace {

// Texels that were stored after this entry, or after one that is gone, show other strokes than the journal has.
void forget_texels_after(SQLite::Database& db, std::uint64_t stroke_id) {
    SQLite::Statement s(db, "SELECT (SELECT ordinal FROM strokes WHERE id = ?) < (SELECT ordinal FROM strokes WHERE id = ?)");
    s.bind(1, static_cast<std::int64_t>(std::strtoull(get_meta(db, "tiles_stroke").c_str(), nullptr, 10)));
    s.bind(2, static_cast<std::int64_t>(stroke_id));
    if (s.executeStep() && s.getColumn(0).getInt() == 1) return;
    if (!get_meta(db, "tiles_slots").empty()) put_meta(db, "tiles_slots", "");
}

}  // namespace

void Project::set_hidden(std::uint64_t stroke_id, bool hidden) {
    state_->change([&](SQLite::Database& db) {
        forget_texels_after(db, stroke_id);
        SQLite::Statement s(db, "UPDATE strokes SET hidden = ? WHERE id = ?");
        s.bind(1, hidden ? 1 : 0);
        s.bind(2, static_cast<std::int64_t>(stroke_id));
        if (s.exec() != 1)
            throw Error(state_->path.string(), "has no stroke " + std::to_string(stroke_id));
    });
}

void Project::remove(std::uint64_t stroke_id) {
    state_->change([&](SQLite::Database& db) {
        forget_texels_after(db, stroke_id);
        SQLite::Statement s(db, "DELETE FROM strokes WHERE id = ?");
        s.bind(1, static_cast<std::int64_t>(stroke_id));
        if (s.exec() != 1)
            throw Error(state_->path.string(), "has no stroke " + std::to_string(stroke_id));
    });
}

std::vector<stroke::Stroke> Project::strokes() const {
    return state_->run([&](SQLite::Database& db) { return load_strokes(db, state_->path); });
}

std::size_t Project::n_strokes() const {
    return state_->run([](SQLite::Database& db) {
        return static_cast<std::size_t>(db.execAndGet("SELECT count(*) FROM strokes").getInt64());
    });
}

void Project::save_canvases(std::span<const stroke::LayerTexels> layers, std::uint64_t stroke_id) {
    state_->change([&](SQLite::Database& db) {
        const auto [slots, hash] = store_canvases(db, layers);
        put_meta(db, "tiles_slots", std::to_string(slots));
        put_meta(db, "tiles_stroke", std::to_string(stroke_id));
        put_meta(db, "tiles_hash", std::to_string(hash));
    });
}

void Project::save_canvas(const ink::Canvas& canvas, std::uint64_t stroke_id) {
    const stroke::LayerTexels first{.canvas = &canvas};
    save_canvases(std::span(&first, 1), stroke_id);
}

std::optional<SavedCanvases> Project::load_canvases(std::size_t n_slots) const {
    return state_->run([&](SQLite::Database& db) -> std::optional<SavedCanvases> {
        if (get_meta(db, "tiles_slots") != std::to_string(n_slots)) return std::nullopt;
        SavedCanvases saved;
        saved.stroke_id = std::strtoull(get_meta(db, "tiles_stroke").c_str(), nullptr, 10);
        std::uint64_t hash = 0;
        saved.layers = tuft::io::load_canvases(db, state_->path, n_slots, hash);
        // What does not add up is made again from the strokes.
        if (get_meta(db, "tiles_hash") != std::to_string(hash)) return std::nullopt;
        return saved;
    });
}

std::optional<SavedCanvas> Project::load_canvas(std::size_t n_slots) const {
    std::optional<SavedCanvases> saved = load_canvases(n_slots);
    if (!saved) return std::nullopt;
    return SavedCanvas{std::move(saved->layers.front().canvas), saved->stroke_id};
}

bool is_project(const fs::path& path) {
    return header_of(path).application == kApplicationId;
}

}  // namespace tuft::io
