#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "core/error.h"
#include "ink/spectra/srgb.h"
#include "io/export/export_formats.h"
#include "io/export/gltf_prune.h"
#include "io/scene/json_number.h"
#include "io/scene/scene_document.h"

/// Writes glTF: the document of the file, with new triangles and materials for the parts with ink.
namespace tuft::io {
namespace {

using nlohmann::json;

constexpr std::size_t kNoPart = static_cast<std::size_t>(-1);
constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

/// Turns the model's frame into glTF's (y up).
Vec3f to_gltf(const Vec3f& v) {
    return {v.x, v.z, -v.y};
}

/// Unit tangents along +u with the handedness of the UVs, in the model's frame; bitangent = w (n ×
/// t) points towards +v (up in the picture).
std::vector<Vec4f> wedge_tangents(const ExportScene& scene) {
    const mesh::TriangleMesh& mesh = scene.mesh;
    std::vector<Vec3> sums(scene.wedges.vertex.size(), Vec3(0));
    std::vector<double> signs(sums.size(), 0);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec2 uv0(scene.corner_uvs[3 * t]);
        const Vec2 a = Vec2(scene.corner_uvs[3 * t + 1]) - uv0, b = Vec2(scene.corner_uvs[3 * t + 2]) - uv0;
        const double area = a.x * b.y - a.y * b.x;
        if (!(area != 0)) continue;
        const Vec3 p0 = mesh.position(t, 0), p = mesh.position(t, 1) - p0, q = mesh.position(t, 2) - p0;
        Vec3 along_u = (b.y * p - a.y * q) * (area > 0 ? 1.0 : -1.0);
        const double length = glm::length(along_u);
        if (!(length > 0)) continue;
        along_u *= glm::length(glm::cross(p, q)) / length;  // weight: the triangle's area
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t w = scene.wedges.corner_wedge[3 * t + k];
            sums[w] += along_u;
            signs[w] += area > 0 ? 1 : -1;
        }
    }
    std::vector<Vec4f> tangents(sums.size());
    for (std::size_t w = 0; w < sums.size(); ++w) {
        const Vec3 n = glm::normalize(Vec3(mesh.corner_normals[scene.wedges.corner[w]]));
        const double scale = glm::length(sums[w]);
        const Vec3 t = scale > 0 ? make_frame(Vec3(0), n, sums[w] / scale).t : make_frame(Vec3(0), n).t;
        tangents[w] = Vec4f(Vec3f(t), signs[w] < 0 ? -1.0f : 1.0f);
    }
    return tangents;
}

/// A node's frame. A transform that cannot be undone counts as none.
struct NodeFrame {
    glm::dmat4 inverse{1};
    glm::dmat3 linear{1};
    bool mirrors = false;

    explicit NodeFrame(const std::array<double, 16>& m) {
        glm::dmat4 world;
        for (int i = 0; i < 16; ++i) world[i / 4][i % 4] = m[static_cast<std::size_t>(i)];
        const double det = glm::determinant(glm::dmat3(world));
        if (!(std::isfinite(det) && det != 0)) return;
        inverse = glm::inverse(world);
        linear = glm::dmat3(world);
        mirrors = det < 0;
    }
    Vec3f position(const Vec3f& p) const { return Vec3f(Vec3(inverse * glm::dvec4(Vec3(to_gltf(p)), 1))); }
    /// Normals go back by the transpose, as they came by its inverse.
    Vec3f normal(const Vec3f& n) const { return unit(glm::transpose(linear) * Vec3(to_gltf(n))); }
    Vec3f tangent(const Vec3f& t) const { return unit(glm::dmat3(inverse) * Vec3(to_gltf(t))); }
    static Vec3f unit(const Vec3& v) {
        const double length = glm::length(v);
        return length > 0 ? Vec3f(v / length) : Vec3f(0, 0, 1);
    }
};

class Writer {
  public:
    Writer(const ExportScene& scene, std::span<const EncodedMap> maps, bool embed)
        : scene_(scene),
          maps_(maps),
          embed_(embed),
          document_(parse_document(scene.source)),
          local_(scene.wedges.vertex.size(), kNone) {
        bool with_normals = false;
        for (const EncodedMap& map : maps) with_normals |= map.kind == "normal";
        if (with_normals) tangents_ = wedge_tangents(scene);
    }

