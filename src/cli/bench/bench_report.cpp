#include "cli/bench/bench_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "cli/bench/bench_scaling.h"
#include "cli/bench/svg_plot.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/files/text_file.h"
#include "core/system/build_facts.h"
#include "core/text/nesting.h"
#include "core/text/xml_text.h"

namespace tuft::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kMaxBytes = std::size_t{16} << 20;
constexpr const char* kFormat = "tuft bench report 1";
constexpr double kSame = 0.05;  // ratios nearer to 1 are noise

fs::path beside(const Bench& a, const std::string& end) {
    fs::path path = a.report;
    return path.replace_extension().concat(end);
}

bool is_markdown(const Bench& a) {
    return a.report.extension() == ".md";
}

std::string facts_line(const json& j) {
    const std::string commit = j.value("commit", "");
    return fmt::format("{}, {} cores, {}; tuft {}{}; {} {}; {}, {:.1f} processes at work", j.value("machine", ""),
                       j.value("cores", 0), j.value("isa", ""), j.value("version", ""),
                       commit.empty() ? "" : " " + commit, j.value("compiler", ""), j.value("build_type", ""),
                       j.value("date", ""), j.value("load", 0.0));
}

/// The figures to compare with; nothing where there are none.
std::optional<json> earlier_figures(const Bench& a) {
    const fs::path file = a.against.empty() ? beside(a, ".json") : a.against;
    std::error_code ec;
    if (a.against.empty() && !fs::exists(file, ec)) return {};
    const std::vector<char> bytes = read_file(file, kMaxBytes);
    const std::string text(bytes.begin(), bytes.end());
    check_json_nesting(text, file.string());
    const Error none(file.string(), "holds no figures of a report of 'tuft bench'");
    json j = json::parse(text, nullptr, false);
    if (!j.is_object() || j.value("format", json()) != kFormat) throw none;
    try {
        facts_line(j);  // now, not after minutes of measuring
    } catch (const json::exception&) {
        throw none;
    }
    return j;
}

/// Every number by its path, such as models/sphere-100k/stamps_per_second/64. Rows of a list are named by their first
/// key's value.
void flatten(const json& j, const std::string& path, std::map<std::string, double>& out) {
    if (j.is_number()) out[path] = j.get<double>();
    if (j.is_object())
        for (const auto& [key, value] : j.items()) flatten(value, path.empty() ? key : path + "/" + key, out);
    if (!j.is_array()) return;
    for (const json& row : j)
        for (const char* key : {"threads", "triangles", "size", "texels"})
            if (row.is_object() && row.contains(key)) {
                flatten(row, path + "/" + row[key].dump(), out);
                break;
            }
}

bool is_time(const std::string& path) {
    for (const char* count : {"/bands", "/pigments", "/segments", "/spines", "composite_microseconds/texels"})
        if (path.ends_with(count) && path.find("ns_per_texel") == std::string::npos) return false;
    for (const char* word : {"seconds", "_ms", "ns_per_texel", "_mb"})
        if (path.find(word) != std::string::npos && path.find("per_second") == std::string::npos) return true;
    return false;
}
bool is_rate(const std::string& path) {
    return path.find("per_second") != std::string::npos;
}

/// A figure and how many times as good it is as before.
struct Line {
    std::string name;
    double now = 0;
    std::optional<double> before, ratio;
};

