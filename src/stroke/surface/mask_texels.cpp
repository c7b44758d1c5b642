#include "stroke/surface/mask_texels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "atlas/pack/raster.h"
#include "core/error.h"
#include "core/geometry/segment.h"
#include "core/system/parallel.h"
#include "stroke/surface/sharp_edges.h"

/// Masks on texels.
namespace tuft::stroke {
namespace {

using Coverage = std::array<std::uint8_t, atlas::kTileTexels>;

/// Calls coverage(slot, texel) ∈ [0, 1] for every texel of the charts. Texels outside count as
/// their tile's others do, so that a tile that is covered all takes no room.
template <class Fn>
MaskTexels by_texel(const Model& model, Fn&& coverage) {
    const atlas::TexelMap& map = model.texels;
    std::vector<Coverage> tiles(map.n_slots());
    parallel_for(tiles.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slot = begin; slot < end; ++slot) {
            std::uint8_t lowest = 255;
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                if (map.tiles[slot].cluster[t] == atlas::kNoCluster) continue;
                const double c =
                    std::clamp(static_cast<double>(coverage(static_cast<std::uint32_t>(slot), t)), 0.0, 1.0);
                tiles[slot][t] = static_cast<std::uint8_t>(std::lround(255 * c));
                lowest = std::min(lowest, tiles[slot][t]);
            }
            const std::uint8_t outside = lowest == 255 ? 255 : 0;
            for (int t = 0; t < atlas::kTileTexels; ++t)
                if (map.tiles[slot].cluster[t] == atlas::kNoCluster) tiles[slot][t] = outside;
        }
    });
    MaskTexels out(map.n_slots());
    for (std::uint32_t slot = 0; slot < tiles.size(); ++slot) out.set(slot, tiles[slot]);
    return out;
}

/// For each texel 1 in a triangle that is chosen, 2 in another, 0 in none, [n_slots][256]: the
/// texel map takes corners on a coarser grid and may have centres along a rim that lie in none.
std::vector<Coverage> texels_of(const std::vector<std::uint8_t>& chosen, const Model& model) {
    const atlas::TexelMap& map = model.texels;
    std::vector<Coverage> in(map.n_slots(), Coverage{});
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const std::uint8_t value = chosen[i] ? 1 : 2;
        const Vec2f* uv = &model.atlas.corner_uvs[3 * i];
        atlas::raster_rows({uv[0], uv[1], uv[2]}, map.size,
                           [&](std::uint32_t y, std::uint32_t first, std::uint32_t last) {
                               for (std::uint32_t x = first; x <= last; ++x) {
                                   const atlas::TexelRef texel = atlas::texel_ref(map, x, y);
                                   if (texel.valid()) in[texel.slot][texel.texel] = value;
                               }
                           });
    }
    return in;
}

MaskTexels by_group(const Mask& mask, const Model& model) {
    const mesh::TriangleMesh& mesh = *model.mesh;
    std::map<std::string_view, std::size_t> group_of;  // the first of a name
    for (std::size_t i = 0; i < mesh.group_names.size(); ++i) group_of.try_emplace(mesh.group_names[i], i);
    std::vector<std::uint8_t> wanted(mesh.group_names.size(), 0);
    for (const std::string& name : mask.groups)
        if (const auto at = group_of.find(name); at != group_of.end()) wanted[at->second] = 1;
    std::vector<std::uint8_t> chosen(mesh.n_triangles(), 0);
    for (std::size_t i = 0; i < mesh.triangle_groups.size(); ++i) chosen[i] = wanted[mesh.triangle_groups[i]];
    const std::vector<Coverage> in = texels_of(chosen, model);
    return by_texel(model, [&](std::uint32_t slot, int t) {
        const std::uint8_t value = in[slot][static_cast<std::size_t>(t)];
        if (value != 0) return value == 1;
        const auto at = model.query->closest_point(Vec3(model.texels.position(slot, t)));
        return at && chosen[at->triangle];
    });
}

MaskTexels by_angle(const Mask& mask, const Model& model) {
    const Vec3 direction = glm::normalize(mask.direction);
    return by_texel(model, [&](std::uint32_t slot, int t) {
        const Vec3 n(model.texels.normal(slot, t));
        // atan2 keeps its accuracy where the angle is small.
        const double angle = std::atan2(glm::length(glm::cross(n, direction)), glm::dot(n, direction));
        if (mask.soft <= 0) return angle <= mask.within ? 1.0 : 0.0;
        return (mask.within + mask.soft - angle) / (2 * mask.soft);
    });
}

