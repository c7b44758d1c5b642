#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ease.h"
#include "footprint/outline/outline_parts.h"

// Strips of a row that stands on its edge.
namespace tuft::footprint {
namespace {

// Cosine from the normal of the surface to a broad axis from which on a strip begins to stand on its edge, and from
// which on it does.
constexpr double kBeginsEdge = 0.6, kIsEdge = 0.8;
constexpr double kLeastPart = 0.25;  // of its half width, that a strip is narrowed to

/// Half axes of a section's hair, metres.
struct HairAxes {
    Vec3 broad, thick;

    explicit HairAxes(const brush::Section& s)
        : broad(s.turn.x * s.a * s.e + s.turn.y * s.b * s.m), thick(s.turn.x * s.b * s.m - s.turn.y * s.a * s.e) {}

    /// Gives a section the ellipse of these axes, whose own differ least from what they were.
    void set(brush::Section& s) const {
        using std::numbers::pi;
        const double across = 2 * glm::dot(broad, thick), more = glm::dot(broad, broad) - glm::dot(thick, thick);
        const double own = std::atan2(-s.turn.y, s.turn.x);
        double turn = 0.5 * std::atan2(across, more);
        turn += 0.5 * pi * std::round((own - turn) / (0.5 * pi));
        const Vec3 e = std::cos(turn) * broad + std::sin(turn) * thick,
                   m = std::cos(turn) * thick - std::sin(turn) * broad;
        const double a = glm::length(e), b = glm::length(m);
        if (!(std::min(a, b) > 1e-9)) return;
        s.a = a;
        s.b = b;
        s.e = e / a;
        s.m = m / b;
        s.turn = {std::cos(turn), -std::sin(turn)};
    }
};

}  // namespace

Recycled<brush::Branch> bound_on_edge(const brush::TuftState& tuft, const Frame& frame,
                                      std::span<const NodePlanes> planes) {
    Recycled<brush::Branch> out(tuft.branches.begin(), tuft.branches.end());
    for (std::size_t k = 0; k < out.size(); ++k) {
        const Recycled<brush::Section>& own = tuft.branches[k].sections;
        for (std::size_t i = 0; i < own.size(); ++i) {
            const bool plane = k < planes.size() && i < planes[k].size();
            const Vec3 normal = plane ? planes[k][i].normal : frame.n;
            HairAxes axes(own[i]);
            const double half = glm::length(axes.broad);
            if (!(half > 1e-9)) continue;
            const Vec3 broad = axes.broad / half;
            const double on_edge =
                smooth_step((std::abs(glm::dot(broad, normal)) - kBeginsEdge) / (kIsEdge - kBeginsEdge));
            if (on_edge <= 0) continue;
            double up = half, down = half;  // along the broad axis and against it
            for (const brush::Opening& pair : tuft.openings) {
                if (pair.first != static_cast<int>(k) && pair.second != static_cast<int>(k)) continue;
                const Recycled<brush::Section>& beside =
                    tuft.branches[pair.first == static_cast<int>(k) ? pair.second : pair.first].sections;
                const std::size_t from_root = own.size() - i;
                if (from_root > beside.size()) continue;
                const Vec3 to = beside[beside.size() - from_root].centre - own[i].centre;
                double& side = glm::dot(to, broad) > 0 ? up : down;
                // At the height that is midway, where the hair between both spines is.
                const double midway =
                    0.5 * std::abs(glm::dot(to, normal) / glm::dot(broad, normal)) / Trail::kStripChord;
                side = std::min(side, std::lerp(half, std::clamp(midway, kLeastPart * half, half), on_edge));
            }
            if (up + down >= 2 * half) continue;
            brush::Section& s = out[k].sections[i];
            const double part = 0.5 * (up + down) / half;
            s.centre += 0.5 * Trail::kStripChord * (up - down) * broad;
            axes.broad *= part;
            axes.set(s);
        }
    }
    return out;
}

}  // namespace tuft::footprint
