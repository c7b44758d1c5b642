#include "stroke/drawing/follow_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "core/random.h"
#include "core/text/units.h"
#include "ink/canvas/canvas.h"
#include "ink_centre.h"
#include "mesh/part_groups.h"
#include "sheet.h"
#include "stroke/drawing/drawing.h"
#include "stroke/drawing/follow_names.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/registration.h"

namespace tuft::stroke {
namespace {

using Map = std::function<Vec3(const Vec3&)>;

Vec3 same(const Vec3& p) {
    return p;
}

/// A bent shell of 240 × 160 mm without symmetry, as `n` × `n` squares; points off the corners by a part of a square
/// within the shell.
mesh::TriangleMesh shell(int n, const Map& moved, double off = 0, std::uint64_t seed = 1) {
    mesh::TriangleMesh m;
    Random random(seed);
    const auto at = [&](double u, double v) {
        const double x = 0.24 * (u - 0.5), y = 0.16 * (v - 0.5);
        return moved({x, y, 2.5 * x * x + 1.5 * x * y - 30 * y * y * y + 0.02 * std::exp(-900 * (x * x + y * y))});
    };
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const bool inner = i > 0 && j > 0 && i < n && j < n;
            const double du = inner ? off * random.uniform(-1, 1) : 0, dv = inner ? off * random.uniform(-1, 1) : 0;
            m.positions.push_back(Vec3f(at((i + du) / n, (j + dv) / n)));
            m.bounds.add(Vec3(m.positions.back()));
        }
    const auto vertex = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            m.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            m.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    std::vector<Vec3> normals(m.positions.size(), Vec3(0));
    for (std::size_t t = 0; t < m.n_triangles(); ++t)
        for (const std::uint32_t v : m.triangles[t]) normals[v] += mesh::face_normal(m, t);
    for (const auto& t : m.triangles)
        for (const std::uint32_t v : t) m.corner_normals.push_back(Vec3f(glm::normalize(normals[v])));
    m.neighbours.assign(3 * m.n_triangles(), kNone);
    return m;
}

Map moved_by(const ModelMotion& motion) {
    return [motion](const Vec3& p) { return motion(p); };
}

ModelMotion turned(double degrees, const Vec3& axis, const Vec3& shift, double scale = 1) {
    return {.to = shift, .rotation = glm::angleAxis(degrees * kDegree, glm::normalize(axis)), .scale = scale};
}

/// Largest distance between where a motion takes points of the shell and where they went.
double worst(const mesh::TriangleMesh& former, const ModelMotion& found, const ModelMotion& truth) {
    double most = 0;
    for (const Vec3f& p : former.positions) most = std::max(most, glm::distance(found(Vec3(p)), truth(Vec3(p))));
    return most;
}

// The former shell has 40² squares, the revised one 57², with corners elsewhere on it. A chord of a square is up to
// 0.08 mm below the shell; of 4,000 points the mean is exact to a few hundredths of that.
TEST(Registration, ARemeshedModelThatWasMovedIsFoundToATenthOfAMillimetre) {
    const mesh::TriangleMesh former = shell(40, same);
    for (const ModelMotion& truth :
         {turned(10, {1, 2, 3}, {0.02, -0.01, 0.005}), turned(25, {-1, 0.3, 0.2}, {0, 0, 0.02}),
          turned(190, {0.1, 0.2, 1}, {0.3, 0.1, 0}), turned(10, {0, 1, 1}, {0.02, 0, 0}, 25.4)}) {
        const mesh::TriangleMesh revised = shell(57, moved_by(truth), 0.3);
        const auto found = find_motion(mesh::SurfaceQuery(former), mesh::SurfaceQuery(revised));
        ASSERT_TRUE(found);
        EXPECT_LT(worst(former, *found, truth), 1e-4 * truth.scale) << describe(*found).text();
    }
}

// 30 % of the shell is bent away by up to 20 mm: the rest says how it moved.
TEST(Registration, APartThatWasChangedDoesNotCount) {
    const ModelMotion truth = turned(10, {1, 2, 3}, {0.02, -0.01, 0.005});
    const auto bent = [&](const Vec3& p) {
        const double beyond = std::max(0.0, p.x - 0.05);
        return truth(p + Vec3(0, 0, 5 * beyond * beyond));
    };
    const mesh::TriangleMesh former = shell(40, same);
    const auto found = find_motion(mesh::SurfaceQuery(former), mesh::SurfaceQuery(shell(57, bent, 0.3)));
    ASSERT_TRUE(found);
    EXPECT_LT(worst(former, *found, truth), 3e-4) << "those beyond 70 % of the points are few, not none";
    EXPECT_FALSE(find_motion(mesh::SurfaceQuery(former), mesh::SurfaceQuery(shell(57, [](const Vec3& p) {
                                 const double beyond = std::max(0.0, p.x - 0.05);
                                 return p + Vec3(0, 0, 5 * beyond * beyond);
                             }))));
}

TEST(Registration, AStretchedBodyIsFoundWhereStretchIsAllowed) {
    ModelMotion truth = turned(5, {0, 0.2, 1}, {0.01, 0, 0});
    truth.set_linear(truth.linear() * Mat3(Vec3(1.06, 0, 0), Vec3(0.01, 0.97, 0), Vec3(0, 0, 1)));
    const mesh::TriangleMesh former = shell(40, same), revised = shell(57, moved_by(truth), 0.3);
    const mesh::SurfaceQuery a(former), b(revised);
    const auto similar = find_motion(a, b);
    EXPECT_TRUE(!similar || worst(former, *similar, truth) > 5e-4) << "6 % of 120 mm, spread over it";
    const auto found = find_motion(a, b, MotionFreedom::affine);
    ASSERT_TRUE(found);
    EXPECT_LT(worst(former, *found, truth), 1e-4);
    EXPECT_NE(describe(*found).text().find("stretched by up to"), std::string::npos) << describe(*found).text();
}

TEST(ModelMotion, PolarDecompositionGivesTheMatrixBack) {
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        Mat3 m(1);
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) m[j][k] += random.uniform(-0.4, 0.4);
        if (!(glm::determinant(m) > 0.05)) continue;
        ModelMotion motion;
        motion.set_linear(m);
        for (int j = 0; j < 3; ++j) EXPECT_LT(glm::distance(motion.linear()[j], m[j]), 1e-12);
        EXPECT_NEAR(glm::determinant(motion.stretch), 1, 1e-12);
        for (const Vec3& p : {Vec3(1, 2, 3), Vec3(-1, 0, 0.2)})
            EXPECT_LT(glm::distance(motion.back(motion(p)), p), 1e-12);
    }
}

