#include "app/document/copying.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "copied_picture.h"
#include "core/error.h"
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
    void drag(std::size_t stroke, const std::vector<std::size_t>& over) {
        copy_.dragged = StrokeDrag{stroke};
        for (const std::size_t place : over) drag_stroke(edited(), place);
        copy_.dragged.reset();
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
    drag(0, {1});
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
    for (const double threshold : {0.1, 0.2, 0.3}) slide_threshold(edited(), threshold);
    EXPECT_EQ(copy_.earlier.size(), 2u) << "a slide is one step";
    EXPECT_FALSE(edited().ready());
    click(CopyEdit::reverse, horizontal_);
    EXPECT_TRUE(order().empty()) << "strokes of another threshold are not edited";
    while (step_back(edited()))
        ;
    EXPECT_EQ(request_.correction, writer::CopyCorrection{});
}

TEST_F(Copying, ADragThereAndBackIsOneStep) {
    const std::string before = writer::order_text(copy_.shown->order);
    drag(0, {1, 0, 1, 0});
    EXPECT_EQ(order(), before);
    EXPECT_EQ(copy_.earlier.size(), 1u);
    drag(0, {0});
    EXPECT_EQ(copy_.earlier.size(), 1u) << "one that goes nowhere is none";
}

// A number in the hand means a stroke of what is shown: of other strokes it means nothing.
TEST_F(Copying, StrokesInTheHandAreLetGoWhereOthersAreShown) {
    for (const std::size_t stale : {std::size_t{2}, std::size_t{1} << 40}) {
        copy_.dragged = StrokeDrag{stale};
        drag_stroke(edited(), 0);
        EXPECT_FALSE(copy_.dragged);
    }
    EXPECT_TRUE(order().empty());
    const auto take_both = [&] {
        click(CopyEdit::join, horizontal_);
        copy_.dragged = StrokeDrag{1};
        ASSERT_TRUE(copy_.joined);
    };
    const auto expect_free = [&](const char* after) {
        EXPECT_FALSE(copy_.joined) << after;
        EXPECT_FALSE(copy_.dragged) << after;
        read();
    };
    take_both();
    slide_threshold(edited(), 0.1);
    expect_free("a slide of the threshold");
    take_both();
    correct(edited(), {});
    expect_free("a correction");
    take_both();
    step_back(edited());
    expect_free("a step back");
    take_both();
    writer::CopiedPicture other = *copy_.shown;
    writer::remove_stroke(other.order, 1);
    copy_.take(other, request_.correction);
    expect_free("another picture");
    take_both();
    copy_.take(*copy_.shown, request_.correction);
    EXPECT_TRUE(copy_.joined && copy_.dragged) << "the same strokes read again";
    drag_stroke(edited(), 0);
    EXPECT_FALSE(copy_.joined) << "the order is another one";
}

TEST_F(Copying, ByRulesIsAStepOfItsOwnAfterASlide) {
    slide_threshold(edited(), 0.1);
    slide_threshold(edited(), 0.2);
    correct(edited(), {});
    ASSERT_EQ(copy_.earlier.size(), 2u);
    EXPECT_TRUE(step_back(edited()));
    EXPECT_EQ(request_.correction.threshold, 0.2);
    slide_threshold(edited(), 0.3);
    EXPECT_EQ(copy_.earlier.size(), 2u) << "the slide before is over";
    correct(edited(), request_.correction);
    EXPECT_EQ(copy_.earlier.size(), 2u) << "the same again is no step";
}

TEST_F(Copying, ASplitAtTheEndOfAStrokeIsNoStep) {
    const auto& first = copy_.shown->order.front();
    const writer::Piece& piece = copy_.shown->skeleton.pieces[first.front().piece];
    click(CopyEdit::split, first.front().reversed ? piece.line.back() : piece.line.front());
    EXPECT_EQ(request_.correction, writer::CopyCorrection{});
    EXPECT_TRUE(copy_.earlier.empty());
    EXPECT_TRUE(edited().ready());
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
    const KeptCopy kept = read_copy(request_);
    const KeptCopy back = kept_copy(to_attachment(kept));
    EXPECT_TRUE(back.has_same_content(kept));
    EXPECT_EQ(back.correction.cuts.size(), 1u);
    EXPECT_EQ(writer::cuts_text(back.correction.cuts), writer::cuts_text(request_.correction.cuts));
    EXPECT_EQ(back.correction.order, request_.correction.order);
    EXPECT_EQ(back.name, request_.text);
    EXPECT_EQ(back.bytes, read_file(request_.like));
    EXPECT_EQ(picture_of(back), std::filesystem::absolute(request_.like));
    // Of a damaged line the picture is left.
    EXPECT_EQ(kept_copy({kept.id, "{\"cuts\": \"9:9\"}", kept.bytes}).correction, writer::CopyCorrection{});
    EXPECT_EQ(kept_copy({kept.id, "no JSON", kept.bytes}).bytes, kept.bytes);
}

