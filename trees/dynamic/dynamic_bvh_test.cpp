#include "trees/dynamic/dynamic_bvh.h"

#include "kernels/ray_box/slabs.h"
#include "trees/queries/box_distance.h"
#include "trees/queries/nearest.h"
#include "trees/queries/regions.h"
#include "trees/testing/box_families.h"
#include "trees/testing/ray_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace boxwood {
namespace {

/// Boxes by item, with gaps in the numbers.
using World = std::map<std::uint32_t, Box>;

void expect_answers(const DynamicBvh& bvh, const World& world) {
    std::vector<Pair> pairs;
    for (auto a = world.begin(); a != world.end(); ++a)
        for (auto b = std::next(a); b != world.end(); ++b)
            if (overlaps(a->second, b->second))
                pairs.push_back({a->first, b->first});
    std::vector<Pair> found = bvh.self_pairs();
    std::ranges::sort(found);
    EXPECT_EQ(found, pairs);
    for (const auto& [item, box] : world) {
        std::vector<std::uint32_t> overlapping, containing;
        Neighbour nearest;
        for (const auto& [other, b] : world) {
            if (overlaps(b, box))
                overlapping.push_back(other);
            if (b.contains(box.min))
                containing.push_back(other);
            const Neighbour here{other, squared_distance(box.max, b)};
            if (here.squared_distance < nearest.squared_distance)
                nearest = here;
        }
        EXPECT_EQ(bvh.overlapping(box), overlapping);
        EXPECT_EQ(bvh.containing(box.min), containing);
        EXPECT_EQ(bvh.nearest(box.max), std::vector{nearest});
    }
}

TEST(DynamicBvh, AnswersWhileBoxesComeGoAndMove) {
    std::mt19937 random(3);
    const std::vector<Box> boxes = random_boxes(4000, .2f, 12);
    DynamicBvh bvh;
    World world;
    expect_answers(bvh, world);
    for (std::uint32_t step = 0; step < 900; ++step) {
        const auto item = static_cast<std::uint32_t>(random() % 150 * 7);
        if (!world.contains(item))
            bvh.insert(item, world[item] = boxes[step]);
        else if (random() % 3 == 0) {
            bvh.remove(item);
            world.erase(item);
        } else
            bvh.move(item, world[item] = boxes[step + 2000]);
        if (step % 50 == 0)
            expect_answers(bvh, world);
    }
    ASSERT_EQ(bvh.size(), world.size());
    expect_answers(bvh, world);
    DynamicBvh taken(std::move(bvh));
    expect_answers(taken, world);
    taken.clear();
    expect_answers(taken, {});
}

TEST(DynamicBvh, RaysMeetTheBoxesOnTheirWay) {
    for (const auto& [family, boxes] : box_families()) {
        SCOPED_TRACE(family);
        const DynamicBvh bvh(boxes);
        for (const Ray<float>& ray : test_rays()) {
            std::vector<std::uint32_t> wanted;
            const RaySlabs slabs(ray);
            for (std::uint32_t i = 0; i < boxes.size(); ++i)
                if (clip(slabs, boxes[i], ray.t_min, ray.t_max).hit())
                    wanted.push_back(i);
            EXPECT_EQ(bvh.meeting(ray), wanted);
        }
        EXPECT_TRUE(bvh.meeting({{RayHit::nowhere, 0, 0}, {1, 0, 0}}).empty());
    }
}

/// The balls within the boxes: the nearest hit, found among few of them.
TEST(DynamicBvh, AVisitorEndsTheRay) {
    std::vector<Box> boxes = random_boxes(3000, .02f, 4);
    for (Box& box : boxes)
        box.max = box.min + Vec3<float>{.02f, .02f, .02f};
    const DynamicBvh bvh(boxes);
    const auto hit = [&](std::uint32_t item, const Ray<float>& ray) -> float {
        const Vec3<float> to = ray.origin - (boxes[item].min + Vec3<float>{.01f, .01f, .01f});
        const float a = dot(ray.direction, ray.direction), b = dot(ray.direction, to),
                    c = dot(to, to) - 1e-4f, d = b * b - a * c;
        const float t = d < 0 ? -1 : (-b - std::sqrt(d)) / a;
        return t >= 0 && t <= ray.t_max ? t : ray.t_max;
    };
    std::size_t visits = 0, rays = 0;
    for (const Ray<float>& ray : test_rays()) {
        float wanted = ray.t_max, found = ray.t_max;
        for (std::uint32_t i = 0; i < boxes.size(); ++i)
            wanted = std::min(wanted, hit(i, ray));
        bvh.meeting(ray, [&](std::uint32_t item, const Ray<float>& left) {
            ++visits;
            EXPECT_EQ(left.t_max, found);
            return found = std::min(found, hit(item, left));
        });
        EXPECT_EQ(found, wanted);
        ++rays;
    }
    EXPECT_LT(visits, 20 * rays);
}

/// A step of a box, and what is around it then, at the same density of boxes: the nodes looked at
/// grow as log n does.
TEST(DynamicBvh, AMoveAndAQueryOfItsSurroundingsTakeLogarithmicTime) {
    std::vector<double> per_level;
    for (const std::size_t n : {1'000u, 10'000u, 100'000u, 1'000'000u}) {
        const float size = .5f * std::cbrt(1 / static_cast<float>(n));
        std::vector<Box> boxes = random_boxes(n, size, 5);
        DynamicTree tree;
        tree.reserve(n);
        for (std::uint32_t i = 0; i < n; ++i)
            tree.insert(i, boxes[i]);
        Work work;
        std::mt19937 random(6);
        std::uniform_real_distribution<float> step(-size, size);
        constexpr int moves = 1000;
        CountPairs found;
        for (int i = 0; i < moves; ++i) {
            const auto item = static_cast<std::uint32_t>(random() % n);
            const Vec3<float> by{step(random), step(random), step(random)};
            Box& box = boxes[item];
            box = {box.min + by, box.max + by};
            tree.move(item, box, &work);
            regions(tree, std::span<const Box>(&box, 1), serial(), found, &work);
            Neighbour near[2];
            nearest(tree, std::span<const Vec3<float>>(&box.min, 1), 2, serial(), near, &work);
        }
        per_level.push_back(static_cast<double>(work.node_visits) / moves /
                            std::log2(static_cast<double>(n)));
        EXPECT_LE(static_cast<double>(tree.height()), 3.5 * std::log2(static_cast<double>(n)));
    }
    for (const double count : per_level) {
        EXPECT_GT(count, 1) << "what is counted is counted";
        EXPECT_LT(count, 1.5 * per_level.front());
    }
}

} // namespace
} // namespace boxwood
