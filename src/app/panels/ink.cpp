#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "app/panels/panels.h"
#include "app/widgets/labels.h"
#include "ink/composite/match.h"
#include "ink/composite/recolour.h"
#include "ink/spectra/kubelka_munk.h"

/// Inks: choosing, loading the brush, and what the work is shown with afterwards.
namespace tuft::app {
namespace {

void swatch(ImDrawList* draw, ImVec2 centre, float radius, unsigned colour) {
    draw->AddCircleFilled(centre, radius, colour, 32);
    draw->AddCircle(centre, radius, IM_COL32(128, 128, 128, 160), 32);
}

std::vector<std::string> ink_names(const ColourState& colours) {
    std::vector<std::string> names = colours.shipped;
    for (const ink::Ink& ink : colours.own) names.push_back(ink.name);
    return names;
}

// What an ink is made of, for people.
std::string recipe_text(const Ui& ui, const ColourState& colours, const std::string& name) {
    std::string text = ui.tr(name.c_str());
    const ink::Ink* ink = find_ink(colours, name);
    if (!ink || ink->parts.size() < 2) return text;
    for (const ink::InkPart& part : ink->parts) {
        char line[96];
        std::snprintf(line, sizeof line, "\n%.0f %%  %s", 100 * part.fraction / ink->strength(),
                      ui.tr(pigment_key(part.pigment.name).c_str()));
        text += line;
    }
    return text;
}

// A swatch of the grid: `id` of its button, the name that is shown, and its colour.
struct Swatch {
    std::string id, title;
    unsigned colour = 0;
    bool chosen = false;
    bool own = false;  ///< of the person, not yet of this work
};

struct SwatchSize {
    std::size_t columns = 4, lines = 2;  // of the grid; of a name
    float width = 0, height = 0, radius = 0, letters = 0;

