#include "app/document/copying.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "copied_picture.h"
#include "core/files/files.h"
#include "writer/glyphs/glyph_source.h"

namespace tuft::app {
namespace {

/// A picture of 十: four pieces at one junction, two strokes.
class Copying : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) / ("tuft_copying_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        request_.like = folder_ / "cross.png";
        write_cross(request_.like.string());
        read();
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    /// What the studio's reader does.
    void read() {
        text_ = reader_.read(request_);
        copy_.shown = reader_.copied();
        copy_.shown_for = request_.correction;
    }
    CopyToEdit edited() { return {copy_, request_}; }
    void click(CopyEdit edit, const Vec2& at) {
        copy_.edit = edit;
        edit_stroke(edited(), at);
    }
    const std::string& order() const { return request_.correction.order; }
    const std::vector<writer::GlyphStroke>& strokes() const { return text_.lines.front().front().strokes; }

    static constexpr double kMiddle = 512;
    const Vec2 horizontal_{300, kMiddle}, vertical_{kMiddle, 300};  // places on the strokes, units
    std::filesystem::path folder_;
    writer::TextReader reader_;
    writer::TextRequest request_;
    writer::Text text_;
    CopyInWork copy_;
};

TEST_F(Copying, EditsAreShownAsTheirCorrectionIsRead) {
    ASSERT_EQ(copy_.shown->order.size(), 2u);
    click(CopyEdit::reverse, horizontal_);
    move_stroke(edited(), 0, 1, true);
    click(CopyEdit::split, vertical_);
    const writer::StrokeOrder shown = copy_.shown->order;
    ASSERT_EQ(shown.size(), 3u);
    read();
    EXPECT_EQ(copy_.shown->order, shown);
    EXPECT_GT(strokes()[2].median.front().x, strokes()[2].median.back().x) << "from right to left now";
    // Split within a piece: one part ends where the other begins.
    // Points nearer than 1 unit to the one before are left out of a centre line.
    EXPECT_LT(glm::distance(strokes()[0].median.back(), strokes()[1].median.front()), 1);
    EXPECT_NEAR(strokes()[0].median.back().y, vertical_.y, 2) << "0.001 of a piece of 400 units";
}

TEST_F(Copying, TwiceReversedAndSplitThenJoinedIsAsBefore) {
    click(CopyEdit::reverse, horizontal_);
    const std::string once = order();
    click(CopyEdit::reverse, horizontal_);
    const std::string twice = order();
    EXPECT_NE(once, twice);
    EXPECT_EQ(twice, writer::order_text(reader_.copied()->order));
    const std::vector<writer::GlyphStroke> before = strokes();
    click(CopyEdit::split, vertical_);
    read();
    ASSERT_EQ(strokes().size(), 3u);
    click(CopyEdit::join, {kMiddle, 700});
    EXPECT_TRUE(copy_.joined);
    click(CopyEdit::join, {kMiddle, 150});
    read();
    ASSERT_EQ(strokes().size(), 2u);
    for (std::size_t s = 0; s < 2; ++s) {
        // The cut adds a point to the line, on it.
        EXPECT_LT(glm::distance(strokes()[s].median.front(), before[s].median.front()), 1e-9);
        EXPECT_LT(glm::distance(strokes()[s].median.back(), before[s].median.back()), 1e-9);
        EXPECT_EQ(strokes()[s].outline.size(), before[s].outline.size());
    }
}

TEST_F(Copying, StepsAreTakenBackOneByOneAndTheLastStrokeStays) {
    click(CopyEdit::remove, vertical_);
    EXPECT_EQ(copy_.shown->order.size(), 1u);
    const std::string one = order();
    click(CopyEdit::remove, horizontal_);
    EXPECT_EQ(order(), one);
    EXPECT_EQ(copy_.earlier.size(), 1u) << "what did nothing is no step";
    for (const double threshold : {0.1, 0.2, 0.3}) correct(edited(), {.threshold = threshold, .cuts = {}, .order = {}});
    EXPECT_FALSE(edited().ready());
    click(CopyEdit::reverse, horizontal_);
    EXPECT_TRUE(order().empty()) << "strokes of another threshold are not edited";
    while (step_back(edited()))
        ;
    EXPECT_EQ(request_.correction, writer::CopyCorrection{});
}

TEST_F(Copying, AClickFarFromAllStrokesDoesNothing) {
    for (const CopyEdit edit : {CopyEdit::reverse, CopyEdit::join, CopyEdit::split, CopyEdit::remove})
        click(edit, {150, 150});
    EXPECT_EQ(request_.correction, writer::CopyCorrection{});
    EXPECT_TRUE(copy_.earlier.empty());
}

TEST_F(Copying, IsKeptInAProjectWithItsPicture) {
    request_.text = "\xe5\x8d\x81";
    click(CopyEdit::reverse, horizontal_);
    click(CopyEdit::split, vertical_);
    const std::optional<KeptCopy> kept = copy_to_keep(request_);
    ASSERT_TRUE(kept);
    const KeptCopy back = kept_copy(to_attachment(*kept));
    EXPECT_EQ(back.correction.cuts.size(), 1u);
    EXPECT_EQ(writer::cuts_text(back.correction.cuts), writer::cuts_text(request_.correction.cuts));
    EXPECT_EQ(back.correction.order, request_.correction.order);
    EXPECT_EQ(back.name, request_.text);
    EXPECT_EQ(back.bytes, read_file(request_.like));
    EXPECT_EQ(picture_of(back), std::filesystem::absolute(request_.like));
    // Of a damaged line the picture is left.
    EXPECT_EQ(kept_copy({kept->id, "{\"cuts\": \"9:9\"}", kept->bytes}).correction, writer::CopyCorrection{});
    EXPECT_EQ(kept_copy({kept->id, "no JSON", kept->bytes}).bytes, kept->bytes);
}

// JSON as hanzi-writer-data has it; coordinates have two digits.
TEST_F(Copying, SavedAsJsonItIsTheSameCharacter) {
    click(CopyEdit::reverse, horizontal_);
    read();
    const writer::Glyph& glyph = text_.lines.front().front();
    const writer::Glyph back = writer::parse_hanzi_json(writer::hanzi_json_of(glyph), U'x', "saved");
    ASSERT_EQ(back.strokes.size(), glyph.strokes.size());
    EXPECT_EQ(back.code, glyph.code);
    for (std::size_t s = 0; s < glyph.strokes.size(); ++s) {
        ASSERT_EQ(back.strokes[s].median.size(), glyph.strokes[s].median.size());
        for (std::size_t i = 0; i < glyph.strokes[s].median.size(); ++i)
            EXPECT_LT(glm::distance(back.strokes[s].median[i], glyph.strokes[s].median[i]), 0.0075);
        ASSERT_EQ(back.strokes[s].outline.size(), glyph.strokes[s].outline.size());
        // A closed path ends where it began.
        EXPECT_EQ(back.strokes[s].outline[0].size(), glyph.strokes[s].outline[0].size() + 1);
    }
}

}  // namespace
}  // namespace tuft::app
