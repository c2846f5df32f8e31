#pragma once

#include "kernels/primitives/triangle.h"

#include <string>

namespace boxwood::bench {

/// What the points where a distance is taken may be off by, in parts of M, the largest |coordinate|
/// of the two triangles: each of its triangle, and their separation of the distance.
struct WitnessErrors {
    double of_point;
    double of_separation;
    double size = 0; ///< M is at least this
};

/// What kernels promise (distance_kernel.h); where the two cross, separations are ill-conditioned.
constexpr WitnessErrors promised_witnesses(bool touch) {
    return {0x1p-44, touch ? 0x1p-22 : 0x1p-44};
}

/// What is wrong with points that are said to be lo to hi apart, one on each of two triangles, in
/// rational arithmetic; nothing if they are right.
std::string witness_fault(Vec3<double> point_a, Vec3<double> point_b, const Triangle<double>& a,
                          const Triangle<double>& b, double lo, double hi, WitnessErrors errors);

} // namespace boxwood::bench
