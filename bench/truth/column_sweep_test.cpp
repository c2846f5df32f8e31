#include "bench/truth/column_sweep.h"

#include "scenes/scene.h"
#include "trees/executor.h"
#include "trees/testing/brute_force.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace boxwood::bench {
namespace {

using Box = Aabb<float>;

void expect_right(std::span<const Box> boxes) {
    const std::vector<Pair> expected = brute_force(boxes);
    for (const unsigned threads : {1u, 2u}) {
        const ColumnSweep sweep(boxes, threads);
        EXPECT_EQ(sweep.pairs(), expected);
        EXPECT_EQ(sweep.digest(), digest_of(expected));
        const auto odd = [](Pair p) { return (p.a + p.b) % 2 == 1; };
        std::vector<Pair> even = expected;
        std::erase_if(even, odd);
        EXPECT_EQ(sweep.digest(odd), digest_of(even));
    }
}

TEST(ColumnSweep, FindsThePairsOfEveryScene) {
    for (const SceneEntry& entry : scene_generators()) {
        if (entry.reads_file)
            continue;
        for (const double overlap : {.3, 10., 60.}) {
            SCOPED_TRACE(entry.name);
            expect_right(make_scene({.generator = std::string(entry.name),
                                     .n = overlap == 10 ? 5000u : 2000u, // 4096: a sample
                                     .seed = 3,
                                     .overlaps = overlap})
                             .boxes);
        }
    }
}

/// Integer corners: faces, edges and corners touch, many are flat or points, and most coordinates
/// lie where columns are cut.
TEST(ColumnSweep, CountsWhatTouches) {
    std::mt19937 random(1);
    const auto number = [&](unsigned max_value) {
        return static_cast<float>(random() % (max_value + 1));
    };
    for (const unsigned places : {2u, 9u, 40u}) {
        std::vector<Box> boxes(2000);
        for (Box& box : boxes) {
            box.min = {number(places), number(places), number(places)};
            box.max = box.min + Vec3<float>{number(2), number(2), number(2)};
        }
        expect_right(boxes);
    }
}

TEST(ColumnSweep, StandsExtremes) {
    const Box unit{{0, 0, 0}, {1, 1, 1}};
    expect_right({});
    expect_right(std::vector<Box>{unit});
    expect_right(std::vector<Box>(700, unit));
    expect_right(std::vector<Box>(700, Box{{1, 2, 3}, {1, 2, 3}}));

    const float far = 1e30f, tiny = std::numeric_limits<float>::denorm_min(),
                max_value = std::numeric_limits<float>::max(), nan = std::nanf("");
    std::mt19937 random(2);
    std::vector<Box> boxes = make_scene({.generator = "uniform", .n = 3000}).boxes;
    for (Box& box : boxes)
        switch (random() % 12) {
        case 0:
            box = {};
            break; // not present
        case 1:
            box.max.y = nan;
            break;
        case 2:
            box = {{-far, box.min.y, box.min.z}, {far, box.max.y, box.max.z}};
            break;
        case 3:
            box = {{box.min.x, -far, -far}, {box.max.x, far, far}};
            break;
        case 4:
            box = {{0, 0, 0}, {tiny, tiny, tiny}};
            break;
        case 5:
            box = {{-max_value, -max_value, -max_value}, {-max_value, -max_value, -max_value}};
            break;
        case 6:
            box.min.z = box.max.z = .5f;
            break;
        default:
            break;
        }
    expect_right(boxes);
}

} // namespace
} // namespace boxwood::bench
