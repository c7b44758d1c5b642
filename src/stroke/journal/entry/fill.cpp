#include "stroke/journal/entry/fill.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/entry/flat_area_json.h"

namespace tuft::stroke {
namespace {

constexpr double kThickest = 1000;  // film units: ten millimetres of ink
constexpr const char* kRegions[] = {"all", "part", "chart", "outline"};
constexpr const char* kGradients[] = {"none", "along", "round"};

template <class Word, std::size_t N>
Word word_of(const std::string& name, const char* const (&words)[N], const char* what) {
    std::string all;
    for (std::size_t i = 0; i < N; ++i) {
        if (name == words[i]) return static_cast<Word>(i);
        all += std::string(i ? ", " : "") + words[i];
    }
    throw Error(Message("'{}' is no {}; there are {}", name, what, all));
}

}  // namespace

std::string name_of(Region region) {
    return kRegions[static_cast<int>(region)];
}
std::string name_of(Gradient gradient) {
    return kGradients[static_cast<int>(gradient)];
}
Region region_of(const std::string& name) {
    return word_of<Region>(name, kRegions, "region to fill");
}
Gradient gradient_of(const std::string& name) {
    return word_of<Gradient>(name, kGradients, "gradient");
}

Fill fill_of_area(FlatArea area) {
    Fill fill;
    fill.ink = area.stops.front().ink;
    fill.region = Region::outline;
    fill.area = std::move(area);
    return fill;
}

void check_fill(const Fill& f) {
    if (f.area.has_value() != (f.region == Region::outline)) throw Error("a fill of an outline needs an area");
    if (f.area) check_area(*f.area);
    for (const double film : {f.film, f.to_film})
        if (!(film >= 0 && film <= kThickest)) throw Error("the film of a fill is 0 to 1000 film units");
    for (const Vec3& v : {f.from, f.to, f.at})
        if (!within(v)) throw Error("a point of a fill lies out of range");
    if (f.gradient != Gradient::none && !(glm::length(f.to - f.from) > 1e-9))
        throw Error("a gradient needs two points that lie apart");
}

double along_gradient(const Fill& f, const Vec3& p) {
    const Vec3 run = f.to - f.from;
    const double length = glm::length(run);
    double t = 0;
    if (f.gradient == Gradient::along) t = glm::dot(p - f.from, run) / (length * length);
    if (f.gradient == Gradient::round) t = glm::length(p - f.from) / length;
    return std::clamp(t, 0.0, 1.0);
}

nlohmann::json json_of(const Vec3& v) {
    return {v.x, v.y, v.z};
}

Vec3 vector_of(const nlohmann::json& j) {
    const auto v = j.get<std::array<double, 3>>();
    return {v[0], v[1], v[2]};
}

nlohmann::json json_of(const Fill& f) {
    nlohmann::json j{{"film", f.film}, {"region", name_of(f.region)}};
    if (f.area) {
        j["area"] = json_of(*f.area);
        return j;
    }
    if (f.region != Region::all) j["at"] = json_of(f.at);
    if (f.gradient == Gradient::none) return j;
    j["gradient"] = name_of(f.gradient);
    j["to_film"] = f.to_film;
    j["to_ink"] = f.to_ink;
    j["from"] = json_of(f.from);
    j["to"] = json_of(f.to);
    return j;
}

Fill fill_of(const nlohmann::json& j) {
    Fill f;
    try {
        f.film = j.at("film").get<double>();
        f.region = region_of(j.at("region").get<std::string>());
        if (f.region == Region::outline) {
            f.area = flat_area_of(j.at("area"));
            return f;
        }
        if (f.region != Region::all) f.at = vector_of(j.at("at"));
        f.gradient = gradient_of(j.value("gradient", "none"));
        if (f.gradient != Gradient::none) {
            f.to_film = j.at("to_film").get<double>();
            f.to_ink = j.at("to_ink").get<std::string>();
            f.from = vector_of(j.at("from"));
            f.to = vector_of(j.at("to"));
        }
    } catch (const nlohmann::json::exception&) {
        throw Error(Message("a fill cannot be read: {}", j.dump().substr(0, 80)));
    }
    check_fill(f);
    return f;
}

}  // namespace tuft::stroke
