#include "app/document/writing.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "app/document/first_scale.h"
#include "app/document/snapping.h"
#include "both_programs.h"
#include "io/project/restore.h"

namespace tuft::app {
namespace {

Writing cross() {
    const std::string file = testing::TempDir() + "/tuft_writing_" + std::to_string(getpid()) + ".svg";
    std::ofstream(file) << "<svg width='40mm' viewBox='0 0 40 20'><line x1='0' y1='10' x2='40' y2='10'/><line x1='20' "
                           "y1='0' x2='20' y2='20'/></svg>";
    Writing w = read_writing(file);
    std::filesystem::remove(file);
    return w;
}

TEST(Writing, LiesWithItsMiddleAtTheCursorTurnedAndScaled) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    Writing w = cross();
    EXPECT_NEAR(w.form().width, 0.040, 1e-9);
    EXPECT_NEAR(w.form().height, 0.020, 1e-9);
    w.scale = 1.5;
    w.turn = 0.5;
    constexpr double kRounding = 2e-6;  // metres: the turn is 0.01 degrees off at most, on 15 mm
    const auto at = query.ray(mesh.bounds.centre() + Vec3(0.01, 0.02, 1), Vec3(0, 0, -1));
    ASSERT_TRUE(at);
    const auto lines =
        preview_lines(query, w, place_writing(w, query, at->position, Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 0, 1)));
    ASSERT_EQ(lines.size(), 2u);
    // Seen from above with x to the right, a turn goes clockwise: the line's right end sinks.
    const Vec3 right = lines[0].back().position - at->position;
    EXPECT_NEAR(right.x, 0.030 * std::cos(0.5), 1e-5 + kRounding);  // the walk works on single-precision vertices
    EXPECT_NEAR(right.y, -0.030 * std::sin(0.5), 1e-5 + kRounding);
    EXPECT_NEAR(glm::length(lines[1].front().position - lines[1].back().position), 0.030, 1e-5);
}

TEST(Writing, SnapsToSymmetryAndLevelWithOtherDrawings) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    const Vec3 c = mesh.bounds.centre();
    const stroke::Placement other{.origin = c + Vec3(0.02, 0.013, 0), .right = {1, 0, 0}, .down = {0, -1, 0}};
    const SnapTargets targets = snap_targets({}, mesh.bounds, std::vector{other, other});
    ASSERT_EQ(targets.placements.size(), 1u) << "each once";
    ASSERT_EQ(targets.planes.size(), 2u) << "across x and y";
    constexpr double kReach = 2e-3;
    const auto at = [&](double x, double y) { return snap(query, c + Vec3(x, y, 0), targets, kReach); };
    constexpr double kExact = 1.1e-6;  // metres, of surface_point_in_plane
    // In the middle plane across x, and nowhere else: y stays.
    const auto plane = at(0.0015, 0.03);
    ASSERT_TRUE(plane);
    EXPECT_NEAR(plane->at.position.x, c.x, kExact);
    EXPECT_NEAR(plane->at.position.y, c.y + 0.03, kExact);
    EXPECT_EQ(plane->guides.size(), 1u);
    // Level with the other drawing and in the plane.
    const auto both = at(-0.001, 0.0122);
    ASSERT_TRUE(both);
    EXPECT_NEAR(both->at.position.x, c.x, kExact);
    EXPECT_NEAR(both->at.position.y, c.y + 0.013, kExact);
    ASSERT_EQ(both->guides.size(), 2u);
    for (const std::vector<Vec3>& guide : both->guides) EXPECT_GT(guide.size(), 10u);
    EXPECT_FALSE(at(0.01, 0.03));
    // The planes of the symmetry that is on, and no others.
    const SnapTargets mirrored = snap_targets({.mirror_y = true, .centre = c + Vec3(0, 0.005, 0)}, mesh.bounds, {});
    ASSERT_EQ(mirrored.planes.size(), 1u);
    EXPECT_NEAR(snap(query, c + Vec3(0.001, 0.0045, 0), mirrored, kReach)->at.position.y, c.y + 0.005, kExact);
}

