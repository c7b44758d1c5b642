#include "ink/composite/composite.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include "core/random.h"
#include "core/system/parallel.h"
#include "ink/spectra/kubelka_munk.h"
#include "mesh/repair/repair.h"
#include "texels.h"

namespace tuft::ink {
namespace {

/// A page of `size` texels with a disc-shaped chart in its middle.
atlas::TexelMap disc_map(std::uint32_t size, double radius) {
    atlas::TexelMap map;
    map.size = size;
    map.tiles_per_side = (size + 15) / 16;
    map.texel_size = 1e-4;
    map.slot_of_tile.assign(std::size_t{map.tiles_per_side} * map.tiles_per_side, kNone);
    const auto tiles = std::make_shared<std::vector<atlas::TexelTile>>();
    for (std::uint32_t tile = 0; tile < map.slot_of_tile.size(); ++tile) {
        auto made = atlas::TexelTile{};
        bool any = false;
        for (int t = 0; t < kN; ++t) {
            const double x = tile % map.tiles_per_side * 16 + t % 16 + 0.5 - size / 2.0;
            const double y = tile / map.tiles_per_side * 16 + t / 16 + 0.5 - size / 2.0;
            const bool inside = x * x + y * y < radius * radius;
            made.cluster[t] = inside ? 0 : atlas::kNoCluster;
            made.area[t] = inside ? 1e-8f : 0.0f;
            any |= inside;
        }
        if (!any) continue;
        map.slot_of_tile[tile] = static_cast<std::uint32_t>(tiles->size());
        map.tile_of_slot.push_back(tile);
        tiles->push_back(made);
    }
    map.tiles = {tiles, std::span<const atlas::TexelTile>(*tiles)};
    return map;
}

/// What `shade_films` computes, in double, one texel, from the scalar formulas.
struct Reference {
    std::array<double, kBands> r{};
    Substrate substrate;

