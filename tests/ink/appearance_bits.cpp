// Prints a hash of tiles coloured by src/ink/composite/composite.cpp, which is compiled into this program
// for one instruction set (same_bits.sh compares them). Prints "skipped" where it cannot run.
#include <cstdio>

#include "core/hash.h"
#include "core/random.h"
#include "ink/composite/composite.h"
#include "instructions.h"

int main(int n_arguments, char** arguments) {
    using namespace tuft;
    using namespace tuft::ink;
    if (n_arguments > 1 && !tuft::test::has_instructions(arguments[1])) {
        std::puts("skipped");
        return 0;
    }
    std::uint64_t hash = 0;
    std::vector<Pigment> pigments;
    for (int p = 0; p < 4; ++p) {
        Pigment made;
        for (int b = 0; b < kBands; ++b) {
            made.k[b] = static_cast<float>(3 * uniform(p, b));
            made.s[b] = static_cast<float>(2 * uniform(p + 10, b));
        }
        pigments.push_back(made);
    }
    for (int round = 0; round < 20; ++round) {
        std::array<Plane, 6> planes;
        for (int p = 0; p < 6; ++p)
            for (int t = 0; t < atlas::kTileTexels; ++t)
                planes[p][t] = static_cast<float>(3 * uniform(100 + round, 1000 * p + t) * uniform(200 + p, t));
        for (float& m : planes[4]) m = m < 1 ? m : 1;
        const TileFilm films[] = {
            {.pigments = {&planes[0], &planes[1]}},
            {.pigments = {nullptr, &planes[1], &planes[2], &planes[3]}, .mask = &planes[4], .opacity = 0.8f}};
        Substrate substrate;
        substrate.interface = 0.5f * static_cast<float>(round % 3);
        const TileAppearance look = shade_films(films, round % 2 ? &planes[5] : nullptr, pigments, substrate);
        for (const auto& channel : look.colour) hash = hash_bytes(channel.data(), sizeof channel, hash);
        hash = hash_bytes(look.roughness.data(), sizeof look.roughness, hash);
        hash = hash_bytes(look.height.data(), sizeof look.height, hash);
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(hash));
}
