#include "stroke/journal/entry/parts.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/error.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/entry/layers.h"

namespace tuft::stroke {
namespace {

auto place_of(auto& parts, std::string_view name) {
    return std::ranges::lower_bound(parts, name, {}, [](const Part& p) -> std::string_view { return p.name; });
}

PartEdit edit_of(const PartTable& table, const std::vector<std::string>& names, auto&& change) {
    PartEdit edit;
    for (const std::string& name : names) {
        Part part = table.state_of(name);
        change(part);
        edit.parts.push_back(std::move(part));
    }
    return edit;
}

}  // namespace

// A substrate is what its file says.
bool Part::operator==(const Part& other) const {
    if (name != other.name || hidden != other.hidden || locked != other.locked ||
        substrate.has_value() != other.substrate.has_value())
        return false;
    return !substrate || ink::substrate_toml(*substrate) == ink::substrate_toml(*other.substrate);
}

const Part* PartTable::find(std::string_view name) const {
    const auto at = place_of(parts, name);
    return at == parts.end() || at->name != name ? nullptr : &*at;
}

Part PartTable::state_of(const std::string& name) const {
    if (const Part* part = find(name)) return *part;
    Part plain;
    plain.name = name;
    return plain;
}

void apply(PartTable& table, const PartEdit& edit) {
    if (edit.parts.empty()) throw Error("a change of parts needs the name of one");
    std::set<std::string_view> names;
    for (const Part& part : edit.parts) {
        check_name(part.name, "part");
        if (!names.insert(part.name).second) throw Error(Message("part '{}' is named twice", part.name));
    }
    PartTable changed = table;
    for (const Part& part : edit.parts) {
        const auto at = place_of(changed.parts, part.name);
        const bool is_known = at != changed.parts.end() && at->name == part.name;
        if (is_known && part.is_plain())
            changed.parts.erase(at);
        else if (is_known)
            *at = part;
        else if (!part.is_plain())
            changed.parts.insert(at, part);
    }
    if (changed.parts.size() > kMaxParts) throw Error("a painting names at most 100000 parts");
    table = std::move(changed);
}

PartEdit hidden_parts(const PartTable& table, const std::vector<std::string>& names, bool hidden) {
    return edit_of(table, names, [&](Part& part) { part.hidden = hidden; });
}

PartEdit locked_parts(const PartTable& table, const std::vector<std::string>& names, bool locked) {
    return edit_of(table, names, [&](Part& part) { part.locked = locked; });
}

PartEdit parts_of_substrate(const PartTable& table, const std::vector<std::string>& names,
                            const std::optional<ink::Substrate>& substrate) {
    return edit_of(table, names, [&](Part& part) { part.substrate = substrate; });
}

PartEdit isolated_parts(const PartTable& table, const std::vector<std::string>& all,
                        const std::vector<std::string>& names) {
    const std::set<std::string> shown(names.begin(), names.end());
    return edit_of(table, all, [&](Part& part) { part.hidden = !shown.contains(part.name); });
}

bool have_same_substrates(const PartTable& a, const PartTable& b) {
    const auto only = [](const PartTable& table) {
        PartTable of_substrates;
        for (Part part : table.parts) {
            part.hidden = part.locked = false;
            if (part.substrate) of_substrates.parts.push_back(std::move(part));
        }
        return of_substrates;
    };
    return only(a) == only(b);
}

PartEdit changes_only(const PartTable& table, PartEdit edit) {
    std::erase_if(edit.parts, [&](const Part& part) { return part == table.state_of(part.name); });
    return edit;
}

nlohmann::json json_of(const PartEdit& edit) {
    nlohmann::json parts = nlohmann::json::array();
    for (const Part& part : edit.parts) {
        nlohmann::json j{{"name", part.name}};
        if (part.hidden) j["hidden"] = true;
        if (part.locked) j["locked"] = true;
        if (part.substrate) j["substrate"] = ink::substrate_toml(*part.substrate);
        parts.push_back(std::move(j));
    }
    return {{"parts", std::move(parts)}};
}

PartEdit part_edit_of(const nlohmann::json& json) {
    PartEdit edit;
    try {
        for (const nlohmann::json& j : json.at("parts")) {
            Part part;
            part.name = j.at("name").get<std::string>();
            part.hidden = j.value("hidden", false);
            part.locked = j.value("locked", false);
            if (const auto text = j.find("substrate"); text != j.end())
                part.substrate = ink::parse_substrate(text->get<std::string>(), "the substrate of a part");
            edit.parts.push_back(std::move(part));
        }
    } catch (const nlohmann::json::exception&) {
        throw Error(Message("a change of parts cannot be read: {}",
                            json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace).substr(0, 80)));
    }
    return edit;
}

}  // namespace tuft::stroke
