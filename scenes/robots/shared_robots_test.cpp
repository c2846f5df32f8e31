/// Robots that others made, which are no part of the project: read where they are.

#include "kernels/kinematics/kinematic_tree.h"
#include "scenes/robots/urdf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace boxwood {
namespace {

namespace fs = std::filesystem;

const fs::path robots = "../shared/data/robots";
#define BOXWOOD_NEEDS_ROBOTS()                                                                     \
    if (!fs::is_directory(robots))                                                                 \
    GTEST_SKIP() << robots << " is not here: the sample robots are no part of the project"

TEST(SharedRobots, PandaLoads) {
    BOXWOOD_NEEDS_ROBOTS();
    const UrdfRobot panda = read_urdf(robots / "panda/panda.urdf");
    EXPECT_EQ(panda.description.links.size(), 12u);
    EXPECT_EQ(panda.description.joints.size(), 11u);
    EXPECT_EQ(panda.meshes.size(), 10u); // both fingers have one
    const KinematicTree tree(panda.description);
    EXPECT_EQ(tree.n_values(), 8u); // seven joints, and the fingers move as one
    EXPECT_EQ(tree.ranges()[3].lower, -3.1416);
    std::size_t triangles = 0;
    for (const TriangleMesh& mesh : panda.meshes)
        triangles += mesh.triangles.size();
    EXPECT_EQ(triangles, 2332u);
}

TEST(SharedRobots, Z1Loads) {
    BOXWOOD_NEEDS_ROBOTS();
    const UrdfRobot z1 = read_urdf(robots / "z1/z1.urdf");
    const KinematicTree tree(z1.description);
    EXPECT_EQ(tree.n_values(), 7u);
    EXPECT_EQ(z1.description.links[tree.root()].name, "world");
    ASSERT_FALSE(z1.meshes.empty());
    for (std::size_t i = 0; i < z1.meshes.size(); ++i)
        EXPECT_EQ(z1.meshes[i].triangles.size(), (fs::file_size(z1.mesh_files[i]) - 84) / 50);
}

using Matrix = std::array<std::array<long double, 4>, 4>;

Matrix times(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t k = 0; k < 4; ++k)
                out[i][j] += a[i][k] * b[k][j];
    return out;
}

/// The frames of Panda's joints by the parameters that its maker publishes (Denavit and Hartenberg,
/// in Craig's form): Rot_x(alpha) Trans_x(a) Rot_z(theta) Trans_z(d).
std::array<Matrix, 8> panda_frames(std::span<const double> angles) {
    constexpr long double right = std::numbers::pi_v<long double> / 2;
    constexpr long double a[]{0, 0, 0, .0825L, -.0825L, 0, .088L, 0};
    constexpr long double d[]{.333L, 0, .316L, 0, .384L, 0, 0, .107L};
    constexpr long double alpha[]{0, -right, right, right, -right, right, right, 0};
    std::array<Matrix, 8> frames;
    Matrix all{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    for (std::size_t i = 0; i < 8; ++i) {
        const long double theta = i < 7 ? static_cast<long double>(angles[i]) : 0;
        const long double ca = std::cos(alpha[i]), sa = std::sin(alpha[i]), ct = std::cos(theta),
                          st = std::sin(theta);
        const Matrix step{{{ct, -st, 0, a[i]},
                           {st * ca, ct * ca, -sa, -sa * d[i]},
                           {st * sa, ct * sa, ca, ca * d[i]},
                           {0, 0, 0, 1}}};
        frames[i] = all = times(all, step);
    }
    return frames;
}

TEST(SharedRobots, PandaStandsWhereItsMakerSays) {
    BOXWOOD_NEEDS_ROBOTS();
    const RobotDescription panda = read_urdf(robots / "panda/panda.urdf").description;
    const KinematicTree tree(panda);
    std::vector<RigidTransform<double>> poses(tree.n_links());
    const double quarter = std::numbers::pi / 4;
    std::vector<double> values{0, -quarter, 0, -3 * quarter, 0, 2 * quarter, quarter, 0};
    tree.forward(values, poses); // "ready": the flange is at (0.307, 0, 0.590)
    EXPECT_NEAR(poses[8].translation.x, .3069, 1e-4);
    EXPECT_NEAR(poses[8].translation.y, 0, 1e-9);
    EXPECT_NEAR(poses[8].translation.z, .4869 + .1034, 1e-4);
    std::mt19937_64 random(4);
    for (int state = 0; state < 1000; ++state) {
        for (std::size_t k = 0; k < values.size(); ++k)
            values[k] = std::uniform_real_distribution<double>(tree.ranges()[k].lower,
                                                               tree.ranges()[k].upper)(random);
        tree.forward(values, poses);
        const auto frames = panda_frames(values);
        for (std::size_t i = 0; i < 8; ++i) { // the file has pi / 2 to 12 digits
            ASSERT_EQ(panda.links[i + 1].name, fmt::format("panda_link{}", i + 1));
            for (std::size_t r = 0; r < 3; ++r) {
                const int row = static_cast<int>(r);
                ASSERT_NEAR(static_cast<double>(frames[i][r][3]), poses[i + 1].translation[row],
                            1e-10);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(static_cast<double>(frames[i][r][static_cast<std::size_t>(c)]),
                                poses[i + 1].rotation[r][c], 1e-10);
            }
        }
        // The fingers part by twice their value, along the hand's y.
        const Vec3<double> apart = poses[10].translation - poses[11].translation;
        ASSERT_NEAR(length(apart), 2 * values[7], 1e-12);
    }
}

} // namespace
} // namespace boxwood
