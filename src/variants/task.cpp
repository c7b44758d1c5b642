#include "variants/task.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "brush/preset/preset.h"
#include "core/error.h"
#include "core/files/disk_cache.h"
#include "core/files/files.h"
#include "core/geometry/bounds.h"
#include "core/system/build_facts.h"
#include "core/text/nesting.h"
#include "core/text/text.h"
#include "core/text/units.h"
#include "ink/colour/pigments.h"
#include "stroke/drawing/free_area.h"
#include "stroke/journal/entry/samples.h"

namespace fs = std::filesystem;

namespace tuft::variants {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ModelChoice, file, unit, up, atlas_size)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PlacementChoice, at_mm, side, width_mm, turn_deg, mapping)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Tolerance, name, shift_mm, turn_deg, scale, hand_mm, hand_length_mm, pressure)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PictureChoice, of, width, height, view_deg, zoom)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PaintingChoice, substrate, film, dip, fit_brush)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Task, name, model, strokes, ink, brush, painting, placement, tolerance, sample, seed,
                                   picture, program, contents)

namespace {

constexpr std::size_t kLongestName = 400;  // bytes
constexpr const char* kFormat = "tuft variant 1";

std::string hex(const CacheKey& key) {
    return fmt::format("{:016x}{:016x}", key.high(), key.low());
}

std::string hash_of_text(const std::string& text) {
    CacheKey key("text");
    key.add_text(text);
    return hex(key);
}

/// Fails with one line for values out of range.
struct Checker {
    const std::string& source;