    void run() {
        document_["asset"]["version"] = "2.0";
        document_["asset"]["generator"] = "tuft";
        document_.erase(kStatements);
        References before = references_in(document_);
        for (const mesh::ScenePart& part : scene_.source.parts)
            if (part.primitive < 0 && part.own_material >= 0)
                before.materials.insert(static_cast<std::size_t>(part.own_material));
        const std::vector<std::vector<std::uint32_t>> triangles = triangles_of_parts(scene_);
        std::map<std::int32_t, std::vector<std::size_t>> parts_of;  // by node
        for (std::size_t i = 0; i < scene_.source.parts.size(); ++i) parts_of[scene_.source.parts[i].node].push_back(i);
        bool rebuilt = false;
        for (const auto& [node, parts] : parts_of) rebuilt |= rebuild_node(node, parts, triangles);
        if (rebuilt && !scene_.mesh.triangle_groups.empty())
            for (const auto& [node, parts] : parts_of) name_parts(node, parts, triangles);
        prune(document_, before);
    }

    /// The document, and the pieces of its buffer: bytes of the source, then new ones.
    json& document() { return document_; }
    const std::vector<unsigned char>& added() const { return added_; }

  private:
    json& list(const char* key) {
        json& value = document_[key];
        if (!value.is_array()) value = json::array();
        return value;
    }
    int add(const char* key, json value) {
        json& all = list(key);
        all.push_back(std::move(value));
        return static_cast<int>(all.size()) - 1;
    }

    /// Views of new bytes count from the end of the source's; see `take_views`.
    int add_view(const void* data, std::size_t size, int target) {
        added_.resize(aligned(added_.size()));
        json view{
            {"buffer", 0}, {"byteOffset", aligned(scene_.source.buffer.size()) + added_.size()}, {"byteLength", size}};
        if (target > 0) view["target"] = target;
        const auto* from = static_cast<const unsigned char*>(data);
        added_.insert(added_.end(), from, from + size);
        return add("bufferViews", std::move(view));
    }

    template <class T>
    int add_accessor(const std::vector<T>& values, int component, const char* type, int target,
                     json more = json::object()) {
        more["bufferView"] = add_view(values.data(), values.size() * sizeof(T), target);
        more["componentType"] = component;
        more["count"] = values.size();
        more["type"] = type;
        return add("accessors", std::move(more));
    }

    int add_texture(const EncodedMap& map) {
        if (sampler_ < 0)  // linear, mip-mapped, ends at the edge
            sampler_ = add("samplers", {{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 33071}, {"wrapT", 33071}});
        json image{{"name", map.kind}, {"mimeType", "image/png"}};
        if (embed_)
            image["bufferView"] = add_view(map.png.data(), map.png.size(), 0);
        else
            image["uri"] = map.file;
        const int source = add("images", std::move(image));
        return add("textures", {{"sampler", sampler_}, {"source", source}});
    }

    /// Index of the decorated material of a page; it keeps what the file says of the backs of
    /// faces.
    int decorated(std::uint32_t page, bool double_sided, bool transmits) {
        const auto [it, is_new] = decorated_.try_emplace({page, double_sided, transmits}, -1);
        if (!is_new) return it->second;
        json pbr{{"metallicFactor", 0}, {"roughnessFactor", 0.3}}, material;
        material["name"] = scene_.material_name(page) + (transmits ? mesh::kGlassSuffix : "");
        if (double_sided) material["doubleSided"] = true;
        for (const EncodedMap& map : maps_) {
            if (map.page != page || (map.kind == "transmission" && !transmits)) continue;
            const auto [texture, is_first] = textures_.try_emplace(&map, -1);
            if (is_first) texture->second = add_texture(map);
            if (map.kind == "base_colour") {
                pbr["baseColorTexture"] = {{"index", texture->second}};
            } else if (map.kind == "orm") {
                pbr["metallicRoughnessTexture"] = {{"index", texture->second}};
                pbr["metallicFactor"] = pbr["roughnessFactor"] = 1;
            } else if (map.kind == "normal") {
                material["normalTexture"] = {{"index", texture->second}};
            } else if (map.kind == "transmission") {
                material["extensions"]["KHR_materials_transmission"] = {
                    {"transmissionFactor", 1}, {"transmissionTexture", {{"index", texture->second}}}};
                use_extension("KHR_materials_transmission");
            }
        }
        material["pbrMetallicRoughness"] = std::move(pbr);
        return it->second = add("materials", std::move(material));
    }

    void use_extension(const char* name) {
        json& used = list("extensionsUsed");
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
    }

