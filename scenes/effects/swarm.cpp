#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// Flocks of bodies with neighbouring numbers: each steers for its own place around a goal that all
/// of its flock share, and that moves elsewhere after a while.
struct Swarm {
    static constexpr std::string_view name = "swarm";
    static constexpr std::string_view summary =
        "flocks of bodies steer for goals that move elsewhere after a while";
    static constexpr Changes changes{.velocity = true};

    double speed = 10, flock = 100, period = 3, spread = 5;
    static std::vector<Setting<Swarm>> settings() {
        return {
            {"speed", "the highest, mean body sides per second", &Swarm::speed, 0, 1e9},
            {"flock", "bodies that share a goal", &Swarm::flock, 1, 1e9},
            {"period", "seconds until the goal moves", &Swarm::period, 1e-3, 1e6},
            {"spread", "radius of a flock at its goal, mean body sides", &Swarm::spread, 0, 1e6}};
    }

    void start(Moment&) const {}
    void advance(Moment& moment) const {
        Bodies& bodies = moment.bodies;
        const SteerStep steer = step(moment);
        Vec3<double> goal{};
        std::uint64_t goal_of = ~std::uint64_t{0};
        for (const std::uint32_t i : moment.chosen) {
            if (i / steer.flock != goal_of) {
                goal_of = i / steer.flock;
                goal = steer.goal(goal_of);
            }
            steer(i, goal, bodies.pose[i].translation, bodies.velocity[i]);
        }
    }
    SteerStep step(const Moment& moment) const {
        const double side = moment.bodies.side,
                     time = static_cast<double>(moment.frame) * moment.dt;
        return {moment.bodies.bounds,
                moment.random,
                static_cast<std::uint64_t>(time / period),
                static_cast<std::uint64_t>(flock),
                speed * side,
                spread * side,
                moment.dt};
    }
};

} // namespace

EffectEntry swarm_effect() { return effect_entry<Swarm>(); }

} // namespace boxwood
