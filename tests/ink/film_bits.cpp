// Prints a hash of tiles of the wet film stepped by src/ink/film/tile/film_kernel.cpp, which is compiled into
// this program for one instruction set (same_bits.sh compares them). Prints "skipped" where it cannot run.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "core/hash.h"
#include "core/random.h"
#include "ink/film/seepage.h"
#include "ink/film/tension.h"
#include "ink/film/tile/film_tile.h"
#include "instructions.h"

namespace {

using namespace tuft;
using namespace tuft::ink;
using namespace tuft::ink::wet;

float chance(std::uint64_t a, std::uint64_t b) {
    return static_cast<float>(uniform(a, b));
}

/// Texels outside the charts.
bool beside(int texel) {
    return texel % 29 == 7;
}

/// Levelling by tension of one tile, alone and over a seam to itself.
template <class Add>
void level(const Field& w, const Geometry& g, Work& work, Add&& add) {
    auto tile = std::make_unique<TensionTile>();
    tile->w = w;
    tile->held = 0.3f;
    const std::array<TensionLink, 2> links{{{0, 17, 200, 0.7f, 5, 0.5f}, {0, 200, 17, 0.7f, 5, 0.5f}}};
    open_texels(*tile, g, 30);
    hold_rims(*tile, g);
    add(tile->inner);
    set_faces(*tile, g);
    sum_faces(tile->grid, links, 1);
    coarsen(tile->grid, tile->grid2);
    sum_faces(tile->grid2, links, 0.5f);
    coarsen(tile->grid2, tile->grid4);
    sum_faces(tile->grid4, links, 0.25f);
    for (int i = 0; i < 3; ++i) {
        relax(tile->grid);
        std::array<float, 2> missing{restrict_residual(tile->grid, tile->grid2)};
        relax(tile->grid2);
        missing[1] = restrict_residual(tile->grid2, tile->grid4);
        relax(tile->grid4);
        prolong(tile->grid4, tile->grid2);
        prolong(tile->grid2, tile->grid);
        add(missing);
    }
    tension_flow(work, g, tile->grid, 0.5f);
    for (float& v : work.dw) v += 0.0f;  // no zero's sign counts
    add(work.dw);
    const Ripples found = find_ripples(w, g, 0.3f);
    const LinkFlow over = flow_over_link(links[0], {1.5f, 2}, {tile->grid.p[40], tile->grid.p[80]}, {0.5f, 0.4f});
    add(std::array{over.flow + 0.0f, over.a, over.b + 0.0f,
                   static_cast<float>(found.strong + 2 * found.faint + 4 * found.rims)});
}

/// Seepage in one tile, and over a seam to itself.
template <class Add>
void seep(const Field& s, const Geometry& g, Work& work, Add&& add) {
    auto tile = std::make_unique<SeepTile>();
    tile->open.fill(1);
    Plane start, rate;
    for (int t = 0; t < kTexels; ++t) start[t] = s[static_cast<std::size_t>(field_of(t))], rate[t] = 0.4f;
    tile->start = start.data();
    tile->film = rate.data();
    tile->links = {{0, 17, 200, 0.7f, 0.3f}, {0, 200, 17, 0.7f, 0.3f}};
    for (int j = 1; j <= 3; ++j) {
        const auto n = static_cast<float>(j);
        const SeepStage stage{0.1f, 0.05f, 1 / 3.0f, (2 * n + 1) / (n + 2), (n - 1) / (n + 2), (j + 1) % 2};
        for (SeepLink& l : tile->links) seep_over_link(l, start[l.texel], start[l.other_texel], stage);
        seep_stage(*tile, s, g, stage);
        add(tile->s[static_cast<std::size_t>(1 - stage.from)]);
    }
    limit_carried(*tile, g, 1, rate);
    add(tile->carried);
    Field carried{};
    for (int t = 0; t < kTexels; ++t) carried[static_cast<std::size_t>(field_of(t))] = tile->carried[t];
    seepage_flow(work, *tile, g, 1, carried);
    for (float& v : work.ds) v += 0.0f;  // no zero's sign counts
    add(work.ds);
    std::array<float, kTexels> pigment;
    pigment_step(pigment.data(), work, g, false, 7);
    add(pigment);
}

/// Conductances as of a stretched, sheared chart with a hole in it.
void fill(Geometry& g, std::uint64_t seed) {
    for (int k = 0; k < kField; ++k)
        g.flow_area[static_cast<std::size_t>(k)] =
            static_cast<std::uint16_t>((0.4f + 0.8f * chance(seed + 9, k)) / kFlowAreaUnit);
    g.blocks = 0xf7ff;
    g.valid.fill((1u << (kSide + 2)) - 1);
    if (seed % 2) g.gd = std::make_unique<Geometry::Diagonals>();
    const bool upwards = seed % 100 < 51, downwards = seed % 200 > 1;
    g.ups = g.gd && upwards, g.downs = g.gd && downwards;
    const auto size = [&](std::uint64_t k, int i) {
        return static_cast<std::uint16_t>((0.6f + 0.8f * chance(seed + k, i)) / kConductanceUnit);
    };
    for (int i = 0; i < kTexels; ++i) {
        g.gx[Geometry::right_of(i % kSide, i / kSide)] = i % 37 ? size(0, i) : 0;
        g.inverse[i] = beside(i) ? 0 : 0.7f + 0.6f * chance(seed + 1, i);
    }
    for (int i = 0; i < kTexels + kSide; ++i) g.gy[i] = size(3, i);
    for (int i = 0; i < kSide; ++i) g.gx[Geometry::right_of(-1, i)] = size(5, i);
    for (int row = -1; row <= kSide; ++row)
        for (int column = -1; column <= kSide; ++column) {
            const int k = field_at(column, row);
            g.grain[k] = 0.6f + 0.8f * chance(seed + 7, k);
            if (g.gd && row < kSide && column < kSide)
                (*g.gd)[Geometry::corner_of(column, row)] =
                    static_cast<std::int16_t>(0.4f * (chance(seed + 8, k) - 0.5f) / kDiagonalUnit);
        }
}

}  // namespace