    explicit Reference(const Substrate& s) : substrate(s) {
        const Bands bare = bands_of_rgb(s.reflectance);
        for (int b = 0; b < kBands; ++b) r[b] = saunderson_inverse(bare[b], {.k1 = 0, .k2 = 0.6 * s.interface}, false);
    }
    void lay(const std::vector<Pigment>& pigments, const std::vector<double>& w, double part = 1) {
        for (int b = 0; b < kBands; ++b) {
            double k = 0, s = 0;
            for (std::size_t p = 0; p < w.size(); ++p) {
                k += w[p] * pigments[p].k[b];
                s += w[p] * pigments[p].s[b];
            }
            r[b] += part * (over(layer(k, s, 1), r[b]) - r[b]);
        }
    }
    /// Colour of a texel with `wet` of its surface under water.
    Rgb seen(double wet = 0) const {
        const double g = substrate.interface + (1 - substrate.interface) * wet;
        Bands out;
        for (int b = 0; b < kBands; ++b) out[b] = static_cast<float>(saunderson(r[b], {.k1 = 0, .k2 = 0.6 * g}, false));
        return into_gamut(rgb_of_bands(out));
    }
};

std::vector<Pigment> pigments_of(std::initializer_list<const char*> inks) {
    std::vector<Pigment> pigments;
    for (const char* name : inks) pigments.push_back(load_ink(name).parts[0].pigment);
    return pigments;
}

/// From 1e-7 to 10 film units, and some exact zeros.
Plane random_plane(int seed) {
    Plane w;
    for (int t = 0; t < kN; ++t)
        w[t] = (t + seed) % 7 == 0 ? 0.0f : static_cast<float>(std::pow(10, 8 * uniform(seed, t) - 7));
    return w;
}

TEST(Composite, AgreesWithTheScalarFormulas) {
    std::vector<Pigment> pigments = pigments_of({"carbon", "shell-white", "gamboge"});
    Pigment clear{.name = "clear"};
    clear.s[1] = 1e-4f;
    clear.s[kBands - 1] = 300;
    pigments.push_back(clear);
    Canvas canvas(1);
    for (int p = 0; p < 4; ++p) {
        canvas.add_pigment(pigments[p]);
        static_cast<std::array<float, kN>&>(canvas.touch(0, p)) = random_plane(p);
    }
    for (const char* name : {"porcelain", "bisque", "primed-metal"}) {
        const Substrate substrate = load_substrate(name);
        const TileAppearance look = shade_tile(canvas, 0, substrate);
        for (int t = 0; t < kN; ++t) {
            std::vector<double> w;
            double height = 0;
            for (int p = 0; p < 4; ++p) {
                w.push_back((*canvas.plane(0, p))[t]);
                height += w[p] * pigments[p].height * 1e6;
            }
            Reference reference(substrate);
            reference.lay(pigments, w);
            const Rgb expected = reference.seen();
            // Single precision through two dozen operations; the interface has slope ≤ 2.5.
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(look.colour[c][t], expected[c], 4e-6) << name << " " << t;
            EXPECT_NEAR(look.height[t], height, 1e-5 * height);
            EXPECT_GE(look.roughness[t], 0);
            EXPECT_LE(look.roughness[t], 1);
        }
    }
}

TEST(Composite, FilmsLieOverEachOther) {
    const std::vector<Pigment> pigments = pigments_of({"gamboge", "indigo", "titanium-white"});
    const Plane yellow = random_plane(1), blue = random_plane(2), white = random_plane(3);
    Plane mask, water;
    for (int t = 0; t < kN; ++t) {
        mask[t] = static_cast<float>(uniform(5, t));
        water[t] = static_cast<float>(2 * uniform(6, t));
    }
    const Substrate paper = load_substrate("rice-paper");
    const std::vector<TileFilm> films{
        {.pigments = {&yellow}},
        {.pigments = {nullptr, &blue, nullptr}, .mask = &mask, .opacity = 0.7f},
        {},
        {.pigments = {nullptr, &blue, &white}},
    };
    const TileAppearance look = shade_films(films, &water, pigments, paper);
    for (int t = 0; t < kN; ++t) {
        Reference reference(paper);
        reference.lay(pigments, {yellow[t], 0, 0});
        reference.lay(pigments, {0, blue[t], 0}, 0.7 * mask[t]);
        reference.lay(pigments, {0, blue[t], white[t]});
        // 1 film unit is 10 µm; the paper's grain is 15 µm rms.
        const Rgb expected = reference.seen(1 - std::exp(-water[t] * 10.0 / 30.0));
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(look.colour[c][t], expected[c], 4e-6) << t;
        EXPECT_NEAR(look.height[t],
                    1e6 * (pigments[0].height * yellow[t] + pigments[1].height * blue[t] * (1 + 0.7f * mask[t]) +
                           pigments[2].height * white[t]),
                    1e-5 * look.height[t] + 1e-9);
    }
}

// Layers over each other as Kubelka and Munk say, in either order, with colours mixed by opacity.
TEST(Composite, LayersLieOverEachOtherInTheirOrder) {
    const std::vector<Pigment> pigments = pigments_of({"cinnabar", "indigo"});
    std::array<Canvas, 2> canvas{Canvas(1), Canvas(1)};
    const std::array<Plane, 2> w{random_plane(1), random_plane(2)};
    for (int i = 0; i < 2; ++i) {
        for (const Pigment& p : pigments) canvas[i].add_pigment(p);
        canvas[i].touch(0, i) = w[i];
    }
    const Substrate paper = load_substrate("rice-paper");
    for (const float opacity : {1.0f, 0.3f}) {
        for (const int lower : {0, 1}) {
            const Stack stack({{&canvas[lower], 1}, {&canvas[1 - lower], opacity}});
            const TileAppearance look = shade_tile(stack, 0, paper);
            for (int t = 0; t < kN; ++t) {
                Reference reference(paper);
                const auto film = [&](int i) {
                    return std::vector<double>{i == 0 ? w[0][t] : 0.0, i == 1 ? w[1][t] : 0.0};
                };
                reference.lay(pigments, film(lower));
                reference.lay(pigments, film(1 - lower), static_cast<double>(opacity));
                const Rgb expected = reference.seen();
                // As for single films above.
                for (int c = 0; c < 3; ++c) EXPECT_NEAR(look.colour[c][t], expected[c], 4e-6) << t;
            }
        }
    }
    // A layer of two films fades as one thing: what it hides shows through it only by its opacity.
    canvas[0].touch_film(0, kFirstDryFilm, 1).fill(50);
    canvas[0].touch(0, 0).fill(50);
    canvas[1].touch(0, 0).fill(50);
    canvas[1].touch(0, 1).fill(0);
    const auto faded = [&](const Canvas& c) { return shade_tile(Stack(std::vector<LayerView>{{&c, 0.5f}}), 0, paper); };
    for (int t = 0; t < kN; t += 17)
        for (int c = 0; c < 3; ++c)  // fifty film units hide anything to 1e-6
            EXPECT_NEAR(faded(canvas[0]).colour[c][t], faded(canvas[1]).colour[c][t], 4e-6);
}

TEST(Composite, SplittingAFilmChangesNothing) {
    const std::vector<Pigment> pigments = pigments_of({"cinnabar", "shell-white"});
    const Plane red = random_plane(1), white = random_plane(2);
    Plane red_low, white_low, red_high, white_high;
    for (int t = 0; t < kN; ++t) {
        red_low[t] = 0.25f * red[t];
        red_high[t] = 0.75f * red[t];
        white_low[t] = 0.25f * white[t];
        white_high[t] = 0.75f * white[t];
    }
    const std::vector<TileFilm> one{{.pigments = {&red, &white}}};
    const std::vector<TileFilm> two{{.pigments = {&red_low, &white_low}}, {.pigments = {&red_high, &white_high}}};
    const Substrate glaze = load_substrate("porcelain");
    const TileAppearance whole = shade_films(one, nullptr, pigments, glaze);
    const TileAppearance parts = shade_films(two, nullptr, pigments, glaze);
    for (int c = 0; c < 3; ++c)
        for (int t = 0; t < kN; ++t) EXPECT_NEAR(parts.colour[c][t], whole.colour[c][t], 4e-6) << "single precision";
}

TEST(Composite, WaterDeepensColourAndShines) {
    const std::vector<Pigment> pigments = pigments_of({"cinnabar"});
    Plane red, water;
    red.fill(1);
    for (int t = 0; t < kN; ++t) water[t] = 0.05f * static_cast<float>(t);
    const std::vector<TileFilm> films{{.pigments = {&red}}};
    for (const char* name : {"rice-paper", "bisque", "clay"}) {
        const TileAppearance look = shade_films(films, &water, pigments, load_substrate(name));
        for (int t = 1; t < kN; ++t) {
            EXPECT_LE(look.colour[0][t], look.colour[0][t - 1] + 1e-7f);
            EXPECT_LE(look.roughness[t], look.roughness[t - 1]);
        }
        EXPECT_LT(look.colour[1][255], 0.6f * look.colour[1][0]) << name;
        EXPECT_LT(look.roughness[255], 0.1f) << name;
    }
    // Nothing gets wetter under a glaze.
    const TileAppearance glazed = shade_films(films, &water, pigments, load_substrate("porcelain"));
    EXPECT_FLOAT_EQ(glazed.colour[1][255], glazed.colour[1][0]);
}

TEST(Composite, AnEmptyTileLooksLikeTheSubstrate) {
    Canvas canvas(1);
    canvas.add_pigment(load_ink("carbon").parts[0].pigment);
    canvas.touch(0, 0);
    const Substrate clay = load_substrate("clay");
    const TileAppearance look = shade_tile(canvas, 0, clay);
    EXPECT_EQ(look.height[9], 0);
    EXPECT_FLOAT_EQ(look.roughness[9], clay.roughness);
    for (const std::string& name : list_substrates()) {  // under its interface too
        const Substrate substrate = load_substrate(name);
        const TileAppearance bare = shade_tile(canvas, 0, substrate);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(bare.colour[c][9], substrate.reflectance[c], 1e-6) << name;
    }
}

TEST(Composite, MoreInkIsNeverLighter) {
    Canvas canvas(1);
    canvas.add_pigment(load_ink("carbon").parts[0].pigment);
    for (int t = 0; t < kN; ++t) canvas.touch(0, 0)[t] = 0.02f * static_cast<float>(t);
    const TileAppearance look = shade_tile(canvas, 0, load_substrate("porcelain"));
    for (int t = 1; t < kN; ++t) EXPECT_LE(look.colour[1][t], look.colour[1][t - 1] + 1e-7f);
}

TEST(Composite, MapsHaveTheChartsTheirGutterAndTheBackground) {
    const atlas::TexelMap map = disc_map(100, 30);
    Canvas canvas(map.n_slots());
    canvas.add_pigment(load_ink("cinnabar").parts[0].pigment);
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (int t = 0; t < kN; ++t)
            if (map.tiles[slot].cluster[t] != atlas::kNoCluster) canvas.touch(slot, 0)[t] = 3;
    const Substrate porcelain = load_substrate("porcelain");
    const AtlasMap<std::uint8_t> image = compose_srgb8(canvas, map, porcelain, {.gutter = 4});
    ASSERT_EQ(image.texels.size(), 100u * 100u * 3u);
    const TileAppearance look = shade_tile(canvas, map.slot_of_tile[3 * map.tiles_per_side + 3], porcelain);
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            const double r = std::hypot(x + 0.5 - 50, y + 0.5 - 50);
            const int red = image.texels[(y * 100 + x) * 3 + 1];
            if (r < 33) {
                EXPECT_NEAR(red, 255 * srgb_encode(look.colour[1][0]), 1) << x << " " << y;
            } else if (r > 35) {
                EXPECT_NEAR(red, 255 * srgb_encode(porcelain.reflectance[1]), 1) << x << " " << y;
            }
        }
}

TEST(Composite, RefreshingDirtyTilesEqualsComposingAnew) {
    const atlas::TexelMap map = disc_map(200, 80);
    Canvas canvas(map.n_slots());
    canvas.add_pigment(load_ink("indigo").parts[0].pigment);
    const Substrate paper = load_substrate("rice-paper");
    AtlasMap<std::uint8_t> image = compose_srgb8(canvas, map, paper);
    for (std::uint32_t slot = 5; slot < 40; ++slot)
        for (int t = 0; t < kN; ++t) canvas.touch(slot, 0)[t] = static_cast<float>(uniform(slot, t));
    const TileSnapshot before = canvas.snapshot(2);
    canvas.touch(2, 0).fill(1);
    refresh_srgb8(image, canvas.take_dirty(), canvas, map, paper);
    canvas.restore(before);  // undo: an empty tile shows the substrate again
    refresh_srgb8(image, canvas.take_dirty(), canvas, map, paper);
    EXPECT_EQ(image.texels, compose_srgb8(canvas, map, paper).texels);
}

/// A cube of 20 mm: six faces, hence seams.
mesh::TriangleMesh cube() {
    mesh::PolygonSoup soup;
    for (int i = 0; i < 8; ++i) soup.points.emplace_back(i & 1 ? 20 : 0, i & 2 ? 20 : 0, i & 4 ? 20 : 0);
    soup.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    soup.polygon_start = {0, 4, 8, 12, 16, 20, 24};
    return mesh::build_surface(soup).mesh;
}

TEST(Composite, GuttersContinueOverSeams) {
    const mesh::TriangleMesh box = cube();
    const atlas::Atlas atlas = atlas::unwrap(box, {.size = 256, .gutter = 3}).atlas;
    const atlas::TexelMap map = build_texel_map(box, atlas);
    const GutterPlan seams = plan_gutter(box, atlas, map);
    const ComposeOptions options{.seams = &seams};
    Canvas canvas(map.n_slots());
    canvas.add_pigment(load_ink("indigo").parts[0].pigment);
    const Substrate paper = load_substrate("rice-paper");
    AtlasMap<std::uint8_t> image = compose_srgb8(canvas, map, paper, options);
    for (std::uint32_t slot = 0; slot < map.n_slots(); slot += 2)
        for (int t = 0; t < kN; ++t) canvas.touch(slot, 0)[t] = 2 * map.position(slot, t).x / 0.02f;
    AtlasMap<float> linear = compose_linear(canvas, map, paper, options);
    const std::vector<float> composed = linear.texels;
    atlas::fill_gutter(seams.gutter, map, 3, linear.texels);
    ASSERT_FALSE(seams.gutter.texels.empty());
    // Beside unpainted texels the substrate stands as it is, not summed from taps.
    for (std::size_t i = 0; i < composed.size(); ++i) ASSERT_NEAR(linear.texels[i], composed[i], 1e-6);
    refresh_srgb8(image, canvas.take_dirty(), canvas, map, paper, options);
    EXPECT_EQ(image.texels, compose_srgb8(canvas, map, paper, options).texels);
    for (std::size_t i = 0; i < image.texels.size(); i += 7)
        EXPECT_NEAR(image.texels[i], 255 * srgb_encode(std::clamp(composed[i], 0.0f, 1.0f)), 4)
            << "sums of at most 8 rounded taps";
}

TEST(Composite, ThreadsDoNotChangeTheMaps) {
    const atlas::TexelMap map = disc_map(300, 140);
    Canvas canvas(map.n_slots());
    canvas.add_pigment(load_ink("cobalt").parts[0].pigment);
    for (std::uint32_t slot = 0; slot < map.n_slots(); ++slot)
        for (int t = 0; t < kN; ++t) canvas.touch(slot, 0)[t] = static_cast<float>(uniform(slot, t));
    const Substrate bisque = load_substrate("bisque");
    set_thread_count(1);
    const auto one = compose_linear(canvas, map, bisque);
    const auto orm = compose_orm8(canvas, map, bisque);
    set_thread_count(4);
    EXPECT_EQ(compose_linear(canvas, map, bisque).texels, one.texels);
    EXPECT_EQ(compose_orm8(canvas, map, bisque).texels, orm.texels);
    set_thread_count(0);
    EXPECT_EQ(orm.texels[0], 255) << "no occlusion";
    const AtlasMap<float> height = compose_height(canvas, map);
    const Plane& w = *canvas.plane(map.slot_of_tile[5 * map.tiles_per_side + 5], 0);
    EXPECT_NEAR(height.texels[(5 * 16 + 3) * 300 + 5 * 16 + 2], w[3 * 16 + 2] * canvas.pigments()[0].height * 1e6f,
                1e-6);
}

TEST(Srgb, DecodingUndoesEncoding) {
    for (int i = 0; i <= 255; ++i) EXPECT_NEAR(255 * srgb_encode(srgb_decode(static_cast<float>(i) / 255)), i, 1e-3);
}

}  // namespace
}  // namespace tuft::ink
