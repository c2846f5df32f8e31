#pragma once

#include "bench/replay/replay.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// Which objects a manager of an Api has, and the calls that are made to it. FCL's do not stand an
/// object that comes or goes twice: it is updated, or left alone.
template <class Api> class CallsOf {
    using Object = typename Api::Object;
    using Manager = typename Api::Manager;

  public:
    void begin() { is_there_.clear(); }

    /// The objects of the next call; `all` by their numbers.
    template <class Owned>
    void take(const RecordedProgram& program, const RecordedProgram::Call& call,
              const std::vector<std::unique_ptr<Owned>>& all) {
        objects_.clear();
        again_.clear();
        for (const std::uint32_t object : program.objects_of(call))
            (is_made_with(call.what, object) ? objects_ : again_).push_back(all[object].get());
        if (call.what == recording::Call::clear)
            is_there_.clear();
    }
    const std::vector<Object*>& objects() const { return objects_; }

    /// Makes it. `seen` takes what a query shows; of a call with another manager nothing without
    /// `other`.
    template <class Seen>
    void make(recording::Call what, Manager& manager, Seen& seen, Manager* other = nullptr) const {
        if (!is_query(what))
            return change(what, manager);
        const auto query = [&](auto... of) {
            is_distance(what) ? Api::distance(manager, seen, of...)
                              : Api::collide(manager, seen, of...);
        };
        if (!is_with_others(what))
            is_of_one(what) ? query(objects_[0]) : query();
        else if (other)
            query(other);
    }

  private:
    /// Of one that registers: else it is an update.
    bool is_made_with(recording::Call call, std::uint32_t object) {
        if (object >= is_there_.size())
            is_there_.resize(std::size_t{object} + 1);
        if (call == recording::Call::add)
            return !std::exchange(is_there_[object], true);
        if (call == recording::Call::remove)
            return std::exchange(is_there_[object], false);
        return true;
    }
    void change(recording::Call what, Manager& manager) const {
        using enum recording::Call;
        switch (what) {
        case add:
            if (objects_.size() == 1)
                manager.registerObject(objects_[0]);
            else if (!objects_.empty())
                manager.registerObjects(objects_);
            if (!again_.empty())
                manager.update(again_);
            break;
        case remove:
            if (!objects_.empty())
                manager.unregisterObject(objects_[0]);
            break;
        case clear:
            manager.clear();
            break;
        case setup:
            manager.setup();
            break;
        case update_all:
            manager.update();
            break;
        case update_some:
            if (objects_.size() == 1)
                manager.update(objects_[0]);
            else
                manager.update(objects_);
            break;
        default:
            break;
        }
    }

    std::vector<char> is_there_;
    std::vector<Object*> objects_, again_; ///< of a call; those that it does nothing but update
};

/// Whether call i is made: not a query that is left out, nor one of one object that names none.
inline bool is_replayed(const RecordedProgram::Call& call, std::size_t i,
                        const std::function<bool(std::size_t)>& includes) {
    return (!is_query(call.what) || includes(i)) && !(is_of_one(call.what) && call.n_objects == 0);
}

