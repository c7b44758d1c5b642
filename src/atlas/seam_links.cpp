#include "atlas/seam_links.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "atlas/seams.h"
#include "core/parallel.h"

namespace tuft::atlas {
namespace {

constexpr double kSpacing = 0.25;  // texels between samples
constexpr double kSearch = 2.0;    // texels from the seam to the texel beside it

struct Coupling {
    TexelRef a, b;
    double weight;
    Vec3 lack_a, lack_b;  ///< of conductance: m11, m12, m22

    auto pair() const { return std::tie(a.slot, a.texel, b.slot, b.texel); }
};

Vec2 texel_centre(const TexelMap& map, const TexelRef& ref) {
    const std::uint32_t tile = map.tile_of_slot[ref.slot];
    return {double(tile % map.tiles_per_side) * kTile + ref.texel % kTile + 0.5,
            double(tile / map.tiles_per_side) * kTile + ref.texel / kTile + 0.5};
}

/// Texels from the seam to the texel, across the seam.
double distance_to_seam(const TexelMap& map, const TexelRef& ref, const SeamSide& side) {
    const Vec2 d = texel_centre(map, ref) - side.uv;
    return std::abs(d.x * side.along.y - d.y * side.along.x);
}

/// How far the texel lies along the seam from where it was looked for.
double along_seam(const TexelMap& map, const TexelRef& ref, const SeamSide& side) {
    return glm::dot(texel_centre(map, ref) - side.uv, side.along);
}

/// `SeamBalance` of a piece of seam. Of an edge of the texels along (cos α, sin α) and as long as 1, |sin α| and
/// |cos α| half faces are missing, across and along the atlas.
Vec3 lack(const SeamSide& side, double length, double slip) {
    const Vec2 t = glm::abs(side.along);
    return (0.5 * length * (t.x * t.x * t.y + t.x * t.y * t.y) - slip) *
           Vec3{t.x * t.x, side.along.x * side.along.y, t.y * t.y};
}

/// Side by side inside the atlas: the grid couples them already.
bool grid_neighbours(const TexelMap& map, const TexelRef& a, const TexelRef& b) {
    const Vec2 d = glm::abs(texel_centre(map, a) - texel_centre(map, b));
    return d.x + d.y < 1.5;
}

void couple(const TexelMap& map, const Atlas& atlas, const std::vector<SeamSample>& samples,
            std::vector<Coupling>& found) {
    for (const SeamSample& s : samples) {
        TexelRef a =
            nearest_texel(map, atlas.triangle_chart[s.a.triangle], s.a.uv, s.position, kSearch);
        TexelRef b =
            nearest_texel(map, atlas.triangle_chart[s.b.triangle], s.b.uv, s.position, kSearch);
        if (!a.valid() || !b.valid() || a == b || grid_neighbours(map, a, b)) continue;
        const double distance = distance_to_seam(map, a, s.a) + distance_to_seam(map, b, s.b);
        const double askew = along_seam(map, b, s.b) - along_seam(map, a, s.a), weight = s.length / std::max(distance, 0.5);
        const double slip = 0.5 * weight * askew * askew;
        const Vec3 lack_a = lack(s.a, s.length, slip), lack_b = lack(s.b, s.length, slip);
        if (std::tie(b.slot, b.texel) < std::tie(a.slot, a.texel)) found.push_back({b, a, weight, lack_b, lack_a});
        else found.push_back({a, b, weight, lack_a, lack_b});
    }
}

/// Adds up the weights of equal pairs, in the order they were found.
void merge(std::vector<Coupling>& couplings) {
    std::stable_sort(couplings.begin(), couplings.end(),
                     [](const Coupling& x, const Coupling& y) { return x.pair() < y.pair(); });
    std::size_t n = 0;
    for (const Coupling& c : couplings) {
        if (n > 0 && couplings[n - 1].pair() == c.pair()) {
            couplings[n - 1].weight += c.weight;
            couplings[n - 1].lack_a += c.lack_a;
            couplings[n - 1].lack_b += c.lack_b;
        } else {
            couplings[n++] = c;
        }
    }
    couplings.resize(n);
}

/// Sums per texel, in the order of the couplings.
void add_balance(const std::vector<Coupling>& couplings, std::uint32_t n_slots, SeamLinks& result) {
    struct Part {
        TexelRef texel;
        Vec3 m;
    };
    std::vector<Part> parts;
    for (const Coupling& c : couplings) parts.push_back({c.a, c.lack_a}), parts.push_back({c.b, c.lack_b});
    std::stable_sort(parts.begin(), parts.end(), [](const Part& x, const Part& y) {
        return std::tie(x.texel.slot, x.texel.texel) < std::tie(y.texel.slot, y.texel.texel);
    });
    result.balance_start.assign(n_slots + 1, 0);
    for (std::size_t i = 0; i < parts.size();) {
        const TexelRef texel = parts[i].texel;
        Vec3 sum{0};
        for (; i < parts.size() && parts[i].texel == texel; ++i) sum += parts[i].m;
        const Vec3f m(sum);
        result.balance.push_back({texel.texel, m.x, m.y, m.z});
        ++result.balance_start[texel.slot + 1];
    }
    for (std::size_t s = 0; s < n_slots; ++s) result.balance_start[s + 1] += result.balance_start[s];
}

}  // namespace

SeamLinks build_seam_links(const mesh::TriangleMesh& mesh, const Atlas& atlas,
                           const TexelMap& map) {
    const std::vector<SeamEdge> seams = find_seams(mesh, atlas);
    constexpr std::size_t kChunk = 64;
    std::vector<std::vector<Coupling>> by_chunk((seams.size() + kChunk - 1) / kChunk);
    parallel_for(by_chunk.size(), 1, [&](std::size_t begin, std::size_t end) {
        std::vector<SeamSample> samples;
        for (std::size_t chunk = begin; chunk < end; ++chunk) {
            samples.clear();
            const std::size_t last = std::min(seams.size(), (chunk + 1) * kChunk);
            for (std::size_t e = chunk * kChunk; e < last; ++e)
                sample_seam(mesh, atlas, seams[e], kSpacing, samples);
            couple(map, atlas, samples, by_chunk[chunk]);
        }
    });
    std::vector<Coupling> couplings;
    for (const auto& c : by_chunk) couplings.insert(couplings.end(), c.begin(), c.end());
    merge(couplings);

    SeamLinks result;
    result.start.assign(map.n_slots() + 1, 0);
    for (const Coupling& c : couplings) {
        ++result.start[c.a.slot + 1];
        ++result.start[c.b.slot + 1];
    }
    for (std::size_t s = 0; s < map.n_slots(); ++s) result.start[s + 1] += result.start[s];
    result.links.resize(result.start.back());
    std::vector<std::uint32_t> next(result.start.begin(), result.start.end() - 1);
    for (const Coupling& c : couplings) {
        const auto weight = static_cast<float>(c.weight);
        result.links[next[c.a.slot]++] = {c.b.slot, weight, c.a.texel, c.b.texel};
        result.links[next[c.b.slot]++] = {c.a.slot, weight, c.b.texel, c.a.texel};
    }
    add_balance(couplings, map.n_slots(), result);
    for (std::size_t s = 0; s < map.n_slots(); ++s) {
        std::sort(result.links.begin() + result.start[s],
                  result.links.begin() + result.start[s + 1],
                  [](const SeamLink& x, const SeamLink& y) {
                      return std::tie(x.texel, x.other_slot, x.other_texel) <
                             std::tie(y.texel, y.other_slot, y.other_texel);
                  });
    }
    return result;
}

}  // namespace tuft::atlas
