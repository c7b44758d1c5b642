#include "brush/tuft/tuft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/random.h"
#include "core/text/units.h"

namespace tuft::brush {
namespace {

Preset plain(const std::string& name = "mixed-medium") {
    Preset p = load_preset(name);
    p.yield = 0;
    return p;
}

/// A short stroke: press while moving along `direction`, drag, maybe lift. All inputs can be
/// turned by a rigid motion.
struct Motion {
    Quat rotation{1, 0, 0, 0};
    Vec3 shift{0};
    Vec3 apply(const Vec3& p) const { return rotation * p + shift; }
};

struct Stroke {
    Vec3 direction{1, 0, 0};
    double depth = 0.25;  // of the length
    double lean = 0.12;   // radians, of the axis towards -x
    int press = 80, drag = 120, lift = 0;
    Motion motion;
};

TuftState draw(Tuft& tuft, const Stroke& s) {
    const double length = tuft.preset.length;
    ContactPlane plane{s.motion.apply({0, 0, 0}), s.motion.rotation * Vec3{0, 0, 1}};
    const Quat lean = glm::angleAxis(s.lean, Vec3{0, 1, 0});
    Pose pose;
    TuftState state;
    Vec3 at{0, 0, 0};
    for (int i = 1; i <= s.press + s.drag + s.lift; ++i) {
        at += 0.01 * length * s.direction;
        double depth = s.depth * std::min(1.0, static_cast<double>(i) / s.press);
        if (i > s.press + s.drag) depth *= 1 - 1.3 * (i - s.press - s.drag) / s.lift;
        pose.position = s.motion.apply(at + Vec3{0, 0, length * (std::cos(s.lean) - depth)});
        pose.rotation = s.motion.rotation * lean;
        pose.time = 0.005 * i;
        state = step(tuft, pose, {&plane, 1}, 0.005);
    }
    return state;
}

TEST(Tuft, SegmentsKeepTheirLengthAndSectionsTheirArea) {
    Preset preset = load_preset("goat-medium");
    preset.tip_drop = 0;  // ink, not hair
    Tuft tuft = make_tuft(preset);
    const TuftState state = draw(tuft, {});
    const Recycled<Vec3>& x = tuft.trunk().memory.node;
    for (int j = 0; j < tuft.trunk().rod.segments(); ++j) {
        EXPECT_NEAR(glm::length(x[j + 1] - x[j]), tuft.trunk().rod.length[j], 1e-12);
    }
    const Recycled<Section>& sections = state.branches.front().sections;
    ASSERT_EQ(sections.size(), x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double r = tuft.trunk().rest.radius[x.size() - 1 - i];
        EXPECT_NEAR(sections[i].a * sections[i].b, r * r, 1e-12 * r * r);
        EXPECT_LE(sections[i].a, tuft.preset.flatten_max * r * (1 + 1e-12));
        EXPECT_NEAR(glm::dot(sections[i].e, sections[i].tangent), 0, 1e-12);
        EXPECT_NEAR(glm::length(sections[i].e), 1, 1e-12);
        EXPECT_LT(glm::length(glm::cross(sections[i].e, sections[i].tangent) - sections[i].m), 1e-12);
    }
}

TEST(Tuft, PressAndLiftReturnsToRestWhenElastic) {
    Tuft tuft = make_tuft(plain());
    Stroke s;
    s.lift = 100;
    const TuftState state = draw(tuft, s);
    EXPECT_FALSE(state.touching);
    for (const Vec3& t : tuft.trunk().memory.tangent) {
        // Residual moment 1e-6 over the softest joint of about 1e-3.
        EXPECT_GT(glm::dot(t, tuft.pose.axis()), 1 - 1e-6);
    }
}

TEST(Tuft, AWetSoftTuftKeepsASetThatReshapingTakesOut) {
    Preset p = load_preset("goat-medium");
    p.yield = 0.4;
    p.plastic_share = 0.5;
    Tuft tuft = make_tuft(p);
    Stroke s;
    s.depth = 0.4;
    s.lift = 150;
    TuftState state = draw(tuft, s);
    EXPECT_FALSE(state.touching);
    const auto tip_angle = [&] {
        return std::acos(std::min(1.0, glm::dot(tuft.trunk().memory.tangent.back(), tuft.pose.axis())));
    };
    EXPECT_GT(tip_angle(), 0.05);
    reshape(tuft);
    state = step(tuft, tuft.pose, {}, 0.01);
    EXPECT_LT(tip_angle(), 1e-7);
}

/// Angle between the tip and the ferrule's axis, radians.
double tip_angle(const Tuft& tuft) {
    return std::acos(std::min(1.0, glm::dot(tuft.trunk().memory.tangent.back(), tuft.pose.axis())));
}

TEST(Tuft, DryHairSpringsBackWhereWetHairKeepsASet) {
    double set[2];
    for (const int wet : {0, 1}) {
        Preset p = load_preset("goat-medium");
        p.yield = 0.4;
        p.plastic_share = 0.5;
        p.recovery = 0;
        p.friction_dry = p.friction_wet;
        Tuft tuft = make_tuft(p);
        tuft.wetness = wet;
        Stroke s;
        s.depth = 0.4;
        s.lift = 150;
        EXPECT_FALSE(draw(tuft, s).touching);
        set[wet] = tip_angle(tuft);
    }
    EXPECT_LT(set[0], 0.6 * set[1]);
    EXPECT_GT(set[0], 0);
}

TEST(Tuft, ASetGoesBackWithTimeTheSameHoweverItIsDivided) {
    double after[2];
    for (const int parts : {1, 10}) {
        Preset p = load_preset("goat-medium");
        p.yield = 0.4;
        p.plastic_share = 0.5;
        p.recovery = 5;
        Tuft tuft = make_tuft(p);
        Stroke s;
        s.depth = 0.4;
        s.lift = 150;
        draw(tuft, s);
        double before = tip_angle(tuft);
        ASSERT_GT(before, 0.05);
        for (int i = 0; i < 4 * parts; ++i) {
            step(tuft, tuft.pose, {}, 0.5 / parts);
            EXPECT_LE(tip_angle(tuft), before + 1e-5);  // the solver's tolerance on the soft tip
            before = tip_angle(tuft);
        }
        after[parts > 1] = before;
        step(tuft, tuft.pose, {}, 0);
        EXPECT_NEAR(tip_angle(tuft), before, 1e-4);  // without time nothing goes back
    }
    EXPECT_NEAR(after[0], after[1], 0.02 * after[1] + 1e-4);
}

TEST(Tuft, RigidMotionOfAllInputsMovesTheOutputs) {
    const Stroke plain_stroke;
    Tuft reference = make_tuft(load_preset("mixed-medium"));
    const TuftState expected = draw(reference, plain_stroke);
    Random random(11);
    for (int trial = 0; trial < 4; ++trial) {
        Stroke s = plain_stroke;
        s.motion.rotation =
            glm::angleAxis(random.uniform(0, 3),
                           glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}));
        s.motion.shift = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        Tuft tuft = make_tuft(load_preset("mixed-medium"));
        const TuftState state = draw(tuft, s);
        // Round-off in the inputs is 1e-16 m; 200 solves to a tolerance of 1e-6 of the root moment.
        for (std::size_t i = 0; i < expected.branches[0].sections.size(); ++i) {
            const Section &a = expected.branches[0].sections[i], &b = state.branches[0].sections[i];
            EXPECT_LT(glm::length(s.motion.apply(a.centre) - b.centre), 2e-6);
            EXPECT_NEAR(a.a, b.a, 1e-2 * a.a);
        }
        EXPECT_LT(glm::length(s.motion.rotation * expected.force - state.force), 1e-2 * glm::length(expected.force));
    }
}

