#include "stroke/painting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/parallel.h"
#include "ink/composite.h"

namespace tuft::stroke {
namespace {

constexpr double kSide = 0.06;        // metres
constexpr std::uint32_t kSize = 1024; // texels; the sheet covers all but a margin of 8

// A flat sheet in the plane through `centre` spanned by `frame`, with the UVs of a photograph.
Model sheet(const Frame& frame = {}) {
    constexpr int n = 20;
    mesh::TriangleMesh m;
    std::vector<Vec2f> uv;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
            m.positions.push_back(Vec3f(frame.to_world({(x - 0.5) * kSide, (y - 0.5) * kSide, 0})));
            const double margin = 8.0 / kSize;
            uv.push_back(Vec2f(margin + x * (1 - 2 * margin), margin + y * (1 - 2 * margin)));
            m.bounds.add(Vec3(m.positions.back()));
        }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            m.triangles.push_back({a, b, d});
            m.triangles.push_back({a, d, c});
        }
    const std::size_t t = m.triangles.size();
    m.corner_normals.assign(3 * t, Vec3f(frame.n));
    m.neighbours.assign(3 * t, kNone);
    for (std::uint32_t i = 0; i < t; ++i)
        for (int k = 0; k < 3; ++k)
            for (std::uint32_t j = 0; j < t; ++j)
                for (int l = 0; l < 3; ++l)
                    if (m.triangles[i][k] == m.triangles[j][(l + 1) % 3] &&
                        m.triangles[i][(k + 1) % 3] == m.triangles[j][l])
                        m.neighbours[3 * i + k] = j;
    atlas::Atlas a;
    a.size = kSize;
    a.texel_size = kSide / (kSize - 16);
    a.n_charts = 1;
    a.triangle_chart.assign(t, 0);
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle) a.corner_uvs.push_back(uv[v]);
    return prepare_model(std::move(m), std::move(a));
}

// The holder upright over the sheet, pressed `depth` and moved along x with an entry and a lift.
Stroke line(const std::string& brush, double depth, const Frame& frame = {}, double speed = 0.03,
            int rate = 200) {
    const double length = brush::load_preset(brush).length;
    Stroke s;
    s.trace.flat = false;
    s.trace.brush = brush;
    s.trace.ink = "carbon";
    const double time = 0.03 / speed;
    const int n = static_cast<int>(time * rate);
    const Mat3 turn(frame.t, frame.b, frame.n);
    for (int i = 0; i <= n; ++i) {
        const double u = static_cast<double>(i) / n;
        const double press = std::min(1.0, std::min(u, 1 - u) * 6);
        TraceSample p;
        p.time = u * time;
        p.position = frame.to_world({-0.015 + 0.03 * u, 0, length + 1e-3 - (depth + 1e-3) * press});
        p.rotation = glm::quat_cast(turn);
        s.trace.samples.push_back(p);
    }
    return s;
}

TEST(Painting, InkGivenByTheTuftIsInkOnTheTexels) {
    const Model model = sheet();
    Painting painting(model);
    const StrokeReport r = painting.paint(line("wolf-small", 4e-3));
    ASSERT_TRUE(r.touched());
    double on_texels = 0;
    for (int p = 0; p < static_cast<int>(painting.canvas().pigments().size()); ++p)
        on_texels += painting.canvas().total(model.texels, p);
    // Wet ink given times its pigment fraction; carbon's preset is all pigment or less.
    const double strength = painting.ink("carbon").strength();
    EXPECT_NEAR(on_texels / (strength * r.ink_given), 1, 1e-6);
    const double capacity = painting.brush("wolf-small").capacity * ink::kFilmPerVolume;
    EXPECT_NEAR((r.ink_given + r.ink_left) / capacity, 1, 1e-9);

    if (const char* folder = std::getenv("TUFT_LOOK")) {
        painting.paint(line("wolf-small", 1e-3, make_frame({0, 0.01, 0}, {0, 0, 1})));
        painting.paint(line("wolf-small", 2e-3, make_frame({0, 0.02, 0}, {0, 0, 1})));
        painting.paint(line("goat-small", 4e-3, make_frame({0, -0.01, 0}, {0, 0, 1})));
        painting.paint(line("wolf-medium", 8e-3, make_frame({0, -0.02, 0}, {0, 0, 1})));
        const auto map = ink::compose_srgb8(painting.canvas(), model.texels, painting.substrate());
        std::ofstream ppm(std::string(folder) + "/painting.ppm", std::ios::binary);
        ppm << "P6\n" << kSize << " " << kSize << "\n255\n";
        for (int j = kSize - 1; j >= 0; --j)
            ppm.write(reinterpret_cast<const char*>(&map.texels[std::size_t{3} * kSize * j]), 3 * kSize);
    }
}

TEST(Painting, ReplayIsTheSameToTheBitForAnyThreadCount) {
    const Model model = sheet();
    std::uint64_t hash = 0;
    for (const int threads : {1, 2, 8}) {
        set_thread_count(threads);
        Painting painting(model);
        painting.paint(line("wolf-medium", 6e-3));
        if (threads == 1) hash = painting.canvas().hash();
        EXPECT_EQ(painting.canvas().hash(), hash) << threads << " threads";
        Painting again(model);
        again.replay(painting.journal().strokes());
        EXPECT_EQ(again.canvas().hash(), hash);
    }
    set_thread_count(0);
}

