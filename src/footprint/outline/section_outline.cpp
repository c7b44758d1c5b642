#include "footprint/outline/section_outline.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "atlas/texels/log_map.h"
#include "core/geometry/segment.h"
#include "core/noise.h"
#include "core/random.h"

namespace tuft::footprint {
namespace {

constexpr double kRim = 0.6;          // of a pore's radius, that of its round rim
constexpr double kDryOpens = 0.8;     // by which a pore of dry foam, which has ink on its ridges only, is wider
constexpr double kSpanned = 0.3;      // films of ink that stand in from a pore's rim
constexpr int kMostPoints = 400;      // contact points of a shape
constexpr int kRound = 6;             // points of half a stadium's end
constexpr double kChanging = 0.25;    // part of a hair's need that changes along the stroke
constexpr double kRollLength = 6e-3;  // m of travel over which it does

/// Coordinates (u, v) of a point of the shape, from its foot on the surface. Foam that is pressed lies on it.
Vec2 place_of(const brush::CarriedShape& carried, const brush::TuftShape& shape, std::uint32_t i, const Frame& frame) {
    const Vec3& n = shape.normal[i];
    const bool held = carried.height > 0 && shape.height[i] < 0;
    const Vec3 foot = shape.position[i] - (held ? 0 : shape.height[i]) * n;
    if (glm::dot(n, frame.n) > atlas::kLogMapMinCos) return atlas::log_map(frame, foot, n);
    return Vec2(frame.to_local(foot));
}

/// Places of the points that are looked at, each computed once.
class Places {
  public:
    Places(const brush::CarriedShape& carried, const brush::TuftShape& shape, const Frame& frame)
        : carried_(carried),
          shape_(shape),
          frame_(frame),
          known_(shape.position.size(), 0),
          place_(shape.position.size()) {}
    const Vec2& operator[](std::uint32_t i) {
        if (!known_[i]) place_[i] = place_of(carried_, shape_, i, frame_), known_[i] = 1;
        return place_[i];
    }

  private:
    const brush::CarriedShape& carried_;
    const brush::TuftShape& shape_;
    const Frame& frame_;
    Recycled<char> known_;
    Recycled<Vec2> place_;
};

double signed_area(const Polygon& polygon) {
    double sum = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec2 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
        sum += p.x * q.y - p.y * q.x;
    }
    return 0.5 * sum;
}

struct Bounds {
    Vec2 lo{1e9}, hi{-1e9};
};

bool contains(const Polygon& polygon, const Vec2& p) {
    bool inside = false;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        if (crosses_ray(polygon[k], polygon[(k + 1) % polygon.size()], p)) inside = !inside;
    }
    return inside;
}

/// A polygon, and how far ink stands out at each of its points, metres.
struct Loop {
    Polygon polygon;
    Recycled<double> film;
};

/// Turns each loop by the number of others that it lies in.
void turn_even_odd(Recycled<Loop>& loops) {
    Recycled<Bounds> bounds(loops.size());
    for (std::size_t k = 0; k < loops.size(); ++k)
        for (const Vec2& p : loops[k].polygon) bounds[k] = {glm::min(bounds[k].lo, p), glm::max(bounds[k].hi, p)};
    for (std::size_t k = 0; k < loops.size(); ++k) {
        const Vec2 p = loops[k].polygon.front();
        bool hole = false;
        for (std::size_t other = 0; other < loops.size(); ++other) {
            const Bounds& b = bounds[other];
            if (other == k || p.x < b.lo.x || p.y < b.lo.y || p.x > b.hi.x || p.y > b.hi.y) continue;
            if (contains(loops[other].polygon, p)) hole = !hole;
        }
        if ((signed_area(loops[k].polygon) < 0) == hole) continue;
        std::reverse(loops[k].polygon.begin(), loops[k].polygon.end());
        std::reverse(loops[k].film.begin(), loops[k].film.end());
    }
}

/// The loop's polygon moved by its film, away from what it encloses or, round a hole, into it.
Polygon widened(const Loop& loop) {
    Polygon out = loop.polygon;
    const std::size_t n = out.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2 run = loop.polygon[(k + 1) % n] - loop.polygon[(k + n - 1) % n];
        const double length = glm::length(run);
        if (length > 1e-12) out[k] += loop.film[k] / length * Vec2{run.y, -run.x};
    }
    return out;
}

/// Name of the edge between two points.
std::uint64_t edge_of(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

}  // namespace