TEST(Tuft, TurningTheHolderAboutItsAxisChangesNothing) {
    Tuft a = make_tuft(plain()), b = make_tuft(plain());
    const ContactPlane plane;
    TuftState sa, sb;
    for (int i = 1; i <= 150; ++i) {
        const Quat lean = glm::angleAxis(0.15, Vec3{0, 1, 0});
        Pose pose{{3e-4 * i, 0, 0.0317 - 5e-5 * i}, lean, 0.01 * i};
        sa = step(a, pose, {&plane, 1}, 0.01);
        pose.rotation = lean * glm::angleAxis(1.1, Vec3{0, 0, 1});
        sb = step(b, pose, {&plane, 1}, 0.01);
    }
    EXPECT_LT(glm::length(sa.branches[0].sections[0].centre - sb.branches[0].sections[0].centre), 1e-6);
    EXPECT_LT(glm::length(sa.force - sb.force), 1e-2 * glm::length(sa.force));
}

TEST(Tuft, ASymmetricStrokeStaysInItsPlane) {
    Tuft tuft = make_tuft(load_preset("mixed-medium"));
    const TuftState state = draw(tuft, {});
    for (const Section& s : state.branches[0].sections) {
        EXPECT_NEAR(s.centre.y, 0, 1e-9);
        EXPECT_NEAR(std::abs(s.e.y), 1, 1e-9);
    }
    EXPECT_NEAR(state.force.y, 0, 1e-9);
}

