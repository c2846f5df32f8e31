#include "kernels/triangle_triangle/exact.h"

#include "kernels/arithmetic/float_mode.h"
#include "kernels/testing/triangle_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

using testing::PairFamilies;
using testing::TrianglePair;
using Point = Vec3<double>;

static_assert(TriangleKernel<GuigueDevillersExact>);
static_assert(TriangleKernel<GuigueDevillersFiltered>);
static_assert(GuigueDevillersExact::info.promise == Promise::exact);
static_assert(GuigueDevillersFiltered::info.promise == Promise::certified);

/// Of a wanted count, what is left where there are fewer pairs.
constexpr int at_least(int n) { return n / testing::thinned; }

Answer answer_of(bool touch) { return touch ? Answer::yes : Answer::no; }

/// How many pairs each tier decided, and how many the filtered kernel did.
struct Tally {
    std::array<int, 4> by_tier{};
    int filtered = 0, yes = 0, no = 0;
};

/// The exact kernel must be right and the filtered one not wrong, denormals flushed or not.
void judge(Tally& tally, const TrianglePair& pair) {
    const Answer expected = answer_of(pair.touch);
    (pair.touch ? tally.yes : tally.no)++;
    for (const bool flushing : {false, true}) {
        Decision exact, filtered;
        {
            const DenormalFlushing mode(flushing);
            exact = GuigueDevillersExact::intersect(pair.a, pair.b);
            filtered = GuigueDevillersFiltered::intersect(pair.a, pair.b);
        }
        ASSERT_EQ(exact.answer, expected) << testing::print(pair) << " flushing " << flushing;
        if (filtered.answer != Answer::maybe) {
            ASSERT_EQ(filtered.answer, expected)
                << testing::print(pair) << " flushing " << flushing;
        }
        if (!flushing) {
            tally.by_tier[exact.tier]++;
            tally.filtered += filtered.answer != Answer::maybe;
        }
    }
}

Tally judge(const std::vector<TrianglePair>& pairs) {
    Tally tally;
    for (const TrianglePair& pair : pairs) {
        judge(tally, pair);
        if (::testing::Test::HasFatalFailure())
            break;
    }
    return tally;
}

TEST(GuigueDevillersExact, GenericIsLeftToTheFilter) {
    const auto pairs = PairFamilies(1).generic(10000);
    const Tally tally = judge(pairs);
    EXPECT_GT(tally.filtered, static_cast<int>(pairs.size()) - 10);
    EXPECT_EQ(tally.by_tier[0], static_cast<int>(pairs.size()));
}

TEST(GuigueDevillersExact, Grids) {
    PairFamilies families(2);
    for (const int size : {1, 2, 8, 1000, 1 << 20}) {
        const Tally tally = judge(families.grid(4000, size));
        ASSERT_FALSE(HasFatalFailure());
        EXPECT_GT(std::min(tally.yes, tally.no), at_least(30)) << size;
    }
}

/// All that a small grid holds, where doubles round nothing, and scaled so that the same goes to
/// the integers of 60 and of 120 bits.
TEST(GuigueDevillersExact, GridsAtEveryTier) {
    PairFamilies families(3);
    for (const auto& [exponent, tier] :
         {std::pair{0, 0}, {-500, 1}, {-1000, 2}, {-1074, 2}, {900, 1}}) {
        const Tally tally = judge(families.grid(4000, 3, exponent));
        ASSERT_FALSE(HasFatalFailure()) << exponent;
        for (std::size_t other = 1; other < 4; ++other)
            EXPECT_EQ(tally.by_tier[other] > 0, other == static_cast<std::size_t>(tier))
                << exponent;
    }
}

