// Prints a hash of what touches leave on a tile and on the nodes of the tuft: ink both ways, ink onto dry texels and
// paste. Their kernels are compiled into this program for one instruction set (same_bits.sh compares them). Prints
// "skipped" where it cannot run.
#include <cstdio>
#include <utility>

#include "core/hash.h"
#include "core/random.h"
#include "ink/exchange/deposit_mixed.h"
#include "ink/exchange/transfer.h"
#include "ink/film/tile/paste.h"
#include "instructions.h"

namespace {

using namespace tuft;
using namespace tuft::ink;

constexpr int kN = atlas::kTileTexels, kPigments = 3;

float chance(std::uint64_t a, std::uint64_t b) {
    return static_cast<float>(uniform(a, b));
}

/// A tile under part of a contact patch, with bare and dry texels.
struct Tile {
    Canvas canvas{1};
    std::array<float, kN> coverage, area;
    TexelPlaces places;
    HatBasis hats;

    explicit Tile(std::uint64_t seed) {
        for (const char* name : {"indigo", "gamboge", "cinnabar"}) mix_of(canvas, load_ink(name));
        for (int t = 0; t < kN; ++t) {
            coverage[t] = std::max(0.0f, 1.4f * chance(seed, t) - 0.3f);
            area[t] = 1e-8f * (0.7f + 0.6f * chance(seed + 1, t));
            places.along[t] = 0.3f + 0.15f * static_cast<float>(t / atlas::kTile) + 0.1f * chance(seed + 2, t);
            places.across[t] = 1.1f + 0.3f * static_cast<float>(t % atlas::kTile) + 0.1f * chance(seed + 3, t);
            if (chance(seed + 4, t) < 0.2f) continue;
            canvas.touch_liquid(0, Liquid::film)[t] = 6 * chance(seed + 5, t);
            if (seed % 2) canvas.touch_liquid(0, Liquid::pores)[t] = 3 * chance(seed + 6, t);
            canvas.touch(0, 0)[t] = 1.5f * chance(seed + 7, t);
            canvas.touch(0, 1)[t] = chance(seed + 8, t);
        }
        hat_basis(hats, places, coverage);
    }
};

}  // namespace

int main(int n_arguments, char** arguments) {
    if (n_arguments > 1 && !tuft::test::has_instructions(arguments[1])) {
        std::puts("skipped");
        return 0;
    }
    std::uint64_t hash = 0;
    const auto add = [&](const auto& a) { hash = hash_bytes(&a, sizeof a, hash); };
    for (std::uint64_t round = 0; round < 24; ++round) {
        Tile tile(100 * round + round % 2);
        TransferParams p;
        p.deposit = {
            .target = 1.8f + static_cast<float>(round % 3), .capacity = 6, .extinction = round % 4 < 2 ? 0.0f : 0.7f};
        p.uptake = 0.4f * chance(round, 1);
        p.free_capacity = round % 5 ? 2.0f : 0.0f;
        p.pour = round % 6 ? 0.0f : 0.5f;
        NodeMixes mixes{};
        FurrowDepths furrows;
        for (int i = 0; i < kFirmnessSamples; ++i) furrows[i] = p.rub[i] = 0.4f + 1.2f * chance(round + 30, i);
        for (int node = 0; node < kNodes; ++node) {
            p.exchange[node] = chance(round + 31, node);
            for (int k = 0; k < kPigments; ++k) mixes[k][node] = 0.3f * chance(round + 40, 10 * node + k);
            for (int k = 0; k < kPigments; ++k) p.film[k][node] = 4 * mixes[k][node];
            p.film[kMaxPigments][node] = chance(round + 50, node);
        }
        NodeContents given{}, taken{};
        for (int touch = 0; touch < 3; ++touch) {
            transfer(tile.canvas, {{{0, tile.coverage, tile.area}, 4e-5}, tile.places, tile.hats}, p, given);
            p.deposit.mix = {0.2f, 0.1f, 0.05f};
            add(deposit(tile.canvas, {0, tile.coverage, tile.area}, p.deposit, deposit_law(p.deposit, 3e-5)));
            deposit_mixed(tile.canvas, {{0, tile.coverage, tile.area}, 3e-5}, tile.hats, p.deposit, mixes, given);
            const Plane before = open_pigment(tile.canvas, 0);
            deposit_paste(tile.canvas, {{{0, tile.coverage, tile.area}, 5e-5}, tile.places, tile.hats},
                          {.target = 12, .exchange = 0.2, .free_capacity = 3, .furrows = furrows}, mixes, before,
                          {given, taken});
        }
        add(given);
        add(taken);
        for (int k = 0; k < kPigments; ++k) add(*tile.canvas.plane(0, k));
        add(*tile.canvas.liquid(0, Liquid::film));
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(hash));
}
