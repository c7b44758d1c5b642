#include "ink/canvas/canvas.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/system/parallel.h"

namespace tuft::ink {
namespace {

Pigment named(const std::string& name) {
    Pigment p;
    p.name = name;
    return p;
}

Canvas painted() {
    Canvas canvas(10);
    canvas.add_pigment(named("a"));
    canvas.add_pigment(named("b"));
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        canvas.touch(3, 0)[t] = static_cast<float>(uniform(1, t));
        canvas.touch(7, 1)[t] = static_cast<float>(uniform(2, t));
    }
    return canvas;
}

TEST(Canvas, MemoryFollowsThePaintedTiles) {
    Canvas canvas(1000);
    const std::size_t empty = canvas.memory_bytes();
    canvas.add_pigment(named("a"));
    EXPECT_EQ(canvas.memory_bytes(), empty);
    canvas.touch(5, 0);
    canvas.touch(6, 0);
    canvas.touch(6, 0);
    const std::size_t two = canvas.memory_bytes() - empty;
    EXPECT_GE(two, 2 * sizeof(Plane));
    EXPECT_LE(two, 2 * sizeof(Plane) + 256) << "one KiB a tile and a small header";
    canvas.clear();
    EXPECT_EQ(canvas.memory_bytes(), empty);
}

TEST(Canvas, PigmentsAreFoundByNameAndLimitedToEight) {
    Canvas canvas(1);
    for (int i = 0; i < kMaxPigments; ++i) EXPECT_EQ(canvas.add_pigment(named(std::to_string(i))), i);
    EXPECT_EQ(canvas.add_pigment(named("3")), 3);
    EXPECT_THROW(canvas.add_pigment(named("ninth")), Error);
}

TEST(Canvas, RestoringASnapshotBringsBackEveryBit) {
    Canvas canvas = painted();
    const Canvas before = canvas;
    const std::uint64_t hash = canvas.hash();
    const TileSnapshot tile = canvas.snapshot(3), untouched = canvas.snapshot(4);
    canvas.touch(3, 0)[17] += 1;
    canvas.touch(3, 1)[2] = 5;
    canvas.touch(4, 1)[0] = 1;
    EXPECT_NE(canvas.hash(), hash);
    EXPECT_FALSE(canvas.same_contents(before));
    canvas.take_dirty();
    canvas.restore(tile);
    canvas.restore(untouched);
    EXPECT_EQ(canvas.hash(), hash);
    EXPECT_TRUE(canvas.same_contents(before));
    EXPECT_EQ(canvas.take_dirty(), (std::vector<std::uint32_t>{3, 4}));
    EXPECT_EQ(canvas.memory_bytes(), before.memory_bytes());
    EXPECT_FALSE(canvas.touched(4));
}

TEST(Canvas, AForeignSnapshotIsRefused) {
    Canvas canvas = painted();
    TileSnapshot tile = canvas.snapshot(3);
    tile.slot = 10;
    EXPECT_THROW(canvas.restore(tile), Error);
    tile = canvas.snapshot(3);
    tile.amounts.pop_back();
    EXPECT_THROW(canvas.restore(tile), Error);
    tile = canvas.snapshot(3);
    tile.planes = 1 << 5;
    EXPECT_THROW(canvas.restore(tile), Error) << "a pigment the canvas does not have";
}

TEST(Canvas, FilmsAndLiquidComeBackFromASnapshot) {
    Canvas canvas = painted();
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        canvas.touch_film(3, kSoakedFilm, 1)[t] = static_cast<float>(uniform(3, t));
        canvas.touch_film(3, kFirstDryFilm + 2, 0)[t] = static_cast<float>(uniform(4, t));
        canvas.touch_liquid(3, Liquid::pores)[t] = static_cast<float>(uniform(5, t));
    }
    canvas.touch_liquid(8, Liquid::film)[0] = 1;
    EXPECT_EQ(canvas.wet_slots(), (std::vector<std::uint32_t>{3, 8}));
    const Canvas before = canvas;
    const std::size_t bytes = canvas.memory_bytes();
    EXPECT_EQ(before.memory_bytes(), bytes);
    EXPECT_TRUE(before.same_contents(canvas));
    const TileSnapshot tile = canvas.snapshot(3);
    EXPECT_EQ(tile.under, (std::vector<FilmPlanes>{{kSoakedFilm, 2}, {kFirstDryFilm + 2, 1}, {kFilms, 2}}));
    canvas.touch_film(3, kFirstDryFilm + 2, 0)[9] += 1;
    EXPECT_NE(canvas.hash(), before.hash());
    EXPECT_FALSE(canvas.same_contents(before));
    canvas.restore(tile);
    EXPECT_EQ(canvas.hash(), before.hash());
    EXPECT_EQ(canvas.memory_bytes(), bytes);
    canvas.restore(TileSnapshot{.slot = 3});
    canvas.restore(TileSnapshot{.slot = 8});
    EXPECT_FALSE(canvas.wet());
    TileSnapshot bad = tile;
    bad.under[1].film = kOpenFilm;
    EXPECT_THROW(canvas.restore(bad), Error);
    bad = tile;
    bad.under[2].planes = 4;
    EXPECT_THROW(canvas.restore(bad), Error) << "there are two liquids";
    bad = tile;
    std::swap(bad.under[0], bad.under[1]);
    EXPECT_THROW(canvas.restore(bad), Error);
}

TEST(Canvas, HashAndComparisonSeeZerosAsNothing) {
    Canvas canvas = painted(), other = painted();
    other.touch(9, 0);
    EXPECT_EQ(canvas.hash(), other.hash());
    EXPECT_TRUE(canvas.same_contents(other) && other.same_contents(canvas));
    Canvas moved(10);
    moved.add_pigment(named("a"));
    moved.add_pigment(named("b"));
    for (const std::uint32_t slot : {3u, 7u}) {
        TileSnapshot tile = canvas.snapshot(slot);
        tile.slot += 1;
        moved.restore(tile);
    }
    EXPECT_NE(canvas.hash(), moved.hash()) << "the place counts";
}

TEST(Canvas, DirtySlotsAreListedOnceInOrder) {
    Canvas canvas = painted();
    EXPECT_EQ(canvas.take_dirty(), (std::vector<std::uint32_t>{3, 7}));
    EXPECT_TRUE(canvas.take_dirty().empty());
}

TEST(Canvas, DifferentSlotsMayBeTouchedAtOnce) {
    set_thread_count(4);
    Canvas canvas(5000), one(5000);
    canvas.add_pigment(named("a"));
    one.add_pigment(named("a"));
    parallel_for(5000, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s)
            canvas.touch(static_cast<std::uint32_t>(s), 0)[0] = static_cast<float>(s);
    });
    set_thread_count(0);
    for (std::uint32_t s = 0; s < 5000; ++s) one.touch(s, 0)[0] = static_cast<float>(s);
    EXPECT_EQ(canvas.hash(), one.hash());
    EXPECT_EQ(canvas.memory_bytes(), one.memory_bytes());
}

}  // namespace
}  // namespace tuft::ink
