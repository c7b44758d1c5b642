#include "io/project/project_lock.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <functional>
#include <thread>

#include "core/files/files.h"
#include "io/project/project.h"
#include "sample_model.h"

namespace {

int g_flock_errno = 0;  ///< with which flock fails; 0: it does not

}  // namespace

/// In the place of the C library's, for file systems without locks.
extern "C" int flock(int file, int operation) noexcept {
    if (g_flock_errno != 0) return errno = g_flock_errno, -1;
    return static_cast<int>(syscall(SYS_flock, file, operation));
}

namespace tuft::io {
namespace {

namespace fs = std::filesystem;
using namespace testing;

ProjectModel small_model() {
    ProjectModel model;
    model.source = "bowl.ply";
    model.mesh = cylinder();
    model.atlas = cylinder_atlas(model.mesh);
    model.substrate = ink::substrate_toml(ink::load_substrate("porcelain"));
    return model;
}

stroke::JournalEntry stroke_of(std::uint64_t id) {
    stroke::PaintStroke s;
    s.brush = "goat-medium";
    s.ink = "carbon";
    s.trace.samples = {{}, {.time = 1, .position = {1, 0, 0}}};
    stroke::JournalEntry entry(std::move(s));
    entry.id = id;
    return entry;
}

std::string said(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

/// Another process that does something, says so, and waits to be ended.
class Other {
  public:
    explicit Other(const std::function<void(const std::function<void()>& ready)>& act) {
        int ends[2];
        if (::pipe(ends) != 0) std::abort();
        process_ = ::fork();
        if (process_ == 0) {
            ::close(ends[0]);
            try {
                act([&] {
                    if (::write(ends[1], "r", 1) != 1) _exit(1);
                });
            } catch (...) {
            }
            _exit(0);
        }
        ::close(ends[1]);
        char c = 0;
        ready_ = ::read(ends[0], &c, 1) == 1;
        ::close(ends[0]);
    }
    ~Other() { end(SIGKILL); }
    bool ready() const { return ready_; }
    pid_t process() const { return process_; }
    void end(int signal) {
        if (process_ <= 0) return;
        ::kill(process_, signal);
        ::waitpid(std::exchange(process_, 0), nullptr, 0);
    }

  private:
    pid_t process_ = 0;
    bool ready_ = false;
};

void keep(const fs::path& path, const std::function<void()>& ready) {
    const Project project = Project::open(path);
    ready();
    for (;;) ::pause();
}

TEST(ProjectLock, OneProcessWritesAndTheOthersLearnWhichOne) {
    const Folder folder("lock_two");
    const fs::path path = folder / "work.tuft";
    Project::create(path, small_model());
    Other other([&](const auto& ready) { keep(path, ready); });
    ASSERT_TRUE(other.ready());
    const std::string wanted = "work.tuft: test_io (process " + std::to_string(other.process()) +
                               ") is working on it; close it there, or work on a copy of the file";
    EXPECT_NE(said([&] { Project::open(path); }).find(wanted), std::string::npos);
    EXPECT_NE(said([&] { Project::create(path, small_model()); }).find(wanted), std::string::npos)
        << "nor is another one put in its place";
    EXPECT_EQ(said([&] { EXPECT_EQ(Project::open(path, {.access = Access::read}).n_strokes(), 0u); }), "");
    Project reader = Project::open(path, {.access = Access::read});
    EXPECT_NE(said([&] { reader.append(stroke_of(1)); }).find("read only"), std::string::npos);
    // By another name it is the same project; a copy is not.
    fs::create_symlink(path, folder / "link.tuft");
    EXPECT_NE(said([&] { Project::open(folder / "link.tuft"); }).find("is working on it"), std::string::npos);
    fs::copy_file(path, folder / "copy.tuft");
    EXPECT_EQ(said([&] { Project::open(folder / "copy.tuft").append(stroke_of(1)); }), "");
}

// A whole folder may be copied while a project in it is open: the copied lock file is nobody's.
TEST(ProjectLock, WhatAKilledProcessLeavesIsTakenOver) {
    const Folder folder("lock_killed");
    const fs::path path = folder / "work.tuft";
    Project::create(path, small_model());
    Other other([&](const auto& ready) { keep(path, ready); });
    ASSERT_TRUE(other.ready());
    other.end(SIGKILL);
    EXPECT_TRUE(fs::exists(folder / ".work.tuft.lock"));
    EXPECT_EQ(said([&] { Project::open(path).append(stroke_of(1)); }), "");
    EXPECT_EQ(folder.n_files(), 1u) << "one file again";
    const std::string nonsense = "\x1b[31mtuft\nnot a number\nsomewhere\n" + std::string(100'000, 'x');
    write_file(folder / ".work.tuft.lock", nonsense.data(), nonsense.size());
    EXPECT_EQ(said([&] { Project::open(path).append(stroke_of(2)); }), "");
    EXPECT_EQ(folder.n_files(), 1u);
}

TEST(ProjectLock, AWriterThatIsAboutToEndIsWaitedFor) {
    const Folder folder("lock_patience");
    const fs::path path = folder / "work.tuft";
    Project::create(path, small_model());
    const auto three = [&](int first) {
        return [&, first](const std::function<void()>& ready) {
            ready();
            for (int i = 0; i < 3; ++i)
                Project::open(path, {.patience = std::chrono::seconds(20)}).append(stroke_of(first + i));
            ready();
        };
    };
    {
        Other a(three(1)), b(three(11)), c(three(21));
        for (Other* o : {&a, &b, &c}) o->end(0);  // waits
    }
    EXPECT_EQ(Project::open(path).n_strokes(), 9u);
}

TEST(ProjectLock, WhereItCannotBeTheReasonIsReportedAndReadingContinues) {
    const Folder folder("lock_none");
    const fs::path path = folder / "work.tuft";
    Project::create(path, small_model());
    for (const int fault : {ENOLCK, ENOSYS, EINVAL, EIO}) {
        g_flock_errno = fault;
        const std::string text = said([&] { Project::open(path); });
        const std::string reading = said([&] { Project::open(path, {.access = Access::read}).model(); });
        g_flock_errno = 0;
        EXPECT_NE(text.find("cannot be locked against other programs"), std::string::npos) << text;
        EXPECT_NE(text.find("copy it to a disk of this machine"), std::string::npos) << text;
        EXPECT_EQ(reading, "");
    }
    fs::remove(folder / ".work.tuft.lock");
    fs::create_directory(folder / ".work.tuft.lock");
    EXPECT_NE(said([&] { Project::open(path); }).find("its lock file '.work.tuft.lock' cannot be opened"),
              std::string::npos);
    fs::remove(folder / ".work.tuft.lock");
    // A person who may look only; the superuser may everything.
    fs::permissions(folder.path(), fs::perms(0555));
    fs::permissions(path, fs::perms::all);
    std::string writes, reads;
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    if (::fork() == 0) {
        if (::setresuid(65534, 65534, 65534) != 0 && ::getuid() == 0) _exit(1);
        const std::string out = said([&] { Project::open(path); }) + "|" +
                                said([&] { Project::open(path, {.access = Access::read}).model(); }) + "|";
        _exit(::write(ends[1], out.data(), out.size()) < 0);
    }
    ::close(ends[1]);
    std::string out(4096, 0);
    const ssize_t size = ::read(ends[0], out.data(), out.size());
    ::close(ends[0]);
    ::wait(nullptr);
    fs::permissions(folder.path(), fs::perms::owner_all);
    out.resize(static_cast<std::size_t>(std::max<ssize_t>(0, size)));
    EXPECT_NE(out.find("nothing may be written into its folder||"), std::string::npos) << out;
}

// Programs that know of no lock, such as those of before.
TEST(ProjectLock, AChangeByAProgramThatKnowsOfNoLockIsNoticedAndNothingIsWrittenOnTop) {
    const Folder folder("lock_outside");
    const fs::path path = folder / "work.tuft";
    Project project = Project::create(path, small_model());
    project.append(stroke_of(1));
    EXPECT_FALSE(project.changed_outside());
    EXPECT_FALSE(Project::open(path, {.access = Access::read}).changed_outside());
    const auto change = [&] {
        SQLite::Database other(path.string(), SQLite::OPEN_READWRITE);
        other.exec("UPDATE strokes SET label = label || '+'");
    };
    change();
    EXPECT_TRUE(project.changed_outside());
    EXPECT_THROW(project.append(stroke_of(2)), ChangedOutside);
    EXPECT_THROW(project.remove(1), ChangedOutside);
    EXPECT_THROW(project.put_brush({"x", "y"}), ChangedOutside);
    EXPECT_EQ(project.n_strokes(), 1u);
    project = Project::open(path);
    EXPECT_FALSE(project.changed_outside());
    EXPECT_EQ(said([&] { project.append(stroke_of(2)); }), "");
    EXPECT_EQ(said([&] { project.append(stroke_of(3)); }), "");
    EXPECT_FALSE(project.changed_outside());
    // And one that puts another file in its place.
    {
        Project copy = Project::create(folder / "other.tuft", small_model());
        copy.append(stroke_of(7));
    }
    fs::rename(folder / "other.tuft", path);
    EXPECT_TRUE(project.changed_outside());
    EXPECT_THROW(project.append(stroke_of(4)), ChangedOutside);
    project = Project::open(path);
    EXPECT_EQ(project.strokes().at(0).id, 7u);
    EXPECT_EQ(said([&] { project.append(stroke_of(8)); }), "");
}

}  // namespace
}  // namespace tuft::io
