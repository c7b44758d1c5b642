#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "brush/calibration/calibrate.h"
#include "brush/calibration/compare.h"
#include "brush/calibration/match.h"
#include "brush/calibration/sweep.h"
#include "brush/preset/preset.h"
#include "brush/tuft/table.h"
#include "cli/steps/commands.h"
#include "cli/steps/console.h"
#include "cli/steps/steps.h"
#include "core/files/files.h"
#include "core/text/units.h"
#include "io/image/image.h"
#include "render/brush/brush_picture.h"
#include "render/brush/comparison_picture.h"
#include "stroke/placement/placement.h"

namespace tuft::cli {
namespace {

void list_brushes(bool json) {
    const std::vector<std::string> names = brush::list_presets();
    if (json) {
        print_json(nlohmann::json{{"brushes", names}});
        return;
    }
    for (const std::string& name : names) {
        const brush::Preset p = brush::load_preset(name);
        const std::string width =
            p.spines > 1 && p.width > 0
                ? fmt::format("{:>2.0f} x {:.1f} mm", p.width / kMillimetre, 2 * p.radius / kMillimetre)
                : fmt::format("{:>8.1f} mm", 2 * p.radius / kMillimetre);
        fmt::print("{:<16} {:>4.0f} mm long, {:<11} thick  {}\n", name, p.length / kMillimetre, width, p.note);
    }
}

nlohmann::json table_json(const brush::Preset& preset, const brush::QueryTable& table) {
    nlohmann::json j{{"brush", preset.name},
                     {"length_mm", preset.length / kMillimetre},
                     {"root_stiffness_Nm2", preset.stiffness},
                     {"rows", nlohmann::json::array()}};
    for (const brush::TableRow& row : table.rows) {
        nlohmann::json r{{"moment_mNm", row.moment * 1e3}, {"load_N", row.load}};
        for (std::size_t i = 0; i < row.nodes.size(); ++i)
            r["nodes"].push_back({{"x_mm", row.nodes[i].x / kMillimetre},
                                  {"y_mm", row.nodes[i].y / kMillimetre},
                                  {"angle_deg", row.angles[i] / kDegree},
                                  {"moment_mNm", row.moments[i] * 1e3}});
        j["rows"].push_back(std::move(r));
    }
    return j;
}

nlohmann::json foam_json(const brush::Preset& preset) {
    return {{"brush", preset.name},
            {"length_mm", preset.length / kMillimetre},
            {"modulus_kPa", 1e-3 * preset.modulus},
            {"solid", preset.solid},
            {"capacity_ml", 1e6 * preset.capacity}};
}

void print_foam(const brush::Preset& preset) {
    fmt::print("{}: {}\n", preset.name, preset.note);
    fmt::print("foam {:.1f} mm high, {:.1f} mm wide, E* {:.3g} kPa, {:.3g} % solid, holds {:.3g} ml\n",
               preset.length / kMillimetre, 2 * preset.radius / kMillimetre, 1e-3 * preset.modulus, 100 * preset.solid,
               1e6 * preset.capacity);
}

void print_table(const brush::Preset& preset, const brush::QueryTable& table) {
    fmt::print("{}: {}\n", preset.name, preset.note);
    fmt::print("tuft {:.1f} mm long, {:.1f} mm thick, root stiffness {:.3g} N m2, {} segments\n\n",
               preset.length / kMillimetre, 2 * preset.radius / kMillimetre, preset.stiffness, preset.segments);
    fmt::print("{:>11} {:>9} {:>22} {:>11}   node angles from tip to root, degrees\n", "moment mNm", "load N",
               "tip x, y mm", "tip angle");
    for (std::size_t k = 0; k < table.rows.size(); k += 4) {
        const brush::TableRow& row = table.rows[k];
        fmt::print("{:>11.4f} {:>9.4f} {:>10.3f}, {:>10.3f} {:>11.2f}  ", row.moment * 1e3, row.load,
                   row.nodes.front().x / kMillimetre, row.nodes.front().y / kMillimetre, row.angles.front() / kDegree);
        for (std::size_t i = 0; i < row.angles.size(); i += 2) fmt::print(" {:>5.1f}", row.angles[i] / kDegree);
        fmt::print("\n");
    }
    fmt::print("\nEvery fourth of {} rows and every second node; --json prints them all.\n", table.rows.size());
}

nlohmann::json row_json(const brush::SweepRow& row) {
    return {{"width_mm", row.width / kMillimetre},
            {"drag_mm", row.drag / kMillimetre},
            {"offset_mm", row.offset / kMillimetre}};
}

/// A length for people; "-" where there is none.
std::string millimetres(double v) {
    return std::isfinite(v) ? fmt::format("{:.2f}", v / kMillimetre) : "-";
}

/// The number of combinations of constants that the table determines better than the prior does.
std::ptrdiff_t determined_combinations(const brush::Calibration& fit) {
    return std::ranges::count_if(fit.singular, [](double s) { return s > 1; });
}

nlohmann::json fit_json(const brush::Calibration& fit, const std::filesystem::path& output) {
    nlohmann::json constants = nlohmann::json::object();
    for (const brush::FittedConstant& c : fit.constants)
        constants[c.key] = {{"value", c.value}, {"low", c.low}, {"high", c.high}, {"determined", c.determined}};
    return {{"wrote", output.string()},
            {"rms_width_mm", fit.rms.width / kMillimetre},
            {"rms_drag_mm", fit.rms.drag / kMillimetre},
            {"rms_offset_mm", fit.rms.offset / kMillimetre},
            {"rms_over_repeatability", fit.cost},
            {"constants", std::move(constants)},
            {"singular_values", fit.singular},
            {"determined_combinations", determined_combinations(fit)},
            {"evaluations", fit.evaluations}};
}

void print_fit(const brush::Calibration& fit, const std::filesystem::path& output) {
    constexpr double kUndetermined = 0.25;
    fmt::print("wrote {}: residuals (rms) {} mm of width, {} mm of contact length, {} mm of offset\n\n",
               output.string(), millimetres(fit.rms.width), millimetres(fit.rms.drag), millimetres(fit.rms.offset));
    fmt::print("{:<28}{:>12}   95 % interval\n", "constant", "value");
    for (const brush::FittedConstant& c : fit.constants)
        fmt::print("{:<28}{:>12.4g}   {:.4g} to {:.4g}{}\n", c.key, c.value, c.low, c.high,
                   c.determined < kUndetermined ? "   not determined by the table" : "");
    fmt::print(
        "\nThe table determines {} of {} combinations of these constants; the others come from the shipped brushes.\n",
        determined_combinations(fit), fit.constants.size());
}

int calibrate(const Brush& a) {
    check_extension(a.output, {".toml"});
    check_output(a.output);
    Console console(a.common.quiet);
    const std::vector<brush::SweepRow> measured = brush::read_sweep(a.calibrate.string());
    brush::Preset start = brush::load_preset(a.name.empty() || a.name == "calibrate" ? "robot-2020" : a.name);
    start.name = a.output.stem().string();
    if (const auto length = brush::stated_length(a.calibrate.string())) start.length = *length;
    const brush::Calibration fit = brush::calibrate(start, measured, {.progress = console.progress()});
    console.clear();
    const std::string toml = brush::preset_toml(fit.preset);
    write_file(a.output, toml.data(), toml.size());
    if (a.common.json)
        print_json(fit_json(fit, a.output));
    else
        print_fit(fit, a.output);
    return 0;
}

void print_matches(std::span<const brush::BrushMatch> matches) {
    fmt::print("{:<16}{:>9}{:>9}{:>9}{:>12}   at its best size\n", "rms, mm", "width", "contact", "offset",
               "fit error");
    for (const brush::BrushMatch& m : matches) {
        fmt::print("{:<16}", m.name);
        for (double brush::SweepRow::*column : brush::kSweepColumns) fmt::print("{:>9}", millimetres(m.rms.*column));
        fmt::print("{:>12}", std::isfinite(m.fit_error) ? fmt::format("{:.2f}", m.fit_error) : "-");
        if (std::isfinite(m.sized_fit_error)) fmt::print("   {:.2f} at x {:.2f}", m.sized_fit_error, m.size);
        fmt::print("\n");
    }
    fmt::print(
        "\nFit error: rms over what a ruler repeats to (1.4, 0.5 and 0.7 mm with hair of 30 mm); -: too short.\n");
}

int match(const Brush& a) {
    Console console(a.common.quiet);
    const std::vector<brush::SweepRow> measured = brush::read_sweep(a.match.string());
    const std::vector<std::string> names = a.name.empty() ? brush::list_presets() : std::vector{a.name};
    const std::vector<brush::BrushMatch> matches = brush::match_brushes(names, measured, console.progress());
    console.clear();
    if (!a.common.json) {
        print_matches(matches);
        return 0;
    }
    nlohmann::json j{{"brushes", nlohmann::json::array()}};
    for (const brush::BrushMatch& m : matches)
        j["brushes"].push_back({{"name", m.name},
                                {"fit_error", m.fit_error},  // null where it is too short
                                {"rms", row_json(m.rms)},
                                {"best_size", m.size},
                                {"fit_error_at_best_size", m.sized_fit_error}});
    print_json(j);
    return 0;
}

nlohmann::json comparison_json(const brush::Preset& preset, std::span<const brush::ModelSweep> models) {
    nlohmann::json j{{"brush", preset.name}, {"models", nlohmann::json::array()}};
    for (const brush::ModelSweep& model : models) {
        nlohmann::json m{{"spine", brush::kSpineWords[static_cast<std::size_t>(model.method)]},
                         {"rms", row_json(model.rms)}};
        for (const brush::SweepRow& row : model.rows) {
            nlohmann::json r = row_json(row);
            r["z_mm"] = row.depth / kMillimetre;
            m["rows"].push_back(std::move(r));
        }
        j["models"].push_back(std::move(m));
    }
    return j;
}

/// Mean of a column over the measured rows of one depth, metres; NaN where it is not measured.
double measured_mean(std::span<const brush::SweepRow> measured, double depth, double brush::SweepRow::*column) {
    double sum = 0;
    int count = 0;
    for (const brush::SweepRow& row : measured) {
        if (row.depth != depth) continue;
        sum += row.*column;
        ++count;
    }
    return sum / count;
}

void print_comparison(std::span<const brush::ModelSweep> models, std::span<const brush::SweepRow> measured) {
    constexpr const char* kNames[] = {"width of the line", "contact length", "offset behind the axis"};
    for (std::size_t k = 0; k < std::size(kNames); ++k) {
        double brush::SweepRow::*const column = brush::kSweepColumns[k];
        fmt::print("{}{}, mm\n{:>9}{:>10}", k > 0 ? "\n" : "", kNames[k], "depth mm", "measured");
        for (const brush::ModelSweep& model : models)
            fmt::print("{:>8}", brush::kSpineWords[static_cast<std::size_t>(model.method)]);
        fmt::print("\n");
        for (std::size_t i = 0; i < models.front().rows.size(); ++i) {
            const double depth = models.front().rows[i].depth;
            fmt::print("{:>9.4g}{:>10}", depth / kMillimetre, millimetres(measured_mean(measured, depth, column)));
            for (const brush::ModelSweep& model : models) fmt::print("{:>8.2f}", model.rows[i].*column / kMillimetre);
            fmt::print("\n");
        }
        fmt::print("{:>19}", "rms difference");
        for (const brush::ModelSweep& model : models) fmt::print("{:>8}", millimetres(model.rms.*column));
        fmt::print("\n");
    }
}

int compare(const Brush& a) {
    check_extension(a.picture, {".png"});
    check_output(a.picture);
    const std::vector<brush::SweepRow> measured = brush::read_sweep(a.compare.string());
    brush::Preset preset = brush::load_preset(a.name.empty() ? "robot-2020" : a.name);
    // A slant or a geometry stays in proportion to the hair; foam keeps its height.
    if (const auto length = brush::stated_length(a.compare.string()); length && !brush::is_foam(preset)) {
        const std::string name = preset.name;
        if (preset.slant > 0 || preset.geometry) preset = brush::scaled(preset, *length / preset.length);
        preset.length = *length;
        preset.name = name;
    }
    brush::check_preset(preset, preset.name);
    const std::vector<brush::ModelSweep> models = brush::compare_models(preset, measured);
    if (!a.picture.empty()) {
        const render::BrushPicture picture = render::draw_comparison(models, measured);
        io::write_image(a.picture, io::view_of(picture.width, picture.height, 3, picture.rgb.data()));
    }
    if (a.common.json)
        print_json(comparison_json(preset, models));
    else
        print_comparison(models, measured);
    return 0;
}

}  // namespace

int run(const Brush& a) {
    if (!a.calibrate.empty()) return calibrate(a);
    if (!a.match.empty()) return match(a);
    if (!a.compare.empty()) return compare(a);
    if (a.name.empty()) {
        list_brushes(a.common.json);
        return 0;
    }
    check_extension(a.picture, {".png"});
    check_extension(a.sweep_depth, {".csv"});
    check_output(a.picture);
    check_output(a.sweep_depth);
    const brush::Preset preset = brush::load_preset(a.name);
    if (!a.picture.empty()) {
        const render::BrushPicture picture = render::draw_tuft(preset);
        io::write_image(a.picture, io::view_of(picture.width, picture.height, 3, picture.rgb.data()));
    }
    if (!a.sweep_depth.empty()) {
        const double most = stroke::working_depth(preset), step = std::min(kMillimetre, 0.1 * most);
        std::vector<double> depths;
        for (int i = 0; i * step <= most + 0.5 * step; ++i) depths.push_back(i * step);
        const std::string csv = brush::sweep_csv(brush::sweep_depth(preset, depths));
        write_file(a.sweep_depth, csv.data(), csv.size());
    }
    if (brush::is_foam(preset)) {
        if (a.common.json)
            print_json(foam_json(preset));
        else
            print_foam(preset);
        return 0;
    }
    const brush::QueryTable table = brush::make_table(preset);
    if (a.common.json)
        print_json(table_json(preset, table));
    else
        print_table(preset, table);
    return 0;
}

}  // namespace tuft::cli
