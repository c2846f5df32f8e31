#include "trees/dynamic/update.h"

#include "trees/testing/box_families.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <random>

namespace boxwood {
namespace {

std::vector<Pair> pairs_of(const Updater& updater, const Executor& executor = serial()) {
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    updater.self_pairs(executor, sink);
    return pairs;
}

std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::ranges::sort(pairs);
    return pairs;
}

/// What happens to the boxes between two frames.
struct TestMotion {
    const char* name;
    std::function<void(std::vector<Box>&, std::mt19937&)> step;
};

Box shifted(const Box& box, float x, float y, float z) {
    return {box.min + Vec3<float>{x, y, z}, box.max + Vec3<float>{x, y, z}};
}

const TestMotion motions[]{
    {"all drift",
     [](std::vector<Box>& boxes, std::mt19937&) {
         for (std::size_t i = 0; i < boxes.size(); ++i)
             boxes[i] = shifted(boxes[i], .004f * static_cast<float>(i % 5) - .008f,
                                .004f * static_cast<float>(i % 3) - .004f, .002f);
     }},
    {"a few drift",
     [](std::vector<Box>& boxes, std::mt19937&) {
         for (std::size_t i = 3; i < boxes.size(); i += 50)
             boxes[i] = shifted(boxes[i], .02f, -.01f, .03f);
     }},
    {"teleports",
     [](std::vector<Box>& boxes, std::mt19937& random) {
         std::uniform_real_distribution<float> place(0, 1);
         for (Box& box : boxes)
             if (random() % 10 == 0) {
                 const float x = place(random), y = place(random), z = place(random);
                 box = shifted(box, x - box.min.x, y - box.min.y, z - box.min.z);
             }
     }},
    {"far out and back",
     [](std::vector<Box>& boxes, std::mt19937& random) {
         for (Box& box : boxes)
             if (random() % 7 == 0)
                 box = shifted(box, box.min.x > 100 ? -1e6f : 1e6f, 0, 0);
     }},
    {"swap places", [](std::vector<Box>& boxes, std::mt19937&) { std::ranges::reverse(boxes); }},
    {"grow and shrink",
     [](std::vector<Box>& boxes, std::mt19937& random) {
         for (Box& box : boxes)
             if (random() % 4 == 0) {
                 const float x = box.max.x - box.min.x > .5f ? box.min.x : box.max.x + .2f;
                 box.max.x = x;
             }
     }},
    {"all to one point",
     [](std::vector<Box>& boxes, std::mt19937& random) {
         for (Box& box : boxes)
             if (random() % 2 == 0)
                 box = {{.5f, .5f, .5f}, {.5f, .5f, .5f}};
     }},
};

std::vector<std::uint32_t> moved_between(Boxes before, Boxes now) {
    std::vector<std::uint32_t> moved;
    for (std::uint32_t i = 0; i < now.size(); ++i)
        if (!(before[i] == now[i]))
            moved.push_back(i);
    return moved;
}

TEST(Updates, EveryPolicyAndMotionAgainstBruteForceInEveryFrame) {
    for (const TestMotion& motion : motions)
        for (const std::size_t n : {1u, 2u, 17u, 400u}) {
            std::vector<std::unique_ptr<Updater>> all;
            std::mt19937 random(3);
            std::vector<Box> boxes = random_boxes(n, .15f, 5);
            for (const UpdateEntry& entry : updates()) {
                all.push_back(entry.make({}));
                all.back()->start(boxes, serial());
                ASSERT_EQ(sorted(pairs_of(*all.back())), brute_force(boxes)) << entry.name;
            }
            for (int frame = 0; frame < 12; ++frame) {
                const std::vector<Box> before = boxes;
                motion.step(boxes, random);
                const auto moved = moved_between(before, boxes);
                const auto expected = brute_force(boxes);
                for (std::size_t p = 0; p < all.size(); ++p) {
                    all[p]->update(boxes, moved, serial());
                    ASSERT_EQ(all[p]->fault(), "")
                        << updates()[p].name << ", " << motion.name << ", frame " << frame;
                    ASSERT_EQ(sorted(pairs_of(*all[p])), expected)
                        << updates()[p].name << ", " << motion.name << ", n " << n << ", frame "
                        << frame;
                }
            }
        }
}

/// Each family of boxes becomes the next, as far as both have items: a frame of the worst
/// teleports.
TEST(Updates, EveryFamilyBecomesTheNext) {
    const auto families = box_families();
    for (const UpdateEntry& entry : updates()) {
        const auto updater = entry.make({});
        for (std::size_t f = 0; f + 1 < families.size(); ++f) {
            std::vector<Box> boxes = families[f].boxes;
            if (boxes.size() > 1000)
                continue;
            updater->start(boxes, serial());
            for (const BoxFamily* to : {&families[f + 1], &families[f]}) {
                const std::vector<Box> before = boxes;
                std::copy_n(to->boxes.begin(), std::min(boxes.size(), to->boxes.size()),
                            boxes.begin());
                updater->update(boxes, moved_between(before, boxes), serial());
                EXPECT_EQ(updater->fault(), "") << entry.name << ", " << families[f].name;
                EXPECT_EQ(sorted(pairs_of(*updater)), brute_force(boxes))
                    << entry.name << ": " << families[f].name << " to " << to->name;
            }
        }
    }
}

TEST(Updates, SameAnswersInTheSameOrderOnEveryExecutor) {
    for (const UpdateEntry& entry : updates())
        for (const TestMotion& motion : {motions[0], motions[2]}) {
            std::vector<std::vector<Pair>> answers;
            for (const auto& [name, threads] :
                 {std::pair{"serial", 1u}, {"openmp", 2u}, {"tbb", 2u}, {"tbb", 4u}}) {
                const auto executor = make_executor(name, threads);
                const auto updater = entry.make({});
                std::mt19937 random(4);
                std::vector<Box> boxes = random_boxes(10000, .03f, 6), before;
                updater->start(boxes, *executor);
                for (int frame = 0; frame < 3; ++frame) {
                    before = boxes;
                    motion.step(boxes, random);
                    updater->update(boxes, moved_between(before, boxes), *executor);
                }
                answers.push_back(pairs_of(*updater, *executor));
                EXPECT_EQ(answers.back(), answers.front())
                    << entry.name << ", " << motion.name << ", " << name << threads;
            }
            EXPECT_GT(answers.front().size(), 1000u);
        }
}

TEST(Updates, BadFramesAreRefusedAndNothingIsLost) {
    const auto boxes = random_boxes(100, .2f, 8);
    std::vector<std::uint32_t> all(100);
    for (std::uint32_t i = 0; i < 100; ++i)
        all[i] = i;
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(),
                    inf = std::numeric_limits<float>::infinity();
    for (const UpdateEntry& entry : updates()) {
        SCOPED_TRACE(entry.name);
        const auto updater = entry.make({});
        updater->start(boxes, serial());
        const auto expected = brute_force(boxes);
        for (const float bad : {nan, inf, -inf, -5.f})
            for (const auto& moved : {all, std::vector<std::uint32_t>{2, 41, 70}}) {
                auto wrong = random_boxes(100, .3f, 9);
                wrong[41].max.y = bad;
                EXPECT_THAT([&] { updater->update(wrong, moved, serial()); },
                            testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, 41u)))
                    << bad;
                EXPECT_THROW(updater->start(wrong, serial()), InvalidBox);
                EXPECT_EQ(sorted(pairs_of(*updater)), expected);
                EXPECT_EQ(updater->fault(), "");
            }
        const auto refused = [&](Boxes frame, const std::vector<std::uint32_t>& moved) {
            EXPECT_THROW(updater->update(frame, moved, serial()), std::invalid_argument);
            EXPECT_EQ(sorted(pairs_of(*updater)), expected);
        };
        refused(Boxes(boxes).first(99), {});
        refused(boxes, {100});
        refused(boxes, {5, 5});
        refused(boxes, {7, 6});
        updater->update(boxes, {}, serial());
        EXPECT_EQ(sorted(pairs_of(*updater)), expected);
    }
}

