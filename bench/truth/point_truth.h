#pragma once

#include "bench/truth/truth.h"

namespace boxwood::bench {

enum class PointQuery : std::uint8_t {
    containing,   ///< for each point the boxes that contain it
    overlapping,  ///< for each box or sphere the boxes that share a point with it
    nearest,      ///< for each point the k nearest boxes
    surface_point ///< for each point the nearest point of the mesh
};

/// The right answers to a seeded sample of a scene's points or regions: every item tested in
/// doubles. Items of equal distance may differ between libraries, and those of floats round: an
/// answer of the last two is right if its distance is within `point_bound` of the least (of the k
/// least, in order), and exact where it equals the truth.
std::unique_ptr<Truth> make_point_truth(const Scene& scene, PointQuery query, unsigned threads);

/// How far a distance may be off: this share of itself, and of the size of the triangle if there is
/// one.
inline constexpr double point_bound = 0x1p-16;

/// How many neighbours of each point `nearest` wants: the scene's k, or 1.
inline std::size_t neighbours_of(const Scene& scene) {
    return static_cast<std::size_t>(scene.spec.k.value_or(1));
}

} // namespace boxwood::bench
