#include "io/gltf/read_gltf.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <span>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "ink/spectra/srgb.h"
#include "io/gltf/gltf_file.h"
#include "io/scene/materials.h"
#include "io/scene/scene_document.h"
#include "mesh/part_groups.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

constexpr int kMaxNodeDepth = 1000;
constexpr std::size_t kMaxCorners = std::size_t{1} << 31;

template <class T>
const T* element(const std::vector<T>& all, int index) {
    return index >= 0 && static_cast<std::size_t>(index) < all.size() ? &all[index] : nullptr;
}

/// The bytes of an accessor, checked against its buffer.
struct Rows {
    const unsigned char* first = nullptr;
    std::size_t count = 0, stride = 0;
    int component = 0, n_components = 0;
    bool normalised = false;

    double number(std::size_t row, int column) const {
        const unsigned char* at = first + row * stride;
        switch (component) {
            case TINYGLTF_COMPONENT_TYPE_FLOAT:
                return value<float>(at, column);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
                return value<std::uint32_t>(at, column);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
                return value<std::uint16_t>(at, column) / (normalised ? 65535.0 : 1.0);
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return value<std::uint8_t>(at, column) / (normalised ? 255.0 : 1.0);
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return normalised ? std::max(value<std::int16_t>(at, column) / 32767.0, -1.0)
                                  : value<std::int16_t>(at, column);
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return normalised ? std::max(value<std::int8_t>(at, column) / 127.0, -1.0)
                                  : value<std::int8_t>(at, column);
        }
        return 0;
    }

    template <class T>
    static double value(const unsigned char* at, int column) {
        T v;
        std::memcpy(&v, at + static_cast<std::size_t>(column) * sizeof(T), sizeof v);
        return static_cast<double>(v);
    }
};

Rows rows_of(const tinygltf::Model& model, int index, int type, const std::string& name) {
    const auto fail = [&](const Message& what) { throw Error(name, Message("accessor {} {}", index, what)); };
    const tinygltf::Accessor* accessor = element(model.accessors, index);
    if (!accessor) fail("does not exist");
    if (accessor->type != type) fail("has the wrong type");
    if (accessor->sparse.isSparse) fail("is sparse, which tuft does not read; export the model without");
    const tinygltf::BufferView* view = element(model.bufferViews, accessor->bufferView);
    if (!view) fail("has no buffer view, and so no values; export the model anew");
    const tinygltf::Buffer* buffer = element(model.buffers, view->buffer);
    if (!buffer) fail("has no buffer");
    const int component_size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor->componentType));
    const int n_components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
    if (component_size <= 0 || n_components <= 0 || accessor->componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE)
        fail("has an unknown component type");
    const std::size_t row = static_cast<std::size_t>(component_size) * n_components;
    const std::size_t stride = view->byteStride > 0 ? view->byteStride : row;
    const std::size_t have = buffer->data.size();
    if (view->byteOffset > have || view->byteLength > have - view->byteOffset) fail("lies outside its buffer");
    if (stride < row || stride > 4096 || accessor->byteOffset > view->byteLength) fail("lies outside its buffer");
    const std::size_t room = view->byteLength - accessor->byteOffset;
    if (accessor->count > 0 && (room < row || (room - row) / stride < accessor->count - 1))
        fail("lies outside its buffer view");
    return {.first = buffer->data.data() + view->byteOffset + accessor->byteOffset,
            .count = accessor->count,
            .stride = stride,
            .component = accessor->componentType,
            .n_components = n_components,
            .normalised = accessor->normalized};
}

using Mat4 = glm::dmat4;

