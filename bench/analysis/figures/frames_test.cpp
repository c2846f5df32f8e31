#include "bench/analysis/figures/frames.h"

#include "bench/analysis/status.h"
#include "bench/testing/run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

using results::FrameMedian;
using results::FrameStats;

/// A moving scene played in several ways, three rounds each.
class Frames : public testing::Test {
  protected:
    std::uint32_t add(const std::string& variant, const std::string& builder) {
        const std::uint32_t cell = run.cell("uniform", 100, "moving_pairs", variant);
        run.variant_of(cell).builder = builder;
        return cell;
    }
    void frame(std::uint32_t cell, std::uint32_t number, std::vector<double> update,
               std::vector<double> query) {
        for (std::uint32_t round = 0; round < update.size(); ++round) {
            results::FrameRow row;
            row.cell_id = cell;
            row.round = round;
            row.frame = number;
            row.update_ns = update[round];
            row.query_ns = query[round];
            run.results.frames.push_back(row);
        }
    }
    void analyse() {
        set_statuses(run.results);
        medians = run.results.frame_medians = frame_medians_of(run.results);
        stats = frame_stats_of(run.results);
    }

    RunForTest run;
    std::vector<FrameMedian> medians;
    std::vector<FrameStats> stats;
};

TEST_F(Frames, AreMediansOverTheRoundsOfUpdateAndQueryTogether) {
    const auto cell = add("auto", "auto");
    // The sums are 11, 22 and 13, whose median is of another round than that of the queries.
    frame(cell, 0, {10, 2, 5}, {1, 20, 8});
    frame(cell, 1, {10, results::missing, 30}, {4, 4, 6}); // a round without a time is left out
    run.results.frames[0].box_tests = 700;
    run.results.frames[0].sah = 12;
    analyse();
    ASSERT_EQ(medians.size(), 2u);
    EXPECT_EQ(medians[0].frame_ns, 13);
    EXPECT_EQ(medians[0].query_ns, 8);
    EXPECT_EQ(medians[0].box_tests_per_item, 7); // of 100 items
    EXPECT_EQ(medians[0].sah, 12);
    EXPECT_EQ(medians[1].frame, 1u);
    EXPECT_EQ(medians[1].frame_ns, 25); // between 14 and 36
    EXPECT_EQ(medians[1].query_ns, 5);
    EXPECT_TRUE(std::isnan(medians[1].box_tests_per_item));
    EXPECT_EQ(medians[1].over_fresh, 5. / 8); // against its own first frame
    ASSERT_EQ(stats.size(), 1u);
    EXPECT_EQ(stats[0].fresh_cell, results::no_id);
    EXPECT_EQ(stats[0].degradation, 5. / 8);
}

TEST_F(Frames, AreHeldAgainstThoseOfTheStructureThatIsRebuilt) {
    const auto kept = add("reinsert", "reinsert"),
               fresh = add("rebuild.trigger0", "rebuild_trigger0");
    const auto other = run.cell("clusters", 100, "moving_pairs", "reinsert");
    for (const std::uint32_t number : {0u, 1u, 2u}) {
        frame(fresh, number, {50}, {10.0 + number});     // 10, 11, 12
        frame(kept, number, {5}, {20.0 * (1 + number)}); // 20, 40, 60
        frame(other, number, {5}, {20});
    }
    analyse();
    ASSERT_EQ(medians.size(), 9u);
    EXPECT_EQ(medians[0].cell_id, kept);
    EXPECT_DOUBLE_EQ(medians[0].over_fresh, 2);
    EXPECT_DOUBLE_EQ(medians[2].over_fresh, 5);
    EXPECT_EQ(medians[4].over_fresh, 1); // against itself
    ASSERT_EQ(stats.size(), 3u);
    EXPECT_EQ(stats[0].fresh_cell, fresh);
    EXPECT_DOUBLE_EQ(stats[0].degradation, 2.5);
    EXPECT_EQ(stats[2].fresh_cell, results::no_id); // of another scene
    run.results.checks[fresh].status = results::Status::wrong;
    analyse();
    EXPECT_EQ(stats[0].fresh_cell, results::no_id);
    EXPECT_DOUBLE_EQ(stats[0].degradation, 3);
}

TEST_F(Frames, HavePercentilesAsNumpyHasThem) {
    const auto cell = add("auto", "auto");
    for (std::uint32_t number = 0; number < 21; ++number) // 0, 1, ... 20 ms, in another order
        frame(cell, number, {1e6 * (number * 8 % 21)}, {0});
    analyse();
    ASSERT_EQ(stats.size(), 1u);
    EXPECT_EQ(stats[0].n, 21u);
    EXPECT_DOUBLE_EQ(stats[0].p50_ns, 10e6);
    EXPECT_DOUBLE_EQ(stats[0].p95_ns, 19e6);
    EXPECT_DOUBLE_EQ(stats[0].p99_ns, 19.8e6);
    EXPECT_EQ(stats[0].max_ns, 20e6);
    EXPECT_EQ(stats[0].over_1_ms, 19. / 21);   // 2 to 20
    EXPECT_EQ(stats[0].over_16_6_ms, 4. / 21); // 17 to 20
}

} // namespace
} // namespace boxwood::bench
