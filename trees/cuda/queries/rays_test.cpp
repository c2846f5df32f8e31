#include "kernels/registry.h"
#include "trees/builder.h"
#include "trees/cuda/queries/rays.cuh"
#include "trees/cuda/queries/wide8_rays.cuh"
#include "trees/cuda/testing/families.h"
#include "trees/cuda/testing/radix_tree.h"
#include "trees/layout.h"
#include "trees/queries/sorted_rays.h"
#include "trees/testing/append_hits.h"
#include "trees/testing/ray_scenes.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <vector>

namespace boxwood::cuda {
namespace {

using DeviceKernels = std::tuple<Watertight, MollerTrumbore<float>, MollerTrumbore<double>>;

/// Opens nodes of the binary tree until there are eight children.
void collapse(const RadixTreeView& tree, std::vector<Wide8Node>& to, std::uint32_t at,
              std::uint32_t ref) {
    std::vector<std::uint32_t> children{ref};
    for (std::size_t i = 0; children.size() < Wide8Node::width && i < children.size();)
        if (RadixTreeView::is_leaf(children[i])) {
            ++i;
        } else {
            const RadixNode& node = tree.nodes[children[i]];
            children[i] = node.left;
            children.push_back(node.right);
        }
    for (unsigned k = 0; k < Wide8Node::width; ++k) {
        Box box;
        std::uint32_t child = nobody;
        if (k < children.size()) {
            box = tree.box(children[k]);
            child = children[k];
            if (!RadixTreeView::is_leaf(child)) {
                child = static_cast<std::uint32_t>(to.size());
                to.emplace_back();
                collapse(tree, to, child, children[k]);
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            to[at].plane[axis][k] = box.min[axis];
            to[at].plane[3 + axis][k] = box.max[axis];
        }
        to[at].ref[k] = child;
    }
}

/// A mesh and both of its trees in the device's memory.
struct OnDevice {
    std::vector<std::uint32_t> corners;
    std::vector<Box> boxes;
    Array<Triangle<float>> triangles;
    MadeRadixTree binary;
    std::vector<Wide8Node> nodes;
    Wide8View wide8;

    explicit OnDevice(const TriangleMesh& mesh)
        : boxes(bounds_of(mesh)), triangles(boxes.size(), {}), binary(boxes) {
        const MeshView view = view_of(mesh);
        launch(Stream{}, blocks_for(view.n, radix_threads), radix_threads, gather_triangles, view,
               binary.view.items, triangles.data());
        if (view.n > 0) {
            nodes.resize(1);
            collapse(binary.view, nodes, 0, *binary.view.root);
        }
        wide8 = {view.n, nodes.data(), binary.view.items};
    }

    const auto& tree(const RadixTreeView*) const { return binary.view; }
    const auto& tree(const Wide8View*) const { return wide8; }

  private:
    MeshView view_of(const TriangleMesh& mesh) {
        corners.clear();
        for (const auto& triangle : mesh.triangles)
            corners.insert(corners.end(), triangle.begin(), triangle.end());
        return {mesh.vertices.data(), corners.data(),
                static_cast<std::uint32_t>(mesh.triangles.size())};
    }
    std::vector<Box> bounds_of(const TriangleMesh& mesh) {
        const MeshView view = view_of(mesh);
        std::vector<Box> made(view.n);
        launch(Stream{}, blocks_for(view.n, radix_threads), radix_threads, bound_triangles, view,
               made.data());
        return made;
    }
};

template <class Tree>
RaysView<Tree> view_of(const OnDevice& made, const std::vector<Ray<float>>& rays,
                       const std::uint32_t* order = nullptr) {
    return {made.tree(static_cast<const Tree*>(nullptr)), made.triangles.data(), rays.data(),
            static_cast<std::uint32_t>(rays.size()), order};
}

bool same_bits(const std::vector<RayHit>& a, const std::vector<RayHit>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(RayHit)) == 0);
}

/// All hits in any order, with room for half of them.
template <RayKernel K>
void expect_capped(const RaysView<RadixTreeView>& view,
                   const std::vector<std::pair<std::uint32_t, RayHit>>& all) {
    std::uint64_t n = 0;
    Array<HitOfRay> some(all.size() / 2, {});
    find_all_hits<K, Pass::capped>(view, {&n, some.data(), some.size()}, {});
    EXPECT_EQ(n, all.size());
    for (const HitOfRay& hit : std::span(some.data(), some.size()))
        EXPECT_TRUE(std::ranges::binary_search(
            all, std::pair{hit.ray, hit.hit}, [](const auto& a, const auto& b) {
                return a.first != b.first ? a.first < b.first
                                          : BeforeInAnswers{}(a.second, b.second);
            }));
}

template <class Tree, RayKernel K>
std::vector<std::pair<std::uint32_t, RayHit>> all_hits(const RaysView<Tree>& view) {
    std::vector<std::uint64_t> at(view.n + 1);
    find_all_hits<K, Pass::count>(view, {at.data(), nullptr, 0}, {});
    std::exclusive_scan(at.begin(), at.end(), at.begin(), std::uint64_t{0});
    Array<RayHit> hits(at[view.n], {});
    find_all_hits<K, Pass::fill>(view, {at.data(), hits.data(), 0}, {});
    sort_answers(at.data(), view.n, hits.data(), {});
    std::vector<std::pair<std::uint32_t, RayHit>> all;
    for (std::uint32_t ray = 0; ray < view.n; ++ray)
        for (std::uint64_t i = at[ray]; i < at[ray + 1]; ++i)
            all.emplace_back(ray, hits.data()[i]);

    if constexpr (std::same_as<Tree, RadixTreeView>)
        expect_capped<K>(view, all);
    return all;
}

struct Wanted {
    std::vector<RayHit> closest;
    std::vector<std::pair<std::uint32_t, RayHit>> all;
};

template <class Tree, RayKernel K>
void expect_hits(const OnDevice& made, const std::vector<Ray<float>>& rays, const Wanted& wanted,
                 const std::vector<std::uint32_t>& order, std::uint64_t seeds) {
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        on_host::set_seed(seed);
        const auto view = view_of<Tree>(made, rays, seed % 2 ? order.data() : nullptr);
        std::vector<RayHit> hits(rays.size());
        find_hits<K, RayQuery::closest>(view, hits.data(), {});
        ASSERT_TRUE(same_bits(hits, wanted.closest));
        if (seed != 1)
            continue;
        find_hits<K, RayQuery::any>(view, hits.data(), {});
        for (std::size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(hits[i].hit(), wanted.closest[i].hit()) << i;
        ASSERT_TRUE((all_hits<Tree, K>(view) == wanted.all));
    }
}

std::vector<Ray<float>> hard_rays() {
    std::vector<Ray<float>> rays = test_rays();
    constexpr float inf = RayHit::nowhere, nan = std::numeric_limits<float>::quiet_NaN();
    for (const float odd : {nan, inf, -inf, 1e38f, 1e-45f})
        rays.insert(rays.end(), {{{odd, 0, 0}, {1, .1f, 0}},
                                 {{0, 0, 0}, {odd, .1f, 1}},
                                 {{0, 0, 0}, {1, .1f, .2f}, 0, odd},
                                 {{0, 0, 0}, {1, .1f, .2f}, odd}});
    return rays;
}

TEST(RaysOnDevice, AreThoseOfTheCpuForEveryKernelAndTree) {
    const std::vector<Ray<float>> rays = hard_rays();
    for (const TriangleMesh& mesh :
         {sphere(40), triangle_soup(3000), triangle_soup(17), triangle_soup(1), TriangleMesh{}}) {
        const OnDevice made(mesh);
        EXPECT_EQ(made.boxes, triangle_boxes(mesh));
        const auto layout = find_layout("binary").make(
            make_builder("median")(triangle_boxes(mesh), serial()), serial());
        const TriangleBlocks triangles = layout->triangles(mesh);
        const auto order = ray_order(rays, triangles.bounds, serial());
        const std::uint64_t seeds = mesh.triangles.size() > 100 ? 2 : fibre_seeds;
        std::apply(
            [&]<class... K>(const K&...) {
                (
                    [&] {
                        SCOPED_TRACE(K::name);
                        Wanted wanted;
                        wanted.closest.resize(rays.size());
                        layout->rays(rays, RayQuery::closest, K::name, triangles, serial(),
                                     wanted.closest);
                        AppendHits sink;
                        layout->rays_all(rays, K::name, triangles, serial(), sink);
                        wanted.all = sink.all;
                        const std::vector<std::uint32_t> by(order.data(),
                                                            order.data() + order.size());
                        expect_hits<RadixTreeView, K>(made, rays, wanted, by, seeds);
                        expect_hits<Wide8View, K>(made, rays, wanted, by, seeds);
                    }(),
                    ...);
            },
            DeviceKernels{});
    }
}

TEST(RaysOnDevice, OfEqualHitsThatOfTheLowestTriangleWins) {
    TriangleMesh mesh = triangle_soup(40);
    for (int i = 0; i < 300; ++i) // each twice and more
        mesh.triangles.push_back(mesh.triangles[static_cast<std::size_t>(i) % 40]);
    std::ranges::rotate(mesh.triangles, mesh.triangles.begin() + 13);
    const std::vector<Ray<float>> rays = test_rays();
    const OnDevice made(mesh);
    const auto layout = find_layout("binary").make(
        make_builder("median")(triangle_boxes(mesh), serial()), serial());
    Wanted wanted;
    wanted.closest.resize(rays.size());
    const TriangleBlocks triangles = layout->triangles(mesh);
    layout->rays(rays, RayQuery::closest, "watertight", triangles, serial(), wanted.closest);
    AppendHits sink;
    layout->rays_all(rays, "watertight", triangles, serial(), sink);
    wanted.all = sink.all;
    EXPECT_GT(std::ranges::count_if(wanted.closest, &RayHit::hit), 10);
    std::vector<std::uint32_t> order(rays.size());
    std::iota(order.begin(), order.end(), 0u);
    expect_hits<RadixTreeView, Watertight>(made, rays, wanted, order, 2);
    expect_hits<Wide8View, Watertight>(made, rays, wanted, order, 2);
}

TEST(RaysOnDevice, ATreeTooDeepForTheStackLosesNothing) {
    // Triangles behind each other; each node has the farthest of its own as a leaf, which waits.
    // The root has the nearest, too, so that a hit has been found when there is no room.
    constexpr std::uint32_t n = 200;
    std::vector<Triangle<float>> triangles;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto x = static_cast<float>(i);
        triangles.push_back({{x, -1, -1}, {x, 2, -1}, {x, -1, 2}});
    }
    std::vector<std::uint32_t> items(n);
    std::iota(items.begin(), items.end(), 0u);
    std::vector<Wide8Node> nodes(n);
    Box nearer;
    for (std::uint32_t far = 0; far < n; ++far) {
        Wide8Node& node = nodes[n - 1 - far];
        for (unsigned k = 0; k < Wide8Node::width; ++k) {
            set_lane(node, k, k == 0 ? triangles[far].bounds() : k == 2 ? nearer : Box{});
            node.ref[k] = nobody;
        }
        node.ref[0] = far | RadixNode::leaf_bit;
        node.ref[2] = n - far;
        nearer.extend(triangles[far].bounds());
    }
    std::swap(nodes[0].ref[1], nodes[n - 1].ref[0]);
    set_lane(nodes[0], 1, triangles[0].bounds());
    set_lane(nodes[n - 1], 0, Box{});
    const std::vector<Ray<float>> rays{{{-1, 0, 0}, {1, 0, 0}}, {{-1, 0, 0}, {1, 0, 0}, 1.5f}};
    const RaysView<Wide8View> view{
        {n, nodes.data(), items.data()}, triangles.data(), rays.data(), 2, nullptr};
    RayHit hits[2];
    find_hits<Watertight, RayQuery::closest>(view, hits, {});
    EXPECT_EQ(hits[0].triangle, 0u);
    EXPECT_EQ(hits[1].triangle, 1u);
    const auto all = all_hits<Wide8View, Watertight>(view);
    ASSERT_EQ(all.size(), 2 * n - 1);
    for (std::uint32_t i = 0; i < n; ++i)
        EXPECT_EQ(all[i].second.triangle, i);
}

TEST(RaysOnDevice, CodesAreThoseOfTheCpusOrder) {
    const std::vector<Ray<float>> rays = hard_rays();
    const Box bounds{{-1, -1, -1}, {1, .5f, 1}};
    const auto n = static_cast<std::uint32_t>(rays.size());
    std::vector<std::uint32_t> codes(n), numbers(n);
    launch(Stream{}, blocks_for(n, ray_threads), ray_threads, ray_codes, rays.data(), n,
           EntryGrid(bounds), codes.data(), numbers.data());
    std::ranges::stable_sort(numbers, {}, [&](std::uint32_t i) { return codes[i]; });
    const auto wanted = ray_order(rays, bounds, serial());
    EXPECT_TRUE(std::ranges::equal(numbers, wanted.span()));
}

} // namespace
} // namespace boxwood::cuda
