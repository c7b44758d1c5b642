#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// Masks: which texels strokes and fills may change.
namespace tuft::stroke {

enum class MaskKind {
    group,      ///< triangles of the mesh's groups (a file's materials or objects) of these names
    angle,      ///< where the surface's normal is within an angle of a direction
    chart,      ///< the charts of the atlas at these points
    lasso,      ///< what a polygon encloses as somebody sees it from somewhere
    invert,     ///< what another mask leaves out
    intersect,  ///< what lies in all of some masks
    unite,      ///< what lies in any of some masks
};

/// From where a lasso was drawn. Of a point p, with d = p − origin, in front of the viewer:
/// parallel: (d·right, d·up), metres; perspective, the eye at the origin: the same over d·forward.
struct LassoView {
    Vec3 origin{0};
    Vec3 right{1, 0, 0}, up{0, 1, 0};  ///< unit, at right angles; forward = up × right
    bool perspective = false;
    bool through = false;  ///< also what faces away or is hidden behind something

    bool operator==(const LassoView&) const = default;
};

/// A mask as it was asked for: it holds for any atlas and any revised mesh.
struct Mask {
    std::uint32_t id = 0;  ///< unique in its painting, never used again; 0: none
    std::string name;
    MaskKind kind = MaskKind::angle;
    std::vector<std::string> groups;  ///< group
    Vec3 direction{0, 0, 1};          ///< angle: any length but 0
    double within = 0.785398;         ///< angle: radians
    double soft = 0;                  ///< angle: coverage falls from 1 to 0 over within ± soft
    std::vector<Vec3> points;         ///< chart: metres, near the surface
    LassoView view;                   ///< lasso
    std::vector<Vec2> polygon;        ///< lasso: corners in the view, closed by itself; even-odd
    std::vector<std::uint32_t> of;    ///< invert (one), intersect, unite: ids of masks

    bool operator==(const Mask&) const = default;
};

struct MaskTable {
    std::vector<Mask> masks;
    std::uint32_t next_id = 1;

    const Mask* find(std::uint32_t id) const;
    const Mask* find(std::string_view name) const;
    bool operator==(const MaskTable&) const = default;
};

/// A new mask (id 0: the next one), or the end of one: strokes that name it stay as they are.
struct MaskEdit {
    bool remove = false;  ///< then only `mask.id` is looked at
    Mask mask;

    bool operator==(const MaskEdit&) const = default;
};

/// Carries the edit out. Throws `Error` and changes nothing for a mask that cannot be: no name
/// or one that is taken, numbers out of range, masks of masks that are not there.
void apply(MaskTable& table, const MaskEdit& edit);

std::string name_of(MaskKind kind);
MaskKind mask_kind_of(const std::string& name);

}  // namespace tuft::stroke
