#include "ink/colour/base_colour.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/system/parallel.h"
#include "ink/spectra/srgb.h"

namespace tuft::ink {
namespace {

struct Level {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;

    Vec3f at(int x, int y) const {
        const std::uint8_t* p =
            &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
        const std::array<float, 256>& linear = linear_of_code();
        return {linear[p[0]], linear[p[1]], linear[p[2]]};
    }
};

/// Means of 2 × 2 pixels; the last column or row of an odd side counts twice.
Level half_of(const Level& from) {
    Level to{.width = (from.width + 1) / 2, .height = (from.height + 1) / 2, .rgb = {}};
    to.rgb.resize(3 * static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
    parallel_for(static_cast<std::size_t>(to.height), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (int x = 0; x < to.width; ++x) {
                const int x0 = 2 * x, x1 = std::min(x0 + 1, from.width - 1);
                const int y0 = 2 * static_cast<int>(row), y1 = std::min(y0 + 1, from.height - 1);
                const Vec3f mean = 0.25f * (from.at(x0, y0) + from.at(x1, y0) + from.at(x0, y1) + from.at(x1, y1));
                std::uint8_t* p = &to.rgb[3 * (row * static_cast<std::size_t>(to.width) + static_cast<std::size_t>(x))];
                for (int c = 0; c < 3; ++c) p[c] = code_of_linear(mean[c]);
            }
    });
    return to;
}

int wrapped(std::int64_t i, int n, bool round) {
    if (!round) return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
    const std::int64_t m = i % n;
    return static_cast<int>(m < 0 ? m + n : m);
}

/// A picture with its mip-map.
class MipMap {
  public:
    explicit MipMap(const mesh::Picture& picture) {
        levels_.push_back({picture.width, picture.height, picture.rgb});
        while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(half_of(levels_.back()));
    }

    /// Linear colour at UV, v up; `round`: over the ends to the opposite ones.
    Vec3f at(const Vec2& uv, double pixels_per_texel, bool round) const {
        const double log = pixels_per_texel > 1 ? std::log2(pixels_per_texel) : 0;
        const std::size_t level = std::min(static_cast<std::size_t>(log + 0.5), levels_.size() - 1);
        const Level& l = levels_[level];
        const double x = uv.x * l.width - 0.5, y = (1 - uv.y) * l.height - 0.5;
        const auto x0 = static_cast<std::int64_t>(std::floor(x)), y0 = static_cast<std::int64_t>(std::floor(y));
        const auto fx = static_cast<float>(x - static_cast<double>(x0)),
                   fy = static_cast<float>(y - static_cast<double>(y0));
        const int xa = wrapped(x0, l.width, round), xb = wrapped(x0 + 1, l.width, round);
        const int ya = wrapped(y0, l.height, round), yb = wrapped(y0 + 1, l.height, round);
        return (1 - fy) * ((1 - fx) * l.at(xa, ya) + fx * l.at(xb, ya)) +
               fy * ((1 - fx) * l.at(xa, yb) + fx * l.at(xb, yb));
    }

    /// Pixels of the picture under one texel of the atlas (the mean of both directions).
    double pixels_per_texel(double uv_per_atlas_area, std::uint32_t size) const {
        return std::sqrt(uv_per_atlas_area * levels_[0].width * levels_[0].height) / size;
    }

  private:
    std::vector<Level> levels_;
};

double twice_area(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    const Vec2 u = Vec2(b) - Vec2(a), v = Vec2(c) - Vec2(a);
    return std::abs(u.x * v.y - u.y * v.x);
}

class Colours {
  public:
    Colours(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas) : mesh_(mesh), atlas_(atlas) {
        if (mesh.corner_uvs.empty()) return;
        for (const mesh::Material& m : mesh.materials) {
            if (m.picture) pictures_.try_emplace(m.picture.get(), *m.picture);
            for (const mesh::PictureTile& tile : m.tiles) pictures_.try_emplace(tile.picture.get(), *tile.picture);
        }
    }

