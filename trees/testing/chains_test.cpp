#include "trees/builder.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/optimizers/refit.h"
#include "trees/queries/sorted_rays.h"
#include "trees/testing/append_hits.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/layouts_answering.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>

/// Trees as deep as they have items, and boxes that lead to such trees: nothing may take a stack
/// frame per level, nor time beyond the output.
namespace boxwood {
namespace {

/// Runs the body on a thread with a stack of 256 KiB: two bytes and a bit for each level.
void on_a_small_stack(const std::function<void()>& body) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    ASSERT_EQ(pthread_attr_setstacksize(&attributes, 256 * 1024), 0);
    pthread_t thread;
    const auto run = [](void* of) -> void* {
        (*static_cast<const std::function<void()>*>(of))();
        return nullptr;
    };
    void* argument = const_cast<void*>(static_cast<const void*>(&body));
    ASSERT_EQ(pthread_create(&thread, &attributes, run, argument), 0);
    pthread_join(thread, nullptr);
    pthread_attr_destroy(&attributes);
}

constexpr std::uint32_t n = 120'000;

/// A strip of triangles, each in a cell of its own along x; neighbours share a corner.
TriangleMesh strip() {
    TriangleMesh mesh;
    for (std::uint32_t k = 0; k < n; ++k) {
        const auto x = static_cast<float>(k);
        mesh.vertices.insert(mesh.vertices.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 1}});
        mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    return mesh;
}

Box cells(std::uint32_t first, std::uint32_t last) {
    return {{static_cast<float>(first), 0, 0}, {static_cast<float>(last), 1, 1}};
}

/// One cell split off at each inner node: the first, as a left child, or the last, as a right one.
Tree chain(bool to_the_right) {
    Tree tree(n);
    for (std::uint32_t k = 0; k < n; ++k) {
        tree.order[k] = k;
        const bool leaf_only = k + 1 == n;
        if (to_the_right) {
            if (!leaf_only)
                tree.nodes[2 * k] = {cells(k, n), k, n - k};
            tree.nodes[leaf_only ? 2 * k : 2 * k + 1] = {cells(k, k + 1), k, 1};
        } else {
            if (!leaf_only)
                tree.nodes[k] = {cells(0, n - k), 0, n - k};
            tree.nodes[n - 1 + k] = {cells(k, k + 1), k, 1};
        }
    }
    return tree;
}

/// Every query, at cells near both ends and in the middle.
void expect_answers(const AnyLayout& layout, const TriangleMesh& mesh) {
    CountPairs count;
    layout.self_pairs(serial(), count);
    EXPECT_EQ(count.count(), n - 1);
    EXPECT_EQ(layout.self_pairs_counted(count).answers, n - 1);
    layout.tree_pairs(layout, serial(), count);
    EXPECT_EQ(count.count(), n + 2 * (n - 1));

    std::vector<Vec3<float>> points;
    std::vector<Box> boxes;
    std::vector<Sphere<float>> balls;
    std::vector<Ray<float>> rays;
    for (const std::uint32_t k : {0u, 1u, 7u, n / 2, n - 2, n - 1}) {
        const auto x = static_cast<float>(k) + .25f;
        points.push_back({x, .5f, .5f});
        boxes.push_back({points.back(), points.back()});
        balls.push_back({points.back(), .125f});
        rays.push_back({{x, 1, 0}, {0, -1, 1}});
    }
    const auto expect_own = [&](const auto& query) {
        std::vector<Pair> pairs;
        AppendPairs sink(pairs);
        query(sink);
        ASSERT_EQ(pairs.size(), points.size());
        for (std::uint32_t i = 0; i < pairs.size(); ++i)
            EXPECT_EQ(pairs[i], (Pair{i, static_cast<std::uint32_t>(points[i].x)}));
    };
    expect_own([&](PairSink& sink) { layout.points(points, serial(), sink); });
    expect_own([&](PairSink& sink) { layout.regions(boxes, serial(), sink); });
    expect_own([&](PairSink& sink) { layout.regions(balls, serial(), sink); });

    std::vector<Neighbour> near(points.size());
    layout.nearest(points, 1, serial(), near);
    std::vector<SurfacePoint> surface(points.size());
    layout.closest_points(points, mesh, serial(), surface);
    const TriangleBlocks triangles = layout.triangles(mesh);
    std::vector<RayHit> hits(rays.size()), sorted(rays.size());
    layout.rays(rays, RayQuery::closest, "watertight", triangles, serial(), hits);
    sorted_rays(layout, rays, RayQuery::any, "watertight", triangles, serial(), sorted);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto own = static_cast<std::uint32_t>(points[i].x);
        EXPECT_EQ(near[i], (Neighbour{own, 0}));
        EXPECT_EQ(surface[i].triangle, own);
        EXPECT_EQ(hits[i].triangle, own);
        EXPECT_EQ(sorted[i].triangle, own);
    }
    // Along the strip, beside every triangle but through every box.
    rays.push_back({{-1, .75f, .25f}, {1, 0, 0}});
    layout.rays(std::span(rays).last(1), RayQuery::any, "watertight", triangles, serial(),
                std::span(hits).first(1));
    EXPECT_FALSE(hits[0].hit());
    for (const char* kernel : {"watertight", "exact"}) {
        AppendHits all;
        layout.rays_all(rays, kernel, triangles, serial(), all);
        ASSERT_EQ(all.all.size(), points.size()) << kernel;
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(all.all[i].first, i) << kernel;
            EXPECT_EQ(all.all[i].second.triangle, static_cast<std::uint32_t>(points[i].x))
                << kernel;
        }
    }
}

