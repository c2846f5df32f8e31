#include "kernels/triangle_distance/certified.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/testing/distance_pairs.h"
#include "kernels/triangle_distance/detail/refined_bounds.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace boxwood {
namespace {

using namespace detail;

using testing::DistanceFamilies;
using testing::DistancePair;
using testing::few;
using Kernel = CertifiedDistance;

static_assert(Kernel::info.promise == Promise::certified);

/// The bounds hold, `distance` is between them, and is 0 if and only if the two touch.
void expect_certified(const Distance& d, const DistancePair& pair) {
    ASSERT_LE(oracle::compare(d.lo, pair.squared), 0)
        << pair.print() << d.lo << " > " << pair.distance;
    ASSERT_GE(oracle::compare(d.hi, pair.squared), 0)
        << pair.print() << d.hi << " < " << pair.distance;
    ASSERT_TRUE(0 <= d.lo && d.lo <= d.distance && d.distance <= d.hi)
        << pair.print() << d.lo << ' ' << d.distance << ' ' << d.hi;
    ASSERT_EQ(d.distance == 0, pair.touch()) << pair.print() << d.lo << ' ' << d.hi;
    if (pair.touch()) {
        ASSERT_EQ(d.hi, 0) << pair.print();
    }
}

struct Tally {
    std::array<int, 4> tiers{};
    int touching = 0;
    double widest = 0; ///< relative, of those apart
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
            if (!pair.touch())
                all.widest = std::max(all.widest, (d.hi - d.lo) / d.hi);
        }
    }
    return all;
}

TEST(CertifiedDistance, OrdinaryPairs) {
    DistanceFamilies make(3);
    const Tally tally = judge(make, make.ordinary(), 1500);
    EXPECT_GT(tally.tiers[0], few(5000));
    EXPECT_GT(tally.touching, few(500));
    EXPECT_LT(tally.widest, 1e-9);
}

TEST(CertifiedDistance, NearContact) {
    DistanceFamilies make(4);
    const Tally tally = judge(make, make.near_contact(), 500);
    for (int tier = 0; tier < 3; ++tier)
        EXPECT_GT(tally.tiers[static_cast<std::size_t>(tier)], few(300)) << tier;
    EXPECT_EQ(tally.tiers[3], 0);
    EXPECT_LT(tally.widest, 1e-6); // at gaps down to 1e-18
}

TEST(CertifiedDistance, NearlyParallelEdges) {
    DistanceFamilies make(5);
    EXPECT_LT(judge(make, std::array{make.near_parallel_edges()}, 1500).widest, 1e-9);
}

TEST(CertifiedDistance, ThinAndDegenerate) {
    DistanceFamilies make(6);
    const Tally tally = judge(make, make.thin(), 1000);
    EXPECT_GT(tally.touching, few(500));
    EXPECT_LT(tally.widest, 1e-2);
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

TEST(LeastSeparation, IsBelowEveryDistanceOfAGrid) {
    DistanceFamilies make(11);
    const DistanceFamilies::Family tiny{
        "grid", [&] {
            return DistanceFamilies::Made{make.grid(7), make.grid(7)};
        }};
    double nearest = 1;
    for (const DistancePair& pair : make.pairs(tiny, 5000))
        if (!pair.touch()) {
            ASSERT_LE(oracle::compare(min_separation(0, 3), pair.squared), 0) << pair.print();
            nearest = std::min(nearest, pair.distance);
        }
    if (testing::thinned == 1) {
        EXPECT_LT(nearest, 16 * min_separation(0, 3)); // not needlessly small
    }
    EXPECT_EQ(min_separation(-1074, -1070), 0); // underflows
    EXPECT_EQ(coordinate_grid({{4, 0, 0}, {8, 12, 0}, {0, 0, 0}}, {{0, 4, 0}, {0, 0, 0}, {}}), 2);
    EXPECT_EQ(coordinate_grid({{0x1p-1074, 0, 0}, {1, 0, 0}, {}}, {}), -1074);
}

} // namespace
} // namespace boxwood
