#include "app/paint/paint_thread.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>

#include "io/project/project.h"
#include "io/project/restore.h"
#include "models.h"
#include "stroke/journal/tables.h"

/// Whatever is asked for, stopped or called off in whatever order: the file's texels are those of a replay of its
/// journal, and its journal is the painter's.
namespace tuft::app {
namespace {

class PaintThreadTest : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) / ("tuft_painter_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        PaintWork work;
        work.model = std::make_unique<stroke::Model>(test::shipped_model("sheet.ply", 256));
        work.document = std::make_unique<stroke::Document>(*work.model);
        work.texture = std::make_unique<Texture>(*work.document, ProgressFn{});
        ASSERT_TRUE(work.autosave.start(folder_ / "work.tuft", "sheet.ply", {}, *work.document).empty());
        painter_ = std::make_unique<PaintThread>(std::move(work));
        preset_ = brush::load_preset("wolf-small");
    }
    void TearDown() override {
        painter_.reset();
        std::filesystem::remove_all(folder_);
    }

    void begin(const std::string& tip_ink = "", double y = 0, const std::string& ink = "carbon") {
        painter_->post(BeginStroke{.brush = "wolf-small", .ink = ink, .persistent = false, .tip_ink = tip_ink});
        painter_->post(ExtendStroke{test::poses_above(painter_->model(), preset_, 0.02, y)});
    }
    void stroke(double y, const std::string& ink = "carbon") {
        begin("", y, ink);
        painter_->post(EndStroke{});
    }
    void look() {
        Update u = painter_->take();
        if (u.events.strokes) lines_ = std::move(*u.events.strokes);
        for (const Message& message : u.events.messages) messages_.push_back(message.text());
        trouble_ = u.status.file.trouble.text();
        busy_ = u.status.progress.busy;
    }
    void rest() {
        painter_->wait_idle(100);
        look();
    }
    // Presses Stop until all that was asked for is over; a busy machine may let one of several through.
    void stop_all() {
        while (!painter_->idle()) painter_->stop_long_work();
        look();
    }
    std::uint64_t id(std::size_t k) const { return lines_.at(k).id; }

    void expect_file_like_journal(const char* when) {
        SCOPED_TRACE(when);
        rest();
        EXPECT_EQ(trouble_, "");
        // As a kill would leave it; then as the end does.
        compare(folder_ / "work.tuft");
    }
    void compare(const std::filesystem::path& file) {
        const io::Project project = io::Project::open(file);
        const std::vector<stroke::JournalEntry> kept = project.strokes();
        ASSERT_EQ(kept.size(), lines_.size());
        for (std::size_t i = 0; i < kept.size(); ++i) {
            EXPECT_EQ(kept[i].id, lines_[i].id) << i;
            EXPECT_EQ(kept[i].hidden, lines_[i].hidden) << i;
            EXPECT_EQ(stroke::ink_of(kept[i]), lines_[i].ink) << i;
        }
        stroke::Document opened(painter_ ? painter_->model() : *model_), replayed(opened.model());
        io::use_presets(project, opened);
        io::use_presets(project, replayed);
        io::restore_strokes(project, opened, {});
        replayed.replay(kept);
        EXPECT_EQ(opened.layers().hash(), replayed.layers().hash());
    }
    // The painter's own texels are stored when it ends.
    void end() {
        rest();
        model_ = std::make_unique<stroke::Model>(test::shipped_model("sheet.ply", 256));
        painter_.reset();
        EXPECT_TRUE(io::Project::open(folder_ / "work.tuft").load_canvases(model_->texels.n_slots()) || lines_.empty());
        compare(folder_ / "work.tuft");
    }

    std::filesystem::path folder_;
    std::unique_ptr<stroke::Model> model_;
    std::unique_ptr<PaintThread> painter_;
    brush::Preset preset_;
    std::vector<StrokeLine> lines_;
    std::vector<std::string> messages_;
    std::string trouble_, busy_;
};

TEST_F(PaintThreadTest, AStoppedChangeLeavesTexelsAndJournalTogether) {
    const char* inks[] = {"carbon", "cinnabar", "indigo", "gamboge"};
    for (int i = 0; i < 4; ++i) stroke(0.001 * i, inks[i]);
    rest();
    ASSERT_EQ(lines_.size(), 4u);
    const auto before = lines_;
    painter_->post(EditStrokes{.ids = {id(1)}, .hidden = true});
    painter_->post(EditStrokes{.ids = {id(0)}, .remove = true});
    painter_->post(EditStrokes{.ids = {id(2)}, .ink = "iron-red"});
    stop_all();
    EXPECT_NE(std::ranges::find(messages_, "Stopped; everything is as it was."), messages_.end());
    EXPECT_EQ(busy_, "");
    expect_file_like_journal("stopped");

    // A change that is stopped between two that are not, and their undo stopped and asked for again.
    painter_->post(EditStrokes{.ids = {before[1].id}, .hidden = true});
    rest();
    painter_->post(EditStrokes{.ids = {before[0].id}, .remove = true});
    stop_all();
    painter_->post(EditStrokes{.ids = {before[2].id}, .ink = "iron-red"});
    stroke(0.004);
    expect_file_like_journal("changed");
    painter_->post(UndoStroke{});
    painter_->post(UndoStroke{});
    stop_all();
    expect_file_like_journal("undo stopped");
    for (int i = 0; i < 2; ++i) painter_->post(UndoStroke{});
    expect_file_like_journal("undone");
    for (int i = 0; i < 2; ++i) painter_->post(RedoStroke{});
    stop_all();
    expect_file_like_journal("redo stopped");
    for (int i = 0; i < 4; ++i) painter_->post(RedoStroke{});
    expect_file_like_journal("redone");
    end();
}

