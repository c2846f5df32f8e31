#include "kernels/boxes/sat.h"

#include "kernels/oracle/oracle.h"
#include "kernels/testing/poses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace boxwood {
namespace {

static_assert(ObbKernel<PlainSat<float>> && ObbKernel<PlainSat<double>>);
static_assert(ObbKernel<CertifiedSat<float>> && ObbKernel<CertifiedSat<double>>);

constexpr double inf = std::numeric_limits<double>::infinity();

template <class Real> bool truth(const Obb<Real>& a, const Obb<Real>& b) {
    const auto wide = [](const Obb<Real>& o) {
        return std::array{static_cast<Vec3<double>>(o.centre), static_cast<Vec3<double>>(o.axis[0]),
                          static_cast<Vec3<double>>(o.axis[1]),
                          static_cast<Vec3<double>>(o.axis[2])};
    };
    return oracle::boxes_touch(wide(a), static_cast<Vec3<double>>(a.half), wide(b),
                               static_cast<Vec3<double>>(b.half));
}

Obb<float> narrow(const Obb<double>& o) {
    return {static_cast<Vec3<float>>(o.centre), rounded<float>(o.axis),
            static_cast<Vec3<float>>(o.half)};
}

/// How often which answer was given, and how often it was wrong.
struct Count {
    std::map<Answer, int> said, wrong;
    void note(Answer answer, bool truth) {
        ++said[answer];
        wrong[answer] += answer == (truth ? Answer::no : Answer::yes);
    }
};
struct Counts {
    Count plain, certified, plain32, certified32;

