#include "footprint/outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "atlas/log_map.h"

namespace tuft::footprint {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kSearchSteps = 4;  // per segment, to find where the skin meets the surface
constexpr int kSamples = 48;     // sections taken from a stretch that touches
constexpr int kDirections = 24;  // points of a whole section's shadow

/// A section seen from the surface: everything in the stamp's (u, v) and height over it.
struct Cut {
    Vec2 centre{0};       ///< metres, foot of the section's centre
    double z = 0;         ///< metres, height of the centre
    double a = 0, b = 0;  ///< metres, semi-axes with the film
    Vec3 e{1, 0, 0};      ///< unit axes: (u, v, height)
    Vec3 m{0, 0, 1};

    double half_height() const { return std::sqrt(a * a * e.z * e.z + b * b * m.z * m.z); }
    double overlap() const { return half_height() - z; }
    Vec2 at(double cos_w, double sin_w) const {
        return centre + a * cos_w * Vec2(e) + b * sin_w * Vec2(m);
    }
};

Cut cut_of(const brush::Section& s, const Frame& frame, const brush::ContactPlane* plane,
           double film) {
    const Vec3 normal = plane ? plane->normal : frame.n;
    const Vec3 origin = plane ? plane->origin : frame.origin;
    Cut cut;
    cut.z = glm::dot(s.centre - origin, normal);
    cut.a = s.a + film;
    cut.b = s.b + film;
    const Vec3 foot = s.centre - cut.z * normal;
    Frame local = frame;
    if (plane && glm::dot(normal, frame.n) > atlas::kLogMapMinCos) {
        cut.centre = atlas::log_map(frame, foot, normal);
        local.n = normal;
        local.t = parallel_transport(frame.t, frame.n, normal);
        local.b = glm::cross(local.n, local.t);
    } else {
        cut.centre = Vec2(frame.to_local(foot));
    }
    const auto components = [&](const Vec3& v) {
        return Vec3{glm::dot(v, local.t), glm::dot(v, local.b), glm::dot(v, local.n)};
    };
    cut.e = components(s.e);
    cut.m = components(s.m);
    return cut;
}

/// Slope of a monotone cubic at a node from the slopes on both sides (Fritsch and Butland 1984).
double monotone_slope(double before, double after, double h_before, double h_after) {
    if (!(before * after > 0)) return 0;
    const double w1 = 2 * h_after + h_before, w2 = h_after + 2 * h_before;
    return (w1 + w2) / (w1 / before + w2 / after);
}

double hermite(double p0, double p1, double m0, double m1, double h, double f) {
    const double f2 = f * f, f3 = f2 * f;
    return p0 + (p1 - p0) * (3 * f2 - 2 * f3) + h * (m0 * (f3 - 2 * f2 + f) + m1 * (f3 - f2));
}

/// The skin of a branch between its nodes: node parameter 0 (tip) … n − 1 (root).
class Skin {
  public:
    Skin(const brush::Branch& branch, const Frame& frame, const NodePlanes* planes, double film) {
        const auto& sections = branch.sections;
        const auto plane = [&](std::size_t i) {
            return planes && i < planes->size() ? &(*planes)[i] : nullptr;
        };
        add_cap(sections.front(), frame, plane(0), film);
        for (std::size_t i = 0; i < sections.size(); ++i) {
            if (i > 0) steps_.push_back(glm::length(sections[i].centre - sections[i - 1].centre));
            nodes_.push_back(cut_of(sections[i], frame, plane(i), film));
        }
        for (double& h : steps_) h = std::max(h, 1e-9);
        set_slopes();
    }

    double end() const { return nodes_.empty() ? 0 : double(nodes_.size() - 1); }

