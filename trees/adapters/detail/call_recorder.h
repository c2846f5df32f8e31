#pragma once

#include "trees/adapters/detail/recorded_geometry.h"
#include "trees/adapters/recording.h"
#include "trees/adapters/recording_file.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <utility>
#include <vector>

namespace boxwood::detail {

/// Writes down the calls to a manager of FCL's kind, as they are handed on to it. Library names the
/// types Object, Manager and Geometry and the bits of numbers, and has recorded(geometry),
/// rotation(object) and translation(object), and objects_of(manager).
template <class Library> class CallRecorder {
    using Object = typename Library::Object;
    using Manager = typename Library::Manager;
    using Geometry = typename Library::Geometry;
    using Objects = std::vector<Object*>;

  public:
    CallRecorder(Manager& manager, const std::filesystem::path& file)
        : manager_(manager), tables_(std::make_unique<Tables>(file)) {
        tables_->format.add({recording::version, Library::bits});
        if (const Objects there = Library::objects_of(manager); !there.empty())
            record(recording::Call::add, there, [] {});
        write();
    }
    CallRecorder(const CallRecorder&) = delete;
    CallRecorder& operator=(const CallRecorder&) = delete;
    ~CallRecorder() {
        try {
            close();
        } catch (...) { // a destructor cannot report it
        }
    }
    void close() {
        const auto lock = locked();
        if (!tables_)
            return;
        const std::unique_ptr<Tables> last = std::move(tables_);
        last->write();
    }

    void on_failure(std::function<void(const std::exception&)> tell) {
        on_failure_ = std::move(tell);
    }

    Manager& manager() const { return manager_; }
    std::unique_lock<std::recursive_mutex> locked() { return std::unique_lock(calling_); }
    /// Locks this one, and the other one if there is one.
    class Both {
      public:
        Both(CallRecorder& one, CallRecorder* other)
            : one_(one.calling_, std::defer_lock), other_(one.calling_, std::defer_lock) {
            if (other) {
                other_ = std::unique_lock(other->calling_, std::defer_lock);
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

        void add(const CallRecorder& recorder, const Object* a, const Object* b) {
            if (a == b)
                return; // some managers show a registered object itself, some do not
            ++shown;
            keys =
                recording::sum(keys, recording::key(recorder.number_of(a), recorder.number_of(b)));
        }
    };
    /// done() hands the call on.
    template <class Do> void record(recording::Call call, const Objects& objects, const Do& done) {
        const Answer none;
        record(call, objects, none, done);
    }
    template <class Do>
    void record(recording::Call call, const Objects& objects, const Answer& answer,
                const Do& done) {
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
        if (++n_calls_ % 4096 == 0 || tables_->states.n_unwritten() > 1'000'000 ||
            begun - written_ > std::chrono::seconds(1))
            write();
    }

  private:
    void write() {
        try {
            tables_->write();
        } catch (const std::exception& error) {
            if (!on_failure_)
                throw;
            tables_.reset();
            on_failure_(error);
        }
        written_ = std::chrono::steady_clock::now();
    }

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
    std::uint32_t number_of(const Object* object) const {
        const auto found = known_.find(object);
        return found == known_.end() ? std::numeric_limits<std::uint32_t>::max()
                                     : found->second.number;
    }
    static std::array<double, 18> state_of(const Object& object) {
        std::array<double, 18> state;
        const auto& bounds = object.getAABB();
        const auto& rotation = Library::rotation(object);
        const auto& translation = Library::translation(object);
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis);
            state[at] = bounds.min_[axis];
            state[3 + at] = bounds.max_[axis];
            for (int column = 0; column < 3; ++column)
                state[6 + 3 * at + static_cast<std::size_t>(column)] = rotation(axis, column);
            state[15 + at] = translation[axis];
        }
        return state;
    }
    void forget(recording::Call call, const Objects& objects) {
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
    bool follow(const Object& object, recording::Call call) {
        const Geometry* const geometry = object.collisionGeometry().get();
        const std::array<double, 18> state = state_of(object);
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
    void add_call(recording::Call call, std::uint32_t object) {
        tables_->call_objects.add({static_cast<double>(object)});
        tables_->calls.add({static_cast<double>(call), 1., n_states_, 0., 0., 0.,
                            std::numeric_limits<double>::infinity(), 0.});
        n_states_ = 0;
    }
    std::uint32_t number_of_geometry(const Object& object) {
        const auto& geometry = object.collisionGeometry();
        const auto [found, is_new] = number_of_geometry_.try_emplace(geometry.get(), 0u);
        if (!is_new)
            return found->second;
        kept_.push_back(geometry);
        const RecordedGeometry of = geometry ? Library::recorded(*geometry) : RecordedGeometry();
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
    std::recursive_mutex calling_; ///< a callback may query again
    std::unique_ptr<Tables> tables_;
    std::function<void(const std::exception&)> on_failure_;
    std::chrono::steady_clock::time_point written_; ///< when it was last
    std::unordered_map<const Object*, Known> known_;
    std::unordered_map<const Geometry*, std::uint32_t> number_of_geometry_;
    std::unordered_map<std::uint64_t, std::uint32_t> number_of_content_; ///< by hash
    std::vector<std::shared_ptr<const Geometry>> kept_; ///< so that no other takes its place
    std::uint32_t n_objects_ = 0;
    double n_states_ = 0; ///< since the last call
    std::size_t n_calls_ = 0;
};

} // namespace boxwood::detail
