#include "trees/builders/spatial_sah.h"

#include "kernels/registry.h"
#include "kernels/testing/closed_meshes.h"
#include "trees/builders/detail/clip_triangle.h"
#include "trees/inspect/quality.h"
#include "trees/inspect/validate.h"
#include "trees/layout.h"
#include "trees/testing/brute_force_rays.h"
#include "trees/testing/every_executor.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/same_tree.h"
#include "trees/testing/triangle_soup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace boxwood {
using namespace detail;
namespace {

using Point = Vec3<float>;

/// Long thin triangles in random directions, some flat, some points; `size` long, about `centre`.
TriangleMesh slivers(std::uint32_t n, float size, float centre, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> any;
    std::uniform_real_distribution<float> place(-1, 1);
    TriangleMesh mesh;
    const Point middle{centre, centre, centre};
    for (std::uint32_t i = 0; i < n; ++i) {
        const Point p = middle + Point{place(random), place(random), place(random)};
        Point d{any(random), any(random), any(random)};
        d = d * (size / length(d));
        if (i % 7 == 0)
            d.x = 0;
        if (i % 11 == 0)
            d = {};
        const Point across{.01f * size * any(random), 0, .01f * size * any(random)};
        for (const Point& corner : {p, p + d, p + .3f * d + across})
            mesh.vertices.push_back(corner);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

Tree build(const TriangleMesh& mesh, const Settings& settings = {},
           const Executor& executor = serial(), std::string_view name = "spatial_sah") {
    return make_builder(name, settings).build_of_mesh(mesh, executor);
}

TEST(ClippedTriangle, PartsHoldTheirSideAndLittleMore) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-1, 1), weight(0, 1);
    for (const float scale : {1.f, 0x1p-140f, 0x1p126f}) {
        for (int i = 0; i < 2000; ++i) {
            Triangle<float> t;
            for (Point* corner : {&t.a, &t.b, &t.c})
                *corner = Point{place(random), place(random), place(random)} * scale;
            if (i % 5 == 0)
                t.b.y = t.a.y;
            const int axis = i % 3;
            const float plane = i % 4 ? place(random) * scale : t.a[axis];
            const auto [below, above] = ClippedTriangle(t).parts(t.bounds(), axis, plane);
            for (int s = 0; s < 20; ++s) {
                const double u = static_cast<double>(weight(random)),
                             v = static_cast<double>(weight(random)) * (1 - u);
                const auto p =
                    Vec3<double>(t.a) * (1 - u - v) + Vec3<double>(t.b) * u + Vec3<double>(t.c) * v;
                const Box& side = p[axis] <= static_cast<double>(plane) ? below : above;
                for (int k = 0; k < 3; ++k) {
                    const double error = 0x1p-50 * static_cast<double>(scale);
                    ASSERT_GE(p[k], static_cast<double>(side.min[k]) - error);
                    ASSERT_LE(p[k], static_cast<double>(side.max[k]) + error);
                }
            }
            // No farther over the plane than the pad and a rounding.
            const float over = 0x1p-20f * scale + 0x1p-148f;
            if (!below.is_empty()) {
                EXPECT_LE(below.max[axis], plane + over);
            }
            if (!above.is_empty()) {
                EXPECT_GE(above.min[axis], plane - over);
            }
        }
    }
    const Triangle<float> t{{0, 0, 0}, {4, 4, 0}, {4, 0, 0}};
    const auto [below, above] = ClippedTriangle(t).parts(t.bounds(), 0, 1);
    EXPECT_NEAR(below.max.y, 1, 1e-5f);
    EXPECT_NEAR(below.max.x, 1, 1e-5f);
    EXPECT_EQ(above.max.y, 4);
    const auto [all, nothing] = ClippedTriangle(t).parts(t.bounds(), 0, 5);
    EXPECT_EQ(all, t.bounds());
    EXPECT_TRUE(nothing.is_empty());
}

TEST(SpatialSah, CoversEachTriangleWithinItsBudget) {
    for (const float centre : {0.f, 1000.f})
        for (const double references : {1., 1.1, 1.5, 3.})
            for (const std::uint32_t n : {0u, 1u, 2u, 9u, 100u, 4000u}) {
                const TriangleMesh mesh = slivers(n, .7f, centre, n);
                const Tree tree = build(mesh, {{"references", references}});
                EXPECT_EQ(validate_split(tree, mesh).value_or(""), "") << n;
                EXPECT_LE(static_cast<double>(tree.size()), references * n);
                if (n == 4000 && references > 1) {
                    EXPECT_GT(static_cast<double>(tree.size()), 1.05 * n) << "nothing was cut";
                }
            }
}

TEST(ValidateSplit, NamesWhatIsWrong) {
    const TriangleMesh mesh = slivers(60, 2, 0, 8);
    const auto fault = [&](const std::function<void(Tree&)>& spoil) {
        Tree tree = build(mesh, {{"references", 4}});
        spoil(tree);
        return validate_split(tree, mesh).value_or("");
    };
    const auto leaf_of = [](const Tree& tree) {
        std::size_t i = 0;
        while (!tree.is_leaf(i) || tree.item(i) % 7 == 0 || tree.item(i) % 11 == 0)
            ++i;
        return i;
    };
    // Boxes of the inner nodes are made good, so that only the part itself is at fault.
    const auto refit_all = [](Tree& tree) {
        for (std::size_t i = tree.nodes.size(); i-- > 0;)
            if (!tree.is_leaf(i))
                tree.nodes[i].box =
                    merge(tree.nodes[Tree::left(i)].box, tree.nodes[tree.right(i)].box);
    };
    EXPECT_EQ(fault([](Tree&) {}), "");
    EXPECT_NE(fault([](Tree& t) { t.is_split = false; }).find("not marked"), std::string::npos);
    EXPECT_NE(fault([](Tree& t) { t.nodes[1].first += 1; }).find("node 1"), std::string::npos);
    EXPECT_NE(fault([](Tree& t) { t.nodes[0].box.max.x += 1; }).find("union"), std::string::npos);
    EXPECT_NE(fault([](Tree& t) { t.order[0] = 60; }).find("item 60"), std::string::npos);
    EXPECT_NE(fault([&](Tree& t) {
                  t.nodes[leaf_of(t)].box.max.y += 5;
                  refit_all(t);
              }).find("not part"),
              std::string::npos);
    EXPECT_NE(fault([&](Tree& t) {
                  Box& box = t.nodes[leaf_of(t)].box;
                  box.max.z = .5f * (box.min.z + box.max.z);
                  refit_all(t);
              }).find("none of its"),
              std::string::npos);
}

TEST(SpatialSah, ExtremeAndEqualTrianglesMakeValidTrees) {
    constexpr float max_float = std::numeric_limits<float>::max();
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const float x = i < 100 ? 1 : i < 200 ? max_float : 0x1p-149f * static_cast<float>(i);
        mesh.vertices.insert(mesh.vertices.end(), {{-x, -x, 0}, {x, x, x}, {x, -x, x}});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    EXPECT_EQ(validate_split(build(mesh, {{"references", 2}}), mesh).value_or(""), "");
    TriangleMesh tiny;
    tiny.vertices.assign(mesh.vertices.begin() + 600, mesh.vertices.end());
    tiny.triangles.assign(mesh.triangles.begin(), mesh.triangles.begin() + 100);
    EXPECT_EQ(validate_split(build(tiny, {{"references", 2}}), tiny).value_or(""), "");
}

TEST(SpatialSah, CutsLowerTheCostOfSlivers) {
    const TriangleMesh mesh = slivers(5000, .5f, 0, 1);
    const std::vector<Box> boxes = triangle_boxes(mesh);
    const double whole = quality(build(mesh, {{"references", 1}}), boxes).sah_cost;
    const double cut = quality(build(mesh, {{"references", 2}}), boxes).sah_cost;
    EXPECT_LT(cut, .97 * whole);
    const Tree better = build(mesh, {{"references", 2}}, serial(), "spatial_sah+reinsertion");
    EXPECT_EQ(validate_split(better, mesh).value_or(""), "");
    EXPECT_LT(quality(better, boxes).sah_cost, .97 * cut);
}

TEST(SpatialSah, SameTreeForAnyNumberOfThreads) {
    const TriangleMesh mesh = slivers(20000, .3f, 0, 2);
    const Tree expected = build(mesh);
    for (const auto& [name, executor] : every_executor())
        ASSERT_TRUE(same_tree(build(mesh, {}, *executor), expected)) << name;
}

TEST(SpatialSah, BadTriangleIsNamed) {
    TriangleMesh mesh = slivers(10, .1f, 0, 3);
    mesh.vertices[3 * 7 + 1].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THAT([&] { build(mesh); },
                testing::Throws<InvalidBox>(testing::Field(&InvalidBox::index, 7u)));
}

TEST(SpatialSah, RaysThroughTheSeamsHitWhatTheyHitWithoutATree) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> place(-2, 2);
    for (const TriangleMesh& mesh : {slivers(400, 2, 0, 4), slivers(400, 2, 300, 4)}) {
        const Tree tree = build(mesh, {{"references", 4}});
        ASSERT_GT(tree.size(), mesh.triangles.size() * 5 / 4);
        // At corners of leaf boxes, which lie on the planes of cuts, projected into the triangle.
        std::vector<Ray<float>> rays;
        for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
            if (!tree.is_leaf(i))
                continue;
            const Triangle<float> t = mesh.triangle(tree.item(i));
            const Point centre = (t.a + t.b + t.c) * (1.f / 3);
            for (int axis = 0; axis < 3; ++axis) {
                const float plane =
                    i % 2 ? tree.nodes[i].box.min[axis] : tree.nodes[i].box.max[axis];
                if (!(t.b[axis] != t.a[axis]))
                    continue;
                const float s = (plane - t.a[axis]) / (t.b[axis] - t.a[axis]);
                Point target = t.a + s * (t.b - t.a);
                if (i % 3 == 0)
                    target = target + (centre - target) * .01f;
                target[axis] = plane;
                const Point from = centre + Point{place(random), place(random), place(random)};
                rays.push_back({from, target - from});
                Point along{0, 0, 0};
                along[(axis + 1) % 3] = 1;
                rays.push_back({target - along * 3.f, along});
            }
        }
        const std::vector<RayHit> expected = brute_force<Watertight>(mesh, rays);
        const auto n_hits = static_cast<std::size_t>(std::ranges::count_if(expected, &RayHit::hit));
        EXPECT_GT(n_hits, rays.size() / 20);
        EXPECT_LT(n_hits, rays.size());
        for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
            SCOPED_TRACE(entry.name);
            const auto layout = entry.make(tree, serial());
            const TriangleBlocks triangles = layout->triangles(mesh);
            std::vector<RayHit> hits(rays.size());
            layout->rays(rays, RayQuery::closest, "watertight", triangles, serial(), hits);
            for (std::size_t i = 0; i < rays.size(); ++i)
                ASSERT_EQ(hits[i], expected[i]) << i;
        }
    }
}

