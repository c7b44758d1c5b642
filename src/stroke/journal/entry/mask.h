#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"

/// \file
/// Masks: texels that strokes and fills may change. Stored as definitions, which hold for any atlas and any revised
/// mesh; surface/mask_texels.h evaluates them on a model.
namespace tuft::stroke {

/// What a mask consists of.
enum class MaskKind {
    group,      ///< triangles of the mesh's groups (materials or objects of its file) of these names
    angle,      ///< where the surface normal is within an angle of a direction
    chart,      ///< charts of the atlas at these points
    lasso,      ///< what a polygon encloses in a view
    clear,      ///< farther than a distance from sharp edges and borders of the mesh
    invert,     ///< the complement of a mask
    intersect,  ///< the intersection of masks
    unite,      ///< the union of masks
};

/// View in which a lasso was drawn. A point p with d = p − origin, in front of the viewer, projects to (d·right, d·up),
/// metres; in perspective, with the eye at the origin, to (d·right, d·up) / d·forward. forward = up × right.
struct LassoView {
    Vec3 origin{0};
    Vec3 right{1, 0, 0}, up{0, 1, 0};  ///< unit, orthogonal
    bool perspective = false;
    bool through = false;  ///< also surface that faces away or is hidden

    bool operator==(const LassoView&) const = default;
};

/// Definition of a mask. Metres and radians, model frame.
struct Mask {
    std::uint32_t id = 0;  ///< unique in its document, never reused; 0: none
    std::string name;
    MaskKind kind = MaskKind::angle;
    std::vector<std::string> groups;  ///< group
    Vec3 direction{0, 0, 1};          ///< angle: of any length but 0
    double within = 0.785398;   ///< angle: largest angle between normal and direction; clear: between the normals of
                                ///< two triangles whose edge is not sharp
    double distance = 2e-3;     ///< clear
    double soft = 0;            ///< angle: coverage falls from 1 to 0 over within ± soft
    std::vector<Vec3> points;   ///< chart: near the surface
    LassoView view;             ///< lasso
    std::vector<Vec2> polygon;  ///< lasso: corners in the view; closed, even-odd rule
    std::vector<std::uint32_t> of;  ///< invert (one), intersect, unite: ids of masks

    bool operator==(const Mask&) const = default;
};

/// Masks of a document.
struct MaskTable {
    std::vector<Mask> masks;
    std::uint32_t next_id = 1;

    const Mask* find(std::uint32_t id) const;
    const Mask* find(std::string_view name) const;
    bool operator==(const MaskTable&) const = default;
};

/// A new mask (id 0: the next free one), or the end of one. Entries that name it stay.
struct MaskEdit {
    bool remove = false;  ///< reads `mask.id` only
    Mask mask;

    bool operator==(const MaskEdit&) const = default;
};

/// Carries the edit out. Throws `Error` and changes nothing for a name that is empty or taken, numbers out of range,
/// and masks made of unknown masks.
void apply(MaskTable& table, const MaskEdit& edit);

/// Returns the kind as a word, the name of its constant, and back. Back throws `Error` for any other word.
std::string name_of(MaskKind kind);
MaskKind mask_kind_of(const std::string& name);

}  // namespace tuft::stroke
