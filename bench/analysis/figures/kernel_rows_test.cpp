#include "bench/analysis/figures/kernel_rows.h"

#include "bench/analysis/analyse.h"
#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace boxwood::bench {
namespace {

using results::KernelRow;
using ::testing::ElementsAre;

class KernelRows : public testing::Test {
  protected:
    KernelRow& add(const std::string& family, const std::string& task, const std::string& kernel,
                   double ns, std::uint64_t wrong = 0, const char* precision = "f64") {
        const auto cell = run.cell(family, 1000, task, kernel);
        run.results.cells[cell].precision = precision;
        KernelRow row;
        row.cell_id = cell;
        row.family = family;
        row.panel = "generic";
        row.task = task;
        row.kernel = kernel;
        row.promise = "no promise";
        row.n = 1000;
        row.ns_per_call = ns;
        row.false_pos = wrong;
        row.tier_0 = 1000;
        run.results.kernels.push_back(row);
        return run.results.kernels.back();
    }
    void condition(std::uint32_t cell, double decade, std::uint64_t n, double error,
                   double bound = results::missing) {
        run.results.conditions.push_back({cell, decade, n, error, bound});
    }
    std::set<std::string> front() {
        analyse(run.results);
        std::set<std::string> names;
        for (const auto& cost : run.results.kernel_costs)
            if (cost.on_front)
                names.insert(cost.kernel);
        return names;
    }

    RunForTest run;
};

TEST_F(KernelRows, TheWorstErrorOfAllFamiliesCounts) {
    run.results.kernels.reserve(9);
    for (const auto& [family, error] : {std::pair{"slivers", 1e-3}, {"needles", 1e-9}}) {
        KernelRow& row = add(family, "triangle_distance", "mine", 7);
        row.max_rel_err = error;
        condition(row.cell_id, 1, 10, error);
    }
    analyse(run.results);
    ASSERT_EQ(run.results.kernel_costs.size(), 1u);
    EXPECT_EQ(run.results.kernel_costs[0].max_rel_err, 1e-3);
    EXPECT_EQ(run.results.kernel_costs[0].badness, 1e-3);
}

TEST_F(KernelRows, HaveALabelATimeAndRates) {
    run.results.kernels.reserve(9);
    KernelRow& row = add("slivers", "triangle_triangle", "mine_f32", 7, 2, "f32");
    row.false_neg = 3;
    row.bound_violations = 5;
    row.maybe = 20;
    KernelRow& swept = add("slivers", "triangle_triangle", "fcl.tri", 7, 0, "f32");
    run.time(swept.cell_id, results::Phase::query, 4000);
    add("slivers", "triangle_triangle", "fcl.tri_f32", 7, 0, "f32");
    add("slivers", "triangle_triangle", "fcl.tri", 7);
    analyse(run.results);
    const auto& rows = run.results.kernels;
    EXPECT_EQ(rows[0].wrong, 10u);
    EXPECT_EQ(rows[0].wrong_per_million, 10000);
    EXPECT_EQ(rows[0].maybe_per_million, 20000);
    EXPECT_EQ(rows[0].ns, 7); // the check's own
    EXPECT_EQ(rows[1].ns, 4); // the sweep's, of 1000 calls
    EXPECT_THAT((std::vector{rows[0].label, rows[1].label, rows[2].label, rows[3].label}),
                ElementsAre("mine_f32", "fcl.tri f32", "fcl.tri_f32", "fcl.tri"));
}

TEST_F(KernelRows, OnTheFrontStandThoseOfOursThatNoFasterOneOfOursBetters) {
    add("slivers", "triangle_triangle", "fast", 5, 30);
    add("slivers", "triangle_triangle", "slower_and_worse", 6, 40);
    add("slivers", "triangle_triangle", "slower_and_as_bad", 7, 30);
    add("slivers", "triangle_triangle", "better", 8, 10);
    add("slivers", "triangle_triangle", "right", 9, 0);
    add("slivers", "triangle_triangle", "right_and_slow", 10, 0);
    add("slivers", "triangle_triangle", "fcl.best", 1, 0);
    add("slivers", "triangle_triangle", "silent", 4, 0).maybe =
        400; // what is left open, is no answer
    EXPECT_EQ(front(), (std::set<std::string>{"fast", "better", "right"}));
    std::map<std::string, double> unexcluded;
    for (const auto& cost : run.results.kernel_costs) {
        EXPECT_EQ(cost.wrong_per_million, 1000.0 * static_cast<double>(cost.wrong));
        EXPECT_EQ(cost.by_error, 0u);
        EXPECT_EQ(cost.badness, cost.wrong_per_million);
        unexcluded[cost.kernel] = cost.unexcluded_per_million;
    }
    EXPECT_EQ(unexcluded["right"], 3000); // 3 / 1000
    EXPECT_TRUE(std::isnan(unexcluded["fast"]));
}

TEST_F(KernelRows, DistancesAreJudgedByTheirErrors) {
    const auto distance = [&](const char* kernel, double ns, double error,
                              std::uint64_t wrong = 0) {
        KernelRow& row = add("slivers", "triangle_distance", kernel, ns, wrong);
        row.max_rel_err = error;
        condition(row.cell_id, 0, 1000, error);
    };
    distance("no_digit", 3, 7);
    distance("none_either", 4, 50);
    distance("some", 5, 1e-9, 900);
    distance("fewer", 6, 1e-6);
    distance("half_an_ulp", 7, 0x1p-54);
    distance("none", 8, 0);
    EXPECT_EQ(front(), (std::set<std::string>{"no_digit", "some", "half_an_ulp"}));
    std::vector<double> badness; // by rising time
    for (const auto& cost : run.results.kernel_costs) {
        EXPECT_EQ(cost.by_error, 1u);
        EXPECT_TRUE(std::isnan(cost.unexcluded_per_million));
        badness.push_back(cost.badness);
    }
    constexpr double inf = std::numeric_limits<double>::infinity();
    EXPECT_THAT(badness, ElementsAre(inf, inf, 1e-9, 1e-6, 0, 0));
}

TEST_F(KernelRows, PanelsStandInOneOrder) {
    for (const char* panel : {"touching", "degenerate", "generic"})
        add(panel, "triangle_triangle", "any", 5).panel = panel;
    analyse(run.results);
    std::vector<std::string> panels;
    for (const auto& cost : run.results.kernel_costs)
        panels.push_back(cost.panel);
    EXPECT_THAT(panels, ElementsAre("generic", "touching", "degenerate"));
}

TEST_F(KernelRows, ConditionsAreTheWorstOverTheFamilies) {
    const auto slivers = add("slivers", "triangle_distance", "certified", 5).cell_id;
    const auto needles = add("needles", "triangle_distance", "certified", 5).cell_id;
    const auto peer = add("needles", "triangle_distance", "fcl.distance", 5).cell_id;
    KernelRow& skipped = add("wedges", "triangle_distance", "certified", 5);
    skipped.status = results::Status::unsupported;
    condition(slivers, 0, 10, 1e-16, 4e-16);
    condition(slivers, 1, 20, 1e-15, 4e-15);
    condition(needles, 1, 30, 5e-15, 2e-15);
    condition(peer, 1, 40, 1e-3);
    condition(skipped.cell_id, 1, 50, 1);
    analyse(run.results);
    const auto& rows = run.results.kernel_conditions;
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].n, 10u);
    EXPECT_EQ(rows[1].log10_condition, 1);
    EXPECT_EQ(rows[1].n, 50u);
    EXPECT_EQ(rows[1].max_rel_err, 5e-15);
    EXPECT_EQ(rows[1].bound, 4e-15);
    EXPECT_EQ(rows[2].kernel, "fcl.distance");
    EXPECT_EQ(rows[2].is_peer, 1u);
    EXPECT_TRUE(std::isnan(rows[2].bound));
}

