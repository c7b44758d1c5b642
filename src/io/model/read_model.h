#pragma once

#include <filesystem>
#include <optional>

#include "io/import/read_import.h"
#include "mesh/read/polygon_soup.h"

/// \file
/// Reader of model files of all formats. Called by `cli` and by the studio. Any thread.
namespace tuft::io {

/// Names of the formats that `read_model` reads, for messages.
inline constexpr const char* kModelFormats = "OBJ, PLY, STL, OFF, GLB, glTF, FBX, DAE, 3MF, X3D, VRML, STEP and IGES";

/// Returns true when `path` has the extension of one of these formats, in any case.
bool is_model_file(const std::filesystem::path& path);

/// Reads a model file. Its format is recognised by its first bytes where the format has a signature, else by the
/// extension. Throws `Error` naming file and fault.
///
/// glTF: all triangle lists, strips and fans of the default scene, or of all nodes without one, with their node
/// transforms. Points are in metres and rotated from y up to z up, (x, −z, y). UVs are those of set 0 with v up.
/// Materials become groups. Points and lines are skipped with a warning. Buffers are read from the file, from data
/// URIs and from files inside the model's folder.
///
/// FBX, DAE, 3MF, X3D and VRML: all faces with their node transforms, in metres, z up, by the file's unit and axes
/// (read_import.h, read_3mf.h, read_x3d.h, read_vrml.h); VRML, which stores no unit, in that of the file. STEP and
/// IGES: all faces of all bodies, as triangles by `cad`, in metres.
///
/// Colours: in glTF the base colour (factor, picture of UV set 0, COLOR_0); in OBJ `Kd` and `map_Kd`; in PLY
/// `TextureFile` and the colours of faces and vertices (materials.h).
mesh::PolygonSoup read_model(const std::filesystem::path& path, const CadReading& cad = {});

/// Returns true for the extensions of formats that state their unit: all but OBJ, PLY, STL, OFF and VRML 2.0.
bool states_unit(const std::filesystem::path& path);

/// Returns true for the extensions of CAD files, whose surfaces become triangles by a `CadReading`.
bool is_cad_file(const std::filesystem::path& path);

/// Returns the metres per unit of a soup's points. `unit`: that of the file's numbers, "mm" and so on, or empty where
/// nobody says it. It goes before the unit that the file states, which a wrong export has. Nothing where neither is
/// there: OBJ, PLY, STL, OFF and VRML 2.0 (in metres by the standard, in millimetres by CAD) state none.
std::optional<double> metres_per_unit(const mesh::PolygonSoup& soup, const std::string& unit = {});

/// Returns true where `unit` is another one than the file states.
bool overrides_unit(const mesh::PolygonSoup& soup, const std::string& unit);

}  // namespace tuft::io
