#include "atlas/seams/seam_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>

#include "core/random.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// An edge whose triangle is flatter than this part of the edge has no angle worth keeping.
constexpr double kFlatTriangle = 1e-3;
constexpr double kTie = 0.02;

/// Writes nothing where the path is a step long already, so that threads may ask then.
std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
    while (parent[i] != i) {
        const std::uint32_t next = parent[parent[i]];
        if (parent[i] != next) parent[i] = next;
        i = next;
    }
    return i;
}

/// Least eigenvalue of a symmetric matrix, by the trigonometric formula (Smith 1961).
double least_eigenvalue(const std::array<double, 6>& m) {
    const double q = (m[0] + m[3] + m[5]) / 3;
    const double a = m[0] - q, b = m[3] - q, c = m[5] - q;
    const double off = m[1] * m[1] + m[2] * m[2] + m[4] * m[4];
    const double p = std::sqrt((a * a + b * b + c * c + 2 * off) / 6);
    if (!(p > 0)) return q;
    const double det = a * (b * c - m[4] * m[4]) - m[1] * (m[1] * c - m[4] * m[2]) + m[2] * (m[1] * m[4] - b * m[2]);
    const double r = std::clamp(det / (2 * p * p * p), -1.0, 1.0);
    return q + 2 * p * std::cos(std::acos(r) / 3 + 2 * std::numbers::pi / 3);
}

double dihedral(const Patch& patch, std::uint32_t h) {
    const std::uint32_t g = patch.twin[h];
    const double flat = kFlatTriangle * patch.length[h] * patch.length[h];
    if (patch.area[h / 3] < flat || patch.area[g / 3] < flat) return 0;
    return std::acos(std::clamp(static_cast<double>(glm::dot(patch.normal[h / 3], patch.normal[g / 3])), -1.0, 1.0));
}

}  // namespace

NormalMoments NormalMoments::of(double area, const Vec3f& normal) {
    const Vec3 n(normal);
    return {
        area,
        area * n,
        {area * n.x * n.x, area * n.x * n.y, area * n.x * n.z, area * n.y * n.y, area * n.y * n.z, area * n.z * n.z}};
}

void NormalMoments::add(const NormalMoments& m) {
    area += m.area;
    first += m.first;
    for (int i = 0; i < 6; ++i) second[i] += m.second[i];
}

double NormalMoments::error() const {
    if (!(area > 0)) return 0;
    std::array<double, 6> c = second;
    c[0] -= first.x * first.x / area;
    c[1] -= first.x * first.y / area;
    c[2] -= first.x * first.z / area;
    c[3] -= first.y * first.y / area;
    c[4] -= first.y * first.z / area;
    c[5] -= first.z * first.z / area;
    return std::max(0.0, least_eigenvalue(c));
}

SeamGraph::SeamGraph(const Patch& patch, std::span<const std::uint8_t> seam) : patch_(patch) {
    number_edges(seam);
    number_charts(seam);
    count_seams_at_vertices();
    std::vector<std::uint32_t> changed;
    for (std::uint32_t v = 0; v < patch.n_vertices; ++v)
        if (degree_[v] <= 2) simplify_at(v, changed);
}

void SeamGraph::number_edges(std::span<const std::uint8_t> seam) {
    edge_of_.assign(patch_.twin.size(), kNone);
    const auto is_edge = [&](std::uint32_t h) {
        return patch_.twin[h] != kNone && patch_.twin[h] > h && (seam.empty() || seam[h]);
    };
    std::uint32_t n_edges = 0;
    for (std::uint32_t h = 0; h < edge_of_.size(); ++h) n_edges += is_edge(h);
    half_.reserve(n_edges);
    ends_.reserve(n_edges);
    length_.reserve(n_edges);
    bent_.reserve(n_edges);
    for (std::uint32_t h = 0; h < edge_of_.size(); ++h) {
        if (!is_edge(h)) continue;
        edge_of_[h] = edge_of_[patch_.twin[h]] = static_cast<std::uint32_t>(half_.size());
        half_.push_back(h);
        ends_.push_back({patch_.vertex[h], patch_.vertex[next_half(h)]});
        length_.push_back(patch_.length[h]);
        bent_.push_back(static_cast<float>(patch_.length[h] * dihedral(patch_, h)));
    }
    seam_.assign(n_edges, 1);
    chain_parent_.resize(n_edges);
    std::iota(chain_parent_.begin(), chain_parent_.end(), 0u);
    tail_ = chain_parent_;
    next_.assign(n_edges, kNone);
    version_.assign(n_edges, 0);
}

