#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/paint/paint_thread.h"
#include "io/strokes/inkml.h"
#include "models.h"
#include "paths.h"
#include "projects.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/recorded_journal.h"

namespace tuft::app {

/// What a program makes of a drawing or a text: the hash of all texels, the project's journal, and the options of the
/// command line that make the same.
struct Painted {
    std::string hash, words;
    std::vector<stroke::JournalEntry> journal;
};

/// The same work by the studio's paint thread and by `tuft`, on a shipped model, or on one that is named by its path.
class BothPrograms : public ::testing::Test {
  protected:
    /// Returns the command and the options that say the same.
    using MakeCommand = std::function<std::pair<Command, std::string>(const mesh::SurfaceQuery&)>;

    /// `before`: commands that come first.
    Painted by_studio(const std::string& name, const MakeCommand& make, std::vector<Command> before = {}) {
        return in_studio(name, [&](std::unique_ptr<PaintThread>& painter) {
            auto [command, words] = make(painter->surface());
            for (Command& first : before) painter->post(std::move(first));
            painter->post(std::move(command));
            return words;
        });
    }

    /// `work_on` posts commands to the paint thread and returns the options that say the same.
    Painted in_studio(const std::string& name,
                      const std::function<std::string(std::unique_ptr<PaintThread>&)>& work_on) {
        const std::string project = folder_ + "/studio.tuft";
        std::filesystem::remove(project);
        PaintWork work;
        work.model = std::make_unique<stroke::Model>(test::shipped_model(name, kTexels));
        work.document = std::make_unique<stroke::Document>(*work.model);
        work.texture = std::make_unique<Texture>(*work.document, ProgressFn{});
        work.source = test::model_path(name);
        EXPECT_TRUE(work.autosave.start(project, work.source, {}, *work.document).empty());
        auto painter = std::make_unique<PaintThread>(std::move(work));
        const std::string words = work_on(painter);
        painter->wait_idle(600);
        painter.reset();
        return {test::stored_hash(project), words, io::Project::open(project).strokes()};
    }

    Painted by_program(const std::string& command, const std::string& name, const std::string& options) {
        const std::string project = folder_ + "/program.tuft";
        std::filesystem::remove(project);
        const nlohmann::json j = test::tuft(command + " " + test::model_path(name).string() + " --atlas-size " +
                                                std::to_string(kTexels) + " " + options + " --project " + project,
                                            folder_ + "/out.json");
        return {j["canvas_hash"], options, io::Project::open(project).strokes()};
    }

    /// The same texels, and the same journal to the bit.
    void expect_same(const Painted& a, const Painted& b) {
        EXPECT_EQ(a.hash, b.hash) << a.words;
        ASSERT_EQ(a.journal.size(), b.journal.size());
        for (std::size_t i = 0; i < a.journal.size(); ++i) {
            EXPECT_EQ(stroke::entry_json(a.journal[i]), stroke::entry_json(b.journal[i])) << i;
            const auto text = [i](const Painted& p) {
                return io::inkml_text(stroke::record(std::span(p.journal).subspan(i, 1)).strokes);
            };
            EXPECT_EQ(text(a), text(b)) << i;
        }
    }

    static constexpr std::uint32_t kTexels = 256;
    std::string folder_ = testing::TempDir() + "/tuft_both_" + std::to_string(getpid());
    void SetUp() override { std::filesystem::create_directories(folder_); }
    void TearDown() override { std::filesystem::remove_all(folder_); }
};

}  // namespace tuft::app
