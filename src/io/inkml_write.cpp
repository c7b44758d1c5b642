#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/files.h"
#include "core/units.h"
#include "io/inkml.h"
#include "stroke/journal.h"

namespace tuft::io {

namespace {

using stroke::Trace;

enum class Kind { flat, leaned, space };

Kind kind_of(const Trace& trace) {
    if (!trace.flat) return Kind::space;
    const bool leans = std::any_of(trace.samples.begin(), trace.samples.end(),
                                   [](const auto& s) { return s.tilt != Vec2{0}; });
    return leans ? Kind::leaned : Kind::flat;
}

constexpr const char* name_of(Kind kind) {
    return kind == Kind::flat ? "flat" : kind == Kind::leaned ? "leaned" : "space";
}

std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

/// Fixed point with at most `decimals` places, without trailing zeros.
void add_number(std::string& out, double x, int decimals) {
    const std::size_t start = out.size();
    fmt::format_to(std::back_inserter(out), "{:.{}f}", x, decimals);
    if (decimals > 0) {
        while (out.back() == '0') out.pop_back();
        if (out.back() == '.') out.pop_back();
    }
    if (std::string_view(out).substr(start) == "-0") out.replace(start, 2, "0");
}

void add_annotation(std::string& out, const char* indent, const char* type,
                    const std::string& text) {
    if (!text.empty())
        out += fmt::format("{}<annotation type=\"tuft:{}\">{}</annotation>\n", indent, type,
                           escaped(text));
}

std::string vector_text(const Vec3& v, int decimals) {
    std::string out;
    for (int k = 0; k < 3; ++k) {
        if (k) out += ' ';
        add_number(out, v[k], decimals);
    }
    return out;
}

std::string fill_attributes(const stroke::Fill& fill) {
    std::string out = fmt::format(" film=\"{}\" region=\"{}\"", fill.film, stroke::name_of(fill.region));
    const auto add = [&out](const char* name, const Vec3& v) {
        out += fmt::format(" {}=\"{} {} {}\"", name, v.x / kMillimetre, v.y / kMillimetre, v.z / kMillimetre);
    };
    if (fill.region != stroke::Region::all) add("at", fill.at);
    if (fill.gradient == stroke::Gradient::none) return out;
    out += fmt::format(" gradient=\"{}\" to_film=\"{}\" to_ink=\"{}\"", stroke::name_of(fill.gradient),
                       fill.to_film, escaped(fill.to_ink));
    add("from", fill.from);
    add("to", fill.to);
    return out;
}

bool same_place(const Trace& a, const Trace& b) {
    return a.flat == b.flat && a.brush == b.brush && a.ink == b.ink && a.layer == b.layer && a.mask == b.mask && a.erases == b.erases && a.on_palette == b.on_palette &&
           a.placement.origin == b.placement.origin && a.placement.right == b.placement.right &&
           a.placement.down == b.placement.down && a.placement.laying == b.placement.laying;
}

void add_format(std::string& out, Kind kind) {
    out += fmt::format("    <traceFormat xml:id=\"{}-format\">\n", name_of(kind));
    const auto channel = [&](const char* name, const char* more) {
        out += fmt::format("      <channel name=\"{}\" type=\"decimal\"{}/>\n", name, more);
    };
    channel("X", " units=\"mm\"");
    channel("Y", " units=\"mm\"");
    if (kind == Kind::space) channel("Z", " units=\"mm\"");
    channel("P", " min=\"0\" max=\"1\"");
    channel("T", " units=\"ms\"");
    if (kind == Kind::leaned) {
        channel("OTx", " units=\"deg\"");
        channel("OTy", " units=\"deg\"");
    }
    if (kind == Kind::space)
        for (const char* name : {"QW", "QX", "QY", "QZ"}) channel(name, "");
    out += fmt::format(
        "    </traceFormat>\n    <context xml:id=\"{0}\" traceFormatRef=\"#{0}-format\"/>\n",
        name_of(kind));
}

void add_trace(std::string& out, const Trace& trace, Kind kind) {
    out += fmt::format("    <trace contextRef=\"#{}\">\n", name_of(kind));
    add_annotation(out, "      ", "label", trace.label);
    for (const stroke::Care& care : trace.before) {
        const auto part = [](const char* name, double value) {
            return value == 1 ? std::string() : fmt::format(" {}=\"{}\"", name, value);
        };
        out += fmt::format("      <annotation type=\"tuft:{}\"{}{}{}>{}</annotation>\n", stroke::name_of(care.action),
                           care.action == stroke::Action::fill ? fill_attributes(care.fill) : "",
                           part("depth", care.extent.depth), part("amount", care.extent.amount),
                           care.seconds > 0 ? fmt::format("{}", care.seconds) : escaped(care.ink));
    }
    if (trace.seed) add_annotation(out, "      ", "seed", std::to_string(trace.seed));
    const int decimals = trace.flat ? 3 : 7;
    for (std::size_t i = 0; i < trace.samples.size(); ++i) {
        const auto& s = trace.samples[i];
        if (i) out += i % 8 ? ", " : ",\n";
        add_number(out, s.position.x / kMillimetre, decimals);
        out += ' ';
        add_number(out, s.position.y / kMillimetre, decimals);
        if (kind == Kind::space) {
            out += ' ';
            add_number(out, s.position.z / kMillimetre, decimals);
        }
        out += ' ';
        add_number(out, s.pressure, 5);
        out += ' ';
        add_number(out, s.time * 1e3, 3);
        if (kind == Kind::leaned)
            for (int k = 0; k < 2; ++k) {
                out += ' ';
                add_number(out, s.tilt[k] / kDegree, 3);
            }
        if (kind == Kind::space)
            for (const double q : {s.rotation.w, s.rotation.x, s.rotation.y, s.rotation.z}) {
                out += ' ';
                add_number(out, q, 10);
            }
    }
    out += "\n    </trace>\n";
}

}  // namespace

std::string inkml_text(std::span<const Trace> traces, const std::string& title) {
    std::string out =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<ink xmlns=\"http://www.w3.org/2003/InkML\">\n";
    if (!title.empty())
        out += fmt::format("  <annotation type=\"title\">{}</annotation>\n", escaped(title));
    out += "  <definitions>\n";
    for (const Kind kind : {Kind::flat, Kind::leaned, Kind::space})
        if (std::any_of(traces.begin(), traces.end(),
                        [&](const Trace& t) { return kind_of(t) == kind; }))
            add_format(out, kind);
    out += "  </definitions>\n";
    for (std::size_t i = 0; i < traces.size();) {
        const Trace& first = traces[i];
        out += "  <traceGroup>\n";
        add_annotation(out, "    ", "brush", first.brush);
        add_annotation(out, "    ", "ink", first.ink);
        add_annotation(out, "    ", "layer", first.layer);
        add_annotation(out, "    ", "mask", first.mask);
        if (first.erases) add_annotation(out, "    ", "tool", "eraser");
        if (first.on_palette) add_annotation(out, "    ", "on", "palette");
        if (first.flat) {
            add_annotation(out, "    ", "origin",
                           vector_text(first.placement.origin / kMillimetre, 7));
            add_annotation(out, "    ", "right", vector_text(first.placement.right, 10));
            add_annotation(out, "    ", "down", vector_text(first.placement.down, 10));
            add_annotation(out, "    ", "laying",
                           first.placement.laying == stroke::Laying::wrap ? "wrap" : "project");
        }
        for (; i < traces.size() && same_place(first, traces[i]); ++i)
            add_trace(out, traces[i], kind_of(traces[i]));
        out += "  </traceGroup>\n";
    }
    out += "</ink>\n";
    return out;
}

void write_inkml(const std::filesystem::path& path, std::span<const Trace> traces,
                 const std::string& title) {
    const std::string text = inkml_text(traces, title);
    write_file(path, text.data(), text.size());
}

}  // namespace tuft::io
