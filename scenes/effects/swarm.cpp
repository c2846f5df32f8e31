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
        const auto age =
            static_cast<std::uint64_t>(static_cast<double>(moment.frame) * moment.dt / period);
        const Vec3<double> extent = bodies.bounds.max - bodies.bounds.min;
        const double fastest = speed * bodies.side;
        const double max_change = 4 * fastest * moment.dt; // full speed after a quarter second
        Vec3<double> goal{};
        std::uint64_t goal_of = ~std::uint64_t{0};
        for (const std::uint32_t i : moment.chosen) {
            const auto flock_of_i = i / static_cast<std::uint64_t>(flock);
            if (flock_of_i != goal_of) {
                goal_of = flock_of_i;
                const Vec3<double> u = moment.random.item((age + 1) << 32 | flock_of_i).in_cube();
                goal = bodies.bounds.min +
                       Vec3<double>{u.x * extent.x, u.y * extent.y, u.z * extent.z};
            }
            const Vec3<double> place = spread * bodies.side * moment.random.item(i).in_ball();
            const Vec3<double> way = goal + place - bodies.pose[i].translation;
            const Vec3<double> wanted = limited(way * (1 / (moment.dt * 8)), fastest);
            Vec3<double>& velocity = bodies.velocity[i];
            velocity = velocity + limited(wanted - velocity, max_change);
        }
    }

  private:
    static Vec3<double> limited(Vec3<double> v, double max_length) {
        const double size = length(v);
        return size > max_length ? v * (max_length / size) : v;
    }
};

} // namespace

EffectEntry swarm_effect() { return effect_entry<Swarm>(); }

} // namespace boxwood