/// Two shells beside each other, "body" and "door".
mesh::TriangleMesh body_and_door(const Map& body, const Map& door, int n = 40, double off = 0) {
    mesh::TriangleMesh m = shell(
        n, [&](const Vec3& p) { return body(p - Vec3(0.15, 0, 0)); }, off, 1);
    const mesh::TriangleMesh other = shell(
        n, [&](const Vec3& p) { return door(Vec3(0.5 * p.x + 0.1, 0.7 * p.y, 0.6 * p.z + 0.03)); }, off, 2);
    m.triangle_groups.assign(m.n_triangles(), 0);
    const auto first = static_cast<std::uint32_t>(m.positions.size());
    for (const auto& t : other.triangles) {
        m.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        m.triangle_groups.push_back(1);
    }
    m.positions.insert(m.positions.end(), other.positions.begin(), other.positions.end());
    m.corner_normals.insert(m.corner_normals.end(), other.corner_normals.begin(), other.corner_normals.end());
    m.neighbours.assign(3 * m.n_triangles(), kNone);
    m.bounds.add(other.bounds.lo);
    m.bounds.add(other.bounds.hi);
    m.group_names = {"body", "door"};
    return m;
}

/// A flat stroke of 20 mm over a point of a model.
PaintStroke written_at(const mesh::SurfaceQuery& query, const Vec3& near, SurfaceMapping mapping) {
    const auto at = query.closest_point(near);
    PaintStroke s;
    s.brush = "wolf-small";
    s.ink = "carbon";
    s.trace.placement = upright_placement(at->position, at->normal, 0.3);
    s.trace.placement.mapping = mapping;
    for (int i = 0; i <= 50; ++i)
        s.trace.samples.push_back({.time = 0.02 * i,
                                   .position = {0.02 * (i / 50.0 - 0.5), 0.002 * std::sin(0.2 * i), 0},
                                   .pressure = i % 50 == 0 ? 0.0 : 0.5});
    return s;
}