TEST(Chains, EveryLayoutAnswersEveryQueryOnASmallStack) {
    const TriangleMesh mesh = strip();
    for (const bool to_the_right : {false, true}) {
        const Tree tree = chain(to_the_right);
        for (const LayoutEntry& entry :
             layouts_answering({Query::self_pairs, Query::tree_pairs, Query::rays, Query::points,
                                Query::regions, Query::nearest, Query::closest_points})) {
            SCOPED_TRACE(std::string(entry.name) + (to_the_right ? ", right" : ", left"));
            on_a_small_stack([&] { expect_answers(*entry.make(tree, serial()), mesh); });
        }
    }
}

TEST(Chains, AreCheckedMeasuredRefittedAndImprovedOnASmallStack) {
    std::vector<Box> boxes;
    for (std::uint32_t k = 0; k < n; ++k)
        boxes.push_back(cells(k, k + 1));
    for (const bool to_the_right : {false, true})
        on_a_small_stack([&] {
            Tree tree = chain(to_the_right);
            EXPECT_EQ(validate(tree, boxes).value_or(""), "");
            EXPECT_EQ(quality(tree, boxes, {1, 1, 0}).depth_max, n - 1);
            EXPECT_EQ(refit(tree, boxes), 0u);
            for (const OptimizerEntry& optimizer : optimizers()) {
                optimizer.make({})(tree, serial());
                EXPECT_EQ(validate(tree, boxes).value_or(""), "") << optimizer.name;
            }
        });
}

/// Families that make a chain of a careless builder.
struct Hard {
    const char* name;
    std::function<Box(float)> box;
};
const Hard hard[]{
    {"identical",
     [](float) {
         return Box{{0, 0, 0}, {1, 1, 1}};
     }},
    {"identical points",
     [](float) {
         return Box{{1, 2, 3}, {1, 2, 3}};
     }},
    {"nested",
     [](float i) {
         return Box{{-i, -i, -i}, {i, i, i}};
     }},
    {"sorted",
     [](float i) {
         return Box{{i, 0, 0}, {i + 1, 1, 1}};
     }},
    {"sorted and growing",
     [](float i) {
         return Box{{i, 0, 0}, {i + i, 0, 0}};
     }},
    {"by octaves",
     [](float i) {
         const float x = std::exp2(i * (250.f / n) - 125);
         return Box{{x, x, x}, {x, x, x}};
     }},
};

double cpu_seconds() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TEST_P(EachBuilder, StaysInTimeAndDepthOnASmallStack) {
    constexpr std::uint32_t m = 40'000;
    const auto seconds_of = [&](const std::vector<Box>& boxes, const std::string& name) {
        double seconds = 0;
        on_a_small_stack([&] {
            const double start = cpu_seconds();
            const Tree tree = build(boxes);
            seconds = cpu_seconds() - start;
            EXPECT_EQ(validate(tree, boxes).value_or(""), "") << name;
            // Depth bounded by the logarithm of n and the bits of a coordinate.
            EXPECT_LE(quality(tree, boxes, {1, 1, 0}).depth_max, 300u) << name;
        });
        return seconds;
    };
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < m; ++i) {
        const auto at = [&](std::uint32_t k) { return static_cast<float>(i * k % 7919); };
        boxes.push_back({{at(31), at(577), at(2011)}, {at(31) + 9, at(577) + 9, at(2011) + 9}});
    }
    const double usual = seconds_of(boxes, "scattered");
    for (const Hard& family : hard) {
        for (std::uint32_t i = 0; i < m; ++i)
            boxes[i] = family.box(static_cast<float>(i));
        // Quadratic: some hundred times as much.
        EXPECT_LE(seconds_of(boxes, family.name), 30 * usual + .1) << family.name;
    }
}

/// Of identical boxes every query touches no more than a few boxes per answer.
TEST_P(EachBuilder, WorkOnIdenticalBoxesIsThatOfTheOutput) {
    const std::vector<Box> boxes(4000, Box{{0, 0, 0}, {1, 1, 1}}), few(20, boxes[0]);
    const std::vector<Vec3<float>> points(20, Vec3<float>{.5f, 1, 0});
    const std::vector<Sphere<float>> balls(20, Sphere<float>{{2, .5f, .5f}, 1});
    const Tree tree = build(boxes);
    for (const LayoutEntry& entry :
         layouts_answering({Query::self_pairs, Query::tree_pairs, Query::points, Query::regions})) {
        SCOPED_TRACE(entry.name);
        const auto layout = entry.make(tree, serial());
        CountPairs count;
        const auto expect_little = [&](const Work& work, std::uint64_t answers) {
            EXPECT_EQ(work.answers, answers);
            EXPECT_LE(work.box_tests, 5 * answers + 100);
        };
        expect_little(layout->tree_pairs_counted(*layout, count), 4000u * 4000);
        Work work;
        layout->points(points, serial(), count, &work);
        expect_little(work, 20 * 4000);
        layout->regions(few, serial(), count, &(work = {}));
        expect_little(work, 20 * 4000);
        layout->regions(balls, serial(), count, &(work = {}));
        expect_little(work, 20 * 4000);
        std::vector<Neighbour> near(1000 * 20);
        layout->nearest(points, 1000, serial(), near, &(work = {}));
        EXPECT_LE(work.box_tests, 5u * 20 * 4000); // a tie goes to the lowest item
    }
}

} // namespace
} // namespace boxwood
