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
        if (std::tie(b.slot, b.texel) < std::tie(a.slot, a.texel)) std::swap(a, b);
        found.push_back({a, b, s.length / std::max(distance, 0.5)});
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
        } else {
            couplings[n++] = c;
        }
    }
    couplings.resize(n);
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
