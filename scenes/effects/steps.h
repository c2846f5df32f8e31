#pragma once

#include "kernels/arithmetic/on_both.h"
#include "kernels/primitives/aabb.h"
#include "scenes/sampling/random.h"

#include <cmath>
#include <cstdint>
#include <variant>

namespace boxwood {

// What happens to one body in one frame where that depends on the body alone: one source for
// processors and devices, and the same bits.

/// The numbers of one body in one frame alone.
BOXWOOD_BOTH inline Draws draws_of(const Random& random, std::uint64_t frame, std::uint32_t body) {
    return random.item(frame << 32 | body);
}

/// Of drift: what happens is left to the velocity.
struct NoStep {};

/// Of brownian.
struct VelocityStep {
    double fastest;
    Random random;
    std::uint64_t frame;

    BOXWOOD_BOTH void operator()(std::uint32_t body, Vec3<double>& velocity) const {
        velocity = fastest * draws_of(random, frame, body).in_ball();
    }
};

/// Of teleport. Gives whether the body jumped.
struct JumpStep {
    double often;
    Aabb<double> bounds;
    Random random;
    std::uint64_t frame;

    BOXWOOD_BOTH bool operator()(std::uint32_t body, Vec3<double>& place) const {
        Draws draws = draws_of(random, frame, body);
        if (draws.uniform() >= often)
            return false;
        const Vec3<double> u = draws.in_cube(), extent = bounds.max - bounds.min;
        place = bounds.min + Vec3<double>{u.x * extent.x, u.y * extent.y, u.z * extent.z};
        return true;
    }
};

/// Of gravity. Gives whether the body is still awake: one that came to rest is left alone.
struct FallStep {
    double gain; ///< of speed in a frame
    Vec3<double> direction;
    double friction, floor; ///< z at which slow bodies come to rest, -inf if none does

    BOXWOOD_BOTH bool operator()(const Vec3<double>& place, Vec3<double>& velocity) const {
        if (place.z <= floor) {
            velocity.x *= 1 - friction;
            velocity.y *= 1 - friction;
            if (dot(velocity, velocity) < 4 * gain * gain) {
                velocity = {};
                return false;
            }
        }
        velocity = velocity + gain * direction;
        return true;
    }
};

/// Of swarm.
struct SteerStep {
    Aabb<double> bounds;
    Random random;
    std::uint64_t age, flock; ///< how often goals have moved; bodies that share one
    double fastest, radius, dt;

    BOXWOOD_BOTH Vec3<double> goal(std::uint64_t flock_number) const {
        const Vec3<double> u = random.item((age + 1) << 32 | flock_number).in_cube();
        const Vec3<double> extent = bounds.max - bounds.min;
        return bounds.min + Vec3<double>{u.x * extent.x, u.y * extent.y, u.z * extent.z};
    }
    BOXWOOD_BOTH void operator()(std::uint32_t body, const Vec3<double>& goal_of_flock,
                                 const Vec3<double>& place, Vec3<double>& velocity) const {
        const Vec3<double> own = radius * random.item(body).in_ball();
        const Vec3<double> way = goal_of_flock + own - place;
        const Vec3<double> wanted = limited(way * (1 / (dt * 8)), fastest);
        const double max_change = 4 * fastest * dt; // full speed after a quarter second
        velocity = velocity + limited(wanted - velocity, max_change);
    }

  private:
    BOXWOOD_BOTH static Vec3<double> limited(Vec3<double> v, double max_length) {
        const double size = std::sqrt(dot(v, v));
        return size > max_length ? v * (max_length / size) : v;
    }
};

using BodyStep = std::variant<NoStep, VelocityStep, JumpStep, FallStep, SteerStep>;

/// Along its velocity; what would leave the bounds stays at the wall and turns round. Gives whether
/// the body moved.
struct MoveStep {
    Aabb<double> bounds;
    double bounce, frames_per_second;

    BOXWOOD_BOTH bool operator()(Vec3<double>& place, Vec3<double>& velocity) const {
        if (velocity.x == 0 && velocity.y == 0 && velocity.z == 0)
            return false;
        bool moved = false;
        for (int axis = 0; axis < 3; ++axis) {
            const double low = bounds.min[axis], high = bounds.max[axis];
            const double x = place[axis] + velocity[axis] / frames_per_second;
            if ((x < low && velocity[axis] < 0) || (x > high && velocity[axis] > 0))
                velocity[axis] *= -bounce;
            const double within = x < low ? low : high < x ? high : x;
            moved = moved || !(within == place[axis]);
            place[axis] = within;
        }
        return moved;
    }
};

} // namespace boxwood
