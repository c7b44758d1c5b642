#include "core/system/allocations.h"

#include <gtest/gtest.h>

#include <utility>

#include "contact/contact.h"
#include "shapes.h"

namespace tuft::contact {
namespace {

// Presses the tuft onto the surface round `at`, draws it to and fro over it, and lifts it. Returns the allocations.
std::uint64_t allocations_of_a_stroke(brush::Tuft& tuft, const mesh::SurfaceQuery& surface, const Vec3& at) {
    constexpr int kPoses = 80;
    Memory memory;
    Result result;
    const std::uint64_t before = allocations_of_this_thread();
    for (int i = 0; i < kPoses; ++i) {
        const double part = static_cast<double>(i) / kPoses, turn = 2 * std::numbers::pi * part;
        const double depth = 0.25 * tuft.preset.length * std::min(1.0, 2 * std::sin(std::numbers::pi * part));
        brush::Pose pose;
        pose.rotation = glm::angleAxis(0.3 * std::sin(2 * turn), Vec3{0, 1, 0});
        pose.position = at + Vec3{0.6 * tuft.preset.length * std::sin(turn), 1e-3 * std::sin(3 * turn), -depth} -
                        tuft.preset.length * pose.axis();
        pose.time = 1e-3 * i;
        result = step(tuft, pose, surface, memory, 1e-3);
    }
    EXPECT_TRUE(memory.centres.size() > 4);
    return allocations_of_this_thread() - before;
}

// The second stroke finds the memory of the first.
TEST(Allocations, AWarmStepMakesNone) {
    const mesh::TriangleMesh flat = shapes::sheet(0.3, 60), edge = shapes::roof(0.5), round = shapes::bowl(0.05);
    const mesh::TriangleMesh* const places[] = {&flat, &edge, &round};
    // A round and a flat brush on all; those of other makes on one in turn.
    struct Case {
        const char* name;
        int place;
        brush::SpineMethod method = brush::SpineMethod::rod;
    };
    const Case cases[] = {{"wolf-medium", -1}, {"wolf-medium", 2, brush::SpineMethod::table},
                          {"liner-3", 0},      {"flat-12", -1},
                          {"sword-8", 1},      {"sponge-30", 2},
                          {"fan-30", 1}};
    for (const auto& [name, place, method] : cases) {
        for (const mesh::TriangleMesh* m : places) {
            if (place >= 0 && m != places[place]) continue;
            const mesh::SurfaceQuery surface(*m);
            const auto foot = surface.closest_point({0, 0, 0.01});
            ASSERT_TRUE(foot);
            brush::Preset preset = brush::load_preset(name);
            preset.spine = method;
            const brush::Tuft rested = brush::make_tuft(preset);
            brush::Tuft tuft = rested;
            allocations_of_a_stroke(tuft, surface, foot->position);
            tuft = rested;
            EXPECT_EQ(allocations_of_a_stroke(tuft, surface, foot->position), 0u) << name;
        }
    }
}

}  // namespace
}  // namespace tuft::contact
