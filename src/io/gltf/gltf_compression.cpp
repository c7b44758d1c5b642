#include "io/gltf/gltf_compression.h"

#include <meshoptimizer.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>

#include "core/error.h"
#include "core/files/files.h"
#include "io/gltf/draco_mesh.h"
#include "io/gltf/gltf_file.h"
#include "io/scene/json_number.h"
#include "io/scene/materials.h"
#include "io/scene/scene_document.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

using nlohmann::json;
using Bytes = std::vector<unsigned char>;

constexpr const char *kDraco = "KHR_draco_mesh_compression", *kMeshopt = "EXT_meshopt_compression";
constexpr std::size_t kMostBytes = std::size_t{4} << 30, kLeastMost = std::size_t{1} << 28;
constexpr std::size_t kMostJoined = 512;  // bytes more for each of the file's buffers
constexpr std::size_t kMostGrowth = 256;  // of a meshopt stream; its codecs have at least a bit for 8 bytes

struct Container {
    std::string_view text;
    std::span<const unsigned char> binary;
};

Container container_of(const std::vector<char>& bytes) {
    const std::string_view all(bytes.data(), bytes.size());
    if (!all.starts_with("glTF")) return {.text = all, .binary = {}};
    const auto number = [&](std::size_t at) {
        std::uint32_t v = 0;
        std::memcpy(&v, &bytes[at], sizeof v);
        return std::size_t{v};
    };
    Container out{.text = all.substr(20, number(12)), .binary = {}};
    const std::size_t next = 20 + number(12);
    if (next + 8 <= bytes.size())
        out.binary = {reinterpret_cast<const unsigned char*>(&bytes[next]) + 8,
                      std::min(number(next), bytes.size() - next - 8)};
    return out;
}

std::string without_percents(const std::string& uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_code = uri[i] == '%' && i + 2 < uri.size() &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 1])) &&
                             std::isxdigit(static_cast<unsigned char>(uri[i + 2]));
        out += is_code ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
        if (is_code) i += 2;
    }
    return out;
}

bool has_extension(const json& object, const char* name) {
    return object.is_object() && object.contains("extensions") && object["extensions"].is_object() &&
           object["extensions"].contains(name);
}

/// Removes it, and the list that then is empty.
void erase_extension(json& object, const char* name) {
    object["extensions"].erase(name);
    if (object["extensions"].empty()) object.erase("extensions");
}

class Decompressor {
  public:
    Decompressor(json document, const Container& container, const fs::path& path)
        : document_(std::move(document)), container_(container), path_(path), name_(path.string()) {}

    std::vector<char> run() {
        join_buffers();
        for (json& view : array("bufferViews"))
            if (has_extension(view, kMeshopt)) decode_view(view);
        for (json& mesh : array("meshes")) {
            if (!mesh.is_object() || !mesh.contains("primitives") || !mesh["primitives"].is_array()) continue;
            for (json& primitive : mesh["primitives"])
                if (has_extension(primitive, kDraco)) decode_primitive(primitive);
        }
        for (const char* list : {"extensionsUsed", "extensionsRequired"}) forget(list);
        return glb();
    }

  private:
    json& array(const char* key) {
        json& value = document_[key];
        if (!value.is_array()) value = json::array();
        return value;
    }

    void forget(const char* list) {
        json left = json::array();
        for (const json& extension : array(list))
            if (extension != kDraco && extension != kMeshopt) left.push_back(extension);
        document_.erase(list);
        if (!left.empty()) document_[list] = std::move(left);
    }

    Bytes bytes_of(const json& buffer, bool is_first) const {
        const std::string uri = buffer.is_object() ? buffer.value("uri", "") : "";
        if (uri.empty()) return is_first ? Bytes(container_.binary.begin(), container_.binary.end()) : Bytes();
        if (uri.starts_with("data:")) {
            Bytes out;
            std::string type;
            if (!tinygltf::DecodeDataURI(&out, type, uri, 0, false))
                throw Error(name_, "a buffer of the file is no base64 that can be read");
            return out;
        }
        const fs::path folder = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
        const fs::path file = folder / without_percents(uri);
        if (!lies_within(folder, file))
            throw Error(name_, Message("it refers to '{}', which is outside its folder", short_uri(uri)));
        const std::vector<char> bytes = read_file(file);
        return {bytes.begin(), bytes.end()};
    }

