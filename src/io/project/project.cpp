#include "io/project/project.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>

#include "core/files/files.h"
#include "core/files/path_fault.h"
#include "core/files/system_message.h"
#include "core/system/memory.h"
#include "core/text/text.h"
#include "io/project/project_db.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

/// What differs between two states of a file, cheap to read.
struct FileStamp {
    std::uintmax_t size = 0;
    std::int64_t seconds = 0, nanoseconds = 0;  ///< of its last change

    bool operator==(const FileStamp&) const = default;
};

FileStamp stamp_of(const fs::path& path) {
    struct stat s {};
    if (::stat(path.c_str(), &s) != 0) return {};
    return {static_cast<std::uintmax_t>(s.st_size), s.st_mtim.tv_sec, s.st_mtim.tv_nsec};
}

/// The projects that this process has open, by device and inode. Whoever closes such a file in another
/// way than SQLite does takes SQLite's locks off it (POSIX locks are the process's).
class OpenFile {
  public:
    explicit OpenFile(const fs::path& path) : id_(id_of(path)) {
        const std::lock_guard lock(mutex());
        ++all()[id_];
    }
    ~OpenFile() {
        const std::lock_guard lock(mutex());
        if (--all()[id_] == 0) all().erase(id_);
    }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    /// Another file has its name now.
    bool replaced(const fs::path& path) const {
        const Id now = id_of(path);
        return now != Id{} && now != id_;
    }
    static bool is_open(const fs::path& path) {
        const std::lock_guard lock(mutex());
        return all().contains(id_of(path));
    }

  private:
    using Id = std::pair<dev_t, ino_t>;
    static Id id_of(const fs::path& path) {
        struct stat s {};
        return ::stat(path.c_str(), &s) == 0 ? Id{s.st_dev, s.st_ino} : Id{};
    }
    static std::mutex& mutex() {
        static std::mutex m;
        return m;
    }
    static std::map<Id, int>& all() {
        static std::map<Id, int> files;
        return files;
    }

    Id id_;
};

constexpr int kBusyMilliseconds = 2000;
constexpr std::size_t kMostMeta = 1000, kMostName = 4096, kMostPreset = std::size_t{1} << 20;  // bytes
constexpr std::size_t kMostPresets = 10'000;
constexpr std::size_t kMostWords = 160;  // bytes, of SQLite's in a message

/// Whether the project was moved away under our hands, which SQLite calls many names; empty when it is there.
Message why_gone(const std::filesystem::path& path) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (::access(folder.c_str(), F_OK) != 0) return "its folder is not there any more; was it moved?";
    return ::access(path.c_str(), F_OK) != 0 ? Message("is not there any more; was it moved?") : Message();
}

/// Where SQLite only says that a file could not be opened; it writes beside the project too.
Message why_not_opened(const std::filesystem::path& path) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (::access(path.c_str(), R_OK) != 0) return "may not be read; change its permissions";
    if (::access(folder.c_str(), W_OK) != 0) return "cannot be changed: nothing may be written into its folder";
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return Message("cannot be opened: {}", system_message(errno));
    ::close(file);
    return Message("cannot be opened together with its '{}-journal' file; is that a folder, or somebody else's?",
                   path.filename().string());
}

/// What SQLite says, in words for people.
[[noreturn]] void rethrow(const SQLite::Exception& e, const std::filesystem::path& path,
                          const std::filesystem::path& place, int cause) {
    const std::string name = path.string();
    const int code = e.getErrorCode();
    if (const Message gone = why_gone(place);
        !gone.empty() && (code == SQLITE_READONLY || code == SQLITE_IOERR || code == SQLITE_CANTOPEN))
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
            throw Error(name, Message("cannot be read or written: {}", system_message(cause)));
        case SQLITE_PERM:
            throw Error(name, Message("cannot be read or written: {}", system_message(EACCES)));
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
            throw Error(name, "the project is damaged");
        case SQLITE_CANTOPEN:
            throw Error(name, why_not_opened(path));
        case SQLITE_INTERRUPT:
            throw Cancelled();
        case SQLITE_NOMEM:
            throw Error(name, "does not fit into memory");
        case SQLITE_CONSTRAINT:
            throw Error(name, Message("refuses the change ({})", excerpt(e.what(), kMostWords)));
        default:
            throw Error(name, Message("the project is damaged ({})", excerpt(e.what(), kMostWords)));
    }
}

/// Runs `fn`, turning SQLite's exceptions into `Error`s that name the file `path`. `place`: where the file is.
template <class Fn>
auto guarded(const std::filesystem::path& path, const std::filesystem::path& place, Fn&& fn) {
    errno = 0;
    try {
        return fn();
    } catch (const SQLite::Exception& e) {
        // What succeeds after the failure leaves it as it was. Of others than these SQLite says more.
        const int cause = errno == EFBIG || errno == EDQUOT ? errno : EIO;
        rethrow(e, path, place, cause);
    }
}

