#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

/// Of the poses of a scene: whether the copy touches the mesh, by rational arithmetic on all pairs
/// of triangles whose boxes overlap, which a sweep finds without a tree. The copy's corners are
/// those that the pose gives in doubles.
std::unique_ptr<Truth> make_touch_truth(const Scene& scene, unsigned threads);
/// Which triangles do.
std::unique_ptr<Truth> make_touching_truth(const Scene& scene, unsigned threads);

/// How far they are apart: the distance of the triangles that were named, in rational arithmetic,
/// and whether any pair is nearer (nearest_triangles.h). Closest points, if they are given, lie on
/// those triangles, as far apart as is said: to 2^-44 of the largest coordinate where distances are
/// certified, which must have points (distance_kernel.h); of others to 2^-40, by floats 2^-20.
std::unique_ptr<Truth> make_mesh_distance_truth(const Scene& scene, unsigned threads);
/// Whether they are at most a tolerance apart.
std::unique_ptr<Truth> make_within_truth(const Scene& scene, double tolerance, unsigned threads);

/// Where they touch: every touching pair of triangles, more than once if need be, and no other; the
/// deepest first; each point no farther from one of the two than the depth; each normal of length
/// 1; and moved by depth * normal the copy's triangle is off the other one or only touches it, but
/// no farther off along the normal. Lengths to 2^-30 of the mesh's size, as depths are rounded; of
/// peers, which search for them, to 2^-19.
std::unique_ptr<Truth> make_contact_truth(const Scene& scene, unsigned threads);

} // namespace boxwood::bench