    /// All buffers in a row; one that is to be decoded into has no bytes.
    void join_buffers() {
        for (const json& buffer : array("buffers")) {
            const bool is_target = has_extension(buffer, kMeshopt);
            const Bytes bytes = is_target ? Bytes() : bytes_of(buffer, starts_.empty());
            most_ = std::min(kMostBytes, most_ + kMostJoined * bytes.size());
            sizes_.push_back(bytes.size());
            starts_.push_back(append(bytes));
        }
        for (json& view : array("bufferViews")) {
            if (has_extension(view, kMeshopt)) continue;
            const std::size_t buffer = whole_number<std::size_t>(view.at("buffer"));
            if (buffer >= starts_.size()) throw Error(name_, "a buffer view has no buffer");
            const std::size_t offset = whole_number(view, "byteOffset", std::size_t{0});
            const std::size_t length = whole_number(view, "byteLength", std::size_t{0});
            if (offset > sizes_[buffer] || length > sizes_[buffer] - offset)
                throw Error(name_, "a buffer view lies outside its buffer");
            view["byteOffset"] = starts_[buffer] + offset;
            view["buffer"] = 0;
        }
        array("buffers") = json::array({json::object()});
    }

    std::size_t append(std::span<const unsigned char> bytes) {
        if (bytes.size() > most_ || joined_.size() > most_ - bytes.size())
            throw Error(name_, "its compressed parts become too large");
        joined_.resize(aligned(joined_.size()));
        const std::size_t at = joined_.size();
        joined_.insert(joined_.end(), bytes.begin(), bytes.end());
        return at;
    }

    void decode_view(json& view) {
        const json stream = view["extensions"][kMeshopt];
        const std::size_t buffer = whole_number<std::size_t>(stream.at("buffer"));
        const std::size_t offset = whole_number(stream, "byteOffset", std::size_t{0});
        const std::size_t length = whole_number<std::size_t>(stream.at("byteLength"));
        const std::size_t stride = whole_number<std::size_t>(stream.at("byteStride"));
        const std::size_t count = whole_number<std::size_t>(stream.at("count"));
        if (buffer >= starts_.size() || offset > sizes_[buffer] || length > sizes_[buffer] - offset || stride == 0 ||
            stride > 256 || count > (kMostGrowth * length) / stride)
            throw Error(name_, "a compressed buffer view announces more than its bytes can say");
        const Bytes source(joined_.begin() + static_cast<std::ptrdiff_t>(starts_[buffer] + offset),
                           joined_.begin() + static_cast<std::ptrdiff_t>(starts_[buffer] + offset + length));
        Bytes out(count * stride);
        if (!decode(stream, source, count, stride, out)) throw Error(name_, "a compressed buffer view is damaged");
        view["buffer"] = 0;
        view["byteOffset"] = append(out);
        view["byteLength"] = out.size();
        erase_extension(view, kMeshopt);
    }

    static bool decode(const json& stream, const Bytes& source, std::size_t count, std::size_t stride, Bytes& out) {
        const std::string mode = stream.at("mode").get<std::string>(), filter = stream.value("filter", "NONE");
        if (count == 0) return true;
        if (mode == "ATTRIBUTES") {
            if (stride % 4 != 0 ||
                meshopt_decodeVertexBuffer(out.data(), count, stride, source.data(), source.size()) != 0)
                return false;
            if (filter == "NONE") return true;
            if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
                return meshopt_decodeFilterOct(out.data(), count, stride), true;
            if (filter == "QUATERNION" && stride == 8) return meshopt_decodeFilterQuat(out.data(), count, stride), true;
            return filter == "EXPONENTIAL" && (meshopt_decodeFilterExp(out.data(), count, stride), true);
        }
        if ((stride != 2 && stride != 4) || filter != "NONE") return false;
        if (mode == "TRIANGLES")
            return count % 3 == 0 &&
                   meshopt_decodeIndexBuffer(out.data(), count, stride, source.data(), source.size()) == 0;
        return mode == "INDICES" &&
               meshopt_decodeIndexSequence(out.data(), count, stride, source.data(), source.size()) == 0;
    }

    int add_accessor(json accessor, std::span<const unsigned char> rows, std::size_t count, int component_type) {
        json& views = array("bufferViews");
        views.push_back({{"buffer", 0}, {"byteOffset", append(rows)}, {"byteLength", rows.size()}});
        accessor["bufferView"] = views.size() - 1;
        accessor["byteOffset"] = 0;
        accessor["count"] = count;
        accessor["componentType"] = component_type;
        json& accessors = array("accessors");
        accessors.push_back(std::move(accessor));
        return static_cast<int>(accessors.size()) - 1;
    }

    json accessor_at(const json& index) {
        const std::size_t i = whole_number<std::size_t>(index);
        if (i >= array("accessors").size()) throw Error(name_, Message("accessor {} does not exist", i));
        return document_["accessors"][i];
    }

