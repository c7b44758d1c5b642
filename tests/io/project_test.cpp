#include "io/project/project.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <set>

#include "core/error.h"
#include "core/files/files.h"
#include "io/project/packing.h"
#include "sample_project.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/entry/fill.h"
#include "stroke/journal/entry/parts.h"

namespace tuft::io {
namespace {

namespace fs = std::filesystem;

using namespace testing;

/// Equal to the bit, also the sign of zero.
void expect_equal(const stroke::JournalEntry& a, const stroke::JournalEntry& b) {
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.hidden, b.hidden);
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(stroke::brush_of(a), stroke::brush_of(b));
    EXPECT_EQ(stroke::ink_of(a), stroke::ink_of(b));
    EXPECT_EQ(stroke::seed_of(a), stroke::seed_of(b));
    EXPECT_EQ(stroke::entry_json(a), stroke::entry_json(b));
    const stroke::StrokeSamples &s = stroke::samples_of(a), &t = stroke::samples_of(b);
    EXPECT_EQ(s.flat, t.flat);
    EXPECT_EQ(s.placement.mapping, t.placement.mapping);
    EXPECT_EQ(std::memcmp(&s.placement.origin, &t.placement.origin, 9 * sizeof(double)), 0);
    ASSERT_EQ(s.samples.size(), t.samples.size());
    for (std::size_t i = 0; i < s.samples.size(); ++i) {
        const stroke::StrokeSample &p = s.samples[i], &q = t.samples[i];
        EXPECT_EQ(p.time, q.time);
        EXPECT_EQ(p.position, q.position);
        EXPECT_EQ(p.pressure, q.pressure);
        EXPECT_EQ(p.tilt, q.tilt);
        EXPECT_EQ(p.roll, q.roll);
        EXPECT_EQ(p.rotation, q.rotation);
    }
}

TEST(Packing, EveryBitComesBack) {
    for (const std::size_t element : {std::size_t{1}, std::size_t{4}, std::size_t{8}})
        for (const std::size_t lag : {std::size_t{1}, std::size_t{3}})
            for (const std::size_t count :
                 {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{1000}, (std::size_t{1} << 18) + 3}) {
                std::vector<unsigned char> data(count * element), back(count * element);
                for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<unsigned char>(hash_bits(1, i));
                const Packing packing{.element = element, .lag = lag};
                const std::vector<char> blob = pack(data.data(), count, packing);
                unpack(blob.data(), blob.size(), back.data(), count, packing, "x");
                EXPECT_EQ(back, data);
                EXPECT_THROW(unpack(blob.data(), blob.size(), back.data(), count + 1, packing, "x"), Error);
            }
}

TEST(Packing, SmoothColumnsShrink) {
    std::vector<double> times;
    for (int i = 0; i < 2000; ++i) times.push_back(0.005 * i);
    const Packing packing{.element = 8};
    EXPECT_LT(pack(times.data(), times.size(), packing).size(), times.size() * 8 / 2);
}

TEST(Project, ModelAndAtlasComeBackToTheBit) {
    const Folder folder("project_model");
    const ProjectModel model = sample_model();
    const std::uint64_t hash = Project::create(folder / "a.tuft", model).model_hash();
    const Project project = Project::open(folder / "a.tuft", {.access = Access::read});
    EXPECT_EQ(project.model_hash(), hash);
    EXPECT_EQ(project.format(), kFirstFormat);
    EXPECT_EQ(project.written_by().substr(0, 5), "tuft ");
    const ProjectModel back = project.model();
    EXPECT_EQ(back.source, model.source);
    EXPECT_EQ(back.frame.unit, model.frame.unit);
    EXPECT_EQ(back.frame.y_up, model.frame.y_up);
    EXPECT_EQ(back.frame.unit_overrides, model.frame.unit_overrides);
    EXPECT_EQ(back.substrate, model.substrate);
    EXPECT_EQ(back.mesh.positions, model.mesh.positions);
    EXPECT_EQ(back.mesh.triangles, model.mesh.triangles);
    EXPECT_EQ(back.mesh.corner_normals, model.mesh.corner_normals);
    EXPECT_EQ(back.mesh.neighbours, model.mesh.neighbours);
    EXPECT_EQ(back.mesh.corner_uvs, model.mesh.corner_uvs);
    EXPECT_EQ(back.mesh.vertex_colours, model.mesh.vertex_colours);
    EXPECT_EQ(back.mesh.triangle_groups, model.mesh.triangle_groups);
    EXPECT_EQ(back.mesh.group_names, model.mesh.group_names);
    EXPECT_EQ(back.mesh.bounds.lo, model.mesh.bounds.lo);
    EXPECT_EQ(back.atlas.corner_uvs, model.atlas.corner_uvs);
    EXPECT_EQ(back.atlas.triangle_chart, model.atlas.triangle_chart);
    EXPECT_EQ(back.atlas.size, model.atlas.size);
    EXPECT_EQ(back.atlas.texel_size, model.atlas.texel_size);
    EXPECT_EQ(folder.n_files(), 1u) << "a project is one file";
}

TEST(Project, PagesOfTheAtlasComeBack) {
    const Folder folder("project_pages");
    ProjectModel model = sample_model();
    EXPECT_EQ(model.atlas.pages, 1u);
    model.atlas.pages = 3;
    model.atlas.size = 2 * 64;
    for (Vec2f& uv : model.atlas.corner_uvs) uv *= 0.5f;  // all on the first page
    Project::create(folder / "a.tuft", model);
    EXPECT_EQ(Project::open(folder / "a.tuft").model().atlas.pages, 3u);
    EXPECT_TRUE(Project::open(folder / "a.tuft").model().atlas.udims.empty());
    model.atlas.udims = {1001, 1010, 1033};
    Project::create(folder / "c.tuft", model);
    EXPECT_EQ(Project::open(folder / "c.tuft").model().atlas.udims, model.atlas.udims);
    model.atlas.udims = {1001, 1010, 2001};
    Project::create(folder / "d.tuft", model);
    EXPECT_THROW(Project::open(folder / "d.tuft").model(), Error);
    model.atlas.udims.clear();
    model.atlas.size = 2 * 64 + 1;  // no whole page
    Project::create(folder / "b.tuft", model);
    EXPECT_THROW(Project::open(folder / "b.tuft").model(), Error);
}

TEST(Project, AnAtlasThatCannotBePaintedOnIsRefusedInOneLine) {
    const Folder folder("project_uvs");
    const auto fault = [&](auto damage) {
        ProjectModel model = sample_model();
        damage(model.atlas);
        Project::create(folder / "a.tuft", model);
        try {
            Project::open(folder / "a.tuft").model();
        } catch (const Error& e) {
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
            return std::string(e.what());
        }
        return std::string();
    };
    using atlas::Atlas;
    EXPECT_EQ(fault([](Atlas&) {}), "");
    const auto says = [&](const char* what, auto damage) {
        const std::string line = fault(damage);
        EXPECT_NE(line.find(what), std::string::npos) << line;
    };
    says("not finite", [](Atlas& a) { a.corner_uvs[7].x = NAN; });
    says("off the page", [](Atlas& a) { a.corner_uvs[7].y = 1e9f; });
    says("off the page", [](Atlas& a) { a.corner_uvs[0].x = -0.01f; });
    says("mirrored", [](Atlas& a) { std::swap(a.corner_uvs[3], a.corner_uvs[4]); });
    says("overlap", [](Atlas& a) {  // the second row of triangles over the first
        const std::size_t row = 6 * testing::kAround;
        std::copy_n(a.corner_uvs.begin(), row, a.corner_uvs.begin() + row);
    });
    says("room", [](Atlas& a) { std::fill(a.corner_uvs.begin(), a.corner_uvs.end(), Vec2f(0.5f)); });
    says("no page", [](Atlas& a) {
        a.pages = 3;
        a.size = 2 * 64;
    });
}

TEST(Project, StrokesComeBackToTheBitInOrder) {
    const Folder folder("project_strokes");
    std::vector<stroke::JournalEntry> strokes;
    for (const std::uint64_t id : {3, 1, 2, 10, 5}) strokes.push_back(sample_stroke(id));
    strokes.push_back(sample_stroke(11, 0));
    ASSERT_TRUE(strokes[3].get<stroke::PaintStroke>().trace.flat);
    strokes[3].get<stroke::PaintStroke>().trace.placement.mapping = stroke::SurfaceMapping::drape;
    {
        Project project = Project::create(folder / "a.tuft", sample_model());
        project.append(std::span(strokes).first(4));
        project.append(strokes[4]);
        project.append(strokes[5]);
        EXPECT_THROW(project.append(strokes[0]), Error) << "ids are unique";
    }
    Project project = Project::open(folder / "a.tuft");
    EXPECT_EQ(project.format(), kDrapedFormat) << "older programs do not know draped strokes";
    ASSERT_EQ(project.n_strokes(), strokes.size());
    const auto back = project.strokes();
    for (std::size_t i = 0; i < strokes.size(); ++i) expect_equal(back[i], strokes[i]);
    project.set_hidden(2, true);
    project.remove(1);
    EXPECT_THROW(project.remove(1), Error);
    EXPECT_THROW(project.set_hidden(99, true), Error);
    const auto changed = project.strokes();
    ASSERT_EQ(changed.size(), strokes.size() - 1);
    EXPECT_TRUE(changed[1].hidden);
    stroke::JournalEntry bad = sample_stroke(50);
    bad.get<stroke::PaintStroke>().trace.samples[3].position.y = NAN;
    EXPECT_THROW(project.append(bad), Error);
    EXPECT_EQ(project.n_strokes(), changed.size());
}

TEST(Project, RollsComeBackToTheBitAndRaiseTheFormat) {
    const Folder folder("project_rolls");
    stroke::JournalEntry plain = sample_stroke(1), rolled = sample_stroke(10), follows = sample_stroke(12);
    for (std::size_t i = 0; auto& s : rolled.get<stroke::PaintStroke>().trace.samples) s.roll = std::sin(double(i++));
    follows.get<stroke::PaintStroke>().settings.roll_follow = true;
    follows.get<stroke::PaintStroke>().settings.roll = 1.0 / 3;
    Project project = Project::create(folder / "a.tuft", sample_model());
    project.append(plain);
    EXPECT_LT(project.format(), kRolledFormat) << "older programs read what they understand";
    project.append(rolled);
    EXPECT_EQ(project.format(), kRolledFormat);
    project.append(follows);
    const auto back = Project::open(folder / "a.tuft", {.access = Access::read}).strokes();
    expect_equal(back[0], plain);
    expect_equal(back[1], rolled);
    expect_equal(back[2], follows);
    EXPECT_EQ(back[2].as<stroke::PaintStroke>()->settings, follows.as<stroke::PaintStroke>()->settings);
    Project settings = Project::create(folder / "b.tuft", sample_model());
    settings.append(follows);
    EXPECT_EQ(settings.format(), kRolledFormat);
}

TEST(Project, WhatAnAreaReachesUnderComesBackAndRaisesTheFormat) {
    const Folder folder("project_under");
    stroke::FlatArea area{.rings = {{{0, 0}, {0.01, 0}, {0.01, 0.01}}}, .placement = {}, .stops = {{.ink = "carbon"}}};
    Project project = Project::create(folder / "a.tuft", sample_model());
    stroke::JournalEntry plain{stroke::fill_of_area(area)};
    plain.id = 1;
    project.append(plain);
    EXPECT_LT(project.format(), kUnderFormat) << "older programs read what they understand";
    area.under = {{{0.01, 0}, {0.012, 0}, {0.01, 0.01}}};
    stroke::JournalEntry reaching{stroke::fill_of_area(area)};
    reaching.id = 2;
    project.append(reaching);
    EXPECT_EQ(project.format(), kUnderFormat);
    const auto back = Project::open(folder / "a.tuft", {.access = Access::read}).strokes();
    EXPECT_EQ(back[1].as<stroke::Fill>()->area->under, area.under);
}

TEST(Project, StoredTexelsAreForgottenWhenAStrokeUnderThemChanges) {
    const Folder folder("project_forgotten");
    ink::Canvas canvas(20);
    canvas.add_pigment(ink::load_ink("carbon").parts[0].pigment);
    canvas.touch(4, 0)[7] = 1;
    const auto fresh = [&] {
        std::filesystem::remove(folder / "a.tuft");
        Project project = Project::create(folder / "a.tuft", sample_model());
        for (const int id : {1, 2, 3, 4}) project.append(sample_stroke(static_cast<std::uint64_t>(id)));
        project.save_canvas(canvas, 3);
        return project;
    };
    {
        Project project = fresh();
        project.set_hidden(4, true);
        EXPECT_TRUE(project.load_canvas(20)) << "it came after them";
        project.remove(4);
        EXPECT_TRUE(project.load_canvas(20));
        project.set_hidden(3, true);
        EXPECT_FALSE(project.load_canvas(20));
        project.save_canvas(canvas, 3);
        EXPECT_TRUE(project.load_canvas(20));
    }
    Project project = fresh();
    project.remove(1);
    EXPECT_FALSE(project.load_canvas(20));
}

TEST(Project, FilmsAndLiquidComeBackWithTheTiles) {
    const Folder folder("project_films");
    ink::Canvas canvas(20);
    canvas.add_pigment(ink::load_ink("carbon").parts[0].pigment);
    canvas.add_pigment(ink::load_ink("cinnabar").parts[0].pigment);
    for (int t = 0; t < atlas::kTileTexels; ++t) {
        canvas.touch(4, 0)[t] = static_cast<float>(t);
        canvas.touch_film(4, ink::kSoakedFilm, 1)[t] = 0.5f * static_cast<float>(t);
        canvas.touch_film(9, ink::kFirstDryFilm, 0)[t] = 0.25f;
        canvas.touch_liquid(9, ink::Liquid::film)[t] = 2;
    }
    Project project = Project::create(folder / "a.tuft", sample_model());
    project.save_canvas(canvas, 3);
    EXPECT_EQ(project.format(), kFilmsFormat) << "older programs do not know films";
    auto saved = project.load_canvas(20);
    ASSERT_TRUE(saved);
    EXPECT_TRUE(saved->canvas.same_contents(canvas));
    canvas.restore({.slot = 9});
    project.save_canvas(canvas, 4);  // in place of the tiles before
    saved = Project::open(folder / "a.tuft").load_canvas(20);
    ASSERT_TRUE(saved);
    EXPECT_TRUE(saved->canvas.same_contents(canvas));
}

TEST(Project, PartsComeBackAndOlderProgramsDoNotReadThem) {
    const Folder folder("project_parts");
    Project project = Project::create(folder / "a.tuft", sample_model());
    EXPECT_LT(project.format(), kPartsFormat) << "older programs read what they understand";
    stroke::PartEdit edit;
    edit.parts = {{.name = "窗", .hidden = true},
                  {.name = "body", .locked = true, .substrate = ink::load_substrate("glass")}};
    project.append(stroke::entry_after({}, edit));
    EXPECT_EQ(project.format(), kPartsFormat);
    const std::vector<stroke::JournalEntry> read = Project::open(folder / "a.tuft").strokes();
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read[0].get<stroke::PartEdit>(), edit);
    ProjectModel model = sample_model();
    model.substrate = ink::substrate_toml(ink::load_substrate("glass"));
    EXPECT_EQ(Project::create(folder / "b.tuft", model).format(), kPartsFormat)
        << "older programs do not know the key of its transmission";
}

