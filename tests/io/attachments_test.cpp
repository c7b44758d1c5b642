#include "io/project/attachments.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/random.h"
#include "io/project/project.h"
#include "sample_model.h"
#include "stroke/journal/entry/entry_json.h"

/// What a project carries besides its model and journal.
namespace tuft::io {
namespace {

std::vector<stroke::JournalEntry> journal() {
    std::vector<stroke::JournalEntry> entries;
    for (std::uint64_t k = 1; k <= 3; ++k) {
        stroke::PaintStroke s;
        s.trace.flat = k == 2;
        s.brush = "wolf-medium*1.5";
        s.ink = "cinnabar";
        s.seed = ~std::uint64_t{0} - k;
        s.trace.placement = {.origin = {0.1, 1.0 / 3, -1e-9},
                             .right = {0, 1, 0},
                             .down = {0, 0, -1},
                             .mapping = stroke::SurfaceMapping::drape};
        for (int i = 0; i < 20 * static_cast<int>(k); ++i)
            s.trace.samples.push_back({.time = 0.001 * i,
                                       .position = {std::sin(i), 1e-7 * i, std::sqrt(2.0) * i},
                                       .pressure = 0.1,
                                       .tilt = {0.2, -0.3},
                                       .rotation = Quat(0.6, 0, 0.8, 0)});
        stroke::JournalEntry& entry = entries.emplace_back(std::move(s), "横 " + std::to_string(k));
        entry.id = 10 * k;
        entry.hidden = k == 3;
        entry.group = {4, "leaves.svg"};
    }
    entries.emplace_back(stroke::BrushAction{.what = stroke::Dip{.depth = 0.4}, .brush = "goat"}).id = 40;
    return entries;
}

void expect_comes_back(const std::vector<stroke::JournalEntry>& before) {
    const std::vector<stroke::JournalEntry> after = unpack_entries(pack_entries(before), "it");
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const stroke::JournalEntry &a = before[i], &b = after[i];
        EXPECT_EQ(a.id, b.id);
        EXPECT_EQ(a.hidden, b.hidden);
        EXPECT_EQ(stroke::entry_json(a), stroke::entry_json(b));
        EXPECT_EQ(stroke::seed_of(a), stroke::seed_of(b));
        EXPECT_EQ(stroke::brush_of(a), stroke::brush_of(b));
        const stroke::StrokeSamples &s = stroke::samples_of(a), &t = stroke::samples_of(b);
        EXPECT_EQ(a.label, b.label);
        EXPECT_EQ(s.flat, t.flat);
        EXPECT_EQ(s.placement.origin, t.placement.origin);
        EXPECT_EQ(s.placement.mapping, t.placement.mapping);
        ASSERT_EQ(s.samples.size(), t.samples.size());
        for (std::size_t k = 0; k < s.samples.size(); ++k) {
            EXPECT_EQ(s.samples[k].position, t.samples[k].position);
            EXPECT_EQ(s.samples[k].rotation, t.samples[k].rotation);
            EXPECT_EQ(s.samples[k].tilt, t.samples[k].tilt);
            EXPECT_EQ(s.samples[k].roll, t.samples[k].roll);
        }
    }
}

TEST(PackedEntries, ComeBackToTheBit) {
    std::vector<stroke::JournalEntry> entries = journal();
    expect_comes_back(entries);
    std::get<stroke::PaintStroke>(entries[1].content).trace.samples[7].roll = 1.0 / 3;
    expect_comes_back(entries);
    EXPECT_TRUE(unpack_entries(pack_entries({}), "it").empty());
}

// Bytes of a file that anybody may have made: an error that names it, or entries, and nothing else.
TEST(PackedEntries, DamagedBytesAreAnError) {
    const std::vector<char> sound = pack_entries(journal());
    for (const std::size_t n :
         {std::size_t{0}, std::size_t{7}, std::size_t{31}, std::size_t{40}, sound.size() / 2, sound.size() - 1})
        EXPECT_THROW(unpack_entries(std::span(sound).first(n), "it"), Error) << n;
    Random random(5);
    for (int i = 0; i < 400; ++i) {
        std::vector<char> bytes = sound;
        for (int k = 0; k < 3; ++k)
            bytes[std::min(bytes.size() - 1, static_cast<std::size_t>(random.uniform(
                                                 0, static_cast<double>(i < 200 ? 64 : bytes.size()))))] ^=
                static_cast<char>(1 << (i % 8));
        try {
            unpack_entries(bytes, "the snapshot");
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("the snapshot"), std::string::npos) << error.what();
        }
    }
}

class AttachedFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(::testing::TempDir()) / ("tuft_attachments_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        model_.source = "cylinder";
        model_.mesh = io::testing::cylinder();
        model_.atlas = io::testing::cylinder_atlas(model_.mesh);
        model_.substrate = ink::substrate_toml(ink::load_substrate("porcelain"));
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_;
    ProjectModel model_;
};

TEST_F(AttachedFiles, AreKeptReplacedAndTakenOut) {
    const std::filesystem::path file = folder_ / "a.tuft";
    std::vector<char> bytes(5000);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * i);
    const Attachment image{"0002", R"({"name":"飞燕.png"})", bytes}, other{"0001", "{}", {}},
        snapshot{"0002", "one", pack_entries(journal())};
    {
        Project project = Project::create(file, model_);
        project.put_attachment(kReferences, {"0002", "former", {'x'}});
        project.put_attachment(kReferences, image);
        project.put_attachment(kReferences, other);
        project.put_attachment(kSnapshots, snapshot);
        EXPECT_EQ(project.format(), kFirstFormat) << "programs that know nothing of them read the rest";
    }
    Project project = Project::open(file);
    EXPECT_EQ(project.attachments(kReferences), (std::vector<Attachment>{other, image}));
    EXPECT_EQ(project.attachments(kSnapshots), std::vector<Attachment>{snapshot});
    project.remove_attachment(kReferences, "0002");
    project.remove_attachment(kReferences, "there is none");
    EXPECT_EQ(project.attachments(kReferences), std::vector<Attachment>{other});
    EXPECT_EQ(project.model().mesh.n_triangles(), model_.mesh.n_triangles());
}

}  // namespace
}  // namespace tuft::io
