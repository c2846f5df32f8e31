#include "kernels/arithmetic/float_mode.h"

#include <gtest/gtest.h>

#include <limits>

namespace boxwood {
namespace {

constexpr double tiny = 0x1p-1000;

/// Read again each time, so that nothing is folded or hoisted.
double opaque(double x) {
    volatile double v = x;
    return v;
}

TEST(FloatMode, FlushingIsSeenAndRestored) {
    EXPECT_FALSE(flushes_denormals());
    EXPECT_GT(opaque(tiny) * opaque(0x1p-60), 0);
    {
        const DenormalFlushing on(true);
        if (float_mode::flushing == 0)
            GTEST_SKIP() << "no flushing known on this processor";
        EXPECT_TRUE(flushes_denormals());
        EXPECT_EQ(opaque(tiny) * opaque(0x1p-60), 0);
        {
            const DenormalFlushing off(false);
            EXPECT_GT(opaque(tiny) * opaque(0x1p-60), 0);
        }
        EXPECT_TRUE(flushes_denormals());
    }
    EXPECT_FALSE(flushes_denormals());
    EXPECT_GT(opaque(tiny) * opaque(0x1p-60), 0);
}

/// The product is loop-invariant and its operands are known at the call: what a compiler would move
/// out of it, if it could see into it.
double product_of(double a, double b) {
    return without_flushing([&] { return a * b; });
}

TEST(FloatMode, DenormalsSurviveInside) {
    for (const bool on : {false, true, false}) {
        const DenormalFlushing mode(on);
        EXPECT_EQ(product_of(opaque(tiny), opaque(0x1p-60)), 0x1p-1060);
        EXPECT_EQ(product_of(opaque(0x1p-1060), opaque(0x1p60)), tiny);
        const double a = opaque(tiny), b = opaque(0x1p-60);
        double sum = 0;
        for (int i = 0; i < 4; ++i)
            sum = without_flushing([&] { return sum + a * b; });
        EXPECT_EQ(without_flushing([&] { return sum * 0x1p100; }), 0x1p-958);
        EXPECT_EQ(flushes_denormals(), on && float_mode::flushing != 0);
    }
}

TEST(FloatMode, HandsBackReferencesAndNothing) {
    int n = 3;
    for (const bool on : {false, true}) {
        const DenormalFlushing mode(on);
        without_flushing([&]() -> int& { return n; }) += 2;
        without_flushing([&] { ++n; });
    }
    EXPECT_EQ(n, 9);
}

} // namespace
} // namespace boxwood