TEST(Project, LayersComeBackWithTheirTiles) {
    const Folder folder("project_layers");
    ink::Canvas first(20), gold(20), empty(20);
    const ink::Pigment carbon = ink::load_ink("carbon").parts[0].pigment;
    first.add_pigment(carbon);
    first.add_pigment(ink::load_ink("cinnabar").parts[0].pigment);
    gold.add_pigment(carbon);  // has met no cinnabar yet
    first.touch(4, 1).fill(0.5f);
    gold.touch(4, 0).fill(2);
    gold.touch_film(5, ink::kFirstDryFilm, 0).fill(0.25f);
    gold.touch_liquid(5, ink::Liquid::film).fill(1);
    Project project = Project::create(folder / "a.tuft", sample_model());
    // In any order; 3 is empty, 2 lies lowest.
    const std::vector<stroke::LayerTexels> all{{2, &gold}, {1, &first}, {3, &empty}};
    project.save_canvases(all, 7);
    EXPECT_EQ(project.format(), kLayersFormat) << "older programs do not know layers";
    auto saved = Project::open(folder / "a.tuft").load_canvases(20);
    ASSERT_TRUE(saved);
    EXPECT_EQ(saved->stroke_id, 7u);
    ASSERT_EQ(saved->layers.size(), 2u);
    EXPECT_EQ(saved->layers[1].layer, 2u);
    EXPECT_TRUE(saved->layers[0].canvas.same_contents(first));
    gold.add_pigment(first.pigments()[1]);  // all know all, when they come back
    EXPECT_TRUE(saved->layers[1].canvas.same_contents(gold));
    // The first layer can go, and all but it.
    project.save_canvases(std::span(all).first(1), 8);
    saved = project.load_canvases(20);
    ASSERT_TRUE(saved);
    EXPECT_TRUE(saved->layers[0].canvas.touched_slots().empty());
    project.save_canvas(first, 9);
    saved = project.load_canvases(20);
    ASSERT_TRUE(saved);
    EXPECT_EQ(saved->layers.size(), 1u);
    EXPECT_TRUE(saved->layers[0].canvas.same_contents(first));

    const stroke::LayerEdit edit = stroke::add_on_top({}, "gold & 金");
    stroke::JournalEntry entry(edit);
    entry.id = 10;
    stroke::JournalEntry on_it(stroke::PaintStroke{.trace = {.samples = {{}}}, .layer = 2});
    on_it.id = 11;
    project.append(std::vector{entry, on_it});
    const std::vector<stroke::JournalEntry> back = project.strokes();
    ASSERT_EQ(back.size(), 2u);
    EXPECT_EQ(back[0].get<stroke::LayerEdit>(), edit);
    EXPECT_EQ(stroke::layer_of(back[1]), 2u);
}

