#include "atlas/charts/cut_to_pack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "atlas/charts/tasks.h"
#include "atlas/flatten/hull.h"
#include "atlas/seams/straighten.h"

namespace tuft::atlas {
namespace {

constexpr int kMostCuts = 9;                    // of a few charts
constexpr int kMostCutsOfMany = 32;             // of many
constexpr double kLeastOfUse = 0.98;            // that is left when a cut is made for the sake of the next
constexpr double kNear = 0.97;                  // of what is good enough: a patient search gains about 2 %
constexpr double kNearAtLast = 0.94;            // the same for the layout that is used
constexpr double kBeyond = 1.03;                // of the goal, once charts are cut: a short search errs by this
constexpr double kAsLong = 0.85;                // of the longest chart's length
constexpr std::size_t kCandidates = 6;          // largest of a few charts that are tried
constexpr std::size_t kLongCandidates = 16;     // longest charts that are tried
constexpr std::size_t kCandidatesOfMany = 16;   // charts with the emptiest boxes that are tried of many
constexpr std::size_t kFewCharts = 48;          // with more, small ones fill the gaps between large ones
constexpr double kCutGainOfMany = 1.004;        // `kCutGain` for many charts, of which each is a small part
constexpr double kWithinReach = 0.5;            // of what is good enough, below which many charts are too narrow for it
constexpr double kEmpty = 0.01;                 // of the surface, by which a box is larger than its chart
constexpr std::size_t kMostTriangles = 200000;  // triangles of a chart that is left as it is

std::vector<Vec2> border_of(const FlatChart& chart) {
    std::vector<Vec2> border;
    border.reserve(chart.mesh.loop.size());
    for (const std::uint32_t v : chart.mesh.loop) border.push_back(chart.uv[v]);
    return border;
}

/// Part of the pages that charts of `area` cover.
double use_of(const Packing& packing, double area) {
    if (!packing.fits) return 0;
    return area * packing.texels_per_unit * packing.texels_per_unit /
           (static_cast<double>(packing.size) * packing.size * packing.pages);
}

Packing patient_packing(const std::vector<std::vector<Vec2>>& borders, PackOptions options) {
    options.search = Search::patient;
    return pack(borders, options);
}

/// A layout of the charts; a patient search where that may reach what is good enough.
Packing pack_well(const std::vector<std::vector<Vec2>>& borders, double area, PackOptions options, double goal) {
    options.search = Search::full;
    Packing packing = pack(borders, options);
    const double use = use_of(packing, area);
    if (use >= goal || use < kNear * kGoodUse) return packing;
    Packing better = patient_packing(borders, options);
    return use_of(better, area) > use ? better : packing;
}

/// A chart in parts.
struct Halves {
    std::vector<FlatChart> parts;
    std::vector<std::uint32_t> cut;  // half-edges of the mesh
    double length = 0;               // of the new seams, over the unit
};

/// What parts are cut from.
struct Whole {
    const mesh::TriangleMesh& mesh;
    const FlatChart& chart;
    double unit, gap;
};

/// The part of a flat chart that consists of these of its faces; nothing when it is no disk
/// or its new border comes too near to itself.
std::optional<FlatChart> part_of(const Whole& of, std::span<const std::uint32_t> glued,
                                 const std::vector<std::uint32_t>& faces) {
    const FlatChart& whole = of.chart;
    FlatChart part;
    part.worst = whole.worst;
    part.l2 = whole.l2;
    std::vector<std::uint32_t> triangles;
    triangles.reserve(faces.size());
    for (const std::uint32_t f : faces) triangles.push_back(whole.mesh.triangles[f]);
    part.mesh = make_chart(of.mesh, glued, std::move(triangles), of.unit);
    if (!part.mesh.disk) return std::nullopt;
    part.uv.resize(part.mesh.n_vertices());
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (int k = 0; k < 3; ++k) part.uv[part.mesh.faces[i][k]] = whole.uv[whole.mesh.faces[faces[i]][k]];
    if (!check_flat(part.mesh, part.uv, of.gap).sound()) return std::nullopt;
    return part;
}

/// A straight line across a flat chart.
struct Line {
    Vec2 across{1, 0};  // unit
    double at = 0;      // distance from the origin

    bool beyond(const FlatChart& chart, std::uint32_t face) const {
        Vec2 middle(0);
        for (const std::uint32_t v : chart.mesh.faces[face]) middle += chart.uv[v] / 3.0;
        return glm::dot(across, middle) > at;
    }
};

/// Least and largest distance of a chart's points from a line through the origin.
std::pair<double, double> extent_across(const FlatChart& chart, const Vec2& across) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec2& p : chart.uv) {
        low = std::min(low, glm::dot(across, p));
        high = std::max(high, glm::dot(across, p));
    }
    return {low, high};
}

