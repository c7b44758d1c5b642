#pragma once

#include <array>

#include "atlas/log_map.h"
#include "footprint/stamp.h"

/// A surface with its maps, and what stamps do on it.
namespace tuft::footprint {

inline bool evaluate(const atlas::TexelMap& map, const StampJobs& jobs, const TileJob& job,
                     std::array<float, atlas::kTileTexels>& exposure) {
    Unpacked unpacked;
    return evaluate_tile(map, jobs, job, unpacked, exposure);
}

/// Where the stamp's frames put a texel, metres in the tangent plane.
inline Vec2 place_of(const atlas::TexelMap& map, const StampJobs& jobs, const Footprint& f,
                     std::uint32_t slot, int t) {
    for (const TileJob& job : jobs.tiles) {
        if (job.slot != slot) continue;
        for (std::uint32_t k = job.first; k < job.first + job.count; ++k) {
            if (jobs.frames[k].piece != map.tiles[slot].piece[t]) continue;
            const PieceFrame& p = jobs.piecewise ? jobs.frames[k] : jobs.stamp_frame;
            const auto vec = [](const std::array<float, 3>& a) { return Vec3{a[0], a[1], a[2]}; };
            // log_map is linear in t and b: the picture's axes take their place.
            const Frame frame{vec(p.origin), f.cell * vec(p.tu), f.cell * vec(p.tv), vec(p.normal)};
            const Vec3 m = glm::normalize(Vec3(map.normal(slot, t)));
            return atlas::log_map(frame, Vec3(map.position(slot, t)), m) +
                   (Vec2(p.u0, p.v0) + 0.5) * f.cell + f.lo;
        }
    }
    return Vec2{NAN};
}

}  // namespace tuft::footprint
