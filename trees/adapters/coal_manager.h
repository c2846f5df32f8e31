#pragma once

/// For programs that use Coal: a broad phase on Boxwood's trees behind Coal's own interface.
/// Compiled by whoever includes it and has Coal 3; libboxwood knows nothing of Coal. Not part of
/// trees.h.

#include "trees/adapters/detail/object_broad_phase.h"

#include <coal/broadphase/broadphase_callbacks.h>
#include <coal/broadphase/broadphase_collision_manager.h>

#include <cstddef>
#include <vector>

namespace boxwood {

/// In place of Coal's managers: callbacks are shown each pair whose bounds, those of the last
/// registration or update, overlap; `distance` goes to the nearer ones first. A callback's init()
/// is called once before, and true from it ends the query at once. Throws std::invalid_argument for
/// a null object, and std::logic_error where a callback changes the manager. Threads: any number
/// may query at the same time; who changes it is alone meanwhile.
class CoalBroadPhase final : public coal::BroadPhaseCollisionManager {
    struct Library {
        using Object = coal::CollisionObject;
        using Bounds = coal::AABB;
        static constexpr const char* name = "CoalBroadPhase";
    };
    static auto shown(coal::CollisionCallBackBase& callback) {
        callback.init();
        return [to = &callback](coal::CollisionObject* a, coal::CollisionObject* b) {
            return (*to)(a, b);
        };
    }
    static auto measured(coal::DistanceCallBackBase& callback) {
        callback.init();
        return [to = &callback](coal::CollisionObject* a, coal::CollisionObject* b,
                                coal::CoalScalar& least) { return (*to)(a, b, least); };
    }
    static std::vector<coal::CollisionObject*>
    objects_of(const coal::BroadPhaseCollisionManager& manager) {
        std::vector<coal::CollisionObject*> objects;
        manager.getObjects(objects);
        return objects;
    }

  public:
    using Object = coal::CollisionObject;
    using Manager = coal::BroadPhaseCollisionManager;

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
    std::vector<Object*> getObjects() const override { return objects_of(*this); }
    bool empty() const override { return all_.size() == 0; }
    std::size_t size() const override { return all_.size(); }

    /// callback(registered, object) for those that overlap the object; itself, if it is registered.
    void collide(Object* object, coal::CollisionCallBackBase* callback) const override {
        all_.collide(object, shown(*callback));
    }
    /// Each two that overlap once.
    void collide(coal::CollisionCallBackBase* callback) const override {
        all_.collide(shown(*callback));
    }
    /// callback(own, other's); with itself as the plain collide above. The other one may be of any
    /// kind. (Coal's own managers, called with this one, would take it for one of their kind.)
    void collide(Manager* other, coal::CollisionCallBackBase* callback) const override {
        if (other == this)
            return collide(callback);
        if (const auto* same = dynamic_cast<const CoalBroadPhase*>(other))
            return all_.collide(same->all_, shown(*callback));
        all_.collide(objects_of(*other), shown(*callback));
    }

    void distance(Object* object, coal::DistanceCallBackBase* callback) const override {
        all_.distance(object, measured(*callback));
    }
    void distance(coal::DistanceCallBackBase* callback) const override {
        all_.distance(measured(*callback));
    }
    void distance(Manager* other, coal::DistanceCallBackBase* callback) const override {
        if (other == this)
            return distance(callback);
        if (const auto* same = dynamic_cast<const CoalBroadPhase*>(other))
            return all_.distance(same->all_, measured(*callback));
        all_.distance(objects_of(*other), measured(*callback));
    }

  private:
    detail::ObjectBroadPhase<Library> all_;
};

} // namespace boxwood
