#pragma once

#include <string>
#include <vector>

#include "mesh/repair/repair.h"

/// What `tuft inspect` says about a model: sizes, the unit its numbers probably are in, defects.
namespace tuft::mesh {

struct UnitGuess {
    std::string unit;  ///< "mm", "cm", "m" or "in"
    double metres_per_unit = 1e-3;
    std::string second;    ///< another unit that is nearly as likely, or ""
    std::string sentence;  ///< one line for people: the size in that unit, and the doubt
};

/// The unit in which `bounds` (the file's numbers) is most likely a product: things between
/// 6 cm and 6 m across are all as likely, smaller and larger ones ever less (a log-normal
/// tail), and millimetres are commoner than metres, centimetres and inches. Weights chosen by us.
UnitGuess guess_unit(const Box& bounds);

/// Figures of a repaired surface.
struct MeshSummary {
    std::size_t n_vertices = 0;
    std::size_t n_triangles = 0;
    Box bounds;               ///< metres
    double area = 0;          ///< m²
    double volume = 0;        ///< m³, signed; 0 unless closed
    double median_edge = 0;   ///< metres
    double longest_edge = 0;  ///< metres
    bool has_uvs = false;
    bool has_colours = false;  ///< of its own, of any kind
    bool vertex_colours = false;
    std::vector<std::string> pictures;  ///< on its faces: name and size in pixels
    std::vector<std::string> group_names;
    UnitGuess unit;                 ///< guessed from the file's numbers
    double metres_per_unit = 1e-3;  ///< the unit it was loaded with
    RepairReport report;
};

/// `metres_per_unit` is what the surface was built with.
MeshSummary summarise(const Surface& surface, double metres_per_unit);

/// What was wrong with the file and what was done, one line each; empty for a sound mesh.
/// Holes and several parts are told by `describe`: they are no defects.
std::vector<std::string> describe_defects(const RepairReport& report);

/// The whole summary for people, one line each, lengths in millimetres.
std::vector<std::string> describe(const MeshSummary& summary);

}  // namespace tuft::mesh
