#pragma once

#include "scenes/hard_cases/hard_cases.h"
#include "scenes/sampling/random.h"

namespace boxwood {

/// 10^k: the nearest double for |k| <= 22, the same bits everywhere for any k.
double power_of_ten(int k);

/// A factor 10^-k times at least 1/2 and below 1.
double draw_small(Draws& draws, int k);

/// A rotation about the origin by a quaternion of integers up to 64: each entry is a quotient of
/// integers, rounded once, so that the matrix is orthonormal up to 2^-53 per entry.
RigidTransform<double> draw_rotation(Draws& draws);
/// The rotation of the quaternion w + x i + y j + z k, integers of at most 2^25, not all 0.
RigidTransform<double> rotation_of(double w, double x, double y, double z);

/// A vector with coordinates uniform in [-1, 1).
Vec3<double> draw_offset(Draws& draws);

/// A triangle with corners in the unit ball around the origin.
Triangle<double> draw_triangle(Draws& draws);

/// a + u (b - a) + v (c - a), rounded.
Vec3<double> point_of(const Triangle<double>& t, double u, double v);
/// A point inside, off the edges by at least 1 / 16 in u, v and 1 - u - v.
Vec3<double> draw_inside(const Triangle<double>& t, Draws& draws);

/// (b - a) x (c - a), rounded.
Vec3<double> normal_of(const Triangle<double>& t);

Triangle<double> operator+(const Triangle<double>& t, Vec3<double> by);
Triangle<double> operator*(const RigidTransform<double>& transform, const Triangle<double>& t);

/// p 2^exponent, exact away from under- and overflow.
Vec3<double> scaled(Vec3<double> p, int exponent);
Vec3<float> scaled(Vec3<float> p, int exponent);
Triangle<double> scaled(const Triangle<double>& t, int exponent);

/// Where the families of rounded coordinates stay exact: their numbers lie within 2^-60 .. 2^60 and
/// have bits down to 2^-160, or are 0.
constexpr int rounded_scale = 860;

/// A family of rounded coordinates, without a k.
HardCaseFamily rounded_family(std::string_view name, std::string_view summary, Panel panel,
                              decltype(HardCaseFamily::generate) generate);
HardCaseFamily with_k(HardCaseFamily family, std::string_view meaning, int k, int min_k, int max_k);

/// Pairs of triangles drawn in real numbers, rounded as they come, then scaled by 2^scale.
using DrawRoundedPair = TrianglePairCase (*)(Draws& draws, int k);
template <DrawRoundedPair draw>
Cases rounded_pairs(const HardCaseSpec& spec, const Random& random) {
    std::vector<TrianglePairCase> cases(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        cases[i] = draw(draws, *spec.k);
        cases[i].a = scaled(cases[i].a, spec.scale);
        cases[i].b = scaled(cases[i].b, spec.scale);
    }
    return cases;
}

} // namespace boxwood
