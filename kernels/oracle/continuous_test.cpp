#include "kernels/oracle/continuous.h"
#include "kernels/oracle/rational.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/oracle/exact_vector.h"
#include "kernels/testing/grid_hulls.h"

#include <gmp.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace boxwood::oracle {
namespace {

static_assert(ContinuousKernel<ExactContinuous>);

constexpr double inf = std::numeric_limits<double>::infinity();

enum class Kind { vertex_face, edge_edge };
constexpr std::array kinds{Kind::vertex_face, Kind::edge_edge};

Impact impact(Kind kind, const LinearMotion& motion) {
    const ExactContinuous exact;
    return kind == Kind::vertex_face ? exact.vertex_face(motion) : exact.edge_edge(motion);
}

/// Four points on a grid of integers at the start and at the end.
struct GridMotion {
    std::array<Grid, 4> start, end;

    LinearMotion doubles(double scale = 1) const {
        LinearMotion motion;
        for (std::size_t i = 0; i < 4; ++i) {
            motion.start[i] = point(start[i]) * scale;
            motion.end[i] = point(end[i]) * scale;
        }
        return motion;
    }
    RationalMotion rational(const mpq_class& scale) const {
        RationalMotion motion;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                motion.start[i][axis] = scale * mpq_class(static_cast<long>(start[i][axis]));
                motion.end[i][axis] = scale * mpq_class(static_cast<long>(end[i][axis]));
            }
        return motion;
    }
    /// At t = k / n, times n: whether the hulls of the features share a point.
    bool touch_at(Kind kind, std::int64_t k, std::int64_t n) const {
        std::vector<Grid> p(4);
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[i][axis] = (n - k) * start[i][axis] + k * end[i][axis];
        const std::ptrdiff_t first = kind == Kind::vertex_face ? 1 : 2;
        return hull_to_hull({p.begin(), p.begin() + first}, {p.begin() + first, p.end()}).num == 0;
    }
};

/// Points of [0, side]^3; every fourth motion keeps to a plane, some of these to a line,
/// some rest.
GridMotion random_motion(std::mt19937_64& random, int side) {
    GridMotion motion;
    for (auto* points : {&motion.start, &motion.end}) {
        const std::vector<Grid> p = random_points(random, 4, side);
        std::copy(p.begin(), p.end(), points->begin());
    }
    const auto degenerate = random() % 16;
    if (degenerate < 4)
        for (auto* points : {&motion.start, &motion.end})
            for (Grid& g : *points) {
                if (degenerate == 0)
                    g[1] = 2 * g[0];
                g[2] = g[0] + g[1];
            }
    if (degenerate == 4 || degenerate == 0)
        for (std::size_t i = 0; i < 4; ++i)
            if (random() % 2 != 0 || degenerate == 4)
                motion.end[i] = motion.start[i];
    return motion;
}

/// The fraction with the least denominator in [from, to], 0 <= from (Stern-Brocot).
mpq_class simplest_between(const mpq_class& from, const mpq_class& to) {
    const mpz_class whole = from.get_num() / from.get_den();
    if (whole == from || mpq_class(whole + 1) <= to)
        return whole == from ? mpq_class(whole) : mpq_class(whole + 1);
    return whole + 1 / simplest_between(1 / mpq_class(to - whole), 1 / mpq_class(from - whole));
}

TEST(ExactContinuous, FindsEveryTouchOfDenseSampling) {
    // What touches at a sample must be found, and not later than it.
    constexpr std::int64_t n = 48; // thirds, and powers of two to a sixteenth
    std::mt19937_64 random(7);
    int hits = 0, seen = 0;
    for (int i = 0; i < 1000; ++i) {
        const GridMotion motion = random_motion(random, 1 + i % 4);
        for (const Kind kind : kinds) {
            const Impact answer = impact(kind, motion.doubles());
            ASSERT_NE(answer.answer, Answer::maybe);
            hits += answer.answer == Answer::yes;
            std::int64_t first = 0;
            while (first <= n && !motion.touch_at(kind, first, n))
                ++first;
            if (first > n)
                continue;
            ++seen;
            ASSERT_EQ(answer.answer, Answer::yes) << i;
            EXPECT_LE(exact(answer.t_free), mpq_class(static_cast<long>(first), n)) << i;
        }
    }
    EXPECT_GT(seen, 300);
    EXPECT_GT(hits, seen); // some touch only between samples
}