/// The line across the middle of the longer side of the smallest rectangle.
Line middle_line(const FlatChart& chart) {
    const Rectangle box = smallest_rectangle(chart_hull(chart));
    const Vec2 across(box.c, box.s);
    return {across, extent_across(chart, across).first + 0.5 * box.length};
}

/// Sum of the areas of the rectangles, with sides along and across the line, around the parts that a line leaves.
double boxes_beside(const FlatChart& chart, const Line& line) {
    const ChartMesh& m = chart.mesh;
    const Vec2 along(-line.across.y, line.across.x);
    std::vector<std::uint8_t> beyond(m.faces.size()), seen(m.faces.size(), 0);
    for (std::uint32_t f = 0; f < beyond.size(); ++f) beyond[f] = line.beyond(chart, f);
    double sum = 0;
    std::vector<std::uint32_t> stack;
    for (std::uint32_t first = 0; first < seen.size(); ++first) {
        if (seen[first]) continue;
        seen[first] = 1;
        stack.assign(1, first);
        Vec2 low(std::numeric_limits<double>::infinity()), high = -low;
        while (!stack.empty()) {
            const std::uint32_t f = stack.back();
            stack.pop_back();
            for (const std::uint32_t v : m.faces[f]) {
                const Vec2 p(glm::dot(line.across, chart.uv[v]), glm::dot(along, chart.uv[v]));
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
            for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
                const std::uint32_t g = m.twin[h];
                if (g == kNone || seen[g / 3] || beyond[g / 3] != beyond[f]) continue;
                seen[g / 3] = 1;
                stack.push_back(g / 3);
            }
        }
        sum += (high.x - low.x) * (high.y - low.y);
    }
    return sum;
}

/// The line along or across the smallest rectangle that leaves the fullest boxes, as at the corner of a frame; nothing
/// where none leaves much fuller ones.
std::optional<Line> emptying_line(const FlatChart& chart) {
    constexpr int kLines = 31;
    constexpr double kMuch = 0.75;  // of the area of the chart's own box
    constexpr std::size_t kMostFaces = 20000;
    if (chart.mesh.faces.size() > kMostFaces) return std::nullopt;
    const Rectangle box = smallest_rectangle(chart_hull(chart));
    std::optional<Line> best;
    double least = kMuch * box.length * box.width;
    for (const Vec2& across : {Vec2(box.c, box.s), Vec2(-box.s, box.c)}) {
        const auto [low, high] = extent_across(chart, across);
        for (int k = 1; k <= kLines; ++k) {
            const Line line{across, low + (high - low) * k / (kLines + 1)};
            const double sum = boxes_beside(chart, line);
            if (sum >= least) continue;
            least = sum;
            best = line;
        }
    }
    return best;
}

/// The parts of a chart on both sides of a line.
std::optional<Halves> divide(const mesh::TriangleMesh& mesh, const CutMesh& cut, const FlatChart& chart, double gap,
                             const Line& line) {
    const ChartMesh& m = chart.mesh;
    if (m.faces.size() < 2 || m.faces.size() > kMostTriangles) return std::nullopt;
    const Patch patch = make_patch(mesh, cut.glued, m.triangles, cut.unit);
    std::vector<std::uint8_t> seam(patch.twin.size());
    for (std::uint32_t h = 0; h < seam.size(); ++h) {
        const std::uint32_t g = patch.twin[h];
        seam[h] = g == kNone || line.beyond(chart, h / 3) != line.beyond(chart, g / 3);
    }
    straighten_seams(patch, seam);

    Halves halves;
    std::vector<std::uint32_t> local(patch.twin), glued(cut.glued);
    for (std::uint32_t h = 0; h < seam.size(); ++h) {
        if (!seam[h] || local[h] == kNone) continue;
        local[h] = kNone;
        halves.length += 0.5 * patch.length[h];
        const std::uint32_t whole = 3 * m.triangles[h / 3] + h % 3;
        glued[whole] = kNone;
        halves.cut.push_back(whole);
    }
    const auto parts = connected_charts(local);
    if (parts.size() < 2 || parts.size() > 4) return std::nullopt;
    for (const auto& faces : parts) {
        auto part = part_of({mesh, chart, cut.unit, gap}, glued, faces);
        if (!part) return std::nullopt;
        halves.parts.push_back(std::move(*part));
    }
    return halves;
}

void apply(CutMesh& cut, std::uint32_t chart, const Halves& halves) {
    for (const std::uint32_t h : halves.cut) cut.glued[h] = kNone;
    cut.charts[chart] = halves.parts[0];
    cut.charts.insert(cut.charts.end(), halves.parts.begin() + 1, halves.parts.end());
}

/// Charts to be cut together.
using Proposal = std::vector<std::pair<std::uint32_t, Halves>>;

