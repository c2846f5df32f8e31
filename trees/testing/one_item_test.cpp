#include "kernels/registry.h"
#include "trees/dynamic/dynamic_tree.h"
#include "trees/dynamic/update.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/queries/single_rays.h"
#include "trees/queries/sorted_rays.h"
#include "trees/testing/append_hits.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/triangle_soup.h"
#include "trees/testing/ways_to_build.h"

#include <gtest/gtest.h>

/// A root that is a leaf: every builder, optimizer, layout, query, executor and update policy.
namespace boxwood {
namespace {

using Pairs = std::vector<Pair>;

template <class Query> Pairs found(const Query& query) {
    Pairs pairs;
    AppendPairs sink(pairs);
    query(sink);
    return pairs;
}

const TriangleMesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};

void expect_rays(const AnyLayout& layout, const Executor& executor) {
    const std::vector<Ray<float>> rays{{{1, 1, -2}, {0, 0, 1}}, {{3, 3, -2}, {0, 0, 1}}};
    const TriangleBlocks triangles = layout.triangles(mesh, executor);
    for (const KernelInfo& kernel : ray_kernels()) {
        std::vector<RayHit> closest(2), any(2), sorted(2);
        layout.rays(rays, RayQuery::closest, kernel.name, triangles, executor, closest);
        layout.rays(rays, RayQuery::any, kernel.name, triangles, executor, any);
        sorted_rays(layout, rays, RayQuery::closest, kernel.name, triangles, executor, sorted);
        AppendHits all;
        layout.rays_all(rays, kernel.name, triangles, executor, all);
        ASSERT_EQ(all.all.size(), 1u) << kernel.name;
        const SingleRays single(layout, kernel.name, triangles);
        const RayHit hit = single.closest(rays[0]);
        EXPECT_EQ(hit.triangle, 0u) << kernel.name;
        EXPECT_EQ(hit.t, 2) << kernel.name;
        EXPECT_EQ(closest[0], hit);
        EXPECT_EQ(sorted[0], hit);
        EXPECT_EQ(all.all[0], (std::pair{0u, hit}));
        EXPECT_TRUE(any[0].hit() && single.any(rays[0])) << kernel.name;
        EXPECT_FALSE(closest[1].hit() || any[1].hit() || sorted[1].hit() || single.any(rays[1]) ||
                     single.closest(rays[1]).hit())
            << kernel.name;
    }
}

void expect_answers(const AnyLayout& layout, const Executor& executor) {
    const std::vector<Vec3<float>> points{{4, 4, 0}, {4, 4, 1}};
    const std::vector<Box> regions{{{4, 4, 0}, {5, 5, 5}}, {{5, 5, 5}, {6, 6, 6}}};
    const std::vector<Sphere<float>> balls{{{2, 2, 3}, 3}, {{2, 2, 3}, 2}};
    const Pairs first{{0, 0}};
    if (layout.answers(Query::self_pairs)) {
        EXPECT_EQ(found([&](PairSink& to) { layout.self_pairs(executor, to); }), Pairs{});
    }
    if (layout.answers(Query::tree_pairs)) {
        EXPECT_EQ(found([&](PairSink& to) { layout.tree_pairs(layout, executor, to); }), first);
    }
    if (layout.answers(Query::points)) {
        EXPECT_EQ(found([&](PairSink& to) { layout.points(points, executor, to); }), first);
    }
    if (layout.answers(Query::regions)) {
        EXPECT_EQ(found([&](PairSink& to) { layout.regions(regions, executor, to); }), first);
        EXPECT_EQ(found([&](PairSink& to) { layout.regions(balls, executor, to); }), first);
    }
    if (layout.answers(Query::nearest)) {
        std::vector<Neighbour> near(4);
        layout.nearest(points, 2, executor, near);
        EXPECT_EQ(near, (std::vector<Neighbour>{{0, 0}, {}, {0, 1}, {}}));
    }
    if (layout.answers(Query::closest_points)) {
        std::vector<SurfacePoint> near(2);
        layout.closest_points(points, mesh, executor, near);
        EXPECT_EQ(near[1].triangle, 0u);
        EXPECT_EQ(near[1].squared_distance, 9); // of (4, 4, 1) from (2, 2, 0)
    }
    if (layout.answers(Query::rays))
        expect_rays(layout, executor);
}

TEST(OneItem, EveryBuilderLayoutQueryAndExecutor) {
    const std::vector<Box> boxes = triangle_boxes(mesh);
    for (const ExecutorToTry& executor : every_executor())
        for (const std::string& way : ways_to_build()) {
            const Tree tree = make_builder(way)(boxes, *executor.run);
            EXPECT_EQ(validate(tree, boxes).value_or(""), "") << way;
            EXPECT_EQ(quality(tree, boxes).depth_max, 0u) << way;
            for (const LayoutEntry& entry : layouts()) {
                SCOPED_TRACE(way + "." + std::string(entry.name) + ", " + executor.name);
                expect_answers(*entry.make(tree, *executor.run), *executor.run);
                Tree made;
                expect_answers(*make_layout(entry, make_builder(way), boxes, *executor.run, made),
                               *executor.run);
            }
        }
}

TEST(OneItem, EveryUpdatePolicyAndTheDynamicTree) {
    const std::vector<std::uint32_t> moved{0};
    for (const ExecutorToTry& executor : every_executor())
        for (const UpdateEntry& entry : updates()) {
            SCOPED_TRACE(std::string(entry.name) + ", " + executor.name);
            const auto updater = entry.make({});
            std::vector<Box> box{{{0, 0, 0}, {1, 1, 1}}};
            updater->start(box, *executor.run);
            for (int frame = 0; frame < 20; ++frame) {
                box[0] = frame % 3 == 1 ? Box{} : Box{{5, 5, 5}, {6, 6, 6}};
                updater->update(box, moved, *executor.run);
                EXPECT_EQ(found([&](PairSink& to) { updater->self_pairs(*executor.run, to); }),
                          Pairs{});
                EXPECT_EQ(updater->fault(), "");
            }
        }
    DynamicTree tree;
    for (int round = 0; round < 3; ++round) {
        tree.insert(0, {{0, 0, 0}, {1, 1, 1}});
        tree.enlarge(0, {{0, 0, 0}, {2, 2, 2}});
        tree.move(0, {{7, 7, 7}, {8, 8, 8}});
        EXPECT_EQ(tree.height(), 0u);
        EXPECT_EQ(tree.to_tree().size(), 1u);
        tree.remove(0);
        EXPECT_TRUE(tree.to_tree().empty());
    }
}

} // namespace
} // namespace boxwood
