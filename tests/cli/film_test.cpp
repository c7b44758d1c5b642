#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "io/image/image.h"
#include "program.h"

/// `tuft film` as a program.
namespace tuft::test {
namespace {

namespace fs = std::filesystem;

class FilmCommand : public Program {
  protected:
    /// Two strokes on the sheet.
    std::string project() const {
        write("s.inkml", stroke_file("0 0 0", "wolf-small", 20));
        write("t.inkml", stroke_file("0 10 0", "goat-small", 20));
        const Ran ran = tuft("paint " + model("sheet.ply") + " --atlas-size 512 --quiet --strokes " + path("s.inkml") +
                             " --strokes " + path("t.inkml") + " --project " + path("p.tuft"));
        EXPECT_EQ(ran.status, 0) << ran.err;
        return path("p.tuft");
    }
    static constexpr const char* kView = " --size 64x48 --view 20,50 ";
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
};

TEST_F(FilmCommand, BeginsBareAndEndsWithThePictureOfRender) {
    const std::string p = project();
    const Ran ran = tuft("film " + p + kView + "--seconds 0.4 --end 0.08 --json -o " + path("frames"));
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(nlohmann::json::parse(ran.out).at("frames"), 12);
    ASSERT_EQ(tuft("render " + p + kView + "-o " + path("last.png")).status, 0);
    EXPECT_EQ(read(path("frames/frame-00012.png")), read(path("last.png")));
    EXPECT_EQ(read(path("frames/frame-00010.png")), read(path("last.png")));
    ASSERT_EQ(tuft("render " + model("sheet.ply") + kView + "-o " + path("bare.png")).status, 0);
    // A map of one colour in the place of that colour: rounding.
    const io::Image8 bare = io::read_image8(path("bare.png")), first = io::read_image8(path("frames/frame-00001.png"));
    ASSERT_EQ(bare.pixels.size(), first.pixels.size());
    for (std::size_t i = 0; i < bare.pixels.size(); ++i) ASSERT_NEAR(bare.pixels[i], first.pixels[i], 1) << i;
    // A brush is over the stroke in work.
    EXPECT_NE(read(path("frames/frame-00005.png")), read(path("frames/frame-00006.png")));
}

// A sheet under a pane of glass: what is behind the pane is in the frames, and the state of parts in the first one.
TEST_F(FilmCommand, ShowsWhatIsBehindGlassAsRenderDoes) {
    write("m.obj",
          "o body\nv -30 -30 0\nv 30 -30 0\nv 30 30 0\nv -30 30 0\nf 1 2 3 4\n"
          "o pane\nv -20 -20 8\nv 20 -20 8\nv 20 20 8\nv -20 20 8\nf 5 6 7 8\n");
    write("s.inkml", stroke_file("0 0 8", "wolf-small", 20));
    const std::string paint = "paint " + path("m.obj") + " --unit mm --up z --sides file --strokes " + path("s.inkml") +
                              " --mapping project --atlas-size 512 --quiet --substrate clay --substrate pane=glass ";
    ASSERT_EQ(tuft(paint + "--project " + path("p.tuft")).status, 0);
    ASSERT_EQ(tuft(paint + "--hide-parts pane --project " + path("hidden.tuft")).status, 0);
    const std::string film = std::string(kView) + "--seconds 0.2 --end 0 --quiet -o ";
    ASSERT_EQ(tuft("film " + path("p.tuft") + film + path("still")).status, 0);
    ASSERT_EQ(tuft("film " + path("p.tuft") + film + path("turning") + " --camera turntable").status, 0);
    ASSERT_EQ(tuft("film " + path("hidden.tuft") + film + path("hidden")).status, 0);
    for (const char* name : {"p", "hidden"})
        ASSERT_EQ(tuft("render " + path(std::string(name) + ".tuft") + kView + "-o " + path(std::string(name) + ".png"))
                      .status,
                  0);
    EXPECT_EQ(read(path("still/frame-00005.png")), read(path("p.png")));
    EXPECT_EQ(read(path("turning/frame-00005.png")), read(path("p.png")));
    EXPECT_EQ(read(path("hidden/frame-00005.png")), read(path("hidden.png")));
    EXPECT_NE(read(path("p.png")), read(path("hidden.png")));
    // A first frame from before the parts have their states would show an opaque pane in both.
    EXPECT_NE(read(path("still/frame-00001.png")), read(path("hidden/frame-00001.png")));
}

TEST_F(FilmCommand, GivesTheSameFramesOnAnyNumberOfThreadsAndByTurns) {
    const std::string p = project();
    const std::string film = "film " + p + kView + "--seconds 0.3 --end 0 --camera front,view --quiet ";
    ASSERT_EQ(tuft(film + "--threads 1 -o " + path("one")).status, 0);
    ASSERT_EQ(tuft(film + "--threads 3 -o " + path("three")).status, 0);
    for (const char* frame : {"frame-00001.png", "frame-00004.png", "frame-00008.png"})
        EXPECT_EQ(read(path(std::string("one/") + frame)), read(path(std::string("three/") + frame))) << frame;
}

// A slash at the end of a folder's name makes no difference; what is no folder is refused before the work begins.
TEST_F(FilmCommand, WritesItsFramesIntoAnyFolder) {
    const std::string film = "film " + project() + kView + "--seconds 0.1 --end 0 --quiet -o ";
    fs::create_directory(path("there"));
    for (const char* folder : {"new/", "there/"}) {
        EXPECT_EQ(tuft(film + path(folder)).status, 0) << folder;
        EXPECT_TRUE(fs::exists(fs::path(path(folder)) / "frame-00001.png")) << folder;
        EXPECT_EQ(tuft(film + path(folder)).status, 1) << "has frames already: " << folder;
    }
    write("file", "x");
    for (const char* folder : {"file", "file/", "missing/frames", "missing/frames/"}) {
        const Ran ran = tuft(film + path(folder));
        EXPECT_EQ(ran.status, 1) << folder;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    EXPECT_FALSE(fs::exists(path("missing")));
}

TEST_F(FilmCommand, LeavesNoHalfFilm) {
    const std::string p = project();
    // A program in the place of ffmpeg that fails, and one that is never done.
    write("ffmpeg", "#!/bin/sh\nhead -c 1000 >/dev/null\nexit 3\n");
    ::chmod(path("ffmpeg").c_str(), 0755);
    const std::size_t before = files();
    const std::string film = "film " + p + kView + "--no-cache -o " + path("f.mp4");
    const Ran failed = tuft(film, "PATH='" + folder_.string() + ":$PATH'");
    EXPECT_EQ(failed.status, 1);
    EXPECT_EQ(failed.error_lines(), 1) << failed.err;
    const Ran stopped = tuft(film + " --seconds 600", "timeout -s INT 2");
    EXPECT_NE(stopped.status, 0);
    const Ran none = tuft(film, "PATH=/nonexistent");
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("ffmpeg"), std::string::npos) << none.err;
    EXPECT_EQ(files(), before);
}

// A film that is killed after some frames, and stopped after some more, is to the bit the one that is not, where the
// camera stands and where the light goes on from frame to frame as it moves. Frames that were there are not drawn
// again.
TEST_F(FilmCommand, GoesOnWhereItWasKilledOrStopped) {
    const std::string film = "film " + project() + " --size 40x30 --end 0.04 --quiet --camera front,view ",
                      length = "--seconds 0.6 -o ", whole = path("whole"), cut = path("cut");
    ASSERT_EQ(tuft(film + length + whole).status, 0);
    const auto end_at = [&](const char* signal, const char* frame) {
        return tuft(film + length + cut + " & p=$!; until test -e '" + cut + "/" + frame +
                    "'; do kill -0 $p 2>/dev/null || exit 9; sleep 0.01; done; kill -" + signal +
                    " $p; wait $p 2>/dev/null; true");
    };
    EXPECT_EQ(end_at("KILL", "frame-00002.png").status, 0);
    struct stat first {
    }, later{};
    ASSERT_EQ(::stat((cut + "/frame-00002.png").c_str(), &first), 0);
    EXPECT_EQ(end_at("INT", "frame-00004.png").status, 0);
    ASSERT_FALSE(fs::exists(cut + "/frame-00016.png")) << "it was not stopped in time";
    const Ran other = tuft(film + "--seconds 2 -o " + cut);
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.err.find("another film"), std::string::npos) << other.err;
    ASSERT_EQ(tuft(film + length + cut + " --threads 1").status, 0);
    ASSERT_EQ(::stat((cut + "/frame-00002.png").c_str(), &later), 0);
    EXPECT_EQ(first.st_ino, later.st_ino);
    std::size_t frames = 0;
    for (const auto& entry : fs::directory_iterator(whole)) {
        const std::string name = entry.path().filename();
        EXPECT_EQ(read(entry.path()), read(cut + "/" + name)) << name;
        ++frames;
    }
    EXPECT_EQ(frames, 16U);
    EXPECT_EQ(std::distance(fs::directory_iterator(cut), fs::directory_iterator()), 16);
}

// ffmpeg of its own accord ends a film that the disk has no room for with status 0 where the last bytes are missing.
TEST_F(FilmCommand, LeavesNoFilmOnAFullDisk) {
    const std::string film = "film " + project() + kView + "--seconds 0.2 --end 0 --no-cache --quiet -o ";
    for (const char* name : {"f.gif", "f.mp4", "frames"}) {
        // KiB: less than a film of these pictures.
        const Ran ran = tuft(film + path(name), "trap '' XFSZ; ulimit -f 1;");
        EXPECT_EQ(ran.status, 1) << name;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
        EXPECT_FALSE(fs::exists(path(name)));
    }
}

TEST_F(FilmCommand, RefusesBadCamerasInOneLine) {
    const std::string p = project();
    write("empty.toml", "");
    write("falls.toml", "[[key]]\nat = 0.5\n[[key]]\nat = 0.2\n");
    write("odd.toml", "[[key]]\nat = 0.5\nroll = 3\n");
    for (const char* camera : {"frnot", "front,,top", "nothing.toml"}) {
        const Ran ran = tuft("film " + p + " -o " + path("f") + " --camera " + std::string(camera));
        EXPECT_GT(ran.status, 0) << camera;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    for (const char* camera : {"empty", "falls", "odd"}) {
        const Ran ran = tuft("film " + p + " -o " + path("f") + " --camera " + path(std::string(camera) + ".toml"));
        EXPECT_EQ(ran.status, 1) << camera;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
    }
    EXPECT_FALSE(fs::exists(path("f")));
}

}  // namespace
}  // namespace tuft::test
