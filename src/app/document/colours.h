#pragma once

#include <array>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "ink/composite/match.h"

/// \file
/// Chosen colours and the pigment mixtures found for them. The session holds one `ColourChoice`; panels/colour.cpp
/// shows it. Window thread.
namespace tuft::app {

/// A colour to match by an ink.
struct ColourRequest {
    ink::Rgb colour{};                    ///< linear sRGB
    std::string substrate = "porcelain";  ///< preset name
    double film = 0;                      ///< film units; 0: as the colour needs
    std::vector<ink::Pigment> held;       ///< pigments on the canvas: see `ink::match_on_canvas`
};

/// Matches colours on a thread of its own. Only the newest request counts. Window thread.
class MixFinder {
  public:
    /// Starts a match, or lets it wait for the running one. Of those that wait only the newest stays.
    void request(ColourRequest request);
    /// Returns the finished match of the newest request, once.
    std::optional<ink::ColourMatch> poll();
    bool busy() const { return running_.valid() || next_.has_value(); }

  private:
    std::future<std::optional<ink::ColourMatch>> running_;
    std::optional<ColourRequest> next_;
};

enum class ColourSliders { rgb, hsv, lab };

/// The wheel of the colour window in the last frame, pixels.
struct ColourWheelSize {
    float height = 0, room = 1e4f;  ///< of the wheel; free for it in the view
};

/// What is typed into the colour window.
struct TypedColour {
    std::string hex = "#c03020", name;
};

/// State of the colour window.
struct ColourChoice {
    bool shown = false;  ///< the window is open
    ColourWheelSize wheel;
    std::array<float, 3> wanted{0.753f, 0.188f, 0.125f};  ///< sRGB, 0–1
    ColourSliders sliders = ColourSliders::hsv;
    std::array<float, 3> hsv{0.017f, 0.833f, 0.753f};  ///< keeps the hue of greys
    double film = ink::kMixFilm;                       ///< film units
    bool free_film = true;                             ///< the film is as thick as the colour needs
    MixFinder finder;
    std::optional<ink::ColourMatch> match;  ///< newest match found
    bool take = false;                      ///< the next match goes into the brush
    std::optional<ink::Ink> in_hand;        ///< chosen, not yet part of the project
    bool taken = false;                     ///< being added to the project
    TypedColour typed;
    std::vector<std::string> recent;  ///< painted with, `#rrggbb`, newest first
    std::vector<ink::Ink> saved;      ///< the user's own, for all projects
};

/// Returns the key of a pigment's title in the catalogues: "iron-red" of "iron red".
std::string pigment_key(std::string name);
/// Loads recent colours and saved inks of earlier runs from `state_folder()`. Skips what cannot be read.
void load_colours(ColourChoice& choice);
/// Puts a colour first among the recent ones and saves the list.
void remember_colour(ColourChoice& choice, const std::string& hex);
/// Saves an ink under its name for all projects. Throws `Error` where it cannot be written.
void save_own_ink(ColourChoice& choice, ink::Ink ink);
void forget_own_ink(ColourChoice& choice, const std::string& name);

}  // namespace tuft::app
