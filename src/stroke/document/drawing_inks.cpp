#include "stroke/document/drawing_inks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "ink/composite/match.h"
#include "ink/spectra/colorimetry.h"
#include "ink/spectra/srgb.h"
#include "stroke/drawing/drawing.h"

namespace tuft::stroke {
namespace {

constexpr double kOpaque = 0.999;

double difference(const ink::Rgb& a, const ink::Rgb& b) {
    const auto lab = [](const ink::Rgb& c) { return ink::lab_of_rgb({double{c[0]}, double{c[1]}, double{c[2]}}); };
    return ink::delta_e_2000(lab(a), lab(b));
}

/// Film of an ink at an opacity.
double film_for(const ink::Ink& ink, double opacity, const ink::Substrate& substrate) {
    const ink::Rgb full = ink::colour_on(ink, substrate), bare = substrate.reflectance;
    ink::Rgb wanted;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto encoded = [](float linear) { return double(ink::srgb_encode(linear)); };
        wanted[k] = ink::srgb_decode(static_cast<float>(opacity * encoded(full[k]) + (1 - opacity) * encoded(bare[k])));
    }
    const auto error = [&](double film) {
        return difference(film > 0 ? ink::colour_on(ink, substrate, film) : bare, wanted);
    };
    // By factors of the film: thin films change the colour most.
    constexpr int kSteps = 48;
    double best = 0, least = error(0);
    for (int k = 0; k <= kSteps; ++k) {
        const double film = ink.film * std::pow(2.0, -0.25 * k);
        if (const double e = error(film); e < least) least = e, best = film;
    }
    double low = best * std::pow(2.0, -0.25), high = std::min(ink.film, best * std::pow(2.0, 0.25));
    for (int k = 0; k < 24 && best > 0; ++k) {
        const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
        (error(a) < error(b) ? high : low) = error(a) < error(b) ? b : a;
    }
    return best > 0 ? 0.5 * (low + high) : 0;
}

std::map<std::string, double> weights_of(const std::vector<FlatArea*>& areas) {
    std::map<std::string, double> weights;
    double whole = 0;
    for (const FlatArea* area : areas) {
        const double inside = std::abs(enclosed_area(*area));
        whole += inside;
        for (const AreaStop& stop : area->stops)
            if (stop.ink.starts_with('#')) weights[stop.ink] += inside / static_cast<double>(area->stops.size());
    }
    if (!(whole > 0)) return {};
    // A small sign counts, too: a fifth of the weight is shared evenly.
    for (auto& [name, weight] : weights) weight = 0.8 * weight / whole + 0.2 / static_cast<double>(weights.size());
    return weights;
}

}  // namespace

double enclosed_area(const FlatArea& area) {
    double sum = 0;
    for (const std::vector<Vec2>& ring : area.rings) {
        double inside = 0;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
            inside += 0.5 * (a.x * b.y - a.y * b.x);
        }
        sum += inside;
    }
    return sum;
}

void mix_drawing_inks(std::vector<JournalEntry>& drawing, Document& painting) {
    const std::vector<FlatArea*> areas = areas_in(drawing, true);
    painting.mix_together(weights_of(areas));
    const Materials& materials = painting.materials();
    for (const JournalEntry& entry : drawing)
        for (const std::string& ink : inks_of(entry)) materials.ink(ink);
    std::map<std::pair<std::string, double>, double> known;
    for (FlatArea* area : areas)
        for (AreaStop& stop : area->stops) {
            if (stop.film >= 0 || stop.opacity >= kOpaque) continue;
            const auto [at, fresh] = known.try_emplace({stop.ink, stop.opacity}, 0.0);
            if (fresh) at->second = film_for(materials.ink(stop.ink), stop.opacity, materials.substrate());
            stop.film = at->second;
        }
}

std::vector<ReachedInk> reached_inks(const std::vector<JournalEntry>& drawing, const Document& painting) {
    std::vector<ReachedInk> all;
    std::set<std::string> known;
    for (const JournalEntry& entry : drawing)
        for (const std::string& name : inks_of(entry)) {
            const auto wanted = ink::colour_of_hex(name);
            if (!wanted || !known.insert(name).second) continue;
            const ink::Rgb reached = ink::colour_on(painting.materials().ink(name), painting.materials().substrate());
            all.push_back({name, reached, difference(reached, *wanted)});
        }
    return all;
}

}  // namespace tuft::stroke
