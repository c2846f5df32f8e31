#include "trees/adapters/apis/coal_api.h"
#include "trees/adapters/testing/histories.h"
#include "trees/adapters/testing/manager_tests.h"

#include <coal/broadphase/default_broadphase_callbacks.h>
#include <coal/shape/geometric_shapes.h>

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

namespace boxwood {
namespace {

using Apis = testing::Types<CoalApi>;
INSTANTIATE_TYPED_TEST_SUITE_P(Coal, ManagerTest, Apis);
INSTANTIATE_TYPED_TEST_SUITE_P(Coal, ManagerHistories, Apis);

std::vector<std::unique_ptr<coal::CollisionObject>> some_shapes() {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> place(-4, 4), angle(0, 3);
    std::vector<std::unique_ptr<coal::CollisionObject>> objects;
    for (int i = 0; i < 80; ++i) {
        std::shared_ptr<coal::CollisionGeometry> shape;
        if (i % 2 == 0)
            shape = std::make_shared<coal::Box>(.5, .3, .2);
        else
            shape = std::make_shared<coal::Sphere>(.3);
        const Eigen::AngleAxisd turn(angle(random), Eigen::Vector3d::UnitX());
        const Eigen::Vector3d at(place(random), place(random), place(random));
        objects.push_back(std::make_unique<coal::CollisionObject>(
            shape, coal::Transform3s(turn.toRotationMatrix(), at)));
        objects.back()->computeAABB();
    }
    return objects;
}

template <class Manager, class Callback> Callback answered(double apart, Callback callback) {
    const auto objects = some_shapes();
    Manager manager;
    for (const auto& object : objects) {
        object->setTranslation(object->getTranslation() * apart);
        object->computeAABB();
        manager.registerObject(object.get());
    }
    manager.setup();
    if constexpr (std::is_same_v<Callback, coal::CollisionCallBackDefault>)
        manager.collide(&callback);
    else
        manager.distance(&callback);
    return callback;
}

/// With Coal's own narrow phase, shapes and callbacks, which each query begins again.
TEST(CoalBroadPhase, GivesTheAnswersOfCoalsShapes) {
    coal::CollisionCallBackDefault contacts;
    contacts.data.request.num_max_contacts = 100'000;
    const auto found = answered<CoalBroadPhase>(1, contacts).data.result.numContacts();
    EXPECT_EQ(found, answered<coal::NaiveCollisionManager>(1, contacts).data.result.numContacts());
    EXPECT_GT(found, 3u);
    const coal::DistanceCallBackDefault least;
    EXPECT_NEAR(answered<CoalBroadPhase>(4, least).data.result.min_distance,
                answered<coal::NaiveCollisionManager>(4, least).data.result.min_distance, 1e-6);
}

TEST(CoalBroadPhase, BeginsACallbackOnce) {
    struct Counted final : coal::CollisionCallBackBase {
        int begun = 0, shown = 0;
        void init() override { ++begun; }
        bool collide(coal::CollisionObject*, coal::CollisionObject*) override {
            ++shown;
            return false;
        }
    } counted;
    CoalBody a(bounds_of<CoalApi>(0, 0, 0)), b(bounds_of<CoalApi>(.5, 0, 0));
    CoalBroadPhase manager;
    manager.registerObjects({&a, &b});
    manager.collide(&counted);
    EXPECT_EQ(counted.begun, 1);
    EXPECT_EQ(counted.shown, 1);
    manager.collide(&a, &counted);
    EXPECT_EQ(counted.begun, 2);
    EXPECT_EQ(counted.shown, 3);
    EXPECT_EQ(manager.getObjects().size(), 2u);
}

} // namespace
} // namespace boxwood