TEST_F(PaintThreadTest, AStrokeThatIsCalledOffLeavesWhatCanBeRedone) {
    for (int i = 0; i < 3; ++i) stroke(0.001 * i);
    rest();
    painter_->post(EditStrokes{.ids = {id(2)}, .remove = true});
    rest();
    ASSERT_EQ(lines_.size(), 2u);
    painter_->post(UndoStroke{});  // the removal
    painter_->post(UndoStroke{});  // the third stroke
    begin("cinnabar", 0.004);
    painter_->post(CancelStroke{});
    expect_file_like_journal("called off");
    EXPECT_EQ(lines_.size(), 2u);
    painter_->post(RedoStroke{});
    expect_file_like_journal("the stroke again");
    EXPECT_EQ(lines_.size(), 3u);
    EXPECT_EQ(lines_.back().action, stroke::EntryKind::stroke);
    painter_->post(RedoStroke{});
    expect_file_like_journal("removed again");
    EXPECT_EQ(lines_.size(), 2u);
    end();
}

TEST_F(PaintThreadTest, AChangeOrAnUndoWhileTheHandIsDownCallsItsStrokeOff) {
    for (int i = 0; i < 2; ++i) stroke(0.001 * i);
    rest();
    const std::uint64_t first = id(0);
    begin("cinnabar", 0.003);
    painter_->post(EditStrokes{.ids = {first}, .hidden = true});
    painter_->post(EndStroke{});
    expect_file_like_journal("changed");
    EXPECT_EQ(lines_.size(), 2u) << "no loading is left";
    begin("cinnabar", 0.003);
    painter_->post(UndoStroke{});
    painter_->post(EndStroke{});
    expect_file_like_journal("undone");
    EXPECT_EQ(lines_.size(), 2u);
    EXPECT_FALSE(lines_[0].hidden);
    end();
}

TEST_F(PaintThreadTest, AFileLeftAfterAChangeIsNotOpenedWithFormerTexels) {
    for (int i = 0; i < 3; ++i) stroke(0.001 * i);
    painter_->post(SaveProject{folder_ / "work.tuft"});  // with its texels
    rest();
    painter_->post(EditStrokes{.ids = {id(0)}, .hidden = true});
    expect_file_like_journal("hidden");
    painter_->post(SaveProject{folder_ / "work.tuft"});
    // The last one goes, and another comes in its place.
    painter_->post(EditStrokes{.ids = {id(2)}, .remove = true});
    rest();
    stroke(0.006, "cinnabar");
    expect_file_like_journal("another in its place");
    end();
}

// Before the first new layer is shown: both are there, and what is painted on the newest is on the second.
TEST_F(PaintThreadTest, ALayerThatIsAskedForTwiceComesTwiceUnderTwoNames) {
    const ChangeLayers add{stroke::add_on_top(stroke::LayerTable{}, "Layer 2")};
    painter_->post(add);
    painter_->post(add);
    painter_->post(BeginStroke{.brush = "wolf-small", .ink = "carbon", .layer = kNewestLayer});
    painter_->post(ExtendStroke{test::poses_above(painter_->model(), preset_, 0.02, 0)});
    painter_->post(EndStroke{});
    rest();
    EXPECT_TRUE(messages_.empty()) << messages_.front();
    const auto entries = io::Project::open(folder_ / "work.tuft").strokes();
    ASSERT_EQ(entries.size(), 3u);
    const stroke::LayerTable table = stroke::layers_after(entries);
    ASSERT_EQ(table.layers.size(), 3u);
    EXPECT_EQ(table.layers[1].name, "Layer 2");
    EXPECT_EQ(table.layers[2].name, "Layer 3");
    EXPECT_EQ(stroke::layer_of(entries[2]), table.layers[2].id);
    end();
}

// Poses in steps of a thousandth of a second, one a command.
void post_poses(CommandQueue& queue, int n) {
    for (int i = 0; i < n; ++i) {
        const double time = 1e-3 * i;
        queue.post(ExtendStroke{{brush::Pose{.time = time}}, time});
    }
}

