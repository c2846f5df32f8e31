#include "bench/plan/cell_name.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace boxwood::bench {
namespace {

const CellName example{"triangle_soup", 100000, 1, "pairs", "binned_sah_bins16.wide8.self_pairs",
                       "f32",           "tbb",  2};

TEST(CellName, FormatsAsDocumented) {
    EXPECT_EQ(format_cell_name(example),
              "triangle_soup/n100000-s1/pairs/binned_sah_bins16.wide8.self_pairs/f32/tbb-2");
}

TEST(CellName, RoundTrips) {
    CellName name = example;
    for (const std::uint64_t n : {std::uint64_t{0}, std::uint64_t{7}, ~std::uint64_t{0}})
        for (const char* contender : {"a", "fcl.dynamic_aabb_tree", "a.b.c.d"})
            for (const unsigned threads : {1u, 64u}) {
                name.n_items = n;
                name.seed = n;
                name.contender = contender;
                name.threads = threads;
                EXPECT_EQ(parse_cell_name(format_cell_name(name)), name);
            }
}

TEST(CellName, RefusesWhatItCannotHaveWritten) {
    const std::string good = format_cell_name(example);
    ASSERT_TRUE(parse_cell_name(good));
    for (const std::string& bad :
         {std::string{}, std::string{"a"}, good + "/x", good + "x", "/" + good,
          std::string{"s/n1-s1/pairs/a/f32/tbb"}, std::string{"s/n01-s1/pairs/a/f32/tbb-1"},
          std::string{"s/n-s1/pairs/a/f32/tbb-1"}, std::string{"s/n1-s/pairs/a/f32/tbb-1"},
          std::string{"s/1-s1/pairs/a/f32/tbb-1"}, std::string{"s/n1-s1/pairs/a..b/f32/tbb-1"},
          std::string{"s/n1-s1/pairs/a./f32/tbb-1"}, std::string{"S/n1-s1/pairs/a/f32/tbb-1"},
          std::string{"s/n1-s1//a/f32/tbb-1"}, std::string{"s/n1-s1/pairs/a/f32/tbb-+1"},
          std::string{"s/n1-s99999999999999999999/pairs/a/f32/tbb-1"}})
        EXPECT_FALSE(parse_cell_name(bad)) << bad;
}

TEST(CellName, RefusesToWriteWhatIsNotAWord) {
    CellName name = example;
    name.scene = "My Mesh";
    EXPECT_THROW(format_cell_name(name), std::invalid_argument);
    name = example;
    name.contender = "a/b";
    EXPECT_THROW(format_cell_name(name), std::invalid_argument);
}

} // namespace
} // namespace boxwood::bench
