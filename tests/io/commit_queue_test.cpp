#include "io/project/commit_queue.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "sample_model.h"
#include "stroke/journal/entry/entry_json.h"

namespace tuft::io {
namespace {

using namespace testing;

stroke::JournalEntry stroke_with(std::uint64_t id) {
    stroke::PaintStroke s;
    s.brush = "goat-medium";
    s.ink = "carbon";
    s.seed = id;
    for (int i = 0; i < 20; ++i) s.trace.samples.push_back({.time = 0.01 * i, .position = {1e-3 * i, 0, 0}});
    stroke::JournalEntry entry(s);
    entry.id = id;
    return entry;
}

Project new_project(const std::filesystem::path& path) {
    ProjectModel model;
    model.mesh = cylinder();
    model.atlas = cylinder_atlas(model.mesh);
    model.substrate = ink::substrate_toml(ink::load_substrate("porcelain"));
    return Project::create(path, model);
}

TEST(CommitQueue, CommitsEveryStrokeInOrder) {
    const Folder folder("commit_queue");
    Project project = new_project(folder / "a.tuft");
    {
        CommitQueue queue(project);
        queue.finish();
        for (std::uint64_t id = 1; id <= 60; ++id) {
            queue.add(stroke_with(id));
            if (id % 20 != 0) continue;
            queue.finish();
            EXPECT_EQ(Project::open(folder / "a.tuft", {.access = Access::read}).n_strokes(), id)
                << "another program sees what is finished";
        }
        queue.add(stroke_with(61));
    }
    const std::vector<stroke::JournalEntry> strokes = project.strokes();
    ASSERT_EQ(strokes.size(), 61u) << "the queue commits what is left when it ends";
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        EXPECT_EQ(strokes[i].id, i + 1);
        EXPECT_EQ(strokes[i].get<stroke::PaintStroke>().seed, i + 1);
    }
}

TEST(CommitQueue, ThrowsTheErrorOfACommit) {
    const Folder folder("commit_queue_error");
    Project project = new_project(folder / "a.tuft");
    project.append(stroke_with(7));
    CommitQueue queue(project);
    queue.add(stroke_with(7));  // the id is taken
    EXPECT_THROW(queue.finish(), Error);
    EXPECT_THROW(queue.add(stroke_with(8)), Error);
    EXPECT_EQ(project.n_strokes(), 1u);
}

}  // namespace
}  // namespace tuft::io
