#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "core/error.h"
#include "core/files/files.h"
#include "io/image/image.h"
#include "io/sheet/sheet_files.h"

namespace tuft::io {
namespace {

namespace fs = std::filesystem;

constexpr double kMm = 1e-3;

/// A page of 123.4 × 87.6 mm: a cut line of 60 × 40 mm at (20, 30), a mark, a label, a picture of 2 × 3 pixels of 5 mm
/// inside the cut line.
decal::Sheet sample(bool plates) {
    decal::Sheet sheet;
    decal::Page page{.size = {0.1234, 0.0876}};
    page.lines.push_back({{{0.02, 0.03}, {0.08, 0.03}, {0.08, 0.07}, {0.02, 0.07}}, true, decal::Role::cut});
    page.lines.push_back({{{0.002, 0.005}, {0.008, 0.005}}, false, decal::Role::mark});
    page.lines.push_back({{{0.02, 0.072}, {0.025, 0.075}, {0.03, 0.072}}, false, decal::Role::label});
    decal::PrintImage image{.width = 2, .height = 3, .origin = {0.03, 0.04}, .pixel = 5 * kMm};
    image.rgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30, 40, 50, 60, 70, 80, 90};
    image.alpha = {255, 255, 255, 255, 255, 0};
    if (plates) {
        image.plates = {{0, 51, 102, 153, 204, 255}, {255, 200, 150, 100, 50, 0}};
        sheet.plates = {{"cobalt-underglaze", {0.1, 0.2, 0.6}, 1.5}, {"iron red", {0.6, 0.2, 0.1}, 2.0}};
    }
    page.prints.push_back(image);
    sheet.pages.push_back(page);
    return sheet;
}

class SheetFiles : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft_sheet_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string output_of(const std::string& command) const {
        const fs::path out = folder_ / "out.txt";
        if (std::system((command + " > '" + out.string() + "' 2>/dev/null").c_str()) != 0) return {};
        std::ifstream file(out);
        std::stringstream text;
        text << file.rdbuf();
        return text.str();
    }
    static std::string text_of(const fs::path& path) {
        const std::vector<char> bytes = read_file(path);
        return {bytes.begin(), bytes.end()};
    }

    fs::path folder_;
};

struct Extent {
    double left = 1e9, right = -1e9, bottom = 1e9, top = -1e9;
};

TEST_F(SheetFiles, PdfHasItsSizeAndCutLineInTrueMillimetres) {
    const fs::path pdf = folder_ / "sheet.pdf";
    ASSERT_EQ(write_sheet(pdf, sample(false)).size(), 1u);
    const std::string info = output_of("pdfinfo '" + pdf.string() + "'");
    if (info.empty()) GTEST_SKIP() << "poppler-utils is not installed";
    std::smatch m;
    ASSERT_TRUE(std::regex_search(info, m, std::regex("Page size: *([0-9.]+) x ([0-9.]+) pts")));
    EXPECT_NEAR(std::stod(m[1]) * 25.4 / 72, 123.4, 0.05);
    EXPECT_NEAR(std::stod(m[2]) * 25.4 / 72, 87.6, 0.05);
    // Rasterised by another program at 1200 dpi: pixels of 0.02 mm.
    output_of("pdftoppm -r 1200 -png '" + pdf.string() + "' '" + (folder_ / "page").string() + "'");
    const Image8 page = read_image8(folder_ / "page-1.png");
    const double pixel = 25.4 / 1200;
    Extent cut;
    for (int y = 0; y < page.height; ++y)
        for (int x = 0; x < page.width; ++x) {
            const std::uint8_t* p =
                &page.pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(page.width) +
                                  static_cast<std::size_t>(x))];
            const bool magenta = p[0] > 200 && p[1] < 100 && p[2] > 100 && p[2] < 200;
            if (!magenta) continue;
            cut.left = std::min(cut.left, (x + 0.5) * pixel), cut.right = std::max(cut.right, (x + 0.5) * pixel);
            const double up = (page.height - y - 0.5) * pixel;
            cut.bottom = std::min(cut.bottom, up), cut.top = std::max(cut.top, up);
        }
    const double half = 0.5 * 0.25 * 25.4 / 72;  // of the line
    EXPECT_NEAR(cut.left, 20 - half, 0.05);
    EXPECT_NEAR(cut.right, 80 + half, 0.05);
    EXPECT_NEAR(cut.bottom, 30 - half, 0.05);
    EXPECT_NEAR(cut.top, 70 + half, 0.05);
    // The first picture's pixels, where they should be; the transparent one is paper.
    const auto at = [&](double x, double y) {
        const auto i = static_cast<std::size_t>((87.6 - y) / pixel) * static_cast<std::size_t>(page.width) +
                       static_cast<std::size_t>(x / pixel);
        return std::array<int, 3>{page.pixels[3 * i], page.pixels[3 * i + 1], page.pixels[3 * i + 2]};
    };
    EXPECT_EQ(at(32.5, 52.5), (std::array<int, 3>{255, 0, 0}));
    EXPECT_EQ(at(37.5, 52.5), (std::array<int, 3>{0, 255, 0}));
    EXPECT_EQ(at(32.5, 42.5), (std::array<int, 3>{40, 50, 60}));
    EXPECT_EQ(at(37.5, 42.5), (std::array<int, 3>{255, 255, 255}));
}

