#include "io/strokes/inkml_marks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "core/text/units.h"
#include "stroke/journal/journal.h"

namespace tuft::io {

namespace {

using pugi::xml_node;

constexpr double kLeastDirection = 1e-12;  // length of a vector that shall be normalised; the greatest is its inverse

Vec3 vector_of(const InkmlText& file, const xml_node& node, std::string_view text, std::string_view unit) {
    double v[3];
    for (double& x : v) {
        text = trimmed(text);
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
        if (error != std::errc{} || !std::isfinite(x))
            file.fail(node, Message("{} needs three numbers", std::string(node.attribute("type").value())));
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
    if (!trimmed(text).empty() && trimmed(text) != unit)
        file.fail(node, Message("{} needs three numbers, millimetres", std::string(node.attribute("type").value())));
    return {v[0], v[1], v[2]};
}

/// Metres.
Vec3 point_of(const InkmlText& file, const xml_node& node, std::string_view text) {
    const bool metres = trimmed(text).ends_with('m') && !trimmed(text).ends_with("mm");
    const Vec3 p = metres ? vector_of(file, node, text, "m") : kMillimetre * vector_of(file, node, text, "mm");
    if (!within(p))
        file.fail(node, Message("{} lies more than 10 km away", std::string(node.attribute("type").value())));
    return p;
}

Vec3 direction_of(const InkmlText& file, const xml_node& node, std::string_view text) {
    const Vec3 v = vector_of(file, node, text, "mm");
    if (!(glm::length(v) > kLeastDirection && within(v, 1 / kLeastDirection)))
        file.fail(node, "a placement's direction is zero, or no direction");
    return is_unit(glm::dot(v, v)) ? v : glm::normalize(v);
}

std::string name_of(const InkmlText& file, const xml_node& node, std::string_view text, const char* of_what) {
    try {
        stroke::check_name(text, of_what);
    } catch (const Error& e) {
        file.fail(node, e.message());
    }
    return std::string(text);
}

stroke::StrokeSettings settings_of(const InkmlText& file, const xml_node& node, std::string_view text) {
    try {
        return stroke::settings_from_json(std::string(text));
    } catch (const Error& e) {
        file.fail(node, e.message());
    }
}

bool is_care(std::string_view type) {
    return type == "dip" || type == "rinse" || type == "reshape" || type == "dry" || type == "fill" || type == "wipe" ||
           type == "wash";
}

stroke::Fill fill_of(const InkmlText& file, const xml_node& node) {
    stroke::Fill fill;
    const auto number = [&](const char* name, double& to) {
        if (node.attribute(name)) to = file.number_of(node, name);
    };
    const auto point = [&](const char* name, Vec3& to) {
        if (node.attribute(name)) to = point_of(file, node, node.attribute(name).value());
    };
    number("film", fill.film);
    fill.to_film = fill.film;
    number("to_film", fill.to_film);
    point("at", fill.at);
    point("from", fill.from);
    point("to", fill.to);
    fill.to_ink = node.attribute("to_ink").value();
    try {
        if (node.attribute("region")) fill.region = stroke::region_of(node.attribute("region").value());
        if (const auto area = node.attribute("area")) fill.area = stroke::area_of_text(area.value());
        if (node.attribute("gradient")) fill.gradient = stroke::gradient_of(node.attribute("gradient").value());
        if (fill.region != stroke::Region::all && !fill.area && !node.attribute("at"))
            file.fail(node, "a fill of a part or a chart needs a point: at=\"x y z\"");
        stroke::check_fill(fill);
    } catch (const Error& e) {
        if (std::string(e.what()).starts_with(file.path)) throw;
        file.fail(node, e.message());
    }
    return fill;
}

/// Seconds to dry for; nothing written: until all is dry.
double seconds_of(const InkmlText& file, const xml_node& node, std::string_view text) {
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (!text.empty() && (error != std::errc() || end != text.data() + text.size()))
        file.fail(node, Message("'{}' is no number of seconds", std::string(text)));
    try {
        stroke::check_seconds(x);
    } catch (const Error& e) {
        file.fail(node, e.message());
    }
    return x;
}

stroke::BrushChange change_of(const InkmlText& file, const xml_node& node, stroke::EntryKind kind) {
    stroke::BrushChange change = stroke::change_of(kind);
    for (const stroke::ChangeNumber& n : stroke::numbers_of(stroke::Dip{})) {  // the kind that has them all
        const std::string_view text = node.attribute(n.name).value();
        if (text.empty()) continue;
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size())
            file.fail(node,
                      Message("{} of a dip or wipe is a number, not '{}'", std::string(n.name), std::string(text)));
        if (!stroke::set_number(change, n.name, value))
            file.fail(node, Message("a {} has no {}", stroke::name_of(kind), std::string(n.name)));
    }
    try {
        stroke::check_change(change);
    } catch (const Error& e) {
        file.fail(node, e.message());
    }
    return change;
}

/// Four numbers an edge, metres.
std::vector<stroke::StencilEdge> stencil_of(const InkmlText& file, const xml_node& node, std::string_view text) {
    std::vector<double> numbers;
    while (!text.empty()) {
        const std::size_t begin = text.find_first_not_of(", \t\r\n"),
                          end = std::min(text.find_first_of(", \t\r\n", begin), text.size());
        if (begin == std::string_view::npos) break;
        const auto x = to_number(text.substr(begin, end - begin));
        if (!x || numbers.size() >= 4 * stroke::kMaxStencilEdges)
            file.fail(node, "tuft:stencil is not a list of edges, four numbers each");
        if (!(std::abs(*x) <= kFarthest)) file.fail(node, "an edge of tuft:stencil lies more than 10 km away");
        numbers.push_back(*x);
        text.remove_prefix(end);
    }
    if (numbers.size() % 4 != 0) file.fail(node, "tuft:stencil has an edge without four numbers");
    std::vector<stroke::StencilEdge> stencil;
    for (std::size_t i = 0; i < numbers.size(); i += 4)
        stencil.push_back({{numbers[i], numbers[i + 1]}, {numbers[i + 2], numbers[i + 3]}});
    return stencil;
}

stroke::Preparation preparation_of(const InkmlText& file, const xml_node& node, stroke::EntryKind kind,
                                   std::string_view text) {
    if (kind == stroke::EntryKind::dry) return stroke::Dry{.seconds = seconds_of(file, node, text)};
    if (kind == stroke::EntryKind::wash) return stroke::WashPalette{};
    if (kind == stroke::EntryKind::fill) {
        stroke::Fill fill = fill_of(file, node);
        fill.ink = text;
        return fill;
    }
    stroke::BrushAction action{.what = change_of(file, node, kind)};
    if (kind == stroke::EntryKind::dip) action.ink = text;
    return action;
}

}  // namespace

long InkmlText::line_at(std::ptrdiff_t offset) const {
    const auto n = std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(content.size()));
    if (n < counted) counted = 0, counted_line = 1;
    counted_line += static_cast<long>(std::count(content.begin() + counted, content.begin() + n, '\n'));
    counted = n;
    return counted_line;
}

