#include "trees/world/continuous.h"

#include "trees/world/detail/advance.h"

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
                            size_of(a.bounds()) + size_of(b.bounds())};
    return advance(approach, options, [&](double t, const DistanceOptions& near) {
        return distance(a, b, relative_pose(motion_a.at(t), motion_b.at(t)), near, work);
    });
}

} // namespace boxwood
