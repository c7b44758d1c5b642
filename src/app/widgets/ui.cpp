#include "app/widgets/ui.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include "app/text/texts.h"
#include "app/widgets/missing_characters.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr float kFontSize = 16;
constexpr unsigned kIdeographs = 0x2e80;  // from here on: characters of Chinese, Japanese and Korean

// Path by file name of all fonts in the system's folders.
std::map<std::string, std::string> list_fonts() {
    std::vector<fs::path> folders{"/usr/share/fonts", "/usr/local/share/fonts"};
    if (const char* home = std::getenv("HOME")) {
        folders.push_back(fs::path(home) / ".local/share/fonts");
        folders.push_back(fs::path(home) / ".fonts");
    }
    if (const char* extra = std::getenv("TUFT_FONTS")) folders = {extra};
    std::map<std::string, std::string> found;
    for (const fs::path& folder : folders) {
        std::error_code ec;
        for (fs::recursive_directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec))
            found.emplace(it->path().filename().string(), it->path().string());
    }
    return found;
}

std::string first_of(const std::map<std::string, std::string>& fonts, std::initializer_list<const char*> names) {
    for (const char* name : names)
        if (const auto at = fonts.find(name); at != fonts.end()) return at->second;
    return {};
}

/// Ranges of the characters of these ranges, of a text and of a set, as ImGui takes them.
ImVector<ImWchar> ranges_of(const std::vector<const ImWchar*>& ranges, const std::string& text,
                            const std::set<unsigned>& characters) {
    ImFontGlyphRangesBuilder builder;
    for (const ImWchar* range : ranges) builder.AddRanges(range);
    builder.AddText(text.c_str());
    for (const unsigned c : characters) builder.AddChar(static_cast<ImWchar>(c));
    ImVector<ImWchar> out;
    builder.BuildRanges(&out);
    return out;
}

ImVec4 grey(float v, float alpha = 1) {
    return {v, v, v * 1.015f, alpha};
}

}  // namespace

float scale_for(float content, int width, int height) {
    const float larger = std::min(static_cast<float>(width) / 1920, static_cast<float>(height) / 1080);
    return std::clamp(std::max(content, std::round(4 * larger) / 4), 1.0f, 3.0f);
}

std::string find_chinese_font(const std::map<std::string, std::string>& fonts) {
    if (std::string known =
            first_of(fonts, {"NotoSansCJK-Regular.ttc", "NotoSansCJKsc-Regular.otf", "NotoSansSC-Regular.otf",
                             "NotoSansSC-Regular.ttf", "SourceHanSansSC-Regular.otf", "SourceHanSansCN-Regular.otf",
                             "SourceHanSans-Regular.ttc", "wqy-microhei.ttc", "wqy-zenhei.ttc",
                             "LXGWWenKai-Regular.ttf", "DroidSansFallbackFull.ttf", "DroidSansFallback.ttf",
                             "NotoSerifCJK-Regular.ttc", "uming.ttc", "ukai.ttc"});
        !known.empty())
        return known;
    // Others say in their names what they hold.
    for (const auto& [name, path] : fonts) {
        const bool font = name.ends_with(".ttf") || name.ends_with(".otf") || name.ends_with(".ttc");
        for (const char* word :
             {"CJK", "SansSC", "SansCN", "SansHans", "SerifSC", "SerifCN", "wqy-", "simsun", "simhei", "msyh"})
            if (font && name.find(word) != std::string::npos) return path;
    }
    return {};
}

