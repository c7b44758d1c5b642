#include <SQLiteCpp/SQLiteCpp.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "atlas/unwrap/fault.h"
#include "core/hash.h"
#include "core/text/nesting.h"
#include "core/text/units.h"
#include "io/project/project_db.h"
#include "mesh/fault.h"

namespace tuft::io {
namespace {

constexpr std::size_t kMostSource = 8192, kMostGroupText = std::size_t{1} << 26;  // bytes
constexpr Packing kXyz{.element = 4, .lag = 3};
constexpr Packing kUv{.element = 4, .lag = 2};
constexpr Packing kSingle{.element = 4, .lag = 1};

void check(const ProjectModel& model, const std::filesystem::path& path) {
    if (const Message fault = mesh::fault_of(model.mesh); !fault.empty()) damaged(path, fault);
    if (!metres_per(model.frame.unit)) damaged(path, "the model's unit is unknown");
    if (model.atlas.triangle_chart.size() != model.mesh.n_triangles()) damaged(path, "a part of the model is missing");
    if (const Message fault = atlas::fault_of(model.atlas); !fault.empty())
        damaged(path, Message("its atlas cannot be painted on: {}", fault));
}

}  // namespace

void put_array_bytes(SQLite::Database& db, const ArrayKey& key, const void* data, const ArraySize& size,
                     const Packing& packing) {
    if (size.count == 0) return;
    const std::vector<char> blob = pack(data, size.bytes() / packing.element, packing);
    SQLite::Statement insert(db, "INSERT INTO arrays(owner, name, count, data) VALUES(?, ?, ?, ?)");
    insert.bind(1, key.owner);
    insert.bind(2, key.name);
    insert.bind(3, static_cast<std::int64_t>(size.count));
    insert.bindNoCopy(4, blob.data(), static_cast<int>(blob.size()));
    insert.exec();
}

bool has_array(SQLite::Database& db, const std::filesystem::path& path, const ArrayKey& key, const ArraySize& size) {
    SQLite::Statement select(db, "SELECT count, data FROM arrays WHERE owner = ? AND name = ?");
    select.bind(1, key.owner);
    select.bind(2, key.name);
    if (!select.executeStep()) return false;
    if (select.getColumn(0).getInt64() != static_cast<std::int64_t>(size.count))
        damaged(path, Message("array '{}' has the wrong size", key.name));
    const SQLite::Column blob = select.getColumn(1);
    check_packed(blob.getBlob(), static_cast<std::size_t>(blob.getBytes()), size.bytes(),
                 path.string() + ": the project is damaged: array '" + key.name + "'");
    check_memory(path, 2 * static_cast<std::uintmax_t>(size.bytes()));  // it, and it before its bytes are in order
    return true;
}

void get_array_bytes(SQLite::Database& db, const std::filesystem::path& path, const ArrayKey& key, void* out,
                     const ArraySize& size, const Packing& packing) {
    SQLite::Statement select(db, "SELECT data FROM arrays WHERE owner = ? AND name = ?");
    select.bind(1, key.owner);
    select.bind(2, key.name);
    if (!select.executeStep()) damaged(path, Message("array '{}' is missing", key.name));
    const SQLite::Column blob = select.getColumn(0);
    unpack(blob.getBlob(), static_cast<std::size_t>(blob.getBytes()), out, size.bytes() / packing.element, packing,
           path.string() + ": the project is damaged: array '" + key.name + "'");
}

std::uint64_t hash_of(const mesh::TriangleMesh& mesh) {
    return hash_span(std::span<const std::array<std::uint32_t, 3>>(mesh.triangles),
                     hash_span(std::span<const Vec3f>(mesh.positions)));
}

void store_model(SQLite::Database& db, const ModelToWrite& model) {
    const mesh::TriangleMesh& m = model.mesh;
    const atlas::Atlas& a = model.atlas;
    SQLite::Statement row(db,
                          "INSERT INTO model(id, source, unit, hash, vertices, triangles, groups, "
                          "atlas_size, gutter, texel_size, charts, uvs_from_file) "
                          "VALUES(1, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    row.bind(1, model.source);
    row.bind(2, model.frame.unit);
    row.bind(3, static_cast<std::int64_t>(hash_of(m)));
    row.bind(4, static_cast<std::int64_t>(m.n_vertices()));
    row.bind(5, static_cast<std::int64_t>(m.n_triangles()));
    row.bind(6, nlohmann::json(m.group_names).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    row.bind(7, static_cast<std::int64_t>(a.size));
    row.bind(8, static_cast<std::int64_t>(a.gutter));
    row.bind(9, a.texel_size);
    row.bind(10, static_cast<std::int64_t>(a.n_charts));
    row.bind(11, a.from_file ? 1 : 0);
    row.exec();
    put_array(db, "mesh", "positions", m.positions, kXyz);
    put_array(db, "mesh", "triangles", m.triangles, kXyz);
    put_array(db, "mesh", "corner_normals", m.corner_normals, kXyz);
    put_array(db, "mesh", "neighbours", m.neighbours, kXyz);
    put_array(db, "mesh", "corner_uvs", m.corner_uvs, kUv);
    put_array(db, "mesh", "vertex_colours", m.vertex_colours, kSingle);
    put_array(db, "mesh", "triangle_groups", m.triangle_groups, kSingle);
    put_array(db, "atlas", "corner_uvs", a.corner_uvs, kUv);
    put_array(db, "atlas", "triangle_chart", a.triangle_chart, kSingle);
    if (model.frame.y_up) put_array(db, "mesh", "y_up", std::vector<std::uint32_t>{1}, kSingle);
    if (model.frame.unit_overrides) put_array(db, "mesh", "unit_overrides", std::vector<std::uint32_t>{1}, kSingle);
    store_materials(db, m);
    store_scene(db, m);
    if (a.pages > 1) put_array(db, "atlas", "pages", std::vector<std::uint32_t>{a.pages}, kSingle);
    put_array(db, "atlas", "udims", a.udims, kSingle);
}

ProjectModel load_model(SQLite::Database& db, const std::filesystem::path& path, const ProgressFn& progress) {
    SQLite::Statement row(db,
                          "SELECT source, unit, vertices, triangles, groups, atlas_size, gutter, "
                          "texel_size, charts, uvs_from_file FROM model WHERE id = 1");
    if (!row.executeStep()) damaged(path, "it has no model");
    ProjectModel model;
    model.source = text_of(row.getColumn(0), kMostSource, path, "the model's file name");
    model.frame.unit = text_of(row.getColumn(1), kMostSource, path, "the model's unit");
    const std::int64_t vertices = row.getColumn(2).getInt64(), triangles = row.getColumn(3).getInt64();
    if (vertices < 1 || vertices > 3 * kMaxTriangles || triangles < 1 || triangles > kMaxTriangles)
        damaged(path, "the model's counts are out of range");
    const auto n_v = static_cast<std::size_t>(vertices), n_t = static_cast<std::size_t>(triangles);
    mesh::TriangleMesh& m = model.mesh;
    try {
        const auto groups = text_of(row.getColumn(4), kMostGroupText, path, "the list of groups");
        check_json_nesting(groups, path.string());
        m.group_names = nlohmann::json::parse(groups).get<std::vector<std::string>>();
    } catch (const nlohmann::json::exception&) {
        damaged(path, "the names of the groups cannot be read");
    }
    atlas::Atlas& a = model.atlas;
    const auto u32 = [&](int column) {
        const std::int64_t v = row.getColumn(column).getInt64();
        if (v < 0 || v >= kNone) damaged(path, "a number of the atlas is out of range");
        return static_cast<std::uint32_t>(v);
    };
    a.size = u32(5);
    a.gutter = u32(6);
    a.texel_size = row.getColumn(7).getDouble();
    a.n_charts = u32(8);
    a.from_file = row.getColumn(9).getInt() != 0;
    m.positions = get_array<Vec3f>(db, path, "mesh", "positions", kXyz, n_v);
    m.triangles = get_array<std::array<std::uint32_t, 3>>(db, path, "mesh", "triangles", kXyz, n_t);
    if (m.positions.empty() || m.triangles.empty()) damaged(path, "a part of the model is missing");
    report(progress, "reading", 0.3);
    m.corner_normals = get_array<Vec3f>(db, path, "mesh", "corner_normals", kXyz, 3 * n_t);
    m.neighbours = get_array<std::uint32_t>(db, path, "mesh", "neighbours", kXyz, 3 * n_t);
    m.corner_uvs = get_array<Vec2f>(db, path, "mesh", "corner_uvs", kUv, 3 * n_t);
    m.vertex_colours = get_array<std::array<std::uint8_t, 4>>(db, path, "mesh", "vertex_colours", kSingle, n_v);
    m.triangle_groups = get_array<std::uint32_t>(db, path, "mesh", "triangle_groups", kSingle, n_t);
    load_materials(db, path, m);
    load_scene(db, path, m);
    report(progress, "reading", 0.6);
    a.corner_uvs = get_array<Vec2f>(db, path, "atlas", "corner_uvs", kUv, 3 * n_t);
    a.triangle_chart = get_array<std::uint32_t>(db, path, "atlas", "triangle_chart", kSingle, n_t);
    const auto pages = get_array<std::uint32_t>(db, path, "atlas", "pages", kSingle, 1);
    if (!pages.empty()) a.pages = pages[0];
    if (a.pages >= 1 && a.pages <= 100)
        a.udims = get_array<std::uint32_t>(db, path, "atlas", "udims", kSingle, a.pages);
    model.frame.y_up = !get_array<std::uint32_t>(db, path, "mesh", "y_up", kSingle, 1).empty();
    model.frame.unit_overrides = !get_array<std::uint32_t>(db, path, "mesh", "unit_overrides", kSingle, 1).empty();
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    report(progress, "reading", 0.9);
    check(model, path);
    return model;
}

}  // namespace tuft::io
