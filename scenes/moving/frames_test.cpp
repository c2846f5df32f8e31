#include "scenes/moving/frames.h"

#include "kernels/testing/complaint.h"
#include "scenes/effects/effect_scene.h"
#include "scenes/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace boxwood {
namespace {

using testing::HasSubstr;

std::shared_ptr<const SceneFile> built_in(std::string_view name, std::size_t n,
                                          std::size_t n_frames) {
    SceneFile file = load_scene(std::string(name));
    file.n = n;
    file.frames = n_frames;
    return std::make_shared<const SceneFile>(std::move(file));
}

TEST(Frames, AreTheSameHeldAndStreamedAndInEachPass) {
    for (const BuiltInScene& scene : built_in_scenes()) {
        SCOPED_TRACE(scene.name);
        const auto file = built_in(scene.name, 300, 7);
        Frames held(file), streamed(file, 0);
        ASSERT_GE(held.bytes(), 7 * held.start().size_bytes());
        ASSERT_EQ(held.size(), 7u);
        const MovingScene at_start(*file);
        EXPECT_TRUE(std::ranges::equal(held.start(), boxes_of(at_start)));
        EXPECT_TRUE(std::ranges::equal(held.start(), streamed.start()));
        for (int pass = 0; pass < 3; ++pass) {
            const int played = pass == 1 ? 3 : 7; // the second is broken off
            MovingScene scene_played(*file);
            std::vector<Aabb<float>> before = boxes_of(scene_played);
            for (int f = 0; f < played; ++f) {
                const Frame* const a = held.next();
                const Frame* const b = streamed.next();
                ASSERT_TRUE(a && b);
                scene_played.advance();
                ASSERT_EQ(a->boxes, boxes_of(scene_played));
                ASSERT_EQ(b->boxes, a->boxes);
                ASSERT_EQ(b->moved, a->moved);
                std::vector<std::uint32_t> differ;
                for (std::uint32_t i = 0; i < before.size(); ++i)
                    if (!(before[i] == a->boxes[i]))
                        differ.push_back(i);
                ASSERT_EQ(a->moved, differ);
                before = a->boxes;
            }
            if (played == 7) {
                EXPECT_EQ(held.next(), nullptr);
                EXPECT_EQ(streamed.next(), nullptr);
            }
            held.rewind();
            streamed.rewind();
        }
        EXPECT_EQ(content_hash(held), content_hash(streamed));
        Frames others(built_in(scene.name, 301, 7));
        if (others.start().size() != held.start().size()) {
            EXPECT_NE(content_hash(others), content_hash(held));
        }
    }
}

/// A million bodies are streamed: what is held does not depend on the number of frames.
TEST(Frames, OfAMillionBodiesAreNotHeld) {
    SceneFile file = effect_scene({.generator = "uniform", .n = 1'000'000},
                                  std::vector<EffectChoice>{{"drift", {}, .01}});
    const auto held_by = [&](std::size_t n_frames) {
        file.frames = n_frames;
        Frames frames(std::make_shared<const SceneFile>(file));
        for (int f = 0; f < 3; ++f)
            frames.next();
        return frames.bytes();
    };
    const std::size_t few = held_by(12), many = held_by(10'000);
    EXPECT_EQ(few, many);
    EXPECT_LT(many, std::size_t{400} << 20);
    EXPECT_GT(many, std::size_t{2 * 24'000'000}); // the start and the present frame at least
}

TEST(Frames, AreHeldIfTheyAreSmall) {
    const auto file = built_in("broadmark_brownian", 1000, 100);
    const std::size_t all = 100 * 1000 * sizeof(Aabb<float>);
    EXPECT_GE(Frames(file, all).bytes(), all);
    EXPECT_LT(Frames(file, all - 1).bytes(), all / 2);
}

TEST(Frames, WidenByTheMarginOfTheGroup) {
    SceneFile file = effect_scene({.generator = "uniform", .n = 50},
                                  std::vector<EffectChoice>{{"drift", {}, 1}});
    Frames exact(std::make_shared<const SceneFile>(file));
    file.groups[0].margin = .25;
    Frames wide(std::make_shared<const SceneFile>(file));
    const Frame *a = exact.next(), *b = wide.next();
    for (std::size_t i = 0; i < 50; ++i) {
        EXPECT_TRUE(b->boxes[i].contains(a->boxes[i]));
        EXPECT_NEAR(a->boxes[i].min.x - b->boxes[i].min.x, .25f, 1e-6f);
        EXPECT_NEAR(b->boxes[i].max.z - a->boxes[i].max.z, .25f, 1e-6f);
    }
}

TEST(Frames, ASceneThatMovesStandsAtItsFirstFrame) {
    SceneSpec spec{.generator = "uniform", .n = 40, .seed = 9};
    spec.moving = std::make_shared<const SceneFile>(
        effect_scene(spec, std::vector<EffectChoice>{{"spawn", {}, 1}, {"drift", {}, .5}}));
    const Scene scene = make_scene(spec);
    EXPECT_EQ(scene.name, "uniform_spawn_drift_share0_5");
    EXPECT_TRUE(std::ranges::equal(scene.boxes, Frames(spec.moving).start()));
    EXPECT_GT(std::ranges::count_if(scene.boxes, &Aabb<float>::is_empty), 5);
    EXPECT_EQ(effect_names(*spec.moving), "spawn,drift");
    EXPECT_EQ(query_names(*spec.moving), "pairs");
    EXPECT_THAT(scene.params_json, HasSubstr(R"("name":"drift","share":0.5)"));
}

TEST(EffectScene, SaysWhatItIs) {
    const SceneSpec spec{.generator = "clusters", .n = 30, .seed = 4, .overlaps = .5};
    const SceneFile file = effect_scene(
        spec, std::vector<EffectChoice>{{"drift", {{"speed", 1.5}}, .01}, {"spin", {}, 1}});
    EXPECT_EQ(file.name, "clusters_overlaps0_5_drift_speed1_5_share0_01_spin");
    EXPECT_EQ(file.n, 30u);
    EXPECT_EQ(file.seed, 4u);
    EXPECT_EQ(file.frames, default_frames);
    EXPECT_EQ(MovingScene(file).bodies().size(), 30u);
    // Frame 0 is what the generator makes, up to the rounding outward of fitted boxes.
    const Scene still = make_scene(spec);
    const std::vector<Aabb<float>> boxes = boxes_of(MovingScene(file));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        EXPECT_TRUE(boxes[i].contains(still.boxes[i]));
        EXPECT_NEAR(boxes[i].max.x, still.boxes[i].max.x, 1e-6f);
    }
}

/// The motions of the benchmark's table: every box drifts by up to a tenth of a box a frame, one in
/// a hundred does, one in ten jumps.
TEST(EffectScene, MovesAsManyAsItSays) {
    const auto moved = [](const EffectChoice& effect) {
        Frames frames(std::make_shared<const SceneFile>(effect_scene(
            {.generator = "uniform", .n = 10'000}, std::vector<EffectChoice>{effect})));
        std::vector<std::size_t> counts;
        while (const Frame* frame = frames.next())
            counts.push_back(frame->moved.size());
        EXPECT_EQ(counts.size(), default_frames);
        return counts;
    };
    EXPECT_THAT(moved({"drift", {}, 1}), testing::Each(testing::Gt(9'990u)));
    EXPECT_THAT(moved({"drift", {}, .01}),
                testing::Each(testing::AllOf(testing::Gt(60u), testing::Lt(140u))));
    EXPECT_THAT(moved({"teleport", {}, 1}),
                testing::Each(testing::AllOf(testing::Gt(850u), testing::Lt(1150u))));

    Frames frames(std::make_shared<const SceneFile>(effect_scene(
        {.generator = "uniform", .n = 1'000}, std::vector<EffectChoice>{{"drift", {}, 1}})));
    const Aabb<float> first = frames.start()[0];
    const float side = first.max.x - first.min.x;
    float longest = 0;
    const Frame* const frame = frames.next();
    for (std::size_t i = 0; i < 1'000; ++i)
        longest = std::max(longest, length(frame->boxes[i].min - frames.start()[i].min));
    EXPECT_GT(longest, .05f * side);
    EXPECT_LT(longest, .3f * side);
}

TEST(EffectScene, RefusesWhatMakesNoSense) {
    const auto error_of = [](std::string generator, EffectChoice effect) {
        return complaint_of(
            [&] { effect_scene({.generator = generator}, std::vector<EffectChoice>{effect}); });
    };
    EXPECT_THAT(error_of("uniform", {"drfit", {}, 1}), HasSubstr("'drift'"));
    EXPECT_THAT(error_of("uniform", {"drift", {{"sped", 1}}, 1}), HasSubstr("speed"));
    EXPECT_THAT(error_of("sphere_mesh", {"drift", {}, 1}), HasSubstr("one body of triangles"));
    EXPECT_THAT(error_of("unifrom", {"drift", {}, 1}), HasSubstr("'uniform'"));
}

} // namespace
} // namespace boxwood
