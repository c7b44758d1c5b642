#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>

#include "app/dialogs/dialogs.h"
#include "core/files/files.h"
#include "core/system/build_facts.h"

/// \file
/// The About dialog: what the program is, under which licence, and what it is made of.
namespace tuft::app {
namespace {

std::string gl_text(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "";
}

// Name and value of what a report of a fault should say.
std::vector<std::pair<const char*, std::string>> facts_now() {
    const BuildFacts& b = build_facts();
    return {{"Version", b.version + " (" + b.released + ")" + (b.commit.empty() ? "" : ", " + b.commit)},
            {"Licence", "MIT; with CGAL under GPL-3.0-or-later"},
            {"System", b.system},
            {"Compiler", b.compiler + ", " + b.build_type},
            {"Graphics", gl_text(GL_RENDERER)},
            {"OpenGL", gl_text(GL_VERSION)},
            {"Data", data_folder().string()}};
}

std::string as_text() {
    std::string text = "tuft studio\n";
    for (const auto& [name, value] : facts_now()) text += std::string(name) + ": " + value + "\n";
    for (const auto& [name, version] : build_facts().libraries) text += name + " " + version + "\n";
    return text;
}

void fact_rows(Ui& ui) {
    for (const auto& [name, value] : facts_now()) {
        ImGui::TextDisabled("%s", ui.tr(name));
        ImGui::SameLine(ui.px(110));
        ui.wrapped(value);
    }
}

// In three columns, read downward.
void library_rows(Ui& ui) {
    constexpr std::size_t kColumns = 3;
    const auto& libraries = build_facts().libraries;
    const std::size_t rows = (libraries.size() + kColumns - 1) / kColumns;
    const float width = ImGui::GetContentRegionAvail().x / kColumns;
    const float left = ImGui::GetCursorPosX();
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < kColumns; ++column) {
            const std::size_t i = column * rows + row;
            if (i >= libraries.size()) continue;
            if (column > 0) ImGui::SameLine(left + static_cast<float>(column) * width);
            ImGui::Text("%s", libraries[i].first.c_str());
            ImGui::SameLine(0, ui.px(6));
            ImGui::TextDisabled("%s", libraries[i].second.c_str());
        }
}

}  // namespace

void about_dialog(Ui& ui, DialogState& dialogs) {
    if (!dialogs.show_about) return;
    if (!begin_dialog(ui, "About tuft studio", 560)) return end_dialog(ui);
    ui.wrapped(ui.tr("Ink and a bending hair brush on the surface of 3D models."));
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    fact_rows(ui);
    ui.heading("Libraries");
    library_rows(ui);
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    ui.buttons_at_right({{"Copy", 110}, {"Close", 110}});
    if (ui.button("Copy", "Puts all this on the clipboard, for a report", 110))
        ImGui::SetClipboardText(as_text().c_str());
    ImGui::SameLine();
    const bool close = ui.button("Close", nullptr, 110);
    end_dialog(ui);
    if (close) dialogs.show_about = false;
}

}  // namespace tuft::app
