#pragma once

#include <vector>

#include "brush/papers/macro/hair_macro.h"

/// \file
/// Clusters of hair macros: the middle layer of the tuft. Called by macro_model.cpp.
///
/// Hair macros whose geometries are similar form a cluster. One of them, the primitive, is simulated; the others are
/// affine copies of it. Source: [Xu2009], 5.3.1 [p]. Which maps, and how similar, is not printed. Ours are
/// the mirror images of a split, and a copy leaves its cluster as soon as the primitive's step would not be its own
/// [X]. So clusters save work and change nothing.
namespace tuft::brush::macro {

/// Reflection at a plane through the axis of the ferrule.
struct Mirror {
    Vec2 normal{1, 0};  ///< unit, across the axis, ferrule frame
};

/// A hair macro and its mirrored copies.
struct MacroCluster {
    HairMacro primitive;
    std::vector<Mirror> copies;
};

/// Returns the mirror image of a macro of a ferrule at `pose`.
HairMacro mirrored(const HairMacro& macro, const Mirror& mirror, const Pose& pose);

/// Returns all macros: primitive and copies of each cluster, in order of their offset along `across` (ferrule frame).
std::vector<HairMacro> macros_of(const std::vector<MacroCluster>& clusters, const Vec2& across, const Pose& pose);

/// Makes a cluster of each copy that the collision would treat differently from its primitive: the mirror's plane must
/// hold the normals of all planes, the direction of upright hair, and that of the hand's motion.
void release_copies(std::vector<MacroCluster>& clusters, const Collision& collision, const Pose& before);

/// Returns the clusters of macros that have just been split. Two macros are in one cluster where one is the other's
/// mirror image within 1e-9 lengths.
std::vector<MacroCluster> cluster_of(std::vector<HairMacro> macros, const Pose& pose, double length);

}  // namespace tuft::brush::macro
