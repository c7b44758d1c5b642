#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "core/files/files.h"
#include "core/overloaded.h"
#include "core/text/units.h"
#include "core/text/xml_text.h"
#include "io/strokes/inkml.h"

namespace tuft::io {

namespace {

using stroke::RecordedStroke;

enum class Kind { flat, tilted, rolled, space };

Kind kind_of(const RecordedStroke& trace) {
    if (!trace.flat) return Kind::space;
    if (std::any_of(trace.samples.begin(), trace.samples.end(), [](const auto& s) { return s.roll != 0; }))
        return Kind::rolled;
    const bool leans =
        std::any_of(trace.samples.begin(), trace.samples.end(), [](const auto& s) { return s.tilt != Vec2{0}; });
    return leans ? Kind::tilted : Kind::flat;
}

constexpr const char* name_of(Kind kind) {
    return kind == Kind::flat ? "flat" : kind == Kind::tilted ? "tilted" : kind == Kind::rolled ? "rolled" : "space";
}

/// How numbers stand in the file: units per unit of the file, and digits.
struct Style {
    bool exact = true;
    double length = 1, time = 1, angle = 1;  ///< SI per unit of the file
};

Style style_of(Digits digits) {
    return digits == Digits::exact ? Style{} : Style{false, kMillimetre, 1e-3, kDegree};
}

/// The fewest digits that give the number back, or fixed point with at most `decimals` places
/// without trailing zeros.
void add_number(std::string& out, double x, const Style& style, int decimals) {
    if (style.exact) {
        char digits[32];
        const auto [end, error] = std::to_chars(digits, digits + sizeof digits, x);
        out.append(digits, end);
        return;
    }
    const std::size_t start = out.size();
    fmt::format_to(std::back_inserter(out), "{:.{}f}", x, decimals);
    if (decimals > 0) {
        while (out.back() == '0') out.pop_back();
        if (out.back() == '.') out.pop_back();
    }
    if (std::string_view(out).substr(start) == "-0") out.replace(start, 2, "0");
}

void add_annotation(std::string& out, const char* indent, const char* type, const std::string& text) {
    if (!text.empty())
        out += fmt::format("{}<annotation type=\"tuft:{}\">{}</annotation>\n", indent, type, xml_text(text));
}

std::string vector_text(const Vec3& v, const Style& style, int decimals) {
    std::string out;
    for (int k = 0; k < 3; ++k) {
        if (k) out += ' ';
        add_number(out, v[k], style, decimals);
    }
    return out;
}

std::string point_text(const Vec3& p, const Style& style) {
    return style.exact ? vector_text(p, style, 0) + " m" : vector_text(p / kMillimetre, style, 7);
}

std::string fill_attributes(const stroke::Fill& fill, const Style& style) {
    std::string out = fmt::format(" film=\"{}\" region=\"{}\"", fill.film, stroke::name_of(fill.region));
    const auto add = [&](const char* name, const Vec3& v) {
        out += style.exact
                   ? fmt::format(" {}=\"{}\"", name, point_text(v, style))
                   : fmt::format(" {}=\"{} {} {}\"", name, v.x / kMillimetre, v.y / kMillimetre, v.z / kMillimetre);
    };
    if (fill.area) return out + fmt::format(" area=\"{}\"", xml_text(stroke::text_of(*fill.area)));
    if (fill.region != stroke::Region::all) add("at", fill.at);
    if (fill.gradient == stroke::Gradient::none) return out;
    out += fmt::format(" gradient=\"{}\" to_film=\"{}\" to_ink=\"{}\"", stroke::name_of(fill.gradient), fill.to_film,
                       xml_text(fill.to_ink));
    add("from", fill.from);
    add("to", fill.to);
    return out;
}

bool same_place(const RecordedStroke& a, const RecordedStroke& b) {
    return a.flat == b.flat && a.brush == b.brush && a.ink == b.ink && a.names == b.names && a.erases == b.erases &&
           a.on_palette == b.on_palette && a.settings == b.settings && a.placement.origin == b.placement.origin &&
           a.placement.right == b.placement.right && a.placement.down == b.placement.down &&
           a.placement.mapping == b.placement.mapping;
}

void add_format(std::string& out, Kind kind, const Style& style) {
    out += fmt::format("    <traceFormat xml:id=\"{}-format\">\n", name_of(kind));
    const char* type = style.exact ? "double" : "decimal";
    const auto channel = [&](const char* name, const std::string& more) {
        out += fmt::format("      <channel name=\"{}\" type=\"{}\"{}/>\n", name, type, more);
    };
    const std::string length = style.exact ? " units=\"m\"" : " units=\"mm\"",
                      angle = style.exact ? " units=\"rad\"" : " units=\"deg\"";
    channel("X", length);
    channel("Y", length);
    if (kind == Kind::space) channel("Z", length);
    channel("P", " min=\"0\" max=\"1\"");
    channel("T", style.exact ? " units=\"s\"" : " units=\"ms\"");
    if (kind == Kind::tilted || kind == Kind::rolled)
        for (const char* name : {"OTx", "OTy"}) channel(name, angle);
    if (kind == Kind::rolled) channel("OR", angle);
    if (kind == Kind::space)
        for (const char* name : {"QW", "QX", "QY", "QZ"}) channel(name, "");
    out += fmt::format("    </traceFormat>\n    <context xml:id=\"{0}\" traceFormatRef=\"#{0}-format\"/>\n",
                       name_of(kind));
}

void add_sample(std::string& out, const stroke::StrokeSample& s, Kind kind, const Style& style) {
    const int decimals = kind == Kind::space ? 7 : 3;
    const auto add = [&](double x, int places) {
        out += ' ';
        add_number(out, x, style, places);
    };
    add_number(out, s.position.x / style.length, style, decimals);
    add(s.position.y / style.length, decimals);
    if (kind == Kind::space) add(s.position.z / style.length, decimals);
    add(s.pressure, 5);
    add(style.exact ? s.time : s.time * 1e3, 3);
    if (kind == Kind::tilted || kind == Kind::rolled)
        for (int k = 0; k < 2; ++k) add(s.tilt[k] / style.angle, 3);
    if (kind == Kind::rolled) add(s.roll / style.angle, 3);
    if (kind == Kind::space)
        for (const double q : {s.rotation.w, s.rotation.x, s.rotation.y, s.rotation.z}) add(q, 10);
}

constexpr double kLeastLean = 1e-3 * kDegree;  // that three places of a degree keep

/// Whether a holder leans less than the digits tell: a make leans where all samples say 0 (`stroke::lean_holder`).
bool is_stated_upright(const RecordedStroke& trace, const Style& style) {
    bool leans = false;
    for (const stroke::StrokeSample& s : trace.samples) {
        if (std::max(std::abs(s.tilt.x), std::abs(s.tilt.y)) >= 0.5 * kLeastLean) return false;
        leans = leans || s.tilt != Vec2{0};
    }
    return leans && !style.exact && trace.flat;
}

std::string preparation_text(const stroke::Preparation& preparation, const Style& style) {
    std::string attributes, text;
    std::visit(Overloaded{[&](const stroke::BrushAction& action) {
                              for (const stroke::ChangeNumber& n : stroke::numbers_of(action.what))
                                  if (n.value != n.usual) attributes += fmt::format(" {}=\"{}\"", n.name, n.value);
                              text = xml_text(action.ink);
                          },
                          [&](const stroke::Dry& dry) { text = dry.seconds > 0 ? fmt::format("{}", dry.seconds) : ""; },
                          [](const stroke::WashPalette&) {},
                          [&](const stroke::Fill& fill) {
                              attributes = fill_attributes(fill, style);
                              text = xml_text(fill.ink);
                          }},
               preparation);
    return fmt::format("      <annotation type=\"tuft:{}\"{}>{}</annotation>\n",
                       stroke::name_of(stroke::kind_of(preparation)), attributes, text);
}

void add_trace(std::string& out, const RecordedStroke& trace, Kind kind, const Style& style) {
    out += fmt::format("    <trace contextRef=\"#{}\">\n", name_of(kind));
    add_annotation(out, "      ", "label", trace.label);
    for (const stroke::Preparation& preparation : trace.before) out += preparation_text(preparation, style);
    if (!trace.stencil.empty()) {
        std::string stencil;
        for (const stroke::StencilEdge& e : trace.stencil)
            stencil += fmt::format("{}{} {} {} {}", stencil.empty() ? "" : ", ", e.from.x, e.from.y, e.to.x, e.to.y);
        add_annotation(out, "      ", "stencil", stencil);
    }
    if (trace.seed) add_annotation(out, "      ", "seed", std::to_string(trace.seed));
    const bool upright = is_stated_upright(trace, style);
    const double start = trace.samples.empty() ? 0 : trace.samples.front().time;
    if (style.exact && (start != 0 || std::signbit(start))) add_annotation(out, "      ", "clock", "kept");
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        if (i) out += i % 8 ? ", " : ",\n";
        stroke::StrokeSample sample = trace.samples[i];
        if (upright && i == 0) sample.tilt.x = kLeastLean;
        add_sample(out, sample, kind, style);
    }
    out += "\n    </trace>\n";
}

void add_group_marks(std::string& out, const RecordedStroke& first, const Style& style) {
    add_annotation(out, "    ", "brush", first.brush);
    add_annotation(out, "    ", "ink", first.ink);
    add_annotation(out, "    ", "layer", first.names.layer);
    add_annotation(out, "    ", "mask", first.names.mask);
    if (first.settings) add_annotation(out, "    ", "settings", stroke::to_json(*first.settings));
    if (first.erases) add_annotation(out, "    ", "tool", "eraser");
    if (first.on_palette) add_annotation(out, "    ", "on", "palette");
    if (!first.flat) return;
    add_annotation(out, "    ", "origin", point_text(first.placement.origin, style));
    add_annotation(out, "    ", "right", vector_text(first.placement.right, style, 10));
    add_annotation(out, "    ", "down", vector_text(first.placement.down, style, 10));
    add_annotation(out, "    ", "mapping", std::string(stroke::surface_mapping_name(first.placement.mapping)));
}

}  // namespace

