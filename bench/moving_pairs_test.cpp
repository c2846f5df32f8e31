#include "bench/moving_pairs.h"

#include "bench/commands/command.h"
#include "bench/plan.h"
#include "scenes/scenes.h"
#include "trees/update.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace boxwood::bench {
namespace {

Scene moving_scene(std::string motion, std::size_t n) {
    return make_scene(
        {.generator = "uniform", .n = n, .seed = 5, .motion = std::move(motion), .n_frames = 6});
}

/// The check of all frames, after one pass and after another from a new build.
results::Check check_of(Contender& contender, const Scene& scene) {
    const MovingTruth truth(scene, 2);
    Answers answers;
    std::vector<FrameTime> times(scene.frames.size());
    results::Check check;
    std::uint64_t hashes[2];
    for (std::uint64_t& value : hashes) {
        FramesHash hash;
        check = {};
        contender.build();
        play(contender, scene, answers, times, [&](std::size_t frame) {
            hash.add(answers.pairs);
            truth.check(frame, answers, check);
        });
        value = hash.value();
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_GT(times.back().query_ns, 0);
    return check;
}

TEST(MovingPairs, EveryPolicyAndPeerFollowsEveryMotion) {
    for (const MotionEntry& motion : motions()) {
        const Scene scene = moving_scene(std::string(motion.name), 1500);
        const Job job{&scene, Ask::moving_pairs, "serial", 1};
        std::vector<ContenderEntry> all = peers_that_answer(Ask::moving_pairs);
        EXPECT_EQ(all.empty(), peers().size() < 2);
        for (const UpdateEntry& update : updates())
            all.push_back(moving_contender({std::string(update.name), {}}));
        for (const ContenderEntry& entry : all) {
            const results::Check check = check_of(*entry.make(job), scene);
            EXPECT_EQ(check.status, "exact")
                << entry.name << ", " << motion.name << ": " << check.witness;
            EXPECT_GT(check.n_got, 6u * 1500);
        }
    }
}

TEST(MovingPairs, WrongAnswersAreSeen) {
    const Scene scene = moving_scene("teleport", 200);
    const MovingTruth truth(scene, 1);
    Answers answers;
    results::Check check;
    answers.pairs = {{0, 0}};
    truth.check(0, answers, check);
    EXPECT_EQ(check.status, "wrong");
    EXPECT_EQ(check.extra, 1u);
    EXPECT_EQ(check.missing, check.n_expected);
    EXPECT_THAT(check.witness, testing::HasSubstr("frame 0: missing"));

    const std::vector<Pair> pairs{{1, 2}, {3, 4}}, turned{{3, 4}, {1, 2}}, other{{1, 2}, {3, 5}};
    EXPECT_EQ(unordered_hash(pairs), unordered_hash(turned));
    EXPECT_NE(unordered_hash(pairs), unordered_hash(other));
    FramesHash forth, back;
    for (const auto* frame : {&pairs, &other})
        forth.add(*frame);
    for (const auto* frame : {&other, &pairs})
        back.add(*frame);
    EXPECT_NE(forth.value(), back.value());
}

TEST(MovingPairs, ASweepFileNamesMotionsAndPolicies) {
    const auto plan_of = [](const std::string& keys) {
        return make_plan("[[cells]]\nscene = \"uniform\"\nask = \"moving_pairs\"\nn = 50\n" + keys,
                         "test.toml", {});
    };
    const Plan plan = plan_of("motion = [\"all_drift\", \"teleport\"]\nframes = 3\n"
                              "updates = [\"auto\", {name = \"rebuild\", trigger = 1.5}]\n");
    ASSERT_EQ(plan.cells.size(), 4u);
    EXPECT_EQ(plan.cells[0].name,
              "uniform_all_drift_frames3/n50-s1/moving_pairs/auto.packed.self_pairs/f32/serial-1");
    EXPECT_THAT(plan.cells[1].name, testing::HasSubstr("rebuild_trigger1_5.packed.self_pairs"));
    EXPECT_EQ(plan.cells[3].scene.n_frames, 3u);
    const auto error_of = [&](const std::string& keys) -> std::string {
        try {
            plan_of(keys);
        } catch (const BadInput& error) {
            return error.what();
        }
        return "no error";
    };
    EXPECT_THAT(error_of("updates = \"auto\"\n"), testing::HasSubstr("motion"));
    EXPECT_THAT(error_of("motion = \"teleport\"\nupdates = \"atuo\"\n"),
                testing::HasSubstr("auto"));
    EXPECT_THAT(error_of("motion = \"teleport\"\nupdates = {name = \"auto\", trigger = 1}\n"),
                testing::HasSubstr("trigger"));
    EXPECT_THAT(error_of("motion = \"teleport\"\n"), testing::HasSubstr("updates, peers"));
}

} // namespace
} // namespace boxwood::bench
