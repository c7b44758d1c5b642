#pragma once

#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/journal/entry/entry.h"
#include "stroke/placement/model_motion.h"

/// \file
/// Strokes, fills and masks that follow a revised model. Called by `tuft replay --model` and by the studio.
namespace tuft::stroke {

/// Returns the entries moved by a change of the model, as if they had been made on it.
///
/// A flat trace or area at placement (o, r, d) goes to (M o, r', d'): r' is the direction of L r, d' that of L d
/// orthogonal to it, and the samples are mapped by L in the plane of r and d, so that a stretched body carries a
/// stretched drawing. Poses in space go to M p, rotated by the rotation; where the motion stretches, the ferrule stays
/// as far from the surface as it was. Brushes are scaled with the model. Points and directions of fills and masks are
/// moved too. Gravity is not.
///
/// A stroke follows `motion_of`; a fill of a part, chart or area the group at its place; masks and other fills the
/// whole model. Strokes on the palette and layer
/// edits do not change. Cost: a mapping of each flat stroke where parts moved.
std::vector<JournalEntry> follow_model(std::vector<JournalEntry> entries, const ModelChange& change,
                                       const mesh::SurfaceQuery& former);

/// Returns the motion that a stroke follows: that of the group on which more than half of its ink lies on the former
/// model, else that of the whole model.
ModelMotion motion_of(const StrokeSamples& trace, const ModelChange& change, const mesh::SurfaceQuery& former);

/// Returns a stroke in space pulled onto a revised surface: each pose moves along its axis until the surface is as far
/// from the ferrule's mouth as it was on the former model. Samples that met no surface there, or meet none within
/// `length` metres now, move as their neighbours in time do. Other entries do not change. `entry` was made on the
/// former model and `moved` is what `follow_model` made of it.
JournalEntry pull_onto(const JournalEntry& entry, JournalEntry moved, double length, const mesh::SurfaceQuery& former,
                       const mesh::SurfaceQuery& revised);

}  // namespace tuft::stroke
