#include "bench/stages/device_bodies.h"
#include "bench/stages/turned_box.h"
#include "trees/cuda/device/machine.h"

#include <type_traits>
#include <variant>
#include <vector>

namespace boxwood::bench {
namespace {

constexpr unsigned body_threads = 256;

/// Body `at` of those listed; of no list, of all.
__device__ inline std::uint32_t body_of(const std::uint32_t* listed, std::uint32_t at) {
    return listed ? listed[at] : at;
}

/// The bodies that an effect is laid on.
struct Chosen {
    const std::uint32_t* listed;
    std::uint32_t n;
    std::uint8_t* is_at_rest; ///< those that the effect leaves alone from then on; of FallStep
};
/// Of all bodies.
struct State {
    Vec3<double>* places;
    Vec3<double>* velocities; ///< null if no effect gives one
};

__device__ inline void take(const VelocityStep& step, const Chosen&, const State& state,
                            std::uint32_t, std::uint32_t body) {
    step(body, state.velocities[body]);
}
__device__ inline void take(const JumpStep& step, const Chosen&, const State& state, std::uint32_t,
                            std::uint32_t body) {
    step(body, state.places[body]);
}
__device__ inline void take(const FallStep& step, const Chosen& chosen, const State& state,
                            std::uint32_t at, std::uint32_t body) {
    if (!chosen.is_at_rest[at] && !step(state.places[body], state.velocities[body]))
        chosen.is_at_rest[at] = 1;
}
__device__ inline void take(const SteerStep& step, const Chosen&, const State& state, std::uint32_t,
                            std::uint32_t body) {
    step(body, step.goal(body / step.flock), state.places[body], state.velocities[body]);
}

/// A thread per body that the effect is laid on.
template <class Step> __global__ void step_bodies(Step step, Chosen chosen, State state) {
    const std::uint32_t at = blockIdx.x * blockDim.x + threadIdx.x;
    if (at < chosen.n)
        take(step, chosen, state, at, body_of(chosen.listed, at));
}

/// A thread per body with a velocity.
__global__ void move_bodies(MoveStep step, const std::uint32_t* moving, std::uint32_t n,
                            State state) {
    const std::uint32_t at = blockIdx.x * blockDim.x + threadIdx.x;
    if (at >= n)
        return;
    const std::uint32_t body = body_of(moving, at);
    step(state.places[body], state.velocities[body]);
}

/// A thread per body.
__global__ void fit_bodies(const Box* rest, const Vec3<double>* places, std::uint32_t n,
                           Box* boxes) {
    const std::uint32_t body = blockIdx.x * blockDim.x + threadIdx.x;
    if (body < n)
        boxes[body] = TurnedBox(rest[body]).at(places[body]);
}

class BodiesThere final : public DeviceBodies {
  public:
    explicit BodiesThere(DevicePlace place) : place_(place) {}

    std::size_t upload(MovingScene& scene) override {
        const Bodies& bodies = scene.bodies();
        std::vector<Vec3<double>> places;
        places.reserve(bodies.size());
        for (const RigidTransform<double>& pose : bodies.pose)
            places.push_back(pose.translation);
        bytes_up_ = 0;
        put<Box>(bodies.rest, rest_);
        put<Vec3<double>>(places, places_);
        if (!scene.with_velocity().empty())
            put<Vec3<double>>(bodies.velocity, velocities_);
        list(scene.with_velocity(), moving_);
        chosen_.clear();
        for (std::size_t i = 0; i < scene.effects().size(); ++i) {
            Listed& chosen = chosen_.emplace_back();
            const BodyStep step = *scene.step(i);
            if (!std::holds_alternative<NoStep>(step))
                list(scene.effects()[i].chosen, chosen);
            if (std::holds_alternative<FallStep>(step))
                put<std::uint8_t>(std::vector<std::uint8_t>(chosen.n), chosen.is_at_rest);
        }
        if (boxes_.size() != bodies.size())
            boxes_ = DeviceArray<Box>(bodies.size(), place_);
        return bytes_up_;
    }

    void advance(MovingScene& scene, std::size_t laid) override {
        Listed& chosen = chosen_[laid];
        std::visit(
            [&]<class Step>(const Step& step) {
                if constexpr (!std::is_same_v<Step, NoStep>)
                    start(step_bodies<Step>, chosen.n, step,
                          Chosen{chosen.data(), chosen.n, chosen.is_at_rest.span().data}, state());
            },
            *scene.step(laid));
    }
    void move(const MovingScene& scene) override {
        start(move_bodies, moving_.n, scene.move_step(), moving_.data(), moving_.n, state());
    }
    DeviceSpan<const Box> fit() override {
        const auto n = static_cast<std::uint32_t>(rest_.size());
        start(fit_bodies, n, rest_.span().data, places_.span().data, n, boxes_.span().data);
        return boxes_.span();
    }

  private:
    /// Some of the bodies, or all, for which there is no list.
    struct Listed {
        DeviceArray<std::uint32_t> bodies;
        std::uint32_t n = 0;
        DeviceArray<std::uint8_t> is_at_rest; ///< see Chosen
        const std::uint32_t* data() const { return bodies.span().data; }
    };

    State state() { return {places_.span().data, velocities_.span().data}; }

    template <class... Parameters, class... Arguments>
    void start(void (*kernel)(Parameters...), std::uint32_t n, Arguments... arguments) {
        const cuda::Chosen chosen(place_.index);
        cuda::launch(cuda::stream_of(place_), cuda::blocks_for(n, body_threads), body_threads,
                     kernel, arguments...);
    }
    template <class T> void put(std::span<const T> from, DeviceArray<T>& to) {
        if (to.size() != from.size()) {
            to = {}; // not both at the same time
            to = DeviceArray<T>(from.size(), place_);
        }
        to.write(from);
        bytes_up_ += from.size_bytes();
    }
    /// Ascending.
    void list(std::span<const std::uint32_t> bodies, Listed& to) {
        to.n = static_cast<std::uint32_t>(bodies.size());
        if (to.n < rest_.size())
            put<std::uint32_t>(bodies, to.bodies);
    }

    DevicePlace place_;
    std::size_t bytes_up_ = 0;
    DeviceArray<Box> rest_, boxes_;
    DeviceArray<Vec3<double>> places_, velocities_;
    Listed moving_;
    std::vector<Listed> chosen_; ///< by effect laid
};

} // namespace

std::unique_ptr<DeviceBodies> make_device_bodies(DevicePlace place) {
    const cuda::Chosen chosen(place.index); // says if there is none
    return std::make_unique<BodiesThere>(place);
}

} // namespace boxwood::bench
