#pragma once

#include "kernels/primitives/triangle.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boxwood {

/// What is wrong with a mesh, or only unusual. Vertices at one place count as one. An edge is open
/// that belongs to one triangle, non-manifold that belongs to more than two, and turned against its
/// neighbour where two go through it the same way. Triangles that are set aside as bad (not finite,
/// without area, repeated) have no edges here.
struct MeshTriage {
    std::size_t triangles = 0, vertices = 0;
    std::size_t unused_vertices = 0;
    std::vector<std::uint32_t> missing_vertices; ///< triangles with a vertex that is not there
    std::vector<std::uint32_t> not_finite;       ///< ... with a NaN or an infinity
    std::vector<std::uint32_t> without_area;     ///< points and segments, exactly
    std::vector<std::uint32_t> repeated; ///< the corners of an earlier one, in whatever order
    /// Triangles beyond 2^60, which MeshTree and World refuse (MeshBvh: beyond 2^126). None is bad.
    std::vector<std::uint32_t> too_large;
    std::size_t open_edges = 0, non_manifold_edges = 0, turned_edges = 0;

    bool is_closed() const { return open_edges == 0 && non_manifold_edges == 0; }
    bool is_clean() const {
        return bad_triangles() == 0 && too_large.empty() && is_closed() && turned_edges == 0;
    }
    std::size_t bad_triangles() const {
        return missing_vertices.size() + not_finite.size() + without_area.size() + repeated.size();
    }
};

/// Looks at any mesh; never throws for what it finds.
MeshTriage triage(const TriangleMesh& mesh);

/// The numbers of the triangles that are not bad, ascending.
std::vector<std::uint32_t> good_triangles(const MeshTriage& triage);

/// The mesh without its bad triangles: triangle i is good_triangles(triage)[i] of the mesh.
/// Vertices that are not finite, which none of them has, are moved to the origin.
TriangleMesh without_bad_triangles(const TriangleMesh& mesh, const MeshTriage& triage);

} // namespace boxwood