Message Ui::prepare(const UiSettings& settings) {
    settings_ = settings;
    ImGuiIO& io = ImGui::GetIO();
    io.Fonts->Clear();
    Message missing;
    has_chinese = false;
    const std::map<std::string, std::string> fonts = list_fonts();
    const std::string latin =
        first_of(fonts, {"NotoSans-Regular.ttf", "Inter-Regular.ttf", "Ubuntu-R.ttf", "Cantarell-Regular.otf",
                         "DejaVuSans.ttf", "LiberationSans-Regular.ttf", "FreeSans.ttf"});
    static const ImWchar latin_range[] = {0x20,   0x17f,  0x2010, 0x2027, 0x2190, 0x2193, 0x00b0,
                                          0x00b7, 0x0394, 0x0394, 0x03bc, 0x03bc, 0};
    static ImVector<ImWchar> latin_ranges, chinese_ranges;
    latin_ranges = ranges_of({latin_range}, {}, characters_);
    const float size = std::round(kFontSize * settings.scale);
    if (latin.empty()) {
        missing = "No font of the system was found; the built-in one is used.";
        ImFontConfig config;
        config.SizePixels = size;
        io.Fonts->AddFontDefault(&config);
    } else {
        io.Fonts->AddFontFromFileTTF(latin.c_str(), size, nullptr, latin_ranges.Data);
    }
    // A square character needs more room than a Latin letter of the same size to be read.
    const float square = std::round(1.14f * size);
    const std::string chinese = find_chinese_font(fonts);
    if (!chinese.empty()) {
        std::vector<const ImWchar*> common;
        if (settings.language == Language::chinese || characters_.lower_bound(kIdeographs) != characters_.end())
            common.push_back(io.Fonts->GetGlyphRangesChineseSimplifiedCommon());
        chinese_ranges = ranges_of(common, all_chinese_text(), characters_);
        ImFontConfig config;
        config.MergeMode = true;
        config.GlyphOffset.y = std::round(0.4f * (square - size));
        config.FontNo = chinese.ends_with("NotoSansCJK-Regular.ttc") ? 2 : 0;  // the simplified face of the collection
        io.Fonts->AddFontFromFileTTF(chinese.c_str(), square, &config, chinese_ranges.Data);
        has_chinese = true;
    } else if (settings.language == Language::chinese) {
        missing =
            "No Chinese font is installed. Install fonts-noto-cjk (Debian, Ubuntu), google-noto-sans-cjk-fonts "
            "(Fedora) or noto-fonts-cjk (Arch), then choose the language again.";
        settings_.language = Language::english;
    }
    large = latin.empty() ? io.Fonts->Fonts[0]
                          : io.Fonts->AddFontFromFileTTF(latin.c_str(), std::round(1.6f * size), nullptr, latin_range);
    io.Fonts->Build();
    add_placeholders(*io.Fonts->Fonts[0], characters_, square);
    style();
    return missing;
}

bool Ui::lacks_characters(const ImDrawData& drawn) {
    const std::size_t known = characters_.size();
    characters_.merge(drawn_placeholders(drawn));
    return characters_.size() > known;
}

