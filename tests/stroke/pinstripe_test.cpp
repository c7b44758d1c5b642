#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/text/units.h"
#include "mesh/read/polygon_soup.h"
#include "paths.h"
#include "stroke/document/document.h"
#include "stroke/drawing/drawing.h"

/// Stripes by a sword: how even they are, measured on the texels.
namespace tuft::stroke {
namespace {

Model shipped(const std::string& name, std::uint32_t size) {
    const std::string file = source_folder() + "/models/" + name;
    ModelOptions options;
    options.unwrap.size = size;
    options.cache = shared_model_cache();  // for the tests that paint on the same model
    return prepare_model(mesh::read_polygon_file(file), options);
}

/// The car's flank: its triangles below y = −100 mm. Its texels are 0.13 mm, of the whole car 0.18 mm, a third of the
/// stripe: there each layout of the charts rounds its width in another way, by up to 4 %.
Model flank_of_car() {
    const mesh::PolygonSoup car = mesh::read_polygon_file(source_folder() + "/models/car.ply");
    mesh::PolygonSoup flank;
    flank.points = car.points;
    flank.polygon_start = {0};
    for (std::size_t i = 0; i < car.n_polygons(); ++i) {
        const std::span corners(car.corners.begin() + car.polygon_start[i],
                                car.corners.begin() + car.polygon_start[i + 1]);
        if (std::ranges::any_of(corners, [&](std::uint32_t c) { return car.points[c].y > -100; })) continue;
        flank.corners.insert(flank.corners.end(), corners.begin(), corners.end());
        flank.polygon_start.push_back(static_cast<std::uint32_t>(flank.corners.size()));
    }
    ModelOptions options;
    options.unwrap.size = 8192;
    return prepare_model(flank, options);
}

constexpr double kSpeed = 0.16;  // m/s
constexpr double kPress = 0.15;
constexpr double kLands = 15e-3;  // m over which it is pressed and lifted

/// A stripe along points 1 mm apart, x to the right and y down, with the blade along it.
PaintStroke stripe(const std::vector<Vec2>& path, const Placement& place) {
    PaintStroke s;
    s.brush = "sword-8";
    s.ink = "titanium-white";
    s.trace.placement = place;
    s.trace.placed = true;
    double along = 0, whole = 0;
    for (std::size_t i = 1; i < path.size(); ++i) whole += glm::distance(path[i], path[i - 1]);
    double roll = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (i > 0) along += glm::distance(path[i], path[i - 1]);
        const Vec2 ahead = path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0];
        const double across = std::atan2(-ahead.y, ahead.x);
        roll = i > 0 ? roll + std::remainder(across - roll, 2 * std::numbers::pi) : across;
        StrokeSample p;
        p.time = along / kSpeed;
        p.position = Vec3(path[i], 0);
        p.pressure = kPress * std::clamp(std::min(along, whole - along) / kLands, 0.0, 1.0);
        p.roll = roll;
        s.trace.samples.push_back(p);
    }
    return s;
}

struct Evenness {
    double mean = 0, deviation = 0, widest = 0, narrowest = 1e9;  // metres, over parts of the path
    double length = 0;                                            // metres
};