    Vec3f at(std::uint32_t triangle, const Vec3& weights) const {
        static const mesh::Material kWhite{};
        const mesh::Material& material =
            mesh_.materials.empty()
                ? kWhite
                : mesh_.materials[mesh_.triangle_groups.empty() ? 0 : mesh_.triangle_groups[triangle]];
        Vec3f colour;
        for (int c = 0; c < 3; ++c) colour[c] = srgb_decode(material.colour[c]);
        const auto picture = pictures_.find(picture_on(material, triangle));
        const bool pictured = picture != pictures_.end();
        if (pictured) colour *= picture_at(picture->second, triangle, weights, !material.tiles.empty());
        if (!mesh_.vertex_colours.empty() && (!pictured || material.tinted)) colour *= vertex_colour(triangle, weights);
        return colour;
    }

  private:
    /// The tile that the middle of the triangle lies on.
    const mesh::Picture* picture_on(const mesh::Material& material, std::uint32_t triangle) const {
        if (material.tiles.empty() || mesh_.corner_uvs.empty()) return material.picture.get();
        const std::uint32_t udim = mesh::udim_at(std::span(mesh_.corner_uvs).subspan(3 * std::size_t{triangle}, 3));
        const auto tile = std::ranges::lower_bound(material.tiles, udim, {}, &mesh::PictureTile::udim);
        return tile != material.tiles.end() && tile->udim == udim ? tile->picture.get() : nullptr;
    }

    Vec3f picture_at(const MipMap& map, std::uint32_t triangle, const Vec3& weights, bool tiled) const {
        const Vec2f* uv = &mesh_.corner_uvs[3 * std::size_t{triangle}];
        const Vec2f* on_page = &atlas_.corner_uvs[3 * std::size_t{triangle}];
        const Vec2 corner = tiled ? glm::floor((Vec2(uv[0]) + Vec2(uv[1]) + Vec2(uv[2])) / 3.0) : Vec2(0);
        Vec2 at(0);
        bool inside = true;
        for (int k = 0; k < 3; ++k) {
            const Vec2 p = Vec2(uv[k]) - corner;
            at += weights[k] * p;
            inside = inside && p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1;
        }
        // Beyond this no digit behind the point is left.
        if (!(std::abs(at.x) < 1e9 && std::abs(at.y) < 1e9)) return Vec3f(1);
        const double area = twice_area(on_page[0], on_page[1], on_page[2]);
        const double ratio = area > 0 ? twice_area(uv[0], uv[1], uv[2]) / area : 0;
        return map.at(at, map.pixels_per_texel(ratio, atlas_.size), !inside);
    }

    Vec3f vertex_colour(std::uint32_t triangle, const Vec3& weights) const {
        Vec3f sum(0);
        for (int k = 0; k < 3; ++k) {
            const std::array<std::uint8_t, 4>& c = mesh_.vertex_colours[mesh_.triangles[triangle][k]];
            const std::array<float, 256>& linear = linear_of_code();
            sum += static_cast<float>(weights[k]) * Vec3f(linear[c[0]], linear[c[1]], linear[c[2]]);
        }
        return sum;
    }

    const mesh::TriangleMesh& mesh_;
    const atlas::Atlas& atlas_;
    std::map<const mesh::Picture*, MipMap> pictures_;
};

}  // namespace

BaseColour base_colour_of(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas, const atlas::TexelMap& map) {
    BaseColour base_colour;
    if (!mesh::has_colours(mesh)) return base_colour;
    const Colours colours(mesh, atlas);
    base_colour.tiles.resize(map.n_slots());
    for (BaseColour::Tile& tile : base_colour.tiles)
        for (auto& channel : tile.rgb) channel.fill(255);
    atlas::visit_texels(mesh, atlas, map,
                        [&](std::uint32_t slot, int texel, std::uint32_t triangle, const Vec3& weights) {
                            const Vec3f colour = colours.at(triangle, weights);
                            for (int c = 0; c < 3; ++c)
                                base_colour.tiles[slot].rgb[c][texel] = code_of_linear(colour[c]);
                        });
    return base_colour;
}

}  // namespace tuft::ink
