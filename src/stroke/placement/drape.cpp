#include "stroke/placement/drape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/system/interrupt.h"

namespace tuft::stroke {

namespace {

using mesh::SurfaceQuery;

constexpr std::size_t kMostSteps = 20'000;

/// One step of a straightest line: ahead on the osculating paraboloid, then onto the surface.
SurfacePatch step(const SurfaceQuery& query, const SurfacePatch& from, double length, double radius) {
    const double k = from.found ? from.curvature[0] : 0, mixed = from.found ? from.curvature[1] : 0;
    const Vec3 side = glm::cross(from.normal, from.heading);
    SurfacePatch guess = from;
    guess.found = false;
    const double turn = k * length;
    guess.position += length * (1 - turn * turn / 6) * from.heading + 0.5 * turn * length * from.normal;
    guess.normal = glm::normalize(from.normal - length * (k * from.heading + mixed * side));
    guess.heading = into_plane(parallel_transport(from.heading, from.normal, guess.normal), guess.normal);
    SurfacePatch next = fit_patch(query, guess, radius);
    if (!next.found) {  // past an edge: straight on
        next = from;
        next.found = false;
        next.position += length * from.heading;
    }
    return next;
}

}  // namespace

Drape::Drape(const SurfaceQuery& query, const Placement& place)
    : query_(query), radius_(drape_radius(query.mesh())), stride_(0.5 * radius_) {
    const auto start = query.closest_point(place.origin);
    if (!start) throw Error("there is no surface to map a stroke onto");
    gap_ = start->distance;
    SurfacePatch patch{
        start->position, start->normal, axes_across(start->normal, place.right, place.down).right, {0, 0, 0}, true};
    for (int pass = 0; pass < 4; ++pass) patch = fit_patch(query, patch, radius_);
    origin_ = patch;
    axes_ = axes_across(patch.normal, place.right, place.down);
    hand_ = glm::dot(glm::cross(axes_.right, patch.normal), axes_.down) < 0 ? -1 : 1;
}

SurfaceSample Drape::at(const Vec2& flat) {
    const double length = glm::length(flat);
    const double angle = std::atan2(flat.y, flat.x) / (2 * std::numbers::pi) * kRays;
    const double left = std::floor(angle), u = angle - left;
    const double along = length / stride_;
    const auto ring = static_cast<std::size_t>(std::min(along, double(kMostSteps - 1)));
    const double v = along - double(ring);
    SurfaceSample out;
    out.position = out.normal = out.right = out.down = Vec3(0);
    for (int r = 0; r < 2; ++r) {
        const int ray = ((static_cast<int>(left) + r) % kRays + kRays) % kRays;
        const std::array<SurfacePatch, 2> patches = patches_of(ray, ring);
        const double phi = 2 * std::numbers::pi * ray / kRays;
        for (std::size_t s = 0; s < 2; ++s) {
            const double weight = (r ? u : 1 - u) * (s ? v : 1 - v);
            const SurfacePatch& g = patches[s];
            const Vec3 side = hand_ * glm::cross(g.heading, g.normal);
            out.position += weight * g.position;
            out.normal += weight * g.normal;
            out.right += weight * (std::cos(phi) * g.heading - std::sin(phi) * side);
            out.down += weight * (std::sin(phi) * g.heading + std::cos(phi) * side);
            if (!g.found && weight > 0.25) out.on_surface = false;
        }
    }
    out.normal = glm::normalize(out.normal);
    const Axes axes = axes_across(out.normal, out.right, out.down);
    out.right = axes.right;
    out.down = axes.down;
    return out;
}

std::array<SurfacePatch, 2> Drape::patches_of(int ray, std::size_t ring) {
    Line& of_ray = lines_[static_cast<std::size_t>(ray)];
    const std::lock_guard lock(of_ray.mutex);
    std::vector<SurfacePatch>& line = of_ray.patches;
    if (line.empty()) {
        const double phi = 2 * std::numbers::pi * ray / kRays;
        SurfacePatch start = origin_;
        start.heading = std::cos(phi) * axes_.right + std::sin(phi) * axes_.down;
        start.curvature = fit_patch(query_, start, radius_).curvature;
        line.push_back(start);
        ++n_patches_;
    }
    while (line.size() <= ring + 1) {
        check_interrupt();
        line.push_back(step(query_, line.back(), stride_, radius_));
        ++n_patches_;
    }
    return {line[ring], line[ring + 1]};
}

std::shared_ptr<Drape> Drapes::of(const Placement& place) {
    const std::lock_guard lock(mutex_);
    auto found = std::ranges::find_if(kept_, [&](const Kept& kept) { return kept.place == place; });
    if (found == kept_.end()) found = kept_.insert(kept_.end(), {place, std::make_shared<Drape>(*surface_, place)});
    kept_.splice(kept_.begin(), kept_, found);
    if (kept_.size() > kMost) kept_.pop_back();
    return kept_.front().drape;
}

void Drapes::drop_large() {
    const std::lock_guard lock(mutex_);
    std::erase_if(kept_, [&](const Kept& kept) { return kept.drape->bytes() > large_; });
}

double drape_radius(const mesh::TriangleMesh& mesh) {
    return std::min(0.008, 0.04 * mesh.bounds.diagonal());
}

SurfaceTrace map_draped(const SurfaceQuery& query, const StrokeSamples& trace, Drapes* shared,
                        std::vector<Vec3>* over) {
    const bool shares = shared && &shared->surface() == &query;
    const std::shared_ptr<Drape> kept =
        shares ? shared->of(trace.placement) : std::make_shared<Drape>(query, trace.placement);
    Drape& drape = *kept;
    SurfaceTrace mapped;
    mapped.origin_gap = drape.origin_gap();
    mapped.samples.reserve(trace.samples.size());
    if (over) over->clear();
    for (const StrokeSample& s : trace.samples) {
        check_interrupt();
        SurfaceSample out = drape.at(Vec2(s.position));
        const SurfaceSample hand = hand_data(s);
        out.time = hand.time;
        out.pressure = hand.pressure;
        out.tilt = hand.tilt;
        out.roll = hand.roll;
        if (over) over->push_back(out.position);
        const double up = clearance(query, out.position, out.normal, drape.radius());
        if (const auto hit = exact_ray(query, out.position + up * out.normal, -out.normal, up + drape.radius())) {
            out.on = *hit;
            out.position = hit->position;
        } else {
            out.on = *query.closest_point(out.position);
            out.on_surface = false;
        }
        mapped.missed += !out.on_surface;
        mapped.samples.push_back(out);
    }
    if (shares) shared->drop_large();
    return mapped;
}

}  // namespace tuft::stroke
