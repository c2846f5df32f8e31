#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// A new velocity in every frame.
struct Brownian {
    static constexpr std::string_view name = "brownian";
    static constexpr std::string_view summary =
        "bodies go another way, at another speed, each frame";
    static constexpr Changes changes{.velocity = true};

    double speed = .75, of_bounds = 0;
    static std::vector<Setting<Brownian>> settings() {
        return {{"speed", "the highest, mean body sides per second", &Brownian::speed, 0, 1e9},
                {"of_bounds", "the same in mean sides of the bounds, added", &Brownian::of_bounds,
                 0, 1e3}};
    }

    void start(Moment&) const {}
    void advance(Moment& moment) const {
        const VelocityStep change = step(moment);
        for (const std::uint32_t i : moment.chosen)
            change(i, moment.bodies.velocity[i]);
    }
    VelocityStep step(const Moment& moment) const {
        return {moment.bodies.length_of(speed, of_bounds), moment.random, moment.frame};
    }
};

} // namespace

EffectEntry brownian_effect() { return effect_entry<Brownian>(); }

} // namespace boxwood