MaskTexels by_chart(const Mask& mask, const Model& model) {
    std::vector<std::uint8_t> wanted(model.atlas.n_charts, 0);
    for (const Vec3& p : mask.points) {
        const auto at = model.query->closest_point(p);
        if (!at) throw Error("there is no surface to mask");
        wanted[model.atlas.triangle_chart[at->triangle]] = 1;
    }
    const atlas::TexelMap& map = model.texels;
    return by_texel(model, [&](std::uint32_t slot, int t) {
        return wanted[map.cluster_chart[map.cluster_start[slot] + map.tiles[slot].cluster[t]]];
    });
}

/// Distance of a point to the polygon's rim, positive inside (even-odd).
double inside_by(const std::vector<Vec2>& polygon, const Vec2& p) {
    double nearest2 = HUGE_VAL;
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2 &a = polygon[j], &b = polygon[i], off = (p - a) - nearest_part(a, b, p) * (b - a);
        nearest2 = std::min(nearest2, glm::dot(off, off));
        if (crosses_ray(a, b, p)) inside = !inside;
    }
    return inside ? std::sqrt(nearest2) : -std::sqrt(nearest2);
}

MaskTexels by_lasso(const Mask& mask, const Model& model) {
    const LassoView& view = mask.view;
    const Vec3 forward = glm::cross(view.up, view.right);
    const double texel = model.texels.texel_size, far = 4 * model.mesh->bounds.diagonal();
    Vec2 low = mask.polygon[0], high = low;
    for (const Vec2& p : mask.polygon) low = glm::min(low, p), high = glm::max(high, p);
    return by_texel(model, [&](std::uint32_t slot, int t) {
        const Vec3 p(model.texels.position(slot, t)), n(model.texels.normal(slot, t)), d = p - view.origin;
        const double depth = glm::dot(d, forward), scale = view.perspective ? depth : 1.0;
        if (view.perspective && !(depth > 0)) return 0.0;
        const Vec2 seen = Vec2(glm::dot(d, view.right), glm::dot(d, view.up)) / scale;
        const double margin = texel / scale;
        if (seen.x < low.x - margin || seen.y < low.y - margin || seen.x > high.x + margin || seen.y > high.y + margin)
            return 0.0;
        const double c = 0.5 + inside_by(mask.polygon, seen) * scale / texel;
        if (c <= 0 || view.through) return c;
        const Vec3 to_eye = view.perspective ? glm::normalize(-d) : -forward;
        if (glm::dot(n, to_eye) <= 0) return 0.0;
        // From two texels above: not from the facet itself, nor from a neighbour of a curved surface.
        const Vec3 from = p + 2 * texel * n;
        const double limit = view.perspective ? glm::length(view.origin - from) : far;
        return model.query->occluded(from, to_eye, 0, limit) ? 0.0 : c;
    });
}

/// Sharp edges and borders of a mesh, by cubes of space.
class SharpEdges {
  public:
    /// `reach`: largest distance asked for, metres.
    SharpEdges(const mesh::TriangleMesh& mesh, double angle, double reach) : cube_(reach) {
        for (const auto& [from, to] : sharp_edges(mesh, angle))
            add(Vec3(mesh.positions[from]), Vec3(mesh.positions[to]));
    }

    /// Distance of a point to the nearest edge, at most `reach`.
    double distance(const Vec3& p) const {
        double nearest2 = cube_ * cube_;
        const Cube c = cube_of(p);
        for (int z = -1; z <= 1; ++z)
            for (int y = -1; y <= 1; ++y)
                for (int x = -1; x <= 1; ++x) {
                    const auto at = cubes_.find({c[0] + x, c[1] + y, c[2] + z});
                    if (at == cubes_.end()) continue;
                    for (const std::uint32_t e : at->second) {
                        const auto& [a, b] = edges_[e];
                        const Vec3 d = b - a;
                        const double t = std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0);
                        const Vec3 off = p - a - t * d;
                        nearest2 = std::min(nearest2, glm::dot(off, off));
                    }
                }
        return std::sqrt(nearest2);
    }

  private:
    using Cube = std::array<std::int64_t, 3>;

    Cube cube_of(const Vec3& p) const {
        Cube c;
        for (int k = 0; k < 3; ++k)
            c[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(std::floor(p[k] / cube_));
        return c;
    }
    // Its points are in no cube more than half a side from those entered here.
    void add(const Vec3& a, const Vec3& b) {
        constexpr double kMostCubes = 100'000;
        const auto e = static_cast<std::uint32_t>(edges_.size());
        edges_.emplace_back(a, b);
        const auto n = static_cast<int>(std::min(kMostCubes, std::ceil(2 * glm::distance(a, b) / cube_)));
        for (int i = 0; i <= n; ++i) {
            std::vector<std::uint32_t>& in = cubes_[cube_of(n > 0 ? glm::mix(a, b, double(i) / n) : a)];
            if (in.empty() || in.back() != e) in.push_back(e);
        }
    }

    double cube_;
    std::vector<std::pair<Vec3, Vec3>> edges_;
    std::map<Cube, std::vector<std::uint32_t>> cubes_;
};

