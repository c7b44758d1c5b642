#include "io/scene/scene_document.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>

#include "core/error.h"
#include "core/text/nesting.h"
#include "ink/spectra/srgb.h"
#include "io/scene/json_number.h"

namespace tuft::io {
namespace {

using nlohmann::json;

json parse(std::string_view text, const std::string& name) {
    check_json_nesting(text, name);
    try {
        json document = json::parse(text.begin(), text.end());
        if (!document.is_object()) throw Error(name, "its JSON is not that of a glTF file");
        return document;
    } catch (const json::exception&) {
        throw Error(name, "its JSON cannot be read");
    }
}

/// The array of that name, or an empty one.
json& array_of(json& document, const char* key) {
    json& value = document[key];
    if (!value.is_array()) value = json::array();
    return value;
}

std::size_t append_bytes(std::vector<unsigned char>& buffer, std::span<const unsigned char> bytes) {
    buffer.resize(aligned(buffer.size()));
    const std::size_t at = buffer.size();
    buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    return at;
}

int add_view(json& document, std::vector<unsigned char>& buffer, std::span<const unsigned char> bytes) {
    json& views = array_of(document, "bufferViews");
    const std::size_t at = append_bytes(buffer, bytes);
    views.push_back({{"buffer", 0}, {"byteOffset", at}, {"byteLength", bytes.size()}});
    return static_cast<int>(views.size()) - 1;
}

/// Moves a reference to buffer b to its place in the one buffer.
void move_view(json& view, const std::vector<std::size_t>& starts, const std::string& name) {
    const std::size_t buffer = whole_number(view, "buffer", std::size_t{0});
    if (buffer >= starts.size()) throw Error(name, "a buffer view has no buffer");
    view["byteOffset"] = whole_number(view, "byteOffset", std::size_t{0}) + starts[buffer];
    view["buffer"] = 0;
}

void pack_buffers(json& document, mesh::SourceScene& scene, std::span<const std::vector<unsigned char>> buffers,
                  const std::string& name) {
    std::vector<std::size_t> starts;
    starts.reserve(buffers.size());
    for (const std::vector<unsigned char>& bytes : buffers) starts.push_back(append_bytes(scene.buffer, bytes));
    if (!document.contains("bufferViews")) return;
    for (json& view : array_of(document, "bufferViews")) {
        move_view(view, starts, name);
        if (const auto extensions = view.find("extensions"); extensions != view.end())
            for (auto& [key, value] : extensions->items())
                if (value.is_object() && value.contains("buffer")) move_view(value, starts, name);
    }
}

void pack_pictures(json& document, mesh::SourceScene& scene, std::span<const std::vector<unsigned char>> pictures) {
    if (!document.contains("images")) return;
    json& images = array_of(document, "images");
    for (std::size_t i = 0; i < images.size(); ++i) {
        json& image = images[i];
        const std::string uri = image.value("uri", "");
        if (uri.empty() || i >= pictures.size() || pictures[i].empty()) continue;
        const std::string type = mime_type_of(pictures[i]);
        if (type.empty()) continue;
        if (!uri.starts_with("data:") && !image.contains("name"))
            image["name"] = std::filesystem::path(uri).stem().string();
        image.erase("uri");
        image["bufferView"] = add_view(document, scene.buffer, pictures[i]);
        images[i]["mimeType"] = type;
    }
}

void add_nodes_for_meshes(json& document) {
    if (document.contains("nodes") && !document["nodes"].empty()) return;
    json& nodes = array_of(document, "nodes");
    const std::size_t n = document.contains("meshes") ? document["meshes"].size() : 0;
    json roots = json::array();
    for (std::size_t m = 0; m < n; ++m) {
        nodes.push_back({{"mesh", m}});
        if (const json& mesh = document["meshes"][m]; mesh.contains("name")) nodes.back()["name"] = mesh["name"];
        roots.push_back(m);
    }
    document["scenes"] = json::array({{{"nodes", std::move(roots)}}});
    document["scene"] = 0;
}

}  // namespace

std::string mime_type_of(std::span<const unsigned char> bytes) {
    const auto starts = [&](std::string_view magic, std::size_t at = 0) {
        return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
    };
    if (starts("\x89PNG")) return "image/png";
    if (starts("\xff\xd8\xff")) return "image/jpeg";
    if (starts("RIFF") && starts("WEBP", 8)) return "image/webp";
    if (starts("\xabKTX 20")) return "image/ktx2";
    if (starts(std::string_view("II*\0", 4)) || starts(std::string_view("MM\0*", 4))) return "image/tiff";
    return {};
}

mesh::SourceScene pack_document(std::string_view text, std::span<const std::vector<unsigned char>> buffers,
                                std::span<const std::vector<unsigned char>> pictures, const std::string& name) {
    mesh::SourceScene scene;
    json document = parse(text, name);
    try {
        pack_buffers(document, scene, buffers, name);
        pack_pictures(document, scene, pictures);
        add_nodes_for_meshes(document);
    } catch (const json::exception&) {
        throw Error(name, "its JSON is not that of a glTF file");
    }
    document.erase("buffers");
    scene.document = document.dump(-1, ' ', false, json::error_handler_t::replace);
    return scene;
}

int SceneBuilder::add_texture(const std::string& name, std::span<const unsigned char> bytes) {
    const int view = add_view(document_, buffer_, bytes);
    json& images = array_of(document_, "images");
    images.push_back({{"name", name}, {"bufferView", view}, {"mimeType", mime_type_of(bytes)}});
    json& textures = array_of(document_, "textures");
    textures.push_back({{"source", images.size() - 1}});
    return static_cast<int>(textures.size()) - 1;
}

int SceneBuilder::add_material(json material) {
    json& materials = array_of(document_, "materials");
    materials.push_back(std::move(material));
    return static_cast<int>(materials.size()) - 1;
}

void SceneBuilder::keep_statements(int material, json statements) {
    json& all = array_of(document_, kStatements);
    while (all.size() <= static_cast<std::size_t>(material)) all.push_back(json::array());
    all[static_cast<std::size_t>(material)] = std::move(statements);
}

mesh::SourceScene SceneBuilder::finish(std::vector<mesh::ScenePart> parts, const std::string& root) {
    json& nodes = array_of(document_, "nodes");
    json roots = json::array();
    std::map<std::pair<std::string, std::string>, std::int32_t> node_of;
    const auto node = [&](const std::string& object, const std::string& group) {
        const auto [it, is_new] = node_of.try_emplace({object, group}, static_cast<std::int32_t>(nodes.size()));
        if (is_new) {
            const std::string& name = group.empty() ? object : group;
            nodes.push_back({{"name", name.empty() ? root : name}});
        }
        return std::pair(it->second, is_new);
    };
    for (mesh::ScenePart& part : parts) {
        const std::string group = part.group == part.object ? "" : part.group;
        if (group.empty() || part.object.empty()) {
            const auto [index, is_new] = node(part.object, group);
            if (is_new) roots.push_back(index);
            part.node = index;
            continue;
        }
        const auto [above, is_first] = node(part.object, "");
        if (is_first) roots.push_back(above);
        const auto [index, is_new] = node(part.object, group);
        if (is_new) nodes[static_cast<std::size_t>(above)]["children"].push_back(index);
        part.node = index;
    }
    document_["scenes"] = json::array({{{"nodes", std::move(roots)}}});
    document_["scene"] = 0;
    document_["asset"] = {{"version", "2.0"}};
    return {.parts = std::move(parts),
            .document = document_.dump(-1, ' ', false, json::error_handler_t::replace),
            .buffer = std::move(buffer_)};
}

json plain_material(const std::string& name, const Vec3f& srgb, int texture) {
    json colour = json::array();
    for (int c = 0; c < 3; ++c) colour.push_back(srgb[c] < 1 ? ink::srgb_decode(srgb[c]) : 1.0f);
    colour.push_back(1);
    json pbr{{"baseColorFactor", std::move(colour)}, {"metallicFactor", 0}, {"roughnessFactor", 0.5}};
    if (texture >= 0) pbr["baseColorTexture"] = {{"index", texture}};
    json material{{"pbrMetallicRoughness", std::move(pbr)}};
    if (!name.empty()) material["name"] = name;
    return material;
}

mesh::SourceScene make_scene(const mesh::TriangleMesh& mesh, const std::string& root) {
    SceneBuilder builder;
    std::vector<mesh::ScenePart> parts(
        std::max<std::size_t>(1, mesh.triangle_groups.empty() ? 1 : mesh.group_names.size()));
    if (mesh.scene && mesh.scene->parts.size() == parts.size())
        parts = mesh.scene->parts;
    else if (!mesh.triangle_groups.empty())
        for (std::size_t i = 0; i < parts.size(); ++i) parts[i].group = mesh.group_names[i];
    std::map<const mesh::Picture*, int> textures;
    for (std::size_t i = 0; i < parts.size() && mesh.materials.size() == parts.size() && !mesh.triangle_groups.empty();
         ++i) {
        const mesh::Material& m = mesh.materials[i];
        int texture = -1;
        if (m.picture && !mesh.corner_uvs.empty()) {
            const auto [it, is_new] = textures.try_emplace(m.picture.get(), -1);
            const auto* bytes = reinterpret_cast<const unsigned char*>(m.picture->bytes.data());
            if (is_new) it->second = builder.add_texture(m.picture->name, {bytes, m.picture->bytes.size()});
            texture = it->second;
        }
        if (parts[i].material.empty()) parts[i].material = mesh.group_names[i];
        parts[i].own_material = builder.add_material(plain_material(parts[i].material, m.colour, texture));
    }
    return builder.finish(std::move(parts), root);
}

json parse_document(const mesh::SourceScene& scene) {
    return parse(scene.document, "the scene of the model");
}

}  // namespace tuft::io
