#include "stroke/gesture/bias_correction.h"

#include <algorithm>
#include <cmath>

#include "core/cubic.h"
#include "core/error.h"

namespace tuft::stroke {
namespace {

constexpr int kPiecePoints = BiasPiece::kPoints;
constexpr double kPieceLength = 6e-3;  // metres, of a piece; neighbours overlap by half
constexpr int kMostPieces = 64;        // of one stroke
constexpr double kDot = 2e-4;          // metres: a shorter stroke goes by time
constexpr int kLike = 4;               // pieces that a correction comes from
constexpr double kRidge = 1e-3;        // pull of the linear map to the identity
constexpr int kPairings = 20;          // times the linear map is fitted to new pairs
constexpr double kMinRatio = 0.5, kMaxRatio = 2;
// Differences that make two pieces unlike: of shape over length, log of length, place, pressure, tilt.
constexpr double kShape = 0.12, kLength = 0.7, kPlace = 0.3, kPressure = 0.25, kTilt = 0.35;
constexpr double kTrust = 3;  // unlikeness at which a shift is no longer believed

struct Point {
    Vec2 position{0};
    double pressure = 0;
    Vec2 tilt{0};
};

// A flat stroke under a linear map, by parts of its arc length (a dot: of its time).
struct Path {
    std::vector<double> part;  // rises from 0 to 1
    std::vector<Point> points;
    double length = 0;
};

Path path_of(const RecordedStroke& trace, const glm::dmat2& linear, const Vec2& middle) {
    Path p;
    p.part.push_back(0);
    for (const StrokeSample& s : trace.samples) {
        p.points.push_back({linear * (Vec2(s.position) - middle), s.pressure, s.tilt});
        if (p.points.size() > 1) {
            const Point &a = p.points[p.points.size() - 2], &b = p.points.back();
            p.part.push_back(p.part.back() + glm::length(b.position - a.position));
        }
    }
    p.length = p.part.back();
    if (p.length < kDot) {
        const double start = trace.samples.front().time;
        for (std::size_t i = 0; i < p.part.size(); ++i) p.part[i] = std::max(0.0, trace.samples[i].time - start);
    }
    const double whole = p.part.back();
    for (double& x : p.part) x = whole > 0 ? x / whole : 0;
    return p;
}

Point at(const Path& p, double part) {
    const auto next = std::upper_bound(p.part.begin(), p.part.end(), part);
    if (next == p.part.begin()) return p.points.front();
    if (next == p.part.end()) return p.points.back();
    const std::size_t i = static_cast<std::size_t>(next - p.part.begin());
    const double w = (part - p.part[i - 1]) / (p.part[i] - p.part[i - 1]);
    const Point &a = p.points[i - 1], &b = p.points[i];
    return {a.position + w * (b.position - a.position), a.pressure + w * (b.pressure - a.pressure),
            a.tilt + w * (b.tilt - a.tilt)};
}

// Pieces of a stroke of this length: piece j spans [j, j + 2] / (n + 1) of it.
int n_clusters(double length) {
    const double n = std::round(2 * length / kPieceLength) - 1;
    return static_cast<int>(std::clamp(n, 1.0, static_cast<double>(kMostPieces)));
}

// What the writer did in piece j of n.
BiasPiece cut(const Path& path, int j, int n) {
    BiasPiece piece;
    const double h = 1.0 / (n + 1);
    piece.begin = j * h;
    piece.end = n == 1 ? 1 : (j + 2) * h;
    piece.length = path.length * (piece.end - piece.begin);
    Vec2 middle(0);
    for (int k = 0; k < kPiecePoints; ++k) {
        const Point p = at(path, piece.begin + (piece.end - piece.begin) * k / (kPiecePoints - 1.0));
        piece.shape[k] = p.position;
        piece.pressure[k] = p.pressure;
        piece.tilt[k] = p.tilt;
        middle += p.position / static_cast<double>(kPiecePoints);
    }
    for (Vec2& x : piece.shape) x = piece.length >= kDot ? (x - middle) / piece.length : Vec2(0);
    return piece;
}

// Control values c of the curve that minimises Σ (goal − curve · factor)² + weak pull to `rest`.
template <class V>
std::array<V, 4> fit_curve(const std::array<V, kPiecePoints>& goal, const std::array<double, kPiecePoints>& factor,
                           const V& rest) {
    constexpr double kPull = 1e-4;
    glm::dmat4 normal(0);
    std::array<V, 4> right{};
    double all = 1e-12;
    for (const double f : factor) all += f * f;
    for (int k = 0; k < kPiecePoints; ++k) {
        const auto b = bernstein(k / (kPiecePoints - 1.0));
        for (int r = 0; r < 4; ++r) {
            right[r] += (b[r] * factor[k]) * (goal[k] - rest * factor[k]);
            for (int c = 0; c < 4; ++c) normal[c][r] += b[r] * b[c] * factor[k] * factor[k];
        }
    }
    for (int r = 0; r < 4; ++r) normal[r][r] += kPull * all;
    const glm::dmat4 inverse = glm::inverse(normal);
    std::array<V, 4> out;
    out.fill(rest);
    for (int r = 0; r < 4; ++r)
        for (int c = 0; c < 4; ++c) out[r] += inverse[c][r] * right[c];
    return out;
}

void learn_piece(BiasPiece& piece, const Path& written, const Path& intended) {
    std::array<double, kPiecePoints> goal_pressure{}, ones{};
    std::array<Vec2, kPiecePoints> shift{}, tilt{};
    ones.fill(1);
    for (int k = 0; k < kPiecePoints; ++k) {
        const double part = piece.begin + (piece.end - piece.begin) * k / (kPiecePoints - 1.0);
        const Point w = at(written, part), i = at(intended, part);
        goal_pressure[k] = i.pressure;
        shift[k] = i.position - w.position;
        tilt[k] = i.tilt - w.tilt;
    }
    piece.pressure_ratio = fit_curve(goal_pressure, piece.pressure, 1.0);
    for (double& r : piece.pressure_ratio) r = std::clamp(r, kMinRatio, kMaxRatio);
    piece.shift = fit_curve(shift, ones, Vec2(0));
    piece.tilt_change = fit_curve(tilt, ones, Vec2(0));
}

// Square of how unlike two pieces are; 1 is a clear difference.
double unlike(const BiasPiece& a, const BiasPiece& b) {
    double shape = 0, pressure = 0, tilt = 0;
    for (int k = 0; k < kPiecePoints; ++k) {
        const Vec2 s = a.shape[k] - b.shape[k], t = a.tilt[k] - b.tilt[k];
        const double p = a.pressure[k] - b.pressure[k];
        shape += glm::dot(s, s), tilt += glm::dot(t, t), pressure += p * p;
    }
    const auto square = [](double x) { return x * x; };
    return (shape / square(kShape) + pressure / square(kPressure) + tilt / square(kTilt)) / kPiecePoints +
           square(std::log(std::max(a.length, kDot) / std::max(b.length, kDot)) / kLength) +
           (square(a.begin - b.begin) + square(a.end - b.end)) / square(kPlace);
}

// Gives a piece the corrections of the learned pieces most like it.
void correct(BiasPiece& piece, const BiasCorrection& bias) {
    std::vector<std::pair<double, std::size_t>> near;
    near.reserve(bias.pieces.size());
    for (std::size_t i = 0; i < bias.pieces.size(); ++i) near.emplace_back(unlike(piece, bias.pieces[i]), i);
    const std::size_t n = std::min<std::size_t>(kLike, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(n), near.end());
    if (n == 0) return;
    const double trust = std::exp(-0.5 * near[0].first / (kTrust * kTrust));
    double sum = 0;
    piece.pressure_ratio.fill(0);
    for (std::size_t i = 0; i < n; ++i) {
        const double w = std::exp(-0.5 * (near[i].first - near[0].first));
        const BiasPiece& from = bias.pieces[near[i].second];
        sum += w;
        for (int k = 0; k < 4; ++k) {
            piece.pressure_ratio[k] += w * from.pressure_ratio[k];
            piece.shift[k] += w * trust * from.shift[k];
            piece.tilt_change[k] += w * from.tilt_change[k];
        }
    }
    for (int k = 0; k < 4; ++k) {
        piece.pressure_ratio[k] /= sum;
        piece.shift[k] /= sum;
        piece.tilt_change[k] /= sum;
    }
}

bool together(const RecordedStroke& a, const RecordedStroke& b) {
    return a.placement.origin == b.placement.origin && a.placement.right == b.placement.right &&
           a.placement.down == b.placement.down;
}

// First stroke of every group, and the number of strokes at the end.
std::vector<std::size_t> groups_of(std::span<const RecordedStroke> traces) {
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < traces.size(); ++i)
        if (i == 0 || !together(traces[i - 1], traces[i])) starts.push_back(i);
    starts.push_back(traces.size());
    return starts;
}

// Middle of the strokes [first, last), weighted by length (dots a little), of flat ones.
Vec2 middle_of(std::span<const RecordedStroke> traces) {
    Vec2 sum(0);
    double weight = 0;
    for (const RecordedStroke& t : traces) {
        if (!t.flat || t.samples.empty()) continue;
        const Path p = path_of(t, glm::dmat2(1), Vec2(0));
        const double w = std::max(p.length, kDot) / kPiecePoints;
        for (int k = 0; k < kPiecePoints; ++k) {
            sum += w * at(p, k / (kPiecePoints - 1.0)).position;
            weight += w;
        }
    }
    return weight > 0 ? sum / weight : Vec2(0);
}

// The map within a stretch of [1/2, 2] in every direction: as much of it as that allows.
glm::dmat2 within_range(const glm::dmat2& m) {
    for (double share = 1; share > 1e-3; share *= 0.9) {
        const glm::dmat2 a = glm::dmat2(1) + share * (m - glm::dmat2(1));
        const double q = 0.5 * (glm::dot(a[0], a[0]) + glm::dot(a[1], a[1])), det = glm::determinant(a);
        const double root = std::sqrt(std::max(0.0, q * q - det * det));
        if (det > 0 && q + root <= kMaxRatio * kMaxRatio && q - root >= kMinRatio * kMinRatio) return a;
    }
    return glm::dmat2(1);
}

struct Pair {
    const RecordedStroke *written, *intended;
    Vec2 written_middle, intended_middle;
};

// Least squares over points paired by arc length, of deviations from the groups' mean offset.
glm::dmat2 fit_linear(std::span<const Pair> pairs) {
    constexpr int kSamples = 32;
    glm::dmat2 linear(1);
    for (int pass = 0; pass < kPairings; ++pass) {
        glm::dmat2 cross(0), scatter(0);
        for (const Pair& pair : pairs) {
            const Path w = path_of(*pair.written, linear, pair.written_middle);
            const Path i = path_of(*pair.intended, glm::dmat2(1), pair.intended_middle);
            const glm::dmat2 back = glm::inverse(linear);
            const double weight = std::max(w.length, kDot) / kSamples;
            for (int k = 0; k < kSamples; ++k) {
                const double part = k / (kSamples - 1.0);
                const Vec2 x = back * at(w, part).position, y = at(i, part).position;
                cross += weight * glm::outerProduct(y, x);
                scatter += weight * glm::outerProduct(x, x);
            }
        }
        const double pull = kRidge * (scatter[0][0] + scatter[1][1]);
        if (!(pull > 0)) return glm::dmat2(1);
        linear = within_range((cross + pull * glm::dmat2(1)) * glm::inverse(scatter + pull * glm::dmat2(1)));
    }
    return linear;
}

}  // namespace

