#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

struct Teleport {
    static constexpr std::string_view name = "teleport";
    static constexpr std::string_view summary =
        "some bodies, others in each frame, jump to anywhere in the bounds";
    static constexpr Changes changes{.position = true};

    double often = .1;
    static std::vector<Setting<Teleport>> settings() {
        return {{"often", "probability that a body jumps in a frame", &Teleport::often, 0, 1}};
    }

    void start(Moment&) const {}
    void advance(Moment& moment) const {
        const JumpStep jump = step(moment);
        for (const std::uint32_t i : moment.chosen)
            if (jump(i, moment.bodies.pose[i].translation))
                moment.changed.add(i);
    }
    JumpStep step(const Moment& moment) const {
        return {often, moment.bodies.bounds, moment.random, moment.frame};
    }
};

} // namespace

EffectEntry teleport_effect() { return effect_entry<Teleport>(); }

} // namespace boxwood
