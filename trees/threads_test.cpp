/// The contract of trees that are shared: any number of threads may query one at the same time.
/// ThreadSanitizer (the preset tsan) watches; in every build the answers are those of one thread.

#include "trees/bvh.h"
#include "trees/testing/box_families.h"
#include "trees/testing/ray_scenes.h"

#include <gtest/gtest.h>

#include <functional>
#include <latch>
#include <thread>

namespace boxwood {
namespace {

/// Everything that a tree answers, as one list of numbers.
using Answers = std::vector<double>;
using Ask = std::function<Answers()>;

void append(Answers& to, std::span<const std::uint32_t> items) {
    to.insert(to.end(), items.begin(), items.end());
}
void append(Answers& to, const std::vector<Pair>& pairs) {
    for (const Pair pair : pairs)
        to.insert(to.end(), {double(pair.a), double(pair.b)});
}
void append(Answers& to, const std::vector<Neighbour>& items) {
    for (const Neighbour& near : items)
        to.push_back(near.squared_distance);
}
void append(Answers& to, const std::vector<RayHit>& hits) {
    for (const RayHit& hit : hits)
        to.push_back(hit.triangle);
}

Answers ask_boxes(const BoxQueries& bvh, Boxes boxes) {
    Answers all;
    append(all, bvh.self_pairs());
    append(all, bvh.pairs(bvh));
    append(all, bvh.overlapping(boxes).of);
    const std::vector<Vec3<float>> points{boxes[0].min, boxes[1].max};
    append(all, bvh.containing(points).of);
    append(all, bvh.nearest(points, 3));
    append(all, bvh.overlapping(boxes[2]));
    append(all, bvh.containing(boxes[3].min));
    append(all, bvh.nearest(boxes[4].min, 2));
    return all;
}

/// Each of several threads asks for itself, all at once.
void expect_same_from_all_threads(const Ask& ask) {
    constexpr std::size_t n = 4;
    const Answers wanted = ask();
    EXPECT_GT(wanted.size(), 100u);
    std::vector<Answers> found(n);
    std::latch start(n);
    std::vector<std::jthread> threads;
    for (Answers& answers : found)
        threads.emplace_back([&] {
            start.arrive_and_wait();
            answers = ask();
        });
    threads.clear();
    for (const Answers& answers : found)
        EXPECT_EQ(answers, wanted);
}

TEST(SharedTrees, AreQueriedByManyThreadsAtOnce) {
    const std::vector<Box> boxes = random_boxes(3000, .05f, 1);
    for (const unsigned threads : {1u, 2u}) {
        for (const LayoutName layout :
             {LayoutName::packed, LayoutName::wide8, LayoutName::quantised8, LayoutName::binary}) {
            const Bvh bvh(boxes, {.layout = layout, .threads = threads});
            expect_same_from_all_threads([&] { return ask_boxes(bvh, boxes); });
        }
        const DynamicBvh dynamic(boxes, {.threads = threads});
        expect_same_from_all_threads([&] {
            Answers all = ask_boxes(dynamic, boxes);
            for (const Ray<float>& ray : test_rays())
                append(all, dynamic.meeting(ray));
            return all;
        });

        std::vector<Aabb<double>> doubles;
        for (const Box& box : boxes)
            doubles.push_back(static_cast<Aabb<double>>(box));
        const BvhF64 exact(doubles, {.threads = threads});
        expect_same_from_all_threads([&] {
            Answers all;
            append(all, exact.self_pairs());
            append(all, exact.overlapping(doubles[0]));
            append(all, exact.nearest(doubles[1].min, 5));
            return all;
        });

        const MeshBvh mesh(sphere(12), {.threads = threads});
        expect_same_from_all_threads([&] {
            Answers all;
            const std::vector<Ray<float>> rays = test_rays();
            append(all, mesh.closest_hits(rays));
            append(all, mesh.any_hits(rays));
            append(all, mesh.all_hits(rays).of);
            for (const Ray<float>& ray : rays) {
                all.push_back(mesh.closest_hit(ray).value_or(RayHit{}).triangle);
                all.push_back(mesh.any_hit(ray));
                all.push_back(mesh.closest_point(ray.origin)->squared_distance);
                all.push_back(mesh.signed_distances({&ray.origin, 1}).front());
            }
            return all;
        });
    }
}

/// What sides() keeps of a mesh is made by whoever asks first.
TEST(SharedTrees, FirstAskedBySeveralThreadsAtOnce) {
    constexpr std::size_t n = 4;
    const std::vector<Vec3<float>> points{{0, 0, 0}, {9, 0, 0}, {0.1f, 0.2f, 0.3f}};
    const MeshBvh mesh(sphere(12));
    std::vector<std::vector<Side>> found(n);
    std::latch start(n);
    {
        std::vector<std::jthread> threads;
        for (std::vector<Side>& sides : found)
            threads.emplace_back([&] {
                start.arrive_and_wait();
                sides = mesh.sides(points);
            });
    }
    for (const std::vector<Side>& sides : found)
        EXPECT_EQ(sides, (std::vector{Side::inside, Side::outside, Side::inside}));
}

} // namespace
} // namespace boxwood
