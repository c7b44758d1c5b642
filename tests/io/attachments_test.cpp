#include "io/project/attachments.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "core/error.h"
#include "core/random.h"
#include "io/project/project.h"
#include "sample_model.h"

/// What a project carries besides its model and journal.
namespace tuft::io {
namespace {

std::vector<stroke::Stroke> journal() {
    std::vector<stroke::Stroke> entries;
    for (std::uint64_t k = 1; k <= 3; ++k) {
        stroke::Stroke s;
        s.id = 10 * k;
        s.trace.flat = k == 2;
        s.trace.brush = "wolf-medium*1.5";
        s.trace.ink = "cinnabar";
        s.trace.seed = ~std::uint64_t{0} - k;
        s.trace.label = "横 " + std::to_string(k);
        s.hidden = k == 3;
        s.group = {4, "leaves.svg"};
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
        entries.push_back(std::move(s));
    }
    stroke::Stroke dip;
    dip.id = 40;
    dip.action = stroke::Action::dip;
    dip.trace.flat = false;
    dip.trace.brush = "goat";
    dip.extent.depth = 0.4;
    entries.push_back(dip);
    return entries;
}

TEST(PackedEntries, ComeBackToTheBit) {
    const std::vector<stroke::Stroke> before = journal(), after = unpack_entries(pack_entries(before), "it");
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        const stroke::Stroke &a = before[i], &b = after[i];
        EXPECT_EQ(a.id, b.id);
        EXPECT_EQ(a.hidden, b.hidden);
        EXPECT_EQ(stroke::entry_json(a), stroke::entry_json(b));
        EXPECT_EQ(a.trace.seed, b.trace.seed);
        EXPECT_EQ(a.trace.label, b.trace.label);
        EXPECT_EQ(a.trace.flat, b.trace.flat);
        EXPECT_EQ(a.trace.placement.origin, b.trace.placement.origin);
        EXPECT_EQ(a.trace.placement.mapping, b.trace.placement.mapping);
        ASSERT_EQ(a.trace.samples.size(), b.trace.samples.size());
        for (std::size_t k = 0; k < a.trace.samples.size(); ++k) {
            EXPECT_EQ(a.trace.samples[k].position, b.trace.samples[k].position);
            EXPECT_EQ(a.trace.samples[k].rotation, b.trace.samples[k].rotation);
            EXPECT_EQ(a.trace.samples[k].tilt, b.trace.samples[k].tilt);
        }
    }
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