/// Width of what is inked of each `part` metres of the stripe: area over length along the surface, as seen along the
/// mean normal there, so that the walls of a shut line do not count. The ends, where the
/// hand presses and lifts, do not count. `along`: place of a point of the model on the stripe, metres, or negative.
/// `gaps`: parts with a shut line, where hair dips into the gap; they count for the widest and the narrowest only.
template <class F>
Evenness measure(const Document& painting, const Model& model, double part, F along,
                 std::vector<std::size_t> gaps = {}) {
    struct Texel {
        std::size_t part;
        double area;
        Vec3 normal;
    };
    std::vector<Texel> texels;
    std::vector<double> area;
    std::vector<Vec3> middle, normal;  // sums weighted by area
    const ink::Canvas& canvas = painting.layers().canvas();
    const auto full = static_cast<float>(0.8 * painting.materials().ink("titanium-white").film);
    for (const std::uint32_t slot : canvas.touched_slots()) {
        const ink::Plane* plane = canvas.plane(slot, 0);
        for (int t = 0; plane && t < atlas::kTileTexels; ++t) {
            const double covered = std::min((*plane)[t] / full, 1.0f);
            const Vec3 p(model.texels.position(slot, t));
            const double place = along(p), own = covered * static_cast<double>(model.texels.tiles[slot].area[t]);
            if (!(own > 0) || place < 0) continue;
            const auto k = static_cast<std::size_t>(place / part);
            if (k >= area.size()) area.resize(k + 1, 0), middle.resize(k + 1, Vec3{0}), normal.resize(k + 1, Vec3{0});
            texels.push_back({k, own, Vec3(model.texels.normal(slot, t))});
            area[k] += own;
            middle[k] += own * p;
            normal[k] += own * texels.back().normal;
        }
    }
    std::size_t first = 0, end = area.size();
    while (first < end && area[first] == 0) ++first;
    for (std::size_t k = 0; k < area.size(); ++k)
        if (area[k] > 0) middle[k] /= area[k];
    std::fill(area.begin(), area.end(), 0.0);
    for (const Texel& t : texels)
        area[t.part] += t.area * std::max(0.0, glm::dot(t.normal, glm::normalize(normal[t.part])));
    Evenness out;
    std::vector<double> width;
    const auto skip = static_cast<std::size_t>(std::ceil(2 * kLands / part));
    for (std::size_t k = first + skip; k + skip < end; ++k) {
        const double length = 0.5 * glm::distance(middle[k - 1], middle[k + 1]);
        const double own = area[k] / length;
        out.length += length;
        out.widest = std::max(out.widest, own);
        out.narrowest = std::min(out.narrowest, own);
        if (std::find(gaps.begin(), gaps.end(), k) != gaps.end()) continue;
        width.push_back(own);
        out.mean += own;
    }
    out.mean /= static_cast<double>(width.size());
    for (const double w : width) out.deviation += (w - out.mean) * (w - out.mean);
    out.deviation = std::sqrt(out.deviation / static_cast<double>(width.size()));
    return out;
}

void record(const Evenness& e) {
    testing::Test::RecordProperty("mean_mm", std::to_string(e.mean / kMillimetre));
    testing::Test::RecordProperty("deviation_percent", std::to_string(100 * e.deviation / e.mean));
    std::printf("mean %.3f mm, sd %.2f %%, widest %.3f, narrowest %.3f, over %.0f mm\n", 1e3 * e.mean,
                100 * e.deviation / e.mean, e.widest / e.mean, e.narrowest / e.mean, 1e3 * e.length);
}

/// Points of a polygon's Catmull-Rom curve, about 1 mm apart.
std::vector<Vec2> curve_through(const std::vector<Vec2>& keys) {
    std::vector<Vec2> out;
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
        const Vec2 p0 = k > 0 ? keys[k - 1] : 2.0 * keys[0] - keys[1], p1 = keys[k], p2 = keys[k + 1];
        const Vec2 p3 = k + 2 < keys.size() ? keys[k + 2] : 2.0 * p2 - p1;
        const int n = std::max(1, static_cast<int>(glm::distance(p1, p2) / 1e-3));
        for (int i = 0; i < n; ++i) {
            const double f = static_cast<double>(i) / n, f2 = f * f, f3 = f2 * f;
            out.push_back(0.5 * (2.0 * p1 + f * (p2 - p0) + f2 * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3) +
                                 f3 * (3.0 * p1 - p0 - 3.0 * p2 + p3)));
        }
    }
    out.push_back(keys.back());
    return out;
}

