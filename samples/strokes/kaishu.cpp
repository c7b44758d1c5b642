#include "kaishu.h"

#include <algorithm>
#include <cmath>

namespace tuft::samples {

namespace {

/// Coordinates along a stroke: `along` from its start in thousandths, `across` to the
/// right-hand side of the direction of motion (down for a stroke that runs right).
struct Axis {
    Vec2 from, u, v;
    double length;

    Axis(Vec2 a, Vec2 b) : from(a), u(glm::normalize(b - a)), v(-u.y, u.x), length(glm::length(b - a)) {}
    Key at(double along, double across, double width, double pace = 1, double rest = -1) const {
        const Vec2 p = from + along * u + across * v;
        return {p.x, p.y, width, pace, rest};
    }
};

void append(Stroke& s, std::initializer_list<Key> keys) {
    s.keys.insert(s.keys.end(), keys);
}

/// Ends a 横 by a shoulder: the hand presses on as it comes there, then turns down to the right while it lifts, so that
/// the hair closes in a slanted cut, and goes back along the stroke as it leaves. `b`: how far the middle lies across.
/// Places and widths are those for which the edge wavers least about its hull, by trial with wolf, goat and mixed hair.
void shoulder(Stroke& s, const Axis& l, double b, double w) {
    const double n = l.length;
    append(s,
           {l.at(n - 0.954 * w, 0.4 * b + 0.026 * w, 0.78 * w, 0.7),
            l.at(n - 0.562 * w, 0.3 * b + 0.084 * w, 0.70 * w, 0.5, 0),
            l.at(n - 0.357 * w, 0.3 * b + 0.21 * w, 0.505 * w, 0.4, 0),
            l.at(n - 0.38 * w, 0.3 * b + 0.016 * w, 0.283 * w, 0.4), l.at(n - 0.79 * w, 0.3 * b + 0.085 * w, 0, 0.4)});
}

/// Ends a stroke that runs out to a point: the finest line up to the last key, then the hand goes
/// on as it lifts, for the tip trails behind it.
void run_out(Stroke& s, double w) {
    Key& end = s.keys.back();
    const Key before = s.keys[s.keys.size() - 2];
    const Vec2 on = 0.15 * w * glm::normalize(Vec2(end.x - before.x, end.y - before.y));
    end.width = std::max(0.08 * w, 8.0);
    s.keys.push_back({end.x + on.x, end.y + on.y, 0, 1.2});
}

}  // namespace

// Heads of 横 and 折 land where they are pressed: a tip that first moves draws a stick of its own width.
Stroke heng(Vec2 from, Vec2 to, double w, double bow) {
    const Axis l(from, to);
    const double n = l.length, b = -bow * n;
    Stroke s{"heng", {}};
    append(s, {l.at(0.17 * w, -0.243 * w, 0, 0.5), l.at(0.18 * w, -0.24 * w, 0.30 * w, 0.5),
               l.at(0.58 * w, -0.06 * w, 0.72 * w, 0.5, 0), l.at(1.6 * w, 0.4 * b - 0.02 * w, 0.76 * w, 0.9),
               l.at(0.5 * n, b, 0.70 * w, 1.1), l.at(n - 1.963 * w, 0.65 * b - 0.03 * w, 0.665 * w, 0.9)});
    shoulder(s, l, b, w);
    return s;
}

Stroke short_heng(Vec2 from, Vec2 to, double w) {
    const Axis l(from, to);
    const double n = l.length, b = -0.02 * n;
    Stroke s{"heng", {}};
    append(s, {l.at(0.4 * w, -0.04 * w, 0, 0.6), l.at(0.6 * w, 0.02 * w, 0.70 * w, 0.7), l.at(0.5 * n, b, 0.71 * w, 1),
               l.at(n - 1.5 * w, 0.6 * b - 0.03 * w, 0.68 * w, 0.9)});
    shoulder(s, l, b, w);
    return s;
}

namespace {

/// The head of a 竖: a cut from the upper left, then straight down.
void shu_head(Stroke& s, const Axis& l, double w) {
    append(s, {l.at(0.06 * w, 0.30 * w, 0, 0.5), l.at(0.18 * w, 0.26 * w, 0.30 * w, 0.5),
               l.at(0.60 * w, 0.06 * w, 0.79 * w, 0.5, 0), l.at(1.7 * w, 0.04 * w, 0.92 * w, 0.9)});
}

}  // namespace

Stroke shu_drop(Vec2 from, Vec2 to, double w, double bow) {
    const Axis l(from, to);
    const double n = l.length, b = bow * n;
    Stroke s{"shu", {}};
    shu_head(s, l, w);
    append(s, {l.at(0.45 * n, b + 0.03 * w, 0.85 * w, 1.1), l.at(n - 1.6 * w, 0.5 * b + 0.03 * w, 0.90 * w, 0.8),
               l.at(n - 0.75 * w, 0.03 * w, 1.0 * w, 0.5), l.at(n - 0.52 * w, 0.05 * w, 0.92 * w, 0.4, 0.02),
               l.at(n - 0.44 * w, 0.05 * w, 0, 0.3)});
    return s;
}

Stroke shu_needle(Vec2 from, Vec2 to, double w) {
    const Axis l(from, to);
    const double n = l.length;
    Stroke s{"shu", {}};
    shu_head(s, l, w);
    append(s, {l.at(0.5 * n, 0.02 * w, 0.92 * w, 1.1), l.at(0.76 * n, 0, 0.88 * w, 1.1),
               l.at(0.91 * n, 0, 0.42 * w, 1.2), l.at(0.985 * n, 0, 0.0, 1.4)});
    run_out(s, w);
    return s;
}

Stroke shu_plain(Vec2 from, Vec2 to, double w) {
    const Axis l(from, to);
    const double n = l.length;
    Stroke s{"shu", {}};
    shu_head(s, l, w);
    append(s, {l.at(n - 0.75 * w, 0.02 * w, 0.92 * w, 0.7, 0.02), l.at(n - 0.85 * w, 0.02 * w, 0, 0.5)});
    return s;
}

Stroke shu_gou(Vec2 from, Vec2 to, Vec2 hook, double w) {
    const Axis l(from, to);
    const double n = l.length;
    Stroke s{"shu-gou", {}};
    shu_head(s, l, w);
    const Vec2 p = to + Vec2(-0.15 * w, -0.55 * w), h = hook - p;
    append(s, {l.at(0.55 * n, 0.03 * w, 0.88 * w, 1.1),
               l.at(n - 1.1 * w, 0.02 * w, 0.94 * w, 0.7),
               {p.x, p.y, 1.02 * w, 0.4, 0.03},
               {p.x + 0.45 * h.x, p.y + 0.38 * h.y, 0.62 * w, 0.8},
               {p.x + 0.8 * h.x, p.y + 0.75 * h.y, 0.30 * w, 1.1},
               {hook.x, hook.y, 0, 1.3}});
    run_out(s, w);
    return s;
}

Stroke shu_wan_gou(Vec2 from, Vec2 bend, Vec2 to, Vec2 hook, double w) {
    const Axis l(from, bend);
    const double n = l.length;
    const Vec2 t = glm::normalize(to - bend);
    const double m = glm::length(to - bend);
    const auto along = [&](double d, double down, double width, double pace, double rest = -1) -> Key {
        const Vec2 p = bend + d * t + Vec2(0, down);
        return {p.x, p.y, width, pace, rest};
    };
    Stroke s{"shu-wan-gou", {}};
    shu_head(s, l, w);
    append(s, {l.at(0.5 * n, 0.02 * w, 0.84 * w, 1.05), l.at(n - 2.0 * w, -0.02 * w, 0.74 * w, 0.9),
               l.at(n - 1.0 * w, -0.13 * w, 0.70 * w, 0.7), along(0.46 * w, -0.36 * w, 0.68 * w, 0.6),
               along(1.35 * w, -0.04 * w, 0.70 * w, 0.7), along(0.5 * m, 0.06 * w, 0.78 * w, 1),
               along(m - 1.1 * w, 0.0, 0.98 * w, 0.7), along(m - 0.55 * w, -0.12 * w, 0.98 * w, 0.4, 0.03)});
    const Vec2 p{s.keys.back().x, s.keys.back().y}, h = hook - p;
    append(s, {{p.x + 0.40 * h.x + 0.1 * w, p.y + 0.36 * h.y, 0.62 * w, 0.8},
               {p.x + 0.75 * h.x + 0.08 * w, p.y + 0.72 * h.y, 0.30 * w, 1.1},
               {hook.x, hook.y, 0, 1.2}});
    run_out(s, w);
    return s;
}

Stroke pie(Vec2 from, Vec2 to, double w, double sag) {
    const Axis l(from, to);
    const double n = l.length, b = -sag * n;
    Stroke s{"pie", {}};
    append(s, {l.at(0.04 * w, 0.30 * w, 0, 0.5), l.at(0.16 * w, 0.27 * w, 0.30 * w, 0.5),
               l.at(0.60 * w, 0.08 * w, 0.80 * w, 0.5, 0), l.at(1.2 * w, 0.2 * b, 0.98 * w, 0.7),
               l.at(0.25 * n, 0.62 * b, 0.94 * w, 0.95), l.at(0.5 * n, b, 0.85 * w, 1.05),
               l.at(0.74 * n, 0.88 * b, 0.66 * w, 1.1), l.at(0.90 * n, 0.46 * b, 0.36 * w, 1.2),
               l.at(0.985 * n, 0.06 * b, 0.0, 1.4)});
    run_out(s, w);
    return s;
}

Stroke na(Vec2 from, Vec2 foot, Vec2 to, double w) {
    const Axis l(from, foot);
    const double n = l.length;
    const Vec2 t = to - foot;
    Stroke s{"na", {}};
    append(s, {l.at(0, 0, 0, 0.6), l.at(0.02 * n, 0.005 * n, 0.15 * w, 0.6), l.at(0.08 * n, 0.02 * n, 0.26 * w, 0.8),
               l.at(0.38 * n, 0.07 * n, 0.48 * w, 1), l.at(0.72 * n, 0.055 * n, 0.80 * w, 0.9),
               l.at(0.97 * n, 0, 1.06 * w, 0.45, 0.04)});
    append(s, {{foot.x + 0.34 * t.x, foot.y + 0.30 * t.y, 0.80 * w, 0.6},
               {foot.x + 0.66 * t.x, foot.y + 0.62 * t.y, 0.44 * w, 0.85},
               {to.x, to.y, 0, 1.2}});
    run_out(s, 0.7 * w);
    return s;
}

Stroke dian(Vec2 from, Vec2 to, double w) {
    const Axis l(from, to);
    const double n = l.length;
    Stroke s{"dian", {}};
    append(s, {l.at(0, 0, 0, 0.6), l.at(0.04 * n, 0, 0.2 * w, 0.5), l.at(0.45 * n, -0.05 * n, 0.72 * w, 0.7),
               l.at(n - 0.5 * w, 0.0, 1.12 * w, 0.45, 0.03), l.at(n - 0.62 * w, 0.06 * w, 0.0, 0.5)});
    return s;
}

Stroke dian_pie(Vec2 from, Vec2 to, double w) {
    const Axis l(from, to);
    const double n = l.length;
    Stroke s{"pie-dian", {}};
    append(s, {l.at(0.12 * w, 0.4 * w, 0, 0.5), l.at(0.55 * w, 0.0, 1.05 * w, 0.5, 0.02),
               l.at(0.5 * n, -0.06 * n, 0.82 * w, 1), l.at(0.8 * n, -0.03 * n, 0.42 * w, 1.1), l.at(n, 0, 0, 1.3)});
    run_out(s, w);
    return s;
}

Stroke ti(Vec2 from, Vec2 to, double w) {
    const Axis l(from, to);
    const double n = l.length;
    Stroke s{"ti", {}};
    append(s, {l.at(0.25 * w, -0.40 * w, 0, 0.5), l.at(0.52 * w, 0.05 * w, 1.05 * w, 0.5, 0.03),
               l.at(0.42 * n, 0.03 * n, 0.72 * w, 0.9), l.at(0.75 * n, 0.01 * n, 0.34 * w, 1.2), l.at(n, 0, 0, 1.4)});
    run_out(s, w);
    return s;
}

namespace {

/// The path across and the shoulder of a 折.
void zhe_head(Stroke& s, const Axis& l, double w) {
    const double n = l.length;
    append(s, {l.at(0.17 * w, -0.243 * w, 0, 0.5), l.at(0.18 * w, -0.24 * w, 0.28 * w, 0.5),
               l.at(0.56 * w, -0.06 * w, 0.70 * w, 0.5, 0), l.at(1.6 * w, -0.005 * n, 0.76 * w, 0.9),
               l.at(0.55 * n, -0.02 * n, 0.72 * w, 1), l.at(n - 1.4 * w, -0.012 * n, 0.75 * w, 0.8),
               l.at(n - 0.72 * w, -0.08 * w, 0.78 * w, 0.45, 0.01), l.at(n - 0.50 * w, 0.16 * w, 0.98 * w, 0.4, 0.01)});
}

}  // namespace

Stroke heng_zhe(Vec2 from, Vec2 corner, Vec2 to, double w) {
    const Axis l(from, corner), d(Vec2(corner.x - 0.45 * w, corner.y), to);
    const double m = d.length;
    Stroke s{"heng-zhe", {}};
    zhe_head(s, l, w);
    append(s, {d.at(1.6 * w, 0, 1.0 * w, 0.8), d.at(0.6 * m, 0, 0.94 * w, 1), d.at(m - 0.6 * w, 0, 1.02 * w, 0.6, 0.02),
               d.at(m - 0.7 * w, 0, 0, 0.5)});
    return s;
}

Stroke heng_pie(Vec2 from, Vec2 corner, Vec2 to, double w) {
    const Axis l(from, corner), d(Vec2(corner.x - 0.4 * w, corner.y + 0.3 * w), to);
    const double m = d.length;
    Stroke s{"heng-pie", {}};
    zhe_head(s, l, w);
    append(s, {d.at(0.28 * m, -0.075 * m, 0.92 * w, 0.9), d.at(0.55 * m, -0.11 * m, 0.78 * w, 1.05),
               d.at(0.80 * m, -0.075 * m, 0.50 * w, 1.15), d.at(0.98 * m, 0.0, 0.0, 1.4)});
    run_out(s, w);
    return s;
}

}  // namespace tuft::samples
