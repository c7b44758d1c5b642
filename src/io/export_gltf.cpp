#include <tiny_gltf.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "io/export_formats.h"

namespace tuft::io {
namespace {

/// Turns the model's frame into glTF's (y up).
Vec3f to_gltf(const Vec3f& v) {
    return {v.x, v.z, -v.y};
}

/// Unit tangents along +u with the handedness of the UVs; bitangent = w (n × t) points
/// towards +v (up in the picture).
std::vector<Vec4f> wedge_tangents(const ExportScene& scene) {
    const mesh::TriangleMesh& mesh = scene.mesh;
    std::vector<Vec3> sums(scene.wedges.vertex.size(), Vec3(0));
    std::vector<double> signs(sums.size(), 0);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec2 uv0(scene.corner_uvs[3 * t]);
        const Vec2 a = Vec2(scene.corner_uvs[3 * t + 1]) - uv0,
                   b = Vec2(scene.corner_uvs[3 * t + 2]) - uv0;
        const double area = a.x * b.y - a.y * b.x;
        if (!(area != 0)) continue;
        const Vec3 p0 = mesh.position(t, 0), p = mesh.position(t, 1) - p0,
                   q = mesh.position(t, 2) - p0;
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
        const Vec3 t =
            scale > 0 ? make_frame(Vec3(0), n, sums[w] / scale).t : make_frame(Vec3(0), n).t;
        tangents[w] = Vec4f(to_gltf(Vec3f(t)), signs[w] < 0 ? -1.0f : 1.0f);
    }
    return tangents;
}

class Builder {
  public:
    tinygltf::Model model;

    Builder() {
        model.asset.version = "2.0";
        model.asset.generator = "tuft";
        model.buffers.emplace_back();
    }

    int add_view(const void* data, std::size_t size, int target) {
        std::vector<unsigned char>& bytes = model.buffers[0].data;
        bytes.resize((bytes.size() + 3) / 4 * 4, 0);
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = bytes.size();
        view.byteLength = size;
        view.target = target;
        const auto* from = static_cast<const unsigned char*>(data);
        bytes.insert(bytes.end(), from, from + size);
        model.bufferViews.push_back(view);
        return static_cast<int>(model.bufferViews.size()) - 1;
    }

    template <class T>
    int add_accessor(const std::vector<T>& values, int component, int type, int target) {
        tinygltf::Accessor accessor;
        accessor.bufferView = add_view(values.data(), values.size() * sizeof(T), target);
        accessor.componentType = component;
        accessor.type = type;
        accessor.count = values.size();
        model.accessors.push_back(accessor);
        return static_cast<int>(model.accessors.size()) - 1;
    }

    template <class T>
    int add_attribute(const std::vector<T>& values, int type) {
        return add_accessor(values, TINYGLTF_COMPONENT_TYPE_FLOAT, type,
                            TINYGLTF_TARGET_ARRAY_BUFFER);
    }

