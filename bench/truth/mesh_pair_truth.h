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
/// and whether any pair is nearer: of all, up to 2,048 triangles, else of 256 of each side with all
/// of the other, by the certified kernel. Of more triangles, what one contender named counts for
/// those that are judged after it alone.
std::unique_ptr<Truth> make_mesh_distance_truth(const Scene& scene, unsigned threads);

} // namespace boxwood::bench
