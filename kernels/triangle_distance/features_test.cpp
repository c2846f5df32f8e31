#include "kernels/triangle_distance/features.h"

#include "kernels/detail/rescale.h"
#include "kernels/testing/distance_pairs.h"
#include "kernels/testing/every_target.h"
#include "kernels/triangle_distance/features_batch.h"

#include <gtest/gtest.h>

#include <limits>

namespace boxwood {
namespace {

using testing::DistanceFamilies;
using testing::DistancePair;
using testing::few;

struct NoDistance {
    using Real = double;
    static constexpr std::string_view name = "none";
    static constexpr KernelInfo info{};
    static double distance(const Triangle<double>&, const Triangle<double>&);
};
static_assert(!TriangleDistanceKernel<NoDistance>);
static_assert(!TriangleDistanceBatchKernel<FeaturesF64>);

/// The error of K over the size of the pair; the truth is that of the corners as K reads them.
template <class K> double error(const Triangle<double>& a, const Triangle<double>& b) {
    using Real = typename K::Real;
    const Triangle<Real> ra = testing::as<Real>(a), rb = testing::as<Real>(b);
    const DistancePair pair(testing::as<double>(ra), testing::as<double>(rb));
    const Distance d = K::distance(ra, rb);
    EXPECT_TRUE(d.lo == d.distance && d.hi == d.distance);
    return std::abs(d.distance - pair.distance) / pair.size;
}

template <class K> class Features : public ::testing::Test {
  protected:
    static constexpr bool f32 = std::is_same_v<typename K::Real, float>;
    static constexpr double u = f32 ? 0x1p-24 : 0x1p-53;
};
using Kernels = ::testing::Types<FeaturesF32, FeaturesF64, CrossProductF64, FeaturesF64Batch>;
TYPED_TEST_SUITE(Features, Kernels);

TYPED_TEST(Features, SmallIntegers) {
    // Every logic error shows: degenerate ones, touching ones, shared corners and edges.
    DistanceFamilies make;
    for (const int n : {1, 2, 3, 8})
        for (int i = 0; i < few(1500); ++i) {
            auto a = make.grid(n), b = make.grid(n);
            if (i % 3 == 0)
                a = make.degraded(a);
            if (i % 4 == 0)
                b = make.degraded(b);
            if (i % 5 == 0)
                std::copy_n(a.begin(), i % 3, b.begin());
            const Triangle<double> ta = make.triangle(a), tb = make.triangle(b);
            ASSERT_LT(error<TypeParam>(ta, tb), 4 * this->u) << testing::print({ta, tb, false});
        }
}

TYPED_TEST(Features, OrdinaryPairs) {
    DistanceFamilies make(2);
    for (const DistanceFamilies::Family& family : make.ordinary())
        for (int i = 0; i < few(250); ++i) {
            const auto [a, b] = family.make();
            ASSERT_LT(error<TypeParam>(make.triangle(a), make.triangle(b)), 64 * this->u)
                << family.name << testing::print({make.triangle(a), make.triangle(b), false});
        }
}

TYPED_TEST(Features, NearContact) {
    DistanceFamilies make(3);
    for (const DistanceFamilies::Family& family : make.near_contact())
        for (int i = 0; i < few(250); ++i) {
            const auto [a, b] = family.make();
            // Floats of coplanar corners are slivers' worth of angles apart.
            ASSERT_LT(error<TypeParam>(make.triangle(a), make.triangle(b)),
                      (this->f32 ? 2048 : 64) * this->u)
                << family.name << testing::print({make.triangle(a), make.triangle(b), false});
        }
}

TYPED_TEST(Features, ThinOnes) {
    // The normal of a sliver is off by u / sin, the sliver sin wide: at worst about sqrt(u).
    DistanceFamilies make(4);
    for (const DistanceFamilies::Family& family : make.thin())
        for (int i = 0; i < few(250); ++i) {
            const auto [a, b] = family.make();
            ASSERT_LT(error<TypeParam>(make.triangle(a), make.triangle(b)), 8 * std::sqrt(this->u))
                << family.name << testing::print({make.triangle(a), make.triangle(b), false});
        }
}

TYPED_TEST(Features, PowersOfTwoChangeNothing) {
    using Real = typename TypeParam::Real;
    DistanceFamilies make(5);
    const int reach = this->f32 ? 100 : 900;
    for (int i = 0; i < few(1000); ++i) {
        const auto a = testing::as<Real>(make.triangle(make.inside()));
        const auto b = testing::as<Real>(make.triangle(make.inside()));
        const int k = make.below(2 * reach) - reach;
        const Distance one = TypeParam::distance(a, b);
        const Distance other =
            TypeParam::distance(detail::times_power_of_two(a, k), detail::times_power_of_two(b, k));
        ASSERT_EQ(other.distance, std::ldexp(one.distance, k)) << k;
        ASSERT_EQ(other.point_a, detail::times_power_of_two(one.point_a, k)) << k;
        ASSERT_EQ(other.point_b, detail::times_power_of_two(one.point_b, k)) << k;
    }
}

TYPED_TEST(Features, WitnessesLieThatFarApart) {
    DistanceFamilies make(6);
    for (int i = 0; i < few(1000); ++i) {
        const auto a = testing::as<typename TypeParam::Real>(make.triangle(make.inside()));
        const auto b = testing::as<typename TypeParam::Real>(make.triangle(make.inside()));
        const Distance d = TypeParam::distance(a, b);
        ASSERT_NEAR(length(d.point_a - d.point_b), d.distance, 16 * this->u);
        const auto off = [](Vec3<double> p, const Triangle<double>& t) {
            return oracle::nearest_sqrt(oracle::squared_distance(p, t));
        };
        ASSERT_LT(off(d.point_a, testing::as<double>(a)), 16 * this->u);
        ASSERT_LT(off(d.point_b, testing::as<double>(b)), 16 * this->u);
    }
}

TYPED_TEST(Features, KnownAnswers) {
    using Real = typename TypeParam::Real;
    const auto measure = [](const Triangle<double>& a, const Triangle<double>& b) {
        return TypeParam::distance(testing::as<Real>(a), testing::as<Real>(b)).distance;
    };
    for (const double s : {1.8e-4, 1.7e-4, 1e-4, 1e-5}) {
        const double h = s / 10;
        const Triangle<double> a{{0, 0, 0}, {s, 0, 0}, {0, s, 0}};
        const Triangle<double> b{
            {s / 4, s / 4, h}, {5 * s / 4, s / 4, h + s}, {s / 4, 5 * s / 4, h + s}};
        EXPECT_NEAR(measure(a, b), h, 8 * this->u * h) << s;
    }
    const Triangle<double> t{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_NEAR(measure(t, {{10, 10, 0}, {11, 10, 0}, {10, 11, 0}}), 13.435028842544403,
                100 * this->u);
    EXPECT_EQ(measure(t, t), 0);
    EXPECT_EQ(measure(t, {{.25, .25, 0}, {.5, .25, 0}, {.25, .5, 0}}), 0);    // contained
    EXPECT_EQ(measure(t, {{.25, .25, -1}, {.25, .25, 1}, {.25, .25, 1}}), 0); // a segment through
    EXPECT_EQ(measure(t, {{1, 0, 0}, {1, 0, 0}, {1, 0, 0}}), 0);              // a point
    EXPECT_EQ(measure({{3, 4, 0}, {3, 4, 0}, {3, 4, 0}}, {}), 5);             // two points
    EXPECT_EQ(measure({}, {}), 0);
}

TYPED_TEST(Features, NanAndInfinity) {
    using Real = typename TypeParam::Real;
    const Triangle<Real> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const Real bad :
         {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()})
        for (int k = 0; k < 3; ++k) {
            Triangle<Real> t = good;
            t.c[k] = bad;
            EXPECT_TRUE(std::isnan(TypeParam::distance(t, good).distance));
            EXPECT_TRUE(std::isnan(TypeParam::distance(good, t).hi));
            EXPECT_TRUE(std::isnan(TypeParam::distance(t, t).lo));
        }
}

/// Greatest relative error of K on nearly parallel edges that far apart.
template <class K> double worst_relative_error(double apart) {
    DistanceFamilies make(7);
    double worst = 0;
    for (int i = 0; i < few(3000); ++i) {
        const double angle = std::pow(10, -2 - i % 15);
        const auto [a, b] = make.near_parallel_edges(angle, apart);
        const DistancePair pair(make.triangle(a), make.triangle(b));
        worst = std::max(worst, std::abs(K::distance(pair.a, pair.b).distance / pair.distance - 1));
    }
    return worst;
}

TEST(CrossProduct, KeepsItsDigitsWhereEdgesAreNearlyParallel) {
    for (const double apart : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
        EXPECT_LT(worst_relative_error<CrossProductF64>(apart), 1e-15 / apart) << apart;
    }
    EXPECT_GT(worst_relative_error<FeaturesF64>(1e-10), 1); // what it is for
}

TEST(FeaturesBatch, SameBitsOnEveryTarget) {
    DistanceFamilies make(8);
    std::vector<Triangle<double>> a, b;
    for (auto families : {make.ordinary(), make.near_contact(), make.thin(), make.extreme()})
        for (const DistanceFamilies::Family& family : families)
            for (int i = 0; i < few(150); ++i) {
                const auto made = family.make();
                a.push_back(make.triangle(made.a));
                b.push_back(make.triangle(made.b));
                if (i % 50 == 0)
                    a.back().b.y = std::nan("");
            }
    using Block = TrianglePairBlock<double>;
    std::vector<Block> blocks((a.size() + Block::lanes - 1) / Block::lanes);
    std::vector<Distance> expected;
    for (std::size_t i = 0; i < a.size(); ++i) {
        blocks[i / Block::lanes].set(i % Block::lanes, a[i], b[i]);
        expected.push_back(FeaturesF64Batch::distance(a[i], b[i]));
    }
    const auto bits = [](const Distance& d) {
        return std::bit_cast<std::array<std::uint64_t, 9>>(
            std::array{d.distance, d.lo, d.hi, d.point_a.x, d.point_a.y, d.point_a.z, d.point_b.x,
                       d.point_b.y, d.point_b.z});
    };
    on_every_target([&] {
        for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{8},
                                    std::size_t{130}, a.size() - 5, a.size()}) {
            std::vector<Distance> got(n + 1);
            got.back().distance = -1; // not to be written
            FeaturesF64Batch::distance(blocks, {got.data(), n});
            for (std::size_t i = 0; i < n; ++i)
                ASSERT_EQ(bits(got[i]), bits(expected[i]))
                    << i << testing::print({a[i], b[i], false}) << got[i].distance << ' '
                    << expected[i].distance;
            EXPECT_EQ(got.back().distance, -1);
        }
    });
}

} // namespace
} // namespace boxwood
