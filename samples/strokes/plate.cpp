#include <cmath>
#include <numbers>

#include "brush/preset/preset.h"
#include "compositions.h"
#include "core/random.h"
#include "core/text/units.h"
#include "hand.h"

namespace tuft::samples {

namespace {

using std::numbers::pi;

constexpr const char* kBrush = "mixed-small";
constexpr int kPeriods = 12;
constexpr double kRadius = 113.5;  ///< mm, middle of the rim
constexpr double kHeight = 24.6;   ///< mm, of the glaze there
constexpr double kSlope = 0.245;   ///< radians, the rim rises outwards

/// Lays one period of the ornament out: s mm along the rim, t mm outwards, to the flat
/// square of a placement at s = 0. The rim is a cone, so its circle unrolls to one of
/// radius r / cos(slope).
struct Rim {
    double unrolled = kRadius / std::cos(kSlope);
    Key at(double s, double t, double width, double pace = 1, double rest = -1) const {
        const double a = s / unrolled;
        return {(unrolled + t) * std::sin(a), unrolled - (unrolled + t) * std::cos(a), width, pace, rest};
    }
};

/// The hand's own variation.
struct Hand {
    Random random;
    double vary(double x, double part) { return x * (1 + random.uniform(-part, part)); }
    double shift(double most) { return random.uniform(-most, most); }
};

struct Leaf {
    double s = 0, t = 0;  ///< foot, mm
    double turn = 0;      ///< radians from +s towards +t
    double length = 10, width = 3;
    double bend = 0.15;  ///< of the length, to the left
};

Stroke draw(const Leaf& l, const Rim& rim) {
    const Vec2 u{std::cos(l.turn), std::sin(l.turn)}, v{-u.y, u.x};
    const auto key = [&](double along, double across, double width, double pace, double rest = -1) {
        const Vec2 p = Vec2(l.s, l.t) + l.length * (along * u + across * l.bend * v);
        return rim.at(p.x, p.y, width, pace, rest);
    };
    return {"leaf",
            {key(0, 0, 0, 0.7), key(0.16, 0.5, 0.45 * l.width, 0.8), key(0.42, 1.0, l.width, 0.8),
             key(0.66, 0.95, 0.80 * l.width, 1), key(0.86, 0.5, 0.34 * l.width, 1.2), key(1.0, 0.0, 0.22, 1.2, 0),
             key(0.93, 0.22, 0, 1)}};
}

/// A thin line through points (s, t) that swells by `width` in its middle.
Stroke stem(const std::vector<Vec2>& points, double width, const Rim& rim) {
    Stroke out{"stem", {}};
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        const double x = static_cast<double>(i) / static_cast<double>(n - 1);
        const double w = i == 0 || i + 1 == n ? 0 : width * (0.75 + 0.4 * std::sin(pi * x));
        out.keys.push_back(rim.at(points[i].x, points[i].y, w, 1.0));
    }
    return out;
}

/// A round berry: pressed and lifted where it stands.
Stroke berry(Vec2 p, double width, const Rim& rim) {
    return {"berry",
            {rim.at(p.x - 0.7 * width, p.y, 0, 0.4), rim.at(p.x, p.y, width, 0.4, 0.06),
             rim.at(p.x - 0.1 * width, p.y, 0, 0.4)}};
}

/// Half a wave: the stem's hollow with its spray, and the leaf on its back. `side` is +1
/// where the stem runs on the outer half.
void half_wave(std::vector<Stroke>& out, double s0, double half, double side, const Rim& rim, Hand& hand) {
    const double rise = 6.5;
    const auto wave = [&](double x) { return side * rise * std::sin(pi * x); };
    std::vector<Vec2> main;
    for (int i = -1; i <= 9; ++i) main.push_back({s0 + half * i / 8.0, wave(i / 8.0)});
    for (std::size_t i = 1; i + 1 < main.size(); ++i) main[i].y += hand.shift(0.25);
    out.push_back(stem(main, 1.3, rim));

    // A side shoot curls back into the hollow and ends in a spray of three.
    const double x0 = s0 + 0.08 * half;
    const Vec2 end{s0 + hand.vary(0.56, 0.03) * half, side * hand.vary(-5.2, 0.06)};
    out.push_back(
        stem({{x0, wave(0.08)}, {s0 + 0.22 * half, side * 1.0}, {s0 + 0.38 * half, side * -2.6}, end}, 0.95, rim));
    const double along = side * -0.25;
    const double turns[] = {0.0, 0.75, -0.75};
    const double lengths[] = {15.0, 11.5, 11.0};
    for (int k = 0; k < 3; ++k)
        out.push_back(draw({.s = end.x - 2.0,
                            .t = end.y + side * 0.9,
                            .turn = along + turns[k] + hand.shift(0.08),
                            .length = hand.vary(lengths[k], 0.06),
                            .width = hand.vary(k ? 3.0 : 3.7, 0.06),
                            .bend = turns[k] > 0   ? -0.16
                                    : turns[k] < 0 ? 0.16
                                                   : 0.10 * side},
                           rim));
    // Two leaves on the outer side of the wave, one before the crest and one behind.
    for (const double x : {0.30, 0.62}) {
        const double slope = std::atan2(side * rise * pi * std::cos(pi * x), half);
        out.push_back(draw({.s = s0 + x * half,
                            .t = wave(x) + side * 0.4,
                            .turn = slope + side * (0.75 + hand.shift(0.08)),
                            .length = hand.vary(x < 0.5 ? 10.0 : 11.5, 0.06),
                            .width = hand.vary(3.0, 0.06),
                            .bend = -0.16 * side},
                           rim));
    }
    // One under the shoot's start.
    out.push_back(draw({.s = s0 + 0.22 * half,
                        .t = side * 0.6,
                        .turn = side * (-1.25 + hand.shift(0.1)),
                        .length = hand.vary(8.0, 0.08),
                        .width = hand.vary(2.7, 0.06),
                        .bend = 0.16 * side},
                       rim));
    out.push_back(berry({s0 + 0.93 * half, side * hand.vary(6.6, 0.05)}, hand.vary(2.3, 0.08), rim));
}

}  // namespace

std::vector<stroke::Trace> plate_ornament() {
    const WidthTable table(brush::load_preset(kBrush));
    const WriteOptions options{.size = 1.0, .centre = {0, 0}, .speed = 0.05};  // keys are millimetres
    const Rim rim;
    const double period = 2 * pi * rim.unrolled * std::cos(kSlope) / kPeriods;
    std::vector<stroke::Trace> out;
    for (int k = 0; k < kPeriods; ++k) {
        const double a = -2 * pi * k / kPeriods;  // to the right, seen from above with the rim up
        const Vec3 radial{std::sin(-a), std::cos(-a), 0};
        const stroke::Placement place{kMillimetre * (kRadius * radial + Vec3(0, 0, kHeight)),
                                      {radial.y, -radial.x, 0},
                                      -radial,
                                      stroke::SurfaceMapping::wrap};
        Hand hand{Random(static_cast<std::uint64_t>(k) + 1)};
        std::vector<Stroke> strokes;
        half_wave(strokes, -0.5 * period, 0.5 * period, 1, rim, hand);
        half_wave(strokes, 0, 0.5 * period, -1, rim, hand);
        for (const Stroke& s : strokes) {
            stroke::Trace t = write(s, table, options);
            t.placement = place;
            t.brush = kBrush;
            t.ink = "cobalt";
            t.seed = out.size() + 1;
            out.push_back(t);
        }
    }
    return out;
}

}  // namespace tuft::samples
