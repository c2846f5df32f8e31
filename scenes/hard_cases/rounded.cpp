#include "scenes/hard_cases/rounded.h"

#include "scenes/hard_cases/lattice.h"

#include <algorithm>
#include <cmath>

namespace boxwood {

double power_of_ten(int k) {
    double power = 1;
    for (int i = 0; i < std::abs(k); ++i)
        power *= 10;
    return k < 0 ? 1 / power : power;
}

double draw_small(Draws& draws, int k) { return power_of_ten(-k) * draws.uniform(0.5, 1); }

RigidTransform<double> rotation_of(double w, double x, double y, double z) {
    const double square = w * w + x * x + y * y + z * z;
    const auto row = [&](double a, double b, double c) {
        return Vec3<double>{a / square, b / square, c / square};
    };
    return {{row(w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)),
             row(2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)),
             row(2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z)},
            {}};
}

RigidTransform<double> draw_rotation(Draws& draws) {
    double q[4];
    do
        for (double& component : q)
            component = static_cast<double>(draw_integer(draws, -64, 64));
    while (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0);
    return rotation_of(q[0], q[1], q[2], q[3]);
}

Vec3<double> draw_offset(Draws& draws) { return 2.0 * draws.in_cube() - Vec3<double>{1, 1, 1}; }

Triangle<double> draw_triangle(Draws& draws) {
    return {draws.in_ball(), draws.in_ball(), draws.in_ball()};
}

Vec3<double> point_of(const Triangle<double>& t, double u, double v) {
    return t.a + u * (t.b - t.a) + v * (t.c - t.a);
}

Vec3<double> draw_inside(const Triangle<double>& t, Draws& draws) {
    double u = draws.uniform(), v = draws.uniform();
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    constexpr double inset = 1.0 / 16;
    return point_of(t, inset + (1 - 3 * inset) * u, inset + (1 - 3 * inset) * v);
}

Vec3<double> normal_of(const Triangle<double>& t) { return cross(t.b - t.a, t.c - t.a); }

Triangle<double> operator+(const Triangle<double>& t, Vec3<double> by) {
    return {t.a + by, t.b + by, t.c + by};
}

Triangle<double> operator*(const RigidTransform<double>& transform, const Triangle<double>& t) {
    return {transform(t.a), transform(t.b), transform(t.c)};
}

Vec3<double> scaled(Vec3<double> p, int exponent) {
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

Vec3<float> scaled(Vec3<float> p, int exponent) {
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

Triangle<double> scaled(const Triangle<double>& t, int exponent) {
    return {scaled(t.a, exponent), scaled(t.b, exponent), scaled(t.c, exponent)};
}

HardCaseFamily rounded_family(std::string_view name, std::string_view summary, Panel panel,
                              decltype(HardCaseFamily::generate) generate) {
    return {.name = name,
            .summary = summary,
            .panel = panel,
            .scale_min = -rounded_scale,
            .scale_max = rounded_scale,
            .generate = generate};
}

HardCaseFamily with_k(HardCaseFamily family, std::string_view meaning, int k, int min_k,
                      int max_k) {
    family.k_meaning = meaning;
    family.k_default = k;
    family.k_min = min_k;
    family.k_max = max_k;
    return family;
}

} // namespace boxwood