void InkmlText::fail(const pugi::xml_node& node, const Message& what) const {
    throw Error(path, line_at(node.offset_debug()), what);
}

double InkmlText::number_of(const pugi::xml_node& node, const char* attribute) const {
    const auto x = to_number(node.attribute(attribute).value());
    if (!x) fail(node, Message("attribute {} is not a number", attribute));
    return *x;
}

std::string_view local_name(const xml_node& node) {
    const std::string_view name = node.name();
    const auto colon = name.find(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string text_of(const xml_node& node) {
    std::string text;
    for (const xml_node& child : node.children())
        if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) text += child.value();
    return text;
}

std::string_view trimmed(std::string_view s) {
    const auto first = s.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return {};
    return s.substr(first, s.find_last_not_of(" \t\r\n") - first + 1);
}

std::optional<double> to_number(std::string_view s) {
    s = trimmed(s);
    double x = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
    if (error != std::errc{} || end != s.data() + s.size() || !std::isfinite(x)) return {};
    return x;
}

void apply_marks(const InkmlText& file, InkmlMarks& marks, const xml_node& parent) {
    for (const xml_node& node : parent.children()) {
        if (local_name(node) != "annotation") continue;
        std::string_view type = node.attribute("type").value();
        if (type.rfind("tuft:", 0) != 0) continue;
        type.remove_prefix(5);
        if (is_care(type) && local_name(parent) != "trace")
            file.fail(node, Message("tuft:{} belongs on the trace before which it is done", std::string(type)));
        const std::string whole = text_of(node);
        const std::string_view text = trimmed(whole);
        if (type == "brush")
            marks.brush = text;
        else if (type == "ink")
            marks.ink = text;
        else if (type == "label")
            marks.label = text;
        else if (type == "tool" && text != "brush" && text != "eraser")
            file.fail(node, "tuft:tool is neither brush nor eraser");
        else if (type == "tool")
            marks.erases = text == "eraser";
        else if (type == "on" && text != "model" && text != "palette")
            file.fail(node, "tuft:on is neither model nor palette");
        else if (type == "on")
            marks.on_palette = text == "palette";
        else if (type == "clock" && text != "kept")
            file.fail(node, "tuft:clock is nothing but kept");
        else if (type == "clock")
            marks.keeps_clock = true;
        else if (type == "settings")
            marks.settings = settings_of(file, node, text);
        else if (type == "mask")
            marks.mask = name_of(file, node, text, "mask");
        else if (type == "stencil" || type == "tape")  // its name before
            marks.stencil = stencil_of(file, node, text);
        else if (type == "layer")
            marks.layer = name_of(file, node, text, "layer");
        else if (type == "origin") {
            marks.placement.origin = point_of(file, node, text);
            marks.placed = true;
        } else if (type == "right")
            marks.placement.right = direction_of(file, node, text);
        else if (type == "down")
            marks.placement.down = direction_of(file, node, text);
        else if (type == "mapping" || type == "laying") {  // its name before
            const auto mapping = stroke::surface_mapping_named(text);
            if (!mapping) file.fail(node, "tuft:mapping is neither wrap, drape nor project");
            marks.placement.mapping = *mapping;
        } else if (type == "seed") {
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), marks.seed);
            if (error != std::errc{} || end != text.data() + text.size())
                file.fail(node, "tuft:seed is not a whole number");
        }
    }
}

std::vector<stroke::Preparation> preparations_of(const InkmlText& file, const xml_node& trace) {
    std::vector<stroke::Preparation> before;
    for (const xml_node& node : trace.children()) {
        if (local_name(node) != "annotation") continue;
        std::string_view type = node.attribute("type").value();
        if (type.rfind("tuft:", 0) != 0 || !is_care(type.substr(5))) continue;
        const std::string text = text_of(node);
        before.push_back(preparation_of(file, node, stroke::entry_kind_of(std::string(type.substr(5))), trimmed(text)));
    }
    return before;
}

}  // namespace tuft::io