    /// A texture over a picture: in a buffer view, or in a file of its own.
    int add_texture(const EncodedMap& map, bool embed) {
        if (model.samplers.empty()) {
            tinygltf::Sampler sampler;
            sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
            sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
            sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
            model.samplers.push_back(sampler);
        }
        tinygltf::Image image;
        image.name = map.kind;
        image.mimeType = "image/png";
        if (embed)
            image.bufferView = add_view(map.png.data(), map.png.size(), 0);
        else
            image.uri = map.file;
        model.images.push_back(image);
        tinygltf::Texture texture;
        texture.sampler = 0;
        texture.source = static_cast<int>(model.images.size()) - 1;
        model.textures.push_back(texture);
        return static_cast<int>(model.textures.size()) - 1;
    }
};

tinygltf::Material material_of(Builder& builder, const ExportScene& scene,
                               std::span<const EncodedMap> maps, std::uint32_t page, bool embed) {
    tinygltf::Material material;
    material.name = "decorated";
    if (scene.udims.size() > 1) material.name += "." + std::to_string(scene.udims[page]);
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.3;
    for (const EncodedMap& map : maps) {
        if (map.page != page) continue;
        const int texture = builder.add_texture(map, embed);
        if (map.kind == "base_colour") {
            material.pbrMetallicRoughness.baseColorTexture.index = texture;
        } else if (map.kind == "orm") {
            material.pbrMetallicRoughness.metallicRoughnessTexture.index = texture;
            material.pbrMetallicRoughness.metallicFactor = 1;
            material.pbrMetallicRoughness.roughnessFactor = 1;
        } else if (map.kind == "normal") {
            material.normalTexture.index = texture;
        }
    }
    return material;
}

/// All vertices, without indices.
tinygltf::Primitive vertices_of(Builder& builder, const ExportScene& scene, bool tangents) {
    const mesh::TriangleMesh& mesh = scene.mesh;
    const std::size_t n = scene.wedges.vertex.size();
    std::vector<Vec3f> positions(n), normals(n);
    std::vector<Vec2f> uvs(n);
    Vec3f lo(std::numeric_limits<float>::infinity()), hi(-lo);
    for (std::size_t w = 0; w < n; ++w) {
        const std::uint32_t corner = scene.wedges.corner[w];
        positions[w] = to_gltf(mesh.positions[scene.wedges.vertex[w]]);
        normals[w] = to_gltf(mesh.corner_normals[corner]);
        uvs[w] = Vec2f(scene.corner_uvs[corner].x, 1 - scene.corner_uvs[corner].y);
        lo = glm::min(lo, positions[w]);
        hi = glm::max(hi, positions[w]);
    }
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    const int position = builder.add_attribute(positions, TINYGLTF_TYPE_VEC3);
    builder.model.accessors[position].minValues = {lo.x, lo.y, lo.z};
    builder.model.accessors[position].maxValues = {hi.x, hi.y, hi.z};
    primitive.attributes["POSITION"] = position;
    primitive.attributes["NORMAL"] = builder.add_attribute(normals, TINYGLTF_TYPE_VEC3);
    primitive.attributes["TEXCOORD_0"] = builder.add_attribute(uvs, TINYGLTF_TYPE_VEC2);
    if (tangents)
        primitive.attributes["TANGENT"] =
            builder.add_attribute(wedge_tangents(scene), TINYGLTF_TYPE_VEC4);
    return primitive;
}

/// The triangles of one page, over vertices that all pages share.
int indices_of(Builder& builder, const ExportScene& scene, std::uint32_t page) {
    const auto add = [&](const std::vector<std::uint32_t>& corners) {
        return builder.add_accessor(corners, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                    TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    };
    const std::vector<std::uint32_t>& all = scene.wedges.corner_wedge;
    if (scene.udims.size() == 1) return add(all);
    std::vector<std::uint32_t> own;
    for (std::size_t c = 0; c < all.size(); ++c)
        if (scene.page_of(c / 3) == page) own.push_back(all[c]);
    return add(own);
}

/// tinygltf does not say when the disk is full.
void check_written(const std::filesystem::path& path, std::size_t at_least) {
    std::error_code ec;
    const std::uintmax_t size = std::filesystem::file_size(path, ec);
    if (ec || size < at_least)
        throw Error(path.filename().string(), "could not be written to its end (disk full?)");
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const ExportScene& scene,
                std::span<const EncodedMap> maps) {
    const bool embed = path.extension() == ".glb";
    bool with_normals = false;
    for (const EncodedMap& map : maps) with_normals |= map.kind == "normal";

    Builder builder;
    tinygltf::Mesh mesh;
    mesh.name = scene.name;
    tinygltf::Primitive primitive = vertices_of(builder, scene, with_normals);
    for (std::uint32_t page = 0; page < scene.udims.size(); ++page) {
        primitive.material = static_cast<int>(page);
        primitive.indices = indices_of(builder, scene, page);
        mesh.primitives.push_back(primitive);
    }
    builder.model.meshes.push_back(mesh);
    for (std::uint32_t page = 0; page < scene.udims.size(); ++page)
        builder.model.materials.push_back(material_of(builder, scene, maps, page, embed));
    tinygltf::Node node;
    node.name = scene.name;
    node.mesh = 0;
    builder.model.nodes.push_back(node);
    tinygltf::Scene root;
    root.nodes.push_back(0);
    builder.model.scenes.push_back(root);
    builder.model.defaultScene = 0;

    const std::size_t bytes = builder.model.buffers[0].data.size();
    if (embed && bytes > std::numeric_limits<std::uint32_t>::max() - (1u << 20))
        throw Error(path.filename().string(), "a GLB file holds at most 4 GiB; export as .gltf");
    if (!embed) {
        builder.model.buffers[0].uri = safe_stem(path) + ".bin";
        for (const EncodedMap& map : maps)
            write_staged(path.parent_path() / map.file, map.png.data(), map.png.size());
    }
    tinygltf::TinyGLTF writer;
    writer.SetImageWriter(nullptr, nullptr);  // the pictures are encoded already
    if (!writer.WriteGltfSceneToFile(&builder.model, path.string(), false, embed, !embed, embed))
        throw Error(path.filename().string(), "could not be written");
    if (embed) {
        check_written(path, bytes + 20);
    } else {
        check_written(path.parent_path() / builder.model.buffers[0].uri, bytes);
        check_written(path, 100);
    }
}

}  // namespace tuft::io
