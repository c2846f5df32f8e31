#include "kernels/triangle_triangle/guigue_devillers_batch.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/testing/every_target.h"
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

static_assert(TriangleBatchKernel<GuigueDevillersF32Batch>);
static_assert(TriangleBatchKernel<GuigueDevillersExactF32Batch>);
static_assert(TriangleBatchKernel<GuigueDevillersExactBatch>);
static_assert(!TriangleBatchKernel<GuigueDevillersF32>);
static_assert(GuigueDevillersF32Batch::info.promise == Promise::none);
static_assert(GuigueDevillersExactF32Batch::info.promise == Promise::exact);
static_assert(GuigueDevillersExactF32Batch::name == "guigue_devillers_exact_f32_batch");

template <class K> struct Blocks {
    using Real = typename K::Real;
    using Block = TrianglePairBlock<Real>;
    std::vector<Block> blocks;

    explicit Blocks(const std::vector<TrianglePair>& pairs)
        : blocks((pairs.size() + Block::lanes - 1) / Block::lanes) {
        for (std::size_t i = 0; i < pairs.size(); ++i)
            blocks[i / Block::lanes].set(i % Block::lanes, as<Real>(pairs[i].a),
                                         as<Real>(pairs[i].b));
    }
    std::vector<Decision> decisions(std::size_t n) const {
        constexpr Decision unwritten{Answer::maybe, 99};
        std::vector<Decision> all(n + 1, unwritten);
        K::intersect(blocks, {all.data(), n});
        EXPECT_EQ(all.back(), unwritten);
        all.pop_back();
        return all;
    }
};

template <class K> class Batch : public ::testing::Test {
  protected:
    static constexpr bool floats = std::is_same_v<typename K::Real, float>;
    static constexpr bool exact = K::info.promise == Promise::exact;
    static constexpr Kept kept = floats ? Kept::as_float : Kept::as_double;

    static PairFamilies families(std::uint64_t seed) { return PairFamilies(seed, kept); }

    /// The same decisions on every instruction set, with denormals flushed or not (if exact) and
    /// one by one. Returns them.
    static std::vector<Decision> decisions(const std::vector<TrianglePair>& pairs) {
        const Blocks<K> blocks(pairs);
        const std::vector<Decision> best = blocks.decisions(pairs.size());
        on_every_target([&] { EXPECT_EQ(blocks.decisions(pairs.size()), best); });
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const auto one =
                K::intersect(as<typename K::Real>(pairs[i].a), as<typename K::Real>(pairs[i].b));
            EXPECT_EQ(one, best[i]) << print(pairs[i]);
            if (one != best[i])
                break;
        }
        if (exact) {
            std::vector<Decision> flushed;
            {
                const DenormalFlushing mode(true);
                flushed = blocks.decisions(pairs.size());
            }
            EXPECT_EQ(flushed, best);
        }
        return best;
    }

    /// How many are wrong, maybe, and not decided by the first tier.
    struct Tally {
        std::size_t wrong = 0, maybe = 0, passed_up = 0;
    };
    static Tally judge(const std::vector<TrianglePair>& pairs) {
        Tally tally;
        const std::vector<Decision> said = decisions(pairs);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            const bool wrong = said[i].answer == (pairs[i].touch ? Answer::no : Answer::yes);
            if (wrong && tally.wrong == 0 && exact)
                ADD_FAILURE() << print(pairs[i]);
            tally.wrong += wrong;
            tally.maybe += said[i].answer == Answer::maybe;
            tally.passed_up += said[i].tier > 0;
        }
        return tally;
    }
};
using Kernels = ::testing::Types<GuigueDevillersF32Batch, GuigueDevillersExactF32Batch,
                                 GuigueDevillersExactBatch>;
TYPED_TEST_SUITE(Batch, Kernels);

TYPED_TEST(Batch, ExactOnSmallIntegers) {
    for (const int size : {1, 2, 8}) {
        const auto tally = this->judge(this->families(std::uint64_t(size)).grid(6000, size));
        EXPECT_EQ(tally.wrong, 0u) << size;
        EXPECT_EQ(tally.maybe, 0u) << size;
    }
}

