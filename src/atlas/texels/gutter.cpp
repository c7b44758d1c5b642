#include "atlas/texels/gutter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "atlas/texels/seams.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

/// A fit that is tried: its radius in texels and what keeps its squares small.
struct FitKind {
    double radius, stiffness;
};
// More reach, and less freedom, where the first finds too little.
constexpr std::array<FitKind, 3> kFits{{{2.4, 0.4}, {2.4, 1e6}, {3.0, 1e6}}};
constexpr double kOnEdge = 0.01;  // texels; an uncovered centre may lie that far inside
constexpr std::size_t kMaxTaps = 10;
constexpr double kMaxGain = 2.0;  // Σ |weight| of a fit that is trusted

/// One border edge of a chart: its own side and, unless the mesh ends there, the other.
/// Local coordinates: x along the edge, y out of the chart, in texels of this chart.
struct Border {
    Vec2 start{0}, along{1, 0}, out{0, 1};  ///< in the atlas, texels; unit vectors
    double length = 0;                      ///< texels
    std::uint32_t chart = 0;
    bool has_other = false;
    Vec2 other_start{0}, other_along{1, 0}, other_in{0, 1};
    double along_scale = 1, in_scale = 1;  ///< texels there per texel here
    double shear = 0;                      ///< texels along there per texel out here
    std::uint32_t other_chart = 0;

    Vec2 to_atlas(const Vec2& xy) const { return start + xy.x * along + xy.y * out; }
    Vec2 local(const Vec2& uv) const { return {glm::dot(uv - start, along), glm::dot(uv - start, out)}; }
    Vec2 to_other(const Vec2& xy) const {
        return other_start + (xy.x * along_scale + xy.y * shear) * other_along + xy.y * in_scale * other_in;
    }
    Vec2 from_other(const Vec2& uv) const {
        const double y = glm::dot(uv - other_start, other_in) / in_scale;
        return {(glm::dot(uv - other_start, other_along) - y * shear) / along_scale, y};
    }
};

Vec2 corner(const Atlas& atlas, std::uint32_t triangle, int k) {
    return corner_texels(atlas, triangle, k % 3);
}

/// Unit normal of the edge from p to q that points away from `inside`.
Vec2 away_from(const Vec2& p, const Vec2& q, const Vec2& inside) {
    const Vec2 d = q - p;
    const double length = glm::length(d);
    const Vec2 n = length > 0 ? Vec2{d.y, -d.x} / length : Vec2{1, 0};
    return glm::dot(n, inside - p) > 0 ? -n : n;
}

Border make_border(const Atlas& atlas, std::uint32_t triangle, int k) {
    Border border;
    const Vec2 p = corner(atlas, triangle, k), q = corner(atlas, triangle, k + 1);
    border.start = p;
    border.length = glm::length(q - p);
    if (border.length > 0) border.along = (q - p) / border.length;
    border.out = away_from(p, q, corner(atlas, triangle, k + 2));
    border.chart = atlas.triangle_chart[triangle];
    return border;
}

/// A triangle's image of the texel step across its edge: metres along the edge and square to it.
struct Across {
    double slant = 0, height = 0;
};

/// `third` is the corner off the edge, in texels along and across; `from` and `to` end the edge.
Across across(const mesh::TriangleMesh& mesh, std::uint32_t triangle, int from, int to, const Vec2& third,
              double metres_per_texel) {
    const Vec3 p = mesh.position(triangle, from), e = glm::normalize(mesh.position(triangle, to) - p);
    const Vec3 d = mesh.position(triangle, 3 - from - to) - p;
    const double along = glm::dot(d, e), height = glm::length(d - along * e);
    return {(along - third.x * metres_per_texel) / third.y, height / std::abs(third.y)};
}

/// A side of an edge: a triangle and the corners that the edge goes between.
struct EdgeSide {
    std::uint32_t triangle;
    int from, to;
};

