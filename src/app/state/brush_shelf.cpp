#include "app/state/brush_shelf.h"

#include <algorithm>
#include <array>
#include <utility>

#include "app/document/detached.h"
#include "core/error.h"
#include "core/files/modified_time.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::array<const char*, 8> kTitles{"goat", "mixed", "wolf", "flat", "liner", "round", "sponge", "own"};
constexpr double kLinerThicknesses = 6;
constexpr std::chrono::seconds kBetweenLooks{1};

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
    return take(name, read_file_of(name));
}

BrushShelf::Read BrushShelf::read_file_of(const std::string& name) {
    Read read;
    // Before it is read: what is written meanwhile is seen at the next look.
    if (is_own_brush(name)) read.written = modified_time(name);
    try {
        read.preset = brush::load_preset(name);
    } catch (const Error& error) {
        read.fault = is_own_brush(name) && !read.written ? Message("The file of this brush is missing: {}", name)
                                                         : error.message();
    }
    return read;
}

const ShelfBrush& BrushShelf::take(const std::string& name, Read read) {
    ShelfBrush& brush = brushes_[name];
    brush.reading = ++readings_;
    if (read.preset) brush.preset = std::move(*read.preset);
    brush.fault = std::move(read.fault);
    brush.written = read.written;
    return brush;
}

void BrushShelf::watch(const std::vector<std::string>& names, const std::string& in_hand) {
    poll();
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < kBetweenLooks) return;
    looked_ = now;
    std::erase_if(brushes_, [&](const auto& entry) {
        const std::string& name = entry.first;
        return is_own_brush(name) && name != in_hand && std::find(names.begin(), names.end(), name) == names.end();
    });
    look();
}

void BrushShelf::look() {
    if (busy()) return;
    std::vector<Known> known;
    for (const auto& [name, brush] : brushes_)
        if (is_own_brush(name)) known.push_back({name, brush.reading, brush.written});
    if (known.empty()) return;
    looking_ = run_detached([known = std::move(known)] {
        std::vector<Changed> changed;
        for (const Known& brush : known)
            if (modified_time(brush.name) != brush.written) changed.push_back({brush, read_file_of(brush.name)});
        return changed;
    });
}

BrushShelf::~BrushShelf() {
    wait_briefly(looking_);
}

void BrushShelf::wait() const {
    if (busy()) looking_.wait();
}

void BrushShelf::poll() {
    if (!busy() || looking_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    for (Changed& changed : looking_.get()) {
        // One that was read meanwhile, or let go, is another one.
        const auto at = brushes_.find(changed.before.name);
        if (at == brushes_.end() || at->second.reading != changed.before.reading) continue;
        take(changed.before.name, std::move(changed.read));
    }
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
