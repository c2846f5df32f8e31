// The oracle against CGAL's exact kernel, on input that is not degenerate: CGAL asks for that.
#include "kernels/oracle/exact_answers.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>
#include <string>

namespace boxwood::oracle {
namespace {

using Epeck = CGAL::Exact_predicates_exact_constructions_kernel;

Epeck::Point_3 cgal(Vec3<double> p) { return {p.x, p.y, p.z}; }
Epeck::Triangle_3 cgal(const Triangle<double>& t) { return {cgal(t.a), cgal(t.b), cgal(t.c)}; }
Epeck::Segment_3 cgal(const Segment<double>& s) { return {cgal(s.a), cgal(s.b)}; }

mpq_class rational(const Epeck::FT& x) {
    std::ostringstream text;
    text << CGAL::exact(x);
    mpq_class q(text.str());
    q.canonicalize();
    return q;
}

/// Pairs of triangles that touch, nearly touch or don't, of many kinds; none degenerate.
class PairMaker {
  public:
    struct Pair {
        Triangle<double> a, b;
    };

    Pair operator()() {
        for (;;) {
            const Pair p = any();
            if (!cgal(p.a).is_degenerate() && !cgal(p.b).is_degenerate())
                return p;
        }
    }

  private:
    Pair any() {
        Triangle<double> a = triangle(), b = triangle();
        const double s = real(), r = real();
        switch (bits_() % 8) {
        case 0: // coordinates of any size
            return {scaled(a, std::exp2(80 * s)), scaled(b, std::exp2(80 * r))};
        case 1: // a shared corner
            b.a = a.b;
            break;
        case 2: // a shared edge
            b.a = a.b;
            b.b = a.a;
            break;
        case 3: // a corner rounded onto the face, a line or beyond
            b.a = a.a + (a.b - a.a) * s + (a.c - a.a) * r;
            break;
        case 4: // nearly parallel, thinly apart
            b = {a.a + b.a * 1e-10, a.b + b.b * 1e-10, a.c + b.c * 1e-10};
            break;
        case 5: // whole numbers
            return {rounded(scaled(a, 3)), rounded(scaled(b, 3))};
        case 6: // in one plane of whole numbers, tilted
            return {tilted(rounded(scaled(a, 4))), tilted(rounded(scaled(b, 4)))};
        default:
            break;
        }
        return {a, b};
    }

    double real() { return std::uniform_real_distribution<double>(-1, 1)(bits_); }
    Vec3<double> vector() { return {real(), real(), real()}; }
    Triangle<double> triangle() { return {vector(), vector(), vector()}; }
    static Triangle<double> scaled(const Triangle<double>& t, double s) {
        return {t.a * s, t.b * s, t.c * s};
    }
    static Triangle<double> rounded(const Triangle<double>& t) {
        const auto whole = [](Vec3<double> p) {
            return Vec3<double>{std::round(p.x), std::round(p.y), std::round(p.z)};
        };
        return {whole(t.a), whole(t.b), whole(t.c)};
    }
    static Triangle<double> tilted(const Triangle<double>& t) {
        const auto tilt = [](Vec3<double> p) {
            return Vec3<double>{p.x, p.y, 2 * p.x - 3 * p.y + 1};
        };
        return {tilt(t.a), tilt(t.b), tilt(t.c)};
    }

    std::mt19937_64 bits_{2};
};

TEST(OracleAgainstCgal, TrianglesIntersect) {
    PairMaker make;
    int touching = 0;
    for (int i = 0; i < 30'000; ++i) {
        const auto [a, b] = make();
        const bool expected = CGAL::do_intersect(cgal(a), cgal(b));
        touching += expected;
        ASSERT_EQ(intersect(a, b), expected) << i;
    }
    EXPECT_GT(touching, 8000);
    EXPECT_LT(touching, 22'000);
}

TEST(OracleAgainstCgal, SquaredDistances) {
    PairMaker make;
    for (int i = 0; i < 3000; ++i) {
        const auto [a, b] = make();
        const Segment<double> s{a.a, a.b}, t{b.a, b.b};
        ASSERT_EQ(squared_distance(a, b), rational(CGAL::squared_distance(cgal(a), cgal(b)))) << i;
        ASSERT_EQ(squared_distance(s, t), rational(CGAL::squared_distance(cgal(s), cgal(t)))) << i;
        ASSERT_EQ(squared_distance(a.a, b), rational(CGAL::squared_distance(cgal(a.a), cgal(b))));
        ASSERT_EQ(squared_distance(a.a, t), rational(CGAL::squared_distance(cgal(a.a), cgal(t))));
    }
}

} // namespace
} // namespace boxwood::oracle
