#include "trees/trees.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace boxwood {
namespace {

/// Compiled with trees/trees.h alone.
TEST(TreesHeader, IsAllThatAUserIncludes) {
    const std::vector<Box> boxes{{{0, 0, 0}, {2, 2, 2}}, {{1, 1, 1}, {3, 3, 3}}};
    const auto layout =
        find_layout("wide8").make(SweepSahBuilder{}.build(boxes, serial()), serial());
    CountPairs pairs;
    layout->self_pairs(serial(), pairs);
    EXPECT_EQ(pairs.count(), 1u);
    EXPECT_EQ(squared_distance<float>({0, 0, 5}, boxes[0]), 9);
}

/// Every header of trees/ but those in cuda/, detail/, traversals/ and testing/ is public; those in
/// adapters/ are for users of another library, who include them one by one.
TEST(TreesHeader, HoldsAllThatIsPublicAndNothingElse) {
    namespace fs = std::filesystem;
    std::set<std::string> there, included;
    ASSERT_TRUE(fs::is_directory("trees")) << "run from the root of the sources";
    for (const auto& entry : fs::recursive_directory_iterator("trees")) {
        const std::string path = entry.path().generic_string();
        const bool internal =
            path.find("/detail/") != std::string::npos || path.starts_with("trees/cuda/") ||
            path.starts_with("trees/traversals/") || path.starts_with("trees/testing/") ||
            path.starts_with("trees/adapters/");
        if (path.ends_with(".h") && !internal && path != "trees/trees.h")
            there.insert(path);
    }
    std::ifstream header("trees/trees.h");
    const std::string start = "#include \"";
    for (std::string line; std::getline(header, line);)
        if (line.starts_with(start))
            included.insert(line.substr(start.size(), line.size() - start.size() - 1));
    EXPECT_EQ(included, there);
}

} // namespace
} // namespace boxwood
