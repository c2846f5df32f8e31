#include "bench/analysis/comparisons.h"

#include "bench/analysis/status.h"
#include "bench/testing/maker.h"
#include "bench/testing/run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

namespace boxwood::bench {
namespace {

using results::Comparison;
using results::Family, results::Phase, results::Reason;
using results::Results;
using results::Verdict;

/// The machine slows down from round to round; pairing takes that out.
Clock drifting(double ns) {
    return [ns](std::uint32_t round) { return ns * (1 + round) * (1 + 0.001 * (round * 7 % 5)); };
}

const Comparison& row_of(const std::vector<Comparison>& rows, std::uint32_t a, std::uint32_t b,
                         Phase phase) {
    for (const auto& row : rows)
        if (row.cell_a == a && row.cell_b == b && row.phase == phase)
            return row;
    static const Comparison none;
    ADD_FAILURE() << "no row " << a << " " << b << " " << to_string(phase);
    return none;
}

/// The claims against peers, as a file would have them.
std::vector<Comparison> against_peers(Results& results) {
    set_statuses(results);
    results.medians = medians_of(results, Times(results));
    std::vector<Comparison> rows = comparisons_of(results, Times(results), default_delta);
    std::erase_if(rows, [](const Comparison& row) { return row.family != Family::peers; });
    return rows;
}

std::optional<double> floor_of(const Results& results) {
    return NoiseFloors(results, Times(results)).highest();
}

TEST(ComparePeers, PairedRoundsSeeThroughDrift) {
    Maker maker(9);
    const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
    maker.time(ours, Phase::build, drifting(100));
    maker.time(peer, Phase::build, drifting(300));
    maker.time(ours, Phase::query, drifting(100));
    maker.time(peer, Phase::query, drifting(50));
    const auto rows = against_peers(maker.results);
    ASSERT_EQ(rows.size(), 3u);
    const Comparison& build = row_of(rows, peer, ours, Phase::build);
    EXPECT_EQ(build.verdict, Verdict::faster);
    EXPECT_EQ(build.n_pairs, 9u);
    EXPECT_NEAR(build.ratio, 1.0 / 3, 1e-12);
    EXPECT_NEAR(build.p_adj, 2.0 / 512, 1e-12);
    EXPECT_EQ(row_of(rows, peer, ours, Phase::query).verdict, Verdict::slower);
    const Comparison& sum = row_of(rows, peer, ours, Phase::build_and_query);
    EXPECT_EQ(sum.verdict, Verdict::faster);
    EXPECT_NEAR(sum.ratio, 200.0 / 350, 1e-12);
}

TEST(ComparePeers, FewRoundsTellNothing) {
    for (const std::uint32_t rounds : {1u, 5u, 6u, 8u}) {
        Maker maker(rounds);
        const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
        maker.time(ours, Phase::query, steady(1));
        maker.time(peer, Phase::query, steady(50));
        const auto rows = against_peers(maker.results);
        ASSERT_EQ(rows.size(), 1u);
        EXPECT_EQ(rows[0].verdict, Verdict::cannot_tell);
        EXPECT_EQ(rows[0].reason, Reason::too_few_rounds);
        EXPECT_EQ(std::isnan(rows[0].ci_lo), rounds < 6);
    }
}

TEST(ComparePeers, OnlyTheSameJob) {
    Maker maker(9);
    const auto ours = maker.cell("ours", false);
    maker.time(ours, Phase::query, steady(1));
    for (int i = 0; i < 3; ++i) {
        const auto peer = maker.cell("peer", true);
        maker.time(peer, Phase::query, steady(2));
        results::Cell& cell = maker.results.cells[peer];
        if (i == 0)
            cell.task = "tree_pairs";
        else if (i == 1)
            cell.threads = 2;
        else
            cell.scene_id = 5;
    }
    EXPECT_TRUE(against_peers(maker.results).empty());
}

TEST(ComparePeers, WrongIsNeverRanked) {
    Maker maker(9);
    const auto ours = maker.cell("ours", false),
               wrong = maker.cell("wrong", true, results::Status::wrong),
               unchecked = maker.cell("unchecked", true, results::Status::unchecked),
               right = maker.cell("right", true);
    for (const auto cell : {ours, wrong, unchecked, right})
        maker.time(cell, Phase::query, steady(10.0 * (cell + 1)));
    auto rows = against_peers(maker.results);
    EXPECT_EQ(row_of(rows, wrong, ours, Phase::query).verdict, Verdict::wrong);
    EXPECT_TRUE(std::isnan(row_of(rows, wrong, ours, Phase::query).ratio));
    EXPECT_EQ(row_of(rows, unchecked, ours, Phase::query).verdict, Verdict::cannot_tell);
    EXPECT_EQ(row_of(rows, unchecked, ours, Phase::query).reason, Reason::unchecked);
    EXPECT_EQ(row_of(rows, right, ours, Phase::query).verdict, Verdict::faster);
    maker.results.samples[3].flags |= results::wrong_answer; // one round of ours
    rows = against_peers(maker.results);
    EXPECT_EQ(row_of(rows, right, ours, Phase::query).verdict, Verdict::wrong);
}

TEST(ComparePeers, AFamilyIsCorrected) {
    Maker maker(9); // p of one claim is 2/512: among 12 it can stand alone, not among 13
    const auto ours = maker.cell("ours", false), slow = maker.cell("slow", true);
    maker.time(ours, Phase::query, steady(1));
    maker.time(slow, Phase::query, steady(2));
    const Clock now_one_now_the_other = [](std::uint32_t round) { return round % 2 ? 0.5 : 2; };
    for (int others = 1; others <= 12; ++others) {
        maker.time(maker.cell("peer", true), Phase::query, now_one_now_the_other);
        const auto rows = against_peers(maker.results);
        EXPECT_EQ(row_of(rows, slow, ours, Phase::query).verdict,
                  others < 12 ? Verdict::faster : Verdict::cannot_tell);
    }
    // Beside others that are as clear it need not.
    maker.time(maker.cell("slow", true), Phase::query, steady(3));
    EXPECT_EQ(row_of(against_peers(maker.results), slow, ours, Phase::query).verdict,
              Verdict::faster);
}

TEST(NoiseFloor, FromTheTwinAndBoundsClaims) {
    Maker maker(9);
    const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
    maker.time(ours, Phase::query, steady(100));
    maker.time(peer, Phase::query, steady(112));
    EXPECT_FALSE(floor_of(maker.results));
    EXPECT_EQ(against_peers(maker.results)[0].verdict, Verdict::faster);
    maker.time(ours, Phase::query, steady(100 / 1.15), results::aa_twin);
    ASSERT_TRUE(floor_of(maker.results));
    EXPECT_NEAR(*floor_of(maker.results), 0.15, 1e-9); // below 1 counts as much as above
    const Comparison row = against_peers(maker.results)[0];
    EXPECT_EQ(row.verdict, Verdict::cannot_tell);
    EXPECT_EQ(row.reason, Reason::below_the_floor);
    EXPECT_NEAR(row.floor, 0.15, 1e-9);
    EXPECT_EQ(row.delta, default_delta);
}

TEST(Comparisons, SayWhereTheMemoryLayoutDecides) {
    for (const bool by_layout : {true, false}) {
        Maker maker(15);
        const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
        maker.time(ours, Phase::query, steady(100));
        maker.time(peer, Phase::query, [](std::uint32_t round) { return round % 2 ? 120. : 80.; });
        for (results::Shard& shard : maker.results.shards)
            shard.padding_bytes =
                64 * (by_layout ? 100 * (shard.round % 2) + shard.round : shard.round);
        const Comparison row = against_peers(maker.results)[0];
        EXPECT_EQ(row.verdict, Verdict::cannot_tell);
        EXPECT_EQ(row.reason, by_layout ? Reason::memory_layout : Reason::crosses_1);
        EXPECT_EQ(row.words, by_layout ? "can't tell (flips with the memory layout)"
                                       : "can't tell (may be equal)");
    }
}

TEST(ComparePeers, WhereOneSideKeepsNoStructureOnlyTheSumIsCompared) {
    Maker maker(9);
    const auto ours = maker.cell("ours", false), copies = maker.cell("copies", true);
    maker.time(ours, Phase::build, steady(5000));
    maker.time(ours, Phase::query, steady(1000));
    maker.time(copies, Phase::build, steady(200));
    maker.time(copies, Phase::query, steady(10'000));
    maker.results.variants[copies].keeps_structure = 0;
    const auto rows = against_peers(maker.results);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].phase, Phase::build_and_query);
    EXPECT_EQ(rows[0].verdict, Verdict::faster);
}

TEST(ComparePeers, NeitherAreThePartsOfAFrame) {
    for (const auto field :
         {&results::Variant::keeps_structure, &results::Variant::answers_from_cache}) {
        Maker maker(9);
        const auto ours = maker.cell("ours", false), other = maker.cell("other", true);
        for (const auto cell : {ours, other}) {
            maker.time(cell, Phase::update, steady(200));
            maker.time(cell, Phase::query, steady(1000));
        }
        EXPECT_EQ(against_peers(maker.results).size(), 3u);
        std::uint32_t& value = maker.results.variants[other].*field;
        value = !value;
        const auto rows = against_peers(maker.results);
        ASSERT_EQ(rows.size(), 1u);
        EXPECT_EQ(rows[0].phase, Phase::update_and_query);
    }
}

TEST(ComparePeers, BuildersAloneOnlyWhereTheFasterOnesTreeIsAsGood) {
    // Ours takes half of the peer's time; by the cost of its tree over that of the peer's.
    for (const auto& [cost, is_compared] :
         {std::pair{0.8, true}, {1.0, true}, {1.009, true}, {1.05, false}})
        for (const char* task : {"build", "pairs"}) {
            RunForTest run;
            const auto ours = run.cell("uniform", 1000, task, "lbvh.tree"),
                       peer = run.cell("uniform", 1000, task, "embree.rtc_build_bvh.high");
            run.time(ours, Phase::build, 100);
            run.time(peer, Phase::build, 200);
            for (const auto cell : {ours, peer}) {
                results::TreeRow tree;
                tree.cell_id = cell;
                tree.sah_cost = cell == ours ? 50 * cost : 50;
                run.results.trees.push_back(tree);
            }
            EXPECT_EQ(against_peers(run.results).size(),
                      is_compared || task == std::string("pairs") ? 1u : 0u)
                << task << " " << cost;
            run.results.trees.clear();
            EXPECT_EQ(against_peers(run.results).size(), 1u);
        }
}

TEST(CompareFamilies, OursThreadsStagesAndErrors) {
    RunForTest run;
    const auto hilbert = run.cell("uniform", 1000, "pairs", "hilbert.packed"),
               wide = run.cell("uniform", 1000, "pairs", "hilbert.wide8"),
               mine = run.cell("uniform", 1000, "pairs", "mine.wide8"),
               two = run.cell("uniform", 1000, "pairs", "mine.wide8", 2),
               required = run.cell("warehouse", 10, "scene_queries", "required"),
               all = run.cell("warehouse", 10, "scene_queries", "all_stages"),
               without = run.cell("warehouse", 10, "scene_queries", "required.without_drift"),
               exact = run.cell("bunny", 100, "distance", "my.obb.distance"),
               within = run.cell("bunny", 100, "distance", "my.obb.distance.within_0.1"),
               warm = run.cell("bunny", 100, "distance", "my.obb.distance.warm.within_0.1"),
               plain = run.cell("bunny", 100, "distance", "my.obb.distance.plain");
    run.results.cells[plain].classes = "not certified";
    run.results.cells[within].classes = "an error", run.results.cells[warm].classes = "warm";
    for (const auto& [cell, ns] : {std::pair{hilbert, 100.},
                                   {wide, 80.},
                                   {mine, 40.},
                                   {two, 25.},
                                   {required, 100.},
                                   {all, 300.},
                                   {without, 80.},
                                   {exact, 100.},
                                   {within, 20.},
                                   {plain, 90.},
                                   {warm, 10.}})
        run.time(cell, Phase::query, ns);
    set_statuses(run.results);
    const auto rows = comparisons_of(run.results, Times(run.results), default_delta);
    ASSERT_EQ(rows.size(), 7u);
    const auto expect = [&](std::uint32_t a, std::uint32_t b, Family family, double ratio) {
        const Comparison& row = row_of(rows, a, b, Phase::query);
        EXPECT_EQ(row.family, family);
        EXPECT_NEAR(row.ratio, ratio, 1e-12);
    };
    expect(hilbert, wide, Family::ours, 0.8); // the first of hilbert, whose layout differs
    expect(wide, mine, Family::ours, 0.5);    // hilbert with the same layout
    expect(mine, two, Family::threads, 25. / 40);
    expect(required, all, Family::stages, 3);
    expect(without, required, Family::stages, 1.25);
    expect(exact, within, Family::errors, 0.2);
    expect(exact, plain, Family::errors, 0.9);
    EXPECT_EQ(reference_of(Index(run.results), run.results.cells[hilbert]), nullptr); // itself
}

TEST(CompareFamilies, AReferenceRunsOnAsManyThreads) {
    RunForTest run;
    const auto one = run.cell("uniform", 1000, "pairs", "hilbert.wide8"),
               two = run.cell("uniform", 1000, "pairs", "hilbert.wide8", 2),
               mine = run.cell("uniform", 1000, "pairs", "mine.wide8"),
               on_two = run.cell("uniform", 1000, "pairs", "mine.wide8", 2),
               on_four = run.cell("uniform", 1000, "pairs", "mine.wide8", 4);
    set_statuses(run.results);
    const Index index(run.results);
    const auto& cells = run.results.cells;
    EXPECT_EQ(reference_of(index, cells[mine]), &cells[one]);
    EXPECT_EQ(reference_of(index, cells[on_two]), &cells[two]);
    EXPECT_EQ(reference_of(index, cells[on_four]), nullptr);
}

TEST(CompareFamilies, AReferenceDoesTheSameWorkInTheSamePrecision) {
    RunForTest run;
    const auto other_class = run.cell("bunny", 100, "rays_closest", "hilbert.wide4"),
               other_precision = run.cell("bunny", 100, "rays_closest", "hilbert.wide8"),
               reference = run.cell("bunny", 100, "rays_closest", "hilbert.wide16"),
               mine = run.cell("bunny", 100, "rays_closest", "mine.wide2");
    auto& cells = run.results.cells;
    for (auto& cell : cells)
        cell.classes = "batches";
    cells[other_class].classes = "single rays";
    cells[other_precision].precision = "f64";
    set_statuses(run.results);
    EXPECT_EQ(reference_of(Index(run.results), cells[mine]), &cells[reference]);
}

TEST(CompareFamilies, OneThreadIsThatOfTheUsualExecutor) {
    for (const bool usual_first : {true, false}) {
        RunForTest run;
        const auto first = run.cell("uniform", 1000, "pairs", "mine.wide8"),
                   second = run.cell("uniform", 1000, "pairs", "mine.wide8"),
                   two = run.cell("uniform", 1000, "pairs", "mine.wide8", 2);
        const auto usual = usual_first ? first : second;
        run.results.cells[usual_first ? second : first].executor = "openmp";
        for (const auto cell : {first, second, two})
            run.time(cell, Phase::query, 100);
        set_statuses(run.results);
        std::vector<std::uint32_t> held_against;
        for (const Comparison& row : comparisons_of(run.results, Times(run.results), default_delta))
            if (row.family == Family::threads)
                held_against.push_back(row.cell_a);
        EXPECT_EQ(held_against, std::vector{usual});
    }
}

TEST(CompareMachines, RoundsOfOneNumberArePairedInTheOrderOfTime) {
    Maker maker(2);
    const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
    const auto add = [&](std::uint32_t cell, std::uint32_t shard, double ns) {
        results::Sample sample;
        sample.cell_id = cell;
        sample.shard_id = shard;
        sample.phase = Phase::query;
        sample.wall_ns = ns;
        maker.results.samples.push_back(sample);
    };
    add(ours, 0, 10);
    add(ours, 1, 20);
    add(peer, 1, 60); // the rows of a merged file are in any order
    add(peer, 0, 30);
    const Times times(maker.results);
    const std::vector<double> logs = times.log_ratios(ours, peer, Phase::query);
    ASSERT_EQ(logs.size(), 2u);
    for (const double log : logs)
        EXPECT_DOUBLE_EQ(log, std::log(3.0));
}

TEST(CompareClasses, OnlyWithinOneOfThem) {
    RunForTest run;
    std::map<std::string, std::uint32_t> cells;
    for (const auto& [name, classes] : {std::pair{"batch.wide8", "packets,batches"},
                                        {"one.wide8", "single rays"},
                                        {"embree.packet", "packets"},
                                        {"embree.loop", "single rays,batches"},
                                        {"embree.robust", "watertight batches"}}) {
        cells[name] = run.cell("bunny", 100, "rays_closest", name);
        run.results.cells[cells[name]].classes = classes;
        run.time(cells[name], Phase::query, 100);
    }
    std::set<std::tuple<std::string, std::string, std::string>> pairs;
    for (const Comparison& row : against_peers(run.results))
        pairs.insert({run.variant_of(row.cell_b).name, run.variant_of(row.cell_a).name,
                      row.contender_class});
    EXPECT_EQ(pairs, (decltype(pairs){{"batch.wide8", "embree.packet", "packets"},
                                      {"batch.wide8", "embree.loop", "batches"},
                                      {"one.wide8", "embree.loop", "single rays"}}));
}

TEST(CompareMachines, RoundsOfTwoMachinesDoNotMix) {
    Maker maker(10);
    const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
    maker.results.env.push_back({});
    maker.results.env[1].env_id = 1;
    maker.results.env[1].env_hash = "slow";
    for (std::uint32_t i = 5; i < 10; ++i) { // the same round numbers on a slow machine
        maker.results.shards[i].env_id = 1;
        maker.results.shards[i].round = i - 5;
    }
    const auto on = [](double ns) {
        return [ns](std::uint32_t round) { return ns * (1 + round); };
    };
    maker.time(ours, Phase::query, on(10));
    maker.time(peer, Phase::query, on(20));
    for (auto& sample : maker.results.samples)
        if (sample.shard_id >= 5)
            sample.wall_ns *= 1000;
    const auto rows = against_peers(maker.results);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].n_pairs, 10u);
    EXPECT_EQ(rows[0].ci_lo, 0.5);
    EXPECT_EQ(rows[0].ci_hi, 0.5);
}

