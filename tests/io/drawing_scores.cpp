#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <pugixml.hpp>

#include "../stroke/sheet.h"
#include "core/error.h"
#include "core/files/files.h"
#include "ink/composite/composite.h"
#include "ink/composite/match.h"
#include "ink/spectra/srgb.h"
#include "io/image/image.h"
#include "io/svg/style/svg_page.h"
#include "io/svg/svg.h"
#include "stroke/drawing/drawing.h"

/// Scores of coloured drawings beside rasters of them by another program:
///
///     io_drawing_scores FOLDER        # NAME.svg beside NAME.png, its larger side 300 pixels, for each NAME
///
/// Each drawing is painted onto a sheet of 300 by 300 texels. Says for each the intersection over union of what is
/// painted in it and in its raster (half covered and more), and the median and the mean of ΔE2000 within both, away
/// from edges, over pixels whose colour the pigments reach within ΔE2000 3; then the means.
namespace tuft {
namespace {

constexpr int kSide = 300;    // pixels
constexpr int kMargin = 8;    // texels round the sheet
constexpr int kEven = 2;      // codes by which pixels of one area differ
constexpr double kReach = 3;  // ΔE2000

struct Score {
    double iou = 0, median = 0, mean = 0, reached = 0;
};

std::vector<stroke::JournalEntry> placed(const std::filesystem::path& svg) {
    pugi::xml_document document;
    document.load_file(svg.c_str());
    const io::SvgPage page = io::svg_page(document.document_element(), svg.string());
    std::vector<stroke::JournalEntry> entries;
    for (stroke::RecordedStroke& r : io::read_svg(svg, {.painting = io::SvgPainting::areas}))
        for (stroke::Preparation& before : r.before) entries.emplace_back(std::get<stroke::Fill>(before));
    const double scale = stroke::kSide / std::max(page.size.x, page.size.y);
    stroke::Placement sheet;
    sheet.mapping = stroke::SurfaceMapping::project;
    for (stroke::FlatArea* area : stroke::areas_in(entries, true)) {
        stroke::transform_area(*area, 0.5 * page.size, scale);
        area->placement = sheet;
    }
    return entries;
}

const stroke::Model& sheet_model() {
    static const stroke::Model model = stroke::sheet({}, kSide + 2 * kMargin);
    return model;
}

/// Colours (linear) or films of the sheet in the raster's pixels.
template <class Map>
std::vector<std::vector<float>> in_pixels(const Map& map) {
    std::vector<std::vector<float>> out(kSide * kSide);
    const atlas::TexelMap& texels = sheet_model().texels;
    for (std::uint32_t y = 0; y < texels.size; ++y)
        for (std::uint32_t x = 0; x < texels.size; ++x) {
            const atlas::TexelRef at = atlas::texel_ref(texels, x, y);
            if (!at.valid()) continue;
            const Vec3 p(texels.position(at.slot, at.texel));
            const int i = static_cast<int>(std::floor((p.x / stroke::kSide + 0.5) * kSide)),
                      j = static_cast<int>(std::floor((0.5 - p.y / stroke::kSide) * kSide));
            if (i < 0 || j < 0 || i >= kSide || j >= kSide) continue;
            const auto* first =
                &map.texels[(std::size_t{y} * texels.size + x) * static_cast<std::size_t>(map.channels)];
            out[static_cast<std::size_t>(j * kSide + i)].assign(first, first + map.channels);
        }
    return out;
}

std::vector<std::vector<float>> colours_of(const std::vector<stroke::JournalEntry>& entries) {
    stroke::Document document(sheet_model());
    for (const stroke::JournalEntry& entry : entries) document.paint(entry);
    const stroke::Appearance& shown = document.appearance();
    return in_pixels(
        ink::compose_linear(shown.stack(), sheet_model().texels, shown.substrate(), shown.compose_options()));
}

/// Coverage by all areas together.
std::vector<double> coverage_of(std::vector<stroke::JournalEntry> entries) {
    for (stroke::FlatArea* area : stroke::areas_in(entries, true))
        for (stroke::AreaStop& stop : area->stops) stop.ink = "carbon", stop.film = stop.opacity;
    stroke::Document document(sheet_model());
    for (stroke::JournalEntry& entry : entries) {
        entry.get<stroke::Fill>().ink = "carbon";
        document.paint(entry);
    }
    const double full = document.materials().ink("carbon").strength();
    std::vector<double> out;
    const auto amounts = in_pixels(ink::compose_amounts(document.appearance().stack(), sheet_model().texels,
                                                        document.appearance().compose_options()));
    for (const std::vector<float>& pixel : amounts) {
        double sum = 0;
        for (const float a : pixel) sum += double(a);
        out.push_back(sum / full);
    }
    return out;
}

/// ΔE2000 that the pigments leave to a colour.
double unreached(const ink::Rgb& colour) {
    static std::map<std::string, double> known;
    const std::string hex = ink::to_hex(colour);
    const auto [at, fresh] = known.try_emplace(hex, 0.0);
    if (fresh) at->second = ink::match_on_canvas(colour, ink::load_substrate("porcelain"), {}, {.film = 0}).delta_e;
    return at->second;
}

double difference(const ink::Rgb& a, const ink::Rgb& b) {
    const auto lab = [](const ink::Rgb& c) { return ink::lab_of_rgb({double(c[0]), double(c[1]), double(c[2])}); };
    return ink::delta_e_2000(lab(a), lab(b));
}

Score score(const std::filesystem::path& svg, const std::filesystem::path& png) {
    const std::vector<stroke::JournalEntry> entries = placed(svg);
    const io::Image8 raster = io::read_image8(png);
    if (std::max(raster.width, raster.height) != kSide || (raster.channels != 4 && raster.channels != 3))
        throw Error(png.string(), "is not 300 pixels large and in colours");
    const std::vector<double> covered = coverage_of(entries);
    const std::vector<std::vector<float>> colours = colours_of(entries);
    // In the middle of the sheet.
    const int left = (kSide - raster.width) / 2, top = (kSide - raster.height) / 2;
    const auto channel = [&](int x, int y, std::size_t k) -> std::uint8_t {
        x -= left, y -= top;
        if (x < 0 || y < 0 || x >= raster.width || y >= raster.height) return 0;
        if (k >= static_cast<std::size_t>(raster.channels)) return 255;
        return raster.pixels[static_cast<std::size_t>(raster.channels * (y * raster.width + x)) + k];
    };
    const auto alpha = [&](int x, int y) { return channel(x, y, 3); };
    const auto colour = [&](int x, int y) {
        ink::Rgb rgb;
        for (std::size_t k = 0; k < 3; ++k) rgb[k] = ink::srgb_decode(float(channel(x, y, k)) / 255);
        return rgb;
    };
    std::size_t both = 0, either = 0, inner = 0, reached = 0;
    std::vector<double> errors;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const bool a = covered[static_cast<std::size_t>(y * kSide + x)] >= 0.5, b = alpha(x, y) >= 128;
            both += a && b, either += a || b;
            bool even = a && alpha(x, y) == 255 && x > 1 && y > 1 && x < kSide - 2 && y < kSide - 2;
            for (int j = -2; j <= 2 && even; ++j)
                for (int i = -2; i <= 2 && even; ++i)
                    for (std::size_t k = 0; k < 4 && even; ++k)
                        even = std::abs(int(channel(x + i, y + j, k)) - int(channel(x, y, k))) <= kEven;
            if (!even) continue;
            ++inner;
            if (unreached(colour(x, y)) > kReach) continue;
            ++reached;
            const std::vector<float>& c = colours[static_cast<std::size_t>(y * kSide + x)];
            errors.push_back(difference({c[0], c[1], c[2]}, colour(x, y)));
        }
    Score s{.iou = either ? double(both) / double(either) : 1, .reached = inner ? double(reached) / double(inner) : 0};
    if (errors.empty()) return s;
    for (const double e : errors) s.mean += e / double(errors.size());
    std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
    s.median = errors[errors.size() / 2];
    return s;
}

int run(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> drawings;
    for (const auto& file : std::filesystem::directory_iterator(folder))
        if (file.path().extension() == ".svg") drawings.push_back(file.path());
    std::sort(drawings.begin(), drawings.end());
    double iou = 0, worst = 1, mean = 0, n_mean = 0;
    fmt::print("{:<34} {:>6} {:>8} {:>8} {:>8}\n", "drawing", "IoU", "median", "mean dE", "reached");
    for (const std::filesystem::path& svg : drawings) {
        std::filesystem::path png = svg;
        png.replace_extension(".png");
        const Score s = score(svg, png);
        fmt::print("{:<34} {:>6.4f} {:>8.2f} {:>8.2f} {:>7.0f}%\n", svg.stem().string(), s.iou, s.median, s.mean,
                   100 * s.reached);
        std::fflush(stdout);
        iou += s.iou, worst = std::min(worst, s.iou);
        if (s.reached > 0) mean += s.mean, n_mean += 1;
    }
    const double n = static_cast<double>(std::max<std::size_t>(1, drawings.size()));
    fmt::print("{} drawings: mean IoU {:.4f}, worst {:.4f}, mean dE2000 {:.2f}\n", drawings.size(), iou / n, worst,
               n_mean > 0 ? mean / n_mean : 0);
    return 0;
}

}  // namespace
}  // namespace tuft

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "io_drawing_scores FOLDER\n");
        return 2;
    }
    try {
        return tuft::run(argv[1]);
    } catch (const std::exception& e) {
        fmt::print(stderr, "{}\n", e.what());
        return 1;
    }
}