    Cut at(double s) const {
        if (nodes_.size() == 1) return nodes_[0];
        const auto last = static_cast<int>(nodes_.size()) - 2;
        const int i = std::clamp(static_cast<int>(s), 0, last);
        const double f = std::clamp(s - i, 0.0, 1.0), h = steps_[i];
        const Cut &p = nodes_[i], &q = nodes_[i + 1];
        const Slope &g = slopes_[i], &k = slopes_[i + 1];
        Cut cut;
        cut.centre = {hermite(p.centre.x, q.centre.x, g.centre.x, k.centre.x, h, f),
                      hermite(p.centre.y, q.centre.y, g.centre.y, k.centre.y, h, f)};
        cut.z = hermite(p.z, q.z, g.z, k.z, h, f);
        cut.a = hermite(p.a, q.a, g.a, k.a, h, f);
        cut.b = hermite(p.b, q.b, g.b, k.b, h, f);
        cut.e = between(p.e, q.e, f);
        cut.m = between(p.m, q.m, f);
        return cut;
    }

  private:
    struct Slope {
        Vec2 centre{0};
        double z = 0, a = 0, b = 0;
    };

    /// Closes a blunt tip by half an ellipsoid.
    void add_cap(const brush::Section& tip, const Frame& frame, const brush::ContactPlane* plane,
                 double film) {
        const double r = std::sqrt((tip.a + film) * (tip.b + film));
        if (!(r > 1e-7)) return;
        static constexpr std::array<double, 5> kAhead{1, 0.98, 0.9, 0.7, 0.4};
        for (std::size_t k = 0; k < kAhead.size(); ++k) {
            brush::Section ring = tip;
            const double shrink = std::sqrt(1 - kAhead[k] * kAhead[k]);
            ring.centre += kAhead[k] * r * tip.tangent;
            nodes_.push_back(cut_of(ring, frame, plane, film));
            nodes_.back().a *= shrink;
            nodes_.back().b *= shrink;
            steps_.push_back((kAhead[k] - (k + 1 < kAhead.size() ? kAhead[k + 1] : 0)) * r);
        }
    }

    static Vec3 between(const Vec3& p, const Vec3& q, double f) {
        const Vec3 v = (1 - f) * p + f * q;
        const double length = glm::length(v);
        return length > 1e-9 ? v / length : p;
    }

    void set_slopes() {
        const std::size_t n = nodes_.size();
        slopes_.resize(n);
        const auto rate = [&](std::size_t i, auto get) {
            return (get(nodes_[i + 1]) - get(nodes_[i])) / steps_[i];
        };
        const auto z = [](const Cut& c) { return c.z; };
        const auto a = [](const Cut& c) { return c.a; };
        const auto b = [](const Cut& c) { return c.b; };
        const auto centre = [](const Cut& c) { return c.centre; };
        for (std::size_t i = 0; i < n && n > 1; ++i) {
            if (i == 0 || i == n - 1) {
                const std::size_t j = i == 0 ? 0 : n - 2;
                slopes_[i] = {rate(j, centre), rate(j, z), rate(j, a), rate(j, b)};
                continue;
            }
            const double h0 = steps_[i - 1], h1 = steps_[i];
            const auto slope = [&](auto get) {
                return monotone_slope(rate(i - 1, get), rate(i, get), h0, h1);
            };
            slopes_[i] = {(h1 * rate(i - 1, centre) + h0 * rate(i, centre)) / (h0 + h1), slope(z),
                          slope(a), slope(b)};
        }
    }

