#include <imgui.h>

#include <algorithm>

#include "app/panels/panels.h"
#include "app/widgets/icons.h"

namespace tuft::app {
namespace {

void file_menu(const MenuParts& s, MenuChoice& chosen) {
    if (!s.ui.begin_menu("File")) return;
    const bool ready = s.work != nullptr;
    if (s.ui.menu_item("Open...", name_of(s.keys.chord(Action::open)).c_str()))
        s.dialogs.file.show(FileDialog::Purpose::open, {});
    if (s.ui.menu_item("Save as...", name_of(s.keys.chord(Action::save)).c_str(), false, ready))
        s.dialogs.file.show(FileDialog::Purpose::save, project_name(s.work, s.reported.file.project) + ".tuft");
    if (s.ui.menu_item("Export...", name_of(s.keys.chord(Action::export_to)).c_str(), false, ready))
        s.dialogs.show_export = true;
    if (s.ui.menu_item("Decal sheets...", nullptr, false, ready)) s.dialogs.show_decals = true;
    s.ui.hint("Lays what is painted flat at true size, to be printed and cut");
    if (s.ui.menu_item("Film...", nullptr, false, ready)) s.dialogs.show_film = true;
    s.ui.hint("Films how it was painted, stroke by stroke");
    if (s.ui.menu_item("Revised model...", nullptr, false, ready))
        s.dialogs.file.show(FileDialog::Purpose::revise, s.work->source());
    if (s.has_former_model && s.ui.menu_item("Back to the former model", nullptr, false, ready))
        chosen = MenuChoice::former_model;
    ImGui::Separator();
    if (s.ui.menu_item("Close model", nullptr, false, ready)) chosen = MenuChoice::close_model;
    if (s.ui.menu_item("Quit", name_of(s.keys.chord(Action::quit)).c_str())) chosen = MenuChoice::quit;
    ImGui::EndMenu();
}

void edit_menu(const MenuParts& s) {
    if (!s.ui.begin_menu("Edit")) return;
    if (s.ui.menu_item("Undo", name_of(s.keys.chord(Action::undo)).c_str(), false, s.reported.document.can_undo) &&
        s.work)
        s.work->post(UndoStroke{});
    if (s.ui.menu_item("Redo", name_of(s.keys.chord(Action::redo)).c_str(), false, s.reported.document.can_redo) &&
        s.work)
        s.work->post(RedoStroke{});
    ImGui::Separator();
    if (s.ui.menu_item("Recolour...", nullptr, false, s.work != nullptr)) s.panels.show_appearance = true;
    s.ui.hint("Shows what is painted in other inks, or on another material, without painting it anew");
    if (s.ui.menu_item("Settings...")) s.dialogs.show_settings = true;
    ImGui::EndMenu();
}

void view_menu(const MenuParts& s, MenuChoice& chosen) {
    if (!s.ui.begin_menu("View")) return;
    Orbit& o = s.view.orbit;
    if (s.ui.menu_item("Frame all", name_of(s.keys.chord(Action::frame_all)).c_str()) && s.work)
        o.frame(s.work->model().mesh->bounds);
    if (s.ui.menu_item("Front", name_of(s.keys.chord(Action::front)).c_str())) o.look_from(StandardView::front);
    if (s.ui.menu_item("Back", name_of(s.keys.chord(Action::back)).c_str())) o.look_from(StandardView::back);
    if (s.ui.menu_item("Right", name_of(s.keys.chord(Action::right)).c_str())) o.look_from(StandardView::right);
    if (s.ui.menu_item("Left", name_of(s.keys.chord(Action::left)).c_str())) o.look_from(StandardView::left);
    if (s.ui.menu_item("Top", name_of(s.keys.chord(Action::top)).c_str())) o.look_from(StandardView::top);
    if (s.ui.menu_item("Bottom", name_of(s.keys.chord(Action::bottom)).c_str())) o.look_from(StandardView::bottom);
    ImGui::Separator();
    if (s.ui.menu_item("Parallel projection", name_of(s.keys.chord(Action::parallel)).c_str(), o.parallel))
        o.set_parallel(!o.parallel);
    if (s.ui.menu_item("Atlas beside the model", name_of(s.keys.chord(Action::atlas)).c_str(), s.view.atlas.shown))
        s.view.atlas.shown = !s.view.atlas.shown;
    if (!s.panels.journal_fits &&
        s.ui.menu_item("Journal and layers", nullptr, s.panels.journal_over_tools, s.work != nullptr))
        s.panels.journal_over_tools = !s.panels.journal_over_tools;
    if (s.ui.menu_item("Palette", name_of(s.keys.chord(Action::palette)).c_str(), s.palette.shown, s.work != nullptr))
        show_palette(s.palette, s.brush, s.status, !s.palette.shown);
    if (s.ui.menu_item("Force-feedback arm", name_of(s.keys.chord(Action::arm)).c_str(), s.arm.shown,
                       s.work != nullptr))
        s.arm.shown = !s.arm.shown;
    if (s.ui.menu_item("Settings of the tools", nullptr, s.panels.show_tools, s.work != nullptr))
        s.panels.show_tools = !s.panels.show_tools, chosen = MenuChoice::store_settings;
    if (s.ui.menu_item("Journal", nullptr, s.panels.show_journal, s.work != nullptr && s.panels.journal_fits))
        s.panels.show_journal = !s.panels.show_journal, chosen = MenuChoice::store_settings;
    if (s.ui.menu_item("Fold the panels", name_of(s.keys.chord(Action::panels)).c_str(), false, s.work != nullptr))
        chosen = MenuChoice::fold_panels;
    if (s.ui.menu_item("See through the brush", name_of(s.keys.chord(Action::see_through)).c_str(), s.view.see_through))
        s.view.see_through = !s.view.see_through;
    if (s.ui.menu_item("Side view of the tuft", nullptr, s.view.show_tuft_inset))
        s.view.show_tuft_inset = !s.view.show_tuft_inset;
    ImGui::EndMenu();
}

// Changes to the other language; its name is in that language.
void language_button(const MenuParts& s, MenuChoice& chosen) {
    Ui& ui = s.ui;
    const bool english = ui.settings().language == Language::english;
    // Without a font for them the characters are drawn.
    const float height = 0.8f * ImGui::GetFontSize(), width = ui.px(64);
    const bool drawn = english && !ui.has_chinese;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Button(drawn     ? "##language"
                      : english ? "\xe4\xb8\xad\xe6\x96\x87##language"
                                : "English##language",
                      ImVec2(width, 0))) {
        chosen = MenuChoice::other_language;
    }
    ui.mark("Language button");
    if (drawn)
        draw_zhongwen(ImGui::GetWindowDrawList(),
                      ImVec2(at.x + 0.5f * (width - 2.2f * height), at.y + 0.5f * (ImGui::GetFrameHeight() - height)),
                      height, ui.strong);
}

void shading_combo(const MenuParts& s) {
    static const std::vector<std::string> names{"Glaze",   "Clay",       "Flat colour", "Ink height",
                                                "Wetness", "Texel grid", "Charts",      "Stretch"};
    // On the bar, which a light theme makes as grey as a field.
    ImGui::PushStyleColor(ImGuiCol_FrameBg, ImGui::GetStyleColorVec4(ImGuiCol_Button));
    std::string name = names[static_cast<std::size_t>(s.view.shading)];
    if (s.ui.combo("Shading", name, names, 130))
        s.view.shading = static_cast<ModelView>(std::find(names.begin(), names.end(), name) - names.begin());
    s.ui.hint("How the model is shown");
    static const std::vector<std::string> rigs{"Studio light", "Window light", "Raking light"};
    std::string rig = rigs[static_cast<std::size_t>(s.view.rig)];
    if (s.ui.combo("Light", rig, rigs, 140))
        s.view.rig = static_cast<render::LightRig>(std::find(rigs.begin(), rigs.end(), rig) - rigs.begin());
    s.ui.hint("Raking light shows the relief of the ink");
    ImGui::PopStyleColor();
}

}  // namespace