/// Unfolds the other side over the edge; its corner `from` lies at the start of this border.
/// The map between both pictures is that of the two triangles laid flat.
void join_other(const mesh::TriangleMesh& mesh, const Atlas& atlas, const EdgeSide& own, const EdgeSide& opposite,
                Border& border) {
    const auto [triangle, k, next] = own;
    const auto [other, from, to] = opposite;
    const Vec2 p = corner(atlas, other, from), q = corner(atlas, other, to);
    const Vec2 r = corner(atlas, other, 3 - from - to);
    const double length = glm::length(q - p);
    const double edge = glm::length(mesh.position(triangle, k) - mesh.position(triangle, next));
    if (!(length > 0) || !(border.length > 0) || !(edge > 0)) return;
    border.has_other = true;
    border.other_start = p;
    border.other_along = (q - p) / length;
    border.other_in = -away_from(p, q, r);
    border.other_chart = atlas.triangle_chart[other];
    border.along_scale = std::clamp(length / border.length, 0.125, 8.0);
    const Vec2 third = border.local(corner(atlas, triangle, k + 2));
    const Vec2 other_third{glm::dot(r - p, border.other_along), glm::dot(r - p, border.other_in)};
    border.in_scale = border.along_scale;
    if (!(std::abs(third.y) > 1e-6) || !(std::abs(other_third.y) > 1e-6)) return;
    const Across here = across(mesh, triangle, k, next, third, edge / border.length);
    const Across there = across(mesh, other, from, to, other_third, edge / length);
    const double in_scale = here.height / there.height;
    const double shear = (here.slant - there.slant * in_scale) * length / edge;
    if (!(in_scale > 0.125 && in_scale < 8 && std::abs(shear) < 4)) return;  // slivers
    border.in_scale = in_scale;
    border.shear = shear;
}

bool finite(const Border& b) {
    return std::isfinite(b.start.x + b.start.y + b.along.x + b.along.y + b.length);
}

std::vector<Border> find_borders(const mesh::TriangleMesh& mesh, const Atlas& atlas) {
    std::vector<Border> borders;
    for (const SeamEdge& e : find_seams(mesh, atlas)) {
        const int next_a = (e.corner_a + 1) % 3, next_b = (e.corner_b + 1) % 3;
        Border a = make_border(atlas, e.triangle_a, e.corner_a);
        join_other(mesh, atlas, {e.triangle_a, e.corner_a, next_a}, {e.triangle_b, next_b, e.corner_b}, a);
        Border b = make_border(atlas, e.triangle_b, e.corner_b);
        join_other(mesh, atlas, {e.triangle_b, e.corner_b, next_b}, {e.triangle_a, next_a, e.corner_a}, b);
        borders.push_back(a);
        borders.push_back(b);
    }
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) {
        for (int k = 0; k < 3; ++k) {
            if (mesh.neighbours[3 * std::size_t{t} + k] == kNone) borders.push_back(make_border(atlas, t, k));
        }
    }
    std::erase_if(borders, [](const Border& b) { return !finite(b); });
    return borders;
}

/// A covered texel that a gutter texel may take from, at its place beside the border.
struct Candidate {
    std::uint32_t texel;
    Vec2 offset;  ///< from the gutter texel, texels
    double fade;  ///< (1 − d²/r²)²
};

/// Where to look for candidates; lengths in texels.
struct CandidateSearch {
    std::uint32_t chart = kNone;
    Vec2 centre{0};     ///< on the chart
    double reach = 0;   ///< radius round `centre`
    Vec2 target{0};     ///< the gutter texel
    double radius = 0;  ///< round `target`, of the mapped candidates
};

