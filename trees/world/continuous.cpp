#include "trees/world/continuous.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace boxwood {
namespace {

double size_of(const MeshTree& mesh) {
    const Aabb<float>& box = mesh.bounds();
    return length(Vec3<double>(box.max) - Vec3<double>(box.min));
}

/// The greatest |coordinate| that a mesh comes to in a pose, or more.
double reach_of(const MeshTree& mesh, const Pose& pose) {
    const Aabb<float>& box = mesh.bounds();
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += std::max(std::abs(double{box.min[axis]}), std::abs(double{box.max[axis]})) +
                 std::abs(pose.translation[axis]);
    return reach;
}

} // namespace

FirstContact first_contact(const MeshTree& a, const Motion& motion_a, const MeshTree& b,
                           const Motion& motion_b, const ContinuousOptions& options, Work* work) {
    if (!(options.tolerance >= 0))
        throw std::invalid_argument("a tolerance must be at least 0");
    FirstContact found;
    if (a.empty() || b.empty())
        return found;
    const double speed = motion_a.longest_way(a.bounds()) + motion_b.longest_way(b.bounds());
    // What a pose may be off by moves corners by as much.
    const double rounding =
        0x1p-44 * (speed + reach_of(a, motion_a.at(0)) + reach_of(b, motion_b.at(0)));
    const double tolerance =
        std::max(options.tolerance > 0 ? options.tolerance : 0x1p-36 * (size_of(a) + size_of(b)),
                 4 * rounding);
    DistanceOptions near;
    double t = 0;
    while (found.steps < options.max_steps) {
        const MeshDistance d =
            distance(a, b, relative_pose(motion_a.at(t), motion_b.at(t)), near, work);
        ++found.steps;
        if (d.lo <= tolerance && d.hi > tolerance && near.relative > 0) {
            near.relative = 0; // look again
            continue;
        }
        if (d.hi <= tolerance || d.lo <= 2 * rounding) {
            found.hit = Answer::yes;
            found.t_free = found.t_hit = t;
            found.triangles = d.triangles;
            return found;
        }
        if (t >= 1)
            return found;
        // Nearer than the tolerance, so that the end is reached.
        const double free = std::max(d.lo - 2 * rounding, 0.0);
        const double step = speed > 0 ? free / speed * (1 - 0x1p-40) : 1;
        found.t_free = t = std::min(1.0, t + step);
        near.start = d.triangles;
        // Far apart a rough distance will do.
        near.relative = d.lo > 64 * tolerance ? .1 : 0;
    }
    found.hit = Answer::maybe;
    found.t_free = t;
    return found;
}

} // namespace boxwood