MenuChoice menu_bar(const MenuParts& s) {
    MenuChoice chosen = MenuChoice::none;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(s.ui.px(8), s.ui.px(6)));
    if (ImGui::BeginMainMenuBar()) {
        file_menu(s, chosen);
        edit_menu(s);
        view_menu(s, chosen);
        if (s.ui.begin_menu("Help")) {
            if (s.ui.menu_item("Manual")) s.panels.help.manual = true;
            if (s.ui.menu_item("The first minute, step by step", nullptr, s.panels.help.step >= 0, s.work != nullptr))
                start_guide(s.panels.help);
            if (s.ui.menu_item("Keys and mouse", name_of(s.keys.chord(Action::keys)).c_str()))
                s.dialogs.show_keys = true;
            if (s.ui.menu_item("About tuft studio")) s.dialogs.show_about = true;
            ImGui::EndMenu();
        }
        if (s.work) {
            const std::string name =
                project_name(s.work, s.reported.file.project) + (s.reported.file.viewing ? s.ui.tr(" (a view)") : "");
            const float width = ImGui::GetWindowWidth();
            const float text = ImGui::CalcTextSize(name.c_str()).x,
                        x = std::max(0.5f * (width - text), ImGui::GetCursorPosX() + s.ui.px(8));
            if (x + text < width - s.ui.px(130 + 140 + 34 + 72)) {
                ImGui::SetCursorPosX(x);
                ImGui::TextUnformatted(name.c_str());
            }
        }
        ImGui::SetCursorPosX(ImGui::GetWindowWidth() - s.ui.px((s.work ? 130 + 140 + 16 : 0) + 64 + 12));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(s.ui.px(8), s.ui.px(2)));
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() + s.ui.px(3));
        if (s.work) shading_combo(s);
        language_button(s, chosen);
        ImGui::PopStyleVar();
        ImGui::EndMainMenuBar();
    }
    ImGui::PopStyleVar();
    return chosen;
}

}  // namespace tuft::app
