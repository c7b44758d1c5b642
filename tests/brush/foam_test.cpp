#include "brush/tuft/foam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/tuft/tuft.h"
#include "core/error.h"

/// Laws of a sponge: Winkler's foundation of foam.
namespace tuft::brush {
namespace {

using std::numbers::pi;

/// sponge-30 with a smooth flat face.
Preset smooth(double dome = 0) {
    Preset p = load_preset("sponge-30");
    p.dome = dome;
    p.rim = p.unevenness = 0;
    p.friction_wet = p.friction_dry = 0;
    return p;
}

TuftState pressed(Tuft& tuft, double depth, const Quat& rotation = {1, 0, 0, 0}) {
    const ContactPlane plane;
    Pose pose{{0, 0, 0}, rotation, 0};
    pose.position = -(tuft.preset.length - depth) * pose.axis();
    return step(tuft, pose, {&plane, 1}, 0.01);
}

TuftState pressed(const Preset& p, double depth) {
    Tuft tuft = make_tuft(p);
    return pressed(tuft, depth);
}

// F = E* A d/H, and E* π R d²/H for a dome. The face is a polygon of 176 corners on its circle (0.02 % less area); the
// dome's law is the first term in d/R.
TEST(Foam, FlatFaceAndDomeFollowWinkler) {
    const Preset flat = smooth(), dome = smooth(0.06);
    const double area = pi * flat.radius * flat.radius;
    for (const double d : {1e-4, 1e-3, 5e-3, 15e-3, 23e-3})
        EXPECT_NEAR(pressed(flat, d).normal_force / (flat.modulus * area * d / flat.length), 1, 0.02) << d;
    for (const double d : {4e-4, 8e-4, 1.5e-3})
        EXPECT_NEAR(pressed(dome, d).normal_force / (dome.modulus * pi * dome.dome * d * d / dome.length), 1, 0.02)
            << d;
}

// From ε_D = 1 − 1.4 φ on it stiffens, without bound and without turning over.
TEST(Foam, StiffensWhereItsCellsAreShut) {
    const double solid = 0.03, dense = densification_strain(solid);
    EXPECT_DOUBLE_EQ(dense, 0.958);
    double before = 0, slope = 0;
    for (double e = 0.001; e < 0.999; e += 0.001) {
        const double s = foam_stress(solid, e);
        EXPECT_GE(s - before, slope - 1e-12) << e;
        if (e < dense) {
            EXPECT_DOUBLE_EQ(s, e);
        }
        slope = s - before;
        before = s;
        // Stress is the slope of the energy: central differences.
        EXPECT_NEAR((foam_energy(solid, e + 1e-6) - foam_energy(solid, e - 1e-6)) / 2e-6, s, 1e-5 + 1e-3 * s);
    }
    Tuft tuft = make_tuft(smooth());
    double force = 0;
    for (double d = 1e-3; d < 0.04; d += 1e-3) {  // also deeper than it is high
        const TuftState state = pressed(tuft, d);
        EXPECT_GE(state.normal_force, force);
        force = state.normal_force;
        for (const Vec3& p : state.shape.position) EXPECT_LE(p.z, std::max(0.0, tuft.preset.length - d) + 1e-9);
    }
}

// The volume lost is A d; the work of the hand is what is stored.
TEST(Foam, LosesTheVolumeThatIsPressedOut) {
    const Preset p = smooth();
    const double area = pi * p.radius * p.radius;
    Tuft tuft = make_tuft(p);
    double work = 0, before = 0;
    for (double d = 0; d <= 6.00001e-3; d += 1e-4) {
        const TuftState state = pressed(tuft, d);
        EXPECT_NEAR(state.volume_lost, area * d, 1e-3 * area * d + 1e-15);
        work += 0.5e-4 * (before + state.force.z);
        before = state.force.z;
        EXPECT_NEAR(state.energy.stored(), work, 1e-3 * work + 1e-12);
    }
}

// Its force is that of a sponge leant the other way, seen in a mirror.
TEST(Foam, LeansLikeItsMirrorImage) {
    for (const double lean : {0.1, 0.3, 0.6}) {
        Tuft a = make_tuft(smooth()), b = make_tuft(smooth());
        const TuftState p = pressed(a, 5e-3, glm::angleAxis(lean, Vec3{0, 1, 0})),
                        q = pressed(b, 5e-3, glm::angleAxis(-lean, Vec3{0, 1, 0}));
        EXPECT_GT(p.normal_force, 0);
        // The diagonals of the face's squares have no mirror image: a part in a thousand of its area.
        EXPECT_NEAR(p.normal_force / q.normal_force, 1, 2e-3);
        EXPECT_NEAR(p.moment.y / -q.moment.y, 1, 5e-3);
    }
}

// It sticks, leaning up to μ F over the shear stiffness, and slides from there.
TEST(Foam, SticksAndThenSlides) {
    Preset p = smooth();
    p.friction_wet = p.friction_dry = 0.4;
    Tuft tuft = make_tuft(p);
    tuft.wetness = 1;
    const ContactPlane plane;
    const double d = 4e-3, area = pi * p.radius * p.radius, stiffness = 0.5 * p.modulus * area / p.length;
    Pose pose{{0, 0, p.length - d}, {1, 0, 0, 0}, 0};
    step(tuft, pose, {&plane, 1}, 0);
    double work = 0, lost = 0, before = 0;
    TuftState state;
    for (int i = 1; i <= 100; ++i) {
        pose.position.x = 1e-4 * i;
        state = step(tuft, pose, {&plane, 1}, 0.01);
        const double expected = -std::min(stiffness * 1e-4 * i, 0.4 * state.normal_force);
        EXPECT_NEAR(state.force.x, expected, 2e-3 * std::abs(expected));
        work -= 0.5e-4 * (before + state.force.x);
        before = state.force.x;
        lost += state.energy.lost;
    }
    EXPECT_NEAR(work, state.energy.aside + lost, 0.01 * work);  // one step at the kink
}

// The same bits again and from a copy; the pores belong to the material.
TEST(Foam, IsTheSameAgain) {
    const Preset p = load_preset("sponge-30");
    Tuft a = make_tuft(p, 1), b = make_tuft(p, 2);
    ASSERT_EQ(a.carried->pores.size(), b.carried->pores.size());
    EXPECT_GT(a.carried->pores.size(), 1000u);
    const TuftState first = pressed(a, 3e-3);
    Tuft copy = a;
    EXPECT_EQ(pressed(b, 3e-3).shape.position, first.shape.position);
    EXPECT_EQ(pressed(copy, 5e-3).shape.position, pressed(a, 5e-3).shape.position);
    Preset other = p;
    other.pore_seed = 2;
    EXPECT_NE(make_tuft(other).carried->rest, a.carried->rest);
}

// Pores cut 55 % of the skin: circles of a Boolean model, 1 − e^(−0.8), as its spheres fill the volume [Delesse1847].
TEST(Foam, PoresOpenTheSkinAsTheyOpenTheVolume) {
    const Preset p = smooth();
    const Tuft tuft = make_tuft(p);
    double circles = 0;
    for (const SkinPore& pore : tuft.carried->pores) {
        const auto& t = tuft.carried->triangles[pore.triangle];
        const bool face = std::all_of(t.begin(), t.end(),
                                      [&](std::uint32_t v) { return tuft.carried->rest[v].z < -0.99 * p.length; });
        if (face) circles += pi * pore.radius * pore.radius;
    }
    // About 2000 circles: their sum scatters by 2 %.
    EXPECT_NEAR(circles / (pi * p.radius * p.radius), 0.8, 0.06);
}

TEST(Foam, RefusesWhatItCannotBe) {
    Preset p = load_preset("sponge-30");
    p.spine = SpineMethod::chain;
    EXPECT_THROW(make_tuft(p), Error);
    p = load_preset("sponge-30");
    p.pore_min = 2e-3;
    EXPECT_THROW(make_tuft(p), Error);
    p = load_preset("sponge-30");
    p.radius = 0.1;
    EXPECT_THROW(make_tuft(p), Error);
}

}  // namespace
}  // namespace tuft::brush
