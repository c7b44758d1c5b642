#include <imgui.h>

#include <algorithm>
#include <cctype>

#include "app/dialogs/dialogs.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

// What a sample is called; a project is called as its file is.
std::string title_of(const fs::path& file, const Ui& ui) {
    std::string name = file.stem().string();
    if (file.extension() == ".tuft") return name;
    std::replace(name.begin(), name.end(), '_', ' ');
    if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
    return ui.tr(name.c_str());
}

// A card with a picture and a name below; true when it was pressed.
bool card(Session& s, const fs::path& file, const std::string& name, float width) {
    const float height = width * Pictures::kHeight / Pictures::kWidth, text = s.ui.px(26);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushID(file.c_str());
    const bool pressed = ImGui::InvisibleButton("card", ImVec2(width, height + text));
    s.ui.mark(name);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const bool over = ImGui::IsItemHovered();
    const float round = s.ui.px(5);
    draw->AddRectFilled(at, ImVec2(at.x + width, at.y + height + text),
                        ImGui::GetColorU32(over ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg), round);
    const unsigned texture = s.project.start_page.pictures.texture(file);
    if (texture)
        draw->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture)), at,
                              ImVec2(at.x + width, at.y + height), ImVec2(0, 0), ImVec2(1, 1), IM_COL32_WHITE, round,
                              ImDrawFlags_RoundCornersTop);
    else
        draw->AddRectFilled(at, ImVec2(at.x + width, at.y + height), IM_COL32(120, 120, 124, 40), round,
                            ImDrawFlags_RoundCornersTop);
    const ImVec2 size = ImGui::CalcTextSize(name.c_str());
    draw->PushClipRect(at, ImVec2(at.x + width, at.y + height + text), true);
    draw->AddText(ImVec2(at.x + std::max(s.ui.px(6), 0.5f * (width - size.x)), at.y + height + 0.5f * (text - size.y)),
                  s.ui.strong, name.c_str());
    draw->PopClipRect();
    if (over) ImGui::SetTooltip("%s", file.c_str());
    ImGui::PopID();
    return pressed;
}

fs::path cards(Session& s, const std::vector<fs::path>& files, float width, std::size_t columns, std::size_t most) {
    fs::path chosen;
    for (std::size_t i = 0; i < std::min(most, files.size()); ++i) {
        if (i % columns) ImGui::SameLine();
        if (card(s, files[i], title_of(files[i], s.ui), width)) chosen = files[i];
    }
    return chosen;
}

}  // namespace

void welcome(Session& s) {
    Ui& ui = s.ui;
    if (!s.project.opening.running() && !s.project.inspected) s.project.start_page.pictures.resume();
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const float top = ImGui::GetFrameHeight() + ui.px(6);
    ImGui::SetNextWindowPos(ImVec2(0, top));
    ImGui::SetNextWindowSize(ImVec2(screen.x, screen.y - top));
    const float side = std::max(ui.px(24), 0.5f * (screen.x - ui.px(1000)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(side, ui.px(22)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("###welcome", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleVar(3);
    ImGui::PushFont(ui.large);
    ImGui::TextUnformatted("tuft studio");
    ImGui::PopFont();
    ui.note(ui.tr("Drop a model or a project anywhere on this window, or open one."));
    if (ui.primary_button("Open...", 130)) s.dialogs.file.show(FileDialog::Purpose::open, {});
    if (!s.status.text.empty()) {
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        ui.wrapped(ui.sentence(s.status.text));
    }
    fs::path chosen;
    const float width_all = ImGui::GetContentRegionAvail().x, gap = ImGui::GetStyle().ItemSpacing.x;
    const auto columns = static_cast<std::size_t>(std::max(2.0f, (width_all + gap) / (ui.px(188) + gap)));
    const float width = (width_all - static_cast<float>(columns - 1) * gap) / static_cast<float>(columns);
    if (!s.project.start_page.recent.empty()) {
        ui.heading("Recent projects");
        chosen = cards(s, s.project.start_page.recent, width, columns, columns);
    }
    ui.heading("Samples");
    const fs::path sample = cards(s, s.project.start_page.samples, width, columns, 24);
    ImGui::End();
    if (!sample.empty()) open_sample(s, sample);
    if (!chosen.empty()) open_path(s, chosen);
}

}  // namespace tuft::app
