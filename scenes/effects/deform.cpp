#include "scenes/effects/effect.h"

#include <algorithm>

namespace boxwood {
namespace {

/// A wave that runs along x through the mesh of a body and lifts its vertices along z; along y it
/// comes later, so that no two rows move alike.
struct Deform {
    static constexpr std::string_view name = "deform";
    static constexpr std::string_view summary = "meshes wave, vertex by vertex";
    static constexpr Changes changes{.shape = true};

    double height = .1, waves = 2, rate = .5;
    static std::vector<Setting<Deform>> settings() {
        return {{"height", "of the wave, of the largest side of the mesh", &Deform::height, 0, 10},
                {"waves", "number along x", &Deform::waves, 0, 1e3},
                {"rate", "waves that pass per second", &Deform::rate, 0, 1e3}};
    }

    void start(Moment& moment) {
        at_rest_.clear();
        for (const std::uint32_t i : moment.chosen)
            if (const std::uint32_t m = moment.bodies.mesh[i]; m != no_mesh)
                at_rest_.push_back({i, moment.bodies.rest[i], moment.bodies.meshes[m].vertices});
    }

    void advance(Moment& moment) const {
        Bodies& bodies = moment.bodies;
        const double passed = 4 * rate * moment.dt * static_cast<double>(moment.frame);
        for (const auto& [i, box, vertices] : at_rest_) {
            const auto low = static_cast<Vec3<double>>(box.min);
            const auto size = static_cast<Vec3<double>>(box.max) - low;
            const double lift = height * std::max({size.x, size.y, size.z});
            const auto quarters = [](double x, double side) { return side > 0 ? 4 * x / side : 0; };
            std::vector<Vec3<float>>& moved = bodies.meshes[bodies.mesh[i]].vertices;
            Aabb<float> around;
            for (std::size_t v = 0; v < vertices.size(); ++v) {
                const auto p = static_cast<Vec3<double>>(vertices[v]);
                const double along = waves * quarters(p.x - low.x, size.x);
                const double across = quarters(p.y - low.y, size.y) / 2;
                moved[v].z = static_cast<float>(p.z + lift * wave(along + across - passed));
                around.extend(moved[v]);
            }
            bodies.rest[i] = around;
            moment.changed.add(i);
        }
    }

  private:
    struct AtRest {
        std::uint32_t body;
        Aabb<float> box;
        std::vector<Vec3<float>> vertices;
    };
    std::vector<AtRest> at_rest_; ///< of the chosen bodies that have a mesh
};

} // namespace

EffectEntry deform_effect() { return effect_entry<Deform>(); }

} // namespace boxwood