TEST(Painting, UndoTakesTheTexelsBackAndRedoMakesThemAgain) {
    const Model model = sheet();
    for (const std::size_t undo_bytes : {std::size_t{1} << 28, std::size_t{1}}) {
        Painting painting(model, {.undo_bytes = undo_bytes});
        const std::uint64_t empty = painting.canvas().hash();
        painting.paint(line("wolf-small", 3e-3));
        const std::uint64_t one = painting.canvas().hash();
        painting.paint(line("goat-small", 5e-3));
        const std::uint64_t two = painting.canvas().hash();
        ASSERT_NE(one, two);
        EXPECT_TRUE(painting.undo());
        // Pigment names stay known; the texels are what counts.
        EXPECT_EQ(painting.canvas().hash(), one);
        EXPECT_TRUE(painting.undo());
        EXPECT_TRUE(painting.canvas().touched_slots().empty() || painting.canvas().hash() == empty ||
                    painting.canvas().total(model.texels, 0) == 0);
        EXPECT_FALSE(painting.undo());
        EXPECT_TRUE(painting.redo());
        EXPECT_TRUE(painting.redo());
        EXPECT_FALSE(painting.redo());
        EXPECT_EQ(painting.canvas().hash(), two);
    }
}

TEST(Painting, AStrokeInPiecesIsTheWholeStroke) {
    const Model model = sheet();
    const Stroke whole = line("mixed-small", 4e-3);
    Painting at_once(model), in_pieces(model);
    at_once.paint(whole);
    Stroke header = whole;
    header.trace.samples.clear();
    in_pieces.begin(header);
    for (const brush::Pose& pose : spatial_poses(whole.trace))
        in_pieces.extend(std::span(&pose, 1));
    in_pieces.end();
    EXPECT_EQ(in_pieces.canvas().hash(), at_once.canvas().hash());
    ASSERT_EQ(in_pieces.journal().strokes().size(), 1u);
    EXPECT_EQ(in_pieces.journal().strokes()[0].trace.samples.size(), whole.trace.samples.size());
}

TEST(Painting, CancelLeavesNothingBehind) {
    const Model model = sheet();
    Painting painting(model);
    const Stroke s = line("wolf-small", 4e-3);
    painting.paint(s);
    const std::uint64_t before = painting.canvas().hash();
    painting.begin(line("goat-small", 5e-3));
    const auto poses = spatial_poses(s.trace);
    painting.extend(std::span(poses).subspan(0, poses.size() / 2));
    painting.cancel();
    EXPECT_EQ(painting.canvas().hash(), before);
    EXPECT_EQ(painting.journal().strokes().size(), 1u);
}

TEST(Painting, AStrokeInTheAirTouchesNothingAndSaysHowFar) {
    const Model model = sheet();
    Painting painting(model);
    Stroke s = line("wolf-small", 4e-3);
    for (TraceSample& p : s.trace.samples) p.position.z += 0.05;
    const StrokeReport r = painting.paint(s);
    EXPECT_FALSE(r.touched());
    EXPECT_NEAR(r.nearest, 0.046, 1e-3);  // 50 mm up less the 4 mm it was pressed; the tip hangs straight
}

// Covered width across the middle of the stroke, metres.
double middle_width(const Painting& painting, const Frame& frame) {
    double covered = 0;
    const atlas::TexelMap& map = painting.model().texels;
    for (const std::uint32_t slot : painting.canvas().touched_slots()) {
        const ink::Plane* plane = painting.canvas().plane(slot, 0);
        if (!plane) continue;
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const atlas::TexelTile& tile = map.tiles[slot];
            const Vec3 p = frame.to_local({tile.px[t], tile.py[t], tile.pz[t]});
            if (std::abs(p.x) < 2e-3 && tile.area[t] > 0)
                covered += std::min(1.0f, (*plane)[t] / 1.0f) * tile.area[t];
        }
    }
    return covered / 4e-3;
}

TEST(Painting, TurningSheetAndHandTogetherKeepsTheWidth) {
    const Model flat = sheet();
    Painting here(flat);
    here.paint(line("wolf-small", 4e-3));
    const double width = middle_width(here, {});
    ASSERT_GT(width, 1e-3);
    const Vec3 n = glm::normalize(Vec3{0.3, -0.5, 0.7});
    const Frame turned = make_frame({0.4, -0.2, 0.1}, n, {0.2, 0.9, 0.1});
    const Model model = sheet(turned);
    Painting there(model);
    there.paint(line("wolf-small", 4e-3, turned));
    EXPECT_NEAR(middle_width(there, turned) / width, 1, 0.01);
}

TEST(Painting, TheStrokeIsTheSameAtAnySamplingRate) {
    const Model model = sheet();
    Painting slow(model), fast(model);
    slow.paint(line("wolf-small", 4e-3, {}, 0.03, 100));
    fast.paint(line("wolf-small", 4e-3, {}, 0.03, 1000));
    // The press and lift are corners of the motion; the spline rounds them by part of a sample.
    EXPECT_NEAR(slow.canvas().total(model.texels, 0) / fast.canvas().total(model.texels, 0), 1, 0.01);
}

}  // namespace
}  // namespace tuft::stroke
