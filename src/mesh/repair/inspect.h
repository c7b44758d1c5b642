#pragma once

#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/repair/repair.h"

/// \file
/// Figures about a model for `tuft inspect` and the window's model dialog: sizes, likely unit, defects.
namespace tuft::mesh {

/// The unit that a file without one probably has.
struct UnitGuess {
    std::string unit;  ///< "mm", "cm", "m" or "in"
    double metres_per_unit = 1e-3;
    std::string second;    ///< another unit that is nearly as likely, or ""
    std::string sentence;  ///< one line for people: the size in that unit, and in others that are nearly as likely
};

/// Guesses the unit of `bounds` (the file's numbers) from the likely size of a product. Sizes between 6 cm and 6 m
/// are equally likely; smaller and larger ones are less likely (a log-normal tail). Millimetres are likelier than
/// metres, centimetres and inches. The weights are our choice.
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

/// Returns the figures of a surface. `metres_per_unit` is the unit that the surface was built with.
MeshSummary summarise(const Surface& surface, double metres_per_unit);

/// Returns the defects of the file and their repairs, one line each; empty for a sound mesh. Holes and several
/// components are no defects: `describe` reports them.
std::vector<Message> describe_defects(const RepairReport& report);

/// Returns the whole summary for people, one line each, lengths in millimetres.
std::vector<std::string> describe(const MeshSummary& summary);

}  // namespace tuft::mesh
