#include "bench/analysis/figures/devices.h"

#include "bench/analysis/analyse.h"
#include "bench/analysis/screen.h"
#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Cell;
using results::Family;
using results::Phase;
using results::Verdict;
using testing::ElementsAre;
using testing::HasSubstr;

struct DeviceGains : testing::Test {
    RunForTest run;

    std::uint32_t add(std::uint64_t n, const std::string& variant, double ns,
                      std::uint32_t threads = 1, const std::string& task = "pairs") {
        const auto cell = run.cell("uniform", n, task, variant, threads);
        run.time(cell, Phase::build, 0.25 * ns);
        run.time(cell, Phase::query, 0.75 * ns);
        return cell;
    }
    std::uint32_t add_device(std::uint64_t n, const std::string& variant, double ns,
                             std::string_view executor = results::device_executor,
                             const std::string& task = "pairs") {
        const auto id = add(n, variant, ns, 1, task);
        const bool crosses = executor == results::device_executor;
        Cell& cell = run.results.cells[id];
        cell.executor = executor;
        cell.classes = crosses ? "on a device" : "resident";
        if (crosses) {
            run.time(id, Phase::upload, 0.2 * ns);
            run.time(id, Phase::device_build, 0.05 * ns);
            run.time(id, Phase::device_query, 0.15 * ns);
            run.time(id, Phase::download, 0.6 * ns);
        }
        return id;
    }
    const std::string& place(std::uint32_t id) {
        static const std::string processor = "processor";
        const Cell& cell = run.results.cells.at(id);
        return is_device(cell) ? cell.executor : processor;
    }
    const results::DeviceBreakEven& only() {
        analyse(run.results);
        EXPECT_EQ(run.results.device_break_even.size(), 1u);
        return run.results.device_break_even.at(0);
    }
};

