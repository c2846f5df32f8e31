#pragma once

#include "kernels/primitives/vec3.h"

namespace boxwood {

/// A closed ball: every point at most `radius` from the centre, scene units, radius >= 0.
template <class Real> struct Sphere {
    Vec3<Real> centre;
    Real radius;
};

} // namespace boxwood