BiasCorrection learn_bias(std::span<const RecordedStroke> intended, std::span<const RecordedStroke> written) {
    if (intended.size() != written.size())
        throw Error(Message("a bias correction is learned from pairs, but {} strokes are intended and {} written",
                            intended.size(), written.size()));
    if (written.empty()) throw Error("there are no strokes to learn a bias from");
    for (const auto& traces : {intended, written})
        for (const RecordedStroke& t : traces)
            if (!t.flat || t.samples.empty())
                throw Error("a bias correction is learned from flat strokes with samples only");

    std::vector<Pair> pairs;
    const std::vector<std::size_t> groups = groups_of(written);
    for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
        const std::size_t first = groups[g], count = groups[g + 1] - first;
        const Vec2 w = middle_of(written.subspan(first, count)), i = middle_of(intended.subspan(first, count));
        for (std::size_t k = first; k < first + count; ++k) pairs.push_back({&written[k], &intended[k], w, i});
    }
    BiasCorrection bias;
    bias.linear = fit_linear(pairs);
    for (const Pair& pair : pairs) {
        const Path w = path_of(*pair.written, bias.linear, pair.written_middle);
        const Path i = path_of(*pair.intended, glm::dmat2(1), pair.intended_middle);
        const int n = n_clusters(w.length);
        for (int j = 0; j < n; ++j) {
            BiasPiece piece = cut(w, j, n);
            learn_piece(piece, w, i);
            bias.pieces.push_back(piece);
        }
    }
    return bias;
}