void SeamGraph::number_charts(std::span<const std::uint8_t> seam) {
    const auto n = static_cast<std::uint32_t>(patch_.triangles.size());
    charts_.first.resize(n);
    std::iota(charts_.first.begin(), charts_.first.end(), 0u);
    for (std::uint32_t h = 0; h < seam.size(); ++h) {
        if (seam[h]) continue;
        const std::uint32_t a = find_root(charts_.first, h / 3);
        const std::uint32_t b = find_root(charts_.first, patch_.twin[h] / 3);
        charts_.first[std::max(a, b)] = std::min(a, b);
    }
    // A root is the first triangle of its chart, so that those before it have their numbers.
    std::uint32_t n_charts = 0;
    for (std::uint32_t t = 0; t < n; ++t)
        charts_.first[t] = charts_.first[t] == t ? n_charts++ : charts_.first[charts_.first[t]];
    charts_.parent.resize(n_charts);
    std::iota(charts_.parent.begin(), charts_.parent.end(), 0u);
    charts_.n_triangles.assign(n_charts, 0);
    charts_.moments.resize(n_charts);
    for (std::uint32_t t = 0; t < n; ++t) {
        ++charts_.n_triangles[charts_.first[t]];
        charts_.moments[charts_.first[t]].add(NormalMoments::of(patch_.area[t], patch_.normal[t]));
    }
    charts_.error.resize(n_charts);
    for (std::uint32_t c = 0; c < n_charts; ++c) charts_.error[c] = charts_.moments[c].error();
}

void SeamGraph::count_seams_at_vertices() {
    degree_.assign(patch_.n_vertices, 0);
    vertex_half_.assign(patch_.n_vertices, kNone);
    stays_.assign(patch_.n_vertices, 0);
    for (std::uint32_t h = 0; h < edge_of_.size(); ++h) {
        const std::uint32_t v = patch_.vertex[h];
        vertex_half_[v] = h;
        if (patch_.twin[h] != kNone) continue;
        for (const std::uint32_t w : {v, patch_.vertex[next_half(h)]}) {
            stays_[w] = 1;
            ++degree_[w];
        }
    }
    const std::vector<float> angle = vertex_angles(patch_);
    for (std::uint32_t v = 0; v < patch_.n_vertices; ++v)
        if (std::abs(angle[v] - 2 * std::numbers::pi) > kSlitDefect) stays_[v] = 1;
    for (const Ends& e : ends_) {
        ++degree_[e.a];
        ++degree_[e.b];
    }
}

std::uint32_t SeamGraph::chain_of(std::uint32_t edge) const {
    return find_root(chain_parent_, edge);
}

std::uint32_t SeamGraph::chart_of(std::uint32_t triangle) const {
    return find_root(charts_.parent, charts_.first[triangle]);
}

/// The chain is a whole loop, so that gluing it would leave no border.
bool SeamGraph::is_closed(std::uint32_t chain) const {
    return ends_[chain].a == ends_[chain].b && degree_[ends_[chain].a] <= 2;
}

int SeamGraph::seam_edges_at(std::uint32_t vertex, std::array<std::uint32_t, 3>& edges) const {
    int found = 0;
    const auto take = [&](std::uint32_t h) {
        const std::uint32_t e = edge_of_[h];
        if (e == kNone || !seam_[e]) return;
        if (found < 3) edges[found] = e;
        ++found;
    };
    const std::uint32_t start = vertex_half_[vertex];
    std::uint32_t h = start;
    do {
        take(h);
        const std::uint32_t g = patch_.twin[prev_half(h)];
        if (g == kNone) {  // the other side of the fan, up to the border
            take(prev_half(h));
            for (std::uint32_t b = patch_.twin[start]; b != kNone; b = patch_.twin[next_half(b)]) take(next_half(b));
            break;
        }
        h = g;
    } while (h != start);
    return found;
}

void SeamGraph::join(std::uint32_t a, std::uint32_t b, std::uint32_t vertex) {
    const auto other_end = [&](std::uint32_t c) { return ends_[c].a == vertex ? ends_[c].b : ends_[c].a; };
    const Ends ends{other_end(a), other_end(b)};
    next_[tail_[a]] = b;
    tail_[a] = tail_[b];
    chain_parent_[b] = a;
    ends_[a] = ends;
    length_[a] += length_[b];
    bent_[a] += bent_[b];
    ++version_[a];
    ++version_[b];
}