/// A lattice vector d with n . d = 1, of n = u x v, close to the parallelogram of u and v: as near
/// to their plane as their lattice has points. No value if the components of n share a factor.
std::optional<Vec3<std::int64_t>> next_to_plane(Vec3<std::int64_t> u, Vec3<std::int64_t> v) {
    __extension__ using Wide = __int128;
    const Vec3<std::int64_t> n = cross(u, v);
    // a x + b y = g
    const auto bezout = [](Wide a, Wide b) {
        std::array<Wide, 3> r{a, 1, 0}, s{b, 0, 1};
        while (s[0] != 0) {
            const Wide q = r[0] / s[0];
            for (std::size_t i = 0; i < 3; ++i)
                r[i] -= q * s[i];
            std::swap(r, s);
        }
        return r;
    };
    const auto [g, x, y] = bezout(n.x, n.y);
    const auto [one, of_g, z] = bezout(g, n.z);
    if (one != 1 && one != -1)
        return std::nullopt;
    std::array<Wide, 3> d{x * of_g * one, y * of_g * one, z * one};
    // Off with the multiples of u and v; twice, as doubles round.
    for (int pass = 0; pass < 4; ++pass) {
        const Vec3<double> at{double(d[0]), double(d[1]), double(d[2])}, normal(n);
        const double square = dot(normal, normal);
        const auto s =
            static_cast<Wide>(std::round(dot(cross(at, Vec3<double>(v)), normal) / square));
        const auto t =
            static_cast<Wide>(std::round(dot(cross(Vec3<double>(u), at), normal) / square));
        for (int k = 0; k < 3; ++k)
            d[static_cast<std::size_t>(k)] -= s * u[k] + t * v[k];
    }
    return Vec3<std::int64_t>{static_cast<std::int64_t>(d[0]), static_cast<std::int64_t>(d[1]),
                              static_cast<std::int64_t>(d[2])};
}

/// b points with a corner at a, on its plane or the least step of the grid to one side of it: where
/// a determinant that was rounded by one unit would be wrong. Near the origin and far from it.
TEST(GuigueDevillersExact, TheLeastStepOffThePlane) {
    PairFamilies random(11);
    using Lattice = Vec3<std::int64_t>;
    for (const int bits : {8, 14, 15, 16, 17, 18, 20, 22}) {
        std::vector<TrianglePair> pairs;
        const auto component = [&] { return std::int64_t{random.below(2 << bits)} - (1 << bits); };
        while (pairs.size() < 1500 / testing::thinned) {
            const Lattice u{component(), component(), component()};
            const Lattice v{component(), component(), component()};
            const auto step = next_to_plane(u, v);
            if (!step)
                continue;
            const std::int64_t side = random.below(3) - 1;
            const auto times = [](const Lattice& p, std::int64_t s) {
                return Lattice{p.x * s, p.y * s, p.z * s};
            };
            const Lattice near = times(*step, side), n = cross(u, v);
            // The two others of b on one side: above, where n points.
            const auto above = [&] {
                const Lattice p{component(), component(), component()};
                return dot(Point(n), Point(p)) > 0 ? p : times(p, -1);
            };
            const int far = random.below(3) == 0 ? bits + 18 + random.below(5) : 0;
            const double offset = far == 0 ? 0 : std::ldexp(random.below(2) == 0 ? 1 : -1, far);
            const auto point = [&](const Lattice& p) {
                return Point(p) + Point{offset, offset, offset};
            };
            TrianglePair pair{{point({0, 0, 0}), point(u), point(v)},
                              {point(near), point(near + above()), point(near + above())},
                              false};
            if (random.below(2) == 0)
                std::swap(pair.a, pair.b);
            pair.touch = oracle::intersect(pair.a, pair.b);
            pairs.push_back(pair);
        }
        const Tally tally = judge(pairs);
        ASSERT_FALSE(HasFatalFailure()) << bits;
        EXPECT_GT(std::min(tally.yes, tally.no), at_least(30)) << bits;
    }
}

/// In a coordinate plane, where only the test of the plane is left: corners rounded onto edges.
TEST(GuigueDevillersExact, NearlyTouchingInAPlane) {
    PairFamilies families(12);
    std::vector<TrianglePair> pairs = families.nearly_touching(6000);
    for (TrianglePair& pair : pairs) {
        const int axis = families.below(3);
        const auto& [p, q, r] = pair.a;
        const double t = std::ldexp(families.below(1 << 20), -20);
        pair.b.a = families.below(2) == 0 ? p + (q - p) * t : q + (r - q) * t;
        if (families.below(2) == 0)
            pair.b.b = pair.b.a + (q - p);
        for (Triangle<double>* side : {&pair.a, &pair.b})
            for (Point* point : {&side->a, &side->b, &side->c})
                (*point)[axis] = 0.3;
        pair.touch = oracle::intersect(pair.a, pair.b);
    }
    const Tally tally = judge(pairs);
    EXPECT_GT(std::min(tally.yes, tally.no), at_least(500));
    EXPECT_GT(tally.by_tier[1], at_least(500));
}

