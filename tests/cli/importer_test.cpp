#include <algorithm>
#include <csignal>

#include "program.h"

/// The process that reads FBX and DAE, from the outside: whatever it does, `tuft` ends with status 1 and one line, and
/// nothing of it stays.
namespace tuft::test {
namespace {

class Importer : public Program {
  protected:
    void SetUp() override {
        Program::SetUp();
        dae_ = write("box.dae", read(source_folder() + "/tests/fuzz/corpus/dae/box.dae"));
    }

    /// `tuft inspect` of a DAE file by a copy of the program, beside which `script` (of sh) stands for the importer.
    Ran inspect_by(const std::string& script, const std::string& limits = "") const {
        namespace fs = std::filesystem;
        fs::create_directories(path("bin"));
        const std::string program = path("bin/tuft");
        fs::copy_file(tuft_program(), program, fs::copy_options::overwrite_existing);
        write("bin/tuft-import", "#!/bin/sh\necho $$ >'" + path("pid") + "'\n" + script + "\n");
        fs::permissions(path("bin/tuft-import"), fs::perms::owner_all);
        return run(program, "inspect '" + dae_ + "'", limits);
    }

    void expect_refused(const Ran& ran, const std::string& words) const {
        EXPECT_EQ(ran.status, 1) << ran.err;
        EXPECT_EQ(ran.error_lines(), 1) << ran.err;
        EXPECT_TRUE(ran.err.starts_with("tuft: " + dae_ + ": ")) << ran.err;
        EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
        EXPECT_TRUE(ran.out.empty()) << ran.out;
        const int pid = std::stoi(read(path("pid")));
        EXPECT_NE(::kill(pid, 0), 0) << "the importer is there still, running or as a zombie";
        for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
            const std::string name = entry.path().filename();
            EXPECT_TRUE(name == "bin" || name == "pid" || name == "box.dae" || name.starts_with(".")) << name;
        }
    }

    std::string dae_;
};

TEST_F(Importer, ThatCrashesIsOneLine) {
    for (const char* signal : {"SEGV", "ABRT", "FPE", "BUS"})
        expect_refused(inspect_by(std::string("kill -") + signal + " $$"), "is damaged: reading it failed");
    expect_refused(inspect_by("kill -KILL $$"), "its reader was ended from outside");
    expect_refused(inspect_by("exit 7"), "is damaged: reading it failed");
}

TEST_F(Importer, ThatHandsOverNonsenseIsOneLine) {
    expect_refused(inspect_by("exit 0"), "its importer handed over a damaged model");
    expect_refused(inspect_by("echo tuft scene 3; head -c 100000 /dev/zero"),
                   "its importer handed over a damaged model");
    expect_refused(inspect_by("printf 'fault: has\\na\\tfault\\033[1m'; exit 1"), "has?a?fault?[1m");
}

// The limits of who calls the program hold for the importer too, which makes these quick.
TEST_F(Importer, ThatNeverEndsIsStoppedWhetherItComputesOrWaits) {
    expect_refused(inspect_by("while :; do :; done", "ulimit -t 2;"), "reading it took more than 1 s");
    expect_refused(inspect_by("exec sleep 1000000", "ulimit -t 2;"), "does not come to an end");
    expect_refused(inspect_by("kill -STOP $$", "ulimit -t 2;"), "does not come to an end");
}

TEST_F(Importer, ThatTakesMemoryWithoutEndIsStopped) {
    expect_refused(inspect_by("x=0123456789abcdef; while :; do x=$x$x; done"), "is damaged: reading it failed");
    expect_refused(inspect_by("exec cat /dev/zero"), "reading it gave more than 1024 MiB");
}

TEST_F(Importer, ThatIsNotThereOrIsNoProgramIsOneLine) {
    const Ran ran = inspect_by("");
    std::ofstream(path("bin/tuft-import"), std::ios::trunc) << "\x7f"
                                                               "ELF, but no program";
    const Ran broken = run(path("bin/tuft"), "inspect '" + dae_ + "'");
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(broken.status, 1);
    EXPECT_EQ(broken.error_lines(), 1) << broken.err;
    EXPECT_NE(broken.err.find("tuft-import: cannot be started"), std::string::npos) << broken.err;
}

// The real one: it keeps to its limits, and a caller that lets children go unheard is served all the same.
TEST_F(Importer, ReadsForACallerThatIgnoresItsChildren) {
    const Ran plain = tuft("inspect '" + dae_ + "'");
    ASSERT_EQ(plain.status, 0) << plain.err;
    const Ran deaf = tuft("inspect '" + dae_ + "'", "trap '' CHLD;");
    EXPECT_EQ(deaf.status, 0) << deaf.err;
    EXPECT_EQ(deaf.out, plain.out);
}

TEST_F(Importer, WithTooLittleMemoryForAFileSaysSo) {
    std::string numbers;
    for (int i = 0; i < 6'000'000; ++i) numbers += "1 2 3 ";  // 36 MB, and 72 MB as numbers
    std::string text = read(dae_);
    const std::size_t at = text.find("<float_array ");
    ASSERT_NE(at, text.npos);
    text.insert(at, "<float_array id=\"x\" count=\"18000000\">" + numbers + "</float_array>");
    write("box.dae", text);
    const std::string real = std::filesystem::path(tuft_program()).parent_path() / "../io/tuft-import";
    expect_refused(inspect_by("ulimit -v 150000; exec '" + real + "' \"$@\""),
                   "asks for more memory than a file of its size may");
}

}  // namespace
}  // namespace tuft::test