void Ui::style() {
    ImGuiStyle& s = ImGui::GetStyle();
    s = ImGuiStyle();
    const bool dark = settings_.theme == Theme::dark;
    dark ? ImGui::StyleColorsDark() : ImGui::StyleColorsLight();
    const ImVec4 blue = dark ? ImVec4(0.33f, 0.56f, 0.90f, 1) : ImVec4(0.10f, 0.38f, 0.74f, 1);
    const ImVec4 soft = dark ? ImVec4(0.25f, 0.38f, 0.58f, 1) : ImVec4(0.72f, 0.82f, 0.95f, 1);
    ImVec4* c = s.Colors;
    c[ImGuiCol_Text] = dark ? grey(0.92f) : grey(0.10f);
    c[ImGuiCol_TextDisabled] = dark ? grey(0.66f) : grey(0.36f);
    c[ImGuiCol_WindowBg] = dark ? grey(0.155f) : grey(0.94f);
    c[ImGuiCol_ChildBg] = ImVec4(0, 0, 0, 0);
    c[ImGuiCol_PopupBg] = dark ? grey(0.19f) : grey(0.985f);
    c[ImGuiCol_MenuBarBg] = dark ? grey(0.125f) : grey(0.88f);
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = dark ? grey(0.125f) : grey(0.86f);
    c[ImGuiCol_Border] = c[ImGuiCol_Separator] = dark ? grey(0.27f) : grey(0.78f);
    c[ImGuiCol_FrameBg] = dark ? grey(0.235f) : grey(0.86f);
    c[ImGuiCol_FrameBgHovered] = dark ? grey(0.29f) : grey(0.81f);
    c[ImGuiCol_FrameBgActive] = dark ? grey(0.33f) : grey(0.77f);
    c[ImGuiCol_Button] = dark ? grey(0.265f) : grey(0.84f);
    c[ImGuiCol_ButtonHovered] = dark ? grey(0.33f) : grey(0.78f);
    c[ImGuiCol_ButtonActive] = soft;
    c[ImGuiCol_Header] = soft;
    c[ImGuiCol_HeaderHovered] = dark ? grey(0.30f) : grey(0.82f);
    c[ImGuiCol_HeaderActive] = soft;
    c[ImGuiCol_SliderGrab] = c[ImGuiCol_CheckMark] = blue;
    c[ImGuiCol_SliderGrabActive] = blue;
    c[ImGuiCol_PlotHistogram] = blue;
    c[ImGuiCol_ModalWindowDimBg] = ImVec4(0, 0, 0, 0.45f);
    s.WindowRounding = s.PopupRounding = 6;
    s.FrameRounding = s.GrabRounding = s.ChildRounding = 4;
    s.WindowPadding = {12, 10};
    s.FramePadding = {8, 4};
    s.ItemSpacing = {8, 6};
    s.ItemInnerSpacing = {8, 4};
    s.WindowTitleAlign = {0.02f, 0.5f};
    s.ScrollbarSize = 9;
    s.WindowBorderSize = 1;
    s.ScaleAllSizes(settings_.scale);
    accent = ImGui::ColorConvertFloat4ToU32(blue);
    faint = ImGui::ColorConvertFloat4ToU32(c[ImGuiCol_TextDisabled]);
    strong = ImGui::ColorConvertFloat4ToU32(c[ImGuiCol_Text]);
    wrong = dark ? IM_COL32(255, 140, 107, 255) : IM_COL32(184, 26, 5, 255);
}

const char* Ui::tr(const char* english) const {
    const char* text = settings_.language == Language::english ? english_name(english) : chinese_text(english);
    return text ? text : english;
}

std::string Ui::title(const std::string& name) const {
    if (const std::size_t slash = name.rfind('/'); slash != std::string::npos) {  // of a file
        const std::string file = name.substr(slash + 1);
        const std::size_t toml = file.rfind(".toml");
        return toml == std::string::npos ? file : file.substr(0, toml) + title(file.substr(toml)).substr(5);
    }
    const std::size_t star = name.find('*');
    if (star == std::string::npos) return tr(name.c_str());
    char factor[32];
    std::snprintf(factor, sizeof factor, " \xc3\x97 %.2g", std::atof(name.c_str() + star + 1));
    return tr(name.substr(0, star).c_str()) + std::string(factor);
}

std::string Ui::fitted(const std::string& text, float width) const {
    if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
    std::size_t end = text.size();
    const auto shorter = [&] { return text.substr(0, end) + "..."; };
    while (end > 0 && ImGui::CalcTextSize(shorter().c_str()).x > width) {
        do --end;
        while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80);  // whole characters
    }
    return shorter();
}

std::string Ui::sentence(const Message& message) const {
    return message.text([this](const char* english) { return tr(english); });
}

std::string Ui::id(const char* label) const {
    return std::string(tr(label)) + "##" + label;
}

void Ui::begin_frame() {
    places_.clear();
}

void Ui::mark(const std::string& name) {
    const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    if (!ImGui::IsRectVisible(a, b)) return;
    if (const auto there = places_.find(name); there != places_.end() && there->second.on_top && !in_menu) return;
    places_[name] = {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), in_menu};
}

