#include <gtest/gtest.h>

#include "haptic/strokes.h"
#include "io/model/read_model.h"
#include "stroke/document/document.h"
#include "trial_model.h"

namespace tuft::haptic {
namespace {

stroke::Model sheet() {
    stroke::ModelOptions options;
    options.repair.metres_per_unit = 1e-3;
    options.unwrap.size = 512;
    return stroke::prepare_model(io::read_model(source_folder() + "/models/sheet.ply"), options);
}

stroke::PaintStroke device_stroke() {
    stroke::PaintStroke s;
    s.trace.flat = false;
    s.brush = "wolf-small";
    s.ink = "carbon";
    return s;
}

/// Solved poses of a trial of taps, which are several strokes.
std::vector<SolvedPose> solved_poses(const stroke::Model& model, HandMotion motion) {
    const brush::Tuft tuft = tuft_of("wolf-small");
    const TrialPlace place = place_above(*model.query, "sheet");
    TrialOptions options{.law = {.limits = device_preset("inverse3")}, .seconds = 2.5, .record = true};
    return run_trial(tuft, *model.query, hand_path(motion, place, tuft.preset), options).roots;
}

// The poses that were solved are the stroke's samples, to the bit, and a replay of the journal gives the same texels.
TEST(Painting, AStrokeFromTheQueueAndItsJournalGiveTheSameTexels) {
    const stroke::Model model = sheet();
    const std::vector<SolvedPose> solved = solved_poses(model, HandMotion::circles);
    stroke::Document painting(model, {});
    StrokeCutter cutter;
    std::size_t poses = 0;
    for (const SolvedPose& pose : solved) {
        const StrokeCutter::Cut cut = cutter.add(pose);
        if (cut.begins) painting.begin(device_stroke());
        if (!cut.poses.empty()) painting.extend(cut.poses);
        poses += cut.poses.size();
        if (cut.ends) painting.end();
    }
    if (cutter.in_stroke()) painting.end();
    ASSERT_GT(poses, 500u);
    ASSERT_GT(painting.layers().canvas().touched_slots().size(), 0u);

    const std::vector<stroke::JournalEntry>& entries = painting.journal().entries();
    ASSERT_EQ(entries.size(), 1u);
    const auto& samples = std::get<stroke::PaintStroke>(entries[0].content).trace.samples;
    ASSERT_EQ(samples.size(), poses);
    std::size_t at = 0;
    while (solved[at].pose.position != samples[0].position) ++at;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ASSERT_EQ(samples[i].position, solved[at + i].pose.position);
        ASSERT_EQ(samples[i].rotation, solved[at + i].pose.rotation);
    }
    stroke::Document again(model, {});
    again.replay(entries);
    EXPECT_EQ(again.layers().canvas().hash(), painting.layers().canvas().hash());
}

TEST(Painting, TapsAreStrokesOfTheirOwn) {
    const stroke::Model model = sheet();
    const std::vector<SolvedPose> solved = solved_poses(model, HandMotion::taps);
    StrokeCutter cutter;
    int begun = 0, ended = 0;
    for (const SolvedPose& pose : solved) {
        const StrokeCutter::Cut cut = cutter.add(pose);
        begun += cut.begins;
        ended += cut.ends;
        if (cut.begins) {
            ASSERT_GE(cut.poses.size(), 2u);  // it comes from the air
            EXPECT_EQ(cut.poses.front().time, 0);
        }
    }
    EXPECT_GE(begun, 3);
    EXPECT_EQ(begun, ended + cutter.in_stroke());
}

// The arm takes the brush up elsewhere: what was in work ends, and no line is drawn across.
TEST(Painting, ABrushTakenUpElsewhereBeginsAStrokeOfItsOwn) {
    StrokeCutter cutter;
    EXPECT_TRUE(cutter.add({{.tick = 1, .taken_up = 1}, true}).begins);
    EXPECT_FALSE(cutter.add({{.tick = 2, .taken_up = 1}, true}).begins);
    EXPECT_TRUE(cutter.add({{.tick = 90, .taken_up = 90}, true}).ends);
    EXPECT_TRUE(cutter.add({{.tick = 91, .taken_up = 90}, true}).begins);
}

}  // namespace
}  // namespace tuft::haptic