Mat4 local_transform(const tinygltf::Node& node) {
    Mat4 m(1.0);
    if (node.matrix.size() == 16) {
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[i];
        return m;
    }
    if (node.rotation.size() == 4) {
        const Quat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        m = glm::mat4_cast(glm::normalize(q));
    }
    if (node.scale.size() == 3)
        for (int i = 0; i < 3; ++i) m[i] *= node.scale[i];
    if (node.translation.size() == 3)
        m[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
    return m;
}

/// By which UVs the picture of a material lies: those of a set, moved.
struct PictureUvs {
    int set = 0;  ///< TEXCOORD_n
    /// u and v, v down, to the picture's: these columns times (u, v, 1).
    std::array<Vec2, 3> columns{Vec2(1, 0), Vec2(0, 1), Vec2(0, 0)};
};

/// KHR_texture_transform: scaled, turned counter-clockwise as the picture is seen (v up), then moved. The
/// specification's GLSL reads the other way round; Khronos' sample viewer, three.js and Blender turn this way.
PictureUvs picture_uvs(const tinygltf::Material& material) {
    const tinygltf::TextureInfo& info = material.pbrMetallicRoughness.baseColorTexture;
    PictureUvs out{.set = info.texCoord};
    const auto moved = info.extensions.find("KHR_texture_transform");
    if (moved == info.extensions.end() || !moved->second.IsObject()) return out;
    const auto number = [](const tinygltf::Value& value, double other) {
        return value.IsNumber() && std::isfinite(value.GetNumberAsDouble()) ? value.GetNumberAsDouble() : other;
    };
    const auto pair = [&](const char* name, double other) {
        const tinygltf::Value& value = moved->second.Get(name);
        const bool is_pair = value.IsArray() && value.ArrayLen() == 2;
        return is_pair ? Vec2(number(value.Get(0), other), number(value.Get(1), other)) : Vec2(other);
    };
    const Vec2 offset = pair("offset", 0), scale = pair("scale", 1);
    const double turn = number(moved->second.Get("rotation"), 0);
    out.columns = {scale.x * Vec2(std::cos(turn), -std::sin(turn)), scale.y * Vec2(std::sin(turn), std::cos(turn)),
                   offset};
    if (const tinygltf::Value& set = moved->second.Get("texCoord"); set.IsInt()) out.set = set.GetNumberAsInt();
    return out;
}

class Gatherer {
  public:
    Gatherer(GltfFile& file, std::string name) : file_(file), model_(*file.model), name_(std::move(name)) {}

    mesh::PolygonSoup run() {
        soup_.polygon_start.push_back(0);
        std::vector<int> roots;
        const int scene = model_.defaultScene >= 0 ? model_.defaultScene : 0;
        if (const tinygltf::Scene* s = element(model_.scenes, scene)) roots = s->nodes;
        if (roots.empty()) roots = parentless();
        // Depth first; a node may hang in the tree once, which also stops cycles.
        struct Visit {
            int node, depth;
            Mat4 parent;
        };
        std::vector<Visit> stack;
        for (auto it = roots.rbegin(); it != roots.rend(); ++it) stack.push_back({*it, 0, Mat4(1.0)});
        std::vector<bool> seen(model_.nodes.size(), false);
        while (!stack.empty()) {
            const Visit visit = stack.back();
            stack.pop_back();
            const tinygltf::Node* node = element(model_.nodes, visit.node);
            if (!node) throw Error(name_, Message("node {} does not exist", visit.node));
            if (seen[visit.node] || visit.depth > kMaxNodeDepth) throw Error(name_, "its nodes do not form a tree");
            seen[visit.node] = true;
            const Mat4 world = visit.parent * local_transform(*node);
            if (node->mesh >= 0) add_mesh(node->mesh, visit.node, world);
            for (auto it = node->children.rbegin(); it != node->children.rend(); ++it)
                stack.push_back({*it, visit.depth + 1, world});
        }
        if (model_.nodes.empty())
            for (std::size_t m = 0; m < model_.meshes.size(); ++m)
                add_mesh(static_cast<int>(m), static_cast<int>(m), Mat4(1.0));
        if (soup_.n_polygons() == 0)
            throw Error(name_, soup_.warnings.empty() ? Message("has no triangles")
                                                      : Message("has no triangles: {}", soup_.warnings.front()));
        if (!any_uv_) soup_.corner_uvs.clear();
        if (!any_colour_) soup_.point_colours.clear();
        group_faces();
        drop_plain_materials(soup_);
        keep_scene();
        soup_.stated_unit = 1;
        soup_.turned_up = true;
        return std::move(soup_);
    }

  private:
    std::vector<int> parentless() const {
        std::vector<bool> child(model_.nodes.size(), false);
        for (const tinygltf::Node& node : model_.nodes)
            for (const int c : node.children)
                if (element(model_.nodes, c)) child[c] = true;
        std::vector<int> roots;
        for (std::size_t n = 0; n < child.size(); ++n)
            if (!child[n]) roots.push_back(static_cast<int>(n));
        return roots;
    }

    /// The file as exports write it again, in one buffer.
    void keep_scene() {
        std::vector<std::vector<unsigned char>> buffers;
        for (tinygltf::Buffer& buffer : model_.buffers) buffers.push_back(std::move(buffer.data));
        soup_.scene = std::make_shared<mesh::SourceScene>(pack_document(file_.json, buffers, file_.pictures, name_));
        soup_.scene->parts = std::move(parts_);
    }

    void add_mesh(int index, int node, const Mat4& world) {
        const tinygltf::Mesh* mesh = element(model_.meshes, index);
        if (!mesh) throw Error(name_, Message("mesh {} does not exist", index));
        const tinygltf::Node* at = element(model_.nodes, node);
        for (std::size_t p = 0; p < mesh->primitives.size(); ++p) {
            const tinygltf::Primitive& primitive = mesh->primitives[p];
            const tinygltf::Material* material = element(model_.materials, primitive.material);
            mesh::ScenePart part{
                .object = at && !at->name.empty() ? at->name : mesh->name,
                .group = exported_name(model_.nodes.empty() ? nullptr : at, p, mesh->primitives.size()),
                .material = material ? material->name : "",
                .node = node,
                .primitive = static_cast<std::int32_t>(p),
                .own_material = material ? primitive.material : -1};
            for (int i = 0; i < 16; ++i) part.transform[static_cast<std::size_t>(i)] = world[i / 4][i % 4];
            parts_.push_back(std::move(part));
            add_primitive(*mesh, primitive, world);
        }
    }

    /// The groups with faces, and their materials.
    void group_faces() {
        const mesh::PartGroups groups = mesh::group_parts(parts_);
        std::vector<std::uint32_t> group_of(groups.names.size(), kNone);
        std::set<std::uint32_t> seen;  // parts with a page
        for (const std::uint32_t part : soup_.polygon_parts) {
            std::uint32_t& group = group_of[groups.of_part[part]];
            if (group == kNone) {
                group = static_cast<std::uint32_t>(soup_.group_names.size());
                soup_.group_names.push_back(groups.names[groups.of_part[part]]);
                const tinygltf::Material* material = element(model_.materials, parts_[part].own_material);
                soup_.materials.push_back(material ? material_of(*material) : mesh::Material{.tinted = true});
            }
            soup_.polygon_groups.push_back(group);
            if (page_of(part) > 0 && seen.insert(part).second) add_page(soup_.materials[group], part);
        }
    }

    std::uint32_t page_of(std::uint32_t part) const { return mesh::decorated_page(parts_[part].material); }

    /// Gives a decorated part's material its picture on one page.
    void add_page(mesh::Material& material, std::uint32_t part) {
        const tinygltf::Material* own = element(model_.materials, parts_[part].own_material);
        const mesh::PictureTile page{page_of(part), own ? material_of(*own).picture : nullptr};
        const auto at = std::ranges::lower_bound(material.tiles, page.udim, {}, &mesh::PictureTile::udim);
        if (!page.picture || (at != material.tiles.end() && at->udim == page.udim)) return;
        material.tiles.insert(at, page);
        material.picture = material.tiles.front().picture;
    }

    /// Moves the UVs of the last triangle to the page of its part: in the file all pages lie on the same square.
    void move_to_page(std::uint32_t page) {
        const std::span<Vec2f> uvs = std::span(soup_.corner_uvs).last(3);
        const Vec2f middle = (uvs[0] + uvs[1] + uvs[2]) / 3.0f;
        const auto tile = static_cast<int>(page - 1001);
        const Vec2f shift = Vec2f(tile % 10, tile / 10) - glm::floor(middle);
        for (Vec2f& uv : uvs) uv += shift;
    }

    /// Name that an export gave a primitive of a node; none where another program changed the primitives since.
    static std::string exported_name(const tinygltf::Node* node, std::size_t primitive, std::size_t n_primitives) {
        if (!node || !node->extras.Has(kPartNames)) return {};
        const tinygltf::Value& names = node->extras.Get(kPartNames);
        if (!names.IsArray() || names.ArrayLen() != n_primitives) return {};
        const tinygltf::Value& name = names.Get(static_cast<int>(primitive));
        return name.IsString() ? name.Get<std::string>() : std::string();
    }

    mesh::Material material_of(const tinygltf::Material& material) {
        const tinygltf::PbrMetallicRoughness& pbr = material.pbrMetallicRoughness;
        mesh::Material out{.tinted = true};
        for (std::size_t c = 0; c < std::min<std::size_t>(3, pbr.baseColorFactor.size()); ++c) {
            const double factor = pbr.baseColorFactor[c];
            const double linear = std::isfinite(factor) ? std::clamp(factor, 0.0, 1.0) : 1.0;
            out.colour[static_cast<int>(c)] = linear < 1 ? ink::srgb_encode(static_cast<float>(linear)) : 1;
        }
        const tinygltf::Texture* texture = element(model_.textures, pbr.baseColorTexture.index);
        if (!texture) return out;
        out.picture = picture(texture->source);
        return out;
    }

    /// Each picture is read once, and reported once when that fails.
    std::shared_ptr<const mesh::Picture> picture(int index) {
        const auto [it, is_new] = pictures_.try_emplace(index);
        const tinygltf::Image* image = element(model_.images, index);
        if (!is_new) return it->second;
        std::string name = image ? image->name.empty() ? short_uri(image->uri) : image->name : "";
        if (name.empty()) name = "picture " + std::to_string(index);
        const std::vector<unsigned char>* bytes = element(file_.pictures, index);
        try {
            if (!image || !bytes || bytes->empty())
                soup_.warnings.push_back(Message("the picture '{}' is not there; its faces go without", name));
            else
                it->second = decode_picture(name, {bytes->begin(), bytes->end()});
        } catch (const std::exception& e) {
            soup_.warnings.push_back(Message("{}; its faces go without", message_of(e)));
        }
        return it->second;
    }

    void add_primitive(const tinygltf::Mesh& mesh, const tinygltf::Primitive& primitive, const Mat4& world) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode != TINYGLTF_MODE_TRIANGLES && mode != TINYGLTF_MODE_TRIANGLE_STRIP &&
            mode != TINYGLTF_MODE_TRIANGLE_FAN) {
            soup_.warnings.push_back(Message("points and lines of mesh '{}' were skipped", mesh.name));
            return;
        }
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) {
            soup_.warnings.push_back(Message("a part of mesh '{}' without positions was skipped", mesh.name));
            return;
        }
        const Rows points = rows_of(model_, position->second, TINYGLTF_TYPE_VEC3, name_);
        const CornerUvs uvs = uvs_of(mesh, primitive, points.count);
        Rows indices;
        if (primitive.indices >= 0) indices = rows_of(model_, primitive.indices, TINYGLTF_TYPE_SCALAR, name_);
        const bool indexed = primitive.indices >= 0;
        const std::size_t n = indexed ? indices.count : points.count;
        const std::uint32_t base = add_points(points, world);
        add_colours(primitive, points.count);
        // A mirroring transform turns the triangles inside out.
        const bool mirrored = glm::determinant(glm::dmat3(world)) < 0;
        const auto index_at = [&](std::size_t i) {
            const double index = indexed ? indices.number(i, 0) : static_cast<double>(i);
            if (!(index >= 0 && index < static_cast<double>(points.count)))
                throw Error(name_, Message("index {} of mesh '{}' is out of range (there are {} vertices)",
                                           static_cast<long long>(index), mesh.name, points.count));
            return static_cast<std::uint32_t>(index);
        };
        const bool list = mode == TINYGLTF_MODE_TRIANGLES;
        const std::size_t n_triangles = list ? n / 3 : (n >= 3 ? n - 2 : 0);
        if (soup_.corners.size() + 3 * n_triangles > kMaxCorners) throw Error(name_, "has too many triangles");
        const std::uint32_t page = page_of(static_cast<std::uint32_t>(parts_.size()) - 1);
        std::size_t dropped = 0;
        for (std::size_t t = 0; t < n_triangles; ++t) {
            std::array<std::size_t, 3> at{3 * t, 3 * t + 1, 3 * t + 2};
            if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) at = {t, t + 1 + t % 2, t + 2 - t % 2};
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN) at = {t + 1, t + 2, 0};
            if (mirrored) std::swap(at[1], at[2]);
            const std::array<std::uint32_t, 3> index{index_at(at[0]), index_at(at[1]), index_at(at[2])};
            if (bad_[base + index[0]] || bad_[base + index[1]] || bad_[base + index[2]]) {
                ++dropped;
                continue;
            }
            for (const std::uint32_t i : index) add_corner(base, i, uvs);
            if (page > 0 && uvs.rows.first) move_to_page(page);
            soup_.polygon_start.push_back(static_cast<std::uint32_t>(soup_.corners.size()));
            soup_.polygon_parts.push_back(static_cast<std::uint32_t>(parts_.size()) - 1);
        }
        if (dropped > 0)
            soup_.warnings.push_back(
                Message("{} triangles of mesh '{}' were dropped: their vertices are no finite numbers or lie more than "
                        "10 km away",
                        dropped, mesh.name));
    }

    std::uint32_t add_points(const Rows& points, const Mat4& world) {
        const auto base = static_cast<std::uint32_t>(soup_.points.size());
        if (soup_.points.size() + points.count > kMaxCorners) throw Error(name_, "has too many vertices");
        soup_.points.reserve(soup_.points.size() + points.count);
        for (std::size_t i = 0; i < points.count; ++i) {
            const Vec3 p = Vec3(world * glm::dvec4(points.number(i, 0), points.number(i, 1), points.number(i, 2), 1));
            const bool fits = within(p);
            bad_.push_back(!fits);
            soup_.points.push_back(fits ? Vec3(p.x, -p.z, p.y) : Vec3(0));
        }
        return base;
    }

    /// COLOR_0, linear; white where there is none.
    void add_colours(const tinygltf::Primitive& primitive, std::size_t n) {
        soup_.point_colours.resize(soup_.points.size(), {255, 255, 255, 255});
        const auto colour = primitive.attributes.find("COLOR_0");
        if (colour == primitive.attributes.end()) return;
        const tinygltf::Accessor* accessor = element(model_.accessors, colour->second);
        const int type = accessor && accessor->type == TINYGLTF_TYPE_VEC4 ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
        const Rows rows = rows_of(model_, colour->second, type, name_);
        if (rows.count != n) throw Error(name_, "COLOR_0 and POSITION differ in count");
        any_colour_ = true;
        for (std::size_t i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c) {
                const double value = rows.number(i, c);
                const double linear = std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 1.0;
                soup_.point_colours[soup_.points.size() - n + i][static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::lround(255 * ink::srgb_encode(static_cast<float>(linear))));
            }
    }

    struct CornerUvs {
        Rows rows;
        PictureUvs place;
    };

    /// Those by which its picture lies; where it has none, or not those, TEXCOORD_0.
    CornerUvs uvs_of(const tinygltf::Mesh& mesh, const tinygltf::Primitive& primitive, std::size_t n_points) {
        CornerUvs out;
        const tinygltf::Material* material = element(model_.materials, primitive.material);
        if (material && material->pbrMetallicRoughness.baseColorTexture.index >= 0) out.place = picture_uvs(*material);
        std::string name = "TEXCOORD_" + std::to_string(out.place.set);
        auto found = primitive.attributes.find(name);
        if (found == primitive.attributes.end() && out.place.set != 0) {
            soup_.warnings.push_back(Message(
                "mesh '{}' has no {}, by which the picture of material '{}' lies; it lies by TEXCOORD_0 instead",
                mesh.name, name, material->name));
            found = primitive.attributes.find(name = "TEXCOORD_0");
        }
        if (found == primitive.attributes.end()) return out;
        out.rows = rows_of(model_, found->second, TINYGLTF_TYPE_VEC2, name_);
        if (out.rows.count != n_points) throw Error(name_, Message("{} and POSITION differ in count", name));
        any_uv_ = true;
        return out;
    }

    void add_corner(std::uint32_t base, std::uint32_t index, const CornerUvs& uvs) {
        soup_.corners.push_back(base + index);
        Vec2f uv(0);
        if (uvs.rows.first) {
            const auto& [x, y, one] = uvs.place.columns;
            const Vec2 at = uvs.rows.number(index, 0) * x + uvs.rows.number(index, 1) * y + one;
            uv = Vec2f(static_cast<float>(at.x), static_cast<float>(1 - at.y));
        }
        soup_.corner_uvs.push_back(uv);
    }

    GltfFile& file_;
    tinygltf::Model& model_;
    std::string name_;
    std::vector<mesh::ScenePart> parts_;
    mesh::PolygonSoup soup_;
    std::map<int, std::shared_ptr<const mesh::Picture>> pictures_;
    std::vector<bool> bad_;  ///< [n_points] not finite or out of bounds
    bool any_uv_ = false, any_colour_ = false;
};

}  // namespace

mesh::PolygonSoup read_gltf(const std::vector<char>& bytes, const fs::path& path) {
    GltfFile file = open_gltf(bytes, path);
    return Gatherer(file, path.string()).run();
}

}  // namespace tuft::io