TEST(NoiseFloor, AboveTwentyPerCentOnlyWhatIsBeyondItIsClaimed) {
    for (const auto& [ns, verdict] :
         {std::pair{120., Verdict::cannot_tell}, {1000., Verdict::faster}}) {
        Maker maker(9);
        const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
        maker.time(ours, Phase::query, steady(100));
        maker.time(peer, Phase::query, steady(ns));
        maker.time(ours, Phase::query, steady(121), results::aa_twin);
        const Comparison row = against_peers(maker.results)[0];
        EXPECT_EQ(row.verdict, verdict);
        EXPECT_EQ(row.words, verdict == Verdict::faster ? "faster" : "can't tell (too noisy)");
    }
}

TEST(NoiseFloor, IsThatOfTheKind) {
    Maker maker(9);
    const auto brief = maker.cell("brief", false), brief_peer = maker.cell("brief_peer", true),
               lengthy = maker.cell("long", false), lengthy_peer = maker.cell("long_peer", true);
    for (const auto& [cell, ns] :
         {std::pair{brief, 1e3}, {brief_peer, 1.1e3}, {lengthy, 1e7}, {lengthy_peer, 1.1e7}})
        maker.time(cell, Phase::query, steady(ns));
    maker.time(brief, Phase::query, steady(1.15e3), results::aa_twin);
    maker.time(lengthy, Phase::query, steady(1.01e7), results::aa_twin);
    const auto rows = against_peers(maker.results);
    EXPECT_EQ(row_of(rows, brief_peer, brief, Phase::query).verdict, Verdict::cannot_tell);
    EXPECT_EQ(row_of(rows, lengthy_peer, lengthy, Phase::query).verdict, Verdict::faster);
}

} // namespace
} // namespace boxwood::bench
