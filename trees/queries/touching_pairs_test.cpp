#include "trees/queries/touching_pairs.h"

#include "kernels/oracle/oracle.h"
#include "kernels/registry.h"
#include "trees/builder.h"
#include "trees/layout.h"
#include "trees/testing/layouts_answering.h"
#include "trees/testing/triangle_soup.h"

#include <gtest/gtest.h>

#include <random>

namespace boxwood {
namespace {

/// Triangles with corners on a small integer grid: many touch at a corner or an edge, some are
/// degenerate.
TriangleMesh lattice_mesh(std::size_t n) {
    std::mt19937 random(7);
    const auto coordinate = [&] { return static_cast<float>(random() % 17); };
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < n; ++i) {
        const Vec3<float> at{coordinate(), coordinate(), coordinate()};
        for (int k = 0; k < 3; ++k)
            mesh.vertices.push_back(at + Vec3<float>{static_cast<float>(random() % 4),
                                                     static_cast<float>(random() % 4),
                                                     static_cast<float>(random() % 4)});
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

template <class K> void check(const TriangleMesh& mesh, const std::vector<Pair>& expected) {
    SCOPED_TRACE(std::string(K::name));
    const Tree tree = builders().front().make({})(triangle_boxes(mesh), serial());
    for (const LayoutEntry& entry : layouts_answering({Query::self_pairs})) {
        const auto layout = entry.make(tree, serial());
        std::vector<Pair> in_order;
        for (const unsigned threads : {1u, 3u}) {
            std::vector<Pair> pairs;
            AppendPairs sink(pairs);
            TouchingPairs<K> touching(mesh, sink);
            layout->self_pairs(*make_executor("tbb", threads), touching);
            if (threads == 1)
                in_order = pairs;
            EXPECT_EQ(pairs, in_order) << "the order depends on the threads";
            std::ranges::sort(pairs);
            EXPECT_EQ(pairs, expected);
        }
        CountPairs count, candidates;
        layout->self_pairs(serial(), candidates);
        TierCounts tiers;
        TouchingPairs<K> touching(mesh, count, &tiers);
        layout->self_pairs(serial(), touching);
        std::uint64_t judged = 0;
        for (const std::uint64_t decided : tiers.decided)
            judged += decided;
        EXPECT_EQ(judged, candidates.count());
        EXPECT_EQ(count.count(), expected.size());
    }
}

TEST(TouchingPairs, ExactKernelsFindWhatTheOracleFinds) {
    const TriangleMesh mesh = lattice_mesh(400);
    std::vector<Pair> expected;
    const auto triangle = [&](std::uint32_t i) {
        const Triangle<float> t = mesh.triangle(i);
        return Triangle<double>{Vec3<double>(t.a), Vec3<double>(t.b), Vec3<double>(t.c)};
    };
    for (std::uint32_t i = 0; i < 400; ++i)
        for (std::uint32_t j = i + 1; j < 400; ++j)
            if (overlaps(mesh.triangle(i).bounds(), mesh.triangle(j).bounds()) &&
                oracle::intersect(triangle(i), triangle(j)))
                expected.push_back({i, j});
    ASSERT_GT(expected.size(), 200u);
    int exact = 0;
    [&]<class... K>(std::type_identity<std::tuple<K...>>) {
        ((K::info.promise == Promise::exact ? (++exact, check<K>(mesh, expected)) : void()), ...);
    }(std::type_identity<TriangleKernels>{});
    EXPECT_GT(exact, 0);
}

/// Says maybe to everything: nothing may be lost.
struct Undecided {
    using Real = float;
    static constexpr std::string_view name = "undecided";
    static constexpr KernelInfo info{"triangle_triangle", name, "", Promise::certified};
    static Decision intersect(const Triangle<float>&, const Triangle<float>&) {
        return {Answer::maybe, 2};
    }
};

TEST(TouchingPairs, HandsOnWhatIsUndecided) {
    const TriangleMesh mesh = lattice_mesh(3);
    std::vector<Pair> pairs;
    AppendPairs sink(pairs);
    TierCounts tiers;
    TouchingPairs<Undecided> touching(mesh, sink, &tiers);
    touching.begin(1, true);
    const std::array<Pair, 2> candidates{{{0, 1}, {1, 2}}};
    EXPECT_TRUE(touching.take(0, candidates));
    touching.end();
    EXPECT_EQ(pairs.size(), 2u);
    EXPECT_EQ(tiers.undecided, 2u);
    EXPECT_EQ(tiers.decided[2], 2u);
}

} // namespace
} // namespace boxwood