/// All pairs of a triangle on [0,1]^3 with one that has a corner in the origin.
TYPED_TEST(Batch, ExactOnAllPairsOfTheUnitGrid) {
    const auto point = [](int i) {
        return Vec3<double>{double(i & 1), double(i >> 1 & 1), double(i >> 2)};
    };
    std::vector<TrianglePair> pairs;
    for (int i = 0; i < 8; ++i)
        for (int j = i; j < 8; ++j)
            for (int k = j; k < 8; ++k)
                for (int l = 0; l < 8; ++l)
                    for (int m = l; m < 8; ++m) {
                        TrianglePair pair{
                            {point(i), point(j), point(k)}, {point(0), point(l), point(m)}, false};
                        pair.touch = oracle::intersect(pair.a, pair.b);
                        pairs.push_back(pair);
                    }
    const auto tally = this->judge(pairs);
    EXPECT_EQ(tally.wrong, 0u);
    EXPECT_EQ(tally.maybe, 0u);
}

TYPED_TEST(Batch, GenericPairsNeedNoHelp) {
    const auto tally = this->judge(this->families(1).generic(20000));
    EXPECT_LE(tally.wrong, this->exact ? 0u : 5u);
    EXPECT_LE(tally.passed_up, 100u);
}

TYPED_TEST(Batch, NearTouch) {
    const auto pairs = this->families(1).nearly_touching(20000);
    const auto tally = this->judge(pairs);
    EXPECT_EQ(tally.maybe, 0u);
    if (this->exact) {
        EXPECT_EQ(tally.wrong, 0u);
        EXPECT_GT(tally.passed_up, pairs.size() / 10);
        EXPECT_LT(tally.passed_up, pairs.size() * 9 / 10);
    } else {
        EXPECT_GT(tally.wrong, pairs.size() / 200);
    }
}

TYPED_TEST(Batch, Magnitudes) {
    const int low = this->floats ? -149 : -1074, high = this->floats ? 127 : 1023;
    for (const auto& pairs :
         {this->families(1).magnitudes(4000, low, high),
          this->families(2).magnitudes(4000, -20, 20),
          this->families(3).magnitudes(4000, low / 3 - 20, low / 3 + 20),
          this->families(4).magnitudes(4000, high / 3 - 20, high / 3 + 20),
          this->families(5).magnitudes(2000, low, low + 60),
          this->families(6).magnitudes(2000, high - 40, high), this->families(7).grid(2000, 8, low),
          this->families(8).grid(2000, 8, high - 5), this->families(9).grid(2000, 60, low / 3),
          this->families(9).grid(2000, 60, high / 3)}) {
        const auto tally = this->judge(pairs);
        if (this->exact) {
            EXPECT_EQ(tally.wrong, 0u);
            EXPECT_EQ(tally.maybe, 0u);
        }
    }
}

TYPED_TEST(Batch, WritesNoMoreThanAsked) {
    const auto pairs = this->families(3).grid(40, 3);
    const Blocks<TypeParam> blocks(pairs);
    const std::vector<Decision> all = blocks.decisions(pairs.size());
    on_every_target([&] {
        for (std::size_t n = 0; n <= pairs.size(); ++n)
            EXPECT_EQ(blocks.decisions(n),
                      std::vector<Decision>(all.begin(), all.begin() + std::ptrdiff_t(n)));
    });
}

TYPED_TEST(Batch, MaybeForNanAndInfinity) {
    using Real = typename TypeParam::Real;
    const Triangle<Real> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Triangle<Real> across{{Real(.2), Real(.2), -1}, {Real(.3), Real(.2), 1}, {1, 1, 1}};
    const Triangle<Real> far{{0, 1, 9}, {1, 0, 8}, {0, 2, 9}};
    constexpr Real inf = std::numeric_limits<Real>::infinity(),
                   nan = std::numeric_limits<Real>::quiet_NaN();
    std::vector<Real> bad{nan};
    if (this->exact) // the kernel above the other one judges infinity as it can
        bad.insert(bad.end(), {inf, -inf});
    on_every_target([&] {
        for (const Real x : bad)
            for (int corner = 0; corner < 3; ++corner)
                for (int k = 0; k < 3; ++k)
                    for (const Triangle<Real>& other : {good, across, far}) {
                        Triangle<Real> t = across;
                        (corner == 0 ? t.a : corner == 1 ? t.b : t.c)[k] = x;
                        EXPECT_EQ(TypeParam::intersect(t, other).answer, Answer::maybe);
                        EXPECT_EQ(TypeParam::intersect(other, t).answer, Answer::maybe);
                        EXPECT_EQ(TypeParam::intersect(t, t).answer, Answer::maybe);
                    }
    });
}

} // namespace
} // namespace boxwood
