/// Compiled twice, as device_test.cpp.

#include "trees/device_triangles.h"

#include "kernels/testing/triangle_pairs.h"
#include "kernels/triangle_distance/features.h"
#include "kernels/triangle_triangle/guigue_devillers_batch.h"
#include "trees/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace boxwood {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class TrianglesOnADevice : public ::testing::Test {
  protected:
    void SetUp() override {
        if (devices().empty())
            GTEST_SKIP() << why_no_device();
    }
};

struct Listed {
    std::vector<Triangle<float>> a, b;
    std::vector<Pair> pairs; ///< i and i, shuffled
    std::vector<bool> touch; ///< by i

    explicit Listed(const std::vector<testing::TrianglePair>& of) {
        for (std::uint32_t i = 0; i < of.size(); ++i) {
            a.push_back(testing::as<float>(of[i].a));
            b.push_back(testing::as<float>(of[i].b));
            pairs.push_back({i, i});
            touch.push_back(of[i].touch);
        }
        std::ranges::shuffle(pairs, std::mt19937(7));
    }
};

std::vector<Listed> lists() {
    testing::PairFamilies make(5, testing::Kept::as_float);
    std::vector<Listed> all;
    for (const std::size_t n : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 4097u})
        all.emplace_back(make.generic(n));
    all.emplace_back(make.grid(300, 3));
    all.emplace_back(make.nearly_touching(300));
    all.emplace_back(make.magnitudes(100, -149, 126));
    return all;
}

TEST_F(TrianglesOnADevice, AreDecidedAsOnTheCpu) {
    std::uint32_t n_uncertain = 0, in_longest = 0;
    for (const Listed& list : lists()) {
        const auto plain = triangles_touch(list.a, list.b, list.pairs, DeviceAccuracy::plain),
                   certified =
                       triangles_touch(list.a, list.b, list.pairs, DeviceAccuracy::certified),
                   exact = triangles_touch(list.a, list.b, list.pairs, DeviceAccuracy::exact);
        ASSERT_EQ(exact.size(), list.pairs.size());
        std::vector<Pair> touching;
        std::uint32_t maybe = 0;
        for (std::size_t k = 0; k < list.pairs.size(); ++k) {
            const std::uint32_t i = list.pairs[k].a;
            const Answer truth = list.touch[i] ? Answer::yes : Answer::no;
            EXPECT_EQ(plain[k], GuigueDevillersF32Batch::intersect(list.a[i], list.b[i]).answer);
            EXPECT_EQ(exact[k], truth);
            EXPECT_TRUE(certified[k] == truth || certified[k] == Answer::maybe);
            maybe += certified[k] == Answer::maybe;
            if (list.touch[i])
                touching.push_back(list.pairs[k]);
        }
        // The same of an indexed mesh that stays there, and what it cost.
        std::vector<Vec3<float>> vertices;
        std::vector<std::array<std::uint32_t, 3>> corners;
        for (const auto* side : {&list.a, &list.b})
            for (const Triangle<float>& t : *side) {
                const auto at = static_cast<std::uint32_t>(vertices.size());
                corners.push_back({at + 2, at, at + 1});
                vertices.insert(vertices.end(), {t.b, t.c, t.a});
            }
        const DevicePlace place;
        const DeviceArray<Vec3<float>> there(std::span<const Vec3<float>>(vertices), place);
        const DeviceArray<Pair> pairs(std::span<const Pair>(list.pairs), place);
        const std::span<const std::array<std::uint32_t, 3>> all(corners);
        const DeviceArray<std::array<std::uint32_t, 3>> first(all.first(list.a.size()), place),
            second(all.subspan(list.a.size()), place);
        const DeviceTriangles a{there.span(), first.span()}, b{there.span(), second.span()};
        EXPECT_EQ(touching_pairs(a, b, pairs.span(), DeviceAccuracy::exact).to_host(), touching);
        const auto decided = triangles_touch(a, b, pairs.span(), DeviceAccuracy::exact);
        EXPECT_EQ(decided.of.to_host(), exact);
        const UncertainPairs uncertain = decided.uncertain.to_host()[0];
        EXPECT_EQ(uncertain.n, maybe);
        n_uncertain += uncertain.n;
        in_longest += uncertain.in_longest;
    }
    EXPECT_GT(n_uncertain, in_longest);
    EXPECT_GT(in_longest, 0u);
}

TEST_F(TrianglesOnADevice, AreMeasuredAsOnTheCpu) {
    for (const Listed& list : lists()) {
        const auto plain = triangle_distances(list.a, list.b, list.pairs, DeviceAccuracy::plain),
                   exact = triangle_distances(list.a, list.b, list.pairs, DeviceAccuracy::exact);
        ASSERT_EQ(plain.size(), list.pairs.size());
        for (std::size_t k = 0; k < list.pairs.size(); ++k) {
            const std::uint32_t i = list.pairs[k].a;
            EXPECT_EQ(plain[k].lo, FeaturesF32::distance(list.a[i], list.b[i]).distance);
            EXPECT_EQ(plain[k].hi, plain[k].lo);
            EXPECT_EQ(exact[k].hi == 0, list.touch[i]);
            EXPECT_LE(exact[k].hi - exact[k].lo, exact[k].hi * 0x1p-32);
        }
    }
}

TEST_F(TrianglesOnADevice, OfAPairThatIsNotThereAreRefused) {
    const std::vector<Triangle<float>> one(1), two(2);
    const std::vector<Pair> good{{0, 1}}, bad{{0, 1}, {1, 0}};
    EXPECT_EQ(triangles_touch(one, two, good, DeviceAccuracy::exact).size(), 1u);
    EXPECT_THAT([&] { triangles_touch(one, two, bad, DeviceAccuracy::plain); },
                ThrowsMessage<std::invalid_argument>(
                    HasSubstr("pair 1 is of the triangles 1 and 0, of 1 and 2")));
    EXPECT_THROW(triangle_distances(two, one, good, DeviceAccuracy::exact), std::invalid_argument);
}

} // namespace
} // namespace boxwood
