#include "io/svg/svg_stroke.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::io {
namespace {

Vec2 left_of(const Vec2& d) {
    return {-d.y, d.x};
}
double cross_of(const Vec2& a, const Vec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Outline of one line, side by side.
class Outline {
  public:
    Outline(const SvgStyle& style, double tolerance) : style_(style), r_(0.5 * style.pen.width) {
        const double part = std::clamp(tolerance / std::max(r_, 1e-300), 1e-4, 0.5);
        step_ = 2 * std::acos(1 - part);
    }

    std::vector<SvgLine> of(const SvgLine& raw) {
        SvgLine line;
        for (const Vec2& p : raw)
            if (line.empty() || glm::distance(line.back(), p) > 1e-9 * r_) line.push_back(p);
        const bool closed = raw.size() > 2 && raw.front() == raw.back() && line.size() > 2;
        if (line.size() < 2) return dot(raw.front());
        if (closed) {
            if (glm::distance(line.front(), line.back()) <= 1e-9 * r_) line.pop_back();
            SvgLine back(line.rbegin(), line.rend());
            return {side(line, true), side(back, true)};
        }
        SvgLine ring = side(line, false);
        cap(ring, line.back(), glm::normalize(line.back() - line[line.size() - 2]));
        const SvgLine back(line.rbegin(), line.rend());
        const SvgLine other = side(back, false);
        ring.insert(ring.end(), other.begin(), other.end());
        cap(ring, line.front(), glm::normalize(line.front() - line[1]));
        return {ring};
    }

  private:
    // A line of length 0 shows its ends.
    std::vector<SvgLine> dot(const Vec2& at) {
        if (style_.pen.cap == SvgCap::butt) return {};
        if (style_.pen.cap == SvgCap::square)
            return {{at + Vec2(-r_, -r_), at + Vec2(r_, -r_), at + Vec2(r_, r_), at + Vec2(-r_, r_)}};
        SvgLine ring;
        fan(ring, at, {r_, 0}, 2 * std::numbers::pi);
        return {ring};
    }

    /// The side to the left of the line.
    SvgLine side(const SvgLine& line, bool closed) {
        SvgLine out;
        const std::size_t n = line.size(), parts = closed ? n : n - 1;
        Vec2 before(0);
        for (std::size_t i = 0; i < parts; ++i) {
            const Vec2 &a = line[i], &b = line[(i + 1) % n];
            const Vec2 along = glm::normalize(b - a);
            if (i > 0) join(out, a, before, along);
            out.push_back(a + r_ * left_of(along));
            out.push_back(b + r_ * left_of(along));
            before = along;
        }
        if (closed) join(out, line[0], before, glm::normalize(line[1] - line[0]));
        return out;
    }

    void join(SvgLine& out, const Vec2& at, const Vec2& in, const Vec2& on) {
        const double turn = std::atan2(cross_of(in, on), glm::dot(in, on));
        if (turn > 0) {  // the inner side: by way of the corner, which lies inside
            if (turn > 1e-3) out.push_back(at);
            return;
        }
        if (style_.pen.join == SvgJoin::round) return fan(out, at, r_ * left_of(in), turn);
        // The ratio of the miter's length to the width is 1 / sin(θ/2), θ the angle between the parts.
        const double sine = std::cos(0.5 * turn);
        if (style_.pen.join == SvgJoin::miter && sine * style_.pen.miter_limit >= 1 && sine > 1e-6) {
            const Vec2 middle = left_of(in) + left_of(on);
            out.push_back(at + (r_ / sine) * glm::normalize(middle));
        }
    }

    void cap(SvgLine& out, const Vec2& at, const Vec2& along) {
        if (style_.pen.cap == SvgCap::round) return fan(out, at, r_ * left_of(along), -std::numbers::pi);
        if (style_.pen.cap != SvgCap::square) return;
        out.push_back(at + r_ * (along + left_of(along)));
        out.push_back(at + r_ * (along - left_of(along)));
    }

    void fan(SvgLine& out, const Vec2& at, const Vec2& from, double turn) {
        const int n = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / step_)));
        for (int i = 1; i < n; ++i) {
            const double a = turn * i / n, c = std::cos(a), s = std::sin(a);
            out.push_back(at + Vec2(c * from.x - s * from.y, s * from.x + c * from.y));
        }
    }

    const SvgStyle& style_;
    double r_, step_ = 0.1;
};

}  // namespace

std::vector<SvgLine> svg_dashed(const SvgLine& line, const std::vector<double>& dashes, double offset) {
    double period = 0, whole = 0;
    for (const double d : dashes) period += d;
    for (std::size_t i = 1; i < line.size(); ++i) whole += glm::distance(line[i - 1], line[i]);
    if (!(period > 0) || whole / period * static_cast<double>(dashes.size()) > double(kMostDashes)) return {line};
    double phase = offset - period * std::floor(offset / period);
    std::size_t k = 0;
    while (phase > 0 && phase >= dashes[k]) phase -= dashes[k], k = (k + 1) % dashes.size();
    double left = dashes[k] - phase;
    std::vector<SvgLine> out;
    SvgLine dash;
    if (k % 2 == 0) dash.push_back(line.front());
    for (std::size_t i = 1; i < line.size(); ++i) {
        Vec2 at = line[i - 1];
        for (double rest = glm::distance(at, line[i]); rest > 0;) {
            if (left > rest) {
                left -= rest;
                if (k % 2 == 0) dash.push_back(line[i]);
                break;
            }
            at += (line[i] - at) * (left / rest);
            rest -= left;
            if (k % 2 == 0) {
                dash.push_back(at);
                out.push_back(std::move(dash));
            }
            dash.clear();
            k = (k + 1) % dashes.size();
            left = dashes[k];
            if (k % 2 == 0) dash.push_back(at);
            if (out.size() > kMostDashes) return {line};
        }
    }
    if (dash.size() == 1 && left == 0) dash.push_back(dash.front());  // a dash without length shows its ends
    if (dash.size() > 1) out.push_back(std::move(dash));
    return out;
}

std::vector<SvgLine> svg_stroke_rings(const SvgLine& line, const SvgStyle& style, double tolerance) {
    if (line.empty() || !(style.pen.width > 0)) return {};
    std::vector<SvgLine> rings;
    for (const SvgLine& part : style.pen.dashes.empty() ? std::vector<SvgLine>{line}
                                                        : svg_dashed(line, style.pen.dashes, style.pen.dash_offset))
        for (SvgLine& ring : Outline(style, tolerance).of(part)) rings.push_back(std::move(ring));
    return rings;
}

}  // namespace tuft::io