/// Joins two chains that meet at a vertex and glues slits that end there.
void SeamGraph::simplify_at(std::uint32_t vertex, std::vector<std::uint32_t>& changed) {
    while (!stays_[vertex]) {
        std::array<std::uint32_t, 3> edges{};
        if (degree_[vertex] == 0 || degree_[vertex] > 2) return;
        if (seam_edges_at(vertex, edges) != static_cast<int>(degree_[vertex])) return;
        const std::uint32_t a = chain_of(edges[0]);
        if (degree_[vertex] == 2) {
            const std::uint32_t b = chain_of(edges[1]);
            if (a == b) return;
            join(std::min(a, b), std::max(a, b), vertex);
            changed.push_back(std::min(a, b));
            return;
        }
        const std::uint32_t far = ends_[a].a == vertex ? ends_[a].b : ends_[a].a;
        if (far == vertex || degree_[far] < 2) return;
        for (std::uint32_t e = a; e != kNone; e = next_[e]) {
            seam_[e] = 0;
            --degree_[patch_.vertex[half_[e]]];
            --degree_[patch_.vertex[next_half(half_[e])]];
        }
        ++version_[a];
        vertex = far;
    }
}

void SeamGraph::take_away(std::uint32_t chain, std::vector<std::uint32_t>& changed) {
    const std::uint32_t a = chart_of(half_[chain] / 3);
    const std::uint32_t b = chart_of(patch_.twin[half_[chain]] / 3);
    charts_.parent[std::max(a, b)] = std::min(a, b);
    if (a != b) {
        charts_.moments[std::min(a, b)].add(charts_.moments[std::max(a, b)]);
        charts_.error[std::min(a, b)] = charts_.moments[std::min(a, b)].error();
        charts_.n_triangles[std::min(a, b)] += charts_.n_triangles[std::max(a, b)];
    }
    for (std::uint32_t e = chain; e != kNone; e = next_[e]) {
        seam_[e] = 0;
        --degree_[patch_.vertex[half_[e]]];
        --degree_[patch_.vertex[next_half(half_[e])]];
    }
    ++version_[chain];
    const Ends ends = ends_[chain];
    simplify_at(ends.a, changed);
    if (ends.b != ends.a) simplify_at(ends.b, changed);
}

void SeamGraph::glue(std::uint32_t chain) {
    std::vector<std::uint32_t> changed;
    take_away(chain_of(chain), changed);
}

double SeamGraph::cost(std::uint32_t chain, const GluingLimits& limits) const {
    const std::uint32_t a = chart_of(half_[chain] / 3);
    const std::uint32_t b = chart_of(patch_.twin[half_[chain]] / 3);
    if (a == b || is_closed(chain)) return kNever;
    if (charts_.n_triangles[a] + charts_.n_triangles[b] > limits.triangles) return kNever;
    if (bent_[chain] > limits.crease * length_[chain]) return kNever;
    NormalMoments both = charts_.moments[a];
    both.add(charts_.moments[b]);
    if (both.area > limits.area) return kNever;
    if (glm::dot(both.first, both.first) < limits.mean_normal * limits.mean_normal * both.area * both.area)
        return kNever;
    const double error = both.error();
    if (error > limits.error * both.area) return kNever;
    const double growth = std::max(0.0, error - charts_.error[a] - charts_.error[b]);
    const double small = std::min(charts_.moments[a].area, charts_.moments[b].area);
    // Regular meshes are full of equal costs that rounding would put in order by chance,
    // and so by the mesh's unit: a small difference by number puts them in order for good.
    const double tie = 1 + kTie * uniform(0, chain);
    const double cost = tie * (growth + limits.small * small) / std::max(length_[chain], 1e-30f);
    return cost < kNever ? cost : kNever;  // also where it is no number: costs must have an order
}

std::vector<SeamGraph::GlueEntry> SeamGraph::all_glue_entries(const GluingLimits& limits) {
    std::vector<GlueEntry> entries;
    entries.reserve(half_.size());
    for (std::uint32_t e = 0; e < half_.size(); ++e)
        if (seam_[e] && chain_parent_[e] == e) entries.push_back({kNever, e, version_[e]});
    for (std::uint32_t c = 0; c < charts_.parent.size(); ++c) charts_.parent[c] = find_root(charts_.parent, c);
    parallel_for(entries.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) entries[i].cost = cost(entries[i].chain, limits);
    });
    return entries;
}