std::uint32_t big_endian(const char* bytes) {
    std::uint32_t v = 0;
    for (int i = 0; i < 4; ++i) v = v << 8 | static_cast<unsigned char>(bytes[i]);
    return v;
}

struct Header {
    bool sqlite = false;
    bool own_kind = false;  ///< UTF-8 with a rollback journal, as all projects are
    std::uint32_t application = 0, version = 0;
};

/// The head of a SQLite file, read without SQLite so that nothing of a foreign file runs.
Header header_of(const fs::path& path) {
    if (OpenFile::is_open(path)) return {.sqlite = true, .own_kind = true, .application = kApplicationId, .version = 0};
    std::error_code ec;
    if (!fs::is_regular_file(path, ec)) return {};  // opening a pipe would wait for its other end
    std::ifstream file(path, std::ios::binary);
    char head[100] = {};
    file.read(head, sizeof head);
    if (file.gcount() != sizeof head || std::memcmp(head, "SQLite format 3", 16) != 0) return {};
    return {.sqlite = true,
            .own_kind = head[18] == 1 && head[19] == 1 && big_endian(head + 56) == 1,
            .application = big_endian(head + 68),
            .version = big_endian(head + 60)};
}

void set_pragmas(SQLite::Database& db, Access access) {
    db.setBusyTimeout(kBusyMilliseconds);
    if (access == Access::read) db.exec("PRAGMA query_only = ON;");
    // The rollback journal keeps a project one file; each commit reaches the disk.
    else
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
    return s.executeStep() ? s.getColumn(0).getString().substr(0, kMostMeta) : "";
}

void put_preset(SQLite::Database& db, const char* kind, const PresetText& preset) {
    SQLite::Statement s(db, "INSERT OR REPLACE INTO presets(kind, name, toml) VALUES(?, ?, ?)");
    s.bind(1, kind);
    s.bind(2, preset.first);
    s.bind(3, preset.second);
    s.exec();
}

std::vector<PresetText> get_presets(SQLite::Database& db, const fs::path& path, const char* kind) {
    SQLite::Statement s(db, "SELECT name, toml FROM presets WHERE kind = ? ORDER BY name");
    s.bind(1, kind);
    std::vector<PresetText> presets;
    while (s.executeStep()) {
        if (presets.size() >= kMostPresets) damaged(path, Message("it has too many presets of the kind '{}'", kind));
        presets.emplace_back(text_of(s.getColumn(0), kMostName, path, "the name of a preset"),
                             text_of(s.getColumn(1), kMostPreset, path, "a preset"));
    }
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
        restrain(old);
        old.execAndGet("SELECT count(*) FROM sqlite_master");
    } catch (const SQLite::Exception&) {
        // Not a database any more: the journal is of no use to anybody.
    }
    fs::remove(journal, ec);
}

// Earlier versions refuse a substrate with a key that they do not know.
void raise_format_of_glass(SQLite::Database& db, const std::string& toml) {
    if (toml.find("\ntransmission") != std::string::npos) raise_format(db, kPartsFormat);
}

}  // namespace

ChangedOutside::ChangedOutside(const fs::path& project)
    : Error(project.string(), "another program changed it meanwhile; nothing was written over that: do it again") {}

struct Project::State {
    fs::path path;                    ///< for messages
    fs::path place;                   ///< where the file is: of a project that is being made, elsewhere
    std::optional<ProjectLock> lock;  ///< none: to be read only
    SQLite::Database db;
    mutable CallBudget budget;
    OpenFile file;
    std::uint32_t version = 0;  ///< change counter of the file as last read or written here
    mutable FileStamp seen;

    State(const fs::path& p, std::optional<ProjectLock> l)
        : path(p),
          place(p),
          lock(std::move(l)),
          db(p.string(), SQLite::OPEN_READWRITE),
          budget(db.getHandle()),
          file(p),
          seen(stamp_of(p)) {}

