#pragma once

#include "kernels/primitives/rotation.h"
#include "kernels/settings.h"
#include "scenes/effects/steps.h"
#include "scenes/moving/bodies.h"
#include "scenes/sampling/random.h"

#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace boxwood {

/// What an effect may change. A plan has no stage for what none of a scene's effects changes.
struct Changes {
    bool velocity = false; ///< bodies with a velocity are moved along it after all effects
    bool position = false;
    bool rotation = false;
    bool shape = false; ///< the vertices of meshes
    bool presence = false;

    constexpr Changes operator|(const Changes& o) const {
        return {velocity || o.velocity, position || o.position, rotation || o.rotation,
                shape || o.shape, presence || o.presence};
    }
    constexpr bool operator==(const Changes&) const = default;
};

/// The moment at which an effect acts.
struct Moment {
    Bodies& bodies;
    std::span<const std::uint32_t>
        chosen;          ///< the bodies it is laid on, ascending: no other changes
    Changed& changed;    ///< what it must list: bodies it changed, but velocity
    Random random;       ///< its own numbers
    std::uint64_t frame; ///< from 1; 0 at the start
    double dt;           ///< seconds from frame to frame

    /// The numbers of one body in this frame alone.
    Draws draws(std::uint32_t body) const { return draws_of(random, frame, body); }
};

/// Something that happens to bodies, frame after frame: the same bits on every machine, hence no
/// sine and no power. Its settings are data members that `settings()` lists; whatever else it must
/// remember it sets up in `start`. `BodyStep step(const Moment&) const`, if it has that, is what
/// its `advance` does in the frame: then a device can do it too.
template <class E>
concept Effect = std::default_initializable<E> && requires(E effect, Moment& moment) {
    { E::name } -> std::convertible_to<std::string_view>;
    { E::summary } -> std::convertible_to<std::string_view>;
    { E::changes } -> std::convertible_to<Changes>;
    effect.start(moment);
    effect.advance(moment);
};

/// An effect laid on some bodies of one scene.
class RunningEffect {
  public:
    virtual ~RunningEffect() = default;
    virtual void start(Moment& moment) = 0;
    virtual void advance(Moment& moment) = 0;
    /// Nothing if what it does is not a step of each body alone.
    virtual std::optional<BodyStep> step(const Moment& moment) const = 0;
};

/// A registry row. `make` throws std::invalid_argument for an unknown or out-of-range setting.
struct EffectEntry {
    std::string_view name, summary;
    Changes changes;
    bool is_step; ///< of each body alone
    std::vector<SettingInfo> settings;
    std::function<std::unique_ptr<RunningEffect>(const Settings&)> make;
};
std::span<const EffectEntry> effects();

/// The row of that name. Throws std::invalid_argument, with a suggestion, for an unknown one.
const EffectEntry& effect_of(std::string_view name);

/// The registry row of an Effect type. An effect NAME is the file effects/NAME.cpp, which defines
/// `EffectEntry NAME_effect()` by this, and the name X(NAME) in effect.cpp.
template <Effect E> EffectEntry effect_entry() {
    constexpr bool is_step = requires(const E& effect, const Moment& moment) {
        effect.step(moment);
    };
    struct Running final : RunningEffect {
        explicit Running(const E& made) : effect(made) {}
        void start(Moment& moment) override { effect.start(moment); }
        void advance(Moment& moment) override { effect.advance(moment); }
        std::optional<BodyStep> step([[maybe_unused]] const Moment& moment) const override {
            if constexpr (is_step)
                return effect.step(moment);
            else
                return std::nullopt;
        }
        E effect;
    };
    return {
        E::name, E::summary, E::changes, is_step, setting_infos<E>(), [](const Settings& values) {
            return std::make_unique<Running>(with_settings<E>(values));
        }};
}

/// Half the wave of a sine, without a sine: runs through 0, 1, 0, -1, 0 as its argument runs
/// through 0, 1, 2, 3, 4, in parabolas, with a continuous slope, and repeats.
double wave(double quarters);

/// The rotation about a unit axis by 2 atan(t): Cayley's form, orthonormal up to rounding.
std::array<Vec3<double>, 3> cayley_rotation(Vec3<double> axis, double t);

} // namespace boxwood
