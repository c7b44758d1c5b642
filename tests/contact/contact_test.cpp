#include "contact/contact.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "contact/node_contact.h"
#include "core/random.h"
#include "shapes.h"

namespace tuft::contact {
namespace {

constexpr double kUp = std::numbers::pi;

/// A pose whose tuft points to -z of `q` and whose tip, unbent, would be at `tip`.
brush::Pose pose_at(const brush::Preset& preset, const Vec3& tip, const Quat& q = {1, 0, 0, 0}) {
    brush::Pose pose;
    pose.rotation = q;
    pose.position = tip - preset.length * pose.axis();
    return pose;
}

/// One brush with its memory on one surface.
struct ContactStage {
    explicit ContactStage(const mesh::SurfaceQuery& s, const std::string& name = "wolf", Options o = {})
        : surface(s), tuft(brush::make_tuft(brush::load_preset(name))), options(o) {}

    const brush::Preset& preset() const { return tuft.preset; }
    Result move(const Vec3& tip, const Quat& q = {1, 0, 0, 0}) {
        return step(tuft, pose_at(tuft.preset, tip, q), surface, memory, 1e-3, options);
    }

    const mesh::SurfaceQuery& surface;
    brush::Tuft tuft;
    Options options;
    Memory memory;
};

bool finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

const Recycled<brush::Section>& spine(const Result& r) {
    return r.tuft.branches.front().sections;
}

TEST(Contact, FlatSheetIsTheBrushsOwnPlane) {
    const mesh::TriangleMesh m = shapes::sheet(0.3, 60);
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    brush::Tuft alone = brush::make_tuft(hand.preset());
    const brush::ContactPlane plane;
    for (int i = 0; i < 120; ++i) {
        const double depth = 0.01 * std::min(1.0, i / 40.0), x = std::max(0.0, (i - 40) * 5e-4);
        const brush::Pose pose = pose_at(hand.preset(), {x, 0, -depth});
        const Result r = step(hand.tuft, pose, surface, hand.memory, 1e-3);
        const brush::TuftState expected = brush::step(alone, pose, std::span(&plane, 1), 1e-3);
        EXPECT_EQ(r.tuft.touching, expected.touching);
        // The same problem with planes that differ by single precision of the mesh (1e-9 m).
        EXPECT_NEAR(glm::length(r.tuft.force - expected.force), 0, 1e-4 * (glm::length(expected.force) + 1e-3));
        EXPECT_NEAR(glm::length(spine(r).front().centre - expected.branches[0].sections.front().centre), 0, 2e-6);
        if (r.tuft.touching) {
            EXPECT_NEAR(r.frame.origin.z, 0, 1e-8);
            EXPECT_NEAR(r.frame.n.z, 1, 1e-8);
            EXPECT_EQ(r.distance, 0);
            if (i > 100) {
                EXPECT_NEAR(glm::length(r.travel - Vec3{5e-4, 0, 0}), 0, 2e-6);  // steady drag
            }
        }
    }
}

TEST(Contact, TurnedAndMovedSheetTurnsAndMovesEverything) {
    const mesh::TriangleMesh flat = shapes::sheet(0.3, 50);
    const mesh::SurfaceQuery flat_surface(flat);
    Random random(1);
    for (int trial = 0; trial < 4; ++trial) {
        const Quat q = glm::normalize(
            Quat{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const Vec3 d{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
        const mesh::TriangleMesh turned = shapes::moved(flat, q, d);
        const mesh::SurfaceQuery turned_surface(turned);
        for (const Method method : {Method::exact, Method::vertices}) {
            Options options;
            options.method = method;
            ContactStage one(flat_surface, "mixed", options), two(turned_surface, "mixed", options);
            for (int i = 0; i < 60; ++i) {
                const Vec3 tip{i * 4e-4, i * 1e-4, -0.008 * std::min(1.0, i / 20.0)};
                const Quat lean = glm::angleAxis(0.3, Vec3{0, 1, 0});
                const Result a = one.move(tip, lean), b = two.move(q * tip + d, q * lean);
                // Vertices are rounded to 6e-9 m, which decides when pressed hair gives way; after
                // that both are dragged into the same steady state.
                if (i < 40) continue;
                EXPECT_NEAR(glm::length(q * spine(a).front().centre + d - spine(b).front().centre), 0, 2e-5);
                EXPECT_NEAR(glm::length(q * a.tuft.force - b.tuft.force), 0, 0.01 * glm::length(a.tuft.force) + 1e-5);
                if (!a.tuft.touching || !b.tuft.touching) continue;
                EXPECT_NEAR(glm::length(q * a.frame.origin + d - b.frame.origin), 0, 5e-5);
                EXPECT_NEAR(glm::length(q * a.frame.n - b.frame.n), 0, 1e-3);
            }
        }
    }
}

TEST(Contact, ThinPlateHasContactOnTheSideOfTheFerrule) {
    // 1 mm thick, pressed 12 mm deep at once and little by little, from above and from below.
    const mesh::TriangleMesh m = shapes::plate({0.08, 0.08, 0.0005});
    const mesh::SurfaceQuery surface(m);
    for (const double side : {1.0, -1.0})
        for (const int steps : {1, 60}) {
            ContactStage hand(surface);
            const Quat q = side > 0 ? Quat{1, 0, 0, 0} : glm::angleAxis(kUp, Vec3{1, 0, 0});
            Result r;
            for (int i = 1; i <= steps; ++i) r = hand.move({0.003, 0.002, side * (0.0005 - 0.012 * i / steps)}, q);
            for (int i = 0; i < 40; ++i) r = hand.move({0.003 + 2e-4 * i, 0.002, side * (0.0005 - 0.012)}, q);
            ASSERT_TRUE(r.tuft.touching);
            for (const brush::Section& s : spine(r)) EXPECT_GT(side * s.centre.z, 0.0005 - 3e-4);
            EXPECT_NEAR(side * r.frame.origin.z, 0.0005, 1e-7);
            EXPECT_GT(side * r.frame.n.z, 0.999);
            EXPECT_GT(side * r.tuft.force.z, 0.01);
        }
}

TEST(Contact, FerrulePushedThroughAPlateKeepsItsSide) {
    const mesh::TriangleMesh m = shapes::plate({0.08, 0.08, 0.0005});
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    const double length = hand.preset().length;
    for (int i = 0; i <= 200; ++i) {
        const double depth = 1.5 * length * std::sin(std::numbers::pi * i / 200);
        const Result r = hand.move({0, 0, 0.0005 - depth});
        ASSERT_TRUE(finite(r.tuft.force));
        if (depth > 0.002) {
            EXPECT_TRUE(r.tuft.touching);
            EXPECT_GT(r.tuft.force.z, 0);
            EXPECT_GT(r.frame.n.z, 0.999);
        }
    }
    EXPECT_FALSE(hand.move({0, 0, 0.01}).tuft.touching);
}

TEST(Contact, OpenSheetHasContactFromEitherSide) {
    const mesh::TriangleMesh m = shapes::sheet();  // normals +z, no thickness
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    const Quat below = glm::angleAxis(kUp, Vec3{1, 0, 0});
    Result r;
    for (int i = 0; i <= 40; ++i) r = hand.move({0.01, 0, 0.002 + 2e-4 * i - 0.004}, below);
    ASSERT_TRUE(r.tuft.touching);
    EXPECT_LT(r.tuft.force.z, -0.005);
    EXPECT_LT(r.frame.n.z, -0.999);
    for (const brush::Section& s : spine(r)) EXPECT_LT(s.centre.z, 3e-4);
}

/// Drags a brush that leans into its motion, tip trailing, along -x over the surface z(x).
struct Drag {
    double worst_dip = 0;   ///< deepest node under the true surface, metres
    double worst_jump = 0;  ///< largest change of force from step to step over the mean force
    double mean_force = 0;
    double frame_jump = 0;  ///< largest step of the frame's origin, metres
    double travel = 0;      ///< largest step of the touching hair, metres
};
Drag drag_across(const mesh::SurfaceQuery& surface, const std::function<double(double)>& height, double depth) {
    ContactStage hand(surface);
    const Quat lean = glm::angleAxis(-0.6, Vec3{0, 1, 0});
    for (int i = 0; i <= 40; ++i) hand.move({0.03, 0, height(0.03) - depth * i / 40}, lean);
    for (int i = 0; i < 50; ++i) hand.move({0.03 - 1e-4 * i, 0, height(0.03 - 1e-4 * i) - depth}, lean);
    Drag out;
    Vec3 force{0}, origin{0};
    constexpr int kSteps = 550;
    for (int i = 0; i <= kSteps; ++i) {
        const double x = 0.025 - 1e-4 * i;
        const Result r = hand.move({x, 0, height(x) - depth}, lean);
        EXPECT_TRUE(r.tuft.touching);
        for (const brush::Section& s : spine(r))
            out.worst_dip = std::max(out.worst_dip, (height(s.centre.x) - s.centre.z));
        if (i > 0) {
            out.worst_jump = std::max(out.worst_jump, glm::length(r.tuft.force - force));
            out.frame_jump = std::max(out.frame_jump, glm::length(r.frame.origin - origin));
        }
        out.travel = std::max(out.travel, glm::length(r.travel));
        force = r.tuft.force;
        origin = r.frame.origin;
        out.mean_force += glm::length(force) / kSteps;
        EXPECT_NEAR(r.frame.origin.z, height(r.frame.origin.x), 1e-5);
    }
    out.worst_jump /= out.mean_force;
    return out;
}

TEST(Contact, DragsOverAConvexCreaseAndThroughAGutter) {
    // A node that slips over a sharp edge lets go at once: the hair is a chain of 16 segments.
    for (const auto& [angle, jump] : {std::pair{0.5, 1.0}, {-0.5, 0.15}, {0.25, 0.5}, {-0.25, 0.1}}) {
        const mesh::TriangleMesh m = shapes::roof(angle, 0.3);
        const mesh::SurfaceQuery surface(m);
        const double slope = std::tan(angle);
        const Drag d = drag_across(
            surface, [=](double x) { return -std::abs(x) * slope; }, 0.006);
        SCOPED_TRACE(angle);
        EXPECT_LT(d.worst_dip,
                  5e-5);                // nodes keep off by their radius less what the hair's side gives
        EXPECT_LT(d.worst_jump, jump);  // per 0.1 mm of travel
        EXPECT_LT(d.frame_jump, 1e-3);  // it travels with the hair
        EXPECT_LT(d.travel, 1e-3);      // the hair itself moves no farther than a slip
    }
}

TEST(Contact, SmoothWaveIsFollowedSmoothly) {
    const auto height = [](double x) { return 0.002 * std::sin(x / 0.008); };
    const mesh::TriangleMesh m = shapes::surface(400, 40, [&](double u, double v) {
        const double x = 0.3 * (u - 0.5);
        return Vec3{x, 0.2 * (v - 0.5), height(x)};
    });
    const mesh::SurfaceQuery surface(m);
    const Drag d = drag_across(surface, height, 0.005);
    EXPECT_LT(d.worst_dip, 5e-5);
    EXPECT_LT(d.worst_jump, 0.02);
    EXPECT_LT(d.frame_jump, 2e-4);
}

TEST(Contact, CircleInsideABowlIsSteadyAndTheSameAtEveryAzimuth) {
    constexpr double kRadius = 0.06;
    const mesh::TriangleMesh m = shapes::bowl(kRadius, 160);
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    constexpr double kPolar = 2.4;  // of the touched circle, from +z
    const double depth = 0.006;
    double lo = 1e9, hi = 0, worst = 0;
    const int per_turn = 1200;
    for (int i = 0; i < per_turn + 400; ++i) {
        const double phi = 2 * std::numbers::pi * i / per_turn;
        const Vec3 out{std::sin(kPolar) * std::cos(phi), std::sin(kPolar) * std::sin(phi), std::cos(kPolar)};
        // The holder stands on the surface's normal and turns with the azimuth.
        const Quat q = glm::angleAxis(phi, Vec3{0, 0, 1}) * glm::angleAxis(kPolar - kUp, Vec3{0, 1, 0});
        const Result r = hand.move((kRadius + depth * std::min(1.0, i / 60.0)) * out, q);
        for (const brush::Section& s : spine(r)) worst = std::max(worst, glm::length(s.centre) - kRadius);
        if (i < 400) continue;
        lo = std::min(lo, r.tuft.normal_force);
        hi = std::max(hi, r.tuft.normal_force);
        EXPECT_NEAR(glm::length(r.frame.origin), kRadius, 2e-5);
        EXPECT_LT(glm::dot(r.frame.n, glm::normalize(r.frame.origin)), -0.9995);
    }
    EXPECT_LT(worst, 3e-4);
    EXPECT_GT(lo, 0);
    EXPECT_LT(hi / lo, 1.03);  // facets of 0.6 mm and stick-slip of the nodes
}

TEST(Contact, LeavesAPlateOverItsRim) {
    const mesh::TriangleMesh m = shapes::plate({0.03, 0.05, 0.002}, 60);
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    for (int i = 0; i <= 40; ++i) hand.move({0, 0, 0.002 - 0.008 * i / 40});
    Vec3 force{0};
    double steady = 0, worst = 0;
    bool touching = true;
    for (int i = 0; i <= 700; ++i) {
        const Result r = hand.move({-1e-4 * i, 0, 0.002 - 0.008});
        ASSERT_TRUE(finite(r.tuft.force));
        if (i == 150) steady = glm::length(r.tuft.force);
        if (i > 1) worst = std::max(worst, glm::length(r.tuft.force - force));
        force = r.tuft.force;
        touching = r.tuft.touching;
        for (const brush::Section& s : spine(r)) {
            const bool inside = std::abs(s.centre.x) < 0.03 - 4e-4 && std::abs(s.centre.z) < 0.002 - 4e-4;
            EXPECT_FALSE(inside) << i;
        }
    }
    EXPECT_FALSE(touching);
    EXPECT_NEAR(glm::length(force), 0, 1e-9);
    // The largest jump is the hair's snap when it slips off the edge.
    EXPECT_LT(worst, 1.2 * steady);
}

TEST(Contact, SidesThatMeetAWallStopThere) {
    // A floor with a wall along it, 2.5 mm beside the stroke: the side nodes would reach through.
    const auto reach = [](double wall) {
        const mesh::TriangleMesh m = shapes::surface(120, 60, [&](double u, double v) {
            const double s = 0.12 * u - 0.08;  // over the floor, then up
            return Vec3{std::min(s, wall), 0.2 * (v - 0.5), std::max(0.0, s - wall)};
        });
        const mesh::SurfaceQuery surface(m);
        ContactStage hand(surface, "goat");
        double widest = 0;
        for (int i = 0; i <= 240; ++i) {
            const double depth = 0.012 * std::min(1.0, i / 100.0);
            const Result r = hand.move({0, -0.02 + 2e-4 * i, -depth});
            if (i < 200) continue;
            for (const brush::Section& s : spine(r))
                if (s.centre.z < 2e-3) widest = std::max(widest, s.centre.x + s.a * std::abs(s.e.x));
        }
        return widest;
    };
    const double open = reach(0.03), walled = reach(0.0025);
    EXPECT_GT(open, 3.5e-3);
    EXPECT_LT(walled, 3.0e-3);  // the wall gives by the push over a hundred springs, and a step's lag
}

TEST(Contact, ALedgeBesideTheTuftPushesIt) {
    // 5 mm high, so that it meets the spread hair and not the belly over it.
    struct Pushed {
        Vec3 tip, force;
    };
    const auto drawn = [](double ledge) {
        constexpr double kHigh = 5e-3;
        const mesh::TriangleMesh m = shapes::surface(240, 60, [&](double u, double v) {
            const double s = 0.12 * u - 0.08, up = std::clamp(s - ledge, 0.0, kHigh);
            return Vec3{s - up, 0.2 * (v - 0.5), up};
        });
        const mesh::SurfaceQuery surface(m);
        ContactStage hand(surface, "goat");
        Pushed out{};
        for (int i = 0; i <= 240; ++i) {
            const Result r = hand.move({0, -0.02 + 2e-4 * i, -0.012 * std::min(1.0, i / 100.0)});
            out = {spine(r).front().centre, r.tuft.force};
        }
        return out;
    };
    const Pushed free = drawn(0.03), near = drawn(3.3e-3), nearer = drawn(2.7e-3);
    // The mesh is a mirror image of itself but for its diagonals: to the solver's tolerance nothing goes aside.
    EXPECT_NEAR(free.tip.x, 0, 2e-5);
    EXPECT_LT(near.tip.x, free.tip.x - 1e-4);
    EXPECT_LT(nearer.tip.x, near.tip.x - 1e-4);
    EXPECT_LT(near.force.x, free.force.x - 1e-4);
    EXPECT_LT(nearer.force.x, free.force.x - 1e-4);
}

TEST(Contact, HoverHasAForceWithinTheTolerance) {
    const mesh::TriangleMesh m = shapes::sheet();
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    const double tip_radius = brush::rest_radius(hand.preset(), 1);
    double before = 0;
    for (int i = 0; i <= 400; ++i) {
        const double gap = 0.002 - 5e-6 * i;
        const Result r = hand.move({0.01, 0.02, gap + tip_radius});
        if (gap > 1e-6) {
            EXPECT_NEAR(r.distance, gap, 1e-6);
        }
        // Next to what the tuft itself feels, such as the pull of a wet tip.
        const double force = glm::dot(r.device_force - brush::device_force(hand.preset(), r.tuft), Vec3{0, 0, 1});
        if (gap > 1.0e-3) {
            EXPECT_NEAR(force, 0, 1e-12);
        } else if (gap < 0.9e-3 && gap > 1e-6) {
            EXPECT_NEAR(force, 0.1, 1e-12);
        }
        if (i > 0) {
            EXPECT_LT(std::abs(force - before), 0.006);  // 0.1 N over 0.1 mm: 5 mN per step of 5 µm
        }
        before = force;
    }
}

TEST(Contact, DeviceForceIsClamped) {
    const mesh::TriangleMesh m = shapes::sheet();
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    for (int i = 1; i <= 60; ++i) {
        const Result r = hand.move({0, 0, -0.025 * i / 60});
        const Vec3 wanted = brush::device_force(hand.preset(), r.tuft) + Vec3{0, 0, 0.1};
        const double size = glm::length(wanted);
        EXPECT_NEAR(glm::length(r.device_force - wanted * std::min(1.0, 7.9 / size)), 0, 1e-9);
    }
}

TEST(Contact, VertexMethodGivesThePlaneOfTheSheetAndTheSphereOfTheTuft) {
    const mesh::TriangleMesh m = shapes::sheet(0.2, 300);
    const mesh::SurfaceQuery surface(m);
    Options options;
    options.method = Method::vertices;
    ContactStage by_vertices(surface, "wolf", options), exact(surface);
    for (int i = 0; i <= 80; ++i) {
        const Vec3 tip{std::max(0, i - 40) * 3e-4, 0, -0.01 * std::min(1.0, i / 40.0)};
        const Result a = by_vertices.move(tip), b = exact.move(tip);
        EXPECT_NEAR(glm::length(a.tuft.force - b.tuft.force), 0, 1e-3 * glm::length(b.tuft.force) + 1e-5);
        if (!a.tuft.touching || i < 20) continue;
        EXPECT_NEAR(a.frame.n.z, 1, 1e-9);
        for (const Vec3& p : outline_points(a.tuft))
            EXPECT_LE(glm::length(p - a.sphere.centre), a.sphere.radius * (1 + 1e-12));
        EXPECT_GT(a.patch.vertices.size(), 10u);
    }
}

TEST(Contact, AnyPoseIsFiniteAndLeavesTheTuftUsable) {
    const mesh::TriangleMesh bowl = shapes::bowl(0.06, 40);
    const mesh::TriangleMesh plate = shapes::plate({0.05, 0.04, 0.001}, 20);
    const mesh::TriangleMesh roof = shapes::roof(1.2, 0.1, 20);
    for (const mesh::TriangleMesh* m : {&bowl, &plate, &roof}) {
        const mesh::SurfaceQuery surface(*m);
        ContactStage hand(surface, "goat");
        Random random(11);
        for (int i = 0; i < 700; ++i) {
            const Quat q = glm::normalize(Quat{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                                               random.uniform(-1, 1) + 1e-3});
            const double spread = i % 7 == 0 ? 1.0 : 0.05;
            hand.options.method = i % 3 == 0 ? Method::vertices : Method::exact;
            const Result r = hand.move(
                {random.uniform(-spread, spread), random.uniform(-spread, spread), random.uniform(-spread, spread)}, q);
            ASSERT_TRUE(finite(r.tuft.force) && finite(r.device_force) && finite(r.frame.origin) && finite(r.frame.n));
            ASSERT_NEAR(glm::length(r.frame.n), 1, 1e-9);
            ASSERT_LE(glm::length(r.device_force), hand.preset().force_limit + 1e-9);
            for (const brush::Branch& b : r.tuft.branches)
                for (const brush::Section& s : b.sections) ASSERT_TRUE(finite(s.centre));
        }
    }
}

// After a jump of the hand the planes may be too far off. While it stands still they are looked for again until they
// hold.
TEST(Contact, PlanesOfARestAreTrueWhereTheNodesLie) {
    const mesh::TriangleMesh m = shapes::bowl(0.02, 60);
    const mesh::SurfaceQuery surface(m);
    ContactStage hand(surface);
    Random random(4);
    int compared = 0;
    for (int jump = 0; jump < 40; ++jump) {
        const double x = random.uniform(-0.008, 0.008), y = random.uniform(-0.008, 0.008);
        const Vec3 tip{x, y, -std::sqrt(4e-4 - x * x - y * y) - random.uniform(1e-3, 8e-3)};
        Result r;
        for (int i = 0; i < 6; ++i) r = hand.move(tip);
        const brush::Pose pose = pose_at(hand.preset(), tip);
        const Recycled<Vec3> nodes = brush::predicted_nodes(hand.tuft, pose);
        const NodeContact root = find_node_contact(surface, {pose.position, pose.position}, {});
        const Recycled<NodeContact> fresh = find_chain_contacts(surface, root, nodes, 0.01, {});
        ASSERT_EQ(r.planes.size(), nodes.size());
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const double height = brush::height_over(fresh[i].wedge, nodes[i]);
            if (height > 1e-3) continue;
            ++compared;
            EXPECT_NEAR(brush::height_over(r.planes[i], nodes[i]), height, hand.options.refresh_error)
                << jump << " " << i;
        }
    }
    EXPECT_GT(compared, 100);
}

// Where the patch passes over a gap depends on the hand's path, not on how finely it is sampled: at all spacings the
// frame goes over to the far plate with the hand at the same place, to one spacing of the coarsest.
TEST(Contact, TheFrameCrossesAGapAtTheSamePlaceAtEverySpacing) {
    constexpr double kGap = 3e-3, kCoarsest = 0.4e-3;
    const Vec3 half{0.05, 0.05, 0.005};
    const mesh::TriangleMesh plate = shapes::plate(half);
    mesh::TriangleMesh m;
    for (const double side : {-1.0, 1.0}) {
        const auto first = static_cast<std::uint32_t>(m.positions.size());
        for (const Vec3f& p : plate.positions)
            m.positions.emplace_back(Vec3(p) + Vec3{side * (half.x + 0.5 * kGap), 0, -half.z});
        for (const auto& t : plate.triangles) m.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    shapes::finish(m);
    const mesh::SurfaceQuery surface(m);
    double least = 1, most = -1;
    for (const double spacing : {0.05e-3, 0.1e-3, 0.2e-3, kCoarsest}) {
        ContactStage hand(surface, "wolf-medium");
        double crossed = 1;
        for (double depth = 0; depth < 0.006; depth += spacing) hand.move({-0.02, 0.0003, -depth});
        for (double x = -0.02; x < 0.04 && crossed > 0.9; x += spacing)
            if (hand.move({x, 0.0003, -0.006}).frame.origin.x > 0) crossed = x;
        ASSERT_LT(crossed, 0.9) << "at " << spacing;
        least = std::min(least, crossed);
        most = std::max(most, crossed);
    }
    EXPECT_LT(most - least, kCoarsest);
}

TEST(Contact, AFerruleThatWouldEnterTheObjectIsHeldOnItsSurface) {
    // A block of 200 × 200 × 100 mm, from above into its middle; the tuft, 20 or 32 mm long, once made 2,000 N there.
    const mesh::TriangleMesh block = shapes::plate({0.1, 0.1, 0.05});
    const mesh::SurfaceQuery surface(block);
    for (const char* name : {"wolf-medium", "goat-small"}) {
        ContactStage hand(surface, name);
        const double length = hand.preset().length, down = 0.05 - length;
        double flat = 0;                                             // force where the ferrule rests on pressed hair
        for (double below = -length; below < 0.06; below += 1e-4) {  // of the ferrule's mouth
            const Result r = hand.move({0, 0, down - below});
            const double force = glm::length(r.tuft.force);
            if (below < -0.5 * hand.preset().radius) flat = std::max(flat, force);
            ASSERT_LT(force, 1.1 * flat + 1) << name << ", " << below;
            EXPECT_NEAR(r.inside, std::max(0.0, below), 3e-5) << "what a stand is lifted by";
        }
        EXPECT_LT(flat, 60) << "a firm press of a whole arm";
        // One that begins there is solved, too.
        ContactStage inside(surface, name);
        const Result first = inside.move({0, 0, down - 0.02});
        EXPECT_NEAR(first.inside, 0.02, 3e-5);
        EXPECT_TRUE(first.tuft.converged) << name;
        // It lies otherwise than hair that came there slowly, with friction at rest: a third more.
        EXPECT_LT(glm::length(first.tuft.force), 1.5 * flat + 1);
        EXPECT_GT(first.tuft.force.z, 0);
    }
}

TEST(Contact, DepthInsideIsOfClosedBodiesOnly) {
    const mesh::TriangleMesh block = shapes::plate({0.1, 0.1, 0.05}), sheet = shapes::sheet(),
                             bowl = shapes::bowl(0.05);
    const mesh::SurfaceQuery in_block(block), on_sheet(sheet), in_bowl(bowl);
    EXPECT_NEAR(depth_inside(in_block, {0, 0, 0.02}), 0.03, 1e-6);
    EXPECT_NEAR(depth_inside(in_block, {-0.09, 0.01, 0}), 0.01, 1e-6);
    for (const Vec3& p : {Vec3{0, 0, 0.06}, {0.2, 0, 0}, {-0.1001, 0, 0}}) EXPECT_EQ(depth_inside(in_block, p), 0);
    for (const double z : {-0.01, 0.0, 0.01}) EXPECT_EQ(depth_inside(on_sheet, {0.01, 0.02, z}), 0);
    for (const Vec3& p : {Vec3{0, 0, -0.04}, {0, 0, -0.06}, {0.03, 0, -0.001}}) EXPECT_EQ(depth_inside(in_bowl, p), 0);
}

}  // namespace
}  // namespace tuft::contact
