#include "kernels/boxes/fit.h"

#include "kernels/oracle/exact_answers.h"
#include "kernels/oracle/exact_vector.h"
#include "kernels/testing/poses.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace boxwood {
namespace {

static_assert(BoxFitKernel<PlainFit<float>> && BoxFitKernel<PlainFit<double>>);
static_assert(BoxFitKernel<PaddedFit<float>> && BoxFitKernel<PaddedFit<double>>);

template <class Real>
oracle::RationalBox image(const RigidTransform<Real>& t, const Aabb<Real>& b) {
    const auto wide = [](Vec3<Real> v) { return static_cast<Vec3<double>>(v); };
    return oracle::image(
        {{wide(t.rotation[0]), wide(t.rotation[1]), wide(t.rotation[2])}, wide(t.translation)},
        {wide(b.min), wide(b.max)});
}

template <class Real> bool contains(const Aabb<Real>& box, const oracle::RationalBox& exact) {
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (std::isnan(box.min[i]) || std::isnan(box.max[i]) ||
            (std::isfinite(box.min[i]) && oracle::exact(box.min[i]) > exact.min[k]) ||
            (std::isfinite(box.max[i]) && oracle::exact(box.max[i]) < exact.max[k]) ||
            box.min[i] == Aabb<Real>::inf || box.max[i] == -Aabb<Real>::inf)
            return false;
    }
    return true;
}

template <class Real> class BoxFit : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(BoxFit, Reals);

template <class Real> RigidTransform<Real> random_transform(RandomPoses& random, double far) {
    return {rounded<Real>(random.rotation()), static_cast<Vec3<Real>>(random.vector(far))};
}
template <class Real> Aabb<Real> random_box(RandomPoses& random, double far, double size) {
    const Vec3<double> p = random.vector(far), e = random.vector(size);
    Aabb<Real> box;
    box.extend(static_cast<Vec3<Real>>(p - e));
    box.extend(static_cast<Vec3<Real>>(p + e));
    if (random.bits() % 4 == 0)
        box.max.x = box.min.x; // flat
    if (random.bits() % 16 == 0)
        box.max = box.min;
    return box;
}

// Rotating boxes against their rational corner boxes: family 35.
TYPED_TEST(BoxFit, HoldsTheExactImage) {
    using Real = TypeParam;
    RandomPoses random(1);
    int plain_short = 0;
    for (int i = 0; i < 8000; ++i) {
        const double far = std::exp2(random.whole(-8, 8));
        const auto t = random_transform<Real>(random, far);
        const auto box = random_box<Real>(random, std::exp2(random.whole(-8, 8)), 1);
        const auto exact = image(t, box);
        const Aabb<Real> padded = fit(t, box);
        ASSERT_TRUE(contains(padded, exact)) << i;
        plain_short += !contains(PlainFit<Real>::fit(t, box), exact);
        // And it is no larger than it says: 8uA, and up to 8uA of rounding the other way.
        const Vec3<Real> max_corner = max(magnitudes(box.min), magnitudes(box.max));
        for (int k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(k);
            const double all = static_cast<double>(
                2 * dot(magnitudes(t.rotation[axis]), max_corner) + std::abs(t.translation[k]));
            const double sixteen_u = 8 * static_cast<double>(std::numeric_limits<Real>::epsilon());
            const mpq_class excess = oracle::exact(padded.max[k]) - exact.max[axis];
            ASSERT_LE(excess.get_d(), 1.01 * sixteen_u * all);
        }
    }
    EXPECT_GT(plain_short, 2000); // the test can tell
}

