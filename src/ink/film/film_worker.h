#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "ink/canvas/canvas.h"
#include "ink/film/tile/film_tile.h"

/// \file
/// Per-thread buffers of the wet film. Internal to the wet film (film.h).
namespace tuft::ink::wet {

/// Flow over a tile's links.
struct Crossing {
    std::vector<SeamLanes> lanes;
    std::vector<std::uint8_t> texels;  ///< [size] where links start
    std::vector<float> beyond;         ///< [pigment][links] amounts at their other ends
    std::size_t links = 0, size = 0;   ///< of the tile, and those with liquid at either end
    std::uint32_t pigments = 0;        ///< bits: those that have planes there

    void clear(std::size_t n, int n_pigments) {
        links = n;
        size = 0;
        pigments = 0;
        if (n == 0) return;
        lanes.resize((n + kSide - 1) / kSide);
        texels.resize(n);
        beyond.resize(n * static_cast<std::size_t>(n_pigments));
    }
    void add(const atlas::SeamLink& link, float flow_area, const std::array<float, 2>& w,
             const std::array<float, 2>& s) {
        SeamLanes& l = lanes[size / kSide];
        const std::size_t lane = size % kSide;
        l.weight[lane] = link.weight;
        l.flow_area[lane] = flow_area;
        l.apart[lane] = static_cast<float>(link.apart) / 64;
        for (int end = 0; end < 2; ++end) l.w[end][lane] = w[end], l.s[end][lane] = s[end];
        texels[size++] = link.texel;
    }
};

/// Prefetch queue. Planes are scattered in memory, and a cache miss is slow, but a dozen may be in flight: some are
/// issued between one loop and the next. They go to the second-level cache, since the first holds the current tile.
struct Ahead {
    static constexpr int kSecondCache = 2;

    struct Piece {
        const char *at, *end;
    };
    std::array<Piece, 256> clusters;
    std::size_t n = 0, next = 0;

    void clear() { n = next = 0; }
    void add(const void* from, std::size_t begin, std::size_t end) {
        const char* at = static_cast<const char*>(from);
        if (from && n < clusters.size()) clusters[n++] = {at + begin, at + end};
    }
    void fetch(int lines) {
        for (; lines > 0 && next < n; ++next) {
            Piece& cluster = clusters[next];
            for (; cluster.at < cluster.end && lines > 0; cluster.at += 64, --lines)
                __builtin_prefetch(cluster.at, 0, kSecondCache);
            if (cluster.at < cluster.end) return;
        }
    }
};

/// Free planes for reuse, the most recent still in cache; one stack per kind, so that the planes of a tile stay on
/// few memory pages.
using Spare = std::array<std::vector<PlanePtr>, 2 + kMaxPigments>;

/// What a thread works with.
struct Worker {
    Work work;
    Ahead ahead;
    Crossing crossing;
    Spare spare;
    Plane drying;  ///< factors of a tile
};

}  // namespace tuft::ink::wet
