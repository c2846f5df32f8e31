#pragma once

#include "kernels/convex/signed_distance.h"
#include "trees/world/continuous.h"
#include "trees/world/mesh_contacts.h"
#include "trees/world/mesh_pairs.h"
#include "trees/world/motion.h"

#include <vector>

namespace boxwood {

/// Questions about a mesh, which is its surface, and a convex shape of any kind, which is solid: a
/// mesh that lies inside touches it. The shape stands at `shape_in_mesh` in the mesh's frame.
/// Certified, as kernels/convex/ is: the triangles are exactly as they are given, the shape is
/// where the doubles of the pose say.
/// Throws std::invalid_argument for a pose with a number that is not finite or a matrix off a
/// rotation by more than 2^-12 (checked_pose mends it), and for a shape with a length that is
/// negative or not finite, or that lies or reaches beyond 2^90. `work`, if given, is added to.

/// Whether they share a point: yes and no are proven, maybe is within rounding. Stops at the first
/// triangle that certainly does.
Decision collide(const MeshTree& mesh, const convex::Shape& shape, const Pose& shape_in_mesh,
                 Work* work = nullptr);

/// The least distance, between bounds as wide as those of signed_distance: 2^-36 of it and about
/// 2e-14 of the size of both, or what the options allow; of curved shapes (cylinders, cones,
/// ellipsoids) in rare cases more, to 2^-19 of it seen, where the search cannot end as it should.
/// point_a is on the mesh, point_b on the shape, in the mesh's frame; triangles.a is the triangle,
/// triangles.b 0, as of `start`. 0, and lo = hi = 0, where they certainly touch: then both points
/// are one that they share, up to rounding.
MeshDistance distance(const MeshTree& mesh, const convex::Shape& shape, const Pose& shape_in_mesh,
                      const DistanceOptions& options = {}, Work* work = nullptr);

/// Whether they are at most `tolerance` apart, certain but within the width of those bounds: then
/// lo and hi lie on both sides of the tolerance, and `within` is true.
MeshWithin within(const MeshTree& mesh, const convex::Shape& shape, const Pose& shape_in_mesh,
                  double tolerance, Work* work = nullptr);

/// One of each triangle that touches the shape, or may within rounding (then about 0 deep), so that
/// there are none exactly where collide says no; and of each that is within options.margin, whose
/// depth is then minus its distance; the deepest first and then by triangles (a; b is 0). The shape
/// leaves the triangle when it moves by depth * normal, the least that does, and the point is
/// midway between the two places that part last, in the mesh's frame.
std::vector<Contact> contacts(const MeshTree& mesh, const convex::Shape& shape,
                              const Pose& shape_in_mesh, const ContactOptions& options = {},
                              Work* work = nullptr);

/// Conservative advancement, as of two meshes (continuous.h); half-spaces and planes may turn, too.
FirstContact first_contact(const MeshTree& mesh, const Motion& motion, const convex::Shape& shape,
                           const Motion& shape_motion, const ContinuousOptions& options = {},
                           Work* work = nullptr);

} // namespace boxwood