Recycled<Polygon> section_polygons(const brush::CarriedShape& carried, const brush::TuftShape& shape,
                                   const Frame& frame, const ShapeOptions& options) {
    Recycled<Polygon> out;
    if (shape.height.empty()) return out;
    Places places(carried, shape, frame);
    const auto level = [&](std::uint32_t v) {
        return shape.middle.empty() ? options.film : std::min(options.film, shape.middle[v]);
    };
    const auto over = [&](std::uint32_t v) { return shape.height[v] - level(v); };
    const auto below = [&](std::uint32_t v) { return over(v) < 0; };
    struct Crossing {
        Vec2 at{0};
        double film = 0;  // that stands out
        std::uint64_t next = 0;
        bool visited = false;
    };
    std::unordered_map<std::uint64_t, Crossing, std::hash<std::uint64_t>, std::equal_to<>,
                       Recycler<std::pair<const std::uint64_t, Crossing>>>
        crossings;
    Recycled<std::uint64_t> order;  // a loop begins at the first of its crossings in the order of the triangles
    const auto crossing = [&](std::uint32_t a, std::uint32_t b) {
        if (b < a) std::swap(a, b);
        const std::uint64_t name = edge_of(a, b);
        const auto [at, fresh] = crossings.try_emplace(name);
        if (fresh) {
            const double part = over(a) / (over(a) - over(b));
            at->second.at = glm::mix(places[a], places[b], part);
            at->second.film = std::clamp(options.film - std::lerp(level(a), level(b), part), 0.0, options.film);
            order.push_back(name);
        }
        return name;
    };
    for (const auto& t : carried.triangles) {
        const int under = below(t[0]) + below(t[1]) + below(t[2]);
        if (under == 0 || under == 3) continue;
        // Enters where an edge goes down, leaves where one goes up.
        std::uint64_t down = 0, up = 0;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            if (below(a) == below(b)) continue;
            (below(b) ? down : up) = crossing(a, b);
        }
        crossings[up].next = down;
    }
    Recycled<Loop> loops;
    for (const std::uint64_t start : order) {
        Loop loop;
        for (std::uint64_t name = start; !crossings[name].visited; name = crossings[name].next) {
            crossings[name].visited = true;
            loop.polygon.push_back(crossings[name].at);
            loop.film.push_back(crossings[name].film);
        }
        if (loop.polygon.size() >= 3) loops.push_back(std::move(loop));
    }
    turn_even_odd(loops);
    for (const Loop& loop : loops) out.push_back(widened(loop));
    return out;
}

namespace {

/// The points within r of the line from p to q, counter-clockwise.
Polygon stadium(const Vec2& p, const Vec2& q, double r) {
    const Vec2 run = q - p;
    const double length = glm::length(run);
    const Vec2 e = length > 1e-12 ? run / length : Vec2{1, 0}, m{-e.y, e.x};
    Polygon out;
    for (int end = 0; end < 2; ++end)
        for (int k = 0; k <= kRound; ++k) {
            const double w = std::numbers::pi * (static_cast<double>(k) / kRound - 0.5) + end * std::numbers::pi;
            out.push_back((end ? p : q) + r * (std::cos(w) * e + std::sin(w) * m));
        }
    return out;
}

/// Wetness below which a hair does not mark now.
double need_of(std::size_t line, const LineInk& ink) {
    const std::uint64_t own = hash_bits(ink.seed, 7000 + line);
    const double rolls = value_noise(ink.travel / kRollLength + 8 * uniform(own, 1),
                                     [&](std::uint64_t cell) { return uniform(hash_bits(own, 2), cell); });
    return (1 - kChanging) * uniform(own, 0) + kChanging * rolls;
}

}  // namespace

Recycled<Polygon> hair_polygons(const brush::CarriedShape& carried, const brush::TuftShape& shape, const Frame& frame,
                                double width, const LineInk& ink, const ShapeOptions& options) {
    Recycled<Polygon> out;
    if (shape.height.empty()) return out;
    Places places(carried, shape, frame);
    const double reach = options.film + 0.5 * width;
    for (std::size_t l = 0; l < carried.lines.size(); ++l) {
        const std::vector<std::uint32_t>& line = carried.lines[l];
        const std::uint32_t bundle = carried.bundle[line.front()];
        const double wet = bundle < ink.wet.size() ? ink.wet[bundle] : 1;
        if (wet < 1 && wet <= need_of(l, ink)) continue;
        const double half = 0.5 * width + options.film * std::min(1.0, wet);
        for (std::size_t k = 0; k + 1 < line.size(); ++k) {
            const std::uint32_t a = line[k], b = line[k + 1];
            const double p = shape.height[a] - reach, q = shape.height[b] - reach;
            if (p >= 0 && q >= 0) continue;
            Vec2 from = places[a], to = places[b];
            if (p > 0) from = glm::mix(from, to, p / (p - q));
            if (q > 0) to = glm::mix(to, from, q / (q - p));
            out.push_back(stadium(from, to, half));
        }
    }
    return out;
}

