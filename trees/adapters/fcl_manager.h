#pragma once

/// For programs that use FCL: a broad phase on Boxwood's trees behind FCL's own interface. Compiled
/// by whoever includes it and has FCL 0.7; libboxwood knows nothing of FCL. Not part of trees.h.

#include "trees/adapters/detail/fcl_bounds.h"
#include "trees/dynamic/detail/item_tree.h"
#include "trees/dynamic/detail/nearest_first.h"
#include "trees/queries/filters.h"
#include "trees/queries/regions.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/sinks.h"
#include "trees/queries/tree_pairs.h"

#include <fcl/broadphase/broadphase_collision_manager.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace boxwood {

/// In place of FCL's managers, S being float or double: callbacks are shown each pair whose bounds,
/// those of the last registration or update, overlap; `distance` goes to the nearer ones first.
/// True from a callback ends the query at once. Throws std::invalid_argument for a null object, and
/// std::logic_error where a callback changes the manager.
/// Threads: any number may query at the same time; who changes it is alone meanwhile.
template <class S> class FclBroadPhase final : public fcl::BroadPhaseCollisionManager<S> {
  public:
    using Object = fcl::CollisionObject<S>;
    using Manager = fcl::BroadPhaseCollisionManager<S>;

    FclBroadPhase() { unpaired_.add_all(); }
    FclBroadPhase(const FclBroadPhase&) = delete;
    FclBroadPhase& operator=(const FclBroadPhase&) = delete;

    /// One that is registered already is updated.
    void registerObject(Object* object) override {
        begin_change();
        add(object);
    }
    void registerObjects(const std::vector<Object*>& objects) override {
        begin_change();
        if (std::ranges::find(objects, nullptr) != objects.end())
            throw_null();
        item_of_.reserve(item_of_.size() + objects.size());
        for (Object* object : objects)
            add(object);
    }
    /// One that is not registered is left alone.
    void unregisterObject(Object* object) override {
        begin_change();
        const auto found = item_of_.find(object);
        if (found == item_of_.end())
            return;
        const std::uint32_t item = found->second;
        item_of_.erase(found);
        bodies_[item].object = objects_[item] = nullptr;
        place(item, Box{}, false);
        free_.push_back(item);
        if (free_.size() > 64 && free_.size() > 2 * item_of_.size())
            renumber();
    }
    void clear() override {
        begin_change();
        bodies_.clear();
        objects_.clear();
        is_wide_.clear();
        item_of_.clear();
        free_.clear();
        wide_.clear();
        tree_.clear();
        pairs_.clear();
        unpaired_.clear();
        unpaired_.add_all();
    }

    /// What the next query would do first.
    void setup() override { const Query query(*this, detail::ItemTree::per_query); }

    /// Objects that moved have had their bounds computed (computeAABB) before.
    void update() override {
        begin_change();
        constexpr std::size_t ahead = 16;
        for (std::uint32_t item = 0; item < bodies_.size(); ++item) {
            if (item + ahead < bodies_.size() && bodies_[item + ahead].object)
                prefetch(*bodies_[item + ahead].newest);
            if (bodies_[item].object)
                follow(item);
        }
    }
    /// One that is not registered is left alone.
    void update(Object* object) override {
        begin_change();
        follow(object);
    }
    void update(const std::vector<Object*>& objects) override {
        begin_change();
        for (Object* object : objects)
            follow(object);
    }

    /// In the order of registration, but that a new one may take the place of one that is gone.
    void getObjects(std::vector<Object*>& objects) const override {
        objects.clear();
        std::ranges::copy_if(objects_, std::back_inserter(objects),
                             [](Object* object) { return object != nullptr; });
    }
    bool empty() const override { return item_of_.empty(); }
    std::size_t size() const override { return item_of_.size(); }

    /// callback(registered, object) for those that overlap the object; itself, if it is registered.
    void collide(Object* object, void* data, fcl::CollisionCallBack<S> callback) const override {
        const Query query(*this, detail::ItemTree::per_query);
        collide_one(object, data, callback);
    }
    /// Each two that overlap once.
    void collide(void* data, fcl::CollisionCallBack<S> callback) const override {
        const Query query(*this, detail::ItemTree::per_item * static_cast<double>(size()));
        const bool stopped = !collide_self(data, callback, cached_pairs());
        stops_early_.store(stopped, std::memory_order_relaxed);
    }
    /// callback(own, other's); with itself as the plain collide above. The other one may be of any
    /// kind. (FCL's own managers, called with this one, would take it for one of their kind.)
    void collide(Manager* other, void* data, fcl::CollisionCallBack<S> callback) const override {
        if (other == this)
            return collide(data, callback);
        const auto* same = dynamic_cast<const FclBroadPhase*>(other);
        if (!same)
            return collide_all_of(*other, data, callback);
        const Query query(*this, detail::ItemTree::per_item * static_cast<double>(size()));
        const Query others(*same, detail::ItemTree::per_item * static_cast<double>(same->size()));
        collide_two(*same, data, callback);
    }

    void distance(Object* object, void* data, fcl::DistanceCallBack<S> callback) const override {
        const Query query(*this, detail::ItemTree::per_query);
        Nearest nearest(data, callback);
        distance_one(object, nearest);
    }
    void distance(void* data, fcl::DistanceCallBack<S> callback) const override {
        const Query query(*this, detail::ItemTree::per_item * static_cast<double>(size()));
        Nearest nearest(data, callback);
        distance_self(nearest);
    }
    void distance(Manager* other, void* data, fcl::DistanceCallBack<S> callback) const override {
        if (other == this)
            return distance(data, callback);
        Nearest nearest(data, callback);
        const Query query(*this, detail::ItemTree::per_item * static_cast<double>(size()));
        if (const auto* same = dynamic_cast<const FclBroadPhase*>(other)) {
            const Query others(*same,
                               detail::ItemTree::per_item * static_cast<double>(same->size()));
            distance_two(*same, nearest);
            return;
        }
        std::vector<Object*> objects;
        other->getObjects(objects);
        for (Object* object : objects)
            if (!distance_one(object, nearest))
                return;
    }

  private:
    using Bounds = fcl::AABB<S>;
    /// One line of cache in doubles, half of one in floats.
    struct alignas(8 * sizeof(S)) Body {
        Bounds bounds;
        Object* object;       ///< null where none is
        const Bounds* newest; ///< what object->getAABB() refers to, without a call
    };
    class ShowPairs;
    class Nearest;

    /// While it lives the manager is not changed. The tree is up to date from here on.
    class Query {
      public:
        Query(const FclBroadPhase& manager, double cost) : manager_(manager) {
            ++manager_.queries_;
            try {
                manager_.prepare(cost);
            } catch (...) {
                --manager_.queries_;
                throw;
            }
        }
        Query(const Query&) = delete;
        Query& operator=(const Query&) = delete;
        ~Query() { --manager_.queries_; }

      private:
        const FclBroadPhase& manager_;
    };

    [[noreturn]] static void throw_null() {
        throw std::invalid_argument("FclBroadPhase: a null pointer is registered; give an object");
    }
    void begin_change() {
        if (queries_ != 0)
            throw std::logic_error("FclBroadPhase is changed while it is queried: from within a "
                                   "callback, or by another thread; do so once the query is over");
        is_stale_ = true;
    }
    void add(Object* object) {
        if (!object)
            throw_null();
        const auto [found, is_new] = item_of_.try_emplace(object, 0u);
        if (!is_new)
            return follow(found->second);
        if (free_.empty()) {
            found->second = static_cast<std::uint32_t>(bodies_.size());
            bodies_.push_back({Bounds(), nullptr, nullptr});
            objects_.push_back(nullptr);
            is_wide_.push_back(0);
        } else {
            found->second = free_.back();
            free_.pop_back();
        }
        bodies_[found->second].object = objects_[found->second] = object;
        bodies_[found->second].newest = &object->getAABB();
        take(found->second);
    }
    /// Numbers the objects from 0 again, as most numbers are free.
    void renumber() {
        std::vector<Object*> objects;
        getObjects(objects);
        clear();
        for (Object* object : objects)
            add(object);
    }
    static void prefetch(const Bounds& bounds) {
        detail::prefetch(&bounds.min_);
        detail::prefetch(&bounds.max_[2]);
    }
    void follow(Object* object) {
        const auto found = item_of_.find(object);
        if (found != item_of_.end())
            follow(found->second);
    }
    void follow(std::uint32_t item) {
        if (!detail::is_same(*bodies_[item].newest, bodies_[item].bounds))
            take(item);
    }
    void take(std::uint32_t item) {
        Body& body = bodies_[item];
        body.bounds = *body.newest;
        const Box box = detail::box_around(body.bounds);
        place(item, box, box == Box{});
    }
    void place(std::uint32_t item, const Box& box, bool is_wide) {
        tree_.set(item, box);
        unpaired_.add(item, bodies_.size());
        if (is_wide == (is_wide_[item] != 0))
            return;
        is_wide_[item] = is_wide;
        if (is_wide)
            wide_.push_back(item);
        else
            std::erase(wide_, item);
    }

    /// Queries that begin meanwhile wait for the tree; one that is under way keeps it as it is.
    void prepare(double cost) const {
        if (is_stale_) {
            const std::lock_guard lock(changing_);
            if (is_stale_ && tree_.refresh(cost))
                lost_ = 0;
            is_stale_ = false;
        }
        if (const double excess = tree_.excess(cost); excess > 0) {
            const double lost = lost_.load(std::memory_order_relaxed) + excess;
            lost_.store(lost, std::memory_order_relaxed);
            if (tree_.is_worth_order(lost))
                reorder();
        }
    }
    void reorder() const {
        const std::lock_guard lock(changing_);
        is_stale_ = true;
        if (queries_ <= 1 && tree_.is_worth_order(lost_)) {
            tree_.reorder();
            lost_ = 0;
        }
        is_stale_ = false;
    }

    bool overlap(std::uint32_t a, const Bounds& b) const {
        return detail::overlap(bodies_[a].bounds, b);
    }
    bool overlap(Pair pair) const { return overlap(pair.a, bodies_[pair.b].bounds); }
    static constexpr bool is_exact = std::is_same_v<S, float>; ///< the boxes of the tree

    const std::vector<Pair>* cached_pairs() const;
    void find_pairs() const;
    void follow_pairs() const;
    bool collide_self(void* data, fcl::CollisionCallBack<S> callback,
                      const std::vector<Pair>* cached) const;
    bool collide_one(Object* object, void* data, fcl::CollisionCallBack<S> callback) const;
    bool collide_two(const FclBroadPhase& other, void* data,
                     fcl::CollisionCallBack<S> callback) const;
    void collide_all_of(Manager& other, void* data, fcl::CollisionCallBack<S> callback) const {
        const Query query(*this, detail::ItemTree::per_item * static_cast<double>(size()));
        std::vector<Object*> objects;
        other.getObjects(objects);
        for (Object* object : objects)
            if (!collide_one(object, data, callback))
                return;
    }
    bool distance_one(Object* object, Nearest& nearest) const;
    bool distance_self(Nearest& nearest) const;
    bool distance_two(const FclBroadPhase& other, Nearest& nearest) const;

    std::vector<Body> bodies_;          ///< by item
    std::vector<Object*> objects_;      ///< the same objects, close together
    std::vector<std::uint8_t> is_wide_; ///< by item: not in the tree
    std::vector<std::uint32_t> wide_;   ///< items that are not in the tree, each tested with all
    std::vector<std::uint32_t> free_;   ///< items that are none
    std::unordered_map<const Object*, std::uint32_t> item_of_;

    mutable std::mutex changing_; ///< whoever changes what queries read
    mutable std::atomic<bool> is_stale_ = false;
    mutable std::atomic<int> queries_ = 0;
    mutable std::atomic<double> lost_ = 0; ///< by queries in the tree as it is, nanoseconds
    mutable detail::ItemTree tree_;

    // The overlapping pairs of the tree, if they are held:
    mutable std::vector<Pair> pairs_;
    mutable bool has_pairs_ = false;
    mutable detail::ChangedItems unpaired_; ///< since they were up to date
    mutable std::atomic<bool> stops_early_ = false;
};

} // namespace boxwood

#include "trees/adapters/detail/fcl_collide-inl.h"
#include "trees/adapters/detail/fcl_distance-inl.h"
