#include "app/widgets/file_dialog.h"

#include <imgui.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <tuple>
#include <utility>

#include "app/document/detached.h"
#include "app/document/pictures/state_folder.h"
#include "app/document/writing.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/files/system_message.h"
#include "io/model/read_model.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::size_t kRecentFolders = 6;
constexpr std::uintmax_t kMostSketched = 4 << 20;  // bytes of a drawing that is read for its preview
constexpr std::uintmax_t kMostDrawn = 40 << 20;    // bytes of a model that is drawn for its preview

bool is_one_of(const std::string& extension, std::initializer_list<const char*> known) {
    return std::any_of(known.begin(), known.end(), [&](const char* k) { return extension == k; });
}

// The end of a path that there is room for.
std::string path_end(const std::string& path, float width) {
    std::size_t from = 0;
    while (from < path.size() && ImGui::CalcTextSize(("..." + path.substr(from)).c_str()).x > width)
        from = std::min(path.find('/', from + 1), path.size());
    return from == 0 ? path : "..." + path.substr(from);
}

}  // namespace

std::vector<fs::path> recent_folders() {
    std::vector<fs::path> folders;
    std::ifstream in(state_folder() / "folders");
    std::error_code ec;
    for (std::string line; folders.size() < kRecentFolders && std::getline(in, line);)
        if (fs::is_directory(line, ec)) folders.emplace_back(line);
    return folders;
}

void remember_folder(const fs::path& folder) {
    std::string text = folder.string() + '\n';
    for (const fs::path& other : recent_folders())
        if (other != folder) text += other.string() + '\n';
    try {
        write_file(state_folder() / "folders", text.data(), text.size());
    } catch (const Error&) {
        // The list is older then.
    }
}

bool FileDialog::reads() const {
    constexpr Purpose kWrites[] = {Purpose::save,   Purpose::export_model, Purpose::save_ink,
                                   Purpose::decals, Purpose::film,         Purpose::save_copy};
    return std::find(std::begin(kWrites), std::end(kWrites), purpose_) == std::end(kWrites);
}

bool FileDialog::suits(const fs::path& file) const {
    const std::string e = lower(file.extension().string());
    if (purpose_ == Purpose::save) return e == ".tuft";
    if (purpose_ == Purpose::arm_recording) return e == ".csv";
    if (purpose_ == Purpose::export_model) return is_one_of(e, {".glb", ".gltf", ".obj", ".png", ".exr", ".inkml"});
    if (purpose_ == Purpose::ink || purpose_ == Purpose::save_ink || purpose_ == Purpose::brush) return e == ".toml";
    if (purpose_ == Purpose::decals) return is_one_of(e, {".pdf", ".svg", ".dxf"});
    if (purpose_ == Purpose::film) return is_one_of(e, {".mp4", ".gif"});
    if (purpose_ == Purpose::writing) return is_one_of(e, {".svg", ".inkml"});
    if (purpose_ == Purpose::glyphs)
        return is_one_of(e, {".json", ".svg", ".txt", ".ttf", ".otf", ".ttc", ".woff", ".woff2"});
    if (purpose_ == Purpose::save_copy) return e == ".json";
    if (purpose_ == Purpose::reference || purpose_ == Purpose::copied_picture)
        return is_one_of(e, {".png", ".jpg", ".jpeg", ".exr", ".tif", ".tiff"});
    return (e == ".tuft" && purpose_ != Purpose::revise) || io::is_model_file(file);
}

void FileDialog::show(Purpose purpose, const fs::path& start) {
    purpose_ = purpose;
    shown_ = true;
    ask_replace_ = new_folder_.shown = false;
    listing_.filter[0] = 0;
    std::error_code ec;
    const std::vector<fs::path> recent = recent_folders();
    const fs::path usual = recent.empty() ? fs::current_path(ec) : recent.front();
    const fs::path full = start.empty() ? usual : start.has_parent_path() ? fs::absolute(start, ec) : usual / start;
    const bool is_folder = fs::is_directory(full, ec);
    name_.extension = is_folder || reads() ? "" : full.extension().string();
    choose_name(is_folder ? "" : full.filename().string());
    name_.take_focus = name_.select_stem = true;
    go(is_folder ? full : full.parent_path());
}