TEST(Tuft, DragInEightDirectionsGivesTheTurnedResult) {
    Stroke s;
    s.lean = 0;
    double width = 0;
    for (int k = 0; k < 8; ++k) {
        const double angle = k * std::numbers::pi / 4;
        s.direction = {std::cos(angle), std::sin(angle), 0};
        Tuft tuft = make_tuft(load_preset("mixed-medium"));
        const TuftState state = draw(tuft, s);
        const Vec3 tip = state.branches[0].sections.front().centre - tuft.pose.position;
        const double behind = -glm::dot(tip, s.direction);
        EXPECT_GT(behind, 0.2 * tuft.preset.length);
        EXPECT_LT(std::abs(tip.x * s.direction.y - tip.y * s.direction.x), 0.01 * tuft.preset.length);
        if (k == 0) width = behind;
        EXPECT_NEAR(behind, width, 0.01 * width);
    }
}

/// Pressed straight down half its length, then dragged to `direction`.
struct PressedDown {
    Tuft tuft;
    ContactPlane plane;
    Pose pose;
    TuftState state;

    PressedDown(const std::string& name, const Quat& rotation) : tuft(make_tuft(load_preset(name))) {
        const double length = tuft.preset.length;
        pose.rotation = rotation;
        for (int i = 0; i <= 100; ++i) {
            pose.position.z = length * (1 - 0.005 * i);
            pose.time = 0.005 * i;
            state = step(tuft, pose, {&plane, 1}, 0.005);
        }
    }

    /// Lengths of travel, in steps of a hundredth.
    void drag(const Vec3& direction, double lengths) {
        for (int i = 0; i < std::lround(100 * lengths); ++i) {
            pose.position += 0.01 * tuft.preset.length * direction;
            pose.time += 0.005;
            state = step(tuft, pose, {&plane, 1}, 0.005);
        }
    }

    /// The tip behind the root along `direction` and to its left, in lengths.
    Vec2 trail(const Vec3& direction) const {
        const Vec3 back = (pose.position - state.branches[0].sections.front().centre) / tuft.preset.length;
        return {glm::dot(back, direction), glm::dot(-back, Vec3{-direction.y, direction.x, 0})};
    }

    /// Length of hair that lies on the sheet, in lengths; of a segment the part whose side is under it.
    double contact() const {
        double sum = 0;
        const Recycled<Section>& s = state.branches[0].sections;
        for (std::size_t i = 0; i + 1 < s.size(); ++i) {
            const double from = s[i].centre.z - s[i].b, to = s[i + 1].centre.z - s[i + 1].b;
            const double low = std::min(from, to), high = std::max(from, to);
            const double part = high <= 0 ? 1 : low < 0 ? low / (low - high) : 0;
            sum += part * glm::length(s[i + 1].centre - s[i].centre) / tuft.preset.length;
        }
        return sum;
    }
};

TEST(Tuft, PressedStraightDownItFollowsTheDragWithinAContactLength) {
    // Hair that splays evenly has no side to keep: a tractrix alone would never turn one that lies ahead,
    // and takes two lengths where it lies 45° from there.
    for (const std::string name : {"mixed-medium", "goat-medium", "wolf-small"}) {
        for (const double turned : {0.0, 0.7}) {
            Vec2 first{0};
            double force = 0;
            for (int k = 0; k < 8; ++k) {
                const double angle = k * std::numbers::pi / 4;
                const Vec3 d{std::cos(angle), std::sin(angle), 0};
                SCOPED_TRACE(name + " turned " + std::to_string(turned) + " towards " + std::to_string(k));
                PressedDown pressed(name, glm::angleAxis(turned, Vec3{0, 0, 1}));
                const double contact = pressed.contact();
                EXPECT_GT(contact, 0.25);
                EXPECT_LT(contact, 0.6);
                pressed.drag(d, contact);
                // Trailing: within 14° of straight behind, which the whole hair is after twice as far.
                Vec2 trail = pressed.trail(d);
                EXPECT_GT(trail.x, 0.5);
                EXPECT_LT(std::abs(trail.y), std::tan(0.24) * trail.x);
                pressed.drag(d, 3 - contact);
                trail = pressed.trail(d);
                if (k == 0) {
                    first = trail;
                    force = pressed.state.normal_force;
                }
                // As DragInEightDirectionsGivesTheTurnedResult.
                EXPECT_NEAR(trail.x, first.x, 0.01 * first.x);
                // Soft wet hair keeps a little of the set that it took where it lay first.
                EXPECT_LT(std::abs(trail.y), name == "goat-medium" ? 0.015 : 0.01);
                EXPECT_NEAR(pressed.state.normal_force, force, 0.01 * force);
            }
        }
    }
}

