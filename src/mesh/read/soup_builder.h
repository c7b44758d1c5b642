#pragma once

#include <array>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/message.h"
#include "mesh/read/polygon_soup.h"

/// \file
/// Builder of a polygon soup, shared by the readers of `mesh` and of `io`.
namespace tuft::mesh {

/// Reports a repeated event in one line: the first places and the total.
struct Tally {
    std::size_t count = 0;
    std::vector<long> places;  ///< the first five: lines or rows

    void add(long place) {
        if (places.size() < 5) places.push_back(place);
        ++count;
    }
    /// "N WHAT (line 3, 8, ...)" with `unit` = "line" or "row".
    Message text(const char* what, const char* unit) const;
};

/// Builds a `PolygonSoup` from what a reader finds. Drops what cannot be used and reports it.
class SoupBuilder {
  public:
    SoupBuilder(std::string file, const char* place_unit) : file_(std::move(file)), unit_(place_unit) {}

    PolygonSoup soup;

    /// Adds a point. `finish` drops points that are not finite or lie beyond `kFarthestNumber`, and the polygons
    /// that use them.
    void add_point(const Vec3& p, long place);
    /// Adds a polygon over valid point indices. Polygons of fewer than three corners are dropped. `uvs` is empty or
    /// has one entry per corner, and so has `normals`.
    void add_polygon(std::span<const std::uint32_t> corners, std::span<const Vec2f> uvs, std::uint32_t group,
                     long place, std::span<const Vec3f> normals = {});
    /// Returns the index of the group with this name (as UTF-8, see `to_utf8`), and adds the group when it is new.
    /// `material` is the material name of its faces, as the file spells it.
    std::uint32_t group(const std::string& name, const std::string& material = "");
    /// Returns the group of faces of this colour, named "#rrggbb". A file with one colour, or with more than 256,
    /// gets no colour groups. The faces get materials of these colours.
    std::uint32_t colour_group(const std::array<std::uint8_t, 4>& colour);
    /// Adds the warnings to `soup` and returns it. Throws `Error` when there is no polygon.
    PolygonSoup finish();

  private:
    void drop_bad_points();
    void finish_groups();

    std::string file_;
    const char* unit_;
    std::unordered_map<std::string, std::uint32_t> group_of_;
    std::vector<std::uint32_t> bad_points_;
    Tally bad_rows_, bad_uvs_, short_polygons_, no_uv_;
    bool groups_used_ = false;
    std::unordered_map<std::uint32_t, std::uint32_t> group_of_colour_;
    bool too_many_colours_ = false;
    std::vector<Vec3f> group_colours_;  ///< by group; white for groups without a colour
};

/// Returns a colour from four channels: bytes unchanged, reals scaled from [0, 1].
std::array<std::uint8_t, 4> colour_from(const std::array<double, 4>& channels, bool is_real);

}  // namespace tuft::mesh
