#include "io/gltf/gltf_file.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/library_fault.h"
#include "core/text/nesting.h"
#include "core/text/text.h"
#include "io/gltf/gltf_compression.h"
#include "io/scene/materials.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

std::uint32_t u32(const char* bytes) {
    std::uint32_t v;
    std::memcpy(&v, bytes, sizeof v);
    return v;
}

/// Checks the chunks of a GLB (tinygltf trusts the length of the second one) and the JSON.
void check_container(const std::vector<char>& bytes, const std::string& name) {
    if (!bytes.empty() && std::memcmp(bytes.data(), "glTF", std::min<std::size_t>(4, bytes.size())) != 0) {
        check_json_nesting({bytes.data(), bytes.size()}, name);
        return;
    }
    if (bytes.size() < 20) throw Error(name, "the GLB file is cut short");
    if (u32(&bytes[4]) != 2) throw Error(name, Message("is glTF version {}; tuft reads version 2", u32(&bytes[4])));
    const std::size_t length = u32(&bytes[8]);
    if (length > bytes.size())
        throw Error(name, Message("the GLB file is cut short: it has {} of {} bytes", bytes.size(), length));
    std::size_t at = 12;
    for (int chunk = 0; at + 8 <= length; ++chunk) {
        const std::size_t size = u32(&bytes[at]);
        if (size > length - at - 8) throw Error(name, "a chunk of the GLB file is longer than the file");
        if (chunk == 0) check_json_nesting({&bytes[at + 8], size}, name);
        at += 8 + size;
    }
}

/// File access for external buffers: only inside the model's folder.
struct Sandbox {
    fs::path folder;
    std::string refused, missing;

    bool inside(const std::string& file) {
        if (lies_within(folder, file)) return true;
        refused = file;
        return false;
    }
    bool exists(const std::string& file) {
        std::error_code ec;
        if (!inside(file)) return false;
        if (fs::is_regular_file(file, ec)) return true;
        missing = file;
        return false;
    }
    Message fault() const {
        // The library looks in the working folder next, which is outside as a rule.
        if (!missing.empty()) return Message("it refers to '{}', which is not there", short_uri(missing));
        return Message("it refers to '{}', which is outside its folder", short_uri(refused));
    }
};

bool sandbox_exists(const std::string& file, void* sandbox) {
    return static_cast<Sandbox*>(sandbox)->exists(file);
}

std::string sandbox_expand(const std::string& file, void*) {
    return file;
}

bool sandbox_read(std::vector<unsigned char>* out, std::string* err, const std::string& file, void* sandbox) {
    try {
        if (!static_cast<Sandbox*>(sandbox)->inside(file)) return false;
        const std::vector<char> bytes = read_file(file);
        out->assign(bytes.begin(), bytes.end());
        return true;
    } catch (const std::exception& e) {
        *err += e.what();
        return false;
    }
}

bool sandbox_write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}

/// The bytes of each picture, as they are.
using PictureFiles = std::vector<std::vector<unsigned char>>;

constexpr std::size_t kMostPictures = 4096;

void keep_picture(PictureFiles& all, std::size_t index, std::span<const unsigned char> bytes) {
    if (index >= kMostPictures || bytes.empty()) return;
    if (all.size() <= index) all.resize(index + 1);
    all[index].assign(bytes.begin(), bytes.end());
}

bool take_picture(tinygltf::Image* image, const int index, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void* files) {
    // The library takes a buffer view's word for where it lies: those come afterwards.
    if (image->bufferView < 0 && index >= 0 && size > 0)
        keep_picture(*static_cast<PictureFiles*>(files), static_cast<std::size_t>(index),
                     {bytes, static_cast<std::size_t>(size)});
    return true;
}

/// The pictures in buffers; one that does not lie within its buffer is none.
void take_pictures_of_buffers(const tinygltf::Model& model, PictureFiles& files) {
    const auto lies_in = [](int index, const auto& all) {
        return index >= 0 && static_cast<std::size_t>(index) < all.size();
    };
    for (std::size_t i = 0; i < model.images.size(); ++i) {
        const int index = model.images[i].bufferView;
        if (!lies_in(index, model.bufferViews)) continue;
        const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(index)];
        if (!lies_in(view.buffer, model.buffers)) continue;
        const std::vector<unsigned char>& bytes = model.buffers[static_cast<std::size_t>(view.buffer)].data;
        if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) continue;
        keep_picture(files, i, std::span(bytes).subspan(view.byteOffset, view.byteLength));
    }
}

/// The JSON of a file whose container is sound.
std::string_view json_of(const std::vector<char>& bytes) {
    const std::string_view all(bytes.data(), bytes.size());
    return all.starts_with("glTF") ? all.substr(20, u32(&bytes[12])) : all;
}

struct Extension {
    std::string_view name;
    const char* advice;  ///< null: it changes nothing that tuft reads, and is handed on
};

/// Extensions that a file may require; the compressed ones are decoded first. Others may change where its triangles
/// lie.
constexpr std::array<Extension, 14> kExtensions{{
    {"KHR_draco_mesh_compression", nullptr},
    {"EXT_meshopt_compression", nullptr},
    {"KHR_texture_basisu", "its textures are in KTX 2; export them as PNG or JPEG"},
    {"EXT_texture_webp", "its textures are in WebP; export them as PNG or JPEG"},
    {"EXT_texture_avif", "its textures are in AVIF; export them as PNG or JPEG"},
    {"MSFT_texture_dds", "its textures are in DDS; export them as PNG or JPEG"},
    {"EXT_mesh_gpu_instancing", "its copies of meshes are one node; export a node for each"},
    {"KHR_texture_transform", nullptr},
    {"KHR_mesh_quantization", nullptr},
    {"KHR_lights_punctual", nullptr},
    {"KHR_xmp", nullptr},
    {"KHR_xmp_json_ld", nullptr},
    {"KHR_animation_pointer", nullptr},
    {"EXT_lights_image_based", nullptr},
}};