    std::vector<Cut> nodes_;
    std::vector<double> steps_;
    std::vector<Slope> slopes_;
};

/// Part [begin, end] of the skin that touches the surface.
struct Stretch {
    double begin = 0, end = 0;
};

/// Parameter between `out` (not touching) and `in` (touching) where the skin meets the surface.
double meeting(const Skin& skin, double out, double in) {
    for (int i = 0; i < 26; ++i) {
        const double middle = 0.5 * (out + in);
        (skin.at(middle).overlap() >= 0 ? in : out) = middle;
    }
    return in;
}

std::vector<Stretch> touching_stretches(const Skin& skin) {
    std::vector<Stretch> found;
    const int n = static_cast<int>(skin.end()) * kSearchSteps;
    bool before = false;
    for (int i = 0; i <= n; ++i) {
        const double s = double(i) / kSearchSteps;
        const bool now = skin.at(s).overlap() >= 0;
        if (now && !before)
            found.push_back({i == 0 ? 0 : meeting(skin, double(i - 1) / kSearchSteps, s), s});
        if (now) found.back().end = s;
        if (!now && before) found.back().end = meeting(skin, s, double(i - 1) / kSearchSteps);
        before = now;
    }
    return found;
}

const std::array<Vec2, kDirections>& directions() {
    static const auto table = [] {
        std::array<Vec2, kDirections> t;
        for (int k = 0; k < kDirections; ++k)
            t[k] = {std::cos(2 * kPi * k / kDirections), std::sin(2 * kPi * k / kDirections)};
        return t;
    }();
    return table;
}

/// Corners of the shadow of the part of a section that lies below the surface, in order:
/// first and last are its cut points Q±, unless all of it lies below.
void shadow(const Cut& cut, std::vector<Vec2>& corners) {
    corners.clear();
    const double p = cut.a * cut.e.z, q = cut.b * cut.m.z, height = std::sqrt(p * p + q * q);
    const double level =
        height > 0 ? std::clamp(-cut.z / height, -1.0, 1.0) : (cut.z <= 0 ? 1 : -1);
    const double cos_f = height > 0 ? p / height : 1, sin_f = height > 0 ? q / height : 0;
    const double sin_l = std::sqrt(std::max(0.0, 1 - level * level));
    // Q± at φ ± acos(level); below the surface is what lies between them on the far side.
    const Vec2 from{cos_f * level - sin_f * sin_l, sin_f * level + cos_f * sin_l};
    const Vec2 to{cos_f * level + sin_f * sin_l, sin_f * level - cos_f * sin_l};
    if (level < 1) corners.push_back(cut.at(from.x, from.y));
    const auto below = [&](int k) {
        const Vec2& w = directions()[k];
        return level >= 1 || w.x * cos_f + w.y * sin_f < level;
    };
    // They are taken in order from Q+ on: from where those below the surface begin.
    int first = 0;
    while (first < kDirections && !(below(first) && !below((first + kDirections - 1) % kDirections)))
        ++first;
    if (first == kDirections)
        first = static_cast<int>(std::ceil(std::atan2(from.y, from.x) * kDirections / (2 * kPi))) +
                kDirections;
    for (int k = 0; k < kDirections; ++k) {
        const int at = (first + k) % kDirections;
        if (below(at)) corners.push_back(cut.at(directions()[at].x, directions()[at].y));
    }
    if (level < 1) corners.push_back(cut.at(to.x, to.y));
}

Vec2 unit_or(const Vec2& v, const Vec2& other) {
    const double length = glm::length(v);
    return length > 1e-12 ? v / length : other;
}

/// Direction of the footprint from tail to tip: from end to end of the touching spine; for
/// one that stands, the trace of its bending plane.
Vec2 forward_direction(const std::vector<Cut>& cuts) {
    const Vec2 run = cuts.front().centre - cuts.back().centre;
    Vec2 side{0};
    double width = 0;
    for (const Cut& c : cuts) {
        side += Vec2(c.e);
        width += c.a / double(cuts.size());
    }
    Vec2 across = unit_or({side.y, -side.x}, {0, 0});
    if (glm::dot(across, run) < 0) across = -across;
    return unit_or(run + 0.25 * width * across, {1, 0});
}

/// Upper and lower edge of a region over evenly turned abscissae between its two ends.
class Envelope {
  public:
    Envelope(double lo, double hi, int n) : x_(n), top_(n, -kFar), bottom_(n, kFar) {
        for (int j = 0; j < n; ++j)
            x_[j] = 0.5 * (lo + hi) - 0.5 * (hi - lo) * std::cos(kPi * (j + 1) / (n + 1));
    }