MaskTexels by_clear(const Mask& mask, const Model& model) {
    const double texel = model.texels.texel_size;
    // Half a cube more than is asked for: an edge may lie that far from the cubes that it is entered in.
    const SharpEdges edges(*model.mesh, mask.within, 1.5 * (mask.distance + texel));
    return by_texel(model, [&](std::uint32_t slot, int t) {
        return 0.5 + (edges.distance(Vec3(model.texels.position(slot, t))) - mask.distance) / texel;
    });
}

using Parts = std::map<std::uint32_t, MaskTexels>;

MaskTexels of_masks(const Mask& mask, const Parts& done, const Model& model) {
    std::vector<const MaskTexels*> parts;
    for (const std::uint32_t id : mask.of) parts.push_back(&done.at(id));
    return by_texel(model, [&](std::uint32_t slot, int t) {
        int c = parts[0]->coverage(slot, t);
        for (std::size_t i = 1; i < parts.size(); ++i) {
            const int other = parts[i]->coverage(slot, t);
            c = mask.kind == MaskKind::intersect ? std::min(c, other) : std::max(c, other);
        }
        return (mask.kind == MaskKind::invert ? 255 - c : c) / 255.0;
    });
}

MaskTexels evaluate_one(const Mask& mask, const Parts& done, const Model& model) {
    switch (mask.kind) {
        case MaskKind::group:
            return by_group(mask, model);
        case MaskKind::angle:
            return by_angle(mask, model);
        case MaskKind::chart:
            return by_chart(mask, model);
        case MaskKind::lasso:
            return by_lasso(mask, model);
        case MaskKind::clear:
            return by_clear(mask, model);
        case MaskKind::invert:
        case MaskKind::intersect:
        case MaskKind::unite:
            break;
    }
    return of_masks(mask, done, model);
}

}  // namespace

void check_groups(const Mask& mask, const mesh::TriangleMesh& mesh) {
    if (mask.kind != MaskKind::group) return;
    const std::set<std::string_view> names(mesh.group_names.begin(), mesh.group_names.end());
    for (const std::string& name : mask.groups) {
        if (names.contains(name) && !mesh.triangle_groups.empty()) continue;
        const std::string near = nearest_name(name, mesh.group_names);
        throw Error(Message("the mesh has no group '{}'{}", name, did_you_mean(near)));
    }
}

MaskTexels evaluate(const Mask& mask, const MaskTable& table, const Model& model) {
    // Each part once, however often it is named; a mask is made of earlier ones only.
    std::set<std::uint32_t> needed;
    std::vector<std::uint32_t> open = mask.of;
    while (!open.empty()) {
        const std::uint32_t id = open.back();
        open.pop_back();
        if (!needed.insert(id).second) continue;
        const Mask* part = table.find(id);
        if (!part) throw Error(Message("there is no mask {}", id));
        open.insert(open.end(), part->of.begin(), part->of.end());
    }
    Parts done;
    for (const std::uint32_t id : needed) done.emplace(id, evaluate_one(*table.find(id), done, model));
    return evaluate_one(mask, done, model);
}

void MaskTexels::set(std::uint32_t slot, const std::array<std::uint8_t, atlas::kTileTexels>& coverage) {
    const auto is = [&](std::uint8_t value) {
        return std::all_of(coverage.begin(), coverage.end(), [value](std::uint8_t c) { return c == value; });
    };
    if (is(0)) {
        place_[slot] = kNone_;
    } else if (is(255)) {
        place_[slot] = kAll_;
    } else {
        place_[slot] = static_cast<std::uint32_t>(parts_.size());
        parts_.push_back(coverage);
    }
}

std::uint8_t MaskTexels::coverage(std::uint32_t slot, int texel) const {
    if (place_[slot] == kNone_) return 0;
    return place_[slot] == kAll_ ? 255 : parts_[place_[slot]][static_cast<std::size_t>(texel)];
}

void MaskTexels::apply(std::uint32_t slot, std::span<float, atlas::kTileTexels> exposure) const {
    if (place_[slot] == kAll_) return;
    for (int t = 0; t < atlas::kTileTexels; ++t) exposure[t] *= static_cast<float>(coverage(slot, t)) * (1.0f / 255);
}

std::size_t MaskTexels::memory_bytes() const {
    return place_.capacity() * sizeof(place_[0]) + parts_.capacity() * sizeof(parts_[0]);
}

}  // namespace tuft::stroke