/// Why a required extension is refused; empty: it is not.
Message refusal_of(const std::string& name) {
    if (name.starts_with("KHR_materials_")) return {};
    for (const Extension& known : kExtensions)
        if (name == known.name)
            return known.advice
                       ? Message("it requires the glTF extension {}, which tuft does not read: {}", name, known.advice)
                       : Message();
    return Message("it requires the glTF extension '{}', which tuft does not know; export it without that extension",
                   name.substr(0, 60));
}

void check_extensions(std::string_view text, const std::string& file) {
    // Only this array is looked at: a buffer in the text may be large.
    const auto only_required = [key = std::string()](int at, nlohmann::json::parse_event_t event,
                                                     nlohmann::json& value) mutable {
        if (event == nlohmann::json::parse_event_t::key && at == 1) key = value.get<std::string>();
        return at == 0 || key == "extensionsRequired";
    };
    const nlohmann::json head = nlohmann::json::parse(text.begin(), text.end(), only_required, false);
    if (!head.is_object() || !head.contains("extensionsRequired") || !head["extensionsRequired"].is_array()) return;
    for (const nlohmann::json& name : head["extensionsRequired"]) {
        const Message why = name.is_string() ? refusal_of(name.get<std::string>()) : Message();
        if (!why.empty()) throw Error(file, why);
    }
}

/// What the library says, as one line of at most 300 characters, without the text of data URIs.
std::string one_line(std::string text) {
    for (std::size_t at = 0; (at = text.find("data:", at)) != text.npos;) {
        const std::size_t end = std::min(text.find_first_of(" \n\"'", at), text.size());
        const std::string shorter = short_uri(text.substr(at, end - at));
        text.replace(at, end - at, shorter);
        at += shorter.size();
    }
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    if (text.size() > 300) text = text.substr(0, 300) + "...";
    return text;
}

}  // namespace

GltfFile::GltfFile() = default;
GltfFile::~GltfFile() = default;
GltfFile::GltfFile(GltfFile&&) noexcept = default;

std::string short_uri(const std::string& uri) {
    constexpr std::size_t kMost = 80;
    if (!uri.starts_with("data:")) return uri.size() <= kMost ? uri : uri.substr(0, kMost) + "...";
    const std::size_t comma = std::min(uri.find(','), uri.size());
    return uri.substr(0, std::min(comma, kMost)) + ",... (" + std::to_string(uri.size()) + " characters)";
}

namespace {

/// The same of a file whose container is sound, without compression.
GltfFile open_plain(const std::vector<char>& bytes, const fs::path& path) {
    const std::string name = path.string();
    Sandbox sandbox{path.has_parent_path() ? path.parent_path() : fs::path("."), {}, {}};
    tinygltf::TinyGLTF loader;
    GltfFile file;
    file.model = std::make_unique<tinygltf::Model>();
    tinygltf::Model& model = *file.model;
    loader.SetImageLoader(take_picture, &file.pictures);
    loader.SetFsCallbacks({sandbox_exists, sandbox_expand, sandbox_read, sandbox_write, &sandbox});
    std::string err, warn;
    bool ok = false;
    try {
        const auto size = static_cast<unsigned>(bytes.size());
        if (bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0)
            ok = loader.LoadBinaryFromMemory(&model, &err, &warn, reinterpret_cast<const unsigned char*>(bytes.data()),
                                             size, sandbox.folder.string());
        else
            ok = loader.LoadASCIIFromString(&model, &err, &warn, bytes.data(), size, sandbox.folder.string());
    } catch (const std::bad_alloc&) {
        throw Error(name, "asks for more memory than there is");
    } catch (const std::exception& e) {
        err = e.what();
    }
    if (!ok) {
        if (!sandbox.refused.empty() || !sandbox.missing.empty()) throw Error(name, sandbox.fault());
        err = one_line(std::move(err));
        // The JSON library's messages begin with its name for the error, and end with what it read last.
        if (const auto end = err.find("] "); err.starts_with("[json.exception") && end != err.npos)
            throw Error(name, Message("its JSON cannot be read: {}",
                                      library_fault(err.substr(end + 2, err.find("; last read") - end - 2))));
        throw Error(name, err.empty() ? Message("is not a glTF file that can be read")
                                      : Message("is not a glTF file that can be read: {}", library_fault(err)));
    }
    if (model.asset.version.starts_with("1."))
        throw Error(name, Message("is glTF version {}; tuft reads version 2", model.asset.version));
    take_pictures_of_buffers(model, file.pictures);
    file.json = json_of(bytes);
    return file;
}

}  // namespace

GltfFile open_gltf(const std::vector<char>& bytes, const fs::path& path) {
    const std::string name = path.string();
    check_container(bytes, name);
    if (bytes.size() > std::numeric_limits<unsigned>::max()) throw Error(name, "is larger than 4 GiB");
    check_extensions(json_of(bytes), name);
    const std::optional<std::vector<char>> plain = decompress_gltf(bytes, path);
    return open_plain(plain ? *plain : bytes, path);
}

}  // namespace tuft::io
