#pragma once

#include <TopoDS_Shape.hxx>
#include <functional>
#include <gp_Trsf.hxx>

#include "io/scene/file_scene.h"

/// \file
/// From the tessellated faces of a CAD body to the polygons of a `FileScene`. Used by import_cad.cpp only.
namespace tuft::io {

/// Triangulates all faces of a shape within `chord` (its unit) and an angle of 20° between neighbours.
void tessellate(const TopoDS_Shape& shape, double chord);

/// Adds the triangles of a tessellated body. Nodes on a shared edge or vertex become one point, so that a closed shell
/// is closed. `placement` leads from the body's millimetres to the model's, and points are stored in metres. `part_of`
/// gives the part of a face, in their order. Returns the number of faces without triangles.
std::size_t add_body(const TopoDS_Shape& body, const gp_Trsf& placement,
                     const std::function<std::uint32_t(const TopoDS_Shape& face)>& part_of, FileScene& out);

}  // namespace tuft::io
