#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ink/spectra/kubelka_munk.h"
#include "ink/spectra/spectrum.h"

/// What inks are made of and what they are put on. Colour is computed from amounts,
/// so presets hold optical coefficients, never colours.
///
/// Film unit: 10 µm of wet ink on the surface, about 5 g/m² when dry. Amounts of ink
/// in bulk are film·m²; one millilitre is 0.1 film·m².
namespace tuft::ink {

inline constexpr double kFilmUnit = 1e-5;  ///< metres of wet ink
/// film·m² in one m³ of ink.
inline constexpr double kFilmPerVolume = 1.0 / kFilmUnit;

/// Film·m² in a volume given in millilitres.
constexpr double film_of_millilitres(double ml) {
    return ml * 1e-6 * kFilmPerVolume;
}

/// K and S as a file gives them.
struct PigmentCurve {
    std::vector<float> nm;    ///< wavelengths, ascending; empty: k and s are red, green, blue
    std::vector<float> k, s;  ///< one number per wavelength, times `scale` per film unit
    float scale = 1;
};

/// K and S per film unit at a wavelength, of a curve that has some: linear between its samples,
/// level beyond the first and the last.
Coefficients coefficients_at(const PigmentCurve& curve, float nm);

struct Pigment {
    std::string name;          ///< identifies the pigment across inks
    Bands k{};                 ///< absorption per film unit
    Bands s{};                 ///< scattering per film unit
    float height = 2.5e-6f;    ///< metres left by one film unit when dry
    float roughness = 0.5f;    ///< glTF perceptual roughness of the dry film
    float density = 2000;      ///< kg/m³ of the solid
    float granulation = 0.2f;  ///< 0–1: how much settles in the hollows of the grain
    float staining = 0.5f;     ///< 0–1: how firmly the dry film resists being lifted
    std::string source = {};   ///< where K and S come from
    PigmentCurve curve = {};   ///< what `k` and `s` were made from; empty: they came as they are
};

/// Bands of a pigment from its curve: linear between the samples, level beyond them. Red, green
/// and blue alone are made into smooth spectra first (`upsample_pigment`), so that films keep
/// the colours they have in three bands.
void use_curve(Pigment& pigment);

struct InkPart {
    Pigment pigment;
    double fraction = 1;  ///< of the wet ink; the rest of the ink is water
};

/// An ink as it is in the dish.
struct Ink {
    std::string name;                  ///< preset name: file stem
    std::string title;                 ///< for people
    std::vector<InkPart> parts;        ///< fractions sum to at most 1
    double film = 1.8;                 ///< film units a full brush leaves
    double supply = 0.004;             ///< η: part of the tuft's ink offered per supply length
    double supply_length = 0.5e-3;     ///< metres of travel
    double transfer_length = 0.08e-3;  ///< s0, metres of travel in which a texel takes up its film:
                                       ///< short beside the thinnest hairline, which must be black too

    double yield = 0;  ///< Pa: stress below which the wet ink stands as it was put, as a paste does
                       ///< (heavy oil colour some 100 to 1000); 0: it flows

    /// Sum of the fractions: 1 for undiluted ink.
    double strength() const;
};

/// What is painted on.
struct Substrate {
    std::string name, title;
    Rgb reflectance{0.8f, 0.8f, 0.8f};  ///< linear, diffuse, of the bare surface as it is seen
    float roughness = 0.5f;             ///< glTF perceptual roughness
    float metallic = 0;
    float capacity = 8;  ///< film units that stay on it, all inks together

    /// Part of the light that meets an air boundary above the ink: 1 under a glaze or
    /// varnish, 0 for a matte surface. See `Interface` (kubelka_munk.h).
    float interface = 0;
    float relief = 8e-6f;           ///< ζ: rms height of the surface's grain, metres
    float relief_length = 60e-6f;   ///< correlation length of the grain, metres
    float absorbency = 0.2f;        ///< part of the water standing on it that it draws in, 1/s
    float pores = 2;                ///< film units of water that it can hold inside
    float retention = 0;            ///< 0–1: part of the pigments that its pores sieve out of what seeps
    float diffusion = 1e-8f;        ///< D of the wet film, m²/s per film unit of water
    float threshold = 0.1f;         ///< w_c: film units of water that do not move
    float edge = 0.5f;              ///< 0–1: how firmly the rim of a wet spot stays where it is,
                                    ///< which makes its edge darken as it dries
    float evaporation = 1.0f / 60;  ///< film units of water a second at full wetness
};

/// The preset `name` from data_folder()/models/inks, or the file when `name` ends in
/// ".toml". Throws `Error` for an unknown name (with the nearest one suggested) and for
/// a file that is malformed or out of range (with its line).
Ink load_ink(std::string_view name);
Pigment load_pigment(std::string_view name);  ///< from models/pigments
Substrate load_substrate(std::string_view name);

/// Names of the presets, sorted.
std::vector<std::string> list_inks();
std::vector<std::string> list_pigments();
std::vector<std::string> list_substrates();

/// From and to TOML text; `source` is used in messages. parse_ink(ink_toml(i)) == i.
/// A part of an ink has its pigment written out, or `preset = "NAME"` of models/pigments.
Ink parse_ink(std::string_view toml, const std::string& source);
std::string ink_toml(const Ink& ink);
Pigment parse_pigment(std::string_view toml, const std::string& source);
std::string pigment_toml(const Pigment& pigment);
Substrate parse_substrate(std::string_view toml, const std::string& source);
std::string substrate_toml(const Substrate& substrate);

}  // namespace tuft::ink
