#include "mesh/part_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tuft::mesh {
namespace {

using ::testing::ElementsAre;

// A copy of an exported object has its extras, too.
TEST(PartGroups, OfNodesWithOneExportedNameAreOneEach) {
    const std::vector<ScenePart> parts{
        {.object = "Hood", .group = "Hood", .material = "decorated", .node = 0, .own_material = 0},
        {.object = "Hood.001", .group = "Hood", .material = "decorated", .node = 1, .own_material = 0}};
    const PartGroups groups = group_parts(parts);
    EXPECT_THAT(groups.names, ElementsAre("Hood", "Hood 2"));
    EXPECT_THAT(groups.of_part, ElementsAre(0, 1));
}

// As Blender writes again what was exported: without extras, materials by page.
TEST(PartGroups, OfOneNodeOnSeveralPagesAreOne) {
    const std::vector<ScenePart> parts{
        {.object = "Hood", .material = "decorated.1001", .node = 0, .own_material = 0},
        {.object = "Hood", .material = "decorated.1002", .node = 0, .own_material = 1},
        {.object = "Hood", .material = "decorated.1002.glass", .node = 0, .own_material = 2},
        {.object = "Hood", .material = "decorated.1002.001", .node = 0, .own_material = 3},
        {.object = "Door", .material = "decorated.1002", .node = 1, .own_material = 1},
        {.object = "Lid", .material = "Page 1001", .node = 2, .own_material = 4},
        {.object = "Lid", .material = "Page 1002", .node = 2, .own_material = 5}};
    const PartGroups groups = group_parts(parts);
    EXPECT_THAT(groups.names, ElementsAre("Hood", "Hood 2", "Hood 3", "Door", "Page 1001", "Page 1002"))
        << "glass is a part of its own, and a page has one picture";
    EXPECT_THAT(groups.of_part, ElementsAre(0, 0, 1, 2, 3, 4, 5));
}

TEST(PartGroups, OfNodesWithOneMaterialHaveTheirNames) {
    const std::vector<ScenePart> parts{{.object = "Windscreen", .material = "Glass", .node = 0, .own_material = 0},
                                       {.object = "Body", .material = "Paint", .node = 1, .own_material = 1},
                                       {.object = "Body", .material = "Chrome", .node = 1, .own_material = 2},
                                       {.object = "", .material = "Rubber", .node = 2, .own_material = 3}};
    EXPECT_THAT(group_parts(parts).names, ElementsAre("Windscreen", "Paint", "Chrome", "Rubber"));
}

TEST(PartGroups, HaveNamesThatEntriesMayHave) {
    std::string long_name;
    for (int i = 0; i < 65; ++i) long_name += "\u91d1";  // 195 bytes
    std::vector<ScenePart> parts;
    for (std::int32_t node = 0; node < 2; ++node)
        for (std::int32_t material = 0; material < 2; ++material)
            parts.push_back({.object = long_name,
                             .material = material == 0 ? "\u6f06\u91d1" : "\u6f06\u9280",
                             .node = node,
                             .own_material = material});
    const PartGroups groups = group_parts(parts);
    // 195 bytes and " / " are 198: the first character of the material takes three.
    EXPECT_THAT(groups.names,
                ElementsAre(long_name + " / ", long_name + " /  2", long_name + " /  3", long_name + " /  4"));
    for (const std::string& name : groups.names) EXPECT_LE(name.size(), kMaxPartNameBytes);
}

// Names that only differ beyond what is kept are numbered on: 30,000 of them would take minutes if each began at 2.
TEST(PartGroups, WithOneLongBeginningAreNumberedOn) {
    constexpr int kParts = 30000;
    std::vector<ScenePart> parts;
    for (int i = 0; i < kParts; ++i)
        parts.push_back({.object = std::string(kMaxPartNameBytes, 'a') + std::to_string(i), .node = i});
    const PartGroups groups = group_parts(parts);
    ASSERT_EQ(groups.names.size(), parts.size());
    EXPECT_EQ(groups.names[0], std::string(kMaxPartNameBytes, 'a'));
    EXPECT_TRUE(groups.names.back().ends_with("a " + std::to_string(kParts)));
    EXPECT_EQ(std::set<std::string>(groups.names.begin(), groups.names.end()).size(), parts.size());
}

}  // namespace
}  // namespace tuft::mesh