    /// `hears`: whoever listens may stop it.
    template <class Fn>
    auto run(Fn&& fn, bool hears = false) {
        budget.begin(seen.size, hears);
        try {
            return guarded(path, place, [&] { return fn(db); });
        } catch (const Cancelled&) {
            if (budget.spent()) damaged(path, "reading it does not come to an end");
            throw;
        }
    }
    /// Counts the committed changes of the file; `PRAGMA data_version` counts failed ones of this connection too.
    /// Read through SQLite's own file: closing another one would take its locks off.
    std::uint32_t change_counter() {
        sqlite3_file* handle = nullptr;
        char bytes[4] = {};
        sqlite3_file_control(db.getHandle(), "main", SQLITE_FCNTL_FILE_POINTER, &handle);
        if (!handle || !handle->pMethods || handle->pMethods->xRead(handle, bytes, sizeof bytes, 24) != SQLITE_OK)
            return version;
        return big_endian(bytes);
    }
    /// All of `fn` or nothing.
    template <class Fn>
    void change(Fn&& fn) {
        if (!lock) throw Error(path.string(), "was opened to be read only");
        if (file.replaced(place)) throw ChangedOutside(path);
        run([&](SQLite::Database&) {
            SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
            if (change_counter() != version) throw ChangedOutside(path);
            fn(db);
            transaction.commit();
            // One change, or none where nothing was to be changed.
            version = change_counter() == version ? version : version + 1;
        });
        seen = stamp_of(place);
    }
};

Project::Project(std::unique_ptr<State> state) : state_(std::move(state)) {}
Project::~Project() = default;
Project::Project(Project&&) noexcept = default;
Project& Project::operator=(Project&&) noexcept = default;

Project Project::open_file(const fs::path& path, std::optional<ProjectLock> lock, const ProgressFn& progress) {
    auto state = guarded(path, path, [&] { return std::make_unique<State>(path, std::move(lock)); });
    state->budget.listen(progress);
    report(progress, "reading", 0);
    state->run(
        [&](SQLite::Database& db) {
            restrain(db);
            check_schema(db, path);
            set_pragmas(db, state->lock ? Access::write : Access::read);
            const std::string verdict = state->budget.check_pages(db);
            if (verdict != "ok") damaged(path, verdict);
            state->version = state->change_counter();
        },
        true);
    return Project(std::move(state));
}

