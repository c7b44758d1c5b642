#pragma once

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/packing.h"
#include "io/project.h"

/// The tables of a project; included by project*.cpp only.
namespace tuft::io {

inline constexpr std::uint32_t kApplicationId = 0x54554654;  // "TUFT"
inline constexpr std::int64_t kMaxTriangles = std::int64_t{1} << 28;
inline constexpr std::int64_t kMaxSamples = std::int64_t{1} << 25;  ///< in one stroke

/// What SQLite says, in words for people.
[[noreturn]] inline void rethrow(const SQLite::Exception& e, const std::filesystem::path& path) {
    const std::string name = path.string();
    switch (e.getErrorCode()) {
        case SQLITE_FULL: throw Error(name, "cannot be written: the disk is full");
        case SQLITE_READONLY: throw Error(name, "cannot be written: it is read-only");
        case SQLITE_BUSY:
        case SQLITE_LOCKED: throw Error(name, "is in use by another program");
        case SQLITE_IOERR: throw Error(name, std::string("cannot be read or written: ") + e.what());
        case SQLITE_CANTOPEN: throw Error(name, std::string("cannot be opened: ") + e.what());
        case SQLITE_NOMEM: throw Error(name, "does not fit into memory");
        case SQLITE_CONSTRAINT: throw Error(name, std::string("refuses the change: ") + e.what());
        default: throw Error(name, std::string("the project is damaged: ") + e.what());
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

[[noreturn]] inline void damaged(const std::filesystem::path& path, const std::string& what) {
    throw Error(path.string(), "the project is damaged: " + what);
}

/// Stores an array of T, made of numbers of `packing.element` bytes, in the table `arrays`.
template <class T>
void put_array(SQLite::Database& db, const char* owner, const char* name,
               const std::vector<T>& values, const Packing& packing) {
    if (values.empty()) return;
    const std::vector<char> blob =
        pack(values.data(), values.size() * sizeof(T) / packing.element, packing);
    SQLite::Statement insert(db, "INSERT INTO arrays(owner, name, count, data) VALUES(?, ?, ?, ?)");
    insert.bind(1, owner);
    insert.bind(2, name);
    insert.bind(3, static_cast<std::int64_t>(values.size()));
    insert.bindNoCopy(4, blob.data(), static_cast<int>(blob.size()));
    insert.exec();
}

/// The stored array, which must have `expected` elements; empty when there is none.
template <class T>
std::vector<T> get_array(SQLite::Database& db, const std::filesystem::path& path, const char* owner,
                         const char* name, const Packing& packing, std::size_t expected) {
    SQLite::Statement select(db, "SELECT count, data FROM arrays WHERE owner = ? AND name = ?");
    select.bind(1, owner);
    select.bind(2, name);
    if (!select.executeStep()) return {};
    const std::string what = path.string() + ": the project is damaged: array '" + name + "'";
    if (select.getColumn(0).getInt64() != static_cast<std::int64_t>(expected))
        throw Error(what + " has the wrong size");
    const SQLite::Column blob = select.getColumn(1);
    std::vector<T> values;
    // The frame knows its size: check before memory is taken for it.
    check_packed(blob.getBlob(), static_cast<std::size_t>(blob.getBytes()), expected * sizeof(T), what);
    values.resize(expected);
    unpack(blob.getBlob(), static_cast<std::size_t>(blob.getBytes()), values.data(),
           expected * sizeof(T) / packing.element, packing, what);
    return values;
}

/// Model and atlas (project_model.cpp). `load_model` checks sizes, indices and numbers.
void store_model(SQLite::Database& db, const ProjectModel& model);
ProjectModel load_model(SQLite::Database& db, const std::filesystem::path& path);
std::uint64_t hash_of(const mesh::TriangleMesh& mesh);

/// Strokes (project_strokes.cpp). The caller opens the transaction.
void store_strokes(SQLite::Database& db, const std::filesystem::path& path,
                   std::span<const stroke::Stroke> strokes);
std::vector<stroke::Stroke> load_strokes(SQLite::Database& db, const std::filesystem::path& path);

}  // namespace tuft::io
