#pragma once

/// For programs that use FCL: their calls to a manager, in a file that `boxwood
/// replay` runs again. Compiled by whoever includes it and has FCL 0.7 and HDF5; not part of
/// trees.h.

#include "trees/adapters/detail/fcl_geometry.h"
#include "trees/adapters/detail/recorded_manager.h"

#include <fcl/broadphase/broadphase_collision_manager.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <cstddef>
#include <vector>

namespace boxwood {
namespace detail {

/// What a recorder has to know of FCL.
template <class S> struct FclLibrary {
    using Object = fcl::CollisionObject<S>;
    using Manager = fcl::BroadPhaseCollisionManager<S>;
    using Geometry = fcl::CollisionGeometry<S>;
    static constexpr double bits = 8 * sizeof(S);

    static RecordedGeometry recorded(const Geometry& geometry) {
        return detail::recorded(geometry);
    }
    static auto rotation(const Object& object) { return object.getTransform().linear(); }
    static auto translation(const Object& object) { return object.getTransform().translation(); }
    static std::vector<Object*> objects_of(const Manager& manager) {
        std::vector<Object*> objects;
        manager.getObjects(objects);
        return objects;
    }
};

} // namespace detail

/// Hands every call to a manager of FCL's interface, which outlives it, and writes it down: objects
/// with their bounds and poses, geometries once, what callbacks were shown, how long it took.
/// Objects that the manager has already are registered in the recording, too. Threads may call it
/// at a time as they may call the manager, and wait for each other only while something is noted or
/// written; calls are written in the order in which they begin. A forked child's calls are handed
/// on, and not written. `close`, or the destructor, ends the file; if the program ends badly, but
/// while it writes, all is readable but the last second or so, and what began after a call that was
/// not done.
/// Throws std::runtime_error, "FILE: ...", where the file cannot be written.
template <class S> class FclRecorder final : public detail::RecordedManager<detail::FclLibrary<S>> {
    using Library = detail::FclLibrary<S>;
    using Base = detail::RecordedManager<Library>;
    using Base::calls_, Base::to;
    using typename Base::Calls;

  public:
    using Base::Base;
    using typename Base::Manager, typename Base::Object;

    void collide(Object* object, void* data, fcl::CollisionCallBack<S> callback) const override {
        Shown shown(*this, data, callback);
        calls_.record(recording::Call::collide_object, {object}, shown,
                      [&] { to().collide(object, &shown, Shown::show); });
    }
    void collide(void* data, fcl::CollisionCallBack<S> callback) const override {
        Shown shown(*this, data, callback);
        calls_.record(recording::Call::collide_self, {}, shown,
                      [&] { to().collide(&shown, Shown::show); });
    }
    /// The other one may be a recorder, too.
    void collide(Manager* other, void* data, fcl::CollisionCallBack<S> callback) const override {
        if (other == this)
            return collide(data, callback);
        Shown shown(*this, data, callback);
        Manager* const with = &Base::behind(other);
        calls_.record(recording::Call::collide_others, Library::objects_of(*with), shown,
                      [&] { to().collide(with, &shown, Shown::show); });
    }
    void distance(Object* object, void* data, fcl::DistanceCallBack<S> callback) const override {
        Measured measured(*this, data, callback);
        calls_.record(recording::Call::distance_object, {object}, measured,
                      [&] { to().distance(object, &measured, Measured::show); });
    }
    void distance(void* data, fcl::DistanceCallBack<S> callback) const override {
        Measured measured(*this, data, callback);
        calls_.record(recording::Call::distance_self, {}, measured,
                      [&] { to().distance(&measured, Measured::show); });
    }
    void distance(Manager* other, void* data, fcl::DistanceCallBack<S> callback) const override {
        if (other == this)
            return distance(data, callback);
        Measured measured(*this, data, callback);
        Manager* const with = &Base::behind(other);
        calls_.record(recording::Call::distance_others, Library::objects_of(*with), measured,
                      [&] { to().distance(with, &measured, Measured::show); });
    }

    /// In callbacks, in the place of fcl::collide and fcl::distance: the query is
    /// written down, too. Without a recorder, and outside of its calls, they do the same.
    static std::size_t collide(const Object* a, const Object* b,
                               const fcl::CollisionRequest<S>& request,
                               fcl::CollisionResult<S>& result) {
        return timed(request, [&] { return fcl::collide(a, b, request, result); });
    }
    static S distance(const Object* a, const Object* b, const fcl::DistanceRequest<S>& request,
                      fcl::DistanceResult<S>& result) {
        return timed(request, [&] { return fcl::distance(a, b, request, result); });
    }
    /// answer(), which is FCL's to this request.
    template <class Query>
    static auto timed(const fcl::CollisionRequest<S>& request, const Query& answer) {
        return Calls::timed({0, static_cast<double>(request.num_max_contacts),
                             request.enable_contact ? 1. : 0., 0, 0},
                            answer);
    }
    template <class Query>
    static auto timed(const fcl::DistanceRequest<S>& request, const Query& answer) {
        return Calls::timed({1, 0, 0, request.enable_nearest_points ? 1. : 0.,
                             request.enable_signed_distance ? 1. : 0.},
                            answer);
    }

  private:
    struct Shown : Calls::Answer {
        const FclRecorder& recorder;
        void* data;
        fcl::CollisionCallBack<S> callback;

        Shown(const FclRecorder& r, void* d, fcl::CollisionCallBack<S> c)
            : recorder(r), data(d), callback(c) {}
        static bool show(Object* a, Object* b, void* to) {
            Shown& self = *static_cast<Shown*>(to);
            self.add(self.recorder.calls_, a, b);
            return self.ended = self.callback(a, b, self.data);
        }
    };
    struct Measured : Calls::Answer {
        const FclRecorder& recorder;
        void* data;
        fcl::DistanceCallBack<S> callback;

        Measured(const FclRecorder& r, void* d, fcl::DistanceCallBack<S> c)
            : recorder(r), data(d), callback(c) {}
        static bool show(Object* a, Object* b, void* to, S& least) {
            Measured& self = *static_cast<Measured*>(to);
            self.add(self.recorder.calls_, a, b);
            self.ended = self.callback(a, b, self.data, least);
            self.min_distance = static_cast<double>(least);
            return self.ended;
        }
    };
};

} // namespace boxwood