TEST_F(Copying, APictureThatIsAwayIsPutIntoTheStateFolderUnderItsName) {
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
    KeptCopy kept = read_copy(request_);
    std::filesystem::remove(request_.like);
    const std::filesystem::path there = picture_of(kept);
    EXPECT_EQ(there.filename(), "cross.png");
    EXPECT_EQ(read_file(there), kept.bytes);
    // Two pictures of one name.
    KeptCopy other = kept;
    other.bytes.push_back(0);
    EXPECT_NE(picture_of(other), there);
    EXPECT_EQ(read_file(there), kept.bytes);
    for (const char* hostile : {"", ".", "..", "a/..", "/"}) {
        kept.file = hostile;
        const std::filesystem::path inside = std::filesystem::relative(picture_of(kept), folder_ / "state");
        EXPECT_NE(*inside.begin(), "..") << hostile;
        EXPECT_EQ(inside.filename(), "picture.png") << hostile;
    }
    // A file in place of the folder.
    std::filesystem::create_directories(folder_ / "full" / "tuft");
    std::filesystem::copy_file(there, folder_ / "full" / "tuft" / "copied");
    setenv("XDG_STATE_HOME", (folder_ / "full").c_str(), 1);
    EXPECT_THROW(picture_of(kept), Error);
    setenv("XDG_STATE_HOME", (folder_ / "state").c_str(), 1);
}

/// What it reads until it has nothing to do.
std::vector<CopyReader::Read> all_of(CopyReader& reader) {
    std::vector<CopyReader::Read> all;
    while (reader.busy()) {
        reader.wait();
        if (auto read = reader.poll()) all.push_back(std::move(*read));
    }
    return all;
}

TEST_F(Copying, IsReadToBeKeptOnceForEachCorrectionAndStateOfItsFile) {
    CopyReader reader;
    std::vector<KeptCopy> kept;
    const auto reads = [&] {
        reader.read(request_, kept);
        std::vector<CopyReader::Read> all = all_of(reader);
        for (CopyReader::Read& read : all) kept = {std::move(*read.copy)};
        return all.size();
    };
    EXPECT_EQ(reads(), 1u);
    EXPECT_EQ(reads(), 0u);
    click(CopyEdit::reverse, horizontal_);
    EXPECT_EQ(reads(), 1u);
    EXPECT_EQ(kept.front().correction, request_.correction);
    std::filesystem::last_write_time(request_.like, *kept.front().read_at + std::chrono::seconds(1));
    EXPECT_EQ(reads(), 1u);
    EXPECT_EQ(reads(), 0u);
}

TEST_F(Copying, TheSameRequestWhileItIsReadIsReadOnceUnlessAnotherOneCameBetween) {
    CopyReader reader;
    reader.read(request_, {});
    reader.read(request_, {});
    EXPECT_EQ(all_of(reader).size(), 1u);
    // The last of several corrections is the one that stays, also where it is the one that is kept.
    const std::vector<KeptCopy> kept{read_copy(request_)};
    const writer::CopyCorrection before = request_.correction;
    click(CopyEdit::reverse, horizontal_);
    reader.read(request_, kept);
    request_.correction = before;
    reader.read(request_, kept);
    const std::vector<CopyReader::Read> all = all_of(reader);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[1].copy->correction, before);
}

TEST_F(Copying, RequestsThatComeWhileOneIsReadAreReadAfterItAndAFaultIsReported) {
    CopyReader reader;
    for (const char* name : {"a", "b", "c"}) {
        request_.text = name;
        reader.read(request_, {});
    }
    request_.like = folder_ / "away.png";
    reader.read(request_, {});
    const std::vector<CopyReader::Read> all = all_of(reader);
    ASSERT_EQ(all.size(), 4u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(all[i].copy->name, std::string(1, static_cast<char>('a' + i)));
    EXPECT_FALSE(all[3].copy);
    EXPECT_NE(all[3].fault.text().find("away.png"), std::string::npos) << all[3].fault.text();
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
