#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ink/spectra/kubelka_munk.h"
#include "ink/spectra/spectrum.h"

/// \file
/// Pigments, inks and substrates, and their preset files. Presets hold optical coefficients, never colours: colour
/// is computed from amounts.
///
/// Film unit: 10 µm of wet ink on the surface, about 5 g/m² when dry. Bulk amounts of ink are in film·m²; one
/// millilitre is 0.1 film·m².
namespace tuft::ink {

inline constexpr double kFilmUnit = 1e-5;  ///< metres of wet ink
/// film·m² in one m³ of ink.
inline constexpr double kFilmPerVolume = 1.0 / kFilmUnit;

/// Film·m² in a volume given in millilitres.
constexpr double film_of_millilitres(double ml) {
    return ml * 1e-6 * kFilmPerVolume;
}

/// K and S as a file states them.
struct PigmentCurve {
    std::vector<float> nm;    ///< wavelengths, ascending; empty: k and s are red, green, blue
    std::vector<float> k, s;  ///< one number per wavelength, times `scale` per film unit
    float scale = 1;          ///< factor on `k` and `s`
};

/// Returns K and S per film unit at a wavelength, of a curve that is not empty: linear between its samples,
/// constant beyond the first and the last.
Coefficients coefficients_at(const PigmentCurve& curve, float nm);

/// A pigment, read from a file.
struct Pigment {
    std::string name;          ///< identifies the pigment across inks
    Bands k{};                 ///< absorption per film unit
    Bands s{};                 ///< scattering per film unit
    float height = 2.5e-6f;    ///< metres left by one film unit when dry
    float roughness = 0.5f;    ///< glTF perceptual roughness of the dry film
    float density = 2000;      ///< kg/m³ of the solid
    float granulation = 0.2f;  ///< 0–1: fraction that settles in the hollows of the grain
    float staining = 0.5f;     ///< 0–1: resistance of the dry film to lifting
    std::string source = {};   ///< source of K and S
    PigmentCurve curve = {};   ///< curve of `k` and `s`; empty: bands given directly
};

/// Computes the bands of a pigment from its curve: linear between the samples, constant beyond them. A curve of
/// red, green and blue only is first made into smooth spectra (`upsample_pigment`), so that films have the same
/// colours as in three bands.
void use_curve(Pigment& pigment);

/// A pigment of an ink and its share.
struct InkPart {
    Pigment pigment;
    double fraction = 1;  ///< of the wet ink; the rest of the ink is water
};

/// An ink before it is loaded.
struct Ink {
    std::string name;               ///< preset name: file stem
    std::string title;              ///< for people
    std::vector<InkPart> parts;     ///< fractions sum to at most 1
    double film = 1.8;              ///< film units that a full brush deposits
    double supply = 0.004;          ///< η: fraction of the tuft's ink offered per supply length
    double supply_length = 0.5e-3;  ///< metres of travel
    /// s0, metres of travel in which a texel takes up its film; short against the thinnest hairline, so that this
    /// is black too.
    double transfer_length = 0.08e-3;

    /// Pa: yield stress of the wet ink; below it the ink keeps its shape, like a paste (heavy oil colour 100 to
    /// 1000). 0: it flows.
    double yield = 0;

    /// Sum of the fractions: 1 for undiluted ink.
    double strength() const;
};

/// How liquid behaves on a substrate and in its pores.
struct Wetting {
    float absorbency = 0.2f;  ///< rate of absorption of the water on it, 1/s
    float pores = 2;          ///< capacity of its pores, film units of water
    /// r, metres: radius of tubes that draw as its pores do, by their rate of rise [Washburn1921]; less than their
    /// width, since paths through pores wind and end. 0: `diffusion` holds in the pores too.
    float pore_radius = 0;
    float contact_angle = 0;        ///< θ of water on its pores, degrees, below 90
    float retention = 0;            ///< 0–1: fraction of the pigments that its pores retain from seeping liquid
    float diffusion = 1e-8f;        ///< D of the wet film, m²/s per film unit of water
    float threshold = 0.1f;         ///< w_c: film units of water that do not flow
    float edge = 0.5f;              ///< 0–1: pinning of the rim of a wet spot, which darkens its edge as it dries
    float evaporation = 1.0f / 60;  ///< film units of water per second, however wet it is
    /// Metres: thickness of still air, whose vapour spreads by diffusion, so that large wet places dry more slowly than
    /// `evaporation`, which then is that of lines and dots of 2 mm. 0: the air moves.
    float still_air = 0;
    /// cos θ_r − cos θ_a of contact lines that recede and advance on a wall: what holds a sheet of liquid
    /// (film/sheet_flow.h). 0: no sheets run, what is too heavy runs as beads.
    float line_hysteresis = 0;
};

/// A substrate.
struct Substrate {
    std::string name, title;
    Rgb reflectance{0.8f, 0.8f, 0.8f};  ///< linear, diffuse, of the bare surface as it is seen
    float roughness = 0.5f;             ///< glTF perceptual roughness
    float metallic = 0;                 ///< glTF
    /// Part of the light that passes the bare substrate (KHR_materials_transmission); 0: it is opaque. Ink hides what
    /// is behind it: w film units leave exp(−4 w) of it.
    float transmission = 0;
    float capacity = 8;  ///< film units that stay on it, all inks together

    /// Part of the light that meets an air boundary above the ink: 1 under a glaze or
    /// varnish, 0 for a matte surface. See `Interface` (kubelka_munk.h).
    float interface = 0;
    float relief = 8e-6f;          ///< ζ: rms height of the surface's grain, metres
    float relief_length = 60e-6f;  ///< correlation length of the grain, metres
    Wetting wetting;
};

/// Loads the preset `name` from data_folder()/models/inks, or the file when `name` ends in ".toml". Throws `Error`
/// for an unknown name (with the nearest one) and for a file that is malformed or out of range (with its line).
Ink load_ink(std::string_view name);
Pigment load_pigment(std::string_view name);  ///< from models/pigments
Substrate load_substrate(std::string_view name);

/// Names of the presets, sorted.
std::vector<std::string> list_inks();
std::vector<std::string> list_pigments();
std::vector<std::string> list_substrates();

/// Conversions from and to TOML text; `source` names the text in messages. parse_ink(ink_toml(i)) == i. A part of
/// an ink has its pigment written out, or `preset = "NAME"` of models/pigments.
Ink parse_ink(std::string_view toml, const std::string& source);
std::string ink_toml(const Ink& ink);
Pigment parse_pigment(std::string_view toml, const std::string& source);
Substrate parse_substrate(std::string_view toml, const std::string& source);
std::string substrate_toml(const Substrate& substrate);

}  // namespace tuft::ink
