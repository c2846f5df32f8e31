#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// Circles about the vertical line through the middle of the bounds.
struct Orbit {
    static constexpr std::string_view name = "orbit";
    static constexpr std::string_view summary =
        "bodies circle the middle of the bounds, each at a rate of its own";
    static constexpr Changes changes{.position = true};

    double rate = .5;
    static std::vector<Setting<Orbit>> settings() {
        return {{"rate", "of the fastest, radians per second; half of it at least", &Orbit::rate, 0,
                 1e3}};
    }

    void start(Moment& moment) {
        turns_.clear();
        for (const std::uint32_t i : moment.chosen) {
            const double radians = rate * moment.dt * moment.draws(i).uniform(.5, 1);
            turns_.push_back(cayley_rotation({0, 0, 1}, radians / 2));
        }
    }
    void advance(Moment& moment) const {
        const Aabb<double>& bounds = moment.bodies.bounds;
        const Vec3<double> middle = .5 * (bounds.min + bounds.max);
        for (std::size_t k = 0; k < moment.chosen.size(); ++k) {
            const std::uint32_t i = moment.chosen[k];
            Vec3<double>& place = moment.bodies.pose[i].translation;
            const Vec3<double> arm = place - middle;
            place = middle + Vec3<double>{dot(turns_[k][0], arm), dot(turns_[k][1], arm), arm.z};
            moment.changed.add(i);
        }
    }

  private:
    std::vector<std::array<Vec3<double>, 3>> turns_; ///< per frame, of each chosen body
};

} // namespace

EffectEntry orbit_effect() { return effect_entry<Orbit>(); }

} // namespace boxwood
