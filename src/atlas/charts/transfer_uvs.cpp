#include "atlas/charts/transfer_uvs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "atlas/flatten/rigid_motion.h"

namespace tuft::atlas {
namespace {

constexpr std::size_t kAround = 5;  // times the triangles taken over, laid anew
constexpr std::size_t kLeastAround = 500;

/// Third corner of a triangle whose first edge lies at a, b.
Vec2 unfold(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec2& a, const Vec2& b) {
    const Vec3 e = p1 - p0, d = p2 - p0;
    const double l = std::max(glm::dot(e, e), 1e-300);
    const double along = glm::dot(d, e) / l, side = glm::length(glm::cross(e, d)) / l;
    const Vec2 u = b - a;
    return a + along * u + side * Vec2(-u.y, u.x);
}

class UvTransfer {
  public:
    UvTransfer(const FlatChart& old, const FlatChart& donor, std::span<const std::uint32_t> taken,
               const ChartMesh& chart)
        : donor_(donor),
          chart_(chart),
          uv_(chart.n_vertices()),
          known_(chart.n_vertices(), 0),
          open_(chart.n_vertices(), Vec2(0)),
          taken_(chart.faces.size(), 0),
          in_donor_(chart.faces.size(), kNone) {
        const std::vector<std::uint32_t>&before = old.mesh.triangles, &there = donor.mesh.triangles;
        for (std::size_t f = 0, k = 0, b = 0, d = 0; f < chart.faces.size(); ++f) {
            const std::uint32_t t = chart.triangles[f];
            while (k < taken.size() && taken[k] < t) ++k;
            taken_[f] = k < taken.size() && taken[k] == t;
            if (taken_[f]) {
                while (there[d] < t) ++d;
                in_donor_[f] = static_cast<std::uint32_t>(d);
                continue;
            }
            while (before[b] < t) ++b;
            for (int c = 0; c < 3; ++c) {
                uv_[chart.faces[f][c]] = old.uv[old.mesh.faces[b][c]];
                known_[chart.faces[f][c]] = 1;
            }
        }
    }

    std::vector<Vec2> run() {
        for (std::uint32_t f = 0; f < taken_.size(); ++f)
            if (taken_[f]) place(part_from(f));
        return std::move(uv_);
    }

  private:
    /// UVs in `donor` of the corners of a face that was taken.
    std::array<Vec2, 3> in_donor(std::uint32_t face) const {
        const auto& f = donor_.mesh.faces[in_donor_[face]];
        return {donor_.uv[f[0]], donor_.uv[f[1]], donor_.uv[f[2]]};
    }

    /// The taken faces that hang together with one; they are taken no more.
    std::vector<std::uint32_t> part_from(std::uint32_t first) {
        std::vector<std::uint32_t> part{first};
        taken_[first] = 0;
        for (std::size_t i = 0; i < part.size(); ++i)
            for (std::uint32_t h = 3 * part[i]; h < 3 * part[i] + 3; ++h) {
                const std::uint32_t g = chart_.twin[h];
                if (g == kNone || !taken_[g / 3]) continue;
                taken_[g / 3] = 0;
                part.push_back(g / 3);
            }
        return part;
    }

