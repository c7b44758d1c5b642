#include <algorithm>

#include "app/session/session.h"

/// \file
/// Inks that come from a chosen colour: from the mix that was found into the brush, and into the work.
namespace tuft::app {
namespace {

bool same_recipe(const ink::Ink& a, const ink::Ink& b) {
    return a.film == b.film && a.yield == b.yield &&
           std::equal(a.parts.begin(), a.parts.end(), b.parts.begin(), b.parts.end(),
                      [](const ink::InkPart& p, const ink::InkPart& q) {
                          return p.fraction == q.fraction && p.pigment.name == q.pigment.name;
                      });
}

}  // namespace

std::vector<ink::Pigment> pigments_in_use(const Session& s) {
    std::vector<ink::Pigment> all;
    for (const StrokeLine& line : s.strokes) {
        const ink::Ink* ink = line.ink.empty() || line.erases ? nullptr : find_ink(s, line.ink);
        if (!ink) continue;
        for (const ink::InkPart& part : ink->parts)
            if (std::none_of(all.begin(), all.end(),
                             [&](const ink::Pigment& p) { return p.name == part.pigment.name; }))
                all.push_back(part.pigment);
    }
    return all;
}

void take_mix(Session& s, ink::Ink ink) {
    // An ink of the work has that name already: the same one, or another that keeps it.
    const std::string wanted = ink.name;
    for (int n = 2;; ++n) {
        const auto own =
            std::find_if(s.own_inks.begin(), s.own_inks.end(), [&](const ink::Ink& o) { return o.name == ink.name; });
        const bool shipped = std::find(s.inks.begin(), s.inks.end(), ink.name) != s.inks.end();
        if (own != s.own_inks.end() && same_recipe(*own, ink)) {
            s.colour.in_hand.reset();
            s.ink = ink.name;
            return;
        }
        if (own == s.own_inks.end() && !shipped) break;
        ink.name = wanted + "-" + std::to_string(n);
    }
    s.ink = ink.name;
    s.colour.in_hand = std::move(ink);
    s.colour.taken = false;
}

void bring_in_colour(Session& s) {
    ColourChoice& c = s.colour;
    if (!c.in_hand || c.taken || !s.painter || s.ink != c.in_hand->name) return;
    if (ink::colour_of_hex(c.in_hand->title)) remember_colour(c, c.in_hand->title);
    s.painter->post(TakeInk{*c.in_hand});
    c.taken = true;
}

void poll_colour(Session& s) {
    ColourChoice& c = s.colour;
    std::optional<ink::ColourMatch> match = c.finder.poll();
    if (!match) return;
    c.match = std::move(match);
    if (std::exchange(c.take, false)) take_mix(s, c.match->ink);
}

}  // namespace tuft::app