TEST(ModelChange, APartThatWasMovedTakesItsStrokesAlong) {
    const ModelMotion whole = turned(10, {1, 2, 3}, {0.02, 0, 0});
    ModelMotion door = turned(6, {0, 0, 1}, {0.03, 0.01, 0.004});
    const mesh::TriangleMesh former = body_and_door(same, same);
    const mesh::TriangleMesh revised = body_and_door(
        moved_by(whole), [&](const Vec3& p) { return whole(door(p)); }, 57, 0.3);
    const mesh::SurfaceQuery a(former), b(revised);
    const ModelChange change = find_change(a, b);
    ASSERT_TRUE(change.whole);
    ASSERT_EQ(change.parts.size(), 1u);
    EXPECT_EQ(change.parts[0].name, "door");
    EXPECT_LT(worst(former, *change.whole, whole), 5e-4) << "the door is a quarter of the points";
    for (const auto& [at, truth] :
         std::vector<std::pair<Vec3, Map>>{{{-0.09, 0.05, 0.02}, [&](const Vec3& p) { return whole(p); }},
                                           {{0.13, 0.035, 0.05}, [&](const Vec3& p) { return whole(door(p)); }}}) {
        const PaintStroke stroke = written_at(a, at, SurfaceMapping::wrap);
        const std::vector<JournalEntry> followed = follow_model({stroke}, change, a);
        const SurfaceTrace was = map_to_surface(a, stroke.trace),
                           is = map_to_surface(b, followed[0].get<PaintStroke>().trace);
        for (std::size_t i = 0; i < was.samples.size(); ++i)
            EXPECT_LT(glm::distance(is.samples[i].position, truth(was.samples[i].position)), 2e-4)
                << "geodesics of two meshes of one shell, away from its steep middle, and two registrations";
    }
    EXPECT_TRUE(find_change(a, a).none());
}

/// Where the ink of a stroke lies on a model.
std::vector<Vec3> ink_points(const PaintStroke& s, const mesh::SurfaceQuery& query, double length) {
    std::vector<Vec3> points;
    if (s.trace.flat) {
        for (const SurfaceSample& p : map_to_surface(query, s.trace).samples) points.push_back(p.position);
        return points;
    }
    for (const brush::Pose& pose : spatial_poses(s.trace))
        if (const auto hit = query.ray(pose.position, pose.axis(), 0, length)) points.push_back(hit->position);
    return points;
}

// The same triangles, moved: every point of the ink goes where its point of the model goes, to what single precision
// of the mesh allows (1e-8 m for each, some dozen triangles crossed).
TEST(FollowModel, InkLiesWhereItsPlaceOnTheModelWent) {
    const mesh::TriangleMesh former = shell(40, same);
    const mesh::SurfaceQuery a(former);
    for (const double scale : {1.0, 1.3})
        for (const ModelMotion& motion : {turned(40, {1, 2, 3}, {0.02, -0.01, 0.005}, scale)}) {
            const mesh::TriangleMesh revised = shell(40, moved_by(motion));
            const mesh::SurfaceQuery b(revised);
            std::vector<PaintStroke> strokes;
            for (const SurfaceMapping mapping : {SurfaceMapping::wrap, SurfaceMapping::project})
                strokes.push_back(written_at(a, {0.03, 0.01, 0}, mapping));
            const auto at = a.closest_point({-0.04, -0.02, 0});
            strokes.push_back(line("wolf-small", 2e-3, make_frame(at->position, at->normal)));
            for (const PaintStroke& stroke : strokes) {
                const auto followed = follow_model({stroke}, {.whole = motion}, a)[0].get<PaintStroke>();
                const double length = brush::load_preset(stroke.brush).length;
                const std::vector<Vec3> was = ink_points(stroke, a, length),
                                        is = ink_points(followed, b, length * scale);
                ASSERT_EQ(was.size(), is.size());
                ASSERT_GT(was.size(), 20u);
                for (std::size_t i = 0; i < was.size(); ++i)
                    EXPECT_LT(glm::distance(motion(was[i]), is[i]), 1e-6 * scale);
                EXPECT_EQ(followed.brush, scale == 1 ? "wolf-small" : "wolf-small*1.3");
            }
        }
}

