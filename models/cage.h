#pragma once

#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "shape.h"

/// Control cages: coarse polygons with creases, made smooth by subdivision.
namespace tuft::models {

struct Cage {
    std::vector<Vec3> points;                       ///< millimetres
    std::vector<std::vector<std::uint32_t>> faces;  ///< counter-clockwise from outside
    /// Sharpness of edges (smaller index first): 0 smooth, s stays sharp for s levels.
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> sharpness;

    std::uint32_t add_point(const Vec3& p);
    std::uint32_t add_face(std::vector<std::uint32_t> corners);
    void crease(std::uint32_t a, std::uint32_t b, double sharp);
};

/// One loop of a carving: the border of the region is copied, moved `inset` into
/// the region along the surface and `depth` below it, and joined by a band of quads.
/// Both are measured from the untouched border; a negative depth stands out.
struct CarveLoop {
    double inset = 0;  ///< mm
    double depth = 0;  ///< mm
    double sharp = 2;  ///< crease along the loop
};

struct CarveBorder {
    double sharp = 2;         ///< crease along the border that stays
    double corner_sharp = 0;  ///< where the border turns sharply: crease across the bands
};

/// Carves the discs formed by `faces` with one loop after another; the rest of the
/// region follows the depth of the last loop. The faces keep their numbers.
void carve(Cage& cage, std::span<const std::uint32_t> faces, const CarveBorder& border,
           std::span<const CarveLoop> loops);

/// Catmull–Clark subdivision with semi-sharp creases, `levels` times (Catmull and
/// Clark 1978; creases: DeRose, Kass and Truong 1998). The polygon mesh must be an
/// orientable manifold; borders become creases. The result has quads only.
Cage subdivide(const Cage& cage, int levels);

/// A box of n × n × n cells' surface, its points placed by `place` from (-1…1)³. The
/// faces of the side at -1 on the first axis come first.
Cage make_block(std::array<int, 3> n, const std::function<Vec3(const Vec3& unit)>& place);

/// The cage's polygons as triangles, quads cut along the shorter diagonal.
Shape triangulate(const Cage& cage);

/// Adds `part` to `shape` as a component of its own.
void append(Shape& shape, const Shape& part);

/// The mirror image in the plane y = 0.
Shape mirrored(const Shape& shape);

}  // namespace tuft::models
