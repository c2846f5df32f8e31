#include "kernels/convex/motion.h"
#include "trees/testing/test_bodies.h"
#include "trees/world/bodies/detail/swept_box.h"
#include "trees/world/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace boxwood {
namespace {

/// A mesh and a box in one place go the same way, however near half a turn.
TEST(ShapeMotions, OfMeshesAndConvexShapesAreOne) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-2, 2), exponent(-17, -1);
    const BodyShape box(convex::Box{{1, 2, 3}});
    for (int k = 0; k < 4000; ++k) {
        const Pose from = random_pose(random, {place(random), place(random), place(random)});
        Vec3<double> axis{place(random), place(random), place(random)};
        if (k % 3 == 0)
            axis = {k % 2 ? 1. : 0., k % 2 ? 0. : 1., 0};
        axis = axis * (1 / length(axis));
        const double less = k % 5 ? std::pow(10, exponent(random)) : 0;
        const double angle = (k % 4 < 2 ? 1 : -1) * (std::numbers::pi - less);
        Pose to = from;
        to.rotation = product(rotation_about(axis, angle), from.rotation);
        to.translation = to.translation + Vec3<double>{place(random), 0, place(random)};
        for (const MotionPath path : {MotionPath::linear, MotionPath::screw}) {
            const Motion motion(from, to, path);
            const convex::Motion other = detail::convex_motion({box, from, to, path});
            for (const double t : {.25, .5, 1.})
                for (const Vec3<double> p : {Vec3<double>{0, 0, 0}, Vec3<double>{1, -2, 3}})
                    ASSERT_LT(length(motion.at(t)(p) - convex::pose_at(other, t)(p)), 1e-13)
                        << k << " at " << t;
            ASSERT_LT(length(convex::pose_at(other, 1)({1, -2, 3}) - to({1, -2, 3})), 1e-13);
        }
    }
}

} // namespace
} // namespace boxwood
