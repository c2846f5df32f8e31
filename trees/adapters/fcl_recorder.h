#pragma once

/// For programs that use FCL: their calls to a manager, in a file that `boxwood
/// replay` runs again. Compiled by whoever includes it and has FCL 0.7 and HDF5; not part of
/// trees.h.

#include "trees/adapters/detail/call_recorder.h"
#include "trees/adapters/detail/fcl_geometry.h"

#include <fcl/broadphase/broadphase_collision_manager.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace boxwood {

/// Hands every call to a manager of FCL's interface, which outlives it, and writes it down: objects
/// with their bounds and poses, geometries once, what callbacks were shown, how long it took.
/// Objects that the manager has already are registered in the recording, too. Any number of threads
/// may call; one waits for another. `close`, or the destructor, ends the file; all but the last
/// 4096 calls are readable if the program ends badly, but while it writes.
/// Throws std::runtime_error, "FILE: ...", where the file cannot be written.
template <class S> class FclRecorder final : public fcl::BroadPhaseCollisionManager<S> {
  public:
    using Object = fcl::CollisionObject<S>;
    using Objects = std::vector<Object*>;
    using Manager = fcl::BroadPhaseCollisionManager<S>;

    FclRecorder(Manager& manager, const std::filesystem::path& file) : calls_(manager, file) {}

    /// The end of the recording; calls are handed on, and not written down any more.
    void close() { calls_.close(); }

    void registerObject(Object* object) override {
        calls_.record(recording::Call::add, {object}, [&] { to().registerObject(object); });
    }
    void registerObjects(const Objects& objects) override {
        calls_.record(recording::Call::add, objects, [&] { to().registerObjects(objects); });
    }
    void unregisterObject(Object* object) override {
        calls_.record(recording::Call::remove, {object}, [&] { to().unregisterObject(object); });
    }
    void clear() override {
        calls_.record(recording::Call::clear, {}, [&] { to().clear(); });
    }
    void setup() override {
        calls_.record(recording::Call::setup, {}, [&] { to().setup(); });
    }
    void update() override {
        const auto lock = calls_.locked();
        calls_.record(recording::Call::update_all, Library::objects_of(to()),
                      [&] { to().update(); });
    }
    void update(Object* object) override {
        calls_.record(recording::Call::update_some, {object}, [&] { to().update(object); });
    }
    void update(const Objects& objects) override {
        calls_.record(recording::Call::update_some, objects, [&] { to().update(objects); });
    }
    void getObjects(Objects& objects) const override {
        const auto lock = calls_.locked();
        to().getObjects(objects);
    }
    bool empty() const override { return size() == 0; }
    std::size_t size() const override {
        const auto lock = calls_.locked();
        return to().size();
    }

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
        const Within within(*this, other);
        Manager* const with = within.manager;
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
        const Within within(*this, other);
        Manager* const with = within.manager;
        calls_.record(recording::Call::distance_others, Library::objects_of(*with), measured,
                      [&] { to().distance(with, &measured, Measured::show); });
    }

  private:
    struct Library {
        using Object = fcl::CollisionObject<S>;
        using Manager = fcl::BroadPhaseCollisionManager<S>;
        using Geometry = fcl::CollisionGeometry<S>;
        static constexpr double bits = 8 * sizeof(S);

        static detail::RecordedGeometry recorded(const Geometry& geometry) {
            return detail::recorded(geometry);
        }
        static auto rotation(const Object& object) { return object.getTransform().linear(); }
        static auto translation(const Object& object) {
            return object.getTransform().translation();
        }
        static Objects objects_of(const Manager& manager) {
            Objects objects;
            manager.getObjects(objects);
            return objects;
        }
    };
    using Calls = detail::CallRecorder<Library>;

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
    /// Another manager, or the one that another recorder is before; both are locked meanwhile.
    struct Within {
        Within(const FclRecorder& one, Manager* other)
            : recorder(dynamic_cast<const FclRecorder*>(other)),
              both(one.calls_, recorder ? &recorder->calls_ : nullptr),
              manager(recorder ? &recorder->to() : other) {}
        const FclRecorder* recorder;
        typename Calls::Both both;
        Manager* manager;
    };
    Manager& to() const { return calls_.manager(); }

    mutable Calls calls_;
};

} // namespace boxwood