/// Adds the covered texels of the chart within `reach` of `centre` that `place` maps to within `radius` of `target`.
template <class Place>
void collect(const TexelMap& map, const CandidateSearch& search, Place&& place, std::vector<Candidate>& found) {
    const auto& [chart, centre, reach, target, radius] = search;
    const auto x0 = static_cast<std::int64_t>(std::floor(centre.x - reach));
    const auto x1 = static_cast<std::int64_t>(std::floor(centre.x + reach));
    const auto y0 = static_cast<std::int64_t>(std::floor(centre.y - reach));
    const auto y1 = static_cast<std::int64_t>(std::floor(centre.y + reach));
    for (std::int64_t y = y0; y <= y1; ++y) {
        for (std::int64_t x = x0; x <= x1; ++x) {
            const TexelRef ref = texel_ref(map, x, y);
            if (!ref.valid()) continue;
            const std::uint8_t cluster = map.tiles[ref.slot].cluster[ref.texel];
            if (map.cluster_chart[map.cluster_start[ref.slot] + cluster] != chart) continue;
            const Vec2 d = place(Vec2(double(x) + 0.5, double(y) + 0.5)) - target;
            const double q = 1 - glm::dot(d, d) / (radius * radius);
            if (q <= 0) continue;
            const std::uint32_t texel = ref.slot * kTileTexels + ref.texel;
            const auto same = [&](const Candidate& c) { return c.texel == texel; };
            if (std::none_of(found.begin(), found.end(), same)) found.push_back({texel, d, q * q});
        }
    }
}

/// Weights of the fit at the gutter texel: fade · P (Pᵀ fade P + Λ)⁻¹ e₁ with the rows of P
/// (1, x, y, x², xy, y²) and Λ = stiffness on the squares, so that few texels still hold a
/// linear function and many a quadratic one. False where they do not hold one.
bool fit_weights(const std::vector<Candidate>& c, double stiffness, std::vector<double>& weights) {
    constexpr int kN = 6;
    double m[kN][kN + 1] = {};
    const auto basis = [](const Vec2& p) {
        return std::array<double, kN>{1, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y};
    };
    for (const Candidate& k : c) {
        const auto v = basis(k.offset);
        for (int i = 0; i < kN; ++i) {
            for (int j = 0; j < kN; ++j) m[i][j] += k.fade * v[i] * v[j];
        }
    }
    const double det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    if (!(det > 1e-3 * m[0][0] * m[0][0] * m[0][0])) return false;
    for (int i = 3; i < kN; ++i) m[i][i] += stiffness;
    m[0][kN] = 1;
    // Symmetric and positive: elimination needs no pivots.
    for (int i = 0; i < kN; ++i) {
        for (int r = i + 1; r < kN; ++r) {
            const double f = m[r][i] / m[i][i];
            for (int j = i; j <= kN; ++j) m[r][j] -= f * m[i][j];
        }
    }
    std::array<double, kN> x{};
    for (int i = kN - 1; i >= 0; --i) {
        x[i] = m[i][kN];
        for (int j = i + 1; j < kN; ++j) x[i] -= m[i][j] * x[j];
        x[i] /= m[i][i];
    }
    double gain = 0;
    weights.clear();
    for (const Candidate& k : c) {
        const auto v = basis(k.offset);
        double w = 0;
        for (int i = 0; i < kN; ++i) w += x[i] * v[i];
        weights.push_back(k.fade * w);
        gain += std::abs(weights.back());
    }
    return gain <= kMaxGain;
}

/// Borders of one chart near a gutter texel, the nearest first: at a chart's corner the
/// surface goes on over both edges.
struct Near {
    static constexpr int kMax = 3;
    std::array<std::uint32_t, kMax> border{kNone, kNone, kNone};
    std::array<float, kMax> distance{};  ///< squared, texels²
};

/// Scratch memory of `find_taps`; one per thread.
struct TapScratch {
    std::vector<Candidate> found;
    std::vector<double> weights;
};

