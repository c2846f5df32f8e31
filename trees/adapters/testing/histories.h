#pragma once

/// Random histories of a manager, in step with the library's own: the same pairs, the same least
/// distances. A suite of the name ManagerHistories, typed by the Api, runs them.

#include "trees/adapters/testing/shown_pairs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <random>

namespace boxwood {

inline constexpr int operations = 10'000;

/// Where bounds lie.
enum class Family { grid, real, nearly_touching, far_apart, wide };

template <class Api> class SomeBounds {
    using S = typename Api::Scalar;
    using Bounds = typename Api::Bounds;

  public:
    SomeBounds(Family family, std::mt19937_64& random) : family_(family), random_(random) {}

    Bounds bounds() {
        Bounds b;
        for (int axis = 0; axis < 3; ++axis) {
            b.min_[axis] = place();
            b.max_[axis] = b.min_[axis] + side();
        }
        if (family_ == Family::wide && one_in(6))
            spoil(b);
        return b;
    }
    bool one_in(unsigned n) { return random_() % n == 0; }
    unsigned below(std::size_t n) { return static_cast<unsigned>(random_() % n); }

  private:
    S real(S low, S high) { return std::uniform_real_distribution<S>(low, high)(random_); }
    S whole(int n) { return static_cast<S>(below(static_cast<std::size_t>(n))); }

    S place() {
        switch (family_) {
        case Family::grid:
            return whole(12);
        case Family::nearly_touching: // closer together than floats are
            return whole(8) + whole(3) * std::numeric_limits<S>::epsilon() * 4;
        case Family::far_apart:
            return std::ldexp(real(-1, 1), static_cast<int>(below(60)) - 20);
        default:
            return real(0, 8);
        }
    }
    S side() {
        switch (family_) {
        case Family::grid:
        case Family::nearly_touching:
            return whole(3);
        case Family::far_apart:
            return std::ldexp(real(0, 1), static_cast<int>(below(40)) - 20);
        default:
            return real(0, 2);
        }
    }
    /// As half-spaces and planes have them, empty geometries, and worse.
    void spoil(Bounds& b) {
        constexpr S max = std::numeric_limits<S>::max(), inf = std::numeric_limits<S>::infinity();
        const int axis = static_cast<int>(below(3));
        switch (below(6)) {
        case 0:
            b.min_.setConstant(-max);
            b.max_.setConstant(max);
            b.max_[axis] = real(0, 8);
            break;
        case 1:
            b.min_[axis] = -inf;
            break;
        case 2:
            b = Bounds();
            break;
        case 3:
            std::swap(b.min_[axis], b.max_[axis]);
            break;
        case 4:
            b.max_[axis] = S(1e19);
            break;
        default:
            b.min_[axis] = -max;
            b.max_[axis] = inf;
        }
    }

    Family family_;
    std::mt19937_64& random_;
};

/// The least distance of the pairs that a callback was shown: of two bodies no less than that of
/// their bounds, the same both ways round (that of bounds with min > max is not).
template <class Api> struct Least {
    using S = typename Api::Scalar;
    using Object = typename Api::Object;

    S least = std::numeric_limits<S>::max();
    std::size_t calls = 0, enough = std::numeric_limits<std::size_t>::max();

    bool add(Object* a, Object* b, S& of_manager) {
        least = of_manager = std::min(least, distance(a, b));
        return ++calls >= enough;
    }

  private:
    static S distance(const Object* a, const Object* b) {
        const auto number = [](auto* object) {
            return static_cast<const typename Api::Body*>(object)->number();
        };
        const auto &of_a = a->getAABB(), &of_b = b->getAABB();
        return std::max(of_a.distance(of_b), of_b.distance(of_a)) +
               static_cast<S>((number(a) ^ number(b)) % 8) / 16;
    }
};

/// One set of bodies in three managers.
template <class Api> class Side {
  public:
    using Object = typename Api::Object;
    using Bounds = typename Api::Bounds;
    using Manager = typename Api::Manager;
    using Body = typename Api::Body;

    explicit Side(bool with_tree) : with_tree_(with_tree) {}

    typename Api::Ours ours;
    typename Api::Naive naive;
    typename Api::Tree tree;
    std::vector<std::unique_ptr<Body>> bodies;

    void add(const Bounds& bounds) {
        bodies.push_back(std::make_unique<Body>(bounds, ++numbers_));
        each([&](Manager& manager) { manager.registerObject(bodies.back().get()); });
    }
    void add_many(const std::vector<Bounds>& bounds) {
        std::vector<Object*> added;
        for (const auto& b : bounds) {
            bodies.push_back(std::make_unique<Body>(b, ++numbers_));
            added.push_back(bodies.back().get());
        }
        each([&](Manager& manager) { manager.registerObjects(added); });
    }
    void remove(std::size_t i) {
        each([&](Manager& manager) { manager.unregisterObject(bodies[i].get()); });
        std::swap(bodies[i], bodies.back());
        bodies.pop_back(); // whoever shows it from now on reads what is freed
    }
    void clear() {
        each([](Manager& manager) { manager.clear(); });
        bodies.clear();
    }
    /// Without the library's tree where it does not stand bounds that are not finite.
    template <class F> void each(const F& f) {
        f(ours);
        f(naive);
        if (with_tree_)
            f(tree);
    }
    bool with_tree() const { return with_tree_; }

  private:
    bool with_tree_;
    unsigned numbers_ = 0;
};

template <class Api> class History {
    using S = typename Api::Scalar;
    using Object = typename Api::Object;
    using Bounds = typename Api::Bounds;
    using Manager = typename Api::Manager;
    using Body = typename Api::Body;
    using Side = boxwood::Side<Api>;
    using Shown = ShownPairs<Api>;
    using Pairs = std::vector<ObjectPair<Api>>;

  public:
    History(Family family, std::uint64_t seed)
        : random_(seed),
          some_(family, random_), sides_{Side(has_tree(family)), Side(has_tree(family))} {}

    void run() {
        for (int i = 0; i < operations && !testing::Test::HasFailure(); ++i) {
            step(sides_[some_.below(2)], sides_[some_.below(2)]);
            for (Side& side : sides_)
                ASSERT_EQ(side.ours.size(), side.bodies.size());
        }
        EXPECT_GT(pairs_seen_, 1000u);
    }

  private:
    /// Whether the library's own tree stands such bounds.
    static bool has_tree(Family family) {
        return family == Family::real || (Api::tree_takes_flat && family != Family::wide);
    }

    void step(Side& side, Side& other) {
        const std::size_t n = side.bodies.size();
        const unsigned kind = some_.below(100);
        if (kind < 12 && n < max_bodies)
            side.add(some_.bounds());
        else if (kind < 14 && n < max_bodies / 2)
            add_many(side);
        else if (kind < 24 && n > 0)
            side.remove(some_.below(n));
        else if (kind == 24 && some_.one_in(10))
            some_.one_in(2) ? side.clear() : remove_most(side);
        else if (kind < 36 && n > 0)
            move_one(side);
        else if (kind < 44 && n > 0)
            move_some(side);
        else if (kind < 48)
            move_all(side);
        else if (kind < 52)
            side.each([](Manager& manager) { manager.setup(); });
        else if (kind < 68)
            collide_self(side);
        else if (kind < 78)
            collide_one(side, other);
        else if (kind < 86)
            collide_two(side, other);
        else if (kind < 91)
            distance_self(side);
        else if (kind < 96)
            distance_one(side, other);
        else
            distance_two(side, other);
    }

    void add_many(Side& side) {
        std::vector<Bounds> many;
        for (unsigned i = some_.below(max_bodies / 2); i-- > 0;)
            many.push_back(some_.bounds());
        side.add_many(many);
    }
    void remove_most(Side& side) {
        while (side.bodies.size() > 3)
            side.remove(some_.below(side.bodies.size()));
    }
    void move_one(Side& side) {
        Body* body = side.bodies[some_.below(side.bodies.size())].get();
        body->move(some_.bounds());
        side.each([&](Manager& manager) { manager.update(body); });
    }
    void move_some(Side& side) {
        std::vector<Object*> moved;
        for (unsigned i = some_.below(8); i-- > 0;) {
            Body* body = side.bodies[some_.below(side.bodies.size())].get();
            if (!some_.one_in(4))
                body->move(some_.bounds());
            moved.push_back(body); // perhaps twice, perhaps unmoved
        }
        side.each([&](Manager& manager) { manager.update(moved); });
    }
    void move_all(Side& side) {
        const unsigned one_in = 1 + some_.below(8);
        for (const auto& body : side.bodies)
            if (some_.one_in(one_in))
                body->move(some_.bounds());
        side.each([](Manager& manager) { manager.update(); });
    }

    /// query(manager, shown). The library's tree shows bounds as they were if they shrank; what
    /// overlaps now is the same.
    template <class Query> void same_pairs(Side& side, const Pairs& truth, const Query& query) {
        Shown ours, tree;
        query(side.ours, ours);
        EXPECT_EQ(ours.sorted(), truth);
        if (side.with_tree()) {
            query(side.tree, tree);
            EXPECT_EQ(tree.overlapping(), truth);
        }
        if (!truth.empty()) {
            Shown stopped;
            stopped.enough = 1 + some_.below(truth.size());
            query(side.ours, stopped);
            EXPECT_EQ(stopped.pairs.size(), stopped.enough);
        }
        pairs_seen_ += truth.size();
    }
    void collide_self(Side& side) {
        Shown naive;
        Api::collide(side.naive, naive);
        same_pairs(side, naive.sorted(),
                   [](Manager& manager, Shown& shown) { Api::collide(manager, shown); });
        same_pairs(side, naive.sorted(), [&](Manager& manager, Shown& shown) {
            if (&manager == &side.tree)
                Api::collide(manager, shown); // with itself it shows all twice
            else
                Api::collide(manager, shown, &manager);
        });
    }
    /// Of this side, of the other one, or of none.
    Object* any_object(Side& other) {
        if (other.bodies.empty() || some_.one_in(2)) {
            alone_ = std::make_unique<Body>(some_.bounds());
            return alone_.get();
        }
        return other.bodies[some_.below(other.bodies.size())].get();
    }
    void collide_one(Side& side, Side& other) {
        Object* object = any_object(other);
        Shown naive;
        Api::collide(side.naive, naive, object);
        same_pairs(side, naive.overlapping(),
                   [&](Manager& manager, Shown& shown) { Api::collide(manager, shown, object); });
    }
    void collide_two(Side& side, Side& other) {
        if (&side == &other)
            return;
        Shown naive;
        Api::collide(side.naive, naive, static_cast<Manager*>(&other.naive));
        Manager& others = some_.one_in(2) ? static_cast<Manager&>(other.naive) : other.ours;
        same_pairs(side, naive.sorted(), [&](Manager& manager, Shown& shown) {
            Manager& tree = other.tree;
            Api::collide(manager, shown, &manager == &side.tree ? &tree : &others);
        });
    }

    /// The least distance that a manager leads to, for the objects or managers of the call.
    template <class... Of> static S least(const Manager& manager, Of*... of) {
        Least<Api> found;
        Api::distance(manager, found, of...);
        return found.least;
    }
    void distance_self(Side& side) {
        const S naive = least(side.naive);
        EXPECT_EQ(least(side.ours), naive);
        if (side.with_tree()) {
            EXPECT_EQ(least(side.tree), naive);
        }
        Least<Api> stopped;
        stopped.enough = 2;
        Api::distance(side.ours, stopped);
        EXPECT_LE(stopped.calls, 2u);
    }
    void distance_one(Side& side, Side& other) {
        Object* object = any_object(other);
        const S naive = least(side.naive, object);
        EXPECT_EQ(least(side.ours, object), naive);
        if (side.with_tree()) {
            EXPECT_EQ(least(side.tree, object), naive);
        }
    }
    void distance_two(Side& side, Side& other) {
        if (&side == &other)
            return;
        Manager &ours = other.ours, &naives = other.naive, &trees = other.tree;
        const S naive = least(side.naive, &naives);
        EXPECT_EQ(least(side.ours, &ours), naive);
        EXPECT_EQ(least(side.ours, &naives), naive);
        if (side.with_tree()) {
            EXPECT_EQ(least(side.tree, &trees), naive);
        }
    }

    static constexpr std::size_t max_bodies = 120;

    std::mt19937_64 random_;
    SomeBounds<Api> some_;
    std::array<Side, 2> sides_;
    std::unique_ptr<Body> alone_;
    std::size_t pairs_seen_ = 0;
};

template <class Api> class ManagerHistories : public testing::Test {};
TYPED_TEST_SUITE_P(ManagerHistories);

TYPED_TEST_P(ManagerHistories, OnAGrid) { History<TypeParam>(Family::grid, 1).run(); }
TYPED_TEST_P(ManagerHistories, OfRealBounds) { History<TypeParam>(Family::real, 2).run(); }
TYPED_TEST_P(ManagerHistories, OfBoundsThatNearlyTouch) {
    History<TypeParam>(Family::nearly_touching, 3).run();
}
TYPED_TEST_P(ManagerHistories, OfBoundsFarApart) { History<TypeParam>(Family::far_apart, 4).run(); }
TYPED_TEST_P(ManagerHistories, OfBoundsThatTreesDoNotHold) {
    History<TypeParam>(Family::wide, 5).run();
}
REGISTER_TYPED_TEST_SUITE_P(ManagerHistories, OnAGrid, OfRealBounds, OfBoundsThatNearlyTouch,
                            OfBoundsFarApart, OfBoundsThatTreesDoNotHold);

} // namespace boxwood
