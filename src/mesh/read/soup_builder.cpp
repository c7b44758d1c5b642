#include "mesh/read/soup_builder.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "core/text/text.h"

namespace tuft::mesh {
namespace {

constexpr std::size_t kMaxCorners = 0xfffffff0u;  // offsets are 32-bit

}  // namespace

Message Tally::text(const char* what, const char* unit) const {
    std::string list;
    for (const long place : places) list += (list.empty() ? "" : ", ") + std::to_string(place);
    if (count > places.size()) list += ", ...";
    return Message("{} {} ({} {})", count, what, unit, list);
}

void SoupBuilder::add_point(const Vec3& p, long place) {
    const bool fits = within(p, kFarthestNumber);
    if (!fits) {
        bad_points_.push_back(static_cast<std::uint32_t>(soup.points.size()));
        bad_rows_.add(place);
    }
    if (soup.points.size() >= kMaxCorners) throw Error(file_, place, "too many vertices");
    soup.points.push_back(fits ? p : Vec3(0));
}

void SoupBuilder::add_polygon(std::span<const std::uint32_t> corners, std::span<const Vec2f> uvs, std::uint32_t group,
                              long place, std::span<const Vec3f> normals) {
    if (corners.size() < 3) return short_polygons_.add(place);
    const std::size_t begin = soup.corners.size();
    if (begin + corners.size() > kMaxCorners) throw Error(file_, place, "too many faces");
    if (soup.polygon_start.empty()) soup.polygon_start.push_back(0);
    soup.corners.insert(soup.corners.end(), corners.begin(), corners.end());
    soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    if (!uvs.empty() && soup.corner_uvs.empty() && begin > 0) {
        soup.corner_uvs.resize(begin, Vec2f(0));
        no_uv_.count = soup.n_polygons() - 1;
    }
    if (!uvs.empty()) {
        bool bad = false;
        for (Vec2f uv : uvs) {
            if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) bad = true, uv = Vec2f(0);
            soup.corner_uvs.push_back(uv);
        }
        if (bad) bad_uvs_.add(place);
    } else if (!soup.corner_uvs.empty()) {
        soup.corner_uvs.resize(soup.corners.size(), Vec2f(0));
        no_uv_.add(place);
    }
    if (!normals.empty() || !soup.corner_normals.empty()) {
        soup.corner_normals.resize(begin, Vec3f(NAN));
        soup.corner_normals.insert(soup.corner_normals.end(), normals.begin(), normals.end());
        soup.corner_normals.resize(soup.corners.size(), Vec3f(NAN));
    }
    if (group != kNone) groups_used_ = true;
    soup.polygon_groups.push_back(group);
}

std::uint32_t SoupBuilder::group(const std::string& name, const std::string& material) {
    std::string readable = to_utf8(name);
    const auto [it, is_new] = group_of_.try_emplace(readable, static_cast<std::uint32_t>(soup.group_names.size()));
    if (is_new) {
        soup.group_names.push_back(std::move(readable));
        soup.material_names.push_back(material);
    }
    return it->second;
}

std::uint32_t SoupBuilder::colour_group(const std::array<std::uint8_t, 4>& c) {
    constexpr std::size_t kMostColours = 256;  // more are shades of a scan, not parts
    if (too_many_colours_) return kNone;
    const std::uint32_t key = std::uint32_t{c[0]} << 16 | std::uint32_t{c[1]} << 8 | c[2];
    const auto found = group_of_colour_.find(key);
    if (found != group_of_colour_.end()) return found->second;
    too_many_colours_ = group_of_colour_.size() == kMostColours;
    if (too_many_colours_) return kNone;
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string name = "#";
    for (int shift = 20; shift >= 0; shift -= 4) name += kDigits[key >> shift & 15];
    const std::uint32_t index = group_of_colour_[key] = group(name);
    group_colours_.resize(index + 1, Vec3f(1));
    group_colours_[index] = Vec3f(c[0], c[1], c[2]) / 255.0f;
    return index;
}