std::vector<Line> lines_of(const json& now, const std::optional<json>& before) {
    std::map<std::string, double> a, b;
    flatten(now, "", a);
    if (before) flatten(*before, "", b);
    std::vector<Line> lines;
    for (const auto& [path, value] : a) {
        if (!is_time(path) && !is_rate(path)) continue;
        // The first model's figures stand at the top, too, for older readers.
        if (path.find("models/") == std::string::npos && now.contains("models") &&
            now["models"].front().contains(path.substr(0, path.find('/'))))
            continue;
        Line line{path, value, {}, {}};
        if (const auto at = b.find(path); at != b.end()) {
            line.before = at->second;
            if (value > 0 && at->second > 0) line.ratio = is_rate(path) ? value / at->second : at->second / value;
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

PlotSeries series(const json& rows, const char* x, const char* y, const std::string& name) {
    PlotSeries s{name, {}};
    for (const json& row : rows) s.points.emplace_back(row.at(x).get<double>(), row.at(y).get<double>());
    return s;
}

/// Speed over that of the first row.
PlotSeries speed_up(const json& rows, const char* y, const std::string& name) {
    PlotSeries s = series(rows, "threads", y, name);
    const double one = s.points.front().y;
    for (Vec2& p : s.points) p.y = one / p.y;
    return s;
}

struct NamedPlot {
    std::string name, svg;
};

std::vector<NamedPlot> plots_of(const json& j) {
    const json& s = j.at("scaling");
    std::vector<NamedPlot> plots;
    const json& threads = s.at("threads");
    PlotSeries ideal{"as many times as threads", {}};
    for (const json& row : threads)
        ideal.points.emplace_back(row.at("threads").get<double>(), row.at("threads").get<double>());
    plots.push_back(
        {"threads", svg_of({.title = "Speed over threads",
                            .x_label = "threads",
                            .y_label = "times as fast as one",
                            .series = {speed_up(threads, "paint_seconds", "40 strokes"),
                                       speed_up(threads, "paint_many_seconds", "many short strokes"),
                                       speed_up(threads, "wet_strokes_seconds", "wet strokes"),
                                       speed_up(threads, "film_step_seconds", "film"),
                                       speed_up(threads, "prepare_seconds", "preparing a model"), ideal}})});
    plots.push_back(
        {"triangles", svg_of({.title = "Whole path over triangles, 64 texels wide, one thread",
                              .x_label = "triangles",
                              .y_label = "stamps a second",
                              .log_x = true,
                              .series = {series(s.at("triangles"), "triangles", "stamps_per_second", "at 2048²")}})});
    plots.push_back(
        {"texels", svg_of({.title = "Whole path over the atlas, 64 texels wide, one thread",
                           .x_label = "texels along a side",
                           .y_label = "stamps a second",
                           .log_x = true,
                           .series = {series(s.at("texels"), "size", "stamps_per_second", "25,000 triangles")}})});
    plots.push_back(
        {"stamp", svg_of({.title = "Stamps over their size, one thread",
                          .x_label = "texels across",
                          .y_label = "stamps a second",
                          .log_x = true,
                          .log_y = true,
                          .series = {series(s.at("stamp"), "texels", "stamps_per_second", "whole path"), [&] {
                                         PlotSeries d =
                                             series(s.at("stamp"), "texels", "microseconds_per_stamp", "deposit alone");
                                         for (Vec2& p : d.points) p.y = 1e6 / p.y;
                                         return d;
                                     }()}})});
    plots.push_back(
        {"prepare", svg_of({.title = "Preparing a model, one thread",
                            .x_label = "triangles",
                            .y_label = "seconds",
                            .log_x = true,
                            .log_y = true,
                            .series = {series(s.at("triangles"), "triangles", "prepare_seconds", "at 2048²")}})});
    for (const auto& [name, m] : j.at("models").items())
        plots.push_back({"stages-" + name, svg_bars("Preparing " + name + ", by stage, all threads", "s",
                                                    {{"repair and queries", m.at("repair_seconds")},
                                                     {"atlas", m.at("atlas_seconds")},
                                                     {"texel map", m.at("texel_map_seconds")},
                                                     {"cluster graph", m.at("cluster_graph_seconds")}})});
    return plots;
}

std::string ratio_text(const Line& line) {
    return line.ratio ? fmt::format("{:.2f}", *line.ratio) : "";
}

constexpr const char* kExplained =
    "One thread and CPU time, medians of repeats, where nothing else is said; preparing and threads are wall time. The "
    "ratio is how many times as fast, or as small, a figure is as in the earlier report: above 1 is better. Other work "
    "on the machine changes all of them.";

std::string libraries_of(const json& j) {
    std::string text;
    const json libraries = j.value("libraries", json::object());
    for (const auto& [name, version] : libraries.items())
        text += (text.empty() ? "" : ", ") + name + " " + version.get<std::string>();
    return text;
}

std::string html_page(const json& j, const std::optional<json>& before, const std::vector<NamedPlot>& plots) {
    std::string page =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Figures of tuft</title>\n<style>\n"
        "body { font-family: sans-serif; max-width: 1180px; margin: 2em auto; padding: 0 1em; color: #222 }\n"
        ".plots { display: flex; flex-wrap: wrap; gap: 12px } .plots svg { border: 1px solid #ddd }\n"
        "table { border-collapse: collapse; font-size: 14px } td, th { padding: 2px 12px 2px 0; text-align: right }\n"
        "td:first-child, th:first-child { text-align: left } tr { border-bottom: 1px solid #eee }\n"
        ".better { color: #00663c; font-weight: bold } .worse { color: #b02000; font-weight: bold }\n"
        "</style></head><body>\n<h1>Figures of tuft</h1>\n";
    page += "<p>" + xml_text(facts_line(j)) + "</p>\n";
    if (before) page += "<p>Compared with: " + xml_text(facts_line(*before)) + "</p>\n";
    page += std::string("<p>") + kExplained + "</p>\n<div class=\"plots\">\n";
    for (const NamedPlot& plot : plots) page += plot.svg;
    page += "</div>\n<h2>All figures</h2>\n<table><tr><th>figure</th><th>now</th><th>before</th><th>ratio</th></tr>\n";
    for (const Line& line : lines_of(j, before)) {
        const char* mark = !line.ratio || std::abs(*line.ratio - 1) < kSame ? "" : *line.ratio > 1 ? "better" : "worse";
        page +=
            fmt::format("<tr><td>{}</td><td>{:.4g}</td><td>{}</td><td class=\"{}\">{}</td></tr>\n", xml_text(line.name),
                        line.now, line.before ? fmt::format("{:.4g}", *line.before) : "", mark, ratio_text(line));
    }
    return page + "</table>\n<p>Libraries: " + xml_text(libraries_of(j)) + "</p>\n</body></html>\n";
}

std::string markdown_page(const json& j, const std::optional<json>& before, const std::vector<NamedPlot>& plots,
                          const Bench& a) {
    std::string page = "# Figures of tuft\n\n" + facts_line(j) + "\n\n";
    if (before) page += "Compared with: " + facts_line(*before) + "\n\n";
    page += std::string(kExplained) + "\n\n";
    for (const NamedPlot& plot : plots)
        page += fmt::format("![{}]({})\n", plot.name, beside(a, "-" + plot.name + ".svg").filename().string());
    page += "\n| figure | now | before | ratio |\n|---|---|---|---|\n";
    for (const Line& line : lines_of(j, before))
        page += fmt::format("| {} | {:.4g} | {} | {} |\n", line.name, line.now,
                            line.before ? fmt::format("{:.4g}", *line.before) : "", ratio_text(line));
    return page + "\nLibraries: " + libraries_of(j) + "\n";
}

void add_facts(json& j) {
    const BuildFacts& facts = build_facts();
    j["format"] = kFormat;
    j["cores"] = std::thread::hardware_concurrency();
    j["version"] = facts.version;
    j["commit"] = facts.commit;
    j["compiler"] = facts.compiler;
    j["build_type"] = facts.build_type;
    double load = 0;
    ::getloadavg(&load, 1);
    j["load"] = load;
    j["date"] = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)));
    for (const auto& [name, version] : facts.libraries) j["libraries"][name] = version;
}

}  // namespace

void check_bench_report(const Bench& a) {
    if (a.report.empty()) return;
    check_extension(a.report, {".html", ".md"});
    check_output(a.report);
    earlier_figures(a);
}

void write_bench_report(const Bench& a, const json& figures, Console& console) {
    const std::optional<json> before = earlier_figures(a);
    json j = figures;
    add_facts(j);
    j["scaling"] = measure_scaling(a, console);
    std::vector<NamedPlot> plots = plots_of(j);
    for (NamedPlot& plot : plots)
        std::replace_if(
            plot.name.begin(), plot.name.end(), [](unsigned char c) { return !std::isalnum(c) && c != '-'; }, '-');
    if (is_markdown(a))
        for (const NamedPlot& plot : plots) write_text(beside(a, "-" + plot.name + ".svg"), plot.svg);
    write_text(a.report, is_markdown(a) ? markdown_page(j, before, plots, a) : html_page(j, before, plots));
    write_text(beside(a, ".json"), j.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace tuft::cli
