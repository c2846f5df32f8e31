#pragma once

#include "trees/inspect/work.h"
#include "trees/world/detail/advance.h"
#include "trees/world/mesh_tree.h"
#include "trees/world/motion.h"

#include <optional>

namespace boxwood::detail {

/// What moves, and the extra width that it has.
struct MovingMeshes {
    const MeshTree& a;
    const Motion& motion_a;
    const MeshTree& b;
    const Motion& motion_b;
    double margin = 0; ///< of both together
};

/// Until when no vertex of a stretch comes near a face, and no edge an edge, of triangles that are
/// near at its start (kernels/continuous/tight_inclusion.h); nothing if there are too many of them.
std::optional<FreeStretch> free_stretch(const MovingMeshes& meshes, const Stretch& stretch,
                                        Work* work);

} // namespace boxwood::detail
