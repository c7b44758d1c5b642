#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "ink/spectra/spectrum.h"

/// \file
/// Filaments of a colour printer: how their walls look, and which of them a painted triangle gets. Called by `io` for
/// 3MF.
namespace tuft::ink {

/// A filament. Its thick wall has the colour `colour`; `hiding` is the thickness of a wall that over black has 98 % of
/// the luminance which it has when it is thick (contrast ratio 0.98, ISO 6504-3).
struct Filament {
    std::string name;
    Rgb colour{1, 1, 1};  ///< linear sRGB
    double hiding = 0;    ///< metres; 0: opaque
};

/// Returns the colour of a wall of `filament`, `wall` metres thick, over a thick one of `core`, by Kubelka–Munk in each
/// band: K/S = (1 − R)² / 2R from the colour's bands R, and one S for all bands that gives `hiding`. Linear sRGB.
Rgb colour_of_wall(const Filament& filament, const Filament& core, double wall);

/// A piece of a triangle: its painted colour and its area.
struct ColourPatch {
    Rgb colour{0, 0, 0};  ///< linear sRGB
    double area = 0;      ///< any unit
};

/// The filament nearest to a colour.
struct FilamentChoice {
    std::size_t filament = 0;
    double delta_e = 0;  ///< mean CIEDE2000 over the patches, weighted by area
};

/// Returns the filament with the least mean CIEDE2000 between the patches and its printed colour; of equal ones the
/// first. Triangles do not influence each other, so this choice for each triangle is the best assignment of all. An
/// empty list of patches gets filament 0.
FilamentChoice choose_filament(std::span<const ColourPatch> patches, std::span<const Rgb> printed);

/// Reads a file of filaments:
///
///     [[filament]]
///     name = "PLA white"
///     colour = "#f4f2ea"
///     hiding_mm = 1.2      # 0 or nothing: opaque
///
/// Throws `Error` naming file and line, for no filament and for more than 16.
std::vector<Filament> load_filaments(const std::filesystem::path& path);

inline constexpr std::size_t kMostFilaments = 16;

}  // namespace tuft::ink