    /// The file's material without its pictures, which lie by other UVs; where there are no maps to
    /// write.
    int without_pictures(std::int32_t index, const json& own) {
        const auto [it, is_new] = bare_.try_emplace(index, -1);
        if (!is_new) return it->second;
        json material = own;
        drop_pictures(material);
        return it->second = add("materials", std::move(material));
    }
    static void drop_pictures(json& of) {
        for (auto it = of.begin(); it != of.end();)
            if (it.key().ends_with("Texture")) {
                it = of.erase(it);
            } else {
                if (it->is_object()) drop_pictures(*it);
                ++it;
            }
    }

    const json* own_material(const mesh::ScenePart& part) const {
        const auto materials = document_.find("materials");
        const auto index = static_cast<std::size_t>(part.own_material);
        if (part.own_material < 0 || materials == document_.end() || index >= materials->size()) return nullptr;
        return &(*materials)[index];
    }

    /// New primitives of a part: one, or one for each page that it lies on.
    json primitives_of(std::size_t index, const std::vector<std::uint32_t>& triangles) {
        const mesh::ScenePart& part = scene_.source.parts[index];
        const json* own = own_material(part);
        json out = json::array();
        if (!scene_.decorated[index] && own) {
            out.push_back(primitive_of(triangles, NodeFrame(part.transform), own, false));
            out.back()["material"] = part.own_material;
            return out;
        }
        const bool double_sided = own && own->value("doubleSided", false);
        const bool transmits = index < scene_.transmits.size() && scene_.transmits[index];
        std::map<std::uint32_t, std::vector<std::uint32_t>> by_page;
        for (const std::uint32_t t : triangles) by_page[scene_.page_of(t)].push_back(t);
        for (const auto& [page, here] : by_page) {
            json primitive = primitive_of(here, NodeFrame(part.transform), nullptr, !tangents_.empty());
            primitive["material"] = maps_.empty() && own ? without_pictures(part.own_material, *own)
                                                         : decorated(page, double_sided, transmits);
            own = own_material(part);  // the list has grown
            out.push_back(std::move(primitive));
        }
        return out;
    }

