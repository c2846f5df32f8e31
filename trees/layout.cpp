#include "trees/layout.h"

namespace boxwood {

OrderedTriangles::OrderedTriangles(const Tree& tree, const TriangleMesh& mesh)
    : triangles(tree.size()), ids(tree.size()) {
    for (std::size_t slot = 0; slot < tree.size(); ++slot) {
        triangles[slot] = mesh.triangle(tree.order[slot]);
        ids[slot] = tree.order[slot];
    }
}

} // namespace boxwood