TEST_F(DeviceGains, MeetProcessorsInTheirOwnFamilyAlone) {
    for (const std::uint64_t n : {10, 100, 1000}) {
        const double ns = static_cast<double>(n);
        for (const char* kernel : {"", ".moller", ".exact"})
            for (const char* builder : {"hilbert", "median"}) {
                const std::string variant = std::string(builder) + ".packed.self_pairs" + kernel;
                add(n, variant, 50 * ns);
                add(n, variant, 30 * ns, 2);
                add_device(n, variant, 9 * ns);
                add_device(n, variant, 3 * ns, results::resident_executor);
            }
        add(n, "fcl.tree", 70 * ns);
        add_device(n, "embree.gpu", 10 * ns);
        add_device(n, "embree.gpu", 4 * ns, results::resident_executor);
    }
    for (const Cell& cell : run.results.cells) {
        results::TreeRow tree;
        tree.cell_id = cell.cell_id;
        tree.sah_cost = is_device(cell) ? 10 : 20;
        run.results.trees.push_back(tree);
    }
    analyse(run.results);
    std::set<std::tuple<std::string, Family, std::string>> met;
    for (const auto& row : run.results.compare)
        met.insert({place(row.cell_a), row.family, place(row.cell_b)});
    std::set<std::tuple<std::string, Family, std::string>> expected{
        {"processor", Family::threads, "processor"}, {"processor", Family::devices, "cuda"}};
    for (const char* of : {"processor", "cuda", "cuda_resident"})
        for (const Family family : {Family::peers, Family::ours})
            expected.insert({of, family, of});
    EXPECT_EQ(met, expected);
    for (const auto& row : run.results.break_even)
        if (row.cell_a != results::no_id) {
            EXPECT_EQ(place(row.cell_a), place(row.cell_b));
        }
    std::set<std::string> with_front, with_cheapest;
    for (const auto& tree : run.results.trees)
        if (tree.on_front)
            with_front.insert(place(tree.cell_id));
    for (const auto& row : run.results.break_even)
        with_cheapest.insert(place(row.cell_b));
    EXPECT_EQ(with_front.size(), 3u);
    EXPECT_EQ(with_cheapest.size(), 3u);
    std::map<std::uint32_t, std::string> groups;
    for (const auto& row : run.results.query_kernels)
        EXPECT_EQ(groups.emplace(row.group, place(row.cell_id)).first->second, place(row.cell_id));
    std::set<std::string> raced;
    for (const auto& row : run.results.findings)
        if (row.topic == results::Topic::race) {
            EXPECT_EQ(place(row.ours), place(row.rival));
            raced.insert(place(row.ours) + row.contender_class);
        }
    EXPECT_THAT(raced, ElementsAre("cuda_residentresident", "cudaon a device", "processor"));
    for (const auto& row : run.results.size_scaling) {
        EXPECT_EQ(row.n_sizes, 3u);
        EXPECT_NEAR(row.exponent, 1, 1e-9);
    }
    for (const auto& row : run.results.medians)
        if (is_device(run.results.cells[row.cell_id])) {
            EXPECT_LE(row.median_ns, 10'000);
        }
}

TEST_F(DeviceGains, AreHeldAgainstOurBestOfOneTwoAndAllThreads) {
    const auto one = add(10, "hilbert.packed", 400), two = add(10, "hilbert.packed", 200, 2),
               all = add(10, "hilbert.packed", 100, 16), device = add_device(10, "lbvh", 50),
               resident = add_device(10, "lbvh", 10, results::resident_executor);
    add(10, "slow.packed", 500);
    add(10, "slow.packed", 130, 16);
    add(10, "hilbert.packed", 150, 4);
    add(10, "fcl.tree", 1); // a peer
    add_device(10, "slow", 60);
    add_device(10, "embree.gpu", 20);
    const auto wrong = add_device(10, "broken", 1);
    run.results.checks[wrong].status = results::Status::wrong;
    const auto other = add(10, "double.packed", 1);
    run.results.cells[other].precision = "f64";
    analyse(run.results);
    std::map<std::uint32_t, double> ratios;
    for (const auto& row : run.results.compare)
        if (row.family == Family::devices) {
            EXPECT_EQ(row.cell_b, device);
            EXPECT_EQ(row.phase, Phase::build_and_query);
            EXPECT_EQ(row.verdict, Verdict::faster);
            EXPECT_DOUBLE_EQ(row.p_adj, 2. / 512); // nine rounds, three claims that are all clear
            ratios[row.cell_a] = row.ratio;
        }
    ASSERT_EQ(ratios.size(), 3u);
    EXPECT_DOUBLE_EQ(ratios[one], 0.125);
    EXPECT_DOUBLE_EQ(ratios[two], 0.25);
    EXPECT_DOUBLE_EQ(ratios[all], 0.5);
    ASSERT_EQ(run.results.device_gains.size(), 1u);
    const results::DeviceGain& row = run.results.device_gains[0];
    EXPECT_EQ(std::tuple(row.cpu_1_ns, row.cpu_2_ns, row.cpu_all_ns, row.end_to_end_ns,
                         row.resident_ns, row.device_ns),
              std::tuple(400, 200, 100, 50, 10, 10));
    EXPECT_EQ(std::tuple(row.cell_1, row.cell_2, row.cell_all, row.cell_device, row.cell_resident),
              std::tuple(one, two, all, device, resident));
    EXPECT_EQ(row.threads, 16u);
    EXPECT_DOUBLE_EQ(row.ratio, 0.5);
    EXPECT_EQ(row.words, "faster");
    EXPECT_TRUE(std::isnan(row.limit_ns));
}

TEST_F(DeviceGains, OfTwoThreadsAreClaimedOnce) {
    add(10, "hilbert.packed", 400);
    const auto two = add(10, "hilbert.packed", 200, 2);
    add_device(10, "lbvh", 50);
    analyse(run.results);
    EXPECT_EQ(
        std::ranges::count(run.results.compare, Family::devices, &results::Comparison::family), 2);
    EXPECT_EQ(run.results.device_gains.at(0).cell_all, two);
    EXPECT_EQ(run.results.device_gains.at(0).cell_2, two);
}

TEST_F(DeviceGains, ArePairedWithRoundsOfTheirOwnMachine) {
    const auto cpu = add(10, "hilbert.packed", 100);
    add_device(10, "lbvh", 50);
    run.results.env.push_back(run.results.env[0]);
    run.results.env[1].env_id = 1;
    run.results.env[1].env_hash = "slow, and without a device";
    run.results.shards.push_back(run.results.shards[0]);
    run.results.shards[1].shard_id = run.results.shards[1].env_id = 1;
    for (std::uint32_t round = 0; round < 20; ++round)
        for (const Phase phase : {Phase::build, Phase::query}) {
            results::Sample sample;
            sample.cell_id = cpu;
            sample.shard_id = 1;
            sample.round = round;
            sample.phase = phase;
            sample.wall_ns = 1e6;
            run.results.samples.push_back(sample);
        }
    analyse(run.results);
    EXPECT_EQ(run.results.device_gains.at(0).cpu_1_ns, 100);
    EXPECT_DOUBLE_EQ(run.results.device_gains.at(0).ratio, 0.5);
}

TEST_F(DeviceGains, WinFromTheSizeAfterWhichTheyDoNotLose) {
    const double factors[] = {5, 2, 0.8, 0.5};
    std::uint64_t n = 1000;
    for (const double factor : factors) {
        add(n, "hilbert.packed", 100, 2);
        add_device(n, "lbvh", 100 * factor);
        n *= 10;
    }
    const auto& row = only();
    EXPECT_EQ(row.n_sizes, 4u);
    EXPECT_EQ(row.wins_from, 100'000u);
    EXPECT_EQ(row.loses_to, 10'000u);
    EXPECT_EQ(row.words, "wins at 100k boxes and above, loses at 10k");
    EXPECT_EQ(run.results.scenes[row.scene_id].n_items, 1'000'000u);
    const results::Finding& finding = run.results.findings.back();
    EXPECT_EQ(finding.topic, results::Topic::device);
    EXPECT_EQ(finding.is_headline, 1u);
    EXPECT_EQ(finding.is_loss, 0u);
    EXPECT_EQ(finding.question, "overlapping pairs, uniform");
    EXPECT_EQ(finding.together, row.words);
    EXPECT_EQ(finding.alone, "wins 2.00x over 2 threads");
    EXPECT_EQ(finding.certainty, "2.00 to 2.00");
    const std::string screen = screen_text(run.results);
    EXPECT_THAT(screen, HasSubstr("wins at 100k boxes and above, loses at 10k"));
    EXPECT_THAT(screen, testing::ContainsRegex("\n +100k +- +100 ns +100 ns +80.0 ns +- "
                                               "+16.0 ns +- +wins 1.25x"));
    EXPECT_LE(std::ranges::count(screen, '\n'), 21);
    EXPECT_THAT(devices_text(run.results, 1), HasSubstr("LOSES 0.200x"));
}

TEST_F(DeviceGains, SayAsWellThatTheyAlwaysOrNeverWin) {
    const auto words = [&](std::initializer_list<double> factors) {
        run = {};
        std::uint64_t n = 1000;
        for (const double factor : factors) {
            add(n, "hilbert.packed", 100);
            const auto cell = add(n, "lbvh", 1);
            run.results.cells[cell].executor = results::device_executor;
            for (results::Sample& sample : run.results.samples)
                if (sample.cell_id == cell) // 0: now faster, now slower
                    sample.wall_ns *= factor > 0 ? 100 * factor : sample.round % 2 ? 50 : 200;
            n *= 10;
        }
        return only().words;
    };
    EXPECT_EQ(words({0.9, 0.5}), "wins at all 1k to 10k boxes");
    EXPECT_EQ(words({4, 2, 1.5}), "no lasting win at 1k to 100k boxes, loses at 100k");
    EXPECT_EQ(words({0.5, 0.5, 1.5, 0}), "no lasting win at 1k to 1M boxes, loses at 100k");
    EXPECT_EQ(words({0, 0.5}), "wins at 10k boxes and above, unsure below");
    EXPECT_EQ(words({0, 0}), "unsure at 1k to 10k boxes");
    EXPECT_EQ(words({0.5, 4, 0.5}), "wins at 100k boxes and above, loses at 10k");
}

TEST_F(DeviceGains, WithoutOneNothingIsSaid) {
    add(10, "hilbert.packed", 100);
    analyse(run.results);
    EXPECT_TRUE(run.results.device_gains.empty());
    EXPECT_EQ(devices_text(run.results), "");
    run.results.cells[add_device(20, "lbvh", 10)].scene_id = 0;
    run.results.scenes[0].n_triangles = 5;
    analyse(run.results);
    EXPECT_EQ(run.results.device_break_even.at(0).words, "wins at all 20 triangles");
    for (Cell& cell : run.results.cells)
        if (!is_device(cell))
            cell.scene_id = 1;
    analyse(run.results);
    EXPECT_EQ(run.results.device_gains.at(0).cell_all, results::no_id);
    EXPECT_TRUE(run.results.device_break_even.empty());
}

} // namespace
} // namespace boxwood::bench
