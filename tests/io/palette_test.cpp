#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "core/error.h"
#include "io/project/project.h"
#include "io/project/restore.h"
#include "io/strokes/inkml.h"
#include "stroke/document/pick.h"

namespace tuft::io {
namespace {

// A pool of each ink, and a stroke through both of them.
std::vector<stroke::JournalEntry> mixing() {
    std::vector<stroke::JournalEntry> entries;
    for (const auto& [ink, x] : {std::pair{"cinnabar", -0.006}, std::pair{"gamboge", 0.006}}) {
        entries.emplace_back(stroke::Fill{.ink = ink,
                                          .layer = stroke::kPaletteLayer,
                                          .film = 50,
                                          .gradient = stroke::Gradient::round,
                                          .to_film = 0,
                                          .from = {x, 0, 0},
                                          .to = {x + 0.006, 0, 0}});
    }
    stroke::PaintStroke s;
    s.brush = "wolf-small";
    s.ink = "cinnabar";
    s.layer = stroke::kPaletteLayer;
    s.settings.spacing = 4;
    for (int i = 0; i <= 20; ++i)
        s.trace.samples.push_back({.time = 0.02 * i, .position = {-0.01 + 0.001 * i, 0, 0}, .pressure = 0.6});
    entries.emplace_back(s);
    return entries;
}

TEST(Palette, ComesBackFromAProjectWithoutAReplay) {
    const stroke::Model model = stroke::make_palette();  // any model will do
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / ("tuft_palette_" + std::to_string(getpid()) + ".tuft");
    stroke::Document painting(model);
    for (const stroke::JournalEntry& s : mixing()) painting.paint(s);
    const std::uint64_t last = painting.journal().entries().back().id;
    {
        ProjectModel stored;
        stored.mesh = *model.mesh;
        stored.atlas = model.atlas;
        stored.substrate = ink::substrate_toml(painting.materials().substrate());
        Project project = Project::create(file, stored);
        project.append(painting.journal().entries());
        EXPECT_EQ(project.format(), 4) << "programs without a palette would paint on the model";
        project.save_canvases(stroke::all_canvases(painting), last);
    }
    const Project project = Project::open(file);
    EXPECT_EQ(stroke::layer_of(project.strokes()[0]), stroke::kPaletteLayer);
    stroke::Document back(model);
    restore_strokes(project, back, [](std::string_view phase, double) {
        ADD_FAILURE() << "a replay: " << phase;
        return true;
    });
    ASSERT_NE(back.palette().canvas(), nullptr);
    EXPECT_EQ(back.palette().canvas()->hash(), painting.palette().canvas()->hash());
    EXPECT_EQ(back.layers().hash(), painting.layers().hash());
    // The eyedropper there: both pigments in the pool that was crossed second.
    const stroke::Pick pick = stroke::pick_on_palette(back, {0.006, 0, 0});
    EXPECT_GT(pick.amounts[0], 0);
    EXPECT_GT(pick.amounts[1], 0);
    ASSERT_EQ(pick.films.size(), 1u);
    EXPECT_EQ(pick.films[0].layer, stroke::kPaletteLayer);
    std::filesystem::remove(file);
}

TEST(Palette, IsOneMoreThanTheMostLayers) {
    const stroke::Model model = stroke::make_palette();
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / ("tuft_palette_layers_" + std::to_string(getpid()) + ".tuft");
    stroke::Document painting(model);
    painting.paint(mixing()[0]);
    const stroke::LayerTexels palette = stroke::all_canvases(painting).back();
    ASSERT_EQ(palette.layer, stroke::kPaletteLayer);
    std::vector<stroke::LayerTexels> all;
    for (std::uint32_t i = 0; i < stroke::kMaxLayers; ++i) all.push_back({stroke::kFirstLayer + i, palette.canvas});
    const auto stored = [&](const std::vector<stroke::LayerTexels>& canvases) {
        ProjectModel kept;
        kept.mesh = *model.mesh;
        kept.atlas = model.atlas;
        kept.substrate = ink::substrate_toml(painting.materials().substrate());
        Project project = Project::create(file, kept);
        project.append(painting.journal().entries());
        project.save_canvases(canvases, painting.journal().entries().back().id);
        return project.load_canvases(model.texels.n_slots())->layers.size();
    };
    all.push_back(palette);
    EXPECT_EQ(stored(all), stroke::kMaxLayers + 1);
    all.insert(all.end() - 1, {static_cast<std::uint32_t>(stroke::kFirstLayer + stroke::kMaxLayers), palette.canvas});
    EXPECT_THROW(stored(all), Error);
    std::filesystem::remove(file);
}

TEST(Palette, StrokeFilesSayWhatBelongsOnIt) {
    std::vector<stroke::RecordedStroke> traces(2);
    for (stroke::RecordedStroke& t : traces)
        t.samples = {{.position = {0, 0, 0}, .pressure = 0.5},
                     {.time = 0.5, .position = {0.01, 0, 0}, .pressure = 0.5}};
    traces[1].on_palette = true;
    const std::vector<stroke::RecordedStroke> read = parse_inkml(inkml_text(traces), "test");
    ASSERT_EQ(read.size(), 2u);
    EXPECT_FALSE(read[0].on_palette);
    EXPECT_TRUE(read[1].on_palette);
}

}  // namespace
}  // namespace tuft::io