int main(int n_arguments, char** arguments) {
    if (n_arguments > 1 && !tuft::test::has_instructions(arguments[1])) {
        std::puts("skipped");
        return 0;
    }
    std::uint64_t hash = 0;
    const auto add = [&](const auto& a) { hash = hash_bytes(a.data(), sizeof a[0] * a.size(), hash); };
    for (std::uint64_t round = 0; round < 32; ++round) {
        // Wet all over, or with dry places; with and without pores.
        const float dry = round & 2 ? 0.3f : 0.0f;
        std::array<std::array<float, kTexels>, 9> w, s, p, z;
        std::array<const float*, 9> w_at, s_at, p_at, z_at;
        for (std::size_t i = 0; i < 9; ++i) {
            for (int t = 0; t < kTexels; ++t) {
                const bool wet = chance(round, 9000 * i + t) >= dry && !(i == 4 && beside(t));
                w[i][t] = wet ? 0.01f + 6 * chance(round + 100, 9000 * i + t) : 0;
                s[i][t] = wet && round & 4 ? 3 * chance(round + 200, 9000 * i + t) : 0;
                p[i][t] = 2 * chance(round + 300, 9000 * i + t);
                z[i][t] = std::max(0.0f, 8 * chance(round + 400, 9000 * i + t) - 4);
            }
            w_at[i] = w[i].data(), s_at[i] = s[i].data(), p_at[i] = p[i].data(), z_at[i] = z[i].data();
        }
        Geometry g;
        fill(g, 50 * round + (round & 1));
        const Step step{
            .flow = 0.02f,
            .levelling = 0.01f,
            .limit = {.flow = 0.06f, .most = round & 16 ? 0.02f * kFlowAreaUnit : 0.0f, .most_of_link = 0.03f},
            .threshold = 0.1f,
            .pin = 1,
            .mixing = 0.02f,
            .grip = 0.5f,
            .pores = round & 4 ? 3.0f : 0.0f,
            .passing = round & 8 ? 0.2f : 1.0f,
            .drying = {.evaporation = 0.004f, .rim = 0.002f},
            .retained = 1,
            .relief = 0.015f,
            .ridge = 0.4f};
        Work work;
        gather_field(work.w, w_at);
        gather_field(work.s, s_at);
        gather_field(work.p, p_at);
        gather_field(work.z, z_at);
        work.on_relief = round % 3 == 2;
        fluxes(work, g, step);
        if (step.limit.most > 0) {
            TileNeighbours beside{.blocks = {0xffff, 0xffff, 0xffff, 0xffff}, .here = g.blocks};
            beside.liquid = {w_at[3], w_at[5], w_at[1], w_at[7]};
            film_block_flow(work, g, beside, step);
        }
        std::array<SeamLanes, 2> seams;
        for (std::size_t lane = 0; lane < 2 * kSide; ++lane) {
            SeamLanes& l = seams[lane / kSide];
            const auto x = lane % kSide;
            l.weight[x] = 0.7f, l.flow_area[x] = 0.5f, l.apart[x] = 0.05f * static_cast<float>(lane);
            for (std::size_t end = 0; end < 2; ++end) {
                l.w[end][x] = w[end][4 * lane], l.s[end][x] = s[end][4 * lane], l.z[end][x] = z[end][4 * lane];
                l.grain[end][x] = end ? 1.1f : 0.9f;
            }
        }
        seam_fluxes(seams, step);
        for (const SeamLanes& l : seams) {
            for (SeamLanes::Lane lane : {l.through, l.a, l.b}) {
                for (float& v : lane) v += 0.0f;  // no zero's sign counts
                add(lane);
            }
            for (std::size_t x = 0; x < kSide; ++x) {
                work.dw[x] -= l.through[x];
                work.dp[x] -= l.a[x] * p[0][4 * x] + l.b[x] * p[1][4 * x];
            }
        }
        std::array<float, kTexels> pigment;
        pigment_step(pigment.data(), work, g, round & 16, round);
        std::array<std::uint8_t, kTexels> closing{};
        const Outcome out = local_step({w[4].data(), s[4].data(), closing}, work, g, step, round);
        add(pigment);
        add(w[4]);
        add(s[4]);
        if (out.closing) add(closing);
        const std::array rest{out.most_w, out.most_s, static_cast<float>(out.sides), static_cast<float>(out.evaporated),
                              greatest(pigment.data())};
        add(rest);
        level(work.w, g, work, add);
        if (round & 4) seep(work.s, g, work, add);
    }
    std::printf("%016llx\n", static_cast<unsigned long long>(hash));
}
