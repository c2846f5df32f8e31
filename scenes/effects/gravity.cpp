#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// A constant acceleration, in one direction or turning about z. Bodies that have come to rest on
/// the floor of the bounds are left alone from then on, unless the direction turns.
struct Gravity {
    static constexpr std::string_view name = "gravity";
    static constexpr std::string_view summary =
        "bodies fall, bounce off the floor and walls of the bounds, and come to rest";
    static constexpr Changes changes{.velocity = true};

    double strength = 10, of_bounds = 0, bounce = .5, friction = .1, turn = 0;
    static std::vector<Setting<Gravity>> settings() {
        return {
            {"strength", "mean body sides per second squared", &Gravity::strength, 0, 1e9},
            {"of_bounds", "the same in mean sides of the bounds, added", &Gravity::of_bounds, 0,
             1e3},
            {"bounce", "share of its speed that a body keeps at a wall", &Gravity::bounce, 0, 1},
            {"friction", "share of its sideways speed lost per frame on the floor",
             &Gravity::friction, 0, 1},
            {"turn", "quarter turns of the direction, about y, per second; 0: straight down",
             &Gravity::turn, 0, 1e3}};
    }

    void start(Moment& moment) {
        moment.bodies.bounce = bounce;
        awake_.assign(moment.chosen.begin(), moment.chosen.end());
    }

    void advance(Moment& moment) {
        Bodies& bodies = moment.bodies;
        const FallStep fall = step(moment);
        std::size_t still_awake = 0;
        for (const std::uint32_t i : awake_)
            if (fall(bodies.pose[i].translation, bodies.velocity[i]))
                awake_[still_awake++] = i;
        awake_.resize(still_awake);
    }
    FallStep step(const Moment& moment) const {
        const double gain = moment.bodies.length_of(strength, of_bounds) * moment.dt;
        const double quarters = turn * moment.dt * static_cast<double>(moment.frame);
        return {gain,
                {wave(quarters), 0, -wave(quarters + 1)},
                friction,
                turn == 0 ? moment.bodies.bounds.min.z : -Aabb<double>::inf};
    }

  private:
    std::vector<std::uint32_t> awake_;
};

} // namespace

EffectEntry gravity_effect() { return effect_entry<Gravity>(); }

} // namespace boxwood