/// Adds the taps of one gutter texel at `uv`.
void find_taps(const TexelMap& map, const std::vector<Border>& borders, const Near& near, const Vec2& uv,
               TapScratch& scratch, std::vector<GutterTap>& taps) {
    auto& [found, weights] = scratch;
    const std::uint32_t chart = borders[near.border[0]].chart;
    for (const auto& [radius, stiffness] : kFits) {
        found.clear();
        collect(
            map, {chart, uv, radius, uv, radius}, [](const Vec2& p) { return p; }, found);
        for (const std::uint32_t k : near.border) {
            if (k == kNone || borders[k].chart != chart || !borders[k].has_other) continue;
            const Border& border = borders[k];
            const double stretch = std::max({border.along_scale, border.in_scale, 1.0}) + std::abs(border.shear);
            collect(
                map, {border.other_chart, border.to_other(border.local(uv)), radius * stretch, uv, radius},
                [&](const Vec2& p) { return border.to_atlas(border.from_other(p)); }, found);
        }
        std::stable_sort(found.begin(), found.end(),
                         [](const Candidate& a, const Candidate& b) { return a.fade > b.fade; });
        if (found.size() > kMaxTaps) found.resize(kMaxTaps);
        if (!fit_weights(found, stiffness, weights)) continue;
        for (std::size_t k = 0; k < found.size(); ++k) taps.push_back({found[k].texel, static_cast<float>(weights[k])});
        return;
    }
    // Nothing holds a linear function (the mesh ends here, or a sliver): a mean.
    double sum = 0;
    for (const Candidate& c : found) sum += c.fade;
    for (const Candidate& c : found) taps.push_back({c.texel, static_cast<float>(c.fade / sum)});
}

/// Nearest texel of the chart itself, for places further out than the fit reaches.
void take_nearest(const TexelMap& map, const Border& border, const Vec2& uv, std::vector<GutterTap>& taps) {
    const Vec2 local = border.local(uv);
    const Vec2 foot = border.start + std::clamp(local.x, 0.0, border.length) * border.along;
    TexelRef best;
    double distance = 9;
    for (int dy = -3; dy <= 3; ++dy) {
        for (int dx = -3; dx <= 3; ++dx) {
            const auto x = static_cast<std::int64_t>(std::floor(foot.x)) + dx;
            const auto y = static_cast<std::int64_t>(std::floor(foot.y)) + dy;
            const TexelRef ref = texel_ref(map, x, y);
            const Vec2 d = Vec2(double(x) + 0.5, double(y) + 0.5) - foot;
            if (!ref.valid() || glm::dot(d, d) >= distance) continue;
            best = ref;
            distance = glm::dot(d, d);
        }
    }
    if (best.valid()) taps.push_back({best.slot * kTileTexels + best.texel, 1});
}

/// Puts border `b` into its place among the near ones; of those that lead the same way over
/// the same seam only the nearest stays.
void insert(const std::vector<Border>& borders, std::uint32_t b, float distance, Near& near) {
    const auto same_seam = [&](std::uint32_t k) {
        return borders[k].chart == borders[b].chart && borders[k].has_other == borders[b].has_other &&
               borders[k].other_chart == borders[b].other_chart && glm::dot(borders[k].out, borders[b].out) > 0.5;
    };
    int last = Near::kMax - 1;  // the one to be replaced
    for (int k = 0; k < Near::kMax; ++k) {
        if (near.border[k] == kNone) {
            last = std::min(last, k);
        } else if (same_seam(near.border[k])) {
            if (near.distance[k] <= distance) return;
            last = k;
            break;
        }
    }
    if (near.border[last] != kNone && near.distance[last] <= distance) return;
    for (; last > 0 && distance < near.distance[last - 1]; --last) {
        near.border[last] = near.border[last - 1];
        near.distance[last] = near.distance[last - 1];
    }
    near.border[last] = b;
    near.distance[last] = distance;
}

/// Borders near each uncovered texel of the rows [row, row + kTile).
void find_near(const TexelMap& map, const std::vector<Border>& borders, std::span<const std::uint32_t> members,
               std::int64_t row, double width, std::vector<Near>& near) {
    const std::int64_t size = map.size;
    near.assign(static_cast<std::size_t>(size) * kTile, {});
    for (const std::uint32_t b : members) {
        const Border& border = borders[b];
        const Vec2 end = border.start + border.length * border.along;
        const Vec2 lo = glm::min(border.start, end) - width, hi = glm::max(border.start, end) + width;
        const std::int64_t x0 = std::max<std::int64_t>(0, std::int64_t(std::floor(lo.x)));
        const std::int64_t x1 = std::min<std::int64_t>(size - 1, std::int64_t(std::floor(hi.x)));
        const std::int64_t y0 = std::max<std::int64_t>(row, std::int64_t(std::floor(lo.y)));
        const std::int64_t y1 = std::min<std::int64_t>({row + kTile - 1, size - 1, std::int64_t(std::floor(hi.y))});
        for (std::int64_t y = y0; y <= y1; ++y) {
            for (std::int64_t x = x0; x <= x1; ++x) {
                const Vec2 p = border.local(Vec2(double(x) + 0.5, double(y) + 0.5));
                const double beyond = p.x - std::clamp(p.x, 0.0, border.length);
                const double d = beyond * beyond + p.y * p.y;
                if (p.y < -kOnEdge || d > width * width || texel_ref(map, x, y).valid()) continue;
                insert(borders, b, static_cast<float>(d), near[std::size_t((y - row) * size + x)]);
            }
        }
    }
}

}  // namespace

