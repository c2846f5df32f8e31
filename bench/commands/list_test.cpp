#include "bench/commands/list.h"

#include "trees/world/mesh_tree.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace boxwood::bench {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::size_t max_line(const std::string& text) {
    std::size_t longest = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        longest = std::max(longest, line.size());
    return longest;
}

TEST(List, TheSummaryHasALinePerRegistryAndFitsOneScreen) {
    const std::string text = list_text("", false), json = list_text("", true);
    EXPECT_LE(max_line(text), 100u);
    EXPECT_LE(std::ranges::count(text, '\n'), 24);
    for (const std::string_view name : registry_names()) {
        EXPECT_THAT("\n" + text, HasSubstr(fmt::format("\n{} ", name)));
        EXPECT_THAT(json, HasSubstr(fmt::format("\"{}\":[", name)));
    }
    EXPECT_THAT(text, ContainsRegex("builders +[0-9]+ .*median, hilbert, .*, \\.\\.\\."));
    EXPECT_THAT(text, ContainsRegex("executors +3 .*serial, openmp, tbb\n"));
    EXPECT_THAT(text, HasSubstr("`boxwood list builders`"));
}

TEST(List, OneRegistryHasALinePerEntry) {
    EXPECT_THAT(list_text("executors", false), HasSubstr("serial"));
    EXPECT_THAT(list_text("executors", true), StartsWith("[{\"name\":\"serial\",\"summary\":"));
    EXPECT_THAT(list_text("tasks", false), HasSubstr("rays_closest"));
    EXPECT_THAT(list_text("kernels", true), HasSubstr("\"name\":\"watertight\""));
}

TEST(List, TheDefaultVolumeIsNamed) {
    EXPECT_THAT(list_text("volumes", false), ContainsRegex("obb +.*\\(the default\\)\naabb +"));
    EXPECT_THAT(list_text("volumes", true), ContainsRegex("\"obb\",.*\"default\":true.*\"aabb\",.*"
                                                          "\"default\":false"));
    EXPECT_THAT(list_text("", false), ContainsRegex("volumes +2 .*obb, aabb\n"));
    EXPECT_EQ(mesh_volumes().front().volume, MeshTreeOptions().volume);
}

TEST(List, EveryEntryHasASummaryAndLinesFitTheScreen) {
    for (const std::string_view name : registry_names()) {
        EXPECT_THAT(list_text(name, true), Not(HasSubstr("\"summary\":\"\""))) << name;
        EXPECT_LE(max_line(list_text(name, false)), 100u) << name;
    }
}

TEST(List, AKernelSaysPromiseBoundAndCost) {
    const std::string text = list_text("kernels", false);
    EXPECT_THAT(text, HasSubstr("triangle_triangle, exact: "));
    EXPECT_THAT(text, HasSubstr("bound: "));
    EXPECT_THAT(text, HasSubstr("cost: rational: microseconds, allocates"));
    EXPECT_THAT(text, HasSubstr("vertex_face, exact: "));
    const std::string json = list_text("kernels", true);
    EXPECT_THAT(json, HasSubstr(R"("family":"triangle_triangle","promise":"certified","bound":)"));
}

TEST(List, AFamilySaysItsPanelAndItsParameters) {
    const std::string text = list_text("families", false);
    EXPECT_THAT(text, HasSubstr("degenerate: triangles of two planes at an angle of 10^-k"));
    EXPECT_THAT(text, HasSubstr("k = 16 (1 to 18): the angle is 10^-k"));
    EXPECT_THAT(text, HasSubstr("scale = -860 to 860 ("));
    const std::string json = list_text("families", true);
    EXPECT_THAT(json, HasSubstr(R"("panel":"degenerate","k":{"meaning":"the angle is 10^-k",)"
                                R"("default":16,"min":1,"max":18},)"
                                R"("scale":{"min":-860,"max":860},"reads_file":false})"));
    EXPECT_THAT(json, HasSubstr(R"("k":null)"));
    EXPECT_THAT(json, HasSubstr(R"("reads_file":true)"));
}

TEST(List, AMisspeltNameGetsASuggestion) {
    EXPECT_THAT([] { list_text("bilders", false); },
                testing::ThrowsMessage<std::invalid_argument>(HasSubstr("'builders'")));
}

} // namespace
} // namespace boxwood::bench
