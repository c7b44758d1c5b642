#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "core/files/files.h"
#include "io/project/packing.h"
#include "io/project/project.h"
#include "sample_model.h"

/// Projects that somebody made to do harm: each is refused in one line, before it costs time or
/// memory.
namespace tuft::io {
namespace {

namespace fs = std::filesystem;
using namespace testing;

class HostileProject : public ::testing::Test {
  protected:
    HostileProject() : folder_("project_hostile"), good_(folder_ / "good.tuft"), path_(folder_ / "bad.tuft") {
        ProjectModel model;
        model.source = "bowl.ply";
        model.mesh = cylinder();
        model.atlas = cylinder_atlas(model.mesh);
        model.substrate = ink::substrate_toml(ink::load_substrate("porcelain"));
        Project project = Project::create(good_, model);
        project.put_brush({"wolf", "name"});
        for (std::uint64_t id = 1; id < 4; ++id) {
            stroke::PaintStroke s;
            s.brush = "wolf";
            s.ink = "carbon";
            s.trace.samples.resize(200);
            stroke::JournalEntry entry(std::move(s));
            entry.id = id;
            project.append(entry);
        }
        ink::Canvas canvas(500);
        canvas.add_pigment(ink::load_ink("carbon").parts[0].pigment);
        for (std::uint32_t slot = 0; slot < 20; ++slot) canvas.touch(slot, 0).fill(0.5f);
        project.save_canvas(canvas, 3);
    }

