#pragma once

#include <array>
#include <span>

#include "io/scene/file_scene.h"

/// \file
/// Reading of STEP and IGES by Open CASCADE, which crashes, hangs and takes memory without end on damaged files. Called
/// in processes of their own only: by `tuft-import-cad` (import_cad_main.cpp), and by the fuzz targets.
namespace tuft::io {

/// Faults of a file in our own words; all others are Open CASCADE's.
inline constexpr const char *kNotCad = "is no sound STEP or IGES file",
                            *kNoCadFaces = "has no faces with a bounded area",
                            *kTooFineChord =
                                "is too large for this chord tolerance, which is below its 1,000,000th part",
                            *kTooManyCopies = "places its parts more than a million times";
inline constexpr std::array kCadFaults{kNotCad, kNoCadFaces, kTooFineChord, kTooManyCopies};

/// The default chord tolerance as a part of the diagonal of the model's bounds.
inline constexpr double kChordPart = 2e-4;

/// How a CAD file becomes triangles.
struct CadRequest {
    double chord = 0;       ///< metres between surface and triangles, about; 0: `kChordPart` of the diagonal
    bool by_faces = false;  ///< a part for each CAD face; else one for each body and colour
};

/// Returns the triangles of all bodies of a file, in metres, with the axes of the file. `format` is "stp" or "igs".
///
/// Placements of assemblies are applied. Faces outside of closed shells are sewn: edges within the larger of 1e-5 of
/// the diagonal and of the file's own tolerance are joined, up to `kChordPart`. Triangles of faces that share an edge
/// share its points. Normals are those of the surfaces. A part is named after product or instance, body and face; a
/// second one of a name gets a number. Materials are the colours of faces, bodies and instances. Opens no file, but for
/// IGES a copy of `bytes` in memory. Throws `std::runtime_error` for what cannot be read, with Open CASCADE's words or
/// one of `kCadFaults`, or `std::bad_alloc`.
FileScene import_cad(std::string_view format, std::span<const char> bytes, const CadRequest& request);

}  // namespace tuft::io
