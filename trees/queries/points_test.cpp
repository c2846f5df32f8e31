#include "kernels/features/point_triangle.h"
#include "kernels/testing/every_target.h"
#include "trees/builder.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/testing/box_families.h"
#include "trees/testing/each_builder.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/region_queries.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace boxwood {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// The same formula as the contract's, on its own.
double distance_to(Vec3<float> point, const Box& box) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double p = static_cast<double>(point[axis]);
        double d = 0;
        if (p < static_cast<double>(box.min[axis]))
            d = static_cast<double>(box.min[axis]) - p;
        else if (p > static_cast<double>(box.max[axis]))
            d = p - static_cast<double>(box.max[axis]);
        sum += d * d;
    }
    return sum;
}

bool is_inverted(const Box& b) {
    return !(b.min.x <= b.max.x && b.min.y <= b.max.y && b.min.z <= b.max.z);
}

struct Expected {
    std::vector<Pair> points, boxes, balls;
    std::vector<Neighbour> nearest; ///< k = 5
};
constexpr std::size_t k = 5;

Expected brute_force(Boxes items, const QueriesOfRegions& q) {
    Expected e;
    for (std::uint32_t i = 0; i < q.points.size(); ++i) {
        std::vector<Neighbour> all;
        for (std::uint32_t j = 0; j < items.size(); ++j) {
            if (items[j].contains(q.points[i]))
                e.points.push_back({i, j});
            if (is_finite(q.points[i]))
                all.push_back({j, distance_to(q.points[i], items[j])});
        }
        std::ranges::stable_sort(all, {}, &Neighbour::squared_distance);
        all.resize(k);
        e.nearest.insert(e.nearest.end(), all.begin(), all.end());
    }
    for (std::uint32_t i = 0; i < q.boxes.size(); ++i)
        for (std::uint32_t j = 0; j < items.size(); ++j)
            if (!is_inverted(q.boxes[i]) && overlaps(q.boxes[i], items[j]))
                e.boxes.push_back({i, j});
    for (std::uint32_t i = 0; i < q.balls.size(); ++i) {
        const double r = static_cast<double>(q.balls[i].radius);
        for (std::uint32_t j = 0; j < items.size(); ++j)
            if (is_finite(q.balls[i].centre) && r >= 0 &&
                distance_to(q.balls[i].centre, items[j]) <= r * r)
                e.balls.push_back({i, j});
    }
    return e;
}

void expect_answers(const AnyLayout& layout, const QueriesOfRegions& q, const Expected& e,
                    const Executor& executor, Work* work = nullptr) {
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    layout.points(q.points, executor, sink, work);
    ASSERT_EQ(pairs, e.points);
    pairs.clear();
    layout.regions(q.boxes, executor, sink, work);
    ASSERT_EQ(pairs, e.boxes);
    pairs.clear();
    layout.regions(q.balls, executor, sink, work);
    ASSERT_EQ(pairs, e.balls);
    std::vector<Neighbour> near(k * q.points.size());
    layout.nearest(q.points, k, executor, near, work);
    ASSERT_EQ(near, e.nearest);
    near.resize(q.points.size());
    layout.nearest(q.points, 1, executor, near, work);
    for (std::size_t i = 0; i < near.size(); ++i)
        ASSERT_EQ(near[i], e.nearest[k * i]) << i;
}

TEST_P(EachBuilder, PointsRegionsAndNeighboursAgreeWithBruteForce) {
    for (const BoxFamily& family : box_families()) {
        SCOPED_TRACE(family.name);
        const QueriesOfRegions q = queries_for(family.boxes);
        const Expected e = brute_force(family.boxes, q);
        const Tree tree = build(family.boxes);
        for (const LayoutEntry& entry : layouts_answering(
                 {Query::points, Query::regions, Query::nearest, Query::closest_points})) {
            SCOPED_TRACE(entry.name);
            const auto layout = entry.make(tree, serial());
            Work work;
            expect_answers(*layout, q, e, serial(), &work);
            const auto found = static_cast<std::uint64_t>(std::ranges::count_if(
                e.nearest, [](const Neighbour& n) { return n.item != Neighbour::none; }));
            const auto any = static_cast<std::uint64_t>(
                family.boxes.empty() ? 0 : std::ranges::count_if(q.points, [](Vec3<float> p) {
                    return is_finite(p);
                }));
            EXPECT_EQ(work.answers,
                      e.points.size() + e.boxes.size() + e.balls.size() + found + any);
            EXPECT_EQ(work.box_tests > 0, !family.boxes.empty());
            if (&builder_ == &builders().front())
                on_every_target([&] { expect_answers(*layout, q, e, serial()); });
        }
    }
}

