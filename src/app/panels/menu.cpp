#include <imgui.h>

#include <algorithm>

#include "app/panels/panels.h"
#include "app/widgets/icons.h"

namespace tuft::app {
namespace {

void file_menu(Session& s) {
    if (!s.ui.begin_menu("File")) return;
    const bool ready = s.painter != nullptr;
    if (s.ui.menu_item("Open...", name_of(s.keys.chord(Act::open)).c_str()))
        s.files.show(FileDialog::Purpose::open, {});
    if (s.ui.menu_item("Save as...", name_of(s.keys.chord(Act::save)).c_str(), false, ready))
        s.files.show(FileDialog::Purpose::save, project_name(s) + ".tuft");
    if (s.ui.menu_item("Export...", name_of(s.keys.chord(Act::export_to)).c_str(), false, ready)) s.show_export = true;
    if (s.ui.menu_item("Revised model...", nullptr, false, ready))
        s.files.show(FileDialog::Purpose::revise, s.painter->source());
    if (!s.former.empty() && s.ui.menu_item("Back to the former model", nullptr, false, ready)) open_former(s);
    ImGui::Separator();
    if (s.ui.menu_item("Close model", nullptr, false, ready)) leave(s, {Leaving::To::close, {}});
    if (s.ui.menu_item("Quit", name_of(s.keys.chord(Act::quit)).c_str())) leave(s, {});
    ImGui::EndMenu();
}

void edit_menu(Session& s) {
    if (!s.ui.begin_menu("Edit")) return;
    if (s.ui.menu_item("Undo", name_of(s.keys.chord(Act::undo)).c_str(), false, s.last.can_undo) && s.painter)
        s.painter->post(UndoStroke{});
    if (s.ui.menu_item("Redo", name_of(s.keys.chord(Act::redo)).c_str(), false, s.last.can_redo) && s.painter)
        s.painter->post(RedoStroke{});
    ImGui::Separator();
    if (s.ui.menu_item("Recolour...", nullptr, false, s.painter != nullptr)) s.show_colours = true;
    s.ui.hint("Shows what is painted in other inks, or on another material, without painting it anew");
    if (s.ui.menu_item("Settings...")) s.show_settings = true;
    ImGui::EndMenu();
}

void view_menu(Session& s) {
    if (!s.ui.begin_menu("View")) return;
    Orbit& o = s.view.orbit;
    if (s.ui.menu_item("Frame all", name_of(s.keys.chord(Act::frame_all)).c_str()) && s.painter)
        o.frame(s.painter->model().mesh->bounds);
    if (s.ui.menu_item("Front", name_of(s.keys.chord(Act::front)).c_str())) o.look_from(StandardView::front);
    if (s.ui.menu_item("Back", name_of(s.keys.chord(Act::back)).c_str())) o.look_from(StandardView::back);
    if (s.ui.menu_item("Right", name_of(s.keys.chord(Act::right)).c_str())) o.look_from(StandardView::right);
    if (s.ui.menu_item("Left", name_of(s.keys.chord(Act::left)).c_str())) o.look_from(StandardView::left);
    if (s.ui.menu_item("Top", name_of(s.keys.chord(Act::top)).c_str())) o.look_from(StandardView::top);
    if (s.ui.menu_item("Bottom", name_of(s.keys.chord(Act::bottom)).c_str())) o.look_from(StandardView::bottom);
    ImGui::Separator();
    if (s.ui.menu_item("Parallel projection", name_of(s.keys.chord(Act::parallel)).c_str(), o.parallel))
        o.set_parallel(!o.parallel);
    if (s.ui.menu_item("Atlas beside the model", name_of(s.keys.chord(Act::atlas)).c_str(), s.view.atlas))
        s.view.atlas = !s.view.atlas;
    if (!s.journal_fits && s.ui.menu_item("Journal and layers", nullptr, s.show_journal, s.painter != nullptr))
        s.show_journal = !s.show_journal;
    if (s.ui.menu_item("Palette", name_of(s.keys.chord(Act::palette)).c_str(), s.palette.shown, s.painter != nullptr))
        show_palette(s, !s.palette.shown);
    if (s.ui.menu_item("Settings of the tools", nullptr, s.tools_shown, s.painter != nullptr))
        s.tools_shown = !s.tools_shown, store_settings(s);
    if (s.ui.menu_item("Journal", nullptr, s.journal_shown, s.painter != nullptr && s.journal_fits))
        s.journal_shown = !s.journal_shown, store_settings(s);
    if (s.ui.menu_item("Fold the panels", name_of(s.keys.chord(Act::panels)).c_str(), false, s.painter != nullptr))
        fold_panels(s);
    if (s.ui.menu_item("See through the brush", name_of(s.keys.chord(Act::see_through)).c_str(), s.view.see_through))
        s.view.see_through = !s.view.see_through;
    if (s.ui.menu_item("Side view of the tuft", nullptr, s.view.inset)) s.view.inset = !s.view.inset;
    ImGui::EndMenu();
}

// Changes to the other language; its name is in that language.
void language_button(Session& s) {
    Ui& ui = s.ui;
    const bool english = s.wanted.language == Language::english;
    // Without a font for them the characters are drawn.
    const float height = 0.8f * ImGui::GetFontSize(), width = ui.px(64);
    const bool drawn = english && !ui.has_chinese;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Button(drawn     ? "##language"
                      : english ? "\xe4\xb8\xad\xe6\x96\x87##language"
                                : "English##language",
                      ImVec2(width, 0))) {
        s.wanted.language = english ? Language::chinese : Language::english;
        s.restyle = true;
        store_settings(s);
    }
    ui.mark("Language button");
    if (drawn)
        draw_zhongwen(ImGui::GetWindowDrawList(),
                      ImVec2(at.x + 0.5f * (width - 2.2f * height), at.y + 0.5f * (ImGui::GetFrameHeight() - height)),
                      height, ui.strong);
}

void shading_combo(Session& s) {
    static const std::vector<std::string> names{"Glaze",   "Clay",       "Flat colour", "Ink height",
                                                "Wetness", "Texel grid", "Charts",      "Stretch"};
    std::string name = names[static_cast<std::size_t>(s.view.shown)];
    if (s.ui.combo("Shading", name, names, 130))
        s.view.shown = static_cast<ModelView>(std::find(names.begin(), names.end(), name) - names.begin());
    s.ui.hint("How the model is shown");
    static const std::vector<std::string> rigs{"Studio light", "Window light", "Raking light"};
    std::string rig = rigs[static_cast<std::size_t>(s.view.rig)];
    if (s.ui.combo("Light", rig, rigs, 140))
        s.view.rig = static_cast<render::LightRig>(std::find(rigs.begin(), rigs.end(), rig) - rigs.begin());
    s.ui.hint("Raking light shows the relief of the ink");
}

}  // namespace

