#include "io/import/import_scene.h"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "io/scene/file_scene.h"

namespace tuft::io {
namespace {

using Mat4 = glm::dmat4;

/// No file but the one in memory.
class NoFiles : public Assimp::IOSystem {
  public:
    bool Exists(const char*) const override { return false; }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
    void Close(Assimp::IOStream*) override {}
};

Mat4 matrix_of(const aiMatrix4x4& m) {
    Mat4 out;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) out[column][row] = static_cast<double>(m[row][column]);
    return out;
}

/// Metres in the unit that an FBX file states; centimetres where it states none.
double fbx_unit(const aiScene& scene) {
    double centimetres = 1;
    if (float scale = 1; scene.mMetaData && scene.mMetaData->Get("UnitScaleFactor", scale))
        centimetres = static_cast<double>(scale);
    else if (scene.mMetaData)
        scene.mMetaData->Get("UnitScaleFactor", centimetres);
    return 0.01 * (centimetres > 0 && std::isfinite(centimetres) ? centimetres : 1);
}

/// Value of an attribute of an XML element, whose name and attributes are `tag`.
std::string_view attribute_of(std::string_view tag, std::string_view name) {
    constexpr std::string_view kBlank = " \t\r\n";
    const auto skip_to = [&](std::size_t at) { tag.remove_prefix(std::min(at, tag.size())); };
    skip_to(tag.find_first_of(kBlank));
    while (!tag.empty()) {
        skip_to(tag.find_first_not_of(kBlank));
        const std::string_view word = tag.substr(0, tag.find_first_of(" \t\r\n="));
        skip_to(tag.find_first_of("\"'"));
        if (tag.empty()) break;
        const std::string_view value = tag.substr(1, tag.find(tag[0], 1) - 1);
        if (word == name) return value;
        skip_to(value.size() + 2);
    }
    return {};
}

/// Metres in the unit that the <asset> of a DAE file states, which Assimp applies and does not tell; metres where it
/// states none.
double dae_unit(std::string_view text) {
    const std::size_t asset = text.find("<asset");
    if (asset == text.npos) return 1;
    text = text.substr(asset, text.find("</asset>", asset) - asset);
    const std::size_t unit = text.find("<unit");
    if (unit == text.npos) return 1;
    text = attribute_of(text.substr(unit, text.find('>', unit) - unit), "meter");
    text = text.substr(std::min(text.size(), text.find_first_not_of(" +")));
    double metres = 1;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), metres);
    return error == std::errc() && metres > 0 && std::isfinite(metres) ? metres : 1;
}

/// From the axes and the unit of the file to metres, z up.
Mat4 frame_of(const aiScene& scene, bool is_fbx) {
    if (!is_fbx) return Mat4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);  // Assimp turns DAE to metres, y up
    const auto whole = [&](const char* key, int other) {
        std::int32_t value = other;
        return scene.mMetaData && scene.mMetaData->Get(key, value) ? value : other;
    };
    std::array<int, 3> axis{whole("CoordAxis", 0), whole("FrontAxis", 2), whole("UpAxis", 1)};
    std::array<int, 3> sign{whole("CoordAxisSign", 1), whole("FrontAxisSign", 1), whole("UpAxisSign", 1)};
    std::array<int, 3> sorted = axis;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != std::array{0, 1, 2}) axis = {0, 2, 1}, sign = {1, 1, 1};
    Mat4 out(0);
    out[3][3] = 1;
    // Right is x; the front looks along −y; up is z.
    for (int k = 0; k < 3; ++k)
        out[axis[static_cast<std::size_t>(k)]][k] =
            (sign[static_cast<std::size_t>(k)] < 0 ? -1 : 1) * (k == 1 ? -1 : 1) * fbx_unit(scene);
    return out;
}

class Walker {
  public:
    Walker(const aiScene& scene, bool is_fbx) : in_(scene), frame_(frame_of(scene, is_fbx)) {}

    FileScene run() {
        for (unsigned m = 0; m < in_.mNumMaterials; ++m) out_.materials.push_back(material_of(*in_.mMaterials[m]));
        struct Visit {
            const aiNode* node;
            Mat4 parent;
        };
        std::vector<Visit> stack;
        if (in_.mRootNode) stack.push_back({in_.mRootNode, frame_});
        while (!stack.empty()) {
            const auto [node, parent] = stack.back();
            stack.pop_back();
            const Mat4 world = parent * matrix_of(node->mTransformation);
            for (unsigned i = 0; i < node->mNumMeshes; ++i)
                if (node->mMeshes[i] < in_.mNumMeshes) add_mesh(*in_.mMeshes[node->mMeshes[i]], *node, world);
            for (unsigned i = node->mNumChildren; i > 0; --i) stack.push_back({node->mChildren[i - 1], world});
        }
        if (out_.colours.size() < out_.points.size() && any_colour_)
            out_.colours.resize(out_.points.size(), {255, 255, 255, 255});
        if (lines_ > 0) out_.warnings.push_back(Message("{} points and lines were skipped", lines_));
        return std::move(out_);
    }

