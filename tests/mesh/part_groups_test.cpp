#include "mesh/part_groups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace tuft::mesh