// On a plane a stretch is exact too: the drawing's plane is mapped by the same matrix.
TEST(FollowModel, AStretchedPlaneCarriesAStretchedDrawing) {
    const Model model = sheet({}, 128);
    ModelMotion motion;
    motion.set_linear(Mat3(Vec3(1.2, 0, 0), Vec3(0.1, 0.9, 0), Vec3(0, 0, 1)));
    mesh::TriangleMesh stretched = *model.mesh;
    for (Vec3f& p : stretched.positions) p = Vec3f(motion(Vec3(p)));
    const mesh::SurfaceQuery revised(stretched);
    PaintStroke stroke = written_at(*model.query, {0.004, 0.003, 0}, SurfaceMapping::wrap);
    const auto followed = follow_model({stroke}, {.whole = motion}, *model.query)[0].get<PaintStroke>();
    const std::vector<Vec3> was = ink_points(stroke, *model.query, 1), is = ink_points(followed, revised, 1);
    for (std::size_t i = 0; i < was.size(); ++i) EXPECT_LT(glm::distance(motion(was[i]), is[i]), 1e-7);

    FlatArea area;
    area.rings = {{{-5e-3, -5e-3}, {5e-3, -5e-3}, {5e-3, 5e-3}}};
    area.under = area.rings;
    area.placement = stroke.trace.placement;
    area.stops = {{.at = 0, .ink = "carbon"}, {.at = 1, .ink = "cinnabar"}};
    area.gradient = AreaGradient::linear;
    area.to_unit = {100, 20, 30, 80, 0.5, 0.1};
    const FlatArea moved = *follow_model({fill_of_area(area)}, {.whole = motion}, *model.query)[0].get<Fill>().area;
    const auto in_space = [](const FlatArea& a, const Vec2& p) {
        return a.placement.origin + p.x * a.placement.right + p.y * a.placement.down;
    };
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_LT(glm::distance(motion(in_space(area, area.rings[0][i])), in_space(moved, moved.rings[0][i])), 1e-9);
        EXPECT_NEAR(along_area(area, area.rings[0][i]), along_area(moved, moved.rings[0][i]), 1e-9);
    }
    EXPECT_EQ(moved.under, moved.rings) << "what it reaches under goes the same way";
}

/// A shell as a model to paint on.
Model model_of(const mesh::TriangleMesh& m) {
    mesh::PolygonSoup soup;
    for (const Vec3f& p : m.positions) soup.points.push_back(Vec3(p) / kMillimetre);
    for (const auto& t : m.triangles) {
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        soup.corners.insert(soup.corners.end(), t.begin(), t.end());
    }
    soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    ModelOptions options;
    options.unwrap.size = 1024;
    options.cache = shared_model_cache();
    return prepare_model(soup, options);
}