void menu_bar(Session& s) {
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(s.ui.px(8), s.ui.px(6)));
    if (ImGui::BeginMainMenuBar()) {
        file_menu(s);
        edit_menu(s);
        view_menu(s);
        if (s.ui.begin_menu("Help")) {
            if (s.ui.menu_item("Manual")) s.help.manual = true;
            if (s.ui.menu_item("The first minute, step by step", nullptr, s.help.step >= 0, s.painter != nullptr))
                start_guide(s);
            if (s.ui.menu_item("Keys and mouse", name_of(s.keys.chord(Act::keys)).c_str())) s.show_keys = true;
            if (s.ui.menu_item("About tuft studio")) s.show_about = true;
            ImGui::EndMenu();
        }
        if (s.painter) {
            const std::string name = project_name(s) + (s.last.viewing ? s.ui.tr(" (a view)") : "");
            const float width = ImGui::GetWindowWidth();
            const float text = ImGui::CalcTextSize(name.c_str()).x,
                        x = std::max(0.5f * (width - text), ImGui::GetCursorPosX() + s.ui.px(8));
            if (x + text < width - s.ui.px(130 + 140 + 34 + 72)) {
                ImGui::SetCursorPosX(x);
                ImGui::TextUnformatted(name.c_str());
            }
        }
        ImGui::SetCursorPosX(ImGui::GetWindowWidth() - s.ui.px((s.painter ? 130 + 140 + 16 : 0) + 64 + 12));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(s.ui.px(8), s.ui.px(2)));
        ImGui::SetCursorPosY(ImGui::GetCursorPosY() + s.ui.px(3));
        if (s.painter) shading_combo(s);
        language_button(s);
        ImGui::PopStyleVar();
        ImGui::EndMainMenuBar();
    }
    ImGui::PopStyleVar();
}

}  // namespace tuft::app
