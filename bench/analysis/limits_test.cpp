#include "bench/analysis/limits.h"

#include "bench/analysis/times.h"
#include "bench/testing/maker.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;

results::Results on_one_machine() {
    results::Results r;
    r.env.resize(1);
    r.env[0].stream_triad_gbs_1 = 7.5; // 10 with the lines that a write reads
    r.env[0].stream_triad_gbs_all = 12;
    r.env[0].core_ghz = 4;
    r.env[0].l3_bytes = 1'000'000;
    return r;
}

TEST(Limits, InTheCachesAreWhatACoreCanLoad) {
    results::Results r = on_one_machine();
    results::Cell cell;
    cell.cell_id = 7;
    cell.n_items = 1000;
    cell.threads = 1;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 24'000 / 512.);
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::query))); // its answers were not counted
    r.counters = {{7, "pairs", 5000}};
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 40'000 / 512.);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build_and_query), 64'000 / 512.);
    cell.threads = 2;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 24'000 / 1024.);
    r.env.push_back({}); // rows of two machines
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::build)));
}

TEST(Limits, BeyondTheLastCacheAreWhatTheMemoryCanMove) {
    results::Results r = on_one_machine();
    r.counters = {{0, "pairs", 1'000'000}};
    results::Cell cell;
    cell.n_items = 1'000'000;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 2'300'000); // all but 1 MB at 10 B/ns
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 700'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build_and_query), 3'100'000); // the cache holds 1 MB
    cell.threads = 2;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 23'000'000 / 16.);
    r.env[0].l3_bytes = results::no_count; // all may be in it
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 24'000'000 / 1024.);
}

TEST(Limits, OfAnUpdateCountTheItemsThatMoved) {
    results::Results r = on_one_machine();
    r.scenes.resize(1);
    r.scenes[0].n_frames = 20;
    results::Cell cell;
    cell.n_items = 1000;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::update), 24'000 / 512.); // not counted: all of them
    r.counters = {{0, "items_moved", 200}, {0, "pairs", 3}};
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::update), 240 / 512.);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::update_and_query), 264 / 512.);
    r.counters[0].value = 0;
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::update)));
}

TEST(Limits, OfADeviceAreItsMemoryALaunchAndTheBus) {
    results::Results r;
    r.env.resize(1);
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
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 6000);  // 24 MB at 4000 B/ns
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::query))); // its answers were not counted
    r.counters = {{0, "upload_bytes", 24'000'000},
                  {0, "query_upload_bytes", 0},
                  {0, "download_bytes", 40'000'000}};
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 10'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build_and_query), 16'000);
    EXPECT_TRUE(std::isnan(limit_ns(r, cell, Phase::update)));
    cell.executor = results::device_executor;
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::upload), 2'000'000);   // 24 MB at 12 B/ns
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::download), 5'000'000); // 40 MB at 8 B/ns
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build), 2'006'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 5'010'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::build_and_query), 7'016'000);
    r.env[0].gpu_l2_bytes = 50'000'000; // holds all: a launch is left
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_build), 2000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::device_query), 2000);
    r.counters[1].value = 12'000'000; // rays, say
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::upload), 3'000'000);
    EXPECT_DOUBLE_EQ(limit_ns(r, cell, Phase::query), 2000 + 1'000'000 + 5'000'000);
}

TEST(Medians, MedianSpreadAndTails) {
    Maker maker(5);
    const auto id = maker.cell("x", false);
    maker.time(id, Phase::query, [](std::uint32_t round) {
        return std::array{5., 1., 3., 2., 100.}[round];
    });
    maker.time(id, Phase::query, steady(7), results::aa_twin);
    maker.results.samples.push_back(maker.results.samples[0]);
    maker.results.samples.back().wall_ns = results::missing;
    const auto stats = medians_of(maker.results, Times(maker.results));
    ASSERT_EQ(stats.size(), 1u);
    EXPECT_EQ(stats[0].phase, Phase::query);
    EXPECT_EQ(stats[0].n, 5u);
    EXPECT_EQ(stats[0].median_ns, 3);
    EXPECT_EQ(stats[0].mad_ns, 2); // of 2 2 0 1 97
    EXPECT_EQ(stats[0].min_ns, 1);
    EXPECT_DOUBLE_EQ(stats[0].p95_ns, 81); // numpy.percentile([1, 2, 3, 5, 100], 95)
    EXPECT_DOUBLE_EQ(stats[0].p99_ns, 96.2);
}

TEST(NoiseFloors, TheHighestIsThatOfTheNoisiestPhase) {
    Maker maker(9);
    const auto ours = maker.cell("ours", false);
    maker.time(ours, Phase::build, steady(100));
    maker.time(ours, Phase::query, steady(100));
    maker.time(ours, Phase::build, steady(130), results::aa_twin);
    maker.time(ours, Phase::query, steady(102), results::aa_twin);
    EXPECT_NEAR(NoiseFloors(maker.results, Times(maker.results)).highest().value(), 0.30, 1e-9);
}

TEST(NoiseFloors, EachKindOfCellAndPhaseHasItsOwn) {
    Maker maker(9);
    const auto brief = maker.cell("brief", false), lengthy = maker.cell("long", false);
    maker.time(brief, Phase::query, steady(1e3));
    maker.time(lengthy, Phase::query, steady(1e7));
    maker.time(brief, Phase::query, steady(1.15e3), results::aa_twin);
    maker.time(lengthy, Phase::query, steady(1.01e7), results::aa_twin);
    maker.time(brief, Phase::cold_build, steady(1e3));
    maker.time(lengthy, Phase::cold_build, steady(1e7));
    maker.time(brief, Phase::cold_build, steady(1.5e3), results::aa_twin);
    EXPECT_NEAR(NoiseFloors(maker.results, Times(maker.results)).highest().value(), .15,
                1e-9); // what is not cold knows nothing of it
    maker.time(lengthy, Phase::build, steady(1e7));
    maker.time(lengthy, Phase::build, steady(1.4e7), results::aa_twin);
    maker.time(brief, Phase::build, steady(1e3));
    maker.time(brief, Phase::build, steady(1.05e3), results::aa_twin);
    maker.time(lengthy, Phase::cold_query, steady(1e7));
    maker.time(lengthy, Phase::cold_query, steady(1.3e7), results::aa_twin);
    const Times times(maker.results);
    const NoiseFloors floors(maker.results, times);
    for (const auto& [phase, floor] : {std::pair{Phase::cold_build, .5},
                                       {Phase::cold_query, .3}, // not that of a warm one
                                       {Phase::build, .4},
                                       {Phase::query, .01},
                                       {Phase::build_and_query, .4}})
        EXPECT_NEAR(*floors.of(maker.results.cells[lengthy], phase), floor, 1e-6);
    for (const auto& [phase, floor] :
         {std::pair{Phase::build, .05}, {Phase::query, .15}, {Phase::build_and_query, .15}})
        EXPECT_NEAR(*floors.of(maker.results.cells[brief], phase), floor, 1e-6);
    const auto mixed = maker.cell("brief build, long query", false);
    maker.time(mixed, Phase::build, steady(1e3));
    maker.time(mixed, Phase::query, steady(1e7));
    const Times of_all(maker.results);
    EXPECT_NEAR(
        *NoiseFloors(maker.results, of_all).of(maker.results.cells[mixed], Phase::build_and_query),
        .4, 1e-6); // as a long build
}

} // namespace
} // namespace boxwood::bench
