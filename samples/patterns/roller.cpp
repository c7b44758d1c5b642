#include "roller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::samples {

std::vector<Contact> straight_way(const stroke::Model& model, const Vec3& from, const Vec3& heading,
                                  double step, int n) {
    std::vector<Contact> way;
    auto at = model.query->closest_point(from);
    Frame frame = make_frame(at->position, at->normal, heading);
    while (static_cast<int>(way.size()) < n) {
        way.push_back({frame, at->triangle});
        // Over an edge the nearest point lags behind: go on until the step is done.
        const Vec3 start = frame.origin;
        for (int k = 0; k < 8 && glm::length(frame.origin - start) < 0.99 * step; ++k) {
            const double rest = step - glm::length(frame.origin - start);
            at = model.query->closest_point(frame.origin + rest * frame.t);
            const Vec3 t = parallel_transport(frame.t, frame.n, at->normal);
            frame = make_frame(at->position, at->normal, t);
        }
    }
    return way;
}

std::vector<Contact> ring(const stroke::Model& model, double radius, double height, int n) {
    std::vector<Contact> way;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        const Vec3 above{radius * std::cos(a), radius * std::sin(a), height};
        const auto at = model.query->ray(above, {0, 0, -1});
        const Vec3 along{-std::sin(a), std::cos(a), 0};
        // The circle turns in the plane; in the surface by the part that lies in it.
        way.push_back({make_frame(at->position, at->normal, along), at->triangle,
                       2 * std::numbers::pi / n * at->normal.z});
    }
    return way;
}

void roll(const stroke::Model& model, ink::Canvas& canvas, int pigment, float film,
          const std::vector<Contact>& way, double step, double width, const Pattern& pattern) {
    const double cell = 0.5 * model.texels.texel_size;
    constexpr int kBar = 2;  // cells of the printing row along the way
    footprint::Footprint f;
    f.cell = cell;
    f.width = kBar + 4;
    f.height = static_cast<int>(std::ceil(width / cell)) + 4;
    f.lo = Vec2(-0.5 * f.width * cell, -0.5 * f.height * cell);
    f.radius = 0.5 * cell * std::hypot(f.width, f.height);
    footprint::PlanScratch scratch;
    footprint::Unpacked unpacked;
    footprint::StampJobs jobs;
    bool piecewise = false;
    std::array<float, atlas::kTileTexels> exposure;
    for (std::size_t i = 0; i < way.size(); ++i) {
        f.frame = way[i].frame;
        f.triangle = way[i].triangle;
        f.coverage.assign(std::size_t(f.width) * f.height, 0);
        for (int j = 2; j < f.height - 2; ++j) {
            int sum = 0;  // of four points over the cell
            for (int k = 0; k < 4; ++k)
                sum += pattern(static_cast<int>(i), f.lo.y + (j + (k + 0.5) / 4) * cell);
            for (int k = 0; k < kBar; ++k)
                f.coverage[std::size_t(j) * f.width + 2 + k] =
                    static_cast<std::uint8_t>(255 * sum / 4);
        }
        jobs = footprint::plan_stamp(model.surface(), f, {{step, 0}, way[i].turn}, {}, scratch,
                                     std::move(jobs));
        piecewise = footprint::choose_mode(jobs, piecewise, {});
        for (const footprint::TileJob& job : jobs.tiles) {
            if (!footprint::evaluate_tile(model.texels, jobs, job, unpacked, exposure)) continue;
            ink::Plane& plane = canvas.touch(job.slot, pigment);
            const auto part = static_cast<float>(film * step / (kBar * cell));
            for (int t = 0; t < atlas::kTileTexels; ++t)
                plane[t] = std::min(plane[t] + part * exposure[t], film);
        }
    }
}

}  // namespace tuft::samples
