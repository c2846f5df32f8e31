#pragma once

#include "kernels/primitives/aabb.h"

#include <array>
#include <string_view>

namespace boxwood {

/// A planar arm of four links in a row along x: the smallest robot that shows what a tree does for
/// self-collision. Straight, the link boxes are centred at x = 0, 0.5, 1.2, 1.8 (metres), and the
/// pairs (base, shoulder) and (elbow, wrist) overlap. The base stands still; joint i turns about z
/// at the point `four_link_joints[i]`, half-way between the centres of links i and i + 1, and
/// carries all links after it.
inline constexpr std::array<std::string_view, 4> four_link_names{"base", "shoulder", "elbow",
                                                                 "wrist"};
inline constexpr std::array<double, 4> four_link_centres{0, 0.5, 1.2, 1.8}; ///< x; y = z = 0
inline constexpr std::array<double, 3> four_link_joints{0.25, 0.85, 1.5};   ///< x; y = z = 0
inline constexpr Vec3<double> four_link_half{0.32, 0.1, 0.1}; ///< half size of each link's own box

/// Radians, counter-clockwise seen from +z, each relative to the link before.
using FourLinkAngles = std::array<double, 3>;

inline constexpr FourLinkAngles four_link_straight{0, 0, 0};
/// 60, 120 and 0 degrees: bent back above itself; adjacent links alone overlap.
inline constexpr FourLinkAngles four_link_bent{1.0471975511965976, 2.0943951023931953, 0};
/// From there the last joint alone turns by 90 degrees, and the wrist meets the base.
inline constexpr FourLinkAngles four_link_folded{1.0471975511965976, 2.0943951023931953,
                                                 1.5707963267948966};

/// Forward kinematics: each link's box rotated and moved, then the axis-aligned box around it,
/// rounded outward to float. Throws std::invalid_argument for an angle that is not finite.
std::array<Aabb<float>, 4> four_link_boxes(const FourLinkAngles& angles);

/// The same as four_link_boxes(four_link_straight), without sine and cosine.
std::array<Aabb<float>, 4> four_link_straight_boxes();

} // namespace boxwood
