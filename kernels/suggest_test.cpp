#include "kernels/suggest.h"

#include <gtest/gtest.h>

#include <array>

namespace boxwood {
namespace {

constexpr std::array<std::string_view, 4> words{"uniform", "clusters", "bars", "sphere_mesh"};

TEST(Suggest, FindsTheNearestWord) {
    EXPECT_EQ(suggest("unifrom", words), "uniform");         // swap
    EXPECT_EQ(suggest("cluster", words), "clusters");        // insert
    EXPECT_EQ(suggest("barss", words), "bars");              // delete
    EXPECT_EQ(suggest("sphere-mesh", words), "sphere_mesh"); // replace
    EXPECT_EQ(suggest("bars", words), "bars");
}

TEST(Suggest, StaysSilentWhenNothingIsNear) {
    EXPECT_EQ(suggest("robot", words), "");
    EXPECT_EQ(suggest("", words), "");
    EXPECT_EQ(suggest("bars", {}), "");
}

TEST(Suggest, MessagesNameTheWordOrTheList) {
    EXPECT_EQ(unknown_name("scene", "bras", words), "unknown scene 'bras'; did you mean 'bars'?");
    EXPECT_EQ(unknown_name("scene", "robot", words),
              "unknown scene 'robot'; known are: uniform, clusters, bars, sphere_mesh");
    const std::vector<std::string_view> many(90, "a");
    const std::string text = unknown_name("peer", "robots", many);
    EXPECT_EQ(text.substr(text.size() - 16), "a, a and 50 more");
}

} // namespace
} // namespace boxwood
