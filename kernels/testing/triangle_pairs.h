#pragma once

#include "kernels/oracle/oracle.h"
#include "kernels/primitives/triangle.h"
#include "kernels/testing/thinned.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

/// Pairs of triangles with the truth from the oracle, for the tests of yes/no kernels.
namespace boxwood::testing {

struct TrianglePair {
    Triangle<double> a, b;
    bool touch;
};

/// How closely a family's coordinates are kept: doubles, or doubles that are floats.
enum class Kept { as_double, as_float };

inline std::string print(const TrianglePair& pair) {
    std::ostringstream text;
    text << std::hexfloat;
    for (const Triangle<double>* t : {&pair.a, &pair.b})
        for (const Vec3<double>* p : {&t->a, &t->b, &t->c})
            text << '(' << p->x << ' ' << p->y << ' ' << p->z << ") ";
    return text.str();
}

template <class To, class From> Triangle<To> as(const Triangle<From>& t) {
    return {Vec3<To>(t.a), Vec3<To>(t.b), Vec3<To>(t.c)};
}

class PairFamilies {
  public:
    using Point = Vec3<double>;
    using Corners = std::array<Point, 3>;

    explicit PairFamilies(std::uint64_t seed = 1, Kept kept = Kept::as_double)
        : engine_(seed), kept_(kept) {}

    /// Corners anywhere in the unit cube: three in ten touch, none nearly.
    std::vector<TrianglePair> generic(std::size_t n) {
        return pairs(n, [&](Corners& a, Corners& b) {
            a = {inside(), inside(), inside()};
            b = {inside(), inside(), inside()};
        });
    }

    /// Integers in [0, size], times 2^exponent: two generic pairs in six; else a shared corner or
    /// edge, one plane, and in the last two one or both degenerate.
    std::vector<TrianglePair> grid(std::size_t n, int size, int exponent = 0) {
        return pairs(n, [&](Corners& a, Corners& b) {
            const auto point = [&] {
                return Point{double(below(size + 1)), double(below(size + 1)),
                             double(below(size + 1))};
            };
            a = {point(), point(), point()};
            b = {point(), point(), point()};
            switch (below(6)) {
            case 0:
                std::copy_n(a.begin(), 1 + below(3), b.begin());
                break;
            case 1: {
                const int axis = below(3);
                for (Corners* t : {&a, &b})
                    for (Point& p : *t)
                        p[axis] = p[(axis + 1) % 3]; // x = y, say
                break;
            }
            case 2:
                degrade(a);
                degrade(b);
                break;
            case 3:
                degrade(below(2) == 0 ? a : b);
                break;
            }
            for (Corners* t : {&a, &b})
                for (Point& p : *t)
                    p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent),
                         std::ldexp(p.z, exponent)};
        });
    }

    /// A corner or an edge's point of b rounded onto a, the two in nearly one plane, b's corner off
    /// a's by an ulp, or b a copy of a off by ulps; and half of the b moved a little.
    std::vector<TrianglePair> nearly_touching(std::size_t n) {
        return pairs(n, [&](Corners& a, Corners& b) {
            a = {inside(), inside(), inside()};
            b = {inside(), inside(), inside()};
            const int kind = below(5);
            if (kind == 0)
                b[0] = on(a);
            if (kind == 1) // an edge of b through a point of a's edge
                b[1] = b[0] + (between(a[0], a[1]) - b[0]) * (1 + fraction());
            if (kind == 2)
                b = {on(a), on(a), on(a) + (a[1] - a[0])};
            if (kind == 3)
                b[0] = nudged(a[0]);
            if (kind == 4)
                b = {nudged(a[1]), nudged(a[0]), nudged(a[2])};
            if (below(2) == 0) { // and moved by 10^-1 .. 10^-17
                const Point by = inside() * std::pow(10.0, -between(1, 17));
                b = {b[0] + by, b[1] + by, b[2] + by};
            }
        });
    }

    /// Any magnitude at all: exponents in [low, high], one for the pair, for each corner or for
    /// each coordinate.
    std::vector<TrianglePair> magnitudes(std::size_t n, int low, int high) {
        return pairs(n, [&](Corners& a, Corners& b) {
            const int kind = below(3);
            int exponent = between(low, high);
            for (Corners* t : {&a, &b})
                for (Point& p : *t) {
                    if (kind == 1)
                        exponent = between(low, high);
                    for (int k = 0; k < 3; ++k) {
                        if (kind == 2)
                            exponent = between(low, high);
                        p[k] = std::ldexp(2 * fraction() - 1, exponent);
                    }
                }
            if (below(3) == 0)
                b[0] = a[1];
            if (below(3) == 0)
                for (int k = 0; k < 3; ++k)
                    a[2][k] = b[2][k] = 0;
        });
    }

    int below(int n) { return std::uniform_int_distribution(0, n - 1)(engine_); }

  private:
    double fraction() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
    int between(int low, int high) { return low + below(high - low + 1); }
    Point inside() { return {fraction(), fraction(), fraction()}; }
    Point between(const Point& p, const Point& q) { return p + (q - p) * fraction(); }
    Point on(const Corners& t) { return between(between(t[0], t[1]), t[2]); }
    Point nudged(Point p) {
        for (int k = 0; k < 3; ++k) {
            const double to = below(3) - 1;
            p[k] = kept_ == Kept::as_float
                       ? double(std::nextafter(float(p[k]), float(p[k]) + float(to)))
                       : std::nextafter(p[k], p[k] + to);
        }
        return p;
    }
    /// A point, or a segment: a corner twice, or one corner between the others or beyond.
    void degrade(Corners& t) {
        switch (below(3)) {
        case 0:
            t = {t[0], t[0], t[0]};
            break;
        case 1:
            t[1] = t[0];
            break;
        default:
            t[2] = t[1] + (t[1] - t[0]);
        }
        std::shuffle(t.begin(), t.end(), engine_);
    }

    template <class Make> std::vector<TrianglePair> pairs(std::size_t n, Make make) {
        std::vector<TrianglePair> all(n / thinned);
        for (TrianglePair& pair : all) {
            Corners a{}, b{};
            make(a, b);
            pair = {kept(a), kept(b), false};
            if (below(2) == 0)
                std::swap(pair.a, pair.b);
            pair.touch = oracle::intersect(pair.a, pair.b);
        }
        return all;
    }
    Triangle<double> kept(const Corners& t) const {
        const Triangle<double> all{t[0], t[1], t[2]};
        return kept_ == Kept::as_float ? as<double>(as<float>(all)) : all;
    }

    std::mt19937_64 engine_;
    Kept kept_;
};

} // namespace boxwood::testing
