#include "kernels/continuous/detail/inclusion.h"

#include "kernels/continuous/detail/nearest_direction.h"
#include "kernels/oracle/exact_vector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace boxwood::detail::inclusion {
namespace {

using Vector = Vec3<double>;

class Random {
  public:
    double real() { return std::uniform_real_distribution<double>(-1, 1)(bits_); }
    double part() { return std::uniform_real_distribution<double>(0, 1)(bits_); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(bits_); }
    Vector vector() { return {real(), real(), real()}; }
    /// Of sizes that differ by axis, in part far from the origin, in part with small motions.
    LinearMotion motion() {
        LinearMotion m;
        const Vector size{std::ldexp(1, whole(-40, 40)), std::ldexp(1, whole(-3, 3)), 1};
        const Vector away = vector() * std::ldexp(1, whole(-20, 30));
        const double speed = std::ldexp(1, -whole(0, 50));
        const auto scaled = [&](Vector v) {
            return Vector{v.x * size.x, v.y * size.y, v.z * size.z};
        };
        for (std::size_t i = 0; i < 4; ++i) {
            m.start[i] = scaled(vector() + away);
            m.end[i] = m.start[i] + scaled(vector() * speed);
        }
        return m;
    }

  private:
    std::mt19937_64 bits_{23};
};

/// d.F(t, u, v) without rounding, scaled as the kernel scales it.
template <int n>
mpq_class exact_value(const LinearMotion& m, int exponent, Vector d, double t, double u, double v) {
    using oracle::exact;
    mpq_class sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        std::array<mpq_class, 4> x;
        for (std::size_t i = 0; i < 4; ++i)
            x[i] = (1 - exact(t)) * exact(m.start[i][axis]) + exact(t) * exact(m.end[i][axis]);
        const mpq_class p = exact(u), q = exact(v);
        const mpq_class f =
            n == 3 ? mpq_class(x[0] - ((1 - p - q) * x[1] + p * x[2] + q * x[3]))
                   : mpq_class((1 - p) * x[0] + p * x[1] - ((1 - q) * x[2] + q * x[3]));
        sum += exact(d[axis]) * f;
    }
    return oracle::scaled(sum, -exponent);
}

template <int n> void hold_bound(std::uint64_t* used) {
    Random random;
    for (int i = 0; i < 500; ++i) {
        const LinearMotion m = random.motion();
        const std::uint64_t bits = largest_bits(m);
        const Inclusion<n> f(m, bits);
        const int exponent = std::ilogb(std::bit_cast<double>(bits)) + 1;
        const double scale = std::ldexp(1.0, -exponent);
        double largest[3] = {};
        for (const auto* points : {&m.start, &m.end})
            for (const Vector& p : *points)
                for (int axis = 0; axis < 3; ++axis)
                    largest[axis] = std::max(largest[axis], std::abs(p[axis]) * scale);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LE(f.bound[axis], 36.2 * 0x1p-53 * largest[axis]);
        for (int k = 0; k < 10; ++k) {
            const double t = k == 0 ? 0 : k == 1 ? 1 : random.part();
            double u = random.part(), v = random.part();
            if (n == 3 && u + v > 1) {
                u /= 2;
                v /= 2;
            }
            const Vector d = k % 3 == 0 ? Vector{k % 2 == 0 ? 1.0 : 0.0, 1, 0} : random.vector();
            const double value = mean(dot(d, f.start.at(u, v)), dot(d, f.end.at(u, v)), t);
            const mpq_class error =
                abs(mpq_class(oracle::exact(value) - exact_value<n>(m, exponent, d, t, u, v)));
            const mpq_class margin = oracle::exact(f.margin(d));
            ASSERT_LE(error, margin) << i << " " << k;
            *used += error * 20 > margin; // the bound is within 20 of what is seen
        }
    }
}

TEST(Inclusion, RoundingStaysWithinItsBound) {
    std::uint64_t used = 0;
    hold_bound<3>(&used);
    hold_bound<4>(&used);
    EXPECT_GT(used, 30u);
}

TEST(Inclusion, BoundIsBelowThePublishedOne) {
    // Of 6.661e-15 and 6.217e-15 times the largest |x| rounded up to a power of two.
    EXPECT_LT(36.2 * 0x1p-53, 6.217e-15);
}

TEST(Inclusion, ScalesAreExactPowersOfTwo) {
    Random random;
    for (const int k : {-1000, -300, 0, 300, 1000}) {
        LinearMotion m, scaled;
        for (std::size_t i = 0; i < 4; ++i) {
            m.start[i] = random.vector();
            m.end[i] = random.vector();
            scaled.start[i] = m.start[i] * std::ldexp(1, k);
            scaled.end[i] = m.end[i] * std::ldexp(1, k);
        }
        const Inclusion<4> f(m, largest_bits(m)), g(scaled, largest_bits(scaled));
        EXPECT_EQ(f.start.a, g.start.a);
        EXPECT_EQ(f.end.c, g.end.c);
        EXPECT_EQ(f.bound, g.bound);
        EXPECT_EQ(f.size, g.size);
    }
}