    float height_of(std::size_t n, float gap) const {
        return static_cast<float>((n + columns - 1) / columns) * (height + gap);
    }
};

SwatchSize swatch_size(const Ui& ui, ToolDensity room) {
    SwatchSize size;
    size.columns = room == ToolDensity::tight ? 6 : 4;
    size.lines = room == ToolDensity::full ? 2 : room == ToolDensity::compact ? 1 : 0;
    size.letters = 0.70f * ImGui::GetFontSize();
    size.radius = ui.px(room == ToolDensity::full ? 10.0f : 8.0f);
    const float gap = ui.px(2);
    size.width = (ImGui::GetContentRegionAvail().x + gap) / static_cast<float>(size.columns) - gap;
    size.height = 2 * size.radius + ui.px(4) + static_cast<float>(size.lines) * size.letters;
    return size;
}

SwatchSize small_swatch_size(const Ui& ui) {
    SwatchSize size{.columns = 9, .lines = 0, .radius = ui.px(7)};
    const float gap = ui.px(2);
    size.width = (ImGui::GetContentRegionAvail().x + gap) / static_cast<float>(size.columns) - gap;
    size.height = 2 * size.radius + ui.px(4);
    return size;
}

// A swatch with its name under it; true when it was pressed.
bool named_swatch(Ui& ui, const Swatch& shown, const std::string& label, const SwatchSize& size) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(("ink " + shown.id).c_str(), ImVec2(size.width, size.height));
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 centre(at.x + 0.5f * size.width, at.y + size.radius + ui.px(2));
    swatch(draw, centre, size.radius, shown.colour);
    if (shown.chosen) draw->AddCircle(centre, size.radius + ui.px(2), ui.accent, 32, ui.px(2));
    float y = at.y + 2 * size.radius + ui.px(3);
    std::istringstream lines(size.lines > 0 ? label : "");
    for (std::string line; std::getline(lines, line); y += size.letters) {
        const float length = ImGui::GetFont()->CalcTextSizeA(size.letters, 1e9f, 0, line.c_str()).x;
        draw->AddText(ImGui::GetFont(), size.letters, ImVec2(std::round(centre.x - 0.5f * length), std::round(y)),
                      shown.chosen ? ui.strong : ui.faint, line.c_str());
    }
    return pressed;
}

bool is_colour(const Swatch& shown) {
    return ink::colour_of_hex(shown.title).has_value();
}

// The inks of this work, then the person's own, but for those that are part of it already. Those that are named by
// their colours come last.
std::vector<Swatch> list_swatches(const InkParts& s) {
    std::vector<Swatch> all;
    std::vector<std::string> names = ink_names(s.colours);
    if (s.colours.choice.in_hand &&
        std::find(names.begin(), names.end(), s.colours.choice.in_hand->name) == names.end())
        names.push_back(s.colours.choice.in_hand->name);
    for (const std::string& name : names)
        all.push_back({name, s.ui.tr(name.c_str()), ink_colour(s.colours, name), name == s.brush.ink});
    for (const ink::Ink& own : s.colours.choice.saved)
        if (std::find(names.begin(), names.end(), own.name) == names.end())
            all.push_back({"own " + own.name, own.name, ink_colour(s.colours, own), false, true});
    std::ranges::stable_partition(all, [](const Swatch& shown) { return !is_colour(shown); });
    return all;
}

void choose_own(const InkParts& s, const std::string& name) {
    const std::vector<ink::Ink>& saved = s.colours.choice.saved;
    const auto at = std::find_if(saved.begin(), saved.end(), [&](const ink::Ink& i) { return i.name == name; });
    if (at != saved.end()) take_mix(s.colours, s.brush, *at);
}

void swatch_button(const InkParts& s, const Swatch& shown, const std::string& label, const SwatchSize& size) {
    if (named_swatch(s.ui, shown, label, size)) {
        if (shown.own)
            choose_own(s, shown.title);
        else
            s.brush.ink = shown.id;
    }
    s.ui.mark(shown.id);
    if (ImGui::IsItemHovered())
        ImGui::SetTooltip("%s", (shown.own ? shown.title : recipe_text(s.ui, s.colours, shown.id)).c_str());
    if (shown.own && ImGui::BeginPopupContextItem()) {
        if (s.ui.menu_item("Forget this ink")) forget_own_ink(s.colours.choice, shown.title);
        ImGui::EndPopup();
    }
}

// Those with names, then in small those whose name says no more than their colour, such as all of a drawing's.
Savings swatches(const InkParts& s, ToolDensity room) {
    const SwatchSize size = swatch_size(s.ui, room), full = swatch_size(s.ui, ToolDensity::full),
                     compact = swatch_size(s.ui, ToolDensity::compact), tight = swatch_size(s.ui, ToolDensity::tight),
                     small = small_swatch_size(s.ui);
    const std::vector<Swatch> all = list_swatches(s);
    const auto n_named = static_cast<std::size_t>(std::ranges::find_if(all, is_colour) - all.begin());
    std::vector<std::string> titles;
    for (std::size_t i = 0; i < n_named; ++i) titles.push_back(all[i].title);
    const auto width_of = [&](const std::string& text) {
        return ImGui::GetFont()->CalcTextSizeA(size.letters, 1e9f, 0, text.c_str()).x;
    };
    const std::vector<std::string> labels =
        make_distinct(titles, {std::max<std::size_t>(1, size.lines), size.width, width_of});
    const float gap = s.ui.px(2);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(gap, gap));
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool named = i < n_named;
        const std::size_t place = named ? i : i - n_named;
        if (place % (named ? size : small).columns) ImGui::SameLine(0, gap);
        swatch_button(s, all[i], named ? labels[i] : "", named ? size : small);
    }
    ImGui::PopStyleVar();
    const float whole = full.height_of(n_named, gap);
    return {whole - compact.height_of(n_named, gap), whole - tight.height_of(n_named, gap)};
}

