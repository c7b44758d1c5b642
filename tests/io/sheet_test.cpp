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
