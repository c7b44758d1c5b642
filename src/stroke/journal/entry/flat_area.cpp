#include "stroke/journal/entry/flat_area.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "core/text/nesting.h"
#include "stroke/journal/entry/flat_area_json.h"

namespace tuft::stroke {
namespace {

using nlohmann::json;

constexpr double kThickestStop = 1000;  // film units
constexpr const char* kSpreads[] = {"pad", "reflect", "repeat"};
constexpr const char* kAreaGradients[] = {"none", "linear", "radial", "image"};
constexpr const char* kAreaEdges[] = {"facing", "cut", "run-over"};

template <class Word, std::size_t N>
Word area_word(const std::string& name, const char* const (&words)[N]) {
    for (std::size_t i = 0; i < N; ++i)
        if (name == words[i]) return static_cast<Word>(i);
    throw Error(Message("'{}' is no word of an area", name));
}

json pair_of(const Vec2& p) {
    return json::array({p.x, p.y});
}
Vec2 pair_in(const json& j) {
    const auto p = j.get<std::array<double, 2>>();
    return {p[0], p[1]};
}
json json_of(const std::vector<std::vector<Vec2>>& paths) {
    json j = json::array();
    for (const auto& path : paths) {
        json& points = j.emplace_back(json::array());
        for (const Vec2& p : path) points.push_back(p.x), points.push_back(p.y);
    }
    return j;
}
std::vector<std::vector<Vec2>> paths_in(const json& j) {
    std::vector<std::vector<Vec2>> paths;
    for (const json& points : j) {
        if (!points.is_array() || points.size() % 2 != 0) throw Error("an area of the journal cannot be read");
        auto& path = paths.emplace_back();
        for (std::size_t i = 0; i < points.size(); i += 2)
            path.emplace_back(points[i].get<double>(), points[i + 1].get<double>());
    }
    return paths;
}
Vec3 triple_in(const json& j) {
    const auto v = j.get<std::array<double, 3>>();
    return {v[0], v[1], v[2]};
}

// The circle of radius t about (1 − t) f through q: (q − f + t f)² = t², the larger root.
double radial_parameter(const Vec2& q, const Vec2& f) {
    const Vec2 d = q - f;
    const double a = 1 - glm::dot(f, f), b = glm::dot(d, f), c = glm::dot(d, d);
    if (!(a > 0)) return glm::length(q);
    return (b + std::sqrt(std::max(0.0, b * b + a * c))) / a;
}

double darkness_at(const AreaImage& image, const Vec2& q) {
    const double x = std::clamp(q.x * image.width - 0.5, 0.0, image.width - 1.0),
                 y = std::clamp(q.y * image.height - 0.5, 0.0, image.height - 1.0);
    const int i = static_cast<int>(x), j = static_cast<int>(y), i1 = std::min(i + 1, image.width - 1),
              j1 = std::min(j + 1, image.height - 1);
    const auto pixel = [&](int column, int row) {
        return double(image.darkness[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                                     static_cast<std::size_t>(column)]);
    };
    const double u = x - i, v = y - j;
    return ((1 - v) * ((1 - u) * pixel(i, j) + u * pixel(i1, j)) + v * ((1 - u) * pixel(i, j1) + u * pixel(i1, j1))) /
           255;
}

// Mean over a square, by as many points as it has pixels across.
double darkness_at(const FlatArea& area, const Vec2& p, double width) {
    constexpr double kMostAcross = 8;
    const auto& a = area.to_unit;
    const double across =
        width * std::max(std::hypot(a[0], a[2]) * area.image.width, std::hypot(a[1], a[3]) * area.image.height);
    const int n = static_cast<int>(std::clamp(std::ceil(across), 1.0, kMostAcross));
    double sum = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec2 s = p + width * (Vec2(i + 0.5, j + 0.5) / double(n) - 0.5);
            sum += darkness_at(area.image, {a[0] * s.x + a[2] * s.y + a[4], a[1] * s.x + a[3] * s.y + a[5]});
        }
    return sum / (n * n);
}

bool is_whole(const AreaImage& image) {
    return image.width > 0 && image.height > 0 && image.width <= kMaxAreaSide && image.height <= kMaxAreaSide &&
           image.darkness.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

std::string hex_text(const std::vector<std::uint8_t>& bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    std::string text;
    text.reserve(2 * bytes.size());
    for (const std::uint8_t b : bytes) text.push_back(kDigits[b >> 4]), text.push_back(kDigits[b & 15]);
    return text;
}
std::vector<std::uint8_t> bytes_of_hex(const std::string& text) {
    std::vector<std::uint8_t> bytes;
    const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1; };
    for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
        const int high = digit(text[i]), low = digit(text[i + 1]);
        if (high < 0 || low < 0) throw Error("the picture of an area cannot be read");
        bytes.push_back(static_cast<std::uint8_t>(16 * high + low));
    }
    return bytes;
}

