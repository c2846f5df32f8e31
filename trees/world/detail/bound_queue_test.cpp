#include "trees/world/detail/bound_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace boxwood::detail {
namespace {

TEST(BoundQueue, PopsTheLeastBoundButForABucketsWidth) {
    std::mt19937 random(1);
    constexpr float greatest = 3;
    BoundQueue queue(greatest);
    std::vector<NearEntry> inside;
    bool was_full = false;
    std::size_t times_empty = 0;
    std::uniform_real_distribution<float> bounds(0, 1.2f * greatest);
    for (std::uint32_t id = 0; id < 50'000; ++id) {
        // Grows to the brim, then shrinks to nothing, again and again.
        const bool grows = id / 4000 % 2 == 0;
        was_full |= !queue.has_room_for(1);
        times_empty += queue.empty();
        if (queue.has_room_for(1) && (queue.empty() || (random() % 4 != 0) == grows)) {
            const NearEntry entry{random() % 8 == 0 ? 0 : bounds(random), id, 0};
            queue.push(entry);
            inside.push_back(entry);
        } else {
            const NearEntry got = queue.pop();
            const auto at = std::ranges::find(inside, got.a, &NearEntry::a);
            ASSERT_NE(at, inside.end());
            EXPECT_EQ(at->bound, got.bound);
            const float least = std::ranges::min_element(inside, {}, &NearEntry::bound)->bound;
            EXPECT_LE(std::min(got.bound, greatest), least + greatest / 64 * 1.0001f);
            inside.erase(at);
        }
        ASSERT_EQ(queue.size(), inside.size());
        ASSERT_EQ(queue.empty(), inside.empty());
    }
    EXPECT_TRUE(was_full);
    EXPECT_GT(times_empty, 5u);
}

TEST(BoundQueue, IsAStackWhereTheGreatestBoundIsInfinite) {
    BoundQueue queue(std::numeric_limits<float>::infinity());
    for (std::uint32_t id = 0; id < queue.capacity; ++id) {
        EXPECT_TRUE(queue.has_room_for(1));
        queue.push({static_cast<float>(id % 7), id, 0});
    }
    EXPECT_FALSE(queue.has_room_for(1));
    for (std::uint32_t id = queue.capacity; id-- > 0;)
        EXPECT_EQ(queue.pop().a, id);
    EXPECT_TRUE(queue.empty());
}

TEST(BoundQueue, TakesBoundsOfAnySize) {
    for (const float greatest : {0.f, 1e-45f, 1e-30f, 1e30f, std::numeric_limits<float>::max()}) {
        BoundQueue queue(greatest);
        std::set<std::uint32_t> inside;
        std::uint32_t id = 0;
        for (const float bound : {0.f, 1e-45f, greatest / 2, greatest, 1.f, 1e38f}) {
            queue.push({bound, id, 0});
            inside.insert(id++);
        }
        while (!queue.empty())
            EXPECT_EQ(inside.erase(queue.pop().a), 1u);
        EXPECT_TRUE(inside.empty());
    }
}

} // namespace
} // namespace boxwood::detail
