#include "io/svg/style/svg_page.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <pugixml.hpp>

#include "core/error.h"
#include "io/strokes/inkml_marks.h"

namespace tuft::io {

double svg_length(const std::string& text, const std::string& source) {
    if (text.empty() || text.back() == '%') return 0;
    SvgReader in(text, source);
    const double value = in.number();
    const std::string unit = in.word();
    if (unit == "mm") return value * 1e-3;
    if (unit == "cm") return value * 1e-2;
    if (unit == "in") return value * 0.0254;
    if (unit == "pt") return value * 0.0254 / 72;
    if (unit == "pc") return value * 0.0254 / 6;
    return value * kSvgPixel;
}

double svg_number(const pugi::xml_node& node, const char* name, const Vec2& page, const std::string& source) {
    const std::string text = node.attribute(name).value();
    if (text.empty()) return 0;
    SvgReader in(text, source);
    const double value = in.number();
    if (in.peek() == '%') {
        const std::string_view along(name);
        const double whole = along == "r" ? glm::length(page) / std::numbers::sqrt2
                             : along.find('y') != along.npos || along == "height" ? page.y
                                                                                  : page.x;
        return value / 100 * whole;
    }
    return in.word().empty() ? value : svg_length(text, source) / kSvgPixel;
}

std::vector<double> svg_dashes(const std::string& text, const std::string& source) {
    if (text == "none" || text.find_first_of("123456789") == std::string::npos) return {};
    std::vector<double> dashes;
    SvgReader in(text, source);
    while (in.number_next() && dashes.size() < 1000) {
        const double value = in.number();
        if (value < 0) return {};
        if (in.peek() == '%') return {};
        std::string unit = in.word();
        dashes.push_back(unit.empty() ? value : value * svg_length("1" + unit, source) / kSvgPixel);
    }
    const std::size_t n = dashes.size();
    if (n % 2 == 1)
        for (std::size_t i = 0; i < n; ++i) dashes.push_back(dashes[i]);
    return dashes;
}

double svg_growth(const SvgMatrix& m) {
    return std::sqrt(std::abs(m[0][0] * m[1][1] - m[1][0] * m[0][1]));
}

SvgPage svg_page(const pugi::xml_node& svg, const std::string& source) {
    const double width = svg_length(svg.attribute("width").value(), source),
                 height = svg_length(svg.attribute("height").value(), source);
    SvgPage page{svg_scaling(kSvgPixel, kSvgPixel), {width / kSvgPixel, height / kSvgPixel}, {width, height}};
    const std::string box = svg.attribute("viewBox").value();
    if (box.empty()) return page;
    SvgReader in(box, source);
    const double x = in.number(), y = in.number(), w = in.number();
    if (!(w > 0)) throw Error(source, "the viewBox has no width");
    const double h = in.number_next() ? in.number() : 0;
    const double scale = width > 0 ? width / w : height > 0 && h > 0 ? height / h : kSvgPixel;
    return {svg_scaling(scale, scale) * svg_translation(-x, -y), {w, h}, {scale * w, scale * h}};
}

SvgFraming svg_framing(const pugi::xml_node& node, const SvgViewport& port, const std::string& source) {
    SvgFraming out{svg_translation(port.corner.x, port.corner.y), port.size};
    const std::string box = node.attribute("viewBox").value();
    if (box.empty()) return out;
    SvgReader in(box, source);
    const double x = in.number(), y = in.number(), w = in.number(), h = in.number();
    if (!(w > 0 && h > 0)) return out;
    out.view = {w, h};
    Vec2 scale = port.size / Vec2(w, h);
    const std::string aspect = node.attribute("preserveAspectRatio").value();
    Vec2 left(0);
    if (aspect.find("none") == std::string::npos) {
        scale =
            Vec2(aspect.find("slice") != std::string::npos ? std::max(scale.x, scale.y) : std::min(scale.x, scale.y));
        const auto part = [&](const char* low, const char* high) {
            return aspect.find(low) != std::string::npos ? 0.0 : aspect.find(high) != std::string::npos ? 1.0 : 0.5;
        };
        left = (port.size - scale * Vec2(w, h)) * Vec2(part("xMin", "xMax"), part("YMin", "YMax"));
    }
    out.matrix = out.matrix * svg_translation(left.x, left.y) * svg_scaling(scale.x, scale.y) * svg_translation(-x, -y);
    return out;
}

std::vector<SvgLine> svg_lines(const pugi::xml_node& node, const std::string& name, const SvgCurves& curves,
                               const Vec2& page, const std::string& source, bool* damaged) {
    const auto number = [&](const char* of) { return svg_number(node, of, page, source); };
    std::vector<SvgLine> lines;
    const auto emit = [&](SvgLine line) {
        if (!line.empty()) lines.push_back(std::move(line));
    };
    if (name == "path") {
        try {
            svg_path(node.attribute("d").value(), source, curves, emit);
        } catch (const Error&) {
            if (!damaged) throw;
            *damaged = true;
        }
    } else if (name == "polyline" || name == "polygon") {
        emit(svg_points(node.attribute("points").value(), source, name == "polygon"));
    } else if (name == "line") {
        emit({{number("x1"), number("y1")}, {number("x2"), number("y2")}});
    } else if (name == "rect") {
        // A corner without one of its radii has both alike.
        Vec2 radii(number("rx"), number("ry"));
        if (!node.attribute("rx")) radii.x = radii.y;
        if (!node.attribute("ry")) radii.y = radii.x;
        emit(svg_rectangle({number("x"), number("y")}, {number("width"), number("height")}, radii, curves));
    } else if (name == "circle") {
        emit(svg_ellipse({number("cx"), number("cy")}, Vec2(number("r")), curves));
    } else if (name == "ellipse") {
        emit(svg_ellipse({number("cx"), number("cy")}, {number("rx"), number("ry")}, curves));
    }
    return lines;
}

std::vector<SvgLine> svg_transformed_lines(const pugi::xml_node& node, const SvgCurves& curves, const Vec2& page,
                                           const std::string& source) {
    std::vector<SvgLine> lines = svg_lines(node, std::string(local_name(node)), curves, page, source);
    if (const auto transform = node.attribute("transform")) {
        const SvgMatrix matrix = svg_transform(transform.value(), source);
        for (SvgLine& line : lines)
            for (Vec2& p : line) p = Vec2(matrix * Vec3(p, 1));
    }
    return lines;
}

}  // namespace tuft::io
