#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/project/packing.h"
#include "io/project/project.h"
#include "io/project/project_schema.h"

/// The tables of a project; included by project*.cpp only.
namespace tuft::io {

inline constexpr std::uint32_t kApplicationId = 0x54554654;  // "TUFT"
inline constexpr std::int64_t kMaxTriangles = std::int64_t{1} << 28;
inline constexpr std::int64_t kMaxSamples = std::int64_t{1} << 25;  ///< in one stroke
inline constexpr std::int64_t kMaxEntries = 1'000'000;              ///< of a journal

[[noreturn]] inline void damaged(const std::filesystem::path& path, const Message& what) {
    throw Error(path.string(), Message("the project is damaged: {}", what));
}

/// Stores an array of `count` elements of `size` bytes, made of numbers of
/// `packing.element` bytes, in the table `arrays`; nothing when it is empty.
void put_array_bytes(SQLite::Database& db, const char* owner, const char* name, const void* data, std::size_t count,
                     std::size_t size, const Packing& packing);

/// Whether the array is there; throws when it does not have `count` elements of `size` bytes.
bool has_array(SQLite::Database& db, const std::filesystem::path& path, const char* owner, const char* name,
               std::size_t count, std::size_t size);
void get_array_bytes(SQLite::Database& db, const std::filesystem::path& path, const char* owner, const char* name,
                     void* out, std::size_t count, std::size_t size, const Packing& packing);

template <class T>
void put_array(SQLite::Database& db, const char* owner, const char* name, const std::vector<T>& values,
               const Packing& packing) {
    put_array_bytes(db, owner, name, values.data(), values.size(), sizeof(T), packing);
}

/// The stored array, which must have `expected` elements; empty when there is none. Its size
/// is checked before memory is taken.
template <class T>
std::vector<T> get_array(SQLite::Database& db, const std::filesystem::path& path, const char* owner, const char* name,
                         const Packing& packing, std::size_t expected) {
    if (!has_array(db, path, owner, name, expected, sizeof(T))) return {};
    std::vector<T> values(expected);
    get_array_bytes(db, path, owner, name, values.data(), expected, sizeof(T), packing);
    return values;
}

/// Model and atlas (project_model.cpp). `load_model` checks sizes, indices and numbers.
void store_model(SQLite::Database& db, const ModelToWrite& model);
ProjectModel load_model(SQLite::Database& db, const std::filesystem::path& path, const ProgressFn& progress);
std::uint64_t hash_of(const mesh::TriangleMesh& mesh);
/// Its materials with their pictures as they were found (project_materials.cpp); groups come first.
void store_materials(SQLite::Database& db, const mesh::TriangleMesh& mesh);
void load_materials(SQLite::Database& db, const std::filesystem::path& path, mesh::TriangleMesh& mesh);

/// The scene of its file and the parts of the triangles (project_scene.cpp). Other programs and older
/// versions of this one leave them unread: the project's format does not change for them.
void store_scene(SQLite::Database& db, const mesh::TriangleMesh& mesh);
void load_scene(SQLite::Database& db, const std::filesystem::path& path, mesh::TriangleMesh& mesh);
/// A stored array of bytes of any length up to `most`; empty when there is none.
std::vector<char> get_bytes(SQLite::Database& db, const std::filesystem::path& path, const std::string& name,
                            std::size_t most);

/// Strokes (project_strokes.cpp). The caller opens the transaction. `load_strokes` throws `Cancelled`.
void store_strokes(SQLite::Database& db, const std::filesystem::path& path,
                   std::span<const stroke::JournalEntry> strokes);
std::vector<stroke::JournalEntry> load_strokes(SQLite::Database& db, const std::filesystem::path& path,
                                               const ProgressFn& progress);

/// Texels (project_tiles.cpp). The caller opens the transaction.
struct StoredTexels {
    std::size_t n_slots = 0;
    std::uint64_t hash = 0;  ///< of one layer as its canvas has it
};
StoredTexels store_canvases(SQLite::Database& db, std::span<const stroke::LayerTexels> layers);
/// The first layer, also when it has no texels, and the others that have any.
std::vector<stroke::LayerCanvas> load_canvases(SQLite::Database& db, const std::filesystem::path& path,
                                               std::size_t n_slots, std::uint64_t& hash, const ProgressFn& progress);

/// What a project carries (attachments.cpp). The caller opens the transaction.
inline constexpr std::size_t kMostAbout = std::size_t{1} << 16;
void store_attachment(SQLite::Database& db, const std::string& kind, const Attachment& attachment);
void remove_attachment(SQLite::Database& db, const std::string& kind, const std::string& name);
std::vector<Attachment> load_attachments(SQLite::Database& db, const std::filesystem::path& path,
                                         const std::string& kind);

/// Marks the project as one of `format`, unless it is of a higher one.
void raise_format(SQLite::Database& db, int format);

}  // namespace tuft::io
