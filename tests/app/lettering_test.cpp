#include "app/document/lettering.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "both_programs.h"
#include "copied_picture.h"
#include "core/files/disk_cache.h"

namespace tuft::app {
namespace {

/// Waits for what a text reads as.
void read(Lettering& l) {
    LetteringReader reader;
    do {
        reader.update(l);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } while (reader.busy(l));
}

Lettering lettering(const std::string& text, double side, writer::Direction direction = {}) {
    Lettering l;
    l.wanted.text = text;
    l.side = side;
    l.direction = direction;
    read(l);
    return l;
}

TEST(Lettering, NamesEachMissingCharacterAndKeepsNoText) {
    const Lettering l = lettering("\xe6\xb0\xb8\xe9\x91\xab\xe9\xbe\x98", 0.03);
    EXPECT_TRUE(l.empty());
    EXPECT_NE(l.fault.text().find("\xe9\x91\xab"), std::string::npos) << l.fault.text();
    EXPECT_NE(l.fault.text().find("\xe9\xbe\x98"), std::string::npos);
    EXPECT_EQ(l.fault.text().find("\xe6\xb0\xb8"), std::string::npos) << "it is there";
}

TEST(Lettering, WithoutATextThereIsNeitherFaultNorAnythingToWrite) {
    for (const char* text : {"", " ", "\n\n"}) {
        const Lettering l = lettering(text, 0.03);
        EXPECT_TRUE(l.empty());
        EXPECT_TRUE(l.fault.empty()) << l.fault.text();
    }
}

TEST(Lettering, AnotherTextIsReadWhileTheLastOneIsStillBeingRead) {
    Lettering l;
    LetteringReader reader;
    l.wanted.text = "\xe6\xb0\xb8";
    reader.update(l);
    l.wanted.text = "\xe6\x98\xa5\xe9\xa2\xa8";
    EXPECT_TRUE(reader.busy(l));
    while (reader.busy(l)) reader.update(l);
    ASSERT_FALSE(l.empty());
    EXPECT_EQ(l.text->lines.front().size(), 2u);
}

// Another picture under the same name is another picture.
TEST(Lettering, APictureChosenAgainIsReadAgainAsItsFileIsNow) {
    const std::string file = testing::TempDir() + "/tuft_lettering_" + std::to_string(getpid()) + ".png";
    write_cross(file);
    Lettering l;
    LetteringReader reader;
    const auto choose = [&] {
        copy_picture(l, file);
        l.copy.fresh = false;
        EXPECT_TRUE(reader.busy(l));
        while (reader.busy(l)) reader.update(l);
    };
    choose();
    ASSERT_TRUE(l.copy.shown);
    EXPECT_TRUE(l.copy.fresh);
    choose();
    ASSERT_TRUE(l.copy.shown) << "the panel is not left blank";
    EXPECT_FALSE(l.copy.fresh) << "its texture is the same";
    const std::vector<std::uint8_t> before = l.copy.picture.rgb;
    std::vector<std::uint8_t> bar(200 * 200, 255);
    for (std::size_t i = 0; i < bar.size(); ++i)
        if (i / 200 >= 90 && i / 200 < 110 && i % 200 >= 20 && i % 200 < 180) bar[i] = 0;
    io::write_image(file, io::view_of(200, 200, 1, bar.data()));
    std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) + std::chrono::seconds(2));
    choose();
    ASSERT_TRUE(l.copy.shown);
    EXPECT_EQ(l.copy.shown->order.size(), 1u);
    EXPECT_TRUE(l.copy.fresh);
    EXPECT_NE(l.copy.picture.rgb, before);
    std::filesystem::remove(file);
}

TEST(Lettering, ItsUsualSizeIsATenthOfTheModelInTwoDigits) {
    EXPECT_DOUBLE_EQ(usual_side({.lo = {0, 0, 0}, .hi = {0.2378, 0, 0}}), 0.024);
}

// Flat, the preview is the layout itself: the two squares of a row stand `spacing` sides apart.
TEST(Lettering, ThePreviewLiesAboutItsPlaceAsLargeAsTheTextWillBe) {
    const stroke::Model sheet = test::shipped_model("sheet.ply", 64);
    const Lettering l = lettering("\xe6\xb0\xb8\xe6\xb0\xb8", 0.02);
    const Vec3 middle = sheet.query->ray(sheet.mesh->bounds.centre() + Vec3(0, 0, 1), {0, 0, -1})->position;
    const LetteringPlace place = place_lettering(l, *sheet.query, middle, {0, 0, 1}, {1, 0, 0}, {0, 0, 1});
    const auto lines = preview_lines(*sheet.query, l, place);
    ASSERT_EQ(lines.size(), 2 * l.text->lines.front().front().strokes.size());
    Box box;
    for (const auto& line : lines)
        for (const PreviewPoint& p : line) box.add(p.position);
    constexpr double kExact = 1e-5;  // metres: the walk works on single-precision vertices
    EXPECT_NEAR(glm::distance(Vec3(box.centre()), middle), 0, kExact);
    const std::size_t n = lines.size() / 2;
    EXPECT_NEAR(lines[n].front().position.x - lines[0].front().position.x, l.text->style.spacing * 0.02, kExact);
}

