#include "bench/advice/advice.h"

#include "bench/advice/policies.h"
#include "bench/analysis/analyse.h"
#include "bench/io/bad_input.h"
#include "bench/testing/maker.h"
#include "bench/testing/run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace boxwood::bench {
namespace {

using results::Phase;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

struct Timed {
    const char *builder, *layout;
    double build_ns, query_ns; ///< of 1000 rays
    results::Status status = results::Status::exact;
};

/// more_peers: their builders are their names.
results::Results timed(const std::vector<Timed>& ways, double peer_ns = 0, double twin = 1.001,
                       const std::vector<Timed>& more_peers = {}) {
    Maker made(15);
    const auto add = [&](const std::string& name, bool is_peer, double build, double query,
                         results::Status status) {
        const std::uint32_t cell = made.cell(name, is_peer, status);
        made.results.cells[cell].task = "rays_closest";
        made.results.cells[cell].n_queries = 1000;
        made.results.cells[cell].status = status;
        made.time(cell, Phase::build, steady(build));
        made.time(cell, Phase::query, steady(query));
        return cell;
    };
    for (const Timed& way : ways) {
        const std::uint32_t cell = add(std::string(way.builder) + "." + way.layout, false,
                                       way.build_ns, way.query_ns, way.status);
        made.results.variants[cell].builder = way.builder;
        made.results.variants[cell].layout = way.layout;
    }
    made.time(0, Phase::query, steady(ways[0].query_ns * twin), results::aa_twin);
    if (peer_ns > 0) {
        const std::uint32_t cell =
            add("embree.rtc_x", true, peer_ns, peer_ns, results::Status::exact);
        made.results.variants[cell].library_title = "Embree";
    }
    for (const Timed& peer : more_peers) {
        const std::uint32_t cell =
            add(peer.builder, true, peer.build_ns, peer.query_ns, peer.status);
        made.results.variants[cell].library_title = "Embree";
    }
    return made.results;
}

std::vector<std::string> front_of(const Advice& advice) {
    std::vector<std::string> names;
    for (const std::size_t i : advice.front)
        names.push_back(advice.ways[i].name);
    return names;
}

TEST(Advice, SaysFromHowManyQueriesADearerTreePays) {
    const Advice advice = advise(timed({{"hilbert", "wide8", 1e6, 9e5},
                                        {"binned_sah", "wide8", 3e6, 4e5},
                                        {"worse", "wide8", 4e6, 8e5},
                                        {"best", "wide8", 9e6, 3e5}},
                                       5e6));
    EXPECT_THAT(front_of(advice), ElementsAre("hilbert.wide8", "binned_sah.wide8", "best.wide8"));
    ASSERT_EQ(advice.steps.size(), 2u);
    // 2 ms more for half a microsecond less a ray, 6 ms for a tenth.
    EXPECT_NEAR(advice.steps[0].queries.mid, 4000, 40);
    EXPECT_LE(advice.steps[0].queries.lo, advice.steps[0].queries.mid);
    EXPECT_NEAR(advice.steps[1].queries.mid, 60000, 600);
    EXPECT_NEAR(advice.steps[0].query.ratio, 9. / 4, 0.02);
    EXPECT_EQ(advice.ways[advice.best].name, "hilbert.wide8"); // for the 1000 that were timed
    ASSERT_TRUE(advice.rival);
    EXPECT_NEAR(advice.rival_ratio.ratio, 10 / 1.9, 0.05);
    EXPECT_THAT(advice_text(advice), HasSubstr("Up to 4,000 rays per build"));
    EXPECT_THAT(advice_text(advice), HasSubstr("above it binned_sah.wide8 (2.25x"));
    EXPECT_THAT(advice_text(advice), HasSubstr("Embree: rtc_x would take 5.26x"));
    EXPECT_THAT(advice_text(advice), HasSubstr("make_builder(\"hilbert\")"));
}

TEST(Advice, SaysFromHowManyQueriesAPeerIsFaster) {
    auto results = timed({{"hilbert", "wide8", 1e6, 9e5}, {"binned_sah", "wide8", 3e6, 4e5}}, 0);
    EXPECT_TRUE(advise(results).losses.empty());
    // Of a peer 5 ms and 300 ns a ray: 2 ms more than ours, for 100 ns less.
    results = timed({{"hilbert", "wide8", 1e6, 9e5}, {"binned_sah", "wide8", 3e6, 4e5}}, 5e6);
    for (auto& sample : results.samples)
        if (sample.cell_id == 2 && sample.phase == Phase::query)
            sample.wall_ns *= 3e5 / 5e6;
    const Advice advice = advise(results);
    ASSERT_EQ(advice.losses.size(), 1u);
    EXPECT_GT(advice.losses[0].from, 20'000);
    EXPECT_LT(advice.losses[0].from, 40'000); // beyond the noise floor
    EXPECT_TRUE(std::isnan(advice.losses[0].to));
    EXPECT_NEAR(advice.losses[0].query_ratio, .75, .01);
    EXPECT_THAT(
        advice_text(advice),
        AllOf(HasSubstr("From about "),
              HasSubstr("rays per build on, Embree: rtc_x is faster than all of ours; once built, "
                        "it takes 0.75")));
    EXPECT_THAT(advice_json(advice), HasSubstr(R"("to":null,"peers":["Embree: rtc_x"])"));
    // One that builds soonest, and is slow then, is faster for few alone.
    for (auto& sample : results.samples)
        if (sample.cell_id == 2)
            sample.wall_ns = sample.phase == Phase::query ? 4e6 : 1e5;
    const Advice few = advise(results);
    ASSERT_EQ(few.losses.size(), 1u);
    EXPECT_EQ(few.losses[0].from, 1);
    EXPECT_NEAR(few.losses[0].to, 290, 40);
}

TEST(Advice, NamesEachPeerThatIsFasterOnce) {
    // One peer for few rays and another, whose name the first's begins with, for many.
    const Advice advice =
        advise(timed({{"hilbert", "wide8", 1e6, 9e5}}, 0, 1.001,
                     {{"embree.rtc.low", "", 3e5, 6e5}, {"embree.rtc", "", 3e6, 3e5}}));
    ASSERT_EQ(advice.losses.size(), 1u);
    EXPECT_THAT(advice.losses[0].peers, ElementsAre("Embree: rtc.low", "Embree: rtc"));
    EXPECT_THAT(advice_text(advice), HasSubstr("on, Embree: rtc.low or Embree: rtc is faster"));
    EXPECT_THAT(advice_json(advice), HasSubstr(R"(["Embree: rtc.low","Embree: rtc"])"));
}

TEST(Advice, IsForAsManyQueriesAsAreWanted) {
    const auto results = timed({{"hilbert", "wide8", 1e6, 9e5}, {"binned_sah", "wide8", 3e6, 4e5}});
    EXPECT_EQ(advise(results, 3000).best, 0u);
    EXPECT_EQ(advise(results, 5000).best, 1u);
}

TEST(Advice, IsNeverMadeOfADifferenceThatIsNone) {
    // 2 % faster, where the same cell differs by 6 % from itself.
    const Advice advice =
        advise(timed({{"a", "wide8", 1e6, 5e5}, {"b", "wide8", 3e6, 4.9e5}}, 0, 1.06));
    EXPECT_THAT(front_of(advice), ElementsAre("a.wide8"));
    EXPECT_TRUE(advice.steps.empty());
    EXPECT_THAT(advice_text(advice), HasSubstr("for any number of rays"));
    EXPECT_FALSE(advice.rival);
}

TEST(Advice, TakesTheLeastTotalOfAllAndNamesWhatIsNotToldApart) {
    // Rounds that jump about: from when on a dearer tree pays lies between wide ends, and whatever
    // the front is, what is taken costs the least.
    auto noisy = timed({{"a", "wide8", 1e6, 9e5},
                        {"b", "wide8", 1.5e6, 7e5},
                        {"c", "wide8", 3e6, 5.5e5},
                        {"d", "wide8", 6e6, 5e5}});
    for (auto& sample : noisy.samples)
        sample.wall_ns *= 1 + .3 * ((sample.round * 5 + sample.cell_id * 3) % 7) / 7;
    for (double queries = 500; queries < 1e6; queries *= 1.3) {
        const Advice advice = advise(noisy, queries);
        const auto total = [&](const Way& way) {
            return way.build_ns + queries / 1000 * way.query_ns;
        };
        const double least = total(std::ranges::min(advice.ways, {}, total));
        EXPECT_LE(total(advice.ways[advice.best]), 1.02 * least) << queries;
    }
    const Advice alike =
        advise(timed({{"a", "wide8", 1e6, 5e5}, {"b", "wide8", 1.01e6, 5e5}}, 1.51e6));
    EXPECT_THAT(advice_text(alike), AllOf(HasSubstr("Not told apart from it there (noise floor "),
                                          HasSubstr(" %): b.wide8.\n")));
    const Advice apart = advise(timed({{"a", "wide8", 1e6, 5e5}, {"b", "wide8", 2e6, 5e5}}, 7.6e5));
    EXPECT_THAT(advice_text(apart), Not(HasSubstr("ot told apart from it there")));
    EXPECT_THAT(advice_text(apart), HasSubstr("as long, which is not told apart from it."));
}

TEST(Advice, NamesTheThreadsThatWereTimed) {
    auto of_two = timed({{"a", "wide8", 1e6, 5e5}});
    EXPECT_THAT(advice_text(advise(of_two)), Not(HasSubstr("threads")));
    for (results::Cell& cell : of_two.cells)
        cell.threads = 2;
    const std::string text = advice_text(advise(of_two));
    EXPECT_THAT(text, HasSubstr(", .threads = 2});"));
    EXPECT_THAT(text, HasSubstr(", threads=2)"));
}

TEST(Advice, LeavesOutWhatErrs) {
    const Advice advice =
        advise(timed({{"a", "wide8", 1e6, 5e5}, {"b", "wide8", 1e5, 1e5, results::Status::wrong}}));
    EXPECT_THAT(front_of(advice), ElementsAre("a.wide8"));
    EXPECT_THROW(advise(timed({{"b", "wide8", 1, 1, results::Status::wrong}})), BadInput);
}

TEST(Advice, IsDrawnAndToldToPrograms) {
    const Advice advice =
        advise(timed({{"hilbert", "wide8", 1e6, 9e5}, {"binned_sah", "wide8", 3e6, 4e5}}, 5e6));
    const std::string svg = advice_picture(advice);
    EXPECT_THAT(svg, HasSubstr(">hilbert.wide8</text>"));
    EXPECT_THAT(svg, HasSubstr("class=\"rival\""));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    const std::string json = advice_json(advice);
    EXPECT_THAT(json, HasSubstr(R"("best":"hilbert.wide8")"));
    EXPECT_THAT(json, HasSubstr(R"("break_even":{"value":)"));
    EXPECT_THAT(json, HasSubstr(R"("is_rival_distinct":true)"));
}

TEST(PolicyAdvice, APeerThatIsFasterBeyondNoiseIsNotCalledAsGood) {
    for (const auto& [ns, as_good] : {std::pair{200., false}, {404., true}, {900., false}}) {
        RunForTest run;
        for (const auto& [name, query] :
             {std::pair{"auto", 300.}, {"refit", 303.}, {"fcl.moved", ns - 100}}) {
            const auto cell = run.cell("drift", 10, "moving_pairs", name);
            run.time(cell, results::Phase::update, 100.);
            run.time(cell, results::Phase::query, query);
        }
        analyse(run.results);
        const PolicyAdvice advice = advise_of_policies(run.results);
        EXPECT_EQ(advice.policies[advice.best].name, "auto");
        for (const Policy& policy : advice.policies)
            EXPECT_EQ(policy.is_as_good, !policy.is_peer || as_good) << policy.name << ' ' << ns;
        EXPECT_EQ(policies_text(advice).find(", which is not told apart from it") !=
                      std::string::npos,
                  as_good);
    }
}

} // namespace
} // namespace boxwood::bench