    /// `own`: the file's material, of a part without ink.
    json primitive_of(const std::vector<std::uint32_t>& triangles, const NodeFrame& frame, const json* own,
                      bool with_tangents) {
        const mesh::TriangleMesh& mesh = scene_.mesh;
        std::vector<std::uint32_t> indices, wedges;
        for (const std::uint32_t t : triangles)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t wedge = scene_.wedges.corner_wedge[3 * t + (frame.mirrors ? 2 - k : k)];
                if (local_[wedge] == kNone) {
                    local_[wedge] = static_cast<std::uint32_t>(wedges.size());
                    wedges.push_back(wedge);
                }
                indices.push_back(local_[wedge]);
            }
        for (const std::uint32_t wedge : wedges) local_[wedge] = kNone;
        const std::size_t n = wedges.size();
        std::vector<Vec3f> positions(n), normals(n);
        std::vector<Vec2f> uvs(n);
        std::vector<Vec4f> tangents(with_tangents ? n : 0);
        Vec3f lo(std::numeric_limits<float>::infinity()), hi(-lo);
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t wedge = wedges[i], corner = scene_.wedges.corner[wedge];
            positions[i] = frame.position(mesh.positions[scene_.wedges.vertex[wedge]]);
            normals[i] = frame.normal(mesh.corner_normals[corner]);
            uvs[i] = Vec2f(scene_.corner_uvs[corner].x, 1 - scene_.corner_uvs[corner].y);
            if (with_tangents) tangents[i] = Vec4f(frame.tangent(Vec3f(tangents_[wedge])), tangents_[wedge].w);
            lo = glm::min(lo, positions[i]);
            hi = glm::max(hi, positions[i]);
        }
        json attributes;
        attributes["POSITION"] = add_accessor(positions, kFloat, "VEC3", kVertexTarget,
                                              {{"min", {lo.x, lo.y, lo.z}}, {"max", {hi.x, hi.y, hi.z}}});
        attributes["NORMAL"] = add_accessor(normals, kFloat, "VEC3", kVertexTarget);
        if (!own || !mesh.corner_uvs.empty())
            attributes["TEXCOORD_0"] = add_accessor(uvs, kFloat, "VEC2", kVertexTarget);
        if (with_tangents) attributes["TANGENT"] = add_accessor(tangents, kFloat, "VEC4", kVertexTarget);
        if (own && !mesh.vertex_colours.empty() &&
            !own->value("pbrMetallicRoughness", json::object()).contains("baseColorTexture"))
            attributes["COLOR_0"] =
                add_accessor(vertex_colours(wedges), kUnsignedShort, "VEC4", kVertexTarget, {{"normalized", true}});
        return {{"attributes", std::move(attributes)},
                {"indices", add_accessor(indices, kUnsignedInt, "SCALAR", kIndexTarget)}};
    }

    std::vector<std::array<std::uint16_t, 4>> vertex_colours(const std::vector<std::uint32_t>& wedges) const {
        std::vector<std::array<std::uint16_t, 4>> colours;
        for (const std::uint32_t wedge : wedges) {
            const auto& code = scene_.mesh.vertex_colours[scene_.wedges.vertex[wedge]];
            std::array<std::uint16_t, 4> linear{0, 0, 0, 65535};
            for (std::size_t c = 0; c < 3; ++c)
                linear[c] = static_cast<std::uint16_t>(std::lround(65535 * ink::linear_of_code()[code[c]]));
            colours.push_back(linear);
        }
        return colours;
    }

    /// Gives a node its mesh anew where a part of it has ink, or where the document has no
    /// triangles. Returns whether it did.
    bool rebuild_node(std::int32_t index, const std::vector<std::size_t>& parts,
                      const std::vector<std::vector<std::uint32_t>>& triangles) {
        json& nodes = list("nodes");
        if (index < 0 || static_cast<std::size_t>(index) >= nodes.size() ||
            !nodes[static_cast<std::size_t>(index)].is_object())
            throw Error(Message("the scene of the model has no node {}", index));
        const bool as_read = std::all_of(parts.begin(), parts.end(), [&](std::size_t i) {
            const bool in_document = scene_.source.parts[i].primitive >= 0;
            return triangles[i].empty() || (in_document && !scene_.decorated[i]);
        });
        if (as_read) return false;
        const json old = mesh_of(nodes[static_cast<std::size_t>(index)]);
        json mesh = old, primitives = json::array();
        std::vector<std::size_t>& parts_here = part_of_primitive_[index];
        const auto add_part = [&](std::size_t part) {
            for (json& primitive : primitives_of(part, triangles[part])) {
                primitives.push_back(std::move(primitive));
                parts_here.push_back(part);
            }
        };
        const json old_primitives = old.value("primitives", json::array());
        std::map<std::size_t, std::size_t> new_of;  // by primitive
        for (const std::size_t i : parts) {
            const mesh::ScenePart& part = scene_.source.parts[i];
            if (triangles[i].empty() || (part.primitive >= 0 && !scene_.decorated[i])) continue;
            if (part.primitive >= 0)
                new_of[static_cast<std::size_t>(part.primitive)] = i;
            else
                add_part(i);
        }
        for (std::size_t p = 0; p < old_primitives.size(); ++p) {
            const auto made = new_of.find(p);
            if (made != new_of.end()) {
                add_part(made->second);
                continue;
            }
            primitives.push_back(old_primitives[p]);
            parts_here.push_back(part_at(parts, p));
        }
        for (json& primitive : primitives) primitive.erase("targets");
        mesh.erase("weights");
        mesh["primitives"] = std::move(primitives);
        if (!mesh.contains("name")) mesh["name"] = nodes[static_cast<std::size_t>(index)].value("name", scene_.name);
        put_mesh(static_cast<std::size_t>(index), std::move(mesh));
        return true;
    }

    /// The part of a node's primitive in the document, or `kNoPart`.
    std::size_t part_at(const std::vector<std::size_t>& parts, std::size_t primitive) const {
        for (const std::size_t i : parts)
            if (scene_.source.parts[i].primitive == static_cast<std::int32_t>(primitive)) return i;
        return kNoPart;
    }

    /// Says in a node how the parts of its primitives are called: their materials are others now.
    void name_parts(std::int32_t index, const std::vector<std::size_t>& parts,
                    const std::vector<std::vector<std::uint32_t>>& triangles) {
        json& node = list("nodes")[static_cast<std::size_t>(index)];
        auto rebuilt = part_of_primitive_.find(index);
        if (rebuilt == part_of_primitive_.end()) {
            rebuilt = part_of_primitive_.try_emplace(index).first;
            const std::size_t n = mesh_of(node).value("primitives", json::array()).size();
            for (std::size_t p = 0; p < n; ++p) rebuilt->second.push_back(part_at(parts, p));
        }
        json names = json::array();
        for (const std::size_t part : rebuilt->second) {
            const bool is_named = part != kNoPart && !triangles[part].empty();
            names.push_back(is_named ? scene_.mesh.group_names[scene_.mesh.triangle_groups[triangles[part][0]]] : "");
        }
        if (names.empty()) return;
        json& extras = node["extras"];
        if (extras.is_null() || extras.is_object()) extras[kPartNames] = std::move(names);
    }

    json mesh_of(const json& node) const {
        const auto meshes = document_.find("meshes");
        const std::size_t index = whole_number(node, "mesh", std::numeric_limits<std::size_t>::max());
        if (meshes == document_.end() || !meshes->is_array() || index >= meshes->size()) return json::object();
        return (*meshes)[index];
    }

    /// In place of the node's old mesh, or beside it where other nodes show that.
    void put_mesh(std::size_t index, json mesh) {
        json& nodes = list("nodes");
        const auto uses = [&](std::size_t m) {
            return std::count_if(nodes.begin(), nodes.end(),
                                 [&](const json& n) { return n.is_object() && n.contains("mesh") && n["mesh"] == m; });
        };
        if (nodes[index].contains("mesh") && nodes[index]["mesh"].is_number_unsigned() &&
            uses(nodes[index]["mesh"].get<std::size_t>()) == 1)
            list("meshes").at(nodes[index]["mesh"].get<std::size_t>()) = std::move(mesh);
        else
            nodes[index]["mesh"] = add("meshes", std::move(mesh));
        // Ink lies on the shape as it was read: not bent by bones, not morphed.
        nodes[index].erase("skin");
        nodes[index].erase("weights");
        drop_morphs(document_, index);
    }

    const ExportScene& scene_;
    std::span<const EncodedMap> maps_;
    bool embed_;
    json document_;
    std::vector<unsigned char> added_;
    std::vector<Vec4f> tangents_;                                     ///< by wedge, where there is a map of normals
    std::vector<std::uint32_t> local_;                                ///< by wedge: vertex of the primitive in work
    std::map<std::tuple<std::uint32_t, bool, bool>, int> decorated_;  ///< by page, double-sided, glass
    std::map<const EncodedMap*, int> textures_;
    std::map<std::int32_t, std::vector<std::size_t>> part_of_primitive_;  ///< by node
    std::map<std::int32_t, int> bare_;
    int sampler_ = -1;
};

