#include "io/export/gltf_prune.h"

#include <algorithm>
#include <functional>
#include <map>
#include <string>

#include "io/scene/json_number.h"
#include "io/scene/scene_document.h"

namespace tuft::io {
namespace {

using nlohmann::json;

/// Calls fn with every index that the document holds of the kinds below.
struct IndexVisitor {
    std::function<void(json&)> accessor, view, material, texture, image;

    void visit(json& document) const {
        each(document, "meshes", [&](json& mesh) { each(mesh, "primitives", [&](json& p) { primitive(p); }); });
        each(document, "animations", [&](json& animation) {
            each(animation, "samplers", [&](json& s) { index(s, "input", accessor), index(s, "output", accessor); });
        });
        each(document, "skins", [&](json& skin) { index(skin, "inverseBindMatrices", accessor); });
        each(document, "accessors", [&](json& a) {
            index(a, "bufferView", view);
            if (!a.contains("sparse")) return;
            for (const char* key : {"indices", "values"})
                if (a["sparse"].contains(key)) index(a["sparse"][key], "bufferView", view);
        });
        each(document, "images", [&](json& i) { index(i, "bufferView", view); });
        each(document, "materials", [&](json& m) { textures_of(m); });
        each(document, "textures", [&](json& t) {
            index(t, "source", image);
            extensions_of(t, [&](json& e) { index(e, "source", image); });
        });
    }

