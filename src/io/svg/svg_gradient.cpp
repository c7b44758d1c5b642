#include "io/svg/svg_gradient.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <pugixml.hpp>

#include "io/strokes/inkml_marks.h"

namespace tuft::io {
namespace {

constexpr int kMostReferences = 64;
constexpr std::size_t kMostStops = 256;

/// The id that an element refers to; empty: none of this file.
std::string id_in_href(const pugi::xml_node& node) {
    const std::string target = svg_href(node);
    return target.starts_with('#') ? target.substr(1) : std::string();
}

/// A gradient and those that it refers to.
class Chain {
  public:
    Chain(const std::string& id, const SvgIds& ids) {
        for (auto at = ids.find(id); at != ids.end() && int(nodes_.size()) < kMostReferences;
             at = ids.find(id_in_href(at->second))) {
            const std::string_view name = local_name(at->second);
            if (name != "linearGradient" && name != "radialGradient") break;
            nodes_.push_back(at->second);
        }
    }
    bool empty() const { return nodes_.empty(); }
    bool radial() const { return local_name(nodes_.front()) == "radialGradient"; }
    std::string text(const char* name) const {
        for (const pugi::xml_node& node : nodes_)
            if (const auto own = node.attribute(name)) return own.value();
        return {};
    }
    pugi::xml_node with_stops() const {
        for (const pugi::xml_node& node : nodes_)
            for (const pugi::xml_node& child : node.children())
                if (local_name(child) == "stop") return node;
        return {};
    }

  private:
    std::vector<pugi::xml_node> nodes_;
};

std::vector<SvgStop> stops_of(const pugi::xml_node& node, const SvgSheet& sheet) {
    std::vector<SvgStop> stops;
    for (const pugi::xml_node& child : node.children()) {
        if (local_name(child) != "stop" || stops.size() >= kMostStops) continue;
        const SvgDeclarations declared = sheet.declared(child);
        const auto own = [&](const char* name) {
            const auto at = declared.find(name);
            return at != declared.end() ? at->second : std::string(child.attribute(name).value());
        };
        SvgStop stop;
        stop.at = svg_part(own("offset"), 0);
        if (!stops.empty()) stop.at = std::max(stop.at, stops.back().at);
        const std::string colour = own("stop-color");
        const SvgColour current = svg_colour(own("color")).value_or(SvgColour{});
        stop.colour =
            colour == "currentColor" || colour == "currentcolor" ? current : svg_colour(colour).value_or(SvgColour{});
        stop.colour.alpha *= svg_part(own("stop-opacity"), 1);
        stops.push_back(stop);
    }
    return stops;
}

}  // namespace

std::optional<SvgGradient> svg_gradient(const std::string& id, const SvgGradientUse& use, const SvgIds& ids,
                                        const SvgSheet& sheet, const std::string& source) {
    const Chain chain(id, ids);
    if (chain.empty()) return {};
    SvgGradient g{.radial = chain.radial(), .stops = stops_of(chain.with_stops(), sheet)};
    if (g.stops.empty()) return {};
    const bool in_box = chain.text("gradientUnits") != "userSpaceOnUse";
    const Vec2 page = in_box ? Vec2(1) : use.page;
    const auto number = [&](const char* name, double otherwise, double whole) {
        const std::string text = chain.text(name);
        if (text.empty()) return otherwise * whole;
        SvgReader in(text, source);
        const double value = in.number();
        return in.peek() == '%' ? value / 100 * whole : value;
    };
    SvgMatrix m = use.matrix;
    if (in_box) {
        const Vec2 size = use.high - use.low;
        if (!(size.x > 0 && size.y > 0)) return {};
        m = m * svg_translation(use.low.x, use.low.y) * svg_scaling(size.x, size.y);
    }
    if (const std::string own = chain.text("gradientTransform"); !own.empty())
        m = m * svg_transform(own.c_str(), source);
    const std::string spread = chain.text("spreadMethod");
    if (spread == "reflect") g.spread = SvgGradient::Spread::reflect;
    if (spread == "repeat") g.spread = SvgGradient::Spread::repeat;
    const auto last_only = [&] { g.stops = {g.stops.back()}; };
    if (g.radial) {
        const double diagonal = glm::length(page) / std::numbers::sqrt2;
        const Vec2 centre(number("cx", 0.5, page.x), number("cy", 0.5, page.y));
        const double r = number("r", 0.5, diagonal);
        Vec2 focus(chain.text("fx").empty() ? centre.x : number("fx", 0, page.x),
                   chain.text("fy").empty() ? centre.y : number("fy", 0, page.y));
        if (!(r > 0)) {
            last_only();
        } else {
            m = m * svg_translation(centre.x, centre.y) * svg_scaling(r, r);
            g.focus = (focus - centre) / r;
            constexpr double kInside = 0.99;  // a focus outside lies on the circle (13.2.3), where t has no end
            if (glm::length(g.focus) > kInside) g.focus *= kInside / glm::length(g.focus);
        }
    } else {
        const Vec2 from(number("x1", 0, page.x), number("y1", 0, page.y)),
            to(number("x2", 1, page.x), number("y2", 0, page.y));
        const Vec2 axis = to - from;
        if (!(glm::length(axis) > 0))
            last_only();
        else
            m = m * SvgMatrix(axis.x, axis.y, 0, -axis.y, axis.x, 0, from.x, from.y, 1);
    }
    const double det = glm::determinant(m);
    if (!std::isfinite(det) || det == 0) {
        last_only();
        return g;
    }
    g.to_unit = glm::inverse(m);
    return g;
}

}  // namespace tuft::io
