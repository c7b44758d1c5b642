#include "stroke/journal/journal.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "core/text/nesting.h"
#include "core/text/text.h"
#include "ink/exchange/reservoir.h"
#include "stroke/journal/entry_json.h"

namespace tuft::stroke {

namespace {

constexpr double kLongestString = 1.0;  // metres
constexpr double kStrongestFilter = 100;
constexpr double kLongestWait = 86400;     // seconds
constexpr double kLongestStroke = 1e8;     // seconds; clocks of devices that count from their start are kept
constexpr double kLongestDirection = 1e6;  // of a vector that shall be normalised; the least is its inverse
constexpr double kMostPressure = 10;       // of the working depth
constexpr double kMostTilt = 1.6;          // radians: a holder lies flat
constexpr std::uint64_t kMostGroupId = std::uint64_t{1} << 62;  // ids in files are signed
constexpr const char* kActions[] = {"stroke", "dip",  "rinse", "reshape", "dry",
                                    "layer",  "mask", "fill",  "wipe",    "wash"};

nlohmann::json json_of(const Settings& s) {
    nlohmann::json j = {{"spine", s.spine},
                        {"footprint", s.footprint},
                        {"contact", s.contact},
                        {"spacing", s.spacing},
                        {"lead", s.compensate_tip_lag},
                        {"dip", s.dip},
                        {"pressure", s.pressure},
                        {"smooth", s.smooth},
                        {"stabilise", s.stabilise},
                        {"film", s.film},
                        {"down", {s.down.x, s.down.y, s.down.z}}};
    if (s.endless) j["endless"] = true;  // left out by default: entries stay as older versions wrote them
    return j;
}

nlohmann::json parsed(const std::string& text) {
    check_json_nesting(text, "the settings of a stroke");
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception&) {
        throw Error("the settings of a stroke cannot be read: " + excerpt(text, 80));
    }
}

Settings settings_of(const nlohmann::json& j) {
    Settings s;
    try {
        s.spine = j.value("spine", s.spine);
        s.footprint = j.value("footprint", s.footprint);
        s.contact = j.value("contact", s.contact);
        s.spacing = j.value("spacing", s.spacing);
        s.compensate_tip_lag = j.value("lead", s.compensate_tip_lag);
        s.dip = j.value("dip", s.dip);
        s.endless = j.value("endless", s.endless);
        s.pressure = j.value("pressure", s.pressure);
        s.smooth = j.value("smooth", s.smooth);
        s.stabilise = j.value("stabilise", s.stabilise);
        s.film = j.value("film", s.film);
        const auto down = j.value("down", std::vector<double>{s.down.x, s.down.y, s.down.z});
        if (down.size() != 3) throw Error("the direction of weight of a stroke is no three numbers");
        s.down = {down[0], down[1], down[2]};
    } catch (const nlohmann::json::exception&) {
        throw Error("the settings of a stroke cannot be read: " + excerpt(j.dump(), 80));
    }
    check_settings(s);
    return s;
}

bool among(const std::string& word, std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::vector<StencilEdge> tape_of(const nlohmann::json& j) {
    const auto is_number = [](const nlohmann::json& x) { return x.is_number() && std::isfinite(x.get<double>()); };
    if (!j.is_array() || j.size() % 4 != 0 || j.size() > 4 * kMaxStencilEdges ||
        !std::all_of(j.begin(), j.end(), is_number))
        throw Error("the stencil of a journal's entry cannot be read");
    std::vector<StencilEdge> tape;
    for (std::size_t i = 0; i < j.size(); i += 4)
        tape.push_back(
            {{j[i].get<double>(), j[i + 1].get<double>()}, {j[i + 2].get<double>(), j[i + 3].get<double>()}});
    return tape;
}

EntryGroup group_of(const nlohmann::json& j) {
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

}  // namespace

void check_settings(const Settings& s) {
    if (!(s.spacing > 0 && s.spacing < 1000)) throw Error("spacing is out of range");
    if (!among(s.dip, {"each", "carry"})) throw Error("dip is 'each' or 'carry', not '" + s.dip + "'");
    if (!among(s.pressure, {"none", "speed", "dwell", "speed+dwell"}))
        throw Error("pressure is 'none', 'speed', 'dwell' or 'speed+dwell', not '" + s.pressure + "'");
    if (!among(s.film, {"still", "wet"})) throw Error("film is 'still' or 'wet', not '" + s.film + "'");
    if (!(glm::length(s.down) < 1e9)) throw Error("the direction of weight is no direction");
    if (!(s.smooth >= 0 && s.smooth <= kStrongestFilter)) throw Error("smooth is out of range");
    if (!(s.stabilise >= 0 && s.stabilise <= kLongestString)) throw Error("stabilise is out of range");
}

void check_trace(const Trace& trace) {
    const auto refuse = [](const char* what) { throw Error(std::string(what) + " is no number, or out of range"); };
    const auto is_direction = [](const Vec3& v) {
        return within(v, kLongestDirection) && glm::length(v) > 1 / kLongestDirection;
    };
    const Placement& p = trace.placement;
    if (!within(p.origin)) refuse("the place of a drawing");
    if (trace.flat && !(is_direction(p.right) && is_direction(p.down))) refuse("the direction of a drawing");
    for (const TraceSample& s : trace.samples) {
        if (!within(s.position)) refuse("a sample's place");
        if (!(std::abs(s.time) <= kLongestStroke)) refuse("a sample's time");
        if (!(std::abs(s.pressure) <= kMostPressure)) refuse("a sample's pressure");
        if (!within(s.tilt, kMostTilt)) refuse("a sample's tilt");
        const double square = glm::dot(s.rotation, s.rotation);
        if (!(square > 1e-6 && square < 1e6)) refuse("a sample's rotation");
    }
    for (const StencilEdge& e : trace.stencil)
        if (!within(e.from) || !within(e.to)) refuse("an edge of a stencil");
}

void check_seconds(double seconds) {
    if (!(seconds >= 0 && seconds <= kLongestWait))
        throw Error("ink dries for 0 to " + std::to_string(static_cast<int>(kLongestWait)) + " seconds");
}

std::string to_json(const Settings& s) {
    return json_of(s).dump();
}
Settings settings_from_json(const std::string& json) {
    return settings_of(parsed(json));
}

std::string entry_json(const Stroke& entry) {
    nlohmann::json j = json_of(entry.settings);
    if (entry.action != Action::stroke) j["action"] = name_of(entry.action);
    if (entry.action == Action::dry) j["seconds"] = entry.seconds;
    if (entry.action == Action::layer) j["edit"] = json_of(entry.edit);
    if (entry.layer == kPaletteLayer)
        j["on"] = "palette";
    else if (entry.layer != kFirstLayer)
        j["layer"] = entry.layer;
    if (entry.action == Action::mask) j["mask_edit"] = json_of(entry.mask_edit);
    if (entry.mask != 0) j["mask"] = entry.mask;
    if (entry.action == Action::fill) j["fill"] = json_of(entry.fill);
    if (entry.trace.erases) j["tool"] = "eraser";
    if (!entry.trace.stencil.empty()) {
        nlohmann::json& tape = j["tape"] = nlohmann::json::array();
        for (const StencilEdge& e : entry.trace.stencil)
            for (const double x : {e.from.x, e.from.y, e.to.x, e.to.y}) tape.push_back(x);
    }
    if (entry.extent != Extent{}) {
        j["depth"] = entry.extent.depth;
        j["amount"] = entry.extent.amount;
        if (entry.extent.side != 0) j["side"] = entry.extent.side;
    }
    if (entry.group.id != 0) {
        j["group"] = entry.group.id;
        j["group_name"] = entry.group.name;
    }
    return j.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void read_entry_json(const std::string& json, Stroke& entry) {
    const nlohmann::json j = parsed(json);
    entry.settings = settings_of(j);
    entry.action = Action::stroke;
    const auto id = [&j](const char* key, std::uint32_t otherwise) {
        const auto value = j.find(key);
        if (value == j.end()) return otherwise;
        if (!value->is_number_unsigned() || value->get<std::uint64_t>() >= kPaletteLayer)
            throw Error(std::string("the ") + key + " of a journal's entry cannot be read");
        return value->get<std::uint32_t>();
    };
    entry.layer = id("layer", entry.layer);
    entry.mask = id("mask", entry.mask);
    if (const auto on = j.find("on"); on != j.end()) {
        if (*on != "palette" && *on != "model")
            throw Error("a stroke is on the palette or the model, not on " + excerpt(on->dump(), 40));
        if (*on == "palette") entry.layer = kPaletteLayer;
    }
    entry.trace.erases = false;
    if (const auto tool = j.find("tool"); tool != j.end()) {
        if (*tool != "eraser" && *tool != "brush")
            throw Error("the tool of a stroke is brush or eraser, not " + excerpt(tool->dump(), 40));
        entry.trace.erases = *tool == "eraser";
    }
    entry.trace.stencil.clear();
    if (const auto tape = j.find("tape"); tape != j.end()) entry.trace.stencil = tape_of(*tape);
    entry.group = group_of(j);
    const auto action = j.find("action");
    if (action == j.end()) return;
    if (!action->is_string()) throw Error("the action of a journal's entry cannot be read");
    entry.action = action_of(action->get<std::string>());
    if (entry.action == Action::layer) entry.edit = layer_edit_of(j.value("edit", nlohmann::json::object()));
    if (entry.action == Action::mask) entry.mask_edit = mask_edit_of(j.value("mask_edit", nlohmann::json::object()));
    if (entry.action == Action::fill) entry.fill = fill_of(j.value("fill", nlohmann::json::object()));
    const auto seconds = j.find("seconds");
    if (seconds != j.end() && !seconds->is_number()) throw Error("the seconds of a journal's entry cannot be read");
    entry.seconds = seconds == j.end() ? 0 : seconds->get<double>();
    check_seconds(entry.seconds);
    entry.extent = {};
    try {
        entry.extent = {j.value("depth", 1.0), j.value("amount", 1.0), j.value("side", 0.0)};
    } catch (const nlohmann::json::exception&) {
        throw Error("how far a brush was dipped or wiped cannot be read");
    }
    check_extent(entry.extent, entry.action);
}

std::string name_of(Action action) {
    return kActions[static_cast<int>(action)];
}

Action action_of(const std::string& name) {
    for (const Action a : {Action::stroke, Action::dip, Action::rinse, Action::reshape, Action::dry, Action::layer,
                           Action::mask, Action::fill, Action::wipe, Action::wash})
        if (name == name_of(a)) return a;
    throw Error(
        "'" + excerpt(name) +
        "' is no action of a brush; there are stroke, dip, rinse, reshape, dry, layer, mask, fill, wipe and wash");
}

void check_extent(const Extent& e, Action action) {
    if (!(e.depth >= 0 && e.depth <= 1)) throw Error("the depth of a dip or wipe is a part of the tuft, 0 to 1");
    if (!(e.amount >= 0 && e.amount <= (action == Action::dip ? ink::kMostLevel : 1.0)))
        throw Error("the amount of a wipe is 0 to 1, of a dip 0 to 1.5, above 1 dripping wet");
    if (!(std::abs(e.side) <= 1)) throw Error("the side of a dip or wipe is a part of the tuft's width, -1 to 1");
}

std::string action_text(const BrushAction& care) {
    std::string text = name_of(care.action);
    if (!care.ink.empty()) text += ":" + care.ink;
    const auto add = [&](const char* name, double value, double usual) {
        if (value == usual) return;
        char number[40];
        *std::to_chars(number, number + sizeof number - 1, value).ptr = 0;
        text += std::string(",") + name + "=" + number;
    };
    add("depth", care.extent.depth, 1);
    add("amount", care.extent.amount, 1);
    add("side", care.extent.side, 0);
    return text;
}

BrushAction action_of_text(const std::string& text) {
    BrushAction care;
    std::size_t end = std::min(text.find(','), text.size());
    const std::string head = text.substr(0, end);
    const std::size_t colon = std::min(head.find(':'), head.size());
    care.action = action_of(head.substr(0, colon));
    if (care.action == Action::stroke) throw Error("'" + text + "' is no care of a brush");
    if (colon < head.size()) care.ink = head.substr(colon + 1);
    if (!care.ink.empty() && care.action != Action::dip) throw Error("'" + text + "': only a dip names an ink");
    while (end < text.size()) {
        const std::size_t next = std::min(text.find(',', end + 1), text.size());
        const std::string part = text.substr(end + 1, next - end - 1);
        const std::size_t equal = part.find('=');
        const std::string name = part.substr(0, std::min(equal, part.size()));
        double* value = name == "depth"    ? &care.extent.depth
                        : name == "amount" ? &care.extent.amount
                        : name == "side"   ? &care.extent.side
                                           : nullptr;
        if (!value || equal == std::string::npos || (care.action != Action::dip && care.action != Action::wipe))
            throw Error("'" + part + "' in '" + text +
                        "' is none of depth=PART, amount=PART and side=PART of a dip or wipe");
        const char* last = part.data() + part.size();
        const auto [rest, error] = std::from_chars(part.data() + equal + 1, last, *value);
        if (error != std::errc{} || rest != last) throw Error("'" + part + "' in '" + text + "' is no number");
        end = next;
    }
    check_extent(care.extent, care.action);
    return care;
}

bool has_brush(Action action) {
    return action != Action::dry && action != Action::fill && action != Action::wash && !keeps_texels(action);
}

bool keeps_texels(Action action) {
    return action == Action::layer || action == Action::mask;
}

std::vector<std::string> inks_of(const Stroke& entry) {
    std::vector<std::string> inks;
    const bool none =
        entry.action == Action::dry || entry.action == Action::wash || keeps_texels(entry.action) || entry.trace.erases;
    if (!none && !entry.trace.ink.empty()) inks.push_back(entry.trace.ink);
    if (entry.action == Action::fill && !entry.fill.to_ink.empty()) inks.push_back(entry.fill.to_ink);
    return inks;
}

Stroke action_after(const std::vector<Stroke>& entries, Action action) {
    Stroke entry;
    for (const Stroke& s : entries) entry.id = std::max(entry.id, s.id);
    ++entry.id;
    entry.action = action;
    entry.trace.flat = false;
    return entry;
}

std::string group_name(const std::filesystem::path& file) {
    std::string name = file.filename().string();
    const auto readable = [](const std::string& text) {
        try {
            check_name(text, "group");
            return true;
        } catch (const Error&) {
            return false;
        }
    };
    if (name.size() > kMaxNameBytes) {
        name.resize(kMaxNameBytes);
        for (int i = 0; i < 4 && !readable(name); ++i) name.pop_back();  // the rest of a character
    }
    if (readable(name)) return name;
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    return name.empty() ? "?" : name;
}

std::uint64_t Journal::next_group_id() const {
    std::set<std::uint64_t> used;
    for (const std::vector<Stroke>* entries : {&strokes_, &undone_})
        for (const Stroke& s : *entries) used.insert(s.group.id);
    std::uint64_t id = next_id_;
    while (used.contains(id)) ++id;
    return id;
}

const Stroke& Journal::append(Stroke stroke) {
    stroke.id = next_id_++;
    undone_.clear();
    strokes_.push_back(std::move(stroke));
    return strokes_.back();
}

void Journal::restore(Stroke stroke) {
    next_id_ = std::max(next_id_, stroke.id + 1);
    strokes_.push_back(std::move(stroke));
}

bool Journal::undo() {
    if (strokes_.empty()) return false;
    undone_.push_back(std::move(strokes_.back()));
    strokes_.pop_back();
    return true;
}

bool Journal::redo() {
    if (undone_.empty()) return false;
    strokes_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    return true;
}

}  // namespace tuft::stroke
