#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

struct Despawn {
    static constexpr std::string_view name = "despawn";
    static constexpr std::string_view summary = "bodies vanish, some in each frame";
    static constexpr Changes changes{.presence = true};

    double often = .05;
    static std::vector<Setting<Despawn>> settings() {
        return {{"often", "probability that a body vanishes in a frame", &Despawn::often, 0, 1}};
    }

    void start(Moment&) const {}
    void advance(Moment& moment) const {
        for (const std::uint32_t i : moment.chosen)
            if (moment.bodies.present[i] && moment.draws(i).uniform() < often) {
                moment.bodies.present[i] = 0;
                moment.changed.add(i);
            }
    }
};

} // namespace

EffectEntry despawn_effect() { return effect_entry<Despawn>(); }

} // namespace boxwood
