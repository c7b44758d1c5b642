#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/system/interrupt.h"
#include "core/text/units.h"
#include "writer/layout/feature_line.h"

/// Creases, found and followed by sections across them.
namespace tuft::writer {
namespace {

constexpr std::array<double, 4> kWindows{0.004, 0.008, 0.016, 0.032};  // metres
constexpr double kWidestWindow = 0.1;                                  // of the model's diagonal
constexpr int kHalf = 8;                                               // samples of a section in half a window
constexpr double kLeastBend = 12 * kDegree, kStillBend = 7 * kDegree;  // where a crease is found, and followed
constexpr double kOverBeside = 2.5, kStillOverBeside = 1.8;            // times the bend beside it
constexpr int kDirections = 12;                                        // in which sections are laid, in half a turn
constexpr double kMostShort = 0.25;  // of a step, by which the surface may lie short of it
constexpr std::size_t kMostPlaces = 20'000;

/// The surface in a plane through a place: directions of its faces at even steps to both sides.
struct Section {
    std::vector<double> angle;  ///< radians, from the normal towards the direction; [n]
    std::vector<double> x;      ///< metres along the direction; [n]
};

/// A bend of the surface in a section.
struct Bend {
    double x = 0;      ///< metres, its middle
    double angle = 0;  ///< radians, not negative
};

/// Ends where the surface does, or steps up or down by more than it leans.
Section section(const mesh::SurfaceQuery& query, const Vec3& place, const Vec3& normal, const Vec3& along, double half,
                double step) {
    const int n = static_cast<int>(std::ceil(half / step));
    std::array<Section, 2> sides;
    for (int side = 0; side < 2; ++side) {
        double height = 0;
        for (int i = side; i <= n; ++i) {
            const double x = (side ? -i : i) * step;
            const auto hit = query.ray(place + x * along + half * normal, -normal, 0, 2 * half);
            if (!hit || glm::dot(hit->face_normal, normal) <= 0) break;
            const double up = half - hit->distance;
            if (i > 0 && std::abs(up - height) > 2 * step) break;
            height = up;
            sides[side].x.push_back(x);
            sides[side].angle.push_back(
                std::atan2(glm::dot(hit->face_normal, along), glm::dot(hit->face_normal, normal)));
        }
    }
    Section all;
    all.x.assign(sides[1].x.rbegin(), sides[1].x.rend());
    all.angle.assign(sides[1].angle.rbegin(), sides[1].angle.rend());
    all.x.insert(all.x.end(), sides[0].x.begin(), sides[0].x.end());
    all.angle.insert(all.angle.end(), sides[0].angle.begin(), sides[0].angle.end());
    return all;
}

/// The bend within the window about sample `i`; nothing where it is less than `least`, or not `over` times that beside.
std::optional<Bend> bend_at(const Section& s, std::size_t i, double least, double over) {
    const auto m = static_cast<std::size_t>(kHalf);
    if (i < m || i + m >= s.x.size()) return std::nullopt;
    const double bend = s.angle[i + m] - s.angle[i - m];
    if (std::abs(bend) < least) return std::nullopt;
    const double before = i >= 3 * m ? std::abs(s.angle[i - m] - s.angle[i - 3 * m]) : 0;
    const double after = i + 3 * m < s.x.size() ? std::abs(s.angle[i + 3 * m] - s.angle[i + m]) : 0;
    if (std::abs(bend) < over * std::max(before, after)) return std::nullopt;
    // Over two windows: a bend that is wider than one has the same middle from all of it.
    const std::size_t reach = std::min({2 * m, i, s.x.size() - 1 - i});
    double sum = 0;
    for (std::size_t k = i - reach; k < i + reach; ++k)
        sum += 0.5 * (s.x[k] + s.x[k + 1]) * (s.angle[k + 1] - s.angle[k]);
    return Bend{sum / (s.angle[i + reach] - s.angle[i - reach]), std::abs(bend)};
}

/// A place on a crease.
struct CreasePlace {
    Vec3 position{0}, normal{0, 0, 1}, along{1, 0, 0};
    double angle = 0;
};

/// Finds and follows creases of one width of window.
class CreaseWalk {
  public:
    CreaseWalk(const mesh::SurfaceQuery& query, double window)
        : query_(query), step_(0.5 * window / kHalf), window_(window) {}

