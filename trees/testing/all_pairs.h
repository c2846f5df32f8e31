#pragma once

#include "kernels/triangle_distance/certified.h"
#include "trees/testing/test_meshes.h"
#include "trees/world/mesh_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>

namespace boxwood {

struct Bounds {
    double lo = std::numeric_limits<double>::infinity(), hi = lo;
};
/// How far two meshes are apart, by every pair of their triangles.
inline Bounds distance_of_all_pairs(const TriangleMesh& a, const TriangleMesh& b,
                                    const Pose& pose) {
    Bounds bounds;
    for (std::size_t i = 0; i < a.triangles.size(); ++i)
        for (std::size_t j = 0; j < b.triangles.size(); ++j) {
            const Distance d =
                CertifiedDistance::distance(triangle_at(a, i), triangle_at(b, j, pose));
            bounds.lo = std::min(bounds.lo, d.lo);
            bounds.hi = std::min(bounds.hi, d.hi);
        }
    return bounds;
}

inline void expect_between(const MeshDistance& got, const Bounds& truth) {
    EXPECT_LE(got.lo, truth.hi);
    EXPECT_GE(got.hi, truth.lo);
    EXPECT_LE(got.lo, got.distance);
    EXPECT_LE(got.distance, got.hi);
    EXPECT_EQ(got.hi == 0, truth.hi == 0);
    EXPECT_LE(got.hi - got.lo, got.hi * 0x1p-32 + 0x1p-1073);
}

} // namespace boxwood