/// A thousand small steps leave neither wrong answers nor a tree that ever more has to be passed.
TEST(Updates, NothingDriftsOverManyFrames) {
    for (const UpdateEntry& entry : updates()) {
        const auto updater = entry.make({});
        std::mt19937 random(11);
        std::vector<Box> boxes = random_boxes(400, .1f, 10);
        const std::vector<Box> home = boxes;
        std::vector<Vec3<float>> at(boxes.size()), step(boxes.size());
        for (Vec3<float>& s : step)
            s = {static_cast<float>(random() % 9) * 1e-3f - 4e-3f,
                 static_cast<float>(random() % 9) * 1e-3f - 4e-3f, 1e-3f};
        updater->start(boxes, serial());
        std::size_t max_bytes = 0;
        for (int frame = 0; frame < 1000; ++frame) {
            const std::vector<Box> before = boxes;
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                if (random() % 2 == 0)
                    continue;
                for (int axis = 0; axis < 3; ++axis)
                    if (std::abs(at[i][axis] + step[i][axis]) > .5f)
                        step[i][axis] = -step[i][axis];
                at[i] = at[i] + step[i];
                boxes[i] = {home[i].min + at[i], home[i].max + at[i]};
            }
            updater->update(boxes, moved_between(before, boxes), serial());
            if (frame % 50 == 49) {
                ASSERT_EQ(sorted(pairs_of(*updater)), brute_force(boxes))
                    << entry.name << ", frame " << frame;
                ASSERT_EQ(updater->fault(), "");
            }
            if (frame == 100)
                max_bytes = updater->bytes();
        }
        EXPECT_LE(updater->bytes(), max_bytes + max_bytes / 2)
            << entry.name << " keeps asking for memory";
    }
}

