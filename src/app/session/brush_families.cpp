#include "app/session/brush_families.h"

#include <algorithm>
#include <array>

#include "app/state/brush_settings.h"

namespace tuft::app {
namespace {

constexpr std::array<const char*, 8> kTitles{"goat", "mixed", "wolf", "flat", "liner", "round", "sponge", "own"};
constexpr double kLinerThicknesses = 6;

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

std::vector<BrushFamily> brush_families(const std::vector<std::string>& names) {
    std::vector<BrushFamily> all;
    for (const char* title : kTitles) all.push_back({title, {}});
    for (const std::string& name : names) {
        const std::string family = family_of(name, shipped_brush(name));
        std::find_if(all.begin(), all.end(), [&](const BrushFamily& f) {
            return f.title == family;
        })->names.push_back(name);
    }
    std::erase_if(all, [](const BrushFamily& f) { return f.names.empty(); });
    for (BrushFamily& f : all)
        std::stable_sort(f.names.begin(), f.names.end(), [](const std::string& a, const std::string& b) {
            return shipped_brush(a).length < shipped_brush(b).length;
        });
    return all;
}

}  // namespace tuft::app
