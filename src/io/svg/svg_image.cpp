#include "io/svg/svg_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <pugixml.hpp>
#include <vector>

#include "core/error.h"
#include "core/files/files.h"
#include "core/system/interrupt.h"
#include "core/text/text.h"
#include "io/image/image.h"
#include "io/scene/materials.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 20;  // of a picture's file
constexpr std::size_t kMostPixels = std::size_t{1} << 26;  // of a picture
constexpr std::size_t kMostPictures = 1000;                // of a drawing

/// Bytes of base64 (RFC 4648); blanks are skipped. Empty where it is none.
std::vector<char> bytes_of_base64(std::string_view text) {
    std::vector<char> out;
    std::uint32_t bits = 0;
    int n = 0;
    for (const char c : text) {
        if (c == '=' || c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
        const int value = c >= 'A' && c <= 'Z'   ? c - 'A'
                          : c >= 'a' && c <= 'z' ? c - 'a' + 26
                          : c >= '0' && c <= '9' ? c - '0' + 52
                          : c == '+'             ? 62
                          : c == '/'             ? 63
                                                 : -1;
        if (value < 0) return {};
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        if (n += 6; n >= 8) n -= 8, out.push_back(static_cast<char>(bits >> n & 0xff));
    }
    return out;
}

/// Blanks and other characters of a URI (RFC 3986, 2.1).
std::string unescaped(std::string_view uri) {
    std::string out;
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = uri[i] == '%' && i + 2 < uri.size() ? digit(uri[i + 1]) : -1,
                  low = high >= 0 ? digit(uri[i + 2]) : -1;
        if (low < 0) {
            out.push_back(uri[i]);
            continue;
        }
        out.push_back(static_cast<char>(16 * high + low));
        i += 2;
    }
    return out;
}

double darkness_of(const Image8& image, std::size_t pixel) {
    const std::uint8_t* p = &image.pixels[pixel * static_cast<std::size_t>(image.channels)];
    const double luma = image.channels >= 3 ? 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2] : p[0];
    const double alpha = image.channels == 2 ? p[1] : image.channels >= 4 ? p[3] : 255;
    return alpha / 255 * (255 - luma);
}

/// Means over the squares of a coarser grid.
stroke::AreaImage reduced(const Image8& image) {
    stroke::AreaImage out;
    const double scale = std::min(1.0, double(stroke::kMaxAreaSide) / std::max(image.width, image.height));
    out.width = std::max(1, static_cast<int>(image.width * scale));
    out.height = std::max(1, static_cast<int>(image.height * scale));
    out.darkness.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int j = 0; j < out.height; ++j) {
        check_interrupt();
        const int y0 = static_cast<int>(std::int64_t{j} * image.height / out.height),
                  y1 = static_cast<int>(std::int64_t{j + 1} * image.height / out.height);
        for (int i = 0; i < out.width; ++i) {
            const int x0 = static_cast<int>(std::int64_t{i} * image.width / out.width),
                      x1 = static_cast<int>(std::int64_t{i + 1} * image.width / out.width);
            double sum = 0;
            for (int y = y0; y < y1; ++y)
                for (int x = x0; x < x1; ++x)
                    sum += darkness_of(image, static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                                  static_cast<std::size_t>(x));
            out.darkness[static_cast<std::size_t>(j) * static_cast<std::size_t>(out.width) +
                         static_cast<std::size_t>(i)] =
                static_cast<std::uint8_t>(std::lround(sum / (std::max(1, y1 - y0) * std::max(1, x1 - x0))));
        }
    }
    return out;
}

std::vector<char> bytes_of(const std::string& href, const fs::path& folder) {
    if (href.starts_with("data:")) {
        const std::size_t comma = href.find(',');
        const std::string head = href.substr(0, comma);
        if (comma == href.npos || !head.ends_with(";base64"))
            throw Error(excerpt(head), "only data in base64 are read");
        if (href.size() > 2 * kMostBytes) throw Error(excerpt(head), "the picture is too large");
        std::vector<char> bytes = bytes_of_base64(std::string_view(href).substr(comma + 1));
        if (bytes.empty()) throw Error(excerpt(head), "its data are no base64");
        return bytes;
    }
    const std::string name = unescaped(href);
    const fs::path file(name);
    if (href.empty() || href.starts_with('#') || href.find("://") != href.npos)
        throw Error(excerpt(href), "it is no picture in the drawing's folder");
    if (folder.empty() || file.is_absolute() || !lies_within(folder, folder / file))
        throw Error(excerpt(href), "it lies outside the drawing's folder");
    return read_file(folder / file, kMostBytes);
}

}  // namespace

std::optional<SvgPlacedPicture> svg_place_picture(std::shared_ptr<const stroke::AreaImage> pixels,
                                                  const pugi::xml_node& node, const SvgPictureFrame& frame,
                                                  const std::string& source) {
    if (!(frame.port.size.x > 0 && frame.port.size.y > 0)) return {};
    pugi::xml_document document;
    pugi::xml_node inner = document.append_child("svg");
    inner.append_attribute("viewBox") =
        ("0 0 " + std::to_string(pixels->width) + " " + std::to_string(pixels->height)).c_str();
    if (const auto ratio = node.attribute("preserveAspectRatio")) inner.append_copy(ratio);
    const SvgMatrix own = svg_framing(inner, frame.port, source).matrix * svg_scaling(pixels->width, pixels->height);
    const SvgMatrix whole = frame.matrix * own;
    if (glm::determinant(whole) == 0) return {};
    SvgPlacedPicture placed{std::make_shared<const SvgPicture>(SvgPicture{std::move(pixels), glm::inverse(whole)}),
                            {{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (Vec2& p : placed.rectangle) p = Vec2(own * Vec3(p, 1));
    return placed;
}

std::shared_ptr<const stroke::AreaImage> SvgPictures::read(const std::string& href) {
    if (const auto at = known_.find(href); at != known_.end()) return at->second;
    if (known_.size() >= kMostPictures) throw Error(excerpt(href), "the drawing has too many pictures");
    const std::vector<char> bytes = bytes_of(href, folder_);
    const std::string name = excerpt(href.starts_with("data:") ? href.substr(0, href.find(',')) : href);
    return known_[href] = std::make_shared<const stroke::AreaImage>(reduced(decode_image8(bytes, name, kMostPixels)));
}

}  // namespace tuft::io