    // What is said of the good project after `harm` was done to it.
    std::string said_after(const std::function<void(SQLite::Database&)>& harm) {
        fs::copy_file(good_, path_, fs::copy_options::overwrite_existing);
        {
            SQLite::Database db(path_.string(), SQLite::OPEN_READWRITE);
            db.exec("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF;");
            harm(db);
        }
        return said();
    }
    std::string said_after(const std::string& sql) {
        return said_after([&](SQLite::Database& db) { db.exec(sql); });
    }
    std::string said() {
        try {
            for (const Access access : {Access::read, Access::write}) {
                Project project = Project::open(path_, {.access = access});
                project.model();
                project.strokes();
                project.brushes();
                project.inks();
                project.load_canvases(500);
                if (access == Access::write) project.append(std::span<const stroke::JournalEntry>{});
            }
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
    static void put_blob(SQLite::Database& db, const std::string& sql, const std::vector<char>& blob) {
        SQLite::Statement s(db, sql);
        s.bind(1, blob.empty() ? "" : blob.data(),
               static_cast<int>(blob.size()));  // no bytes are no NULL
        ASSERT_EQ(s.exec(), 1);
    }

    Folder folder_;
    fs::path good_, path_;
};

TEST_F(HostileProject, NothingButTheTablesOfAProjectIsOpened) {
    const std::string endless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) ";
    EXPECT_EQ(said_after("SELECT 1"), "");
    const std::pair<std::string, std::string> harms[] = {
        {"DROP TABLE strokes; CREATE VIEW strokes AS " + endless +
             "SELECT i AS ordinal, i AS id, '' AS brush, '' AS ink, 0 AS seed, '' AS label, '{}' "
             "AS settings, 0 AS hidden, 0 AS flat, 'wrap' AS laying, "
             "zeroblob(72) AS placement, 0 AS sample_count, zeroblob(9) AS samples FROM n",
         "view 'strokes'"},
        {"DROP TABLE presets; CREATE VIEW presets AS " + endless +
             "SELECT 'brush' AS kind, i AS name, hex(zeroblob(1000)) AS toml FROM n",
         "view 'presets'"},
        {"CREATE VIEW more AS " + endless + "SELECT i FROM n", "view 'more'"},
        {"CREATE TRIGGER t AFTER INSERT ON strokes BEGIN DELETE FROM model; END", "trigger 't'"},
        {"CREATE VIRTUAL TABLE v USING rtree(a, b, c)", "table 'v'"},
        {"CREATE TABLE more(a)", "table 'more'"},
        {"CREATE INDEX i ON strokes(hex(label))", "index 'i'"},
        {"DROP TABLE presets; CREATE TABLE presets(kind TEXT NOT NULL, name TEXT NOT NULL, toml "
         "TEXT AS (hex(zeroblob(100000000))), PRIMARY KEY(kind, name))",
         "table 'presets'"},
        {"DROP TABLE tiles; CREATE TABLE tiles(slot INTEGER PRIMARY KEY, planes INTEGER NOT NULL, "
         "amounts BLOB NOT NULL, CHECK(length(hex(zeroblob(slot + 100000000))) > 0))",
         "table 'tiles'"},
        {"ALTER TABLE meta ADD COLUMN more DEFAULT (1)", "table 'meta'"},
    };
    for (const auto& [sql, what] : harms) {
        const std::string text = said_after(sql);
        EXPECT_NE(text.find("it holds the " + what + " as no tuft project does, and is not opened"), std::string::npos)
            << sql << '\n'
            << text;
        EXPECT_EQ(text.find('\n'), std::string::npos);
    }
    EXPECT_NE(said_after("DROP TABLE strokes").find("its table 'strokes' is missing"), std::string::npos);
    EXPECT_NE(said_after("PRAGMA journal_mode = WAL").find("kept in another way"), std::string::npos);
    // White space is all that programs may differ in.
    EXPECT_EQ(said_after("DROP TABLE pigments; CREATE TABLE pigments (plane\n INTEGER  PRIMARY "
                         "KEY,name TEXT NOT NULL , toml TEXT NOT NULL); DELETE FROM tiles"),
              "");
}

TEST_F(HostileProject, SizesThatLieTakeNoMemory) {
    // A frame's head that says 2^40 bytes: magic, single segment with eight bytes of size, then one
    // empty block.
    const std::vector<char> huge{'\x28', '\xb5', '\x2f', '\xfd', '\xe0', 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0};
    const auto frame = [](std::size_t says, std::size_t holds) {
        std::vector<char> zeros(holds), blob(ZSTD_compressBound(holds));
        blob.resize(ZSTD_compress(blob.data(), blob.size(), zeros.data(), holds, 1));
        // Frames of at least 256 and at most 65,791 bytes have two bytes of size after magic and
        // descriptor, less 256.
        if (says != holds)
            blob[5] = static_cast<char>((says - 256) & 0xff), blob[6] = static_cast<char>((says - 256) >> 8);
        return blob;
    };
    const std::size_t samples = 200 * 11 * sizeof(double);
    const std::string of_stroke = "UPDATE strokes SET samples = ? WHERE id = 2",
                      of_tile = "UPDATE tiles SET amounts = ? WHERE slot = 3",
                      of_mesh = "UPDATE arrays SET data = ? WHERE owner = 'mesh' AND name = 'positions'";
    for (const std::string& sql : {of_stroke, of_tile, of_mesh})
        for (const std::vector<char>& blob : {huge, std::vector<char>{}, std::vector<char>(100), frame(300, 300)}) {
            const std::string text = said_after([&](SQLite::Database& db) { put_blob(db, sql, blob); });
            EXPECT_NE(text.find("is damaged"), std::string::npos) << sql << ' ' << blob.size() << ' ' << text;
        }
    for (const std::size_t holds : {samples - 8, samples + 8, 3 * samples}) {
        const std::string text =
            said_after([&](SQLite::Database& db) { put_blob(db, of_stroke, frame(samples, holds)); });
        EXPECT_NE(text.find("stroke 2 is damaged"), std::string::npos) << holds << ' ' << text;
    }
    for (const std::string column : {"vertices", "triangles"})
        for (const std::string value : {"-1", "0", "1000000000000", "9223372036854775807", "'many'", "2", "268435456"})
            EXPECT_NE(said_after("UPDATE model SET " + column + " = " + value).find("the project is damaged"),
                      std::string::npos)
                << column << value;
    EXPECT_NE(said_after("UPDATE strokes SET sample_count = 33554433").find("impossible number of samples"),
              std::string::npos);
    EXPECT_NE(said_after("UPDATE strokes SET sample_count = 33554432").find("is damaged"), std::string::npos);
}

TEST_F(HostileProject, TextsAndJsonAreBounded) {
    const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
    const auto replace = [&](const std::string& sql, const std::string& text) {
        return said_after([&](SQLite::Database& db) {
            SQLite::Statement s(db, sql);
            s.bind(1, text);
            s.exec();
        });
    };
    const std::string settings = "UPDATE strokes SET settings = ? WHERE id = 2", groups = "UPDATE model SET groups = ?";
    for (const std::string& sql : {settings, groups})
        for (const std::string& text : {deep, std::string("{\"a\":") + deep + "}", std::string("not json"),
                                        std::string("{\"spacing\": 1e999}"), std::string("{\"spacing\": \"x\"}")}) {
            const std::string said = replace(sql, text);
            EXPECT_FALSE(said.empty()) << sql << text.substr(0, 40);
            EXPECT_LT(said.size(), 400u) << said.substr(0, 200);
        }
    EXPECT_NE(replace("UPDATE strokes SET label = ? WHERE id = 2", std::string(2'000'000, 'x'))
                  .find("the label of a stroke is too long"),
              std::string::npos);
    EXPECT_NE(replace("UPDATE presets SET toml = ?", std::string(2'000'000, 'x')).find("a preset is too long"),
              std::string::npos);
    EXPECT_NE(
        replace("UPDATE strokes SET brush = ?", std::string(5'000, 'x')).find("the brush of a stroke is too long"),
        std::string::npos);
    EXPECT_NE(said_after("INSERT INTO presets WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i "
                         "+ 1 FROM n LIMIT 20000) SELECT 'ink', i, '' FROM n")
                  .find("too many presets"),
              std::string::npos);
}

// A journal of as many entries as nobody paints; ten million are refused as soon.
TEST_F(HostileProject, AJournalOfMoreEntriesThanAnybodyPaintsIsRefused) {
    EXPECT_NE(said_after("INSERT INTO strokes SELECT NULL, i + 10, '', '', 0, '', '{}', 0, 0, "
                         "'wrap', x'', 0, x'' FROM "
                         "(WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n LIMIT "
                         "1000000) SELECT i FROM n)")
                  .find("it has 1000003 strokes, more than the 1000000 that are read"),
              std::string::npos);
}

TEST_F(HostileProject, NumbersThatAreNoneAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), far = std::numeric_limits<double>::infinity();
    for (const double bad : {nan, far}) {
        std::vector<double> columns(200 * 11);
        columns[777] = bad;
        const std::vector<char> samples = pack(columns.data(), columns.size(), {.element = 8, .lag = 1});
        EXPECT_NE(said_after([&](SQLite::Database& db) {
                      put_blob(db, "UPDATE strokes SET samples = ? WHERE id = 2", samples);
                  }).find("stroke 2"),
                  std::string::npos);
        std::vector<char> placement(72);
        std::memcpy(placement.data() + 16, &bad, 8);
        EXPECT_NE(said_after([&](SQLite::Database& db) {
                      put_blob(db, "UPDATE strokes SET placement = ? WHERE id = 2", placement);
                  }).find("stroke 2"),
                  std::string::npos);
        std::vector<float> positions(3 * cylinder().n_vertices());
        positions[10] = static_cast<float>(bad);
        const std::vector<char> mesh = pack(positions.data(), positions.size(), {.element = 4, .lag = 3});
        EXPECT_NE(said_after([&](SQLite::Database& db) {
                      put_blob(db, "UPDATE arrays SET data = ? WHERE owner = 'mesh' AND name = 'positions'", mesh);
                  }).find("no numbers"),
                  std::string::npos);
    }
    for (const std::string value : {"9e999", "-1", "'x'", "0"})
        EXPECT_NE(said_after("UPDATE model SET texel_size = " + value), "") << value;
}

TEST_F(HostileProject, WhoeverListensIsHeardWhileAFileIsRead) {
    fs::copy_file(good_, path_);
    EXPECT_THROW(Project::open(path_, {.progress = [](std::string_view, double) { return false; }}), Cancelled);
    bool go_on = true;
    Project project = Project::open(path_, {.progress = [&](std::string_view, double) { return go_on; }});
    go_on = false;
    EXPECT_THROW(project.model(), Cancelled);
    EXPECT_THROW(project.strokes(), Cancelled);
    EXPECT_THROW(project.load_canvases(500), Cancelled);
    // What is to be written is written all the same.
    project.set_hidden(1, true);
    project.listen({});
    EXPECT_TRUE(project.strokes().at(0).hidden);
}

}  // namespace
}  // namespace tuft::io
