#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ink/colour/pigments.h"
#include "ink/spectra/colorimetry.h"

/// \file
/// From a wanted colour to an ink: the mix of pigments that comes nearest to it on a substrate.
/// Called by the studio's colour wheel, by `tuft ink match`, and where an ink is named `#rrggbb`.
namespace tuft::ink {

/// Film units of a mix when none are stated: what the shipped inks leave, about 20 µm of wet ink.
inline constexpr double kMixFilm = 2;
/// Most film units of a mix that may be as thick as its colour needs.
inline constexpr double kThickestMix = 8;
/// ΔE2000 below the visible threshold: among mixes that differ by less, the one with the fewest pigments is taken.
inline constexpr double kSameColour = 0.2;
/// Smallest gain in ΔE2000 for which a mix is made twice as thick.
inline constexpr double kWorthThickness = 0.5;

/// Linear sRGB of one dry film of `ink` on `substrate`, `film` units thick (0: as a full brush
/// leaves it), in [0, 1]. Equals what `shade_films` shows for the amounts film · fraction.
Rgb colour_on(const Ink& ink, const Substrate& substrate, double film = 0);

/// Options of `match_colour`.
struct MatchOptions {
    /// X, film units; 0: as many as the colour needs, up to `kThickestMix` and to what stays on the substrate.
    double film = kMixFilm;
    std::size_t most_parts = 4;  ///< pigments in the mix, 1 to 4
};

/// Result of `match_colour`.
struct ColourMatch {
    Ink ink;             ///< with `film` = X; its name is the wanted colour, `#rrggbb`
    Rgb wanted{};        ///< linear sRGB
    Rgb reached{};       ///< likewise: `colour_on` of the ink
    double delta_e = 0;  ///< CIEDE2000 between the two
};

/// Finds the amounts w of pigments in one film that minimise
///
///     ΔE2000(colour(w), wanted),   w_p ≥ 0,  Σ w_p ≤ X,  at most `most_parts` of them above 0,
///
/// with K = Σ w_p K_p and S = Σ w_p S_p in each band, put over the substrate by Kubelka–Munk and
/// seen through its interface (`colour_on`). Fractions of the ink are w_p / X, the rest is water.
///
/// Method: colours of about 7,000 mixes of one to three pigments are sampled once. From the 60
/// nearest samples, at most three of one set of pigments, Levenberg–Marquardt with an active set
/// on the bounds goes on, on the three terms of ΔE2000, and from the best of these with a fourth
/// pigment each. What is still no match ends with a compass search. Fewer pigments win where they
/// are as good (`kSameColour`).
/// Source: [Kubelka1931]; computer colour matching in this form: [Allen1966];
/// ΔE: [Sharma2005]; Levenberg–Marquardt: [Marquardt1963].
class MixSearch {
  public:
    /// At least one pigment, at most `kMostCandidates`; `film` > 0. Throws `Error` otherwise. About
    /// 15 ms.
    MixSearch(std::vector<Pigment> pigments, const Substrate& substrate, double film = kMixFilm);

    /// `wanted`: linear sRGB in [0, 1]. About 10 ms; any thread.
    ColourMatch nearest(const Rgb& wanted, std::size_t most_parts = 4) const;

    const std::vector<Pigment>& pigments() const { return pigments_; }
    double film() const { return film_; }

    static constexpr std::size_t kMostCandidates = 16;

  private:
    struct Sample {
        std::array<std::uint8_t, 3> pigment;  ///< the last ones repeat where there are fewer
        std::uint8_t parts = 0;
        std::array<float, 3> amount;  ///< film units
        std::array<float, 3> lab;
    };
    struct Mix {
        std::vector<std::size_t> pigment;
        std::vector<double> amount;
        double error = 0;  ///< ΔE2000
    };

    Lab lab(const Mix& mix) const;
    Mix refine(Mix mix, const Lab& wanted) const;
    Mix tidied(Mix mix, const Lab& wanted) const;
    Mix refine_mixture(Mix mix, const Lab& wanted) const;
    std::vector<Mix> starts(const Lab& wanted, std::size_t most_parts) const;
    void sample_mixes();

    std::vector<Pigment> pigments_;
    Substrate substrate_;
    std::array<double, kBands> bare_;  ///< its reflectance below the interface
    double film_;
    std::vector<double> strength_;  ///< mean K + S of each pigment, which brings amounts to one scale
    std::vector<Sample> samples_;
};

/// Searches of one set of pigments on one substrate for films that are as thick as a colour needs: the thinnest of 2, 4
/// and 8 units, cut to what stays on the substrate, that comes within `kWorthThickness` of the best. Each is made at
/// its first use, for all colours. One thread at a time.
class MixSearches {
  public:
    MixSearches(std::vector<Pigment> pigments, Substrate substrate)
        : pigments_(std::move(pigments)), substrate_(std::move(substrate)) {}

    /// As `MixSearch::nearest`; 10 ms for each film that is tried.
    ColourMatch nearest(const Rgb& wanted, std::size_t most_parts = 4);
    const Substrate& substrate() const { return substrate_; }

  private:
    std::vector<Pigment> pigments_;
    Substrate substrate_;
    std::vector<MixSearch> searches_;  ///< thinnest first
};

/// The same for one colour; with a film of 0 by `MixSearches`.
ColourMatch match_colour(const Rgb& wanted, const std::vector<Pigment>& pigments, const Substrate& substrate,
                         const MatchOptions& options = {});

/// All pigments in models/pigments.
std::vector<Pigment> shipped_pigments();

/// Linear sRGB of `#rrggbb` or `#rgb`; nothing for any other text. `to_hex` is the inverse.
std::optional<Rgb> colour_of_hex(std::string_view text);
std::string to_hex(const Rgb& linear);

/// The same, or where a canvas that has the pigments `present` has no free planes for those of the mix
/// (`kMaxPigments`), the nearest mix of the present ones.
/// `searches`: of the shipped pigments on `substrate`, reused for many colours; null: made anew.
ColourMatch match_on_canvas(const Rgb& wanted, const Substrate& substrate, std::span<const Pigment> present,
                            const MatchOptions& options = {}, MixSearches* searches = nullptr);

/// A colour that many share a canvas with, and how much it counts.
struct WeightedColour {
    Rgb colour{};       ///< linear sRGB
    double weight = 1;  ///< above 0
};

/// Returns at most `kMaxPigments` pigments for all colours together: those `present`, and of the candidates those whose
/// loss costs most. The cost of losing p is Σ weight · (ΔE2000 of the best mix without p − ΔE2000 of the best mix). All
/// that any best mix uses when there is room. The 48 heaviest colours are looked at. Cost: about 40 ms a colour.
std::vector<Pigment> choose_pigments(std::span<const WeightedColour> colours, const std::vector<Pigment>& candidates,
                                     std::span<const Pigment> present, const Substrate& substrate);

/// `load_ink`, which also takes a colour: `#rrggbb` is the nearest mix of the shipped pigments on
/// `substrate`, as thick as it needs (`match_on_canvas`). Throws `Error` as `load_ink` does, and for
/// a `#` without a colour after it.
Ink ink_named(std::string_view name, const Substrate& substrate, std::span<const Pigment> present = {},
              MixSearches* searches = nullptr);

/// Returns a ΔE2000 in words: "the same to the eye" below 1, and so on.
const char* difference_in_words(double delta_e);

}  // namespace tuft::ink
