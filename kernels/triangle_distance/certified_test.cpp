#include "kernels/triangle_distance/certified.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/oracle/exact_vector.h"
#include "kernels/testing/distance_pairs.h"
#include "kernels/triangle_distance/detail/exact_distance.h"
#include "kernels/triangle_distance/detail/refined_bounds.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <limits>
#include <random>

namespace boxwood {
namespace {

using namespace detail;

using testing::DistanceFamilies;
using testing::DistancePair;
using testing::few;
using Kernel = CertifiedDistance;

static_assert(Kernel::info.promise == Promise::certified);

/// What certified.h promises of the width.
bool narrow(const Distance& d) {
    const double hi = std::min(d.hi, std::numeric_limits<double>::max());
    return hi - d.lo <= 0x1p-32 * hi + 0x1p-1073;
}

/// The bounds hold, are as narrow as promised, `distance` is between them, and is 0 if and only if
/// the two touch.
void expect_certified(const Distance& d, const DistancePair& pair) {
    ASSERT_LE(oracle::compare(d.lo, pair.squared), 0)
        << pair.print() << d.lo << " > " << pair.distance;
    ASSERT_GE(oracle::compare(d.hi, pair.squared), 0)
        << pair.print() << d.hi << " < " << pair.distance;
    ASSERT_TRUE(0 <= d.lo && d.lo <= d.distance && d.distance <= d.hi)
        << pair.print() << d.lo << ' ' << d.distance << ' ' << d.hi;
    ASSERT_EQ(d.distance == 0, pair.touch()) << pair.print() << d.lo << ' ' << d.hi;
    const double denorm_min = std::numeric_limits<double>::denorm_min();
    ASSERT_TRUE(d.lo > 0 || oracle::compare(2 * denorm_min, pair.squared) >= 0) << pair.print();
    ASSERT_TRUE(narrow(d)) << pair.print() << d.lo << ' ' << d.hi << ' ' << int{d.tier};
    if (pair.touch()) {
        ASSERT_EQ(d.hi, 0) << pair.print();
    }
}

struct Tally {
    std::array<int, 4> tiers{};
    int touching = 0;
};

template <class Families>
Tally judge(DistanceFamilies& make, const Families& families, std::size_t n) {
    Tally all;
    for (const DistanceFamilies::Family& family : families) {
        SCOPED_TRACE(family.name);
        for (const DistancePair& pair : make.pairs(family, n)) {
            const Distance d = Kernel::distance(pair.a, pair.b);
            expect_certified(d, pair);
            if (::testing::Test::HasFatalFailure())
                return all;
            ++all.tiers.at(d.tier);
            all.touching += pair.touch();
        }
    }
    return all;
}

TEST(CertifiedDistance, OrdinaryPairs) {
    DistanceFamilies make(3);
    const Tally tally = judge(make, make.ordinary(), 1500);
    EXPECT_GT(tally.tiers[0], few(5000));
    EXPECT_GT(tally.touching, few(500));
}

TEST(CertifiedDistance, NearContact) {
    DistanceFamilies make(4);
    const Tally tally = judge(make, make.near_contact(), 500);
    for (int tier = 0; tier < 3; ++tier)
        EXPECT_GT(tally.tiers[static_cast<std::size_t>(tier)], few(300)) << tier;
    EXPECT_LT(tally.tiers[3], few(600));
}

TEST(CertifiedDistance, NearlyParallelEdges) {
    DistanceFamilies make(5);
    judge(make, std::array{make.near_parallel_edges()}, 1500);
}

TEST(CertifiedDistance, ThinAndDegenerate) {
    DistanceFamilies make(6);
    const Tally tally = judge(make, make.thin(), 1000);
    EXPECT_GT(tally.touching, few(500));
}

TEST(CertifiedDistance, AnyMagnitude) {
    DistanceFamilies make(7);
    const Tally tally = judge(make, make.extreme(), 800);
    EXPECT_GT(tally.tiers[3], few(50));
}

TEST(CertifiedDistance, FlushedDenormals) {
    const DenormalFlushing on(true);
    DistanceFamilies make(7);
    for (const DistanceFamilies::Family& family : make.extreme())
        for (int i = 0; i < few(200); ++i) {
            const auto [a, b] = [&] {
                const DenormalFlushing off(false);
                const auto made = family.make();
                return std::pair(make.triangle(made.a), make.triangle(made.b));
            }();
            const Distance flushed = Kernel::distance(a, b);
            ASSERT_TRUE(flushes_denormals());
            const DenormalFlushing off(false);
            const Distance kept = Kernel::distance(a, b);
            ASSERT_TRUE(flushed.lo == kept.lo && flushed.hi == kept.hi &&
                        flushed.distance == kept.distance)
                << family.name;
        }
}

TEST(CertifiedDistance, OrderOfCornersAndSides) {
    DistanceFamilies make(8);
    for (auto families : {make.ordinary(), make.near_contact(), make.thin()})
        for (const DistanceFamilies::Family& family : families)
            for (const DistancePair& pair : make.pairs(family, 6)) {
                std::array a{pair.a.a, pair.a.b, pair.a.c}, b{pair.b.a, pair.b.b, pair.b.c};
                for (int i = 0; i < 6; ++i)
                    for (int j = 0; j < 6; ++j) {
                        const Triangle<double> ta{a[0], a[1], a[2]}, tb{b[0], b[1], b[2]};
                        expect_certified(Kernel::distance(ta, tb), pair);
                        expect_certified(Kernel::distance(tb, ta), pair);
                        if (HasFatalFailure())
                            return;
                        std::rotate(b.begin(), b.begin() + 1, b.end());
                        if (j == 2)
                            std::swap(b[0], b[1]);
                        if (j == 5 && i == 2)
                            std::swap(a[0], a[1]);
                        if (j == 5)
                            std::rotate(a.begin(), a.begin() + 1, a.end());
                    }
            }
}

TEST(CertifiedDistance, WitnessesLieThatFarApart) {
    DistanceFamilies make(9);
    for (auto families : {make.ordinary(), make.near_contact(), make.thin()})
        for (const DistanceFamilies::Family& family : families)
            for (const DistancePair& pair : make.pairs(family, 200)) {
                const Distance d = Kernel::distance(pair.a, pair.b);
                const double far = std::max({length(pair.a.a), length(pair.b.a), pair.size});
                const auto off = [&](Vec3<double> p, const Triangle<double>& t) {
                    return oracle::nearest_sqrt(oracle::squared_distance(p, t));
                };
                ASSERT_LT(off(d.point_a, pair.a), 1e-15 * far) << family.name << pair.print();
                ASSERT_LT(off(d.point_b, pair.b), 1e-15 * far) << family.name << pair.print();
                // Where thin ones cross, the crossing itself is ill-conditioned.
                ASSERT_NEAR(length(d.point_a - d.point_b), pair.distance,
                            (pair.touch() ? 1e-7 : 1e-14) * far)
                    << family.name << pair.print();
            }
}

TEST(CertifiedDistance, KnownAnswers) {
    for (const double s : {1.7e-4, 1.8e-4, 1e-4, 1e-5, 1e-12}) {
        const double h = s / 10;
        const Triangle<double> a{{0, 0, 0}, {s, 0, 0}, {0, s, 0}};
        const Triangle<double> b{
            {s / 4, s / 4, h}, {5 * s / 4, s / 4, h + s}, {s / 4, 5 * s / 4, h + s}};
        const Distance d = Kernel::distance(a, b);
        EXPECT_TRUE(d.lo <= h && h <= d.hi) << s;
        EXPECT_NEAR(d.distance, h, 1e-15 * h);
    }
    const Distance coplanar = Kernel::distance({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                               {{10, 10, 0}, {11, 10, 0}, {10, 11, 0}});
    EXPECT_DOUBLE_EQ(coplanar.distance, 13.435028842544403);
    const Triangle<double> t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
    EXPECT_EQ(Kernel::distance(t, t).hi, 0);
    const Distance contained = Kernel::distance(t, {{1, 1, 0}, {2, 1, 0}, {1, 2, 0}});
    EXPECT_EQ(contained.hi, 0);
    EXPECT_LT(length(contained.point_a - contained.point_b), 1e-15);
}

TEST(CertifiedDistance, NanAndInfinity) {
    const Triangle<double> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
        for (int k = 0; k < 3; ++k)
            for (Vec3<double> Triangle<double>::*corner :
                 {&Triangle<double>::a, &Triangle<double>::b, &Triangle<double>::c}) {
                Triangle<double> t = good;
                (t.*corner)[k] = bad;
                for (const Distance& d :
                     {Kernel::distance(t, good), Kernel::distance(good, t), Kernel::distance(t, t)})
                    EXPECT_TRUE(std::isnan(d.lo) && std::isnan(d.hi) && std::isnan(d.distance));
            }
}

TEST(RefinedBounds, AreTightDownToTinyGaps) {
    DistanceFamilies make(10);
    for (const DistanceFamilies::Family& family : make.near_contact())
        for (const DistancePair& pair : make.pairs(family, 200)) {
            if (pair.touch() || pair.distance < 1e-15)
                continue;
            const auto unit = [](const Triangle<double>& t) { // at most 1 in size
                return Triangle<double>{t.a * 0x1p-4, t.b * 0x1p-4, t.c * 0x1p-4};
            };
            const DistanceBounds d = refined_bounds(unit(pair.a), unit(pair.b));
            ASSERT_LE(oracle::compare(d.lo * 16, pair.squared), 0);
            ASSERT_GE(oracle::compare(d.hi * 16, pair.squared), 0);
            ASSERT_GT(d.lo, d.hi * (1 - 1e-9)) << family.name << pair.print();
        }
}

/// The exact distance is within 2^-50 of the truth: proven by squares.
void expect_exact(const DistancePair& pair) {
    const Scaled d = exact_distance(pair.a, pair.b);
    const auto square = [&](double m) {
        const mpq_class x(m);
        return oracle::scaled(x * x, 2L * d.exponent);
    };
    ASSERT_LE(square(d.m * (1 - 0x1p-50)), pair.squared) << pair.print();
    ASSERT_GE(square(d.m * (1 + 0x1p-50)), pair.squared) << pair.print();
}

TEST(ExactDistance, IsExactButForTheLastRounding) {
    DistanceFamilies make(11);
    for (auto families : {make.ordinary(), make.near_contact(), make.thin(), make.extreme()})
        for (const DistanceFamilies::Family& family : families)
            for (const DistancePair& pair : make.pairs(family, 100)) {
                expect_exact(pair);
                ASSERT_FALSE(HasFatalFailure()) << family.name;
            }
    const DistanceFamilies::Family grid{
        "grid", [&] {
            return DistanceFamilies::Made{make.grid(7), make.grid(7)};
        }};
    for (const DistancePair& pair : make.pairs(grid, 1000)) {
        expect_exact(pair);
        ASSERT_FALSE(HasFatalFailure());
    }
}

TEST(ExactDistance, OfNumbersThatSpanAllDoubles) {
    std::mt19937_64 bits(12);
    const auto number = [&] {
        for (;;)
            if (const double x = std::bit_cast<double>(bits()); std::isfinite(x))
                return x;
    };
    const double max = std::numeric_limits<double>::max(), min = 0x1p-1074;
    const auto triangle = [&](bool extreme) {
        const auto corner = [&] {
            const auto axis = [&] {
                return !extreme ? number() : (bits() % 2 ? max : min) * (bits() % 2 ? 1 : -1);
            };
            return Vec3<double>{axis(), axis(), axis()};
        };
        return Triangle<double>{corner(), corner(), corner()};
    };
    for (int i = 0; i < few(400); ++i) {
        const DistancePair pair(triangle(i % 2), triangle(i % 2));
        expect_exact(pair);
        ASSERT_FALSE(HasFatalFailure());
        expect_certified(Kernel::distance(pair.a, pair.b), pair);
        ASSERT_FALSE(HasFatalFailure());
    }
}

TEST(CertifiedDistance, NeedlesOfNearlyOnePlane) {
    // Their distance is 5.82e-18, their size 1: the offset between nearest points in double-double
    // has no right bit.
    const Triangle<double> a{{-0x1.2534b35b93800p-10, -0x1.b0fba9e360d80p-2, -0x1.3c3f7a171dcf4p-2},
                             {-0x1.4e1bd62624a0ep-1, 0x1.688c9b2794270p-3, 0x1.4174954e3dad0p-3},
                             {-0x1.8e042e28a8fdcp-2, -0x1.1083c70287c67p-4, -0x1.03ca6ef6b3b13p-5}};
    const Triangle<double> b{{-0x1.63cb050d6f465p-2, -0x1.abc86815a0f2dp-4, -0x1.f5514e278e7d1p-5},
                             {-0x1.30e57440651aep-2, 0x1.740853e8b1908p-1, -0x1.3ae8d1760167cp+0},
                             {0x1.0f9759e25beb6p-2, 0x1.70393080e1a02p-1, -0x1.33d2f7bdc87efp+0}};
    const Distance d = Kernel::distance(a, b);
    expect_certified(d, DistancePair(a, b));
    EXPECT_EQ(d.tier, 3);
}

TEST(CertifiedDistance, GapsFarBelowTheSize) {
    const Triangle<double> t{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const double gap : {1e-20, 1e-30, 1e-100, 1e-200, 1e-308, 0x1p-1074}) {
        const Triangle<double> above{{0.25, 0.25, gap}, {1, 0, 1}, {0, 1, 2}};
        const Distance d = Kernel::distance(t, above);
        expect_certified(d, DistancePair(t, above));
        EXPECT_TRUE(0 < d.lo || gap == 0x1p-1074) << gap;
        EXPECT_NEAR(d.distance, gap, 1e-9 * gap + 0x1p-1074);
    }
}

} // namespace
} // namespace boxwood
