#pragma once

#include "trees/testing/test_bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace boxwood {

/// Collisions, tolerances, distances and candidates as those of all pairs that may meet.
inline void expect_all_questions_right(const MirroredWorld& mirror) {
    const World& world = mirror.world;
    const std::vector<Pair> collisions = mirror.collisions();
    EXPECT_EQ(world.collisions(), collisions);
    const auto any = world.any_collision();
    EXPECT_EQ(any.has_value(), !collisions.empty());
    if (any) {
        EXPECT_TRUE(std::ranges::binary_search(collisions, *any));
    }
    for (const double tolerance : {0.0, .15, .6}) {
        const auto near = mirror.pairs_where([&](const PosedShape& a, const PosedShape& b) {
            return within(a, b, tolerance) != Answer::no;
        });
        EXPECT_EQ(world.within(tolerance), near);
        std::vector<Pair> measured;
        for (const BodyDistance& d : world.distances(tolerance)) {
            measured.push_back(d.bodies);
            const BodyDistance alone = distance(mirror.posed(d.bodies.a), mirror.posed(d.bodies.b));
            EXPECT_LE(d.lo, alone.hi);
            EXPECT_GE(d.hi, alone.lo);
        }
        EXPECT_EQ(measured, near);
        const std::vector<Pair> candidates = world.candidates(tolerance);
        EXPECT_TRUE(std::ranges::includes(candidates, near));
        std::vector<Pair> by_body;
        for (const std::uint32_t body : world.bodies())
            for (const std::uint32_t other : world.candidates_of(body, tolerance))
                if (body < other)
                    by_body.push_back({body, other});
                else
                    EXPECT_TRUE(std::ranges::binary_search(candidates, Pair{other, body}));
        EXPECT_EQ(sorted(by_body), candidates);
    }
    std::vector<Pair> by_body;
    for (const std::uint32_t body : world.bodies())
        for (const std::uint32_t other : world.collisions_of(body))
            by_body.push_back({std::min(body, other), std::max(body, other)});
    std::vector<Pair> twice = collisions;
    twice.insert(twice.end(), collisions.begin(), collisions.end());
    EXPECT_EQ(sorted(by_body), sorted(twice));
}

} // namespace boxwood
