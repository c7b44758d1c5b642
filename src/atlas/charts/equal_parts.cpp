#include "atlas/charts/equal_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "atlas/charts/tasks.h"

namespace tuft::atlas {
namespace {

constexpr double kStretch = 1.01;      // between equal parts, and its inverse
constexpr double kSmallStretch = 1.4;  // the same of small triangles, whose corners are rounded in files
constexpr double kSmall = 1e-5;        // of a part's area
constexpr double kFlat = 1e-12;        // squared area over fourth power of a side: shape unknown from floats
constexpr std::size_t kMostKinds = 8;  // kinds of equal area that a part is compared with
constexpr std::size_t kMostWork = 32;  // triangles compared for a pair of parts, over those of one
constexpr double kMostRatio = 1.02;    // of areas of equal parts and triangles

using Triangles = std::vector<std::uint32_t>;

/// One part and the triangle from which others are compared with it.
struct Part {
    Triangles triangles;
    std::size_t n_borders = 0;
    double area = 0;
    std::uint32_t seed = kNone;
};

double area_of(const mesh::TriangleMesh& mesh, std::uint32_t t) {
    const Vec3 a = mesh.position(t, 0);
    return 0.5 * glm::length(glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a));
}

/// The triangle whose area fewest others share, so that few have to be tried; of those the largest.
std::uint32_t find_seed(const mesh::TriangleMesh& mesh, const Triangles& triangles) {
    std::vector<std::pair<double, std::uint32_t>> by_area;
    by_area.reserve(triangles.size());
    for (const std::uint32_t t : triangles) by_area.emplace_back(area_of(mesh, t), t);
    std::sort(by_area.begin(), by_area.end());
    std::size_t least = by_area.size() + 1, first = 0, end = 0;
    std::uint32_t seed = triangles[0];
    for (std::size_t i = 0; i < by_area.size(); ++i) {
        while (by_area[first].first * kMostRatio < by_area[i].first) ++first;
        while (end < by_area.size() && by_area[end].first <= by_area[i].first * kMostRatio) ++end;
        if (end - first > least || !(by_area[i].first > 0)) continue;
        least = end - first;
        seed = by_area[i].second;
    }
    return seed;
}

struct Sides {
    double aa, ab, bb;  // dot products of two sides
    double squared_area() const { return aa * bb - ab * ab; }
};

Sides sides_of(const mesh::TriangleMesh& mesh, const std::array<std::uint32_t, 3>& corners) {
    const auto at = [&](int k) { return mesh.position(corners[k] / 3, static_cast<int>(corners[k] % 3)); };
    const Vec3 a = at(1) - at(0), b = at(2) - at(0);
    return {glm::dot(a, a), glm::dot(a, b), glm::dot(b, b)};
}

/// Whether the linear map between two triangles stretches by less than a factor.
bool equal_triangles(const Sides& p, const Sides& q, double factor) {
    const double most_square = factor * factor, least_square = 1 / most_square;
    const double longest = std::max(p.aa, p.bb), area = p.squared_area();
    if (!(area > kFlat * longest * longest)) {
        const double most = (most_square - 1) * longest;
        return std::abs(p.aa - q.aa) <= most && std::abs(p.bb - q.bb) <= most && std::abs(p.ab - q.ab) <= most;
    }
    const double mean = 0.5 * (p.bb * q.aa - 2 * p.ab * q.ab + p.aa * q.bb) / area;
    const double spread = std::sqrt(std::max(0.0, mean * mean - q.squared_area() / area));
    return mean - spread >= least_square && mean + spread <= most_square;
}

class PartMatcher {
  public:
    PartMatcher(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin, EqualParts& out)
        : mesh_(mesh), twin_(twin), out_(out) {}

    /// Finds which half-edge of the first corresponds to each of the other; false when the parts differ.
    bool match(const Part& first, const Part& other) {
        const double area = area_of(mesh_, first.seed);
        small_ = 4 * kSmall * kSmall * first.area * first.area;
        std::size_t work = kMostWork * other.triangles.size();
        for (const bool mirrored : {false, true})
            for (const std::uint32_t t : other.triangles) {
                const double own = area_of(mesh_, t);
                if (own > kMostRatio * area || area > kMostRatio * own) continue;
                for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
                    if (spread(3 * first.seed, h, mirrored, work)) return true;
                if (work == 0) return false;
            }
        return false;
    }