    void note(const Obb<double>& a, const Obb<double>& b) {
        const bool touch = truth(a, b);
        plain.note(PlainSat<double>::overlap(a, b).answer, touch);
        certified.note(CertifiedSat<double>::overlap(a, b).answer, touch);
        const Obb<float> a32 = narrow(a), b32 = narrow(b);
        const bool touch32 = truth(a32, b32);
        plain32.note(PlainSat<float>::overlap(a32, b32).answer, touch32);
        certified32.note(CertifiedSat<float>::overlap(a32, b32).answer, touch32);
    }
    void expect_kept() {
        for (Count* c : {&certified, &certified32}) {
            EXPECT_EQ(c->wrong[Answer::no], 0) << "misses";
            EXPECT_EQ(c->wrong[Answer::yes], 0) << "false alarms";
        }
    }
};

Obb<double> random_box(RandomPoses& random, double thinnest = -3) {
    Obb<double> box;
    box.axis = random.rotation();
    for (int k = 0; k < 3; ++k)
        box.half[k] = std::exp2(random.real(thinnest, 0));
    return box;
}

/// Moves b so that a point of each, farthest that way on a and farthest the other way on b, are
/// `gap` apart, up to rounding. Along edges and faces square to the way (to 2^-20) any point will
/// do.
void set_apart(RandomPoses& random, const Obb<double>& a, Obb<double>& b, Vec3<double> way,
               double gap) {
    way = way * (1 / length(way));
    b.centre = a.centre + way * gap;
    for (const Obb<double>* o : {&a, static_cast<const Obb<double>*>(&b)})
        for (std::size_t k = 0; k < 3; ++k) {
            const double along = dot(o->axis[k], way), half = o->half[static_cast<int>(k)];
            const double reach = std::abs(along) < 0x1p-20 ? random.real(-half, half)
                                 : along > 0               ? half
                                                           : -half;
            b.centre = b.centre + o->axis[k] * reach;
        }
}

// Of the 15 directions one that parts the boxes when they are little apart.
Vec3<double> some_direction(RandomPoses& random, const Obb<double>& a, const Obb<double>& b) {
    const auto i = static_cast<std::size_t>(random.whole(0, 2)),
               j = static_cast<std::size_t>(random.whole(0, 2));
    const int kind = random.whole(0, 2);
    const Vec3<double> way = kind == 0   ? a.axis[i]
                             : kind == 1 ? b.axis[j]
                                         : cross(a.axis[i], b.axis[j]);
    return length(way) > 0 ? way : a.axis[i];
}

TEST(ObbSat, GenericBoxesAreDecided) {
    RandomPoses random(1);
    Counts counts;
    for (int i = 0; i < 4000; ++i) {
        const Obb<double> a = random_box(random);
        Obb<double> b = random_box(random);
        b.centre = random.vector(1.5);
        counts.note(a, b);
    }
    counts.expect_kept();
    EXPECT_EQ(counts.certified.said[Answer::maybe], 0);
    EXPECT_LT(counts.certified32.said[Answer::maybe], 5);
    EXPECT_GT(counts.certified.said[Answer::yes], 800);
    EXPECT_GT(counts.certified.said[Answer::no], 800);
}

TEST(ObbSat, BoxesThatTouchOrNearlySo) {
    RandomPoses random(2);
    Counts counts;
    for (int i = 0; i < 8000; ++i) {
        const Obb<double> a = random_box(random);
        Obb<double> b = random_box(random);
        const double gap = i % 3 == 0 ? 0 : random.any_size(-54, i % 2 ? -20 : -44);
        set_apart(random, a, b, some_direction(random, a, b), gap);
        if (i % 2) {
            const Vec3<double> far = random.vector(100);
            b.centre = b.centre + far;
            Obb<double> moved = a;
            moved.centre = far;
            counts.note(moved, b);
        } else {
            counts.note(a, b);
        }
    }
    counts.expect_kept();
    // The test can tell: without a margin some answers are wrong, both ways.
    EXPECT_GT(counts.plain.wrong[Answer::no], 100);
    EXPECT_GT(counts.plain.wrong[Answer::yes], 100);
    EXPECT_GT(counts.plain32.wrong[Answer::no], 100);
    EXPECT_LT(counts.certified.said[Answer::maybe], 6000);
}

// Axes of b those of a, turned by an angle down to nothing, and boxes a little apart or deep.
TEST(ObbSat, NearlyParallelAxes) {
    RandomPoses random(3);
    Counts counts;
    for (int i = 0; i < 8000; ++i) {
        const Obb<double> a = random_box(random, i % 4 ? -3 : -12);
        Obb<double> b = random_box(random);
        const double angle = i % 5 ? random.any_size(-58, -5) : 0;
        const auto turn = RandomPoses::rotation(
            i % 3 ? random.unit_vector() : a.axis[static_cast<std::size_t>(i / 3 % 3)], angle);
        const auto pose = product(a.axis, turn);
        b.axis = {pose[static_cast<std::size_t>(i % 3)],
                  pose[static_cast<std::size_t>((i + 1) % 3)],
                  -pose[static_cast<std::size_t>((i + 2) % 3)]};
        set_apart(random, a, b, some_direction(random, a, b), random.any_size(-54, -2));
        counts.note(a, b);
    }
    counts.expect_kept();
    EXPECT_GT(counts.certified.said[Answer::yes], 1000);
    EXPECT_GT(counts.certified.said[Answer::no], 1000);
    EXPECT_GT(counts.certified32.said[Answer::yes], 400);
}

// hard-cases.md 3.
TEST(ObbSat, KissingBoxes) {
    const std::array<Vec3<double>, 3> columns{
        {{.96193976625564348026, -.19134171618254486313, -.19509032201612822033},
         {.15401279915737359216, .96936494951283913579, -.19134171618254486313},
         {.22572537250328919556, .15401279915737359216, .96193976625564348026}}};
    RandomPoses random(8);
    Counts counts;
    for (const double dim : {.01, .25, .5, 10., 1000.})
        for (const double gap :
             {0., 1e-16, -1e-16, 2.5e-16, -2.5e-16, 1e-15, -1e-15, 1e-9, -1e-9}) {
            Obb<double> a{{2.0770063995786869349, .48468247475641951239, 1.1543291419087275962},
                          columns,
                          {dim / 2, dim / 2, dim / 2}};
            Obb<double> b = a;
            const double g = gap * std::max(1.0, dim);
            set_apart(random, a, b, -columns[1], g);
            counts.note(a, b);
            counts.note(b, a);
            if (std::abs(gap) == 1e-9) {
                EXPECT_EQ(CertifiedSat<double>::overlap(a, b).answer,
                          gap < 0 ? Answer::yes : Answer::no);
            }
        }
    counts.expect_kept();
}

// Family 41. An absolute margin of 1e-6 would swell these by 2e-3.
TEST(ObbSat, ThinBoxesAreNotSwollen) {
    RandomPoses random(4);
    Counts counts;
    for (int i = 0; i < 2000; ++i) {
        Obb<double> a;
        a.axis = random.rotation();
        a.half = i % 2 ? Vec3<double>{1e3, 1e3, 1e-3} : Vec3<double>{1e3, 1, 1};
        Obb<double> b = a;
        set_apart(random, a, b, a.axis[2], i % 4 < 2 ? 1e-9 : -1e-9);
        counts.note(a, b);
        EXPECT_EQ(CertifiedSat<double>::overlap(a, b).answer, i % 4 < 2 ? Answer::no : Answer::yes);
        // A corner of a tilted slab comes within the gap of the lying one's face.
        b.axis = product(a.axis, RandomPoses::rotation(random.unit_vector(), random.real(0, 3)));
        set_apart(random, a, b, some_direction(random, a, b), random.any_size(-45, -25));
        counts.note(a, b);
    }
    counts.expect_kept();
}

// On whole numbers with axes along the coordinates nothing rounds.
TEST(ObbSat, AlignedBoxesOnAGrid) {
    RandomPoses random(5);
    const auto box = [&](Aabb<double>& bounds) {
        Obb<double> o;
        const auto x = static_cast<std::size_t>(random.whole(0, 2));
        const std::array<Vec3<double>, 3> unit{{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};
        o.axis = {unit[x], unit[(x + 1) % 3], unit[(x + 2) % 3]};
        Vec3<double> reach{};
        for (std::size_t k = 0; k < 3; ++k) {
            o.half[static_cast<int>(k)] = random.whole(0, 2);
            o.centre[static_cast<int>(k)] = random.whole(-3, 3);
            for (int c = 0; c < 3; ++c)
                reach[c] += std::abs(o.axis[k][c]) * o.half[static_cast<int>(k)];
        }
        bounds = {o.centre - reach, o.centre + reach};
        return o;
    };
    int touching = 0;
    for (int i = 0; i < 8000; ++i) {
        Aabb<double> bounds_a, bounds_b;
        const Obb<double> a = box(bounds_a), b = box(bounds_b);
        const bool touch = overlaps(bounds_a, bounds_b);
        touching += touch;
        ASSERT_EQ(PlainSat<double>::overlap(a, b).answer, touch ? Answer::yes : Answer::no);
        const bool deep = bounds_a.min.x < bounds_b.max.x && bounds_b.min.x < bounds_a.max.x &&
                          bounds_a.min.y < bounds_b.max.y && bounds_b.min.y < bounds_a.max.y &&
                          bounds_a.min.z < bounds_b.max.z && bounds_b.min.z < bounds_a.max.z;
        ASSERT_EQ(CertifiedSat<double>::overlap(a, b).answer, deep    ? Answer::yes
                                                              : touch ? Answer::maybe
                                                                      : Answer::no);
    }
    EXPECT_GT(touching, 1200);
}

// Boxes without volume, and axes that are not orthonormal or not of unit length.
TEST(ObbSat, FlatBoxesAndPoorAxes) {
    RandomPoses random(6);
    Counts counts;
    for (int i = 0; i < 8000; ++i) {
        Obb<double> a = random_box(random), b = random_box(random);
        for (Obb<double>* o : {&a, &b}) {
            const double lack = i % 2 ? 0 : std::exp2(random.real(-50, -2));
            for (std::size_t k = 0; k < 3; ++k) {
                o->axis[k] = o->axis[k] + random.vector(lack);
                if (random.bits() % 3 == 0)
                    o->half[static_cast<int>(k)] = 0;
            }
        }
        if (i % 4 < 2)
            b.axis = a.axis;
        if (i % 8)
            set_apart(random, a, b, some_direction(random, a, b), random.any_size(-54, -4));
        counts.note(a, b);
    }
    counts.expect_kept();
}

// All lengths times a power of two: the same decisions, down to the denormals and up to 2^1000.
TEST(ObbSat, ScaledByPowersOfTwo) {
    RandomPoses random(7);
    for (int i = 0; i < 1500; ++i) {
        const Obb<double> a = random_box(random);
        Obb<double> b = random_box(random);
        set_apart(random, a, b, some_direction(random, a, b), random.any_size(-54, -20));
        const Decision decision = CertifiedSat<double>::overlap(a, b);
        for (const double scale : {0x1p-900, 0x1p+1000}) {
            Obb<double> c = a, d = b;
            for (Obb<double>* o : {&c, &d}) {
                o->centre = o->centre * scale;
                o->half = o->half * scale;
            }
            ASSERT_EQ(CertifiedSat<double>::overlap(c, d), decision) << i;
        }
        Obb<double> c = a, d = b; // here the coordinates themselves are rounded
        const double scale = std::exp2(random.real(-1074, -1015));
        for (Obb<double>* o : {&c, &d}) {
            o->centre = o->centre * scale;
            o->half = o->half * scale;
        }
        const Decision tiny = CertifiedSat<double>::overlap(c, d);
        ASSERT_NE(tiny.answer, truth(c, d) ? Answer::no : Answer::yes) << i;
        const DenormalFlushing on(true);
        const Decision flushed = CertifiedSat<double>::overlap(c, d);
        const DenormalFlushing off(false);
        ASSERT_EQ(flushed, tiny) << i;
    }
}

TEST(ObbSat, NaNAndInfinityAreMaybe) {
    const Obb<double> good;
    for (const double bad : {inf, -inf, std::nan("")})
        for (int k = 0; k < 3; ++k) {
            Obb<double> centre = good, half = good, axis = good;
            centre.centre[k] = bad;
            half.half[k] = std::abs(bad);
            axis.axis[1][k] = bad;
            for (const Obb<double>& o : {centre, half, axis}) {
                EXPECT_EQ(PlainSat<double>::overlap(o, good).answer, Answer::maybe);
                EXPECT_EQ(PlainSat<double>::overlap(good, o).answer, Answer::maybe);
                EXPECT_EQ(CertifiedSat<double>::overlap(o, good).answer, Answer::maybe);
                EXPECT_EQ(CertifiedSat<double>::overlap(good, o).answer, Answer::maybe);
            }
        }
    Obb<double> far;
    far.centre = {1e308, 1e308, 0};
    Obb<double> near = far;
    near.centre = -near.centre;
    EXPECT_EQ(CertifiedSat<double>::overlap(far, near).answer, Answer::maybe);
}

} // namespace
} // namespace boxwood
