#include "stroke/document/fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "core/random.h"
#include "sheet.h"
#include "stroke/drawing/follow_model.h"

namespace tuft::stroke {
namespace {

constexpr double kDepth = 2e-3;

std::string reason_on(const Model& revised, const PaintStroke& stroke) {
    const Model former = sheet();
    Document painting(revised);
    const auto reports = painting.replay({stroke});
    const auto length_of = [&](const std::string& brush) { return painting.materials().brush(brush).length; };
    const auto mismatches =
        find_mismatches(reports, compare_fit(painting.journal().entries(), painting.journal().entries(), length_of,
                                             {*former.query, *revised.query}));
    EXPECT_LE(mismatches.size(), 1u);
    return mismatches.empty() ? "" : mismatches.front().reason.text();
}

PaintStroke pressed() {
    PaintStroke s = line("wolf-small", kDepth);
    return s;
}

Model lifted(double by) {
    return sheet(make_frame({0, 0, by}, {0, 0, 1}));
}

TEST(Fit, TheSameModelFitsAndSoDoesOneALittleOff) {
    EXPECT_EQ(reason_on(sheet(), pressed()), "");
    EXPECT_EQ(reason_on(lifted(0.3 * kDepth), pressed()), "");
}

// The straight tuft of the stroke reaches 2 mm into the sheet for most of its way.
TEST(Fit, AMovedSurfaceIsReportedByItsDistance) {
    EXPECT_EQ(reason_on(lifted(3e-3), pressed()), "pressed 3.0 mm deeper");
    EXPECT_EQ(reason_on(lifted(-1.5e-3), pressed()), "pressed 1.5 mm less deep");
    EXPECT_EQ(reason_on(lifted(-12e-3), pressed()), "touches nothing, 10.0 mm away");
    EXPECT_EQ(reason_on(lifted(brush::load_preset("wolf-small").length + 1e-3), pressed()),
              "100 % of it lies inside the model");
}

// A sheet that ends under the middle of the stroke, which goes 15 mm to both sides of it.
TEST(Fit, AMissingPartIsReportedByItsFraction) {
    const Model half = sheet(make_frame({0.5 * kSide, 0, 0}, {0, 0, 1}));
    const std::string reason = reason_on(half, pressed());
    ASSERT_TRUE(reason.ends_with(" % of it touches nothing")) << reason;
    EXPECT_NEAR(std::stod(reason), 50, 3);  // a sample of the hand is 1 % of the path
}

TEST(Fit, AStrokeInTheAirIsNoMismatch) {
    PaintStroke above = pressed();
    for (StrokeSample& s : above.trace.samples) s.position.z += 0.2;
    EXPECT_EQ(reason_on(lifted(-5e-3), above), "");
}

constexpr std::uint32_t kSmall = 128;  // texels: only the mesh matters here

/// A flat stroke of 30 mm along x, mapped on whatever lies at the origin.
PaintStroke written(SurfaceMapping mapping) {
    PaintStroke s;
    s.brush = "wolf-small";
    s.ink = "carbon";
    s.trace.placement = {.origin = {0, 0, 0}, .right = {1, 0, 0}, .down = {0, -1, 0}, .mapping = mapping};
    for (int i = 0; i <= 100; ++i)
        s.trace.samples.push_back(
            {.time = 0.01 * i, .position = {0.03 * (i / 100.0 - 0.5), 0, 0}, .pressure = i % 100 == 0 ? 0.0 : 0.5});
    return s;
}

template <class Content>
StrokeFit fit_on(const mesh::TriangleMesh& revised, const Content& stroke, bool with_motion = false) {
    const Model former = sheet({}, kSmall);
    const mesh::SurfaceQuery query(revised);
    const ModelChange change = with_motion ? find_change(*former.query, query) : ModelChange{};
    const std::vector<JournalEntry> entries{JournalEntry(stroke)};
    return compare_fit(entries, entries, [](const std::string& brush) { return brush::load_preset(brush).length; },
                       {*former.query, query, change})
        .at(0);
}

// Triangles with their middle within `radius` of `centre` are gone.
mesh::TriangleMesh with_hole(const mesh::TriangleMesh& mesh, const Vec3& centre, double radius) {
    mesh::TriangleMesh out = mesh;
    std::vector<std::uint32_t> place(mesh.n_triangles(), kNone);
    out.triangles.clear();
    out.corner_normals.clear();
    out.neighbours.clear();
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) {
        if (glm::distance((mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3.0, centre) < radius)
            continue;
        place[t] = static_cast<std::uint32_t>(out.triangles.size());
        out.triangles.push_back(mesh.triangles[t]);
        for (int k = 0; k < 3; ++k) {
            out.corner_normals.push_back(mesh.corner_normals[3 * t + k]);
            out.neighbours.push_back(mesh.neighbours[3 * t + k]);
        }
    }
    for (std::uint32_t& n : out.neighbours)
        if (n != kNone) n = place[n];
    return out;
}

// Another mesh of the same sheet: its vertices lie elsewhere in it, and off it by as much as a
// scan's noise.
mesh::TriangleMesh remeshed(const mesh::TriangleMesh& mesh) {
    mesh::TriangleMesh out = mesh;
    Random random(1);
    for (Vec3f& p : out.positions)
        p += Vec3f(random.uniform(-8e-4, 8e-4), random.uniform(-8e-4, 8e-4), random.uniform(-1e-4, 1e-4));
    return out;
}

TEST(Fit, AFlatStrokeOnTheSameModelOrAnotherMeshOfItFits) {
    for (const SurfaceMapping mapping : {SurfaceMapping::wrap, SurfaceMapping::drape, SurfaceMapping::project}) {
        const StrokeFit same = fit_on(*sheet({}, kSmall).mesh, written(mapping), true),
                        finer = fit_on(remeshed(*sheet({}, kSmall).mesh), written(mapping), true);
        EXPECT_TRUE(mismatch_reason(same).empty());
        EXPECT_EQ(same.moved.most, 0);
        EXPECT_EQ(same.missing(), 0);
        EXPECT_EQ(same.common.stretched, 0);
        EXPECT_NEAR(same.length, 0.03, 1e-3);
        EXPECT_FALSE(same.moved.on_model);
        EXPECT_TRUE(mismatch_reason(finer).empty()) << static_cast<int>(mapping);
        EXPECT_FALSE(finer.moved.on_model);
    }
}

TEST(Fit, AFlatStrokeReportsHowFarItsPlacementMoved) {
    for (const SurfaceMapping mapping : {SurfaceMapping::wrap, SurfaceMapping::drape, SurfaceMapping::project}) {
        EXPECT_EQ(mismatch_reason(fit_on(*sheet(make_frame({0, 0, -20e-3}, {0, 0, 1}), kSmall).mesh, written(mapping)))
                      .text(),
                  "lies 20.0 mm from where it lay");
        // Along itself the sheet goes from under the stroke: it stays in space, but not on the
        // model.
        const Model aside = sheet(make_frame({0, 20e-3, 0}, {0, 0, 1}), kSmall);
        const StrokeFit fit = fit_on(*aside.mesh, written(mapping), true);
        EXPECT_LT(fit.moved.median, 1e-6);
        ASSERT_TRUE(fit.moved.on_model);
        EXPECT_NEAR(*fit.moved.on_model, 20e-3, 1e-6);
        EXPECT_EQ(mismatch_reason(fit).text(), "lies 20.0 mm from its place on the model");
    }
}

/// A square of 20 mm in the middle of the sheet.
Fill square(SurfaceMapping mapping) {
    FlatArea area;
    area.rings = {{{-0.01, -0.01}, {0.01, -0.01}, {0.01, 0.01}, {-0.01, 0.01}}};
    area.placement = written(mapping).trace.placement;
    area.stops = {{.ink = "carbon"}};
    return fill_of_area(area);
}

// As strokes are: areas of drawings were left out, and one that went to another model altogether was no mismatch.
TEST(Fit, AnAreaOfADrawingIsComparedAlongItsEdge) {
    for (const SurfaceMapping mapping : {SurfaceMapping::wrap, SurfaceMapping::drape, SurfaceMapping::project}) {
        const StrokeFit same = fit_on(*sheet({}, kSmall).mesh, square(mapping), true);
        EXPECT_TRUE(same.area);
        EXPECT_TRUE(mismatch_reason(same).empty()) << mismatch_reason(same).text();
        EXPECT_NEAR(same.length, 0.08, 1e-6);
        EXPECT_EQ(same.moved.most, 0);
        EXPECT_EQ(same.missing(), 0);
        EXPECT_TRUE(mismatch_reason(fit_on(remeshed(*sheet({}, kSmall).mesh), square(mapping))).empty());
        const StrokeFit lower = fit_on(*sheet(make_frame({0, 0, -20e-3}, {0, 0, 1}), kSmall).mesh, square(mapping));
        const std::vector<StrokeMismatch> found = find_mismatches({}, {lower});
        ASSERT_EQ(found.size(), 1u);
        EXPECT_TRUE(found[0].area);
        EXPECT_EQ(found[0].reason.text(), "lies 20.0 mm from where it lay");
        const Model aside = sheet(make_frame({0, 20e-3, 0}, {0, 0, 1}), kSmall);
        const Message reason = mismatch_reason(fit_on(*aside.mesh, square(mapping), true));
        EXPECT_TRUE(reason.text().starts_with("lies 20.0 mm from its place on the model")) << reason.text();
    }
    // It follows a model that is half as large again, point by point.
    const Model former = sheet({}, kSmall);
    mesh::TriangleMesh larger = *former.mesh;
    for (Vec3f& position : larger.positions) position *= 1.5f;
    const mesh::SurfaceQuery query(larger);
    const ModelChange change{.whole = ModelMotion{.scale = 1.5}, .parts = {}};
    const std::vector<JournalEntry> entries{JournalEntry(square(SurfaceMapping::project))};
    const StrokeFit grown = compare_fit(entries, follow_model(entries, change, *former.query),
                                        [](const std::string&) { return 0.0; }, {*former.query, query, change})
                                .at(0);
    EXPECT_TRUE(grown.followed);
    EXPECT_TRUE(mismatch_reason(grown).empty()) << mismatch_reason(grown).text();
    EXPECT_LT(grown.moved.on_model.value_or(1), 1e-6);
    // A hole of 12 mm about the middle of an edge of 20 mm; triangles of 3 mm make it ragged.
    const StrokeFit hole =
        fit_on(with_hole(*sheet({}, kSmall).mesh, Vec3(0.01, 0, 0), 6e-3), square(SurfaceMapping::project));
    EXPECT_NEAR(hole.missing(), 12.0 / 80, 0.06);
}

// A hole of 10 mm across the middle of 30 mm; triangles of 3 mm make it ragged.
TEST(Fit, AHoleUnderAStrokeIsMissingInk) {
    const StrokeFit flat = fit_on(with_hole(*sheet({}, kSmall).mesh, Vec3(0), 5e-3), written(SurfaceMapping::project));
    const StrokeFit space = fit_on(with_hole(*sheet({}, kSmall).mesh, Vec3(0), 5e-3), pressed());
    for (const StrokeFit& fit : {flat, space}) {
        EXPECT_NEAR(fit.missing(), 10.0 / 30, 0.1);
        EXPECT_NE(mismatch_reason(fit).text().find("% of it touches nothing"), std::string::npos)
            << mismatch_reason(fit).text();
    }
}

// Projected onto a plane that leans by 60 degrees along it, a stroke is twice as long.
TEST(Fit, AStretchedStrokeIsReportedByItsFraction) {
    const Model steep = sheet(make_frame(Vec3(0), glm::normalize(Vec3(-std::sqrt(3.0), 0, 1))), kSmall);
    const StrokeFit fit = fit_on(*steep.mesh, written(SurfaceMapping::project));
    EXPECT_NEAR(fit.common.revised / fit.common.former, 2, 0.02);
    EXPECT_GT(fit.common.stretched, 0.5 * fit.length);
    EXPECT_NE(mismatch_reason(fit).text().find("stretched or squeezed"), std::string::npos)
        << mismatch_reason(fit).text();
}

TEST(Fit, TheTotalIsThatOfAllStrokes) {
    const std::vector<StrokeFit> fits{
        fit_on(*sheet(make_frame({0, 0, -20e-3}, {0, 0, 1}), kSmall).mesh, written(SurfaceMapping::wrap)),
        fit_on(*sheet({}, kSmall).mesh, written(SurfaceMapping::wrap))};
    const FitTotal total = total_of(fits, {{1, "moved"}});
    EXPECT_EQ(total.strokes, 2u);
    EXPECT_NEAR(total.moved.most, 20e-3, 1e-6);
    EXPECT_EQ(describe(total).text(),
              "1 of 2 strokes no longer fit: they lie 20.0 mm from where they lay (20.0 mm at "
              "most), 0 % of their ink is missing, 0 % of it is "
              "stretched or squeezed by more than a quarter");
}

/// A model without symmetry: a sheet that is bent up at one side and cut at a corner.
mesh::TriangleMesh crooked(const std::function<Vec3(const Vec3&)>& moved) {
    mesh::TriangleMesh m = with_hole(*sheet({}, kSmall).mesh, {0.5 * kSide, 0.5 * kSide, 0}, 0.02);
    m.bounds = {};
    std::set<std::uint32_t> used;
    for (const auto& t : m.triangles) used.insert(t.begin(), t.end());
    for (std::uint32_t v = 0; v < m.positions.size(); ++v) {
        Vec3 p(m.positions[v]);
        p.z = 10 * p.x * p.x + 6 * p.x * p.y;
        m.positions[v] = Vec3f(moved(p));
        if (used.contains(v)) m.bounds.add(Vec3(m.positions[v]));
    }
    return m;
}

TEST(ModelMotion, ShiftsTurnsAndSizesOfAWholeModelAreFound) {
    const mesh::TriangleMesh former = crooked([](const Vec3& p) { return p; });
    const auto found = [&](const std::function<Vec3(const Vec3&)>& moved) {
        const mesh::TriangleMesh revised = crooked(moved);
        const auto motion = find_motion(mesh::SurfaceQuery(former), mesh::SurfaceQuery(revised));
        if (!motion) return std::string();
        for (const Vec3f& p : former.positions) EXPECT_LT(glm::distance((*motion)(Vec3(p)), moved(Vec3(p))), 1e-6);
        for (const Vec3f& p : former.positions)
            EXPECT_LT(glm::distance(motion->back((*motion)(Vec3(p))), Vec3(p)), 1e-12);
        return describe(*motion).text();
    };
    EXPECT_EQ(found([](const Vec3& p) { return p; }), "");
    EXPECT_EQ(found([](const Vec3& p) { return p + Vec3(20e-3, 0, -1e-3); }), "shifted by (20.0, 0.0, -1.0) mm");
    EXPECT_EQ(found([](const Vec3& p) { return 1.2 * p; }), "1.2 times as large");
    EXPECT_EQ(found([](const Vec3& p) { return 25.4 * p; }), "25.4 times as large");
    EXPECT_EQ(found([](const Vec3& p) { return Vec3(p.x, -p.z, p.y); }), "turned by 90 degrees");
    EXPECT_EQ(found([](const Vec3& p) { return Vec3(-p.x, -p.y, p.z) + Vec3(0, 0, 5e-3); }),
              "turned by 180 degrees and shifted by (0.0, 0.0, 5.0) mm");
}

// Centimetres read as inches are 2.54 times as large, inches read as millimetres 1 / 25.4: the first is painted and
// reported, the second would be painted by tufts longer than the model.
TEST(SizeFault, AModelSmallerThanATuftIsRefusedOnlyWhereTheFormerOneWasLarger) {
    const mesh::TriangleMesh mesh = crooked([](const Vec3& p) { return p; });
    const mesh::SurfaceQuery former(mesh);
    const auto fault = [&](double scale, const std::vector<JournalEntry>& entries) {
        const mesh::TriangleMesh scaled = crooked([&](const Vec3& p) { return scale * p; });
        const mesh::SurfaceQuery revised(scaled);
        return size_fault(
                   entries, [](const std::string& name) { return brush::load_preset(name).length; }, former, revised)
            .text();
    };
    EXPECT_EQ(fault(1 / 2.54, {pressed()}), "");
    EXPECT_EQ(fault(25.4, {pressed()}), "");
    const std::string text = fault(1 / 25.4, {pressed()});
    EXPECT_NE(text.find("the tuft of wolf-small is"), std::string::npos) << text;
    JournalEntry hidden = pressed();
    hidden.hidden = true;
    EXPECT_EQ(fault(1 / 25.4, {hidden}), "");
    EXPECT_EQ(fault(1 / 25.4, {}), "");
}

// The sheet's diagonal is 85 mm, the drawing 40 mm wide, the tuft 20 mm long: the sheet is less than a quarter of the
// drawing from a size of 0.118 on, and shorter than the tuft from 0.236 on.
TEST(SizeFault, ADrawingIsRefusedOnAModelThatIsSmallerThanTheTuftAndAQuarterOfTheDrawing) {
    const Model model = sheet();
    const auto fault = [&](double scale, const std::vector<JournalEntry>& entries) {
        mesh::TriangleMesh scaled = *model.mesh;
        scaled.bounds = {};
        for (Vec3f& p : scaled.positions) p *= static_cast<float>(scale), scaled.bounds.add(Vec3(p));
        return size_fault(
                   entries, [](const std::string& name) { return brush::load_preset(name).length; },
                   mesh::SurfaceQuery(scaled))
            .text();
    };
    PaintStroke flat;
    flat.brush = "wolf-small";
    flat.trace.flat = true;
    // Two strokes far from each other are one drawing.
    const auto at = [&](double x) {
        PaintStroke s = flat;
        s.trace.placement = {.origin = {x, 0, 0}, .right = {0, 1, 0}, .down = {0, 0, -1}};
        s.trace.samples = {{.position = {0, 0, 0}, .pressure = 0.5}, {.time = 1, .position = {1e-3, 0, 0}}};
        return s;
    };
    const std::vector<JournalEntry> drawing{at(-0.02), at(0.02)};
    ASSERT_EQ(brush::load_preset("wolf-small").length, 0.02);
    EXPECT_EQ(fault(0.12, drawing), "");
    EXPECT_NE(fault(0.115, drawing), "");
    EXPECT_NE(fault(1e-3, drawing).find("it is 0.0849 mm across, the strokes 40 mm; the tuft of wolf-small is 20 mm"),
              std::string::npos)
        << fault(1e-3, drawing);
    EXPECT_NE(fault(1e-3, {at(0)}).find("the strokes 1 mm"), std::string::npos);
    EXPECT_EQ(fault(1e-3, {pressed()}), "") << "in space";
    JournalEntry hidden = at(0);
    hidden.hidden = true;
    EXPECT_EQ(fault(1e-3, {hidden}), "");
    EXPECT_EQ(fault(1e-3, {}), "");
}

TEST(ModelMotion, AnotherMeshAHoleOrAnotherShapeIsNoMotion) {
    const mesh::TriangleMesh former = crooked([](const Vec3& p) { return p; });
    const auto none = [&](const mesh::TriangleMesh& revised) {
        return !find_motion(mesh::SurfaceQuery(former), mesh::SurfaceQuery(revised));
    };
    EXPECT_TRUE(none(remeshed(former)));
    EXPECT_TRUE(none(with_hole(former, {-0.01, 0, 0}, 8e-3)));
    EXPECT_TRUE(none(crooked([](const Vec3& p) { return Vec3(p.x, p.y, 3 * p.z); })));
    EXPECT_TRUE(none(*sheet(make_frame({0.1, 0, 0}, {0, 0, 1}), kSmall).mesh));
}

}  // namespace
}  // namespace tuft::stroke
