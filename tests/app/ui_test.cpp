#include "app/widgets/ui.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <ostream>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "app/text/texts.h"
#include "app/widgets/manual_text.h"
#include "brush/preset/preset.h"
#include "ink/colour/pigments.h"
#include "paths.h"
#include "stroke/journal/model_motion.h"

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

/// What the program puts something else for: directives of printf, fields of fmt, keys of the manual, and # for
/// numbers.
std::vector<std::string> placeholders(std::string_view text) {
    static const std::regex pattern(R"(%[-+0-9.]*[a-z]|\{[a-z-]*\}|#)");
    std::vector<std::string> found;
    const std::string whole(text);
    for (std::sregex_iterator it(whole.begin(), whole.end(), pattern), end; it != end; ++it) found.push_back(it->str());
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
    EXPECT_EQ(placeholders("%d of {} by {undo}"), (std::vector<std::string>{"%d", "{undo}", "{}"}));
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

// However the model moved: a size may be 0.04, 25 or 1e-05, and a shift negative.
TEST(UiText, ARevisedModelThatMovedIsReportedInChinese) {
    const auto chinese = [](const stroke::ModelMotion& motion) {
        return chinese_sentence("The revised model is the former one " + stroke::describe(motion) + ".");
    };
    const Quat turn = glm::angleAxis(std::numbers::pi / 2, Vec3(1, 0, 0));
    const std::string is = "\xe4\xbf\xae\xe8\xae\xa2\xe5\x90\x8e";  // "revised"
    for (const double scale : {1.0, 0.04, 25.4, 1e-5, 1000.0})
        for (const Quat& rotation : {Quat(1, 0, 0, 0), turn})
            for (const Vec3& to : {Vec3(0), Vec3(-0.0203, 0, 1.5)}) {
                const std::string text = chinese({.from = Vec3(0), .to = to, .rotation = rotation, .scale = scale});
                EXPECT_TRUE(text.starts_with(is)) << text;
                EXPECT_EQ(text.find('#'), std::string::npos) << text;
            }
    EXPECT_NE(chinese({.to = Vec3(-0.0203, 0, 1.5)}).find("(-20.3, 0.0, 1500.0)"), std::string::npos);
    EXPECT_NE(chinese({.scale = 0.04}).find(" 0.04 "), std::string::npos);
}

TEST(UiText, ASentenceAboutAFileKeepsItsName) {
    EXPECT_NE(chinese_sentence("Saved as /tmp/a * b 7.tuft").find("/tmp/a * b 7.tuft"), std::string::npos);
    const std::string other =
        chinese_sentence("Another program put another model into a.tuft; this is a copy of what was in it.");
    EXPECT_NE(other.find("a.tuft"), std::string::npos);
    EXPECT_EQ(other.find("copy"), std::string::npos) << other;
    EXPECT_EQ(chinese_sentence("a.ply: line 3 is cut off"), "a.ply: line 3 is cut off") << "what is not known";
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

}  // namespace
}  // namespace tuft::app
