#pragma once

/// What every manager holds to, typed by the Api.

#include "trees/adapters/testing/shown_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <deque>
#include <random>
#include <stdexcept>
#include <thread>

namespace boxwood {

template <class Api> class ManagerTest : public testing::Test {
  protected:
    using Number = typename Api::Scalar;
    using Body = typename Api::Body;
    using Shown = ShownPairs<Api>;

    Body* body(Number x, Number y = 0, Number z = 0, Number side = 1) {
        return &bodies_.emplace_back(bounds_of<Api>(x, y, z, side));
    }
    Body* added(Number x, Number y = 0, Number z = 0, Number side = 1) {
        Body* made = body(x, y, z, side);
        ours.registerObject(made);
        return made;
    }
    auto self_pairs() {
        Shown shown;
        Api::collide(ours, shown);
        return shown.pairs;
    }
    auto pairs_with(typename Api::Object* object) {
        Shown shown;
        Api::collide(ours, shown, object);
        return shown.pairs;
    }

    std::deque<Body> bodies_;
    typename Api::Ours ours;
};
TYPED_TEST_SUITE_P(ManagerTest);

TYPED_TEST_P(ManagerTest, OfNothingShowsNothing) {
    using Api = TypeParam;
    auto& manager = this->ours;
    typename Api::Ours other;
    manager.setup();
    manager.update();
    EXPECT_TRUE(manager.empty());
    EXPECT_THAT(this->self_pairs(), testing::IsEmpty());
    EXPECT_THAT(this->pairs_with(this->body(0)), testing::IsEmpty());
    ShownPairs<Api> shown;
    typename Api::Manager* const others = &other;
    Api::collide(manager, shown, others);
    struct Counted {
        int calls = 0;
        bool add(typename Api::Object*, typename Api::Object*, typename Api::Scalar&) {
            return ++calls > 9;
        }
    } counted;
    Api::distance(manager, counted);
    Api::distance(manager, counted, static_cast<typename Api::Object*>(this->body(0)));
    Api::distance(manager, counted, others);
    EXPECT_THROW(Api::distance(manager, counted, static_cast<typename Api::Object*>(nullptr)),
                 std::invalid_argument);
    EXPECT_THAT(shown.pairs, testing::IsEmpty());
    EXPECT_EQ(counted.calls, 0);
    this->added(0);
    EXPECT_THAT(this->self_pairs(), testing::IsEmpty());
    EXPECT_EQ(manager.size(), 1u);
}

TYPED_TEST_P(ManagerTest, ShowsTheRegisteredBodyFirst) {
    auto *a = this->added(0), *b = this->added(1), *query = this->body(1.5);
    this->added(3);
    EXPECT_THAT(this->self_pairs(),
                testing::UnorderedElementsAre(testing::Pair(a, b))); // they touch
    EXPECT_THAT(this->pairs_with(query), testing::ElementsAre(testing::Pair(b, query)));
    EXPECT_THAT(this->pairs_with(b),
                testing::UnorderedElementsAre(testing::Pair(a, b), testing::Pair(b, b)));
    typename TypeParam::Ours other;
    other.registerObject(query);
    ShownPairs<TypeParam> shown;
    TypeParam::collide(this->ours, shown, static_cast<typename TypeParam::Manager*>(&other));
    EXPECT_THAT(shown.pairs, testing::ElementsAre(testing::Pair(b, query)));
}

TYPED_TEST_P(ManagerTest, ObjectsAreASet) {
    auto *a = this->added(0), *b = this->added(0);
    auto& manager = this->ours;
    manager.registerObject(a);
    manager.registerObjects({a, b, b});
    EXPECT_EQ(manager.size(), 2u);
    std::vector<typename TypeParam::Object*> objects(7);
    manager.getObjects(objects);
    EXPECT_THAT(objects, testing::ElementsAre(a, b));
    EXPECT_EQ(this->self_pairs().size(), 1u);
    a->move(bounds_of<TypeParam>(5, 5, 5));
    manager.registerObject(a); // which updates it
    EXPECT_THAT(this->self_pairs(), testing::IsEmpty());
    manager.unregisterObject(a);
    manager.unregisterObject(a);
    manager.update(a);
    manager.update(static_cast<typename TypeParam::Object*>(nullptr));
    manager.unregisterObject(nullptr);
    EXPECT_EQ(manager.size(), 1u);
    EXPECT_THROW(manager.registerObject(nullptr), std::invalid_argument);
    EXPECT_THROW(manager.registerObjects({a, nullptr}), std::invalid_argument);
    typename TypeParam::Object* none = nullptr;
    ShownPairs<TypeParam> shown;
    EXPECT_THROW(TypeParam::collide(manager, shown, none), std::invalid_argument);
    EXPECT_EQ(manager.size(), 1u);
    manager.clear();
    EXPECT_TRUE(manager.empty());
    EXPECT_THAT(this->pairs_with(b), testing::IsEmpty());
}

TYPED_TEST_P(ManagerTest, BoundsAreThoseOfTheLastUpdate) {
    auto *a = this->added(0), *b = this->added(5);
    EXPECT_THAT(this->self_pairs(), testing::IsEmpty());
    b->move(bounds_of<TypeParam>(0, 0, 0));
    EXPECT_THAT(this->self_pairs(), testing::IsEmpty());
    this->ours.update(a);
    EXPECT_THAT(this->self_pairs(), testing::IsEmpty());
    this->ours.update(b);
    EXPECT_EQ(this->self_pairs().size(), 1u);
    b->move(bounds_of<TypeParam>(5, 0, 0));
    this->ours.update();
    EXPECT_THAT(this->self_pairs(), testing::IsEmpty());
}

TYPED_TEST_P(ManagerTest, WithItselfItShowsItsOwnPairs) {
    for (int i = 0; i < 20; ++i)
        this->added(static_cast<typename TypeParam::Scalar>(i));
    ShownPairs<TypeParam> shown;
    TypeParam::collide(this->ours, shown, static_cast<typename TypeParam::Manager*>(&this->ours));
    EXPECT_EQ(shown.pairs.size(), 19u);
}

TYPED_TEST_P(ManagerTest, EndsWithTheCallThatHasEnough) {
    using Api = TypeParam;
    typename Api::Ours same;
    typename Api::Naive foreign;
    for (int i = 0; i < 50; ++i) {
        auto* body = this->added(0);
        same.registerObject(body);
        foreign.registerObject(body);
    }
    typename Api::Manager &of_same = same, &of_foreign = foreign;
    using Of = ShownPairs<Api>;
    for (const std::size_t enough : {1u, 2u, 7u, 50u}) {
        Of self, again, one, two, three;
        self.enough = again.enough = one.enough = two.enough = three.enough = enough;
        Api::collide(this->ours, self);
        Api::collide(this->ours, again); // perhaps of a cache
        Api::collide(this->ours, one, static_cast<typename Api::Object*>(this->body(0)));
        Api::collide(this->ours, two, &of_same);
        Api::collide(this->ours, three, &of_foreign);
        for (const Of* shown : {&self, &again, &one, &two, &three})
            EXPECT_EQ(shown->pairs.size(), enough);
    }
}

TYPED_TEST_P(ManagerTest, IsNotChangedFromWithinACallback) {
    using Api = TypeParam;
    using Object = typename Api::Object;
    struct Changes {
        typename Api::Ours& manager;
        bool add(Object* object, Object*) {
            manager.unregisterObject(object);
            return false;
        }
    } changes{this->ours};
    struct Queries {
        typename Api::Ours& manager;
        std::size_t inner = 0;
        bool add(Object* object, Object*) {
            ShownPairs<Api> shown;
            Api::collide(manager, shown, object);
            Api::collide(manager, shown);
            inner += shown.pairs.size();
            return false;
        }
    } queries{this->ours};
    auto* a = this->added(0);
    this->added(0);
    for (int times = 0; times < 3; ++times) { // of the tree, then of cached pairs
        EXPECT_THROW(Api::collide(this->ours, changes), std::logic_error);
        Api::collide(this->ours, queries);
    }
    EXPECT_EQ(queries.inner, 9u);
    this->ours.unregisterObject(a); // the exception ended the query
    EXPECT_EQ(this->ours.size(), 1u);
}

TYPED_TEST_P(ManagerTest, ComesToTheNearestSoon) {
    using Api = TypeParam;
    using S = typename Api::Scalar;
    using Object = typename Api::Object;
    std::vector<typename Api::Body*> bodies;
    for (int i = 0; i < 500; ++i)
        bodies.push_back(this->added(static_cast<S>(3 * i)));
    struct Measured {
        std::vector<ObjectPair<Api>> pairs;
        bool add(Object* a, Object* b, S& least) {
            pairs.emplace_back(a, b);
            least = std::min(least, a->getAABB().distance(b->getAABB()));
            return false;
        }
    } shown;
    auto* query = this->body(S(3 * 321 + 1.25));
    Api::distance(this->ours, shown, static_cast<Object*>(query));
    EXPECT_EQ(shown.pairs.back(), ObjectPair<Api>(bodies[321], query));
    EXPECT_LE(shown.pairs.size(), 3u);
    bodies[77]->move(bounds_of<Api>(3 * 78 - S(1.5), 0, 0));
    this->ours.update(bodies[77]);
    shown.pairs.clear();
    Api::distance(this->ours, shown);
    EXPECT_EQ(shown.pairs.back(), ObjectPair<Api>(bodies[77], bodies[78]));
    EXPECT_LT(shown.pairs.size(), 10u);
}

TYPED_TEST_P(ManagerTest, ANumberThatIsNoneOverlapsOnItsAxis) {
    using S = typename TypeParam::Scalar;
    typename TypeParam::Naive naive;
    for (int i = 0; i < 10; ++i) {
        auto* body = this->body(static_cast<S>(2 * i));
        auto bounds = body->getAABB();
        if (i == 5)
            bounds.min_[0] = std::numeric_limits<S>::quiet_NaN();
        if (i == 7)
            bounds.max_.setConstant(std::numeric_limits<S>::quiet_NaN());
        body->move(bounds);
        this->ours.registerObject(body);
        naive.registerObject(body);
    }
    ShownPairs<TypeParam> truth, found;
    TypeParam::collide(naive, truth);
    TypeParam::collide(this->ours, found);
    EXPECT_EQ(found.sorted(), truth.sorted());
    EXPECT_GT(truth.pairs.size(), 5u);
}

/// Thousands of bodies: more levels, cached pairs, new orders.
TYPED_TEST_P(ManagerTest, FollowsLargeScenes) {
    using Api = TypeParam;
    using S = typename Api::Scalar;
    std::mt19937_64 random(5);
    std::uniform_real_distribution<S> place(0, 18), step(-S(.05), S(.05));
    std::vector<typename Api::Object*> all;
    for (int i = 0; i < 3000; ++i) // of which over 203 are many
        all.push_back(this->body(place(random), place(random), place(random)));
    this->ours.registerObjects(all);
    for (int frame = 0; frame < 60; ++frame) {
        std::vector<typename Api::Object*> moved;
        const std::size_t n = frame % 20 < 15 ? 1 + random() % 200 : all.size();
        for (std::size_t i = 0; i < n; ++i) {
            auto* object = all[n == all.size() ? i : random() % all.size()];
            auto bounds = object->getAABB();
            const S x = step(random), y = step(random);
            for (auto* corner : {&bounds.min_, &bounds.max_}) {
                (*corner)[0] += x;
                (*corner)[1] += y;
            }
            const auto far = bounds_of<Api>(place(random), place(random), place(random));
            static_cast<typename Api::Body*>(object)->move(random() % 4 == 0 ? far : bounds);
            moved.push_back(object);
        }
        this->ours.update(moved);
        typename Api::Tree tree; // updated, it would not shrink bounds
        tree.registerObjects(all);
        ShownPairs<Api> truth, found;
        Api::collide(tree, truth);
        Api::collide(this->ours, found);
        ASSERT_EQ(found.sorted(), truth.sorted()) << frame;
        ASSERT_GT(truth.pairs.size(), 5000u);
    }
}

TYPED_TEST_P(ManagerTest, ManyThreadsMayQuery) {
    using Api = TypeParam;
    using S = typename Api::Scalar;
    std::mt19937_64 random(6);
    std::uniform_real_distribution<S> place(0, 10);
    for (int i = 0; i < 2000; ++i)
        this->added(place(random), place(random), place(random), S(.5));
    for (int round = 0; round < 20; ++round) {
        for (int i = 0; i < 200; ++i) {
            auto& body = this->bodies_[random() % 2000];
            body.move(bounds_of<Api>(place(random), place(random), place(random), S(.5)));
            this->ours.update(&body);
        }
        std::array<ShownPairs<Api>, 4> shown;
        std::array<std::size_t, 4> of_one{};
        std::vector<std::thread> threads;
        for (std::size_t t = 0; t < shown.size(); ++t)
            threads.emplace_back([&, t] {
                for (std::size_t i = 0; i < 50; ++i) {
                    ShownPairs<Api> one;
                    typename Api::Object* const object = &this->bodies_[40 * i];
                    Api::collide(this->ours, one, object);
                    of_one[t] += one.pairs.size();
                }
                Api::collide(this->ours, shown[t]);
            });
        for (std::thread& thread : threads)
            thread.join();
        for (std::size_t t = 1; t < shown.size(); ++t) {
            EXPECT_EQ(of_one[t], of_one[0]);
            EXPECT_EQ(shown[t].sorted(), shown[0].sorted());
        }
    }
}

REGISTER_TYPED_TEST_SUITE_P(ManagerTest, OfNothingShowsNothing, ShowsTheRegisteredBodyFirst,
                            ObjectsAreASet, BoundsAreThoseOfTheLastUpdate,
                            WithItselfItShowsItsOwnPairs, EndsWithTheCallThatHasEnough,
                            IsNotChangedFromWithinACallback, ComesToTheNearestSoon,
                            ANumberThatIsNoneOverlapsOnItsAxis, FollowsLargeScenes,
                            ManyThreadsMayQuery);

} // namespace boxwood