Project Project::create(const fs::path& path, const ModelToWrite& model, const std::function<void(Project&)>& fill,
                        const OpenOptions& options) {
    const ProjectLock lock(path, options.patience, options.progress);
    write_atomically(path, [&](const fs::path& temporary) {
        std::error_code ec;
        fs::remove(temporary, ec);
        guarded(path, temporary, [&] {
            SQLite::Database db(temporary.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
            // Nothing to protect yet: the file gets its name when it is complete.
            db.exec("PRAGMA journal_mode = OFF; PRAGMA synchronous = FULL; PRAGMA page_size = 8192;");
            db.exec("PRAGMA application_id = " + std::to_string(kApplicationId) +
                    "; PRAGMA user_version = " + std::to_string(kFirstFormat) + ";");
            SQLite::Transaction transaction(db);
            create_tables(db);
            put_meta(db, "written_by", std::string("tuft ") + TUFT_VERSION);
            put_preset(db, "substrate", {"", model.substrate});
            raise_format_of_glass(db, model.substrate);
            store_model(db, model);
            transaction.commit();
        });
        if (fill) {
            Project filled = open_file(temporary, lock, {});
            filled.state_->path = path;  // for messages
            fill(filled);
        }
        settle_old_journal(path);
    });
    release_free_memory();
    return open(path, options);
}

Project Project::open(const fs::path& path, const OpenOptions& options) {
    std::error_code ec;
    check_exists(path);
    if (fs::is_directory(path, ec)) throw Error(path.string(), "is a folder, not a project");
    if (!fs::is_regular_file(path, ec)) throw Error(path.string(), "is not a regular file");
    if (::access(path.c_str(), R_OK) != 0) throw Error(path.string(), "may not be read; change its permissions");
    const Header header = header_of(path);
    if (!header.sqlite) throw Error(path.string(), "is not a tuft project");
    if (header.application != kApplicationId) throw Error(path.string(), "is a database, but not a tuft project");
    if (header.version > kProjectFormat)
        throw Error(path.string(),
                    Message("was written by a newer tuft (format {}, this one reads up to {}); update tuft to open it",
                            header.version, kProjectFormat));
    if (!header.own_kind) damaged(path, "it is kept in another way than tuft keeps projects");
    std::optional<ProjectLock> lock;
    if (options.access == Access::write) {
        if (::access(path.c_str(), W_OK) != 0) throw Error(path.string(), "cannot be written: it is read-only");
        lock.emplace(path, options.patience, options.progress);
    }
    return open_file(path, std::move(lock), options.progress);
}

void Project::listen(ProgressFn progress) {
    state_->budget.listen(std::move(progress));
}

bool Project::changed_outside() const {
    if (state_->file.replaced(state_->place)) return true;
    const FileStamp now = stamp_of(state_->place);
    if (now == state_->seen || now == FileStamp{}) return false;
    if (state_->change_counter() != state_->version) return true;
    state_->seen = now;
    return false;
}

void Project::read_together(const std::function<void()>& read) const {
    guarded(state_->path, state_->place, [&] {
        SQLite::Transaction transaction(state_->db);
        read();
        transaction.commit();
    });
}

const fs::path& Project::path() const {
    return state_->path;
}

int Project::format() const {
    return state_->run([](SQLite::Database& db) { return db.execAndGet("PRAGMA user_version").getInt(); });
}

std::string Project::written_by() const {
    return state_->run([](SQLite::Database& db) { return get_meta(db, "written_by"); });
}

ProjectModel Project::model() const {
    return state_->run(
        [&](SQLite::Database& db) {
            ProjectModel model = load_model(db, state_->path, state_->budget.progress());
            for (const PresetText& preset : get_presets(db, state_->path, "substrate")) model.substrate = preset.second;
            return model;
        },
        true);
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
    state_->change([&](SQLite::Database& db) {
        put_preset(db, "substrate", {"", toml});
        raise_format_of_glass(db, toml);
    });
}

std::vector<PresetText> Project::brushes() const {
    return state_->run([&](SQLite::Database& db) { return get_presets(db, state_->path, "brush"); });
}

std::vector<PresetText> Project::inks() const {
    return state_->run([&](SQLite::Database& db) { return get_presets(db, state_->path, "ink"); });
}

void Project::put_recolour(const PresetText& preset) {
    state_->change([&](SQLite::Database& db) { put_preset(db, "recolour", preset); });
}

std::vector<PresetText> Project::recolours() const {
    return state_->run([&](SQLite::Database& db) { return get_presets(db, state_->path, "recolour"); });
}

void Project::put_shown_substrate(const std::string& toml) {
    state_->change([&](SQLite::Database& db) {
        put_preset(db, "shown substrate", {"", toml});
        raise_format_of_glass(db, toml);
    });
}

std::string Project::shown_substrate() const {
    return state_->run([&](SQLite::Database& db) {
        const std::vector<PresetText> stored = get_presets(db, state_->path, "shown substrate");
        return stored.empty() ? std::string() : stored.front().second;
    });
}

void Project::put_attachment(const std::string& kind, const Attachment& attachment) {
    state_->change([&](SQLite::Database& db) { store_attachment(db, kind, attachment); });
}

void Project::remove_attachment(const std::string& kind, const std::string& name) {
    state_->change([&](SQLite::Database& db) { tuft::io::remove_attachment(db, kind, name); });
}

std::vector<Attachment> Project::attachments(const std::string& kind) const {
    return state_->run([&](SQLite::Database& db) { return load_attachments(db, state_->path, kind); });
}

void Project::append(std::span<const stroke::JournalEntry> strokes) {
    state_->change([&](SQLite::Database& db) { store_strokes(db, state_->path, strokes); });
}

namespace {

// Texels that were stored after this entry, or after one that is gone, show other strokes than the journal has.
void forget_texels_after(SQLite::Database& db, std::uint64_t stroke_id) {
    SQLite::Statement s(
        db, "SELECT (SELECT ordinal FROM strokes WHERE id = ?) < (SELECT ordinal FROM strokes WHERE id = ?)");
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
        if (s.exec() != 1) throw Error(state_->path.string(), Message("has no stroke {}", stroke_id));
    });
}

void Project::remove(std::uint64_t stroke_id) {
    state_->change([&](SQLite::Database& db) {
        forget_texels_after(db, stroke_id);
        SQLite::Statement s(db, "DELETE FROM strokes WHERE id = ?");
        s.bind(1, static_cast<std::int64_t>(stroke_id));
        if (s.exec() != 1) throw Error(state_->path.string(), Message("has no stroke {}", stroke_id));
    });
}

std::vector<stroke::JournalEntry> Project::strokes() const {
    return state_->run([&](SQLite::Database& db) { return load_strokes(db, state_->path, state_->budget.progress()); },
                       true);
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
    const auto load = [&](SQLite::Database& db) -> std::optional<SavedCanvases> {
        if (get_meta(db, "tiles_slots") != std::to_string(n_slots)) return std::nullopt;
        SavedCanvases saved;
        saved.stroke_id = std::strtoull(get_meta(db, "tiles_stroke").c_str(), nullptr, 10);
        std::uint64_t hash = 0;
        saved.layers = tuft::io::load_canvases(db, state_->path, n_slots, hash, state_->budget.progress());
        // What does not add up is made again from the strokes.
        if (get_meta(db, "tiles_hash") != std::to_string(hash)) return std::nullopt;
        return saved;
    };
    return state_->run(load, true);
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
