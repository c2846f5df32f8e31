#pragma once

#include "kernels/oracle/exact_answers.h"
#include "kernels/primitives/triangle.h"
#include "kernels/testing/triangle_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

/// Pairs of triangles that are hard to measure, by family, with the true distance by the oracle.
namespace boxwood::testing {

/// n, or fewer where the oracle is slow.
constexpr int few(int n) { return (n + thinned - 1) / thinned; }

/// The longest distance of two corners of either; not 0, not infinite.
inline double size_of(const Triangle<double>& a, const Triangle<double>& b) {
    const std::array corners{a.a, a.b, a.c, b.a, b.b, b.c};
    double max_magnitude = 0x1p-1074;
    for (const Vec3<double>& p : corners)
        for (const Vec3<double>& q : corners)
            max_magnitude = std::max(
                max_magnitude, std::hypot(p.x / 2 - q.x / 2, p.y / 2 - q.y / 2, p.z / 2 - q.z / 2));
    return std::min(max_magnitude, 0x1p1000) * 2;
}

struct DistancePair {
    Triangle<double> a, b;
    mpq_class squared;
    double distance; ///< nearest to the root
    double size;     ///< size_of them

    DistancePair(const Triangle<double>& first, const Triangle<double>& second)
        : a(first), b(second), squared(oracle::squared_distance(a, b)),
          distance(oracle::nearest_sqrt(squared)), size(size_of(a, b)) {}

    bool touch() const { return sgn(squared) == 0; }
    std::string print() const { return testing::print({a, b, touch()}); }
};

class DistanceFamilies {
  public:
    using Point = Vec3<double>;
    using Corners = std::array<Point, 3>;
    struct Made {
        Corners a, b;
    };
    struct Family {
        std::string_view name;
        std::function<Made()> make;
    };

    explicit DistanceFamilies(std::uint64_t seed = 1) : engine_(seed), touching_(seed) {}

    /// n pairs of one, its sides swapped at random.
    std::vector<DistancePair> pairs(const Family& family, std::size_t n) {
        std::vector<DistancePair> all;
        for (int i = 0; i < few(static_cast<int>(n)); ++i) {
            Made made = family.make();
            if (below(2) == 0)
                std::swap(made.a, made.b);
            all.emplace_back(triangle(made.a), triangle(made.b));
        }
        return all;
    }

    /// Sizes near 1, and 1e-5 to 1e12; coordinates of any kind.
    std::vector<Family> ordinary() {
        return {
            {"generic",
             [&] {
                 return Made{inside(), inside()};
             }},
            {"separated",
             [&] {
                 return Made{inside(), moved(inside(), Point{3 * part(), part(), 2 * part()})};
             }},
            {"tiny",
             [&] {
                 const double s = below(2) == 0 ? 1.7e-4 : 1e-5;
                 return Made{scaled(inside(), s), scaled(inside(), s)};
             }},
            {"offset",
             [&] {
                 const Point far = point() * ten_to(3, 12);
                 return Made{moved(inside(), far), moved(inside(), far)};
             }},
            {"mixed_scale",
             [&] {
                 const Corners a = inside();
                 const double s = ten_to(-12, 0);
                 return Made{a, moved(scaled(inside(), s), on(a) + unit() * ten_to(-14, 0))};
             }},
        };
    }

    /// Gaps from 1e-1 down below rounding, between features of each kind.
    std::vector<Family> near_contact() {
        return {
            {"corner_and_face",
             [&] {
                 const Frame f = frame();
                 const Corners a{f.at(coordinate(), coordinate()), f.at(coordinate(), coordinate()),
                                 f.at(coordinate(), coordinate())};
                 const Point q = on(a) + f.n * gap();
                 return Made{a,
                             {q, q + f.n * part(.3) + f.x * coordinate(),
                              q + f.n * part(.1) + f.y * coordinate()}};
             }},
            {"corner_and_edge",
             [&] {
                 const Frame f = frame();
                 const Corners a{f.at(-part(.1), 0), f.at(part(.1), 0),
                                 f.o - f.n * part(.3) + f.y * (coordinate() / 5)};
                 const Point q = f.o + f.n * gap();
                 return Made{a,
                             {q, q + f.n * part(.3) + f.x * coordinate(),
                              q + f.n * part(.1) + f.y * (coordinate() / 3)}};
             }},
            {"corner_and_corner",
             [&] {
                 const Frame f = frame();
                 const auto away = [&](double side) {
                     return f.n * (side * part(.3)) + unit() * .3;
                 };
                 const Point q = f.o + f.n * gap();
                 return Made{{f.o, f.o + away(-1), f.o + away(-1)}, {q, q + away(1), q + away(1)}};
             }},
            {"edge_and_edge",
             [&] {
                 const Frame f = frame();
                 const Point b = f.y + f.x * coordinate(), q = f.o + f.n * gap();
                 return Made{{f.at(-part(.1), 0), f.at(part(.1), 0),
                              f.o - f.n * part(.3) + b * (coordinate() / 3)},
                             {q - b * part(.1), q + b * part(.1),
                              q + f.n * part(.3) + f.x * (coordinate() / 3)}};
             }},
            {"parallel_planes",
             [&] {
                 const Frame f = frame();
                 const auto in = [&] { return f.at(coordinate(), coordinate()); };
                 return Made{{in(), in(), in()}, moved({in(), in(), in()}, f.n * gap())};
             }},
            {"translates",
             [&] {
                 const Corners a = inside();
                 return Made{a, moved(a, unit() * gap())};
             }},
            {"coplanar",
             [&] {
                 const Frame f = frame();
                 const auto in = [&] { return f.at(coordinate(), coordinate()); };
                 return Made{{in(), in(), in()}, moved({in(), in(), in()}, f.x * (2 * part()))};
             }},
            {"near_grid",
             [&] {
                 return Made{grid(4), moved(grid(4), unit() * gap())};
             }},
            {"nearly_touching",
             [&] {
                 const TrianglePair pair = touching_.nearly_touching(thinned).front();
                 return Made{corners(pair.a), corners(pair.b)};
             }},
        };
    }

