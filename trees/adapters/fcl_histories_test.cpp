/// Random histories of a manager, in step with FCL's own: the same pairs, the same least distances.

#include "trees/adapters/fcl_manager.h"
#include "trees/adapters/testing/fcl_bodies.h"

#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <random>

namespace boxwood {
namespace {

constexpr int operations = 10'000;

/// Where bounds lie.
enum class Family { grid, real, nearly_touching, far_apart, wide };

template <class S> class Bodies {
  public:
    Bodies(Family family, std::mt19937_64& random) : family_(family), random_(random) {}

    fcl::AABB<S> bounds() {
        fcl::AABB<S> b;
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
    void spoil(fcl::AABB<S>& b) {
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
            b = fcl::AABB<S>();
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

/// The distance of two bodies, no less than that of their bounds, the same both ways round (FCL's
/// of bounds with min > max is not).
template <class S>
S shape_distance(const fcl::CollisionObject<S>* a, const fcl::CollisionObject<S>* b) {
    const auto number = [](auto* body) { return static_cast<const FclBody<S>*>(body)->number(); };
    const auto &of_a = a->getAABB(), &of_b = b->getAABB();
    return std::max(of_a.distance(of_b), of_b.distance(of_a)) +
           static_cast<S>((number(a) ^ number(b)) % 8) / 16;
}

template <class S> struct Least {
    S least = std::numeric_limits<S>::max();
    std::size_t calls = 0, enough = std::numeric_limits<std::size_t>::max();

    static bool take(fcl::CollisionObject<S>* a, fcl::CollisionObject<S>* b, void* data, S& least) {
        auto& self = *static_cast<Least*>(data);
        self.least = std::min(self.least, shape_distance(a, b));
        least = self.least;
        return ++self.calls >= self.enough;
    }
};

/// One set of bodies in three managers.
template <class S> class Side {
  public:
    using Object = fcl::CollisionObject<S>;
    using Manager = fcl::BroadPhaseCollisionManager<S>;

    explicit Side(bool with_tree) : with_tree_(with_tree) {}

    FclBroadPhase<S> ours;
    fcl::NaiveCollisionManager<S> naive;
    fcl::DynamicAABBTreeCollisionManager<S> tree;
    std::vector<std::unique_ptr<FclBody<S>>> bodies;

    void add(const fcl::AABB<S>& bounds) {
        bodies.push_back(std::make_unique<FclBody<S>>(bounds, ++numbers_));
        each([&](Manager& manager) { manager.registerObject(bodies.back().get()); });
    }
    void add_many(const std::vector<fcl::AABB<S>>& bounds) {
        std::vector<Object*> added;
        for (const auto& b : bounds) {
            bodies.push_back(std::make_unique<FclBody<S>>(b, ++numbers_));
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
    /// Without FCL's tree where it does not stand bounds that are not finite.
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

template <class S> class History {
  public:
    History(Family family, std::uint64_t seed)
        : random_(seed), some_(family, random_), sides_{Side<S>(family != Family::wide),
                                                        Side<S>(family != Family::wide)} {}

    void run() {
        for (int i = 0; i < operations && !testing::Test::HasFailure(); ++i) {
            step(sides_[some_.below(2)], sides_[some_.below(2)]);
            for (Side<S>& side : sides_)
                ASSERT_EQ(side.ours.size(), side.bodies.size());
        }
        EXPECT_GT(pairs_seen_, 1000u);
    }

  private:
    using Object = fcl::CollisionObject<S>;
    using Manager = fcl::BroadPhaseCollisionManager<S>;
    using Pairs = std::vector<FclPair<S>>;

    void step(Side<S>& side, Side<S>& other) {
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

    void add_many(Side<S>& side) {
        std::vector<fcl::AABB<S>> many;
        for (unsigned i = some_.below(max_bodies / 2); i-- > 0;)
            many.push_back(some_.bounds());
        side.add_many(many);
    }
    void remove_most(Side<S>& side) {
        while (side.bodies.size() > 3)
            side.remove(some_.below(side.bodies.size()));
    }
    void move_one(Side<S>& side) {
        FclBody<S>* body = side.bodies[some_.below(side.bodies.size())].get();
        body->move(some_.bounds());
        side.each([&](Manager& manager) { manager.update(body); });
    }
    void move_some(Side<S>& side) {
        std::vector<Object*> moved;
        for (unsigned i = some_.below(8); i-- > 0;) {
            FclBody<S>* body = side.bodies[some_.below(side.bodies.size())].get();
            if (!some_.one_in(4))
                body->move(some_.bounds());
            moved.push_back(body); // perhaps twice, perhaps unmoved
        }
        side.each([&](Manager& manager) { manager.update(moved); });
    }
    void move_all(Side<S>& side) {
        const unsigned one_in = 1 + some_.below(8);
        for (const auto& body : side.bodies)
            if (some_.one_in(one_in))
                body->move(some_.bounds());
        side.each([](Manager& manager) { manager.update(); });
    }

    /// query(manager, data, callback). FCL's tree shows bounds as they were if they shrank; what
    /// overlaps now is the same.
    template <class Query> void same_pairs(Side<S>& side, const Pairs& truth, const Query& query) {
        ShownPairs<S> ours, tree;
        query(side.ours, side.tree, &ours, ShownPairs<S>::add);
        EXPECT_EQ(ours.sorted(), truth);
        if (side.with_tree()) {
            query(side.tree, side.tree, &tree, ShownPairs<S>::add);
            EXPECT_EQ(tree.overlapping(), truth);
        }
        if (!truth.empty()) {
            ShownPairs<S> stopped;
            stopped.enough = 1 + some_.below(truth.size());
            query(side.ours, side.tree, &stopped, ShownPairs<S>::add);
            EXPECT_EQ(stopped.pairs.size(), stopped.enough);
        }
        pairs_seen_ += truth.size();
    }
    void collide_self(Side<S>& side) {
        ShownPairs<S> naive;
        side.naive.collide(&naive, ShownPairs<S>::add);
        same_pairs(side, naive.sorted(), [](Manager& manager, Manager&, void* data, auto callback) {
            manager.collide(data, callback);
        });
        same_pairs(side, naive.sorted(),
                   [&](Manager& manager, Manager& tree, void* data, auto callback) {
                       if (&manager == &tree)
                           manager.collide(data, callback); // FCL's tree shows all twice here
                       else
                           manager.collide(&manager, data, callback);
                   });
    }
    /// Of this side, of the other one, or of none.
    Object* any_object(Side<S>& other) {
        if (other.bodies.empty() || some_.one_in(2)) {
            alone_ = std::make_unique<FclBody<S>>(some_.bounds());
            return alone_.get();
        }
        return other.bodies[some_.below(other.bodies.size())].get();
    }
    void collide_one(Side<S>& side, Side<S>& other) {
        Object* object = any_object(other);
        ShownPairs<S> naive;
        side.naive.collide(object, &naive, ShownPairs<S>::add);
        same_pairs(side, naive.overlapping(),
                   [&](Manager& manager, Manager&, void* data, auto callback) {
                       manager.collide(object, data, callback);
                   });
    }
    void collide_two(Side<S>& side, Side<S>& other) {
        if (&side == &other)
            return;
        ShownPairs<S> naive;
        side.naive.collide(&other.naive, &naive, ShownPairs<S>::add);
        const bool foreign = some_.one_in(2);
        same_pairs(side, naive.sorted(),
                   [&](Manager& manager, Manager& tree, void* data, auto callback) {
                       if (&manager == &tree)
                           manager.collide(&other.tree, data, callback);
                       else if (foreign)
                           manager.collide(&other.naive, data, callback);
                       else
                           manager.collide(&other.ours, data, callback);
                   });
    }

    void same_least(S ours, S naive, const std::optional<S>& tree) {
        EXPECT_EQ(ours, naive);
        if (tree) {
            EXPECT_EQ(ours, *tree);
        }
    }
    template <class Query> S least(const Query& query) {
        Least<S> found;
        query(&found, Least<S>::take);
        return found.least;
    }
    void distance_self(Side<S>& side) {
        const auto of = [&](Manager& manager) {
            return least([&](void* data, auto take) { manager.distance(data, take); });
        };
        same_least(of(side.ours), of(side.naive), tree_only(side, of));
        Least<S> stopped;
        stopped.enough = 2;
        side.ours.distance(&stopped, Least<S>::take);
        EXPECT_LE(stopped.calls, 2u);
    }
    void distance_one(Side<S>& side, Side<S>& other) {
        Object* object = any_object(other);
        const auto of = [&](Manager& manager) {
            return least([&](void* data, auto take) { manager.distance(object, data, take); });
        };
        same_least(of(side.ours), of(side.naive), tree_only(side, of));
    }
    void distance_two(Side<S>& side, Side<S>& other) {
        if (&side == &other)
            return;
        const auto with = [&](Manager& manager, Manager& others) {
            return least([&](void* data, auto take) { manager.distance(&others, data, take); });
        };
        const S naive = with(side.naive, other.naive);
        same_least(with(side.ours, other.ours), naive, {});
        same_least(with(side.ours, other.naive), naive,
                   tree_only(side, [&](Manager& tree) { return with(tree, other.tree); }));
    }
    template <class Of> std::optional<S> tree_only(Side<S>& side, const Of& of) {
        return side.with_tree() ? std::optional<S>(of(side.tree)) : std::nullopt;
    }

    static constexpr std::size_t max_bodies = 120;

    std::mt19937_64 random_;
    Bodies<S> some_;
    std::array<Side<S>, 2> sides_;
    std::unique_ptr<FclBody<S>> alone_;
    std::size_t pairs_seen_ = 0;
};

template <class S> class FclHistories : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FclHistories, Scalars);

TYPED_TEST(FclHistories, OnAGrid) { History<TypeParam>(Family::grid, 1).run(); }
TYPED_TEST(FclHistories, OfRealBounds) { History<TypeParam>(Family::real, 2).run(); }
TYPED_TEST(FclHistories, OfBoundsThatNearlyTouch) {
    History<TypeParam>(Family::nearly_touching, 3).run();
}
TYPED_TEST(FclHistories, OfBoundsFarApart) { History<TypeParam>(Family::far_apart, 4).run(); }
TYPED_TEST(FclHistories, OfBoundsThatTreesDoNotHold) { History<TypeParam>(Family::wide, 5).run(); }

} // namespace
} // namespace boxwood
