#include "scenes/robots/four_link.h"

#include "kernels/arithmetic/rounding.h"

#include <fmt/format.h>

#include <stdexcept>

namespace boxwood {
namespace {

/// The slack covers the double arithmetic before it: fewer than 20 operations on numbers below 4,
/// each off by at most 2^-52. It is far below half an ulp of the float.
Aabb<float> box_around(Vec3<double> centre, Vec3<double> half) {
    constexpr double slack = 20 * 0x1p-52;
    half = half + Vec3<double>{slack, slack, slack};
    return round_outward({centre - half, centre + half});
}

} // namespace

std::array<Aabb<float>, 4> four_link_boxes(const FourLinkAngles& angles) {
    std::array<Aabb<float>, 4> boxes;
    Vec3<double> joint{}; // where the joint before link i is now; the base has none and stands at 0
    double home = 0;      // its x when the arm is straight
    double angle = 0;     // of link i to the x axis
    for (std::size_t i = 0; i < 4; ++i) {
        if (i > 0) {
            if (!std::isfinite(angles[i - 1]))
                throw std::invalid_argument(
                    fmt::format("four_link: the angle of joint {} is {}", i - 1, angles[i - 1]));
            angle += angles[i - 1];
        }
        const Vec3<double> along{std::cos(angle), std::sin(angle), 0};
        const double c = std::abs(along.x), s = std::abs(along.y);
        const auto [x, y, z] = four_link_half;
        boxes[i] = box_around(joint + (four_link_centres[i] - home) * along,
                              {c * x + s * y, s * x + c * y, z});
        if (i < 3) {
            joint = joint + (four_link_joints[i] - home) * along;
            home = four_link_joints[i];
        }
    }
    return boxes;
}

std::array<Aabb<float>, 4> four_link_straight_boxes() {
    std::array<Aabb<float>, 4> boxes;
    for (std::size_t i = 0; i < 4; ++i)
        boxes[i] = box_around({four_link_centres[i], 0, 0}, four_link_half);
    return boxes;
}

} // namespace boxwood
