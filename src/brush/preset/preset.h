#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Kinds of brush: everything about a tuft that does not change while it paints.
namespace tuft::brush {

/// How the spine's shape under load is found.
enum class SpineMethod {
    rod,    ///< discrete elastic rod in contact, solved at every sample
    table,  ///< query table over the bending moment, turned so that the tip touches
};

/// A tuft's make. Lengths in metres, stiffness in SI; TOML files say millimetres,
/// cubic centimetres and plain SI (see `load_preset`). Symbols as in the variable
/// stiffness brush: B(ξ) = B0 e^{αξ} (1+βξ)³, M_e(ξ) = M_e0 e^{γξ} (1+βξ)², ξ from
/// root (0) to tip (1).
struct Preset {
    std::string name;  ///< "wolf-medium"
    std::string note;  ///< one line for people

    // Shape.
    double length = 0.032;     ///< m, free hair from ferrule to tip
    double radius = 0.0035;    ///< m, scale R of the belly; the widest section is about 1.06 R
    double tip_power = 1.4;    ///< exponent q of the taper (1-u^2.4)^q: larger is a finer point
    double tip_radius = 1e-4;  ///< m, of the few hairs that make the point
    double hardness = 0.5;     ///< [0, 1]; softer means shorter segments at the tip
    int segments = 16;         ///< spine segments, 12–24

    // Bending.
    double stiffness = 2e-4;      ///< B0, N·m², at the root
    double alpha = -1;            ///< α of the modulus
    double beta = -0.8;           ///< β of the height, > -1
    double tip_stiffness = 2e-4;  ///< of B0, added all along: the hairs that reach the tip
    double yield = 0.7;           ///< e = M_e0 L / B0; 0 means it never yields
    double gamma = -1;            ///< γ of the yield stress
    double plastic_share = 0.3;   ///< part of the stiffness that yields; 1 is the ideally plastic hair
                                  ///< of the paper, less gives a set that saturates

    double recovery = 4;    ///< s in which a small set goes back while nothing bends the hair;
                            ///< 0: never. A large set goes slower or stays
    double damping = 3e-3;  ///< s, viscous over elastic stiffness of the wet bundle: hair that
                            ///< slips off an edge or buckles lets go in this time

    // Contact.
    double transverse_stiffness = 1.2e4;  ///< k_c, N/m²: force per length per indentation of the tuft's side
    double core_stiffness = 150;          ///< times k_c once the hair is packed
    double core_start = 0.65;             ///< indentation over radius at which it is packed
    double end_compliance = 5e-4;         ///< m, scatter of the hairs' ends: by so much the point gives before
                                          ///< the tuft, pressed end-on, buckles
    double adhesion = 0.5;                ///< N/m, pull of the wet film per length of hair; none when dry
    double adhesion_range = 1e-3;         ///< m, gap at which the film breaks
    double friction_wet = 0.30, friction_dry = 0.45;  ///< Coulomb μ
    double grain = 0.4;                               ///< κ_f: share of friction along the hair; 0.5 is isotropic
    double with_hair = 0.3;                           ///< C_η: part of friction lost when dragged tip last
    double pore_grip = 0.5;                           ///< extra μ at the tip against being pushed tip first
    double stick = 40;                                ///< tangential over normal stiffness of a sticking contact

    // Sections.
    double flatten_moment = 0.8;  ///< κ1 of a = r (1 + κ1 |m|/M_e0 + κ2 k_F + κ3 i)
    double flatten_force = 0.6;   ///< κ2
    double flatten_contact = 1;   ///< κ3; the indentation i is 1 where the hair is pressed flat
    double flatten_max = 3;       ///< a <= flatten_max r

    // Ink and splitting.
    double capacity = 4e-7;               ///< m³ of ink when full
    double split_factor = 3;              ///< ξ of SP = ξ k (1 - Z_i/Z)
    double split_at = 1, merge_at = 0.7;  ///< thresholds on SP
    double split_yaw = 0.12;              ///< Δ, radians between sub-spines
    int split_into = 3;                   ///< sub-spines of the last third, 2–5

    // Hair.
    int bundles = 40;    ///< of hair that stick together, each with ink of its own
    int bristles = 500;  ///< drawn and inked one by one

    // Force to the hand.
    double force_gain = 15;    ///< G: hair gives 0.05–0.5 N, the hand feels G times it
    double force_limit = 7.9;  ///< N

    SpineMethod spine = SpineMethod::rod;
};

/// The same make of another size, which draws the same strokes in that size: lengths grow by
/// `factor`, B0 by its fourth power, adhesion (N/m) by itself, so that forces grow by its square and
/// shapes are similar; what the tuft holds by its square, as the ground does that a stroke covers.
/// The hand feels the same force.
/// Throws `Error` when a value leaves its range.
Preset scaled(const Preset& preset, double factor);

/// A brush's name and how many times its size it is: "wolf-small*0.5".
struct SizedName {
    std::string base;
    double factor = 1;
};
inline constexpr double kLeastSize = 0.1, kMostSize = 4;

/// Takes a name apart; "*" without a number from kLeastSize to kMostSize after it is an `Error`.
SizedName sized_name(const std::string& name);
/// And puts it together: the base alone where the factor, to four digits, is 1; held to the range.
std::string name_of(const SizedName& sized);

/// Reads a preset by name from the shipped presets, or from a path to a TOML file
/// (a name with '/' or ending in ".toml"). "wolf" alone means "wolf-medium", "wolf*0.5" one of
/// half its size.
/// Throws `Error`: unknown name (with the nearest one), unreadable file with its
/// line, unknown key, wrong type, or a value out of its range, each by name.
Preset load_preset(const std::string& name_or_path);

/// Names of the shipped presets, sorted.
std::vector<std::string> list_presets();

/// The preset as a TOML file that `load_preset` reads back to the same values (1e-9).
std::string preset_toml(const Preset& preset);

/// Parses TOML text; `source` names it in errors.
Preset parse_preset(std::string_view text, const std::string& source);

/// Throws `Error(source, ...)` when a value is out of its range.
void check_preset(const Preset& preset, const std::string& source);

}  // namespace tuft::brush