/// Points along the car's flank, from behind the nose over both arches, in a drawing at a height of 178 mm.
std::vector<Vec2> flank_keys() {
    std::vector<Vec2> keys;
    for (const auto& [x, z] : {std::pair{470, 170},
                               {430, 181},
                               {400, 187},
                               {345, 193},
                               {285, 188},
                               {225, 181},
                               {150, 177},
                               {50, 178},
                               {-50, 180},
                               {-150, 185},
                               {-250, 193},
                               {-345, 200},
                               {-420, 196},
                               {-480, 184},
                               {-530, 168}})
        keys.push_back(kMillimetre * Vec2(x, 178 - z));
    return keys;
}

/// Along the car's flank, from behind the nose over both arches, and 3 mm higher, where the shoulder begins to round.
TEST(Pinstripe, AMetreOverTheCarsFlankIsEven) {
    const Model car = flank_of_car();
    const std::vector<Vec2> path = curve_through(flank_keys());
    for (const double higher : {0.0, 3e-3}) {
        Document painting(car);
        painting.paint(stripe(path, {{0, -0.24, 0.178 + higher}, {1, 0, 0}, {0, 0, -1}, SurfaceMapping::project}));
        const Evenness e = measure(painting, car, 10e-3, [](const Vec3& p) { return p.y < 0 ? 0.55 - p.x : -1; },
                                   {35, 36, 67});  // the door's
        record(e);
        EXPECT_GT(e.length, 0.95);
        EXPECT_LE(e.deviation, 0.03 * e.mean) << higher;
        EXPECT_LT(e.widest, 1.3 * e.mean) << "no bead, nor at the shut lines";
        EXPECT_GT(e.narrowest, 0.85 * e.mean) << "no break";
    }
}

/// Round a circle of 60 mm, the start with it.
TEST(Pinstripe, ACurveOfSixtyMillimetresIsEven) {
    const Model sheet = shipped("sheet.ply", 2048);
    std::vector<Vec2> path;
    for (int i = 0; i <= 340; ++i) {
        const double a = i * 1e-3 / 60e-3;
        path.push_back(60e-3 * Vec2(std::cos(a), std::sin(a)));
    }
    Document painting(sheet);
    painting.paint(stripe(path, {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::project}));
    const Evenness e = measure(painting, sheet, 5e-3, [](const Vec3& p) {
        return 60e-3 * std::fmod(std::atan2(-p.y, p.x) + 2 * std::numbers::pi, 2 * std::numbers::pi);
    });
    record(e);
    EXPECT_LE(e.deviation, 0.03 * e.mean);
    EXPECT_LT(e.widest, 1.15 * e.mean);
    EXPECT_GT(e.narrowest, 0.85 * e.mean);
}

/// A line as an area, `width` metres wide, along points of a drawing.
Fill line_area(const std::vector<Vec2>& path, const Placement& place, double width) {
    FlatArea area{.rings = {{}}, .placement = place, .low = path.front(), .high = path.front(), .stops = {}};
    std::vector<Vec2> back;
    for (std::size_t i = 0; i < path.size(); ++i) {
        const Vec2 ahead = glm::normalize(path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0]);
        const Vec2 across(-ahead.y, ahead.x);
        area.rings[0].push_back(path[i] + 0.5 * width * across);
        back.push_back(path[i] - 0.5 * width * across);
        area.low = glm::min(area.low, path[i] - width), area.high = glm::max(area.high, path[i] + width);
    }
    area.rings[0].insert(area.rings[0].end(), back.rbegin(), back.rend());
    area.lines = {path};
    area.stops = {{.ink = "titanium-white"}};
    return fill_of_area(std::move(area));
}

/// A gentle S, `half` metres to both sides of the place.
std::vector<Vec2> wave(double half, double height) {
    std::vector<Vec2> path;
    const int n = static_cast<int>(std::lround(2 * half / 1e-3));
    for (int i = 0; i <= n; ++i) {
        const double x = half * (2.0 * i / n - 1);
        path.emplace_back(x, height * std::sin(std::numbers::pi * x / half));
    }
    return path;
}