TEST_F(SheetFiles, PdfCutsInASpotColourThatOverprints) {
    const std::string pdf = pdf_bytes(sample(false));
    EXPECT_TRUE(std::regex_search(pdf, std::regex(R"(/Separation\s*/CutContour\s*/DeviceCMYK)")));
    EXPECT_TRUE(std::regex_search(pdf, std::regex(R"(/OP true)")));
    EXPECT_EQ(pdf, pdf_bytes(sample(false)));  // the same sheet is the same file, whatever the clock says
    EXPECT_EQ(pdf.find("CreationDate"), std::string::npos);
}

TEST_F(SheetFiles, PdfHoldsAPlateForEachPigment) {
    const fs::path pdf = folder_ / "plates.pdf";
    const decal::Sheet sheet = sample(true);
    write_sheet(pdf, sheet);
    const std::string bytes = text_of(pdf);
    EXPECT_NE(bytes.find("/cobalt-underglaze"), std::string::npos);
    EXPECT_NE(bytes.find("/iron#20red"), std::string::npos);
    const std::string list = output_of("pdfimages -list '" + pdf.string() + "'");
    if (list.empty()) GTEST_SKIP() << "poppler-utils is not installed";
    const std::regex separation(" sep ");
    EXPECT_EQ(std::distance(std::sregex_iterator(list.begin(), list.end(), separation), std::sregex_iterator()), 2);
}

// Poppler rounds each product down, so that eight plates without ink were a grey of 247.
TEST_F(SheetFiles, PlatesWithoutInkAreNotSeen) {
    decal::Sheet sheet = sample(true);
    decal::PrintImage& image = sheet.pages[0].prints[0];
    sheet.plates.clear();
    image.plates.clear();
    for (int i = 0; i < 8; ++i) {
        sheet.plates.push_back({"plate " + std::to_string(i), {0.1, 0.2, 0.6}, 1});
        image.plates.push_back({0, 0, 0, 0, 0, 255});
    }
    const fs::path pdf = folder_ / "eight.pdf";
    write_sheet(pdf, sheet);
    output_of("pdftoppm -r 25.4 -png '" + pdf.string() + "' '" + (folder_ / "eight").string() + "'");
    if (!fs::exists(folder_ / "eight-1.png")) GTEST_SKIP() << "poppler-utils is not installed";
    const Image8 page = read_image8(folder_ / "eight-1.png");
    const auto red = [&](int x, int y) {
        return page.pixels[3 * (static_cast<std::size_t>(87 - y) * static_cast<std::size_t>(page.width) +
                                static_cast<std::size_t>(x))];
    };
    EXPECT_EQ(red(32, 52), 255);
    EXPECT_LT(red(37, 42), 10);  // 0.1^8
}

