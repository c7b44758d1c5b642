#include <SQLiteCpp/SQLiteCpp.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text/nesting.h"
#include "io/project/project_db.h"
#include "io/scene/json_number.h"
#include "io/scene/scene_document.h"

namespace tuft::io {
namespace {

using nlohmann::json;

constexpr Packing kSceneBytes{.element = 1, .lag = 1}, kPartNumbers{.element = 4, .lag = 1};
constexpr std::size_t kMostText = std::size_t{1} << 28, kMostParts = std::size_t{1} << 20;
constexpr std::size_t kBufferPiece = std::size_t{1} << 26;  // of the buffer, in one row of the table
constexpr std::size_t kMostPieces = 128;

std::string piece_name(std::size_t i) {
    return "scene buffer " + std::to_string(i);
}

json json_of_part(const mesh::ScenePart& part) {
    return {{"object", part.object},      {"group", part.group},         {"material", part.material},
            {"node", part.node},          {"primitive", part.primitive}, {"own_material", part.own_material},
            {"transform", part.transform}};
}

mesh::ScenePart part_of_json(const json& j) {
    mesh::ScenePart part;
    j.at("object").get_to(part.object);
    j.at("group").get_to(part.group);
    j.at("material").get_to(part.material);
    part.node = whole_number<std::int32_t>(j.at("node"));
    part.primitive = whole_number<std::int32_t>(j.at("primitive"));
    part.own_material = whole_number<std::int32_t>(j.at("own_material"));
    j.at("transform").get_to(part.transform);
    return part;
}

void put_text(SQLite::Database& db, const char* name, const std::string& text) {
    put_array(db, "mesh", name, std::vector<char>(text.begin(), text.end()), kSceneBytes);
}

}  // namespace

void store_scene(SQLite::Database& db, const mesh::TriangleMesh& mesh) {
    if (!mesh.scene) return;
    json parts = json::array();
    for (const mesh::ScenePart& part : mesh.scene->parts) parts.push_back(json_of_part(part));
    put_text(db, "scene parts", parts.dump(-1, ' ', false, json::error_handler_t::replace));
    put_text(db, "scene document", mesh.scene->document);
    const std::vector<unsigned char>& buffer = mesh.scene->buffer;
    for (std::size_t at = 0, i = 0; at < buffer.size(); at += kBufferPiece, ++i)
        put_array_bytes(db, {"mesh", piece_name(i).c_str()}, &buffer[at],
                        {std::min(kBufferPiece, buffer.size() - at), 1}, kSceneBytes);
    put_array(db, "mesh", "triangle_parts", mesh.triangle_parts, kPartNumbers);
}

void load_scene(SQLite::Database& db, const std::filesystem::path& path, mesh::TriangleMesh& mesh) {
    const std::vector<char> text = get_bytes(db, path, "scene parts", kMostText);
    if (text.empty()) return;
    auto scene = std::make_shared<mesh::SourceScene>();
    check_json_nesting({text.data(), text.size()}, path.string() + ": parts");
    try {
        const json parts = json::parse(text.begin(), text.end());
        if (!parts.is_array() || parts.empty() || parts.size() > kMostParts) damaged(path, "it has no valid parts");
        for (const json& part : parts) scene->parts.push_back(part_of_json(part));
    } catch (const json::exception&) {
        damaged(path, "its parts cannot be read");
    }
    const std::vector<char> document = get_bytes(db, path, "scene document", kMostText);
    scene->document.assign(document.begin(), document.end());
    for (std::size_t i = 0; i < kMostPieces; ++i) {
        const std::vector<char> piece = get_bytes(db, path, piece_name(i), kBufferPiece);
        if (piece.empty()) break;
        scene->buffer.insert(scene->buffer.end(), piece.begin(), piece.end());
    }
    mesh.triangle_parts =
        get_array<std::uint32_t>(db, path, "mesh", "triangle_parts", kPartNumbers, mesh.n_triangles());
    if (!scene->document.empty()) parse_document(*scene);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        if (mesh::part_of(mesh, t) >= scene->parts.size()) damaged(path, "a triangle is in a part that does not exist");
    mesh.scene = std::move(scene);
}

}  // namespace tuft::io
