#include "stroke/journal/entry/settings.h"

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/error.h"
#include "core/text/nesting.h"
#include "core/text/text.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/entry/samples.h"

namespace tuft::stroke {
namespace {

constexpr double kLongestString = 1.0;  // metres
constexpr double kStrongestFilter = 100;

// In the order of the enumerators.
constexpr const char* kFootprints[] = {"surface", "plane"};
constexpr const char* kContacts[] = {"exact", "vertices"};
constexpr const char* kDips[] = {"each", "persistent"};
constexpr const char* kPressures[] = {"none", "speed", "dwell", "speed+dwell"};
constexpr const char* kFilms[] = {"still", "wet"};

template <std::size_t N, class Enum>
std::string word(const char* const (&words)[N], Enum value) {
    return words[static_cast<std::size_t>(value)];
}

template <class Enum, std::size_t N>
Enum enumerator(const char* const (&words)[N], const std::string& name, const char* what) {
    std::string all;
    for (std::size_t i = 0; i < N; ++i) {
        if (name == words[i]) return static_cast<Enum>(i);
        all += std::string(i == 0 ? "'" : i + 1 == N ? " or '" : ", '") + words[i] + "'";
    }
    throw Error(Message("{} is {}, not '{}'", what, all, excerpt(name)));
}

}  // namespace

std::string name_of(DipMode dip) {
    return word(kDips, dip);
}
std::string name_of(PressureFrom from) {
    return word(kPressures, from);
}
std::string name_of(FilmModel film) {
    return word(kFilms, film);
}
DipMode dip_mode_of(const std::string& name) {
    return name == "carry" ? DipMode::persistent : enumerator<DipMode>(kDips, name, "dip");
}
PressureFrom pressure_from(const std::string& name) {
    return enumerator<PressureFrom>(kPressures, name, "pressure");
}
FilmModel film_model_of(const std::string& name) {
    return enumerator<FilmModel>(kFilms, name, "film");
}
brush::SpineMethod spine_method_of(const std::string& name) {
    return enumerator<brush::SpineMethod>(brush::kSpineWords, name, "spine");
}
footprint::Mapping footprint_mapping_of(const std::string& name) {
    return enumerator<footprint::Mapping>(kFootprints, name, "footprint");
}
contact::Method contact_method_of(const std::string& name) {
    return enumerator<contact::Method>(kContacts, name, "contact");
}

nlohmann::json json_of(const StrokeSettings& s) {
    nlohmann::json j = {{"spine", word(brush::kSpineWords, s.spine)},
                        {"footprint", word(kFootprints, s.footprint)},
                        {"contact", word(kContacts, s.contact)},
                        {"spacing", s.spacing},
                        {"lead", s.compensate_tip_lag},
                        {"dip", name_of(s.dip)},
                        {"pressure", name_of(s.pressure)},
                        {"smooth", s.smooth},
                        {"stabilise", s.stabilise},
                        {"film", name_of(s.film)},
                        {"down", {s.down.x, s.down.y, s.down.z}}};
    if (s.endless) j["endless"] = true;  // left out by default: entries stay as older versions wrote them
    if (s.roll != 0) j["roll"] = s.roll;
    if (s.roll_follow) j["roll_follow"] = true;
    return j;
}

StrokeSettings settings_of(const nlohmann::json& j) {
    StrokeSettings s;
    try {
        const auto read = [&j](const char* key, auto& value, const auto& of_name) {
            if (const auto at = j.find(key); at != j.end()) value = of_name(at->template get<std::string>());
        };
        read("spine", s.spine, spine_method_of);
        read("footprint", s.footprint, footprint_mapping_of);
        read("contact", s.contact, contact_method_of);
        s.spacing = j.value("spacing", s.spacing);
        s.compensate_tip_lag = j.value("lead", s.compensate_tip_lag);
        read("dip", s.dip, dip_mode_of);
        s.endless = j.value("endless", s.endless);
        read("pressure", s.pressure, pressure_from);
        s.smooth = j.value("smooth", s.smooth);
        s.stabilise = j.value("stabilise", s.stabilise);
        s.roll = j.value("roll", s.roll);
        s.roll_follow = j.value("roll_follow", s.roll_follow);
        read("film", s.film, film_model_of);
        const auto down = j.value("down", std::vector<double>{s.down.x, s.down.y, s.down.z});
        if (down.size() != 3) throw Error("the direction of weight of a stroke is no three numbers");
        s.down = {down[0], down[1], down[2]};
    } catch (const nlohmann::json::exception&) {
        throw Error(Message("the settings of a stroke cannot be read: {}", excerpt(j.dump(), 80)));
    }
    check_settings(s);
    return s;
}

void check_settings(const StrokeSettings& s) {
    if (!(s.spacing > 0 && s.spacing < 1000)) throw Error("spacing is out of range");
    if (!(glm::length(s.down) < 1e9)) throw Error("the direction of weight is no direction");
    if (!(s.smooth >= 0 && s.smooth <= kStrongestFilter)) throw Error("smooth is out of range");
    if (!(s.stabilise >= 0 && s.stabilise <= kLongestString)) throw Error("stabilise is out of range");
    if (!(std::abs(s.roll) <= kMostRoll)) throw Error("roll is out of range");
}

std::string to_json(const StrokeSettings& s) {
    return json_of(s).dump();
}

StrokeSettings settings_from_json(const std::string& text) {
    check_json_nesting(text, "the settings of a stroke");
    try {
        return settings_of(nlohmann::json::parse(text));
    } catch (const nlohmann::json::exception&) {
        throw Error(Message("the settings of a stroke cannot be read: {}", excerpt(text, 80)));
    }
}

}  // namespace tuft::stroke
