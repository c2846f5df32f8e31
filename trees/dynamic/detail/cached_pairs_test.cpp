#include "trees/dynamic/detail/cached_pairs.h"

#include "trees/dynamic/update.h"
#include "trees/testing/box_families.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <numeric>
#include <random>

namespace boxwood {
using namespace detail;
namespace {

Box shifted(const Box& box, Vec3<float> by) { return {box.min + by, box.max + by}; }

/// Boxes of which all are said to move, under the policy `cached`.
struct Caching {
    std::vector<Box> boxes;
    std::unique_ptr<Updater> updater;
    std::vector<std::uint32_t> all;

    explicit Caching(std::vector<Box> start, const char* policy = "cached", Settings settings = {})
        : boxes(std::move(start)), updater(find_update(policy).make(settings)), all(boxes.size()) {
        std::iota(all.begin(), all.end(), 0u);
        updater->start(boxes, serial());
    }
    UpdateStep step(const std::function<Box(std::size_t, const Box&)>& next) {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = next(i, boxes[i]);
        updater->update(boxes, all, serial());
        return updater->last_step();
    }
    std::vector<Pair> pairs(const Executor& executor = serial()) const {
        std::vector<Pair> found;
        AppendPairs sink(found);
        updater->self_pairs(executor, sink);
        return found;
    }
    ::testing::AssertionResult is_right() const {
        auto found = pairs();
        std::ranges::sort(found);
        if (found != brute_force(boxes))
            return ::testing::AssertionFailure() << "wrong pairs";
        if (const auto fault = updater->fault(); !fault.empty())
            return ::testing::AssertionFailure() << fault;
        return ::testing::AssertionSuccess();
    }
};

/// Directions for n items, each coordinate one of -1, 0, 1.
std::vector<Vec3<float>> directions(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Vec3<float>> all(n);
    for (auto& d : all)
        for (int axis = 0; axis < 3; ++axis)
            d[axis] = static_cast<float>(random() % 3) - 1;
    return all;
}

TEST(CachedPairs, OverTenThousandFramesOfSlowDriftNothingDrifts) {
    const std::size_t n = 120;
    Caching caching(random_boxes(n, .2f, 31));
    const auto home = caching.boxes;
    auto by = directions(n, 32);
    std::vector<Vec3<float>> at(n);
    std::size_t pairs_rebuilt = 0;
    for (int frame = 0; frame < 10'000; ++frame) {
        pairs_rebuilt += caching
                             .step([&](std::size_t i, const Box&) {
                                 for (int axis = 0; axis < 3; ++axis) {
                                     at[i][axis] += by[i][axis] * 2e-4f;
                                     if (std::abs(at[i][axis]) > .3f)
                                         by[i][axis] = at[i][axis] > 0 ? -1.f : 1.f;
                                 }
                                 return shifted(home[i], at[i]);
                             })
                             .pairs_rebuilt;
        ASSERT_TRUE(caching.is_right()) << "frame " << frame;
    }
    EXPECT_GT(pairs_rebuilt, 50u);
    EXPECT_LT(pairs_rebuilt, 1000u);
}

TEST(CachedPairs, FewAreExaminedInASlowDriftAndNoneAtRest) {
    const std::size_t n = 20'000;
    Caching caching(random_boxes(n, .11f, 33));
    const double pairs = static_cast<double>(caching.pairs().size());
    ASSERT_GT(pairs, 3. * n);
    const auto by = directions(n, 34);
    double examined = 0;
    std::size_t pairs_rebuilt = 0;
    for (int frame = 0; frame < 40; ++frame) {
        const UpdateStep step = caching.step(
            [&](std::size_t i, const Box& box) { return shifted(box, 2.5e-6f * by[i]); });
        examined += static_cast<double>(step.examined);
        pairs_rebuilt += step.pairs_rebuilt;
        EXPECT_EQ(step.fast, 0u);
        EXPECT_EQ(step.answers_from_cache, !step.pairs_rebuilt);
        CountPairs sink;
        const Work work = caching.updater->self_pairs_counted(sink);
        EXPECT_EQ(work.box_tests, step.examined);
        EXPECT_EQ(work.answers, sink.count());
    }
    EXPECT_EQ(pairs_rebuilt, 0u);
    EXPECT_GT(examined, 0);
    EXPECT_LT(examined / 40, .02 * pairs);
    ASSERT_TRUE(caching.is_right());
    const UpdateStep still = caching.step([](std::size_t, const Box& box) { return box; });
    EXPECT_EQ(still.examined, 0u);
    caching.updater->update(caching.boxes, {}, serial());
    CountPairs sink;
    EXPECT_EQ(caching.updater->self_pairs_counted(sink).box_tests, 0u);
    EXPECT_EQ(sink.count(), caching.pairs().size());
}

/// Unit cubes in a lattice that all touch: the gap is 0, and each step decides it again.
TEST(CachedPairs, TouchingBoxesPartAndMeet) {
    std::vector<Box> lattice;
    for (int x = 0; x < 6; ++x)
        for (int y = 0; y < 6; ++y)
            for (int z = 0; z < 6; ++z) {
                const Vec3<float> at{static_cast<float>(x), static_cast<float>(y),
                                     static_cast<float>(z)};
                lattice.push_back({at, at + Vec3<float>{1, 1, 1}});
            }
    for (const float size : {1.f, 1e-30f, 1e30f, 1e-42f})
        for (const float step : {0x1p-20f, 0x1p-8f, .03f}) {
            auto boxes = lattice;
            for (Box& box : boxes)
                box = {size * box.min, size * box.max};
            Caching caching(boxes);
            const auto by = directions(boxes.size(), 35);
            for (int frame = 0; frame < 12; ++frame) {
                const float way = frame % 4 < 2 ? step * size : -step * size;
                caching.step(
                    [&](std::size_t i, const Box& box) { return shifted(box, way * by[i]); });
                ASSERT_TRUE(caching.is_right()) << size << " " << step << " " << frame;
            }
        }
}

/// Two boxes head for each other with just the margin: whoever counts a step too little misses the
/// frame in which they meet.
TEST(CachedPairs, MeetInTheVeryFrame) {
    for (const double margin : {.01, .1, 1.})
        for (int frames = 1; frames < 9; ++frames) {
            std::vector<Box> boxes = random_boxes(60, .1f, 36);
            const std::size_t n = boxes.size();
            const float way = static_cast<float>(margin) * .9f / static_cast<float>(frames);
            for (std::size_t i = 0; i < n; ++i) {
                const float x = static_cast<float>(i / 2) * 10,
                            gap = 2 * way * static_cast<float>(frames);
                boxes[i] = i % 2 == 0 ? Box{{x, 0, 0}, {x + 1, 1, 1}}
                                      : Box{{x + 1 + gap, 0, 0}, {x + 2 + gap, 1, 1}};
            }
            Caching caching(boxes, "cached", {{"margin", margin}});
            std::size_t met = 0;
            for (int frame = 0; frame < frames + 3; ++frame) {
                caching.step([&](std::size_t i, const Box& box) {
                    return shifted(box, {i % 2 == 0 ? way : -way, 0, 0});
                });
                ASSERT_TRUE(caching.is_right()) << margin << " " << frames << " " << frame;
                met = std::max(met, caching.pairs().size());
            }
            EXPECT_EQ(met, n / 2);
        }
}

TEST(CachedPairs, AFewFastItemsAreFoundEachFrameAndSlowAgainWhenTheyStop) {
    const std::size_t n = 5000, fast = 40;
    Caching caching(random_boxes(n, .06f, 37));
    const auto by = directions(n, 38);
    std::mt19937 random(39);
    std::uniform_real_distribution<float> place(0, 1);
    std::size_t pairs_rebuilt = 0;
    UpdateStep step;
    for (int frame = 0; frame < 300; ++frame) {
        step = caching.step([&](std::size_t i, const Box& box) {
            if (i % (n / fast) != 0 || frame >= 10)
                return shifted(box, 1e-6f * by[i]);
            const Vec3<float> to{place(random), place(random), place(random)};
            return shifted(box, to - box.min);
        });
        pairs_rebuilt += step.pairs_rebuilt;
        if (frame == 9) {
            EXPECT_EQ(step.fast, fast);
        }
        if (frame < 12 || frame % 50 == 0) {
            ASSERT_TRUE(caching.is_right()) << frame;
        }
    }
    EXPECT_EQ(step.fast, 0u);
    EXPECT_LT(pairs_rebuilt, 4u);
}

/// How many are fast in the fourth frame, where in each some items jump to and fro.
std::size_t fast_in_the_fourth(const char* policy,
                               const std::function<bool(int, std::size_t)>& jumps) {
    Caching caching(random_boxes(8000, .03f, 36), policy);
    std::size_t fast = 0;
    for (int frame = 0; frame < 4; ++frame)
        fast = caching
                   .step([&](std::size_t i, const Box& box) {
                       return jumps(frame, i) ? shifted(box, {frame % 2 ? -.2f : .2f, 0, 0}) : box;
                   })
                   .fast;
    EXPECT_TRUE(caching.is_right());
    return fast;
}

TEST(CachedPairs, AutoGivesUpWhereOtherItemsJumpInEachFrame) {
    const auto others = [](int frame, std::size_t i) {
        return i % 50 == static_cast<std::size_t>(frame);
    };
    const auto the_same = [](int, std::size_t i) { return i % 500 == 0; };
    EXPECT_GE(fast_in_the_fourth("cached", others), 160u);
    EXPECT_EQ(fast_in_the_fourth("auto", others), 0u);
    EXPECT_EQ(fast_in_the_fourth("auto", the_same), 16u);
}

TEST(CachedPairs, WhereTheyAreTooManyTheTreeAnswers) {
    std::vector<Box> same(700, Box{{0, 0, 0}, {1, 1, 1}});
    for (const char* policy : {"cached", "auto"}) {
        Caching caching(same, policy);
        for (int frame = 0; frame < 140; ++frame) {
            const UpdateStep step = caching.step([&](std::size_t i, const Box& box) {
                const float x = frame == 60 ? static_cast<float>(i) : 0;
                return shifted(box, {x + 1e-5f * static_cast<float>(i % 3), 0, 0});
            });
            EXPECT_EQ(step.examined, 0u);
            if (frame % 20 == 0) {
                ASSERT_TRUE(caching.is_right()) << policy << frame;
            }
            if (frame == 60)
                break;
        }
    }
}

TEST(CachedPairs, SameAnswersInTheSameOrderOnEveryExecutor) {
    for (const char* policy : {"cached", "auto"}) {
        std::vector<std::vector<Pair>> first;
        for (const auto& [name, threads] : {std::pair{"serial", 1u},
                                            {"openmp", 1u},
                                            {"openmp", 2u},
                                            {"openmp", 4u},
                                            {"tbb", 1u},
                                            {"tbb", 2u},
                                            {"tbb", 4u}}) {
            const auto executor = make_executor(name, threads);
            Caching caching(random_boxes(30'000, .03f, 40), policy);
            const auto by = directions(caching.boxes.size(), 41);
            std::mt19937 random(42);
            for (std::size_t frame = 0; frame < 6; ++frame) {
                for (std::size_t i = 0; i < caching.boxes.size(); ++i)
                    caching.boxes[i] = shifted(caching.boxes[i], 1e-5f * by[i]);
                for (int jump = 0; jump < 20; ++jump)
                    caching.boxes[random() % caching.boxes.size()] = caching.boxes[7];
                if (frame == 3)
                    caching.boxes[100] = Box{};
                caching.updater->update(caching.boxes, caching.all, *executor);
                if (first.size() <= frame)
                    first.push_back(caching.pairs());
                ASSERT_EQ(caching.pairs(*executor), first[frame])
                    << policy << ", " << name << " " << threads << ", frame " << frame;
            }
        }
    }
}

TEST(GapCodes, AreOfTheAxisThatHoldsThemApart) {
    const Box box{{0, 0, 0}, {4, 4, 4}};
    const auto scale = GapScale::from(10, 10);
    constexpr auto overlap = GapScale::overlap, last = GapScale::last;
    EXPECT_EQ(scale.code(box, shifted(box, {5, 7.01f, 0})), 40u);
    EXPECT_EQ(scale.code(box, shifted(box, {5, 7.21f, 0})), 42u);
    EXPECT_EQ(scale.code(box, shifted(box, {1, 3, 2})), 19u | overlap); // safely below 20
    EXPECT_EQ(scale.code(box, shifted(box, {4, 0, 0})), 9u | overlap);
    EXPECT_EQ(scale.code(box, shifted(box, {1e30f, 0, 0})), last);
    EXPECT_EQ(scale.code({{-3e38f, 0, 0}, {3e38f, 4, 4}}, box), 49u | overlap);
    EXPECT_EQ(scale.code(Box{}, box), last);
    EXPECT_EQ(scale.code(Box{}, Box{}), last);
}

TEST(GapCodes, OfManyAreThoseOfEach) {
    for (const BoxFamily& family : box_families()) {
        const std::size_t n = std::min<std::size_t>(family.boxes.size(), 50);
        struct Strided {
            Pair pair;
            std::uint32_t between;
        };
        std::vector<Pair> pairs;
        std::vector<Strided> strided;
        for (std::uint32_t a = 0; a < n; ++a)
            for (std::uint32_t b = 0; b < n; b += 3) {
                pairs.push_back({a, b});
                strided.push_back({{a, b}, 7});
            }
        if (pairs.empty())
            continue;
        for (const double per_gap : {1e-3, 7., 1e3, 1e300}) {
            const auto scale = GapScale::from(3.5, per_gap);
            std::vector<std::uint32_t> codes(pairs.size()), apart(pairs.size());
            gap_codes(pairs.data(), 2, pairs.size(), family.boxes.data(), scale, codes.data());
            gap_codes(&strided[0].pair, 3, pairs.size(), family.boxes.data(), scale, apart.data());
            EXPECT_EQ(codes, apart);
            for (std::size_t i = 0; i < pairs.size(); ++i) {
                const Box &a = family.boxes[pairs[i].a], &b = family.boxes[pairs[i].b];
                ASSERT_EQ(codes[i], scale.code(a, b)) << family.name;
                ASSERT_EQ((codes[i] & GapScale::overlap) != 0, overlaps(a, b)) << family.name;
            }
        }
    }
}

} // namespace
} // namespace boxwood
