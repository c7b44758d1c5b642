#include "app/widgets/ui.h"

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <ostream>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/panels/panels.h"
#include "app/text/texts.h"
#include "app/widgets/manual_text.h"
#include "app/widgets/titles.h"
#include "brush/preset/preset.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/files/system_message.h"
#include "ink/colour/pigments.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/project/project.h"
#include "io/svg/svg.h"
#include "paths.h"
#include "stroke/placement/model_motion.h"

namespace tuft::app {

static void PrintTo(Theme theme, std::ostream* out) {
    *out << (theme == Theme::dark ? "dark" : "light");
}

namespace {

// Relative luminance and contrast after WCAG 2.1, "relative luminance" and "contrast ratio".
double luminance(const ImVec4& c) {
    const auto linear = [](float v) {
        const auto x = static_cast<double>(v);
        return x <= 0.03928 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(c.x) + 0.7152 * linear(c.y) + 0.0722 * linear(c.z);
}
double contrast(const ImVec4& a, const ImVec4& b) {
    const double x = luminance(a), y = luminance(b);
    return (std::max(x, y) + 0.05) / (std::min(x, y) + 0.05);
}

TEST(Contrast, OfBlackOnWhiteIsTwentyOne) {
    EXPECT_NEAR(contrast({0, 0, 0, 1}, {1, 1, 1, 1}), 21, 1e-9);
}

/// Whether a text has a word of Latin letters that is no name: in Chinese those that stay are names of formats.
bool has_english(const std::string& text) {
    static const std::regex kWord("[A-Za-z]{2,}"),
        kName(
            "mm|km|um|cm|in|ft|PLY|OBJ|STL|OFF|SVG|IGES|glb|GLB|obj|ply|stl|off|tuft|endsolid|UV|MiB|gltf|JSON|TOML|"
            "UTF|"
            "xyz|end|header|glTF|FBX|DAE|COLLADA|X3D|VRML|gunzip|AMF|MF|none|svg|STEP|dae|fbx|or|and");
    const std::string words = std::regex_replace(text, std::regex("'[^']*'|\xe2\x80\x9c[^\xe2]*\xe2\x80\x9d"), "");
    for (std::sregex_iterator it(words.begin(), words.end(), kWord), end; it != end; ++it)
        if (!std::regex_match(it->str(), kName)) return true;
    return false;
}

/// Literals among the arguments of a call whose list begins at `at`, not those of calls within it.
std::vector<std::string> literals_of_call(const std::string& text, std::size_t at) {
    std::vector<std::string> found;
    std::string literal;
    bool open = false;  // a literal that may go on in the next line
    const auto close = [&] {
        if (std::exchange(open, false)) found.push_back(std::exchange(literal, ""));
    };
    for (int depth = 1; at < text.size() && depth > 0; ++at) {
        const char c = text[at];
        if (c == '"') {
            std::string here;
            for (++at; text[at] != '"'; ++at) {
                if (text[at] == '\\') {
                    ++at;
                    here += text[at] == 'n' ? '\n' : text[at];
                } else {
                    here += text[at];
                }
            }
            if (depth == 1) literal += here, open = true;
        } else if (c == '\'' && !std::isalnum(static_cast<unsigned char>(text[at - 1]))) {
            for (++at; text[at] != '\''; ++at) at += text[at] == '\\';
        } else if (!std::isspace(static_cast<unsigned char>(c))) {
            if (depth == 1) close();
            depth += c == '(' || c == '{' || c == '[';
            depth -= c == ')' || c == '}' || c == ']';
        }
    }
    close();
    return found;
}

class Themes : public testing::TestWithParam<Theme> {};

TEST_P(Themes, TextCanBeReadEverywhere) {
    ImGui::CreateContext();
    Ui ui;
    ui.prepare({.theme = GetParam()});
    const ImVec4* c = ImGui::GetStyle().Colors;
    for (const int ground :
         {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_MenuBarBg, ImGuiCol_TitleBgActive, ImGuiCol_FrameBg,
          ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_Button, ImGuiCol_ButtonHovered,
          ImGuiCol_ButtonActive, ImGuiCol_Header, ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive})
        EXPECT_GE(contrast(c[ImGuiCol_Text], c[ground]), 4.5) << ImGui::GetStyleColorName(ground);
    for (const int ground : {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_MenuBarBg, ImGuiCol_FrameBg})
        EXPECT_GE(contrast(c[ImGuiCol_TextDisabled], c[ground]), 4.5)
            << "faint on " << ImGui::GetStyleColorName(ground);
    const ImVec4 white(1, 1, 1, 1);
    EXPECT_GE(contrast(white, {kPrimary[0], kPrimary[1], kPrimary[2], 1}), 4.5);
    EXPECT_GE(contrast(white, {kPrimaryHovered[0], kPrimaryHovered[1], kPrimaryHovered[2], 1}), 4.5);
    // What is not text needs 3 : 1 (WCAG 1.4.11).
    const ImVec4 accent = ImGui::ColorConvertU32ToFloat4(ui.accent);
    for (const int ground : {ImGuiCol_WindowBg, ImGuiCol_FrameBg})
        EXPECT_GE(contrast(accent, c[ground]), 3.0) << ImGui::GetStyleColorName(ground);
    ImGui::DestroyContext();
}
INSTANTIATE_TEST_SUITE_P(, Themes, testing::Values(Theme::dark, Theme::light));

TEST(UiText, AllChineseTextsAreThereForWhatTheKeysAreCalled) {
    for (const char* text : {"Undo", "Redo", "Curve", "Hold it upright", "Dry"})
        EXPECT_NE(chinese_text(text), nullptr) << text;
}

// What the panels' sources give to the functions that show it, but for keys and names that are the same in both.
TEST(UiText, EveryTextOfThePanelsHasAChineseOne) {
    const std::regex shown(
        R"re((?:button|choice|toggle|slider|heading|section|menu_item|begin_menu|begin_dialog|fact|row|tr|note)\((?:(?:s|ui|s\.ui), )?"((?:[^"\\]|\\x..)*)")re");
    const std::regex words("[a-z]{3}"), joint(R"("\s*\n\s*")");
    std::size_t seen = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(source_folder() + "/src/app")) {
        if (!file.is_regular_file()) continue;
        std::ifstream in(file.path());
        // Literals that go on in the next line are one text.
        const std::string text = std::regex_replace(std::string{std::istreambuf_iterator<char>(in), {}}, joint, "");
        for (std::sregex_iterator it(text.begin(), text.end(), shown), end; it != end; ++it) {
            const std::string label = (*it)[1];
            if (!std::regex_search(label, words) || label.find('\\') != std::string::npos || label == "SpaceMouse" ||
                label == "%g mm")
                continue;
            ++seen;
            EXPECT_NE(chinese_text(label.c_str()), nullptr) << file.path().filename() << ": " << label;
        }
    }
    EXPECT_GT(seen, 150u);
}

/// What the program puts something else for: directives of printf, arguments of a message and keys of the manual.
/// The arguments {} are numbered, so that a translation may have them in another order.
std::vector<std::string> placeholders(std::string_view text) {
    static const std::regex pattern(R"(%[-+0-9.]*[a-z]|\{[0-9a-z-]*\})");
    std::vector<std::string> found;
    const std::string whole(text);
    int next = 0;
    for (std::sregex_iterator it(whole.begin(), whole.end(), pattern), end; it != end; ++it)
        found.push_back(it->str() == "{}" ? "{" + std::to_string(next++) + "}" : it->str());
    std::sort(found.begin(), found.end());
    return found;
}

TEST(Catalogues, FindEachOfTheirTextsAndNoOther) {
    for (const Catalogue* catalogue : {&english_catalogue(), &chinese_catalogue()}) {
        ASSERT_GT(catalogue->size(), 30u);
        for (std::size_t i = 1; i < catalogue->size(); ++i) {
            EXPECT_EQ(catalogue->find(catalogue->text(i)), catalogue->translation(i));
            EXPECT_LT(catalogue->text(i - 1), catalogue->text(i)) << "they are searched by halves";
            EXPECT_EQ(catalogue->find(std::string(catalogue->text(i)) + "~"), nullptr);
        }
        EXPECT_EQ(catalogue->find(""), nullptr) << "the header is no text";
    }
}

TEST(Catalogues, TranslationsHaveThePlaceholdersOfTheirTexts) {
    const Catalogue& catalogue = chinese_catalogue();
    for (std::size_t i = 1; i < catalogue.size(); ++i) {
        EXPECT_EQ(placeholders(catalogue.text(i)), placeholders(catalogue.translation(i))) << catalogue.text(i);
        EXPECT_STRNE(catalogue.translation(i), "") << catalogue.text(i);
    }
    EXPECT_EQ(placeholders("%d of {} by {undo}"), (std::vector<std::string>{"%d", "{0}", "{undo}"}));
    EXPECT_EQ(placeholders("{1} of {0}"), placeholders("{} {}"));
}

TEST(Catalogues, HaveEachPageOfTheManual) {
    for (const ManualPage& page : manual_pages()) {
        EXPECT_STRNE(chinese_manual_text(page.title), page.title);
        EXPECT_STRNE(chinese_manual_text(page.text), page.text) << page.title;
    }
}

TEST(UiScale, FollowsTheDisplayAndTheSizeOfThePicture) {
    EXPECT_EQ(scale_for(1, 1280, 720), 1);
    EXPECT_EQ(scale_for(1, 1920, 1080), 1);
    EXPECT_EQ(scale_for(1, 3840, 2160), 2);
    EXPECT_EQ(scale_for(1, 3840, 2060), 2) << "less the desktop's bars";
    EXPECT_EQ(scale_for(1, 2560, 1440), 1.25f);
    EXPECT_EQ(scale_for(1, 3840, 1080), 1) << "a wide one is not a sharp one";
    EXPECT_EQ(scale_for(1.5f, 1280, 720), 1.5f);
    EXPECT_EQ(scale_for(1, 320, 240), 1);
    EXPECT_EQ(scale_for(8, 8192, 8192), 3);
}

TEST(ChineseFont, IsFoundByItsNameTheBestOneFirst) {
    EXPECT_EQ(find_chinese_font({{"DejaVuSans.ttf", "a"}, {"NotoSansMono-Regular.ttf", "b"}}), "");
    EXPECT_EQ(find_chinese_font({{"uming.ttc", "u"}, {"NotoSansCJK-Regular.ttc", "n"}}), "n");
    EXPECT_EQ(find_chinese_font({{"DejaVuSans.ttf", "a"}, {"SarasaGothicCJK-Light.ttc", "s"}}), "s")
        << "one that is not known";
    EXPECT_EQ(find_chinese_font({{"README-CJK.txt", "t"}}), "");
}

// A frame that shows a text, as a list of files shows names.
bool lacks_after_drawing(Ui& ui, const std::string& text) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {800, 600};
    io.IniFilename = nullptr;
    ImGui::NewFrame();
    ImGui::SetNextWindowSize({700, 500});
    ImGui::Begin("Names");
    ImGui::TextUnformatted(text.c_str());
    ImGui::End();
    ImGui::Render();
    return ui.lacks_characters(*ImGui::GetDrawData());
}

// Whether each character of a text in UTF-8, of at most three bytes each, has a picture in the font.
bool has_glyphs(const std::string& text) {
    ImWchar characters[64];
    const int n = ImTextStrFromUtf8(characters, 64, text.c_str(), nullptr);
    const ImFont* font = ImGui::GetIO().Fonts->Fonts[0];
    return std::all_of(characters, characters + n, [&](ImWchar c) {
        const ImFontGlyph* glyph = font->FindGlyphNoFallback(c);
        return glyph && glyph->U0 < 1;  // a placeholder's coordinate is larger
    });
}

// U+9F98 and U+72C3 are not among the 2500 common characters.
TEST(UiFont, GetsTheCharactersThatAreShownInEachLanguage) {
    const std::string names = "\xe9\x9d\x92\xe8\x8a\xb1 \xe9\xbe\x98\xe7\x8b\x83.glb \xe3\x83\x84 \xd0\x96";
    ImGui::CreateContext();
    Ui ui;
    ui.prepare({});
    if (ui.has_chinese) {
        EXPECT_FALSE(lacks_after_drawing(ui, "Plain names? 100 %.glb")) << "a question mark is one";
        EXPECT_FALSE(has_glyphs(names));
        EXPECT_TRUE(lacks_after_drawing(ui, names));
        ui.prepare({});
        EXPECT_TRUE(has_glyphs(names));
        EXPECT_FALSE(lacks_after_drawing(ui, names));
    }
    // No font has U+1A1E, Buginese: it is asked for once.
    ui.prepare({});
    lacks_after_drawing(ui, "\xe1\xa8\x9e");
    ui.prepare({});
    EXPECT_FALSE(lacks_after_drawing(ui, "\xe1\xa8\x9e"));
    ImGui::DestroyContext();
}

// Boxes of the triangles of one colour in what was drawn, glyphs or not.
std::vector<ImVec4> boxes_drawn(const ImDrawData& data, ImU32 colour, bool glyphs) {
    const ImVec2 white = ImGui::GetIO().Fonts->TexUvWhitePixel;
    std::vector<ImVec4> boxes;
    for (int l = 0; l < data.CmdListsCount; ++l) {
        const ImDrawList& list = *data.CmdLists[l];
        for (int i = 0; i + 2 < list.IdxBuffer.Size; i += 3) {
            ImVec4 box(1e9f, 1e9f, -1e9f, -1e9f);
            bool wanted = true;
            for (int k = 0; k < 3; ++k) {
                const ImDrawVert& v = list.VtxBuffer[list.IdxBuffer[i + k]];
                wanted = wanted && v.col == colour && glyphs == (v.uv.x != white.x || v.uv.y != white.y);
                box = {std::min(box.x, v.pos.x), std::min(box.y, v.pos.y), std::max(box.z, v.pos.x),
                       std::max(box.w, v.pos.y)};
            }
            if (wanted) boxes.push_back(box);
        }
    }
    return boxes;
}

TEST(Ui, TheGrabOfASliderLeavesItsTextFree) {
    ImGui::CreateContext();
    Ui ui;
    ui.prepare({});
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {800, 600};
    io.IniFilename = nullptr;
    for (int i = 0; i <= 50; ++i) {
        double value = i / 50.0;
        ImGui::NewFrame();
        ImGui::SetNextWindowSize({400, 200});
        ImGui::Begin("Panel", nullptr, ImGuiWindowFlags_NoTitleBar);
        ui.named_slider("Strength", value, {0, 1, "%.2f"}, nullptr, 300);
        const ImU32 blue = ImGui::GetColorU32(ImGuiCol_SliderGrab), ink = ImGui::GetColorU32(ImGuiCol_Text);
        ImGui::End();
        ImGui::Render();
        const auto grab = boxes_drawn(*ImGui::GetDrawData(), blue, false);
        const auto text = boxes_drawn(*ImGui::GetDrawData(), ink, true);
        ASSERT_FALSE(grab.empty()) << value;
        ASSERT_FALSE(text.empty());
        for (const ImVec4& a : grab)
            for (const ImVec4& b : text) ASSERT_FALSE(a.x < b.z && b.x < a.z && a.y < b.w && b.y < a.w) << value;
    }
    ImGui::DestroyContext();
}

std::string chinese(const Message& message) {
    return message.text([](const char* english) { return chinese_text(english); });
}

// However the model moved: a size may be 0.04, 25 or 1e-05, and a shift negative.
TEST(UiText, ARevisedModelThatMovedIsReportedInChinese) {
    const auto said = [](const stroke::ModelMotion& motion) {
        return chinese(Message("The revised model is the former one {}.", stroke::describe(motion)));
    };
    const Quat turn = glm::angleAxis(std::numbers::pi / 2, Vec3(1, 0, 0));
    for (const double scale : {1.0, 0.04, 25.4, 1e-5, 1000.0})
        for (const Quat& rotation : {Quat(1, 0, 0, 0), turn})
            for (const Vec3& to : {Vec3(0), Vec3(-0.0203, 0, 1.5)}) {
                std::string text = said({.from = Vec3(0), .to = to, .rotation = rotation, .scale = scale});
                EXPECT_FALSE(has_english(text)) << text;
            }
    EXPECT_NE(said({.to = Vec3(-0.0203, 0, 1.5)}).find("(-20.3, 0.0, 1500.0)"), std::string::npos);
    EXPECT_NE(said({.scale = 0.04}).find(" 0.04 "), std::string::npos);
}

// What a person meets when a file cannot be opened or written, as the modules throw it.
TEST(UiText, ErrorsOfFilesAreSaidInChineseAndKeepTheNameOfTheFile) {
    const auto error_of = [](const auto& action) {
        try {
            action();
        } catch (const Error& error) {
            return error.message();
        }
        return Message("no error");
    };
    const std::string folder = testing::TempDir() + "/" + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    const auto written = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder + "/" + name) << text;
        return folder + "/" + name;
    };
    const std::vector<Message> errors{
        error_of([&] { io::read_model(folder + "/none.ply"); }),
        error_of([&] { io::read_model(folder); }),
        error_of([&] { io::read_model(written("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n")); }),
        error_of([&] { io::read_model(written("b.obj", "v 0 0 0\nf 1 2 x\n")); }),
        error_of([&] { io::read_model(written("c.stl", "short")); }),
        error_of([&] { io::read_model(written("d.xyz", "1 2 3\n")); }),
        error_of([&] { io::Project::open(written("e.tuft", "no project"), {.access = io::Access::read}); }),
        error_of([&] { io::read_strokes(written("f.svg", "<svg xmlns='http://www.w3.org/2000/svg'/>")); }),
        error_of([&] { write_file(folder + "/none/x.ply", "x", 1); }),
        error_of([&] { io::read_strokes(written("g.svg", "<svg xmlns='http://www.w3.org/2000/svg'><g></svg>")); }),
        error_of([&] { throw Error(folder, Message("cannot be read: {}", system_message(EACCES))); }),
        error_of([&] {
            throw Error(folder, Message("cannot be read: {}",
                                        system_message(std::error_code(ENOSPC, std::generic_category()))));
        }),
    };
    for (const Message& error : errors) {
        const std::string text = chinese(error);
        const std::size_t at = text.find(folder);
        ASSERT_EQ(at, 0u) << text;
        EXPECT_FALSE(has_english(text.substr(text.find("\xef\xbc\x9a")))) << text << " | " << error.text();
    }
    // Of files that a library reads: kinds in Chinese, the library's own words only in parentheses behind them.
    const auto broken = [&](const char* target, const char* name, std::size_t from, std::string_view bytes) {
        const std::vector<char> whole = read_file(source_folder() + "/tests/fuzz/corpus/" + target + "/" + name);
        std::string text(whole.begin(), whole.end());
        text = from < text.size() ? text.substr(0, from) + std::string(bytes) : text;
        return written(std::string("broken_") + name, text);
    };
    std::vector<Message> faults;
    for (const char* name : {"two.png", "two.jpg", "two.tif", "two.exr"})
        for (const std::size_t from : {std::size_t{20}, std::size_t{60}, std::size_t{100}})
            for (const std::string_view bytes :
                 {std::string_view(), std::string_view("\x7f\x01\xfe garbage \x80\xff")}) {
                const Message error = error_of([&] { io::read_image8(broken("image", name, from, bytes)); });
                if (error.text() != "no error") faults.push_back(error);
            }
    EXPECT_GT(faults.size(), 12u);
    for (const std::size_t from : {std::size_t{40}, std::size_t{400}}) {
        faults.push_back(error_of([&] { io::read_model(broken("fbx", "box.fbx", from, "")); }));
        faults.push_back(error_of([&] { io::read_model(broken("dae", "small.dae", from, "")); }));
    }
    faults.push_back(error_of([&] { io::read_model(written("i.gltf", "{\"asset\": {")); }));
    faults.push_back(error_of([&] { io::read_model(written("j.gltf", "{\"asset\": {\"version\": 3}}")); }));
    for (const char* toml : {"a = 1\na = 2\n", "a = [1, 2", "a = = 1", "a = \"\xff\""})
        faults.push_back(error_of([&] { brush::parse_preset(toml, folder + "/k.toml"); }));
    const std::regex details("\xef\xbc\x88[^\xef]*\xef\xbc\x89|^[^\xef]*");
    for (const Message& fault : faults) {
        EXPECT_NE(fault.text(), "no error");
        EXPECT_FALSE(has_english(std::regex_replace(chinese(fault), details, "")))
            << chinese(fault) << " | " << fault.text();
    }
    std::vector<Message> notes;
    io::read_strokes(written("h.svg",
                             "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0L9 9' stroke='#900000' "
                             "stroke-dasharray='1'/><image/><image/><text fill='#900000'>a&#x10FFFD;</text></svg>"),
                     {.note = [&](const Message& note) { notes.push_back(note); }});
    EXPECT_EQ(notes.size(), 3u) << "the dashes are drawn";
    for (const Message& note : notes) EXPECT_FALSE(has_english(chinese(note))) << chinese(note);
    std::filesystem::remove_all(folder);
    EXPECT_FALSE(
        has_english(chinese(Message("layer '{}' is locked; unlock it or paint on another one", std::string("2")))));
    EXPECT_EQ(chinese(Message(std::string("a.ply * {}"))), "a.ply * {}") << "a name is no format";
}

// Literals that become messages: the arguments of what throws, reports or makes one. The command line's own stay
// English.
TEST(UiText, EveryMessageHasAChineseOne) {
    const std::regex call(R"(\b(Message|Error|fail|damaged|refuse|fault|say|show_message|outbox_?\.report)[({]\s*)");
    const std::regex word("[a-z]{2}"), comment(R"((^|[^:"])//[^\n]*)");
    const auto in_window = [](const std::string& path) {
        for (const char* other :
             {"/src/cli", "/src/variants", "/src/render", "/app/script", "/set_by_name.cpp", "/app/main.cpp",
              "/brush/calibration", "/core/manual", "/core/message", "/core/error", "import_main"})
            if (path.find(other) != std::string::npos) return false;
        return true;
    };
    std::size_t seen = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(source_folder() + "/src")) {
        const std::string extension = file.path().extension();
        if ((extension != ".cpp" && extension != ".h") || !in_window(file.path().string())) continue;
        std::ifstream in(file.path());
        const std::string text = std::regex_replace(std::string{std::istreambuf_iterator<char>(in), {}}, comment, "$1");
        for (std::sregex_iterator it(text.begin(), text.end(), call), end; it != end; ++it)
            for (const std::string& literal :
                 literals_of_call(text, static_cast<std::size_t>(it->position() + it->length()))) {
                if (!std::regex_search(literal, word)) continue;
                ++seen;
                EXPECT_NE(chinese_text(literal.c_str()), nullptr) << file.path().filename() << ": " << literal;
            }
    }
    EXPECT_GT(seen, 450u);
}

