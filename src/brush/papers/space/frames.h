#pragma once

#include <span>
#include <vector>

#include "brush/state/tuft_state.h"
#include "core/system/recycled.h"

/// \file
/// What all models of the papers share: sections round given nodes, planes of the nodes.
namespace tuft::brush {

/// Returns the plane of node `k` (tip first), whether there is one for each node or one for all. Precondition: not
/// empty.
const ContactPlane& plane_of(std::span<const ContactPlane> planes, std::size_t k);

/// Returns sections at `nodes` (tip first), with semi-axes and forces 0. The tangent bisects the two segments; at the
/// root the one inside is `axis`, the ferrule's. A segment without length takes the tangent before it. e at node
/// `at` is the part of `wide` normal to the tangent there; from there it is parallel-transported both ways.
Recycled<Section> frame_sections(std::span<const Vec3> nodes, const Vec3& axis, std::size_t at, const Vec3& wide);

/// Where the wide axis is known best, and its direction there.
struct WideAxis {
    std::size_t at = 0;  ///< node, tip first
    Vec3 direction{1, 0, 0};
};

/// Returns the wide axis of a bent tuft: along its contact plane where it is nearest to the surface, relative to
/// `radius`; off the surface along the axis of bending; straight it is `kept`. The sign is that of `kept`.
WideAxis find_wide_axis(std::span<const Vec3> nodes, const Vec3& axis, std::span<const ContactPlane> planes,
                        std::span<const double> radius, const Vec3& kept);

}  // namespace tuft::brush
