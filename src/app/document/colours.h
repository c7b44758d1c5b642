#pragma once

#include <array>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "ink/composite/match.h"

/// \file
/// Colours that a person chooses, and the mixes of pigments found for them. The session holds one
/// `ColourChoice`; `panels/colour.cpp` shows it.
namespace tuft::app {

/// A colour that is wanted of an ink.
struct ColourWish {
    ink::Rgb colour{};                    ///< linear sRGB
    std::string substrate = "porcelain";  ///< preset name
    double film = 0;                      ///< film units; 0: as many as it needs
    std::vector<ink::Pigment> held;       ///< pigments of the work: see `ink::match_on_canvas`
};

/// Finds mixes on a thread of its own; only the newest wish counts.
class MixFinder {
  public:
    void want(ColourWish wish);
    /// The mix of the newest wish that is done, once.
    std::optional<ink::ColourMatch> poll();
    bool busy() const { return running_.valid() || next_.has_value(); }

  private:
    std::future<std::optional<ink::ColourMatch>> running_;
    std::optional<ColourWish> next_;
};

enum class ColourSliders { rgb, hsv, lab };

struct ColourChoice {
    bool shown = false;                                   ///< its window
    float wheel_height = 0, room_for_wheel = 1e4f;        ///< pixels, of its wheel in the last frame
    std::array<float, 3> wanted{0.753f, 0.188f, 0.125f};  ///< sRGB, 0–1
    ColourSliders sliders = ColourSliders::hsv;
    std::array<float, 3> hsv{0.017f, 0.833f, 0.753f};  ///< keeps the hue of greys
    double film = ink::kMixFilm;                       ///< film units
    bool free_film = true;                             ///< as many as the colour needs, instead
    MixFinder finder;
    std::optional<ink::ColourMatch> match;  ///< the newest mix found
    bool take = false;                      ///< the mix that comes next goes into the brush
    std::optional<ink::Ink> in_hand;        ///< chosen, and not yet part of the work
    bool taken = false;                     ///< on its way into it
    std::string hex = "#c03020", name;      ///< as typed
    std::vector<std::string> recent;        ///< painted with, `#rrggbb`, the newest first
    std::vector<ink::Ink> saved;            ///< of the person, for every work
};

/// The key of a pigment's title in the catalogues: "iron-red" of "iron red".
std::string pigment_key(std::string name);
/// Colours painted with and inks saved, of earlier runs: under `state_folder()`. What cannot be read is left out.
void load_colours(ColourChoice& choice);
/// Puts a colour first among the recent ones.
void remember_colour(ColourChoice& choice, const std::string& hex);
/// Saves an ink under its name, for every work. Throws `Error` where it cannot be written.
void save_own_ink(ColourChoice& choice, ink::Ink ink);
void forget_own_ink(ColourChoice& choice, const std::string& name);

}  // namespace tuft::app
