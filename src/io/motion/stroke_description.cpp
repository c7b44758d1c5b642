#include "io/motion/stroke_description.h"

#include <nlohmann/json.hpp>

namespace tuft::io {

using nlohmann::json;

json stroke_json(const stroke::RecordedStroke& s) {
    json j{{"brush", s.brush},   {"ink", s.ink},           {"seed", s.seed},       {"label", s.label},
           {"erases", s.erases}, {"layer", s.names.layer}, {"mask", s.names.mask}, {"before", json::array()}};
    for (const stroke::Preparation& p : s.before)
        if (!std::holds_alternative<stroke::Fill>(p)) j["before"].push_back(stroke::preparation_text(p));
    if (s.settings) j["settings"] = json::parse(stroke::to_json(*s.settings));
    return j;
}

stroke::RecordedStroke stroke_of(const json& j) {
    stroke::RecordedStroke s;
    s.flat = false;
    s.brush = j.at("brush").get<std::string>();
    s.ink = j.at("ink").get<std::string>();
    s.seed = j.at("seed").get<std::uint64_t>();
    s.label = j.at("label").get<std::string>();
    s.erases = j.at("erases").get<bool>();
    s.names.layer = j.at("layer").get<std::string>();
    s.names.mask = j.at("mask").get<std::string>();
    for (const json& text : j.at("before")) s.before.push_back(stroke::preparation_of(text.get<std::string>()));
    if (j.contains("settings")) s.settings = stroke::settings_from_json(j["settings"].dump());
    return s;
}

}  // namespace tuft::io
