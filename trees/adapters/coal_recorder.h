#pragma once

/// For programs that use Coal: their calls to a manager, in a file that `boxwood
/// replay` runs again. Compiled by whoever includes it and has Coal 3 and HDF5; not part of
/// trees.h.

#include "trees/adapters/detail/call_recorder.h"
#include "trees/adapters/detail/coal_geometry.h"

#include <coal/broadphase/broadphase_callbacks.h>
#include <coal/broadphase/broadphase_collision_manager.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace boxwood {

/// Hands every call to a manager of Coal's interface, and writes it down: as FclRecorder does.
/// Bounds of objects are those that they have (computeAABB).
class CoalRecorder final : public coal::BroadPhaseCollisionManager {
  public:
    using Object = coal::CollisionObject;
    using Objects = std::vector<Object*>;
    using Manager = coal::BroadPhaseCollisionManager;

    CoalRecorder(Manager& manager, const std::filesystem::path& file) : calls_(manager, file) {}

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
    Objects getObjects() const override {
        const auto lock = calls_.locked();
        return Library::objects_of(to());
    }
    bool empty() const override { return size() == 0; }
    std::size_t size() const override {
        const auto lock = calls_.locked();
        return to().size();
    }

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
        const Within within(*this, other);
        Manager* const with = within.manager;
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
        const Within within(*this, other);
        Manager* const with = within.manager;
        calls_.record(recording::Call::distance_others, Library::objects_of(*with), measured,
                      [&] { to().distance(with, &measured); });
    }

  private:
    struct Library {
        using Object = coal::CollisionObject;
        using Manager = coal::BroadPhaseCollisionManager;
        using Geometry = coal::CollisionGeometry;
        static constexpr double bits = 8 * sizeof(coal::CoalScalar);

        static detail::RecordedGeometry recorded(const Geometry& geometry) {
            return detail::recorded(geometry);
        }
        static auto rotation(const Object& object) { return object.getTransform().getRotation(); }
        static auto translation(const Object& object) {
            return object.getTransform().getTranslation();
        }
        static Objects objects_of(const Manager& manager) {
            Objects objects;
            manager.getObjects(objects);
            return objects;
        }
    };
    using Calls = detail::CallRecorder<Library>;

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
    /// Another manager, or the one that another recorder is before; both are locked meanwhile.
    struct Within {
        Within(const CoalRecorder& one, Manager* other)
            : recorder(dynamic_cast<const CoalRecorder*>(other)),
              both(one.calls_, recorder ? &recorder->calls_ : nullptr),
              manager(recorder ? &recorder->to() : other) {}
        const CoalRecorder* recorder;
        Calls::Both both;
        Manager* manager;
    };
    Manager& to() const { return calls_.manager(); }

    mutable Calls calls_;
};

} // namespace boxwood
