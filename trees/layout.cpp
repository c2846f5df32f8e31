#include "trees/layout.h"

namespace boxwood {

void TriangleBlock8::set(std::uint32_t lane, const TriangleMesh& mesh, std::uint32_t triangle) {
    const Triangle<float> t = mesh.triangle(triangle);
    for (int axis = 0; axis < 3; ++axis) {
        corner[0][axis][lane] = t.a[axis];
        corner[1][axis][lane] = t.b[axis];
        corner[2][axis][lane] = t.c[axis];
    }
    id[lane] = triangle;
}

} // namespace boxwood
