#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mesh/read/polygon_soup.h"

/// \file
/// Readers of FBX (binary and text) and DAE (COLLADA), by Assimp, and of STEP and IGES, by Open CASCADE. Called by
/// read_model.cpp only. Any thread.
///
/// Both libraries crash on damaged files. They therefore run in processes of their own, `tuft-import` and
/// `tuft-import-cad` (import_process.h). Such a process opens no file and has limits of computing time and memory by
/// the file's size. It costs 3 ms more than a call, and Open CASCADE's 70 libraries are loaded for its files only.
namespace tuft::io {

/// What becomes a group of the faces of a CAD file.
enum class CadGroups { bodies, faces };

/// How the surfaces of a CAD file become triangles.
struct CadReading {
    double chord = 0;  ///< greatest distance between surface and triangles, about, metres; 0: 2e-4 of the diagonal
    CadGroups groups = CadGroups::bodies;
    std::string unit = {};  ///< in which `read_model` reads the file's numbers, "mm" and so on; empty: as it states

    bool operator==(const CadReading&) const = default;
};

/// CAD formats that Open CASCADE reads.
enum class CadFormat { step, iges };

/// Returns all polygons of all nodes with the nodes' transforms applied. Points are in metres, z up, by the file's unit
/// and axes. Each object and material is a group. UVs are those of the set that the base colour's picture uses. `path`
/// gives the folder of pictures and is named in messages. Throws `Error` in one line where the file is damaged, or
/// where the process crashes, hangs or exceeds a limit: of computing time, memory, output and waiting time, by the
/// size of the file.
mesh::PolygonSoup read_fbx(const std::vector<char>& bytes, const std::filesystem::path& path);
mesh::PolygonSoup read_dae(const std::vector<char>& bytes, const std::filesystem::path& path);

/// Returns the triangles of all bodies of a file (import_cad.h), with the same promises. Points are in metres by the
/// file's unit, with its axes. Normals are those of the surfaces. Each body and colour is a group, or each face.
mesh::PolygonSoup read_cad(CadFormat format, const std::vector<char>& bytes, const std::filesystem::path& path,
                           const CadReading& how);

}  // namespace tuft::io
