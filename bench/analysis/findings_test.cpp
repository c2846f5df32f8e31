#include "bench/analysis/findings.h"

#include "bench/analysis/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace boxwood::bench {
namespace {

using testing::HasSubstr;
using testing::Not;

/// One scene and ask; each cell of a variant of its own, timed in nine rounds.
struct Findings : testing::Test {
    results::Results r;

    Findings() {
        r.scenes.push_back({});
        r.scenes[0].name = "uniform";
        r.shards.push_back({});
        r.env.push_back({});
    }

    void add(const std::string& name, const std::string& library, double build_ns, double query_ns,
             const std::string& status = "exact", const std::string& witness = "") {
        const auto id = static_cast<std::uint32_t>(r.cells.size());
        results::Variant variant;
        variant.variant_id = id;
        variant.name = name;
        variant.library = library;
        variant.is_peer = library != "boxwood";
        r.variants.push_back(variant);
        results::Cell cell;
        cell.cell_id = cell.variant_id = id;
        cell.name = "cell/" + name;
        cell.task = "pairs";
        r.cells.push_back(cell);
        results::Check check;
        check.cell_id = id;
        check.status = status;
        check.witness = witness;
        r.checks.push_back(check);
        for (std::uint32_t round = 0; round < 9; ++round)
            for (const bool is_query : {false, true}) {
                results::Sample sample;
                sample.cell_id = id;
                sample.round = round;
                sample.phase = is_query ? "query" : "build";
                sample.wall_ns = is_query ? query_ns : build_ns;
                r.samples.push_back(sample);
            }
        r.compare = compare_to_peers(r);
    }
};

TEST_F(Findings, ShowTheBestOfEachLibraryAndItsRatio) {
    add("ours_slow", "boxwood", 100, 900);
    add("ours_best", "boxwood", 100, 300);
    add("peer_best", "fcl", 100, 1100);
    add("peer_slow", "fcl", 100, 5000);
    const std::string text = findings_text(r);
    EXPECT_THAT(text, HasSubstr("ours_best"));
    EXPECT_THAT(text, HasSubstr("peer_best"));
    EXPECT_THAT(text, HasSubstr("3.00 [3.00, 3.00] faster")); // 1200 / 400
    EXPECT_THAT(text, HasSubstr("3.67 [3.67, 3.67] faster")); // 1100 / 300
    EXPECT_THAT(text, Not(HasSubstr("slow")));
    EXPECT_FALSE(is_promise_broken(r));
}

TEST_F(Findings, ChooseTheBestOfEachMeasureByItself) {
    add("ours_quick_build", "boxwood", 100, 300);
    add("ours_quick_query", "boxwood", 900, 200);
    add("peer", "fcl", 700, 600);
    const std::string text = findings_text(r);
    EXPECT_THAT(text, HasSubstr("3.25 [3.25, 3.25] faster")); // 1300 / 400, build and query
    EXPECT_THAT(text, HasSubstr("3.00 [3.00, 3.00] faster")); // 600 / 200, query alone
}

TEST_F(Findings, RankUpdatesWithTheirQueriesAndBuildsThatNothingFollows) {
    add("ours", "boxwood", 100, 300);
    add("peer", "fcl", 700, 500);
    for (results::Sample& sample : r.samples)
        if (sample.phase == "build")
            sample.phase = "update";
    r.compare = compare_to_peers(r);
    EXPECT_THAT(findings_text(r), HasSubstr("3.00 [3.00, 3.00] faster")); // 1200 / 400
    std::erase_if(r.samples, [](const auto& sample) { return sample.phase == "query"; });
    for (results::Sample& sample : r.samples)
        sample.phase = "build";
    r.compare = compare_to_peers(r);
    EXPECT_THAT(findings_text(r), HasSubstr("7.00 [7.00, 7.00] faster"));
}

TEST_F(Findings, NeverRankWhatIsWrong) {
    add("ours", "boxwood", 100, 300);
    add("rogue", "fcl", 1, 1, "wrong", "pair 3 4");
    const std::string text = findings_text(r);
    EXPECT_THAT(text.substr(0, text.find("Wrong")), Not(HasSubstr("rogue")));
    EXPECT_THAT(text, HasSubstr("cell/rogue: 0 missing, 0 extra; pair 3 4"));
    EXPECT_FALSE(is_promise_broken(r)); // a peer promised nothing
    add("ours_wrong", "boxwood", 1, 1, "wrong", "pair 1 2");
    EXPECT_TRUE(is_promise_broken(r));
}

TEST_F(Findings, ALaterWrongAnswerOrACrashBreaksThePromise) {
    add("ours", "boxwood", 100, 300);
    r.samples[3].flags |= results::wrong_answer;
    EXPECT_TRUE(is_promise_broken(r));
    EXPECT_THAT(findings_text(r), HasSubstr("a timed round answered otherwise"));
    r.samples[3].flags = 0;
    EXPECT_FALSE(is_promise_broken(r));
    add("peer", "fcl", 1, 1, "wrong", "crashed: signal 11 in round 2");
    EXPECT_TRUE(is_promise_broken(r));
}

TEST_F(Findings, AKernelWithoutAPromiseMayErrAndOneWithMayNot) {
    const auto add_kernel = [&](const std::string& rung, const std::string& promise,
                                std::uint64_t false_neg, double ns) {
        add(rung, "boxwood", results::missing, 100 * ns, false_neg > 0 ? "wrong" : "exact");
        r.cells.back().task = "triangle_triangle";
        results::KernelRow row;
        row.cell_id = r.cells.back().cell_id;
        row.family = "slivers";
        row.panel = "degenerate";
        row.task = "triangle_triangle";
        row.kernel = rung;
        row.promise = promise;
        row.n = row.tier_0 = 100;
        row.false_neg = false_neg;
        row.status = false_neg > 0 ? "wrong" : "exact";
        row.witness = "case 7";
        r.kernels.push_back(row);
    };
    add_kernel("plain", "no promise", 3, 10);
    add_kernel("sure", "exact", 0, 25);
    const std::string text = findings_text(r);
    EXPECT_FALSE(is_promise_broken(r));
    EXPECT_THAT(text, HasSubstr("plain errs on slivers 3/100"));
    EXPECT_THAT(text, HasSubstr("degenerate input: cheapest rung with no wrong answer on these "
                                "cases: sure, at 2.50 times the fastest (plain)"));
    EXPECT_THAT(text, HasSubstr("Every promise is kept."));
    EXPECT_THAT(text, Not(HasSubstr("not ranked")));
    add_kernel("liar", "never-miss", 1, 5);
    EXPECT_TRUE(is_promise_broken(r));
    EXPECT_THAT(findings_text(r), HasSubstr("BROKEN PROMISE: liar promises never-miss on slivers/"
                                            "triangle_triangle\n  case 7"));
}

} // namespace
} // namespace boxwood::bench