/// Many more queries than one chunk.
TEST(Points, AnswerInOneOrderOnEveryExecutor) {
    const std::vector<Box> items = random_boxes(3000, .1f, 3);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    QueriesOfRegions q;
    for (int i = 0; i < 2000; ++i) {
        q.points.push_back({unit(random), unit(random), unit(random)});
        q.balls.push_back({q.points.back(), .1f * unit(random)});
        q.boxes.push_back({q.points.back(), q.points.back() + Vec3<float>{.1f, .2f, .1f}});
    }
    const Expected e = brute_force(items, q);
    ASSERT_GT(e.points.size(), 500u);
    for (const LayoutEntry& entry : layouts_answering(
             {Query::points, Query::regions, Query::nearest, Query::closest_points})) {
        SCOPED_TRACE(entry.name);
        const auto layout = entry.make(builders().front().make({})(items, serial()), serial());
        for (const auto& [name, executor] : every_executor()) {
            SCOPED_TRACE(name);
            expect_answers(*layout, q, e, *executor);
        }
        std::size_t taken = 0;
        ForEachPair stop([&](Pair) { return ++taken < 10; });
        layout->regions(q.boxes, serial(), stop);
        EXPECT_EQ(taken, 10u);
    }
}

/// So many points of a tree so large come in another order; asked one by one they do not.
TEST(Points, ManyAtOnceAreAnsweredAsOneByOne) {
    const std::vector<Box> items = random_boxes(9000, .01f, 5);
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(-.2f, 1.2f);
    std::vector<Vec3<float>> points{{nan, 0, 0}, {0, inf, 0}, {-1e30f, 1e30f, .5f}};
    while (points.size() < 2500)
        points.push_back({unit(random), unit(random), unit(random)});
    for (const LayoutEntry& entry : layouts_answering({Query::nearest})) {
        SCOPED_TRACE(entry.name);
        const auto layout = entry.make(builders().front().make({})(items, serial()), serial());
        for (const std::size_t wanted : {std::size_t{1}, k}) {
            std::vector<Neighbour> alone(wanted * points.size()), together(alone.size());
            for (std::size_t i = 0; i < points.size(); ++i)
                layout->nearest(std::span(points).subspan(i, 1), wanted, serial(),
                                std::span(alone).subspan(i * wanted, wanted));
            for (const auto& [name, executor] : every_executor()) {
                SCOPED_TRACE(name);
                std::ranges::fill(together, Neighbour{7, 7});
                layout->nearest(points, wanted, *executor, together);
                EXPECT_EQ(alone, together);
            }
        }
    }
}

/// One item beside all others, and so on: wide layouts are a hundred blocks deep.
TEST(Points, ADeepTreeIsSearchedToItsEnd) {
    std::vector<Box> items;
    QueriesOfRegions q;
    for (int i = 0; i < 1500; ++i) {
        const float x = static_cast<float>(i);
        items.push_back({{x, 0, 0}, {x + .5f, .5f, .5f}});
        q.points.push_back({x + .6f, .2f, .75f});
        q.balls.push_back({q.points.back(), .3f});
        q.boxes.push_back({q.points.back(), q.points.back() + Vec3<float>{.6f, .1f, .1f}});
    }
    const Expected e = brute_force(items, q);
    const auto n = static_cast<std::uint32_t>(items.size());
    Tree chain(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        chain.order[i] = i;
        if (i + 1 < n)
            chain.nodes[2 * i] = {{items[i].min, items.back().max}, i, n - i};
        chain.nodes[i + 1 < n ? 2 * i + 1 : 2 * i] = {items[i], i, 1};
    }
    ASSERT_EQ(validate(chain, items, Bounds::tight), std::nullopt);
    for (const LayoutEntry& entry : layouts_answering({Query::nearest})) {
        SCOPED_TRACE(entry.name);
        expect_answers(*entry.make(chain, serial()), q, e, serial());
    }
}

