#pragma once

#include <string>
#include <vector>

#include "stroke/document/document.h"

/// \file
/// The inks of a coloured drawing, before its areas are painted. Called by `tuft paint` and by the studio; the same
/// drawing gives the same inks. Thread of the document.
namespace tuft::stroke {

/// Returns the area that the rings enclose, m²; of a ring that runs the other way, a hole, it is negative.
double enclosed_area(const FlatArea& area);

/// Mixes the inks that areas of a drawing name by colours (`#rrggbb`) from pigments that suit all of them together
/// (`Materials::mix_together`), and loads every ink that the drawing names. The weight of a colour is
///
///     0.8 A / Σ A + 0.2 / n
///
/// with its area A and the number n of colours; the stops of a gradient share its area evenly.
///
/// Then sets the film of every translucent stop: the thickness that brings the ink nearest (ΔE2000) to its opacity
/// times its colour over the bare substrate, mixed in sRGB as the drawing's maker saw it.
///
/// Throws `Error` for an unknown ink.
void mix_drawing_inks(std::vector<JournalEntry>& drawing, Document& painting);

/// What an ink that is named by a colour looks like.
struct ReachedInk {
    std::string ink;     ///< its name, the wanted colour
    ink::Rgb reached{};  ///< linear sRGB, of a full film on the substrate
    double delta_e = 0;  ///< ΔE2000 between both
};
/// Returns them for the colours that a drawing names, in the order of use. Loads the inks.
std::vector<ReachedInk> reached_inks(const std::vector<JournalEntry>& drawing, const Document& painting);

}  // namespace tuft::stroke
