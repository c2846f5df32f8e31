#include "kernels/triangle_triangle/moller.h"

#include "kernels/testing/triangle_pairs.h"

#include <gtest/gtest.h>

#include <limits>

namespace boxwood {
namespace {

using testing::as;
using testing::Kept;
using testing::PairFamilies;
using testing::print;
using testing::TrianglePair;

static_assert(TriangleKernel<MollerF32> && TriangleKernel<MollerF64>);

template <class K> class MollerKernels : public ::testing::Test {
  protected:
    static constexpr Kept kept =
        std::is_same_v<typename K::Real, float> ? Kept::as_float : Kept::as_double;

    static Answer answer(const TrianglePair& pair) {
        return K::intersect(as<typename K::Real>(pair.a), as<typename K::Real>(pair.b)).answer;
    }
    /// The share of wrong answers.
    static double wrong(const std::vector<TrianglePair>& pairs) {
        int n = 0;
        for (const TrianglePair& pair : pairs)
            n += answer(pair) != (pair.touch ? Answer::yes : Answer::no);
        return n / double(pairs.size());
    }
};
using Kernels = ::testing::Types<MollerF32, MollerF64>;
TYPED_TEST_SUITE(MollerKernels, Kernels);

TYPED_TEST(MollerKernels, ExactOnSmallIntegers) {
    for (const int size : {1, 2, 4, this->kept == Kept::as_float ? 3 : 64})
        for (const TrianglePair& pair : PairFamilies(std::uint64_t(size)).grid(6000, size))
            ASSERT_EQ(this->answer(pair), pair.touch ? Answer::yes : Answer::no) << print(pair);
}

TYPED_TEST(MollerKernels, GenericPairs) {
    EXPECT_LT(this->wrong(PairFamilies(1, this->kept).generic(10000)), 1e-3);
}

TYPED_TEST(MollerKernels, PromisesNothingNearTouch) {
    const double wrong = this->wrong(PairFamilies(1, this->kept).nearly_touching(4000));
    EXPECT_GT(wrong, 0.01);
    EXPECT_LT(wrong, 0.5);
}

TYPED_TEST(MollerKernels, PowersOfTwoChangeNothing) {
    const int max_exponent = this->kept == Kept::as_float ? 8 : 60;
    for (const int exponent : {-max_exponent, max_exponent})
        EXPECT_EQ(this->wrong(PairFamilies(2, this->kept).grid(4000, 4, exponent)), 0);
}

TYPED_TEST(MollerKernels, MaybeForNanInfinityAndOverflow) {
    using Real = typename TypeParam::Real;
    const Triangle<Real> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Triangle<Real> far{{0, 0, 9}, {1, 0, 9}, {0, 1, 9}};
    constexpr Real inf = std::numeric_limits<Real>::infinity(),
                   nan = std::numeric_limits<Real>::quiet_NaN();
    for (const Real bad : {nan, inf, -inf})
        for (int corner = 0; corner < 3; ++corner)
            for (int k = 0; k < 3; ++k)
                for (const Triangle<Real>& other : {good, far}) {
                    Triangle<Real> t = good;
                    (corner == 0 ? t.a : corner == 1 ? t.b : t.c)[k] = bad;
                    EXPECT_EQ(TypeParam::intersect(t, other).answer, Answer::maybe);
                    EXPECT_EQ(TypeParam::intersect(other, t).answer, Answer::maybe);
                    EXPECT_EQ(TypeParam::intersect(t, t).answer, Answer::maybe);
                }
    const Real huge = std::numeric_limits<Real>::max() / 4;
    const Triangle<Real> h{{-huge, -huge, 0}, {huge, -huge, huge}, {0, huge, huge}};
    EXPECT_EQ(TypeParam::intersect(h, h).answer, Answer::maybe);
}

} // namespace
} // namespace boxwood
