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
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
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
        tables_->write();
    }
    CallRecorder(const CallRecorder&) = delete;
    CallRecorder& operator=(const CallRecorder&) = delete;
    ~CallRecorder() {
        try {
            close();
        } catch (...) { // a destructor cannot report it
        }
    }
    /// Calls that are not done yet are written as queries that were ended.
    void close() {
        if (is_elsewhere()) {
            static_cast<void>(tables_.release());
            return;
        }
        const std::lock_guard lock(writing_);
        if (!tables_)
            return;
        for (const Pending& call : pending_)
            add(call);
        const std::unique_ptr<Tables> last = std::move(tables_);
        last->write();
    }

    void on_failure(std::function<void(const std::exception&)> tell) {
        on_failure_ = std::move(tell);
    }

    Manager& manager() const { return manager_; }

    /// What a query's callback was shown.
    struct Answer {
        double shown = 0, min_distance = std::numeric_limits<double>::infinity();
        std::uint64_t keys = 0;
        bool ended = false;

        void add(const CallRecorder& recorder, const Object* a, const Object* b) {
            if (a == b)
                return; // some managers show a registered object itself, some do not
            ++shown;
            if (recorder.is_elsewhere())
                return;
            const std::lock_guard lock(recorder.writing_);
            keys =
                recording::sum(keys, recording::key(recorder.number_of(a), recorder.number_of(b)));
        }
    };
    /// done() hands the call on. Nothing is locked meanwhile; threads wait for each other only
    /// while what they were shown is noted, or the file is written. Calls are written in the order
    /// in which they begin.
    template <class Do> void record(recording::Call call, const Objects& objects, const Do& done) {
        const Answer none;
        record(call, objects, none, done);
    }
    template <class Do>
    void record(recording::Call call, const Objects& objects, const Answer& answer,
                const Do& done) {
        const std::optional<Open> open = begin(call, objects);
        const Inside inside(*this, open ? &**open : nullptr);
        const auto begun = std::chrono::steady_clock::now();
        const auto taken = [&] {
            return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() -
                                                            begun)
                .count();
        };
        try {
            done();
        } catch (...) {
            if (open && !is_elsewhere()) {
                Answer so_far = answer;
                so_far.ended = true;
                const std::lock_guard lock(writing_);
                finish(*open, so_far, taken());
            }
            throw;
        }
        if (open && !is_elsewhere())
            end(*open, answer, taken());
    }

    /// answer() about two shapes, timed, and written down where a callback of a recorded call of
    /// this thread makes the query.
    template <class Query>
    static auto timed(const recording::Request& request, const Query& answer) {
        const auto begun = std::chrono::steady_clock::now();
        const auto found = answer();
        const std::chrono::duration<double, std::nano> taken =
            std::chrono::steady_clock::now() - begun;
        if (inside_.call && !inside_.recorder->is_elsewhere())
            inside_.recorder->note(*inside_.call, request, taken.count());
        return found;
    }

  private:
    using State = std::array<double, 19>; ///< a row of states

    /// A call that has begun: a row of calls, and the rows that belong to it.
    struct Pending {
        explicit Pending(recording::Call made) : call(made) { answer.ended = true; }

        recording::Call call;
        std::vector<std::uint32_t> objects;
        std::vector<State> states;
        bool is_certain = true, is_done = false, is_written = false;
        Answer answer; ///< while it is not done, of a query that was ended
        double ns = 0;
        struct RequestCount {
            double n = 0, ns = 0;
        };
        std::map<std::size_t, RequestCount> request_counts; ///< by request
    };
    using Open = typename std::list<Pending>::iterator;
    /// The innermost recorded call that this thread is in.
    class Inside {
      public:
        Inside(CallRecorder& recorder, Pending* call)
            : before_(std::exchange(inside_, {&recorder, call})) {}
        ~Inside() { inside_ = before_; }
        Inside(const Inside&) = delete;
        Inside& operator=(const Inside&) = delete;

        struct Call {
            CallRecorder* recorder = nullptr;
            Pending* call = nullptr;
        };

      private:
        Call before_;
    };
    static inline thread_local typename Inside::Call inside_;

    void note(Pending& call, const recording::Request& request, double ns) {
        const std::lock_guard lock(writing_);
        if (!tables_)
            return;
        const auto [found, is_new] = requests_.try_emplace(request, requests_.size());
        if (is_new)
            tables_->requests.add(request);
        auto& [n, all_ns] = call.request_counts[found->second];
        ++n;
        all_ns += ns;
    }
    /// Nothing after the end.
    std::optional<Open> begin(recording::Call call, const Objects& objects) {
        if (is_elsewhere())
            return std::nullopt;
        const std::lock_guard lock(writing_);
        if (!tables_)
            return std::nullopt;
        Pending row(call);
        // A manager takes the address alone of what is removed, which may be gone by then.
        if (call != recording::Call::remove)
            for (const Object* object : objects)
                if (object)
                    row.is_certain &= follow(*object, row);
        if (call != recording::Call::update_all)
            for (const Object* object : objects)
                if (const auto known = known_.find(object); known != known_.end())
                    row.objects.push_back(known->second.number);
        if (call == recording::Call::remove || call == recording::Call::clear)
            forget(call, objects);
        return pending_.insert(pending_.end(), std::move(row));
    }
    void finish(Open call, const Answer& answer, double ns) {
        call->answer = answer;
        call->ns = ns;
        call->is_done = true;
        if (call->is_written)
            written_early_.erase(call);
    }
    void end(Open call, const Answer& answer, double ns) {
        std::exception_ptr failure;
        {
            const std::lock_guard lock(writing_);
            finish(call, answer, ns);
            if (!tables_)
                return;
            settle();
            if (n_calls_ >= 4096 || tables_->states.n_unwritten() > 1'000'000 ||
                std::chrono::steady_clock::now() - written_ > std::chrono::seconds(1))
                failure = write();
        }
        if (failure)
            report(failure);
    }
    /// Adds the rows of all that is done, up to the first that is not; of too many that wait for
    /// one, that one's, too.
    void settle() {
        constexpr std::size_t max_pending = 65536;
        while (!pending_.empty()) {
            Pending& first = pending_.front();
            if (!first.is_done && pending_.size() <= max_pending)
                return;
            add(first);
            if (first.is_done) {
                pending_.pop_front();
            } else {
                first.is_written = true;
                written_early_.splice(written_early_.end(), pending_, pending_.begin());
            }
        }
    }
    void add(const Pending& row) {
        for (const std::uint32_t object : row.objects)
            tables_->call_objects.add({static_cast<double>(object)});
        for (const State& state : row.states)
            tables_->states.add(state);
        tables_->calls.add({static_cast<double>(row.call), static_cast<double>(row.objects.size()),
                            static_cast<double>(row.states.size()), row.answer.shown,
                            static_cast<double>(row.answer.keys),
                            row.answer.ended || !row.is_certain ? 1. : 0., row.answer.min_distance,
                            row.ns});
        for (const auto& [request, of] : row.request_counts)
            tables_->request_counts.add({n_rows_, static_cast<double>(request), of.n, of.ns});
        ++n_rows_;
        ++n_calls_;
    }
    /// Whether this is a forked child: the file is its parent's, and so may the lock be.
    bool is_elsewhere() const { return Forks::count() != forks_; }

    /// Why it could not be written; with an `on_failure` the recording has ended then.
    std::exception_ptr write() {
        n_calls_ = 0;
        written_ = std::chrono::steady_clock::now();
        try {
            tables_->write();
            return nullptr;
        } catch (const std::exception&) {
            if (on_failure_)
                tables_.reset();
            return std::current_exception();
        }
    }
    void report(const std::exception_ptr& failure) const {
        try {
            std::rethrow_exception(failure);
        } catch (const std::exception& error) {
            if (!on_failure_)
                throw;
            on_failure_(error);
        }
    }

    struct Tables {
        explicit Tables(const std::filesystem::path& path) : file(path) {}
        void write() {
            const QuietHdf5 quiet;
            for (RecordingFile::Table* table :
                 {&format, &geometries, &vertices, &triangles, &objects, &states, &call_objects,
                  &calls, &requests, &request_counts})
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
            requests{file, "requests", recording::requests},
            request_counts{file, "request_counts", recording::request_counts},
            calls{file, "calls", recording::calls};
    };
    struct Known {
        std::uint32_t number = 0, geometry = 0;
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
    /// Adds the object's state to a call if it is new or changed; one of another geometry at an
    /// address is another object, which takes the place of a registered one. False of a query of a
    /// registered one that has changed: the manager may look at what it was.
    bool follow(const Object& object, Pending& call) {
        const std::uint32_t geometry = number_of_geometry(object);
        const std::array<double, 18> state = state_of(object);
        const bool is_reported = call.call == recording::Call::add ||
                                 call.call == recording::Call::update_all ||
                                 call.call == recording::Call::update_some;
        const auto [found, is_new] = known_.try_emplace(&object);
        Known& known = found->second;
        const bool is_other = is_new || known.geometry != geometry;
        const bool takes_place = is_other && known.is_registered;
        if (takes_place && !is_reported)
            return false;
        if (takes_place)
            add_call(recording::Call::remove, known.number, call);
        if (is_other) {
            known = {};
            known.number = n_objects_++;
            known.geometry = geometry;
            tables_->objects.add({static_cast<double>(geometry)});
        }
        known.is_registered |= call.call == recording::Call::add;
        if (!is_other && known.state == state)
            return true;
        if (known.is_registered && !is_reported)
            return false;
        known.state = state;
        State& row = call.states.emplace_back();
        row[0] = known.number;
        std::ranges::copy(state, row.begin() + 1);
        if (takes_place) {
            known.is_registered = true;
            add_call(recording::Call::add, known.number, call);
        }
        return true;
    }
    /// One that the program did not make by itself: of one object, with the states so far.
    void add_call(recording::Call what, std::uint32_t object, Pending& before) {
        Pending made(what);
        made.objects = {object};
        made.is_done = true;
        made.answer.ended = false;
        std::swap(made.states, before.states);
        pending_.push_back(std::move(made));
    }
    std::uint32_t number_of_geometry(const Object& object) {
        const std::shared_ptr<const Geometry> geometry = object.collisionGeometry();
        if (number_of_geometry_.size() > 2 * n_kept_ + 1024) {
            std::erase_if(number_of_geometry_,
                          [](const auto& entry) { return entry.second.geometry.expired(); });
            n_kept_ = number_of_geometry_.size();
        }
        Numbered& known = number_of_geometry_[geometry.get()];
        if (known.is_numbered && (geometry.use_count() == 0 || known.geometry.lock() == geometry))
            return known.number; // else another one has taken its place
        const RecordedGeometry of = geometry ? Library::recorded(*geometry) : RecordedGeometry();
        const std::uint64_t hash = of.hash();
        const auto [same, is_first] = number_of_content_.try_emplace(
            hash, static_cast<std::uint32_t>(number_of_content_.size()));
        known = {geometry, same->second, true};
        if (!is_first)
            return known.number;
        for (const auto& vertex : of.vertices)
            tables_->vertices.add(vertex);
        for (const auto& triangle : of.triangles)
            tables_->triangles.add(triangle);
        tables_->geometries.add(
            {static_cast<double>(of.shape), of.numbers[0], of.numbers[1], of.numbers[2],
             of.numbers[3], static_cast<double>(of.vertices.size()),
             static_cast<double>(of.triangles.size()), static_cast<double>(hash >> 32),
             static_cast<double>(hash & 0xffffffff)});
        return known.number;
    }

    struct Numbered {
        std::weak_ptr<const Geometry> geometry;
        std::uint32_t number = 0;
        bool is_numbered = false;
    };

    Manager& manager_;
    const unsigned forks_ = Forks::count();
    mutable std::mutex writing_; ///< of all below
    std::unique_ptr<Tables> tables_;
    std::list<Pending> pending_;       ///< the first of them is not done
    std::list<Pending> written_early_; ///< not done, and written
    std::function<void(const std::exception&)> on_failure_;
    std::chrono::steady_clock::time_point written_; ///< when it was last
    std::unordered_map<const Object*, Known> known_;
    std::unordered_map<const Geometry*, Numbered> number_of_geometry_;
    std::unordered_map<std::uint64_t, std::uint32_t> number_of_content_; ///< by hash
    std::size_t n_kept_ = 0; ///< geometries that were there when expired ones were taken out
    std::uint32_t n_objects_ = 0;
    std::map<recording::Request, std::size_t> requests_;
    double n_rows_ = 0;       ///< of calls
    std::size_t n_calls_ = 0; ///< that are not written
};

} // namespace boxwood::detail
