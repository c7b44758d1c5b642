#pragma once

#include <memory>
#include <vector>

#include "brush/preset/preset.h"
#include "brush/state/tuft_state.h"
#include "brush/tuft/bundles.h"
#include "brush/tuft/shape/lattice.h"

/// \file
/// The shape that a tuft carries: points of a geometry embedded in the lattice of its spines, or of foam. `step` places
/// them (`TuftState::shape`); `footprint` cuts them by the surface, `render` and `app` draw them.
namespace tuft::brush {

struct Tuft;

/// An open pore at the skin of foam: a disc without contact.
struct SkinPore {
    std::uint32_t triangle = 0;
    Vec2 weights{0};    ///< barycentric, of the triangle's second and third corner
    double radius = 0;  ///< metres, at rest
};

/// A carried shape at rest. It does not change; copies of a tuft share it.
struct CarriedShape {
    std::vector<Vec3> rest;                               ///< [points] metres, ferrule frame
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< closed; or empty
    std::vector<std::vector<std::uint32_t>> lines;        ///< hairs; or empty
    std::vector<LatticePlace> place;                      ///< [points] in the lattice; empty for foam
    std::vector<double> at;                               ///< [nodes] of the lattice, 0 root … 1 tip
    Vec2 lo{0}, hi{0};                                    ///< metres, box of the section
    std::vector<std::uint32_t> bundle;                    ///< [points] bundle whose ink is there
    std::vector<double> along;                            ///< [points] 0 root … 1 tip
    std::vector<double> area;                             ///< [points] m² of the skin that a point stands for, or 1
    std::vector<SkinPore> pores;                          ///< of foam
    double height = 0;                                    ///< metres, of foam
    double shut_strain = 1;                               ///< of foam: strain at which its cells are shut
};

/// Returns the shape that the tuft carries, made for its spines and bundles; null where its preset has no geometry.
std::shared_ptr<const CarriedShape> embed_geometry(const Tuft& tuft);

/// Returns the frames of a bent tuft's sections as input of its lattice. x and y are carried along the spine without
/// twist from the ferrule and stretched by a/a₀ along e and b/b₀ along m.
LatticeInput lattice_input(const Tuft& tuft, const TuftState& state);

/// Fills `state.shape` from the bent spines; `planes` as in `step`. Cost: about 0.2 µs a point.
void place_geometry(const Tuft& tuft, std::span<const ContactPlane> planes, TuftState& state);

/// Fills in box, areas and ink of a shape whose `rest`, triangles and lines are there. `length` is the tuft's, metres.
void finish_shape(const Bundles& bundles, double length, CarriedShape& shape);

}  // namespace tuft::brush