/// A Replay with a manager of an Api (trees/adapters/apis/fcl_api.h is one).
template <class Api> class Replayer final : public Replay {
    using Object = typename Api::Object;
    using Bounds = typename Api::Bounds;
    using Body = typename Api::Body;
    using Manager = typename Api::Manager;
    using Number = typename Api::Scalar;

  public:
    using Make = std::function<std::unique_ptr<Manager>()>;

    Replayer(const RecordedProgram& program, Make make)
        : program_(program), make_(std::move(make)) {
        for (std::size_t i = 0; i < program.n_objects(); ++i)
            bodies_.push_back(std::make_unique<Body>(Bounds(), static_cast<unsigned>(i)));
    }

    void run(const std::function<bool(std::size_t)>& includes,
             std::vector<ReplayedCall>& calls) override {
        calls.assign(program_.calls.size(), {});
        manager_ = make_();
        to_manager_.begin();
        for (std::size_t i = 0; i < calls.size(); ++i) {
            const RecordedProgram::Call& call = program_.calls[i];
            for (const RecordedProgram::State& state : program_.states_of(call))
                bodies_[state.object]->move(bounds_of(state));
            if (!is_replayed(call, i, includes))
                continue;
            to_manager_.take(program_, call, bodies_);
            make_other(call.what);
            Seen seen(noted_, call.ended ? std::max<std::uint64_t>(call.shown, 1) : 0);
            const auto begun = std::chrono::steady_clock::now();
            to_manager_.make(call.what, *manager_, seen, other_.get());
            const std::chrono::duration<double, std::nano> taken =
                std::chrono::steady_clock::now() - begun - seen.aside();
            seen.look();
            calls[i] = {taken.count(), seen.shown(), seen.keys(), seen.min_distance()};
        }
        other_.reset();
        manager_.reset();
    }

  private:
    using Noted = std::vector<std::pair<const Object*, const Object*>>;
    /// A callback that takes note of pairs. They are looked at outside the clock: else that would
    /// be most of what a query of 100,000 bodies takes. A query that the program ended ends at as
    /// many pairs that overlap, which are counted within the clock.
    class Seen {
      public:
        Seen(Noted& noted, std::uint64_t enough) : noted_(noted), enough_(enough) {
            noted_.clear();
        }

        bool add(Object* a, Object* b) {
            if (a == b)
                return false; // some managers show a registered object itself, some do not
            if (enough_ > 0) {
                count(a, b);
                return shown_ == enough_;
            }
            if (noted_.size() == max_noted)
                look();
            noted_.emplace_back(a, b);
            return false;
        }
        bool add(Object* a, Object* b, Number& of_manager) {
            if (a == b)
                return false;
            min_distance_ =
                std::min(min_distance_, static_cast<double>(a->getAABB().distance(b->getAABB())));
            of_manager = static_cast<Number>(
                std::min(min_distance_, static_cast<double>(std::numeric_limits<Number>::max())));
            return ++distances_ == enough_;
        }
        void look() {
            const auto begun = std::chrono::steady_clock::now();
            for (const auto& [a, b] : noted_)
                count(a, b);
            noted_.clear();
            aside_ += std::chrono::steady_clock::now() - begun;
        }
        /// What looking at pairs took.
        std::chrono::steady_clock::duration aside() const { return aside_; }
        std::uint64_t shown() const { return shown_; }
        std::uint64_t keys() const { return keys_; }
        double min_distance() const { return min_distance_; }

      private:
        static std::uint32_t number(const Object* object) {
            return static_cast<const Body*>(object)->number();
        }
        void count(const Object* a, const Object* b) {
            if (!a->getAABB().overlap(b->getAABB()))
                return; // some show what has shrunk since
            ++shown_;
            keys_ = recording::sum(keys_, recording::key(number(a), number(b)));
        }

        static constexpr std::size_t max_noted = 1 << 20;
        Noted& noted_;
        std::uint64_t enough_; ///< 0: there is never enough
        std::uint64_t distances_ = 0, shown_ = 0, keys_ = 0;
        double min_distance_ = std::numeric_limits<double>::infinity();
        std::chrono::steady_clock::duration aside_{};
    };

    static Bounds bounds_of(const RecordedProgram::State& state) {
        Bounds bounds;
        for (int axis = 0; axis < 3; ++axis) {
            bounds.min_[axis] = static_cast<Number>(state.bounds[static_cast<std::size_t>(axis)]);
            bounds.max_[axis] =
                static_cast<Number>(state.bounds[static_cast<std::size_t>(3 + axis)]);
        }
        return bounds;
    }
    /// Another manager of the same kind, where a query is with one.
    void make_other(recording::Call what) {
        if (!is_with_others(what))
            return;
        other_ = make_();
        other_->registerObjects(to_manager_.objects());
        other_->setup();
    }

    const RecordedProgram& program_;
    Make make_;
    std::vector<std::unique_ptr<Body>> bodies_;
    CallsOf<Api> to_manager_;
    std::unique_ptr<Manager> manager_, other_;
    Noted noted_; ///< kept, so that it grows in the first round alone
};

} // namespace boxwood::bench