    /// Edges at an angle of 1e-2 to 1e-16, 1e-2 to 1e-12 apart.
    Family near_parallel_edges() {
        return {"near_parallel_edges",
                [&] { return near_parallel_edges(ten_to(-16, -2), ten_to(-12, -2)); }};
    }
    Made near_parallel_edges(double angle, double apart) {
        const Frame f = frame();
        const Point along = f.x + f.y * angle, q = f.o + f.n * apart;
        return {{f.at(-part(.2), 0), f.at(part(.2), 0),
                 f.o - f.n * part(.3) + f.y * (coordinate() / 2)},
                {q - along * part(.2), q + along * part(.2),
                 q + f.n * part(.3) + f.y * (coordinate() / 2)}};
    }

    /// Triangles nearly, or quite, without area.
    std::vector<Family> thin() {
        return {
            {"slivers",
             [&] {
                 return Made{sliver(), sliver()};
             }},
            {"needles",
             [&] {
                 return Made{needle(), needle()};
             }},
            {"sliver_and_corner",
             [&] {
                 const Corners a = sliver();
                 const Point q = on(a) + unit() * gap(), e = unit();
                 return Made{a,
                             {q, q + e * part(.1) + unit() * .1, q + e * part(.1) + unit() * .1}};
             }},
            {"small_integers",
             [&] {
                 return Made{degraded(grid(2)), degraded(grid(2))};
             }},
            {"integers",
             [&] {
                 return Made{degraded(grid(8)), grid(8)};
             }},
        };
    }

    /// Magnitudes from one end of the range to the other.
    std::vector<Family> extreme() {
        return {
            {"scaled",
             [&] {
                 const double s = std::ldexp(1, 1000 - below(2000));
                 return Made{scaled(inside(), s), scaled(inside(), s)};
             }},
            {"denormal",
             [&] {
                 return Made{scaled(inside(), 0x1p-1065), scaled(inside(), 0x1p-1065)};
             }},
            {"denormal_grid",
             [&] {
                 return Made{scaled(grid(8), 0x1p-1074), scaled(grid(8), 0x1p-1074)};
             }},
            {"largest",
             [&] {
                 const double max_magnitude = 0x1.fp1023;
                 return Made{scaled(inside(), -max_magnitude), scaled(inside(), max_magnitude)};
             }},
            {"any_magnitude",
             [&] {
                 const TrianglePair pair = touching_.magnitudes(thinned, -1074, 1020).front();
                 return Made{corners(pair.a), corners(pair.b)};
             }},
            {"forty_orders",
             [&] {
                 const TrianglePair pair = touching_.magnitudes(thinned, -40, 40).front();
                 return Made{corners(pair.a), corners(pair.b)};
             }},
        };
    }

    int below(int n) { return std::uniform_int_distribution(0, n - 1)(engine_); }
    double part(double low = 0) { return std::uniform_real_distribution<double>(low, 1)(engine_); }
    double coordinate() { return 2 * part() - 1; }
    Corners inside() { return {point(), point(), point()}; }
    Corners grid(int n) {
        const auto at = [&] { return double(below(n + 1)); };
        return {Point{at(), at(), at()}, Point{at(), at(), at()}, Point{at(), at(), at()}};
    }
    Corners degraded(Corners t) {
        switch (below(4)) {
        case 0:
            t[1] = t[0];
            break;
        case 1:
            t[2] = t[1] + (t[1] - t[0]);
            break;
        case 2:
            t = {t[0], t[0], t[0]};
        }
        return t;
    }

    static Triangle<double> triangle(const Corners& t) { return {t[0], t[1], t[2]}; }
    static Corners scaled(Corners t, double s) {
        for (Point& p : t)
            p = p * s;
        return t;
    }
    static Corners moved(Corners t, const Point& by) {
        for (Point& p : t)
            p = p + by;
        return t;
    }

  private:
    struct Frame {
        Point o, x, y, n; ///< orthonormal but for rounding
        Point at(double u, double v) const { return o + x * u + y * v; }
    };

    static Corners corners(const Triangle<double>& t) { return {t.a, t.b, t.c}; }
    static Point normalized(Point p) { return p * (1 / length(p)); }

    double ten_to(double low, double max_magnitude) {
        return std::pow(10, std::uniform_real_distribution<double>(low, max_magnitude)(engine_));
    }
    double gap() { return ten_to(-18, -1); }
    Point point() { return {part(), part(), part()}; }
    Point unit() {
        for (;;)
            if (const Point p{coordinate(), coordinate(), coordinate()};
                dot(p, p) > .01 && dot(p, p) < 1)
                return normalized(p);
    }
    Frame frame() {
        const Point x = unit(), n = normalized(cross(x, unit()));
        return {point(), x, cross(n, x), n};
    }
    Point on(const Corners& t) {
        const double u = part(), v = part();
        return t[0] * u + (t[1] * v + t[2] * (1 - v)) * (1 - u);
    }
    Corners sliver() {
        const Point a = point(), d = unit();
        return {a, a + d * part(.5), a + d * part() + unit() * ten_to(-16, -2)};
    }
    Corners needle() {
        const Point a = point();
        return {a, point(), a + unit() * ten_to(-18, -2)};
    }

    std::mt19937_64 engine_;
    PairFamilies touching_;
};

} // namespace boxwood::testing