  private:
    FileMaterial material_of(const aiMaterial& m) {
        FileMaterial out{.name = m.GetName().C_Str()};
        if (aiColor4D colour;
            m.Get(AI_MATKEY_BASE_COLOR, colour) == AI_SUCCESS || m.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS)
            out.colour = {colour.r, colour.g, colour.b};
        if (float alpha = 1; m.Get(AI_MATKEY_OPACITY, alpha) == AI_SUCCESS && alpha > 0) out.alpha = alpha;
        m.Get(AI_MATKEY_ROUGHNESS_FACTOR, out.roughness);
        m.Get(AI_MATKEY_METALLIC_FACTOR, out.metallic);
        for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
            aiString name;
            if (m.GetTexture(type, 0, &name) != AI_SUCCESS || name.length == 0) continue;
            out.picture = name.C_Str();
            if (const aiTexture* inside = in_.GetEmbeddedTexture(name.C_Str()); inside && inside->mHeight == 0) {
                const char* bytes = reinterpret_cast<const char*>(inside->pcData);
                out.picture_bytes.assign(bytes, bytes + inside->mWidth);
                if (inside->mFilename.length > 0) out.picture = inside->mFilename.C_Str();
            }
            int channel = 0;
            m.Get(AI_MATKEY_UVWSRC(type, 0), channel);
            aiUVTransform moved;
            m.Get(AI_MATKEY_UVTRANSFORM(type, 0), moved);
            placed_[&m] = {channel, moved};
            break;
        }
        return out;
    }

    struct Placed {
        int channel = 0;
        aiUVTransform moved;

        /// Scaled, turned round the middle of the picture, moved.
        Vec2f operator()(const aiVector3D& uv) const {
            Vec2f at(uv.x * moved.mScaling.x, uv.y * moved.mScaling.y);
            if (moved.mRotation != 0) {
                const float c = std::cos(moved.mRotation), s = std::sin(moved.mRotation);
                at -= 0.5f;
                at = Vec2f(c * at.x - s * at.y, s * at.x + c * at.y) + 0.5f;
            }
            return at + Vec2f(moved.mTranslation.x, moved.mTranslation.y);
        }
    };

    void add_mesh(const aiMesh& mesh, const aiNode& node, const Mat4& world) {
        const auto base = static_cast<std::uint32_t>(out_.points.size());
        if (out_.points.size() + mesh.mNumVertices >= kNone) throw std::runtime_error(kTooManyVertices);
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D& p = mesh.mVertices[v];
            out_.points.push_back(Vec3(world * glm::dvec4(p.x, p.y, p.z, 1)));
        }
        add_colours(mesh, base);
        const auto part = static_cast<std::uint32_t>(out_.parts.size());
        const bool named = mesh.mMaterialIndex < in_.mNumMaterials;
        out_.parts.push_back({.object = node.mName.length > 0 ? node.mName.C_Str() : mesh.mName.C_Str(),
                              .material = named ? mesh.mMaterialIndex : kNone});
        Placed placed;
        if (named)
            if (const auto it = placed_.find(in_.mMaterials[mesh.mMaterialIndex]); it != placed_.end())
                placed = it->second;
        const bool has_channel = placed.channel >= 0 && placed.channel < AI_MAX_NUMBER_OF_TEXTURECOORDS;
        const aiVector3D* uvs = has_channel ? mesh.mTextureCoords[placed.channel] : nullptr;
        if (!uvs) uvs = mesh.mTextureCoords[0];
        add_faces(mesh, base, part, uvs, placed, glm::determinant(glm::dmat3(world)) < 0);
    }

    void add_faces(const aiMesh& mesh, std::uint32_t base, std::uint32_t part, const aiVector3D* uvs,
                   const Placed& placed, bool mirrored) {
        std::vector<std::uint32_t> corners;
        std::vector<Vec2f> corner_uvs;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            corners.clear();
            corner_uvs.clear();
            if (face.mNumIndices < 3) {
                ++lines_;
                continue;
            }
            for (unsigned i = 0; i < face.mNumIndices; ++i) {
                const unsigned index = face.mIndices[mirrored ? face.mNumIndices - 1 - i : i];
                if (index >= mesh.mNumVertices) throw std::runtime_error(kNoSuchVertex);
                corners.push_back(base + index);
                if (uvs) corner_uvs.push_back(placed(uvs[index]));
            }
            out_.add_polygon(part, corners, corner_uvs);
        }
    }

    void add_colours(const aiMesh& mesh, std::uint32_t base) {
        if (!mesh.mColors[0]) return;
        any_colour_ = true;
        out_.colours.resize(base, {255, 255, 255, 255});
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiColor4D& c = mesh.mColors[0][v];
            std::array<std::uint8_t, 4> bytes{255, 255, 255, 255};
            const std::array<float, 3> channels{c.r, c.g, c.b};
            for (std::size_t k = 0; k < 3; ++k)
                if (channels[k] >= 0) bytes[k] = static_cast<std::uint8_t>(std::min(channels[k], 1.0f) * 255 + 0.5f);
            out_.colours.push_back(bytes);
        }
    }

    const aiScene& in_;
    Mat4 frame_;
    FileScene out_;
    std::map<const aiMaterial*, Placed> placed_;
    std::size_t lines_ = 0;
    bool any_colour_ = false;
};

}  // namespace

void prepare_importer(Assimp::Importer& importer, const char* format) {
    importer.SetIOHandler(new NoFiles);
    // Only the reader of this format: the others would try their luck with what it refuses.
    const std::size_t wanted = importer.GetImporterIndex((std::string(".") + format).c_str());
    for (std::size_t i = importer.GetImporterCount(); i > 0; --i)
        if (i - 1 != wanted) importer.UnregisterLoader(importer.GetImporter(i - 1));
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);
}

std::vector<char> import_scene(Assimp::Importer& importer, const char* format, std::span<const char> bytes,
                               const std::function<void()>& is_read) {
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, format);
    if (!scene) {
        const std::string words = importer.GetErrorString();
        if (words.find("bad_alloc") != words.npos) throw std::bad_alloc();
        throw std::runtime_error(words);
    }
    if (is_read) is_read();
    const bool is_fbx = std::string_view(format) == "fbx";
    FileScene out = Walker(*scene, is_fbx).run();
    out.stated_unit = is_fbx ? fbx_unit(*scene) : dae_unit({bytes.data(), bytes.size()});
    return pack_scene(out);
}

}  // namespace tuft::io
