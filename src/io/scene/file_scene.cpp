#include "io/scene/file_scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/text/text.h"
#include "io/scene/materials.h"
#include "io/scene/scene_document.h"
#include "mesh/read/soup_builder.h"
#include "mesh/read/text_cursor.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

/// Makes materials of what the file says, each picture once.
class Materials {
  public:
    Materials(const FileScene& scene, fs::path folder, std::vector<Message>& warnings)
        : scene_(scene), folder_(std::move(folder)), warnings_(warnings) {}

    mesh::Material colours(std::uint32_t index) {
        if (index == kNone) return {.tinted = true};
        const FileMaterial& m = scene_.materials[index];
        mesh::Material out{.picture = picture(m)};
        if (!out.picture) out.colour = m.colour;
        return out;
    }

    nlohmann::json gltf(std::uint32_t index, SceneBuilder& builder) {
        const FileMaterial& m = scene_.materials[index];
        const auto picture_of = picture(m);
        int texture = -1;
        if (picture_of) {
            const auto [it, is_new] = textures_.try_emplace(picture_of.get(), -1);
            const auto* bytes = reinterpret_cast<const unsigned char*>(picture_of->bytes.data());
            if (is_new) it->second = builder.add_texture(picture_of->name, {bytes, picture_of->bytes.size()});
            texture = it->second;
        }
        nlohmann::json material = plain_material(to_utf8(m.name), picture_of ? Vec3f(1) : m.colour, texture);
        nlohmann::json& pbr = material["pbrMetallicRoughness"];
        pbr["roughnessFactor"] = m.roughness;
        pbr["metallicFactor"] = m.metallic;
        if (m.alpha < 1) {
            pbr["baseColorFactor"][3] = m.alpha;
            material["alphaMode"] = "BLEND";
        }
        return material;
    }

  private:
    std::shared_ptr<const mesh::Picture> picture(const FileMaterial& m) {
        if (m.picture.empty()) return nullptr;
        const std::string name = to_utf8(m.picture);
        const auto [it, is_new] = pictures_.try_emplace(name);
        if (!is_new) return it->second;
        try {
            it->second = m.picture_bytes.empty() ? read_picture_beside(folder_, name, warnings_)
                                                 : decode_picture(fs::path(name).filename().string(), m.picture_bytes);
        } catch (const std::exception& e) {
            warnings_.push_back(Message("{}; its faces go without", message_of(e)));
        }
        return it->second;
    }

    const FileScene& scene_;
    fs::path folder_;
    std::vector<Message>& warnings_;
    std::map<std::string, std::shared_ptr<const mesh::Picture>> pictures_;
    std::map<const mesh::Picture*, int> textures_;
};

float unit_or(float value, float other) {
    return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : other;
}

void bound(FileMaterial& m) {
    for (int c = 0; c < 3; ++c) m.colour[c] = unit_or(m.colour[c], 1);
    m.alpha = unit_or(m.alpha, 1);
    m.roughness = unit_or(m.roughness, 0.5f);
    m.metallic = unit_or(m.metallic, 0);
}

/// Parts of one object and one material are one group, however many the file has.
class Groups {
  public:
    Groups(const FileScene& scene, mesh::SoupBuilder& builder)
        : scene_(scene), builder_(builder), group_of_(scene.parts.size(), kNone) {}

    std::vector<mesh::ScenePart> parts;      ///< by group
    std::vector<std::uint32_t> material_of;  ///< by group

    std::uint32_t get(std::uint32_t index) {
        if (group_of_[index] != kNone) return group_of_[index];
        const FilePart& part = scene_.parts[index];
        const std::string material = part.material == kNone ? "" : scene_.materials[part.material].name;
        std::string name = part.object;
        if (!material.empty() && material != name) name += (name.empty() ? "" : " / ") + material;
        if (name.empty()) name = "part " + std::to_string(index + 1);
        const std::uint32_t group = group_of_[index] = builder_.group(name, material);
        if (group == parts.size()) {
            parts.push_back({.object = to_utf8(part.object), .material = to_utf8(material)});
            material_of.push_back(part.material);
        }
        return group;
    }

  private:
    const FileScene& scene_;
    mesh::SoupBuilder& builder_;
    std::vector<std::uint32_t> group_of_;
};

void add_polygons(const FileScene& scene, mesh::SoupBuilder& builder, Groups& groups) {
    std::size_t corner = 0;
    if (!scene.normals.empty()) builder.soup.corner_normals.reserve(scene.normals.size());
    for (std::size_t p = 0; p < scene.counts.size(); corner += scene.counts[p], ++p) {
        const std::span corners(scene.corners.data() + corner, scene.counts[p]);
        std::span<const Vec2f> uvs;
        if (!scene.uvs.empty()) uvs = std::span(scene.uvs).subspan(corner, scene.counts[p]);
        if (std::any_of(uvs.begin(), uvs.end(), [](const Vec2f& uv) { return std::isnan(uv.x) || std::isnan(uv.y); }))
            uvs = {};
        std::span<const Vec3f> normals;
        if (!scene.normals.empty()) normals = std::span(scene.normals).subspan(corner, scene.counts[p]);
        builder.add_polygon(corners, uvs, groups.get(scene.polygon_parts[p]), static_cast<long>(p) + 1, normals);
    }
}

void add_materials(mesh::PolygonSoup& soup, Groups& groups, Materials& materials) {
    soup.material_names.clear();
    soup.materials.clear();
    for (const std::uint32_t m : groups.material_of) soup.materials.push_back(materials.colours(m));
    SceneBuilder document;
    std::map<std::uint32_t, std::int32_t> made;
    for (std::size_t i = 0; i < groups.parts.size(); ++i) {
        const std::uint32_t material = groups.material_of[i];
        if (material == kNone) continue;
        const auto [it, is_new] = made.try_emplace(material, -1);
        if (is_new) it->second = document.add_material(materials.gltf(material, document));
        groups.parts[i].own_material = it->second;
    }
    soup.scene = std::make_shared<mesh::SourceScene>(document.finish(std::move(groups.parts), "model"));
    drop_plain_materials(soup);
}

}  // namespace

mesh::PolygonSoup soup_of(FileScene&& scene, const fs::path& model) {
    mesh::SoupBuilder builder(model.string(), "vertex");
    for (std::size_t i = 0; i < scene.points.size(); ++i) builder.add_point(scene.points[i], static_cast<long>(i) + 1);
    builder.soup.point_colours = std::move(scene.colours);
    builder.soup.warnings = std::move(scene.warnings);
    for (FileMaterial& m : scene.materials) bound(m);
    Groups groups(scene, builder);
    add_polygons(scene, builder, groups);
    mesh::PolygonSoup soup = builder.finish();
    Materials materials(scene, model.has_parent_path() ? model.parent_path() : fs::path("."), soup.warnings);
    add_materials(soup, groups, materials);
    soup.stated_unit = scene.stated_unit;
    soup.turned_up = true;
    return soup;
}

}  // namespace tuft::io