void SeamGraph::glue_developable(const GluingLimits& limits, const ProgressFn& progress) {
    using Entry = GlueEntry;
    struct Later {
        bool operator()(const Entry& a, const Entry& b) const { return b < a; }
    };
    std::vector<Entry> start = all_glue_entries(limits);

    std::size_t left = start.size();
    const std::size_t all = std::max<std::size_t>(left, 1);
    // What breaks a limit now may keep it once the charts have grown: try again while any glued.
    for (bool glued = true; glued && !start.empty();) {
        glued = false;
        std::vector<Entry> rejected;
        // Those known from the start are sorted once and read in their order; only what comes back
        // goes through the heap, which stays small.
        std::sort(start.begin(), start.end());
        std::priority_queue<Entry, std::vector<Entry>, Later> queue;
        std::vector<std::uint32_t> changed;
        std::size_t steps = 0;
        for (std::size_t next = 0; next < start.size() || !queue.empty();) {
            const bool back = next == start.size() || (!queue.empty() && queue.top() < start[next]);
            const Entry top = back ? queue.top() : start[next++];
            if (back) queue.pop();
            if ((++steps & 0xfff) == 0)
                report(progress, "charts", 1.0 - static_cast<double>(left) / static_cast<double>(all));
            const std::uint32_t c = top.chain;
            if (!seam_[c] || chain_parent_[c] != c || version_[c] != top.version) continue;
            const double now = cost(c, limits);
            if (now == kNever) {
                rejected.push_back({now, c, top.version});
                continue;
            }
            if (top.cost == kNever || now > top.cost * (1 + 1e-9)) {
                queue.push({now, c, top.version});
                continue;
            }
            changed.clear();
            take_away(c, changed);
            glued = true;
            left -= left > 0;
            for (const std::uint32_t j : changed)
                if (seam_[j] && chain_parent_[j] == j) queue.push({cost(j, limits), j, version_[j]});
        }
        start.clear();
        for (const Entry& e : rejected) {
            if (!seam_[e.chain] || chain_parent_[e.chain] != e.chain) continue;
            if (chart_of(half_[e.chain] / 3) == chart_of(patch_.twin[half_[e.chain]] / 3)) continue;
            start.push_back({cost(e.chain, limits), e.chain, version_[e.chain]});
        }
    }
}

std::vector<SeamGraph::Chain> SeamGraph::chains() const {
    std::vector<Chain> chains;
    for (std::uint32_t e = 0; e < half_.size(); ++e) {
        if (!seam_[e] || chain_of(e) != e) continue;
        Chain c;
        c.id = e;
        c.chart_a = chart_of(half_[e] / 3);
        c.chart_b = chart_of(patch_.twin[half_[e]] / 3);
        c.length = length_[e];
        c.bend = length_[e] > 0 ? bent_[e] / length_[e] : 0;
        c.closed = is_closed(e);
        chains.push_back(c);
    }
    return chains;
}

std::vector<std::uint32_t> SeamGraph::half_edges(std::uint32_t chain) const {
    std::vector<std::uint32_t> halves;
    for (std::uint32_t e = chain_of(chain); e != kNone; e = next_[e]) halves.push_back(half_[e]);
    return halves;
}

std::vector<std::uint32_t> SeamGraph::glued_with(std::uint32_t chain) const {
    const std::uint32_t c = chain_of(chain), v = ends_[c].a;
    if (v != ends_[c].b || stays_[v] || degree_[v] != 3) return {};
    std::array<std::uint32_t, 3> edges{};
    if (seam_edges_at(v, edges) != 3) return {};
    for (const std::uint32_t e : edges) {
        const std::uint32_t slit = chain_of(e);
        if (slit == c) continue;
        const std::uint32_t far = ends_[slit].a == v ? ends_[slit].b : ends_[slit].a;
        if (far != v && degree_[far] >= 2) return half_edges(slit);
    }
    return {};
}

std::vector<std::uint8_t> SeamGraph::seams() const {
    std::vector<std::uint8_t> seam(edge_of_.size());
    for (std::size_t h = 0; h < seam.size(); ++h)
        seam[h] = patch_.twin[h] == kNone || (edge_of_[h] != kNone && seam_[edge_of_[h]]);
    return seam;
}

}  // namespace tuft::atlas
