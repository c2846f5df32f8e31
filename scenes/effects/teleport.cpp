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
        const Aabb<double>& bounds = moment.bodies.bounds;
        const Vec3<double> extent = bounds.max - bounds.min;
        for (const std::uint32_t i : moment.chosen) {
            Draws draws = moment.draws(i);
            if (draws.uniform() >= often)
                continue;
            const Vec3<double> u = draws.in_cube();
            moment.bodies.pose[i].translation =
                bounds.min + Vec3<double>{u.x * extent.x, u.y * extent.y, u.z * extent.z};
            moment.changed.add(i);
        }
    }
};

} // namespace

EffectEntry teleport_effect() { return effect_entry<Teleport>(); }

} // namespace boxwood
