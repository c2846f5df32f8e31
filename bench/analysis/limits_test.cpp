#include "bench/analysis/limits.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;

TEST(Limits, AreTheBytesOrTheCyclesThatCannotBeAvoided) {
    results::Results r;
    r.env.push_back({});
    r.env[0].stream_triad_gbs_1 = 10;
    r.env[0].stream_triad_gbs_all = 16;
    r.env[0].core_ghz = 4;
    results::Cell cell;
    cell.cell_id = 7;
    cell.n_items = 1000;
    cell.threads = 1;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 8800); // 88 kB at 10 B/ns
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::update), 8800);
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::query))); // no work was counted
    r.counters = {{7, "box_tests", 100'000}, {7, "pairs", 5000}};
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query),
                     9000); // 36,000 cycles; 64 kB would take 6400 ns
    r.counters[0].value = 10'000;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 6400);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build_and_query), 8800 + 6400);
    cell.threads = 2;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 4000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 5500);
    cell.cell_id = 8;
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::query)));
    r.env.push_back({}); // rows of two machines
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::build)));
}

TEST(Limits, OfAnUpdateCountTheItemsThatMoved) {
    results::Results r;
    r.env.push_back({});
    r.env[0].stream_triad_gbs_1 = r.env[0].stream_triad_gbs_all = 10;
    r.scenes.resize(1);
    r.scenes[0].n_frames = 20;
    results::Cell cell;
    cell.n_items = 1000;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::update), 8800); // not counted: all of them
    r.counters = {{0, "items_moved", 200}};
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::update), 88);
    r.counters.push_back({0, "box_tests", 10});
    r.counters.push_back({0, "pairs", 0});
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 2400);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::update_and_query), 88 + 2400);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 8800);
    r.counters[0].value = 0;
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::update)));
}

} // namespace
} // namespace boxwood::bench
