#include "kernels/continuous/tight_inclusion.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/features/point_triangle.h"
#include "kernels/features/segment_segment.h"
#include "kernels/oracle/rational.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace boxwood {
namespace {

using Vector = Vec3<double>;

static_assert(ContinuousKernel<TightInclusion>);

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr bool both_kinds[] = {true, false};

template <class Kernel> Impact impact(const Kernel& kernel, bool is_face, const LinearMotion& m) {
    return is_face ? kernel.vertex_face(m) : kernel.edge_edge(m);
}

template <class F> void for_each_coordinate(LinearMotion& m, F&& f) {
    for (auto* points : {&m.start, &m.end})
        for (Vector& p : *points)
            for (int axis = 0; axis < 3; ++axis)
                f(p[axis]);
}

/// Motions with small whole coordinates, in 8 ways: most of their touches are degenerate.
class Motions {
  public:
    explicit Motions(unsigned seed) : bits_(seed) {}

    LinearMotion next(int way) {
        LinearMotion m;
        const int high = way == 0 ? 1 : 3;
        for_each_coordinate(m, [&](double& x) { x = whole(-high, high); });
        switch (way) {
        case 1: // around touches, by a few units in the last place
            for_each_coordinate(m, [&](double& x) {
                x *= 0.1;
                if (whole(0, 1) == 0)
                    x = std::nextafter(x, whole(-1, 1));
            });
            break;
        case 2: // nothing moves
            m.end = m.start;
            break;
        case 3: // one feature moves without turning
            m.end = m.start;
            m.end[0] = m.start[0] + Vector{4, double(whole(-3, 3)), 1};
            if (whole(0, 1) == 0)
                m.end[1] = m.start[1] + (m.end[0] - m.start[0]);
            break;
        case 4: // coplanar all the time
            for (auto* points : {&m.start, &m.end})
                for (Vector& p : *points)
                    p.z = p.x + 2 * p.y;
            break;
        case 5: // on one line
            for (auto* points : {&m.start, &m.end})
                for (Vector& p : *points)
                    p = {p.x, 2 * p.x, -p.x};
            break;
        case 6: // edges that turn while they slide along each other
            m.start = {{{-1, 0, 0}, {1, 0, 0}, {real(), -1, 0}, {0, 1, 0}}};
            m.end = {{{-1, real(), real()}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}}};
            m.start[3].x = m.start[2].x;
            for (const std::size_t i : {2u, 3u}) {
                m.end[i].x = -m.start[i].x;
                m.start[i].z = m.end[i].z = std::ldexp(1, -whole(3, 40));
            }
            m.end[1].y = -m.end[0].y;
            m.end[1].z = -m.end[0].z;
            break;
        case 7: // anywhere
            for_each_coordinate(m, [&](double& x) { x = real(); });
            break;
        default:
            break;
        }
        return m;
    }
    static constexpr int ways = 8;

  private:
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(bits_); }
    double real() { return std::uniform_real_distribution<double>(-1, 1)(bits_); }
    std::mt19937_64 bits_;
};

TEST(TightInclusion, NeverMissesAndProvesWhatItSays) {
    constexpr double tolerances[] = {1e-6, 0, 0.5};
    int hits = 0, proven[3] = {}, apart[3] = {}, undecided[3] = {};
    Motions motions(1);
    for (int i = 0; i < 2400; ++i) {
        const LinearMotion m = motions.next(i % Motions::ways);
        for (const bool is_face : both_kinds) {
            const Impact truth = impact(oracle::ExactContinuous{}, is_face, m);
            hits += truth.answer == Answer::yes;
            for (int k = 0; k < 3; ++k) {
                TightInclusion kernel;
                kernel.tolerance = tolerances[k];
                const Impact said = impact(kernel, is_face, m);
                ASSERT_LE(said.t_free, truth.t_hit) << i;
                if (truth.answer == Answer::yes) {
                    ASSERT_NE(said.answer, Answer::no) << i;
                    ASSERT_GE(said.t_hit, truth.t_free) << i;
                } else {
                    ASSERT_NE(said.answer, Answer::yes) << i;
                }
                ASSERT_NE(said.tier, 3) << i;
                proven[k] += said.answer == Answer::yes;
                apart[k] += said.answer == Answer::no;
                undecided[k] += said.answer == Answer::maybe && truth.answer == Answer::no;
            }
        }
    }
    EXPECT_GT(hits, 1200);
    for (int k = 0; k < 2; ++k) {
        EXPECT_GT(proven[k], 300);
        EXPECT_GT(apart[k], 2400);
        EXPECT_LT(undecided[k], 60); // those within rounding of a touch
    }
    EXPECT_GT(proven[2], 150);
    EXPECT_GT(apart[2], 1500);
}

