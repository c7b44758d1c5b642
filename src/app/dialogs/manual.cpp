#include <imgui.h>

#include <algorithm>
#include <sstream>

#include "app/dialogs/dialogs.h"
#include "app/text/texts.h"
#include "app/widgets/manual_text.h"

/// The manual's dialog.
namespace tuft::app {

void manual_dialog(Ui& ui, HelpState& help, DialogState& dialogs, const KeyTable& keys) {
    if (!help.manual) return;
    if (!begin_dialog(ui, "Manual", 760)) return end_dialog(ui);
    const Language language = ui.settings().language;
    const auto pages = manual_pages();
    help.page = std::min(help.page, pages.size() - 1);
    const float height = std::min(ui.px(400), ImGui::GetIO().DisplaySize.y - ui.px(130));
    ImGui::BeginChild("pages", ImVec2(ui.px(200), height));
    for (std::size_t i = 0; i < pages.size(); ++i) {
        const char* title = language == Language::chinese ? chinese_manual_text(pages[i].title) : pages[i].title;
        if (ImGui::Selectable(title, help.page == i)) help.page = i;
        ui.mark(std::string("page ") + pages[i].title);
    }
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("text", ImVec2(0, height));
    std::istringstream lines(manual_text(pages[help.page], language, keys));
    for (std::string line; std::getline(lines, line);) {
        const bool point = line.starts_with("* ");
        if (point) {
            ImGui::Bullet();
            ImGui::SameLine();
        }
        ui.wrapped(point ? line.substr(2) : line);
    }
    ImGui::EndChild();
    ui.buttons_at_right({{"Keys and mouse", 120}, {"Close", 110}});
    if (ui.button("Keys and mouse", nullptr, 120)) dialogs.show_keys = true;
    ImGui::SameLine();
    const bool close = ui.button("Close", nullptr, 110);
    end_dialog(ui);
    if (close) help.manual = false;
}

}  // namespace tuft::app