    void decode_primitive(json& primitive) {
        constexpr std::array<std::string_view, 4> kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
        const json stream = primitive["extensions"][kDraco];
        const std::size_t index = whole_number<std::size_t>(stream.at("bufferView"));
        if (index >= array("bufferViews").size()) throw Error(name_, "a Draco mesh has no buffer view");
        const json& view = document_["bufferViews"][index];
        const std::size_t start = whole_number(view, "byteOffset", std::size_t{0});
        const std::size_t length = whole_number(view, "byteLength", std::size_t{0});
        if (start > joined_.size() || length > joined_.size() - start)
            throw Error(name_, "a buffer view lies outside its buffer");
        const std::unique_ptr<DracoMesh> mesh =
            decode_draco(std::span<const unsigned char>(joined_).subspan(start, length), name_);
        for (const auto& [attribute, id] : stream.at("attributes").items()) {
            json& named = primitive.at("attributes").at(attribute);
            const json accessor = accessor_at(named);
            const auto type = std::find(kTypes.begin(), kTypes.end(), accessor.at("type").get<std::string>());
            const int component = whole_number<int>(accessor.at("componentType"));
            const int n = type == kTypes.end() ? 0 : static_cast<int>(type - kTypes.begin()) + 1;
            Bytes rows;
            if (!mesh->rows(whole_number<unsigned>(id), component, n, rows))
                throw Error(name_, "a Draco mesh lacks an attribute that its primitive names");
            named = add_accessor(accessor, rows, mesh->n_points(), component);
        }
        std::vector<std::uint32_t> indices;
        if (!mesh->indices(indices)) throw Error(name_, "a Draco mesh is damaged");
        const auto* first = reinterpret_cast<const unsigned char*>(indices.data());
        primitive["indices"] = add_accessor({{"type", "SCALAR"}}, {first, 4 * indices.size()}, indices.size(), 5125);
        primitive["mode"] = 4;  // triangles, whatever it was before
        erase_extension(primitive, kDraco);
    }

    std::vector<char> glb() {
        joined_.resize(aligned(joined_.size()));
        array("buffers")[0]["byteLength"] = joined_.size();
        for (const char* list : {"buffers", "bufferViews", "accessors", "meshes"})
            if (document_.contains(list) && document_[list].empty()) document_.erase(list);
        std::string text = document_.dump(-1, ' ', false, json::error_handler_t::replace);
        text.resize(aligned(text.size()), ' ');
        const std::size_t size = 28 + text.size() + joined_.size();
        if (size > std::numeric_limits<std::uint32_t>::max()) throw Error(name_, "is larger than 4 GiB");
        std::vector<char> out;
        out.reserve(size);
        const auto put = [&](const void* from, std::size_t n) {
            out.insert(out.end(), static_cast<const char*>(from), static_cast<const char*>(from) + n);
        };
        const auto number = [&](std::size_t value) {
            const auto v = static_cast<std::uint32_t>(value);
            put(&v, sizeof v);
        };
        put("glTF", 4), number(2), number(size);
        number(text.size()), put("JSON", 4), put(text.data(), text.size());
        number(joined_.size()), put("BIN\0", 4), put(joined_.data(), joined_.size());
        return out;
    }

    json document_;
    const Container& container_;
    const fs::path& path_;
    std::string name_;
    std::size_t most_ = kLeastMost;            ///< bytes of the joined buffer
    std::vector<std::size_t> starts_, sizes_;  ///< of the file's buffers in the joined one
    Bytes joined_;
};

bool is_used(const json& document) {
    if (!document.is_object()) return false;
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        if (document.contains(list) && document[list].is_array())
            for (const json& name : document[list])
                if (name == kDraco || name == kMeshopt) return true;
    return false;
}

}  // namespace

std::optional<std::vector<char>> decompress_gltf(const std::vector<char>& bytes, const fs::path& path) {
    const Container container = container_of(bytes);
    if (container.text.find(kDraco) == container.text.npos && container.text.find(kMeshopt) == container.text.npos)
        return std::nullopt;
    try {
        json document = json::parse(container.text.begin(), container.text.end(), nullptr, false);
        if (!is_used(document)) return std::nullopt;
        return Decompressor(std::move(document), container, path).run();
    } catch (const json::exception&) {
        throw Error(path.string(), "its JSON is not that of a glTF file");
    } catch (const std::bad_alloc&) {
        throw Error(path.string(), "asks for more memory than there is");
    }
}

}  // namespace tuft::io
