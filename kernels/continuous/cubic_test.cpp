#include "kernels/continuous/cubic.h"

#include "kernels/oracle/rational.h"

#include <gtest/gtest.h>

#include <random>

namespace boxwood {
namespace {

static_assert(ContinuousKernel<CubicF64>);

TEST(CubicF64, IsRightOnOrdinaryMotions) {
    std::mt19937_64 bits(1);
    std::uniform_real_distribution<double> real(-1, 1);
    const CubicF64 cubic;
    const oracle::ExactContinuous exact;
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        LinearMotion m;
        for (auto* points : {&m.start, &m.end})
            for (Vec3<double>& p : *points)
                p = {real(bits), real(bits), real(bits)};
        for (const auto& [said, truth] : {std::pair{cubic.vertex_face(m), exact.vertex_face(m)},
                                          std::pair{cubic.edge_edge(m), exact.edge_edge(m)}}) {
            ASSERT_EQ(said.answer, truth.answer) << i;
            EXPECT_EQ(said.tier, 0);
            if (truth.answer == Answer::yes) {
                ++hits;
                EXPECT_NEAR(said.t_free, truth.t_free, 1e-9) << i;
                EXPECT_EQ(said.t_hit, said.t_free);
            }
        }
    }
    EXPECT_GT(hits, 200);
}

TEST(CubicF64, SeesTheFirstOfThreeCrossings) {
    // The vertex goes straight up; the plane of the face swings through it.
    const LinearMotion m{{{{.25, .25, -1}, {0, 0, -3}, {1, 0, 4}, {0, 1, 4}}},
                         {{{.25, .25, 1}, {0, 0, 3}, {1, 0, -4}, {0, 1, -4}}}};
    const Impact said = CubicF64{}.vertex_face(m);
    EXPECT_EQ(said.answer, Answer::yes);
    EXPECT_EQ(said.t_free, oracle::ExactContinuous{}.vertex_face(m).t_free);
}

TEST(CubicF64, IsBlindWhereTheCubicVanishes) {
    // Why it has no promise: these touch.
    const std::array<Vec3<double>, 4> on_face{{{.25, .25, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
    EXPECT_EQ(CubicF64{}.vertex_face({on_face, on_face}).answer, Answer::no);
    EXPECT_EQ(oracle::ExactContinuous{}.vertex_face({on_face, on_face}).answer, Answer::yes);
    LinearMotion slide{on_face, on_face};
    slide.start[0].x = -1;
    EXPECT_EQ(CubicF64{}.vertex_face(slide).answer, Answer::no);
    EXPECT_EQ(oracle::ExactContinuous{}.vertex_face(slide).answer, Answer::yes);
}

TEST(CubicF64, NotANumberIsMaybe) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        LinearMotion m{};
        m.start[2].z = bad;
        EXPECT_EQ(CubicF64{}.vertex_face(m).answer, Answer::maybe);
        EXPECT_EQ(CubicF64{}.edge_edge(m).answer, Answer::maybe);
    }
}

TEST(CubicF64, OverflowAndUnderflowDoNotCrash) {
    for (const double size : {0x1p-1074, 0x1p-700, 0x1p700, 0x1p1023}) {
        LinearMotion m;
        std::mt19937_64 bits(2);
        std::uniform_real_distribution<double> real(-1, 1);
        for (auto* points : {&m.start, &m.end})
            for (Vec3<double>& p : *points)
                p = {size * real(bits), size * real(bits), size * real(bits)};
        CubicF64{}.vertex_face(m);
        CubicF64{}.edge_edge(m);
    }
}

} // namespace
} // namespace boxwood