/// The smallest rectangle around a chart.
struct ChartBox {
    double area = 0, length = 0;
    double empty = 0;  // area outside the chart
};

std::vector<ChartBox> boxes_of(const CutMesh& cut) {
    std::vector<ChartBox> boxes(cut.charts.size());
    for (std::size_t c = 0; c < boxes.size(); ++c) {
        const Rectangle r = smallest_rectangle(chart_hull(cut.charts[c]));
        boxes[c] = {r.length * r.width, r.length, r.length * r.width - cut.charts[c].mesh.area};
    }
    return boxes;
}

/// The charts with the largest value, largest first.
std::vector<std::uint32_t> largest_by(const std::vector<ChartBox>& boxes, double ChartBox::*value, std::size_t most) {
    std::vector<std::uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return boxes[a].*value > boxes[b].*value; });
    order.resize(std::min(order.size(), most));
    return order;
}

/// Each chart in two along the line that `line_of` gives, if it gives one that divides it.
template <class LineOf>
std::vector<std::optional<Halves>> divide_all(const mesh::TriangleMesh& mesh, const CutMesh& cut,
                                              std::span<const std::uint32_t> charts, double gap, LineOf line_of) {
    std::vector<std::optional<Halves>> halves(charts.size());
    run_tasks(charts.size(), [&](std::size_t i) {
        const FlatChart& chart = cut.charts[charts[i]];
        if (const std::optional<Line> line = line_of(chart)) halves[i] = divide(mesh, cut, chart, gap, *line);
    });
    return halves;
}

/// All charts that are about as long as the longest, which may be all that keeps the rest small.
void add_longest(std::vector<Proposal>& all, const mesh::TriangleMesh& mesh, const CutMesh& cut,
                 const std::vector<ChartBox>& boxes, double gap) {
    const std::vector<std::uint32_t> order = largest_by(boxes, &ChartBox::length, kLongCandidates);
    std::vector<std::uint32_t> longest;
    for (const std::uint32_t c : order)
        if (boxes[c].length >= kAsLong * boxes[order[0]].length) longest.push_back(c);
    const std::vector<std::optional<Halves>> halves = divide_all(mesh, cut, longest, gap, middle_line);
    Proposal together;
    for (std::size_t i = 0; i < longest.size(); ++i)
        if (halves[i]) together.push_back({longest[i], *halves[i]});
    if (!together.empty()) all.push_back(std::move(together));
}

/// Each of the charts with the largest boxes, and the two largest together.
std::vector<Proposal> proposals_of_few(const mesh::TriangleMesh& mesh, const CutMesh& cut,
                                       const std::vector<ChartBox>& boxes, double gap) {
    const std::vector<std::uint32_t> order = largest_by(boxes, &ChartBox::area, kCandidates);
    const std::vector<std::optional<Halves>> halves = divide_all(mesh, cut, order, gap, middle_line);
    std::vector<Proposal> all;
    for (std::size_t i = 0; i < order.size(); ++i)
        if (halves[i]) all.push_back({{order[i], *halves[i]}});
    if (order.size() > 1 && halves[0] && halves[1]) all.push_back({{order[0], *halves[0]}, {order[1], *halves[1]}});
    return all;
}

/// Frames, bows and bent strips, whose boxes are emptiest: one, four, sixteen of them. A single cut among many
/// charts shows little.
std::vector<Proposal> proposals_of_many(const mesh::TriangleMesh& mesh, const CutMesh& cut,
                                        const std::vector<ChartBox>& boxes, double gap) {
    std::vector<std::uint32_t> order = largest_by(boxes, &ChartBox::empty, kCandidatesOfMany);
    std::erase_if(order, [&](std::uint32_t c) { return boxes[c].empty < kEmpty; });
    const std::vector<std::optional<Halves>> halves = divide_all(mesh, cut, order, gap, emptying_line);
    std::vector<Proposal> all;
    Proposal together;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (halves[i]) together.push_back({order[i], *halves[i]});
        const bool last = i + 1 == order.size();
        if (!together.empty() && (last || i == 0 || i == 3)) all.push_back(together);
    }
    return all;
}

std::vector<Proposal> proposals(const mesh::TriangleMesh& mesh, const CutMesh& cut, double gap) {
    const std::vector<ChartBox> boxes = boxes_of(cut);
    std::vector<Proposal> all =
        boxes.size() > kFewCharts ? proposals_of_many(mesh, cut, boxes, gap) : proposals_of_few(mesh, cut, boxes, gap);
    add_longest(all, mesh, cut, boxes, gap);
    return all;
}

double seam_length(const Proposal& proposal) {
    double length = 0;
    for (const auto& [chart, halves] : proposal) length += halves.length;
    return length;
}