  private:
    /// Compares triangle by triangle from one pair of half-edges on; undone when two differ.
    bool spread(std::uint32_t of_first, std::uint32_t of_other, bool mirrored, std::size_t& work) {
        reached_.clear();
        bool equal = take(of_first, of_other, mirrored);
        for (std::size_t i = 0; i < reached_.size() && equal; ++i) {
            if (work == 0) equal = false;
            work -= work > 0;
            for (std::uint32_t h = 3 * reached_[i]; h < 3 * reached_[i] + 3 && equal; ++h) {
                const std::uint32_t g = twin_[h], s = twin_[out_.source[h]];
                if (g == kNone || s == kNone)
                    equal = g == s;
                else
                    equal = out_.source[g] == kNone ? take(s, g, mirrored) : out_.source[g] == s;
            }
        }
        if (!equal)
            for (const std::uint32_t t : reached_)
                for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) out_.source[h] = kNone;
        return equal;
    }

    bool take(std::uint32_t s, std::uint32_t h, bool mirrored) {
        const std::array<std::uint32_t, 3> own{h, next_half(h), prev_half(h)};
        const std::array<std::uint32_t, 3> corners =
            mirrored ? std::array{next_half(s), s, prev_half(s)} : std::array{s, next_half(s), prev_half(s)};
        const Sides first = sides_of(mesh_, corners);
        const double factor = first.squared_area() > small_ ? kStretch : kSmallStretch;
        if (!equal_triangles(first, sides_of(mesh_, own), factor)) return false;
        out_.source[h] = s;
        out_.source[next_half(h)] = mirrored ? prev_half(s) : next_half(s);
        out_.source[prev_half(h)] = mirrored ? next_half(s) : prev_half(s);
        out_.mirrored[h / 3] = mirrored;
        reached_.push_back(h / 3);
        return true;
    }

    const mesh::TriangleMesh& mesh_;
    std::span<const std::uint32_t> twin_;
    EqualParts& out_;
    Triangles reached_;
    double small_ = 0;  // squared area of a parallelogram of two sides
};

std::vector<Part> parts_of(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin) {
    std::vector<Part> parts;
    for (Triangles& triangles : connected_charts(twin)) {
        Part part;
        for (const std::uint32_t t : triangles) {
            part.area += area_of(mesh, t);
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) part.n_borders += twin[h] == kNone;
        }
        part.triangles = std::move(triangles);
        parts.push_back(std::move(part));
    }
    return parts;
}

std::vector<std::uint32_t> ranks(const EqualParts& parts) {
    std::vector<std::uint32_t> rank(parts.part.size(), kNone);
    for (std::uint32_t i = 0; i < parts.kept.size(); ++i) rank[parts.kept[i]] = i;
    return rank;
}

}  // namespace

EqualParts find_equal_parts(const mesh::TriangleMesh& mesh, std::span<const std::uint32_t> twin) {
    EqualParts out;
    std::vector<Part> parts = parts_of(mesh, twin);
    out.source.assign(twin.size(), kNone);
    out.part.resize(mesh.n_triangles());
    out.mirrored.assign(mesh.n_triangles(), 0);
    PartMatcher matcher(mesh, twin, out);
    using Counts = std::pair<std::size_t, std::size_t>;  // triangles, borders
    std::map<Counts, std::multimap<double, std::uint32_t>> kinds;
    for (std::uint32_t p = 0; p < parts.size(); ++p) {
        Part& part = parts[p];
        for (const std::uint32_t t : part.triangles) out.part[t] = p;
        auto& alike = kinds[{part.triangles.size(), part.n_borders}];
        bool known = false;
        std::size_t tried = 0;
        for (auto it = alike.lower_bound(part.area / kMostRatio);
             it != alike.end() && it->first <= part.area * kMostRatio && tried < kMostKinds && !known; ++it, ++tried) {
            Part& first = parts[it->second];
            if (first.seed == kNone) first.seed = find_seed(mesh, first.triangles);
            known = matcher.match(first, part);
        }
        if (known) continue;
        alike.emplace(part.area, p);
        for (const std::uint32_t t : part.triangles) {
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) out.source[h] = h;
            out.mirrored[t] = 0;
        }
        out.kept.insert(out.kept.end(), part.triangles.begin(), part.triangles.end());
    }
    std::sort(out.kept.begin(), out.kept.end());
    return out;
}

