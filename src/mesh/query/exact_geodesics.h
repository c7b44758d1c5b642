#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/sparse_numbering.h"
#include "mesh/triangle_mesh.h"

/// \file
/// Exact geodesics on a triangle mesh from one point, within a radius. Called by `footprint` where the surface is
/// occluded.
///
/// Windows of straight paths propagate from edge to edge in the order of their distance [Mitchell1987], with one angle,
/// one split [Chen1990]. Windows dominated by a vertex are dropped [Xin2009]; those of one source are merged
/// [Surazhsky2005]. Bent paths pass vertices whose angles exceed 2π, or border vertices.
///
/// CGAL's Surface_mesh_shortest_path is the truth in tests/footprint/geodesic_test.cpp: 1667 paths of at most 30 mm on
/// the shipped car and bowl differ by 2.5e-8 m at most. It takes 12 and 23 times as long (one run, by turns: 0.074 s to
/// 0.006 s, 1.18 s to 0.051 s for 20 origins each).
namespace tuft::mesh {

/// Geodesics from one point to all points within a radius.
class ExactGeodesics {
  public:
    /// Limits of a search.
    struct Limits {
        std::size_t windows = 1'000'000;  ///< most windows, > 0
        /// Metres, 0: none. Windows that meet on an edge are merged when their sources lie as near to each other. Each
        /// vertex of a surface that is flat or bends gently parts windows by less than that. Lengths differ by less
        /// than `merge`, directions by some of it over the length of the path.
        double merge = 0;
    };
    /// Computes the geodesics from `origin`, a point of `triangle`, to all points within `radius` metres. Returns
    /// false when more windows than the limit are needed, or are predicted to be; then no result is defined. Cost:
    /// about 0.2 µs per window. With `merge` these are some two per triangle, else as many more as triangles lie along
    /// a path.
    bool spread(const TriangleMesh& mesh, std::uint32_t triangle, const Vec3& origin, double radius,
                const Limits& limits);

    /// The shortest path from the origin to a point.
    struct Geodesic {
        double length = std::numeric_limits<double>::infinity();  ///< metres; infinite: none within the radius
        Vec3 start_direction{0};                                  ///< unit, in the plane of the origin's triangle
        Vec3 end_direction{0};  ///< unit, in the plane of the point's triangle, away from the origin
        bool bent = false;      ///< the path passes a vertex
    };
    /// Returns the geodesic to the point p of a triangle; p may lie outside it by rounding.
    Geodesic to(std::uint32_t triangle, const Vec3& p) const;

    std::size_t n_windows() const { return windows_.size(); }
    std::size_t n_faces() const { return faces_.size(); }
    /// Index in the mesh of the i-th triangle within the radius.
    std::uint32_t triangle(std::size_t i) const { return faces_[i].triangle; }

  private:
    static constexpr std::size_t kRings = 512;

    /// A triangle within the radius. Edge k goes from corner k to k + 1. In its frame corner k is the origin,
    /// corner k + 1 lies on x, and the triangle lies above.
    struct Face {
        std::uint32_t triangle;
        std::array<std::uint32_t, 3> vertex;
        std::array<double, 3> length;
        std::array<Vec2, 3> third;             ///< corner k + 2 in the frame of edge k
        std::array<std::uint32_t, 3> windows;  ///< first window entering over edge k; kNone: none
        /// Shortest path over edge k to the third corner: length, crossing point on the edge.
        std::array<double, 3> nearest, crossing;
    };
    /// A vertex within the radius.
    struct Vertex {
        double distance = std::numeric_limits<double>::infinity();
        Vec2 start_direction{0};  ///< unit, in the frame of edge 0 of the origin's triangle
    };
    /// Straight paths from `source` through the interval [from, to] of an edge into a face, in that edge's frame.
    struct Window {
        std::uint32_t face;
        std::uint8_t edge;
        bool settled;  ///< it has had its turn
        double from, to;
        Vec2 source;    ///< below the edge
        double before;  ///< metres from the origin to the source: 0, or the distance of a vertex
        Vec2 turn;      ///< rotates directions into the frame of edge 0 of the origin's triangle
        /// Vertex at the source, or kNone; next window of the face.
        std::uint32_t root, next;
    };
    /// A vertex that a path reaches in direction `onward` (frame of edge `corner`).
    struct Arrival {
        std::uint32_t face;
        int corner;
        double distance;
        Vec2 onward;
    };
    /// A queue entry: a window or an arrival, in a list of entries of about the same distance from the origin.
    struct QueueEntry {
        std::uint32_t index;
        bool vertex;
        std::uint32_t next;
    };
    /// Windows and arrivals by distance: rings of equal width, each a list.
    struct Queue {
        std::vector<QueueEntry> entries;
        std::array<std::uint32_t, kRings> rings;  ///< by distance: lists of `entries`
        std::size_t ring = 0;                     ///< being processed
    };
    /// Where the straight paths of a window start: the origin, or a vertex.
    struct Source {
        Vec2 at;  ///< in the frame of the edge crossed, above it
        double before;
        Vec2 turn;
        std::uint32_t root;
    };
    /// Corner of a face.
    struct Corner {
        std::uint32_t face;
        int corner;
    };

    /// Returns the window of the shortest path to q (frame of edge 0) through `face`, and its length; null where none
    /// is shorter than `length`. `corners`, `edges`: of the face, edges unit.
    const Window* shortest_window(const Face& face, const Vec2& q, const std::array<Vec2, 3>& corners,
                                  const std::array<Vec2, 3>& edges, double& length) const;
    void begin(const TriangleMesh& mesh, double radius, double merge);
    std::uint32_t face_of(std::uint32_t triangle);
    std::uint32_t vertex_of(std::uint32_t vertex);
    Corner over(std::uint32_t face, int edge);
    void enqueue(double distance, std::uint32_t index, bool vertex);
    bool is_dominated(const Face& face, int edge, double from, double to, const Source& source) const;
    void add_window(std::uint32_t face, int edge, double from, double to, const Source& source);
    std::uint32_t find_mergeable(const Window& window) const;
    void merge(std::uint32_t index, const Window& window);
    void propagate(std::uint32_t window);
    void reach(std::uint32_t face, int corner, double distance, const Vec2& onward, const Vec2& start_direction);
    void bend(const Arrival& arrival);
    void add_window_at_vertex(const Corner& at, double from, double to, double distance);
    std::vector<Corner>& fan(std::vector<Corner>& corners, Corner at, bool counter_clockwise);

    const TriangleMesh* mesh_ = nullptr;
    double radius_ = 0, merge_ = 0;
    std::uint32_t start_ = kNone;                    ///< the origin's face
    Vec2 origin_{0};                                 ///< in the frame of its edge 0
    SparseNumbering face_numbers_, vertex_numbers_;  ///< local numbers by index in the mesh
    std::vector<Face> faces_;
    std::vector<Vertex> vertices_;
    std::vector<Window> windows_;
    std::vector<Arrival> arrivals_;
    Queue queue_;
    std::vector<Corner> left_, right_;
};

}  // namespace tuft::mesh
