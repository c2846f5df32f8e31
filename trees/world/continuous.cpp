#include "trees/world/continuous.h"

#include "trees/world/detail/advance.h"
#include "trees/world/detail/straight_ways.h"

namespace boxwood {
FirstContact first_contact(const MeshTree& a, const Motion& motion_a, const MeshTree& b,
                           const Motion& motion_b, const ContinuousOptions& options, Work* work) {
    using namespace detail;
    check(options);
    if (a.empty() || b.empty())
        return {};
    const Approach approach{relative_speed(motion_a, a.bounds(), motion_b, b.bounds()),
                            motion_a.longest_way(a.bounds()) + motion_b.longest_way(b.bounds()),
                            reach_of(a.bounds(), motion_a.at(0)) +
                                reach_of(b.bounds(), motion_b.at(0)),
                            size_of(a.bounds()) + size_of(b.bounds()),
                            motion_a.longest_bend(a.bounds()) + motion_b.longest_bend(b.bounds())};
    const auto distance_at = [&](double t, const DistanceOptions& near) {
        return distance(a, b, relative_pose(motion_a.at(t), motion_b.at(t)), near, work);
    };
    const MovingMeshes meshes{a, motion_a, b, motion_b};
    const auto free_in = [&](const Stretch& stretch) {
        return free_stretch(meshes, stretch, work);
    };
    return advance(approach, options, distance_at, free_in);
}

} // namespace boxwood