    /// The nearest place of a crease to a point of the surface.
    std::optional<CreasePlace> nearest(const mesh::SurfacePoint& from, double reach) const {
        const Frame frame = make_frame(from.position, from.face_normal);
        std::optional<Bend> best;
        Vec3 across{0};
        for (int k = 0; k < kDirections; ++k) {
            const double turn = std::numbers::pi * k / kDirections;
            const Vec3 along = std::cos(turn) * frame.t + std::sin(turn) * frame.b;
            const Section s = section(query_, from.position, from.face_normal, along, reach + 1.5 * window_, step_);
            for (std::size_t i = 0; i < s.x.size(); ++i) {
                const auto bend = bend_at(s, i, kLeastBend, kOverBeside);
                if (!bend || std::abs(bend->x) > reach || (best && std::abs(bend->x) >= std::abs(best->x))) continue;
                best = bend, across = along;
            }
        }
        if (!best) return std::nullopt;
        const auto at = query_.closest_point(from.position + best->x * across);
        CreasePlace place{at->position, from.face_normal, glm::cross(across, from.face_normal), best->angle};
        // The section through the place itself stands across the crease.
        for (int pass = 0; pass < 4; ++pass) {
            const auto ahead = next(place, 0.5 * window_), back = next(place, -0.5 * window_);
            if (!ahead || !back) break;
            place.along = glm::normalize(ahead->position - back->position);
            if (const auto again = next(place, 0)) place = *again;
        }
        return place;
    }

    /// The place a step on (metres; negative: back). Nothing where the crease has ended.
    std::optional<CreasePlace> next(const CreasePlace& from, double step) const {
        const Vec3 ahead = from.position + step * from.along;
        const auto near = query_.closest_point(ahead, window_);
        if (!near || std::abs(glm::dot(near->position - ahead, from.along)) > kMostShort * std::abs(step) + 1e-9)
            return std::nullopt;  // the surface ends
        const Vec3 across = glm::normalize(glm::cross(from.normal, from.along));
        const Section s = section(query_, near->position, from.normal, across, 1.5 * window_, step_);
        std::optional<Bend> best;
        double least = HUGE_VAL;  // metres between the middles of window and bend
        for (std::size_t i = 0; i < s.x.size(); ++i) {
            const auto bend = bend_at(s, i, kStillBend, kStillOverBeside);
            if (!bend || std::abs(bend->x) > 0.5 * window_ || std::abs(s.x[i] - bend->x) >= least) continue;
            best = bend;
            least = std::abs(s.x[i] - bend->x);
        }
        if (!best) return std::nullopt;
        const auto at =
            query_.ray(near->position + best->x * across + window_ * from.normal, -from.normal, 0, 2 * window_);
        if (!at) return std::nullopt;
        CreasePlace place{at->position, mean_normal(s, *best, from.normal, across), from.along, best->angle};
        const Vec3 gone = place.position - from.position;
        if (step != 0) place.along = glm::normalize(from.along + glm::normalize(step < 0 ? -gone : gone));
        place.along = glm::normalize(place.along - glm::dot(place.along, place.normal) * place.normal);
        return place;
    }

    /// Places from the one after `from` on; `closed`: they come back to it.
    std::vector<CreasePlace> follow(const CreasePlace& from, double sign, bool& closed) const {
        std::vector<CreasePlace> line;
        closed = false;
        const double step = 0.5 * window_;
        for (CreasePlace at = from; line.size() < kMostPlaces;) {
            check_interrupt();
            const auto on = next(at, sign * step);
            if (!on) break;
            if (line.size() > 8 && glm::distance(on->position, from.position) < 0.75 * step) {
                closed = true;
                break;
            }
            line.push_back(*on);
            at = *on;
        }
        return line;
    }

  private:
    /// Half-way between the directions of both sides.
    static Vec3 mean_normal(const Section& s, const Bend& bend, const Vec3& normal, const Vec3& across) {
        const auto near = std::ranges::lower_bound(s.x, bend.x) - s.x.begin();
        const auto last = static_cast<std::ptrdiff_t>(s.x.size()) - 1;
        const double a = s.angle[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(near - kHalf, 0, last))];
        const double b = s.angle[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(near + kHalf, 0, last))];
        const double mean = 0.5 * (a + b);
        return glm::normalize(std::cos(mean) * normal + std::sin(mean) * across);
    }

    const mesh::SurfaceQuery& query_;
    double step_, window_;  ///< metres
};

}  // namespace

std::optional<FeatureLine> crease_line(const mesh::SurfaceQuery& query, const Vec3& through, double reach) {
    const auto from = query.closest_point(through);
    if (!from) return std::nullopt;
    for (const double window : kWindows) {
        if (window > kWidestWindow * query.mesh().bounds.diagonal()) break;
        const CreaseWalk walk(query, window);
        const auto place = walk.nearest(*from, reach);
        if (!place) continue;
        bool closed = false;
        std::vector<CreasePlace> line = walk.follow(*place, 1, closed);
        line.insert(line.begin(), *place);
        if (!closed) {
            bool never = false;
            const std::vector<CreasePlace> back = walk.follow(*place, -1, never);
            line.insert(line.begin(), back.rbegin(), back.rend());
        }
        if (line.size() < 3) continue;
        FeatureLine out{.kind = LineKind::crease,
                        .away = glm::distance(place->position, through),
                        .angle = place->angle,
                        .over = window};
        out.path.closed = closed;
        for (const CreasePlace& p : line) {
            out.path.points.push_back(p.position);
            out.path.normals.push_back(p.normal);
        }
        return out;
    }
    return std::nullopt;
}

}  // namespace tuft::writer