// On another mesh of the same shell, in place, and moved by 20 mm and turned by 10 degrees: found by registration.
// Chords of the squares, 4 × 2.7 mm, are up to 0.04 mm off the shell and turn its normal by half a degree.
TEST(FollowModel, DotsStayWithinATenthOfAMillimetreOnARemeshedModel) {
    const mesh::TriangleMesh shape = shell(60, same);
    const Model former = model_of(shape);
    for (const ModelMotion& truth : {ModelMotion{}, turned(10, {1, 2, 3}, {0.012, -0.01, 0.0125})}) {
        const Model revised = model_of(shell(85, moved_by(truth), 0.3));
        const ModelChange change = find_change(*former.query, *revised.query);
        std::size_t dots = 0;
        for (const OrientedPoint& at : even_points(shape, 30)) {
            if (std::abs(at.position.x) > 0.112 || std::abs(at.position.y) > 0.072) continue;  // whole dots
            FlatArea dot{.rings = {{}}, .placement = {}, .placed = true, .low = Vec2(-2e-3), .high = Vec2(2e-3)};
            dot.placement = upright_placement(at.position, at.normal, 0);
            dot.placement.mapping = SurfaceMapping::drape;
            for (int i = 0; i < 60; ++i)
                dot.rings[0].push_back(2e-3 * Vec2(std::cos(6 * kDegree * i), std::sin(6 * kDegree * i)));
            dot.stops = {{.ink = "carbon"}};
            const std::vector<JournalEntry> made{JournalEntry(fill_of_area(dot))};
            const Vec3 was = truth(test::ink_centre(former, made[0])),
                       is = test::ink_centre(revised, follow_model(made, change, *former.query)[0]);
            EXPECT_LT(
                glm::distance(revised.query->closest_point(was)->position, revised.query->closest_point(is)->position),
                1e-4)
                << at.position.x << ", " << at.position.y;
            ++dots;
        }
        EXPECT_GE(dots, 20u);
    }
}

// A sheet sank by 3 mm and was tilted by 2 degrees: the stroke is pulled onto it and pressed as deep as before.
TEST(FollowModel, AStrokeInSpaceIsPulledOntoASurfaceThatSank) {
    const Model former = sheet({}, 128);
    const Vec3 normal = glm::normalize(Vec3(std::sin(2 * kDegree), 0, std::cos(2 * kDegree)));
    const Model sunk = sheet(make_frame({0, 0, -3e-3}, normal), 128);
    const PaintStroke stroke = line("wolf-small", 2e-3);
    const double length = brush::load_preset("wolf-small").length;
    const JournalEntry pulled = pull_onto(stroke, stroke, length, *former.query, *sunk.query);
    const auto before = spatial_poses(stroke.trace), after = spatial_poses(pulled.get<PaintStroke>().trace);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const auto was = former.query->ray(before[i].position, before[i].axis(), 0, length);
        const auto is = sunk.query->ray(after[i].position, after[i].axis(), 0, length);
        if (!was) continue;
        ASSERT_TRUE(is);
        EXPECT_NEAR(was->distance, is->distance, 1e-8);
        ++compared;
    }
    EXPECT_GT(compared, before.size() / 2);
    const Vec3 first = after.front().position - before.front().position;
    EXPECT_LT(first.z, -2e-3) << "samples above the former surface go with their neighbours";
}

// A project of a time when the objects of one material were one part.
TEST(FollowNames, AreThoseThatThePartsHaveToday) {
    mesh::TriangleMesh former = shell(2, same), revised = former;
    const auto n = static_cast<std::uint32_t>(former.n_triangles());
    auto scene = std::make_shared<mesh::SourceScene>();
    scene->parts = {{.object = "Hood", .material = "Paint", .node = 0, .own_material = 0},
                    {.object = "Door", .material = "Paint", .node = 1, .own_material = 0},
                    {.object = "Lamp", .material = "Glass", .node = 2, .own_material = 1}};
    former.scene = scene;
    former.group_names = {"Paint", "Glass"};
    former.materials = {{.colour = Vec3f(1, 0, 0)}, {.colour = Vec3f(0, 1, 0)}};
    for (std::uint32_t t = 0; t < n; ++t) {
        former.triangle_parts.push_back(t % 3);
        former.triangle_groups.push_back(t % 3 / 2);
        revised.triangle_groups.push_back(t % 3);
    }
    revised.group_names = {"Hood", "Door", "Lamp"};
    std::vector<JournalEntry> entries(3);
    entries[0].content = PartEdit{{{.name = "Glass", .hidden = true}, {.name = "Paint", .locked = true}}};
    entries[1].content = MaskEdit{.mask = {.kind = MaskKind::group, .groups = {"Paint", "Glass"}}};
    entries[2].content = Dry{};
    entries = follow_names(std::move(entries), former, revised).entries;
    EXPECT_EQ(former.group_names, revised.group_names);
    EXPECT_EQ(former.triangle_groups, revised.triangle_groups);
    ASSERT_EQ(former.materials.size(), 3u);
    EXPECT_EQ(former.materials[1].colour, Vec3f(1, 0, 0));
    EXPECT_EQ(former.materials[2].colour, Vec3f(0, 1, 0));
    const PartEdit expected{
        {{.name = "Door", .locked = true}, {.name = "Hood", .locked = true}, {.name = "Lamp", .hidden = true}}};
    EXPECT_EQ(entries[0].get<PartEdit>(), expected);
    EXPECT_EQ(entries[1].get<MaskEdit>().mask.groups, (std::vector<std::string>{"Door", "Hood", "Lamp"}));
}