void SoupBuilder::drop_bad_points() {
    if (bad_points_.empty()) return;
    std::vector<std::uint32_t> new_index(soup.points.size());
    std::size_t kept = 0, next_bad = 0;
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        if (next_bad < bad_points_.size() && bad_points_[next_bad] == i) {
            new_index[i] = kNone;
            ++next_bad;
            continue;
        }
        new_index[i] = static_cast<std::uint32_t>(kept);
        soup.points[kept] = soup.points[i];
        if (!soup.point_colours.empty()) soup.point_colours[kept] = soup.point_colours[i];
        ++kept;
    }
    soup.points.resize(kept);
    if (!soup.point_colours.empty()) soup.point_colours.resize(kept);

    std::size_t out = 0, out_corner = 0, dropped = 0;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) {
        // The start of the next polygon is overwritten below, never before it is read.
        const std::size_t begin = soup.polygon_start[p], end = soup.polygon_start[p + 1];
        const bool good = std::none_of(soup.corners.begin() + static_cast<std::ptrdiff_t>(begin),
                                       soup.corners.begin() + static_cast<std::ptrdiff_t>(end),
                                       [&](std::uint32_t v) { return new_index[v] == kNone; });
        if (!good) {
            ++dropped;
            continue;
        }
        soup.polygon_groups[out] = soup.polygon_groups[p];
        soup.polygon_start[out++] = static_cast<std::uint32_t>(out_corner);
        for (std::size_t c = begin; c < end; ++c, ++out_corner) {
            soup.corners[out_corner] = new_index[soup.corners[c]];
            if (!soup.corner_uvs.empty()) soup.corner_uvs[out_corner] = soup.corner_uvs[c];
            if (!soup.corner_normals.empty()) soup.corner_normals[out_corner] = soup.corner_normals[c];
        }
    }
    if (!soup.polygon_start.empty()) {
        soup.polygon_start[out] = static_cast<std::uint32_t>(out_corner);
        soup.polygon_start.resize(out + 1);
    }
    soup.corners.resize(out_corner);
    soup.polygon_groups.resize(out);
    if (!soup.corner_uvs.empty()) soup.corner_uvs.resize(out_corner);
    if (!soup.corner_normals.empty()) soup.corner_normals.resize(out_corner);
    soup.warnings.push_back(
        Message("{}, and with them {} faces",
                bad_rows_.text("vertices are no finite numbers or lie beyond 1e10 and were dropped", unit_), dropped));
}

PolygonSoup SoupBuilder::finish() {
    const std::size_t n_points = soup.points.size();
    const bool had_polygons = soup.n_polygons() > 0;
    drop_bad_points();
    if (short_polygons_.count)
        soup.warnings.push_back(short_polygons_.text("faces have fewer than three corners and were dropped", unit_));
    if (bad_uvs_.count)
        soup.warnings.push_back(bad_uvs_.text("faces have texture coordinates that are not finite", unit_));
    if (no_uv_.count)
        soup.warnings.push_back(Message("{} faces have no texture coordinates while others do", no_uv_.count));
    if (soup.n_polygons() == 0) {
        if (had_polygons) throw Error(file_, "every face uses a vertex that is no finite number or lies beyond 1e10");
        if (n_points > 0) throw Error(file_, Message("has {} vertices but no faces; a surface is needed", n_points));
        throw Error(file_, "has no vertices and no faces");
    }
    finish_groups();
    return std::move(soup);
}

void SoupBuilder::finish_groups() {
    std::vector<std::uint32_t>& groups = soup.polygon_groups;
    if (too_many_colours_) soup.warnings.push_back("faces have more than 256 colours, too many to be groups of faces");
    const bool by_colour = !group_of_colour_.empty() && !too_many_colours_;
    const bool all_one = std::adjacent_find(groups.begin(), groups.end(), std::not_equal_to<>()) == groups.end();
    group_colours_.resize(soup.group_names.size(), Vec3f(1));
    if (!groups_used_ || too_many_colours_ || (by_colour && all_one)) {
        const bool coloured = by_colour && groups[0] != kNone;
        if (coloured) soup.materials = {{.colour = group_colours_[groups[0]]}};
        groups.clear();
        soup.group_names.clear();
        soup.material_names.clear();
        return;
    }
    for (std::uint32_t& g : groups)
        if (g == kNone) g = group("");
    group_colours_.resize(soup.group_names.size(), Vec3f(1));
    if (by_colour)
        for (const Vec3f& colour : group_colours_) soup.materials.push_back({.colour = colour});
    const bool named = std::any_of(soup.material_names.begin(), soup.material_names.end(),
                                   [](const std::string& name) { return !name.empty(); });
    if (!named) soup.material_names.clear();
}

std::array<std::uint8_t, 4> colour_from(const std::array<double, 4>& channels, bool is_real) {
    std::array<std::uint8_t, 4> colour{};
    for (int k = 0; k < 4; ++k) {
        const double value = is_real ? channels[k] * 255 : channels[k];
        colour[k] = std::isnan(value) ? 0 : static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
    return colour;
}

}  // namespace tuft::mesh