    void add(Vec2 p, Vec2 q) {
        if (p.x > q.x) std::swap(p, q);
        const int n = static_cast<int>(x_.size());
        while (at_ > 0 && x_[at_ - 1] >= p.x) --at_;
        while (at_ < n && x_[at_] < p.x) ++at_;
        for (int j = at_; j < n && x_[j] <= q.x; ++j) {
            const double f = q.x > p.x ? (x_[j] - p.x) / (q.x - p.x) : 0;
            const double y = p.y + f * (q.y - p.y);
            top_[j] = std::max(top_[j], y);
            bottom_[j] = std::min(bottom_[j], y);
        }
    }

    bool covered(int j) const { return top_[j] >= bottom_[j]; }
    Vec2 top(int j) const { return {x_[j], top_[j]}; }
    Vec2 bottom(int j) const { return {x_[j], bottom_[j]}; }

  private:
    static constexpr double kFar = 1e9;
    std::vector<double> x_, top_, bottom_;
    int at_ = 0;
};

/// Solves (c[k-1] + 4 c[k] + c[k+1]) / 6 = p[k], cyclic, by elimination with one bordering
/// unknown (the last).
std::vector<Vec2> spline_control(const std::vector<Vec2>& p) {
    const int n = static_cast<int>(p.size());
    if (n < 3) return p;
    // Rows 0 … n−2 with c[n−1] moved to the right: c = y − c[n−1] w.
    std::vector<double> diagonal(n - 1, 4), w(n - 1, 0);
    std::vector<Vec2> y(p.begin(), p.end() - 1);
    for (Vec2& v : y) v *= 6;
    w[0] += 1;
    w[n - 2] += 1;
    for (int k = 1; k < n - 1; ++k) {
        const double f = 1 / diagonal[k - 1];
        diagonal[k] -= f;
        w[k] -= f * w[k - 1];
        y[k] -= f * y[k - 1];
    }
    for (int k = n - 2; k >= 0; --k) {
        if (k < n - 2) {
            w[k] -= w[k + 1];
            y[k] -= y[k + 1];
        }
        w[k] /= diagonal[k];
        y[k] /= diagonal[k];
    }
    std::vector<Vec2> c(n);
    c[n - 1] = (6.0 * p[n - 1] - y[0] - y[n - 2]) / (4 - w[0] - w[n - 2]);
    for (int k = 0; k < n - 1; ++k) c[k] = y[k] - w[k] * c[n - 1];
    return c;
}

Outline stretch_outline(const Skin& skin, const Stretch& stretch, int points) {
    std::vector<Cut> cuts(kSamples);
    for (int k = 0; k < kSamples; ++k) {
        const double f = 0.5 - 0.5 * std::cos(kPi * k / (kSamples - 1));
        cuts[k] = skin.at(stretch.begin + f * (stretch.end - stretch.begin));
    }
    const Vec2 forward = forward_direction(cuts), left{-forward.y, forward.x};
    const Vec2 middle = cuts[kSamples / 2].centre;
    std::vector<std::vector<Vec2>> shadows(kSamples);
    Vec2 front{-1e9, 0}, rear{1e9, 0};
    for (int k = 0; k < kSamples; ++k) {
        shadow(cuts[k], shadows[k]);
        for (Vec2& q : shadows[k]) {
            q = {glm::dot(q - middle, forward), glm::dot(q - middle, left)};
            if (q.x > front.x) front = q;
            if (q.x < rear.x) rear = q;
        }
    }
    Envelope envelope(rear.x, front.x, points);
    const auto by_y = [](const Vec2& a, const Vec2& b) { return a.y < b.y; };
    for (int k = 0; k < kSamples; ++k) {
        const auto& s = shadows[k];
        for (std::size_t i = 0; i < s.size(); ++i) envelope.add(s[i], s[(i + 1) % s.size()]);
        if (k == 0) continue;
        const auto [low, high] = std::minmax_element(s.begin(), s.end(), by_y);
        const auto& r = shadows[k - 1];
        const auto [low_before, high_before] = std::minmax_element(r.begin(), r.end(), by_y);
        envelope.add(*low_before, *low);
        envelope.add(*high_before, *high);
    }
    const auto to_stamp = [&](const Vec2& q) { return middle + q.x * forward + q.y * left; };
    Outline outline;
    outline.tip = to_stamp(front);
    outline.tail = to_stamp(rear);
    for (int j = points - 1; j >= 0; --j) {
        if (!envelope.covered(j)) continue;
        outline.left.push_back(to_stamp(envelope.top(j)));
        outline.right.push_back(to_stamp(envelope.bottom(j)));
    }
    std::vector<Vec2> closed{outline.tip};
    closed.insert(closed.end(), outline.left.begin(), outline.left.end());
    closed.push_back(outline.tail);
    closed.insert(closed.end(), outline.right.rbegin(), outline.right.rend());
    outline.control = spline_control(closed);
    return outline;
}

}  // namespace