// Width of a button of which n fill the row, at a scale of 1.
float part_of_row(const Ui& ui, int n) {
    return (ImGui::GetContentRegionAvail().x - static_cast<float>(n - 1) * ImGui::GetStyle().ItemSpacing.x) /
           static_cast<float>(n) / ui.settings().scale;
}

// Buttons whose words fill them, so that several stand in a row.
void push_narrow_buttons(const Ui& ui) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ui.px(2), ImGui::GetStyle().FramePadding.y));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ui.px(4), ImGui::GetStyle().ItemSpacing.y));
}

// What is done with a brush between strokes.
void add_brush_actions(const InkParts& s) {
    Ui& ui = s.ui;
    const auto act = [&](const stroke::BrushChange& what) {
        bring_in_colour(s.colours, s.brush.ink, &s.work);
        s.work.post(ActOnBrush{.what = what, .brush = s.brush.preset, .ink = s.brush.ink});
    };
    push_narrow_buttons(ui);
    const float quarter = part_of_row(ui, 4);
    const bool writes = !s.reported.file.viewing;
    if (ui.button("Dip", "Fills the brush with the chosen ink; what is in it stays and mixes", quarter, writes))
        act(stroke::Dip{.depth = s.brush.dip_depth, .side = s.brush.dip_side});
    ImGui::SameLine();
    if (ui.button("Wipe", "On a rag: the ink goes, as far as the brush is dipped", quarter, writes))
        act(stroke::Wipe{.depth = s.brush.dip_depth, .side = s.brush.dip_side});
    ImGui::SameLine();
    if (ui.button("Rinse", "Washes it: no ink left, hair straight and together", quarter, writes)) act(stroke::Rinse{});
    ImGui::SameLine();
    if (ui.button("Comb", "Hair straight and together, the ink stays", 0, writes)) act(stroke::Reshape{});
    ImGui::PopStyleVar(2);
    ui.slider(
        "How deep", s.brush.dip_depth, {0.05, 1, "%.0f %%", 0.01},
        "Part of the hair, from the tip. Wipe the tip and dip it into another ink: it is darker than the belly then");
    ui.slider("Which side", s.brush.dip_side, {-1, 1, "%.0f %%", 0.01},
              "Part of the hair's width that is dipped or wiped, from the right flank, or from the left when negative; "
              "0: all of it. Wipe one side and dip it into another ink: the stroke shows both side by side");
    if (s.reported.brush.colour) {
        const auto& c = *s.reported.brush.colour;
        ImGui::PushStyleColor(ImGuiCol_PlotHistogram, IM_COL32(c[0], c[1], c[2], 255));
    }
    ImGui::ProgressBar(static_cast<float>(s.reported.brush.fullness), ImVec2(-1, ui.px(14)), "");
    if (s.reported.brush.colour) ImGui::PopStyleColor();
    ui.hint("Ink left in the brush");
}

void two_inks(const InkParts& s) {
    Ui& ui = s.ui;
    ui.toggle("Another ink in the tip", s.brush.two_inks,
              "Every stroke begins with the chosen ink in the belly and another one in the tip: petals, leaves");
    if (!s.brush.two_inks) return;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float size = ImGui::GetFrameHeight();
    swatch(ImGui::GetWindowDrawList(), ImVec2(at.x + 0.5f * size, at.y + 0.5f * size), 0.36f * size,
           ink_colour(s.colours, s.brush.tip_ink));
    ImGui::Dummy(ImVec2(size, size));
    ImGui::SameLine();
    const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
    ui.combo("Tip ink", s.brush.tip_ink, ink_names(s.colours), half / ui.px(1));
    ImGui::SameLine();
    ui.named_slider("Tip", s.brush.tip_depth, {0.05, 0.9, "%.0f %%", 0.01}, "How far up the hair it goes", half);
}