Gutter build_gutter(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, std::uint32_t width) {
    const std::vector<Border> borders = find_borders(mesh, atlas);
    const std::size_t n_bands = map.tiles_per_side;
    std::vector<std::vector<std::uint32_t>> members(n_bands);
    for (std::uint32_t b = 0; b < borders.size(); ++b) {
        const double y0 = borders[b].start.y, y1 = y0 + borders[b].length * borders[b].along.y;
        const double last = double(n_bands) - 1;
        const auto lo = std::clamp(std::floor((std::min(y0, y1) - width) / kTile), 0.0, last);
        const auto hi = std::clamp(std::floor((std::max(y0, y1) + width) / kTile), 0.0, last);
        for (auto band = std::size_t(lo); band <= std::size_t(hi); ++band) members[band].push_back(b);
    }
    std::vector<Gutter> parts(n_bands);
    parallel_for(n_bands, 1, [&](std::size_t begin, std::size_t end) {
        std::vector<Near> near;
        TapScratch scratch;
        for (std::size_t band = begin; band < end; ++band) {
            const auto row = static_cast<std::int64_t>(band) * kTile;
            find_near(map, borders, members[band], row, width, near);
            Gutter& part = parts[band];
            for (std::size_t i = 0; i < near.size(); ++i) {
                if (near[i].border[0] == kNone) continue;
                const std::int64_t x = std::int64_t(i % map.size), y = row + std::int64_t(i / map.size);
                const Vec2 uv{double(x) + 0.5, double(y) + 0.5};
                const std::size_t before = part.taps.size();
                find_taps(map, borders, near[i], uv, scratch, part.taps);
                if (part.taps.size() == before) take_nearest(map, borders[near[i].border[0]], uv, part.taps);
                if (part.taps.size() == before) continue;
                part.texels.push_back(static_cast<std::uint32_t>(y * map.size + x));
                part.start.push_back(static_cast<std::uint32_t>(part.taps.size()));
            }
        }
    });
    Gutter gutter;
    gutter.size = map.size;
    gutter.start.push_back(0);
    for (const Gutter& part : parts) {
        const auto base = static_cast<std::uint32_t>(gutter.taps.size());
        gutter.texels.insert(gutter.texels.end(), part.texels.begin(), part.texels.end());
        for (const std::uint32_t s : part.start) gutter.start.push_back(base + s);
        gutter.taps.insert(gutter.taps.end(), part.taps.begin(), part.taps.end());
    }
    return gutter;
}

void fill_gutter(const Gutter& gutter, const TexelMap& map, int channels, std::span<float> image) {
    assert(image.size() == std::size_t{gutter.size} * gutter.size * channels);
    const auto pixel = [&](std::uint32_t texel) {
        const TexelPlace at = texel_place(map, texel / kTileTexels, texel % kTileTexels);
        return static_cast<std::size_t>((at.y * map.size + at.x) * channels);
    };
    parallel_for(gutter.texels.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            float* out = image.data() + std::size_t{gutter.texels[i]} * channels;
            std::fill(out, out + channels, 0.0f);
            for (std::uint32_t k = gutter.start[i]; k < gutter.start[i + 1]; ++k) {
                const float* in = image.data() + pixel(gutter.taps[k].texel);
                for (int c = 0; c < channels; ++c) out[c] += gutter.taps[k].weight * in[c];
            }
        }
    });
}

}  // namespace tuft::atlas
