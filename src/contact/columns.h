#pragma once

#include <span>

#include "brush/state/tuft_state.h"
#include "contact/node_contact.h"

/// \file
/// Contacts of a sponge: its nodes are places of its face, each at the end of a column along the axis of the ferrule
/// (brush/tuft/foam.h), the last one the mouth. Metres, world frame. Used by contact.h.
namespace tuft::contact {

/// Moves each place, of a sponge at `pose` that is `length` long, to where its column meets the surface, as far as it
/// does. `root`: the contact of the mouth. Where a place had come to rest on the plane of one face of a rim another
/// face may be nearest, and from that the first one again.
void move_to_columns(const mesh::SurfaceQuery& surface, const brush::Pose& pose, const NodeContact& root, double length,
                     std::span<Vec3> nodes);

/// Contacts of the places, each from the mouth down its column. No place follows from another, as along hair: at a rim
/// some hang beside it.
Recycled<NodeContact> find_column_contacts(const mesh::SurfaceQuery& surface, const brush::Pose& pose,
                                           const NodeContact& root, std::span<const Vec3> nodes,
                                           const NodeContactOptions& options);

}  // namespace tuft::contact
