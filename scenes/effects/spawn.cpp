#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// Bodies that are absent appear where they were last.
struct Spawn {
    static constexpr std::string_view name = "spawn";
    static constexpr std::string_view summary = "bodies that are absent appear, some in each frame";
    static constexpr Changes changes{.presence = true};

    double absent = .5, often = .05;
    static std::vector<Setting<Spawn>> settings() {
        return {
            {"absent", "probability that a body is absent at the start", &Spawn::absent, 0, 1},
            {"often", "probability that an absent body appears in a frame", &Spawn::often, 0, 1}};
    }

    void start(Moment& moment) const {
        for (const std::uint32_t i : moment.chosen)
            moment.bodies.present[i] = moment.draws(i).uniform() >= absent;
    }
    void advance(Moment& moment) const {
        for (const std::uint32_t i : moment.chosen)
            if (!moment.bodies.present[i] && moment.draws(i).uniform() < often) {
                moment.bodies.present[i] = 1;
                moment.changed.add(i);
            }
    }
};

} // namespace

EffectEntry spawn_effect() { return effect_entry<Spawn>(); }

} // namespace boxwood
