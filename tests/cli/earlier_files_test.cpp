#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/image/image.h"
#include "program.h"

/// \file
/// Files and options of earlier versions stay readable (tests/data/before).
namespace tuft {
namespace {

using nlohmann::json;

class EarlierFiles : public test::Program {
  protected:
    std::string before(const std::string& name) const { return source_folder() + "/tests/data/before/" + name; }
    /// A copy that may be written.
    std::string copy_of(const std::string& name) const { return write(name, read(before(name))); }

    json run_json(const std::string& arguments) const {
        const test::Ran ran = tuft(arguments + " --json");
        EXPECT_EQ(ran.status, 0) << arguments << "\n" << ran.err;
        return ran.status == 0 ? json::parse(ran.out) : json();
    }
    std::string colours_of(const std::string& project, const std::string& picture) const {
        const test::Ran ran = tuft("export " + project + " -o " + path(picture) + " --map base-colour --quiet");
        EXPECT_EQ(ran.status, 0) << ran.err;
        return path(picture);
    }
};

TEST_F(EarlierFiles, ProjectKeepsItsJournalAndItsTexels) {
    const std::string project = copy_of("painting.tuft");
    const json j = run_json("inspect " + project);
    std::vector<std::string> actions;
    for (const json& entry : j.at("strokes")) actions.push_back(entry.at("action"));
    EXPECT_THAT(actions, testing::ElementsAre("rinse", "dip", "stroke", "mask", "layer", "fill", "layer", "layer",
                                              "stroke", "dry"));
    EXPECT_EQ(j.at("strokes").at(1).at("ink"), "iron-red");
    EXPECT_EQ(j.at("strokes").at(5).at("mask"), 1);
    EXPECT_EQ(j.at("strokes").at(8).at("tool"), "eraser");
    EXPECT_EQ(j.at("layers").at(1).at("blend"), "glaze");
    EXPECT_EQ(j.at("layers").at(1).at("opacity"), 0.7);
    EXPECT_EQ(j.at("masks").at(0).at("kind"), "lasso");

    // The JSON key that scripts of earlier versions read.
    const json revised = run_json("replay " + project + " --model " + before("tile.obj"));
    EXPECT_TRUE(revised.at("misfits").is_array());
    EXPECT_EQ(revised.at("misfits"), revised.at("mismatches"));

    const io::Image8 stored = io::read_image8(colours_of(project, "stored.png"));
    const test::Ran ran = tuft("replay " + project + " --project " + path("again.tuft") + " --quiet");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const io::Image8 again = io::read_image8(colours_of(path("again.tuft"), "again.png"));
    ASSERT_EQ(stored.pixels.size(), again.pixels.size());
    double difference = 0, contrast = 0;
    for (std::size_t i = 0; i < stored.pixels.size(); ++i) {
        difference += std::pow(static_cast<double>(stored.pixels[i]) - again.pixels[i], 2);
        contrast += std::pow(static_cast<double>(stored.pixels[i]) - stored.pixels[i % 4], 2);
    }
    ASSERT_GT(contrast, 0) << "something is painted";
    // A replay gives the same bits as long as no defect of the physics is mended. What such a change
    // moves at the edge of a stroke stays below a tenth (squared: 0.01) of the picture's contrast; a stroke that is
    // lost or a mask that is not heeded is not below.
    EXPECT_LT(difference, 0.01 * contrast);
}

TEST_F(EarlierFiles, InkmlAndBrushWithEarlierWordsPaintTheSameTexels) {
    std::string words = read(before("word.inkml")), keys = read(before("brush.toml"));
    const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
    };
    replace(words, "tuft:tape", "tuft:stencil");
    replace(words, "tuft:laying", "tuft:mapping");
    replace(keys, "end_give_mm", "end_compliance_mm");
    const auto paint = [&](const std::string& strokes, const std::string& brush, const std::string& name) {
        const test::Ran ran = tuft("paint " + before("tile.obj") + " --strokes " + strokes + " --brush " + brush +
                                   " --texel-size 0.4 --project " + path(name) + ".tuft --quiet");
        EXPECT_EQ(ran.status, 0) << ran.err;
        return read(colours_of(path(name) + ".tuft", name + ".png"));
    };
    const std::string earlier = paint(before("word.inkml"), before("brush.toml"), "earlier");
    EXPECT_EQ(earlier, paint(write("new.inkml", words), write("new.toml", keys), "now"));
    std::string open = words;  // the stencil of these files hides half of the stroke
    replace(open, "-0.02 0.001 0.02 0.001", "-0.02 0.02 0.02 0.02");
    EXPECT_NE(earlier, paint(write("open.inkml", open), before("brush.toml"), "open"));
}

TEST_F(EarlierFiles, OptionsOfEarlierVersionsAreTaken) {
    const std::string word = before("word.inkml");
    ASSERT_EQ(tuft("habit " + word + " " + word + " -o " + path("earlier.toml")).status, 0);
    ASSERT_EQ(tuft("bias " + word + " " + word + " -o " + path("now.toml")).status, 0);
    EXPECT_EQ(read(path("earlier.toml")), read(path("now.toml")));
    const std::string paint =
        "paint " + before("tile.obj") + " --strokes " + word + " --texel-size 0.4 --quiet --project ";
    ASSERT_EQ(tuft(paint + path("a.tuft") + " --laying wrap --habit " + path("now.toml")).status, 0);
    ASSERT_EQ(tuft(paint + path("b.tuft") + " --mapping wrap --bias " + path("now.toml")).status, 0);
    EXPECT_EQ(read(colours_of(path("a.tuft"), "a.png")), read(colours_of(path("b.tuft"), "b.png")));
    // A fresh brush for each of three strokes side by side would leave other texels.
    std::string three = read(word);
    const std::string end = "</trace>";
    three.insert(three.find(end) + end.size(),
                 "<trace>-12 6 0.2 0, 0 6 0.6 0.2, 12 6 0.2 0.4</trace><trace>-12 -6 0.2 0, 0 -6 0.6 0.2, 12 -6 0.2 "
                 "0.4</trace>");
    const std::string side_by_side = write("three.inkml", three);
    const auto dipped = [&](const std::string& word_of_dip) {
        const std::string project = path(word_of_dip + ".tuft");
        EXPECT_EQ(tuft("paint " + before("tile.obj") + " --strokes " + side_by_side +
                       " --texel-size 0.4 --quiet --project " + project + " --dip " + word_of_dip)
                      .status,
                  0)
            << word_of_dip;
        return read(colours_of(project, word_of_dip + ".png"));
    };
    EXPECT_EQ(dipped("carry"), dipped("persistent"));
    EXPECT_NE(dipped("each"), dipped("persistent"));
}

}  // namespace
}  // namespace tuft