void FileDialog::return_with(const fs::path& path, const Message& fault) {
    if (!last_ || last_->path != path) return;
    const Chosen last = *last_;
    show(last.purpose, last.path);
    refuse(fault);
}

void FileDialog::choose_name(const std::string& name) {
    std::snprintf(name_.text, sizeof name_.text, "%s", name.c_str());
    ask_replace_ = false;
}

// The name stays to be mended, and the keyboard with it.
void FileDialog::refuse(const Message& why) {
    fault_ = why;
    name_.take_focus = name_.select_stem = true;
}

void FileDialog::go(const fs::path& folder) {
    if (folder_ != folder.lexically_normal()) {  // a disk that does not answer holds up no other folder
        wait_briefly(sketch_.reading);
        sketch_ = {};
    }
    folder_ = folder.lexically_normal();
    read_folder();
}

void FileDialog::read_folder() {
    Message fault;
    listing_.entries = list_folder(
        folder_, [this](const fs::path& file) { return suits(file); }, fault);
    fault_ = fault.empty() ? Message() : Message("This folder cannot be read: {}", fault);
    sort_entries(listing_.entries, listing_.order, listing_.downward);
}

std::optional<fs::path> FileDialog::accept() {
    std::error_code ec;
    fs::path path = fs::path(name_.text).is_absolute() ? fs::path(name_.text) : folder_ / name_.text;
    if (name_.text[0] == '~' && std::getenv("HOME")) path = std::string(std::getenv("HOME")) + (name_.text + 1);
    if (fs::is_directory(path, ec)) {
        go(path);
        choose_name("");
        return std::nullopt;
    }
    if (reads()) {
        if (!fs::exists(path, ec)) {
            if (!ec || ec.value() == ENOENT) return refuse("There is no file of that name."), std::nullopt;
            return refuse(Message("This file cannot be read: {}", system_message(ec))), std::nullopt;
        }
    } else {
        if (!suits(path)) path += name_.extension;
        if (!fs::is_directory(path.parent_path(), ec)) return refuse("There is no folder of that name."), std::nullopt;
        if (::access(path.parent_path().c_str(), W_OK) != 0)
            return refuse("Nothing can be written into this folder."), std::nullopt;
        if (fs::is_directory(path, ec)) return refuse("There is a folder of that name."), std::nullopt;
        if (fs::exists(path, ec) && !ask_replace_) {
            ask_replace_ = true;
            fault_ = {};
            return std::nullopt;
        }
    }
    shown_ = false;
    remember_folder(fs::absolute(path, ec).parent_path());
    last_ = Chosen{path, purpose_};
    return path;
}

void FileDialog::draw_places(Ui& ui) {
    ui.heading("Places");
    if (const char* home = std::getenv("HOME"); home && ImGui::Selectable(ui.tr("Home"))) go(home);
    if (ImGui::Selectable(ui.tr("Samples")))
        go(data_folder() / (purpose_ == Purpose::writing ? "samples/strokes"
                            : purpose_ == Purpose::ink   ? "models/inks"
                            : purpose_ == Purpose::brush ? "models/brushes"
                                                         : "models"));
    std::error_code ec;
    if (ImGui::Selectable(ui.tr("Here"))) go(fs::current_path(ec));
    const std::vector<fs::path> recent = recent_folders();
    if (recent.empty()) return;
    ui.heading("Recent folders");
    for (const fs::path& folder : recent) {
        ImGui::PushID(folder.c_str());
        const std::string name = folder.filename().empty() ? folder.string() : folder.filename().string();
        if (ImGui::Selectable(ui.fitted(name, ImGui::GetContentRegionAvail().x).c_str())) go(folder);
        ui.mark("folder " + name);
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", folder.c_str());
        ImGui::PopID();
    }
}

