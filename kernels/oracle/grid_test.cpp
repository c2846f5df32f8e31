#include "kernels/oracle/nearest.h"
#include "kernels/testing/grid_hulls.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

namespace boxwood::oracle {
namespace {

class OnGrid : public ::testing::TestWithParam<int> {
  protected:
    std::vector<Grid> corners(std::size_t n) { return random_points(random_, n, GetParam()); }

  private:
    std::mt19937_64 random_{7};
};
INSTANTIATE_TEST_SUITE_P(Oracle, OnGrid, ::testing::Values(1, 2, 4, 20));

TEST_P(OnGrid, TrianglesMeetAsTheirDifferencesSay) {
    int touching = 0;
    for (int i = 0; i < 8000; ++i) {
        const auto a = corners(3), b = corners(3);
        const bool truth = hull_to_hull(a, b).num == 0;
        touching += truth;
        ASSERT_EQ(intersect(triangle(a), triangle(b)), truth) << "case " << i;
    }
    EXPECT_GT(touching, 400);
    EXPECT_LT(touching, 7600);
}

/// |a - b|^2 of the points where a distance is taken.
mpq_class squared_length(const Nearest& n) {
    mpq_class sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        sum += (n.a[i] - n.b[i]) * (n.a[i] - n.b[i]);
    return sum;
}

TEST_P(OnGrid, DistancesAreThoseOfTheirDifferences) {
    const auto check = [](const Nearest& n, const std::vector<Grid>& a,
                          const std::vector<Grid>& b) {
        EXPECT_EQ(n.squared, rational(hull_to_hull(a, b)));
        EXPECT_EQ(squared_length(n), n.squared);
    };
    for (int i = 0; i < 1500 && !HasFailure(); ++i) {
        SCOPED_TRACE(i);
        const auto a = corners(3), b = corners(3);
        const std::vector<Grid> edge_a{a[0], a[1]}, edge_b{b[0], b[1]}, corner_a{a[0]};
        check(nearest(triangle(a), triangle(b)), a, b);
        check(nearest(Segment{point(a[0]), point(a[1])}, Segment{point(b[0]), point(b[1])}), edge_a,
              edge_b);
        check(nearest(point(a[0]), triangle(b)), corner_a, b);
        check(nearest(point(a[0]), Segment{point(b[0]), point(b[1])}), corner_a, edge_b);
    }
}

/// The point is in the hull iff its distance to it is 0.
TEST_P(OnGrid, WitnessesLieInTheirTriangles) {
    for (int i = 0; i < 700; ++i) {
        const auto a = corners(3), b = corners(3);
        const Nearest n = nearest(triangle(a), triangle(b));
        // Coordinates are fractions: a common denominator makes whole numbers of them.
        for (const auto& [p, of] : {std::pair(n.a, a), std::pair(n.b, b)}) {
            const mpz_class w = lcm(lcm(p[0].get_den(), p[1].get_den()), p[2].get_den());
            const auto whole = [&](mpq_class x) { return mpz_class(x * w).get_d(); };
            const auto corner = [&](const Grid& g) { return point(g) * w.get_d(); };
            if (abs(w) > (1L << 40))
                continue; // the products above would round
            const Triangle<double> t{corner(of[0]), corner(of[1]), corner(of[2])};
            ASSERT_EQ(squared_distance(Vec3{whole(p[0]), whole(p[1]), whole(p[2])}, t), 0);
        }
    }
}

} // namespace
} // namespace boxwood::oracle
