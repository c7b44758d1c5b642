#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/project/packing.h"
#include "io/project/project.h"
#include "io/project/project_schema.h"

/// \file
/// The tables of a project. Included by project*.cpp only. One thread at a time per database. All functions throw
/// `Error` naming `path` where the database is damaged or the disk is full.
namespace tuft::io {

inline constexpr std::uint32_t kApplicationId = 0x54554654;  // "TUFT"
inline constexpr std::int64_t kMaxTriangles = std::int64_t{1} << 28;
inline constexpr std::int64_t kMaxSamples = std::int64_t{1} << 25;  ///< in one stroke
inline constexpr std::int64_t kMaxEntries = 1'000'000;              ///< of a journal

/// Throws the `Error` of a damaged project.
[[noreturn]] inline void damaged(const std::filesystem::path& path, const Message& what) {
    throw Error(path.string(), Message("the project is damaged: {}", what));
}

/// Key of a row of the table `arrays`. The texts must outlive it.
struct ArrayKey {
    const char* owner = "";  ///< "mesh", "atlas", or the kind of an attachment
    const char* name = "";   ///< unique with its owner
};
/// Size of a stored array.
struct ArraySize {
    std::size_t count = 0;    ///< elements
    std::size_t element = 1;  ///< bytes of an element, a multiple of `Packing::element`

    std::size_t bytes() const { return count * element; }
};

/// Stores an array in the table `arrays`. An empty array is not stored.
void put_array_bytes(SQLite::Database& db, const ArrayKey& key, const void* data, const ArraySize& size,
                     const Packing& packing);

/// Returns true when the array is stored. Throws when it has another size.
bool has_array(SQLite::Database& db, const std::filesystem::path& path, const ArrayKey& key, const ArraySize& size);
/// Reads the array into `out`, [size.bytes()]. Throws when it is missing or damaged.
void get_array_bytes(SQLite::Database& db, const std::filesystem::path& path, const ArrayKey& key, void* out,
                     const ArraySize& size, const Packing& packing);

/// Stores an array of plain values under the names of its owner and its own.
template <class T>
void put_array(SQLite::Database& db, const char* owner, const char* name, const std::vector<T>& values,
               const Packing& packing) {
    put_array_bytes(db, {owner, name}, values.data(), {values.size(), sizeof(T)}, packing);
}

/// Returns the stored array; empty when there is none. Throws when it does not have `expected` elements. The size is
/// checked before memory is taken.
template <class T>
std::vector<T> get_array(SQLite::Database& db, const std::filesystem::path& path, const char* owner, const char* name,
                         const Packing& packing, std::size_t expected) {
    const ArrayKey key{owner, name};
    const ArraySize size{expected, sizeof(T)};
    if (!has_array(db, path, key, size)) return {};
    std::vector<T> values(expected);
    get_array_bytes(db, path, key, values.data(), size, packing);
    return values;
}

/// Stores and loads model and atlas (project_model.cpp). `load_model` checks sizes, indices and numbers.
void store_model(SQLite::Database& db, const ModelToWrite& model);
ProjectModel load_model(SQLite::Database& db, const std::filesystem::path& path, const ProgressFn& progress);
std::uint64_t hash_of(const mesh::TriangleMesh& mesh);
/// Stores and loads the mesh's materials with their pictures (project_materials.cpp). Load the groups first.
void store_materials(SQLite::Database& db, const mesh::TriangleMesh& mesh);
void load_materials(SQLite::Database& db, const std::filesystem::path& path, mesh::TriangleMesh& mesh);

/// Stores and loads the scene of the model file and the parts of the triangles (project_scene.cpp). They do not raise
/// the format: other programs and older versions ignore them.
void store_scene(SQLite::Database& db, const mesh::TriangleMesh& mesh);
void load_scene(SQLite::Database& db, const std::filesystem::path& path, mesh::TriangleMesh& mesh);
/// Returns a stored array of at most `most` bytes; empty when there is none.
std::vector<char> get_bytes(SQLite::Database& db, const std::filesystem::path& path, const std::string& name,
                            std::size_t most);

/// Stores and loads strokes (project_strokes.cpp). The caller opens the transaction. `load_strokes` throws `Cancelled`.
void store_strokes(SQLite::Database& db, const std::filesystem::path& path,
                   std::span<const stroke::JournalEntry> strokes);
std::vector<stroke::JournalEntry> load_strokes(SQLite::Database& db, const std::filesystem::path& path,
                                               const ProgressFn& progress);

/// Stores and loads texels (project_tiles.cpp). The caller opens the transaction.
struct StoredTexels {
    std::size_t n_slots = 0;
    std::uint64_t hash = 0;  ///< of a single layer, as its canvas computes it
};
StoredTexels store_canvases(SQLite::Database& db, std::span<const stroke::LayerTexels> layers);
/// Returns the first layer, also without texels, and all others with texels.
std::vector<stroke::LayerCanvas> load_canvases(SQLite::Database& db, const std::filesystem::path& path,
                                               std::size_t n_slots, std::uint64_t& hash, const ProgressFn& progress);

/// Stores and loads attachments (attachments.cpp). The caller opens the transaction. `kMostAbout`: bytes of `about`.
inline constexpr std::size_t kMostAbout = std::size_t{1} << 16;
void store_attachment(SQLite::Database& db, const std::string& kind, const Attachment& attachment);
void remove_attachment(SQLite::Database& db, const std::string& kind, const std::string& name);
std::vector<Attachment> load_attachments(SQLite::Database& db, const std::filesystem::path& path,
                                         const std::string& kind);

/// Raises the project's format to `format`; never lowers it.
void raise_format(SQLite::Database& db, int format);

}  // namespace tuft::io
