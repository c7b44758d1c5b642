#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "brush/preset/geometry.h"

/// \file
/// Brush presets: the constants of a tuft, which do not change while it paints. `brush`, `stroke` and `io` read
/// them; users write them as TOML.
namespace tuft {
class CacheKey;
}

namespace tuft::brush {

/// Solver of the spine's shape under load.
enum class SpineMethod {
    rod,    ///< discrete elastic rod in contact, solved at every sample
    table,  ///< query table over the bending moment, rotated until the tip touches
    macro,  ///< hair macros of [Xu2009]
    chain,  ///< kinematic chain of [Chu2002] and of [VanLaerhoven2007]
    truss,  ///< spring truss of [Baxter2001]
};

/// Word of each method in files and options, in the order of the values.
inline constexpr const char* kSpineWords[] = {"rod", "table", "macro", "chain", "truss"};

/// Constants of one tuft. Lengths in metres, stiffness in SI. TOML files use millimetres, cubic centimetres and
/// plain SI (see `load_preset`). Symbols as in [Huang2018], B(ξ) = B0 e^{αξ} (1+βξ)³ and M_e(ξ) =
/// M_e0 e^{γξ} (1+βξ)², with ξ from root (0) to tip (1).
struct Preset {
    std::string name;  ///< "wolf-medium"
    std::string note;  ///< one line for people

    // Shape.
    double length = 0.032;     ///< m, free hair from ferrule to tip
    double radius = 0.0035;    ///< m, scale R of the belly; the widest section is about 1.06 R
    double tip_power = 1.4;    ///< exponent q of the taper (1-u^2.4)^q: larger is a finer point
    double tip_radius = 1e-4;  ///< m, of the hairs at the point
    double hardness = 0.5;     ///< [0, 1]; softer means shorter segments at the tip
    int segments = 16;         ///< spine segments, 12–24

    // Ferrule (tuft/ferrule.h). One spine is a round tuft; with more, `radius` is half the thickness.
    int spines = 1;                 ///< K, 1–9: in a row over the width, or in a ring where that is 0
    double width = 0;               ///< m, of the ferrule's mouth; 0: round
    double corner = 16;             ///< exponent q of the mouth's shape: 2 an ellipse … 16 a rectangle
    double toe = 0;                 ///< m, by which the hair at both edges is shorter (filbert)
    double slant = 0;               ///< m, by which the hair at the edge −x is shorter than at +x (sword)
    double splay = 0;               ///< rad, lean of the hair at the edges (fan)
    double hair_diameter = 1e-4;    ///< m, of one hair
    double surface_tension = 0.05;  ///< N/m, of the ink between two spines
    double hair_friction = 0.3;     ///< Coulomb μ between hair and hair

    /// rad, lean of the holder ahead, across its broad side, of a blade (slant > 0) along it, in a hand that gives no
    /// tilt
    double lean = 0;

    // Bending.
    double stiffness = 2e-4;      ///< B0, N·m², at the root, of all hair together
    double alpha = -1;            ///< α of the modulus
    double beta = -0.8;           ///< β of the height, > -1
    double tip_stiffness = 2e-4;  ///< fraction of B0, added along the whole length: the hairs that reach the tip
    double yield = 0.7;           ///< e = M_e0 L / B0; 0 means it never yields
    double gamma = -1;            ///< γ of the yield stress
    /// Fraction of the stiffness that yields; 1: ideally plastic as in the paper; below 1 the set saturates.
    double plastic_share = 0.3;

    /// s, time constant of the recovery of a small set without load; 0: none. A large set recovers slower or not.
    double recovery = 4;
    /// s, viscous over elastic stiffness of the wet bundle; time constant of hair that slips off an edge or
    /// buckles.
    double damping = 3e-3;

    // Contact.
    double transverse_stiffness = 1.2e4;  ///< k_c, N/m²: force per length per indentation of the tuft's side
    double core_stiffness = 150;          ///< factor on k_c for packed hair
    double core_start = 0.65;             ///< indentation over radius at which it is packed
    /// m, scatter of the hair ends: shortening of the point at the buckling load under end-on pressure.
    double end_compliance = 5e-4;
    double adhesion = 0.5;                            ///< N/m, adhesion of the wet film per length of hair; 0 when dry
    double adhesion_range = 1e-3;                     ///< m, gap at which the film breaks
    double friction_wet = 0.30, friction_dry = 0.45;  ///< Coulomb μ
    double grain = 0.4;                               ///< κ_f: fraction of friction along the hair; 0.5 is isotropic
    double with_hair = 0.3;  ///< C_η: fraction of friction lost when the hair is dragged tip last
    double pore_grip = 0.5;  ///< extra μ at the tip when it is pushed tip first
    double stick = 40;       ///< tangential over normal stiffness of a sticking contact