std::string inkml_text(std::span<const RecordedStroke> traces, const std::string& title, Digits digits) {
    const Style style = style_of(digits);
    std::string out =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<ink xmlns=\"http://www.w3.org/2003/InkML\">\n";
    if (!title.empty()) out += fmt::format("  <annotation type=\"title\">{}</annotation>\n", xml_text(title));
    out += "  <definitions>\n";
    for (const Kind kind : {Kind::flat, Kind::tilted, Kind::rolled, Kind::space})
        if (std::any_of(traces.begin(), traces.end(), [&](const RecordedStroke& t) { return kind_of(t) == kind; }))
            add_format(out, kind, style);
    out += "  </definitions>\n";
    for (std::size_t i = 0; i < traces.size();) {
        const RecordedStroke& first = traces[i];
        out += "  <traceGroup>\n";
        add_group_marks(out, first, style);
        for (; i < traces.size() && same_place(first, traces[i]); ++i)
            add_trace(out, traces[i], kind_of(traces[i]), style);
        out += "  </traceGroup>\n";
    }
    out += "</ink>\n";
    return out;
}

void write_inkml(const std::filesystem::path& path, std::span<const RecordedStroke> traces, const std::string& title,
                 Digits digits) {
    const std::string text = inkml_text(traces, title, digits);
    write_file(path, text.data(), text.size());
}

}  // namespace tuft::io
