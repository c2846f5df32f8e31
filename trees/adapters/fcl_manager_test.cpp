#include "trees/adapters/fcl_manager.h"
#include "trees/adapters/testing/fcl_bodies.h"

#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <random>
#include <thread>

namespace boxwood {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

template <class S> class FclBroadPhaseTest : public testing::Test {
  protected:
    using Object = fcl::CollisionObject<S>;
    using Shown = ShownPairs<S>;

    FclBody<S>* body(S x, S y = 0, S z = 0, S side = 1) {
        return &bodies_.emplace_back(bounds_of<S>(x, y, z, side));
    }
    FclBody<S>* added(S x, S y = 0, S z = 0, S side = 1) {
        FclBody<S>* made = body(x, y, z, side);
        ours.registerObject(made);
        return made;
    }
    auto self_pairs() {
        Shown shown;
        ours.collide(&shown, Shown::add);
        return shown.pairs;
    }
    auto pairs_with(Object* object) {
        Shown shown;
        ours.collide(object, &shown, Shown::add);
        return shown.pairs;
    }

    std::deque<FclBody<S>> bodies_;
    FclBroadPhase<S> ours;
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FclBroadPhaseTest, Scalars);

TYPED_TEST(FclBroadPhaseTest, OfNothingShowsNothing) {
    using S = TypeParam;
    FclBroadPhase<S>& manager = this->ours;
    FclBroadPhase<S> other;
    manager.setup();
    manager.update();
    EXPECT_TRUE(manager.empty());
    EXPECT_THAT(this->self_pairs(), IsEmpty());
    EXPECT_THAT(this->pairs_with(this->body(0)), IsEmpty());
    ShownPairs<S> shown;
    manager.collide(&other, &shown, ShownPairs<S>::add);
    int calls = 0;
    const auto count = [](auto*, auto*, void* data, S&) { return ++*static_cast<int*>(data) > 9; };
    manager.distance(&calls, count);
    manager.distance(this->body(0), &calls, count);
    manager.distance(&other, &calls, count);
    EXPECT_THAT(shown.pairs, IsEmpty());
    EXPECT_EQ(calls, 0);
    this->added(0);
    EXPECT_THAT(this->self_pairs(), IsEmpty());
    EXPECT_EQ(manager.size(), 1u);
}

TYPED_TEST(FclBroadPhaseTest, ShowsTheRegisteredBodyFirst) {
    auto *a = this->added(0), *b = this->added(1), *query = this->body(TypeParam(1.5));
    this->added(3);
    EXPECT_THAT(this->self_pairs(), UnorderedElementsAre(Pair(a, b))); // they touch
    EXPECT_THAT(this->pairs_with(query), ElementsAre(Pair(b, query)));
    EXPECT_THAT(this->pairs_with(b), UnorderedElementsAre(Pair(a, b), Pair(b, b)));
    FclBroadPhase<TypeParam> other;
    other.registerObject(query);
    ShownPairs<TypeParam> shown;
    this->ours.collide(&other, &shown, ShownPairs<TypeParam>::add);
    EXPECT_THAT(shown.pairs, ElementsAre(Pair(b, query)));
}

TYPED_TEST(FclBroadPhaseTest, ObjectsAreASet) {
    auto *a = this->added(0), *b = this->added(0);
    auto& manager = this->ours;
    manager.registerObject(a);
    manager.registerObjects({a, b, b});
    EXPECT_EQ(manager.size(), 2u);
    std::vector<fcl::CollisionObject<TypeParam>*> objects(7);
    manager.getObjects(objects);
    EXPECT_THAT(objects, ElementsAre(a, b));
    EXPECT_EQ(this->self_pairs().size(), 1u);
    a->move(bounds_of<TypeParam>(5, 5, 5));
    manager.registerObject(a); // which updates it
    EXPECT_THAT(this->self_pairs(), IsEmpty());
    manager.unregisterObject(a);
    manager.unregisterObject(a);
    manager.update(a);
    manager.update(nullptr);
    manager.unregisterObject(nullptr);
    EXPECT_EQ(manager.size(), 1u);
    EXPECT_THROW(manager.registerObject(nullptr), std::invalid_argument);
    EXPECT_THROW(manager.registerObjects({a, nullptr}), std::invalid_argument);
    EXPECT_EQ(manager.size(), 1u);
    manager.clear();
    EXPECT_TRUE(manager.empty());
    EXPECT_THAT(this->pairs_with(b), IsEmpty());
}

TYPED_TEST(FclBroadPhaseTest, BoundsAreThoseOfTheLastUpdate) {
    auto *a = this->added(0), *b = this->added(5);
    EXPECT_THAT(this->self_pairs(), IsEmpty());
    b->move(bounds_of<TypeParam>(0, 0, 0));
    EXPECT_THAT(this->self_pairs(), IsEmpty());
    this->ours.update(a);
    EXPECT_THAT(this->self_pairs(), IsEmpty());
    this->ours.update(b);
    EXPECT_EQ(this->self_pairs().size(), 1u);
    b->move(bounds_of<TypeParam>(5, 0, 0));
    this->ours.update();
    EXPECT_THAT(this->self_pairs(), IsEmpty());
}

TYPED_TEST(FclBroadPhaseTest, WithItselfItShowsItsOwnPairs) {
    for (int i = 0; i < 20; ++i)
        this->added(static_cast<TypeParam>(i));
    ShownPairs<TypeParam> shown;
    this->ours.collide(&this->ours, &shown, ShownPairs<TypeParam>::add);
    EXPECT_EQ(shown.pairs.size(), 19u);
}

TYPED_TEST(FclBroadPhaseTest, EndsWithTheCallThatHasEnough) {
    FclBroadPhase<TypeParam> same;
    fcl::NaiveCollisionManager<TypeParam> foreign;
    for (int i = 0; i < 50; ++i) {
        auto* body = this->added(0);
        same.registerObject(body);
        foreign.registerObject(body);
    }
    using Of = ShownPairs<TypeParam>;
    for (const std::size_t enough : {1u, 2u, 7u, 50u}) {
        Of self, again, one, two, three;
        self.enough = again.enough = one.enough = two.enough = three.enough = enough;
        this->ours.collide(&self, Of::add);
        this->ours.collide(&again, Of::add); // perhaps of a cache
        this->ours.collide(this->body(0), &one, Of::add);
        this->ours.collide(&same, &two, Of::add);
        this->ours.collide(&foreign, &three, Of::add);
        for (const Of* shown : {&self, &again, &one, &two, &three})
            EXPECT_EQ(shown->pairs.size(), enough);
    }
}

TYPED_TEST(FclBroadPhaseTest, IsNotChangedFromWithinACallback) {
    struct Data {
        FclBroadPhase<TypeParam>* manager;
        std::size_t inner = 0;
    } data{&this->ours};
    auto* a = this->added(0);
    this->added(0);
    const auto change = [](auto* object, auto*, void* d) {
        static_cast<Data*>(d)->manager->unregisterObject(object);
        return false;
    };
    const auto query = [](auto* object, auto*, void* d) {
        ShownPairs<TypeParam> shown;
        static_cast<Data*>(d)->manager->collide(object, &shown, ShownPairs<TypeParam>::add);
        static_cast<Data*>(d)->manager->collide(&shown, ShownPairs<TypeParam>::add);
        static_cast<Data*>(d)->inner += shown.pairs.size();
        return false;
    };
    for (int times = 0; times < 3; ++times) { // of the tree, then of cached pairs
        EXPECT_THROW(this->ours.collide(&data, change), std::logic_error);
        this->ours.collide(&data, query);
    }
    EXPECT_EQ(data.inner, 9u);
    this->ours.unregisterObject(a); // the exception ended the query
    EXPECT_EQ(this->ours.size(), 1u);
}

TYPED_TEST(FclBroadPhaseTest, ComesToTheNearestSoon) {
    using S = TypeParam;
    std::vector<FclBody<S>*> bodies;
    for (int i = 0; i < 500; ++i)
        bodies.push_back(this->added(static_cast<S>(3 * i)));
    struct Data {
        std::vector<FclPair<S>> pairs;
    } data;
    const auto take = [](auto* a, auto* b, void* d, S& least) {
        static_cast<Data*>(d)->pairs.emplace_back(a, b);
        least = std::min(least, a->getAABB().distance(b->getAABB()));
        return false;
    };
    auto* query = this->body(S(3 * 321 + 1.25));
    this->ours.distance(query, &data, take);
    EXPECT_THAT(data.pairs.back(), Pair(bodies[321], query));
    EXPECT_LE(data.pairs.size(), 3u);
    bodies[77]->move(bounds_of<S>(3 * 78 - S(1.5), 0, 0));
    this->ours.update(bodies[77]);
    data.pairs.clear();
    this->ours.distance(&data, take);
    EXPECT_EQ(data.pairs.back(), std::pair(static_cast<fcl::CollisionObject<S>*>(bodies[77]),
                                           static_cast<fcl::CollisionObject<S>*>(bodies[78])));
    EXPECT_LT(data.pairs.size(), 10u);
}

TYPED_TEST(FclBroadPhaseTest, ANumberThatIsNoneOverlapsOnItsAxis) {
    fcl::NaiveCollisionManager<TypeParam> naive;
    for (int i = 0; i < 10; ++i) {
        auto* body = this->body(static_cast<TypeParam>(2 * i));
        auto bounds = body->getAABB();
        if (i == 5)
            bounds.min_[0] = std::numeric_limits<TypeParam>::quiet_NaN();
        if (i == 7)
            bounds.max_.setConstant(std::numeric_limits<TypeParam>::quiet_NaN());
        body->move(bounds);
        this->ours.registerObject(body);
        naive.registerObject(body);
    }
    ShownPairs<TypeParam> truth, found;
    naive.collide(&truth, ShownPairs<TypeParam>::add);
    this->ours.collide(&found, ShownPairs<TypeParam>::add);
    EXPECT_EQ(found.sorted(), truth.sorted());
    EXPECT_GT(truth.pairs.size(), 5u);
}

/// Thousands of bodies: more levels, cached pairs, new orders.
TYPED_TEST(FclBroadPhaseTest, FollowsLargeScenes) {
    using S = TypeParam;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<S> place(0, 18), step(-S(.05), S(.05));
    std::vector<fcl::CollisionObject<S>*> all;
    for (int i = 0; i < 5000; ++i)
        all.push_back(this->body(place(random), place(random), place(random)));
    this->ours.registerObjects(all);
    for (int frame = 0; frame < 60; ++frame) {
        std::vector<fcl::CollisionObject<S>*> moved;
        const std::size_t n = frame % 20 < 15 ? 1 + random() % 200 : all.size();
        for (std::size_t i = 0; i < n; ++i) {
            auto* object = all[n == all.size() ? i : random() % all.size()];
            fcl::AABB<S> bounds = object->getAABB();
            const auto far = bounds_of<S>(place(random), place(random), place(random));
            bounds = random() % 4 == 0
                         ? far
                         : fcl::translate(bounds, fcl::Vector3<S>(step(random), step(random), 0));
            static_cast<FclBody<S>*>(object)->move(bounds);
            moved.push_back(object);
        }
        this->ours.update(moved);
        fcl::DynamicAABBTreeCollisionManager<S> tree; // updated, it would not shrink bounds
        tree.registerObjects(all);
        ShownPairs<S> truth, found;
        tree.collide(&truth, ShownPairs<S>::add);
        this->ours.collide(&found, ShownPairs<S>::add);
        ASSERT_EQ(found.sorted(), truth.sorted()) << frame;
        ASSERT_GT(truth.pairs.size(), 5000u);
    }
}

TYPED_TEST(FclBroadPhaseTest, ManyThreadsMayQuery) {
    using S = TypeParam;
    std::mt19937_64 random(6);
    std::uniform_real_distribution<S> place(0, 10);
    for (int i = 0; i < 2000; ++i)
        this->added(place(random), place(random), place(random), S(.5));
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 200; ++i) {
            auto& body = this->bodies_[random() % 2000];
            body.move(bounds_of<S>(place(random), place(random), place(random), S(.5)));
            this->ours.update(&body);
        }
        std::array<ShownPairs<S>, 4> shown;
        std::array<std::size_t, 4> of_one{};
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < shown.size(); ++t)
            threads.emplace_back([&, t] {
                for (std::size_t i = 0; i < 50; ++i) {
                    ShownPairs<S> one;
                    this->ours.collide(&this->bodies_[40 * i], &one, ShownPairs<S>::add);
                    of_one[t] += one.pairs.size();
                }
                this->ours.collide(&shown[t], ShownPairs<S>::add);
            });
        for (std::thread& thread : threads)
            thread.join();
        for (std::size_t t = 1; t < shown.size(); ++t) {
            EXPECT_EQ(of_one[t], of_one[0]);
            EXPECT_EQ(shown[t].sorted(), shown[0].sorted());
        }
    }
}

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
    EXPECT_EQ(contacts(this->ours), contacts(naive));
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
    EXPECT_EQ(distance(this->ours), distance(naive));
}

} // namespace
} // namespace boxwood
