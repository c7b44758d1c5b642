#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "stroke/journal/tables.h"

/// `tuft layer`: what a project's layers are, changed by entries of its journal.
namespace tuft::cli {
namespace {

double number_of(const LayerWork& a) {
    double x = 0;
    const char* end = a.value.data() + a.value.size();
    const auto [last, error] = std::from_chars(a.value.data(), end, x);
    if (a.value.empty() || error != std::errc{} || last != end)
        throw UsageError("'tuft layer PROJECT " + a.what + " NAME VALUE' needs a number, not '" + a.value + "'");
    return x;
}

stroke::LayerEdit edit_of(const LayerWork& a, const stroke::LayerTable& table) {
    if (a.what == "add") return stroke::add_on_top(table, a.name);
    const stroke::Layer* found = table.find(a.name);
    if (!found) throw Error(a.project.string(), Message("has no layer '{}'", a.name));
    if (a.what == "remove") return stroke::removed(found->id);
    if (a.what == "merge") return stroke::merged_down(table, found->id);
    if (a.what == "duplicate")
        return stroke::duplicated(table, found->id,
                                  a.value.empty() ? stroke::free_name(table, a.name + " copy") : a.value);
    stroke::Layer layer = *found;
    if (a.what == "show" || a.what == "hide") layer.visible = a.what == "show";
    if (a.what == "lock" || a.what == "unlock") layer.locked = a.what == "lock";
    if (a.what == "opacity") layer.opacity = number_of(a);
    if (a.what == "rename") layer.name = a.value;
    if (a.what == "blend") {
        const std::optional<ink::Blend> blend = ink::blend_of(a.value);
        if (!blend)
            throw UsageError("'tuft layer PROJECT blend NAME VALUE' needs normal, glaze or multiply, not '" + a.value +
                             "'");
        layer.blend = *blend;
    }
    if (a.what == "move") {
        const double place = number_of(a), n = static_cast<double>(table.layers.size());
        if (!(place >= 1 && place <= n && place == std::floor(place)))
            throw UsageError(fmt::format("a layer's place is 1 (the lowest) to {}", table.layers.size()));
        return stroke::moved(table, layer.id, static_cast<std::uint32_t>(place) - 1);
    }
    return stroke::changed(table, layer);
}

}  // namespace

int run(const LayerWork& a) {
    Console console(a.common.quiet);
    io::Project project = io::Project::open(a.project, open_options(io::Access::write, console));
    const std::vector<stroke::JournalEntry> entries = project.strokes();
    stroke::LayerTable table = stroke::layers_after(entries);
    const stroke::LayerEdit edit = edit_of(a, table);
    stroke::apply(table, edit);
    project.append(stroke::entry_after(entries, edit));
    if (a.common.json) {
        nlohmann::json j{{"project", a.project.string()}, {"layers", nlohmann::json::array()}};
        for (const stroke::Layer& l : table.layers) j["layers"].push_back(to_json(l));
        print_json(j);
        return 0;
    }
    for (auto l = table.layers.rbegin(); l != table.layers.rend(); ++l)
        fmt::print("{}{}{}, opacity {:g}{}\n", l->name, l->visible ? "" : " (hidden)", l->locked ? " (locked)" : "",
                   l->opacity, l->blend == ink::Blend::normal ? "" : std::string(", ") + ink::name_of(l->blend));
    return 0;
}

}  // namespace tuft::cli