/// Both bends alike. A blade that turns sooner than its hair, or stands upright, draws one of them wider.
TEST(Pinstripe, AnSOnASheetIsEven) {
    const Model sheet = shipped("sheet.ply", 2048);
    Document painting(sheet);
    painting.paint(stripe(wave(75e-3, 8e-3), {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::project}));
    const Evenness e = measure(painting, sheet, 5e-3, [](const Vec3& p) { return 0.1 + p.x; });
    record(e);
    EXPECT_GT(e.length, 0.095) << "the ends do not count";
    EXPECT_GT(e.narrowest, 0.85 * e.mean) << "no break";
    EXPECT_LE(e.deviation, 0.02 * e.mean) << "of its texels, a fifth of the line wide, 1 %";
}

/// Where the model is seen from before, at a height.
Placement before(const Model& model, double height) {
    const auto at = model.query->ray({0, -1, height}, {0, 1, 0});
    return upright_placement(at->position, at->normal, 0);
}

double round_z(const Vec3& p, double radius) {
    return radius * (std::numbers::pi + std::atan2(p.x, -p.y));
}

/// How even a line of a drawing is that is painted as an area, draped in an S over half a model: `radius` turns angles
/// round z into lengths.
Evenness draped_area(const Model& model, double half_length, double height, double radius) {
    Placement place = before(model, model.mesh->bounds.centre().z);
    place.mapping = SurfaceMapping::drape;
    Document painting(model);
    painting.paint(line_area(wave(half_length, height), place, 6e-3));
    return measure(painting, model, 5e-3, [&](const Vec3& p) { return round_z(p, radius); });
}

/// A sword's stripe draped in an S of `height` over half a model; `mirrored`: from right to left, its mirror image.
Evenness draped_stripe(const Model& model, double half_length, double height, bool mirrored = false) {
    Placement place = before(model, model.mesh->bounds.centre().z);
    place.mapping = SurfaceMapping::drape;
    std::vector<Vec2> path = wave(half_length, height);
    for (Vec2& p : path) p.x *= mirrored ? -1 : 1;
    Document painting(model);
    painting.paint(stripe(path, place));
    const double radius = std::hypot(place.origin.x, place.origin.y);
    return measure(painting, model, 5e-3, [&](const Vec3& p) { return round_z(p, radius); });
}

/// Over the wall of a bowl, which falls away from a landing blade along and across. A blade that falls to its side
/// draws twice its edge, and rises over 100 mm.
TEST(Pinstripe, AnSOverABowlIsEven) {
    const Model bowl = shipped("bowl.ply", 4096);
    for (const bool mirrored : {false, true}) {
        const Evenness e = draped_stripe(bowl, 75e-3, 8e-3, mirrored);
        record(e);
        EXPECT_LE(e.deviation, 0.03 * e.mean) << mirrored;
        EXPECT_LT(e.mean, 0.8e-3) << "on its edge, 0.6 mm";
    }
}

/// Once round half a ball.
TEST(Pinstripe, AStripeOverABallIsEven) {
    const Evenness e = draped_stripe(shipped("sphere.ply", 4096), 75e-3, 0);
    record(e);
    EXPECT_LE(e.deviation, 0.03 * e.mean);
    EXPECT_LT(e.mean, 0.8e-3) << "on its edge, 0.6 mm";
}

/// Over 120° of a ball, as curved across as along.
TEST(Pinstripe, ALineAsAnAreaOverABallIsEven) {
    const Evenness e = draped_area(shipped("sphere.ply", 4096), 52e-3, 9e-3, 50e-3);
    record(e);
    EXPECT_LE(e.deviation, 0.03 * e.mean);
}

/// Over the wall of a bowl, which narrows downwards.
TEST(Pinstripe, ALineAsAnAreaOverABowlIsEven) {
    const Model bowl = shipped("bowl.ply", 4096);
    const Vec3 front = before(bowl, bowl.mesh->bounds.centre().z).origin;
    const Evenness e = draped_area(bowl, 75e-3, 8e-3, std::hypot(front.x, front.y));
    record(e);
    EXPECT_LE(e.deviation, 0.03 * e.mean);
}

