#pragma once

#include "trees/adapters/detail/bounds.h"
#include "trees/dynamic/detail/item_tree.h"
#include "trees/dynamic/detail/nearest_first.h"
#include "trees/queries/filters.h"
#include "trees/queries/regions.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/sinks.h"
#include "trees/queries/tree_pairs.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace boxwood::detail {

/// What a manager of FCL's or Coal's interface does, on a tree of the objects' bounds. A Library
/// has Object, whose getAABB() refers to its Bounds (with min_, max_ and distance), and its
/// manager's name. Callbacks are (object, object) -> true to end the query; those of distances also
/// take the least distance so far, by reference. The manager's header has the contract.
template <class Library> class ObjectBroadPhase {
  public:
    using Object = typename Library::Object;
    using Bounds = typename Library::Bounds;
    using Objects = std::vector<Object*>;

    ObjectBroadPhase() { unpaired_.add_all(); }
    ObjectBroadPhase(const ObjectBroadPhase&) = delete;
    ObjectBroadPhase& operator=(const ObjectBroadPhase&) = delete;

    void add(Object* object) {
        begin_change();
        put(object);
    }
    void add(const Objects& objects) {
        begin_change();
        if (std::ranges::find(objects, nullptr) != objects.end())
            throw_null();
        item_of_.reserve(item_of_.size() + objects.size());
        for (Object* object : objects)
            put(object);
    }
    void remove(Object* object) {
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
    void clear() {
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
    void setup() const { const Query query(*this, ItemTree::per_query); }

    void update() {
        begin_change();
        constexpr std::size_t ahead = 16;
        for (std::uint32_t item = 0; item < bodies_.size(); ++item) {
            if (item + ahead < bodies_.size() && bodies_[item + ahead].object)
                prefetch(*bodies_[item + ahead].newest);
            if (bodies_[item].object)
                follow(item);
        }
    }
    void update(Object* object) {
        begin_change();
        follow(object);
    }
    void update(const Objects& objects) {
        begin_change();
        for (Object* object : objects)
            follow(object);
    }

    void list(Objects& objects) const {
        objects.clear();
        std::ranges::copy_if(objects_, std::back_inserter(objects),
                             [](Object* object) { return object != nullptr; });
    }
    std::size_t size() const { return item_of_.size(); }

    template <class Callback> void collide(Object* object, const Callback& callback) const {
        if (!object)
            throw_null();
        const Query query(*this, ItemTree::per_query);
        collide_one(object, callback);
    }
    template <class Callback> void collide(const Callback& callback) const {
        const Query query(*this, per_all());
        const bool stopped = !collide_self(callback, cached_pairs());
        stops_early_.store(stopped, std::memory_order_relaxed);
    }
    template <class Callback>
    void collide(const ObjectBroadPhase& other, const Callback& callback) const {
        const Query query(*this, per_all()), others(other, other.per_all());
        collide_two(other, callback);
    }
    template <class Callback> void collide(const Objects& objects, const Callback& callback) const {
        const Query query(*this, per_all());
        for (Object* object : objects)
            if (!collide_one(object, callback))
                return;
    }

    template <class Callback> void distance(Object* object, const Callback& callback) const {
        if (!object)
            throw_null();
        const Query query(*this, ItemTree::per_query);
        Nearest<Callback> nearest(callback);
        distance_one(object, nearest);
    }
    template <class Callback> void distance(const Callback& callback) const {
        const Query query(*this, per_all());
        Nearest<Callback> nearest(callback);
        distance_self(nearest);
    }
    template <class Callback>
    void distance(const ObjectBroadPhase& other, const Callback& callback) const {
        const Query query(*this, per_all()), others(other, other.per_all());
        Nearest<Callback> nearest(callback);
        distance_two(other, nearest);
    }
    template <class Callback>
    void distance(const Objects& objects, const Callback& callback) const {
        const Query query(*this, per_all());
        Nearest<Callback> nearest(callback);
        for (Object* object : objects)
            if (!distance_one(object, nearest))
                return;
    }

  private:
    using S = ScalarOf<Bounds>;
    /// One line of cache in doubles, half of one in floats.
    struct alignas(8 * sizeof(S)) Body {
        Bounds bounds;
        Object* object;       ///< null where none is
        const Bounds* newest; ///< what object->getAABB() refers to, without a call
    };
    template <class Callback> class ShowPairs;
    template <class Callback> class Nearest;

    /// While it lives the manager is not changed. The tree is up to date from here on.
    class Query {
      public:
        Query(const ObjectBroadPhase& manager, double cost) : manager_(manager) {
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
        const ObjectBroadPhase& manager_;
    };

    [[noreturn]] static void throw_null() {
        throw std::invalid_argument(std::string(Library::name) +
                                    ": a null pointer is no object; give an object");
    }
    void begin_change() {
        if (queries_ != 0)
            throw std::logic_error(std::string(Library::name) +
                                   " is changed while it is queried: from within a callback, or "
                                   "by another thread; do so once the query is over");
        is_stale_ = true;
    }
    void put(Object* object) {
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
        bodies_[found->second].newest = &std::as_const(*object).getAABB();
        take(found->second);
    }
    /// Numbers the objects from 0 again, as most numbers are free.
    void renumber() {
        Objects objects;
        list(objects);
        clear();
        for (Object* object : objects)
            put(object);
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
        if (!is_same(*bodies_[item].newest, bodies_[item].bounds))
            take(item);
    }
    void take(std::uint32_t item) {
        Body& body = bodies_[item];
        body.bounds = *body.newest;
        const Box box = box_around(body.bounds);
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
    double per_all() const { return ItemTree::per_item * static_cast<double>(size()); }

    const std::vector<Pair>* cached_pairs() const;
    void find_pairs() const;
    void follow_pairs() const;
    // False: the callback ended the query.
    template <class Callback>
    bool collide_self(const Callback& callback, const std::vector<Pair>* cached) const;
    template <class Callback> bool collide_one(Object* object, const Callback& callback) const;
    template <class Callback>
    bool collide_two(const ObjectBroadPhase& other, const Callback& callback) const;
    template <class Callback> bool distance_one(Object* object, Nearest<Callback>& nearest) const;
    template <class Callback> bool distance_self(Nearest<Callback>& nearest) const;
    template <class Callback>
    bool distance_two(const ObjectBroadPhase& other, Nearest<Callback>& nearest) const;

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
    mutable ItemTree tree_;

    // The overlapping pairs of the tree, if they are held:
    mutable std::vector<Pair> pairs_;
    mutable bool has_pairs_ = false;
    mutable ChangedItems unpaired_; ///< since they were up to date
    mutable std::atomic<bool> stops_early_ = false;
};

} // namespace boxwood::detail

#include "trees/adapters/detail/object_collide-inl.h"
#include "trees/adapters/detail/object_distance-inl.h"