std::vector<RecordedStroke> correct_bias(const BiasCorrection& bias, std::vector<RecordedStroke> traces) {
    const std::vector<std::size_t> groups = groups_of(traces);
    for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
        const Vec2 middle = middle_of(std::span(traces).subspan(groups[g], groups[g + 1] - groups[g]));
        for (std::size_t t = groups[g]; t < groups[g + 1]; ++t) {
            RecordedStroke& trace = traces[t];
            if (!trace.flat || trace.samples.empty()) continue;
            const Path path = path_of(trace, bias.linear, middle);
            const int n = n_clusters(path.length);
            std::vector<BiasPiece> pieces;
            for (int j = 0; j < n; ++j) {
                pieces.push_back(cut(path, j, n));
                correct(pieces.back(), bias);
            }
            for (std::size_t i = 0; i < trace.samples.size(); ++i) {
                double ratio = 0, sum = 0;
                Vec2 shift(0), tilt(0);
                for (int j = 0; j < n; ++j) {
                    const BiasPiece& piece = pieces[j];
                    const double x = (path.part[i] - piece.begin) / (piece.end - piece.begin);
                    if (x < 0 || x > 1) continue;
                    // Neighbours fade into each other.
                    const double w = std::max(1 - std::abs(2 * x - 1), 1e-9);
                    const auto b = bernstein(x);
                    sum += w;
                    for (int k = 0; k < 4; ++k) {
                        ratio += w * b[k] * piece.pressure_ratio[k];
                        shift += w * b[k] * piece.shift[k];
                        tilt += w * b[k] * piece.tilt_change[k];
                    }
                }
                StrokeSample& s = trace.samples[i];
                s.pressure = std::clamp(s.pressure * ratio / sum, 0.0, 1.0);
                s.position = Vec3(middle + path.points[i].position + shift / sum, s.position.z);
                s.tilt += tilt / sum;
            }
        }
    }
    return traces;
}

}  // namespace tuft::stroke