TEST(TightInclusion, TheIntervalIsTight) {
    // On ordinary input both ends are within the tolerance, and a good deal less, of the touch.
    std::mt19937_64 bits(3);
    std::uniform_real_distribution<double> real(-1, 1);
    int hits = 0;
    for (int i = 0; i < 3000; ++i) {
        LinearMotion m;
        for_each_coordinate(m, [&](double& x) { x = real(bits); });
        for (const bool is_face : both_kinds) {
            const Impact said = impact(TightInclusion{}, is_face, m);
            if (said.answer == Answer::no)
                continue;
            ++hits;
            EXPECT_EQ(said.answer, Answer::yes) << i;
            EXPECT_LT(said.t_hit - said.t_free, 1e-6) << i;
        }
    }
    EXPECT_GT(hits, 500);
}

TEST(TightInclusion, EveryScaleIsTheSame) {
    Motions motions(5);
    for (int i = 0; i < 800; ++i) {
        TightInclusion kernel;
        if (i % 2 == 0)
            kernel.tolerance = 0;
        const LinearMotion m = motions.next(i / 2 % 6);
        for (const bool is_face : both_kinds) {
            const Impact expected = impact(kernel, is_face, m);
            for (const int k : {-1074, -1060, -900, -40, 40, 900, 1020}) {
                if (k < -1000 && i / 2 % 6 == 1)
                    continue; // not exact there
                LinearMotion scaled = m;
                for_each_coordinate(scaled, [&](double& x) { x = std::ldexp(x, k); });
                for (const bool flush : {false, true}) {
                    const DenormalFlushing mode(flush);
                    const Impact said = impact(kernel, is_face, scaled);
                    EXPECT_EQ(said.answer, expected.answer) << i << " " << k;
                    EXPECT_EQ(said.t_free, expected.t_free) << i << " " << k;
                    EXPECT_EQ(said.t_hit, expected.t_hit) << i << " " << k;
                }
            }
        }
    }
}

TEST(TightInclusion, HugeAndDenormalInOneMotion) {
    // A denormal gap that a huge motion does not close, and one that it does.
    LinearMotion m{{{{0, 0, 0x1p-1074}, {-0x1p1023, -1, 0}, {0x1p1023, -1, 0}, {0, 0x1p1023, 0}}},
                   {{{0, 0, 0x1p-1074}, {-0x1p1023, -1, 0}, {0x1p1023, -1, 0}, {0, 0x1p1023, 0}}}};
    EXPECT_EQ(TightInclusion{}.vertex_face(m).answer, Answer::no); // by comparisons alone
    m.end[0].z = 0;
    EXPECT_NE(TightInclusion{}.vertex_face(m).answer, Answer::no);
    m.end[0].z = -0x1p1023;
    EXPECT_NE(TightInclusion{}.vertex_face(m).answer, Answer::no);
}