using Names = std::vector<std::string>;
using Objects = std::vector<std::pair<std::string, std::string>>;  // and their materials

/// A glTF file with a triangle for each object, named as they are read today.
mesh::TriangleMesh file_of(const Objects& objects) {
    mesh::TriangleMesh m;
    auto scene = std::make_shared<mesh::SourceScene>();
    std::map<std::string, std::int32_t> materials;
    for (const auto& [object, material] : objects) {
        const auto id = materials.try_emplace(material, static_cast<std::int32_t>(materials.size())).first->second;
        const auto node = static_cast<std::int32_t>(scene->parts.size());
        scene->parts.push_back(
            {.object = object, .material = material, .node = node, .primitive = 0, .own_material = id});
        m.triangles.push_back({0, 1, 2});
        m.triangle_parts.push_back(static_cast<std::uint32_t>(node));
    }
    m.scene = scene;
    m.triangle_groups.assign(objects.size(), 0);
    m.group_names = {""};
    return mesh::with_part_groups(m);
}

/// As it was read when all nodes of a material were one part.
mesh::TriangleMesh old_file_of(const Objects& objects) {
    mesh::TriangleMesh m = file_of(objects);
    m.group_names.clear();
    for (std::size_t t = 0; t < objects.size(); ++t) {
        const auto at = std::ranges::find(m.group_names, objects[t].second) - m.group_names.begin();
        m.triangle_groups[t] = static_cast<std::uint32_t>(at);
        if (static_cast<std::size_t>(at) == m.group_names.size()) m.group_names.push_back(objects[t].second);
    }
    return m;
}

/// What a mask of these parts holds, and which parts are locked where these were.
struct Followed {
    Names mask, locked, former;
    std::size_t notes = 0;
};

Followed follow(mesh::TriangleMesh former, const mesh::TriangleMesh& revised, const Names& names) {
    std::vector<JournalEntry> entries(2);
    entries[0].content = MaskEdit{.mask = {.kind = MaskKind::group, .groups = names}};
    PartEdit edit;
    for (const std::string& name : names) edit.parts.push_back({.name = name, .locked = true});
    entries[1].content = edit;
    const NamedEntries named = follow_names(std::move(entries), former, revised);
    Followed out{
        .mask = named.entries[0].get<MaskEdit>().mask.groups, .locked = {}, .former = {}, .notes = named.notes.size()};
    for (const Part& part : named.entries[1].get<PartEdit>().parts)
        if (part.locked) out.locked.push_back(part.name);
    for (const std::uint32_t group : former.triangle_groups) out.former.push_back(former.group_names[group]);
    return out;
}

// A part's name depends on how many others share its material.
TEST(FollowNames, OfPartsThatStayedWhileOthersCameAndWent) {
    const Objects one{{"Hood", "Paint"}, {"Tyre", "Rubber"}};
    const Objects two{{"Hood", "Paint"}, {"Door", "Paint"}, {"Tyre", "Rubber"}};
    const Followed added = follow(old_file_of(one), file_of(two), {"Paint"});
    EXPECT_EQ(added.mask, (Names{"Hood"}));
    EXPECT_EQ(added.locked, (Names{"Hood"}));
    EXPECT_EQ(added.former, (Names{"Hood", "Tyre"})) << "the motion of parts is searched by these";

    const Followed removed = follow(file_of(two), file_of(one), {"Hood", "Door"});
    EXPECT_EQ(removed.mask, (Names{"Hood"}));
    EXPECT_EQ(removed.locked, (Names{"Hood", "Door"})) << "that of a part that is gone has no effect";
    EXPECT_EQ(removed.notes, 0u);
    const Followed gone = follow(file_of(two), file_of(one), {"Door"});
    EXPECT_EQ(gone.mask, (Names{"Door"}));
    EXPECT_EQ(gone.notes, 1u);

    Objects renamed = two;
    renamed[0].first = "Bonnet";
    const Followed other = follow(file_of(two), file_of(renamed), {"Hood"});
    EXPECT_EQ(other.mask, (Names{"Bonnet"}));
    EXPECT_EQ(other.locked, (Names{"Bonnet"}));
    EXPECT_EQ(other.former, (Names{"Bonnet", "Door", "Tyre"}));
}

