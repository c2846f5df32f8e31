#pragma once

/// For programs that use FCL: their calls to a manager, in a file that `boxwood
/// replay` runs again. Compiled by whoever includes it and has FCL 0.7 and HDF5; not part of
/// trees.h.

#include "trees/adapters/detail/fcl_geometry.h"
#include "trees/adapters/recording.h"
#include "trees/adapters/recording_file.h"

#include <fcl/broadphase/broadphase_collision_manager.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>
#include <unordered_map>
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

    FclRecorder(Manager& manager, const std::filesystem::path& file)
        : manager_(manager), tables_(std::make_unique<Tables>(file)) {
        tables_->format.add({recording::version, 8 * sizeof(S)});
        if (const Objects there = objects_of(manager); !there.empty())
            record(recording::Call::add, there, [] {});
    }
    ~FclRecorder() override {
        try {
            close();
        } catch (...) { // a destructor cannot report it
        }
    }

    /// The end of the recording; calls are handed on, and not written down any more.
    void close() {
        const std::lock_guard lock(calling_);
        if (!tables_)
            return;
        const std::unique_ptr<Tables> last = std::move(tables_);
        last->write();
    }

    void registerObject(Object* object) override {
        record(recording::Call::add, {object}, [&] { manager_.registerObject(object); });
    }
    void registerObjects(const Objects& objects) override {
        record(recording::Call::add, objects, [&] { manager_.registerObjects(objects); });
    }
    void unregisterObject(Object* object) override {
        record(recording::Call::remove, {object}, [&] { manager_.unregisterObject(object); });
    }
    void clear() override {
        record(recording::Call::clear, {}, [&] { manager_.clear(); });
    }
    void setup() override {
        record(recording::Call::setup, {}, [&] { manager_.setup(); });
    }
    void update() override {
        const std::lock_guard lock(calling_);
        record(recording::Call::update_all, objects_of(manager_), [&] { manager_.update(); });
    }
    void update(Object* object) override {
        record(recording::Call::update_some, {object}, [&] { manager_.update(object); });
    }
    void update(const Objects& objects) override {
        record(recording::Call::update_some, objects, [&] { manager_.update(objects); });
    }
    void getObjects(Objects& objects) const override {
        const std::lock_guard lock(calling_);
        manager_.getObjects(objects);
    }
    bool empty() const override { return size() == 0; }
    std::size_t size() const override {
        const std::lock_guard lock(calling_);
        return manager_.size();
    }

    void collide(Object* object, void* data, fcl::CollisionCallBack<S> callback) const override {
        Shown shown{this, data, callback};
        record(recording::Call::collide_object, {object}, shown,
               [&] { manager_.collide(object, &shown, Shown::show); });
    }
    void collide(void* data, fcl::CollisionCallBack<S> callback) const override {
        Shown shown{this, data, callback};
        record(recording::Call::collide_self, {}, shown,
               [&] { manager_.collide(&shown, Shown::show); });
    }
    /// The other one may be a recorder, too.
    void collide(Manager* other, void* data, fcl::CollisionCallBack<S> callback) const override {
        if (other == this)
            return collide(data, callback);
        Shown shown{this, data, callback};
        const Both both(*this, other);
        Manager* const with = within(other);
        record(recording::Call::collide_others, objects_of(*with), shown,
               [&] { manager_.collide(with, &shown, Shown::show); });
    }
    void distance(Object* object, void* data, fcl::DistanceCallBack<S> callback) const override {
        Measured measured{this, data, callback};
        record(recording::Call::distance_object, {object}, measured,
               [&] { manager_.distance(object, &measured, Measured::show); });
    }
    void distance(void* data, fcl::DistanceCallBack<S> callback) const override {
        Measured measured{this, data, callback};
        record(recording::Call::distance_self, {}, measured,
               [&] { manager_.distance(&measured, Measured::show); });
    }
    void distance(Manager* other, void* data, fcl::DistanceCallBack<S> callback) const override {
        if (other == this)
            return distance(data, callback);
        Measured measured{this, data, callback};
        const Both both(*this, other);
        Manager* const with = within(other);
        record(recording::Call::distance_others, objects_of(*with), measured,
               [&] { manager_.distance(with, &measured, Measured::show); });
    }

  private:
    using Geometry = fcl::CollisionGeometry<S>;

    struct Tables {
        explicit Tables(const std::filesystem::path& path) : file(path) {}
        void write() {
            for (RecordingFile::Table* table : {&format, &geometries, &vertices, &triangles,
                                                &objects, &states, &call_objects, &calls})
                table->write();
            file.flush();
        }

        RecordingFile file;
        RecordingFile::Table format{file, "format", recording::format},
            geometries{file, "geometries", recording::geometries},
            vertices{file, "vertices", recording::vertices},
            triangles{file, "triangles", recording::triangles},
            objects{file, "objects", recording::objects}, states{file, "states", recording::states},
            call_objects{file, "call_objects", recording::call_objects},
            calls{file, "calls", recording::calls};
    };
    struct Known {
        std::uint32_t number = 0;
        const Geometry* geometry = nullptr;
        bool is_registered = false;
        std::array<double, 18> state{}; ///< as written last
    };
    /// Locks this one, and the other one if it is a recorder.
    class Both {
      public:
        Both(const FclRecorder& one, const Manager* other)
            : one_(one.calling_, std::defer_lock), other_(one.calling_, std::defer_lock) {
            if (const auto* recorder = dynamic_cast<const FclRecorder*>(other)) {
                other_ = std::unique_lock(recorder->calling_, std::defer_lock);
                std::lock(one_, other_);
            } else {
                one_.lock();
            }
        }

      private:
        std::unique_lock<std::recursive_mutex> one_, other_;
    };

    /// What a query's callback was shown.
    struct Answer {
        double shown = 0, min_distance = std::numeric_limits<double>::infinity();
        std::uint64_t keys = 0;
        bool ended = false;

        void add(const FclRecorder& recorder, const Object* a, const Object* b) {
            if (a == b)
                return; // some managers show a registered object itself, some do not
            ++shown;
            keys =
                recording::sum(keys, recording::key(recorder.number_of(a), recorder.number_of(b)));
        }
    };
    struct Shown : Answer {
        const FclRecorder* recorder;
        void* data;
        fcl::CollisionCallBack<S> callback;

        Shown(const FclRecorder* r, void* d, fcl::CollisionCallBack<S> c)
            : recorder(r), data(d), callback(c) {}
        static bool show(Object* a, Object* b, void* to) {
            Shown& self = *static_cast<Shown*>(to);
            self.add(*self.recorder, a, b);
            return self.ended = self.callback(a, b, self.data);
        }
    };
    struct Measured : Answer {
        const FclRecorder* recorder;
        void* data;
        fcl::DistanceCallBack<S> callback;

        Measured(const FclRecorder* r, void* d, fcl::DistanceCallBack<S> c)
            : recorder(r), data(d), callback(c) {}
        static bool show(Object* a, Object* b, void* to, S& least) {
            Measured& self = *static_cast<Measured*>(to);
            self.add(*self.recorder, a, b);
            self.ended = self.callback(a, b, self.data, least);
            self.min_distance = static_cast<double>(least);
            return self.ended;
        }
    };

    static Manager* within(Manager* other) {
        const auto* recorder = dynamic_cast<const FclRecorder*>(other);
        return recorder ? &recorder->manager_ : other;
    }
    static Objects objects_of(const Manager& manager) {
        Objects objects;
        manager.getObjects(objects);
        return objects;
    }

    template <class Do>
    void record(recording::Call call, const Objects& objects, const Do& done) const {
        const Answer none;
        record(call, objects, none, done);
    }
    template <class Do>
    void record(recording::Call call, const Objects& objects, const Answer& answer,
                const Do& done) const {
        const std::lock_guard lock(calling_);
        bool is_certain = true;
        if (tables_)
            for (const Object* object : objects)
                if (object)
                    is_certain &= follow(*object, call);
        const auto begun = std::chrono::steady_clock::now();
        done();
        const std::chrono::duration<double, std::nano> taken =
            std::chrono::steady_clock::now() - begun;
        if (!tables_)
            return;
        double n_objects = 0;
        if (call != recording::Call::update_all)
            for (const Object* object : objects)
                if (object) {
                    tables_->call_objects.add({static_cast<double>(number_of(object))});
                    ++n_objects;
                }
        tables_->calls.add({static_cast<double>(call), n_objects, n_states_, answer.shown,
                            static_cast<double>(answer.keys), answer.ended || !is_certain ? 1. : 0.,
                            answer.min_distance, taken.count()});
        n_states_ = 0;
        if (call == recording::Call::remove || call == recording::Call::clear)
            forget(call, objects);
        if (++n_calls_ % 4096 == 0 || tables_->states.n_unwritten() > 1'000'000)
            tables_->write();
    }

    std::uint32_t number_of(const Object* object) const {
        const auto found = known_.find(object);
        return found == known_.end() ? std::numeric_limits<std::uint32_t>::max()
                                     : found->second.number;
    }
    void forget(recording::Call call, const Objects& objects) const {
        if (call == recording::Call::clear)
            for (auto& [object, known] : known_)
                known.is_registered = false;
        for (const Object* object : objects)
            if (const auto found = known_.find(object); found != known_.end())
                found->second.is_registered = false;
    }
    /// Writes the object down if it is new or changed; one of another geometry at an address is
    /// another object, which takes the place of a registered one. False of a query of a registered
    /// one that has changed: the manager may look at what it was.
    bool follow(const Object& object, recording::Call call) const {
        const Geometry* const geometry = object.collisionGeometry().get();
        std::array<double, 18> state;
        const auto& bounds = object.getAABB();
        const auto& pose = object.getTransform();
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis);
            state[at] = bounds.min_[axis];
            state[3 + at] = bounds.max_[axis];
            for (int column = 0; column < 3; ++column)
                state[6 + 3 * at + static_cast<std::size_t>(column)] = pose.linear()(axis, column);
            state[15 + at] = pose.translation()[axis];
        }
        const bool is_reported = call == recording::Call::add ||
                                 call == recording::Call::update_all ||
                                 call == recording::Call::update_some;
        const auto [found, is_new] = known_.try_emplace(&object);
        Known& known = found->second;
        const bool is_other = is_new || known.geometry != geometry;
        const bool takes_place = is_other && known.is_registered;
        if (takes_place && !is_reported)
            return false;
        if (takes_place)
            add_call(recording::Call::remove, known.number);
        if (is_other) {
            known = {};
            known.number = n_objects_++;
            known.geometry = geometry;
            tables_->objects.add({static_cast<double>(number_of_geometry(object))});
        }
        known.is_registered |= call == recording::Call::add;
        if (!is_other && known.state == state)
            return true;
        if (known.is_registered && !is_reported)
            return false;
        known.state = state;
        std::array<double, 19> row;
        row[0] = known.number;
        std::ranges::copy(state, row.begin() + 1);
        tables_->states.add(row);
        ++n_states_;
        if (takes_place) {
            known.is_registered = true;
            add_call(recording::Call::add, known.number);
        }
        return true;
    }
    /// One that the program did not make by itself: of one object, with the states so far.
    void add_call(recording::Call call, std::uint32_t object) const {
        tables_->call_objects.add({static_cast<double>(object)});
        tables_->calls.add({static_cast<double>(call), 1., n_states_, 0., 0., 0.,
                            std::numeric_limits<double>::infinity(), 0.});
        n_states_ = 0;
    }
    std::uint32_t number_of_geometry(const Object& object) const {
        const auto& geometry = object.collisionGeometry();
        const auto [found, is_new] = number_of_geometry_.try_emplace(geometry.get(), 0u);
        if (!is_new)
            return found->second;
        kept_.push_back(geometry);
        const detail::RecordedGeometry of =
            geometry ? detail::recorded(*geometry) : detail::RecordedGeometry();
        const std::uint64_t hash = of.hash();
        const auto [same, is_first] = number_of_content_.try_emplace(
            hash, static_cast<std::uint32_t>(number_of_content_.size()));
        found->second = same->second;
        if (!is_first)
            return found->second;
        for (const auto& vertex : of.vertices)
            tables_->vertices.add(vertex);
        for (const auto& triangle : of.triangles)
            tables_->triangles.add(triangle);
        tables_->geometries.add(
            {static_cast<double>(of.shape), of.numbers[0], of.numbers[1], of.numbers[2],
             of.numbers[3], static_cast<double>(of.vertices.size()),
             static_cast<double>(of.triangles.size()), static_cast<double>(hash >> 32),
             static_cast<double>(hash & 0xffffffff)});
        return found->second;
    }

    Manager& manager_;
    mutable std::recursive_mutex calling_; ///< a callback may query again
    mutable std::unique_ptr<Tables> tables_;
    mutable std::unordered_map<const Object*, Known> known_;
    mutable std::unordered_map<const Geometry*, std::uint32_t> number_of_geometry_;
    mutable std::unordered_map<std::uint64_t, std::uint32_t> number_of_content_; ///< by hash
    mutable std::vector<std::shared_ptr<const Geometry>>
        kept_; ///< so that no other takes its place
    mutable std::uint32_t n_objects_ = 0;
    mutable double n_states_ = 0; ///< since the last call
    mutable std::size_t n_calls_ = 0;
};

} // namespace boxwood
