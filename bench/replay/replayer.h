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

/// Which objects a manager has. FCL's do not stand one that comes or goes twice: it is updated, or
/// left alone.
class Registrations {
  public:
    /// Whether a call is to be made with an object. Of one that registers: else it is an update.
    bool take(recording::Call call, std::uint32_t object) {
        if (object >= is_there_.size())
            is_there_.resize(std::size_t{object} + 1);
        if (call == recording::Call::add)
            return !std::exchange(is_there_[object], true);
        if (call == recording::Call::remove)
            return std::exchange(is_there_[object], false);
        return true;
    }
    void clear() { is_there_.clear(); }

  private:
    std::vector<char> is_there_;
};

/// A call that is no query, of objects that it is made with and of those that are but updated.
template <class Manager, class Object>
void change(Manager& manager, recording::Call what, const std::vector<Object*>& objects,
            const std::vector<Object*>& again) {
    using enum recording::Call;
    switch (what) {
    case add:
        if (objects.size() == 1)
            manager.registerObject(objects[0]);
        else if (!objects.empty())
            manager.registerObjects(objects);
        if (!again.empty())
            manager.update(again);
        break;
    case remove:
        if (!objects.empty())
            manager.unregisterObject(objects[0]);
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
        if (objects.size() == 1)
            manager.update(objects[0]);
        else
            manager.update(objects);
        break;
    default:
        break;
    }
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
        registered_.clear();
        for (std::size_t i = 0; i < calls.size(); ++i) {
            const RecordedProgram::Call& call = program_.calls[i];
            for (const RecordedProgram::State& state : program_.states_of(call))
                bodies_[state.object]->move(bounds_of(state));
            if ((is_query(call.what) && !includes(i)) ||
                (is_of_one(call.what) && call.n_objects == 0))
                continue;
            objects_.clear();
            again_.clear();
            for (const std::uint32_t object : program_.objects_of(call))
                (registered_.take(call.what, object) ? objects_ : again_)
                    .push_back(bodies_[object].get());
            if (call.what == recording::Call::clear)
                registered_.clear();
            make_other(call.what);
            Seen seen{call.ended ? std::max<std::uint64_t>(call.shown, 1) : 0};
            const auto begun = std::chrono::steady_clock::now();
            query(call.what, seen);
            const std::chrono::duration<double, std::nano> taken =
                std::chrono::steady_clock::now() - begun;
            calls[i] = {taken.count(), seen.shown, seen.keys, seen.min_distance};
        }
        other_.reset();
        manager_.reset();
    }

  private:
    struct Seen {
        std::uint64_t enough; ///< 0: there is never enough
        std::uint64_t calls = 0, shown = 0, keys = 0;
        double min_distance = std::numeric_limits<double>::infinity();

        bool add(Object* a, Object* b) {
            if (a == b)
                return false; // some managers show a registered object itself, some do not
            ++calls;
            if (a->getAABB().overlap(b->getAABB())) { // some managers show what has shrunk since
                ++shown;
                keys = recording::sum(keys, recording::key(number(a), number(b)));
            }
            return calls == enough;
        }
        bool add(Object* a, Object* b, Number& of_manager) {
            if (a == b)
                return false;
            ++calls;
            min_distance =
                std::min(min_distance, static_cast<double>(a->getAABB().distance(b->getAABB())));
            of_manager = static_cast<Number>(
                std::min(min_distance, static_cast<double>(std::numeric_limits<Number>::max())));
            return calls == enough;
        }
        static std::uint32_t number(const Object* object) {
            return static_cast<const Body*>(object)->number();
        }
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
        if (what != recording::Call::collide_others && what != recording::Call::distance_others)
            return;
        other_ = make_();
        other_->registerObjects(objects_);
        other_->setup();
    }
    void query(recording::Call what, Seen& seen) {
        using enum recording::Call;
        switch (what) {
        case collide_self:
            return Api::collide(*manager_, seen);
        case collide_object:
            return Api::collide(*manager_, seen, objects_[0]);
        case collide_others:
            return Api::collide(*manager_, seen, other_.get());
        case distance_self:
            return Api::distance(*manager_, seen);
        case distance_object:
            return Api::distance(*manager_, seen, objects_[0]);
        case distance_others:
            return Api::distance(*manager_, seen, other_.get());
        default:
            change(*manager_, what, objects_, again_);
        }
    }

    const RecordedProgram& program_;
    Make make_;
    std::vector<std::unique_ptr<Body>> bodies_;
    Registrations registered_;
    std::vector<Object*> objects_, again_; ///< of a call; those that it does nothing but update
    std::unique_ptr<Manager> manager_, other_;
};

} // namespace boxwood::bench
