#include "render/picture/material.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace tuft::render {
namespace {

/// The four texels round a texture position, and their weights.
struct Taps {
    std::size_t index[4];
    float weight[4];
};

Taps taps_at(const Vec2f& uv, std::uint32_t size) {
    const float x = uv.x * static_cast<float>(size) - 0.5f, y = uv.y * static_cast<float>(size) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    const auto clamp = [&](float v) {
        return static_cast<std::size_t>(std::clamp(v, 0.0f, static_cast<float>(size - 1)));
    };
    const std::size_t x0 = clamp(fx), x1 = clamp(fx + 1), y0 = clamp(fy), y1 = clamp(fy + 1);
    const float wx = x - fx, wy = y - fy;
    return {{y0 * size + x0, y0 * size + x1, y1 * size + x0, y1 * size + x1},
            {(1 - wx) * (1 - wy), wx * (1 - wy), (1 - wx) * wy, wx * wy}};
}

void record(TileReads* reads, const Taps& taps, std::uint32_t size) {
    if (!reads) return;
    const std::size_t per_side = (size + kMapTile - 1) / kMapTile;
    for (const std::size_t i : taps.index)
        reads->add(static_cast<std::uint32_t>(i / size / kMapTile * per_side + i % size / kMapTile));
}

float into_unit(float v) {
    return v >= 0 && v <= 1 ? v : v - std::floor(v);
}

void check_map(std::size_t have, std::uint32_t size, const char* name) {
    if (have && have != std::size_t{size} * size)
        throw Error(Message("the {} map has {} texels instead of {} x {}", std::string(name), have, size, size));
}

}  // namespace

