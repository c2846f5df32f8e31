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

TEST(Limits, OfADeviceAreItsBytesLanesLaunchesAndTheBus) {
    results::Results r;
    r.env.resize(1);
    r.env[0].gpu_sm = 100;
    r.env[0].gpu_clock_ghz = 2; // 25,600 lane cycles in a ns
    r.env[0].gpu_l2_bytes = 0;
    for (const double scale : {1., 3., 0.5}) { // the median is 1
        results::Shard shard;
        shard.gpu_copy_gbs = 4000 * scale;
        shard.gpu_upload_pageable_gbs = 12 * scale;
        shard.gpu_download_pageable_gbs = 8 * scale;
        shard.gpu_launch_ns = 2000 * scale;
        r.shards.push_back(shard);
    }
    r.shards.emplace_back(); // not measured
    results::Cell cell;
    cell.n_items = 1'000'000;
    cell.executor = results::resident_executor;
    r.variants.resize(1);
    r.variants[0].layout = "packed";
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::build))); // nothing was counted
    r.counters = {{0, "build_bytes", 200'000'000},  {0, "build_launches", 12},
                  {0, "query_bytes", 40'000'000},   {0, "query_launches", 3},
                  {0, "box_tests", 640'000'000},    {0, "pairs", 5'000'000},
                  {0, "upload_bytes", 24'000'000},  {0, "query_upload_bytes", 0},
                  {0, "download_bytes", 40'000'000}};
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 50'000);  // 200 MB at 4000 B/ns; 24 us launch
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 200'000); // 8 cycles a test
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build_and_query), 250'000);
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::update)));
    cell.executor = results::device_executor;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::upload), 2'000'000);   // 24 MB at 12 B/ns
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::download), 5'000'000); // 40 MB at 8 B/ns
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_build), 50'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 2'050'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 5'200'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build_and_query), 7'250'000);
    r.counters[4].value = 1000;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_query), 10'000); // 40 MB
    r.counters[2].value = 1000;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_query), 6000); // three launches
    r.counters[1].value = 100;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_build), 200'000);
    r.counters[4].cell_id = 7;
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::device_query)));
    results::Cell on_processors; // the same contender
    on_processors.cell_id = 7;
    r.cells = {cell, on_processors};
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_query), 6000);
    r.cells[1].task = "tree_pairs";
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::device_query)));
    r.cells[1].task = "";
    r.variants[0].layout = "binary"; // walked in another way there
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::device_query)));
    r.variants[0].layout = "packed";
    r.counters[1].value = 12;
    r.env[0].gpu_l2_bytes = 10'000'000; // kept between the passes of a build
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_build), 25'000);
    r.env[0].gpu_l2_bytes = 50'000'000;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_build), 24'000); // launches
    r.counters[7].value = 12'000'000;                                 // rays, say
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::upload), 3'000'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 6000 + 1'000'000 + 5'000'000);
    r.env[0].gpu_sm = results::no_count;
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::device_query)));
}

} // namespace
} // namespace boxwood::bench
