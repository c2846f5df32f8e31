#pragma once

#include "kernels/convex/support.h"

#include <array>
#include <cstddef>
#include <span>

/// The point of a simplex that is nearest to the origin: the sub-algorithm of GJK.
namespace boxwood::convex::detail {

/// A point of the difference A - B, and the point of A that it came from.
struct Vertex {
    Vec3<double> w, on_a;
};
using Vertices = std::array<Vertex, 4>;

/// The nearest point of a simplex.
struct Nearest {
    Vec3<double> point{};     ///< the sum of weights times vertices
    Vec3<double> direction{}; ///< the same way, more accurate if `point` is small: square to the
                              ///< edge or face that it lies on; of any length, 0 if unknown
    std::array<double, 4> weight; ///< of each vertex, >= 0, of sum 1 up to rounding
    unsigned used = 0;            ///< bits of the vertices that it needs
    bool encloses = false;        ///< the origin is in the tetrahedron

    Vec3<double> on_a(const Vertices& vertices) const {
        Vec3<double> p{};
        for (std::size_t i = 0; i < 4; ++i)
            if (used >> i & 1)
                p = p + weight[i] * vertices[i].on_a;
        return p;
    }
};

/// Of the vertices whose bits are set. Parameters are solved for relative to the vertex nearest the
/// origin, so that they are accurate in small simplices far from it. Errors only make the point
/// less near: it is a sum of the vertices. thoroughly: of every part, without asking which one
/// faces the origin.
void find_nearest(const Vertices& vertices, unsigned used, bool thoroughly, Nearest& nearest);

/// At most four vertices.
struct Simplex {
    Vertices vertex;
    int size = 0;

    void add(const Vertex& v) { vertex[static_cast<std::size_t>(size++)] = v; }
};

/// Whether the ball of this radius around the origin is in the tetrahedron: proven, as each face is
/// in a half-space n.x >= radius |n|, up to 8u of the size of its points.
bool encloses_ball(const Vertices& tetrahedron, double radius);
/// The same of two pyramids on one ring of three or four points, counterclockwise seen from `top`.
bool encloses_ball(std::span<const Vec3<double>> ring, Vec3<double> top, Vec3<double> bottom,
                   double radius);

/// A direction square to d, about as long.
inline Vec3<double> square_to(Vec3<double> d) {
    const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
    return x <= y && x <= z ? Vec3<double>{0, -d.z, d.y}
           : y <= z         ? Vec3<double>{d.z, 0, -d.x}
                            : Vec3<double>{-d.y, d.x, 0};
}

} // namespace boxwood::convex::detail