// A stem of a Latin letter is two points far apart: on the bowl its chord would be 1 mm inside the wall. Points a tenth
// of a side apart, h = 3 mm, leave h^2 / 8R = 0.04 mm where the wall is bent most, R = 30 mm; twice that is allowed.
TEST(Lettering, ThePreviewOfStraightStemsBendsWithTheSurface) {
    const stroke::Model bowl = test::shipped_model("bowl.ply", 64);
    Lettering l;
    l.wanted.text = "lHM";
    l.wanted.style = "italic";
    l.side = 0.03;
    read(l);
    ASSERT_FALSE(l.empty()) << l.fault.text();
    const Vec3 at = bowl.query->ray({0, -1, 0.035}, {0, 1, 0})->position;
    for (const writer::Direction direction : {writer::Direction::horizontal, writer::Direction::rim}) {
        l.direction = direction;
        lay_out(l);
        const LetteringPlace place = place_lettering(l, *bowl.query, at, {0, -1, 0}, {1, 0, 0}, {0, -1, 0});
        for (const auto& line : preview_lines(*bowl.query, l, place))
            for (std::size_t i = 1; i < line.size(); ++i) {
                const Vec3 middle = 0.5 * (line[i - 1].position + line[i].position);
                EXPECT_LT(bowl.query->closest_point(middle)->distance, 8e-5);
            }
    }
}

TEST(Lettering, OfALongTextThePreviewIsALineForEachRow) {
    const stroke::Model sheet = test::shipped_model("sheet.ply", 64);
    std::string text;
    for (int row = 0; row < 20; ++row) {
        for (int i = 0; i < 50; ++i) text += "\xe6\xb0\xb8";
        text += "\n";
    }
    const Lettering l = lettering(text, 0.001);
    const Vec3 middle = sheet.query->ray(sheet.mesh->bounds.centre() + Vec3(0, 0, 1), {0, 0, -1})->position;
    const LetteringPlace place = place_lettering(l, *sheet.query, middle, {0, 0, 1}, {1, 0, 0}, {0, 0, 1});
    EXPECT_EQ(preview_lines(*sheet.query, l, place).size(), 20u);
}

TEST(Lettering, ATextLongerThanItsPathIsRefused) {
    const stroke::Model bowl = test::shipped_model("bowl.ply", 64);
    const Lettering l = lettering("\xe6\xb0\xb8\xe6\xb0\xb8\xe6\xb0\xb8", 0.5, writer::Direction::rim);
    const Vec3 at = bowl.query->ray({0, -1, 0.03}, {0, 1, 0})->position;
    const LetteringPlace place = place_lettering(l, *bowl.query, at, {0, -1, 0}, {1, 0, 0}, {0, -1, 0});
    EXPECT_THROW(preview_lines(*bowl.query, l, place), Error);
}

TEST(Lettering, AlongACurveItStandsWhereTheCursorIsAndStaysOnIt) {
    const stroke::Model sheet = test::shipped_model("sheet.ply", 64);
    Lettering l = lettering("\xe6\xb0\xb8", 0.01, writer::Direction::curve);
    const Vec3 c = sheet.mesh->bounds.centre();
    EXPECT_THROW(place_lettering(l, *sheet.query, c, {0, 0, 1}, {1, 0, 0}, {0, 0, 1}), Error) << "there is no curve";
    l.curve = {{.position = c + Vec3(-0.03, 0, 0)}, {.position = c + Vec3(0.03, 0, 0)}};
    const auto middle = [&](double x) {
        const LetteringPlace place =
            place_lettering(l, *sheet.query, c + Vec3(x, 0.002, 0), {0, 0, 1}, {1, 0, 0}, {0, 0, 1});
        const LetteringPath& on = std::get<LetteringPath>(place);
        return writer::places_along(*l.text, on.path, on.middle).front().origin.x - c.x;
    };
    constexpr double kStep = 0.06 / 64;  // metres between the samples of the curve
    EXPECT_NEAR(middle(0.011), 0.011, kStep);
    const double half = 0.5 * 0.01 * l.text->style.spacing;
    EXPECT_NEAR(middle(0.04), 0.03 - half, kStep) << "all of it has room";
}

