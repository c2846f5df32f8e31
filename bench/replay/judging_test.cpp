/// Which answers of a program that is run again are wrong.

#include "bench/replay/made_program.h"
#include "bench/replay/replay.h"

#if __has_include(<fcl/config.h>)

#include "bench/replay/replayer.h"
#include "trees/adapters/apis/fcl_api.h"

#include <fcl/broadphase/broadphase_bruteforce.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

/// Shows no pair.
class Silent final : public fcl::NaiveCollisionManager<double> {
  public:
    using fcl::NaiveCollisionManager<double>::collide;
    void collide(void*, fcl::CollisionCallBack<double>) const override {}
};

ReplayReport run_with_silent(const RecordedProgram& program, double max_tests) {
    std::vector<ReplayEntry> entries;
    for (const ReplayEntry& entry : replay_entries())
        if (!entry.has_shapes && (entry.is_truth || entry.library != "coal"))
            entries.push_back(entry);
    ReplayEntry& silent = entries.emplace_back();
    silent.name = "silent";
    silent.library = "fcl";
    silent.make = [](const RecordedProgram& of) -> std::unique_ptr<Replay> {
        return std::make_unique<Replayer<FclApi<double>>>(
            of, [] { return std::make_unique<Silent>(); });
    };
    return replay(program, entries, 1, max_tests, [](const std::string&) { return true; });
}

TEST(Judging, QueriesThatTheProgramEndedShowAsManyPairs) {
    RecordedProgram program = made_program({.bodies = 300, .moved = 1, .frames = 4});
    std::uint64_t enough = 0;
    for (RecordedProgram::Call& call : program.calls)
        if (is_query(call.what)) {
            call.ended = true;
            call.shown = enough++; // a query that was ended before it showed one ends at the first
        }
    ASSERT_EQ(enough, 4u);
    const ReplayReport report = run_with_silent(program, 1e9);
    ASSERT_GT(report.outcomes.size(), 4u);
    EXPECT_EQ(report.n_checked, 4u);
    for (const ReplayOutcome& outcome : report.outcomes)
        EXPECT_EQ(outcome.wrong, outcome.name == "silent" ? 4u : 0u) << outcome.name;
    for (const ReplayOutcome& outcome : run_with_silent(program, 0).outcomes)
        EXPECT_EQ(outcome.differ, outcome.name == "silent" ? 4u : 0u) << outcome.name;
}

TEST(Judging, ProgramsThatReachTooFarAreRunWithWhatComesBackFromThem) {
    RecordedProgram program = made_program({.bodies = 60, .moved = 1, .frames = 2});
    for (const double far : {1e300, std::numeric_limits<double>::infinity()}) {
        program.states[3].bounds = {-far, -far, -far, far, far, 0}; // a half-space
        const ReplayReport report = run_with_silent(program, 1e9);
        EXPECT_THAT(report.left_out, testing::Contains("fcl.dynamic_aabb_tree"));
        ASSERT_EQ(report.outcomes.size(), 2u);
        EXPECT_EQ(report.outcomes[0].name, "boxwood.fcl_manager");
        EXPECT_EQ(report.outcomes[0].wrong, 0u);
        EXPECT_EQ(report.outcomes[1].wrong, 2u);
    }
}

TEST(Judging, DistancesThatTheProgramEndedAreNotChecked) {
    RecordedProgram program =
        made_program({.bodies = 60, .triangles = 200, .frames = 1, .distances = 5});
    for (RecordedProgram::Call& call : program.calls)
        call.ended = is_distance(call.what);
    const ReplayReport report = run_with_silent(program, 1e9);
    EXPECT_EQ(report.n_queries, 6u);
    EXPECT_EQ(report.n_checked, 1u);
    EXPECT_EQ(report.n_too_dear, 0u);
    EXPECT_EQ(report.n_of_chance, 5u);
    EXPECT_EQ(run_with_silent(program, 0).n_too_dear, 1u);
}

} // namespace
} // namespace boxwood::bench

#endif
