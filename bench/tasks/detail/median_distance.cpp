#include "bench/tasks/detail/median_distance.h"

#include "trees/world/mesh_pairs.h"

#include <algorithm>
#include <vector>

namespace boxwood::bench {

double median_distance(const Scene& scene) {
    if (scene.poses.empty() || scene.mesh.triangles.empty())
        return 0;
    const MeshTree tree(scene.mesh);
    const MeshTree copy(scene.copy());
    std::vector<double> distances;
    for (const Pose& pose : scene.poses)
        distances.push_back(distance(tree, copy, pose).distance);
    std::ranges::sort(distances);
    const std::size_t n = distances.size();
    const Aabb<float>& box = tree.bounds();
    return std::max((distances[(n - 1) / 2] + distances[n / 2]) / 2,
                    1e-3 * length(Vec3<double>(box.max) - Vec3<double>(box.min)));
}

} // namespace boxwood::bench
