#include "kernels/triangle_triangle/guigue_devillers.h"

#include "kernels/predicates/exact.h"
#include "kernels/predicates/rounded.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace boxwood {
namespace {

using Kernel = GuigueDevillersF64;
static_assert(TriangleKernel<Kernel>);
static_assert(TriangleKernel<GuigueDevillersF32>);
static_assert(GuigueDevillersF32::name == "guigue_devillers_f32");
static_assert(Kernel::name == "guigue_devillers_f64");

struct NoVerdict {
    static constexpr std::string_view name = "none";
    static constexpr KernelInfo info{};
    static bool intersect(const Triangle<double>&, const Triangle<double>&);
};
static_assert(!TriangleKernel<NoVerdict>);

/// Undecided wherever the determinant is zero: what a filter does.
struct Coy : Rounded<double> {
    static int orient3d(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double> d) {
        const int sign = Rounded<double>::orient3d(a, b, c, d);
        return sign == 0 ? undecided : sign;
    }
    static int orient2d(Point2<double> a, Point2<double> b, Point2<double> c) {
        const int sign = Rounded<double>::orient2d(a, b, c);
        return sign == 0 ? undecided : sign;
    }
};

// --- The truth on integers. Hulls A and B share a point iff the origin lies in the hull of the
// nine differences a - b, that is (Caratheodory) in one of their affinely independent simplices of
// at most four corners. No case of the kernel appears in it, and no degenerate case needs a word.

using Point = Vec3<std::int64_t>;
using Corners = std::array<Point, 3>;

bool origin_in_hull(const std::array<Point, 9>& p) {
    std::int64_t det[9][9][9];
    for (std::size_t i = 0; i < 9; ++i) {
        if (p[i] == Point{})
            return true;
        for (std::size_t j = i + 1; j < 9; ++j) {
            const Point ij = cross(p[i], p[j]);
            if (ij == Point{} && dot(p[i], p[j]) <= 0)
                return true;
            for (std::size_t k = j + 1; k < 9; ++k) {
                det[i][j][k] = dot(ij, p[k]);
                if (det[i][j][k] != 0)
                    continue;
                const Point jk = cross(p[j], p[k]), ki = cross(p[k], p[i]), n = ij + jk + ki;
                if (n != Point{} && dot(n, ij) >= 0 && dot(n, jk) >= 0 && dot(n, ki) >= 0)
                    return true;
            }
        }
    }
    for (std::size_t i = 0; i < 9; ++i)
        for (std::size_t j = i + 1; j < 9; ++j)
            for (std::size_t k = j + 1; k < 9; ++k)
                for (std::size_t l = k + 1; l < 9; ++l) {
                    const std::array<std::int64_t, 4> weight{det[j][k][l], -det[i][k][l],
                                                             det[i][j][l], -det[i][j][k]};
                    const auto [low, high] = std::minmax_element(weight.begin(), weight.end());
                    if ((*low >= 0 && *high > 0) || (*high <= 0 && *low < 0))
                        return true;
                }
    return false;
}

bool truth(const Corners& a, const Corners& b) {
    std::array<Point, 9> differences;
    for (std::size_t i = 0; i < 9; ++i)
        differences[i] = a[i / 3] - b[i % 3];
    return origin_in_hull(differences);
}

Triangle<double> triangle(const Corners& t) {
    return {Vec3<double>(t[0]), Vec3<double>(t[1]), Vec3<double>(t[2])};
}

template <class K = Kernel> Answer answer(const Corners& a, const Corners& b) {
    const auto read = [](const Corners& t) {
        using Vector = Vec3<typename K::Real>;
        return Triangle<typename K::Real>{Vector(t[0]), Vector(t[1]), Vector(t[2])};
    };
    return K::intersect(read(a), read(b)).answer;
}

/// Whether float determinants round nothing: 6 * (2 * 64)^3 < 2^24.
bool is_small(const Corners& a, const Corners& b) {
    std::int64_t max_coordinate = 0;
    for (const Corners& t : {a, b})
        for (const Point& p : t)
            max_coordinate =
                std::max({max_coordinate, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return max_coordinate <= 64;
}

std::string print(const Corners& a, const Corners& b) {
    std::string text;
    for (const Corners& t : {a, b})
        for (const Point& p : t)
            text += '(' + std::to_string(p.x) + ' ' + std::to_string(p.y) + ' ' +
                    std::to_string(p.z) + ") ";
    return text;
}

/// Agreement with the truth, and of the coy predicates where they decide. Counts what was met.
class Judge {
  public:
    void operator()(const Corners& a, const Corners& b) {
        const bool expected = truth(a, b);
        const Answer wanted = expected ? Answer::yes : Answer::no;
        ASSERT_EQ(answer(a, b), wanted) << print(a, b);
        ASSERT_EQ(answer<GuigueDevillers<Exact>>(a, b), wanted) << print(a, b);
        if (is_small(a, b)) {
            ASSERT_EQ(answer<GuigueDevillersF32>(a, b), wanted) << print(a, b);
        }
        const Answer coy = answer<GuigueDevillers<Coy>>(a, b);
        if (coy != Answer::maybe) {
            ASSERT_EQ(coy, wanted) << print(a, b);
        }
        (expected ? yes : no)++;
        decided += coy != Answer::maybe;
    }
    int yes = 0, no = 0, decided = 0;
};

/// Every triangle with corners among `points`; with `ordered` false one for each set of corners.
std::vector<Corners> all_triangles(const std::vector<Point>& points, bool ordered) {
    std::vector<Corners> all;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = ordered ? 0 : i; j < points.size(); ++j)
            for (std::size_t k = ordered ? 0 : j; k < points.size(); ++k)
                all.push_back({points[i], points[j], points[k]});
    return all;
}

std::vector<Point> grid(int nx, int ny, int nz) {
    std::vector<Point> points;
    for (int i = 0; i < nx * ny * nz; ++i)
        points.push_back({i % nx, i / nx % ny, i / (nx * ny)});
    return points;
}

TEST(GuigueDevillers, EveryPairOfTheUnitCube) {
    Judge judge;
    const auto points = grid(2, 2, 2);
    for (const Corners& a : all_triangles(points, true))
        for (const Corners& b : all_triangles(points, false))
            ASSERT_NO_FATAL_FAILURE(judge(a, b));
    EXPECT_GT(judge.yes, 10000);
    EXPECT_GT(judge.no, 10000);
}

TEST(GuigueDevillers, EveryCoplanarPairOfThreeByThree) {
    Judge judge;
    const auto points = grid(3, 3, 1);
    for (const Corners& a : all_triangles(points, true))
        for (const Corners& b : all_triangles(points, false))
            ASSERT_NO_FATAL_FAILURE(judge(a, b));
    EXPECT_GT(judge.yes, 10000);
    EXPECT_GT(judge.no, 10000);
}

struct Random {
    std::mt19937 engine{11};
    int below(int n) { return std::uniform_int_distribution(0, n - 1)(engine); }
    std::size_t corner() { return static_cast<std::size_t>(below(3)); }
    Corners triangle(int size) {
        Corners t;
        for (Point& p : t)
            p = {below(size + 1), below(size + 1), below(size + 1)};
        return t;
    }
};

/// Random pairs of one kind each: `shape` changes a random pair on [0, size]^3.
template <class Shape> Judge random_pairs(int n, int size, Shape shape) {
    Random random;
    Judge judge;
    for (int i = 0; i < n; ++i) {
        Corners a = random.triangle(size), b = random.triangle(size);
        shape(a, b, random);
        judge(a, b);
        if (::testing::Test::HasFatalFailure())
            break;
    }
    EXPECT_GT(judge.yes, n / 100);
    EXPECT_GT(judge.no, n / 100);
    return judge;
}

TEST(GuigueDevillers, Generic) {
    for (const int size : {2, 3, 8})
        random_pairs(40000, size, [](auto&&...) {});
    const Judge wide = random_pairs(20000, 1000, [](auto&&...) {});
    EXPECT_GT(wide.decided, 19000);
}

TEST(GuigueDevillers, Coplanar) {
    // z = 2x - 3y keeps the lattice; then the axes are turned so that each is the one to drop.
    random_pairs(60000, 8, [](Corners& a, Corners& b, Random& random) {
        const bool tilted = random.below(2) == 1;
        const int turns = random.below(3);
        for (Corners* t : {&a, &b})
            for (Point& p : *t) {
                p.z = tilted ? 2 * p.x - 3 * p.y : 0;
                for (int i = 0; i < turns; ++i)
                    p = {p.y, p.z, p.x};
            }
    });
}

TEST(GuigueDevillers, Touching) {
    // A shared corner, a corner on an edge, edges that cross or overlap, identical triangles.
    random_pairs(60000, 8, [](Corners& a, Corners& b, Random& random) {
        switch (random.below(6)) {
        case 0:
            b[random.corner()] = a[random.corner()];
            break;
        case 1:
            for (Point& p : a)
                p = p + p;
            b[0] = Point{(a[0].x + a[1].x) / 2, (a[0].y + a[1].y) / 2, (a[0].z + a[1].z) / 2};
            break;
        case 2:
            b[0] = a[1];
            b[1] = a[0];
            break;
        case 3:
            b[0] = a[0];
            b[1] = a[1] + (a[1] - a[0]);
            break;
        case 4:
            b = {a[2], a[0], a[1]};
            break;
        default: // parallel planes one step apart: all no
            b = a;
            for (Point& p : b)
                p.z = p.z + 1;
        }
    });
}

TEST(GuigueDevillers, Degenerate) {
    const auto degrade = [](Corners& t, Random& random) {
        switch (random.below(4)) {
        case 0:
            t = {t[0], t[0], t[0]};
            break;
        case 1:
            t[1] = t[0];
            break;
        case 2:
            t[2] = t[1] + (t[1] - t[0]);
            break;
        default:
            t[0] = t[1] + (t[1] - t[2]);
            break;
        }
        std::shuffle(t.begin(), t.end(), random.engine);
    };
    for (const int size : {1, 2, 8}) {
        random_pairs(30000, size,
                     [&](Corners& a, Corners&, Random& random) { degrade(a, random); });
        random_pairs(30000, size, [&](Corners& a, Corners& b, Random& random) {
            degrade(a, random);
            degrade(b, random);
            if (size == 8 && random.below(2) == 1) // one line
                for (Corners* t : {&a, &b})
                    for (Point& p : *t)
                        p = {p.x, 2 * p.x, -p.x};
        });
    }
}

TEST(GuigueDevillers, TheOrderOfCornersAndSidesDoesNotMatter) {
    Random random;
    for (int i = 0; i < 4000; ++i) {
        const Corners a = random.triangle(3), b = random.triangle(3);
        const Answer expected = answer(a, b);
        std::array<std::size_t, 3> pa{0, 1, 2};
        do {
            std::array<std::size_t, 3> pb{0, 1, 2};
            do {
                const Corners sa{a[pa[0]], a[pa[1]], a[pa[2]]}, sb{b[pb[0]], b[pb[1]], b[pb[2]]};
                ASSERT_EQ(answer(sa, sb), expected) << print(sa, sb);
                ASSERT_EQ(answer(sb, sa), expected) << print(sb, sa);
            } while (std::next_permutation(pb.begin(), pb.end()));
        } while (std::next_permutation(pa.begin(), pa.end()));
    }
}

TEST(GuigueDevillers, PowersOfTwoChangeNothing) {
    random_pairs(5000, 4, [](Corners& a, Corners& b, Random& random) {
        const double scale = std::ldexp(1.0, random.below(600) - 300);
        Triangle<double> sa = triangle(a), sb = triangle(b);
        for (Triangle<double>* t : {&sa, &sb})
            *t = {t->a * scale, t->b * scale, t->c * scale};
        ASSERT_EQ(Kernel::intersect(sa, sb).answer, answer(a, b)) << print(a, b) << scale;
    });
}

/// Exact on lattices of step 2^-540, where plain products underflow to zero.
struct Magnified : Rounded<double> {
    static constexpr double factor = 0x1p540;
    static int orient3d(Vec3<double> a, Vec3<double> b, Vec3<double> c, Vec3<double> d) {
        return Rounded<double>::orient3d(a * factor, b * factor, c * factor, d * factor);
    }
    static int orient2d(Point2<double> a, Point2<double> b, Point2<double> c) {
        const auto up = [](Point2<double> p) { return Point2<double>{p.x * factor, p.y * factor}; };
        return Rounded<double>::orient2d(up(a), up(b), up(c));
    }
};

TEST(GuigueDevillers, AsksThePredicatesAlone) {
    // The normal underflows, so that the axis to drop must be found by its sign.
    const auto points = grid(3, 3, 1);
    for (int turns = 0; turns < 3; ++turns)
        for (const Corners& a : all_triangles(points, false))
            for (const Corners& b : all_triangles(points, false)) {
                const auto tiny = [&](Corners t) {
                    for (Point& p : t)
                        for (int i = 0; i < turns; ++i)
                            p = {p.y, p.z, p.x};
                    const Triangle<double> big = triangle(t);
                    return Triangle<double>{big.a * 0x1p-540, big.b * 0x1p-540, big.c * 0x1p-540};
                };
                ASSERT_EQ(GuigueDevillers<Magnified>::intersect(tiny(a), tiny(b)).answer,
                          answer(a, b))
                    << print(a, b) << turns;
            }
}

TEST(GuigueDevillers, CoplanarDisjoint) {
    EXPECT_EQ(answer({Point{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                     {Point{10, 10, 0}, {11, 10, 0}, {10, 11, 0}}),
              Answer::no);
}

TEST(GuigueDevillers, MaybeForNanAndOverflow) {
    const Triangle<double> good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()})
        for (int k = 0; k < 3; ++k) {
            Triangle<double> t = good;
            t.b[k] = bad;
            EXPECT_EQ(Kernel::intersect(t, good).answer, Answer::maybe);
            EXPECT_EQ(Kernel::intersect(good, t).answer, Answer::maybe);
            EXPECT_EQ(Kernel::intersect(t, t).answer, Answer::maybe);
        }
    const Triangle<double> huge{{-1e200, -1e200, 0}, {1e200, -1e200, 1e200}, {0, 1e200, 1e200}};
    EXPECT_EQ(Kernel::intersect(huge, huge).answer, Answer::maybe);
}

} // namespace
} // namespace boxwood