TEST(GuigueDevillersExact, NearlyTouching) {
    const Tally doubles = judge(PairFamilies(4).nearly_touching(15000));
    EXPECT_GT(doubles.by_tier[1], at_least(1000));
    judge(PairFamilies(4, testing::Kept::as_float).nearly_touching(15000));
}

/// On lattices whose steps differ by hundreds of powers of two: the superaccumulator's.
TEST(GuigueDevillersExact, StepsOfAllSizes) {
    PairFamilies random(5);
    const std::array<double, 8> steps{0,        1,         0x1p-1074, -0x1p-1074,
                                      0x1p1000, -0x1p1000, 3,         0x1p-600};
    std::vector<TrianglePair> pairs(6000 / testing::thinned);
    for (TrianglePair& pair : pairs) {
        const std::size_t n_steps = random.below(2) == 0 ? 3 : 8;
        const bool flat = random.below(3) == 0;
        for (Triangle<double>* t : {&pair.a, &pair.b})
            for (Point* p : {&t->a, &t->b, &t->c})
                for (int k = 0; k < 3; ++k)
                    (*p)[k] = flat && k == 1
                                  ? (*p)[0]
                                  : steps[static_cast<std::size_t>(random.below(int(n_steps)))];
        pair.touch = oracle::intersect(pair.a, pair.b);
    }
    const Tally tally = judge(pairs);
    EXPECT_GT(tally.by_tier[3], at_least(100));
    EXPECT_GT(std::min(tally.yes, tally.no), at_least(300));
}

TEST(GuigueDevillersExact, Magnitudes) {
    PairFamilies families(6);
    for (const auto& [low, high] : {std::pair{-3, 3},
                                    {-40, 40},
                                    {-70, 70},
                                    {-150, 150},
                                    {-310, -290},
                                    {-1073, 1023},
                                    {-1073, -1015},
                                    {-960, -850},
                                    {180, 220},
                                    {1015, 1023}}) {
        judge(families.magnitudes(1500, low, high));
        ASSERT_FALSE(HasFatalFailure()) << low << ' ' << high;
    }
}

TEST(GuigueDevillersExact, LargestNumbers) {
    PairFamilies random(7);
    const double huge = std::numeric_limits<double>::max();
    const std::array<double, 6> steps{huge, -huge, 0, std::nextafter(huge, 0), huge / 2, -huge / 2};
    std::vector<TrianglePair> pairs(3000 / testing::thinned);
    for (TrianglePair& pair : pairs) {
        for (Triangle<double>* t : {&pair.a, &pair.b})
            for (Point* p : {&t->a, &t->b, &t->c})
                *p = {steps[static_cast<std::size_t>(random.below(6))],
                      steps[static_cast<std::size_t>(random.below(6))],
                      steps[static_cast<std::size_t>(random.below(3))]};
        pair.touch = oracle::intersect(pair.a, pair.b);
    }
    const Tally tally = judge(pairs);
    EXPECT_GT(std::min(tally.yes, tally.no), at_least(50));
}

std::vector<TrianglePair> mixture(std::uint64_t seed, std::size_t n) {
    PairFamilies families(seed);
    std::vector<TrianglePair> all = families.nearly_touching(n);
    for (auto more : {families.grid(n, 3), families.generic(n), families.magnitudes(n, -1073, 1023),
                      families.grid(n, 2, -1074)})
        all.insert(all.end(), more.begin(), more.end());
    return all;
}

TEST(GuigueDevillersExact, TheOrderOfCornersAndSidesChangesNothing) {
    for (const TrianglePair& pair : mixture(8, 200)) {
        const std::array a{pair.a.a, pair.a.b, pair.a.c}, b{pair.b.a, pair.b.b, pair.b.c};
        std::array<std::size_t, 3> i{0, 1, 2};
        do {
            std::array<std::size_t, 3> j{0, 1, 2};
            do {
                const Triangle<double> p{a[i[0]], a[i[1]], a[i[2]]}, q{b[j[0]], b[j[1]], b[j[2]]};
                for (const bool flushing : {false, true}) {
                    const DenormalFlushing mode(flushing);
                    const Answer forth = GuigueDevillersExact::intersect(p, q).answer;
                    const Answer back = GuigueDevillersExact::intersect(q, p).answer;
                    ASSERT_EQ(forth, answer_of(pair.touch)) << testing::print(pair);
                    ASSERT_EQ(back, answer_of(pair.touch)) << testing::print(pair);
                }
            } while (std::next_permutation(j.begin(), j.end()));
        } while (std::next_permutation(i.begin(), i.end()));
    }
}

