#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/system/progress.h"
#include "mesh/triangle_mesh.h"

/// Charts: where each triangle lies in the texture.
namespace tuft::atlas {

/// The atlas of a mesh: UVs per triangle corner in [0,1]², v up. Texel (i, j) of a
/// size × size page covers u in [i, i+1]/size and v in [j, j+1]/size, its centre
/// at +0.5; row 0 is at v = 0 (image files are flipped on writing).
///
/// Several pages (UDIM) lie side by side in one square of that many texels: page p in column
/// p mod k and row p / k of k × k, its k the least that holds them all. No chart lies on two
/// pages, and half a gutter is free along each page's edge. To whatever works on texels they
/// are one large atlas whose empty tiles cost nothing; only files see pages.
struct Atlas {
    std::uint32_t size = 0;                     ///< texels per side, of all pages together
    std::uint32_t pages = 1;                    ///< that are used
    std::vector<std::uint32_t> udims;           ///< [pages] numbers that a file's pages have; empty: by place
    std::uint32_t gutter = 4;                   ///< texels kept free between charts
    double texel_size = 0;                      ///< metres per texel, area-weighted mean
    std::vector<Vec2f> corner_uvs;              ///< [3 n_triangles]
    std::vector<std::uint32_t> triangle_chart;  ///< [n_triangles]
    std::uint32_t n_charts = 0;
    bool from_file = false;  ///< the file's own UVs were kept

    std::uint32_t pages_per_side() const;
    std::uint32_t page_size() const { return size / pages_per_side(); }
    /// Page of a triangle: where its middle lies.
    std::uint32_t page_of(std::size_t triangle) const;
};

/// UV of a point on a page of its own, [0, 1]².
Vec2 page_uv(const Atlas& atlas, std::uint32_t page, const Vec2f& uv);
/// Number of a page by the UDIM convention, 1001 + column + 10 row: the UV of a point with
/// respect to all pages is `page_uv` + (column, row). Pages kept from a file keep its numbers.
std::uint32_t udim_of(const Atlas& atlas, std::uint32_t page);

enum class UvPolicy { automatic, keep, renew };

/// Edges that no chart may cross, besides the borders of the mesh.
struct RequestedSeams {
    bool groups = false;     ///< between the face groups of the file
    double sharp_angle = 0;  ///< radians: edges bent by more; 0: none

    bool any() const { return groups || sharp_angle > 0; }
};

/// Whether large charts are halved so that pages of a given size are covered better: never,
/// where less than 65 % of them would be covered, or as long as it gains much.
enum class Cutting { never, where_useful, tight };

struct UnwrapOptions {
    std::uint32_t size = 0;  ///< texels per side (of a page); 0: from texel_size
    double texel_size = 0;   ///< metres; used when size is 0. Both 0: size 2048
    /// Most pages. Above 1, `size` (0: 4096) is the side of a page, and with `texel_size` as many
    /// are made as it needs; without, all of them are filled as well as can be.
    std::uint32_t pages = 1;
    std::uint32_t gutter = 4;  ///< texels
    /// automatic: the file's UVs if they are valid and lie on one page; keep: or on several
    /// (UDIM), of `size` texels each
    UvPolicy uvs = UvPolicy::automatic;
    RequestedSeams seams;            ///< these, and pages, make new UVs unless `keep` is asked
    std::uint32_t max_size = 16384;  ///< of all pages together
    Cutting cutting = Cutting::where_useful;
    ProgressFn progress;
};

/// Figures of an atlas. Stretch after Sander et al. 2001 (1 = isometry).
struct AtlasReport {
    std::size_t charts = 0;
    std::size_t flips = 0;               ///< triangles with negative area in UV
    std::size_t overlapping_texels = 0;  ///< texel centres covered by two triangles
    std::size_t roomless_triangles = 0;  ///< with a zero or non-finite UV area
    double l2_stretch = 0, linf_stretch = 0;
    double angle_distortion = 0, area_distortion = 0;     ///< area-weighted means, 1 = none
    double utilisation = 0;                               ///< covered texels over those of all used pages
    double seam_length = 0;                               ///< over the diagonal of the bounding box
    int smallest_gap = 0;                                 ///< texels between two charts, capped at 64
    std::vector<std::pair<std::string, double>> seconds;  ///< per phase, in order
};

struct Unwrapped {
    Atlas atlas;
    AtlasReport report;
};

/// Gives every triangle its place in the texture. Any mesh made by `build_surface`
/// gets an atlas without flips or overlaps. Throws `Error` when the size cannot
/// hold the charts with their gutters, saying which size would, when
/// `UvPolicy::keep` is asked of UVs that are absent or overlap, and when seams are to
/// follow face groups that the mesh does not have.
Unwrapped unwrap(const mesh::TriangleMesh& mesh, const UnwrapOptions& options = {});

/// Measures any atlas; the only phase is "measure".
AtlasReport measure(const mesh::TriangleMesh& mesh, const Atlas& atlas);

/// The UVs a model came with.
struct UvCheck {
    Atlas atlas;        ///< with `size` texels per page, as they are: mirrored charts not turned
    std::string fault;  ///< why `UvPolicy::keep` would refuse them; empty when it would not
};

/// Appearance at UVs without changing them, to be measured; `mesh` must have some. UVs on no page
/// stay where they are, on one page.
UvCheck check_file_uvs(const mesh::TriangleMesh& mesh, std::uint32_t size);

}  // namespace tuft::atlas
