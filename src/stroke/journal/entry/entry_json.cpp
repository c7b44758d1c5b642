#include "stroke/journal/entry/entry_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/overloaded.h"
#include "core/text/nesting.h"
#include "core/text/text.h"

namespace tuft::stroke {
namespace {

using nlohmann::json;

constexpr std::uint64_t kMostGroupId = std::uint64_t{1} << 62;  // ids in files are signed

json parsed(const std::string& text) {
    check_json_nesting(text, "the settings of a stroke");
    try {
        return json::parse(text);
    } catch (const json::exception&) {
        throw Error(Message("the settings of a stroke cannot be read: {}", excerpt(text, 80)));
    }
}

std::vector<StencilEdge> stencil_of(const json& j) {
    const auto is_number = [](const json& x) { return x.is_number() && std::isfinite(x.get<double>()); };
    if (!j.is_array() || j.size() % 4 != 0 || j.size() > 4 * kMaxStencilEdges ||
        !std::all_of(j.begin(), j.end(), is_number))
        throw Error("the stencil of a journal's entry cannot be read");
    std::vector<StencilEdge> stencil;
    for (std::size_t i = 0; i < j.size(); i += 4)
        stencil.push_back(
            {{j[i].get<double>(), j[i + 1].get<double>()}, {j[i + 2].get<double>(), j[i + 3].get<double>()}});
    return stencil;
}

EntryGroup group_of(const json& j) {
    const auto id = j.find("group");
    if (id == j.end()) return {};
    const auto name = j.find("group_name");
    if (!id->is_number_unsigned() || id->get<std::uint64_t>() == 0 || id->get<std::uint64_t>() > kMostGroupId ||
        name == j.end() || !name->is_string())
        throw Error("the group of a journal's entry cannot be read");
    EntryGroup group{id->get<std::uint64_t>(), name->get<std::string>()};
    check_name(group.name, "group");
    return group;
}

std::uint32_t table_id_of(const json& j, const char* key, std::uint32_t otherwise) {
    const auto value = j.find(key);
    if (value == j.end()) return otherwise;
    if (!value->is_number_unsigned() || value->get<std::uint64_t>() >= kPaletteLayer)
        throw Error(Message("the {} of a journal's entry cannot be read", key));
    return value->get<std::uint32_t>();
}

std::uint32_t layer_in(const json& j) {
    const std::uint32_t layer = table_id_of(j, "layer", kFirstLayer);
    const auto on = j.find("on");
    if (on == j.end()) return layer;
    if (*on != "palette" && *on != "model")
        throw Error(Message("a stroke is on the palette or the model, not on {}", excerpt(on->dump(), 40)));
    return *on == "palette" ? kPaletteLayer : layer;
}

Tool tool_in(const json& j) {
    const auto tool = j.find("tool");
    if (tool == j.end()) return Tool::brush;
    if (*tool != "eraser" && *tool != "brush")
        throw Error(Message("the tool of a stroke is brush or eraser, not {}", excerpt(tool->dump(), 40)));
    return *tool == "eraser" ? Tool::eraser : Tool::brush;
}

BrushChange change_in(const json& j, EntryKind kind) {
    BrushChange change = change_of(kind);
    try {
        for (const ChangeNumber& n : numbers_of(change)) set_number(change, n.name, j.value(n.name, n.value));
    } catch (const json::exception&) {
        throw Error("how far a brush was dipped or wiped cannot be read");
    }
    check_change(change);
    return change;
}

double seconds_in(const json& j) {
    const auto seconds = j.find("seconds");
    if (seconds == j.end()) return 0;
    if (!seconds->is_number()) throw Error("the seconds of a journal's entry cannot be read");
    check_seconds(seconds->get<double>());
    return seconds->get<double>();
}

void put_target(json& j, std::uint32_t layer, std::uint32_t mask) {
    if (layer == kPaletteLayer)
        j["on"] = "palette";
    else if (layer != kFirstLayer)
        j["layer"] = layer;
    if (mask != 0) j["mask"] = mask;
}

json json_of(const PaintStroke& stroke) {
    json j = json_of(stroke.settings);
    put_target(j, stroke.layer, stroke.mask);
    if (stroke.erases()) j["tool"] = "eraser";
    if (stroke.trace.stencil.empty()) return j;
    json& edges = j["tape"] = json::array();
    for (const StencilEdge& e : stroke.trace.stencil)
        for (const double x : {e.from.x, e.from.y, e.to.x, e.to.y}) edges.push_back(x);
    return j;
}

// Older versions look for depth and amount together.
json json_of(const BrushAction& action) {
    json j = json_of(StrokeSettings{.spine = action.spine, .dip = action.dip});
    const std::vector<ChangeNumber> numbers = numbers_of(action.what);
    if (std::ranges::all_of(numbers, [](const ChangeNumber& n) { return n.value == n.usual; })) return j;
    for (const ChangeNumber& n : numbers)
        if (n.value != n.usual || n.usual != 0) j[n.name] = n.value;
    return j;
}

json json_of(const Dry& dry) {
    json j = json_of(StrokeSettings{.down = dry.down});
    j["seconds"] = dry.seconds;
    return j;
}

// Kinds without settings write the defaults: older versions look for them.
json with_settings(const char* key, json content) {
    json j = json_of(StrokeSettings{});
    j[key] = std::move(content);
    return j;
}

EntryContent content_of(EntryColumns& columns, EntryKind kind, const json& j) {
    const StrokeSettings settings = settings_of(j);
    switch (kind) {
        case EntryKind::stroke: {
            PaintStroke stroke{.trace = std::move(columns.trace),
                               .brush = std::move(columns.brush),
                               .ink = std::move(columns.ink),
                               .seed = columns.seed,
                               .tool = tool_in(j),
                               .layer = layer_in(j),
                               .mask = table_id_of(j, "mask", 0),
                               .settings = settings,
                               .names = {}};
            const auto edges = j.find("tape");
            stroke.trace.stencil = edges == j.end() ? std::vector<StencilEdge>{} : stencil_of(*edges);
            return stroke;
        }
        case EntryKind::dip:
        case EntryKind::wipe:
        case EntryKind::rinse:
        case EntryKind::reshape:
            return BrushAction{.what = change_in(j, kind),
                               .brush = std::move(columns.brush),
                               .ink = std::move(columns.ink),
                               .seed = columns.seed,
                               .dip = settings.dip,
                               .spine = settings.spine};
        case EntryKind::dry:
            return Dry{seconds_in(j), settings.down};
        case EntryKind::wash:
            return WashPalette{};
        case EntryKind::fill: {
            Fill fill = fill_of(j.value("fill", json::object()));
            fill.ink = std::move(columns.ink);
            fill.layer = layer_in(j);
            fill.mask = table_id_of(j, "mask", 0);
            return fill;
        }
        case EntryKind::layer:
            return layer_edit_of(j.value("edit", json::object()));
        case EntryKind::mask:
            return mask_edit_of(j.value("mask_edit", json::object()));
        case EntryKind::part:
            return part_edit_of(j.value("part_edit", json::object()));
    }
    throw Error("an entry of the journal is of no kind");
}

}  // namespace

std::string entry_json(const JournalEntry& entry) {
    json j = std::visit(Overloaded{[](const PaintStroke& stroke) { return json_of(stroke); },
                                   [](const BrushAction& action) { return json_of(action); },
                                   [](const Dry& dry) { return json_of(dry); },
                                   [](const WashPalette&) { return json_of(StrokeSettings{}); },
                                   [](const Fill& fill) {
                                       json out = with_settings("fill", json_of(fill));
                                       put_target(out, fill.layer, fill.mask);
                                       return out;
                                   },
                                   [](const LayerEdit& edit) { return with_settings("edit", json_of(edit)); },
                                   [](const MaskEdit& edit) { return with_settings("mask_edit", json_of(edit)); },
                                   [](const PartEdit& edit) { return with_settings("part_edit", json_of(edit)); }},
                        entry.content);
    if (const EntryKind kind = kind_of(entry); kind != EntryKind::stroke) j["action"] = name_of(kind);
    if (entry.group.id != 0) {
        j["group"] = entry.group.id;
        j["group_name"] = entry.group.name;
    }
    return j.dump(-1, ' ', false, json::error_handler_t::replace);
}

JournalEntry entry_of(EntryColumns columns, const std::string& text) {
    const json j = parsed(text);
    JournalEntry entry;
    entry.id = columns.id;
    entry.hidden = columns.hidden;
    entry.label = std::move(columns.label);
    EntryKind kind = EntryKind::stroke;
    if (const auto action = j.find("action"); action != j.end()) {
        if (!action->is_string()) throw Error("the action of a journal's entry cannot be read");
        kind = entry_kind_of(action->get<std::string>());
    }
    entry.content = content_of(columns, kind, j);
    entry.group = group_of(j);
    return entry;
}

}  // namespace tuft::stroke
