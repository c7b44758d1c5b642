#include "io/svg/style/svg_style.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <pugixml.hpp>
#include <utility>

#include "io/strokes/inkml_marks.h"
#include "io/svg/style/svg_page.h"

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

std::string svg_href(const pugi::xml_node& node) {
    const std::string target = node.attribute("href").value();
    return target.empty() ? node.attribute("xlink:href").value() : target;
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

void inherit_style(SvgStyle& style, const SvgProperty& own, const SvgIds& ids, const std::string& source) {
    if (const std::string colour = own("color"); !colour.empty())
        style.current = svg_colour(colour).value_or(style.current);
    if (const std::string paint = own("stroke"); !paint.empty()) style.stroke = svg_paint(paint, ids, style.current);
    if (const std::string paint = own("fill"); !paint.empty()) style.fill = svg_paint(paint, ids, style.current);
    if (const std::string width = own("stroke-width"); !width.empty() && width.back() != '%')
        style.pen.width = std::max(0.0, svg_length(width, source) / kSvgPixel);
    const auto rule_of = [&](const char* name, FillRule& to) {
        if (const std::string rule = own(name); !rule.empty())
            to = rule == "evenodd" ? FillRule::even_odd : FillRule::nonzero;
    };
    rule_of("fill-rule", style.rule);
    rule_of("clip-rule", style.clip_rule);
    if (const std::string seen = own("visibility"); !seen.empty()) style.visible = seen == "visible";
    if (const std::string cap = own("stroke-linecap"); !cap.empty())
        style.pen.cap = cap == "round" ? SvgCap::round : cap == "square" ? SvgCap::square : SvgCap::butt;
    if (const std::string join = own("stroke-linejoin"); !join.empty())
        style.pen.join = join == "round" ? SvgJoin::round : join == "bevel" ? SvgJoin::bevel : SvgJoin::miter;
    if (const std::string limit = own("stroke-miterlimit"); !limit.empty())
        style.pen.miter_limit = std::max(1.0, SvgReader(limit, source).number());
    if (const std::string dashes = own("stroke-dasharray"); !dashes.empty())
        style.pen.dashes = svg_dashes(dashes, source);
    if (const std::string offset = own("stroke-dashoffset"); !offset.empty() && offset.back() != '%')
        style.pen.dash_offset = svg_length(offset, source) / kSvgPixel;
    if (const std::string all = own("marker"); !all.empty())
        style.marker_start = style.marker_mid = style.marker_end = svg_reference(all);
    for (const auto& [name, to] :
         {std::pair("marker-start", &style.marker_start), std::pair("marker-mid", &style.marker_mid),
          std::pair("marker-end", &style.marker_end)})
        if (const std::string value = own(name); !value.empty()) *to = svg_reference(value);
    style.fill_opacity = svg_part(own("fill-opacity"), style.fill_opacity);
    style.stroke_opacity = svg_part(own("stroke-opacity"), style.stroke_opacity);
    if (const std::string order = own("paint-order"); !order.empty()) {
        const std::size_t stroke = order.find("stroke");
        style.stroke_first = stroke != std::string::npos && stroke < order.find("fill");
    }
    if (states_font(own)) {
        SvgFont font = style.font ? *style.font : SvgFont{};
        inherit_font(font, own);
        style.font = std::make_shared<const SvgFont>(std::move(font));
    }
}

}  // namespace tuft::io
