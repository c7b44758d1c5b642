#include "variants/plan.h"

#include <fmt/format.h>

#include <functional>
#include <set>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/toml_text.h"
#include "core/random.h"
#include "core/text/text.h"

namespace fs = std::filesystem;

namespace tuft::variants {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{4} << 20;
constexpr std::size_t kMostChoices = 10'000;  // of one kind

/// A value of the file.
struct Value {
    const toml::node& node;
    const std::string& source;
    std::string key;

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(source, static_cast<long>(node.source().begin.line), "'" + excerpt(key) + "' " + what);
    }
    std::string text() const {
        if (!node.is_string()) fail("must be a text in quotes");
        return *node.value<std::string>();
    }
    double number() const {
        if (!node.is_number()) fail("must be a number");
        return *node.value<double>();
    }
    std::int64_t whole(std::int64_t lo, std::int64_t hi) const {
        const auto v = node.is_integer() ? node.value<std::int64_t>() : std::nullopt;
        if (!v || *v < lo || *v > hi) fail(fmt::format("must be a whole number from {} to {}", lo, hi));
        return *v;
    }
    bool yes() const {
        if (!node.is_boolean()) fail("must be true or false");
        return *node.value<bool>();
    }
    const toml::table& table() const {
        if (!node.is_table()) fail("must be a table");
        return *node.as_table();
    }
    std::vector<Value> list() const {
        const toml::array* array = node.as_array();
        if (!array || array->empty() || array->size() > kMostChoices)
            fail(fmt::format("must be a list of 1 to {} values", kMostChoices));
        std::vector<Value> values;
        for (const toml::node& v : *array) values.push_back({v, source, key});
        return values;
    }
    std::vector<double> numbers(std::size_t n) const {
        std::vector<double> out;
        for (const Value& v : list()) out.push_back(v.number());
        if (out.size() != n) fail(fmt::format("must be {} numbers", n));
        return out;
    }
    std::vector<std::string> texts() const {
        std::vector<std::string> out;
        std::set<std::string> seen;
        for (const Value& v : list()) {
            out.push_back(v.text());
            if (!seen.insert(out.back()).second) v.fail("has '" + excerpt(out.back()) + "' twice");
            if (out.back().empty()) v.fail("has an empty name");
        }
        return out;
    }
};

/// A key and what takes its value.
using Keys = std::vector<std::pair<std::string, std::function<void(const Value&)>>>;

void read_table(const toml::table& table, const std::string& source, const Keys& keys) {
    for (const auto& [key, node] : table) {
        const Value value{node, source, std::string(key.str())};
        const auto at = std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.first == value.key; });
        if (at == keys.end()) {
            std::vector<std::string> names;
            for (const auto& k : keys) names.push_back(k.first);
            value.fail("is no key of a plan here" + did_you_mean(nearest_name(value.key, names)).text());
        }
        at->second(value);
    }
}

ModelChoice read_choice(const Value& v) {
    ModelChoice m;
    if (v.node.is_string()) {
        m.file = v.text();
        return m;
    }
    read_table(v.table(), v.source,
               {{"file", [&](const Value& x) { m.file = x.text(); }},
                {"unit", [&](const Value& x) { m.unit = x.text(); }},
                {"up", [&](const Value& x) { m.up = x.text(); }},
                {"atlas_size", [&](const Value& x) { m.atlas_size = static_cast<std::uint32_t>(x.whole(1, 65536)); }}});
    if (m.file.empty()) v.fail("has a model without 'file'");
    return m;
}

void read_models(const Value& v, Plan& plan) {
    std::set<std::string> seen;
    for (const Value& m : v.list()) {
        plan.models.push_back(read_choice(m));
        if (!seen.insert(plan.models.back().file).second)
            m.fail("has '" + excerpt(plan.models.back().file) + "' twice");
    }
}

void read_placement(const Value& v, PlacementChoice& p) {
    read_table(v.table(), v.source,
               {{"at_mm", [&](const Value& x) { p.at_mm = x.numbers(3); }},
                {"side", [&](const Value& x) { p.side = x.text(); }},
                {"width_mm", [&](const Value& x) { p.width_mm = x.number(); }},
                {"turn_deg", [&](const Value& x) { p.turn_deg = x.number(); }},
                {"mapping", [&](const Value& x) { p.mapping = x.text(); }}});
    if (!p.at_mm.empty() && !p.side.empty()) v.fail("has both 'at_mm' and 'side'");
}

void read_tolerance(const Value& v, Plan& plan) {
    Tolerance t;
    int samples = 0;
    read_table(v.table(), v.source,
               {{"name", [&](const Value& x) { t.name = x.text(); }},
                {"samples", [&](const Value& x) { samples = static_cast<int>(x.whole(1, kMostSamples)); }},
                {"shift_mm", [&](const Value& x) { t.shift_mm = x.number(); }},
                {"turn_deg", [&](const Value& x) { t.turn_deg = x.number(); }},
                {"scale", [&](const Value& x) { t.scale = x.number(); }},
                {"hand_mm", [&](const Value& x) { t.hand_mm = x.number(); }},
                {"hand_length_mm", [&](const Value& x) { t.hand_length_mm = x.number(); }},
                {"pressure", [&](const Value& x) { t.pressure = x.number(); }}});
    if (t.name.empty()) v.fail("has a tolerance without 'name'");
    if (samples == 0) v.fail("has a tolerance without 'samples'");
    for (const Tolerance& other : plan.tolerances)
        if (other.name == t.name) v.fail("has '" + excerpt(t.name) + "' twice");
    plan.tolerances.push_back(t);
    plan.samples.push_back(samples);
}

