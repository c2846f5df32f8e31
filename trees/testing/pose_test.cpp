#include "trees/world/pose.h"

#include "trees/testing/test_meshes.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

#if __has_include(<Eigen/Geometry>)
#include <Eigen/Geometry>
#endif

namespace boxwood {
namespace {

TEST(Poses, RelativeOnesLeadBack) {
    const double q[16] = {0, -1, 0, 3, 1, 0, 0, 4, 0, 0, 1, 5, 0, 0, 0, 1};
    const Pose a = pose_of_matrix(q);
    const Pose b = relative_pose(a, a);
    for (std::size_t row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            EXPECT_EQ(b.rotation[row][column], static_cast<int>(row) == column ? 1 : 0);
    EXPECT_EQ(b.translation, (Vec3<double>{}));
}

TEST(Poses, MustBeRigid) {
    Pose pose;
    pose.rotation[0] = {1.0003, 0, 0};
    EXPECT_DOUBLE_EQ(checked_pose(pose).rotation[0].x, 1);
    pose.rotation[0] = {1.1, 0, 0};
    EXPECT_THROW(checked_pose(pose), std::invalid_argument);
    pose.rotation[0] = {-1, 0, 0};
    EXPECT_THROW(checked_pose(pose), std::invalid_argument);
    pose = {};
    pose.translation.x = std::numeric_limits<double>::infinity();
    EXPECT_THROW(checked_pose(pose), std::invalid_argument);
}

TEST(Poses, RelativeOnesBringPointsBack) {
    std::mt19937 random(6);
    for (int k = 0; k < 20; ++k) {
        const Pose a = random_pose(random, {1, 2, 3}), b = random_pose(random, {-4, 5, .5});
        const Vec3<double> p{.3, -.2, .7};
        const Vec3<double> apart = a(relative_pose(a, b)(p)) - b(p);
        EXPECT_LT(length(apart), 1e-14);
    }
}

#if __has_include(<Eigen/Geometry>)
TEST(Poses, AreMadeOfEigensTransforms) {
    const Eigen::Isometry3d turned =
        Eigen::Translation3d(1, 2, 3) * Eigen::AngleAxisd(.7, Eigen::Vector3d(1, 2, 2) / 3);
    const Pose pose = pose_of(turned);
    const Eigen::Vector3d image = turned * Eigen::Vector3d(4, 5, 6);
    const Vec3<double> ours = pose(Vec3<double>{4, 5, 6});
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(ours[axis], image[axis], 1e-14);
    EXPECT_TRUE(transform_of<Eigen::Isometry3d>(pose).isApprox(turned, 1e-15));
    EXPECT_TRUE(
        transform_of<Eigen::Isometry3d>(pose_of(turned.cast<float>())).isApprox(turned, 1e-6));
    Eigen::Affine3d affine = turned;
    EXPECT_TRUE(transform_of<Eigen::Affine3d>(pose_of(affine)).isApprox(affine, 1e-15));
    affine.scale(2);
    EXPECT_THROW(pose_of(affine), std::invalid_argument);
}
#endif

} // namespace
} // namespace boxwood