    // Sections.
    double flatten_moment = 0.8;  ///< κ1 of a = r (1 + κ1 |m|/M_e0 + κ2 k_F + κ3 i)
    double flatten_force = 0.6;   ///< κ2
    double flatten_contact = 1;   ///< κ3; indentation i, 1 where the hair is pressed flat
    double flatten_max = 3;       ///< a <= flatten_max r

    // Ink and splitting.
    double capacity = 4e-7;               ///< m³ of ink when full
    double tip_drop = 0;                  ///< m, radius ρ of the ink that hangs at the point of a wet round tuft
    double split_factor = 3;              ///< ξ of SP = ξ k (1 - Z_i/Z)
    double split_at = 1, merge_at = 0.7;  ///< thresholds on SP
    double split_yaw = 0.12;              ///< Δ, radians between sub-spines
    int split_into = 3;                   ///< sub-spines of the last third, 2–5

    // Hair.
    int bundles = 40;    ///< number of cohesive bundles of hair, each with its own ink
    int bristles = 500;  ///< number of hairs drawn and inked individually

    // Foam (tuft/foam.h): a sponge in place of hair; its `length` is its height and its `radius` that of its face.
    double modulus = 0;      ///< E*, Pa, of the wet foam; 0: hair
    double solid = 0.03;     ///< part of its volume that is no pore
    double pore_min = 2e-4;  ///< m, diameters of the pores at the skin
    double pore_max = 1e-3;  ///< m
    double dome = 0;         ///< m, radius of curvature of the face; 0: flat
    double rim = 0;          ///< m, rounding between the face and the side
    double unevenness = 0;   ///< m, by which the face is recessed here and there
    int pore_seed = 1;       ///< places of the pores and of the unevenness

    /// Resting shape of the hair or foam; null: that of `radius` and `tip_power`.
    std::shared_ptr<const Geometry> geometry;

    // Device force.
    double force_gain = 15;    ///< G: gain from the hair's force, 0.05–0.5 N, to the device
    double force_limit = 7.9;  ///< N

    SpineMethod spine = SpineMethod::rod;
};

/// Whether the ferrule has a broad side; else it is round.
inline bool has_broad_side(const Preset& preset) {
    return preset.width > 0;
}

/// Returns true for a sponge.
inline bool is_foam(const Preset& preset) {
    return preset.modulus > 0;
}

/// Returns how wide the tuft is, metres: the ferrule's width, or the thickness of a round tuft.
inline double tuft_width(const Preset& preset) {
    return has_broad_side(preset) ? preset.width : 2 * preset.radius;
}

/// Whether a spine method bends such a tuft: `rod` any, the others hair of one spine without a geometry; `chain` and
/// `truss` flats and filberts too (Van Laerhoven has two chains with a lattice between, Baxter two trusses for a flat
/// and four for a filbert).
bool can_bend(SpineMethod method, const Preset& preset);

/// Returns a preset scaled by `factor` that draws the same strokes at that size. Lengths scale by `factor`, B0 by
/// its fourth power and adhesion (N/m) by `factor`, so forces scale by its square and shapes are similar. Capacity
/// scales by its square, like the area that a stroke covers. The device force is unchanged. Of a sponge the capacity
/// scales by the cube, and pores and modulus do not change. Throws `Error` when a value leaves its range.
Preset scaled(const Preset& preset, double factor);

/// A brush's name and scale factor: "wolf-small*0.5".
struct SizedName {
    std::string base;
    double factor = 1;
};
inline constexpr double kLeastSize = 0.1, kMostSize = 4;

/// Parses a name. Throws `Error` when "*" is not followed by a number from kLeastSize to kMostSize.
SizedName sized_name(const std::string& name);
/// Returns the name. It is the base alone when the factor, to four digits, is 1. The factor is clamped to the
/// range.
std::string name_of(const SizedName& sized);

/// Reads a preset by name from the shipped presets, or from a path to a TOML file (a name with '/' or ending in
/// ".toml"). "wolf" means "wolf-medium"; "wolf*0.5" has half its size. Throws `Error` by name for an unknown preset
/// (with the nearest name), an unreadable file (with its line), an unknown key, a wrong type, or a value out of its
/// range.
Preset load_preset(const std::string& name_or_path);

/// Names of the shipped presets, sorted.
std::vector<std::string> list_presets();

/// Returns the preset as TOML. `load_preset` reads the same values back (1e-9).
std::string preset_toml(const Preset& preset);

/// Adds every value of the preset but its name and note, to the bit, to the key of what is computed from it.
void add_to(CacheKey& key, const Preset& preset);

/// Parses TOML text; `source` names it in errors. The key `geometry` names a file in `folder`, and is refused without
/// one; `geometry_obj` holds the geometry itself, as `preset_toml` writes it.
Preset parse_preset(std::string_view text, const std::string& source,
                    const std::optional<std::filesystem::path>& folder = std::nullopt);

/// Throws `Error(source, ...)` when a value is out of its range.
void check_preset(const Preset& preset, const std::string& source);

}  // namespace tuft::brush