TEST(Writing, ComesAtItsOwnSizeUnlessNoSideOfTheModelHasRoomForItOrItIsASpeck) {
    const Box bowl{{-0.075, -0.075, 0}, {0.075, 0.075, 0.067}};
    const auto comes = [&](double width, double height) {
        Writing w;
        w.lines.width = width;
        w.lines.height = height;
        return width * first_scale(w, bowl);
    };
    constexpr double kRounding = 1e-15;  // metres
    EXPECT_EQ(comes(0.149, 0.02), 0.149);
    EXPECT_NEAR(comes(0.206, 0.11), bowl.diagonal() / 3, kRounding);
    EXPECT_NEAR(comes(0.1, 0.2) * 2, bowl.diagonal() / 3, kRounding);
    EXPECT_NEAR(comes(0.004, 0.004), bowl.diagonal() / 3, kRounding);
    EXPECT_EQ(comes(0.005, 0.005), 0.005);
}

TEST(Writing, CharactersWithPlacesOfTheirOwnStandSideBySide) {
    const Writing w = read_writing(source_folder() + "/samples/strokes/man-bu-ren-sheng.inkml");
    EXPECT_GT(w.form().width, 3 * w.form().height);
}

TEST(Writing, OptionsOfAnUprightPlaceHaveNoNegativeZero) {
    const Vec3 front{0, -1, 0};
    for (const double turn : {-1e-9, 0.0, 1e-9}) {
        const std::string words = place_words(cross(), stroke::upright_placement({0, -0.1, 0.05}, front, turn));
        EXPECT_NE(words.find("--place-turn 0.00 "), std::string::npos) << words;
    }
}

/// A shipped model with a drawing placed on it at the point that a ray from the outside meets.
class WritingOnModel : public BothPrograms {
  protected:
    Painted by_studio(const std::string& name, const Writing& w, const Vec3& from, const Vec3& along, const Vec3& right,
                      const WritingHand& hand) {
        return BothPrograms::by_studio(name, [&](const mesh::SurfaceQuery& query) {
            const auto at = query.ray(from, along);
            EXPECT_TRUE(at);
            const stroke::Placement placement = place_writing(w, query, at->position, -along, right, -along);
            return std::pair<Command, std::string>(
                PaintDrawing{placed_writing(w, placement, hand), {.name = stroke::group_name(w.file)}},
                place_words(w, placement));
        });
    }

    Painted by_program(const std::string& name, const Writing& w, const std::string& words, const std::string& more) {
        return BothPrograms::by_program("paint", name, "--strokes " + w.file.string() + " " + words + " " + more);
    }

    /// A filled half disc, a curve and a line, 150 mm wide: what a drawing is made of, in few strokes.
    Writing badge(double width) const {
        const std::string file = folder_ + "/badge.svg";
        std::ofstream(file) << "<svg xmlns='http://www.w3.org/2000/svg' width='150mm' viewBox='0 0 30 24'><path "
                               "d='M4 4 A9 9 0 0 0 4 20 Z'/><g fill='none' stroke='black' stroke-width='1'><path "
                               "d='M10 3 C20 3 26 9 26 19'/><path d='M10 12 l12 9'/></g></svg>";
        Writing w = read_writing(file);
        w.scale = width / w.form().width;
        return w;
    }
};

Writing roundel(double width) {
    Writing w = read_writing(source_folder() + "/samples/strokes/roundel.svg");
    w.scale = width / w.form().width;
    return w;
}

/// Three colours, one of them translucent and one under a gradient to another: nearer to each other than to the
/// pigments, so that they are mixed otherwise together than one after the other.
std::string flag() {
    const std::string file = testing::TempDir() + "/tuft_flag_" + std::to_string(getpid()) + ".svg";
    std::ofstream(file) << "<svg xmlns='http://www.w3.org/2000/svg' width='60mm' viewBox='0 0 60 30'><linearGradient "
                           "id='g'><stop stop-color='#1b6f5a'/><stop offset='1' stop-color='#d3ab4c'/></linearGradient>"
                           "<path fill='#bd3b25' d='M0 0 H20 V30 H0 Z'/><path fill='url(#g)' d='M20 0 H40 V30 H20 Z'/>"
                           "<circle fill='#1b6f5a' fill-opacity='0.6' cx='51' cy='15' r='9'/><path fill='none' "
                           "stroke='#d3ab4c' stroke-width='3' d='M4 26 C20 10 40 30 56 4'/></svg>";
    return file;
}

