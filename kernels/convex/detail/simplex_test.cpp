#include "kernels/convex/detail/simplex.h"

#include "kernels/convex/detail/gjk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace boxwood::convex::detail {
namespace {

/// The radius of the greatest ball around the origin in the hull of some points, by all planes
/// through three of them that have the others on one side; less than 0 if the origin is outside.
double ball_in_hull(const std::vector<Vec3<double>>& points) {
    double least = inf;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t k = 0; k < j; ++k) {
                Vec3<double> n = cross(points[j] - points[i], points[k] - points[i]);
                n = n * (1 / length(n));
                const auto height = [&](const Vec3<double>& p) { return dot(n, p - points[i]); };
                const bool is_below =
                    std::ranges::all_of(points, [&](auto& p) { return height(p) < 1e-12; });
                const bool is_above =
                    std::ranges::all_of(points, [&](auto& p) { return height(p) > -1e-12; });
                if (is_below || is_above)
                    least = std::min(least, is_below ? dot(n, points[i]) : -dot(n, points[i]));
            }
    return least;
}

TEST(Simplex, ABallThatIsSaidToBeEnclosedIsInTheHull) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> part(0, 1);
    const auto point = [&] { return Vec3<double>{normal(random), normal(random), normal(random)}; };
    int n_enclosed = 0, n_missed = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::size_t n = 2 + static_cast<std::size_t>(i % 3); // 2: a tetrahedron
        std::vector<Vec3<double>> points;
        for (std::size_t k = 0; k < n + 2; ++k)
            points.push_back(point());
        const double ball = ball_in_hull(points), radius = .3 * part(random) * part(random);
        bool said;
        if (n == 2) {
            Vertices corners;
            for (std::size_t k = 0; k < 4; ++k)
                corners[k].w = points[k];
            said = encloses_ball(corners, radius);
        } else {
            said = encloses_ball(std::span(points).first(n), points[n], points[n + 1], radius);
        }
        if (said) {
            ASSERT_GE(ball, radius * (1 - 1e-9)) << i;
        }
        n_enclosed += said;
        n_missed += n == 2 && !said && ball > radius * (1 + 1e-9);
    }
    EXPECT_GT(n_enclosed, 200);
    EXPECT_EQ(n_missed, 0); // of a tetrahedron nothing else can be said
}

/// Where both are symmetric about one centre, the first edge of a simplex often goes through the
/// origin.
TEST(Simplex, AnEdgeThroughTheOriginIsNoReasonToMeasureADepth) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> part(.2, 1);
    int n_edges = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<Vec3<double>> corners;
        for (int k = 0; k < 12; ++k) {
            const Vec3<double> p{part(random) - .6, part(random) - .6, part(random) - .6};
            corners.insert(corners.end(), {p, -p});
        }
        const Hull hull(corners);
        const Box box{{part(random), part(random), part(random)}};
        const RelativePose same{Pose{}, Pose{}};
        const Difference difference{box, hull, same};
        Simplex ended;
        const double size = reach(box) + reach(hull), error = distance_error(size, 0);
        const CoreDistance found =
            nearest_to_origin(difference, {part(random), part(random), part(random)},
                              Goal{size, 0, 8 * u * size, 0, error, -error}, ended);
        n_edges += ended.size == 2;
        ASSERT_TRUE(found.overlapping && found.hi < -error) << i;
        ASSERT_FALSE(surrounds_ball(difference, ended, reach(box) + reach(hull)));
    }
    EXPECT_GT(n_edges, 50);
}

} // namespace
} // namespace boxwood::convex::detail
