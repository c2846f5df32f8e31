#include "bench/analysis/analyse.h"
#include "bench/analysis/promises.h"
#include "bench/analysis/screen.h"
#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace boxwood::bench {
namespace {

using results::Finding;
using results::Phase;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

struct Findings : testing::Test {
    RunForTest run;

    std::uint32_t add(const std::string& scene, const std::string& task, const std::string& variant,
                      double build_ns, double query_ns, std::uint32_t threads = 1,
                      std::uint64_t n = 10) {
        const auto cell = run.cell(scene, n, task, variant, threads);
        run.time(cell, Phase::build, build_ns);
        run.time(cell, Phase::query, query_ns);
        return cell;
    }
    std::uint32_t add_kernel(const std::string& kernel, const std::string& promise,
                             std::uint64_t false_neg, double ns, std::uint64_t maybe = 0) {
        const auto cell = run.cell("slivers", 100, "triangle_triangle", kernel);
        run.time(cell, Phase::query, 100 * ns);
        results::KernelRow row;
        row.cell_id = cell;
        row.family = "slivers";
        row.panel = "degenerate";
        row.task = "triangle_triangle";
        row.kernel = kernel;
        row.promise = promise;
        row.n = row.tier_0 = 100;
        row.false_neg = false_neg;
        row.maybe = maybe;
        row.status = false_neg > 0 ? results::Status::wrong : results::Status::exact;
        row.witness = "case 7";
        run.results.kernels.push_back(row);
        run.results.checks[cell].status = row.status;
        return cell;
    }
    void time_twin(std::uint32_t cell, double query_ns) {
        const std::size_t before = run.results.samples.size();
        run.time(cell, Phase::query, query_ns);
        for (std::size_t i = before; i < run.results.samples.size(); ++i)
            run.results.samples[i].flags = results::aa_twin;
    }
    std::string screen() {
        analyse(run.results);
        return screen_text(run.results);
    }
    const Finding& only() {
        analyse(run.results);
        EXPECT_EQ(run.results.findings.size(), 1u);
        return run.results.findings.at(0);
    }
};

TEST_F(Findings, HoldTheBestOfOursAgainstTheBestRival) {
    add("uniform", "pairs", "slow.packed", 100, 900);
    const auto ours = add("uniform", "pairs", "quick.packed", 100, 300);
    const auto rival = add("uniform", "pairs", "fcl.best", 100, 1100);
    add("uniform", "pairs", "fcl.slow", 100, 5000);
    const Finding& row = only();
    EXPECT_EQ(row.ours, ours);
    EXPECT_EQ(row.rival, rival);
    EXPECT_EQ(row.together, "wins 3.00x over FCL"); // 1200 / 400
    EXPECT_EQ(row.alone, "wins 3.67x");             // 1100 / 300, over the same
    EXPECT_EQ(row.certainty, "3.00 to 3.00 (both)");
    EXPECT_EQ(row.question, "overlapping pairs, uniform 10");
    EXPECT_FALSE(is_promise_broken(run.results));
}

TEST_F(Findings, APeerThatTwoThreadsSlowDownStandsWithOne) {
    const auto ours = add("uniform", "pairs", "quick.packed", 100, 300, 2),
               one = add("uniform", "pairs", "embree.bvh", 100, 1100),
               two = add("uniform", "pairs", "embree.bvh", 50, 1450, 2);
    const auto without = add("uniform", "pairs", "fcl.tree", 2000, 5000); // it has no threads
    const auto rivals = [&] {
        analyse(run.results);
        std::vector<std::uint32_t> cells;
        for (const results::Comparison& row : run.results.compare)
            if (row.family == results::Family::peers && row.cell_b == ours)
                cells.push_back(row.cell_a);
        return cells;
    };
    EXPECT_THAT(rivals(), UnorderedElementsAre(two, one, one, // build, query, their sum
                                               without, without, without));
    EXPECT_EQ(run.results.findings.at(0).rival, one);
    EXPECT_EQ(run.results.findings.at(0).together, "wins 3.00x over Embree on 1 thread");
    // One that does not support two threads is as one without a cell there.
    const auto refused = run.cell("uniform", 10, "pairs", "fcl.tree", 2);
    run.results.checks[refused].status = results::Status::unsupported;
    EXPECT_THAT(rivals(), UnorderedElementsAre(two, one, one, without, without, without));
    run.results.checks[one].status = results::Status::wrong;
    EXPECT_THAT(rivals(), UnorderedElementsAre(two, two, two, without, without, without));
    EXPECT_EQ(run.results.findings.at(0).together, "wins 3.75x over Embree");
}

TEST_F(Findings, NameTheKindOfRaysAndTheScene) {
    for (const char* name : {"ours.wide8.rays", "embree.rtc"})
        add("sphere_mesh_primary", "rays_closest", name, 10, 100);
    run.results.scenes[0].rays = "primary";
    run.results.scenes[0].human_name = "a sphere";
    EXPECT_EQ(only().question, "nearest hit, primary rays, a sphere");
}

TEST_F(Findings, ChooseTheBestOfEachMeasureByItself) {
    const auto builds = add("uniform", "pairs", "builds.packed", 100, 300),
               queries = add("uniform", "pairs", "queries.packed", 900, 200);
    add("uniform", "pairs", "fcl.tree", 700, 600);
    const Finding& row = only();
    EXPECT_EQ(row.ours, builds);
    EXPECT_EQ(row.ours_alone, queries);
    EXPECT_EQ(row.together, "wins 3.25x over FCL");   // 1300 / 400
    EXPECT_EQ(row.alone, "wins 3.00x");               // 600 / 200
    EXPECT_EQ(row.certainty, "3.00 to 3.00 (query)"); // of what it is ranked by
}

TEST_F(Findings, RankUpdatesWithTheirQueriesAndBuildsThatNothingFollows) {
    for (const auto& [name, update, query] :
         {std::tuple{"auto", 100., 300.}, {"fcl.moved", 700., 500.}}) {
        const auto cell = add("drift", "moving_pairs", name, 1, query);
        run.time(cell, Phase::update, update);
    }
    EXPECT_EQ(only().together, "wins 3.00x over FCL"); // 1200 / 400
    EXPECT_EQ(only().alone, "");
    run = {};
    for (const auto& [name, build] : {std::pair{"hilbert", 1000.}, {"embree.low", 700.}})
        run.time(run.cell("uniform", 10, "build", name), Phase::build, build);
    EXPECT_EQ(only().together, "LOSES 0.700x to Embree");
}

TEST_F(Findings, LossesComeFirstAndOneRowStandsForAQuestion) {
    for (const std::uint64_t n : {10u, 1000u})
        for (const std::uint32_t threads : {1u, 2u}) {
            add("uniform", "pairs", "ours.packed", 10, threads == 2 ? 200 : 100, threads, n);
            add("uniform", "pairs", "fcl.tree", 10, 150, threads, n);
        }
    add("bars", "pairs", "ours.packed", 10, 100);
    add("bars", "pairs", "embree.bvh", 10, 101);
    analyse(run.results);
    std::vector<std::string> headlines;
    for (const Finding& row : run.results.findings)
        if (row.is_headline)
            headlines.push_back(row.question + ": " + row.together);
    EXPECT_THAT(headlines, ElementsAre("overlapping pairs, 2 threads, uniform 1k: LOSES 0.762x "
                                       "to FCL",
                                       "overlapping pairs, bars 10: even with Embree"));
    EXPECT_EQ(run.results.findings.size(), 5u);
    EXPECT_THAT(screen(), HasSubstr("and 3 more (1 losses): "));
}

TEST_F(Findings, WithoutPeersOursStandAgainstTheirReference) {
    add("uniform", "pairs", "hilbert.packed", 100, 300);
    add("uniform", "pairs", "mine.packed", 100, 100);
    EXPECT_EQ(only().together, "wins 2.00x over hilbert");
    EXPECT_EQ(only().alone, "wins 3.00x");
}

TEST_F(Findings, StayWhereTheReferenceIsTheFastest) {
    add("uniform", "pairs", "hilbert.packed", 100, 100);
    add("uniform", "pairs", "mine.packed", 100, 300);
    EXPECT_EQ(only().together, "LOSES 0.500x to hilbert");
}

TEST_F(Findings, SayWhyNothingCanBeTold) {
    run.rounds = 5;
    add("uniform", "pairs", "ours.packed", 100, 300);
    add("uniform", "pairs", "fcl.tree", 100, 900);
    const Finding& row = only();
    EXPECT_EQ(row.together, "unsure, 2.50x FCL");
    EXPECT_EQ(row.certainty, "too few rounds");
    EXPECT_THAT(screen(), Not(HasSubstr("wins")));
}

TEST_F(Findings, NeverRankWhatIsWrong) {
    add("uniform", "pairs", "ours.packed", 100, 300);
    const auto rogue = add("uniform", "pairs", "fcl.rogue", 1, 1);
    run.results.checks[rogue].status = results::Status::wrong;
    EXPECT_THAT(screen(), HasSubstr("2 answers checked: 0 of ours wrong, 1 of the peers' wrong"));
    EXPECT_TRUE(run.results.findings.empty());
    EXPECT_FALSE(is_promise_broken(run.results)); // a peer promised nothing
    run.results.checks[add("uniform", "pairs", "bad.packed", 1, 1)].status = results::Status::wrong;
    EXPECT_THAT(screen(), HasSubstr("1 of ours wrong (" + run.results.cells.back().name + "), "));
    EXPECT_TRUE(is_promise_broken(run.results));
}

TEST_F(Findings, ALaterWrongAnswerOrACrashBreaksThePromise) {
    add("uniform", "pairs", "ours.packed", 100, 300);
    run.results.samples[3].flags |= results::wrong_answer;
    analyse(run.results);
    EXPECT_TRUE(is_promise_broken(run.results));
    run.results.samples[3].flags = 0;
    analyse(run.results);
    EXPECT_FALSE(is_promise_broken(run.results));
    results::Check& check = run.results.checks[add("uniform", "pairs", "fcl.tree", 1, 1)];
    check.status = results::Status::wrong;
    check.witness = "crashed: signal 11 in round 2";
    analyse(run.results);
    EXPECT_TRUE(is_promise_broken(run.results));
}

TEST_F(Findings, AKernelWithoutAPromiseMayErrAndOneWithMayNot) {
    add_kernel("plain", "no promise", 3, 10);
    EXPECT_EQ(only().together, "none is always right");
    EXPECT_EQ(only().certainty, "3 of 100 wrong");
    add_kernel("sure", "exact", 0, 25);
    EXPECT_FALSE((analyse(run.results), is_promise_broken(run.results)));
    EXPECT_EQ(only().question, "triangle triangle, degenerate");
    EXPECT_EQ(only().together, "sure, 25.0 ns");
    EXPECT_EQ(only().alone, "2.50x plain");
    EXPECT_EQ(promises_text(run.results), "Every promise is kept.\n");
    EXPECT_EQ(run.results.health[0].wrong_ours, 0u);
    add_kernel("liar", "never-miss", 1, 5);
    analyse(run.results);
    EXPECT_THAT(run.results.health[0].correctness, HasSubstr("PROMISE BROKEN: liar on slivers"));
    EXPECT_EQ(run.results.health[0].wrong_ours, 1u);
    EXPECT_TRUE(is_promise_broken(run.results));
    EXPECT_THAT(promises_text(run.results),
                HasSubstr("BROKEN PROMISE: liar promises never-miss on slivers/"
                          "triangle_triangle\n  case 7"));
}

TEST_F(Findings, AKernelThatSaysMaybeIsNotAlwaysRight) {
    add_kernel("unsure", "certified", 0, 10, 1);
    EXPECT_EQ(only().together, "none is always right");
    add_kernel("sure", "exact", 0, 25);
    EXPECT_EQ(only().together, "sure, 25.0 ns");
}

TEST_F(Findings, KernelsThatAreAlwaysRightRaceThePeersThatAreSo) {
    add_kernel("plain", "no promise", 3, 5);
    add_kernel("unsure", "certified", 0, 6, 1);
    const auto ours = add_kernel("sure", "exact", 0, 20),
               rival = add_kernel("fcl.exact", "", 0, 30);
    add_kernel("embree.wrong", "", 2, 1);
    add_kernel("bullet.silent", "", 0, 1, 4);
    analyse(run.results);
    std::vector<Finding> calls;
    for (const Finding& row : run.results.findings)
        if (row.topic == results::Topic::call)
            calls.push_back(row);
    ASSERT_EQ(calls.size(), 1u);
    EXPECT_EQ(calls[0].ours, ours);
    EXPECT_EQ(calls[0].rival, rival);
    EXPECT_EQ(calls[0].together, "wins 1.50x over FCL");
    EXPECT_EQ(calls[0].alone, "");
    EXPECT_EQ(calls[0].certainty, "1.50 to 1.50");
    EXPECT_EQ(calls[0].question, "triangle triangle, slivers 100");
    EXPECT_TRUE(calls[0].is_headline);
    EXPECT_FALSE(calls[0].is_loss);
    // Where errors are what counts, none of these is right because it is never wrong.
    run.results.conditions.push_back({ours, 1, 100, 1e3, 1e-3});
    analyse(run.results);
    for (const Finding& row : run.results.findings)
        EXPECT_NE(row.topic, results::Topic::call);
}

TEST_F(Findings, AKernelThatErrsInALaterRoundIsNotExcusedByItsPromise) {
    const auto plain = add_kernel("plain", "no promise", 3, 10);
    analyse(run.results);
    EXPECT_EQ(run.results.health[0].wrong_ours, 0u); // it promised nothing
    EXPECT_EQ(run.results.health[0].answers, 1u);
    EXPECT_THAT(
        run.results.health[0].correctness,
        HasSubstr("1 answers checked: 0 of ours wrong against a promise and 1 that none covers"));
    run.results.checks[plain].status = results::Status::exact;
    run.results.samples.front().flags |= results::wrong_answer; // not what was checked
    analyse(run.results);
    EXPECT_EQ(run.results.health[0].wrong_ours, 1u);
    EXPECT_TRUE(is_promise_broken(run.results));
}

TEST_F(Findings, CountWhatWasAnsweredAndWhatWasDisturbed) {
    add("uniform", "pairs", "ours.packed", 100, 300);
    const auto never = add("uniform", "pairs", "fcl.never", 100, 300);
    run.results.checks[never].status = results::Status::unsupported;
    run.results.samples[0].flags = results::disturbed_steal;
    run.results.samples[1].flags = results::disturbed_switches;
    run.results.samples[2].flags = results::disturbed_steal | results::disturbed_switches;
    analyse(run.results, 0.07);
    const results::Health& health = run.results.health.at(0);
    EXPECT_EQ(health.answers, 1u);
    EXPECT_EQ(health.disturbed, 3u);
    EXPECT_EQ(health.samples, 36u);
    EXPECT_DOUBLE_EQ(health.delta, 0.07);
    EXPECT_DOUBLE_EQ(delta_of(std::vector<results::Results>{{}, run.results}), 0.07);
    EXPECT_THAT(screen(), HasSubstr("9 rounds, 8.3 % of the samples disturbed"));
    EXPECT_THAT(screen(), Not(HasSubstr("beside other programs")));
    run.results.shards.at(0).other_cores = 1;
    analyse(run.results);
    EXPECT_THAT(screen(), HasSubstr("9 rounds (1 began beside other programs), 8.3 %"));
}

TEST_F(Findings, AWrongAnswerOfATwinIsOne) {
    const auto ours = add("uniform", "pairs", "ours.packed", 100, 300);
    run.time(ours, Phase::query, 300);
    run.results.samples.back().flags = results::aa_twin | results::wrong_answer;
    analyse(run.results);
    EXPECT_TRUE(is_promise_broken(run.results));
}

TEST_F(Findings, AClassWithoutRivalsSaysNothingBesideOneThatHasSome) {
    const auto ours = add("bunny", "rays_closest", "ours.wide8", 100, 300),
               hilbert = add("bunny", "rays_closest", "hilbert.wide8", 100, 400),
               rival = add("bunny", "rays_closest", "embree.rtc", 100, 900);
    run.results.cells[ours].classes = run.results.cells[hilbert].classes = "packets,batches";
    run.results.cells[rival].classes = "packets";
    EXPECT_EQ(only().contender_class, "packets");
}

TEST_F(Findings, AScenePlayedSaysItsFrameAndWhatEverythingWouldTake) {
    for (const auto& [name, update] : {std::pair{"required", 2e6}, {"all_stages", 5e6}}) {
        const auto cell = add("warehouse", "scene_queries", name, 1, 1e6);
        run.time(cell, Phase::update, update);
    }
    const Finding& row = only();
    EXPECT_EQ(row.topic, results::Topic::scene);
    EXPECT_EQ(row.together, "3.00 ms a frame");
    EXPECT_EQ(row.alone, "2.00x the time"); // 6 / 3
}

TEST_F(Findings, AScenePlayedOnADeviceSaysWhere) {
    const auto cell = add("warehouse", "scene_queries", "required", 1, 1e6);
    run.results.cells[cell].executor = results::resident_executor;
    run.time(cell, Phase::update, 2e6);
    EXPECT_THAT(only().question, testing::EndsWith(", cuda_resident"));
}

TEST_F(Findings, ANoisyRunSaysRepeatThisInstead) {
    const auto cell = add("uniform", "pairs", "ours.packed", 100, 300);
    add("uniform", "pairs", "fcl.tree", 100, 900);
    time_twin(cell, 600);
    const std::string text = screen();
    EXPECT_EQ(run.results.health[0].is_too_noisy, 1u);
    EXPECT_THAT(text, HasSubstr("REPEAT THIS"));
    EXPECT_THAT(text, Not(HasSubstr("FCL")));
    EXPECT_TRUE(run.results.findings.empty());
}

TEST_F(Findings, ARunThatIsNotQuietTellsWhatIsBeyondItsNoise) {
    const auto cell = add("uniform", "pairs", "ours.packed", 100, 300);
    add("uniform", "pairs", "fcl.tree", 100, 900);
    add("clusters", "pairs", "ours.packed", 100, 300);
    add("clusters", "pairs", "fcl.tree", 100, 380);
    time_twin(cell, 400);
    const std::string text = screen();
    EXPECT_THAT(text, HasSubstr("noise floor 33.3 %: not quiet"));
    EXPECT_EQ(run.results.health[0].is_too_noisy, 0u);
    ASSERT_EQ(run.results.findings.size(), 2u);
    EXPECT_THAT(text, HasSubstr("wins 3.00x"));
    EXPECT_THAT(text, HasSubstr("unsure, 1.27x"));
}

TEST_F(Findings, ASureLossIsNotHiddenBehindAFasterRivalThatIsOpen) {
    add("uniform", "pairs", "ours.packed", 10, 100);
    add("uniform", "pairs", "embree.bvh", 10, 85);
    const auto noisy = run.cell("uniform", 10, "pairs", "fcl.tree");
    for (const Phase phase : {Phase::build, Phase::query})
        run.time(noisy, phase, [](std::uint32_t round) { return round % 9 < 5 ? 70. : 300.; });
    const Finding& row = only();
    EXPECT_EQ(row.together, "LOSES 0.864x to Embree"); // FCL's median is less, and open
    EXPECT_EQ(row.alone, "LOSES 0.850x");
    EXPECT_TRUE(row.is_loss);
}

TEST_F(Findings, WrongKernelsOfPeersAreCounted) {
    add_kernel("plain", "no promise", 3, 10); // ours: it promised nothing
    add_kernel("sure", "exact", 0, 25);
    add_kernel("fcl.triangles", "no promise", 5, 10);
    EXPECT_THAT(screen(), HasSubstr("3 answers checked: 0 of ours wrong against a promise and 1 "
                                    "that none covers, 1 of the peers' wrong"));
}

TEST_F(Findings, OneScreenHoldsAHundredQuestions) {
    for (int i = 0; i < 100; ++i) {
        const std::string scene =
            "a_scene_with_a_name_that_is_longer_than_a_screen_can_hold_in_its_first_column_" +
            std::to_string(i);
        add(scene, "pairs", "ours.packed", 100, 300);
        add(scene, "pairs", "fcl.tree", 100, 200 + 10 * i);
    }
    std::istringstream lines(screen());
    EXPECT_THAT(screen_text(run.results, 1), HasSubstr("and 100 more ("));
    std::size_t n = 0;
    for (std::string line; std::getline(lines, line); ++n) {
        EXPECT_LE(line.size(), 120u) << line;
        EXPECT_EQ(line.find("overlapping") == 0, line.find(" FCL") != line.npos) << line;
    }
    EXPECT_LE(n, 21u); // four more say where the files are
    EXPECT_GE(n, 18u);
}

} // namespace
} // namespace boxwood::bench