std::vector<NodePlanes> node_planes(const brush::TuftState& tuft,
                                    std::span<const brush::ContactPlane> planes) {
    const auto& branches = tuft.branches;
    if (planes.size() == 1) {
        std::vector<NodePlanes> same;
        for (const brush::Branch& b : branches) same.emplace_back(b.sections.size(), planes[0]);
        return same;
    }
    if (branches.size() == 1 && planes.size() >= branches[0].sections.size())
        return {NodePlanes(planes.begin(), planes.begin() + branches[0].sections.size())};
    if (branches.size() < 2) return {};
    // The middle branch ends in the whole spine's root; its outer nodes are the twig's.
    const std::size_t trunk = branches[branches.size() / 2].sections.size();
    const std::size_t twig = branches[0].sections.size();
    if (trunk < twig || planes.size() != trunk + branches.size() * twig) return {};
    std::vector<NodePlanes> dealt;
    for (std::size_t k = 0; k < branches.size(); ++k) {
        const auto own = planes.subspan(trunk + k * twig, twig);
        dealt.emplace_back(own.begin(), own.end());
        if (k != branches.size() / 2) continue;
        dealt.back().pop_back();
        dealt.back().insert(dealt.back().end(), planes.begin() + twig - 1, planes.begin() + trunk);
    }
    return dealt;
}

std::vector<Outline> outline(const brush::TuftState& tuft, const Frame& frame,
                             std::span<const NodePlanes> planes, const OutlineOptions& options) {
    std::vector<Outline> outlines;
    for (std::size_t k = 0; k < tuft.branches.size(); ++k) {
        if (tuft.branches[k].sections.size() < 2) continue;
        const Skin skin(tuft.branches[k], frame, k < planes.size() ? &planes[k] : nullptr,
                        std::max(options.film, 0.0));
        for (const Stretch& stretch : touching_stretches(skin)) {
            Outline o = stretch_outline(skin, stretch, std::max(options.points, 4));
            if (o.left.size() >= 3) outlines.push_back(std::move(o));
        }
    }
    return outlines;
}

std::vector<Vec2> curve_points(const Outline& outline, int per_span) {
    const auto& c = outline.control;
    const int n = static_cast<int>(c.size());
    std::vector<Vec2> points;
    if (n < 3) return points;
    points.reserve(static_cast<std::size_t>(n) * per_span);
    for (int k = 0; k < n; ++k) {
        const Vec2 &c0 = c[(k + n - 1) % n], &c1 = c[k], &c2 = c[(k + 1) % n], &c3 = c[(k + 2) % n];
        for (int i = 0; i < per_span; ++i) {
            const double f = double(i) / per_span, g = 1 - f;
            points.push_back((g * g * g * c0 + (3 * f * f * f - 6 * f * f + 4) * c1 +
                              (3 * g * g * g - 6 * g * g + 4) * c2 + f * f * f * c3) /
                             6.0);
        }
    }
    return points;
}

}  // namespace tuft::footprint