    void place(const std::vector<std::uint32_t>& part) {
        std::vector<std::array<Vec2, 2>> pairs;
        std::vector<std::uint32_t> queue;
        for (const std::uint32_t f : part) {
            const std::array<Vec2, 3> at = in_donor(f);
            const std::size_t before = pairs.size();
            for (int c = 0; c < 3; ++c)
                if (const std::uint32_t v = chart_.faces[f][c]; known_[v]) pairs.push_back({uv_[v], at[c]});
            taken_[f] = 1;
            if (pairs.size() == before) continue;
            queue.push_back(f);
            taken_[f] = 0;
        }
        const RigidMotion motion = fit_motion(pairs);
        for (const std::uint32_t f : queue) {
            const std::array<Vec2, 3> at = in_donor(f);
            for (int c = 0; c < 3; ++c)
                if (const std::uint32_t v = chart_.faces[f][c]; known_[v] == 1) open_[v] = uv_[v] - motion(at[c]);
        }
        // From the border inwards, each corner by what is open at those before it.
        for (std::size_t i = 0; i < queue.size(); ++i) {
            const std::uint32_t f = queue[i];
            const std::array<Vec2, 3> at = in_donor(f);
            Vec2 open(0);
            int count = 0;
            for (const std::uint32_t v : chart_.faces[f])
                if (known_[v]) {
                    open += open_[v];
                    ++count;
                }
            for (int c = 0; c < 3; ++c) {
                const std::uint32_t v = chart_.faces[f][c];
                if (known_[v]) continue;
                known_[v] = 2;
                open_[v] = open / double(std::max(count, 1));
                uv_[v] = motion(at[c]) + open_[v];
            }
            for (std::uint32_t h = 3 * f; h < 3 * f + 3; ++h) {
                const std::uint32_t g = chart_.twin[h];
                if (g == kNone || !taken_[g / 3]) continue;
                taken_[g / 3] = 0;
                queue.push_back(g / 3);
            }
        }
    }

    const FlatChart& donor_;
    const ChartMesh& chart_;
    std::vector<Vec2> uv_;
    std::vector<std::uint8_t> known_;      // 1: where it lay in `old`; 2: placed
    std::vector<Vec2> open_;               // between its place and the moved one in `donor`
    std::vector<std::uint8_t> taken_;      // faces still to be placed
    std::vector<std::uint32_t> in_donor_;  // which of its faces they are
};

}  // namespace

std::vector<Vec2> transfer_uvs(const FlatChart& old, const FlatChart& donor, std::span<const std::uint32_t> taken,
                               const ChartMesh& chart) {
    return UvTransfer(old, donor, taken, chart).run();
}

std::vector<Vec2> unfold_uvs(const FlatChart& old, const ChartMesh& chart) {
    std::vector<Vec2> uv(chart.n_vertices());
    std::vector<std::uint8_t> known(chart.n_vertices(), 0), done(chart.faces.size(), 0);
    std::vector<std::uint32_t> queue;
    std::size_t o = 0;
    for (std::uint32_t f = 0; f < chart.faces.size(); ++f) {
        const std::uint32_t t = chart.triangles[f];
        while (o < old.mesh.triangles.size() && old.mesh.triangles[o] < t) ++o;
        if (o == old.mesh.triangles.size() || old.mesh.triangles[o] != t) continue;
        for (int k = 0; k < 3; ++k) {
            uv[chart.faces[f][k]] = old.uv[old.mesh.faces[o][k]];
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

std::size_t count_faces_around(std::size_t n_faces, std::size_t n_come) {
    const std::size_t wanted = std::max(kAround * n_come, kLeastAround);
    return 2 * wanted > n_faces ? n_faces : wanted;
}

std::vector<std::uint32_t> faces_around(const ChartMesh& chart, std::span<const std::uint32_t> come) {
    const std::size_t wanted = count_faces_around(chart.faces.size(), come.size());
    if (wanted == chart.faces.size()) return {};
    std::vector<std::uint8_t> seen(chart.faces.size(), 0);
    std::vector<std::uint32_t> faces;
    const auto add = [&](std::uint32_t f) {
        if (!std::exchange(seen[f], 1)) faces.push_back(f);
    };
    for (std::size_t f = 0, k = 0; f < chart.faces.size(); ++f) {
        while (k < come.size() && come[k] < chart.triangles[f]) ++k;
        if (k < come.size() && come[k] == chart.triangles[f]) add(static_cast<std::uint32_t>(f));
    }
    for (std::size_t i = 0; i < faces.size() && faces.size() < wanted; ++i)
        for (std::uint32_t h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h)
            if (chart.twin[h] != kNone) add(chart.twin[h] / 3);
    return faces;
}

}  // namespace tuft::atlas
