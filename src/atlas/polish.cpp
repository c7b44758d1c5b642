#include "atlas/polish.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "atlas/flatten.h"
#include "atlas/meter.h"
#include "atlas/straighten.h"
#include "atlas/tasks.h"

namespace tuft::atlas {
namespace {

constexpr int kRounds = 8;
constexpr float kFirstReach = 0.12f;  // how far seams may move at first, over their length
constexpr float kLeastReach = 0.02f;  // seams that may move less stay
constexpr double kUsualWork = 2;  // triangles laid flat in all rounds, over those of the mesh
constexpr double kSlack = 1.1;  // stretch that straighter seams may cost, over what charts may have

/// Where the triangles of the mesh lie now.
struct OldPlaces {
    std::vector<std::uint32_t> chart;  // [n_triangles]
    std::vector<std::uint32_t> face;   // [n_triangles] in the chart
};

OldPlaces old_places(const mesh::TriangleMesh& mesh, const CutMesh& cut) {
    OldPlaces places{std::vector<std::uint32_t>(mesh.n_triangles()),
                     std::vector<std::uint32_t>(mesh.n_triangles())};
    for (std::uint32_t c = 0; c < cut.charts.size(); ++c)
        for (std::uint32_t f = 0; f < cut.charts[c].mesh.triangles.size(); ++f) {
            places.chart[cut.charts[c].mesh.triangles[f]] = c;
            places.face[cut.charts[c].mesh.triangles[f]] = f;
        }
    return places;
}

/// Third corner of a triangle whose first edge lies at a, b.
Vec2 unfold(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec2& a, const Vec2& b) {
    const Vec3 e = p1 - p0, d = p2 - p0;
    const double l = std::max(glm::dot(e, e), 1e-300);
    const double along = glm::dot(d, e) / l, side = glm::length(glm::cross(e, d)) / l;
    const Vec2 u = b - a;
    return a + along * u + side * Vec2(-u.y, u.x);
}

/// The old UVs of the old chart that most of the new one comes from; triangles from
/// elsewhere are unfolded one by one from those that have a place.
std::vector<Vec2> carried_uvs(const CutMesh& cut, const OldPlaces& places, const ChartMesh& chart) {
    std::vector<std::pair<std::uint32_t, double>> share;
    for (std::size_t f = 0; f < chart.faces.size(); ++f) {
        const std::uint32_t c = places.chart[chart.triangles[f]];
        const auto it =
            std::find_if(share.begin(), share.end(), [&](auto& s) { return s.first == c; });
        if (it == share.end())
            share.emplace_back(c, 1);
        else
            it->second += 1;
    }
    const std::uint32_t main = std::max_element(share.begin(), share.end(), [](auto& a, auto& b) {
                                   return a.second < b.second;
                               })->first;
    const FlatChart& old = cut.charts[main];
    std::vector<Vec2> uv(chart.n_vertices());
    std::vector<std::uint8_t> known(chart.n_vertices(), 0), done(chart.faces.size(), 0);
    std::vector<std::uint32_t> queue;
    for (std::uint32_t f = 0; f < chart.faces.size(); ++f) {
        const std::uint32_t t = chart.triangles[f];
        if (places.chart[t] != main) continue;
        for (int k = 0; k < 3; ++k) {
            uv[chart.faces[f][k]] = old.uv[old.mesh.faces[places.face[t]][k]];
            known[chart.faces[f][k]] = 1;
        }
        done[f] = 1;
        queue.push_back(f);
    }
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (std::uint32_t h = 3 * queue[i]; h < 3 * queue[i] + 3; ++h) {
            const std::uint32_t g = chart.twin[h];
            if (g == kNone || done[g / 3]) continue;
            done[g / 3] = 1;
            queue.push_back(g / 3);
            const auto& f = chart.faces[g / 3];
            const std::uint32_t a = f[g % 3], b = f[(g + 1) % 3], c = f[(g + 2) % 3];
            if (known[c]) continue;
            known[c] = 1;
            uv[c] = unfold(chart.position[a], chart.position[b], chart.position[c], uv[a], uv[b]);
        }
    return uv;
}

/// Whether two ways to cut the mesh are the same along these triangles.
bool same_cuts(const std::vector<std::uint32_t>& glued, const std::vector<std::uint32_t>& other,
               const std::vector<std::uint32_t>& triangles) {
    return std::all_of(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
        return std::equal(glued.begin() + 3 * std::ptrdiff_t{t},
                          glued.begin() + 3 * std::ptrdiff_t{t} + 3,
                          other.begin() + 3 * std::ptrdiff_t{t});
    });
}

/// One way to cut the mesh that is being tried.
struct Attempt {
    std::vector<std::uint32_t> glued;
    std::vector<FlatChart> charts;
    std::vector<std::uint8_t> failed;     // [n_charts]
    std::vector<std::uint32_t> chart_of;  // [n_triangles]
};

class Polisher {
  public:
    Polisher(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options)
        : mesh_(mesh),
          cut_(cut),
          options_(options),
          places_(old_places(mesh, cut)),
          reach_(cut.charts.size(), kFirstReach) {
        std::vector<std::uint32_t> all(mesh.n_triangles());
        std::iota(all.begin(), all.end(), 0u);
        patch_ = make_patch(mesh, cut.twin, std::move(all), cut.unit);
    }