void FileDialog::make_folder(Ui& ui) {
    ImGui::SetNextItemWidth(ui.px(200));
    const bool entered = ImGui::InputTextWithHint("##folder", ui.tr("name of the new folder"), new_folder_.name,
                                                  sizeof new_folder_.name, ImGuiInputTextFlags_EnterReturnsTrue);
    ui.mark("name of the new folder");
    ImGui::SameLine();
    const bool made = ui.button("Make it", nullptr, 0, new_folder_.name[0] != 0);
    if (!(entered || made) || !new_folder_.name[0]) return;
    std::error_code ec;
    const fs::path folder = folder_ / new_folder_.name;
    if (!fs::create_directory(folder, ec)) {
        fault_ = ec ? Message("The folder cannot be made: {}", system_message(ec))
                    : Message("There is a folder of that name.");
        return;
    }
    new_folder_.shown = false;
    go(folder);
    name_.take_focus = true;
}

// Where one is, a filter, and a new folder.
void FileDialog::draw_top(Ui& ui) {
    if (ui.button("Up") && folder_.has_parent_path()) go(folder_.parent_path());
    ImGui::SameLine();
    const float right = ui.button_width("New folder", 100) + ui.px(140) + 3 * ImGui::GetStyle().ItemSpacing.x;
    ImGui::AlignTextToFramePadding();
    const float room = ImGui::GetContentRegionAvail().x - right, start = ImGui::GetCursorPosX();
    ImGui::TextUnformatted(path_end(folder_.string(), room).c_str());
    ImGui::SameLine(start + room + ImGui::GetStyle().ItemSpacing.x);
    ImGui::SetNextItemWidth(ui.px(140));
    ImGui::InputTextWithHint("##filter", ui.tr("filter"), listing_.filter, sizeof listing_.filter);
    ui.mark("filter");
    ImGui::SameLine();
    if (ui.choice("New folder", new_folder_.shown, nullptr, 100)) {
        new_folder_.shown = !new_folder_.shown;
        new_folder_.name[0] = 0;
    }
    if (new_folder_.shown) make_folder(ui);
}

// True when a file was clicked twice.
bool FileDialog::draw_list(Ui& ui, float width) {
    const float letter = ImGui::CalcTextSize("0").x, dates = 17 * letter, sizes = 9 * letter;
    ImGui::BeginChild("list", ImVec2(width, 0));
    const float all = ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ScrollbarSize;
    const std::tuple<FileOrder, const char*, float, float> columns[] = {
        {FileOrder::name, "Name", 0, all - dates - sizes},
        {FileOrder::size, "Size", all - dates - sizes, sizes},
        {FileOrder::date, "Changed", all - dates, dates}};
    for (const auto& [order, name, from, wide] : columns) {
        if (from > 0) ImGui::SameLine(from);
        const std::string text =
            std::string(ui.tr(name)) +
            (listing_.order == order ? listing_.downward ? " \xe2\x86\x93" : " \xe2\x86\x91" : "") + "##" + name;
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        if (ImGui::Selectable(text.c_str(), false, 0, ImVec2(wide, 0))) {
            listing_.downward = listing_.order == order && !listing_.downward;
            listing_.order = order;
            sort_entries(listing_.entries, listing_.order, listing_.downward);
        }
        ImGui::PopStyleColor();
        ui.mark(std::string("by ") + name);
    }
    ImGui::Separator();
    ImGui::BeginChild("entries");
    fs::path enter;
    bool twice = false, any = false;
    for (const FileEntry& entry : listing_.entries) {
        if (listing_.filter[0] && !matches_filter(entry.name, listing_.filter)) continue;
        any = true;
        const std::string text = ui.fitted(entry.folder ? entry.name + "/" : entry.name, all - dates - sizes - letter);
        ImGui::PushID(entry.name.c_str());
        if (ImGui::Selectable(text.c_str(), entry.name == name_.text, ImGuiSelectableFlags_AllowDoubleClick)) {
            if (entry.folder)
                enter = folder_ / entry.name;
            else
                choose_name(entry.name), fault_ = {};
            twice = twice || (!entry.folder && ImGui::IsMouseDoubleClicked(0));
        }
        ImGui::PopID();
        ui.mark(entry.name);
        if (!entry.folder) {
            ImGui::SameLine(all - dates - sizes);
            ImGui::TextDisabled("%s", size_text(entry.bytes).c_str());
        }
        ImGui::SameLine(all - dates);
        ImGui::TextDisabled("%s", date_text(entry.changed).c_str());
    }
    if (!any && fault_.empty())
        ImGui::TextDisabled("%s", ui.tr(listing_.filter[0] ? "Nothing here has that in its name."
                                                           : "Nothing here that can be opened."));
    ImGui::EndChild();
    ImGui::EndChild();
    if (!enter.empty()) go(enter);
    return twice;
}

