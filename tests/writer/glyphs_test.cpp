#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "core/error.h"
#include "core/files/files.h"
#include "io/font/installed_fonts.h"
#include "writer/gesture/stroke_line.h"
#include "writer/glyphs/glyph_source.h"
#include "writer/glyphs/outline_font.h"

namespace tuft::writer {
namespace {

constexpr const char* kTen =
    R"({"character":"十","strokes":["M 100 380 L 900 380 L 900 420 L 100 420 Z","M 480 0 L 520 0 L 520 800 L 480 800 Z"],)"
    R"("medians":[[[110,400],[890,400]],[[500,790],[500,10]]]})";

std::string fault_of(const std::string& json) {
    try {
        parse_hanzi_json(json, U'十', "file.json");
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(HanziJson, MediansAndOutlinesAreInTheSquare) {
    const Glyph g = parse_hanzi_json(kTen, U'x', "file.json");
    EXPECT_EQ(g.code, U'十');
    ASSERT_EQ(g.strokes.size(), 2u);
    EXPECT_EQ(g.strokes[0].median.front(), Vec2(110, 524));  // the baseline lies 124 units above the square's edge
    ASSERT_EQ(g.strokes[1].outline.size(), 1u);
    EXPECT_EQ(g.strokes[1].outline[0][0], Vec2(480, 124));
}

TEST(HanziJson, DamagedFilesAreOneLineWithTheirName) {
    const std::string deep(5000, '[');
    for (const std::string& json :
         {std::string("{"), std::string("[]"), std::string("{}"), std::string(R"({"medians":7})"), deep,
          std::string(R"({"medians":[[[1,2]]]})"), std::string(R"({"medians":[[[1,2],[1e300,2]]]})"),
          std::string(R"({"medians":[[[1,2],["a",2]]]})"), std::string(R"({"medians":[[[1,2],[3,4]]],"strokes":[]})"),
          std::string(R"({"medians":[[[1,2],[3,4]]],"strokes":["M 1 nan"]})")}) {
        const std::string fault = fault_of(json);
        EXPECT_TRUE(fault.starts_with("file.json")) << json.substr(0, 60) << ": " << fault;
        EXPECT_EQ(fault.find('\n'), std::string::npos);
    }
}

TEST(KanjiSvg, StrokesHaveTheirTypeAndTheSquareOf109) {
    const Glyph g = parse_kanji_svg(
        R"(<svg xmlns="http://www.w3.org/2000/svg" xmlns:kvg="http://kanjivg.tagaini.net" viewBox="0 0 109 109">)"
        R"(<g id="a"><g id="b"><path kvg:type="㇐" d="M10.9,54.5 L98.1,54.5"/></g><path d="M54.5,10c0,30,0,60,0,90"/></g>)"
        R"(<g id="numbers"><text>1</text></g></svg>)",
        U'十', "053.svg");
    ASSERT_EQ(g.strokes.size(), 2u);
    EXPECT_EQ(g.strokes[0].type, "㇐");
    // 0.1 of the side and the inset of 12 units; half way up.
    EXPECT_NEAR(g.strokes[0].median.front().x, 0.1 * kSide + 12, 1e-6);
    EXPECT_NEAR(g.strokes[0].median.front().y, 0.5 * kSide, 1e-6);
}

// KanjiVG's folder has other forms of characters beside them. They are no fonts.
TEST(KanjiSvg, AFolderWithOtherFormsOfCharactersIsRead) {
    const auto folder = std::filesystem::path(testing::TempDir()) / ("tuft-kanjivg-" + std::to_string(getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const std::string one = "<svg><path d='M10,54 L98,54'/></svg>", other = "<svg><path d='M54,10 L54,98'/></svg>";
    write_file(folder / "04e00.svg", one.data(), one.size());
    write_file(folder / "04e00-Kaisho.svg", other.data(), other.size());
    const auto source = open_glyphs(folder);
    const auto glyph = source->find(U'一');
    ASSERT_TRUE(glyph);
    EXPECT_EQ(glyph->strokes.at(0).median.front().y,
              glyph->strokes.at(0).median.back().y);  // level: not the other form
    EXPECT_FALSE(source->find(U'二'));
    std::filesystem::remove_all(folder);
}

TEST(KanjiSvg, DeepAndEmptyOnesAreRefused) {
    std::string deep;
    for (int i = 0; i < 500; ++i) deep += "<g>";
    for (const std::string& svg : {std::string("<svg>") + deep, std::string("<svg/>"), std::string("none"),
                                   std::string("<svg><path d='M0 0 L1e99 0'/></svg>")})
        EXPECT_THROW(parse_kanji_svg(svg, U'a', "x.svg"), Error) << svg.substr(0, 40);
}

TEST(LineFont, OpenPathsAreStrokesInUnitsOfTheEm) {
    const std::vector<Glyph> font =
        parse_line_font(
            R"(<svg><defs><font horiz-adv-x="500"><font-face units-per-em="2048" descent="-512"/>)"
            R"(<glyph unicode="T" d="M0 1400 L1000 1400 M500 1400 L500 0"/><glyph unicode="ab" d="M0 0 L1 1"/></font></defs></svg>)",
            "font.svg")
            .glyphs;
    ASSERT_EQ(font.size(), 1u);  // a ligature is no character
    ASSERT_EQ(font[0].strokes.size(), 2u);
    EXPECT_TRUE(font[0].single_line);
    EXPECT_EQ(font[0].advance, 250);
    EXPECT_EQ(font[0].strokes[1].median.back(), Vec2(250, 256));
}

// By the name of its family an installed font gives the characters of its file, and what is none is named.
TEST(OutlineFont, IsFoundByTheNameOfItsFamily) {
    const io::InstalledFont installed = io::find_font({.families = {"sans-serif"}});
    if (installed.file.empty()) GTEST_SKIP() << "no font is installed";
    const auto named = open_glyphs(installed.family)->find(U'R'),
               of_file = open_outline_font(installed.file, installed.face)->find(U'R');
    ASSERT_TRUE(named && of_file);
    EXPECT_EQ(named->advance, of_file->advance);
    ASSERT_FALSE(named->area.empty());
    EXPECT_EQ(named->area, of_file->area);
    for (const char* name : {"No Such Family Of Letters", "no/such/file", "missing.ttf", "sans-serif"})
        EXPECT_THROW(open_glyphs(name), Error) << name;
}

TEST(LineFont, KerningIsTakenFromTheAdvanceOfTheFirst) {
    const auto font = parse_line_font(
        R"(<svg><defs><font horiz-adv-x="500"><font-face units-per-em="2048"/><glyph unicode="A" d="M0 0 L9 0"/>)"
        R"(<hkern u1="A,B" u2="V,W" k="100"/></font></defs></svg>)",
        "font.svg");
    EXPECT_EQ(font.kerning.size(), 4u);
    EXPECT_EQ(font.kerning.at({U'B', U'V'}), 50);
    const auto bundled = open_glyphs(bundled_glyphs());
    const double k = bundled->kerning(U'A', U'V');
    EXPECT_GT(k, 20);
    const auto line = bundled->find_line(U"AVA");
    EXPECT_EQ(line[0]->advance, bundled->find(U'A')->advance - k);
    EXPECT_EQ(line[2]->advance, bundled->find(U'A')->advance);
}

TEST(Bundled, AtLeastFortyCharactersAndAnAlphabetAreThere) {
    const auto source = open_glyphs(bundled_glyphs());
    int n = 0;
    for (char32_t c = 0x4E00; c < 0xA000; ++c)
        if (const auto glyph = source->find(c)) {
            ++n;
            EXPECT_FALSE(glyph->single_line);
        }
    EXPECT_GE(n, 40);
    for (const char32_t c : std::u32string(U"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.,!?-"))
        EXPECT_TRUE(source->find(c).has_value()) << utf8_of(c);
}

// A poem with its punctuation, and what a word processor makes of quotes and dashes.
// A pen that follows its own ink fills a counter, and on a small letter it is a blot. A branch leaves a stem (n, r)
// within 140 units; more than 160 is a second stroke along the first.
TEST(Bundled, StrokesOfALetterDoNotRunAlongOneAnother) {
    const auto source = open_glyphs(bundled_glyphs());
    for (char32_t code = U'A'; code <= U'z'; ++code) {
        const std::optional<Glyph> glyph = source->find(code);
        if (!glyph || (code > U'Z' && code < U'a')) continue;
        for (std::size_t i = 0; i < glyph->strokes.size(); ++i)
            for (std::size_t k = i + 1; k < glyph->strokes.size(); ++k) {
                const StrokeLine one = make_stroke_line(glyph->strokes[i].median),
                                 other = make_stroke_line(glyph->strokes[k].median);
                const auto beside = std::count_if(one.points.begin(), one.points.end(), [&](const Vec2& p) {
                    return std::any_of(other.points.begin(), other.points.end(),
                                       [&](const Vec2& q) { return glm::distance(p, q) < 20; });
                });
                EXPECT_LT(static_cast<double>(beside) * StrokeLine::kApart, 160) << utf8_of(code);
            }
    }
}

TEST(Bundled, PunctuationIsThere) {
    const auto source = open_glyphs(bundled_glyphs());
    for (const char32_t c : std::u32string(U"、，。「」『』《》〈〉・·…—–‘’“”+=")) {
        const auto glyph = source->find(c);
        ASSERT_TRUE(glyph) << utf8_of(c);
        for (const GlyphStroke& s : glyph->strokes)
            for (const Vec2& p : s.median) {
                EXPECT_GE(std::min(p.x, p.y), 0) << utf8_of(c);
                EXPECT_LE(std::max(p.x / glyph->advance, p.y / kSide), 1) << utf8_of(c);
            }
    }
}

TEST(Bundled, AFullWidthFormIsItsCharacterInTheMiddleOfASquare) {
    const auto source = open_glyphs(bundled_glyphs());
    const auto line = glyphs_of({U"永？"}, {source.get()})[0];
    const Glyph narrow = *source->find(U'?');
    ASSERT_EQ(line.size(), 2u);
    EXPECT_EQ(line[1].code, U'？');
    EXPECT_EQ(line[1].advance, kSide);
    EXPECT_EQ(line[1].strokes[0].median[0].x - narrow.strokes[0].median[0].x, 0.5 * (kSide - narrow.advance));
}

TEST(Bundled, MissingCharactersAreNamedInOneLine) {
    const auto source = open_glyphs(bundled_glyphs());
    try {
        glyphs_of({U"永鑫 A", U"麤"}, {source.get()});
        FAIL();
    } catch (const Error& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("鑫"), std::string::npos) << what;
        EXPECT_NE(what.find("麤"), std::string::npos) << what;
        EXPECT_EQ(what.find("永"), std::string::npos) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos);
    }
}

TEST(Characters, Utf8GoesThereAndBack) {
    const std::string text = "aé永𠮷";
    std::string back;
    for (const char32_t c : characters_of(text)) back += utf8_of(c);
    EXPECT_EQ(back, text);
    EXPECT_THROW(characters_of(std::string(1 << 20, 'a')), Error);
}

}  // namespace
}  // namespace tuft::writer
