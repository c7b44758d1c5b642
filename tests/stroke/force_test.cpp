#include <gtest/gtest.h>

#include <cmath>

#include "sheet.h"

namespace tuft::stroke {
namespace {

constexpr double kTolerance = 1e-3;  // metres, of contact::Options
constexpr double kProximity = 0.1;   // newtons

// Comes down, drags and lifts, each in smooth motion, sampled at 1 kHz; the pose moves at most
// 40 mm/s down and 60 mm/s along.
PaintStroke press_drag_lift(const std::string& brush, double depth) {
    const double length = brush::load_preset(brush).length;
    const auto ease = [](double x) {
        x = std::clamp(x, 0.0, 1.0);
        return x * x * (3 - 2 * x);
    };
    PaintStroke s;
    s.trace.flat = false;
    s.brush = brush;
    s.ink = "carbon";
    for (int i = 0; i <= 1000; ++i) {
        const double t = i * 1e-3;
        const double press = ease(t / 0.3) * ease((1 - t) / 0.3);
        s.trace.samples.push_back(
            {.time = t,
             .position = {-0.012 + 0.024 * ease((t - 0.25) / 0.5), 0, length + 2e-3 - (depth + 2e-3) * press},
             .rotation = {1, 0, 0, 0}});
    }
    return s;
}

TEST(Forces, GrowAndFallWithoutJumpsAndStayWithinTheClamp) {
    const Model model = sheet();
    for (const char* name : {"wolf-small", "goat-medium", "wolf-medium"}) {
        Document painting(model, {.record_forces = true});
        const brush::Preset& preset = painting.materials().brush(name);
        const StrokeReport r = painting.paint(press_drag_lift(name, 0.3 * preset.length));
        ASSERT_GT(r.forces.size(), 500u);
        double greatest = 0, fastest = 0;
        for (std::size_t i = 0; i < r.forces.size(); ++i) {
            const ForceRecord& f = r.forces[i];
            ASSERT_TRUE(std::isfinite(glm::length(f.device_force)) && std::isfinite(glm::length(f.torque)));
            EXPECT_LE(glm::length(f.device_force), preset.force_limit * (1 + 1e-12));
            greatest = std::max(greatest, glm::length(f.device_force));
            if (i == 0) continue;
            const double dt = f.pose.time - r.forces[i - 1].pose.time;
            if (dt > 1e-5)
                fastest = std::max(fastest, glm::distance(f.device_force, r.forces[i - 1].device_force) / dt);
        }
        // A hand tells changes of a tenth of a newton apart; the hair's onset and slip (up to
        // 1.5 N at once under a gain of 15) come spread over the low-pass of 5 ms.
        EXPECT_LT(fastest * 1e-3, 0.3) << name << ", newtons in 1 ms";
        EXPECT_GT(greatest, 0.5) << name;
        // On, along and off again: nothing is left in the air.
        EXPECT_LT(glm::length(r.forces.back().device_force), 1e-3) << name;
    }
}

TEST(Forces, PullBackAndTurnAsTheyMust) {
    const Model model = sheet();
    Document painting(model, {.record_forces = true});
    const brush::Preset& preset = painting.materials().brush("wolf-medium");
    const StrokeReport r = painting.paint(press_drag_lift("wolf-medium", 0.25 * preset.length));
    bool dragged = false;
    for (const ForceRecord& f : r.forces) {
        if (!(f.force.z > 0.01)) continue;
        // Friction lies in the cone of the driest hair pushed tip first.
        EXPECT_LE(std::hypot(f.force.x, f.force.y), (preset.friction_dry + preset.pore_grip) * f.force.z * 1.05);
        // The torque is that of a force somewhere on the hair, which cannot be stretched.
        EXPECT_LE(glm::length(f.torque), 1.01 * preset.length * glm::length(f.force));
        if (f.pose.time > 0.45 && f.pose.time < 0.55) {
            dragged = true;
            EXPECT_LT(f.force.x, 0) << "the hand goes along +x, the surface holds the hair back";
        }
    }
    EXPECT_TRUE(dragged);
}

TEST(Forces, IncludeTheForceOfProximity) {
    const Model model = sheet();
    Document painting(model, {.record_forces = true});
    const double length = painting.materials().brush("wolf-small").length;
    const auto resting = [&](double height) {
        PaintStroke s = line("wolf-small", 4e-3);
        for (StrokeSample& p : s.trace.samples) p.position.z = length + height;
        return painting.paint(s).forces.back().device_force;
    };
    EXPECT_EQ(glm::length(resting(1.5 * kTolerance)), 0);
    // The wet tip is drawn to the surface a little already.
    EXPECT_NEAR(glm::length(resting(0.5 * kTolerance)), kProximity, 1e-3);
    EXPECT_GT(resting(0.5 * kTolerance).z, 0);
}

TEST(Forces, AreRecordedAtTheHandsSamplesWhateverTheTexels) {
    // A press, a drag and a lift at 1 kHz, and each sample twice as a device repeats itself.
    PaintStroke s = press_drag_lift("wolf-small", 4e-3);
    std::vector<StrokeSample> twice;
    for (const StrokeSample& p : s.trace.samples) twice.insert(twice.end(), 2, p);
    s.trace.samples = twice;
    std::vector<std::vector<ForceRecord>> logs;
    for (const std::uint32_t texels : {1024u, 512u, 256u}) {
        const Model model = sheet({}, texels);
        Document painting(model, {.record_forces = true});
        logs.push_back(painting.paint(s).forces);
        ASSERT_EQ(logs.back().size(), s.trace.samples.size());
        for (std::size_t i = 0; i < logs.back().size(); ++i) {
            EXPECT_EQ(logs.back()[i].pose.time, s.trace.samples[i].time);
            EXPECT_EQ(logs.back()[i].pose.position, s.trace.samples[i].position);
        }
    }
    double greatest = 0;
    for (const ForceRecord& f : logs[0]) greatest = std::max(greatest, glm::length(f.force));
    for (std::size_t k = 1; k < logs.size(); ++k) {
        double squares = 0;
        for (std::size_t i = 0; i < logs[k].size(); ++i) {
            squares += std::pow(glm::distance(logs[k][i].force, logs[0][i].force), 2);
        }
        // Steps of 0.06, 0.12 and 0.25 mm: friction is found at each.
        EXPECT_LT(std::sqrt(squares / double(logs[k].size())), 0.05 * greatest) << k;
    }
}

TEST(Forces, OfAFlatStrokeAreThoseOfItsOwnSamples) {
    const Model model = sheet();
    PaintStroke s;
    s.brush = "goat-small";
    s.ink = "carbon";
    s.trace.placement = {{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, SurfaceMapping::wrap};
    for (int i = 0; i <= 100; ++i)
        s.trace.samples.push_back(
            {.time = 0.005 * i, .position = {-0.01 + 2e-4 * i, 0, 0}, .pressure = i == 100 ? 0 : 0.3});
    Document painting(model, {.record_forces = true});
    const std::vector<ForceRecord> forces = painting.paint(s).forces;
    // It is set down before them and lifted off behind; neither has a sample of the hand.
    ASSERT_EQ(forces.size(), s.trace.samples.size());
    for (std::size_t i = 0; i < forces.size(); ++i) EXPECT_EQ(forces[i].pose.time, s.trace.samples[i].time);
    EXPECT_GT(glm::length(forces.front().force), 5e-3) << "pressed already, with 10 mN";
}

}  // namespace
}  // namespace tuft::stroke