void check_stop(const AreaStop& stop, double before) {
    if (!(stop.at >= before && stop.at <= 1) || !(stop.opacity >= 0 && stop.opacity <= 1) ||
        !(stop.film <= kThickestStop) || std::isnan(stop.film))
        throw Error("a stop of an area's gradient is out of range");
    if (stop.ink.empty()) throw Error("a stop of an area's gradient has no ink");
}

}  // namespace

void check_area(const FlatArea& area) {
    std::size_t n = 0;
    for (const auto* paths : {&area.rings, &area.lines, &area.under})
        for (const auto& path : *paths) {
            n += path.size();
            for (const Vec2& p : path)
                if (!within(p)) throw Error("a point of an area lies out of range");
        }
    if (n > kMaxAreaPoints) throw Error("an area has too many points");
    if (area.stops.empty() || area.stops.size() > kMaxAreaStops) throw Error("an area has no ink, or too many stops");
    double before = 0;
    for (const AreaStop& stop : area.stops) check_stop(stop, before), before = stop.at;
    for (const Vec2& p : {area.low, area.high, area.reading.centre})
        if (!within(p)) throw Error("the bounds of an area lie out of range");
    for (const double a : area.to_unit)
        if (!std::isfinite(a)) throw Error("the gradient of an area is not finite");
    if (area.gradient == AreaGradient::image && !is_whole(area.image))
        throw Error("the picture of an area has no pixels, or too many");
    if (!(glm::length(area.focus) < 1)) throw Error("the focus of an area's gradient lies outside its circle");
    StrokeSamples placed;
    placed.placement = area.placement;
    check_samples(placed);
}

double along_area(const FlatArea& area, const Vec2& p, double width) {
    if (area.gradient == AreaGradient::none) return 0;
    if (area.gradient == AreaGradient::image) return darkness_at(area, p, width);
    const auto& a = area.to_unit;
    const Vec2 q(a[0] * p.x + a[2] * p.y + a[4], a[1] * p.x + a[3] * p.y + a[5]);
    double t = area.gradient == AreaGradient::linear ? q.x : radial_parameter(q, area.focus);
    if (area.spread == AreaSpread::repeat) t -= std::floor(t);
    if (area.spread == AreaSpread::reflect) t = std::abs(t - 2 * std::round(0.5 * t));
    return std::clamp(t, 0.0, 1.0);
}

void transform_area(FlatArea& area, const Vec2& centre, double scale, bool mirrored) {
    const double sign = mirrored ? -1 : 1;
    const auto move = [&](Vec2& p) {
        p = scale * (p - centre);
        p.x *= sign;
    };
    for (auto* paths : {&area.rings, &area.lines, &area.under})
        for (auto& path : *paths)
            for (Vec2& p : path) move(p);
    move(area.low);
    move(area.high);
    move(area.reading.centre);
    const Vec2 low = glm::min(area.low, area.high), high = glm::max(area.low, area.high);
    area.low = low, area.high = high;
    // q = A (x', y') with x = sign x' / scale + centre.x, y = y' / scale + centre.y.
    auto& a = area.to_unit;
    a[4] += a[0] * centre.x + a[2] * centre.y;
    a[5] += a[1] * centre.x + a[3] * centre.y;
    a[0] *= sign / scale, a[1] *= sign / scale, a[2] /= scale, a[3] /= scale;
}