    void number(const char* what, double v, double lo, double hi) const {
        if (!(v >= lo && v <= hi))
            throw Error(source, fmt::format("'{}' must be a number from {:g} to {:g}", what, lo, hi));
    }
    void text(const char* what, const std::string& v) const {
        const bool printable = std::none_of(v.begin(), v.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
        if (v.size() > kLongestName || !is_utf8(v) || !printable)
            throw Error(source, fmt::format("'{}' must be a line of text of at most {} bytes", what, kLongestName));
    }
    void word(const char* what, const std::string& v, const std::vector<std::string>& allowed) const {
        if (std::find(allowed.begin(), allowed.end(), v) == allowed.end())
            throw Error(source,
                        fmt::format("'{}' must be one of {}, not '{}'", what, fmt::join(allowed, ", "), excerpt(v)));
    }
};

void check_placement(const PlacementChoice& p, const Checker& check) {
    if (!p.at_mm.empty() && p.at_mm.size() != 3) throw Error(check.source, "'at_mm' must be three numbers");
    for (const double v : p.at_mm) check.number("at_mm", v, -kFarthest / kMillimetre, kFarthest / kMillimetre);
    if (!p.side.empty() && !stroke::side_named(p.side))
        throw Error(check.source, fmt::format("there is no side '{}'", excerpt(p.side)));
    check.number("width_mm", p.width_mm, 0, kFarthest / kMillimetre);
    check.number("turn_deg", p.turn_deg, -360, 360);
    if (!p.mapping.empty()) check.word("mapping", p.mapping, {"drape", "wrap", "project"});
}

void check_tolerance(const Tolerance& t, const Checker& check) {
    check.text("name", t.name);
    check.number("shift_mm", t.shift_mm, 0, 1000);
    check.number("turn_deg", t.turn_deg, 0, 90);
    check.number("scale", t.scale, 0, 0.2);
    check.number("hand_mm", t.hand_mm, 0, 1000);
    check.number("hand_length_mm", t.hand_length_mm, 0.01, 10000);
    check.number("pressure", t.pressure, 0, 1);
}

}  // namespace

std::string program_version() {
    const BuildFacts& facts = build_facts();
    return facts.commit.empty() ? facts.version : facts.version + " " + facts.commit;
}

void check_task(const Task& task, const std::string& source) {
    const Checker check{source};
    for (const auto& [what, text] : {std::pair{"name", &task.name},
                                     {"model", &task.model.file},
                                     {"strokes", &task.strokes},
                                     {"ink", &task.ink},
                                     {"brush", &task.brush},
                                     {"substrate", &task.painting.substrate},
                                     {"program", &task.program}})
        check.text(what, *text);
    if (!task.model.unit.empty() && !metres_per(task.model.unit))
        throw Error(source, fmt::format("there is no unit '{}'", excerpt(task.model.unit)));
    check.word("up", task.model.up, {"", "y", "z"});
    check.number("atlas_size", task.model.atlas_size, 0, 65536);
    check.word("film", task.painting.film, {"still", "wet"});
    check.word("dip", task.painting.dip, {"each", "persistent", "endless", "carry"});
    check_placement(task.placement, check);
    check_tolerance(task.tolerance, check);
    check.number("sample", task.sample, 0, kMostSamples);
    check.number("width", task.picture.width, 16, kLargestPicture);
    check.number("height", task.picture.height, 16, kLargestPicture);
    check.word("of", task.picture.of, {"all", "planned", "none"});
    check.number("zoom", task.picture.zoom, 1, 100);
    if (!task.picture.view_deg.empty() && task.picture.view_deg.size() != 2)
        throw Error(source, "'view_deg' must be azimuth and elevation");
    for (const double v : task.picture.view_deg) check.number("view_deg", v, -360, 360);
    if (task.picture.view_deg.size() == 2) check.number("elevation", task.picture.view_deg[1], -89, 89);
}

std::string json_of(const Task& task) {
    nlohmann::json j = task;
    j["format"] = kFormat;
    return j.dump(1) + "\n";
}

Task task_of_json(const std::string& text, const std::string& source) {
    check_json_nesting(text, source);
    Task task;
    try {
        const nlohmann::json j = nlohmann::json::parse(text);
        if (j.at("format") != kFormat) throw Error(source, "is a task of another version of tuft");
        j.get_to(task);
    } catch (const nlohmann::json::exception&) {
        throw Error(source, "is no task of 'tuft variants'");
    }
    check_task(task, source);
    return task;
}

std::string hash_of(const Task& task) {
    if (task.painting.dip != "persistent") return hash_of_text(json_of(task));
    Task earlier = task;
    earlier.painting.dip = "carry";  // the word of earlier versions, whose results are kept
    return hash_of_text(json_of(earlier));
}

fs::path find_input(const fs::path& folder, const std::string& name) {
    const fs::path relative = fs::path(name).lexically_normal();
    if (name.empty() || relative.is_absolute() || *relative.begin() == "..")
        throw Error(fmt::format("'{}' does not lie in the folder of the plan", excerpt(name)));
    std::error_code ec;
    const fs::path root = fs::canonical(folder, ec), file = root / relative;
    if (!ec && fs::exists(file, ec)) {
        const fs::path real = fs::canonical(file, ec);
        const auto [left, rest] = std::mismatch(root.begin(), root.end(), real.begin(), real.end());
        if (ec || left != root.end())
            throw Error(fmt::format("'{}' is a link out of the folder of the plan", excerpt(name)));
        return file;
    }
    for (const char* of : {"models", "samples/strokes"}) {
        const fs::path shipped = data_folder() / of / relative;
        if (!relative.has_parent_path() && fs::is_regular_file(shipped, ec)) return shipped;
    }
    throw Error(fmt::format("there is no file '{}' in the folder of the plan", excerpt(name)));
}

std::string content_hash(const fs::path& file) {
    const std::vector<char> bytes = read_file(file);
    CacheKey key("file");
    key.add_array(std::span<const char>(bytes));
    return hex(key);
}

ContentHashes contents_of(const Task& task, const fs::path& folder, ContentHashes& known) {
    ContentHashes out;
    const auto add = [&](const std::string& name, const auto& hash) {
        const auto at = known.find(name);
        out[name] = known[name] = at == known.end() ? hash() : at->second;
    };
    const auto is_file = [](const std::string& name) { return fs::path(name).extension() == ".toml"; };
    const auto preset = [&](const std::string& name) {
        return is_file(name) ? find_input(folder, name).string() : name;
    };
    const auto add_file = [&](const std::string& name) {
        add(name, [&] { return content_hash(find_input(folder, name)); });
    };
    add_file(task.model.file);
    add_file(task.strokes);
    if (is_file(task.painting.substrate)) add_file(task.painting.substrate);
    if (!task.brush.empty())
        add("brush " + task.brush,
            [&] { return hash_of_text(brush::preset_toml(brush::load_preset(preset(task.brush)))); });
    if (!task.ink.empty() && task.ink.front() != '#')
        add("ink " + task.ink, [&] { return hash_of_text(ink::ink_toml(ink::load_ink(preset(task.ink)))); });
    return out;
}

}  // namespace tuft::variants