TEST(SpatialSah, NoRayLeaksFromAClosedMesh) {
    // Long thin triangles from pole to pole.
    const TriangleMesh mesh = uv_sphere(400, 3);
    const Tree tree = build(mesh, {{"references", 4}});
    ASSERT_EQ(validate_split(tree, mesh).value_or(""), "");
    ASSERT_GT(tree.size(), 2 * mesh.triangles.size());
    std::mt19937 random(6);
    std::uniform_real_distribution<float> place(-.5f, .5f), along(0, 1);
    std::vector<Ray<float>> rays;
    for (int i = 0; i < 50000; ++i) {
        const auto& corners = mesh.triangles[random() % mesh.triangles.size()];
        const Point a = mesh.vertices[corners[0]], b = mesh.vertices[corners[1]];
        const Point from{place(random), place(random), place(random)};
        rays.push_back({from, a + along(random) * (b - a) - from});
    }
    for (const LayoutEntry& entry : layouts_answering({Query::rays})) {
        const auto layout = entry.make(tree, serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        std::vector<RayHit> hits(rays.size());
        layout->rays(rays, RayQuery::any, "watertight", triangles, serial(), hits);
        EXPECT_TRUE(std::ranges::all_of(hits, &RayHit::hit)) << entry.name;
    }
}

TEST(SpatialSah, ASplitTreeRefusesPairs) {
    const TriangleMesh mesh = slivers(50, .5f, 0, 7);
    const Tree tree = build(mesh);
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    for (const LayoutEntry& entry : layouts_answering({Query::self_pairs, Query::tree_pairs})) {
        const auto layout = entry.make(tree, serial());
        EXPECT_THROW(layout->self_pairs(serial(), sink), std::invalid_argument) << entry.name;
        EXPECT_THROW(layout->tree_pairs(*layout, serial(), sink), std::invalid_argument);
    }
}

} // namespace
} // namespace boxwood
