#include <imgui.h>

#include <algorithm>
#include <utility>

#include "app/panels/panels.h"
#include "writer/gesture/style.h"

/// \file
/// The panel of the tool that writes: the text, its style, and where its characters come from.
namespace tuft::app {
namespace {

constexpr float kLetteringWidth = 244;  // pixels at a scale of 1
constexpr float kTextLines = 3.6f;      // of the field, seen without scrolling

/// Names of shipped styles in the window.
constexpr std::pair<const char*, const char*> kStyleTitles[] = {
    {"kaishu", "Regular"}, {"xingshu", "Running"}, {"line", "Even line"}, {"italic", "Italic"}};

std::string title_of(const std::string& style) {
    for (const auto& [name, title] : kStyleTitles)
        if (style == name) return title;
    return style;
}

void choose_style(Ui& ui, Lettering& l, float width) {
    static const std::vector<std::string> styles = writer::list_styles();
    std::vector<std::string> titles;
    for (const std::string& style : styles) titles.push_back(title_of(style));
    std::string chosen = title_of(l.wanted.style);
    if (ui.combo("Style", chosen, titles, width)) {
        l.wanted.style =
            styles[static_cast<std::size_t>(std::find(titles.begin(), titles.end(), chosen) - titles.begin())];
        l.spacing = {};
    }
    ui.hint("Of the hand: regular, running, an even line, or a broad edge for letters");
}

/// A field of several lines that keeps what was typed when Esc leaves it.
void text_field(Ui& ui, Lettering& l, bool take_keyboard) {
    const auto grow = [](ImGuiInputTextCallbackData* data) {
        auto& all = *static_cast<std::string*>(data->UserData);
        all.resize(static_cast<std::size_t>(data->BufTextLen));
        data->Buf = all.data();
        return 0;
    };
    std::string& text = l.wanted.text;
    const std::string before = text;
    if (take_keyboard) ImGui::SetKeyboardFocusHere();
    const float height = kTextLines * ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().FramePadding.y;
    // A field that has the keyboard would write its own text over one that was set.
    const std::string name = "##text" + std::to_string(l.setting);
    ImGui::InputTextMultiline(name.c_str(), text.data(), text.capacity() + 1, ImVec2(-1, height),
                              ImGuiInputTextFlags_CallbackResize, grow, &text);
    if (ImGui::IsKeyPressed(ImGuiKey_Escape)) text = before;
    ui.mark("Text");
    ui.hint(l.wanted.like.empty() ? "What is written; Enter begins a new line"
                                  : "The name of the copied character, or nothing");
}

void fault_line(Ui& ui, const Message& fault) {
    if (fault.empty()) return;
    ImGui::PushStyleColor(ImGuiCol_Text, ui.wrong);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(ui.sentence(fault).c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ui.mark("Text fault");
}

void style_row(Ui& ui, Lettering& l) {
    const float half =
        0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / ui.settings().scale;
    choose_style(ui, l, half);
    ImGui::SameLine();
    ui.toggle("Own brush", l.style_brush,
              "The style's brush in the size that suits the characters; else the brush that is chosen, as it is");
}

void source_row(Ui& ui, Lettering& l, FileDialog& files) {
    const float gap = ImGui::GetStyle().ItemSpacing.x, all = ImGui::GetContentRegionAvail().x;
    const bool own = !l.wanted.glyphs.empty();
    const float room = own ? all - ui.px(34) - gap : all;
    const std::string name = l.wanted.glyphs.filename().string();
    const std::string title =
        own ? ui.fitted(name, room - 2 * ImGui::GetStyle().FramePadding.x) : ui.tr("Characters from...");
    if (ImGui::Button((title + "##glyphs").c_str(), ImVec2(room, 0)))
        files.show(FileDialog::Purpose::glyphs, own ? l.wanted.glyphs.parent_path() : "/usr/share/fonts");
    ui.mark("Characters from...");
    ui.hint(
        "A font, or a file of a folder of characters (hanzi-writer-data, KanjiVG, Make Me a Hanzi). Without one those "
        "that are shipped");
    if (!own) return;
    ImGui::SameLine();
    if (ui.button("\xc3\x97##glyphs", "Only the characters that are shipped", 34)) l.wanted.glyphs.clear();
}

/// The picture that is copied; or where it is chosen, beside those that the project keeps.
void copy_row(Session& s, Lettering& l) {
    Ui& ui = s.ui;
    const float gap = ImGui::GetStyle().ItemSpacing.x, all = ImGui::GetContentRegionAvail().x;
    const bool copies = !l.wanted.like.empty();
    const bool aside = copies || !l.kept.empty();
    const float room = aside ? all - ui.px(34) - gap : all;
    const std::string title =
        copies ? ui.fitted(l.wanted.like.filename().string(), room - 2 * ImGui::GetStyle().FramePadding.x)
               : ui.tr("Copy a picture...");
    if (ImGui::Button((title + "##like").c_str(), ImVec2(room, 0)))
        s.dialogs.file.show(FileDialog::Purpose::copied_picture, copies ? l.wanted.like.parent_path() : "");
    ui.mark("Copy a picture...");
    ui.hint("A photo, a scan or a rubbing of one character, which is written as it is there");
    if (!aside) return;
    ImGui::SameLine();
    if (copies) {
        if (ui.button("\xc3\x97##like", "Writes a text again", 34)) copy_picture(l, "");
        return;
    }
    if (ui.button("\xe2\x96\xbe##kept", "Characters that were copied for this project", 34)) ImGui::OpenPopup("kept");
    if (!ImGui::BeginPopup("kept")) return;
    ui.in_menu = true;
    for (const KeptCopy& copy : l.kept) {
        const std::string name = copy.name + (copy.name.empty() ? "" : "  ") + copy.file.filename().string();
        if (ImGui::Selectable((name + "##" + copy.id).c_str())) {
            take_kept_copy(s, copy);
            ui.mark("kept " + name);
            break;
        }
        ui.mark("kept " + name);
    }
    ui.in_menu = false;
    ImGui::EndPopup();
}

void direction_row(Ui& ui, writer::Direction& direction) {
    using enum writer::Direction;
    struct Choice {
        writer::Direction direction;
        const char *name, *hint;
    };
    static constexpr Choice kChoices[] = {
        {horizontal, "Across", "From left to right, lines below each other"},
        {vertical, "Down", "From the top down, columns from right to left"},
        {rim, "Round", "Round the model, level, through the place under the cursor"},
        {curve, "Curve##direction", "Along the curve whose points were set last with the tool Curve"}};
    const float gap = ui.px(2), all = ImGui::GetContentRegionAvail().x;
    const float each = (all - 3 * gap) / 4 / ui.settings().scale;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(ui.px(2), ImGui::GetStyle().FramePadding.y));
    for (const Choice& choice : kChoices) {
        if (choice.direction != horizontal) ImGui::SameLine(0, gap);
        if (ui.choice(choice.name, direction == choice.direction, choice.hint, each)) direction = choice.direction;
    }
    ImGui::PopStyleVar();
}

}  // namespace

void lettering_panel(Session& s) {
    if (s.tools.active != Tool::text || !s.paint_thread) return;
    Ui& ui = s.ui;
    Lettering& l = s.tools.lettering;
    begin_panel_over(ui, s.view.area,
                     {.name = "Write", .width = ui.px(kLetteringWidth), .has_bar = true, .moves = true});
    ImGui::BeginDisabled(s.reported.file.viewing);
    text_field(ui, l, ImGui::IsWindowAppearing() && l.wanted.text.empty() && !s.reported.file.viewing);
    style_row(ui, l);
    direction_row(ui, l.direction);
    if (l.wanted.like.empty()) source_row(ui, l, s.dialogs.file);
    copy_row(s, l);
    const bool brushed = !l.text || l.text->style.kind == writer::HandKind::brush;
    if (!l.wanted.glyphs.empty() && l.wanted.like.empty() && brushed)
        ui.toggle("To their outlines", l.wanted.fit,
                  "Strokes are fitted until their ink covers the outlines that the source states; filled characters of "
                  "a font become strokes");
    ui.toggle("Snap", s.tools.place.snaps,
              "To the plane of symmetry and level with other drawings; Ctrl places it freely");
    ImGui::SameLine();
    ui.toggle("In mm", s.tools.place.has_fields, "Place in millimetres");
    if (s.tools.place.has_fields) place_fields(ui, s.tools);
    // Last: it comes and goes with the cursor over the model, and no button may move under a click.
    if (l.text && l.text->kept_filled > 0)
        ui.note(ui.sentence(
            Message("Characters that stay filled, too large, too heavy or too intricate for strokes of a brush: {}",
                    l.text->kept_filled)));
    fault_line(ui, l.fault.empty() ? s.tools.place.fault : l.fault);
    ImGui::EndDisabled();
    ImGui::End();
}

}  // namespace tuft::app