FileDialog::~FileDialog() {
    wait_briefly(sketch_.reading);
}

bool FileDialog::busy() const {
    return shown_ && sketch_.reading.valid() &&
           sketch_.reading.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

// The lines of the chosen drawing, as soon as they are read. One file is read at a time: of those that are chosen
// meanwhile, the last.
void FileDialog::load_sketch() {
    const fs::path file = folder_ / name_.text;
    if (busy()) return;
    if (sketch_.reading.valid()) sketch_.lines = sketch_.reading.get();
    if (sketch_.file == file.string()) return;
    sketch_.file = file.string();
    sketch_.lines.clear();
    sketch_.reading = run_detached([file]() -> std::vector<std::vector<Vec2>> {
        std::error_code ec;
        if (!fs::is_regular_file(file, ec) || fs::file_size(file, ec) > kMostSketched) return {};
        try {
            return read_sketch(file);
        } catch (const std::exception&) {
            return {};  // who opens it hears what is wrong
        }
    });
}

void FileDialog::draw_preview(Ui& ui, Pictures& pictures, float width) {
    ImGui::BeginChild("preview", ImVec2(width, 0));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = width * Pictures::kHeight / Pictures::kWidth;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const auto entry = std::find_if(listing_.entries.begin(), listing_.entries.end(),
                                    [&](const FileEntry& e) { return !e.folder && e.name == name_.text; });
    draw->AddRectFilled(at, ImVec2(at.x + width, at.y + height), ImGui::GetColorU32(ImGuiCol_FrameBg), ui.px(4));
    ImGui::Dummy(ImVec2(width, height));
    if (entry != listing_.entries.end()) {
        const fs::path file = folder_ / entry->name;
        const std::string e = lower(file.extension().string());
        if (is_one_of(e, {".svg", ".inkml"})) {
            load_sketch();
            const float side = 0.9f * height;
            draw->AddRectFilled(at, ImVec2(at.x + width, at.y + height), IM_COL32(238, 236, 230, 255), ui.px(4));
            for (const std::vector<Vec2>& line : sketch_.lines) {
                if (sketch_.file != file.string()) break;  // another one, that is still read
                std::vector<ImVec2> points;
                points.reserve(line.size());
                for (const Vec2& p : line)
                    points.emplace_back(at.x + 0.5f * width + static_cast<float>(p.x - 0.5) * side,
                                        at.y + 0.5f * height + static_cast<float>(p.y - 0.5) * side);
                draw->AddPolyline(points.data(), static_cast<int>(points.size()), IM_COL32(30, 28, 26, 255), 0,
                                  ui.px(1.2f));
            }
        } else if (e != ".toml" && entry->bytes <= kMostDrawn) {
            pictures.resume();
            if (const unsigned texture = pictures.texture(file))
                draw->AddImageRounded(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture)), at,
                                      ImVec2(at.x + width, at.y + height), ImVec2(0, 0), ImVec2(1, 1), IM_COL32_WHITE,
                                      ui.px(4));
        }
        ui.mark("Preview");
        ui.wrapped(entry->name);
        ui.note(size_text(entry->bytes) + "\n" + date_text(entry->changed));
    }
    ImGui::EndChild();
}