void write_u32(std::ofstream& file, std::size_t value) {
    const auto v = static_cast<std::uint32_t>(value);
    file.write(reinterpret_cast<const char*>(&v), sizeof v);
}

void write_bytes(std::ofstream& file, std::span<const unsigned char> bytes) {
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// JSON of a file, padded to a multiple of 4 with spaces.
std::string text_of_document(const json& document, bool embed) {
    std::string text = document.dump(embed ? -1 : 2, ' ', false, json::error_handler_t::replace);
    while (embed && text.size() % 4 != 0) text += ' ';
    return text;
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps) {
    const bool embed = path.extension() == ".glb";
    std::optional<Writer> made;
    std::vector<unsigned char> buffer;
    try {
        made.emplace(scene, maps, embed);
        made->run();
        buffer = take_views(made->document(), scene.source.buffer, made->added());
    } catch (const json::exception&) {
        throw Error("the scene of the model cannot be written: its document is damaged");
    }
    json& document = made->document();
    if (!buffer.empty()) document["buffers"] = json::array({{{"byteLength", buffer.size()}}});
    if (embed && buffer.size() > std::numeric_limits<std::uint32_t>::max() - (1u << 26))
        throw Error(path.filename().string(), "a GLB file holds at most 4 GiB; export as .gltf");
    if (!embed) {
        if (!buffer.empty()) document["buffers"][0]["uri"] = safe_stem(path) + ".bin";
        for (const EncodedMap& map : maps) write_staged(path.parent_path() / map.file, map.png.data(), map.png.size());
        write_staged(path.parent_path() / (safe_stem(path) + ".bin"), buffer.data(), buffer.size());
        const std::string text = text_of_document(document, embed);
        write_staged(path, text.data(), text.size());
        return;
    }
    const std::string text = text_of_document(document, embed);
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    buffer.resize(aligned(buffer.size()));
    file.write("glTF", 4);
    write_u32(file, 2);
    write_u32(file, 20 + text.size() + (buffer.empty() ? 0 : 8 + buffer.size()));
    write_u32(file, text.size());
    file.write("JSON", 4);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (!buffer.empty()) {
        write_u32(file, buffer.size());
        file.write("BIN\0", 4);
        write_bytes(file, buffer);
    }
    file.close();
    if (!file) throw Error(path.filename().string(), "could not be written to its end (disk full?)");
}

}  // namespace tuft::io
