#include "bench/analysis/figures/work.h"

#include "bench/analysis/analyse.h"
#include "bench/testing/run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;

TEST(Work, IsOfEachRayOrElseOfEachItem) {
    RunForTest run;
    const auto pairs = run.cell("uniform", 100, "pairs", "a.wide8");
    const auto rays = run.cell("mesh", 100, "rays_any", "a.wide8");
    run.cell("uniform", 100, "pairs", "b.wide8"); // nothing was counted
    run.results.cells[rays].n_queries = 10;
    run.time(pairs, Phase::query, 5000);
    run.time(rays, Phase::query, 5000);
    run.results.counters = {{pairs, "box_tests", 700},
                            {pairs, "node_visits", 0},
                            {rays, "box_tests", 700},
                            {rays, "node_visits", 20}};
    analyse(run.results);
    const auto& work = run.results.work;
    ASSERT_EQ(work.size(), 2u);
    EXPECT_EQ(work[0].box_tests, 7);
    EXPECT_TRUE(std::isnan(work[0].node_visits));
    EXPECT_EQ(work[0].query_ns, 50);
    EXPECT_EQ(work[1].box_tests, 70);
    EXPECT_EQ(work[1].node_visits, 2);
    EXPECT_EQ(work[1].query_ns, 500);
}

TEST(QueryKernels, AreHeldAgainstTheFastestUnderTheSameTree) {
    RunForTest run;
    const auto add = [&](const char* variant, double ns) {
        const auto cell = run.cell("mesh", 100, "triangle_pairs", variant);
        run.time(cell, Phase::query, ns);
        return cell;
    };
    const auto fast = add("median.wide8.self_pairs.moller", 200),
               exact = add("median.wide8.self_pairs.exact", 500);
    add("hilbert.wide8.self_pairs.moller", 50); // under another tree, alone
    add("median.wide8.self_pairs", 50);         // without a kernel
    add("embree.wide8", 50);
    analyse(run.results);
    const auto& rows = run.results.query_kernels;
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].cell_id, fast);
    EXPECT_EQ(rows[0].times_fastest, 1);
    EXPECT_EQ(rows[1].cell_id, exact);
    EXPECT_EQ(rows[1].times_fastest, 2.5);
    for (const auto& row : rows) {
        EXPECT_EQ(row.group, 0u);
        EXPECT_EQ(row.tree, "median.wide8.self_pairs");
    }
}

} // namespace
} // namespace boxwood::bench
