#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/types.h"
#include "render/picture/picture.h"
#include "stroke/document/document.h"

/// \file
/// What painting a variant gave: figures, the texels with ink, places of the decoration on the surface, a picture.
/// `cli` makes them, jobs.h stores them, tolerance_map.h compares them.
namespace tuft::variants {

/// Film of all pigments together from which a texel counts as painted, film units: half a micrometre.
inline constexpr float kPaintedFilm = 0.05f;

/// Most places on the surface that a result retains.
inline constexpr std::size_t kMostFeet = 4000;

/// Figures of one variant.
struct Figures {
    std::string canvas_hash;       ///< 16 hexadecimal digits of the hash of all texels
    double ink_area_mm2 = 0;       ///< of the painted texels
    double ink_mm3 = 0;            ///< volume of ink that strokes and areas left
    std::size_t strokes = 0;       ///< of them all the next three count some
    std::size_t dry = 0;           ///< `StrokeReport::ran_dry`
    std::size_t mismatches = 0;    ///< that touch nothing, or have more than a tenth of their samples off the surface
    std::size_t unconverged = 0;   ///< with stamps that were solved only to the iteration limit
    double seconds = 0;            ///< of painting and drawing
    std::vector<double> view_deg;  ///< [2] azimuth and elevation of the picture
    std::string substrate;         ///< painted on

    bool operator==(const Figures&) const = default;
};

/// Texels and places of a variant on its model.
struct Coverage {
    std::uint32_t n_slots = 0;                          ///< of the model's texel map
    std::vector<std::uint32_t> slots;                   ///< with a painted texel, ascending
    std::vector<std::array<std::uint64_t, 4>> painted;  ///< [slots] bit t: texel t
    std::vector<Vec3f> feet;                            ///< metres: where samples of the strokes are on the surface

    bool operator==(const Coverage&) const = default;
};

/// Result of one task.
struct Outcome {
    Figures figures;
    Coverage coverage;
    render::Image picture;  ///< 0 × 0: none
};

/// Returns the painted texels of all layers, and their area in m² in `area`.
Coverage coverage_of(const stroke::Document& painting, double& area);

/// Returns the places of the strokes' samples on the surface, in order, at most `kMostFeet`: every n-th sample. Flat
/// samples are mapped (`stroke::map_to_surface`), others go to the nearest point. `off` becomes one flag per stroke on
/// the model: more than a tenth of its samples are off the surface. The n-th place is the same point of the drawing
/// whatever its deviation.
std::vector<Vec3f> feet_of(const std::vector<stroke::JournalEntry>& entries, const stroke::Model& model,
                           std::vector<bool>& off);

/// A coverage as bytes, and back. Back throws `Error` naming `source` for bytes that are no coverage.
std::vector<char> bytes_of(const Coverage& coverage);
Coverage coverage_of_bytes(const std::vector<char>& bytes, const std::string& source);

}  // namespace tuft::variants
