#include "app/state/colour_state.h"

#include <algorithm>
#include <map>
#include <utility>

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

std::vector<ink::Pigment> pigments_in_use(const ColourState& colours, std::span<const StrokeLine> lines) {
    std::vector<ink::Pigment> all;
    for (const StrokeLine& line : lines) {
        const ink::Ink* ink = line.ink.empty() || line.erases ? nullptr : find_ink(colours, line.ink);
        if (!ink) continue;
        for (const ink::InkPart& part : ink->parts)
            if (std::none_of(all.begin(), all.end(),
                             [&](const ink::Pigment& p) { return p.name == part.pigment.name; }))
                all.push_back(part.pigment);
    }
    return all;
}

void take_mix(ColourState& colours, BrushSettings& brush, ink::Ink ink) {
    // An ink of the work has that name already: the same one, or another that keeps it.
    const std::string wanted = ink.name;
    for (int n = 2;; ++n) {
        const auto own =
            std::find_if(colours.own.begin(), colours.own.end(), [&](const ink::Ink& o) { return o.name == ink.name; });
        const bool shipped =
            std::find(colours.shipped.begin(), colours.shipped.end(), ink.name) != colours.shipped.end();
        if (own != colours.own.end() && same_recipe(*own, ink)) {
            colours.choice.in_hand.reset();
            brush.ink = ink.name;
            return;
        }
        if (own == colours.own.end() && !shipped) break;
        ink.name = wanted + "-" + std::to_string(n);
    }
    brush.ink = ink.name;
    colours.choice.in_hand = std::move(ink);
    colours.choice.taken = false;
}

void bring_in_colour(ColourState& colours, const std::string& ink_in_hand, PaintThread* work) {
    ColourChoice& c = colours.choice;
    if (!c.in_hand || c.taken || !work || ink_in_hand != c.in_hand->name) return;
    if (ink::colour_of_hex(c.in_hand->title)) remember_colour(c, c.in_hand->title);
    work->post(TakeInk{*c.in_hand});
    c.taken = true;
}

void poll_colour(ColourState& colours, BrushSettings& brush) {
    ColourChoice& c = colours.choice;
    std::optional<ink::ColourMatch> match = c.finder.poll();
    if (!match) return;
    c.match = std::move(match);
    if (std::exchange(c.take, false)) take_mix(colours, brush, c.match->ink);
}

const ink::Ink* find_ink(const ColourState& colours, const std::string& name) {
    for (const ink::Ink& ink : colours.own)
        if (ink.name == name) return &ink;
    if (colours.choice.in_hand && colours.choice.in_hand->name == name) return &*colours.choice.in_hand;
    static std::map<std::string, std::optional<ink::Ink>> shipped;
    const auto [at, is_new] = shipped.try_emplace(name);
    try {
        if (is_new) at->second = ink::load_ink(name);
    } catch (const Error&) {
        // Whoever paints with it hears why.
    }
    return at->second ? &*at->second : nullptr;
}

void show_palette(PaletteState& palette, BrushSettings& brush, StatusMessage& status, bool on) {
    palette.shown = on;
    if (!on) return;
    brush.persistent = true;
    show_message(status, "Pour inks, rinse the brush, stir; then paint on the model with what is in it.");
}

}  // namespace tuft::app