mesh::TriangleMesh kept_mesh(const mesh::TriangleMesh& mesh, const EqualParts& parts) {
    mesh::TriangleMesh kept;
    const std::vector<std::uint32_t> rank = ranks(parts);
    std::vector<std::uint32_t> vertex(mesh.n_vertices(), kNone);
    for (const std::uint32_t t : parts.kept) {
        std::array<std::uint32_t, 3> corners = mesh.triangles[t];
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& v = vertex[corners[k]];
            if (v == kNone) {
                v = static_cast<std::uint32_t>(kept.positions.size());
                kept.positions.push_back(mesh.positions[corners[k]]);
            }
            corners[k] = v;
            const std::uint32_t beside = mesh.neighbours[3 * std::size_t{t} + k];
            kept.neighbours.push_back(beside == kNone ? kNone : rank[beside]);
        }
        kept.triangles.push_back(corners);
    }
    for (const Vec3f& p : kept.positions) kept.bounds.add(Vec3(p));
    return kept;
}

CutMesh uncut_kept_mesh(const EqualParts& parts, std::span<const std::uint32_t> twin, double unit) {
    CutMesh cut;
    cut.unit = unit;
    const std::vector<std::uint32_t> rank = ranks(parts);
    std::vector<std::uint32_t> copies(parts.kept.size(), 0);
    for (std::size_t t = 0; t < parts.part.size(); ++t) ++copies[rank[parts.source[3 * t] / 3]];
    cut.copies = std::move(copies);
    cut.twin.reserve(3 * parts.kept.size());
    for (const std::uint32_t t : parts.kept)
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h)
            cut.twin.push_back(twin[h] == kNone ? kNone : 3 * rank[twin[h] / 3] + twin[h] % 3);
    return cut;
}

CutMesh with_copies(const mesh::TriangleMesh& mesh, const EqualParts& parts, std::vector<std::uint32_t> twin,
                    const CutMesh& kept) {
    CutMesh cut;
    cut.unit = kept.unit;
    cut.twin = std::move(twin);
    cut.place.resize(mesh.n_triangles());
    const std::vector<std::uint32_t> rank = ranks(parts);
    const auto in_kept = [&](std::uint32_t half) { return 3 * rank[half / 3] + half % 3; };
    cut.glued.resize(cut.twin.size());
    for (std::uint32_t h = 0; h < cut.glued.size(); ++h)
        cut.glued[h] = kept.glued[in_kept(parts.source[h])] == kNone ? kNone : cut.twin[h];

    std::vector<std::uint32_t> chart_of(parts.kept.size()), face_of(parts.kept.size());
    for (std::uint32_t c = 0; c < kept.charts.size(); ++c) {
        const std::vector<std::uint32_t>& triangles = kept.charts[c].mesh.triangles;
        for (std::uint32_t f = 0; f < triangles.size(); ++f) {
            chart_of[triangles[f]] = c;
            face_of[triangles[f]] = f;
        }
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, Triangles> charts;  // by chart of the kept mesh and part
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t)
        charts[{chart_of[rank[parts.source[3 * t] / 3]], parts.part[t]}].push_back(t);
    std::vector<std::pair<std::uint32_t, Triangles>> all;
    all.reserve(charts.size());
    for (auto& [key, triangles] : charts) all.emplace_back(key.first, std::move(triangles));
    cut.charts.resize(all.size());
    run_tasks(all.size(), [&](std::size_t i) {
        const FlatChart& from = kept.charts[all[i].first];
        FlatChart& chart = cut.charts[i];
        chart.l2 = from.l2;
        chart.worst = from.worst;
        chart.mesh = make_chart(mesh, cut.glued, std::move(all[i].second), cut.unit, cut.place);
        chart.uv.resize(chart.mesh.n_vertices());
        for (std::size_t f = 0; f < chart.mesh.faces.size(); ++f) {
            const std::uint32_t t = chart.mesh.triangles[f];
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t half = in_kept(parts.source[3 * t + k]);
                const std::uint32_t corner = parts.mirrored[t] ? next_half(half) : half;
                const Vec2& uv = from.uv[from.mesh.faces[face_of[corner / 3]][corner % 3]];
                chart.uv[chart.mesh.faces[f][k]] = parts.mirrored[t] ? Vec2(-uv.x, uv.y) : uv;
            }
        }
    });
    return cut;
}

}  // namespace tuft::atlas