// All former names are there today, but hold less.
TEST(FollowNames, OfAMaterialThatIsCalledAsOneOfItsObjects) {
    const Objects car{{"Body", "Body"}, {"Hood", "Body"}, {"Lamp", "Glass"}};
    const Followed body = follow(old_file_of(car), file_of(car), {"Body"});
    EXPECT_EQ(body.mask, (Names{"Body", "Hood"}));
    EXPECT_EQ(body.locked, (Names{"Body", "Hood"}));
    EXPECT_EQ(body.former, (Names{"Body", "Hood", "Lamp"}));
}

TEST(FollowNames, LeaveOutWhatTheRevisedModelLacks) {
    const Objects car{{"Hood", "Paint"}, {"Door", "Paint"}, {"Spoiler", "Paint"}};
    const Followed paint = follow(old_file_of(car), file_of({car[0], car[1]}), {"Paint"});
    EXPECT_EQ(paint.mask, (Names{"Door", "Hood"}));
}

// As many parts of Paint as before, but without the names of their nodes: those are one part.
TEST(FollowNames, OfObjectsThatLostTheirNamesAreTheirMaterial) {
    const Objects named{{"Hood", "Paint"}, {"Door", "Paint"}, {"Tyre", "Rubber"}};
    const Objects unnamed{{"", "Paint"}, {"", "Paint"}, {"Tyre", "Rubber"}};
    const Followed both = follow(file_of(named), file_of(unnamed), {"Door"});
    EXPECT_EQ(both.mask, (Names{"Paint"}));
    EXPECT_EQ(both.locked, Names{}) << "the hood was not";
    EXPECT_EQ(follow(file_of(named), file_of(unnamed), {"Door", "Hood"}).locked, (Names{"Paint"}));
    EXPECT_EQ(both.former, (Names{"Paint", "Paint", "Tyre"}));
    EXPECT_EQ(both.notes, 1u) << "the mask holds more than the door";
    EXPECT_EQ(follow(file_of(named), file_of(unnamed), {"Tyre"}).notes, 0u);
    const Followed fewer = follow(file_of(named), file_of({unnamed[0], unnamed[2]}), {"Door"});
    EXPECT_EQ(fewer.mask, (Names{"Door"})) << "which of both was deleted is not known";
}

// A project of a time when the two pages of an exported part were two parts.
TEST(FollowNames, OfTwoPartsThatAreOneAreSaid) {
    const Objects hood{{"Hood", "decorated.1001"}, {"Tyre", "Rubber"}, {"Hood", "decorated.1002"}};
    mesh::TriangleMesh former = file_of(hood), revised = file_of(hood);
    auto scene = std::make_shared<mesh::SourceScene>(*revised.scene);
    scene->parts[2].node = scene->parts[0].node;
    revised.scene = former.scene = scene;
    revised = mesh::with_part_groups(revised);
    ASSERT_EQ(revised.group_names, (Names{"Hood", "Tyre"}));
    ASSERT_EQ(former.group_names, (Names{"Hood", "Tyre", "Hood 2"}));
    const Followed one = follow(former, revised, {"Hood 2"});
    EXPECT_EQ(one.mask, (Names{"Hood"}));
    EXPECT_EQ(one.locked, Names{}) << "strokes on the first page keep their ink";
    EXPECT_EQ(follow(former, revised, {"Hood", "Hood 2"}).locked, (Names{"Hood"}));
    EXPECT_EQ(one.former, (Names{"Hood", "Tyre", "Hood"}));
    EXPECT_EQ(one.notes, 1u);
    EXPECT_EQ(follow(former, revised, {"Tyre"}).notes, 0u);
}

