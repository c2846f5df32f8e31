#include "kernels/triangle_triangle/sat.h"
#include "kernels/triangle_triangle/sat_certified.h"

#include "kernels/testing/triangle_pairs.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>

namespace boxwood {
namespace {

using testing::PairFamilies;
using testing::print;
using testing::TrianglePair;

static_assert(TriangleKernel<SatF64> && TriangleKernel<SatCertified>);

template <class K> Answer answer(const TrianglePair& pair) {
    return K::intersect(pair.a, pair.b).answer;
}

TEST(SatF64, ExactOnSmallIntegers) {
    for (const int size : {1, 2, 8, 2048})
        for (const TrianglePair& pair : PairFamilies(std::uint64_t(size)).grid(8000, size))
            ASSERT_EQ(answer<SatF64>(pair), pair.touch ? Answer::yes : Answer::no) << print(pair);
}

TEST(SatF64, GenericPairs) {
    for (const TrianglePair& pair : PairFamilies().generic(10000))
        ASSERT_EQ(answer<SatF64>(pair), pair.touch ? Answer::yes : Answer::no) << print(pair);
}

struct Sureness {
    int yes = 0, no = 0, maybe = 0;
};

/// What it's sure of is true, and the same with denormals flushed.
Sureness judge(const std::vector<TrianglePair>& pairs) {
    Sureness sure;
    for (const TrianglePair& pair : pairs) {
        const Answer kept = answer<SatCertified>(pair);
        if (kept != Answer::maybe) {
            EXPECT_EQ(kept, pair.touch ? Answer::yes : Answer::no) << print(pair);
        }
        Answer flushed{};
        {
            const DenormalFlushing mode(true);
            flushed = answer<SatCertified>(pair);
        }
        EXPECT_EQ(flushed, kept) << print(pair);
        (kept == Answer::yes ? sure.yes : kept == Answer::no ? sure.no : sure.maybe)++;
        if (::testing::Test::HasFailure())
            break;
    }
    return sure;
}

TEST(SatCertified, SureOfGenericPairs) { EXPECT_EQ(judge(PairFamilies().generic(20000)).maybe, 0); }

TEST(SatCertified, SureOfTheGapsOfIntegers) {
    for (const int size : {1, 2, 8, 2048})
        for (const TrianglePair& pair : PairFamilies(std::uint64_t(size)).grid(8000, size)) {
            const Answer said = answer<SatCertified>(pair);
            if (pair.touch)
                ASSERT_NE(said, Answer::no) << print(pair);
            else
                ASSERT_EQ(said, Answer::no) << print(pair);
        }
}

TEST(SatCertified, NeverWrongNearTouch) {
    const auto pairs = PairFamilies().nearly_touching(20000);
    const auto n = static_cast<int>(pairs.size());
    const Sureness sure = judge(pairs);
    EXPECT_GT(sure.maybe, n / 4);
    EXPECT_GT(sure.yes, n / 40);
    EXPECT_GT(sure.no, n / 40);
}

TEST(SatCertified, TheSameAtEveryScale) {
    for (const int exponent : {-1074, -1022, -400, 0, 400, 1015})
        for (std::uint64_t seed = 0; seed < 2; ++seed) {
            const Sureness at_one = judge(PairFamilies(seed).grid(2000, 64));
            const Sureness here = judge(PairFamilies(seed).grid(2000, 64, exponent));
            EXPECT_EQ(here.yes, at_one.yes) << exponent;
            EXPECT_EQ(here.no, at_one.no) << exponent;
        }
}

TEST(SatCertified, NeverWrongOnMixedMagnitudes) {
    judge(PairFamilies(1).magnitudes(10000, -60, 60));
    judge(PairFamilies(2).magnitudes(10000, -1074, -1000));
    judge(PairFamilies(3).magnitudes(10000, 960, 1022));
    judge(PairFamilies(4).magnitudes(10000, -1074, 1022));
}

TEST(Sat, MaybeForNanInfinityAndOverflow) {
    const Triangle<double> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Triangle<double> far{{0, 0, 9}, {1, 0, 9}, {0, 1, 9}};
    constexpr double inf = std::numeric_limits<double>::infinity(),
                     nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {nan, inf, -inf})
        for (int corner = 0; corner < 3; ++corner)
            for (int k = 0; k < 3; ++k)
                for (const Triangle<double>& other : {good, far}) {
                    Triangle<double> t = good;
                    (corner == 0 ? t.a : corner == 1 ? t.b : t.c)[k] = bad;
                    for (const TrianglePair& pair :
                         {TrianglePair{t, other, {}}, {other, t, {}}, {t, t, {}}}) {
                        EXPECT_EQ(answer<SatF64>(pair), Answer::maybe);
                        EXPECT_EQ(answer<SatCertified>(pair), Answer::maybe);
                    }
                }
    const Triangle<double> huge{{-1e200, -1e200, 0}, {1e200, -1e200, 1e200}, {0, 1e200, 1e200}};
    EXPECT_EQ(SatF64::intersect(huge, huge).answer, Answer::maybe);
}

/// Two normals and nine edge crosses alone say that these touch.
TEST(Sat, CoplanarDisjoint) {
    const TrianglePair pair{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{10, 10, 0}, {11, 10, 0}, {10, 11, 0}}, false};
    EXPECT_EQ(answer<SatF64>(pair), Answer::no);
    EXPECT_EQ(answer<SatCertified>(pair), Answer::no);
}

} // namespace
} // namespace boxwood
