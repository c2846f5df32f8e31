#pragma once

/// For programs that use FCL: a broad phase on Boxwood's trees behind FCL's own interface. Compiled
/// by whoever includes it and has FCL 0.7; libboxwood knows nothing of FCL. Not part of trees.h.

#include "trees/adapters/detail/object_broad_phase.h"

#include <fcl/broadphase/broadphase_collision_manager.h>

#include <cstddef>
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

    /// One that is registered already is updated.
    void registerObject(Object* object) override { all_.add(object); }
    void registerObjects(const std::vector<Object*>& objects) override { all_.add(objects); }
    /// One that is not registered is left alone.
    void unregisterObject(Object* object) override { all_.remove(object); }
    void clear() override { all_.clear(); }
    /// What the next query would do first.
    void setup() override { all_.setup(); }

    /// Objects that moved have had their bounds computed (computeAABB) before.
    void update() override { all_.update(); }
    /// One that is not registered is left alone.
    void update(Object* object) override { all_.update(object); }
    void update(const std::vector<Object*>& objects) override { all_.update(objects); }

    /// In the order of registration, but that a new one may take the place of one that is gone.
    void getObjects(std::vector<Object*>& objects) const override { all_.list(objects); }
    bool empty() const override { return all_.size() == 0; }
    std::size_t size() const override { return all_.size(); }

    /// callback(registered, object) for those that overlap the object; itself, if it is registered.
    void collide(Object* object, void* data, fcl::CollisionCallBack<S> callback) const override {
        all_.collide(object, shown(data, callback));
    }
    /// Each two that overlap once.
    void collide(void* data, fcl::CollisionCallBack<S> callback) const override {
        all_.collide(shown(data, callback));
    }
    /// callback(own, other's); with itself as the plain collide above. The other one may be of any
    /// kind. (FCL's own managers, called with this one, would take it for one of their kind.)
    void collide(Manager* other, void* data, fcl::CollisionCallBack<S> callback) const override {
        if (other == this)
            return collide(data, callback);
        if (const auto* same = dynamic_cast<const FclBroadPhase*>(other))
            return all_.collide(same->all_, shown(data, callback));
        all_.collide(objects_of(*other), shown(data, callback));
    }

    void distance(Object* object, void* data, fcl::DistanceCallBack<S> callback) const override {
        all_.distance(object, measured(data, callback));
    }
    void distance(void* data, fcl::DistanceCallBack<S> callback) const override {
        all_.distance(measured(data, callback));
    }
    void distance(Manager* other, void* data, fcl::DistanceCallBack<S> callback) const override {
        if (other == this)
            return distance(data, callback);
        if (const auto* same = dynamic_cast<const FclBroadPhase*>(other))
            return all_.distance(same->all_, measured(data, callback));
        all_.distance(objects_of(*other), measured(data, callback));
    }

  private:
    struct Library {
        using Object = fcl::CollisionObject<S>;
        using Bounds = fcl::AABB<S>;
        static constexpr const char* name = "FclBroadPhase";
    };
    static auto shown(void* data, fcl::CollisionCallBack<S> callback) {
        return [=](Object* a, Object* b) { return callback(a, b, data); };
    }
    static auto measured(void* data, fcl::DistanceCallBack<S> callback) {
        return [=](Object* a, Object* b, S& least) { return callback(a, b, data, least); };
    }
    static std::vector<Object*> objects_of(const Manager& manager) {
        std::vector<Object*> objects;
        manager.getObjects(objects);
        return objects;
    }

    detail::ObjectBroadPhase<Library> all_;
};

} // namespace boxwood