// Whether ink flows, and what is done with wet one; all in a row.
void wet_row(const InkParts& s) {
    Ui& ui = s.ui;
    ui.toggle("Wet ink", s.brush.wet,
              "It flows, soaks in and mixes with wet ink under the brush, which picks it up; it dries as you say");
    if (!s.brush.wet && !s.reported.document.wet) return;
    push_narrow_buttons(ui);
    ImGui::SameLine();
    const float half = part_of_row(ui, 2);
    const bool writes = !s.reported.file.viewing;
    if (ui.button("1 min", "Lets wet ink flow and dry for a minute", half, writes))
        s.work.post(TendInk{stroke::Dry{.seconds = 60}});
    ImGui::SameLine();
    if (ui.button("Dry", "Waits until all ink is dry; what is painted then lies over it", part_of_row(ui, 1), writes))
        s.work.post(TendInk{stroke::Dry{}});
    ImGui::PopStyleVar(2);
}

}  // namespace

Savings ink_section(const InkParts& s, ToolDensity room) {
    Ui& ui = s.ui;
    if (!ui.section("Ink", true, ui.tr(s.brush.ink.c_str()))) return {};
    const Savings saves = swatches(s, room);
    push_narrow_buttons(ui);
    if (ui.choice("Colour...", s.colours.choice.shown,
                  "Any colour, on a wheel or as a hex code: the nearest mix of pigments is found for it", 0))
        s.colours.choice.shown = !s.colours.choice.shown;
    ImGui::SameLine();
    if (ui.button("Load...", "An ink from a file", 0)) s.files.show(FileDialog::Purpose::ink, {});
    ImGui::SameLine();
    if (ui.button("Save ink...", "Writes the ink in hand to a file, for other work", part_of_row(ui, 1)))
        s.files.show(FileDialog::Purpose::save_ink, s.brush.ink + ".toml");
    ImGui::PopStyleVar(2);
    wet_row(s);
    ui.toggle("Don't reload", s.brush.persistent,
              "The brush runs dry as it paints, until it is dipped again; else every stroke begins with a full brush");
    if (s.brush.persistent)
        add_brush_actions(s);
    else
        two_inks(s);
    return saves;
}

unsigned ink_colour(const ColourState& colours, const ink::Ink& ink) {
    const ink::Rgb linear = ink::colour_on(ink, colours.appearance.document);
    int rgb[3];
    for (std::size_t c = 0; c < 3; ++c) rgb[c] = static_cast<int>(std::lround(255 * ink::srgb_encode(linear[c])));
    return IM_COL32(rgb[0], rgb[1], rgb[2], 255);
}

unsigned ink_colour(const ColourState& colours, const std::string& name) {
    static std::map<std::pair<const ink::Ink*, std::string>, unsigned> shipped;  // by ink and substrate
    const ink::Ink* ink = find_ink(colours, name);
    if (!ink) return IM_COL32(40, 40, 40, 255);
    if (!colours.own.empty() && ink >= colours.own.data() && ink < colours.own.data() + colours.own.size())
        return ink_colour(colours, *ink);
    if (colours.choice.in_hand && ink == &*colours.choice.in_hand) return ink_colour(colours, *ink);
    const auto [at, is_new] = shipped.try_emplace({ink, ink::substrate_toml(colours.appearance.document)});
    if (is_new) at->second = ink_colour(colours, *ink);
    return at->second;
}

namespace {

void recipe_sliders(Session& s, const std::string& name, const ink::Ink& shown) {
    ink::Ink& edited = s.colours.recipe;
    bool released = false, held = false;
    for (ink::InkPart& part : edited.parts) {
        double others = 0;
        for (const ink::InkPart& other : edited.parts)
            if (&other != &part) others += other.fraction;
        s.ui.slider(pigment_key(part.pigment.name).c_str(), part.fraction,
                    {0, std::max(0.01, 1 - others), "%.0f %%", 0.01}, "Part of the wet ink; the rest is water");
        released = released || ImGui::IsItemDeactivatedAfterEdit();
        held = held || ImGui::IsItemActive();
    }
    static const std::vector<std::string> pigments = ink::list_pigments();
    std::string more = s.ui.tr("Add a pigment...");
    if (s.ui.combo("Add a pigment", more, pigments)) {
        try {
            const bool there = std::any_of(edited.parts.begin(), edited.parts.end(),
                                           [&](const ink::InkPart& p) { return p.pigment.name == more; });
            const double room = 1 - edited.strength();
            if (!there) edited.parts.push_back({ink::load_pigment(more), std::min(0.1, std::max(0.0, room))});
            released = true;
        } catch (const Error& error) {
            show_message(s.status, error.message());
        }
    }
    if (released)
        s.paint_thread->post(RecolourInk{name, edited});
    else if (!held && s.paint_thread->idle())
        edited = shown;
}

}  // namespace

