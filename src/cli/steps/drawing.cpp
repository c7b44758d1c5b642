#include "cli/steps/drawing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/text/units.h"
#include "ink/composite/match.h"
#include "ink/spectra/srgb.h"
#include "stroke/drawing/copies.h"
#include "stroke/drawing/drawing.h"

namespace tuft::cli {
namespace {

constexpr double kOpaque = 0.999;
constexpr double kTexelsAcross = 3;  // that a detail needs to keep its shape
constexpr double kSpeck = 0.01;      // of the drawing's outline
constexpr double kSharp = 30 * kDegree;

std::array<double, 3> as_doubles(const ink::Rgb& rgb) {
    return {double(rgb[0]), double(rgb[1]), double(rgb[2])};
}
double difference(const ink::Rgb& a, const ink::Rgb& b) {
    return ink::delta_e_2000(ink::lab_of_rgb(as_doubles(a)), ink::lab_of_rgb(as_doubles(b)));
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

std::vector<std::string> colour_inks(const std::vector<stroke::JournalEntry>& strokes) {
    std::vector<std::string> names;
    std::set<std::string> known;
    for (const stroke::JournalEntry& s : strokes)
        for (const std::string& name : stroke::inks_of(s))
            if (name.starts_with('#') && known.insert(name).second) names.push_back(name);
    return names;
}

struct Reached {
    std::string ink, reached;
    double delta_e = 0;
};
std::vector<Reached> reached_by(const std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting) {
    std::vector<Reached> all;
    const ink::Substrate& substrate = painting.materials().substrate();
    for (const std::string& name : colour_inks(strokes)) {
        const ink::Rgb reached = ink::colour_on(painting.materials().ink(name), substrate);
        if (const auto wanted = ink::colour_of_hex(name))
            all.push_back({name, ink::to_hex(reached), difference(reached, *wanted)});
    }
    return all;
}

double length_round(const std::vector<Vec2>& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) sum += glm::distance(ring[i], ring[(i + 1) % ring.size()]);
    return sum;
}
double area_in(const std::vector<Vec2>& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
        sum += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return sum;
}

// Least mean width of an area that is no speck, metres.
double finest_width(std::vector<stroke::JournalEntry>& strokes) {
    std::vector<std::pair<double, double>> widths;  // outline, width
    double whole = 0;
    for (const stroke::FlatArea* area : stroke::areas_in(strokes, true)) {
        double outline = 0, inside = 0;
        for (const auto& ring : area->rings) outline += length_round(ring), inside += area_in(ring);
        whole += outline;
        if (outline > 0 && inside != 0) widths.emplace_back(outline, 2 * std::abs(inside) / outline);
    }
    double finest = 0;
    for (const auto& [outline, width] : widths)
        if (outline >= kSpeck * whole && (finest == 0 || width < finest)) finest = width;
    return finest;
}

}  // namespace

void mix_inks(std::vector<stroke::JournalEntry>& strokes, stroke::Document& painting) {
    std::map<std::string, double> weights;
    double whole = 0;
    for (const stroke::FlatArea* area : stroke::areas_in(strokes, true)) {
        double inside = 0;
        for (const auto& ring : area->rings) inside += area_in(ring);
        whole += std::abs(inside);
        for (const stroke::AreaStop& stop : area->stops)
            if (stop.ink.starts_with('#'))
                weights[stop.ink] += std::abs(inside) / static_cast<double>(area->stops.size());
    }
    if (weights.empty() || !(whole > 0)) return;
    // A small sign counts, too: a fifth of the weight is shared evenly.
    for (auto& [name, weight] : weights) weight = 0.8 * weight / whole + 0.2 / static_cast<double>(weights.size());
    painting.mix_together(weights);
}

void set_films(std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting) {
    std::map<std::pair<std::string, double>, double> known;
    for (stroke::FlatArea* area : stroke::areas_in(strokes, true))
        for (stroke::AreaStop& stop : area->stops) {
            if (stop.film >= 0 || stop.opacity >= kOpaque) continue;
            const auto [at, fresh] = known.try_emplace({stop.ink, stop.opacity}, 0.0);
            if (fresh)
                at->second =
                    film_for(painting.materials().ink(stop.ink), stop.opacity, painting.materials().substrate());
            stop.film = at->second;
        }
}

nlohmann::json inks_json(const std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting) {
    nlohmann::json j = nlohmann::json::array();
    for (const Reached& r : reached_by(strokes, painting))
        j.push_back({{"ink", r.ink}, {"reached", r.reached}, {"delta_e_2000", r.delta_e}});
    return j;
}

void note_inks(const std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting, Console& console) {
    constexpr std::size_t kNamed = 8;
    std::vector<Reached> all = reached_by(strokes, painting);
    if (all.empty()) return;
    std::stable_sort(all.begin(), all.end(), [](const Reached& a, const Reached& b) { return a.delta_e > b.delta_e; });
    std::vector<std::string> named;
    named.reserve(std::min(kNamed, all.size()));
    for (std::size_t i = 0; i < std::min(kNamed, all.size()); ++i)
        named.push_back(fmt::format("{} {:.1f}", all[i].ink, all[i].delta_e));
    console.note(fmt::format("{} ink{} of the drawing, mixed for {}; dE2000 from its colour: {}{}", all.size(),
                             all.size() == 1 ? "" : "s", painting.materials().substrate().name, fmt::join(named, ", "),
                             all.size() > kNamed ? ", less for the others" : ""));
}

double texel_for_detail(std::vector<stroke::JournalEntry>& strokes, const Paint& a) {
    const double finest = finest_width(strokes);
    if (finest == 0) return 0;
    Box extent = stroke::extent_of(stroke::drawing_in(strokes, true));
    for (const stroke::FlatArea* area : stroke::areas_in(strokes, true)) stroke::add_extent(extent, *area);
    const double width = stroke::width_of(extent);
    const double scale = a.place.width_mm > 0 && width > 0 ? a.place.width_mm * kMillimetre / width : 1;
    constexpr double kSpare = 1.02;  // the atlas meets the texel size within a percent
    return scale * finest / (kSpare * kTexelsAcross);
}

void note_detail(std::vector<stroke::JournalEntry>& strokes, double texel, Console& console) {
    const double finest = finest_width(strokes);
    if (finest == 0 || finest >= kTexelsAcross * texel) return;
    console.note(fmt::format(
        "warning: the finest detail of the drawing is {:.3g} mm wide, {:.1f} texels; it keeps its shape with texels of "
        "{:.2g} mm (see --texel-size, --auto-texel)",
        finest / kMillimetre, finest / texel, finest / kTexelsAcross / kMillimetre));
}

stroke::AreaEdges edges_of(const Paint& a) {
    if (a.place.edges == "run-over") return stroke::AreaEdges::run_over;
    return a.place.edges == "cut" || a.place.edges == "end-before" ? stroke::AreaEdges::cut : stroke::AreaEdges::facing;
}

void keep_clear_of_edges(std::vector<stroke::JournalEntry>& strokes, const stroke::MaskTable& masks, const Paint& a) {
    if (a.place.edges != "end-before") return;
    std::vector<stroke::JournalEntry> edits;
    std::uint32_t next = masks.next_id;
    // The id of a mask like this one: that of the project where it has it, else of a new one.
    const auto id_of = [&](stroke::Mask mask) {
        if (const stroke::Mask* known = masks.find(mask.name)) {
            mask.id = known->id;
            if (*known == mask) return mask.id;
            for (int n = 2; masks.find(mask.name); ++n) mask.name = fmt::format("{} ({})", known->name, n);
        }
        mask.id = next++;
        edits.emplace_back(stroke::MaskEdit{.mask = mask});
        return mask.id;
    };
    const std::string name = fmt::format("{:.3g} mm clear of edges", a.place.edge_margin_mm);
    const std::uint32_t clear = id_of({.name = name,
                                       .kind = stroke::MaskKind::clear,
                                       .within = kSharp,
                                       .distance = a.place.edge_margin_mm * kMillimetre});
    std::map<std::uint32_t, std::uint32_t> both{{0, clear}};
    const auto keep = [&](std::uint32_t& mask) {
        const auto [at, fresh] = both.try_emplace(mask, 0);
        if (fresh)
            at->second = id_of({.name = fmt::format("{}, {}", masks.find(mask)->name, name),
                                .kind = stroke::MaskKind::intersect,
                                .of = {mask, clear}});
        mask = at->second;
    };
    for (stroke::JournalEntry& s : strokes) {
        if (stroke::on_palette(s)) continue;
        if (auto* stroke = s.as<stroke::PaintStroke>()) keep(stroke->mask);
        if (auto* fill = s.as<stroke::Fill>()) keep(fill->mask);
    }
    strokes.insert(strokes.begin(), std::make_move_iterator(edits.begin()), std::make_move_iterator(edits.end()));
}

void add_copies(std::vector<stroke::JournalEntry>& strokes, const stroke::Model& model, const Paint& a) {
    stroke::Symmetry symmetry{.mirror_x = a.copies.mirror.find('x') != std::string::npos,
                              .mirror_y = a.copies.mirror.find('y') != std::string::npos,
                              .mirror_z = a.copies.mirror.find('z') != std::string::npos,
                              .radial = a.copies.radial,
                              .centre = model.mesh->bounds.centre()};
    if (a.copies.radial_axis == "x") symmetry.axis = {1, 0, 0};
    if (a.copies.radial_axis == "y") symmetry.axis = {0, 1, 0};
    if (!symmetry.any()) return;
    stroke::EntryGroup group{1, "copy"};
    for (const stroke::JournalEntry& s : strokes) {
        if (group.id == 1 && !s.group.name.empty()) group.name = s.group.name + " (copy)";
        group.id = std::max(group.id, s.group.id + 1);
    }
    if (group.name.size() > stroke::kMaxNameBytes) group.name = "copy";
    std::vector<stroke::JournalEntry> copies = stroke::symmetric_copies(
        strokes, symmetry, a.copies.readable ? stroke::CopyReading::upright_parts : stroke::CopyReading::mirrored,
        group);
    strokes.insert(strokes.end(), std::make_move_iterator(copies.begin()), std::make_move_iterator(copies.end()));
}

}  // namespace tuft::cli
