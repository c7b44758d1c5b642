#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/files/files.h"
#include "ink/composite/composite.h"
#include "ink/composite/match.h"

/// \file
/// `tuft ink`: lists the shipped inks. `tuft ink match`: finds the mix nearest to a colour.
namespace tuft::cli {
namespace {

int list_inks(const InkWork& a) {
    nlohmann::json j{{"inks", nlohmann::json::array()}};
    for (const std::string& name : ink::list_inks()) {
        const ink::Ink ink = ink::load_ink(name);
        const std::string hex = ink::to_hex(ink::colour_on(ink, ink::load_substrate("porcelain")));
        if (a.common.json)
            j["inks"].push_back(
                {{"name", name}, {"title", ink.title}, {"film", ink.film}, {"colour_on_porcelain", hex}});
        else
            fmt::print("{:<22} {}  {:>4g} um  {}\n", name, hex, 10 * ink.film, ink.title);
    }
    if (a.common.json) std::cout << j.dump(2) << '\n';
    return 0;
}

ink::Rgb wanted_colour(const InkWork& a) {
    const std::string text = a.colour[0] == '#' ? a.colour : "#" + a.colour;
    if (const std::optional<ink::Rgb> wanted = ink::colour_of_hex(text)) return *wanted;
    throw UsageError("'" + a.colour + "' is no colour; write '#rrggbb', such as '#c03020'");
}

std::vector<ink::Pigment> candidates(const InkWork& a) {
    if (a.pigments.empty()) return ink::shipped_pigments();
    if (a.pigments.size() > ink::MixSearch::kMostCandidates)
        throw UsageError(fmt::format("--pigments: at most {} can be chosen from", ink::MixSearch::kMostCandidates));
    std::vector<ink::Pigment> all;
    for (const std::string& name : a.pigments) {
        all.push_back(ink::load_pigment(name));
        for (std::size_t i = 0; i + 1 < all.size(); ++i)
            if (all[i].name == all.back().name) throw UsageError("--pigments: '" + name + "' is listed twice");
    }
    return all;
}

nlohmann::json match_json(const ink::ColourMatch& match, const ink::Substrate& substrate) {
    nlohmann::json parts = nlohmann::json::array();
    for (const ink::InkPart& part : match.ink.parts)
        parts.push_back({{"pigment", part.pigment.name}, {"fraction", part.fraction}});
    return {{"wanted", ink::to_hex(match.wanted)},
            {"reached", ink::to_hex(match.reached)},
            {"delta_e_2000", match.delta_e},
            {"in_words", ink::difference_in_words(match.delta_e)},
            {"substrate", substrate.name},
            {"film", match.ink.film},
            {"film_um", 10 * match.ink.film},
            {"water", std::max(0.0, 1 - match.ink.strength())},
            {"parts", parts}};
}

}  // namespace

int run(const InkWork& a) {
    if (a.colour.empty()) return list_inks(a);
    check_extension(a.output, {".toml"});
    check_output(a.output);
    if (!std::isfinite(a.film)) throw UsageError("--film: a thickness in film units is a number from 0 to 8");
    const ink::Rgb wanted = wanted_colour(a);
    const ink::Substrate substrate = ink::load_substrate(a.substrate);
    ink::ColourMatch match = ink::match_colour(wanted, candidates(a), substrate,
                                               {.film = a.film, .most_parts = static_cast<std::size_t>(a.parts)});
    if (!a.output.empty()) {
        match.ink.name = a.output.stem().string();
        const std::string toml = ink::ink_toml(match.ink);
        write_file(a.output, toml.data(), toml.size());
    }
    if (a.common.json) {
        nlohmann::json j = match_json(match, substrate);
        if (!a.output.empty()) j["wrote"] = a.output.string();
        std::cout << j.dump(2) << '\n';
        return 0;
    }
    fmt::print("{} on {}, a film of {:g} um: reaches {}, dE2000 {:.2f} ({})\n", ink::to_hex(wanted), substrate.name,
               10 * match.ink.film, ink::to_hex(match.reached), match.delta_e, ink::difference_in_words(match.delta_e));
    for (const ink::InkPart& part : match.ink.parts)
        fmt::print("  {:>6.2f} %  {}\n", 100 * part.fraction, part.pigment.name);
    if (match.ink.strength() < 0.99995) fmt::print("  {:>6.2f} %  water\n", 100 * (1 - match.ink.strength()));
    if (!a.output.empty()) fmt::print("wrote {}\n", a.output.string());
    return 0;
}

}  // namespace tuft::cli
