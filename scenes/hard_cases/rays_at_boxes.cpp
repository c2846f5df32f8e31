#include "scenes/hard_cases/lattice.h"
#include "scenes/hard_cases/rounded.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace boxwood {
namespace {

template <class Draw> Cases ray_boxes(const HardCaseSpec& spec, const Random& random, Draw draw) {
    std::vector<RayBoxCase> cases(spec.n);
    for (std::size_t i = 0; i < spec.n; ++i) {
        Draws draws = random.item(i);
        cases[i] = draw(draws, *spec.k);
        for (Vec3<float>* p : {&cases[i].ray.origin, &cases[i].box.min, &cases[i].box.max})
            *p = scaled(*p, spec.scale);
    }
    return cases;
}

RayBoxCase generic_ray_at_box(Draws& draws, int) {
    RayBoxCase result;
    result.box.extend(Vec3<float>(draws.in_ball()));
    result.box.extend(Vec3<float>(draws.in_ball()));
    const Vec3<double> direction = draws.unit_vector(), shares = draws.in_cube();
    Vec3<double> target = draws.in_ball();
    if (draw_coin(draws))
        for (int axis = 0; axis < 3; ++axis) {
            const auto low = static_cast<double>(result.box.min[axis]);
            const auto high = static_cast<double>(result.box.max[axis]);
            target[axis] = low + shares[axis] * (high - low);
        }
    result.ray.direction = Vec3<float>(direction);
    result.ray.origin = Vec3<float>(target - draws.uniform(0, 4) * direction);
    return result;
}

/// On each axis a direction of +0, -0 or +-2^j, an origin below, on the lower face of, in, on the
/// upper face of or above the box, and a box that is often flat. t_min is 0, and every quotient of
/// the slab test an integer times 2^-j, so that comparing them in double is exact.
RayBoxCase signed_zeros(Draws& draws, int) {
    RayBoxCase result;
    double entry = 0, exit = std::numeric_limits<double>::infinity();
    bool moves = false;
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t low = draw_integer(draws, -8, 8);
        const std::int64_t high = low + (draw_coin(draws) ? 0 : draw_integer(draws, 1, 4));
        const std::int64_t places[5] = {low - 1, low, (low + high) / 2, high, high + 1};
        const std::int64_t origin = places[draw_integer(draws, 0, 4)];
        const int exponent = static_cast<int>(draw_integer(draws, -2, 2));
        double direction = draw_coin(draws) ? 0 : std::ldexp(1.0, exponent);
        if (axis == 2 && !moves)
            direction = std::ldexp(1.0, exponent); // a ray has a direction
        moves |= direction != 0;
        if (draw_coin(draws))
            direction = -direction;
        result.box.min[axis] = static_cast<float>(low);
        result.box.max[axis] = static_cast<float>(high);
        result.ray.origin[axis] = static_cast<float>(origin);
        result.ray.direction[axis] = static_cast<float>(direction);
        if (direction == 0) {
            if (origin < low || origin > high)
                exit = -1; // never within this slab
        } else {
            double near = static_cast<double>(low - origin) / direction;
            double far = static_cast<double>(high - origin) / direction;
            if (direction < 0)
                std::swap(near, far);
            entry = std::max(entry, near);
            exit = std::min(exit, far);
        }
    }
    result.hit = entry <= exit ? Known::yes : Known::no;
    return result;
}

/// The ray enters the x slab and leaves the y slab at t = m exactly: corner - origin = m direction.
/// With direction D an integer below 2^24 and m below 2^(k + 1) the corner is m D rounded to float,
/// and what the rounding took is the origin, an integer of at most 2^22. Every fourth time the
/// box's upper face there is one float lower, and the ray misses.
RayBoxCase corner_tie(Draws& draws, int k) {
    RayBoxCase result;
    const std::int64_t min_side = std::int64_t{1} << k;
    const std::int64_t m = draw_integer(draws, min_side, 2 * min_side - 1);
    const bool misses = draw_integer(draws, 0, 3) == 0;
    std::array<int, 3> axes{0, 1, 2};
    shuffle(axes, draws);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::int64_t d = draw_integer(draws, (1 << 23) + 1, (1 << 24) - 1);
        const auto corner = static_cast<float>(m * d);
        const auto origin = static_cast<float>(static_cast<std::int64_t>(corner) - m * d);
        // i = 0 enters at the corner, 1 leaves there, 2 does both within t = m -+ m / 2.
        float low = corner, high = 2 * corner;
        if (i == 1) {
            low = 0;
            high = misses ? std::nextafter(corner, 0.0f) : corner;
        } else if (i == 2) {
            low = corner / 2;
        }
        const bool mirror = draw_coin(draws);
        const int axis = axes[i];
        result.ray.direction[axis] = static_cast<float>(mirror ? -d : d);
        result.ray.origin[axis] = mirror ? -origin : origin;
        result.box.min[axis] = mirror ? -high : low;
        result.box.max[axis] = mirror ? -low : high;
    }
    result.hit = misses ? Known::no : Known::yes;
    return result;
}

} // namespace

HardCaseFamily generic_ray_boxes_family() {
    return {.name = "generic_ray_boxes",
            .summary = "rays at boxes in the unit ball, about half of them hitting",
            .panel = Panel::generic,
            .scale_min = -80,
            .scale_max = 120,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return ray_boxes(spec, random, generic_ray_at_box);
            }};
}

HardCaseFamily signed_zero_directions_family() {
    return {.name = "signed_zero_directions",
            .summary = "direction components +0 and -0, origins on faces, flat boxes",
            .panel = Panel::degenerate,
            .scale_min = -149,
            .scale_max = 120,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return ray_boxes(spec, random, signed_zeros);
            }};
}

HardCaseFamily slab_corner_ties_family() {
    return {.name = "slab_corner_ties",
            .summary = "rays that touch a box at one point of an edge, or miss it by one float",
            .panel = Panel::touching,
            .k_meaning = "the touch is at t of 2^k to 2^(k + 1)",
            .k_default = 22,
            .k_min = 0,
            .k_max = 22,
            .scale_min = -148,
            .scale_max = 78,
            .generate = [](const HardCaseSpec& spec, const Random& random) {
                return ray_boxes(spec, random, corner_tie);
            }};
}

} // namespace boxwood