TEST(Tuft, AHandThatTremblesWhileItPressesDoesNotTurnTheHairAbout) {
    // To and fro by 0.1 mm at 8 Hz, as hands do: the splayed hair's mean comes back each time.
    PressedDown pressed("mixed-medium", Quat{1, 0, 0, 0});
    const Vec2 before = pressed.trail({1, 0, 0});
    const Vec3 at = pressed.pose.position;
    for (int i = 1; i <= 250; ++i) {
        pressed.pose.position = at + 1e-4 * std::sin(0.25 * i) * Vec3{0.6, 0.8, 0};
        pressed.pose.time += 0.005;
        pressed.state = step(pressed.tuft, pressed.pose, {&pressed.plane, 1}, 0.005);
    }
    EXPECT_LT(glm::length(pressed.trail({1, 0, 0}) - before), 0.01);
}

TEST(Tuft, SteadyDragIsSteady) {
    for (const std::string name : {"wolf-small", "mixed-medium", "goat-large"}) {
        Tuft tuft = make_tuft(load_preset(name));
        Stroke s;
        s.drag = 300;
        draw(tuft, s);
        const double length = tuft.preset.length;
        const ContactPlane plane;
        Pose pose = tuft.pose;
        Vec3 tip_t0 = tuft.trunk().memory.node.back() * length - pose.position;
        for (int i = 0; i < 100; ++i) {
            pose.position.x += 0.01 * length;
            const TuftState state = step(tuft, pose, {&plane, 1}, 0.005);
            const Vec3 tip = tuft.trunk().memory.node.back() * length - pose.position;
            EXPECT_LT(glm::length(tip - tip_t0), 1e-6) << name;  // a micrometre: far below a texel
            EXPECT_TRUE(state.converged);
            tip_t0 = tip;
        }
    }
}

TEST(Tuft, HalfTheStepGivesTheSameEnd) {
    const auto end = [](int parts) {
        Tuft tuft = make_tuft(load_preset("mixed-medium"));
        const ContactPlane plane;
        TuftState state;
        for (int i = 1; i <= 200 * parts; ++i) {
            const double t = static_cast<double>(i) / parts;
            const Pose pose{
                {2.5e-4 * t, 2e-3 * std::sin(0.02 * t), 0.032 - 0.007 * std::min(1.0, t / 80)}, {1, 0, 0, 0}, 0.01 * t};
            state = step(tuft, pose, {&plane, 1}, 0.01 / parts);
        }
        return state;
    };
    const TuftState coarse = end(1), fine = end(2);
    EXPECT_LT(glm::length(coarse.branches[0].sections[0].centre - fine.branches[0].sections[0].centre), 0.01 * 0.032);
    EXPECT_NEAR(coarse.normal_force, fine.normal_force, 0.01 * fine.normal_force);
}

TEST(Tuft, ScalesWithLengthAndStiffness) {
    const double s = 1.7, c = 2.3;
    Preset small = plain(), large = small;
    large.length *= s;
    large.radius *= s;
    large.tip_radius *= s;
    large.stiffness *= c;
    large.transverse_stiffness *= c / std::pow(s, 4);
    large.adhesion *= c / std::pow(s, 3);
    large.adhesion_range *= s;
    Tuft a = make_tuft(small), b = make_tuft(large);
    const TuftState sa = draw(a, {}), sb = draw(b, {});
    // Only the fuzz of 0.05 mm is a fixed length.
    EXPECT_LT(glm::length(sa.branches[0].sections[0].centre * s - sb.branches[0].sections[0].centre),
              1e-2 * large.length);
    EXPECT_NEAR(sb.normal_force, sa.normal_force * c / (s * s), 0.03 * sb.normal_force);
    EXPECT_NEAR(sb.root_moment, sa.root_moment * c / s, 0.03 * sb.root_moment);
}

