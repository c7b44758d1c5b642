#include "brush/papers/macro/macro_cluster.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::brush::macro {

namespace {

constexpr double kAlike = 1e-9;  ///< lengths and radians, between a macro and the copy of another

Vec3 mirror_normal(const Mirror& mirror, const Pose& pose) {
    return pose.rotation * Vec3(mirror.normal, 0);
}

Vec3 reflected(const Vec3& p, const Vec3& through, const Vec3& normal) {
    return p - 2 * glm::dot(p - through, normal) * normal;
}

Vec2 reflected(const Vec2& v, const Mirror& mirror) {
    return v - 2 * glm::dot(v, mirror.normal) * mirror.normal;
}

/// Angle of an axis after the reflection: axes have no sense, so half turns do not count.
double reflected_angle(double angle, const Mirror& mirror) {
    return 2 * std::atan2(mirror.normal.y, mirror.normal.x) - angle;
}

bool same_angle(double a, double b) {
    return std::abs(std::sin(a - b)) < kAlike;
}

bool alike(const HairMacro& a, const HairMacro& b, double length) {
    for (int k = 0; k < 4; ++k) {
        if (glm::length(a.skeleton[k] - b.skeleton[k]) > kAlike * length) return false;
        if (glm::length(a.rest.skeleton[k] - b.rest.skeleton[k]) > kAlike * length) return false;
        if (std::abs(a.widening[k] - b.widening[k]) > kAlike || !same_angle(a.turn[k], b.turn[k])) return false;
    }
    return std::abs(a.rest.share - b.rest.share) < kAlike && std::abs(a.rest.axes.l - b.rest.axes.l) < kAlike &&
           same_angle(a.rest.turn, b.rest.turn) && std::abs(a.growth - b.growth) < kAlike;
}

/// Whether a mirrored macro meets the same surface in the same way.
bool keeps(const Mirror& mirror, const Collision& c, const Pose& before) {
    const Vec3 now = mirror_normal(mirror, c.pose), then = mirror_normal(mirror, before);
    const auto in_plane = [&](const Vec3& v) { return std::abs(glm::dot(v, now)) < kAlike; };
    return glm::length(now - then) < kAlike && in_plane(c.aside) && in_plane(c.push) &&
           std::all_of(c.planes.begin(), c.planes.end(),
                       [&](const ContactPlane& p) { return in_plane(p.normal) && p.beyond_normal == Vec3{0}; });
}

}  // namespace

HairMacro mirrored(const HairMacro& macro, const Mirror& mirror, const Pose& pose) {
    HairMacro m = macro;
    const Vec3 normal = mirror_normal(mirror, pose);
    for (int k = 0; k < 4; ++k) {
        m.skeleton[k] = reflected(macro.skeleton[k], pose.position, normal);
        m.rest.skeleton[k] = reflected(macro.rest.skeleton[k], Vec3{0}, Vec3(mirror.normal, 0));
        m.turn[k] = reflected_angle(macro.turn[k], mirror);
    }
    m.rest.offset = reflected(macro.rest.offset, mirror);
    m.rest.turn = reflected_angle(macro.rest.turn, mirror);
    return m;
}

std::vector<HairMacro> macros_of(const std::vector<MacroCluster>& clusters, const Vec2& across, const Pose& pose) {
    std::vector<HairMacro> macros;
    for (const MacroCluster& cluster : clusters) {
        macros.push_back(cluster.primitive);
        for (const Mirror& copy : cluster.copies) macros.push_back(mirrored(cluster.primitive, copy, pose));
    }
    std::stable_sort(macros.begin(), macros.end(), [&](const HairMacro& a, const HairMacro& b) {
        return glm::dot(a.rest.offset, across) < glm::dot(b.rest.offset, across);
    });
    return macros;
}

void release_copies(std::vector<MacroCluster>& clusters, const Collision& collision, const Pose& before) {
    const std::size_t count = clusters.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::vector<Mirror> copies = std::move(clusters[i].copies);
        clusters[i].copies.clear();
        for (const Mirror& copy : copies) {
            if (keeps(copy, collision, before))
                clusters[i].copies.push_back(copy);
            else
                clusters.push_back({mirrored(clusters[i].primitive, copy, before), {}});
        }
    }
}

std::vector<MacroCluster> cluster_of(std::vector<HairMacro> macros, const Pose& pose, double length) {
    std::vector<MacroCluster> clusters;
    for (HairMacro& macro : macros) {
        const double aside = glm::length(macro.rest.offset);
        const Mirror mirror{aside > 0 ? macro.rest.offset / aside : Vec2{1, 0}};
        const auto twin = std::find_if(clusters.begin(), clusters.end(), [&](const MacroCluster& c) {
            return aside > 0 && c.copies.empty() && alike(mirrored(c.primitive, mirror, pose), macro, length);
        });
        if (twin == clusters.end())
            clusters.push_back({std::move(macro), {}});
        else
            twin->copies.push_back(mirror);
    }
    return clusters;
}

}  // namespace tuft::brush::macro
