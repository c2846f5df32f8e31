#include "kernels/oracle/rational.h"

#include "kernels/oracle/nearest.h"
#include "kernels/oracle/registry.h"
#include "kernels/oracle/roots.h"

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <type_traits>

namespace boxwood::oracle {
namespace {

static_assert(TriangleKernel<RationalTriangles>);
static_assert(TriangleDistanceKernel<RationalTriangleDistance>);
static_assert(SegmentDistanceKernel<RationalSegmentDistance>);
static_assert(PointTriangleKernel<RationalPointTriangle>);
static_assert(PointSegmentKernel<RationalPointSegment>);
static_assert(RayKernel<RationalRays>);

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

class Random {
  public:
    /// Sizes 2^-n .. 1.
    Vec3<double> point(int n) { return {real(n), real(n), real(n)}; }
    Triangle<double> triangle(int n = 0) { return {point(n), point(n), point(n)}; }

  private:
    double real(int n) {
        const int k = n == 0 ? 0 : std::uniform_int_distribution<int>(0, n)(bits_);
        return std::ldexp(std::uniform_real_distribution<double>(-1, 1)(bits_), -k);
    }
    std::mt19937_64 bits_{17};
};

TEST(RationalKernels, ListedOncePerFamily) {
    const auto expect = []<class K>(std::type_identity<std::tuple<K>>, const char* family) {
        EXPECT_EQ(K::info.family, family);
        EXPECT_EQ(K::info.name, "rational");
        EXPECT_EQ(K::info.promise, Promise::exact);
    };
    using std::type_identity;
    expect(type_identity<RationalTriangleKernels>(), "triangle_triangle");
    expect(type_identity<RationalTriangleDistanceKernels>(), "triangle_distance");
    expect(type_identity<RationalSegmentDistanceKernels>(), "segment_segment");
    expect(type_identity<RationalPointTriangleKernels>(), "point_triangle");
    expect(type_identity<RationalPointSegmentKernels>(), "point_segment");
    expect(type_identity<RationalRayKernels>(), "ray_triangle");
}

TEST(RationalKernels, DistanceIsEnclosedByNeighbours) {
    Random random;
    int inexact = 0;
    for (int i = 0; i < 200; ++i) {
        const Triangle<double> a = random.triangle(1074), b = random.triangle(1074);
        const mpq_class squared = squared_distance(a, b);
        const Distance d = RationalTriangleDistance::distance(a, b);
        ASSERT_LE(compare(d.lo, squared), 0);
        ASSERT_GE(compare(d.hi, squared), 0);
        ASSERT_LE(d.lo, d.distance);
        ASSERT_LE(d.distance, d.hi);
        ASSERT_EQ(d.hi, d.lo == d.hi ? d.lo : std::nextafter(d.lo, inf));
        ASSERT_LE(std::abs(ulps_off(d.distance, squared)), 0.5);
        inexact += d.lo != d.hi;
        ASSERT_EQ(RationalTriangles::intersect(a, b).answer == Answer::yes, d.distance == 0);
    }
    EXPECT_GT(inexact, 40);
}

TEST(RationalKernels, WitnessesAreWhereTheDistanceIs) {
    Random random;
    for (int i = 0; i < 200; ++i) {
        const Triangle<double> a = random.triangle(), b = random.triangle();
        const Segment<double> s{a.a, a.b}, t{b.a, b.b};
        for (const Distance& d :
             {RationalTriangleDistance::distance(a, b), RationalSegmentDistance::distance(s, t),
              RationalPointTriangle::distance(a.a, b), RationalPointSegment::distance(a.a, t)}) {
            EXPECT_NEAR(length(d.point_a - d.point_b), d.distance, 1e-15);
            EXPECT_NEAR(RationalPointTriangle::distance(d.point_a, a).distance, 0, 1e-15);
            EXPECT_NEAR(RationalPointTriangle::distance(d.point_b, b).distance, 0, 1e-15);
        }
        EXPECT_EQ(RationalPointTriangle::distance(a.a, b).point_a, a.a);
    }
}

TEST(RationalKernels, DistanceBeyondTheDoubles) {
    const double big = std::numeric_limits<double>::max();
    const Distance d = RationalPointSegment::distance({-big, 0, 0}, {{big, 0, 0}, {big, 1, 0}});
    EXPECT_EQ(d.distance, inf);
    EXPECT_EQ(d.lo, big);
    EXPECT_EQ(d.hi, inf);
}

TEST(RationalKernels, RayIsRoundedOnce) {
    const Ray<float> ray{{0, 0, 0}, {0, 0, 3}};
    const Triangle<float> t{{-1, -1, 1}, {2, -1, 1}, {-1, 2, 1}};
    RayHit hit;
    const float infinite = std::numeric_limits<float>::infinity();
    ASSERT_TRUE(RationalRays::intersect({}, ray, t, infinite, hit));
    EXPECT_EQ(hit.t, 1.0f / 3);
    EXPECT_EQ(hit.u, 1.0f / 3);
    EXPECT_EQ(hit.v, 1.0f / 3);
    // 1/3 rounded to float is above 1/3: it limits nothing, the float below does.
    EXPECT_TRUE(RationalRays::intersect({}, ray, t, 1.0f / 3, hit));
    const RayHit before = hit;
    EXPECT_FALSE(RationalRays::intersect({}, ray, t, std::nextafter(1.0f / 3, 0.0f), hit));
    EXPECT_EQ(hit, before);
    EXPECT_FALSE(RationalRays::intersect({}, {{0, 0, 0}, {0, 0, 1e-42f}}, t, infinite, hit));
}

TEST(RationalKernels, NothingIsSaidOfNaNAndInfinity) {
    for (const double bad : {nan, inf, -inf}) {
        const Triangle<double> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
            spoilt{{0, 0, 0}, {1, bad, 0}, {}};
        EXPECT_EQ(RationalTriangles::intersect(good, spoilt).answer, Answer::maybe);
        EXPECT_EQ(RationalTriangles::intersect(spoilt, good).answer, Answer::maybe);
        const Distance d = RationalTriangleDistance::distance(good, spoilt);
        EXPECT_TRUE(std::isnan(d.distance) && std::isnan(d.lo) && std::isnan(d.hi));
        EXPECT_TRUE(std::isnan(RationalPointTriangle::distance({bad, 0, 0}, good).lo));
        const auto x = static_cast<float>(bad);
        const Triangle<float> t{{-1, -1, 1}, {2, -1, 1}, {-1, 2, 1}};
        RayHit hit;
        EXPECT_FALSE(RationalRays::intersect({}, {{0, 0, 0}, {0, x, 1}}, t, 9, hit));
        EXPECT_FALSE(RationalRays::intersect({}, {{x, 0, 0}, {0, 0, 1}}, t, 9, hit));
        EXPECT_FALSE(
            RationalRays::intersect({}, {{0, 0, 0}, {0, 0, 1}}, {t.a, t.b, {0, 0, x}}, 9, hit));
        EXPECT_FALSE(hit.hit());
    }
}

// Denormals are numbers to the oracle whatever the processor makes of them.
TEST(RationalKernels, FlushToZeroChangesNothing) {
    Random random;
    const unsigned mode = _mm_getcsr();
    for (int i = 0; i < 100; ++i) {
        Triangle<double> a = random.triangle(60), b = random.triangle(60);
        for (Triangle<double>* t : {&a, &b})
            *t = {t->a * 0x1p-1020, t->b * 0x1p-1020, t->c * 0x1p-1020};
        const Distance plain = RationalTriangleDistance::distance(a, b);
        const Decision touch = RationalTriangles::intersect(a, b);
        _mm_setcsr(mode | 0x8040); // FTZ and DAZ
        const Distance flushed = RationalTriangleDistance::distance(a, b);
        const Decision touch_flushed = RationalTriangles::intersect(a, b);
        _mm_setcsr(mode);
        EXPECT_EQ(plain.distance, flushed.distance);
        EXPECT_EQ(plain.lo, flushed.lo);
        EXPECT_EQ(plain.hi, flushed.hi);
        EXPECT_EQ(plain.point_a, flushed.point_a);
        EXPECT_EQ(plain.point_b, flushed.point_b);
        EXPECT_EQ(touch, touch_flushed);
    }
}

} // namespace
} // namespace boxwood::oracle
