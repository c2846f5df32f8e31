#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/rational.h"
#include "kernels/oracle/second_opinion.h"
#include "scenes/hard_cases/hard_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>

namespace boxwood {
namespace {

// The truth of each case in rational arithmetic, where a second oracle agrees.

namespace second = oracle::second_opinion;

bool truth(const TrianglePairCase& c) {
    const std::array a{c.a.a, c.a.b, c.a.c}, b{c.b.a, c.b.b, c.b.c};
    EXPECT_EQ(oracle::squared_distance(c.a, c.b), second::squared_distance(a, b));
    const std::span edge_a = std::span(a).first(2), edge_b = std::span(b).first(2);
    EXPECT_EQ(oracle::squared_distance(Segment{a[0], a[1]}, Segment{b[0], b[1]}),
              second::squared_distance(edge_a, edge_b));
    const std::span corner_a = std::span(a).first(1);
    EXPECT_EQ(oracle::squared_distance(a[0], c.b), second::squared_distance(corner_a, b));
    EXPECT_EQ(oracle::squared_distance(a[0], Segment{b[0], b[1]}),
              second::squared_distance(corner_a, edge_b));
    const bool touch = oracle::intersect(c.a, c.b);
    EXPECT_EQ(touch, second::squared_distance(a, b) == 0);
    return touch;
}
bool truth(const RayBoxCase& c) { return oracle::ray_box(c.ray, c.box); }
bool truth(const ObbPairCase& c) {
    const auto pose = [](const Obb<double>& b) {
        return std::array{b.centre, b.axis[0], b.axis[1], b.axis[2]};
    };
    return oracle::boxes_touch(pose(c.a), c.a.half, pose(c.b), c.b.half);
}

/// Of two boxes, or two balls in rationals; nothing of others.
std::optional<bool> truth(const ShapePairCase& c) {
    if (c.a.shape.get_if<convex::Box>() && c.b.shape.get_if<convex::Box>()) {
        const auto pose = [](const ShapeOfPair& of) {
            const auto& [x, y, z] = of.pose.rotation;
            return std::array{of.pose.translation, Vec3<double>{x.x, y.x, z.x},
                              Vec3<double>{x.y, y.y, z.y}, Vec3<double>{x.z, y.z, z.z}};
        };
        return oracle::boxes_touch(pose(c.a), c.a.shape.get_if<convex::Box>()->half, pose(c.b),
                                   c.b.shape.get_if<convex::Box>()->half);
    }
    if (c.a.shape.get_if<convex::Sphere>() && c.b.shape.get_if<convex::Sphere>()) {
        mpq_class squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const mpq_class along =
                mpq_class(c.a.pose.translation[axis]) - mpq_class(c.b.pose.translation[axis]);
            squared += along * along;
        }
        const mpq_class radii = mpq_class(c.a.shape.get_if<convex::Sphere>()->radius) +
                                mpq_class(c.b.shape.get_if<convex::Sphere>()->radius);
        // [lo, hi], too: lo + radii <= root of the square <= hi + radii
        const mpq_class least = mpq_class(c.lo) + radii, most = mpq_class(c.hi) + radii;
        EXPECT_TRUE((least <= 0 || least * least <= squared) && most >= 0 &&
                    most * most >= squared);
        return squared <= radii * radii;
    }
    return std::nullopt;
}

struct Judged {
    Known known;
    bool truth;
};

std::vector<Judged> judged(const Cases& cases) {
    std::vector<Judged> result;
    std::visit(
        [&]<class C>(const C& all) {
            if constexpr (std::is_same_v<C, RayCases>) {
                for (const RayCase& c : all.rays) {
                    bool hit = false;
                    for (std::uint32_t i = c.first; i < c.first + c.count; ++i) {
                        const auto point = oracle::ray_triangle(c.ray, all.triangles[i]);
                        EXPECT_EQ(point == second::ray_triangle(c.ray, all.triangles[i]), true);
                        hit |= point.has_value();
                    }
                    result.push_back({c.hit, hit});
                }
            } else if constexpr (std::is_same_v<C, MotionCases>) {
                const oracle::ExactContinuous exact;
                for (const MotionCase& c : all.motions) {
                    const bool is_face = all.kind == MotionKind::vertex_face;
                    const Impact impact =
                        is_face ? exact.vertex_face(c.motion) : exact.edge_edge(c.motion);
                    EXPECT_NE(impact.answer, Answer::maybe);
                    EXPECT_TRUE(is_face ? second::confirms_vertex_face(c.motion, impact)
                                        : second::confirms_edge_edge(c.motion, impact));
                    result.push_back({c.touch, impact.answer == Answer::yes});
                }
            } else if constexpr (std::is_same_v<C, std::vector<RayBoxCase>>) {
                for (const RayBoxCase& c : all)
                    result.push_back({c.hit, truth(c)});
            } else if constexpr (std::is_same_v<C, std::vector<TrianglePairCase>> ||
                                 std::is_same_v<C, std::vector<ObbPairCase>>) {
                for (const auto& c : all)
                    result.push_back({c.touch, truth(c)});
            } else if constexpr (std::is_same_v<C, std::vector<ShapePairCase>>) {
                for (const ShapePairCase& c : all) {
                    EXPECT_TRUE(c.lo <= c.hi && (c.lo > 0 || c.hi < 0));
                    const Known known = c.hi < 0 ? Known::yes : Known::no;
                    result.push_back({known, truth(c).value_or(known == Known::yes)});
                }
            } else if constexpr (std::is_same_v<C, BoxCases>) {
                std::uint64_t pairs = 0;
                for (std::size_t i = 0; i < all.boxes.size(); ++i)
                    for (std::size_t j = 0; j < i; ++j)
                        pairs += overlaps(all.boxes[i], all.boxes[j]);
                EXPECT_EQ(pairs, all.n_pairs);
            }
        },
        cases);
    return result;
}

TEST(HardCases, TruthByConstructionIsWhatTheOracleSays) {
    for (const HardCaseFamily& family : hard_case_families()) {
        if (family.reads_file)
            continue;
        SCOPED_TRACE(family.name);
        const int middle = (family.k_min + family.k_default) / 2;
        for (const int k : std::set<int>{family.k_min, middle, family.k_default, family.k_max})
            for (const int scale : {0, family.scale_min, family.scale_max})
                for (const std::uint64_t seed : {1u, 2u}) {
                    const bool plain = k == family.k_default && scale == 0;
                    if (seed > 1 && !plain)
                        continue;
                    const HardCaseSpec spec{plain ? 400u : 50u,
                                            seed,
                                            family.k_meaning.empty() ? std::nullopt
                                                                     : std::optional(k),
                                            scale,
                                            {}};
                    const Cases cases = make_cases(family, spec);
                    const std::vector<Judged> all = judged(cases);
                    for (std::size_t i = 0; i < all.size(); ++i)
                        if (all[i].known != Known::unknown) {
                            ASSERT_EQ(all[i].known == Known::yes, all[i].truth)
                                << "case " << i << ", k " << k << ", scale " << scale << ", seed "
                                << seed;
                        }
                }
    }
}

} // namespace
} // namespace boxwood