/// Bit for bit the decision of both kernels, tier included.
TEST(GuigueDevillersExact, PowersOfTwoChangeNothing) {
    PairFamilies families(9);
    std::vector<TrianglePair> pairs = families.nearly_touching(1000);
    for (auto more : {families.grid(1000, 3), families.generic(1000)})
        pairs.insert(pairs.end(), more.begin(), more.end());
    for (const TrianglePair& pair : pairs)
        for (const int exponent : {-90, -1, 53, 150}) {
            const double s = std::ldexp(1.0, exponent);
            const Triangle<double> a{pair.a.a * s, pair.a.b * s, pair.a.c * s};
            const Triangle<double> b{pair.b.a * s, pair.b.b * s, pair.b.c * s};
            ASSERT_EQ(GuigueDevillersExact::intersect(a, b),
                      GuigueDevillersExact::intersect(pair.a, pair.b))
                << testing::print(pair) << exponent;
            ASSERT_EQ(GuigueDevillersFiltered::intersect(a, b),
                      GuigueDevillersFiltered::intersect(pair.a, pair.b))
                << testing::print(pair) << exponent;
        }
}

/// The four parts of a triangle that the midpoints of its edges cut, where these are doubles.
TEST(GuigueDevillersExact, PartsMeetWhatTheWholeMeets) {
    PairFamilies families(10);
    for (const int exponent : {0, -500, -1000}) {
        int cut = 0;
        for (const TrianglePair& pair : families.grid(3000, 9, exponent)) {
            const auto middle = [](const Point& p, const Point& q) { return p * 0.5 + q * 0.5; };
            const auto& [a, b, c] = pair.a;
            const Point ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            const std::array<Triangle<double>, 4> parts{
                Triangle<double>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}};
            const bool any = std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
                return GuigueDevillersExact::intersect(part, pair.b).answer == Answer::yes;
            });
            ASSERT_EQ(any, pair.touch) << testing::print(pair);
            cut += pair.touch;
        }
        EXPECT_GT(cut, at_least(30));
    }
}

TEST(GuigueDevillersExact, MaybeForNonFiniteAlone) {
    const Triangle<double> t{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::array<Triangle<double>, 6> others{
        t,                                              // all corners shared
        {{0, 0, 0}, {5, 5, 5}, {6, 5, 5}},              // one corner shared
        {{9, 9, 9}, {10, 9, 9}, {9, 10, 9}},            // boxes apart
        {{0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 0.3, 1}}, // through
        {{0.2, 0.2, 0}, {0.3, 0.2, 0}, {0.2, 0.3, 0}},  // in one plane
        {{1e308, 1e308, 0}, {-1e308, 1e308, 0}, {0, 1, 1e308}}};
    for (const Triangle<double>& other : others) {
        EXPECT_NE(GuigueDevillersExact::intersect(t, other).answer, Answer::maybe);
        for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()})
            for (int corner = 0; corner < 3; ++corner)
                for (int k = 0; k < 3; ++k) {
                    Triangle<double> b = other;
                    (corner == 0 ? b.a : corner == 1 ? b.b : b.c)[k] = bad;
                    for (const bool flushing : {false, true}) {
                        const DenormalFlushing mode(flushing);
                        EXPECT_EQ(GuigueDevillersExact::intersect(t, b).answer, Answer::maybe);
                        EXPECT_EQ(GuigueDevillersExact::intersect(b, t).answer, Answer::maybe);
                        EXPECT_EQ(GuigueDevillersFiltered::intersect(t, b).answer, Answer::maybe);
                        EXPECT_EQ(GuigueDevillersFiltered::intersect(b, t).answer, Answer::maybe);
                    }
                }
    }
}

TEST(GuigueDevillersExact, CoplanarDisjoint) {
    const Triangle<double> a{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Triangle<double> b{{10, 10, 0}, {11, 10, 0}, {10, 11, 0}};
    EXPECT_EQ(GuigueDevillersExact::intersect(a, b), (Decision{Answer::no, 0}));
}

} // namespace
} // namespace boxwood