/// A line of a drawing, as an area along the flank and over both arches.
TEST(Pinstripe, AMetreOfALineAsAnAreaIsEven) {
    const Model car = shipped("car.ply", 4096);
    const std::vector<Vec2> path = curve_through(flank_keys());
    Document painting(car);
    painting.paint(line_area(path, {{0, -0.24, 0.178}, {1, 0, 0}, {0, 0, -1}, SurfaceMapping::project}, 6e-3));
    const Evenness e = measure(painting, car, 10e-3, [](const Vec3& p) { return p.y < 0 ? 0.55 - p.x : -1; },
                               {35, 36, 67});  // the door's
    record(e);
    EXPECT_GT(e.length, 0.95);
    EXPECT_LE(e.deviation, 0.03 * e.mean);
}

/// The same draped. The flares of the arches are curved across as along, so lines of equal distance from the place lie
/// up to a quarter further apart or nearer there than in the drawing; and the door's shut lines lie below it.
TEST(Pinstripe, AMetreOfADrapedLineAsAnAreaIsEven) {
    const Model car = shipped("car.ply", 4096);
    const std::vector<Vec2> path = curve_through(flank_keys());
    Document painting(car);
    painting.paint(line_area(path, {{0, -0.24, 0.178}, {1, 0, 0}, {0, 0, -1}, SurfaceMapping::drape}, 6e-3));
    const Evenness e =
        measure(painting, car, 10e-3, [](const Vec3& p) { return p.y < 0 ? 0.55 - p.x : -1; },
                {34, 35, 36, 37, 66, 67, 68});  // the door's, which move the middles of parts beside them
    record(e);
    EXPECT_GT(e.length, 0.9) << "geodesics round the nose are longer than the view of it";
    EXPECT_LE(e.deviation, 0.03 * e.mean);
    EXPECT_NEAR(e.mean, 6e-3, 0.02 * 6e-3) << "a texel of 0.3 mm, by parts";
    EXPECT_LT(e.widest, 1.07 * e.mean) << "5 % of it, of a part without its middle, at the shut lines";
    EXPECT_GT(e.narrowest, 0.93 * e.mean);
}

/// Of two lines from the place of a ball, and one that crosses them a quarter round: an exponential map draws it at
/// sin θ / θ of its width, 0.64 at θ = 90°.
TEST(Pinstripe, ADrapedLineAcrossTheLinesFromThePlaceHasItsWidth) {
    const Model ball = shipped("sphere.ply", 2048);
    constexpr double kRadius = 50e-3, kWidth = 8e-3;
    Placement place = before(ball, ball.mesh->bounds.centre().z);
    place.mapping = SurfaceMapping::drape;
    const double across = 0.5 * std::numbers::pi * kRadius;
    for (const double at : {0.25, 0.5, 0.75, 1.0}) {
        std::vector<Vec2> radial;  // along a line from the place: its width is across the map's stretch
        for (int i = -20; i <= 20; ++i) radial.emplace_back(at * across + 0.5e-3 * i, 0);
        Document painting(ball);
        painting.paint(line_area(radial, place, kWidth));
        double area = 0;
        const ink::Canvas& canvas = painting.layers().canvas();
        const double film = painting.materials().ink("titanium-white").film;
        for (const std::uint32_t slot : canvas.touched_slots())
            if (const ink::Plane* plane = canvas.plane(slot, 0))
                for (int t = 0; t < atlas::kTileTexels; ++t)
                    area += (*plane)[t] / film * static_cast<double>(ball.texels.tiles[slot].area[t]);
        // Slivers of edge texels and a lattice of 2 mm over a radius of 50 mm: 1 %.
        EXPECT_NEAR(area / (20e-3 * kWidth), 1, 0.015) << at;
    }
}

}  // namespace
}  // namespace tuft::stroke