// A phase that no module reports any more would leave the line of progress at the phase before.
TEST(Opening, ThePhasesWithATitleAreThoseThatTheModulesReport) {
    std::string table, others;
    for (const auto& file : std::filesystem::recursive_directory_iterator(source_folder() + "/src")) {
        if (file.path().extension() != ".cpp") continue;
        std::ifstream in(file.path());
        (file.path().filename() == "opening.cpp" ? table : others) += {std::istreambuf_iterator<char>(in), {}};
    }
    const std::regex stage("\\n    \\{\"([a-z ]+)\", \"[A-Z]");
    int seen = 0;
    for (std::sregex_iterator it(table.begin(), table.end(), stage), end; it != end; ++it, ++seen)
        EXPECT_NE(others.find('"' + (*it)[1].str() + '"'), std::string::npos) << (*it)[1];
    EXPECT_GE(seen, 15);
}

// Names in files, such as "iron-red", are not what a person reads.
TEST(UiText, AllThatIsShippedHasANameInBothLanguages) {
    std::vector<std::string> names;
    for (const auto& list : {brush::list_presets(), ink::list_inks(), ink::list_pigments(), ink::list_substrates()})
        names.insert(names.end(), list.begin(), list.end());
    EXPECT_GT(names.size(), 25u);
    for (const std::string& name : names) {
        ASSERT_NE(english_name(name.c_str()), nullptr) << name;
        EXPECT_TRUE(std::isupper(static_cast<unsigned char>(english_name(name.c_str())[0]))) << name;
        EXPECT_NE(chinese_text(name.c_str()), nullptr) << name;
    }
}