json json_of(const FlatArea& area) {
    json j;
    j["rings"] = json_of(area.rings);
    if (!area.lines.empty()) j["lines"] = json_of(area.lines);
    if (!area.under.empty()) j["under"] = json_of(area.under);
    if (area.even_odd) j["even_odd"] = true;
    const Placement& place = area.placement;
    const auto triple = [](const Vec3& v) { return json::array({v.x, v.y, v.z}); };
    j["origin"] = triple(place.origin);
    j["right"] = triple(place.right);
    j["down"] = triple(place.down);
    j["mapping"] = surface_mapping_name(place.mapping);
    if (area.edges != AreaEdges::facing) j["edges"] = kAreaEdges[static_cast<int>(area.edges)];
    j["low"] = pair_of(area.low);
    j["high"] = pair_of(area.high);
    if (!area.reading.part.empty())
        j["upright"] = area.reading.part, j["upright_centre"] = pair_of(area.reading.centre);
    json& stops = j["stops"] = json::array();
    for (const AreaStop& s : area.stops)
        stops.push_back({{"at", s.at}, {"ink", s.ink}, {"opacity", s.opacity}, {"film", s.film}});
    if (area.gradient == AreaGradient::none) return j;
    j["gradient"] = kAreaGradients[static_cast<int>(area.gradient)];
    j["spread"] = kSpreads[static_cast<int>(area.spread)];
    j["to_unit"] = area.to_unit;
    j["focus"] = pair_of(area.focus);
    if (area.gradient == AreaGradient::image)
        j["image"] = {
            {"width", area.image.width}, {"height", area.image.height}, {"darkness", hex_text(area.image.darkness)}};
    return j;
}

std::string text_of(const FlatArea& area) {
    return json_of(area).dump(-1, ' ', false, json::error_handler_t::replace);
}

FlatArea area_of_text(const std::string& text) {
    check_json_nesting(text, "an area");
    try {
        return flat_area_of(json::parse(text));
    } catch (const json::exception&) {
        throw Error("an area of a stroke file cannot be read");
    }
}

FlatArea flat_area_of(const json& j) {
    FlatArea area;
    try {
        area.rings = paths_in(j.at("rings"));
        if (j.contains("lines")) area.lines = paths_in(j.at("lines"));
        if (j.contains("under")) area.under = paths_in(j.at("under"));
        area.even_odd = j.value("even_odd", false);
        area.placement.origin = triple_in(j.at("origin"));
        area.placement.right = triple_in(j.at("right"));
        area.placement.down = triple_in(j.at("down"));
        const auto mapping = surface_mapping_named(j.at("mapping").get<std::string>());
        if (!mapping) throw Error("an area of the journal cannot be read");
        area.placement.mapping = *mapping;
        area.placed = true;
        area.edges = area_word<AreaEdges>(j.value("edges", "facing"), kAreaEdges);
        area.low = pair_in(j.at("low"));
        area.high = pair_in(j.at("high"));
        area.reading.part = j.value("upright", "");
        if (!area.reading.part.empty()) area.reading.centre = pair_in(j.at("upright_centre"));
        for (const json& s : j.at("stops"))
            area.stops.push_back({s.at("at").get<double>(), s.at("ink").get<std::string>(),
                                  s.at("opacity").get<double>(), s.at("film").get<double>()});
        area.gradient = area_word<AreaGradient>(j.value("gradient", "none"), kAreaGradients);
        if (area.gradient != AreaGradient::none) {
            if (area.gradient == AreaGradient::image) {
                const json& image = j.at("image");
                area.image = {image.at("width").get<int>(), image.at("height").get<int>(),
                              bytes_of_hex(image.at("darkness").get<std::string>())};
            }
            area.spread = area_word<AreaSpread>(j.at("spread").get<std::string>(), kSpreads);
            area.to_unit = j.at("to_unit").get<std::array<double, 6>>();
            area.focus = pair_in(j.at("focus"));
        }
    } catch (const json::exception&) {
        throw Error("an area of the journal cannot be read");
    }
    check_area(area);
    return area;
}

}  // namespace tuft::stroke
