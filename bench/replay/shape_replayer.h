#pragma once

#include "bench/replay/replayer.h"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace boxwood::bench {

/// A Replay with the shapes of a library behind a manager of its Api: which pairs touch, by the
/// program's most frequent request, and distances without points. A Library has
///   Api, Geometry (a shared pointer), Rotation, Translation,
///   Geometry geometry_of(program, RecordedProgram::Geometry),
///   bool touch(Object*, Object*, RecordedProgram::Touch),
///   Nearest (of a query: the nearest pair so far, which spares others their search) and
///   double distance(Object*, Object*, Nearest&), that of the nearest pair with this one.
template <class Library> class ShapeReplayer final : public Replay {
    using Api = typename Library::Api;
    using Object = typename Api::Object;
    using Manager = typename Api::Manager;
    using Number = typename Api::Scalar;

  public:
    using Make = std::function<std::unique_ptr<Manager>()>;

    ShapeReplayer(const RecordedProgram& program, Make make)
        : program_(program), touch_(program.touch), make_(std::move(make)) {
        std::vector<typename Library::Geometry> geometries;
        for (const RecordedProgram::Geometry& geometry : program.geometries)
            geometries.push_back(Library::geometry_of(program, geometry));
        for (std::size_t i = 0; i < program.n_objects(); ++i) {
            objects_.push_back(std::make_unique<Object>(geometries[program.geometry_of[i]]));
            objects_.back()->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
        }
    }

    void run(const std::function<bool(std::size_t)>& includes,
             std::vector<ReplayedCall>& calls) override {
        calls.assign(program_.calls.size(), {});
        manager_ = make_();
        to_manager_.begin();
        for (std::size_t i = 0; i < calls.size(); ++i) {
            const RecordedProgram::Call& call = program_.calls[i];
            const bool is_made = is_replayed(call, i, includes);
            if (is_made)
                to_manager_.take(program_, call, objects_);
            Seen seen{calls[i], call.ended, touch_};
            const auto begun = std::chrono::steady_clock::now();
            for (const RecordedProgram::State& state : program_.states_of(call))
                move(state);
            if (is_made)
                to_manager_.make(call.what, *manager_, seen);
            const std::chrono::duration<double, std::nano> taken =
                std::chrono::steady_clock::now() - begun;
            calls[i].ns = taken.count();
        }
        manager_.reset();
    }

  private:
    struct Seen {
        ReplayedCall& to;
        bool ends; ///< at the first pair that touches
        RecordedProgram::Touch touch;
        typename Library::Nearest nearest{};

        bool add(Object* a, Object* b) {
            if (a == b || !Library::touch(a, b, touch))
                return false;
            note_touching(to, number(a), number(b));
            return ends;
        }
        bool add(Object* a, Object* b, Number& least) {
            if (a == b)
                return false;
            to.min_distance =
                std::min(to.min_distance, std::max(Library::distance(a, b, nearest), 0.));
            least = static_cast<Number>(to.min_distance);
            return to.min_distance <= 0;
        }
        static std::uint32_t number(const Object* object) {
            return static_cast<std::uint32_t>(
                reinterpret_cast<std::uintptr_t>(object->getUserData()));
        }
    };

    void move(const RecordedProgram::State& state) {
        Object& object = *objects_[state.object];
        const auto number = [&](std::size_t i) { return static_cast<Number>(state.pose[i]); };
        typename Library::Rotation rotation;
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                rotation(row, column) = number(static_cast<std::size_t>(3 * row + column));
        object.setTransform(rotation,
                            typename Library::Translation(number(9), number(10), number(11)));
        object.computeAABB();
    }

    const RecordedProgram& program_;
    RecordedProgram::Touch touch_;
    Make make_;
    std::vector<std::unique_ptr<Object>> objects_;
    CallsOf<Api> to_manager_;
    std::unique_ptr<Manager> manager_;
};

} // namespace boxwood::bench