/// The shortest cuts that reach the goal; where none does, those that gain most.
std::size_t best_proposal(const std::vector<Proposal>& all, const std::vector<double>& use, double goal) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
        const bool both = use[i] >= goal && use[best] >= goal;
        if (both ? seam_length(all[i]) < seam_length(all[best]) : use[i] > use[best]) best = i;
    }
    return best;
}

std::vector<std::vector<Vec2>> borders_after(std::vector<std::vector<Vec2>> borders, const Proposal& proposal) {
    for (const auto& [chart, halves] : proposal) {
        borders[chart] = border_of(halves.parts[0]);
        for (std::size_t p = 1; p < halves.parts.size(); ++p) borders.push_back(border_of(halves.parts[p]));
    }
    return borders;
}

}  // namespace

std::vector<std::vector<Vec2>> chart_borders(const CutMesh& cut) {
    std::vector<std::vector<Vec2>> borders;
    borders.reserve(cut.charts.size());
    for (const FlatChart& chart : cut.charts) borders.push_back(border_of(chart));
    return borders;
}

namespace {

/// Limits of a run of cuts. Coverage is as coarse masks show it, fraction of the atlas.
struct CutLimits {
    double area = 0;    ///< of the charts
    double use = 0;     ///< coverage at the start
    double goal = 1;    ///< coverage at which to stop
    int most_cuts = 0;  ///< number of cuts at which to stop
    double gain = 1;    ///< least ratio of coverage after a cut to that before
    double least = 1;   ///< the same for a cut made for the sake of the next
};

/// Cuts while coarse masks show that it gains, until they show the goal or nothing helps. Returns the number of cuts.
int cut_while_it_gains(const mesh::TriangleMesh& mesh, CutMesh& cut, double gap, const PackOptions& options,
                       const CutLimits& limits) {
    double use = limits.use;
    std::vector<std::vector<Vec2>> borders = chart_borders(cut);
    int cuts = 0;
    for (; cuts < limits.most_cuts && use < limits.goal; borders = chart_borders(cut)) {
        const std::vector<Proposal> all = proposals(mesh, cut, gap);
        std::vector<double> gained(all.size(), 0);
        run_tasks(all.size(), [&](std::size_t i) {
            gained[i] = use_of(pack(borders_after(borders, all[i]), options), limits.area);
            // Two cuts have to gain as much as each of them would.
            if (gained[i] < limits.goal) gained[i] /= std::pow(limits.gain, all[i].size());
        });
        const std::size_t best = best_proposal(all, gained, limits.goal);
        // A cut may gain nothing until the next one is made.
        if (all.empty() || gained[best] < limits.least * use) break;
        use = std::max(use, gained[best]);
        for (const auto& [chart, halves] : all[best]) {
            apply(cut, chart, halves);
            ++cuts;
        }
    }
    return cuts;
}

}  // namespace

CutToPack cut_to_pack(const mesh::TriangleMesh& mesh, CutMesh& cut, double gap, PackOptions options, double goal) {
    CutToPack result;
    double area = 0;
    for (const FlatChart& chart : cut.charts) area += chart.mesh.area;
    result.packing = pack_well(chart_borders(cut), area, options, goal);
    double use = use_of(result.packing, area);
    if (use >= goal) return result;
    const ProgressFn progress = std::exchange(options.progress, {});
    PackOptions coarse = options;
    coarse.search = Search::coarse;
    CutMesh tried = cut;
    int cuts = 0;
    const bool many = cut.charts.size() > kFewCharts;
    if (many && use < kWithinReach * std::min(goal, kGoodUse)) return result;
    const int most_cuts = many ? kMostCutsOfMany : kMostCuts;
    const double gain = many ? kCutGainOfMany : kCutGain;
    for (double now = use; cuts < most_cuts && now < goal;) {
        report(progress, "cut to pack", double(cuts) / most_cuts);
        CutLimits limits{.area = area, .use = use_of(pack(chart_borders(tried), coarse), area)};
        limits.goal = kBeyond * limits.use / now * goal;
        limits.most_cuts = most_cuts - cuts;
        limits.gain = gain;
        limits.least = many ? 1 : kLeastOfUse;
        const int more = cut_while_it_gains(mesh, tried, gap, coarse, limits);
        if (more == 0) break;
        cuts += more;
        Packing packing = pack_well(chart_borders(tried), area, options, goal);
        now = use_of(packing, area);
        if (now < goal && now < std::pow(gain, cuts - result.cuts) * use) {
            if (many) break;
            continue;
        }
        use = now;
        cut = tried;
        result.cuts = cuts;
        result.packing = std::move(packing);
    }
    if (use >= goal || use < kNearAtLast * kGoodUse) return result;
    Packing better = patient_packing(chart_borders(cut), options);
    if (use_of(better, area) > use) result.packing = std::move(better);
    return result;
}

}  // namespace tuft::atlas