TEST(CommandQueue, JoinsPosesThatWaitUpToATimeAndNoOtherCommand) {
    CommandQueue queue;
    post_poses(queue, 50);
    queue.post(EndStroke{});
    post_poses(queue, 2);
    Command command;
    ASSERT_EQ(queue.wait(command, std::chrono::milliseconds(0)), CommandQueue::Next::command);
    ExtendStroke& extend = std::get<ExtendStroke>(command);
    EXPECT_TRUE(queue.join(extend, 0.0305));  // half a step more than 31 poses last
    ASSERT_EQ(extend.poses.size(), 31u);
    for (int i = 0; i < 31; ++i) EXPECT_EQ(extend.poses[static_cast<std::size_t>(i)].time, 1e-3 * i);
    EXPECT_EQ(extend.requested_at, 1e-3 * 30);
    ASSERT_EQ(queue.wait(command, std::chrono::milliseconds(0)), CommandQueue::Next::command);
    EXPECT_FALSE(queue.join(std::get<ExtendStroke>(command), 1));
    EXPECT_EQ(std::get<ExtendStroke>(command).poses.size(), 19u);
    ASSERT_EQ(queue.wait(command, std::chrono::milliseconds(0)), CommandQueue::Next::command);
    EXPECT_TRUE(std::holds_alternative<EndStroke>(command));
    EXPECT_EQ(queue.waiting(), 3u);  // it, and the next stroke's poses
}

TEST_F(PaintThreadTest, PosesThatComeFasterThanTheirInkArePaintedAsTheHandMadeThem) {
    painter_->post(BeginStroke{.brush = "wolf-small", .ink = "carbon", .persistent = false});
    const std::vector<brush::Pose> poses = test::poses_above(painter_->model(), preset_, 0.02);
    for (const brush::Pose& pose : poses) painter_->post(ExtendStroke{{pose}, 1 + pose.time});
    painter_->post(EndStroke{});
    painter_->wait_idle(100);
    Update update = painter_->take();
    EXPECT_EQ(update.status.progress.done, 1 + poses.back().time);
    ASSERT_TRUE(update.events.strokes);
    lines_ = std::move(*update.events.strokes);
    expect_file_like_journal("as they came");
    const std::vector<stroke::JournalEntry> kept = io::Project::open(folder_ / "work.tuft").strokes();
    const std::vector<stroke::StrokeSample>& samples = kept.at(0).get<stroke::PaintStroke>().trace.samples;
    ASSERT_EQ(samples.size(), poses.size());
    for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i].time, poses[i].time);
}

TEST(StrokeLine, OnlyTheFillOfAnOutlineIsAnArea) {
    const stroke::FlatArea outline{.rings = {{{0, 0}, {1e-2, 0}, {0, 1e-2}}}, .stops = {{.ink = "carbon"}}};
    EXPECT_TRUE(stroke_line(stroke::fill_of_area(outline)).is_area);
    EXPECT_FALSE(stroke_line(stroke::Fill{.ink = "carbon"}).is_area) << "the whole model";
    EXPECT_FALSE(stroke_line(stroke::PaintStroke{}).is_area);
}

TEST(PartChanges, SayWhatAnEditChangesEachKindOnce) {
    using What = PartChange::What;
    const ink::Substrate glass = ink::load_substrate("glass"), clay = ink::load_substrate("clay");
    stroke::PartTable table;
    const auto changes = [&](const stroke::PartEdit& edit) {
        std::vector<PartChange> all = part_changes(table, edit);
        stroke::apply(table, edit);
        return all;
    };
    using Changes = std::vector<PartChange>;
    EXPECT_EQ(changes(stroke::hidden_parts(table, {"door", "pane"}, true)),
              (Changes{{What::hidden, "", {"door", "pane"}}}));
    EXPECT_EQ(changes(stroke::parts_of_substrate(table, {"pane"}, glass)),
              (Changes{{What::made_of, "glass", {"pane"}}}))
        << "that it is hidden is no change";
    EXPECT_EQ(changes(stroke::parts_of_substrate(table, {"pane"}, glass)), Changes{});
    EXPECT_EQ(changes(stroke::isolated_parts(table, {"body", "door", "pane"}, {"door"})),
              (Changes{{What::hidden, "", {"body"}}, {What::shown, "", {"door"}}}));
    EXPECT_EQ(changes(stroke::locked_parts(table, {"body"}, true)), (Changes{{What::locked, "", {"body"}}}));
    stroke::PartEdit both;
    both.parts = {{.name = "body", .hidden = false, .locked = false, .substrate = clay}, {.name = "pane"}};
    EXPECT_EQ(changes(both), (Changes{{What::shown, "", {"body", "pane"}},
                                      {What::unlocked, "", {"body"}},
                                      {What::made_of, "clay", {"body"}},
                                      {What::as_model, "", {"pane"}}}));
}

}  // namespace
}  // namespace tuft::app
