#include "scenes/motions.h"

#include "scenes/scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace boxwood {
namespace {

Scene moving(std::string_view motion, std::size_t n, std::uint64_t seed = 42,
             std::size_t n_frames = default_frames) {
    return make_scene({.generator = "uniform",
                       .n = n,
                       .seed = seed,
                       .motion = std::string(motion),
                       .n_frames = n_frames});
}

// A change of a motion on purpose prints its new hash here.
TEST(Motions, SameBitsOnEveryMachine) {
    const std::map<std::string, std::uint64_t> golden{
        {"uniform_all_drift_frames5", 10591297166248424354u},
        {"uniform_one_percent_frames5", 16785686910784739210u},
        {"uniform_teleport_frames5", 2351989571156350645u},
    };
    std::map<std::string, std::uint64_t> made;
    for (const MotionEntry& motion : motions()) {
        const Scene scene = moving(motion.name, 777, 42, 5);
        made[scene.name] = scene.content_hash;
        EXPECT_EQ(scene.name, scene_name(scene.spec));
        EXPECT_EQ(scene.content_hash, moving(motion.name, 777, 42, 5).content_hash);
        EXPECT_NE(scene.content_hash, moving(motion.name, 777, 43, 5).content_hash);
    }
    EXPECT_EQ(made, golden);
}

TEST(Motions, MovedListsTheBoxesThatDifferAndNoOthers) {
    for (const MotionEntry& motion : motions())
        for (const std::size_t n : {1u, 2u, 1000u}) {
            SCOPED_TRACE(motion.name);
            const Scene scene = moving(motion.name, n);
            ASSERT_EQ(scene.frames.size(), default_frames);
            std::vector<Aabb<float>> before = scene.boxes;
            for (const Frame& frame : scene.frames) {
                ASSERT_EQ(frame.boxes.size(), n);
                EXPECT_TRUE(std::ranges::all_of(frame.boxes, &Aabb<float>::is_valid));
                std::vector<std::uint32_t> differ;
                for (std::uint32_t i = 0; i < n; ++i)
                    if (!(frame.boxes[i] == before[i]))
                        differ.push_back(i);
                EXPECT_EQ(frame.moved, differ);
                before = frame.boxes;
            }
        }
}

TEST(Motions, MoveAsManyAsTheySay) {
    const auto moved = [](std::string_view motion) {
        std::set<std::size_t> counts;
        for (const Frame& frame : moving(motion, 10000).frames)
            counts.insert(frame.moved.size());
        return counts;
    };
    EXPECT_EQ(moved("all_drift"), std::set<std::size_t>{10000});
    EXPECT_EQ(moved("one_percent"), std::set<std::size_t>{100});
    const std::set<std::size_t> jumped = moved("teleport");
    EXPECT_GT(*jumped.begin(), 850u);
    EXPECT_LT(*jumped.rbegin(), 1150u);
    EXPECT_GT(jumped.size(), 10u) << "others in each frame";
}

/// Small steps that add up: after 20 frames a box has gone a side or less, and none has left.
TEST(Motions, DriftGoesStraightAndStaysInside) {
    const Scene scene = moving("all_drift", 5000, 7, 200);
    Aabb<float> bounds;
    for (const Aabb<float>& box : scene.boxes)
        bounds.extend(.5f * (box.min + box.max));
    const auto centre = [](const Aabb<float>& box) { return .5f * (box.min + box.max); };
    double longest = 0;
    for (const Frame& frame : scene.frames)
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            const Vec3<float> at = centre(frame.boxes[i]);
            EXPECT_TRUE((bounds.min - Vec3<float>{1e-6f, 1e-6f, 1e-6f}).x <= at.x);
            EXPECT_TRUE((bounds.max + Vec3<float>{1e-6f, 1e-6f, 1e-6f}).x >= at.x);
            if (&frame == &scene.frames[0])
                longest =
                    std::max(longest, static_cast<double>(length(at - centre(scene.boxes[i]))));
        }
    const float side = scene.boxes[0].max.x - scene.boxes[0].min.x;
    EXPECT_GT(longest, .01 * static_cast<double>(side));
    EXPECT_LT(longest, .3 * static_cast<double>(side));
    const Vec3<float> once = centre(scene.frames[0].boxes[9]) - centre(scene.boxes[9]);
    const Vec3<float> ten = centre(scene.frames[9].boxes[9]) - centre(scene.boxes[9]);
    EXPECT_LT(length(ten - 10.f * once), 1e-5f);
}

TEST(Motions, WhatDoesNotGoTogetherIsRefused) {
    const auto error_of = [](const SceneSpec& spec) -> std::string {
        try {
            make_scene(spec);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "no error";
    };
    using testing::HasSubstr;
    EXPECT_THAT(error_of({.generator = "uniform", .motion = "all_drfit", .n_frames = 3}),
                HasSubstr("all_drift"));
    EXPECT_THAT(error_of({.generator = "uniform", .motion = "teleport"}), HasSubstr("n_frames"));
    EXPECT_THAT(error_of({.generator = "sphere_mesh", .motion = "teleport", .n_frames = 3}),
                HasSubstr("triangles"));
    EXPECT_EQ(moving("teleport", 10).name, "uniform_teleport");
    EXPECT_EQ(moving("teleport", 10, 1, 3).name, "uniform_teleport_frames3");
}

} // namespace
} // namespace boxwood