// Numbers of every size, also such as no rotation has; denormals flushed by the caller or not.
TYPED_TEST(BoxFit, HoldsTheImageOfAnyFiniteInput) {
    using Real = TypeParam;
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    RandomPoses random(2);
    const auto number = [&] {
        for (;;) {
            const auto bits = static_cast<Bits>(random.bits());
            const Real x = std::bit_cast<Real>(bits);
            const auto kind = random.bits() % 8;
            if (kind == 0)
                return Real(0);
            if (kind == 1) // denormal
                return std::bit_cast<Real>(
                    static_cast<Bits>(bits & ~(std::bit_cast<Bits>(Aabb<Real>::inf))));
            if (kind < 5) // moderate
                return static_cast<Real>(random.any_size(-20, 20));
            if (std::isfinite(x))
                return x;
        }
    };
    const auto vector = [&] {
        const Real x = number(), y = number(), z = number();
        return Vec3<Real>{x, y, z};
    };
    for (int i = 0; i < 8000; ++i) {
        const RigidTransform<Real> t{{vector(), vector(), vector()}, vector()};
        Aabb<Real> box;
        box.extend(vector());
        if (i % 4)
            box.extend(vector());
        const auto exact = image(t, box);
        const Aabb<Real> got = fit(t, box);
        ASSERT_TRUE(contains(got, exact)) << i;
        const DenormalFlushing on(true);
        const Aabb<Real> flushed = fit(t, box);
        const DenormalFlushing off(false);
        ASSERT_EQ(flushed, got) << i;
    }
}

// Family 34: a million tiny rotations, never made orthonormal again.
TEST(BoxFitDrift, MatrixOfAMillionTinyRotations) {
    RandomPoses random(3);
    const Aabb<double> box{{-1, -0.5, 2}, {3, -0.5, 2.25}};
    const auto step = RandomPoses::rotation(random.unit_vector(), 1e-3);
    RigidTransform<double> t{{}, {0.1, 0.2, 0.3}};
    for (int i = 1; i <= 1'000'000; ++i) {
        t.rotation = product(step, t.rotation);
        if (i % 1000 == 0) {
            ASSERT_TRUE(contains(fit(t, box), image(t, box))) << i;
            const RigidTransform<float> t32{rounded<float>(t.rotation),
                                            static_cast<Vec3<float>>(t.translation)};
            const Aabb<float> box32{static_cast<Vec3<float>>(box.min),
                                    static_cast<Vec3<float>>(box.max)};
            ASSERT_TRUE(contains(fit(t32, box32), image(t32, box32))) << i;
        }
    }
}

TYPED_TEST(BoxFit, EmptyStaysEmpty) {
    using Real = TypeParam;
    RandomPoses random(4);
    const auto t = random_transform<Real>(random, 1);
    EXPECT_TRUE(fit(t, {}).is_empty());
    EXPECT_TRUE(PlainFit<Real>::fit(t, {}).is_empty());
    EXPECT_TRUE(fit(t, {{0, 1, 0}, {1, 0, 1}}).is_empty());
}

TYPED_TEST(BoxFit, BeyondTheNumbersIsInfinite) {
    using Real = TypeParam;
    constexpr Real inf = Aabb<Real>::inf, nan = std::numeric_limits<Real>::quiet_NaN(),
                   big = std::numeric_limits<Real>::max();
    const Aabb<Real> all{{-inf, -inf, -inf}, {inf, inf, inf}};
    const RigidTransform<Real> turn{{{{1, 1, 0}, {-1, 1, 0}, {0, 0, 1}}}, {}};
    const Aabb<Real> huge{{-big, -big, -1}, {big, big, 1}}, whole = fit(turn, huge);
    EXPECT_EQ(whole.min.x, -inf);
    EXPECT_EQ(whole.max.y, inf);
    EXPECT_GT(whole.min.z, -2);
    EXPECT_TRUE(fit(turn, all).contains(all));
    EXPECT_TRUE(fit(turn, {{0, 0, 0}, {inf, 1, 1}}).contains({{0, 0, 0}, {inf, 1, 1}}));
    for (int k = 0; k < 3; ++k) {
        Aabb<Real> spoilt{{0, 0, 0}, {1, 1, 1}};
        spoilt.max[k] = nan;
        EXPECT_EQ(fit(turn, spoilt), all);
        RigidTransform<Real> bad = turn;
        bad.translation[k] = nan;
        EXPECT_EQ(fit(bad, {{0, 0, 0}, {1, 1, 1}}).max[k], inf);
    }
}

} // namespace
} // namespace boxwood