  private:
    static void each(json& of, const char* key, const std::function<void(json&)>& fn) {
        const auto found = of.is_object() ? of.find(key) : of.end();
        if (found == of.end() || !found->is_array()) return;
        for (json& item : *found)
            if (item.is_object()) fn(item);
    }
    static void index(json& of, const char* key, const std::function<void(json&)>& fn) {
        const auto found = of.is_object() ? of.find(key) : of.end();
        if (found != of.end() && found->is_number_integer() && found->get<std::int64_t>() >= 0) fn(*found);
    }
    static void extensions_of(json& of, const std::function<void(json&)>& fn) {
        const auto found = of.find("extensions");
        if (found == of.end() || !found->is_object()) return;
        for (auto& [key, value] : found->items()) fn(value);
    }
    void attributes_of(json& attributes) const {
        if (attributes.is_object())
            for (auto& [key, value] : attributes.items()) index(attributes, key.c_str(), accessor);
    }
    void primitive(json& p) const {
        if (p.contains("attributes")) attributes_of(p["attributes"]);
        index(p, "indices", accessor);
        index(p, "material", material);
        if (p.contains("targets") && p["targets"].is_array())
            for (json& target : p["targets"]) attributes_of(target);
        extensions_of(p, [&](json& e) {
            index(e, "bufferView", view);
            each(e, "mappings", [&](json& mapping) { index(mapping, "material", material); });
        });
    }
    /// Texture infos are the objects under keys that end so, also those of extensions.
    void textures_of(json& in) const {
        for (auto& [key, value] : in.items()) {
            if (!value.is_object()) continue;
            if (key.ends_with("Texture")) index(value, "index", texture);
            textures_of(value);
        }
    }
};

/// Whether all references of the document's extensions are known to the visitor.
bool knows_extensions(const json& document) {
    const auto used = document.find("extensionsUsed");
    if (used == document.end() || !used->is_array()) return true;
    return std::all_of(used->begin(), used->end(), [](const json& name) {
        if (!name.is_string()) return false;
        const auto& text = name.get_ref<const std::string&>();
        if (text.starts_with("KHR_materials_")) return true;
        for (const char* known :
             {"KHR_texture_transform", "KHR_mesh_quantization", "KHR_lights_punctual", "KHR_texture_basisu",
              "EXT_texture_webp", "KHR_draco_mesh_compression", "KHR_xmp_json_ld", "KHR_node_visibility"})
            if (text == known) return true;
        return false;
    });
}

/// New indices of the items of an array from which those `gone` are taken out.
std::map<std::size_t, std::size_t> take_out(json& document, const char* key, const std::set<std::size_t>& before,
                                            const std::set<std::size_t>& after) {
    std::map<std::size_t, std::size_t> index;
    const auto found = document.find(key);
    if (found == document.end() || !found->is_array()) return index;
    json kept = json::array();
    for (std::size_t i = 0; i < found->size(); ++i) {
        if (before.contains(i) && !after.contains(i)) continue;
        index[i] = kept.size();
        kept.push_back(std::move((*found)[i]));
    }
    if (kept.empty())
        document.erase(key);
    else
        *found = std::move(kept);
    return index;
}

}  // namespace

References references_in(const json& document) {
    References used;
    const auto into = [](std::set<std::size_t>& all) {
        return [&all](json& index) { all.insert(index.get<std::size_t>()); };
    };
    json copy = document;
    const IndexVisitor all{into(used.accessors), into(used.views), into(used.materials), into(used.textures),
                           into(used.images)};
    all.visit(copy);
    return used;
}

void prune(json& document, const References& before) {
    if (!knows_extensions(document)) return;
    const auto nothing = [](json&) {};
    const auto turned = [](const std::map<std::size_t, std::size_t>& index) {
        return [&index](json& value) {
            if (const auto it = index.find(value.get<std::size_t>()); it != index.end()) value = it->second;
        };
    };
    // What one kind leaves out, the next one is no longer asked for by.
    const auto materials = take_out(document, "materials", before.materials, references_in(document).materials);
    IndexVisitor{nothing, nothing, turned(materials), nothing, nothing}.visit(document);
    const auto textures = take_out(document, "textures", before.textures, references_in(document).textures);
    IndexVisitor{nothing, nothing, nothing, turned(textures), nothing}.visit(document);
    const auto images = take_out(document, "images", before.images, references_in(document).images);
    IndexVisitor{nothing, nothing, nothing, nothing, turned(images)}.visit(document);
    const auto accessors = take_out(document, "accessors", before.accessors, references_in(document).accessors);
    IndexVisitor{turned(accessors), nothing, nothing, nothing, nothing}.visit(document);
    const auto views = take_out(document, "bufferViews", before.views, references_in(document).views);
    IndexVisitor{nothing, turned(views), nothing, nothing, nothing}.visit(document);
}

void drop_morphs(json& document, std::size_t node) {
    const auto animations = document.find("animations");
    if (animations == document.end() || !animations->is_array()) return;
    json kept = json::array();
    for (json& animation : *animations) {
        json channels = json::array();
        for (json& channel : animation["channels"]) {
            const json target = channel.value("target", json::object());
            if (target.value("path", "") == "weights" && target.contains("node") && target["node"] == node) continue;
            channels.push_back(std::move(channel));
        }
        if (channels.empty()) continue;
        animation["channels"] = std::move(channels);
        kept.push_back(std::move(animation));
    }
    if (kept.empty())
        document.erase("animations");
    else
        *animations = std::move(kept);
}

std::vector<unsigned char> take_views(json& document, const std::vector<unsigned char>& source,
                                      const std::vector<unsigned char>& added) {
    std::vector<unsigned char> whole;
    const std::size_t second = aligned(source.size()), end = second + added.size();
    const auto found = document.find("bufferViews");
    std::size_t needed = 0;
    bool plain = found != document.end() && found->is_array();
    if (plain)
        for (const json& view : *found) {
            const std::size_t at = whole_number(view, "byteOffset", std::size_t{0}),
                              size = whole_number<std::size_t>(view.at("byteLength"));
            const bool inside = at <= end && size <= end - at && (at >= second || at + size <= source.size());
            plain = plain && inside && !view.contains("extensions");
            needed += inside ? aligned(size) : 0;
        }
    if (!plain || needed > end + (1u << 20)) {
        whole = source;
        if (!added.empty()) whole.resize(second), whole.insert(whole.end(), added.begin(), added.end());
        return whole;
    }
    whole.reserve(needed);
    for (json& view : *found) {
        const std::size_t at = whole_number(view, "byteOffset", std::size_t{0}),
                          size = whole_number<std::size_t>(view["byteLength"]);
        const unsigned char* from = at >= second ? added.data() + (at - second) : source.data() + at;
        whole.resize(aligned(whole.size()));
        view["byteOffset"] = whole.size();
        whole.insert(whole.end(), from, from + size);
    }
    return whole;
}

}  // namespace tuft::io
