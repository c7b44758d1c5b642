#include "cli/steps/drawing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "core/text/units.h"
#include "ink/composite/match.h"
#include "stroke/document/drawing_inks.h"
#include "stroke/drawing/copies.h"
#include "stroke/drawing/drawing.h"

namespace tuft::cli {
namespace {

constexpr double kTexelsAcross = 3;  // that a detail needs to keep its shape
constexpr double kSpeck = 0.01;      // of the drawing's outline
constexpr double kSharp = 30 * kDegree;

double length_round(const std::vector<Vec2>& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) sum += glm::distance(ring[i], ring[(i + 1) % ring.size()]);
    return sum;
}
// Least mean width of an area that is no speck, metres.
double finest_width(std::vector<stroke::JournalEntry>& strokes) {
    std::vector<std::pair<double, double>> widths;  // outline, width
    double whole = 0;
    for (const stroke::FlatArea* area : stroke::areas_in(strokes, true)) {
        const double inside = stroke::enclosed_area(*area);
        double outline = 0;
        for (const auto& ring : area->rings) outline += length_round(ring);
        whole += outline;
        if (outline > 0 && inside != 0) widths.emplace_back(outline, 2 * std::abs(inside) / outline);
    }
    double finest = 0;
    for (const auto& [outline, width] : widths)
        if (outline >= kSpeck * whole && (finest == 0 || width < finest)) finest = width;
    return finest;
}

}  // namespace

nlohmann::json inks_json(const std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting) {
    nlohmann::json j = nlohmann::json::array();
    for (const stroke::ReachedInk& r : stroke::reached_inks(strokes, painting))
        j.push_back({{"ink", r.ink}, {"reached", ink::to_hex(r.reached)}, {"delta_e_2000", r.delta_e}});
    return j;
}

void note_inks(const std::vector<stroke::JournalEntry>& strokes, const stroke::Document& painting, Console& console) {
    constexpr std::size_t kNamed = 8;
    std::vector<stroke::ReachedInk> all = stroke::reached_inks(strokes, painting);
    if (all.empty()) return;
    std::ranges::stable_sort(all, std::ranges::greater(), &stroke::ReachedInk::delta_e);
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