/// A text on a shipped model at the point that a ray from the outside meets.
class LetteringOnModel : public BothPrograms {
  protected:
    Painted by_studio(const std::string& name, const Lettering& l, const Vec3& from, const Vec3& along,
                      const std::string& brush = "wolf-medium", const std::string& ink = "carbon") {
        return BothPrograms::by_studio(name, [&](const mesh::SurfaceQuery& query) {
            const auto at = query.ray(from, along);
            EXPECT_TRUE(at);
            const Vec3 right = glm::normalize(glm::cross(along, Vec3(0.02, 0, 1)));
            PaintText command{.text = *l.text,
                              .place = place_lettering(l, query, at->position, -along, right, -along),
                              .brush = l.style_brush ? "" : brush,
                              .ink = ink,
                              .fit = l.fitted(),
                              .group = {.name = l.text->group}};
            std::string words = place_words(l, command.place, brush);
            return std::pair<Command, std::string>(std::move(command), std::move(words));
        });
    }
    void expect_as_by_program(const std::string& name, const Painted& studio, const std::string& more = "") {
        expect_same(studio, by_program("write", name, studio.words + more));
        ASSERT_FALSE(studio.journal.empty());
        for (const stroke::JournalEntry& entry : studio.journal)
            EXPECT_EQ(entry.group, studio.journal.front().group) << "all in one group";
    }
};

TEST_F(LetteringOnModel, InLinesOnTheBowlItIsTheSame) {
    Lettering l = lettering("\xe6\x98\xa5\n\xe9\xa2\xa8", 0.0201234, writer::Direction::horizontal);
    l.turn = 0.3;
    l.spacing.lines = 1.1;
    lay_out(l);
    const Painted studio = by_studio("bowl.ply", l, {0.004, -1, 0.03}, {0, 1, 0});
    expect_as_by_program("bowl.ply", studio);
    EXPECT_EQ(studio.journal.front().group.name, "\xe6\x98\xa5 \xe9\xa2\xa8");
}

TEST_F(LetteringOnModel, DownTheVaseWithTheChosenBrushAndInkItIsTheSame) {
    Lettering l = lettering("\xe6\x98\xa5\xe9\xa2\xa8", 0.03, writer::Direction::vertical);
    l.style_brush = false;
    const Painted studio = by_studio("vase.ply", l, {0, -1, 0.08}, {0, 1, 0}, "mixed-medium*0.5", "cinnabar");
    expect_as_by_program("vase.ply", studio, " --ink cinnabar");
}

TEST_F(LetteringOnModel, RoundTheBowlItIsTheSame) {
    const Lettering l = lettering("\xe6\xb0\xb8 it's", 0.015, writer::Direction::rim);
    expect_as_by_program("bowl.ply", by_studio("bowl.ply", l, {0.3, -1, 0.03}, {-0.3, 1, 0}));
}

// Copied from a picture, as rules find it and corrected.
TEST_F(LetteringOnModel, LikeAPictureItIsTheSame) {
    const std::string picture = folder_ + "/it's a cross.png";
    write_cross(picture);
    for (const std::string& order : {std::string(), std::string("2+3 -1")}) {
        Lettering l;
        copy_picture(l, picture);
        l.wanted.text = "\xe5\x8d\x81";
        if (!order.empty()) l.wanted.correction = {.threshold = 0.125, .cuts = {{1, 0.25}}, .order = order};
        l.side = 0.03;
        read(l);
        ASSERT_TRUE(l.text) << l.fault.text();
        const Painted studio = by_studio("bowl.ply", l, {0.004, -1, 0.03}, {0, 1, 0});
        expect_as_by_program("bowl.ply", studio);
        EXPECT_EQ(studio.journal.size(), 2u);
        EXPECT_EQ(studio.words.find("--order") == std::string::npos, order.empty()) << studio.words;
    }
}

TEST_F(LetteringOnModel, IsStoppedBeforeItsFirstStrokeWithNothingLeftBehind) {
    Lettering l = lettering("\xe6\x98\xa5\xe9\xa2\xa8", 0.0187);  // of a size that no cache knows
    l.text->style.tries += 1;
    const std::string project = folder_ + "/stopped.tuft";
    PaintWork work;
    work.model = std::make_unique<stroke::Model>(test::shipped_model("sheet.ply", 64));
    work.document = std::make_unique<stroke::Document>(*work.model);
    work.texture = std::make_unique<Texture>(*work.document, ProgressFn{});
    ASSERT_TRUE(work.autosave.start(project, source_folder() + "/models/sheet.ply", {}, *work.document).empty());
    const Vec3 at = work.model->mesh->bounds.centre();
    const LetteringPlace place = place_lettering(l, *work.model->query, at, {0, 0, 1}, {1, 0, 0}, {0, 0, 1});
    {
        PaintThread painter(std::move(work));
        painter.post(PaintText{.text = *l.text, .place = place, .ink = "carbon", .group = {.name = "stopped"}});
        while (painter.take().status.progress.busy.empty()) std::this_thread::yield();
        painter.stop_long_work();
        painter.wait_idle(60);
    }
    EXPECT_TRUE(io::Project::open(project).strokes().empty());
}

}  // namespace
}  // namespace tuft::app
