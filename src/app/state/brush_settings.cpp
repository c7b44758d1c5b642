#include "app/state/brush_settings.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include "app/document/pictures/state_folder.h"
#include "app/paint/paint_thread.h"
#include "brush/calibration/sweep.h"
#include "brush/preset/preset.h"
#include "brush/tuft/ferrule.h"
#include "core/files/files.h"
#include "stroke/placement/placement.h"

/// \file
/// The brush that a model is opened with: the one that a person last had in hand for it, the one of its last stroke,
/// or one in the size of the model.
///
/// Size: at the resting pressure its line shall be 2 % of the diagonal of the model's box wide, 12 to 16 pixels where
/// the whole model is seen, but no wider than a quarter of the middle side of its box. Of the brushes with the hair
/// that is in the hand the one nearest to that is taken, scaled where it is further off than half as much again.
namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr double kPartOfDiagonal = 0.02, kPartOfMiddle = 0.25;
constexpr double kNearEnough = 1.5;       // times the wanted width, up or down, that a brush keeps its own size
constexpr std::size_t kMostModels = 200;  // remembered
constexpr std::size_t kMostOwn = 100;     // brushes of files

fs::path memory_path() {
    return state_folder() / "brushes";
}

fs::path own_path() {
    return state_folder() / "own_brushes";
}

// Brush and model, the newest first.
std::vector<std::pair<std::string, std::string>> memory() {
    std::vector<std::pair<std::string, std::string>> all;
    std::ifstream in(memory_path());
    for (std::string line; all.size() < kMostModels && std::getline(in, line);)
        if (const auto tab = line.find('\t'); tab != std::string::npos)
            all.emplace_back(line.substr(0, tab), line.substr(tab + 1));
    return all;
}

bool loads(const std::string& brush) {
    try {
        brush::load_preset(brush);
        return true;
    } catch (const Error&) {
        return false;  // of another version, or a file that is missing
    }
}

void remember_own(const BrushSettings& brush) {
    std::string text;
    for (const std::string& preset : brush.presets)
        if (is_own_brush(preset)) text += preset + "\n";
    try {
        write_file(own_path(), text.data(), text.size());
    } catch (const Error&) {
        // The list holds for this run then.
    }
}

// Metres, of a shipped brush in its own size.
double line_width(const std::string& name, double pressure) {
    static std::map<std::pair<std::string, double>, double> known;
    const auto [at, is_new] = known.try_emplace({name, pressure});
    if (is_new) {
        const brush::Preset preset = brush::load_preset(name);
        const double depth = pressure * stroke::working_depth(preset);
        at->second = brush::sweep_depth(preset, std::span(&depth, 1)).front().width;
    }
    return at->second;
}

}  // namespace

std::vector<std::string> remembered_own_brushes() {
    std::vector<std::string> files;
    std::ifstream in(own_path());
    for (std::string file; files.size() < kMostOwn && std::getline(in, file);)
        if (is_own_brush(file) && std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
    return files;
}

void take_own_brush(BrushSettings& brush, const fs::path& file) {
    const std::string name = fs::absolute(file).lexically_normal().string();
    if (const ShelfBrush& read = brush.shelf.read(name); !read.fault.empty()) throw Error(read.fault);
    if (std::find(brush.presets.begin(), brush.presets.end(), name) == brush.presets.end()) {
        brush.presets.push_back(name);
        remember_own(brush);
    }
    brush.preset = name;
}

void take_brush(BrushSettings& brush, const std::string& name) {
    // A file that was missing may be back since the last look.
    if (!brush.shelf.at(name).fault.empty())
        if (const ShelfBrush& now = brush.shelf.read(name); !now.fault.empty()) throw Error(now.fault);
    brush.preset = name;
}

void forget_own_brush(BrushSettings& brush, const std::string& name) {
    if (is_own_brush(name) && std::erase(brush.presets, name) > 0) remember_own(brush);
}

double first_line_width(const Box& box) {
    std::array<double, 3> side{box.size().x, box.size().y, box.size().z};
    std::sort(side.begin(), side.end());
    return std::min(kPartOfDiagonal * box.diagonal(), kPartOfMiddle * side[1]);
}

std::string first_brush(const std::vector<std::string>& brushes, const std::string& hair_of, double pressure,
                        double width) {
    const std::string hair = hair_of.substr(0, hair_of.find('-') + 1);
    std::string best;
    double factor = 1, least = 1e9;
    for (const std::string& name : brushes) {
        if (!name.starts_with(hair)) continue;
        const double wanted = width / line_width(name, pressure);
        if (const double off = std::abs(std::log(wanted)); off < least) best = name, factor = wanted, least = off;
    }
    if (best.empty() || std::abs(std::log(factor)) <= std::log(kNearEnough)) return best.empty() ? hair_of : best;
    factor = std::clamp(factor, brush::kLeastSize, brush::kMostSize);
    const double digits = std::pow(10.0, 1 - std::floor(std::log10(factor)));  // two of them
    factor = std::clamp(std::round(factor * digits) / digits, brush::kLeastSize, brush::kMostSize);
    return brush::name_of({best, factor});
}

Message choose_brush(BrushSettings& brush, const PaintThread& work, std::span<const StrokeLine> lines,
                     double pressure) {
    Message fault;
    const auto take = [&](const std::string& name) {
        if (!loads(name)) return false;
        brush.preset = brush.remembered = name;
        return true;
    };
    for (const auto& [name, model] : memory()) {
        if (model != work.source()) continue;
        if (take(name)) return {};
        if (is_own_brush(name)) fault = brush.shelf.at(brush::sized_name(name).base).fault;
    }
    for (auto line = lines.rbegin(); line != lines.rend(); ++line)
        if (line->action == stroke::EntryKind::stroke && !line->on_palette && take(line->brush)) return fault;
    take(first_brush(brush.presets, brush.preset, pressure, first_line_width(work.model().mesh->bounds)));
    return fault;
}

void remember_brush(BrushSettings& brush, const PaintThread* work) {
    if (!work || brush.preset == brush.remembered) return;
    brush.remembered = brush.preset;
    std::vector<std::pair<std::string, std::string>> all = memory();
    std::erase_if(all, [&](const auto& entry) { return entry.second == work->source(); });
    all.insert(all.begin(), {brush.preset, work->source()});
    if (all.size() > kMostModels) all.resize(kMostModels);
    std::string text;
    for (const auto& [name, model] : all) text += name + "\t" + model + "\n";
    try {
        write_file(memory_path(), text.data(), text.size());
    } catch (const Error&) {
        // It holds for this run then.
    }
}

bool brush_can_be_turned(BrushSettings& brush) {
    return brush::can_be_turned(brush.shelf.at(brush::sized_name(brush.preset).base).preset);
}

void size_brush(BrushSettings& brush, StatusMessage& status, double factor) {
    const std::string sized = brush::name_of({brush::sized_name(brush.preset).base, std::round(1e3 * factor) / 1e3});
    try {
        brush::load_preset(sized);
        brush.preset = sized;
    } catch (const Error& error) {
        show_message(status, error.message());  // not every brush has every size
    }
}

}  // namespace tuft::app