float encode_srgb(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

float decode_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

MaterialReader::MaterialReader(const mesh::TriangleMesh& mesh, const Appearance& appearance)
    : mesh_(mesh), appearance_(appearance) {
    const TextureMaps& maps = appearance.maps;
    check_map(maps.base_colour.size(), maps.size, "base colour");
    check_map(maps.base_colour_srgb.size(), maps.size, "base colour");
    check_map(maps.roughness.size(), maps.size, "roughness");
    check_map(maps.height.size(), maps.size, "height");
    if (maps.size && maps.corner_uvs.size() != 3 * mesh.n_triangles())
        throw Error(Message("the texture has {} corner coordinates for a mesh of {} triangles", maps.corner_uvs.size(),
                            mesh.n_triangles()));
    const bool porcelain = appearance.finish == Finish::porcelain;
    body_ = appearance.body_colour.value_or(porcelain ? Vec3f{0.86f, 0.857f, 0.845f} : Vec3f{0.37f, 0.275f, 0.21f});
    roughness_ = porcelain ? 0.02f : 0.6f;
    for (int i = 0; i < 256; ++i) srgb_[i] = decode_srgb(static_cast<float>(i) / 255);
}

Vec2f MaterialReader::uv(std::uint32_t triangle, float b1, float b2) const {
    const Vec2f* corner = &appearance_.maps.corner_uvs[3 * std::size_t{triangle}];
    const Vec2f at = (1 - b1 - b2) * corner[0] + b1 * corner[1] + b2 * corner[2];
    return {into_unit(at.x), into_unit(at.y)};
}

Vec3f MaterialReader::albedo(std::uint32_t triangle, float b1, float b2, TileReads* reads) const {
    const TextureMaps& maps = appearance_.maps;
    if (!maps.base_colour.empty()) {
        const Taps taps = taps_at(uv(triangle, b1, b2), maps.size);
        record(reads, taps, maps.size);
        Vec3f sum{0};
        for (int i = 0; i < 4; ++i) sum += taps.weight[i] * maps.base_colour[taps.index[i]];
        return glm::clamp(sum, 0.0f, 1.0f);
    }
    if (!maps.base_colour_srgb.empty()) {
        const Taps taps = taps_at(uv(triangle, b1, b2), maps.size);
        record(reads, taps, maps.size);
        Vec3f sum{0};
        for (int i = 0; i < 4; ++i) {
            const auto& c = maps.base_colour_srgb[taps.index[i]];
            const float alpha = static_cast<float>(c[3]) / 255;
            sum += taps.weight[i] * glm::mix(body_, Vec3f{srgb_[c[0]], srgb_[c[1]], srgb_[c[2]]}, alpha);
        }
        return sum;
    }
    if (appearance_.vertex_colours && !mesh_.vertex_colours.empty()) {
        const float weight[3] = {1 - b1 - b2, b1, b2};
        Vec3f sum{0};
        for (int k = 0; k < 3; ++k) {
            const auto& c = mesh_.vertex_colours[mesh_.triangles[triangle][k]];
            sum += weight[k] * Vec3f{srgb_[c[0]], srgb_[c[1]], srgb_[c[2]]};
        }
        return sum;
    }
    return body_;
}

float MaterialReader::height(const Vec2f& at) const {
    const TextureMaps& maps = appearance_.maps;
    const Taps taps = taps_at(glm::clamp(at, 0.0f, 1.0f), maps.size);
    float sum = 0;
    for (int i = 0; i < 4; ++i) sum += taps.weight[i] * maps.height[taps.index[i]];
    return sum;
}

float MaterialReader::unshaded(std::uint32_t triangle, float b1, float b2, const Vec3f& normal, const Vec3f& to_light,
                               float blur) const {
    constexpr float kReach = 3e-3f;  // metres
    const TextureMaps& maps = appearance_.maps;
    const float rise = glm::dot(normal, to_light);
    if (maps.height.empty() || !(rise > 0)) return 1;
    const Vec3f level = to_light - rise * normal;
    const float run = glm::length(level);
    if (!(run > 1e-3f)) return 1;
    // A metre along the surface towards the light, in texture coordinates.
    const Vec2f* corner = &maps.corner_uvs[3 * std::size_t{triangle}];
    const Vec3f d1(mesh_.position(triangle, 1) - mesh_.position(triangle, 0));
    const Vec3f d2(mesh_.position(triangle, 2) - mesh_.position(triangle, 0));
    const float g11 = glm::dot(d1, d1), g12 = glm::dot(d1, d2), g22 = glm::dot(d2, d2);
    const float det = g11 * g22 - g12 * g12;
    if (!(det > 0)) return 1;
    const float r1 = glm::dot(level, d1) / run, r2 = glm::dot(level, d2) / run;
    const Vec2f along =
        ((g22 * r1 - g12 * r2) * (corner[1] - corner[0]) + (g11 * r2 - g12 * r1) * (corner[2] - corner[0])) / det;
    const float texels = glm::length(along) * static_cast<float>(maps.size);  // per metre
    if (!(texels > 0) || !std::isfinite(texels)) return 1;
    const Vec2f at = uv(triangle, b1, b2);
    const float here = height(at), slope = rise / run;
    float open = 1;
    for (float d = 0.75f / texels; d < kReach; d += std::max(0.5f / texels, 0.04f * d)) {
        const float over = height(at + d * along) - here;
        open = std::min(open, 0.5f + (slope - over / d) / (2 * blur));
        if (!(open > 0)) return 0;
    }
    return open;
}

Vec3f MaterialReader::relief(std::uint32_t triangle, const Vec2f& at) const {
    // Height gradient by central differences of one texel, carried to the surface by the
    // triangle's UV map: ∇h solves d1·∇h = ∂h/∂(uv)·e1, d2·∇h = ∂h/∂(uv)·e2 in its plane.
    const TextureMaps& maps = appearance_.maps;
    const float step = 1 / static_cast<float>(maps.size);
    const float hu = (height({at.x + step, at.y}) - height({at.x - step, at.y})) / (2 * step);
    const float hv = (height({at.x, at.y + step}) - height({at.x, at.y - step})) / (2 * step);
    if (hu == 0 && hv == 0) return Vec3f{0};
    const Vec2f* corner = &maps.corner_uvs[3 * std::size_t{triangle}];
    const Vec2f e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    const Vec3f d1(mesh_.position(triangle, 1) - mesh_.position(triangle, 0));
    const Vec3f d2(mesh_.position(triangle, 2) - mesh_.position(triangle, 0));
    const float g11 = glm::dot(d1, d1), g12 = glm::dot(d1, d2), g22 = glm::dot(d2, d2);
    const float det = g11 * g22 - g12 * g12;
    if (!(det > 0)) return Vec3f{0};
    const float r1 = hu * e1.x + hv * e1.y, r2 = hu * e2.x + hv * e2.y;
    Vec3f slope = ((g22 * r1 - g12 * r2) * d1 + (g11 * r2 - g12 * r1) * d2) / det;
    const float steepness = glm::length(slope);
    if (!std::isfinite(steepness)) return Vec3f{0};
    return steepness > 1 ? slope / steepness : slope;  // texel steps beyond 45° are not real slopes
}

Material MaterialReader::read(std::uint32_t triangle, float b1, float b2, TileReads* reads) const {
    const TextureMaps& maps = appearance_.maps;
    Material m;
    m.albedo = albedo(triangle, b1, b2, reads);
    m.roughness = roughness_;
    if (!maps.roughness.empty() || !maps.height.empty()) {
        const Vec2f at = uv(triangle, b1, b2);
        if (!maps.roughness.empty()) {
            const Taps taps = taps_at(at, maps.size);
            m.roughness = 0;
            for (int i = 0; i < 4; ++i) m.roughness += taps.weight[i] * maps.roughness[taps.index[i]];
            m.roughness = std::clamp(m.roughness, 0.0f, 1.0f);
        }
        if (!maps.height.empty()) m.slope = relief(triangle, at);
    }
    return m;
}

}  // namespace tuft::render