void Ui::mark_at(const std::string& name, float x, float y) {
    places_[name] = {x, y, in_menu};
}

const Ui::Place* Ui::find(const std::string& name) const {
    const auto at = places_.find(name);
    return at == places_.end() ? nullptr : &at->second;
}

std::vector<std::string> Ui::names() const {
    std::vector<std::string> out;
    for (const auto& [name, place] : places_) out.push_back(name);
    return out;
}

void Ui::hint(const char* text) {
    const std::array<float, 2> item{ImGui::GetItemRectMin().x, ImGui::GetItemRectMin().y};
    if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        if (item == pressed_) pressed_.reset();
        return;
    }
    if (ImGui::IsItemClicked()) pressed_ = item;
    if (!text || (modal && !in_dialog) || item == pressed_) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(px(300));
    ImGui::TextUnformatted(tr(text));
    mark("hint");
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

float Ui::button_width(const char* label, float least) const {
    return std::max(px(least), ImGui::CalcTextSize(tr(label), nullptr, true).x + 2 * ImGui::GetStyle().FramePadding.x);
}

void Ui::buttons_at_right(std::initializer_list<std::pair<const char*, float>> buttons) const {
    float width = -ImGui::GetStyle().ItemSpacing.x;
    for (const auto& [label, least] : buttons) width += button_width(label, least) + ImGui::GetStyle().ItemSpacing.x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, ImGui::GetContentRegionAvail().x - width));
}

bool Ui::button(const char* label, const char* text, float width, bool enabled) {
    ImGui::BeginDisabled(!enabled);
    const bool pressed = ImGui::Button(id(label).c_str(), ImVec2(button_width(label, width), 0));
    ImGui::EndDisabled();
    mark(label);
    hint(text);
    return pressed;
}

bool Ui::primary_button(const char* label, float width, bool enabled) {
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(kPrimary[0], kPrimary[1], kPrimary[2], 1));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered,
                          ImVec4(kPrimaryHovered[0], kPrimaryHovered[1], kPrimaryHovered[2], 1));
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1, 1, 1, 1));
    bool pressed = button(label, nullptr, width, enabled);
    ImGui::PopStyleColor(3);
    if (enter && in_dialog && enabled) {
        enter = false;
        pressed = true;
    }
    return pressed;
}

bool Ui::toggle(const char* label, bool& value, const char* text) {
    const bool changed = ImGui::Checkbox(id(label).c_str(), &value);
    mark(label);
    hint(text);
    return changed;
}

bool Ui::choice(const char* label, bool chosen, const char* text, float width) {
    if (chosen) {
        ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_Header));
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImGui::GetStyleColorVec4(ImGuiCol_Header));
    }
    const bool pressed = button(label, text, width);
    if (chosen) ImGui::PopStyleColor(2);
    return pressed;
}

bool Ui::entry(const char* label, bool chosen, float height) {
    if (chosen) ImGui::PushStyleColor(ImGuiCol_HeaderHovered, ImGui::GetStyleColorVec4(ImGuiCol_Header));
    const bool pressed = ImGui::Selectable(label, chosen, ImGuiSelectableFlags_AllowDoubleClick, ImVec2(0, height));
    if (chosen) ImGui::PopStyleColor();
    return pressed;
}

