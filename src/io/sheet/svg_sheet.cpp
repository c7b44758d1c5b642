#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/image/image.h"
#include "io/sheet/sheet_files.h"

namespace tuft::io {
namespace {

constexpr double kMm = 1000;  // millimetres per metre

std::string base64(const std::vector<unsigned char>& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= n ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string picture(const decal::PrintImage& image, double height, const ImageOptions& options) {
    std::vector<std::uint8_t> rgba;
    rgba.reserve(4 * image.alpha.size());
    for (std::size_t i = 0; i < image.alpha.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) rgba.push_back(image.rgb[3 * i + c]);
        rgba.push_back(image.alpha[i]);
    }
    const double top = height - image.origin.y - image.height * image.pixel;
    return fmt::format(
        "<image x=\"{:.4f}\" y=\"{:.4f}\" width=\"{:.4f}\" height=\"{:.4f}\" preserveAspectRatio=\"none\" "
        "xlink:href=\"data:image/png;base64,{}\"/>\n",
        kMm * image.origin.x, kMm * top, kMm * image.width * image.pixel, kMm * image.height * image.pixel,
        base64(png_bytes(view_of(image.width, image.height, 4, rgba.data()), options)));
}

std::string lines_of(const decal::Page& page, decal::Role role) {
    std::string text;
    for (const decal::Line& line : page.lines) {
        if (line.role != role) continue;
        text += "<path d=\"";
        for (std::size_t i = 0; i < line.points.size(); ++i)
            text += fmt::format("{}{:.4f},{:.4f}", i == 0 ? "M" : " L", kMm * line.points[i].x,
                                kMm * (page.size.y - line.points[i].y));
        text += line.closed ? " Z\"/>\n" : "\"/>\n";
    }
    return text;
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return out;
}

std::string layer(const std::string& name, const std::string& style, const std::string& content) {
    return fmt::format(
        "<g id=\"{0}\" class=\"{0}\" inkscape:groupmode=\"layer\" inkscape:label=\"{0}\" {1}>\n{2}</g>\n", name, style,
        content);
}

/// A layer for each ink. Plates lie over each other as films do.
std::string areas_of(const decal::Sheet& sheet, const decal::Page& page) {
    std::string text;
    const std::vector<std::string> names = ink_layers(sheet);
    for (std::size_t i = 0; i < sheet.inks.size(); ++i) {
        std::string paths;
        for (const decal::InkArea& area : page.areas) {
            if (area.ink != i) continue;
            paths += "<path d=\"";
            for (const decal::Ring& ring : area.region) {
                for (std::size_t k = 0; k < ring.size(); ++k)
                    paths += fmt::format("{}{:.4f},{:.4f}", k == 0 ? "M" : " L", kMm * ring[k].x,
                                         kMm * (page.size.y - ring[k].y));
                paths += " Z ";
            }
            paths += "\"/>\n";
        }
        if (paths.empty()) continue;
        const std::array<double, 3> colour = sheet.inks[i].srgb.value_or(sheet.inks[i].colour);
        const auto byte = [&](std::size_t c) { return std::lround(255 * std::clamp(colour[c], 0.0, 1.0)); };
        text += layer(escaped(names[i]),
                      fmt::format("fill=\"#{:02x}{:02x}{:02x}\" fill-rule=\"nonzero\" stroke=\"none\"{}", byte(0),
                                  byte(1), byte(2), sheet.plates.empty() ? "" : " style=\"mix-blend-mode:multiply\""),
                      paths);
    }
    return text;
}

}  // namespace

std::string svg_text(const decal::Sheet& sheet, std::size_t index) {
    const decal::Page& page = sheet.pages[index];
    std::string pictures;
    const ImageOptions options{.srgb = sheet.profile.empty(), .icc_profile = sheet.profile};
    for (const decal::PrintImage& image : page.prints) pictures += picture(image, page.size.y, options);
    return fmt::format(
               "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
               "xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
               "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\" width=\"{0:.4f}mm\" "
               "height=\"{1:.4f}mm\" viewBox=\"0 0 {0:.4f} {1:.4f}\">\n",
               kMm * page.size.x, kMm * page.size.y) +
           layer("Print", "", pictures) + areas_of(sheet, page) +
           layer("Labels",
                 "fill=\"none\" stroke=\"#000000\" stroke-width=\"0.18\" stroke-linecap=\"round\" "
                 "stroke-linejoin=\"round\"",
                 lines_of(page, decal::Role::label)) +
           layer("Registration", "fill=\"none\" stroke=\"#000000\" stroke-width=\"0.09\"",
                 lines_of(page, decal::Role::mark)) +
           layer(kCutContour, "fill=\"none\" stroke=\"#ff00ff\" stroke-width=\"0.09\"",
                 lines_of(page, decal::Role::cut)) +
           "</svg>\n";
}

}  // namespace tuft::io
