#include "app/widgets/labels.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "app/text/texts.h"
#include "app/widgets/ui.h"
#include "ink/colour/pigments.h"

/// Names in little room, as the grid of inks has them.
namespace tuft::app {
namespace {

// Characters as wide as one another; a character of UTF-8 counts once.
float characters(const std::string& text) {
    float n = 0;
    for (const char c : text) n += (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    return n;
}

void expect_told_apart(const std::vector<std::string>& names, const LabelSpace& room) {
    const std::vector<std::string> labels = make_distinct(names, room);
    ASSERT_EQ(labels.size(), names.size());
    std::set<std::string> different(labels.begin(), labels.end());
    EXPECT_EQ(different.size(), std::set<std::string>(names.begin(), names.end()).size());
    for (const std::string& label : labels) {
        EXPECT_LE(std::count(label.begin(), label.end(), '\n') + 1, static_cast<std::ptrdiff_t>(room.lines)) << label;
        std::istringstream lines(label);
        for (std::string line; std::getline(lines, line);) EXPECT_LE(room.width_of(line), room.width) << label;
    }
}

TEST(Labels, OfDifferentNamesAreDifferentAndFit) {
    const std::vector<std::string> names{"Titanium white",
                                         "Titanium white paste",
                                         "Titanium yellow",
                                         "Titanium",
                                         "my blue sky 1",
                                         "my blue sky 2",
                                         "my blue sky 2 copy",
                                         "\xe9\x92\x9b\xe7\x99\xbd\xe9\xa2\x9c\xe6\x96\x99",
                                         "a",
                                         "",
                                         "white\tpaste",
                                         "white paste"};
    for (const std::size_t lines : {1, 2, 3})
        for (const float width : {6.0f, 8.0f, 12.0f, 40.0f}) {
            SCOPED_TRACE(std::to_string(lines) + " lines of " + std::to_string(width));
            expect_told_apart(names, {lines, width, characters});
        }
}

TEST(Labels, ANameThatFitsStaysAsItIs) {
    EXPECT_EQ(make_distinct({"Iron red", "Iron"}, {1, 8, characters}), (std::vector<std::string>{"Iron red", "Iron"}));
    EXPECT_EQ(make_distinct({"Iron red"}, {2, 5, characters}), (std::vector<std::string>{"Iron\nred"}));
    EXPECT_EQ(make_distinct({"Iron", "Iron"}, {1, 8, characters}), (std::vector<std::string>{"Iron", "Iron"}));
}

// At the sizes that the panel has: four columns and three gaps of 2 in 202 pixels, letters of 0.7 of the font.
TEST(Labels, OfTheShippedInksAreToldApartInBothLanguagesAtEachScale) {
    for (const float scale : {1.0f, 1.25f, 1.5f, 2.0f, 3.0f}) {
        ImGui::CreateContext();
        Ui ui;
        ui.prepare({.scale = scale});
        ImGui::GetIO().Fonts->Build();
        const ImFont* font = ImGui::GetIO().Fonts->Fonts[0];
        const float letters = 0.7f * font->FontSize, width = 49 * scale;
        const auto width_of = [&](const std::string& text) {
            return font->CalcTextSizeA(letters, 1e9f, 0, text.c_str()).x;
        };
        std::vector<std::string> english, chinese;
        for (const std::string& name : ink::list_inks()) {
            english.emplace_back(english_name(name.c_str()));
            chinese.emplace_back(chinese_text(name.c_str()));
        }
        for (const std::size_t lines : {1, 2}) {
            expect_told_apart(english, {lines, width, width_of});
            expect_told_apart(chinese, {lines, width, width_of});
        }
        ImGui::DestroyContext();
    }
}

TEST(Labels, PartsOfARecipeAreBrokenBetweenThemAlone) {
    const std::vector<std::string> parts{"27.4 % red, ", "5.65 % black, ", "65.2 % water ", "(20 \xce\xbcm)"};
    EXPECT_EQ(lines_of(parts, 100, characters), "27.4 % red, 5.65 % black, 65.2 % water (20 \xce\xbcm)");
    EXPECT_EQ(lines_of(parts, 25, characters), "27.4 % red, 5.65 % black,\n65.2 % water (20 \xce\xbcm)");
    EXPECT_EQ(lines_of(parts, 24, characters), "27.4 % red,\n5.65 % black,\n65.2 % water (20 \xce\xbcm)");
    EXPECT_EQ(lines_of(parts, 1, characters), "27.4 % red,\n5.65 % black,\n65.2 % water\n(20 \xce\xbcm)");
    EXPECT_EQ(lines_of({}, 10, characters), "");
}

}  // namespace
}  // namespace tuft::app
