#include "io/strokes/svg_style.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <pugixml.hpp>

#include "io/strokes/inkml_marks.h"

namespace tuft::io {
namespace {

std::string canonical(std::string_view colour) {
    std::string out;
    for (const char c : colour)
        if (!std::isspace(static_cast<unsigned char>(c)))
            out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

}  // namespace

std::string svg_reference(std::string_view value) {
    value = stripped(value);
    if (!value.starts_with("url(")) return {};
    std::string target(stripped(value.substr(4, std::min(value.find(')'), value.size()) - 4)));
    std::erase_if(target, [](char c) { return c == '"' || c == '\''; });
    return target.starts_with('#') ? target.substr(1) : std::string();
}

SvgPaint svg_paint(const std::string& value, const SvgIds& ids, const SvgColour& current) {
    using Kind = SvgPaint::Kind;
    std::string_view left = value;
    while (left.starts_with("url(")) {  // a fallback may be a reference again
        const std::size_t close = std::min(left.find(')'), left.size());
        const std::string target = svg_reference(left);
        const auto at = target.empty() ? ids.end() : ids.find(target);
        if (at != ids.end())
            return {local_name(at->second) == "pattern" ? Kind::pattern : Kind::gradient, {}, {}, target};
        left = close < left.size() ? stripped(left.substr(close + 1)) : std::string_view();
        if (left.empty()) return {Kind::missing, {}, {}, {}};
    }
    if (const std::size_t icc = left.find("icc-color"); icc != left.npos && icc > 0)
        left = stripped(left.substr(0, icc));
    const std::string colour = canonical(left);
    if (colour == "none" || colour == "transparent") return {};
    const SvgColour own = colour == "currentcolor" ? current : svg_colour(left).value_or(SvgColour{});
    const bool white = own == SvgColour{{1, 1, 1}, 1};
    return {white ? Kind::white : Kind::flat, colour, own, {}};
}

double svg_part(const std::string& text, double otherwise) {
    if (text.empty()) return otherwise;
    const double value = std::strtod(text.c_str(), nullptr) / (text.back() == '%' ? 100 : 1);
    return std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : otherwise;
}

}  // namespace tuft::io