TEST(Patch, HalvesCoverItExactly) {
    // A point of the parameters is in one half or the other, down to a depth of 48.
    Random random;
    for (int i = 0; i < 200; ++i) {
        Patch<3> triangle = Patch<3>::whole();
        Patch<4> square = Patch<4>::whole();
        for (int depth = 0; depth < 48; ++depth) {
            const int edge = random.whole(0, 2);
            const Patch<3> before = triangle;
            const Patch<3> other = triangle.halve(edge);
            const auto a = static_cast<std::size_t>(edge), b = (a + 1) % 3;
            // The cut goes through the exact middle of the edge.
            EXPECT_EQ(triangle.u[b], other.u[a]);
            EXPECT_EQ(triangle.v[b], other.v[a]);
            using oracle::exact;
            EXPECT_EQ(2 * exact(other.u[a]), exact(before.u[a]) + exact(before.u[b]));
            EXPECT_EQ(2 * exact(other.v[a]), exact(before.v[a]) + exact(before.v[b]));
            EXPECT_EQ(triangle.u[a], before.u[a]);
            EXPECT_EQ(other.u[b], before.u[b]);
            if (random.whole(0, 1) == 0)
                triangle = other;

            const Patch<4> whole = square;
            const Patch<4> rest = square.halve(edge % 2);
            EXPECT_EQ(square.u[0], whole.u[0]);
            EXPECT_EQ(square.v[0], whole.v[0]);
            EXPECT_EQ(rest.u[2], whole.u[2]);
            EXPECT_EQ(rest.v[2], whole.v[2]);
            EXPECT_EQ(edge % 2 == 0 ? square.u[1] : square.v[2],
                      edge % 2 == 0 ? rest.u[0] : rest.v[0]);
            for (const Patch<4>& p : {square, rest}) { // still a rectangle
                EXPECT_EQ(p.u[0], p.u[3]);
                EXPECT_EQ(p.u[1], p.u[2]);
                EXPECT_EQ(p.v[0], p.v[1]);
                EXPECT_EQ(p.v[2], p.v[3]);
                EXPECT_LT(p.u[0], p.u[1]);
                EXPECT_LT(p.v[0], p.v[3]);
            }
            if (random.whole(0, 1) == 0)
                square = rest;
        }
    }
}

/// The distance from sampling the polygon: never below the true one.
template <std::size_t n> double sampled(const std::array<Vector, n>& c) {
    double shortest = length(c[0]);
    constexpr int steps = 60;
    for (int i = 0; i <= steps; ++i)
        for (int j = 0; j <= (n == 3 ? steps - i : steps); ++j) {
            const double u = i / double(steps), v = j / double(steps);
            shortest = std::min(shortest, length(c[0] + (c[1] - c[0]) * u + (c[n - 1] - c[0]) * v));
        }
    return shortest;
}

template <int n> void hold_nearest() {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        std::array<Vector, n> c;
        for (Vector& p : c)
            p = i % 2 == 0 ? random.vector()
                           : Vector{double(random.whole(-2, 2)), double(random.whole(-2, 2)),
                                    double(random.whole(-2, 2))};
        if constexpr (n == 4)
            c[2] = c[1] + (c[3] - c[0]);
        const Nearest<n> nearest = nearest_to_origin<n>(c);
        const double reference = sampled(c);
        EXPECT_LE(nearest.distance, reference + 1e-12);
        EXPECT_GE(nearest.distance, reference - 0.1);
        Vector p{};
        double sum = 0;
        for (std::size_t k = 0; k < n; ++k) {
            EXPECT_GE(nearest.weights[k], -1e-9);
            sum += nearest.weights[k];
            p = p + c[k] * nearest.weights[k];
        }
        EXPECT_NEAR(sum, 1, 1e-9);
        EXPECT_NEAR(length(p), nearest.distance, 1e-9);
        if (nearest.distance < 1e-6)
            continue;
        for (const Vector& q : c) // the plane across the direction has the polygon beyond it
            EXPECT_GE(dot(nearest.direction, q),
                      nearest.distance * length(nearest.direction) - 1e-6);
    }
}

TEST(NearestToOrigin, OfTrianglesAndParallelograms) {
    hold_nearest<3>();
    hold_nearest<4>();
}

} // namespace
} // namespace boxwood::detail::inclusion