TEST(Project, EntriesOfEveryKindComeBack) {
    const Folder folder("project_kinds");
    std::vector<stroke::JournalEntry> entries{sample_stroke(1)};
    stroke::PaintStroke& stroke = entries[0].get<stroke::PaintStroke>();
    stroke.settings.dip = stroke::DipMode::persistent;
    stroke.settings.stabilise = 1.0 / 3;
    stroke.settings.pressure = stroke::PressureFrom::speed;
    for (const stroke::BrushChange& what :
         {stroke::BrushChange(stroke::Rinse{}), stroke::BrushChange(stroke::Dip{.time = 1.0 / 3}),
          stroke::BrushChange(stroke::Reshape{}),
          stroke::BrushChange(stroke::Wipe{.depth = 1.0 / 3, .amount = 0.1, .side = -0.25})})
        entries.emplace_back(stroke::BrushAction{.what = what,
                                                 .brush = "wolf-small",
                                                 .ink = "cinnabar",
                                                 .seed = 5,
                                                 .dip = stroke::DipMode::persistent,
                                                 .spine = brush::SpineMethod::table});
    entries.emplace_back(stroke::Dry{.seconds = 1.0 / 3, .down = {0, 1.0 / 3, 0}});
    entries.emplace_back(stroke::WashPalette{});
    entries.emplace_back(stroke::Fill{.ink = "indigo", .layer = 2, .mask = 3, .film = 1.0 / 3});
    entries.emplace_back(stroke::add_on_top({}, "gold"), "gold");
    entries.emplace_back(stroke::MaskEdit{.mask = {.id = 1, .name = "cap", .kind = stroke::MaskKind::angle}});
    stroke::PaintStroke eraser{.tool = stroke::Tool::eraser, .layer = stroke::kPaletteLayer, .mask = 1};
    entries.emplace_back(eraser);
    entries.emplace_back(stroke::locked_parts({}, {"Window"}, true));
    for (std::size_t i = 0; i < entries.size(); ++i) entries[i].id = i + 1;
    {
        Project project = Project::create(folder / "a.tuft", sample_model());
        project.append(entries);
    }
    const auto back = Project::open(folder / "a.tuft").strokes();
    ASSERT_EQ(back.size(), entries.size());
    std::set<std::size_t> kinds;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        expect_equal(back[i], entries[i]);
        EXPECT_EQ(stroke::kind_of(back[i]), stroke::kind_of(entries[i]));
        kinds.insert(back[i].content.index());
    }
    EXPECT_EQ(kinds.size(), std::variant_size_v<stroke::EntryContent>) << "a kind without an entry here";
    EXPECT_EQ(back[0].get<stroke::PaintStroke>().settings, entries[0].get<stroke::PaintStroke>().settings);
    for (int i = 1; i <= 4; ++i)
        EXPECT_EQ(back[i].get<stroke::BrushAction>().what, entries[i].get<stroke::BrushAction>().what);
    EXPECT_EQ(back[5].get<stroke::Dry>().down, entries[5].get<stroke::Dry>().down);
    EXPECT_EQ(back[7].get<stroke::Fill>(), entries[7].get<stroke::Fill>());
    EXPECT_EQ(back[8].get<stroke::LayerEdit>(), entries[8].get<stroke::LayerEdit>());
    EXPECT_EQ(back[9].get<stroke::MaskEdit>(), entries[9].get<stroke::MaskEdit>());
    EXPECT_TRUE(back[10].get<stroke::PaintStroke>().erases());
    EXPECT_EQ(back[11].get<stroke::PartEdit>(), entries[11].get<stroke::PartEdit>());
}

