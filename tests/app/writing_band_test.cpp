#include "app/document/writing_band.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "both_programs.h"
#include "studio_program.h"

/// Copies of a drawing along a line of the model, as both programs lay them.
namespace tuft::app {
namespace {

constexpr double kTexel = 1e-3;  // metres, where nothing depends on it

class Bands : public BothPrograms {
  protected:
    /// A line and a filled shape without symmetry, 60 mm wide: few copies, for the cost of their strokes.
    Writing leaf() const {
        const std::string file = folder_ + "/leaf.svg";
        std::ofstream(file) << "<svg xmlns='http://www.w3.org/2000/svg' width='60mm' viewBox='0 0 20 8'><path "
                               "d='M12 1 L18 4 L12 5 Z'/><path fill='none' stroke='black' stroke-width='0.6' "
                               "d='M0.3 6 C6 1 14 9 19.7 6'/></svg>";
        return read_writing(file);
    }

    Painted by_studio(const std::string& name, const Writing& w, const Vec3& at) {
        return BothPrograms::by_studio(name, [&](const mesh::SurfaceQuery& query) {
            writer::FeatureLines lines(query);
            const double texel = test::shipped_model(name, kTexels).texels.texel_size;
            const WritingBand band = lay_band(w, {query, lines, {}, texel}, at);
            copies_ = band.band.repeats;
            return std::pair<Command, std::string>(
                PaintDrawing{placed_writing(w, band, {"wolf-medium", "carbon"}), {.name = stroke::group_name(w.file)}},
                place_words(w, band));
        });
    }
    Painted by_program(const std::string& name, const Writing& w, const std::string& words) {
        return BothPrograms::by_program("paint", name, "--strokes " + w.file.string() + " " + words);
    }
    int copies_ = 0;
};

TEST_F(Bands, AlongAnEdgeAreTheSameInBothPrograms) {
    Writing w = leaf();
    w.along = BandLine::edge;
    w.mirrored = true;
    const Painted studio = by_studio("cylinder.ply", w, {0.001, -0.04, 0.0032});
    EXPECT_NE(studio.words.find("--along edge --place "), std::string::npos) << studio.words;
    EXPECT_EQ(copies_, 4) << "251 mm round";
    expect_same(studio, by_program("cylinder.ply", w, studio.words));
    std::set<std::uint64_t> groups;
    for (const stroke::JournalEntry& entry : studio.journal) groups.insert(entry.group.id);
    EXPECT_EQ(groups.size(), 1u) << "one group, to be moved and hidden as one";
    EXPECT_FALSE(groups.contains(0));
    for (const stroke::JournalEntry& entry : studio.journal) {
        const auto* fill = entry.as<stroke::Fill>();
        const stroke::Placement& at = fill ? fill->area->placement : stroke::samples_of(entry).placement;
        EXPECT_EQ(at.mapping, stroke::SurfaceMapping::drape) << "over grooves, as one copy lies";
    }
}

TEST_F(Bands, RoundTheModelANumberOfThemAreTheSameInBothPrograms) {
    Writing w = leaf();
    w.along = BandLine::rim;
    w.repeats = 3;
    w.scale = 0.8;
    w.mapping = stroke::SurfaceMapping::wrap;
    const Painted studio = by_studio("bowl.ply", w, {0, -0.06, 0.045});
    EXPECT_EQ(copies_, 3);
    expect_same(studio, by_program("bowl.ply", w, studio.words));
}

// Its brushes grow and shrink with it, as those of one copy do.
TEST_F(Bands, OfHandwritingWithPlacesOfItsOwnAreTheSameInBothPrograms) {
    const std::string file = folder_ + "/hand.inkml";
    std::ofstream(file) << "<ink xmlns='http://www.w3.org/2003/InkML'><traceGroup><annotation "
                           "type='tuft:brush'>goat-small</annotation><annotation "
                           "type='tuft:origin'>0 0 0</annotation><trace>0 0, 60 10, 120 0</trace></traceGroup></ink>";
    Writing w = read_writing(file);
    w.along = BandLine::rim;
    w.own_ink = true;
    w.scale = 0.5;
    const Painted studio = by_studio("cylinder.ply", w, {0, -0.04, 0.06});
    expect_same(studio, by_program("cylinder.ply", w, studio.words));
    for (const stroke::JournalEntry& entry : studio.journal) {
        const auto* s = entry.as<stroke::PaintStroke>();
        ASSERT_TRUE(s);
        EXPECT_TRUE(s->brush.starts_with("goat-small*0.")) << s->brush;
    }
}

TEST_F(Bands, AreShownAsTheyWillLie) {
    const mesh::TriangleMesh mesh = mesh::build_surface(io::read_model(test::model_path("cylinder.ply"))).mesh;
    const mesh::SurfaceQuery query(mesh);
    writer::FeatureLines lines(query);
    Writing w = leaf();
    w.along = BandLine::edge;
    const WritingBand band = lay_band(w, {query, lines, {}, kTexel}, {0.001, -0.04, 0.0032});
    const auto shown = preview_lines(query, w, band);
    // Two shapes a copy; the band is half as high above and below its line, which lies on the lower edge of the wall.
    EXPECT_GE(shown.size(), 2u * static_cast<std::size_t>(band.band.repeats));
    double highest = 0;
    for (const auto& line : shown)
        for (const PreviewPoint& p : line) highest = std::max(highest, p.position.z - mesh.bounds.lo.z);
    EXPECT_NEAR(highest, 0.5 * band.band.height, 0.1 * band.band.height) << "half of a line's width lies round it";
    EXPECT_THROW(lay_band(w, {query, lines, {}, kTexel}, {0, -0.04, 0.03}), Error) << "no edge is near";
    w.along = BandLine::curve;
    EXPECT_THROW(lay_band(w, {query, lines, {}, kTexel}, {0, -0.04, 0.03}), Error) << "there is no curve";
}

class BandsInTheWindow : public StudioProgram {};

TEST_F(BandsInTheWindow, AreLaidAlongTheEdgeBesideTheCursorAndTakenBackAsOne) {
    std::ofstream(path("tile.svg")) << "<svg xmlns='http://www.w3.org/2000/svg' width='12mm' viewBox='0 0 12 4'><path "
                                       "d='M1 2 H11' stroke='black' fill='none'/></svg>";
    const Ran ran =
        studio("set draw-every 16\nopen " + source_folder() +
               "/models/cylinder.ply\nwait-ready\nset texels 512\nclick \"Unwrap and paint\"\nwait-ready\n"
               "open " +
               path("tile.svg") +
               "\nwait-ready\nclick \"Lay along\"\nclick Edge\nmove 50%,50%\nwait 0.2\nexpect label \"Copies along the "
               "line\"\npress\nrelease\nwait-ready\nexpect strokes 0\nset elevation 0\nset azimuth 0\nwait "
               "0.3\nmove 50%,78%\nwait 0.2\npress\nrelease\nwait-ready\nexpect message --along\nplaces\n"
               "save " +
               path("band.tuft") + "\nwait-ready\nundo\nwait-ready\nexpect strokes 0\n");
    ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
    EXPECT_TRUE(places(ran.out).contains("group tile.svg")) << ran.out;
}

// A pane of 30 mm over the middle of a body of 60 mm: its edges are too far from those of the body.
TEST_F(BandsInTheWindow, FollowTheEdgesOfPartsThatAreShownAgain) {
    std::ofstream(path("tile.svg")) << "<svg xmlns='http://www.w3.org/2000/svg' width='10mm' viewBox='0 0 10 4'><path "
                                       "d='M1 2 H9' stroke='black' fill='none'/></svg>";
    std::ofstream(path("m.obj")) << "o body\nv -30 -30 0\nv 30 -30 0\nv 30 30 0\nv -30 30 0\nf 1 2 3 4\n"
                                    "o pane\nv -15 -15 4\nv 15 -15 4\nv 15 15 4\nv -15 15 4\nf 5 6 7 8\n";
    const std::string beside = "move 58%,50%\nwait 0.2\npress\nrelease\nwait-ready\n",
                      eye = "click \"show part pane\"\nwait-ready\nwait 0.2\n";
    const Ran ran =
        studio("open " + path("m.obj") +
                   "\nwait-ready\nset texels 512\nclick \"Unwrap and paint\"\nwait-ready\nset azimuth 0\nset elevation "
                   "85\nclick \"fold Parts\"\nwait 0.2\n" +
                   eye + "open " + path("tile.svg") + "\nwait-ready\nset writing-along edge\nset writing-width 10\n" +
                   beside + "expect message \"no edge and no crease\"\n" + eye + beside + "expect message --along\n",
               "--headless --size 1280x900");
    EXPECT_EQ(ran.status, 0) << ran.err;
}

}  // namespace
}  // namespace tuft::app
