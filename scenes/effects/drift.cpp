#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// Uniform motion: the velocity is drawn once and turned round at the walls of the bounds.
struct Drift {
    static constexpr std::string_view name = "drift";
    static constexpr std::string_view summary =
        "bodies go straight on, each at a speed of its own, and bounce off the walls of the bounds";
    static constexpr Changes changes{.velocity = true};

    double speed = 3, of_bounds = 0;
    static std::vector<Setting<Drift>> settings() {
        return {{"speed", "of the fastest, mean body sides per second", &Drift::speed, 0, 1e9},
                {"of_bounds", "the same in mean sides of the bounds, added", &Drift::of_bounds, 0,
                 1e3}};
    }

    void start(Moment& moment) const {
        const double fastest = moment.bodies.length_of(speed, of_bounds);
        for (const std::uint32_t i : moment.chosen) {
            Draws draws = moment.draws(i);
            const Vec3<double> direction = draws.unit_vector();
            moment.bodies.velocity[i] = fastest * draws.uniform() * direction;
        }
    }
    void advance(Moment&) const {}
    BodyStep step(const Moment&) const { return NoStep{}; }
};

} // namespace

EffectEntry drift_effect() { return effect_entry<Drift>(); }

} // namespace boxwood
