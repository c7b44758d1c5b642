#include "app/state/brush_shelf.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::array<const char*, 8> kTitles{"goat", "mixed", "wolf", "flat", "liner", "round", "sponge", "own"};
constexpr double kLinerThicknesses = 6;
constexpr std::chrono::seconds kBetweenLooks{1};

std::optional<fs::file_time_type> time_of(const std::string& file) {
    std::error_code ec;
    const fs::file_time_type time = fs::last_write_time(file, ec);
    return ec ? std::nullopt : std::optional(time);
}

}  // namespace

bool is_own_brush(const std::string& name) {
    return name.find('/') != std::string::npos || name.ends_with(".toml");
}

std::string family_of(const std::string& name, const brush::Preset& preset) {
    if (is_own_brush(name)) return "own";
    for (const char* hair : {"goat", "mixed", "wolf"})
        if (name.starts_with(std::string(hair) + "-")) return hair;
    if (brush::is_foam(preset)) return "sponge";
    if (brush::has_broad_side(preset)) return "flat";
    return preset.length >= kLinerThicknesses * 2 * preset.radius ? "liner" : "round";
}

const ShelfBrush& BrushShelf::at(const std::string& name) {
    const auto at = brushes_.find(name);
    return at == brushes_.end() ? read(name) : at->second;
}

const ShelfBrush& BrushShelf::read(const std::string& name) {
    ShelfBrush& brush = brushes_[name];
    brush.reading = ++readings_;
    brush.fault = {};
    // Before it is read: what is written meanwhile is seen at the next look.
    if (is_own_brush(name)) brush.written = time_of(name);
    try {
        brush.preset = brush::load_preset(name);
    } catch (const Error& error) {
        brush.fault = is_own_brush(name) && !brush.written ? Message("The file of this brush is away: {}", name)
                                                           : error.message();
    }
    return brush;
}

void BrushShelf::watch() {
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < kBetweenLooks) return;
    looked_ = now;
    look();
}

void BrushShelf::look() {
    for (const auto& [name, brush] : brushes_)
        if (is_own_brush(name) && time_of(name) != brush.written) read(name);
}

const std::vector<BrushFamily>& BrushShelf::families(const std::vector<std::string>& names) {
    for (const std::string& name : names) at(name);
    if (names == names_ && readings_ == families_at_) return families_;
    names_ = names;
    families_at_ = readings_;
    families_.clear();
    for (const char* title : kTitles) families_.push_back({title, {}});
    for (const std::string& name : names) {
        const std::string family = family_of(name, at(name).preset);
        std::find_if(families_.begin(), families_.end(), [&](const BrushFamily& f) {
            return f.title == family;
        })->names.push_back(name);
    }
    std::erase_if(families_, [](const BrushFamily& f) { return f.names.empty(); });
    for (BrushFamily& f : families_)
        std::stable_sort(f.names.begin(), f.names.end(), [&](const std::string& a, const std::string& b) {
            return at(a).preset.length < at(b).preset.length;
        });
    return families_;
}

}  // namespace tuft::app