TEST(ExactContinuous, SaysATouchOnlyWhereThereIsOne) {
    // Where the first touch may be a fraction with a small denominator, it is that: the cubics of
    // this grid have no irrational root so near to one. The hulls touch then, not a little earlier.
    std::mt19937_64 random(11);
    int rational = 0, hits = 0;
    for (int i = 0; i < 3000; ++i) {
        const GridMotion motion = random_motion(random, 1 + i % 3);
        for (const Kind kind : kinds) {
            const Impact answer = impact(kind, motion.doubles());
            if (answer.answer != Answer::yes)
                continue;
            ++hits;
            const mpq_class t = simplest_between(exact(answer.t_free), exact(answer.t_hit));
            if (t.get_den() > 30) // the reference keeps to 128 bits
                continue;
            ++rational;
            const std::int64_t k = t.get_num().get_si(), n = t.get_den().get_si();
            EXPECT_TRUE(motion.touch_at(kind, k, n)) << i << " " << t;
            for (const std::int64_t before : {1, 2, 5, 15})
                if (const std::int64_t at = 16 * k - before; at >= 0) {
                    EXPECT_FALSE(motion.touch_at(kind, at, 16 * n)) << i << " " << t;
                }
        }
    }
    EXPECT_GT(rational, 800);
    EXPECT_GT(hits, rational);
}

TEST(ExactContinuous, RationalPointsAndScalesChangeNothing) {
    std::mt19937_64 random(13);
    for (int i = 0; i < 150; ++i) {
        const GridMotion motion = random_motion(random, 3);
        for (const Kind kind : kinds) {
            const Impact expected = impact(kind, motion.doubles());
            const auto same = [&](const Impact& other) {
                return other.answer == expected.answer && other.t_free == expected.t_free &&
                       other.t_hit == expected.t_hit && other.tier == expected.tier;
            };
            for (const double scale : {0x1p-1074, 0x1p-500, -0x1p1020})
                EXPECT_TRUE(same(impact(kind, motion.doubles(scale)))) << i << " " << scale;
            const RationalMotion thirds = motion.rational(mpq_class(-5, 3));
            EXPECT_TRUE(same(kind == Kind::vertex_face ? vertex_face(thirds) : edge_edge(thirds)));
            const LinearMotion tiny = motion.doubles(0x1p-1074);
            const DenormalFlushing on(true);
            EXPECT_TRUE(same(impact(kind, tiny)));
        }
    }
}

TEST(ExactContinuous, TouchesAtTheEndsAndOneUnitShortOfIt) {
    // A vertex falls onto an edge of the face, which tilts, and an edge onto the end of another.
    LinearMotion fall{{{{1, 0, 1}, {0, 0, 0}, {2, 0, 0}, {0, 3, 0}}},
                      {{{1, 0, 0}, {0, 0, 0}, {2, 0, 0}, {0, 3, -5}}}};
    LinearMotion drop{{{{1, -1, 1}, {1, 1, 1}, {1, 0, 0}, {4, 0, 0}}},
                      {{{1, -1, 0}, {1, 1, 0}, {1, 0, 0}, {4, 0, -1}}}};
    for (LinearMotion* motion : {&fall, &drop}) {
        const Kind kind = motion == &fall ? Kind::vertex_face : Kind::edge_edge;
        Impact answer = impact(kind, *motion);
        EXPECT_EQ(answer.answer, Answer::yes);
        EXPECT_EQ(answer.t_free, 1);
        EXPECT_EQ(answer.t_hit, 1);
        std::swap(motion->start, motion->end);
        answer = impact(kind, *motion);
        EXPECT_EQ(answer.answer, Answer::yes);
        EXPECT_EQ(answer.t_hit, 0);
        std::swap(motion->start, motion->end);
        motion->end[0].z = motion->end[kind == Kind::vertex_face ? 0 : 1].z = 0x1p-1074;
        answer = impact(kind, *motion);
        EXPECT_EQ(answer.answer, Answer::no);
        EXPECT_EQ(answer.t_free, 1);
        EXPECT_EQ(answer.t_hit, inf);
    }
}

TEST(ExactContinuous, DoubleRootsAreSeen) {
    // With s = 2 t - 1, the first edge has height s x / 2 + lift and y = s; the second stays at
    // height 0 with x = s: above each other at height s^2 / 2 + lift.
    const auto graze = [](double lift) {
        return LinearMotion{{{{-2, -1, 1 + lift}, {2, -1, -1 + lift}, {-1, -4, 0}, {-1, 4, 0}}},
                            {{{-2, 1, -1 + lift}, {2, 1, 1 + lift}, {1, -4, 0}, {1, 4, 0}}}};
    };
    const Impact on = impact(Kind::edge_edge, graze(0));
    EXPECT_EQ(on.answer, Answer::yes);
    EXPECT_EQ(on.t_free, 0.5);
    EXPECT_EQ(on.t_hit, 0.5);
    EXPECT_EQ(impact(Kind::edge_edge, graze(0x1p-52)).answer, Answer::no);
    const Impact crossing = impact(Kind::edge_edge, graze(-0x1p-51));
    EXPECT_EQ(crossing.answer, Answer::yes);
    EXPECT_EQ(crossing.t_free, 0.5 - 0x1p-26);
    EXPECT_EQ(crossing.t_hit, 0.5 - 0x1p-26);
}