TEST(Writing, OfSeveralColoursComesInThemAndOfOneInTheChosenInk) {
    const std::string file = flag();
    Writing w = read_writing(file);
    EXPECT_TRUE(w.in_colours());
    EXPECT_NEAR(w.form().width, 0.060, 1e-9);
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(source_folder() + "/models/sheet.ply")).mesh;
    const mesh::SurfaceQuery query(mesh);
    const stroke::Placement at = place_writing(w, query, mesh.bounds.centre(), {0, 0, 1}, {1, 0, 0}, {0, 0, 1});
    // Its outlines are seen before it is placed: three shapes and a stroke.
    EXPECT_EQ(preview_lines(query, w, at).size(), 4u);
    EXPECT_NE(place_words(w, at).find("--areas mask"), std::string::npos);
    w.own_ink = false;
    EXPECT_NE(place_words(w, at).find("--areas brush"), std::string::npos);
    const std::string capitals = testing::TempDir() + "/TUFT_FLAG_" + std::to_string(getpid()) + ".SVG";
    std::filesystem::copy_file(file, capitals, std::filesystem::copy_options::overwrite_existing);
    EXPECT_TRUE(read_writing(capitals).in_colours());
    std::filesystem::remove(capitals);
    std::ofstream(file) << "<svg xmlns='http://www.w3.org/2000/svg' width='60mm' viewBox='0 0 60 30'><path "
                           "fill='#bd3b25' d='M0 0 H20 V30 H0 Z'/></svg>";
    w = read_writing(file);
    EXPECT_FALSE(w.in_colours());
    EXPECT_FALSE(w.areas.traces.empty()) << "it can be painted in its colour";
    std::filesystem::remove(file);
    EXPECT_TRUE(cross().areas.traces.empty()) << "black alone";
    EXPECT_FALSE(read_writing(source_folder() + "/samples/strokes/man-bu-ren-sheng.inkml").own_ink) << "one ink";
}

TEST(Writing, ItsSketchIsItsLinesOrTheOutlinesOfItsAreasInAUnitSquare) {
    const auto box_of = [](const std::vector<std::vector<Vec2>>& lines) {
        Box box;
        for (const std::vector<Vec2>& line : lines)
            for (const Vec2& p : line) box.add(Vec3(p, 0));
        return box;
    };
    const auto expect_box = [](const Box& box, double margin, double half_height) {
        constexpr double kChord = 1e-9;  // straight lines
        EXPECT_NEAR(box.lo.x, margin, kChord);
        EXPECT_NEAR(box.hi.x, 1 - margin, kChord);
        EXPECT_NEAR(box.lo.y, 0.5 - half_height, kChord);
        EXPECT_NEAR(box.hi.y, 0.5 + half_height, kChord);
    };
    const std::string file = flag();
    const auto areas = read_sketch(file);
    EXPECT_EQ(areas.size(), 4u) << "three shapes and a stroke";
    expect_box(box_of(areas), 0, 0.25);
    std::ofstream(file) << "<svg xmlns='http://www.w3.org/2000/svg' width='40mm' viewBox='0 0 40 20'><g "
                           "stroke='black' stroke-width='2'><path d='M0 10 H40'/><path d='M20 0 V20'/></g></svg>";
    const auto lines = read_sketch(file);
    EXPECT_EQ(lines.size(), 2u);
    // Half a line's width lies round them.
    expect_box(box_of(lines), 1.0 / 42, 10.0 / 42);
    std::filesystem::remove(file);
    EXPECT_THROW(read_sketch(file), Error);
    EXPECT_GT(read_sketch(source_folder() + "/samples/strokes/man-bu-ren-sheng.inkml").size(), 20u);
}

