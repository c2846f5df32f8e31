#pragma once

/// For programs that use Coal: their calls to a manager, in a file that `boxwood
/// replay` runs again. Compiled by whoever includes it and has Coal 3 and HDF5; not part of
/// trees.h.

#include "trees/adapters/detail/coal_geometry.h"
#include "trees/adapters/detail/recorded_manager.h"

#include <coal/broadphase/broadphase_callbacks.h>
#include <coal/broadphase/broadphase_collision_manager.h>
#include <coal/collision.h>
#include <coal/distance.h>

#include <cstddef>
#include <vector>

namespace boxwood {
namespace detail {

/// What a recorder has to know of Coal.
struct CoalLibrary {
    using Object = coal::CollisionObject;
    using Manager = coal::BroadPhaseCollisionManager;
    using Geometry = coal::CollisionGeometry;
    static constexpr double bits = 8 * sizeof(coal::CoalScalar);

    static RecordedGeometry recorded(const Geometry& geometry) {
        return detail::recorded(geometry);
    }
    static auto rotation(const Object& object) { return object.getTransform().getRotation(); }
    static auto translation(const Object& object) { return object.getTransform().getTranslation(); }
    static std::vector<Object*> objects_of(const Manager& manager) {
        std::vector<Object*> objects;
        manager.getObjects(objects);
        return objects;
    }
};

} // namespace detail

/// Hands every call to a manager of Coal's interface, and writes it down: as FclRecorder does.
/// Bounds of objects are those that they have (computeAABB).
class CoalRecorder final : public detail::RecordedManager<detail::CoalLibrary> {
    using Library = detail::CoalLibrary;
    using Base = detail::RecordedManager<Library>;

  public:
    using Base::Base, Base::getObjects;

    Objects getObjects() const override { return Library::objects_of(to()); }
    void collide(Object* object, coal::CollisionCallBackBase* callback) const override {
        Shown shown(*this, callback);
        calls_.record(recording::Call::collide_object, {object}, shown,
                      [&] { to().collide(object, &shown); });
    }
    void collide(coal::CollisionCallBackBase* callback) const override {
        Shown shown(*this, callback);
        calls_.record(recording::Call::collide_self, {}, shown, [&] { to().collide(&shown); });
    }
    /// The other one may be a recorder, too.
    void collide(Manager* other, coal::CollisionCallBackBase* callback) const override {
        if (other == this)
            return collide(callback);
        Shown shown(*this, callback);
        Manager* const with = &Base::behind(other);
        calls_.record(recording::Call::collide_others, Library::objects_of(*with), shown,
                      [&] { to().collide(with, &shown); });
    }
    void distance(Object* object, coal::DistanceCallBackBase* callback) const override {
        Measured measured(*this, callback);
        calls_.record(recording::Call::distance_object, {object}, measured,
                      [&] { to().distance(object, &measured); });
    }
    void distance(coal::DistanceCallBackBase* callback) const override {
        Measured measured(*this, callback);
        calls_.record(recording::Call::distance_self, {}, measured,
                      [&] { to().distance(&measured); });
    }
    void distance(Manager* other, coal::DistanceCallBackBase* callback) const override {
        if (other == this)
            return distance(callback);
        Measured measured(*this, callback);
        Manager* const with = &Base::behind(other);
        calls_.record(recording::Call::distance_others, Library::objects_of(*with), measured,
                      [&] { to().distance(with, &measured); });
    }

    /// In callbacks, in the place of coal::collide and coal::distance: the query
    /// is written down, too. Without a recorder, and outside of its calls, they do the same.
    static std::size_t collide(const Object* a, const Object* b,
                               const coal::CollisionRequest& request,
                               coal::CollisionResult& result) {
        return Calls::timed({0, static_cast<double>(request.num_max_contacts),
                             request.enable_contact ? 1. : 0., 0, 0},
                            [&] { return coal::collide(a, b, request, result); });
    }
    static coal::CoalScalar distance(const Object* a, const Object* b,
                                     const coal::DistanceRequest& request,
                                     coal::DistanceResult& result) {
        return Calls::timed({1, 0, 0, 1, request.enable_signed_distance ? 1. : 0.},
                            [&] { return coal::distance(a, b, request, result); });
    }

  private:
    struct Shown final : Calls::Answer, coal::CollisionCallBackBase {
        const CoalRecorder& recorder;
        coal::CollisionCallBackBase& callback;

        Shown(const CoalRecorder& r, coal::CollisionCallBackBase* c) : recorder(r), callback(*c) {}
        void init() override { callback.init(); }
        bool collide(Object* a, Object* b) override {
            add(recorder.calls_, a, b);
            return ended = callback(a, b);
        }
    };
    struct Measured final : Calls::Answer, coal::DistanceCallBackBase {
        const CoalRecorder& recorder;
        coal::DistanceCallBackBase& callback;

        Measured(const CoalRecorder& r, coal::DistanceCallBackBase* c)
            : recorder(r), callback(*c) {}
        void init() override { callback.init(); }
        bool distance(Object* a, Object* b, coal::CoalScalar& least) override {
            add(recorder.calls_, a, b);
            ended = callback(a, b, least);
            min_distance = static_cast<double>(least);
            return ended;
        }
    };
};

} // namespace boxwood