TEST(Tuft, ForceGrowsWithDepth) {
    double before = 0;
    for (const double depth : {0.05, 0.1, 0.2, 0.3, 0.4}) {
        Tuft tuft = make_tuft(load_preset("wolf-medium"));
        Stroke s;
        s.depth = depth;
        const TuftState state = draw(tuft, s);
        EXPECT_GT(state.normal_force, before);
        before = state.normal_force;
        const Vec3 filtered = device_force(tuft.preset, state);
        EXPECT_LE(glm::length(filtered), tuft.preset.force_limit * (1 + 1e-12));
        EXPECT_GT(glm::dot(filtered, state.force), 0);
    }
}

// Sections come to touch one after the other; each joins those that lie without a jump. Nothing draws a section down
// faster than the hand goes but what bends on under it: a quarter more.
TEST(Tuft, SectionsMoveNoFasterThanTheHandThatPresses) {
    constexpr double kStep = 1e-5;  // metres
    for (const std::string name : {"mixed-medium", "wolf-medium", "goat-medium"}) {
        for (const double lean : {15.0, 30.0, 50.0}) {
            Preset preset = load_preset(name);
            preset.segments = 24;
            Tuft tuft = make_tuft(preset);
            const ContactPlane plane;
            Pose pose;
            pose.rotation = glm::angleAxis(lean * kDegree, Vec3{0, 1, 0});
            TuftState before;
            double fastest = 0;
            for (int i = 0; i * kStep < 0.25 * preset.length; ++i) {
                pose.time = i * 1e-3;
                pose.position = -preset.length * pose.axis() - Vec3{0, 0, i * kStep};
                TuftState state = step(tuft, pose, {&plane, 1}, 1e-3);
                for (std::size_t k = 0; i > 100 && k < state.branches[0].sections.size(); ++k) {
                    const double moved =
                        state.branches[0].sections[k].centre.z - before.branches[0].sections[k].centre.z;
                    fastest = std::max(fastest, std::abs(moved) / kStep);
                }
                before = std::move(state);
            }
            EXPECT_LT(fastest, 1.25) << name << " leaning " << lean << " degrees";
        }
    }
}

TEST(Tuft, OnePlanePerNodeOfTheSamePlaneIsOnePlane) {
    Tuft a = make_tuft(load_preset("mixed-medium")), b = a;
    const ContactPlane plane;
    const Recycled<ContactPlane> planes(17, plane);
    for (int i = 1; i <= 100; ++i) {
        const Pose pose{{2e-4 * i, 0, 0.032 - 7e-5 * i}, {1, 0, 0, 0}, 0.01 * i};
        const TuftState sa = step(a, pose, {&plane, 1}, 0.01), sb = step(b, pose, planes, 0.01);
        EXPECT_NEAR(sa.normal_force, sb.normal_force, 1e-9);
    }
    EXPECT_THROW(step(a, a.pose, std::span(planes).first(5), 0.01), Error);
}

TEST(Tuft, RefusesPosesThatAreNone) {
    Tuft tuft = make_tuft(load_preset("mixed-medium"));
    Pose pose;
    pose.position.y = std::nan("");
    EXPECT_THROW(step(tuft, pose, {}, 0.01), Error);
    pose = {};
    pose.rotation = {0, 0, 0, 0};
    EXPECT_THROW(step(tuft, pose, {}, 0.01), Error);
}