// Enter in the field of the name.
bool FileDialog::draw_name(Ui& ui) {
    const auto select = [](ImGuiInputTextCallbackData* data) {
        auto& self = *static_cast<FileDialog*>(data->UserData);
        if (!self.name_.select_stem || data->BufTextLen == 0) return 0;
        self.name_.select_stem = false;
        const std::string stem =
            fs::path(std::string(data->Buf, static_cast<std::size_t>(data->BufTextLen))).filename().stem().string();
        data->SelectionStart = data->BufTextLen - static_cast<int>(fs::path(data->Buf).filename().string().size());
        data->SelectionEnd = data->CursorPos = data->SelectionStart + static_cast<int>(stem.size());
        return 0;
    };
    const float buttons =
        ui.button_width("Cancel", 100) + ui.button_width("Replace", 100) + 2 * ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - buttons);
    if (std::exchange(name_.take_focus, false)) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputTextWithHint(
        "##name", ui.tr("file name"), name_.text, sizeof name_.text,
        ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackAlways, select, this);
    if (ImGui::IsItemEdited()) ask_replace_ = false, fault_ = {};
    ui.mark("file name");
    return entered;
}

std::optional<fs::path> FileDialog::draw(Ui& ui, Pictures& pictures) {
    if (!shown_) return std::nullopt;
    std::optional<fs::path> chosen;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * screen.x, 0.5f * screen.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(std::min(ui.px(860), screen.x - 20), std::min(ui.px(520), screen.y - 20)));
    static constexpr const char* titles[] = {
        "Open a model or project", "Save project as", "Export to",       "Writing or drawing to place",
        "Revised model",           "Open an ink",     "Save the ink as", "Reference image",
        "Recording of an arm",     "Decal sheets to", "Film to",         "Characters from"};
    const char* title = titles[static_cast<int>(purpose_)];
    ImGui::Begin((std::string(ui.tr(title)) + "###files").c_str(), nullptr,
                 ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    const bool has_message = !fault_.empty() || ask_replace_;
    const float below =
        ImGui::GetFrameHeightWithSpacing() + ui.px(8) + (has_message ? ImGui::GetTextLineHeightWithSpacing() : 0);
    draw_top(ui);
    ImGui::Separator();
    ImGui::BeginChild("middle", ImVec2(0, -below));
    ImGui::BeginChild("places", ImVec2(ui.px(130), 0));
    draw_places(ui);
    ImGui::EndChild();
    ImGui::SameLine();
    const float preview = ui.px(200), room = ImGui::GetContentRegionAvail().x;
    const bool wide = room > ui.px(620);
    const bool twice = draw_list(ui, wide ? room - preview - ImGui::GetStyle().ItemSpacing.x : 0);
    if (wide) {
        ImGui::SameLine();
        draw_preview(ui, pictures, preview);
    }
    ImGui::EndChild();
    ImGui::Separator();
    if (has_message) {
        const std::string why = ui.sentence(ask_replace_ ? Message("Replace it?") : fault_);
        ImGui::TextColored(
            ui.settings().theme == Theme::dark ? ImVec4(1, 0.62f, 0.45f, 1) : ImVec4(0.72f, 0.10f, 0.02f, 1), "%s",
            ui.fitted(why, ImGui::GetContentRegionAvail().x).c_str());
        ui.mark("File fault");
    }
    const bool entered = draw_name(ui);
    ImGui::SameLine();
    const bool saves = purpose_ == Purpose::save || purpose_ == Purpose::save_ink || purpose_ == Purpose::save_copy;
    const char* action = ask_replace_ ? "Replace" : reads() ? "Open" : saves ? "Save" : "Export";
    if (ui.button("Cancel", nullptr, 100)) shown_ = false;
    ImGui::SameLine();
    const bool pressed = ui.primary_button(action, 100, name_.text[0] != 0);
    if ((pressed || entered || twice) && name_.text[0]) chosen = accept();
    ImGui::End();
    return chosen;
}

}  // namespace tuft::app