TEST(Project, PresetsAreReplacedByName) {
    const Folder folder("project_presets");
    Project project = Project::create(folder / "a.tuft", sample_model());
    project.put_brush({"wolf", "a = 1"});
    project.put_brush({"goat", "b = 2"});
    project.put_brush({"wolf", "a = 3"});
    project.put_ink({"carbon", "c = 4"});
    EXPECT_EQ(project.brushes(), (std::vector<PresetText>{{"goat", "b = 2"}, {"wolf", "a = 3"}}));
    EXPECT_EQ(project.inks(), (std::vector<PresetText>{{"carbon", "c = 4"}}));
    project.put_substrate("x = 1");
    EXPECT_EQ(project.model().substrate, "x = 1");
}

TEST(Project, PaintedTilesComeBackToTheBit) {
    const Folder folder("project_tiles");
    ink::Canvas canvas(500);
    for (const char* name : {"carbon", "cinnabar"}) canvas.add_pigment(ink::load_ink(name).parts[0].pigment);
    for (std::uint32_t slot = 7; slot < 400; slot += 3)
        for (int t = 0; t < atlas::kTileTexels; ++t)
            canvas.touch(slot, slot % 2)[t] = static_cast<float>(uniform(slot, t));
    {
        Project project = Project::create(folder / "a.tuft", sample_model());
        EXPECT_FALSE(project.load_canvas(500)) << "nothing stored yet";
        project.save_canvas(ink::Canvas(500), 1);
        project.save_canvas(canvas, 42);
    }
    const Project project = Project::open(folder / "a.tuft");
    const auto saved = project.load_canvas(500);
    ASSERT_TRUE(saved);
    EXPECT_EQ(saved->stroke_id, 42u);
    EXPECT_TRUE(saved->canvas.same_contents(canvas));
    EXPECT_EQ(saved->canvas.pigments()[1].k, canvas.pigments()[1].k);
    EXPECT_FALSE(project.load_canvas(501)) << "another texel map";
}