// The model was exported again onto one page.
TEST(FollowNames, OfPagesThatBecameOneAreItsPart) {
    const mesh::TriangleMesh former =
        file_of({{"Hood", "decorated.1001"}, {"Tyre", "Rubber"}, {"Hood", "decorated.1002"}});
    ASSERT_EQ(former.group_names, (Names{"Hood", "Tyre", "Hood 2"}));
    const mesh::TriangleMesh revised = file_of({{"Hood", "decorated"}, {"Tyre", "Rubber"}});
    const Followed one = follow(former, revised, {"Hood 2"});
    EXPECT_EQ(one.mask, (Names{"Hood"}));
    EXPECT_EQ(one.former, (Names{"Hood", "Tyre", "Hood"}));
    EXPECT_EQ(one.notes, 1u);
    EXPECT_EQ(follow(former, revised, {"Hood"}).mask, (Names{"Hood"}));
    // Two objects of one name today: which of them the page went to is not known.
    const mesh::TriangleMesh two = file_of({{"Hood", "decorated"}, {"Tyre", "Rubber"}, {"Hood", "decorated"}});
    EXPECT_EQ(follow(former, two, {"Hood 2"}).former[1], "Tyre");
    // Two objects of one name before: nor is it known whose page is left.
    const mesh::TriangleMesh both =
        file_of({{"Hood", "decorated.1001"}, {"Hood", "decorated.1001"}, {"Tyre", "Rubber"}});
    EXPECT_NE(follow(both, revised, {"Hood 2"}).mask, (Names{"Hood"}));
}

// A project of a time when the material of one node named its part.
TEST(FollowNames, OfMaterialsAreThoseOfTheirNodes) {
    const Objects car{{"Body", "Paint"}, {"Windscreen", "Glass"}};
    const Followed glass = follow(old_file_of(car), file_of(car), {"Glass"});
    EXPECT_EQ(glass.mask, (Names{"Windscreen"}));
    EXPECT_EQ(glass.locked, (Names{"Windscreen"}));
    EXPECT_EQ(glass.former, (Names{"Body", "Windscreen"}));
    EXPECT_EQ(glass.notes, 0u);
}

// A material that is called as another node is, in a project that knows materials only.
TEST(FollowNames, OfMaterialsAreNotThoseOfOtherNodes) {
    const Objects car{{"Glass", "Windscreen"}, {"Lamp", "Glass"}};
    mesh::TriangleMesh former = old_file_of(car);
    former.scene = nullptr;
    former.triangle_parts.clear();
    EXPECT_EQ(follow(former, file_of(car), {"Glass"}).mask, (Names{"Lamp"}));
}

// A revised file without parts, such as an STL with solids, still has the former name.
TEST(FollowNames, ThatAFileWithoutPartsHasAreKept) {
    mesh::TriangleMesh revised = file_of({{"Glass", "Glass"}, {"Shell", "Shell"}});
    revised.scene = nullptr;
    revised.triangle_parts.clear();
    const Followed glass = follow(old_file_of({{"Windscreen", "Glass"}, {"Body", "Paint"}}), revised, {"Glass"});
    EXPECT_EQ(glass.mask, (Names{"Glass"}));
    EXPECT_EQ(glass.locked, (Names{"Glass"}));
    EXPECT_EQ(glass.notes, 0u);
}

TEST(FollowNames, OfEqualObjectsAreInTheOrderOfTheFile) {
    const Objects tyres{{"Tyre", "Rubber"}, {"Tyre", "Rubber"}, {"Hood", "Paint"}};
    const Followed same = follow(file_of(tyres), file_of(tyres), {"Tyre 2"});
    EXPECT_EQ(same.mask, (Names{"Tyre 2"}));
    EXPECT_EQ(same.locked, (Names{"Tyre 2"}));
    EXPECT_EQ(follow(old_file_of(tyres), file_of(tyres), {"Rubber"}).mask, (Names{"Tyre", "Tyre 2"}));
}

}  // namespace
}  // namespace tuft::stroke