namespace {

// The triangle of what can be folded: down when it is open, to the right else.
void draw_arrow(ImDrawList* draw, ImVec2 c, float r, bool open, unsigned colour) {
    if (open)
        draw->AddTriangleFilled(ImVec2(c.x - r, c.y - 0.6f * r), ImVec2(c.x + r, c.y - 0.6f * r),
                                ImVec2(c.x, c.y + 0.8f * r), colour);
    else
        draw->AddTriangleFilled(ImVec2(c.x - 0.6f * r, c.y - r), ImVec2(c.x + 0.8f * r, c.y),
                                ImVec2(c.x - 0.6f * r, c.y + r), colour);
}

// What lies behind the text of a slider: filled from zero, or from its lower end, to the value, where the grab stands.
// The grab leaves the text free, so that it can be read wherever the value stands.
void draw_slider_ground(float lo, float hi, float value, const char* text, float width) {
    constexpr float pad = 2;  // pixels that ImGui leaves beside the grab
    const float grab = ImGui::GetStyle().GrabMinSize, round = ImGui::GetStyle().FrameRounding;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 end(at.x + width, at.y + ImGui::GetFrameHeight());
    const auto place = [&](float v) {
        return at.x + pad + 0.5f * grab +
               std::clamp((v - lo) / (hi - lo), 0.0f, 1.0f) * (end.x - at.x - 2 * pad - grab);
    };
    const bool over =
        ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) && ImGui::IsMouseHoveringRect(at, end);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, end, ImGui::GetColorU32(over ? ImGuiCol_FrameBgHovered : ImGuiCol_FrameBg), round);
    const float zero = lo < 0 ? place(0) : at.x, now = place(value);
    draw->AddRectFilled({std::min(zero, now), at.y}, {std::max(zero, now), end.y}, ImGui::GetColorU32(ImGuiCol_Header),
                        lo < 0 ? 0 : round);
    if (text == nullptr) return;
    const unsigned colour = ImGui::GetColorU32(ImGuiCol_SliderGrab);
    const auto draw_grab = [&](float top, float bottom) {
        draw->AddRectFilled({now - 0.5f * grab, top}, {now + 0.5f * grab, bottom}, colour);
    };
    const ImVec2 size = ImGui::CalcTextSize(text, nullptr, true);
    const float middle = 0.5f * (at.x + end.x), above = 0.5f * (end.y - at.y - size.y);
    if (std::abs(now - middle) > 0.5f * (size.x + grab) + pad) return draw_grab(at.y + pad, end.y - pad);
    draw_grab(at.y, at.y + above);
    draw_grab(end.y - above, end.y);
}

}  // namespace

bool Ui::bare_slider(const char* label, double& value, const SliderRange& range, float width) {
    const auto& [lo, hi, format, unit] = range;
    auto v = static_cast<float>(value / unit);
    ImGui::SetNextItemWidth(width);
    const std::string name = std::string("##") + label;
    const auto least = static_cast<float>(lo / unit), most = static_cast<float>(hi / unit);
    char text[256];
    std::snprintf(text, sizeof text, format, static_cast<double>(v));
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, px(4));
    const bool typed = ImGui::TempInputIsActive(ImGui::GetID(name.c_str()));
    draw_slider_ground(least, most, v, typed ? nullptr : text, width);
    const ImGuiCol drawn[] = {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_SliderGrab,
                              ImGuiCol_SliderGrabActive};
    for (const ImGuiCol colour : drawn) ImGui::PushStyleColor(colour, IM_COL32_BLACK_TRANS);
    const bool changed = ImGui::SliderFloat(name.c_str(), &v, least, most, format, ImGuiSliderFlags_AlwaysClamp);
    ImGui::PopStyleColor(static_cast<int>(std::size(drawn)));
    ImGui::PopStyleVar();
    mark(label);
    if (changed) value = v * unit;
    return changed;
}

bool Ui::slider(const char* label, double& value, const SliderRange& range, const char* text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(tr(label));
    hint(text);
    const ImGuiStyle& style = ImGui::GetStyle();
    ImGui::SameLine(std::max(px(112), style.WindowPadding.x + ImGui::CalcTextSize(tr(label)).x + style.ItemSpacing.x));
    const bool changed = bare_slider(label, value, range, ImGui::GetContentRegionAvail().x);
    hint(text);
    return changed;
}

