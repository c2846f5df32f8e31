/// The registry of effects. To add one: write effects/NAME.cpp, which defines
/// `EffectEntry NAME_effect()`, and add its name here.

#include "scenes/effects/effect.h"

#include "kernels/suggest.h"

#include <array>
#include <cmath>
#include <stdexcept>

#define BOXWOOD_EFFECTS(X)                                                                         \
    X(drift)                                                                                       \
    X(gravity)                                                                                     \
    X(brownian) X(swarm) X(orbit) X(spin) X(teleport) X(spawn) X(despawn) X(deform) X(joint_motion)

namespace boxwood {

#define X(name) EffectEntry name##_effect();
BOXWOOD_EFFECTS(X)
#undef X

std::span<const EffectEntry> effects() {
#define X(name) name##_effect(),
    static const EffectEntry entries[] = {BOXWOOD_EFFECTS(X)};
#undef X
    return entries;
}

const EffectEntry& effect_of(std::string_view name) {
    return entry_named(name, effects(), "effect");
}

double wave(double quarters) {
    const double x = quarters - 4 * std::floor(quarters / 4);
    return x < 2 ? x * (2 - x) : (x - 2) * (x - 4);
}

std::array<Vec3<double>, 3> cayley_rotation(Vec3<double> axis, double t) {
    // of the quaternion (1, t axis) / sqrt(1 + t^2)
    const double scale = 1 / (1 + t * t);
    const double c = (1 - t * t) * scale, s = 2 * t * scale, k = 2 * t * t * scale;
    const auto [x, y, z] = axis;
    return {{{c + k * x * x, k * x * y - s * z, k * x * z + s * y},
             {k * x * y + s * z, c + k * y * y, k * y * z - s * x},
             {k * x * z - s * y, k * y * z + s * x, c + k * z * z}}};
}

} // namespace boxwood
