#include "kernels/convex/support.h"
#include "scenes/hard_cases/drawn_shapes.h"
#include "scenes/hard_cases/hard_cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace boxwood {
namespace {

using Vec = Vec3<double>;

Vec farthest_along(const ShapeOfPair& of, Vec n) {
    const auto& [x, y, z] = of.pose.rotation;
    const Vec in_its_frame = n.x * x + n.y * y + n.z * z;
    return of.pose(of.shape.visit([&]<class S>(const S& s) -> Vec {
        if constexpr (requires { convex::support(s, in_its_frame); })
            return convex::support(s, in_its_frame);
        ADD_FAILURE() << "a shape without a farthest point";
        return {};
    }));
}

/// How far b lies before a along n; the greatest of all is the signed distance.
double separation(const ShapePairCase& c, Vec n) {
    return dot(n, farthest_along(c.b, -n) - farthest_along(c.a, n)) / length(n);
}

/// A lower bound of the signed distance, near it: the best of many directions, each of the best few
/// moved by less and less where that is better.
double searched_distance(const ShapePairCase& c, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    const auto draw = [&] { return Vec{normal(random), normal(random), normal(random)}; };
    std::vector<std::pair<double, Vec>> found;
    for (int i = 0; i < 500; ++i) {
        const Vec n = draw();
        found.emplace_back(separation(c, n), n * (1 / length(n)));
    }
    std::ranges::sort(found, std::greater{}, &std::pair<double, Vec>::first);
    double best = found.front().first;
    for (std::size_t i = 0; i < 16; ++i) {
        auto [distance, n] = found[i];
        for (double step = 0.2; step > 1e-7;) {
            const Vec moved = n + step * draw();
            const double there = separation(c, moved);
            step *= there > distance ? 1.5 : 0.98;
            if (there > distance) {
                distance = there;
                n = moved * (1 / length(moved));
            }
        }
        best = std::max(best, distance);
    }
    return best;
}

TEST(ShapePairs, DistancesAreThoseAlongTheBestDirection) {
    std::mt19937_64 random(7);
    std::size_t families = 0;
    for (const HardCaseFamily& family : hard_case_families()) {
        if (family.reads_file)
            continue;
        HardCaseSpec spec;
        spec.n = family.name == "deep_shapes" ? 200 : 40;
        const Cases cases = make_cases(family, spec);
        const auto* const pairs = std::get_if<std::vector<ShapePairCase>>(&cases);
        if (!pairs)
            continue;
        ++families;
        for (std::size_t i = 0; i < pairs->size(); ++i) {
            const ShapePairCase& c = (*pairs)[i];
            const double found = searched_distance(c, random);
            EXPECT_LE(found, c.hi + 1e-12) << family.name << " " << i;
            EXPECT_GE(found, c.lo - 1e-4) << family.name << " " << i;
        }
    }
    EXPECT_EQ(families, 32u);
}

} // namespace
} // namespace boxwood
