#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/message.h"
#include "core/system/progress.h"
#include "mesh/triangle_mesh.h"

/// \file
/// UV atlas of a mesh: makes it, checks the UVs of a file, and measures it. `stroke` unwraps every model with
/// `unwrap`; `tuft unwrap` reports `measure`.
namespace tuft::atlas {

/// Atlas of a mesh: UVs per triangle corner in [0,1]², v up. Texel (i, j) of a size × size page covers u in [i,
/// i+1]/size and v in [j, j+1]/size; its centre is at +0.5. Row 0 is at v = 0 (image files are flipped on writing).
///
/// Pages (UDIM) lie side by side in one square: page p in column p mod k and row p / k of k × k, with the smallest
/// k that holds all. No chart crosses pages, and half a gutter is free along each page's edge. Code that works on
/// texels sees one large atlas, whose empty tiles cost nothing. Only files see pages.
struct Atlas {
    std::uint32_t size = 0;                     ///< texels per side, of all pages together
    std::uint32_t pages = 1;                    ///< number of used pages
    std::vector<std::uint32_t> udims;           ///< [pages] UDIM numbers from a file; empty: by position
    std::uint32_t gutter = 4;                   ///< free texels between charts
    double texel_size = 0;                      ///< metres per texel, area-weighted mean
    std::vector<Vec2f> corner_uvs;              ///< [3 n_triangles]
    std::vector<std::uint32_t> triangle_chart;  ///< [n_triangles]
    std::uint32_t n_charts = 0;                 ///< number of charts
    bool from_file = false;                     ///< the UVs are those of the file

    /// Returns k of the k × k pages, and the texels along a side of one.
    std::uint32_t pages_per_side() const;
    std::uint32_t page_size() const { return size / pages_per_side(); }
    /// Returns the page of a triangle: that of its centre.
    std::uint32_t page_of(std::size_t triangle) const;
};

/// Returns the UV of a point relative to a page, [0, 1]².
Vec2 page_uv(const Atlas& atlas, std::uint32_t page, const Vec2f& uv);
/// Returns the UDIM number of a page, 1001 + column + 10 row. The UV over all pages is `page_uv` + (column, row).
/// Pages from a file retain its numbers.
std::uint32_t udim_of(const Atlas& atlas, std::uint32_t page);

/// Use of the UVs of the model's file.
enum class UvPolicy {
    automatic,  ///< retained if they are valid and on one page; otherwise new ones
    keep,       ///< retained, also on several pages; `unwrap` throws when they are invalid
    renew,      ///< always new ones
};

/// Edges that no chart may cross, in addition to the borders of the mesh.
struct RequestedSeams {
    bool groups = false;     ///< between the face groups of the file
    double sharp_angle = 0;  ///< radians: edges with a larger dihedral angle; 0: none

    bool any() const { return groups || sharp_angle > 0; }
};

/// Halving of large charts, to cover pages of a given size better.
enum class Cutting {
    never,
    where_useful,  ///< where less than 65 % of the pages would be covered
    tight,         ///< while the gain is large
};

/// Options of `unwrap`.
struct UnwrapOptions {
    std::uint32_t size = 0;  ///< texels per side (of a page); 0: from texel_size
    double texel_size = 0;   ///< metres; used when size is 0. Both 0: size 2048
    /// Largest number of pages. Above 1, `size` (0: 4096) is the side of a page. With `texel_size` as many pages
    /// are made as needed; without it, all pages are filled as well as possible.
    std::uint32_t pages = 1;
    std::uint32_t gutter = 4;  ///< texels
    /// automatic: the file's UVs if they are valid and on one page. keep: also UVs on several pages (UDIM), of
    /// `size` texels each.
    UvPolicy uvs = UvPolicy::automatic;
    RequestedSeams seams;            ///< these, and pages, force new UVs unless `uvs` is keep
    std::uint32_t max_size = 16384;  ///< of all pages together
    Cutting cutting = Cutting::where_useful;
    ProgressFn progress;  ///< receives the phase and 0–1; empty: none
};

/// Measures of an atlas. Stretch after [Sander2001] (1 = isometry).
struct AtlasReport {
    std::size_t charts = 0;                               ///< number of charts
    std::size_t flips = 0;                                ///< triangles with negative area in UV
    std::size_t overlapping_texels = 0;                   ///< texel centres covered by two triangles
    std::size_t zero_area_triangles = 0;                  ///< with a zero or non-finite UV area
    double l2_stretch = 0, linf_stretch = 0;              ///< mean and largest stretch
    double angle_distortion = 0, area_distortion = 0;     ///< area-weighted means, 1 = none
    double utilisation = 0;                               ///< covered texels over texels of all used pages
    double seam_length = 0;                               ///< total length over the diagonal of the bounding box
    int smallest_gap = 0;                                 ///< texels between two charts, capped at 64
    std::vector<std::pair<std::string, double>> seconds;  ///< per phase, in order
};

/// Result of `unwrap`.
struct Unwrapped {
    Atlas atlas;
    AtlasReport report;
};

/// Returns an atlas of the mesh. Any mesh of `build_surface` gets one without flips or overlaps. Throws `Error` in
/// three cases: the size cannot hold the charts with their gutters (the message states a sufficient size);
/// `UvPolicy::keep` meets UVs that are absent or overlap; seams are requested along face groups that the mesh does
/// not have.
Unwrapped unwrap(const mesh::TriangleMesh& mesh, const UnwrapOptions& options = {});

/// Returns the measures of any atlas; its only phase is "measure".
AtlasReport measure(const mesh::TriangleMesh& mesh, const Atlas& atlas);

/// The UVs of a model's file.
struct UvCheck {
    Atlas atlas;    ///< with `size` texels per page, unchanged: mirrored charts stay mirrored
    Message fault;  ///< why `UvPolicy::keep` rejects them; empty when it accepts them
};

/// Checks the UVs of the file without changing them, for `measure`. Precondition: `mesh` has UVs. UVs outside all
/// pages are treated as one page.
UvCheck check_file_uvs(const mesh::TriangleMesh& mesh, std::uint32_t size);

}  // namespace tuft::atlas
