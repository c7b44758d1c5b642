#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/types.h"

namespace tuft::test {

/// The bytes of a GLB file with one buffer; both chunks are padded to words.
inline std::vector<char> glb_of(const nlohmann::json& document, std::span<const char> buffer) {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::vector<char> binary(buffer.begin(), buffer.end()), bytes;
    binary.resize((binary.size() + 3) / 4 * 4);
    const auto put = [&](const void* data, std::size_t size) {
        const auto* from = static_cast<const char*>(data);
        bytes.insert(bytes.end(), from, from + size);
    };
    const auto number = [&](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        put(&v, 4);
    };
    put("glTF", 4), number(2), number(28 + text.size() + binary.size());
    number(text.size()), put("JSON", 4), put(text.data(), text.size());
    number(binary.size()), put("BIN\0", 4), put(binary.data(), binary.size());
    return bytes;
}

/// A glTF file that is put together in memory.
class GltfMaker {
  public:
    nlohmann::json document{{"asset", {{"version", "2.0"}}}, {"scene", 0}};

    int add_view(const void* data, std::size_t size) {
        buffer_.resize((buffer_.size() + 3) / 4 * 4);
        document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", size}});
        const auto* from = static_cast<const char*>(data);
        buffer_.insert(buffer_.end(), from, from + size);
        return static_cast<int>(document["bufferViews"].size()) - 1;
    }
    template <class T>
    int add_accessor(const std::vector<T>& values, int component, const char* type,
                     nlohmann::json more = nlohmann::json::object()) {
        more["bufferView"] = add_view(values.data(), values.size() * sizeof(T));
        more["componentType"] = component;
        more["count"] = values.size();
        more["type"] = type;
        document["accessors"].push_back(std::move(more));
        return static_cast<int>(document["accessors"].size()) - 1;
    }
    /// A box from -1/2 to 1/2, scaled and moved: 24 vertices, 12 triangles, two sets of UVs.
    nlohmann::json box(const Vec3f& at, const Vec3f& size, int material) {
        std::vector<Vec3f> points;
        std::vector<Vec2f> first, second;
        std::vector<std::uint16_t> indices;
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-0.5f, 0.5f}) {
                const auto base = static_cast<std::uint16_t>(points.size());
                for (const Vec2f& c :
                     {Vec2f(-0.5f, -0.5f), Vec2f(0.5f, -0.5f), Vec2f(0.5f, 0.5f), Vec2f(-0.5f, 0.5f)}) {
                    Vec3f p;
                    p[axis] = side;
                    p[(axis + 1) % 3] = side > 0 ? c.x : -c.x;
                    p[(axis + 2) % 3] = c.y;
                    points.push_back(at + size * p);
                    first.push_back((c + 0.5f + Vec2f(float(axis), side > 0 ? 1.0f : 0.0f)) / 3.0f);
                    second.push_back(4.0f * c);
                }
                for (const int i : {0, 1, 2, 0, 2, 3}) indices.push_back(static_cast<std::uint16_t>(base + i));
            }
        const Vec3f lo = at - 0.5f * size, hi = at + 0.5f * size;
        nlohmann::json attributes{
            {"POSITION",
             add_accessor(points, 5126, "VEC3", {{"min", {lo.x, lo.y, lo.z}}, {"max", {hi.x, hi.y, hi.z}}})},
            {"TEXCOORD_0", add_accessor(first, 5126, "VEC2")},
            {"TEXCOORD_1", add_accessor(second, 5126, "VEC2")}};
        nlohmann::json primitive{{"attributes", std::move(attributes)},
                                 {"indices", add_accessor(indices, 5123, "SCALAR")}};
        if (material >= 0) primitive["material"] = material;
        return primitive;
    }
    std::vector<char> glb() {
        document["buffers"] = nlohmann::json::array({{{"byteLength", buffer_.size()}}});
        return glb_of(document, buffer_);
    }

  private:
    std::vector<char> buffer_;
};

}  // namespace tuft::test
