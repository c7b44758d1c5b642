#include "app/panels/file_dialog.h"

#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/files.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string size_text(std::uintmax_t bytes) {
    char text[32];
    if (bytes < 1024 * 1024) std::snprintf(text, sizeof text, "%.0f kB", static_cast<double>(bytes) / 1024);
    else std::snprintf(text, sizeof text, "%.1f MB", static_cast<double>(bytes) / 1048576);
    return text;
}

}  // namespace

bool FileDialog::reads() const { return purpose_ != Purpose::save && purpose_ != Purpose::export_model && purpose_ != Purpose::save_ink; }

bool FileDialog::suits(const fs::path& file) const {
    const std::string e = lower(file.extension().string());
    if (purpose_ == Purpose::save) return e == ".tuft";
    if (purpose_ == Purpose::export_model) return e == ".glb" || e == ".gltf" || e == ".obj" || e == ".png" || e == ".exr" || e == ".inkml";
    if (purpose_ == Purpose::ink || purpose_ == Purpose::save_ink) return e == ".toml";
    if (purpose_ == Purpose::writing) return e == ".svg" || e == ".inkml";
    return (e == ".tuft" && purpose_ != Purpose::revise) || e == ".ply" || e == ".obj" || e == ".stl" || e == ".off" || e == ".glb" || e == ".gltf";
}

void FileDialog::show(Purpose purpose, const fs::path& start) {
    purpose_ = purpose;
    shown_ = true;
    ask_replace_ = false;
    std::error_code ec;
    const fs::path full = fs::absolute(start.empty() ? fs::current_path(ec) : start, ec);
    const bool is_folder = fs::is_directory(full, ec);
    extension_ = is_folder || reads() ? "" : full.extension().string();
    std::snprintf(name_, sizeof name_, "%s", is_folder ? "" : full.filename().c_str());
    go(is_folder ? full : full.parent_path());
}

void FileDialog::go(const fs::path& folder) {
    folder_ = folder.lexically_normal();
    read_folder();
}

void FileDialog::read_folder() {
    entries_.clear();
    fault_.clear();
    std::error_code ec;
    for (fs::directory_iterator it(folder_, fs::directory_options::skip_permission_denied, ec), end; !ec && it != end; it.increment(ec)) {
        std::error_code quiet;
        const std::string name = it->path().filename().string();
        if (name.starts_with('.')) continue;
        const bool is_folder = it->is_directory(quiet);
        if (!is_folder && !suits(it->path())) continue;
        const auto size = is_folder ? 0 : it->file_size(quiet);
        entries_.push_back({name, is_folder, quiet ? 0 : size});
    }
    if (ec) fault_ = "This folder cannot be read: " + ec.message();
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.folder != b.folder ? a.folder : lower(a.name) < lower(b.name);
    });
}

std::optional<fs::path> FileDialog::accept(Ui&) {
    std::error_code ec;
    fs::path path = fs::path(name_).is_absolute() ? fs::path(name_) : folder_ / name_;
    if (name_[0] == '~' && std::getenv("HOME")) path = std::string(std::getenv("HOME")) + (name_ + 1);
    if (fs::is_directory(path, ec)) {
        go(path);
        name_[0] = 0;
        return std::nullopt;
    }
    if (reads()) {
        if (!fs::exists(path, ec)) {
            fault_ = "There is no file of that name.";
            return std::nullopt;
        }
    } else {
        if (!suits(path)) path += extension_;
        if (::access(path.parent_path().c_str(), W_OK) != 0) {
            fault_ = "Nothing can be written into this folder.";
            return std::nullopt;
        }
        if (fs::exists(path, ec) && !ask_replace_) {
            ask_replace_ = true;
            return std::nullopt;
        }
    }
    shown_ = false;
    return path;
}

std::optional<fs::path> FileDialog::draw(Ui& ui) {
    if (!shown_) return std::nullopt;
    std::optional<fs::path> chosen;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * screen.x, 0.5f * screen.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(std::min(ui.px(680), screen.x - 20), std::min(ui.px(470), screen.y - 20)));
    static constexpr const char* titles[] = {"Open a model or project", "Save project as", "Export to", "Writing or drawing to place", "Revised model", "Open an ink", "Save the ink as"};
    const char* title = titles[static_cast<int>(purpose_)];
    ImGui::Begin((std::string(ui.tr(title)) + "###files").c_str(), nullptr,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    ImGui::BeginChild("places", ImVec2(ui.px(130), -ui.px(46)));
    ui.heading("Places");
    if (const char* home = std::getenv("HOME"); home && ImGui::Selectable(ui.tr("Home"))) go(home);
    if (ImGui::Selectable(ui.tr("Samples"))) go(data_folder() / (purpose_ == Purpose::writing ? "samples/strokes" : purpose_ == Purpose::ink ? "models/inks" : "models"));
    std::error_code ec;
    if (ImGui::Selectable(ui.tr("Here"))) go(fs::current_path(ec));
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginChild("list", ImVec2(0, -ui.px(46)));
    if (ui.button("Up") && folder_.has_parent_path()) go(folder_.parent_path());
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(folder_.c_str());
    ImGui::Separator();
    ImGui::BeginChild("entries");
    fs::path enter;
    for (const Entry& entry : entries_) {
        const std::string text = entry.folder ? entry.name + "/" : entry.name;
        if (ImGui::Selectable(text.c_str(), entry.name == name_, ImGuiSelectableFlags_AllowDoubleClick)) {
            if (entry.folder) enter = folder_ / entry.name;
            else std::snprintf(name_, sizeof name_, "%s", entry.name.c_str());
            ask_replace_ = false;
            if (!entry.folder && ImGui::IsMouseDoubleClicked(0)) chosen = accept(ui);
        }
        ui.mark(entry.name);
        if (entry.folder) continue;
        const std::string size = size_text(entry.size);
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(size.c_str()).x - ui.px(4));
        ImGui::TextDisabled("%s", size.c_str());
    }
    if (entries_.empty() && fault_.empty()) ImGui::TextDisabled("%s", ui.tr("Nothing here that can be opened."));
    ImGui::EndChild();
    ImGui::EndChild();
    if (!enter.empty()) go(enter);
    ImGui::Separator();
    if (!fault_.empty() || ask_replace_) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(ui.tr(ask_replace_ ? "Replace it?" : fault_.c_str()));
        ImGui::SameLine();
    }
    const float buttons = ui.px(2 * 100 + 16);
    ImGui::SetNextItemWidth(std::max(ui.px(80), ImGui::GetContentRegionAvail().x - buttons));
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputTextWithHint("##name", ui.tr("file name"), name_, sizeof name_, ImGuiInputTextFlags_EnterReturnsTrue);
    ui.mark("file name");
    ImGui::SameLine();
    const char* action = ask_replace_ ? "Replace" : reads() ? "Open" : purpose_ == Purpose::export_model ? "Export" : "Save";
    if (ui.button("Cancel", nullptr, 100)) shown_ = false;
    ImGui::SameLine();
    if ((ui.primary_button(action, 100, name_[0] != 0) || entered) && name_[0]) chosen = accept(ui);
    ImGui::End();
    return chosen;
}

}  // namespace tuft::app