TEST(TightInclusion, TouchesAtTheEnds) {
    const LinearMotion fall{{{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                            {{{.25, .25, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
    const Impact at_end = TightInclusion{}.vertex_face(fall);
    EXPECT_NE(at_end.answer, Answer::no);
    EXPECT_GT(at_end.t_free, 1 - 1e-12);
    const LinearMotion rise{fall.end, fall.start};
    const Impact at_start = TightInclusion{}.vertex_face(rise);
    EXPECT_NE(at_start.answer, Answer::no);
    EXPECT_EQ(at_start.t_free, 0);
}

TEST(TightInclusion, ToleranceBuysWork) {
    // Edges that slide along each other 2^-30 apart while one of them turns: a looser tolerance
    // gives up earlier, never with a later t_free.
    int given_up_before = 0;
    for (const double tolerance : {0.0, 1e-12, 1e-6, 1e-3, 1.0}) {
        TightInclusion kernel;
        kernel.tolerance = tolerance;
        Motions same(7);
        int given_up = 0;
        for (int i = 0; i < 300; ++i) {
            const Impact said = kernel.edge_edge(same.next(i % 2 == 0 ? 6 : 7));
            given_up += said.answer == Answer::maybe;
        }
        EXPECT_GE(given_up, given_up_before) << tolerance;
        given_up_before = given_up;
    }
    EXPECT_GT(given_up_before, 30);
}

TEST(TightInclusion, KeepsASeparation) {
    const auto apart = [](bool is_face, const LinearMotion& m, double t) {
        std::array<Vector, 4> p;
        for (std::size_t k = 0; k < 4; ++k)
            p[k] = m.start[k] * (1 - t) + m.end[k] * t;
        return is_face ? PointTriangleCross::distance(p[0], {p[1], p[2], p[3]}).distance
                       : SegmentSegmentCross::distance({p[0], p[1]}, {p[2], p[3]}).distance;
    };
    Motions motions(11);
    int free = 0, stopped = 0;
    for (int i = 0; i < 1600; ++i) {
        const LinearMotion m = motions.next(i % Motions::ways);
        for (const bool is_face : both_kinds)
            for (const double separation : {1e-9, 1e-3, .2}) {
                TightInclusion kernel;
                kernel.separation = separation;
                const Impact said = impact(kernel, is_face, m);
                ASSERT_NE(said.answer, Answer::yes);
                const bool is_free = said.answer == Answer::no;
                for (int k = 0; k < 32; ++k) {
                    const double t = said.t_free * k / (is_free ? 31 : 32);
                    if (is_free || t < said.t_free) {
                        EXPECT_GT(apart(is_face, m, t), separation * (1 - 1e-12) - 1e-14) << i;
                    }
                }
                free += is_free;
                if (!is_free && said.tier < 3) {
                    ++stopped;
                    EXPECT_LT(apart(is_face, m, said.t_free), separation + 1e-5) << i;
                }
            }
    }
    EXPECT_GT(free, 1000);
    EXPECT_GT(stopped, 1000);

    const LinearMotion fall{{{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                            {{{.25, .25, -1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}};
    TightInclusion kernel;
    kernel.separation = .25;
    EXPECT_NEAR(kernel.vertex_face(fall).t_free, .375, 1e-6);
    kernel.separation = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(kernel.vertex_face(fall).answer, Answer::maybe);
    EXPECT_EQ(kernel.vertex_face(fall).t_free, 0);
}

TEST(TightInclusion, LimitsAreConservative) {
    Motions motions(9);
    int limited = 0;
    for (int i = 0; i < 800; ++i) {
        const LinearMotion m = motions.next(i % Motions::ways);
        for (const bool is_face : both_kinds) {
            const Impact truth = impact(oracle::ExactContinuous{}, is_face, m);
            double before = 0;
            for (const std::size_t checks : {0, 1, 2, 5, 20}) {
                TightInclusion kernel;
                kernel.max_checks = checks;
                const Impact said = impact(kernel, is_face, m);
                EXPECT_LE(said.t_free, truth.t_hit);
                EXPECT_GE(said.t_free, before); // more work never loses ground
                before = said.t_free;
                if (truth.answer == Answer::yes) {
                    EXPECT_NE(said.answer, Answer::no);
                }
                if (said.tier == 3) {
                    EXPECT_EQ(said.answer, Answer::maybe);
                    EXPECT_EQ(said.t_hit, 1);
                    ++limited;
                }
            }
        }
    }
    EXPECT_GT(limited, 400);

    TightInclusion hurried;
    hurried.time_limit_s = 0;
    const Impact said = hurried.vertex_face({{{{.25, .25, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                                             {{{.25, .25, -1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}});
    EXPECT_EQ(said.answer, Answer::maybe);
    EXPECT_EQ(said.tier, 3);
    EXPECT_EQ(said.t_free, 0);
}

TEST(TightInclusion, NotANumberIsMaybe) {
    // Also where another axis would tell the boxes apart.
    LinearMotion apart{};
    apart.start[0] = apart.end[0] = {0, 0, 5};
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), inf, -inf})
        for (std::size_t i = 0; i < 24; ++i) {
            LinearMotion m = apart;
            std::size_t k = 0;
            for_each_coordinate(m, [&](double& x) { x = k++ == i ? bad : x; });
            for (const bool is_face : both_kinds) {
                const Impact said = impact(TightInclusion{}, is_face, m);
                EXPECT_EQ(said.answer, Answer::maybe);
                EXPECT_EQ(said.t_free, 0);
            }
        }
}

TEST(TightInclusion, AllInOnePlace) {
    const LinearMotion m{};
    for (const bool is_face : both_kinds)
        EXPECT_EQ(impact(TightInclusion{}, is_face, m).answer, Answer::maybe);
}

} // namespace
} // namespace boxwood
