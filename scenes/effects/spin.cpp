#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// The pose is the turn of the start times a power of one step; it is made orthonormal again in
/// each frame, so that rounding does not shear the body.
struct Spin {
    static constexpr std::string_view name = "spin";
    static constexpr std::string_view summary = "bodies turn about an axis of their own";
    static constexpr Changes changes{.rotation = true};

    double rate = 2;
    static std::vector<Setting<Spin>> settings() {
        return {{"rate", "of the fastest, radians per second", &Spin::rate, 0, 1e3}};
    }

    void start(Moment& moment) {
        steps_.clear();
        for (const std::uint32_t i : moment.chosen) {
            Draws draws = moment.draws(i);
            const Vec3<double> axis = draws.unit_vector();
            steps_.push_back(cayley_rotation(axis, rate * moment.dt * draws.uniform() / 2));
        }
    }
    void advance(Moment& moment) const {
        for (std::size_t k = 0; k < moment.chosen.size(); ++k) {
            const std::uint32_t i = moment.chosen[k];
            auto& rotation = moment.bodies.pose[i].rotation;
            rotation = orthonormal(product(steps_[k], rotation));
            moment.changed.add(i);
        }
    }

  private:
    /// Gram and Schmidt's way, row by row.
    static std::array<Vec3<double>, 3> orthonormal(std::array<Vec3<double>, 3> rows) {
        rows[0] = rows[0] * (1 / length(rows[0]));
        rows[1] = rows[1] - dot(rows[0], rows[1]) * rows[0];
        rows[1] = rows[1] * (1 / length(rows[1]));
        rows[2] = cross(rows[0], rows[1]);
        return rows;
    }

    std::vector<std::array<Vec3<double>, 3>> steps_; ///< per frame, of each chosen body
};

} // namespace

EffectEntry spin_effect() { return effect_entry<Spin>(); }

} // namespace boxwood
