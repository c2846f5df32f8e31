#include "scenes/effects/effect_scene.h"
#include "scenes/moving/frames.h"
#include "scenes/scene.h"
#include "trees/dynamic/update.h"
#include "trees/executor.h"
#include "trees/testing/brute_force.h"
#include "trees/testing/every_executor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

/// Every update policy on every scene that moves, against two plain loops. All of it comes from the
/// registries: a new word is tried by itself.
namespace boxwood::bench {
namespace {

/// Every box scene of the registry with effects of each kind, and every moving scene.
std::vector<std::shared_ptr<const SceneFile>> every_moving_scene(std::size_t n) {
    const std::vector<std::vector<EffectChoice>> kinds{
        {{"drift", {}, 1}},
        {{"drift", {}, .01}},
        {{"teleport", {}, 1}},
        {{"spawn", {{"often", .3}}, 1}, {"despawn", {{"often", .3}}, 1}, {"teleport", {}, .5}}};
    std::vector<std::shared_ptr<const SceneFile>> all;
    const auto add = [&](SceneFile file) {
        file.frames = 4;
        all.push_back(std::make_shared<const SceneFile>(std::move(file)));
    };
    for (const SceneEntry& entry : scene_generators())
        if (!entry.has_mesh && !entry.reads_file)
            for (const std::vector<EffectChoice>& effects : kinds)
                add(effect_scene({.generator = std::string(entry.name), .n = n, .seed = 7},
                                 effects));
    for (const BuiltInScene& scene : built_in_scenes()) {
        SceneFile file = load_scene(std::string(scene.name));
        file.n = n;
        add(std::move(file));
    }
    return all;
}

TEST(EveryPolicy, FollowsEveryMovingScene) {
    const auto parallel = parallel_executors();
    std::size_t turn = 0;
    for (const std::size_t n : {2u, 5u, 120u})
        for (const auto& file : every_moving_scene(n)) {
            Frames frames(file);
            std::vector<std::vector<Pair>> expected;
            while (const Frame* frame = frames.next())
                expected.push_back(brute_force(frame->boxes));
            for (const UpdateEntry& entry : updates()) {
                const Executor& executor = *parallel[turn++ % parallel.size()].run;
                const auto updater = entry.make({});
                updater->start(frames.start(), executor);
                frames.rewind();
                for (std::size_t f = 0; const Frame* frame = frames.next(); ++f) {
                    updater->update(frame->boxes, frame->moved, executor);
                    std::vector<Pair> pairs;
                    AppendPairs sink(pairs);
                    updater->self_pairs(executor, sink);
                    std::ranges::sort(pairs);
                    ASSERT_EQ(updater->fault(), "") << entry.name << " " << file->name;
                    ASSERT_EQ(pairs, expected[f])
                        << entry.name << ", " << file->name << " n " << n << ", frame " << f;
                }
            }
        }
}

/// Tens of thousands of frames of small steps leave no drift behind: the answers at the end are
/// those of a tree that was made just now.
TEST(EveryPolicy, BuildsUpNothingOverAHundredThousandFrames) {
    SceneFile file = effect_scene({.generator = "uniform", .n = 60, .seed = 3, .overlaps = 3},
                                  std::vector<EffectChoice>{{"drift", {{"speed", .5}}, .5},
                                                            {"spin", {}, .2},
                                                            {"teleport", {{"often", .001}}, .1},
                                                            {"despawn", {{"often", .001}}, .2},
                                                            {"spawn", {{"often", .01}}, .2}});
    file.frames = 100'000;
    Frames frames(std::make_shared<const SceneFile>(std::move(file)), 0);
    std::vector<std::unique_ptr<Updater>> followers;
    for (const UpdateEntry& entry : updates()) {
        followers.push_back(entry.make({}));
        followers.back()->start(frames.start(), serial());
    }
    std::size_t n_pairs = 0;
    for (std::size_t f = 1; const Frame* frame = frames.next(); ++f) {
        const bool is_looked_at = f % 997 == 0 || f == frames.size();
        const std::vector<Pair> expected =
            is_looked_at ? brute_force(frame->boxes) : std::vector<Pair>();
        n_pairs += expected.size();
        for (std::size_t u = 0; u < followers.size(); ++u) {
            followers[u]->update(frame->boxes, frame->moved, serial());
            if (!is_looked_at)
                continue;
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            followers[u]->self_pairs(serial(), sink);
            std::ranges::sort(pairs);
            ASSERT_EQ(pairs, expected) << updates()[u].name << ", frame " << f;
            ASSERT_EQ(followers[u]->fault(), "") << updates()[u].name << ", frame " << f;
        }
    }
    EXPECT_GT(n_pairs, 1000u);
}

} // namespace
} // namespace boxwood::bench
