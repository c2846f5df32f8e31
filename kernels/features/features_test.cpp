#include "kernels/features/point_triangle.h"

#include "kernels/testing/distance_pairs.h"

#include <gtest/gtest.h>

#include <limits>

namespace boxwood {
namespace {

using testing::DistanceFamilies;
using testing::few;

// What a pair of triangles gives to each family: edges a.a a.b and b.a b.b, the corner a.a.
template <class Real> Segment<Real> edge(const Triangle<Real>& t) { return {t.a, t.b}; }

template <class K> struct OfSegments {
    using Kernel = K;
    template <class Real> static auto first(const Triangle<Real>& a) { return edge(a); }
    template <class Real> static auto second(const Triangle<Real>& b) { return edge(b); }
};
template <class K> struct OfPointAndTriangle {
    using Kernel = K;
    template <class Real> static auto first(const Triangle<Real>& a) { return a.a; }
    template <class Real> static auto second(const Triangle<Real>& b) { return b; }
};
template <class K> struct OfPointAndSegment {
    using Kernel = K;
    template <class Real> static auto first(const Triangle<Real>& a) { return a.a; }
    template <class Real> static auto second(const Triangle<Real>& b) { return edge(b); }
};

template <class Level> class FeaturePairs : public ::testing::Test {
  protected:
    using Number = typename Level::Kernel::Real;
    static constexpr double u = sizeof(Number) == 4 ? 0x1p-24 : 0x1p-53;

    static Distance measure(const Triangle<Number>& a, const Triangle<Number>& b) {
        return Level::Kernel::distance(Level::first(a), Level::second(b));
    }
    static double truth(const Triangle<Number>& a, const Triangle<Number>& b) {
        return oracle::nearest_sqrt(oracle::squared_distance(
            Level::first(testing::as<double>(a)), Level::second(testing::as<double>(b))));
    }
    /// Over the size of the two triangles.
    static double error(const Triangle<double>& a, const Triangle<double>& b) {
        const auto ra = testing::as<Number>(a), rb = testing::as<Number>(b);
        return std::abs(measure(ra, rb).distance - truth(ra, rb)) / testing::size_of(a, b);
    }
};
using Kernels =
    ::testing::Types<OfSegments<SegmentSegmentF32>, OfSegments<SegmentSegmentF64>,
                     OfSegments<SegmentSegmentCross>, OfPointAndTriangle<PointTriangleF32>,
                     OfPointAndTriangle<PointTriangleF64>, OfPointAndTriangle<PointTriangleCross>,
                     OfPointAndSegment<PointSegmentF32>, OfPointAndSegment<PointSegmentF64>>;
TYPED_TEST_SUITE(FeaturePairs, Kernels);

TYPED_TEST(FeaturePairs, SmallIntegersAndDegenerateOnes) {
    DistanceFamilies make;
    for (const int n : {1, 2, 8})
        for (int i = 0; i < few(2000); ++i) {
            const auto a = make.triangle(i % 2 == 0 ? make.grid(n) : make.degraded(make.grid(n)));
            const auto b = make.triangle(i % 3 == 0 ? make.grid(n) : make.degraded(make.grid(n)));
            ASSERT_LT(this->error(a, b), 4 * this->u) << testing::print({a, b, false});
        }
}

TYPED_TEST(FeaturePairs, OrdinaryPairs) {
    DistanceFamilies make(2);
    for (const DistanceFamilies::Family& family : make.ordinary())
        for (int i = 0; i < few(1000); ++i) {
            const auto made = family.make();
            const auto a = make.triangle(made.a), b = make.triangle(made.b);
            ASSERT_LT(this->error(a, b), 16 * this->u)
                << family.name << testing::print({a, b, false});
        }
}

TYPED_TEST(FeaturePairs, PowersOfTwoChangeNothing) {
    using Real = typename TypeParam::Kernel::Real;
    DistanceFamilies make(3);
    const int reach = sizeof(Real) == 4 ? 100 : 900;
    for (int i = 0; i < few(1000); ++i) {
        const auto a = testing::as<Real>(make.triangle(make.inside()));
        const auto b = testing::as<Real>(make.triangle(make.inside()));
        const int k = make.below(2 * reach) - reach;
        const Distance one = this->measure(a, b);
        const Distance other =
            this->measure(detail::times_power_of_two(a, k), detail::times_power_of_two(b, k));
        ASSERT_EQ(other.distance, std::ldexp(one.distance, k)) << k;
        ASSERT_EQ(other.point_a, detail::times_power_of_two(one.point_a, k)) << k;
    }
}

TYPED_TEST(FeaturePairs, WitnessesLieThatFarApart) {
    using Real = typename TypeParam::Kernel::Real;
    DistanceFamilies make(4);
    for (int i = 0; i < few(1000); ++i) {
        const auto a = testing::as<Real>(make.triangle(make.inside()));
        const auto b = testing::as<Real>(make.triangle(make.inside()));
        const Distance d = this->measure(a, b);
        ASSERT_NEAR(length(d.point_a - d.point_b), d.distance, 16 * this->u);
        ASSERT_LT(oracle::nearest_sqrt(oracle::squared_distance(
                      d.point_b, TypeParam::second(testing::as<double>(b)))),
                  16 * this->u);
    }
}

TYPED_TEST(FeaturePairs, NanAndInfinity) {
    using Real = typename TypeParam::Kernel::Real;
    const Triangle<Real> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const Real bad :
         {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()})
        for (int k = 0; k < 3; ++k) {
            Triangle<Real> t = good;
            t.a[k] = bad;
            EXPECT_TRUE(std::isnan(this->measure(t, good).distance));
            EXPECT_TRUE(std::isnan(this->measure(good, t).lo));
        }
}

TEST(SegmentSegment, CrossProductKeepsItsDigitsWhereTheyAreNearlyParallel) {
    DistanceFamilies make(5);
    double ericson = 0, cross = 0;
    for (int i = 0; i < few(5000); ++i) {
        const auto made = make.near_parallel_edges(std::pow(10, -2 - i % 15), 1e-10);
        const Segment<double> a = edge(make.triangle(made.a)), b = edge(make.triangle(made.b));
        const double d = oracle::nearest_sqrt(oracle::squared_distance(a, b));
        const auto relative = [&](const Distance& got) { return std::abs(got.distance / d - 1); };
        ericson = std::max(ericson, relative(SegmentSegmentF64::distance(a, b)));
        cross = std::max(cross, relative(SegmentSegmentCross::distance(a, b)));
    }
    EXPECT_LT(cross, 1e-5);
    EXPECT_GT(ericson, 1);
}

TEST(PointTriangle, CrossProductKeepsItsDigitsInSlivers) {
    DistanceFamilies make(6);
    double ericson = 0, cross = 0;
    for (const DistanceFamilies::Family& family : make.thin())
        for (int i = 0; i < few(2000); ++i) {
            const auto made = family.make();
            const Triangle<double> t = make.triangle(made.a);
            const Vec3<double> p = made.b[0];
            const double d = oracle::nearest_sqrt(oracle::squared_distance(p, t));
            const double size = testing::size_of(t, make.triangle(made.b));
            const auto error = [&](const Distance& got) {
                return std::abs(got.distance - d) / size;
            };
            ericson = std::max(ericson, error(PointTriangleF64::distance(p, t)));
            cross = std::max(cross, error(PointTriangleCross::distance(p, t)));
        }
    EXPECT_LT(cross, 1e-10);
    EXPECT_GT(ericson, 1e-6);
    EXPECT_LT(ericson, 1e-2);
}

} // namespace
} // namespace boxwood
