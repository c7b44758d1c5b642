#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "atlas/seams/half_edges.h"
#include "core/system/progress.h"

/// \file
/// Graph of charts and seam chains. At first every triangle is a chart and every edge a seam; gluing two charts
/// along one chain keeps every chart a disk. Used by atlas/charts.
namespace tuft::atlas {

/// Limits of gluing, and the weight of its cost.
struct GluingLimits {
    double error = 0.02;              ///< developability error over area of a chart
    double mean_normal = 0.55;        ///< smallest length of the mean unit normal: prevents charts that wrap round
    double crease = 0.87;             ///< radians; chains with a larger mean dihedral angle are not glued
    double small = 1e-3;              ///< weight of the smaller chart's area in the cost
    double area = 1e300;              ///< largest area of a chart, over unit²
    std::uint32_t triangles = kNone;  ///< most triangles of a chart
};

/// Area-weighted moments of the normals of a chart. Its developability error is the
/// area times the least eigenvalue of their covariance: 0 where all normals lie in
/// one plane of normal space, as on planes, cylinders and cones.
struct NormalMoments {
    double area = 0;                 ///< over unit²
    Vec3 first{0};                   ///< Σ area · normal
    std::array<double, 6> second{};  ///< xx, xy, xz, yy, yz, zz

    static NormalMoments of(double area, const Vec3f& normal);
    void add(const NormalMoments& m);
    /// Returns the developability error, over unit².
    double error() const;
};

/// Charts of a patch, and the chains of seam edges between them.
class SeamGraph {
  public:
    /// A chain of seam edges between two charts (or one chart and itself).
    struct Chain {
        std::uint32_t id = kNone;                        ///< an edge of it
        std::uint32_t chart_a = kNone, chart_b = kNone;  ///< on its two sides
        double length = 0;                               ///< over the patch's unit
        double bend = 0;                                 ///< mean dihedral angle, radians
        bool closed = false;                             ///< gluing it would close the surface
    };

    /// `seam` [3n] marks the seams to begin with; empty: every edge is one. Takes some 20 bytes a
    /// triangle, 37 for each edge that is a seam and 100 for each chart.
    SeamGraph(const Patch& patch, std::span<const std::uint8_t> seam);

    /// Glues chains in the order of least (error growth + small area) / length while the limits hold.
    void glue_developable(const GluingLimits& limits, const ProgressFn& progress = {});

    /// All chains, in the order of their ids.
    std::vector<Chain> chains() const;
    /// Half-edges of a chain, one per edge, in no order.
    std::vector<std::uint32_t> half_edges(std::uint32_t chain) const;
    /// Returns the half-edges of the slit that is glued together with this chain: a chain that ended at it from
    /// outside. Usually empty.
    std::vector<std::uint32_t> glued_with(std::uint32_t chain) const;
    void glue(std::uint32_t chain);

    /// A number below that of the charts to begin with: the least of those glued together.
    std::uint32_t chart_of(std::uint32_t triangle) const;
    std::size_t n_charts_at_first() const { return charts_.parent.size(); }
    std::size_t n_edges() const { return half_.size(); }  ///< ids of chains lie below
    const NormalMoments& moments(std::uint32_t chart) const { return charts_.moments[chart]; }
    std::uint32_t n_triangles(std::uint32_t chart) const { return charts_.n_triangles[chart]; }
    std::vector<std::uint8_t> seams() const;  ///< [3n], borders included

  private:
    struct Ends {
        std::uint32_t a, b;
    };
    struct Charts {
        std::vector<std::uint32_t> first;           // [n_triangles] chart to begin with
        mutable std::vector<std::uint32_t> parent;  // [n_charts] of the forest of charts glued together
        std::vector<NormalMoments> moments;         // [n_charts]
        std::vector<double> error;                  // [n_charts] costly to find anew for each of their chains
        std::vector<std::uint32_t> n_triangles;     // [n_charts]
    };
    /// A chain that may be glued; ordered by cost, then by number.
    struct GlueEntry {
        double cost;
        std::uint32_t chain, version;
        bool operator<(const GlueEntry& o) const { return cost != o.cost ? cost < o.cost : chain < o.chain; }
    };
    std::vector<GlueEntry> all_glue_entries(const GluingLimits& limits);
    void number_edges(std::span<const std::uint8_t> seam);
    void number_charts(std::span<const std::uint8_t> seam);
    void count_seams_at_vertices();
    double cost(std::uint32_t chain, const GluingLimits& limits) const;
    std::uint32_t chain_of(std::uint32_t edge) const;
    bool is_closed(std::uint32_t chain) const;
    void simplify_at(std::uint32_t vertex, std::vector<std::uint32_t>& changed);
    void join(std::uint32_t a, std::uint32_t b, std::uint32_t vertex);
    void take_away(std::uint32_t chain, std::vector<std::uint32_t>& changed);
    int seam_edges_at(std::uint32_t vertex, std::array<std::uint32_t, 3>& edges) const;

    const Patch& patch_;
    std::vector<std::uint32_t> edge_of_;  // [3n], kNone where there was no seam to begin with
    std::vector<std::uint32_t> half_;     // [n_edges] one half-edge each
    std::vector<std::uint8_t> seam_;      // [n_edges]
    mutable std::vector<std::uint32_t> chain_parent_;
    std::vector<std::uint32_t> next_, tail_;  // lists of the edges of a chain
    std::vector<Ends> ends_;
    std::vector<float> length_, bent_;  // of chains: sum of length, of length × angle
    std::vector<std::uint32_t> version_;
    Charts charts_;
    std::vector<std::uint32_t> vertex_half_;  // [n_vertices] a half-edge that leaves it
    std::vector<std::uint32_t> degree_;       // seam edges at a vertex, borders included
    std::vector<std::uint8_t> stays_;         // vertex lies on a border or wants its slit
};

}  // namespace tuft::atlas