// Ghostscript, which shares nothing with us, parts the file into its inks: a grey picture of each, white without ink.
// On its screen picture the plates lie over each other: the product of their tints' colours. 3 of 255: it rounds both.
TEST_F(SheetFiles, AnotherReaderFindsThePlatesByTheirNamesAndTheirColoursTogether) {
    const decal::Sheet sheet = sample(true);
    const fs::path pdf = folder_ / "plates.pdf";
    write_sheet(pdf, sheet);
    const std::string gs = "gs -q -dNOPAUSE -dBATCH -dSAFER -r50.8 -sOutputFile='" + folder_.string() + "/";
    if (output_of("gs --version").empty()) GTEST_SKIP() << "ghostscript is not installed";
    output_of(gs + "p.tif' -sDEVICE=tiffsep '" + pdf.string() + "'");
    output_of(gs + "p.png' -sDEVICE=png16m '" + pdf.string() + "'");
    ASSERT_TRUE(fs::exists(folder_ / "p(CutContour).tif"));
    const Image8 screen = read_image8(folder_ / "p.png"), cut = read_image8(folder_ / "p(CutContour).tif");
    std::vector<Image8> plates;
    for (const decal::Plate& plate : sheet.plates) {
        ASSERT_TRUE(fs::exists(folder_ / ("p(" + plate.name + ").tif"))) << plate.name;
        plates.push_back(read_image8(folder_ / ("p(" + plate.name + ").tif")));
    }
    const auto at = [&](const Image8& image, double x, double y) {
        return static_cast<std::size_t>(2 * (87.6 - y)) * static_cast<std::size_t>(image.width) +
               static_cast<std::size_t>(2 * x);
    };
    int darkest = 255;  // about the cut line: the page is no whole number of pixels high
    for (const double y : {29.5, 30.0, 30.5}) darkest = std::min<int>(darkest, cut.pixels[at(cut, 50, y)]);
    EXPECT_LT(darkest, 255);
    EXPECT_EQ(cut.pixels[at(cut, 50, 50)], 255);
    for (std::size_t i = 0; i < 6; ++i) {
        const double x = 32.5 + 5 * static_cast<double>(i % 2), y = 52.5 - 5 * static_cast<double>(i / 2);
        std::array<double, 3> product{255, 255, 255};
        for (std::size_t m = 0; m < plates.size(); ++m) {
            const int tint = 255 - plates[m].pixels[at(plates[m], x, y)];
            EXPECT_NEAR(tint, sheet.pages[0].prints[0].plates[m][i], 1);
            for (std::size_t c = 0; c < 3; ++c) product[c] *= 1 - tint / 255.0 * (1 - sheet.plates[m].colour[c]);
        }
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(screen.pixels[3 * at(screen, x, y) + c], product[c], 3) << i;
    }
}

/// The page without pictures: a square of 40 × 20 mm with a hole of 10 × 10 mm in the first ink, a triangle in the
/// second.
decal::Sheet outlined(bool plates) {
    decal::Sheet sheet = sample(plates);
    sheet.pages[0].prints.clear();
    sheet.inks = {{.name = "cobalt-underglaze", .colour = {0.2, 0.4, 0.6}},
                  {.name = "iron <red>", .colour = {0.6, 0.4, 0.2}}};
    if (plates) sheet.plates = {{"cobalt-underglaze", {0.2, 0.4, 0.6}, 1.5}, {"iron <red>", {0.6, 0.4, 0.2}, 2.0}};
    sheet.pages[0].areas = {{0,
                             {{{0.03, 0.04}, {0.07, 0.04}, {0.07, 0.06}, {0.03, 0.06}},
                              {{0.04, 0.045}, {0.04, 0.055}, {0.05, 0.055}, {0.05, 0.045}}}},
                            {1, {{{0.022, 0.032}, {0.028, 0.032}, {0.025, 0.038}}}}};
    return sheet;
}

TEST_F(SheetFiles, AreasOfOneInkAreFilledPathsWithTheirHoles) {
    for (const bool plates : {false, true}) {
        const fs::path pdf = folder_ / (plates ? "plates.pdf" : "inks.pdf");
        write_sheet(pdf, outlined(plates));
        if (output_of("pdfinfo '" + pdf.string() + "'").empty()) GTEST_SKIP() << "poppler-utils is not installed";
        EXPECT_EQ(output_of("pdfimages -list '" + pdf.string() + "'").find("image"), std::string::npos);
        output_of("pdftoppm -r 254 -png '" + pdf.string() + "' '" + (folder_ / "areas").string() + "'");
        const Image8 page = read_image8(folder_ / "areas-1.png");
        const auto at = [&](double x, double y) {
            const auto i = static_cast<std::size_t>((87.6 - y) * 10) * static_cast<std::size_t>(page.width) +
                           static_cast<std::size_t>(x * 10);
            return std::array<int, 3>{page.pixels[3 * i], page.pixels[3 * i + 1], page.pixels[3 * i + 2]};
        };
        EXPECT_EQ(at(32, 50), (std::array<int, 3>{51, 102, 153}));  // 0.2, 0.4, 0.6 of 255
        EXPECT_EQ(at(60, 50), (std::array<int, 3>{51, 102, 153}));
        EXPECT_EQ(at(45, 50), (std::array<int, 3>{255, 255, 255}));  // the hole
        EXPECT_EQ(at(25, 34), (std::array<int, 3>{153, 102, 51}));
    }
    const std::string svg = svg_text(outlined(false), 0);
    EXPECT_NE(svg.find("id=\"Ink cobalt-underglaze\""), std::string::npos);
    EXPECT_NE(svg.find("id=\"Ink iron _red_\""), std::string::npos);  // no characters that CAD forbids
    EXPECT_NE(svg.find("fill=\"#336699\""), std::string::npos);
    EXPECT_NE(svg.find("M40.0000,42.6000 L40.0000,32.6000"), std::string::npos);
}