TEST(ExactContinuous, NothingMovesAndAllCoplanar) {
    const std::array<Vec3<double>, 4> on_edge{{{1, 1, 0}, {0, 2, 0}, {2, 0, 0}, {0, 0, 0}}};
    const std::array<Vec3<double>, 4> outside{{{2, 1, 0}, {0, 2, 0}, {2, 0, 0}, {0, 0, 0}}};
    const std::array<Vec3<double>, 4> collapsed{{{1, 1, 1}, {3, 3, 3}, {0, 0, 0}, {2, 2, 2}}};
    EXPECT_EQ(impact(Kind::vertex_face, {on_edge, on_edge}).t_hit, 0);
    EXPECT_EQ(impact(Kind::vertex_face, {outside, outside}).answer, Answer::no);
    EXPECT_EQ(impact(Kind::vertex_face, {collapsed, collapsed}).answer, Answer::yes);
    // In one plane: from outside through the edge x + y = 2 at t = 1/2.
    LinearMotion slide{outside, outside};
    slide.end[0] = {1, 0, 0};
    const Impact answer = impact(Kind::vertex_face, slide);
    EXPECT_EQ(answer.answer, Answer::yes);
    EXPECT_EQ(answer.t_free, 0.5);
    EXPECT_EQ(answer.t_hit, 0.5);
    EXPECT_EQ(answer.tier, 2);
    // On one line, (0, 1) against (3, 4) at speed 5: at t = 2/5.
    const LinearMotion line{{{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {4, 4, 4}}},
                            {{{5, 5, 5}, {6, 6, 6}, {3, 3, 3}, {4, 4, 4}}}};
    const Impact meet = impact(Kind::edge_edge, line);
    EXPECT_EQ(meet.answer, Answer::yes);
    EXPECT_LT(exact(meet.t_free), mpq_class(2, 5));
    EXPECT_GT(exact(meet.t_hit), mpq_class(2, 5));
}

/// The bytes that GMP asks for: work that is the same on every machine.
std::size_t bytes_asked = 0;
std::size_t bytes_for(Kind kind, const LinearMotion& motion) {
    void* (*allocate)(std::size_t);
    void* (*reallocate)(void*, std::size_t, std::size_t);
    void (*release)(void*, std::size_t);
    mp_get_memory_functions(&allocate, &reallocate, &release);
    mp_set_memory_functions(
        [](std::size_t n) {
            bytes_asked += n;
            return std::malloc(n);
        },
        [](void* p, std::size_t, std::size_t n) {
            bytes_asked += n;
            return std::realloc(p, n);
        },
        [](void* p, std::size_t) { std::free(p); });
    bytes_asked = 0;
    impact(kind, motion);
    mp_set_memory_functions(allocate, reallocate, release);
    return bytes_asked;
}

TEST(ExactContinuous, CoordinatesOfAllOctavesTakeLittleWork) {
    // Found by the fuzzers: roots and signs that are decided some 1000 to 4000 binary digits deep.
    // Halved cell by cell they asked for 27, 107, 93 and 58 MB; now for 0.5, 0.9, 5.4 and 0.4.
    constexpr double d = 0x1p-1074, e = 0x1p-52;
    const LinearMotion edges{{{{d, 0, 0}, {5, -14 - 48 * e, 0}, {0, 0, 0}, {0, 2, 0}}},
                             {{{0, 1, 0}, {d, -1, 0}, {-2, 0, 0}, {0, 0, 0}}}};
    const LinearMotion more_edges{{{{d, d, 0}, {0, -16, 0}, {0, 0, 0}, {-1 - 6 * e, 0, 0}}},
                                  {{{-16, 0, 0}, {0, 0, 0}, {d, -4 - 8 * e, 0}, {0, 0, 0}}}};
    const LinearMotion faces{{{{3 + 8 * e, 0, 0}, {0, 1 + e, 1}, {d, 0, 0}, {d, 0, 2 * d}}},
                             {{{0, 0, 0}, {3 * d, 0, 0}, {0, 3 * d, 0}, {d, 0, -1 - 4 * e}}}};
    const LinearMotion more_faces{
        {{{1, 1, d}, {0, d, 11 + 32 * e}, {0, 4 + 4 * e, 1 + 6 * e}, {0, -16, 0}}},
        {{{3 + 8 * e, 0, 2 * d}, {0, 0, 0}, {3 * d, 0, -1 - 3 * e}, {0, 4 * d, 0}}}};
    EXPECT_LT(bytes_for(Kind::edge_edge, edges), 2'000'000u);
    EXPECT_LT(bytes_for(Kind::edge_edge, more_edges), 2'000'000u);
    EXPECT_LT(bytes_for(Kind::vertex_face, faces), 8'000'000u);
    EXPECT_LT(bytes_for(Kind::vertex_face, more_faces), 2'000'000u);
}

TEST(ExactContinuous, NotANumberIsMaybe) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), inf, -inf}) {
        LinearMotion motion{};
        motion.end[3].y = bad;
        EXPECT_EQ(impact(Kind::vertex_face, motion).answer, Answer::maybe);
        EXPECT_EQ(impact(Kind::edge_edge, motion).answer, Answer::maybe);
    }
}

} // namespace
} // namespace boxwood::oracle