bool Ui::named_slider(const char* label, double& value, const SliderRange& range, const char* text, float width) {
    const auto& [lo, hi, format, unit] = range;
    // The number goes last: where the name does not fit beside it, the name is cut.
    char number[48];
    std::snprintf(number, sizeof number, format, value / unit);
    const float room = width - ImGui::CalcTextSize(number).x - 2 * ImGui::GetStyle().FramePadding.x - px(6);
    std::string shown = fitted(tr(label), room);
    for (std::size_t at = 0; (at = shown.find('%', at)) != std::string::npos; at += 2) shown.insert(at, 1, '%');
    const bool changed = bare_slider(label, value, {lo, hi, (shown + "  " + format).c_str(), unit}, width);
    hint(text);
    return changed;
}

bool Ui::combo(const char* label, std::string& value, const std::vector<std::string>& names, float width) {
    bool changed = false;
    ImGui::SetNextItemWidth(width > 0 ? px(width) : -1);
    if (ImGui::BeginCombo((std::string("##") + label).c_str(), title(value).c_str())) {
        for (const std::string& name : names) {
            if (ImGui::Selectable(tr(name.c_str()), name == value)) {
                value = name;
                changed = true;
            }
            mark(name);
        }
        ImGui::EndCombo();
    } else {
        mark(label);
    }
    return changed;
}

bool Ui::menu_item(const char* label, const char* shortcut, bool chosen, bool enabled) {
    const bool pressed = ImGui::MenuItem(id(label).c_str(), shortcut, chosen, enabled);
    mark(label);
    return pressed;
}

void Ui::fold_arrow(float x, float y, bool open) const {
    draw_arrow(ImGui::GetWindowDrawList(), ImVec2(x, y), px(4), open, strong);
}

bool Ui::begin_menu(const char* label) {
    const bool open = ImGui::BeginMenu(id(label).c_str());
    if (!open) mark(label);
    return open;
}

void Ui::heading(const char* text) {
    ImGui::Dummy(ImVec2(0, px(2)));
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextUnformatted(tr(text));
    ImGui::PopStyleColor();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddLine(ImVec2(at.x, at.y - px(3)),
                                        ImVec2(at.x + ImGui::GetContentRegionAvail().x, at.y - px(3)),
                                        ImGui::GetColorU32(ImGuiCol_Separator));
    ImGui::Dummy(ImVec2(0, px(1)));
}

bool Ui::section(const char* title, bool open, const char* value) {
    if (const auto known = sections.find(title); known != sections.end()) open = known->second;
    const ImVec2 at = ImGui::GetCursorScreenPos(),
                 size(ImGui::GetContentRegionAvail().x, ImGui::GetTextLineHeight() + px(4));
    if (ImGui::InvisibleButton((std::string("##fold ") + title).c_str(), size)) {
        sections[title] = open = !open;
        sections_changed = true;
    }
    mark(std::string("fold ") + title);
    const unsigned colour = ImGui::IsItemHovered() ? strong : faint;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw_arrow(draw, ImVec2(at.x + px(5), at.y + 0.5f * ImGui::GetTextLineHeight()), px(4), open, colour);
    draw->AddText(ImVec2(at.x + px(15), at.y), colour, tr(title));
    if (value) {
        const std::string shown = fitted(value, size.x - px(25) - ImGui::CalcTextSize(tr(title)).x);
        draw->AddText(ImVec2(at.x + size.x - ImGui::CalcTextSize(shown.c_str()).x, at.y), strong, shown.c_str());
    }
    draw->AddLine(ImVec2(at.x, at.y + size.y - px(1)), ImVec2(at.x + size.x, at.y + size.y - px(1)),
                  ImGui::GetColorU32(ImGuiCol_Separator));
    return open;
}

void Ui::wrapped(const std::string& text) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
}

void Ui::note(const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    wrapped(text);
    ImGui::PopStyleColor();
}

}  // namespace tuft::app
