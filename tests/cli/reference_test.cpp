#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"

/// \file
/// What the program says of itself. Manual pages and completions are tried by
/// tests/install/manual.sh.
namespace tuft {
namespace {

class Reference : public test::Program {};

TEST_F(Reference, VersionAsJsonHasLibrariesAndFactsOfTheBuild) {
    const test::Ran plain = tuft("--version");
    ASSERT_EQ(plain.status, 0) << plain.err;
    for (const char* order : {"--version --json", "--json --version"}) {
        const test::Ran ran = tuft(order);
        ASSERT_EQ(ran.status, 0) << ran.err;
        const nlohmann::json j = nlohmann::json::parse(ran.out);
        EXPECT_EQ("tuft " + j.at("version").get<std::string>() + "\n", plain.out);
        for (const char* library : {"CGAL", "OpenMesh", "OpenImageIO", "SQLite3", "embree", "polyclipping"})
            EXPECT_TRUE(std::isdigit(j.at("libraries").at(library).get<std::string>().at(0))) << library;
        for (const char* fact : {"compiler", "build_type", "system", "released", "licence", "data"})
            EXPECT_FALSE(j.at(fact).get<std::string>().empty()) << fact;
        EXPECT_EQ(j.at("data"), source_folder());
    }
}

TEST_F(Reference, JsonOfNothingIsRefused) {
    const test::Ran ran = tuft("--json");
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.error_lines(), 1) << ran.err;
}

TEST_F(Reference, ManualThatCannotBeWrittenIsOneLine) {
    const test::Ran ran = tuft("--reference " + write("file", "") + "/below");
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.error_lines(), 1) << ran.err;
}

}  // namespace
}  // namespace tuft