TEST_F(KernelRows, EscalationsAreOfOursThatDecidedSomeByTierZeroAndOthersNot) {
    const auto tiers = [&](const char* family, const char* kernel, std::uint64_t zero,
                           std::uint64_t one, std::uint64_t two) {
        KernelRow& row = add(family, "triangle_triangle", kernel, 5);
        row.tier_0 = zero;
        row.tier_1 = one;
        row.tier_2 = two;
    };
    tiers("slivers", "adaptive", 600, 300, 100);
    tiers("needles", "adaptive", 1000, 0, 0);
    tiers("slivers", "plain", 1000, 0, 0);
    tiers("slivers", "always_exact", 0, 0, 1000);
    tiers("slivers", "fcl.adaptive", 600, 400, 0);
    analyse(run.results);
    const auto& rows = run.results.escalations;
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].cell_id, 0u);
    EXPECT_EQ(rows[0].share_0, 0.6);
    EXPECT_EQ(rows[0].share_1, 0.3);
    EXPECT_EQ(rows[0].share_2, 0.1);
    EXPECT_EQ(rows[1].share_0, 1);
    EXPECT_EQ(rows[2].cell_id, results::no_id);
    EXPECT_EQ(rows[2].kernel, "adaptive");
    EXPECT_EQ(rows[2].share_0, 0.8);
    EXPECT_EQ(rows[2].share_2, 0.05);
}

} // namespace
} // namespace boxwood::bench
