#pragma once

#include "kernels/decision.h"
#include "trees/world/mesh_pairs.h"
#include "trees/world/motion.h"

namespace boxwood {

struct ContinuousOptions {
    /// Nearer than this they touch, scene units; 0: 2^-36 of the two meshes' sizes together.
    double tolerance = 0;
    /// Steps after which it is left open whether they touch: those that turn about each other just
    /// beyond the tolerance need many.
    std::size_t max_steps = 10'000;
};

/// When two moving meshes first touch. From 0 to t_free they do not, which is certain: a step is no
/// longer than the least distance between bounds takes at the greatest speed, or than all vertices
/// and faces, and edges and edges, that come near meanwhile are shown to stay apart; so nothing
/// thin is passed through. At t_hit they are within the tolerance, or their distance has a lower
/// bound of no more than the rounding of their poses (curved shapes, whose bounds are wide near
/// contact). Both are 1 where they never touch.
struct FirstContact {
    Answer hit = Answer::no; ///< maybe: after max_steps; then t_hit is 1
    double t_free = 1, t_hit = 1;
    Pair triangles{~0u, ~0u}; ///< that touch
    std::size_t steps = 0;
};

/// Conservative advancement; where its steps are short, features of near triangles on straight ways
/// (kernels/continuous/tight_inclusion.h), how far these are off the true ones counted in. Throws
/// std::invalid_argument for a tolerance below 0 or NaN.
/// Source: Mirtich 1996, "Impulse-based Dynamic Simulation of Rigid Body Systems".
FirstContact first_contact(const MeshTree& a, const Motion& motion_a, const MeshTree& b,
                           const Motion& motion_b, const ContinuousOptions& options = {},
                           Work* work = nullptr);

} // namespace boxwood