TEST(Project, AKillLosesAtMostTheStrokeInHand) {
    const Folder folder("project_kill");
    const std::vector<stroke::JournalEntry> strokes{sample_stroke(1, 400), sample_stroke(2, 400)};
    for (int round = 0; round < 5; ++round) {
        Project::create(folder / "a.tuft", sample_model());
        int pipe_ends[2];
        ASSERT_EQ(::pipe(pipe_ends), 0);
        const pid_t child = ::fork();
        ASSERT_GE(child, 0);
        if (child == 0) {
            // Only what has been committed is reported; no clean-up ever runs here.
            Project project = Project::open(folder / "a.tuft");
            for (std::uint64_t id = 1;; ++id) {
                stroke::JournalEntry stroke = strokes[id % 2];
                stroke.id = id;
                project.append(stroke);
                if (::write(pipe_ends[1], &id, sizeof id) != sizeof id) _exit(1);
            }
        }
        std::uint64_t finished = 0;
        for (int i = 0; i < 5 + 3 * round; ++i) ASSERT_EQ(::read(pipe_ends[0], &finished, sizeof finished), 8);
        ASSERT_EQ(::kill(child, SIGKILL), 0);
        ASSERT_EQ(::waitpid(child, nullptr, 0), child);
        ::close(pipe_ends[1]);
        while (::read(pipe_ends[0], &finished, sizeof finished) == sizeof finished) {
        }
        ::close(pipe_ends[0]);
        {
            Project project = Project::open(folder / "a.tuft");
            const auto back = project.strokes();
            ASSERT_GE(back.size(), finished);
            ASSERT_LE(back.size(), finished + 1);
            for (std::size_t i = 0; i < back.size(); ++i) {
                stroke::JournalEntry wanted = strokes[(i + 1) % 2];
                wanted.id = i + 1;
                expect_equal(back[i], wanted);
            }
            project.append(sample_stroke(100000));
        }
        EXPECT_EQ(folder.n_files(), 1u) << "one file again after the recovery";
    }
}

TEST(Project, MakingAProjectAnewIgnoresTheOldJournal) {
    const Folder folder("project_anew");
    Project::create(folder / "a.tuft", sample_model()).append(sample_stroke(1));
    const std::string junk(5000, 'j');
    write_file(folder / "a.tuft-journal", junk.data(), junk.size());
    Project::create(folder / "a.tuft", sample_model());
    EXPECT_EQ(Project::open(folder / "a.tuft").n_strokes(), 0u);
    EXPECT_EQ(folder.n_files(), 1u);
}

}  // namespace
}  // namespace tuft::io
