#pragma once

#include "kernels/convex/support.h"

#include <array>

/// The point of a simplex that is nearest to the origin: the sub-algorithm of GJK.
namespace boxwood::convex::detail {

/// At most four points of the difference A - B, the newest last, each with the point of A that it
/// came from; and the nearest point that was found last.
struct Simplex {
    struct Vertex {
        Vec3<double> w, on_a;
    };
    std::array<Vertex, 4> vertex;
    std::array<double, 4> weight{}; ///< of each vertex, >= 0, of sum 1 up to rounding
    int size = 0;

    Vec3<double> nearest{};   ///< the sum of weights times points
    Vec3<double> direction{}; ///< the same way, more accurate if `nearest` is small: square to the
                              ///< edge or face that it lies on; of any length, 0 if unknown
    bool encloses = false;    ///< the origin is in the tetrahedron

    void add(const Vertex& v) { vertex[static_cast<std::size_t>(size++)] = v; }
    bool holds(const Vec3<double>& w) const {
        for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i)
            if (vertex[i].w == w)
                return true;
        return false;
    }
    Vec3<double> on_a() const {
        Vec3<double> p{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i)
            p = p + weight[i] * vertex[i].on_a;
        return p;
    }
};

/// The nearest point of `from`, and in `to` (another one) only the vertices that it needs.
/// Parameters are solved for relative to the vertex nearest the origin, so that they are accurate
/// in small simplices far from it. Errors only make the point less near: it is a sum of the
/// vertices.
void reduce(const Simplex& from, Simplex& to);

/// The same, of every part of the simplex without asking which one faces the origin.
void reduce_thoroughly(const Simplex& from, Simplex& to);

/// Whether the ball of this radius around the origin is in the tetrahedron: proven, as each face is
/// in a half-space n.x >= radius |n|, up to 8u of the size of its points.
bool encloses_ball(const Simplex& tetrahedron, double radius);

/// A direction square to d, about as long.
inline Vec3<double> square_to(Vec3<double> d) {
    const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    return x <= y && x <= z ? Vec3<double>{0, -d.z, d.y}
           : y <= z         ? Vec3<double>{d.z, 0, -d.x}
                            : Vec3<double>{-d.y, d.x, 0};
}

} // namespace boxwood::convex::detail
