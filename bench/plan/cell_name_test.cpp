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
    CellName held = example;
    held.isa = "avx2";
    EXPECT_EQ(format_cell_name(held), format_cell_name(example) + "/avx2");
}

TEST(CellName, RefusesWhatIsNotMadeOfWords) {
    const auto refuses = [](std::string CellName::*part, const char* text) {
        CellName name = example;
        name.*part = text;
        EXPECT_THROW(format_cell_name(name), std::invalid_argument) << text;
    };
    for (const char* bad : {"", "My Mesh", "S", "a/b", "a-b", "+"})
        for (const auto part : {&CellName::scene, &CellName::task, &CellName::contender,
                                &CellName::precision, &CellName::executor})
            refuses(part, bad);
    for (const char* bad : {"a..b", "a.", ".a"})
        refuses(&CellName::contender, bad);
    refuses(&CellName::scene, "a.b");
}

} // namespace
} // namespace boxwood::bench