const WritingHand kHand{"wolf-medium", "carbon"};

TEST_F(WritingOnModel, TheStudioPaintsARoundelOnTheBowlAsTheProgramDoes) {
    const Writing w = roundel(0.060);
    const Painted studio = by_studio("bowl.ply", w, {0.004, -1, 0.03}, {0, 1, 0}, {1, 0.1, 0}, kHand);
    expect_same(studio, by_program("bowl.ply", w, studio.words, ""));
    // Areas are there too: each stroke leaves ink.
    EXPECT_EQ(studio.journal.size(), 43u);
}

TEST_F(WritingOnModel, MirroredTurnedAndSmallInAPlateItIsTheSame) {
    Writing w = badge(0.024);  // less than a sixth of its own size: its strokes' times are scaled too
    w.mirrored = true;
    w.turn = 0.7;
    const Painted studio =
        by_studio("plate.ply", w, {0.01, 0.02, 1}, {0, 0, -1}, {0.8, 0.6, 0}, {"goat-medium", "cinnabar"});
    expect_same(studio, by_program("plate.ply", w, studio.words, "--brush goat-medium --fit-brush --ink cinnabar"));
    EXPECT_NE(studio.words.find("--place-mirror"), std::string::npos);
}

TEST_F(WritingOnModel, InItsColoursItIsTheSame) {
    const std::string file = flag();
    Writing w = read_writing(file);
    w.scale = 0.8;
    w.turn = 0.3;
    w.mirrored = true;
    const Painted studio = by_studio("bowl.ply", w, {0.004, -1, 0.03}, {0, 1, 0}, {1, 0.1, 0}, kHand);
    const Painted program = by_program("bowl.ply", w, studio.words, "");
    expect_same(studio, program);
    ASSERT_EQ(studio.journal.size(), 4u);
    std::set<std::string> inks;
    for (const stroke::JournalEntry& entry : studio.journal)
        for (const std::string& ink : stroke::inks_of(entry)) inks.insert(ink);
    for (const char* ink : {"#1b6f5a", "#bd3b25", "#d3ab4c"}) EXPECT_TRUE(inks.contains(ink)) << ink;
    // The project holds the inks as they were mixed: painted again it is the same.
    const nlohmann::json again = test::tuft("replay " + folder_ + "/studio.tuft", folder_ + "/out.json");
    EXPECT_EQ(again["canvas_hash"], studio.hash);
    std::filesystem::remove(file);
}

TEST_F(WritingOnModel, OnACarsDoorItIsTheSame) {
    const Writing w = badge(0.150);
    const Painted studio = by_studio("car.ply", w, {0, -3, 0.118}, {0, 1, 0}, {1, 0, 0}, kHand);
    expect_same(studio, by_program("car.ply", w, studio.words, ""));
    EXPECT_GT(studio.journal.size(), 2u) << "the area is painted too";
}

TEST_F(WritingOnModel, HandwritingWithBrushesAndPlacesOfItsOwnIsTheSame) {
    Writing w = read_writing(source_folder() + "/samples/strokes/man-bu-ren-sheng.inkml");
    w.own_ink = true;
    w.scale = 0.4;
    const Painted studio = by_studio("vase.ply", w, {0, -1, 0.08}, {0, 1, 0}, {1, 0, 0}, kHand);
    expect_same(studio, by_program("vase.ply", w, studio.words, ""));
}

// A model in a mistaken unit. The tuft of wolf-large*4 is 180 mm long, the cylinder is 165 mm across, the drawing 800
// mm wide.
TEST_F(WritingOnModel, OneThatNoTuftCanPaintIsRefusedBeforeItsFirstStroke) {
    Writing w = cross();
    const WritingHand hand{"wolf-large*4", "carbon"};
    w.scale = 20;
    EXPECT_TRUE(by_studio("cylinder.ply", w, {0, -1, 0.03}, {0, 1, 0}, {1, 0, 0}, hand).journal.empty());
    w.scale = 1;
    EXPECT_EQ(by_studio("cylinder.ply", w, {0, -1, 0.03}, {0, 1, 0}, {1, 0, 0}, hand).journal.size(), 2u);
}

