/// Programs that are run again with their shapes, and what a truth says of the answers.

#include "bench/replay/made_program.h"
#include "bench/replay/replay.h"

#if __has_include(<fcl/config.h>)

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace boxwood::bench {
namespace {

ReplayReport replayed(const RecordedProgram& program, const std::vector<ReplayEntry>& entries,
                      double max_tests = 1e9) {
    return replay(program, entries, 2, max_tests, [](const std::string&) { return true; });
}

TEST(ShapeReplays, FclAnswersInFloatsToo) {
    std::vector<ReplayEntry> floats = replay_entries();
    std::erase_if(floats, [](const ReplayEntry& e) { return !e.in_floats; });
    ASSERT_EQ(floats.size(), 3u);
    const RecordedProgram program =
        made_program({.bodies = 20, .triangles = 50, .frames = 1, .distances = 3});
    const ReplayReport report = replayed(program, floats);
    EXPECT_EQ(report.n_shapes_checked, 4u);
    ASSERT_EQ(report.outcomes.size(), 3u);
    EXPECT_THAT(report.outcomes, testing::Each(testing::Field(&ReplayOutcome::wrong, 0u)));
    EXPECT_THAT(report.outcomes, testing::Each(testing::Field(&ReplayOutcome::in_floats, true)));
}

/// World, but for the pair that it shows last, and its distances, which are farther.
class Liar final : public Replay {
  public:
    explicit Liar(const RecordedProgram& program) : world_(world_replay().make(program)) {}
    void run(const std::function<bool(std::size_t)>& includes,
             std::vector<ReplayedCall>& calls) override {
        world_->run(includes, calls);
        for (ReplayedCall& call : calls) {
            call.min_distance += .01;
            if (call.touching.empty())
                continue;
            call.touching.pop_back();
            --call.shown;
        }
    }

  private:
    std::unique_ptr<Replay> world_;
};

/// Whether they are first, and those of ours, or not.
TEST(ShapeReplays, WrongAnswersOfShapesAreFound) {
    const RecordedProgram program =
        made_program({.bodies = 60, .triangles = 100, .frames = 2, .distances = 5});
    std::vector<ReplayEntry> entries = {world_replay()};
    entries[0].make = [](const RecordedProgram& of) { return std::make_unique<Liar>(of); };
    for (ReplayEntry& e : replay_entries())
        if (e.name == "fcl.dynamic_aabb_tree, FCL's shapes")
            entries.push_back(std::move(e));
    ASSERT_EQ(entries.size(), 2u);
    const ReplayReport report = replayed(program, entries);
    ASSERT_EQ(report.outcomes.size(), 2u);
    EXPECT_EQ(report.outcomes[0].name, "boxwood.world");
    EXPECT_GE(report.outcomes[0].wrong, 4u);
    EXPECT_THAT(report.outcomes[0].witness,
                testing::MatchesRegex("objects [0-9]+ and [0-9]+ touch"));
    EXPECT_EQ(program.calls[report.outcomes[0].first_wrong].what, recording::Call::collide_self);
    EXPECT_EQ(report.outcomes[1].wrong, 0u);
    const ReplayReport unchecked = replayed(program, entries, 0);
    EXPECT_EQ(unchecked.outcomes[0].wrong, 0u);
    EXPECT_GE(unchecked.outcomes[1].differ, 4u);
}

} // namespace
} // namespace boxwood::bench

#endif
