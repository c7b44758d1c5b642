#include "app/document/colours.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "app/document/pictures/thumbnails.h"
#include "app/state/brush_settings.h"
#include "app/view/viewport.h"
#include "brush/calibration/sweep.h"
#include "brush/preset/preset.h"
#include "models.h"
#include "stroke/placement/placement.h"

namespace tuft::app {
namespace {

namespace fs = std::filesystem;

ink::ColourMatch wait_for(MixFinder& finder) {
    for (int i = 0; i < 3000; ++i) {
        if (auto match = finder.poll()) return *match;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << "no mix was found";
    return {};
}

TEST(MixFinder, TheNewestRequestCounts) {
    MixFinder finder;
    for (const char* hex : {"#c03020", "#203040", "#e0c040"}) finder.request({.colour = *ink::colour_of_hex(hex)});
    EXPECT_TRUE(finder.busy());
    EXPECT_EQ(ink::to_hex(wait_for(finder).wanted), "#e0c040");
    EXPECT_FALSE(finder.busy());
    EXPECT_FALSE(finder.poll());
}

TEST(MixFinder, ASubstrateOfAProjectsOwnIsTakenAsPorcelain) {
    MixFinder finder;
    finder.request({.colour = *ink::colour_of_hex("#603010"), .substrate = "of-nobody"});
    EXPECT_LT(wait_for(finder).delta_e, 1);
}

class OwnInks : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("tuft_colours_" + std::to_string(getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        setenv("XDG_STATE_HOME", folder_.c_str(), 1);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(OwnInks, AndRecentColoursAreThereTheNextTime) {
    ColourChoice first;
    ink::Ink own =
        ink::match_colour(*ink::colour_of_hex("#603010"), ink::shipped_pigments(), ink::load_substrate("porcelain"))
            .ink;
    own.name = "bark / 树皮";
    save_own_ink(first, own);
    remember_colour(first, "#603010");
    remember_colour(first, "#102030");
    remember_colour(first, "#603010");
    ColourChoice next;
    load_colours(next);
    EXPECT_EQ(next.recent, (std::vector<std::string>{"#603010", "#102030"}));
    ASSERT_EQ(next.saved.size(), 1u);
    EXPECT_EQ(next.saved[0].name, own.name);
    EXPECT_EQ(next.saved[0].parts.size(), own.parts.size());
    forget_own_ink(next, own.name);
    ColourChoice last;
    load_colours(last);
    EXPECT_TRUE(last.saved.empty());
}

TEST_F(OwnInks, ThatCannotBeReadAreLeftOut) {
    ColourChoice choice;
    save_own_ink(choice, ink::load_ink("carbon"));
    std::ofstream(folder_ / "tuft" / "inks" / "broken.toml") << "film = 'thick'";
    std::ofstream(folder_ / "tuft" / "colours") << "#12\nred\n#abcdef\n";
    ColourChoice next;
    load_colours(next);
    EXPECT_EQ(next.saved.size(), 1u);
    EXPECT_EQ(next.recent, std::vector<std::string>{"#abcdef"});
}

Box box(double x, double y, double z) {
    return {Vec3(0), Vec3(x, y, z)};
}

// The line of the first brush, metres.
double first_line(const Box& of) {
    const std::string name = first_brush(brush::list_presets(), "wolf-medium", 0.45, first_line_width(of));
    const brush::Preset preset = brush::load_preset(name);
    const double depth = 0.45 * stroke::working_depth(preset);
    return brush::sweep_depth(preset, std::span(&depth, 1)).front().width;
}

TEST(FirstBrush, DrawsALineInTheSizeOfTheModel) {
    // From a 20 mm ring to a car of 1.2 m: within half as much again of 2 % of the diagonal.
    for (const Box& b : {box(0.02, 0.02, 0.004), box(0.06, 0.05, 0.04), box(0.15, 0.15, 0.07), box(0.2, 0.2, 0.001),
                         box(1.16, 0.54, 0.33)}) {
        const double wanted = 0.02 * b.diagonal();
        EXPECT_LT(first_line(b), 1.6 * wanted) << b.diagonal();
        EXPECT_GT(first_line(b), wanted / 1.6) << b.diagonal();
    }
    // A real car takes the largest size there is; its line is no hairline where 5.1 m lie on 700 pixels.
    const Box car = box(4.6, 1.8, 1.4);
    EXPECT_EQ(brush::sized_name(first_brush(brush::list_presets(), "wolf-medium", 0.45, first_line_width(car))).factor,
              brush::kMostSize);
    EXPECT_GT(first_line(car), 3 * 5.1 / 700) << "three pixels";
    // A thin rod is not painted round.
    EXPECT_LT(first_line(box(1, 0.01, 0.01)), 0.005);
}

TEST(FirstBrush, OfASampleInBrushSizeIsNotScaled) {
    const std::string name =
        first_brush(brush::list_presets(), "wolf-medium", 0.45, first_line_width(box(0.151, 0.151, 0.067)));
    EXPECT_EQ(name.find('*'), std::string::npos) << name;
    EXPECT_TRUE(name.starts_with("wolf-")) << name;
}

TEST(Thumbnails, ShowEachLayerAlone) {
    const stroke::Model model = test::shipped_model("sheet.ply", 256);
    stroke::Document painting(model);
    painting.paint(stroke::add_on_top(painting.layers().table(), "gold"));
    const std::uint32_t gold = painting.layers().table().layers.back().id;
    Orbit orbit;
    orbit.look_from(StandardView::top);
    orbit.frame(model.mesh->bounds);
    Thumbnails thumbnails;
    EXPECT_FALSE(thumbnails.waiting(painting)) << "nobody looks yet";
    thumbnails.look_from(model, orbit.camera(48, 36, model.mesh->bounds));
    EXPECT_EQ(thumbnails.draw(painting).size(), 2u);
    EXPECT_FALSE(thumbnails.waiting(painting));
    painting.appearance().take_dirty();
    const brush::Preset preset = brush::load_preset("goat-large");
    stroke::PaintStroke s;
    s.trace.flat = false;
    s.brush = "goat-large";
    s.ink = "carbon";
    s.layer = gold;
    painting.begin(s);
    painting.extend(test::poses_above(model, preset, 0.1));
    painting.end();
    thumbnails.touch(painting.appearance().take_dirty());
    ASSERT_TRUE(thumbnails.waiting(painting));
    const std::vector<Thumbnail> changed = thumbnails.draw(painting);
    const auto darkest = [&](std::uint32_t layer) {
        int least = 255;
        for (const Thumbnail& t : changed)
            if (t.layer == layer)
                for (std::size_t i = 0; i < t.rgba.size(); i += 4)
                    if (t.rgba[i + 3]) least = std::min<int>(least, t.rgba[i]);
        return least;
    };
    EXPECT_LT(darkest(gold), 80) << "ink";
    EXPECT_GT(darkest(stroke::kFirstLayer), 150) << "the bare sheet";
}

}  // namespace
}  // namespace tuft::app