// A canvas has planes for a few pigments. Inks that were asked for hold theirs: those of the first drawing would leave
// too few for the second one's.
TEST_F(WritingOnModel, OneInColoursThatIsRefusedLeavesNoneOfItsInks) {
    const auto placed = [](const std::string& file, double scale, const WritingHand& hand) {
        Writing w = read_writing(file);
        w.own_ink = scale == 1;
        w.scale = scale;
        return PaintDrawing{placed_writing(w, stroke::placement_seen({0, 0, 0.05}, {0, 0, 1}, {1, 0, 0}, 0), hand), {}};
    };
    const auto stripes = [&](const std::vector<std::string>& colours) {
        const std::string file = folder_ + "/stripes.svg";
        std::ofstream out(file);
        out << "<svg xmlns='http://www.w3.org/2000/svg' width='16mm' viewBox='0 0 16 10'>";
        for (std::size_t i = 0; i < colours.size(); ++i)
            out << "<rect width='4' height='10' x='" << 4 * i << "' fill='" << colours[i] << "'/>";
        out << "</svg>";
        out.close();
        return placed(file, 1, kHand);
    };
    const std::vector<std::string> many{"#0a3d2a", "#e0b030", "#1b3f9a", "#f0f0e8"};
    stroke::LayerEdit lock{.what = stroke::LayerChange::change, .layer = {.id = stroke::kFirstLayer}};
    std::vector<Command> before;
    lock.layer.locked = true;
    before.push_back(ChangeLayers{lock});
    before.push_back(stripes(many));
    lock.layer.locked = false;
    before.push_back(ChangeLayers{lock});
    // A line 1.4 m long by a tuft that is longer than the sphere: refused when the inks of areas and lines are mixed.
    const std::string line = folder_ + "/line.inkml";
    std::ofstream(line) << "<ink xmlns='http://www.w3.org/2003/InkML'><trace>0 0, 7 0, 14 0</trace></ink>";
    PaintDrawing large = placed(line, 100, {"wolf-large*4", "#7a1f90"});
    for (stroke::JournalEntry& entry : stripes(many).drawing.entries) large.drawing.entries.push_back(std::move(entry));
    before.push_back(std::move(large));
    const std::string colour = "#c02070";
    const auto paint = [&](const mesh::SurfaceQuery&) {
        return std::pair<Command, std::string>(stripes({colour}), "");
    };
    const Painted all = BothPrograms::by_studio("sphere.ply", paint, std::move(before));
    ASSERT_EQ(all.journal.size(), 3u) << "two changes of the layer and one stripe";
    const io::Project project = io::Project::open(folder_ + "/studio.tuft");
    EXPECT_EQ(project.inks().size(), 1u);
    const stroke::Model model = test::shipped_model("sphere.ply", 64);
    stroke::Document fresh(model), stored(model);
    io::use_presets(project, stored);
    fresh.mix_together({{colour, 1}});
    const std::vector<ink::InkPart>& alone = fresh.materials().ink(colour).parts;
    const std::vector<ink::InkPart>& mixed = stored.materials().ink(colour).parts;
    ASSERT_EQ(mixed.size(), alone.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        EXPECT_EQ(mixed[i].pigment.name, alone[i].pigment.name);
        EXPECT_NEAR(mixed[i].fraction, alone[i].fraction, 1e-9) << "written and read as text";
    }
}

TEST_F(WritingOnModel, StraightThroughThePictureItIsTheSame) {
    Writing w = badge(0.05);
    w.mapping = stroke::SurfaceMapping::project;
    w.turn = -0.2;
    // The eye is above the rim and to the left; its picture leans a little.
    const Vec3 along = glm::normalize(Vec3(0.3, 1, -0.2)), right = glm::normalize(Vec3(1, -0.3, 0.05));
    const Painted studio = by_studio("bowl.ply", w, Vec3(0, 0, 0.03) - along, along, right, kHand);
    expect_same(studio, by_program("bowl.ply", w, studio.words, ""));
}

}  // namespace
}  // namespace tuft::app