TEST(UiText, ABrushOfAnotherSizeIsNamedByTwoDigitsOfItsFactor) {
    const Ui ui;
    EXPECT_EQ(ui.title("goat-large*0.10743"), "Goat, large \xc3\x97 0.11");
    EXPECT_EQ(ui.title("mixed-medium*1.8"), "Mixed, medium \xc3\x97 1.8");
    EXPECT_EQ(ui.title("my own"), "my own");
}

TEST(UiText, NamesThatTheStudioGaveAreShownInTheLanguageAndOthersAsTheyAre) {
    ImGui::CreateContext();
    Ui ui;
    for (const char* name : {"Layer 2", "Layer 2 copy", "Layer 2 copy 3", "Layer 2 copy copy", "copy", "Layer x"})
        EXPECT_EQ(layer_title(ui, name), name);
    ui.prepare({.language = Language::chinese});
    EXPECT_EQ(layer_title(ui, "Layer 2"), "图层 2");
    EXPECT_EQ(layer_title(ui, "Layer 2 copy"), "图层 2 副本");
    EXPECT_EQ(layer_title(ui, "Layer 2 copy 3"), "图层 2 副本 3");
    EXPECT_EQ(layer_title(ui, "Layer 2 copy copy"), "图层 2 副本 副本");
    EXPECT_EQ(layer_title(ui, "gold copy"), "gold 副本");
    EXPECT_EQ(numbered_title(ui, "Snapshot 12", "Snapshot"), "快照 12");
    for (const char* name : {"", "copy", " copy", "gold", "Layer", "Layer ", "Layer x", "a copy of it", "photocopy"})
        EXPECT_EQ(layer_title(ui, name), name);
    ImGui::DestroyContext();
}

}  // namespace
}  // namespace tuft::app