void colours_panel(Session& s, float top, float bottom, float left) {
    Ui& ui = s.ui;
    begin_side_panel(s.ui, "###colours", {left, top, bottom});
    ui.heading("Recolour");
    ui.note(ui.tr("Pigment amounts stay as they were painted; only what they look like changes."));
    std::set<std::string> used;
    for (const StrokeLine& line : s.journal.lines)
        if (!line.ink.empty() && !line.erases) used.insert(line.ink);
    const std::vector<std::string> names = ink_names(s.colours);
    if (used.empty()) ui.note(ui.tr("Nothing is painted yet."));
    for (const std::string& name : used) {
        const auto other = s.colours.appearance.recolours.find(name);
        const ink::Ink* shown =
            other != s.colours.appearance.recolours.end() ? &other->second : find_ink(s.colours, name);
        if (!shown) continue;
        ImGui::PushID(name.c_str());
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float size = ImGui::GetFrameHeight();
        swatch(ImGui::GetWindowDrawList(), ImVec2(at.x + 0.5f * size, at.y + 0.5f * size), 0.40f * size,
               ink_colour(s.colours, *shown));
        ImGui::Dummy(ImVec2(size, size));
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        ImGui::Text("%s %s", ui.tr(name.c_str()), ui.tr("as"));
        std::string wanted = shown->name;
        if (ui.combo(("As " + name).c_str(), wanted, names, part_of_row(s.ui, 1) - 80) && find_ink(s.colours, wanted))
            s.paint_thread->post(RecolourInk{name, *find_ink(s.colours, wanted)});
        ImGui::SameLine();
        if (ui.choice("Recipe", s.colours.edited == name, "Its pigments", part_of_row(s.ui, 1))) {
            s.colours.edited = s.colours.edited == name ? "" : name;
            s.colours.recipe = *shown;
        }
        std::string shared;
        for (const std::string& with : used)
            if (const ink::Ink* a = find_ink(s.colours, name), *b = find_ink(s.colours, with);
                with != name && a && b && !ink::shared_pigments(*a, *b).empty())
                shared += (shared.empty() ? "" : ", ") + with;
        if (shown->name != name && !shared.empty()) ui.note(std::string(ui.tr("Changes with it:")) + " " + shared);
        if (s.colours.edited == name) recipe_sliders(s, name, *shown);
        ImGui::PopID();
    }
    ui.heading("Material");
    std::string material = s.colours.appearance.substrate;
    if (ui.combo("Shown on", material, s.colours.substrates)) s.paint_thread->post(PreviewSubstrate{material});
    if (material != s.colours.appearance.painted_on)
        ImGui::TextDisabled("%s %s", ui.tr("painted on"), ui.tr(s.colours.appearance.painted_on.c_str()));
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    if (ui.primary_button("Back to the tools", part_of_row(s.ui, 1))) s.panels.show_appearance = false;
    ImGui::End();
}

unsigned colour_in_tuft(const BrushSettings& brush, const ColourState& colours, const BrushStatus& painting) {
    if (brush.persistent && painting.colour) {
        const auto& c = *painting.colour;
        return IM_COL32(c[0], c[1], c[2], 255);
    }
    return ink_colour(colours, brush.ink);
}

}  // namespace tuft::app