TEST(Tuft, SplitsWhenBentAndDryAndMergesWhenWetAgain) {
    Preset preset = load_preset("mixed-medium");
    preset.split_factor = 3;  // the paper's
    Tuft tuft = make_tuft(preset);
    tuft.ink_left = 0.02;
    Stroke s;
    s.depth = 0.42;
    TuftState state = draw(tuft, s);
    ASSERT_TRUE(tuft.split);
    ASSERT_EQ(state.branches.size(), 3u);
    double shares = 0;
    for (const Branch& b : state.branches) shares += b.ink_share;
    EXPECT_NEAR(shares, 1, 1e-12);
    // The tips have the tuft's tip area between them and lie apart.
    double area = 0;
    for (const Branch& b : state.branches) area += b.sections[1].a * b.sections[1].b;
    const double r = tuft.trunk().rest.radius[15];
    EXPECT_NEAR(area, r * r, 1e-9 * r * r);
    EXPECT_GT(glm::length(state.branches[0].sections[0].centre - state.branches[2].sections[0].centre), 5e-4);
    // They leave side by side from edge to edge of the trunk, as flat as it is.
    const std::size_t leave = state.branches[0].sections.size() - 1;
    const Section& trunk = state.branches[1].sections[leave];
    for (const int side : {0, 2}) {
        const Section& root = state.branches[side].sections[leave];
        EXPECT_NEAR(root.a / root.b, trunk.a / trunk.b, 1e-9 * trunk.a / trunk.b);
        EXPECT_NEAR(glm::length(root.centre - trunk.centre) + root.a, trunk.a, 1e-6 * trunk.a);
        // The next section, a segment on, goes on from there; one that began round was not half as wide.
        EXPECT_GT(state.branches[side].sections[leave - 1].a, 0.7 * root.a);
    }
    EXPECT_EQ(predicted_nodes(tuft, tuft.pose).size(), 17 + 3 * tuft.sub_spines[0].rest.radius.size());
    tuft.ink_left = 1;
    const ContactPlane plane;
    step(tuft, tuft.pose, {&plane, 1}, 0.01);
    EXPECT_TRUE(tuft.split) << "water takes its time";
    for (int i = 0; i < 30; ++i) state = step(tuft, tuft.pose, {&plane, 1}, 0.01);
    EXPECT_EQ(state.branches.size(), 1u);
}

TEST(Tuft, TenThousandRandomPosesStayFiniteAndBounded) {
    Random random(2024);
    for (const std::string name : {"wolf-medium", "goat-small"}) {
        Tuft tuft = make_tuft(load_preset(name));
        const double length = tuft.preset.length;
        for (int i = 0; i < 5000; ++i) {
            if (i % 500 == 0) reset(tuft);
            tuft.ink_left = random.uniform();
            Pose pose;
            const double reach = i % 3 == 0 ? 3 * length : 0.5 * length;  // jumps of up to 10 m/s at 100 Hz
            pose.position = {random.uniform(-reach, reach), random.uniform(-reach, reach),
                             random.uniform(-reach, 1.2 * length)};
            const Vec3 axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
            pose.rotation =
                glm::angleAxis(random.uniform(0, i % 2 == 0 ? 3.14 : 0.5), glm::normalize(axis + Vec3{1e-9, 0, 0}));
            ContactPlane plane;
            plane.normal = glm::normalize(Vec3{random.uniform(-1, 1), random.uniform(-1, 1), 1.2});
            Recycled<ContactPlane> planes(predicted_nodes(tuft, pose).size(), plane);
            for (ContactPlane& p : planes) p.origin.z += 1e-3 * random.uniform();
            const TuftState state = step(tuft, pose, planes, 0.01);
            ASSERT_TRUE(std::isfinite(state.normal_force) && std::isfinite(glm::length(state.force)));
            // The rod and three sub-spines: 60 each, the last of which may cost five trials and the
            // eigenvectors' twelve.
            ASSERT_LE(state.work.iterations, 4 * (59 + 17));
            for (const Branch& b : state.branches) {
                for (const Section& s : b.sections) {
                    ASSERT_TRUE(std::isfinite(glm::length(s.centre)) && std::isfinite(s.a) &&
                                std::isfinite(glm::length(s.e)));
                    // Hair does not grow: its length from the ferrule, moved by at most its
                    // radius, by half of what it spreads, and by a wet film.
                    const double about =
                        (1 + 0.5 * tuft.preset.flatten_max) * tuft.preset.radius + 2 * tuft.preset.adhesion_range;
                    ASSERT_LE(glm::length(s.centre - pose.position), length + about);
                }
            }
            for (std::size_t j = 0; j < tuft.trunk().memory.tangent.size(); ++j) {
                ASSERT_NEAR(glm::length(tuft.trunk().memory.tangent[j]), 1, 1e-9);
            }
        }
    }
}

TEST(Tuft, TheSameStrokeGivesTheSameBits) {
    Tuft a = make_tuft(load_preset("goat-medium")), b = make_tuft(load_preset("goat-medium"));
    const TuftState sa = draw(a, {}), sb = draw(b, {});
    EXPECT_EQ(sa.force, sb.force);
    EXPECT_EQ(sa.branches[0].sections[0].centre, sb.branches[0].sections[0].centre);
}

}  // namespace
}  // namespace tuft::brush
