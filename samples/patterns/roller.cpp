#include "roller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "footprint/stamp/plan_scratch.h"

namespace tuft::samples {
namespace {

constexpr double kWheel = 2.5e-3;  // metres, radius: too wide for the shut lines of the car

}  // namespace

std::vector<Contact> straight_track(const stroke::Model& model, const Vec3& from, const Vec3& heading, double step,
                                    int n) {
    const auto start = model.query->closest_point(from);
    Frame frame = make_frame(start->position, start->normal, heading);
    std::vector<Contact> track{{frame, start->triangle}};
    double gone = 0;  // since the last place
    while (static_cast<int>(track.size()) < n) {
        const Vec3 centre = frame.origin + kWheel * frame.n + 0.25 * step * frame.t;
        const auto at = model.query->closest_point(centre);
        const Vec3 normal = glm::normalize(centre - at->position);
        const Vec3 leap = at->position - frame.origin;
        const double length = glm::length(leap);
        gone += length;
        frame = make_frame(at->position, normal, parallel_transport(frame.t, frame.n, normal));
        for (; gone >= step; gone -= step) {
            // A hollow that the wheel is too wide for is printed, a gap is not.
            const auto on = model.query->closest_point(at->position - (gone - step) / length * leap);
            Contact place{frame, length < 0.5 * kWheel ? on->triangle : kNone};
            place.frame.origin = on->position;
            track.push_back(place);
        }
    }
    return track;
}

std::vector<Contact> ring(const stroke::Model& model, double radius, double height, int n) {
    std::vector<Contact> track;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        const Vec3 above{radius * std::cos(a), radius * std::sin(a), height};
        const auto at = model.query->ray(above, {0, 0, -1});
        const Vec3 along{-std::sin(a), std::cos(a), 0};
        track.push_back({make_frame(at->position, at->normal, along), at->triangle});
    }
    return track;
}

void roll(const stroke::Model& model, ink::Canvas& canvas, const std::vector<Contact>& track, const Print& print,
          const Pattern& pattern) {
    const auto& [pigment, film, step, width] = print;
    const double cell = 0.5 * model.texels.texel_size;
    // The wheel flattens over four steps, so that rows that fan out where the surface bends like a
    // saddle leave nothing blank between them.
    const int flat = std::max(2, static_cast<int>(std::ceil(4 * step / cell)));
    footprint::Footprint f;
    f.cell = cell;
    f.width = flat + 4;
    f.height = static_cast<int>(std::ceil(width / cell)) + 4;
    f.lo = Vec2(-0.5 * f.width * cell, -0.5 * f.height * cell);
    f.radius = 0.5 * cell * std::hypot(f.width, f.height);
    // On rows of a few texels the change from one frame for all to one for each cluster would show.
    const footprint::StampOptions options{.enter = 0, .leave = 0};
    footprint::PlanScratch scratch;
    footprint::Unpacked unpacked;
    footprint::StampJobs jobs;
    std::array<float, atlas::kTileTexels> exposure;
    for (std::size_t i = 0; i < track.size(); ++i) {
        if (track[i].triangle == kNone) continue;
        f.frame = track[i].frame;
        f.triangle = track[i].triangle;
        f.coverage.assign(std::size_t(f.width) * f.height, 0);
        for (int j = 2; j < f.height - 2; ++j)
            for (int k = 2; k < f.width - 2; ++k) {
                constexpr int kPoints = 4;  // along the side of a cell
                int sum = 0;
                for (int p = 0; p < kPoints * kPoints; ++p) {
                    const double u = f.lo.x + (k + (p % kPoints + 0.5) / kPoints) * cell;
                    const double v = f.lo.y + (j + (p / kPoints + 0.5) / kPoints) * cell;
                    sum += pattern(double(i) * step + u, v);
                }
                f.coverage[std::size_t(j) * f.width + k] = static_cast<std::uint8_t>(255 * sum / (kPoints * kPoints));
            }
        jobs = footprint::plan_stamp(model.surface(), f, {}, options, {scratch, std::move(jobs)});
        footprint::choose_mode(jobs, true, options);
        for (const footprint::TileJob& job : jobs.tiles) {
            if (!footprint::evaluate_tile(model.texels, jobs, job, unpacked, exposure)) continue;
            ink::Plane& plane = canvas.touch(job.slot, pigment);
            for (int t = 0; t < atlas::kTileTexels; ++t) plane[t] = std::max(plane[t], film * exposure[t]);
        }
    }
}

}  // namespace tuft::samples
