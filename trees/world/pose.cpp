#include "trees/world/pose.h"

#include "kernels/primitives/coordinate_limit.h"

#include <sstream>
#include <stdexcept>

namespace boxwood {

Pose checked_pose(const Pose& pose) {
    constexpr double permitted = 1e-3;
    for (const Vec3<double>& row : pose.rotation)
        if (!is_finite(row))
            throw std::invalid_argument("a pose has a rotation with a number that is not finite");
    if (!is_in_range(pose.translation))
        throw std::invalid_argument("a pose has a translation that is not finite or beyond 2^60");
    Pose checked = pose;
    auto& r = checked.rotation;
    if (!(distance_from_orthonormal(r) <= permitted))
        throw std::invalid_argument("a pose is no rigid transform: its matrix is off a rotation by "
                                    "more than 1e-3 (rows must be of length 1 and at right angles; "
                                    "put a scale into the mesh)");
    if (dot(cross(r[0], r[1]), r[2]) < 0)
        throw std::invalid_argument("a pose is a reflection, not a rotation: mirror the mesh");
    for (int step = 0; step < 4 && distance_from_orthonormal(r) > 0x1p-51; ++step)
        r = orthonormalised(r);
    return checked;
}

Pose pose_of_matrix(std::span<const double, 16> m) {
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
        std::ostringstream what;
        what << "the last row is " << m[12] << "," << m[13] << "," << m[14] << "," << m[15]
             << "; that of a rigid transform is 0,0,0,1 (the numbers go row by row)";
        throw std::invalid_argument(what.str());
    }
    Pose pose;
    for (std::size_t i = 0; i < 3; ++i) {
        pose.rotation[i] = {m[4 * i], m[4 * i + 1], m[4 * i + 2]};
        pose.translation[static_cast<int>(i)] = m[4 * i + 3];
    }
    return checked_pose(pose);
}

Pose relative_pose(const Pose& a, const Pose& b) {
    const auto& [r0, r1, r2] = a.rotation;
    const Vec3<double> column[3] = {{r0.x, r1.x, r2.x}, {r0.y, r1.y, r2.y}, {r0.z, r1.z, r2.z}};
    const Vec3<double> apart = b.translation - a.translation;
    Pose relative;
    for (std::size_t i = 0; i < 3; ++i) {
        relative.rotation[i] =
            column[i].x * b.rotation[0] + column[i].y * b.rotation[1] + column[i].z * b.rotation[2];
        relative.translation[static_cast<int>(i)] = dot(column[i], apart);
    }
    return relative;
}

} // namespace boxwood
