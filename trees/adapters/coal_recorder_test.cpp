#include "trees/adapters/coal_recorder.h"

#include "trees/adapters/coal_manager.h"

#include <coal/BVH/BVH_model.h>
#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/broadphase/default_broadphase_callbacks.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include <unistd.h>

namespace boxwood {
namespace {

using recording::Call;
using recording::Shape;

class CoalRecordings : public testing::Test {
  protected:
    ~CoalRecordings() override { std::filesystem::remove(file_); }

    std::vector<double> column(const std::string& table, const std::string& name) const {
        const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
        const hid_t set = H5Dopen2(file, (table + "/" + name).c_str(), H5P_DEFAULT);
        const hid_t space = H5Dget_space(set);
        std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
        H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        H5Sclose(space);
        H5Dclose(set);
        H5Fclose(file);
        return values;
    }
    std::vector<Call> calls() const {
        std::vector<Call> all;
        for (const double call : column("calls", "call"))
            all.push_back(static_cast<Call>(call));
        return all;
    }

    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("boxwood_coal_" + std::to_string(::getpid()) + ".h5");
};

std::unique_ptr<coal::CollisionObject> object(const std::shared_ptr<coal::CollisionGeometry>& shape,
                                              double x) {
    auto made = std::make_unique<coal::CollisionObject>(shape);
    made->setTranslation({x, 0, 0});
    made->computeAABB();
    return made;
}

TEST_F(CoalRecordings, HoldWhatWasAskedAndShown) {
    const auto ball = std::make_shared<coal::Sphere>(.6);
    std::vector<std::unique_ptr<coal::CollisionObject>> objects;
    for (int i = 0; i < 10; ++i)
        objects.push_back(object(ball, i));
    coal::CollisionCallBackDefault all, one, others;
    for (auto* callback : {&all, &one, &others})
        callback->data.request.num_max_contacts = 1000;
    coal::DistanceCallBackDefault nearest;
    {
        coal::DynamicAABBTreeCollisionManager manager;
        CoalBroadPhase boxwoods;
        boxwoods.registerObject(objects[9].get());
        manager.registerObject(objects[0].get()); // before there is a recorder
        CoalRecorder recorder(manager, file_);
        for (std::size_t i = 1; i < 8; ++i)
            recorder.registerObject(objects[i].get());
        recorder.setup();
        objects[2]->setTranslation({2.1, 0, 0});
        objects[2]->computeAABB();
        recorder.update(objects[2].get());
        recorder.collide(&all);
        recorder.collide(objects[8].get(), &one);
        recorder.distance(&nearest);
        recorder.unregisterObject(objects[7].get());
        EXPECT_EQ(recorder.size(), 7u);
        EXPECT_EQ(recorder.getObjects().size(), 7u);
        recorder.close();
        recorder.clear(); // handed on, and not written
        EXPECT_TRUE(manager.empty());
    }
    EXPECT_EQ(all.data.result.numContacts(), 7u);
    EXPECT_EQ(one.data.result.numContacts(), 1u);
    const std::vector<Call> expected = {
        Call::add,           Call::add,         Call::add,          Call::add,
        Call::add,           Call::add,         Call::add,          Call::add,
        Call::setup,         Call::update_some, Call::collide_self, Call::collide_object,
        Call::distance_self, Call::remove};
    EXPECT_EQ(calls(), expected);
    const std::vector<double> shown = column("calls", "shown");
    EXPECT_EQ(shown[10], 7);
    EXPECT_EQ(shown[11], 1);
    EXPECT_EQ(column("calls", "min_distance")[12], nearest.data.result.min_distance);
    EXPECT_EQ(column("objects", "geometry").size(), 9u);
    EXPECT_EQ(column("geometries", "shape").size(), 1u);
    EXPECT_EQ(column("states", "object").size(), 10u); // one of them moved
}

TEST_F(CoalRecordings, HoldEveryKindOfShape) {
    auto mesh = std::make_shared<coal::BVHModel<coal::OBBRSS>>();
    mesh->beginModel();
    mesh->addTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh->addTriangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
    mesh->endModel();
    const auto corners = std::make_shared<std::vector<coal::Vec3s>>(
        std::vector<coal::Vec3s>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    const auto faces = std::make_shared<std::vector<coal::Triangle>>(
        std::vector<coal::Triangle>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
    const auto wide = std::make_shared<coal::Sphere>(1);
    wide->setSweptSphereRadius(.5);
    const std::vector<std::shared_ptr<coal::CollisionGeometry>> shapes = {
        mesh,
        std::make_shared<coal::Box>(1, 2, 3),
        std::make_shared<coal::Sphere>(2),
        std::make_shared<coal::Ellipsoid>(1, 2, 3),
        std::make_shared<coal::Capsule>(1, 4),
        std::make_shared<coal::Cone>(1, 4),
        std::make_shared<coal::Cylinder>(1, 4),
        std::make_shared<coal::Convex<coal::Triangle>>(corners, 4, faces, 4),
        std::make_shared<coal::Plane>(coal::Vec3s(0, 0, 1), 2),
        std::make_shared<coal::Halfspace>(coal::Vec3s(0, 0, 1), 3),
        wide};
    std::vector<std::unique_ptr<coal::CollisionObject>> objects;
    for (const auto& shape : shapes)
        objects.push_back(object(shape, static_cast<double>(objects.size())));
    {
        CoalBroadPhase manager;
        CoalRecorder recorder(manager, file_);
        for (const auto& made : objects)
            recorder.registerObject(made.get());
    }
    std::vector<Shape> recorded;
    for (const double shape : column("geometries", "shape"))
        recorded.push_back(static_cast<Shape>(shape));
    EXPECT_EQ(recorded, (std::vector{Shape::mesh, Shape::box, Shape::sphere, Shape::ellipsoid,
                                     Shape::capsule, Shape::cone, Shape::cylinder, Shape::convex,
                                     Shape::plane, Shape::half_space, Shape::other}));
    EXPECT_EQ(column("geometries", "a"), (std::vector<double>{0, 1, 2, 1, 1, 1, 1, 0, 0, 0, 0}));
    EXPECT_EQ(column("geometries", "b"), (std::vector<double>{0, 2, 0, 2, 4, 4, 4, 0, 0, 0, 0}));
    EXPECT_EQ(column("geometries", "d"), (std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 2, 3, 0}));
    const std::vector<double> triangles = column("geometries", "n_triangles");
    EXPECT_EQ(triangles[0], 2);
    EXPECT_EQ(triangles[7], 4);
}

} // namespace
} // namespace boxwood
