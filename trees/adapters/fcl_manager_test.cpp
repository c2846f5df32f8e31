#include "trees/adapters/apis/fcl_api.h"
#include "trees/adapters/testing/histories.h"
#include "trees/adapters/testing/manager_tests.h"

#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

namespace boxwood {
namespace {

using Apis = testing::Types<FclApi<float>, FclApi<double>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Fcl, ManagerTest, Apis);
INSTANTIATE_TYPED_TEST_SUITE_P(Fcl, ManagerHistories, Apis);

template <class S> class FclBroadPhaseTest : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FclBroadPhaseTest, Scalars);

/// With FCL's own narrow phase, shapes and callbacks.
TYPED_TEST(FclBroadPhaseTest, GivesTheAnswersOfFclsShapes) {
    using S = TypeParam;
    using Shape = fcl::CollisionObject<S>;
    std::mt19937_64 random(7);
    std::uniform_real_distribution<S> place(-4, 4), angle(0, 3);
    std::vector<std::unique_ptr<Shape>> objects;
    std::vector<Shape*> all;
    for (int i = 0; i < 80; ++i) {
        std::shared_ptr<fcl::CollisionGeometry<S>> shape;
        if (i == 0)
            shape = std::make_shared<fcl::Halfspace<S>>(0, 0, 1, -3);
        else if (i % 2 == 0)
            shape = std::make_shared<fcl::Box<S>>(S(.5), S(.3), S(.2));
        else
            shape = std::make_shared<fcl::Sphere<S>>(S(.3));
        fcl::Transform3<S> pose = fcl::Transform3<S>::Identity();
        if (i > 0) {
            pose.linear() =
                fcl::AngleAxis<S>(angle(random), fcl::Vector3<S>::UnitX()).toRotationMatrix();
            pose.translation() = fcl::Vector3<S>(place(random), place(random), place(random));
        }
        objects.push_back(std::make_unique<Shape>(shape, pose));
        all.push_back(objects.back().get());
    }
    fcl::NaiveCollisionManager<S> naive; // FCL's tree of floats crashes on a half-space among many
    const auto contacts = [&](fcl::BroadPhaseCollisionManager<S>& manager) {
        manager.clear();
        manager.registerObjects(all);
        manager.setup();
        fcl::DefaultCollisionData<S> data;
        data.request.num_max_contacts = 100'000;
        manager.collide(&data, fcl::DefaultCollisionFunction<S>);
        return data.result.numContacts();
    };
    FclBroadPhase<S> ours;
    EXPECT_EQ(contacts(ours), contacts(naive));
    EXPECT_GT(contacts(naive), 3u);
    all.erase(all.begin()); // FCL has no distance of a half-space
    const auto distance = [&](fcl::BroadPhaseCollisionManager<S>& manager) {
        for (Shape* object : all) {
            object->setTranslation(object->getTranslation() * 4);
            object->computeAABB();
        }
        manager.clear();
        manager.registerObjects(all);
        fcl::DefaultDistanceData<S> data;
        manager.distance(&data, fcl::DefaultDistanceFunction<S>);
        for (Shape* object : all) {
            object->setTranslation(object->getTranslation() / 4);
            object->computeAABB();
        }
        return data.result.min_distance;
    };
    EXPECT_EQ(distance(ours), distance(naive));
}

} // namespace
} // namespace boxwood