TEST_F(SheetFiles, SvgIsInMillimetres) {
    const fs::path path = folder_ / "sheet.svg";
    ASSERT_EQ(write_sheet(path, sample(false)), std::vector<fs::path>{path});
    const std::string svg = text_of(path);
    EXPECT_NE(svg.find("width=\"123.4000mm\" height=\"87.6000mm\" viewBox=\"0 0 123.4000 87.6000\""),
              std::string::npos);
    const auto layer = svg.find("id=\"CutContour\"");
    ASSERT_NE(layer, std::string::npos);
    EXPECT_NE(svg.find("M20.0000,57.6000 L80.0000,57.6000 L80.0000,17.6000 L20.0000,17.6000 Z", layer),
              std::string::npos);
    EXPECT_NE(svg.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
}

/// Reads DXF as pairs of code and value, on its own.
std::vector<std::pair<int, std::string>> dxf_pairs(const std::string& text) {
    std::vector<std::pair<int, std::string>> pairs;
    std::istringstream lines(text);
    for (std::string code, value; std::getline(lines, code) && std::getline(lines, value);)
        pairs.emplace_back(std::stoi(code), value);
    return pairs;
}

TEST_F(SheetFiles, DxfHasClosedPolylinesOnNamedLayers) {
    const fs::path path = folder_ / "sheet.dxf";
    ASSERT_EQ(write_sheet(path, sample(false)), std::vector<fs::path>{path});
    const auto pairs = dxf_pairs(text_of(path));
    std::map<std::string, std::vector<Vec2>> points;
    bool closed = false;
    for (std::size_t i = 0; i + 3 < pairs.size(); ++i) {
        if (pairs[i].first != 0) continue;
        if (pairs[i].second == "POLYLINE" && pairs[i + 1].second == "CutContour")
            for (std::size_t k = i + 1; pairs[k].first != 0; ++k)
                if (pairs[k].first == 70) closed = pairs[k].second == "1";
        if (pairs[i].second == "VERTEX")
            points[pairs[i + 1].second].push_back({std::stod(pairs[i + 2].second), std::stod(pairs[i + 3].second)});
    }
    EXPECT_TRUE(closed);
    ASSERT_EQ(points["CutContour"].size(), 4u);
    EXPECT_EQ(points["CutContour"][2], Vec2(80, 70));
    EXPECT_EQ(points["Registration"].size(), 2u);
    EXPECT_EQ(points["Labels"].size(), 3u);
    EXPECT_EQ(pairs.back(), (std::pair<int, std::string>{0, "EOF"}));
}

TEST_F(SheetFiles, DxfHasAClosedPolylineForEachBorderOfAnInk) {
    const auto pairs = dxf_pairs(dxf_text(outlined(true), 0));
    std::map<std::string, int> closed;
    std::vector<std::string> layers;
    for (std::size_t i = 0; i + 7 < pairs.size(); ++i) {
        if (pairs[i] == std::pair<int, std::string>{0, "LAYER"}) layers.push_back(pairs[i + 1].second);
        if (pairs[i] == std::pair<int, std::string>{0, "POLYLINE"} && pairs[i + 6].second == "1")
            ++closed[pairs[i + 1].second];
    }
    EXPECT_EQ(closed["Ink_cobalt-underglaze"], 2);
    EXPECT_EQ(closed["Ink_iron__red_"], 1);
    EXPECT_EQ(std::count(layers.begin(), layers.end(), "Ink_iron__red_"), 1);
}

// R12 knows at most 31 of A-Z 0-9 $ - _ in the name of a layer, and no capitals.
TEST_F(SheetFiles, EachInkHasALayerOfItsOwnByTheRulesOfTheFormat) {
    decal::Sheet sheet;
    for (const char* name : {"indigo 70 + gamboge 30", "A", "a", "a/b", "a:b", "墨", "朱",
                             "carbon black 50 + burnt sienna 30 + white 20", "carbon black 50 + burnt sienna 20"})
        sheet.inks.push_back({.name = name});
    EXPECT_EQ(
        dxf_ink_layers(sheet),
        (std::vector<std::string>{"Ink_indigo_70___gamboge_30", "Ink_A", "Ink_a_2", "Ink_a_b", "Ink_a_b_2", "Ink__",
                                  "Ink___2", "Ink_carbon_black_50___burnt_sie", "Ink_carbon_black_50___burnt_s_2"}));
    const std::vector<std::string> names = ink_layers(sheet);
    EXPECT_EQ(names[0], "Ink indigo 70 + gamboge 30");
    EXPECT_EQ(names[4], "Ink a_b_2");
    EXPECT_EQ(names[5], "Ink 墨");
}

// 4: millimetres, 1: metric (DXF reference, header variables).
TEST_F(SheetFiles, DxfHeaderSaysMillimetres) {
    const fs::path path = folder_ / "sheet.dxf";
    write_sheet(path, sample(false));
    std::map<std::string, std::string> header;
    const auto pairs = dxf_pairs(text_of(path));
    for (std::size_t i = 0; i + 1 < pairs.size(); ++i)
        if (pairs[i].first == 9) header[pairs[i].second] = pairs[i + 1].second;
    EXPECT_EQ(header["$ACADVER"], "AC1009");
    EXPECT_EQ(header["$INSUNITS"], "4");
    EXPECT_EQ(header["$MEASUREMENT"], "1");
}

TEST_F(SheetFiles, DxfIsReadByEzdxf) {
    const fs::path path = folder_ / "sheet.dxf", script = folder_ / "read.py";
    write_sheet(path, sample(false));
    std::ofstream(script) << "import sys, ezdxf\n"
                             "d = ezdxf.readfile(sys.argv[1])\n"
                             "print('mm' if d.units == ezdxf.units.MM else 'other', len(d.audit().errors))\n"
                             "for p in d.modelspace().query('POLYLINE'):\n"
                             "    at = (v.dxf.location for v in p.vertices)\n"
                             "    print(p.dxf.layer, p.is_closed, *('%g,%g' % (v.x, v.y) for v in at))\n";
    const std::string python = "/usr/bin/python3 ";  // Debian's, which has Debian's modules
    if (output_of(python + "-c 'import importlib.util as u; exit(not u.find_spec(\"ezdxf\"))' && echo yes").empty())
        GTEST_SKIP() << "python3-ezdxf is not installed";
    EXPECT_EQ(output_of(python + "'" + script.string() + "' '" + path.string() + "'"),
              "mm 0\n"
              "CutContour True 20,30 80,30 80,70 20,70\n"
              "Registration False 2,5 8,5\n"
              "Labels False 20,72 25,75 30,72\n");
}

TEST_F(SheetFiles, SeveralPagesAreNumberedFilesAndAllOrNone) {
    decal::Sheet sheet = sample(false);
    sheet.pages.push_back(sheet.pages[0]);
    sheet.pages.push_back(sheet.pages[0]);
    sheet.pages[2].strain_map = true;
    EXPECT_EQ(write_sheet(folder_ / "a.svg", sheet).size(), 3u);
    EXPECT_EQ(write_sheet(folder_ / "a.dxf", sheet), (std::vector<fs::path>{folder_ / "a-1.dxf", folder_ / "a-2.dxf"}));
    EXPECT_TRUE(fs::exists(folder_ / "a-2.dxf"));
    EXPECT_THROW(write_sheet(folder_ / "missing" / "a.svg", sheet), Error);
    EXPECT_THROW(write_sheet(folder_ / "a.txt", sheet), Error);
    EXPECT_THROW(write_sheet(folder_ / "b.svg", sample(true)), Error);
    EXPECT_FALSE(fs::exists(folder_ / "b.svg"));
}

}  // namespace
}  // namespace tuft::io