TEST(Updates, SettingsSteer) {
    const auto steps = [](const char* name, const Settings& settings, int motion) {
        const auto updater = find_update(name).make(settings);
        std::mt19937 random(12);
        std::vector<Box> boxes = random_boxes(3000, .05f, 13);
        updater->start(boxes, serial());
        UpdateStep sum;
        for (int frame = 0; frame < 8; ++frame) {
            const std::vector<Box> before = boxes;
            motions[motion].step(boxes, random);
            updater->update(boxes, moved_between(before, boxes), serial());
            sum.placed += updater->last_step().placed;
            sum.rebuilt |= updater->last_step().rebuilt;
        }
        return sum;
    };
    EXPECT_EQ(steps("refit", {}, 2).placed, 0u);
    EXPECT_EQ(steps("rebuild", {{"trigger", 0}}, 0).placed, 8u * 3000);
    EXPECT_FALSE(steps("rebuild", {{"trigger", 1000}}, 0).rebuilt);
    EXPECT_TRUE(steps("rebuild", {}, 2).rebuilt);
    EXPECT_LT(steps("refine", {{"share", .05}}, 0).placed, 8u * 152);
    for (const char* name : {"merge", "reinsert"}) {
        EXPECT_EQ(steps(name, {{"margin", 1000}}, 2).placed, 0u) << name;
        EXPECT_GT(steps(name, {{"margin", 0}}, 0).placed, 7u * 3000) << name;
        EXPECT_EQ(steps(name, {{"margin", 0}}, 1).placed, 8u * 60) << name;
        EXPECT_LT(steps(name, {{"margin", 4}}, 1).placed, 3u * 60) << name;
    }
    EXPECT_THROW(find_update("merge").make({{"trigger", 1}}), std::invalid_argument);
    EXPECT_THROW(find_update("merge").make({{"margin", -1}}), std::invalid_argument);
}

} // namespace
} // namespace boxwood