void read_painting(const Value& v, PaintingChoice& p) {
    read_table(v.table(), v.source,
               {{"substrate", [&](const Value& x) { p.substrate = x.text(); }},
                {"film", [&](const Value& x) { p.film = x.text(); }},
                // "carry" is the word of earlier versions.
                {"dip", [&](const Value& x) { p.dip = x.text() == "carry" ? "persistent" : x.text(); }},
                {"fit_brush", [&](const Value& x) { p.fit_brush = x.yes(); }}});
}

void read_picture(const Value& v, PictureChoice& p) {
    const auto side = [](const Value& x) { return static_cast<int>(x.whole(16, kLargestPicture)); };
    read_table(v.table(), v.source,
               {{"of", [&](const Value& x) { p.of = x.text(); }},
                {"width", [&](const Value& x) { p.width = side(x); }},
                {"height", [&](const Value& x) { p.height = side(x); }},
                {"zoom", [&](const Value& x) { p.zoom = x.number(); }},
                {"view_deg", [&](const Value& x) { p.view_deg = x.numbers(2); }}});
}

void check_count(const Plan& plan, const std::string& source) {
    double samples = 1;
    for (const int n : plan.samples) samples += n;
    const double n = static_cast<double>(plan.models.size()) * static_cast<double>(plan.strokes.size()) *
                     static_cast<double>(plan.inks.size()) * static_cast<double>(plan.brushes.size()) * samples;
    if (n > kMostTasks) throw Error(source, fmt::format("makes {:.0f} variants; at most {} are made", n, kMostTasks));
}

/// What all tasks have in common.
Task first_task(const Plan& plan) {
    Task task;
    task.painting = plan.painting;
    task.placement = plan.placement;
    task.picture = plan.picture;
    task.program = program_version();
    return task;
}

/// The part of a name that distinguishes files: without folders and extension.
std::string short_name(const std::string& file) {
    return fs::path(file).stem().string();
}

std::string name_of(const Task& t) {
    std::string name = short_name(t.model.file) + " " + short_name(t.strokes);
    for (const std::string& part : {t.ink, t.brush})
        if (!part.empty()) name += " " + (part.front() == '#' ? part : short_name(part));
    if (t.sample > 0) name += fmt::format(" {} {}", t.tolerance.name, t.sample);
    return name;
}

/// Adds a task as planned, then one for each sample of each tolerance.
void add_samples(std::vector<Task>& tasks, Task task, const Plan& plan) {
    const auto add = [&] {
        task.name = name_of(task);
        tasks.push_back(task);
    };
    add();
    for (std::size_t t = 0; t < plan.tolerances.size(); ++t)
        for (int k = 1; k <= plan.samples[t]; ++k) {
            task.tolerance = plan.tolerances[t];
            task.sample = k;
            task.seed = hash_bits(hash_bits(plan.seed, t), static_cast<std::uint64_t>(k));
            add();
        }
}

/// Files with one stem, such as vase.stl and old/vase.ply, get their number in the plan.
void make_distinct(std::vector<Task>& tasks) {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < tasks.size(); ++i)
        if (!seen.insert(tasks[i].name).second) tasks[i].name += fmt::format(" ({})", i);
}

}  // namespace

Plan parse_plan(const std::string& text, const std::string& source, const fs::path& folder) {
    Plan plan;
    plan.folder = folder;
    const toml::table table = parse_toml(text, source);
    read_table(table, source,
               {{"name", [&](const Value& v) { plan.name = v.text(); }},
                {"seed", [&](const Value& v) { plan.seed = static_cast<std::uint64_t>(v.whole(0, 1'000'000'000)); }},
                {"models", [&](const Value& v) { read_models(v, plan); }},
                {"strokes", [&](const Value& v) { plan.strokes = v.texts(); }},
                {"inks", [&](const Value& v) { plan.inks = v.texts(); }},
                {"brushes", [&](const Value& v) { plan.brushes = v.texts(); }},
                {"painting", [&](const Value& v) { read_painting(v, plan.painting); }},
                {"placement", [&](const Value& v) { read_placement(v, plan.placement); }},
                {"tolerance",
                 [&](const Value& v) {
                     for (const Value& t : v.list()) read_tolerance(t, plan);
                 }},
                {"picture", [&](const Value& v) { read_picture(v, plan.picture); }}});
    if (plan.models.empty()) throw Error(source, "names no 'models'");
    if (plan.strokes.empty()) throw Error(source, "names no 'strokes'");
    if (plan.inks.empty()) plan.inks.emplace_back();
    if (plan.brushes.empty()) plan.brushes.emplace_back();
    check_count(plan, source);
    Task task = first_task(plan);
    check_task(task, source);
    for (const Tolerance& t : plan.tolerances) task.tolerance = t, check_task(task, source);
    for (const ModelChoice& m : plan.models) task.model = m, check_task(task, source);
    return plan;
}

Plan read_plan(const fs::path& file) {
    const std::vector<char> bytes = read_file(file, kMaxBytes);
    const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
    Plan plan = parse_plan({bytes.begin(), bytes.end()}, file.string(), folder);
    if (plan.name.empty()) plan.name = to_utf8(file.stem().string());
    return plan;
}

std::vector<Task> tasks_of(const Plan& plan) {
    std::vector<Task> tasks;
    ContentHashes known;
    Task task = first_task(plan);
    for (const ModelChoice& model : plan.models)
        for (const std::string& strokes : plan.strokes)
            for (const std::string& ink : plan.inks)
                for (const std::string& brush : plan.brushes) {
                    task.model = model;
                    task.strokes = strokes;
                    task.ink = ink;
                    task.brush = brush;
                    task.contents = contents_of(task, plan.folder, known);
                    add_samples(tasks, task, plan);
                }
    make_distinct(tasks);
    return tasks;
}

}  // namespace tuft::variants
