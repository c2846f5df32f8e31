#include "kernels/oracle/nearest.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <vector>

/// The oracle against a method that has nothing in common with it, on small integers. Two convex
/// hulls share a point iff 0 lies in the hull of the differences of their corners, and their
/// distance is that of 0 to it. By Caratheodory only simplices of corners need be looked at.
namespace boxwood::oracle {
namespace {

__extension__ typedef __int128 Wide;
using Grid = std::array<std::int64_t, 3>;

Grid minus(const Grid& a, const Grid& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
std::array<Wide, 3> normal(const Grid& a, const Grid& b) {
    return {Wide(a[1]) * b[2] - Wide(a[2]) * b[1], Wide(a[2]) * b[0] - Wide(a[0]) * b[2],
            Wide(a[0]) * b[1] - Wide(a[1]) * b[0]};
}
template <class A, class B> Wide product(const A& a, const B& b) {
    return Wide(a[0]) * b[0] + Wide(a[1]) * b[1] + Wide(a[2]) * b[2];
}

struct Fraction {
    Wide num, den;
    bool operator<(const Fraction& b) const { return num * b.den < b.num * den; }
};

mpq_class rational(const Fraction& f) {
    return mpq_class(static_cast<long>(f.num)) / mpq_class(static_cast<long>(f.den));
}

/// The squared distance of the origin to the hull of the points.
Fraction origin_to_hull(const std::vector<Grid>& p) {
    Fraction best{product(p[0], p[0]), 1};
    const auto offer = [&](Wide num, Wide den) {
        if (const Fraction f{num, den}; f < best)
            best = f;
    };
    for (std::size_t i = 0; i < p.size(); ++i) {
        offer(product(p[i], p[i]), 1);
        for (std::size_t j = i + 1; j < p.size(); ++j) {
            const Grid ij = minus(p[j], p[i]);
            const Wide at = -product(p[i], ij), end = product(ij, ij);
            if (end > 0 && at >= 0 && at <= end) {
                const auto moment = normal(p[i], ij);
                offer(product(moment, moment), end);
            }
            for (std::size_t k = j + 1; k < p.size(); ++k) {
                const auto n = normal(ij, minus(p[k], p[i]));
                const Wide nn = product(n, n), height = product(n, p[i]);
                if (nn == 0)
                    continue;
                const Wide u = product(n, normal(p[i], p[j])), v = product(n, normal(p[j], p[k])),
                           w = product(n, normal(p[k], p[i]));
                if (u >= 0 && v >= 0 && w >= 0)
                    offer(height * height, nn);
                for (std::size_t l = k + 1; l < p.size(); ++l) {
                    // Is 0 in the tetrahedron: on the inner side of its four faces?
                    const Wide six = product(n, minus(p[l], p[i]));
                    if (six == 0)
                        continue;
                    const auto det = [](const Grid& a, const Grid& b, const Grid& c) {
                        return product(normal(a, b), c);
                    };
                    const int turn = six > 0 ? 1 : -1;
                    if (turn * det(p[j], p[k], p[l]) >= 0 && turn * det(p[i], p[l], p[k]) >= 0 &&
                        turn * det(p[i], p[j], p[l]) >= 0 && turn * det(p[i], p[k], p[j]) >= 0)
                        return {0, 1};
                }
            }
        }
    }
    return best;
}

Fraction hull_to_hull(const std::vector<Grid>& a, const std::vector<Grid>& b) {
    std::vector<Grid> differences;
    for (const Grid& p : a)
        for (const Grid& q : b)
            differences.push_back(minus(p, q));
    return origin_to_hull(differences);
}

Vec3<double> point(const Grid& g) {
    return {static_cast<double>(g[0]), static_cast<double>(g[1]), static_cast<double>(g[2])};
}
Triangle<double> triangle(const std::vector<Grid>& g) {
    return {point(g[0]), point(g[1]), point(g[2])};
}

class OnGrid : public testing::TestWithParam<int> {
  protected:
    std::vector<Grid> corners(std::size_t n) {
        std::uniform_int_distribution<std::int64_t> coordinate(0, GetParam());
        std::vector<Grid> all(n);
        for (Grid& g : all)
            for (auto& x : g)
                x = coordinate(random_);
        return all;
    }

  private:
    std::mt19937_64 random_{7};
};
INSTANTIATE_TEST_SUITE_P(Oracle, OnGrid, testing::Values(1, 2, 4, 20));

TEST_P(OnGrid, TrianglesMeetAsTheirDifferencesSay) {
    int touching = 0;
    for (int i = 0; i < 20'000; ++i) {
        const auto a = corners(3), b = corners(3);
        const bool truth = hull_to_hull(a, b).num == 0;
        touching += truth;
        ASSERT_EQ(intersect(triangle(a), triangle(b)), truth) << "case " << i;
    }
    EXPECT_GT(touching, 1000);
    EXPECT_LT(touching, 19'000);
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
    for (int i = 0; i < 4000 && !HasFailure(); ++i) {
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
    for (int i = 0; i < 2000; ++i) {
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
