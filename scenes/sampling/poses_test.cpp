#include "scenes/sampling/poses.h"

#include "scenes/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

namespace boxwood {
namespace {

TEST(ScenePoses, AreRotationsAtTheirGap) {
    const Scene scene = make_scene({.generator = "sphere_mesh", .n = 500});
    std::map<std::string_view, double> between; // middles, in the mean
    for (const PoseKindEntry& kind : pose_kinds())
        for (const auto& pose : make_poses(kind.name, scene.mesh, 20, 3)) {
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    EXPECT_NEAR(dot(pose.rotation[i], pose.rotation[j]), i == j ? 1 : 0, 4e-15);
            between[kind.name] += length(pose.translation) / 20;
        }
    // The same rotations and directions: what differs are parts of the width.
    const double width = (between["apart"] - between["deep"]);
    EXPECT_GT(width, 1.5);
    EXPECT_LT(width, 3);
    EXPECT_NEAR(between["near"] - between["shallow"], .03 * width, .005);
    EXPECT_NEAR(between["near"] / width, 1.01, .15);
}

TEST(ScenePoses, AlongAWayAreADegreeApart) {
    const Scene scene = make_scene({.generator = "sphere_mesh", .n = 500});
    const auto poses = make_poses("along", scene.mesh, 90, 3);
    for (std::size_t i = 1; i < poses.size(); ++i) {
        double trace = 0;
        for (std::size_t row = 0; row < 3; ++row)
            trace += dot(poses[i].rotation[row], poses[i - 1].rotation[row]);
        EXPECT_NEAR(std::acos((trace - 1) / 2), .0174, .0002);
        EXPECT_LT(length(poses[i].translation - poses[i - 1].translation), .08);
    }
    EXPECT_GT(length(poses[89].translation - poses[0].translation), .5); // it leads away
}

TEST(ScenePoses, ParallelSheetsLieOnOneAnother) {
    const Scene scene = make_scene({.generator = "cloth", .n = 200}); // 3 units wide
    const auto poses = make_poses("parallel", scene.mesh, 8, 3);
    for (const auto& pose : poses) {
        EXPECT_EQ(pose.rotation, (RigidTransform<double>{}.rotation));
        int across = 0;
        for (int axis = 0; axis < 3; ++axis) {
            across += std::abs(pose.translation[axis] - .03) < 1e-6;
            EXPECT_LT(std::abs(pose.translation[axis]), .31);
        }
        EXPECT_GE(across, 1);
    }
    EXPECT_NE(poses[0], poses[1]);
}

TEST(ScenePoses, NestedCopiesAreLargerAndAround) {
    for (const auto& [kind, larger] : {std::pair{"nested", .01}, {"nested_closely", .001}}) {
        const Scene scene =
            make_scene({.generator = "sphere_mesh", .n = 500, .poses = kind, .n_poses = 4});
        ASSERT_TRUE(scene.has_other_copy());
        EXPECT_EQ(scene.copy().triangles, scene.mesh.triangles);
        for (const auto& pose : scene.poses) {
            EXPECT_EQ(pose.rotation, (RigidTransform<double>{}.rotation));
            EXPECT_GT(length(pose.translation), 0);
            EXPECT_LT(length(pose.translation), .12 * larger);
        }
        Aabb<double> box, box_of_copy;
        for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
            box = merge(box, Aabb<double>(scene.mesh.triangle(i).bounds()));
            box_of_copy = merge(box_of_copy, Aabb<double>(scene.copy().triangle(i).bounds()));
        }
        for (int axis = 0; axis < 3; ++axis) {
            const double width = box.max[axis] - box.min[axis];
            EXPECT_NEAR(box.min[axis] - box_of_copy.min[axis], larger / 2 * width, 1e-6);
            EXPECT_NEAR(box_of_copy.max[axis] - box.max[axis], larger / 2 * width, 1e-6);
        }
    }
    const Scene same =
        make_scene({.generator = "sphere_mesh", .n = 500, .poses = "near", .n_poses = 4});
    EXPECT_FALSE(same.has_other_copy());
    EXPECT_EQ(&same.copy(), &same.mesh);
}

TEST(ScenePoses, DependOnSeedAndNumberAlone) {
    const Scene scene = make_scene({.generator = "sphere_mesh", .n = 100});
    const auto few = make_poses("near", scene.mesh, 3, 1),
               more = make_poses("near", scene.mesh, 5, 1);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(few[i], more[i]);
    EXPECT_NE(make_poses("near", scene.mesh, 1, 2)[0], few[0]);
    EXPECT_THROW(make_poses("far", scene.mesh, 1, 1), std::invalid_argument);
    EXPECT_THROW(make_poses("near", {}, 1, 1), std::invalid_argument);
}

TEST(ScenePoses, AreJoinedByMotionsByName) {
    SceneSpec spec{.generator = "sphere_mesh", .n = 100, .poses = "apart", .n_poses = 3};
    const Scene still = make_scene(spec);
    spec.motion = "screw";
    const Scene moving = make_scene(spec);
    EXPECT_EQ(moving.name, "sphere_mesh_apart_screw");
    EXPECT_EQ(moving.poses, still.poses);
    EXPECT_NE(moving.params_json.find("\"motion\":\"screw\""), std::string::npos);
    spec.motion = "screwed";
    EXPECT_THROW(make_scene(spec), std::invalid_argument);
    spec.motion = "screw";
    spec.n_poses = 1;
    EXPECT_THROW(make_scene(spec), std::invalid_argument);
    spec.poses.clear();
    EXPECT_THROW(make_scene(spec), std::invalid_argument);
}

TEST(ScenePoses, ArePartOfASceneByName) {
    const SceneSpec spec{.generator = "sphere_mesh", .n = 100, .poses = "deep", .n_poses = 7};
    const Scene scene = make_scene(spec);
    EXPECT_EQ(scene.name, "sphere_mesh_deep");
    EXPECT_EQ(scene.poses.size(), 7u);
    EXPECT_NE(scene.content_hash, make_scene({.generator = "sphere_mesh", .n = 100}).content_hash);
    EXPECT_NE(scene.params_json.find("\"poses\":\"deep\""), std::string::npos);
    EXPECT_THROW(make_scene({.generator = "uniform", .poses = "deep", .n_poses = 7}),
                 std::invalid_argument);
    EXPECT_THROW(make_scene({.generator = "sphere_mesh", .poses = "deep"}), std::invalid_argument);
}

} // namespace
} // namespace boxwood