TEST(Points, RefuseAnswersOfTheWrongSize) {
    const std::vector<Box> items = random_boxes(10, .1f, 3);
    const std::vector<Vec3<float>> points(4);
    std::vector<Neighbour> near(7);
    std::vector<SurfacePoint> surface(3);
    for (const LayoutEntry& entry : layouts_answering({Query::nearest, Query::closest_points})) {
        const auto layout = entry.make(builders().front().make({})(items, serial()), serial());
        EXPECT_THROW(layout->nearest(points, 2, serial(), near), std::invalid_argument);
        EXPECT_THROW(layout->closest_points(points, {}, serial(), surface), std::invalid_argument);
        layout->nearest(points, 0, serial(), {});
    }
}

TriangleMesh soup(std::size_t n, float size, float scale) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-1, 1);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Vec3<float> p{place(random), place(random), place(random)};
        for (int corner = 0; corner < 3; ++corner)
            mesh.vertices.push_back(
                scale * (p + size * Vec3<float>{place(random), place(random), place(random)}));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + (i % 10 == 0 ? 1 : 2)}); // some flat
    }
    return mesh;
}

/// The kernel on every triangle.
SurfacePoint closest_of_all(const TriangleMesh& mesh, Vec3<float> point) {
    SurfacePoint best;
    for (std::uint32_t i = 0; is_finite(point) && i < mesh.triangles.size(); ++i) {
        const Triangle<float> t = mesh.triangle(i);
        const auto at = point_triangle::Regions::nearest(
            Vec3<double>(point),
            Triangle<double>{Vec3<double>(t.a), Vec3<double>(t.b), Vec3<double>(t.c)});
        const double squared = dot(at.offset, at.offset);
        if (squared < best.squared_distance)
            best = {Vec3<float>(at.b), i, squared};
    }
    return best;
}

TEST_P(EachBuilder, ClosestPointsAgreeWithTheKernelOnEveryTriangle) {
    for (const TriangleMesh& mesh :
         {soup(2000, .1f, 1), soup(300, 1, 1e30f), soup(300, .5f, 1e-38f), soup(5, 1, 1),
          soup(1, 1, 1), TriangleMesh{}}) {
        SCOPED_TRACE(std::to_string(mesh.triangles.size()));
        const std::vector<Box> items = triangle_boxes(mesh);
        std::vector<Vec3<float>> points = queries_for(items).points;
        for (std::size_t i = 0; i < std::min<std::size_t>(mesh.vertices.size(), 600); ++i)
            points.push_back(.9f * mesh.vertices[(7 * i) % mesh.vertices.size()]);
        std::vector<SurfacePoint> expected;
        for (const Vec3<float> p : points)
            expected.push_back(closest_of_all(mesh, p));
        const Tree tree = build(items);
        for (const LayoutEntry& entry : layouts_answering({Query::closest_points})) {
            SCOPED_TRACE(entry.name);
            const auto layout = entry.make(tree, serial());
            const auto expect = [&](const Executor& executor, Work* work) {
                std::vector<SurfacePoint> got(points.size());
                layout->closest_points(points, mesh, executor, got, work);
                for (std::size_t i = 0; i < got.size(); ++i) {
                    ASSERT_EQ(got[i].triangle, expected[i].triangle) << i;
                    ASSERT_EQ(got[i].squared_distance, expected[i].squared_distance) << i;
                    ASSERT_EQ(got[i].point, expected[i].point) << i;
                }
            };
            Work work;
            expect(serial(), &work);
            EXPECT_EQ(work.triangle_tests > 0, !items.empty());
            if (&builder_ != &builders().front())
                continue;
            on_every_target([&] { expect(serial(), nullptr); });
            for (const ExecutorEntry& executor : executors())
                expect(*executor.make(std::min(4u, executor.max_threads)), nullptr);
        }
    }
}

} // namespace
} // namespace boxwood
