#include "bench/analysis/compare_files.h"
#include "bench/analysis/comparisons.h"
#include "bench/analysis/status.h"
#include "bench/testing/maker.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

using results::Phase;
using results::Results;

/// Eight cells of ours, the first with a twin that is 2 % off, and three peers; 9 rounds.
Results recorded() {
    Maker maker(9);
    for (int i = 0; i < 8; ++i)
        maker.time(maker.cell("ours" + std::to_string(i), false), Phase::query, steady(100 + i));
    maker.time(0, Phase::query, steady(102), results::aa_twin);
    for (int i = 0; i < 3; ++i)
        maker.time(maker.cell("peer" + std::to_string(i), true), Phase::query, steady(300 + i));
    set_statuses(maker.results);
    return maker.results;
}

/// The same run with the times of cells [first, last) multiplied.
Results slowed(double factor, std::uint32_t first, std::uint32_t last) {
    Results edited = recorded();
    for (auto& sample : edited.samples)
        if (first <= sample.cell_id && sample.cell_id < last)
            sample.wall_ns *= factor;
    return edited;
}

std::ptrdiff_t rows_with(const FileComparison& comparison, Gate gate) {
    return std::ranges::count(comparison.rows, gate, &FileRow::gate);
}

TEST(Gate, AnIdenticalFilePasses) {
    const FileComparison same = compare_files(recorded(), recorded());
    EXPECT_NEAR(same.floor.value(), 0.02, 1e-9);
    EXPECT_EQ(same.gate, Gate::passes);
    EXPECT_EQ(rows_with(same, Gate::passes), 8);
}

TEST(Gate, AFileThatLacksRoundsIsNotTheSame) {
    Results fewer = recorded();
    std::erase_if(fewer.samples, [](const auto& sample) { return sample.round >= 5; });
    EXPECT_NE(compare_files(recorded(), fewer).gate, Gate::passes);
}

TEST(Gate, EveryCellOfOursThreeTimesSlowerFails) {
    const FileComparison slower = compare_files(recorded(), slowed(3, 0, 8));
    EXPECT_EQ(slower.gate, Gate::fails);
    EXPECT_EQ(rows_with(slower, Gate::fails), 8);
}

TEST(Gate, OneCellSlowerByEightPercentIsFound) {
    for (std::uint32_t cell = 0; cell < 8; ++cell) {
        const FileComparison slower = compare_files(recorded(), slowed(1.08, cell, cell + 1));
        EXPECT_EQ(slower.gate, Gate::fails) << cell;
        EXPECT_EQ(slower.rows[cell].gate, Gate::fails) << cell;
        EXPECT_EQ(rows_with(slower, Gate::fails), 1) << cell;
    }
}

TEST(Gate, AShiftOfEveryCellIsTheMachine) {
    for (const double factor : {1.1, 1 / 1.1}) {
        const FileComparison shifted = compare_files(recorded(), slowed(factor, 0, 11));
        EXPECT_TRUE(shifted.peers_moved);
        EXPECT_EQ(shifted.gate, Gate::open);
        EXPECT_EQ(rows_with(shifted, Gate::open), 8);
    }
}

TEST(InputMedians, LieInTheIntervalOfAComparison) {
    Maker maker(15);
    const auto ours = maker.cell("ours", false), peer = maker.cell("peer", true);
    for (results::Shard& shard : maker.results.shards)
        shard.input = shard.round % 5;
    maker.time(ours, Phase::query, [](std::uint32_t) { return 100.; });
    maker.time(peer, Phase::query,
               [](std::uint32_t round) { return round % 5 == 3 ? 110. : 200.; });
    set_statuses(maker.results);
    const auto rows = comparisons_of(maker.results, Times(maker.results), default_delta);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_NEAR(rows[0].ratio, .5, 1e-12);
    EXPECT_NEAR(rows[0].ci_lo, .5, 1e-12);
    EXPECT_NEAR(rows[0].ci_hi, 1 / 1.1, 1e-12);
    EXPECT_EQ(rows[0].verdict, results::Verdict::faster);
}

TEST(NoiseFloor, OfSeveralTwinsIsTheFarthestMedianOrTheMiddleInterval) {
    Maker maker(9);
    const auto floor_with = [&](const std::string& name, double ns, double shaken) {
        const auto cell = maker.cell(name, false);
        maker.time(cell, Phase::query, steady(100));
        const auto twin = [=](std::uint32_t round) { return round < 3 ? shaken : ns; };
        maker.time(cell, Phase::query, twin, results::aa_twin);
        return *NoiseFloors(maker.results, Times(maker.results)).highest();
    };
    EXPECT_GT(floor_with("shaken", 101, 150), .4); // three rounds of nine are off
    EXPECT_GT(floor_with("quiet", 101, 101), .4);  // of two the farther
    EXPECT_NEAR(floor_with("as steady", 102, 102), .02, 1e-9);
    EXPECT_NEAR(floor_with("biased", 108, 108), .08, 1e-9); // no other one hides it
}

TEST(Times, MediansAreOfEachRound) {
    EXPECT_EQ(medians_by_round({}), std::vector<double>{});
    EXPECT_EQ(medians_by_round({{{"m", 0}, {3, 1, 2}}, {{"m", 1}, {4, 6}}}),
              (std::vector<double>{2, 5}));
}

} // namespace
} // namespace boxwood::bench
