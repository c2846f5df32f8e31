#include "scenes/effects/effect.h"

namespace boxwood {
namespace {

/// The chosen bodies, in their order, are the links of one chain that stands on the first. Joint k
/// sits half-way between the origins of links k and k + 1 at rest and carries all links after it;
/// joints turn about z and y by turns and swing to and fro, each at a rate of its own.
struct JointMotion {
    static constexpr std::string_view name = "joint_motion";
    static constexpr std::string_view summary =
        "bodies are the links of a chain whose joints swing to and fro";
    static constexpr Changes changes{.position = true, .rotation = true};

    double swing = 60, rate = .25, flat = 0;
    static std::vector<Setting<JointMotion>> settings() {
        return {
            {"swing", "largest angle of a joint, about, in degrees", &JointMotion::swing, 0, 120},
            {"rate", "swings per second of the fastest joint; a third of it at least",
             &JointMotion::rate, 0, 100},
            {"flat", "1: all joints turn about z", &JointMotion::flat, 0, 1}};
    }

    void start(Moment& moment) {
        at_rest_.clear();
        rates_.clear();
        for (const std::uint32_t i : moment.chosen) {
            at_rest_.push_back(moment.bodies.pose[i].translation);
            rates_.push_back(moment.draws(i).uniform(rate / 3, rate));
        }
    }

    void advance(Moment& moment) const {
        const double time = moment.dt * static_cast<double>(moment.frame);
        const double radians = swing * 0x1.1df46a2529d39p-6; // pi / 180
        // tan(x) about x + x^3/3 + 2 x^5/15: the angle is within 4 % up to 120 degrees
        const double x = radians / 2;
        const double tangent = x + x * x * x / 3 + 2 * x * x * x * x * x / 15;
        std::array<Vec3<double>, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        const auto turned = [&](Vec3<double> v) {
            return Vec3<double>{dot(rotation[0], v), dot(rotation[1], v), dot(rotation[2], v)};
        };
        for (std::size_t k = 1; k < at_rest_.size(); ++k) {
            const Vec3<double> half = .5 * (at_rest_[k] - at_rest_[k - 1]);
            const auto& before = moment.bodies.pose[moment.chosen[k - 1]];
            const Vec3<double> joint = before.translation + turned(half);
            const Vec3<double> axis =
                flat != 0 || k % 2 == 1 ? Vec3<double>{0, 0, 1} : Vec3<double>{0, 1, 0};
            const double angle = tangent * wave(4 * rates_[k] * time);
            rotation = product(rotation, cayley_rotation(axis, angle));
            auto& pose = moment.bodies.pose[moment.chosen[k]];
            pose.rotation = rotation;
            pose.translation = joint + turned(half);
            moment.changed.add(moment.chosen[k]);
        }
    }

  private:
    std::vector<Vec3<double>> at_rest_; ///< origins of the links
    std::vector<double> rates_;         ///< swings per second of the joint before each link
};

} // namespace

EffectEntry joint_motion_effect() { return effect_entry<JointMotion>(); }

} // namespace boxwood