    void run(const ProgressFn& progress) {
        Attempt last;
        Meter meter(progress, "polish", kUsualWork * double(mesh_.n_triangles()));
        for (int round = 0; round <= kRounds; ++round) {
            if (round == kRounds) reach_.assign(reach_.size(), 0);
            Attempt now = attempt(last, meter);
            bool failed = false;
            std::vector<std::uint8_t> hit(reach_.size(), 0);
            for (std::size_t i = 0; i < now.charts.size(); ++i) {
                if (!now.failed[i]) continue;
                failed = true;
                for (const std::uint32_t t : now.charts[i].mesh.triangles)
                    hit[places_.chart[t]] = 1;
            }
            for (std::size_t c = 0; c < hit.size(); ++c)
                if (hit[c]) reach_[c] = reach_[c] > kLeastReach ? 0.35f * reach_[c] : 0;
            last = std::move(now);
            if (!failed) break;
        }
        cut_.glued = std::move(last.glued);
        cut_.charts = std::move(last.charts);
    }

  private:
    /// Straightens seams as far as each may move; charts that come out as in the last
    /// attempt are taken from there.
    Attempt attempt(Attempt& last, Meter& meter) {
        std::vector<std::uint8_t> seam(cut_.glued.size());
        std::vector<float> reach(mesh_.n_triangles());
        for (std::size_t h = 0; h < seam.size(); ++h) seam[h] = cut_.glued[h] == kNone;
        for (std::size_t t = 0; t < reach.size(); ++t) reach[t] = reach_[places_.chart[t]];
        straighten_seams(patch_, seam, reach);
        Attempt now;
        now.glued = cut_.twin;
        for (std::size_t h = 0; h < seam.size(); ++h)
            if (seam[h]) now.glued[h] = kNone;
        const auto parts = connected_charts(now.glued);
        now.charts.resize(parts.size());
        now.failed.assign(parts.size(), 0);
        now.chart_of.resize(mesh_.n_triangles());
        for (std::uint32_t i = 0; i < parts.size(); ++i)
            for (const std::uint32_t t : parts[i]) now.chart_of[t] = i;
        run_tasks(parts.size(), [&](std::size_t i) {
            if (!last.charts.empty() && same_cuts(now.glued, last.glued, parts[i])) {
                const std::uint32_t j = last.chart_of[parts[i][0]];
                now.charts[i] = std::move(last.charts[j]);
                now.failed[i] = last.failed[j];
            } else {
                now.failed[i] = !flatten_part(now.glued, parts[i], now.charts[i], meter);
            }
        });
        return now;
    }

    /// False when the chart's seams changed and it does not lie flat with them.
    bool flatten_part(const std::vector<std::uint32_t>& glued,
                      const std::vector<std::uint32_t>& part, FlatChart& chart, Meter& meter) {
        chart.mesh = make_chart(mesh_, glued, part, cut_.unit, cut_.place);
        MeterPart work(meter, double(part.size()));
        ArapOptions options;
        options.on_step = [&] { work.advance(double(part.size()) / options.iterations); };
        const bool as_before = same_cuts(glued, cut_.glued, part);
        if (chart.mesh.disk) {
            chart.uv = carried_uvs(cut_, places_, chart.mesh);
            arap(chart.mesh, chart.uv, options);
            work.finish();
            scale_to_area(chart.mesh, chart.uv);
            const FlatCheck check = check_flat(chart.mesh, chart.uv, options_.gap);
            chart.worst = check.linf;
            if (check.sound() && check.stretch_999 <= options_.largest &&
                check.l2 <= 1 + kSlack * (options_.l2 - 1) &&
                check.linf <= std::max(options_.worst, worst_before(part)))
                return true;
        }
        if (as_before) chart.uv = cut_.charts[places_.chart[part[0]]].uv;
        return as_before;
    }

    double worst_before(const std::vector<std::uint32_t>& part) const {
        double worst = 0;
        for (const std::uint32_t t : part)
            worst = std::max(worst, cut_.charts[places_.chart[t]].worst);
        return worst;
    }

    const mesh::TriangleMesh& mesh_;
    CutMesh& cut_;
    const ChartOptions& options_;
    Patch patch_;
    OldPlaces places_;
    std::vector<float> reach_;  // of the seams of each old chart
};

}  // namespace

void polish_charts(const mesh::TriangleMesh& mesh, CutMesh& cut, const ChartOptions& options,
                   const ProgressFn& progress) {
    Polisher(mesh, cut, options).run(progress);
}

}  // namespace tuft::atlas