Recycled<Polygon> shape_polygons(const brush::Tuft& tuft, const brush::TuftShape& shape, const Frame& frame,
                                 const ShapeOptions& options) {
    return tuft.carried->lines.empty()
               ? section_polygons(*tuft.carried, shape, frame, options)
               : hair_polygons(*tuft.carried, shape, frame, tuft.preset.hair_diameter, {}, options);
}

double open_radius(double rest, double depth, double shut_depth) {
    const double rim = kRim * rest, off = std::max(0.0, 1 - depth / rim);
    return rest * std::sqrt(std::max(0.0, 1 - depth / shut_depth)) + rim * (1 - std::sqrt(1 - off * off));
}

void open_pores(const brush::CarriedShape& carried, const brush::TuftShape& shape, const ShapeOptions& options,
                Footprint& f) {
    if (f.empty() || carried.pores.empty()) return;
    Places places(carried, shape, f.frame);
    const double dry = 1 + kDryOpens * (1 - options.wetness);
    for (const brush::SkinPore& pore : carried.pores) {
        const auto& t = carried.triangles[pore.triangle];
        const double weights[3] = {1 - pore.weights.x - pore.weights.y, pore.weights.x, pore.weights.y};
        double height = 0;
        for (int k = 0; k < 3; ++k) height += weights[k] * shape.height[t[k]];
        if (height > options.film) continue;
        const double r = open_radius(dry * pore.radius, std::max(0.0, -height), carried.shut_strain * carried.height) -
                         kSpanned * options.film * options.wetness;
        if (!(r > 0.25 * f.cell)) continue;
        Vec2 at{0};
        for (int k = 0; k < 3; ++k) at += weights[k] * places[t[k]];
        // In cells, antialiased by distance.
        const Vec2 c = (at - f.lo) / f.cell - 0.5;
        const double radius = r / f.cell;
        const int x0 = std::max(0, static_cast<int>(std::ceil(c.x - radius - 0.5))),
                  x1 = std::min(f.width - 1, static_cast<int>(std::floor(c.x + radius + 0.5))),
                  y0 = std::max(0, static_cast<int>(std::ceil(c.y - radius - 0.5))),
                  y1 = std::min(f.height - 1, static_cast<int>(std::floor(c.y + radius + 0.5)));
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const double open = std::clamp(radius + 0.5 - glm::length(Vec2(x, y) - c), 0.0, 1.0);
                std::uint8_t& cell = f.coverage[static_cast<std::size_t>(y) * f.width + x];
                cell = static_cast<std::uint8_t>(cell * (1 - open) + 0.5);
            }
    }
}

void clip_footprint(Footprint& f, const Footprint& by) {
    if (f.empty()) return;
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x) {
            const Vec2 at = (f.lo + f.cell * (Vec2(x, y) + 0.5) - by.lo) / std::max(by.cell, 1e-12);
            const int i = static_cast<int>(std::floor(at.x)), j = static_cast<int>(std::floor(at.y));
            const bool inside = !by.empty() && i >= 0 && j >= 0 && i < by.width && j < by.height;
            const unsigned cover = inside ? by.coverage[static_cast<std::size_t>(j) * by.width + i] : 0u;
            std::uint8_t& cell = f.coverage[static_cast<std::size_t>(y) * f.width + x];
            cell = static_cast<std::uint8_t>((cell * cover + 127) / 255);
        }
}

Recycled<HairContactPoint> shape_contact_points(const brush::CarriedShape& carried, const brush::TuftShape& shape,
                                                const Frame& frame, double film) {
    Recycled<HairContactPoint> found;
    if (shape.height.empty()) return found;
    Recycled<std::uint32_t> touching;
    for (std::uint32_t i = 0; i < shape.height.size(); ++i)
        if (shape.height[i] < film && carried.area[i] > 0) touching.push_back(i);
    const std::size_t stride = touching.size() / kMostPoints + 1;
    for (std::size_t k = 0; k < touching.size(); k += stride) {
        const std::uint32_t i = touching[k];
        found.push_back({carried.bundle[i], place_of(carried, shape, i, frame), carried.along[i], carried.area[i]});
    }
    return found;
}

Recycled<float> shape_contact_cells(std::span<const HairContactPoint> points, std::size_t bundles,
                                    std::span<const double> ends) {
    const std::size_t cells = ends.size();
    Recycled<double> sum(bundles * cells, 0);
    double all = 0;
    for (const HairContactPoint& p : points) {
        const std::size_t c =
            std::min<std::size_t>(std::upper_bound(ends.begin(), ends.end(), p.along) - ends.begin(), cells - 1);
        sum[p.bundle * cells + c] += p.length;
        all += p.length;
    }
    for (std::size_t k = 0; k < bundles && !(all > 0); ++k) sum[k * cells + cells - 1] = 1;
    if (!(all > 0)) all = static_cast<double>(bundles);
    Recycled<float> parts(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) parts[i] = static_cast<float>(sum[i] / all);
    return parts;
}

}  // namespace tuft::footprint
