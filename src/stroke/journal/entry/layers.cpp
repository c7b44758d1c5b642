#include "stroke/journal/entry/layers.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "stroke/journal/entry/entry_json.h"

namespace tuft::stroke {
namespace {

constexpr const char* kChanges[] = {"add", "change", "remove", "duplicate", "merge"};

template <class Table>
auto place_of(Table& table, std::uint32_t id) {
    const auto at = std::find_if(table.layers.begin(), table.layers.end(), [id](const Layer& l) { return l.id == id; });
    if (at == table.layers.end()) throw Error(Message("there is no layer {}", id));
    return at;
}

void check_layer(const LayerTable& table, const Layer& layer) {
    check_name(layer.name, "layer");
    if (!(layer.opacity >= 0 && layer.opacity <= 1)) throw Error("the opacity of a layer is 0 to 1");
    const Layer* same = table.find(layer.name);
    if (same && same->id != layer.id) throw Error(Message("there is a layer '{}' already", title_of(layer)));
}

}  // namespace

namespace {

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

Message message_of(const std::string& name) {
    constexpr std::string_view kCopy = " copy", kLayer = "Layer ";
    if (const std::size_t at = name.rfind(kCopy); at != std::string::npos && at > 0) {
        const std::string number = name.substr(at + kCopy.size());
        if (number.empty() || (number[0] == ' ' && is_number(std::string_view(number).substr(1))))
            return {"{} copy{}", message_of(name.substr(0, at)), number};
    }
    if (name.starts_with(kLayer) && is_number(std::string_view(name).substr(kLayer.size())))
        return {"Layer {}", name.substr(kLayer.size())};
    return name;
}

}  // namespace

Message title_of(const Layer& layer) {
    return message_of(layer.name);
}

void check_name(std::string_view name, const char* of_what) {
    const Message what("the name of a {}", of_what);
    if (name.empty()) throw Error(Message("{} is empty", what));
    if (name.size() > kMaxNameBytes) throw Error(Message("{} is longer than {} bytes", what, kMaxNameBytes));
    int following = 0;  // bytes of a UTF-8 sequence still to come
    for (const char c : name) {
        const auto b = static_cast<unsigned char>(c);
        const bool continues = (b & 0xc0) == 0x80;
        if (continues != (following > 0) || b < 0x20 || b == 0x7f || b > 0xf4)
            throw Error(Message("{} is no readable text", what));
        if (continues)
            --following;
        else
            following = b >= 0xf0 ? 3 : b >= 0xe0 ? 2 : b >= 0xc0 ? 1 : 0;
    }
    if (following > 0) throw Error(Message("{} is no readable text", what));
}

const Layer* LayerTable::find(std::uint32_t id) const {
    const auto at = std::find_if(layers.begin(), layers.end(), [id](const Layer& l) { return l.id == id; });
    return at == layers.end() ? nullptr : &*at;
}

const Layer* LayerTable::find(std::string_view name) const {
    const auto at = std::find_if(layers.begin(), layers.end(), [name](const Layer& l) { return l.name == name; });
    return at == layers.end() ? nullptr : &*at;
}

void apply(LayerTable& table, const LayerEdit& edit) {
    std::vector<Layer>& layers = table.layers;
    if (edit.what == LayerChange::remove || edit.what == LayerChange::merge) {
        const auto at = place_of(table, edit.layer.id);
        if (layers.size() == 1) throw Error("the last layer cannot be removed");
        if (edit.what == LayerChange::merge && place_of(table, edit.other) == at)
            throw Error("a layer cannot be merged into itself");
        layers.erase(at);
        return;
    }
    check_layer(table, edit.layer);
    if (edit.what == LayerChange::add || edit.what == LayerChange::duplicate) {
        if (edit.what == LayerChange::duplicate) place_of(table, edit.other);
        if (layers.size() >= kMaxLayers) throw Error(Message("a painting has at most {} layers", kMaxLayers));
        Layer layer = edit.layer;
        if (layer.id == 0) layer.id = table.next_id;
        if (layer.id < table.next_id || layer.id >= kPaletteLayer)
            throw Error(Message("layer {} cannot be added again", layer.id));
        if (edit.place > layers.size()) throw Error("a layer's place is beyond the highest one");
        table.next_id = layer.id + 1;
        layers.insert(layers.begin() + edit.place, std::move(layer));
        return;
    }
    const auto at = place_of(table, edit.layer.id);
    if (edit.place >= layers.size()) throw Error("a layer's place is beyond the highest one");
    layers.erase(at);
    layers.insert(layers.begin() + edit.place, edit.layer);
}

LayerEdit add_on_top(const LayerTable& table, const std::string& name) {
    return {LayerChange::add, Layer{.id = table.next_id, .name = name},
            static_cast<std::uint32_t>(table.layers.size())};
}

LayerEdit changed(const LayerTable& table, const Layer& layer) {
    const Layer* at = table.find(layer.id);
    if (!at) throw Error(Message("there is no layer {}", layer.id));
    return {LayerChange::change, layer, static_cast<std::uint32_t>(at - table.layers.data())};
}

LayerEdit moved(const LayerTable& table, std::uint32_t id, std::uint32_t place) {
    const Layer* at = table.find(id);
    if (!at) throw Error(Message("there is no layer {}", id));
    return {LayerChange::change, *at, place};
}

LayerEdit removed(std::uint32_t id) {
    return {LayerChange::remove, Layer{.id = id}, 0};
}

LayerEdit duplicated(const LayerTable& table, std::uint32_t id, const std::string& name) {
    LayerEdit edit = changed(table, *place_of(table, id));
    edit.what = LayerChange::duplicate;
    edit.other = id;
    edit.layer.id = table.next_id;
    edit.layer.name = name;
    ++edit.place;
    return edit;
}

LayerEdit merged_down(const LayerTable& table, std::uint32_t id) {
    const Layer& upper = *place_of(table, id);
    if (&upper == table.layers.data())
        throw Error(Message("layer '{}' is the lowest: there is none to merge it into", title_of(upper)));
    const Layer& lower = *(&upper - 1);
    for (const Layer* layer : {&upper, &lower}) {
        if (!layer->visible)
            throw Error(Message("layer '{}' is hidden; show it before layers are merged", title_of(*layer)));
        if (layer->locked)
            throw Error(Message("layer '{}' is locked; unlock it before layers are merged", title_of(*layer)));
        if (layer->opacity < 1)
            throw Error(Message(
                "layer '{}' is faded, which one layer of ink cannot show; give it opacity 1 before layers are merged",
                layer->name));
        if (layer->blend == ink::Blend::multiply)
            throw Error(
                Message("layer '{}' is multiplied, which one layer of ink cannot show; blend it normally before layers "
                        "are merged",
                        layer->name));
    }
    if (upper.blend != lower.blend)
        throw Error(
            Message("layers '{}' and '{}' blend differently; make both normal or both glaze before they are merged",
                    upper.name, lower.name));
    return {LayerChange::merge, Layer{.id = id}, 0, lower.id};
}

std::string free_name(const LayerTable& table, const std::string& base) {
    if (!table.find(std::string_view(base))) return base;
    for (int n = 2;; ++n)
        if (std::string name = base + " " + std::to_string(n); !table.find(std::string_view(name))) return name;
}

nlohmann::json json_of(const LayerEdit& edit) {
    nlohmann::json j{{"what", kChanges[static_cast<int>(edit.what)]}, {"id", edit.layer.id}};
    if (edit.other) j["other"] = edit.other;
    if (edit.what == LayerChange::remove || edit.what == LayerChange::merge) return j;
    if (edit.layer.blend != ink::Blend::normal) j["blend"] = ink::name_of(edit.layer.blend);
    j["name"] = edit.layer.name;
    j["visible"] = edit.layer.visible;
    j["opacity"] = edit.layer.opacity;
    j["locked"] = edit.layer.locked;
    j["place"] = edit.place;
    return j;
}

std::uint32_t number_of(const nlohmann::json& json, const char* name) {
    if (!json.is_number_unsigned() || json.get<std::uint64_t>() >= kNone)
        throw Error(Message("{} is no whole number in range", std::string(name)));
    return static_cast<std::uint32_t>(json.get<std::uint64_t>());
}

LayerEdit layer_edit_of(const nlohmann::json& j) {
    LayerEdit edit;
    try {
        const std::string what = j.at("what").get<std::string>();
        const auto at = std::find(std::begin(kChanges), std::end(kChanges), what);
        if (at == std::end(kChanges)) throw Error(Message("'{}' is no change of a layer", what));
        edit.what = static_cast<LayerChange>(at - std::begin(kChanges));
        const auto whole = [&j](const char* key) {
            return number_of(j.at(key), (std::string("the ") + key + " of a layer").c_str());
        };
        edit.layer.id = whole("id");
        if (edit.what == LayerChange::duplicate || edit.what == LayerChange::merge) edit.other = whole("other");
        if (edit.what == LayerChange::remove || edit.what == LayerChange::merge) return edit;
        const std::string blend = j.value("blend", "normal");
        const std::optional<ink::Blend> known = ink::blend_of(blend);
        if (!known) throw Error(Message("'{}' is no blend of a layer", blend));
        edit.layer.blend = *known;
        edit.layer.name = j.at("name").get<std::string>();
        edit.layer.visible = j.at("visible").get<bool>();
        edit.layer.opacity = j.at("opacity").get<double>();
        edit.layer.locked = j.at("locked").get<bool>();
        edit.place = whole("place");
    } catch (const nlohmann::json::exception&) {
        throw Error(Message("a change of the layers cannot be read: {}", j.dump().substr(0, 80)));
    }
    return edit;
}

}  // namespace tuft::stroke
