#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "core/error.h"
#include "core/files/files.h"
#include "core/random.h"
#include "sample_project.h"

/// Files that are no project, or one no more: each is refused in one line.
namespace tuft::io {
namespace {

namespace fs = std::filesystem;

using namespace testing;

std::string fault(const fs::path& path) {
    try {
        Project project = Project::open(path);
        project.model();
        project.strokes();
        project.inks();
        project.load_canvas(500);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(ProjectRefused, ForeignFilesAreNamedAsSuch) {
    const Folder folder("project_foreign");
    EXPECT_NE(fault(folder / "none.tuft").find("no such file"), std::string::npos);
    const std::string text = "just some text";
    write_file(folder / "t.tuft", text.data(), text.size());
    EXPECT_NE(fault(folder / "t.tuft").find("is not a tuft project"), std::string::npos);
    EXPECT_FALSE(is_project(folder / "t.tuft"));
    write_file(folder / "empty.tuft", text.data(), 0);
    EXPECT_NE(fault(folder / "empty.tuft").find("is not a tuft project"), std::string::npos);

    Project::create(folder / "a.tuft", sample_model());
    EXPECT_TRUE(is_project(folder / "a.tuft"));
    std::vector<char> bytes = read_file(folder / "a.tuft");
    std::vector<char> other = bytes;
    std::memcpy(&other[68], "GPKG", 4);
    write_file(folder / "o.tuft", other.data(), other.size());
    EXPECT_NE(fault(folder / "o.tuft").find("not a tuft project"), std::string::npos);
    bytes[63] = kProjectFormat + 1;  // user_version
    write_file(folder / "n.tuft", bytes.data(), bytes.size());
    EXPECT_NE(fault(folder / "n.tuft")
                  .find("newer tuft (format " + std::to_string(kProjectFormat + 1) + ", this one reads up to " +
                        std::to_string(kProjectFormat) + ")"),
              std::string::npos);
    EXPECT_THROW(Project::create(folder / "no/where/a.tuft", sample_model()), Error);
}

TEST(ProjectRefused, WhatCannotBeOpenedSaysWhyInWordsOfPeople) {
    const Folder folder("project_unopened");
    const auto says = [](const std::function<void()>& act) {
        try {
            act();
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    fs::create_directories(folder / "folder.tuft");
    EXPECT_NE(fault(folder / "folder.tuft").find("is a folder"), std::string::npos);
    fs::create_directories(folder / "work");
    Project project = Project::create(folder / "work/a.tuft", sample_model());
    project.append(sample_stroke(1));
    // Its rollback journal cannot be made.
    fs::create_directories(folder / "work/a.tuft-journal");
    const std::string blocked = says([&] { project.append(sample_stroke(2)); });
    EXPECT_NE(blocked.find("a.tuft: cannot be"), std::string::npos) << blocked;
    fs::remove(folder / "work/a.tuft-journal");
    fs::rename(folder / "work", folder / "elsewhere");
    const std::string moved = says([&] { project.append(sample_stroke(2)); });
    EXPECT_NE(moved.find("is not there any more"), std::string::npos) << moved;
    for (const std::string& text : {blocked, moved}) EXPECT_EQ(text.find("database"), std::string::npos) << text;
    fs::rename(folder / "elsewhere", folder / "work");
    EXPECT_EQ(says([&] { project.append(sample_stroke(2)); }), "");
}

TEST(ProjectRefused, DamagedFilesAreErrorsNeverCrashes) {
    const Folder folder("project_damaged");
    {
        Project project = Project::create(folder / "a.tuft", sample_model());
        for (std::uint64_t id = 1; id < 6; ++id) project.append(sample_stroke(id, 200));
        ink::Canvas canvas(500);
        canvas.add_pigment(ink::load_ink("carbon").parts[0].pigment);
        for (std::uint32_t slot = 0; slot < 20; ++slot) canvas.touch(slot, 0).fill(0.5f);
        project.save_canvas(canvas, 5);
    }
    const std::vector<char> good = read_file(folder / "a.tuft");
    EXPECT_EQ(fault(folder / "a.tuft"), "");
    for (const double part : {0.02, 0.3, 0.7, 0.99}) {
        write_file(folder / "cut.tuft", good.data(), static_cast<std::size_t>(part * good.size()));
        EXPECT_NE(fault(folder / "cut.tuft"), "") << part;
    }
    int refused = 0;
    for (int i = 0; i < 120; ++i) {
        std::vector<char> bytes = good;
        Random random(i);
        for (int k = 0; k < 1 + i % 20; ++k) {
            const std::size_t at = 100 + static_cast<std::size_t>(random.uniform() * (bytes.size() - 100));
            bytes[at] = static_cast<char>(random.bits());
        }
        write_file(folder / "bad.tuft", bytes.data(), bytes.size());
        refused += fault(folder / "bad.tuft") != "";
    }
    EXPECT_GT(refused, 10) << "some hits fall on text, unused space or bits nobody checks";
}

}  // namespace
}  // namespace tuft::io
