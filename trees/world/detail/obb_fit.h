#pragma once

#include "kernels/primitives/aabb.h"
#include "kernels/primitives/vec3.h"
#include "trees/world/detail/obb_block.h"

#include <cstddef>
#include <span>

namespace boxwood::detail {

/// Rows of the corners of triangles, one after the other: by corner and axis. `n` floats each, and
/// up to eight more may be read behind a range.
struct CornerRows {
    const float* of[3][3];
};

/// Area, its first and its second moments (xx, xy, xz, yy, yz, zz) about a point, of some
/// triangles.
struct Moments {
    double area = 0, first[3] = {}, second[6] = {};

    void add(const Moments& other) {
        area += other.area;
        for (std::size_t k = 0; k < 3; ++k)
            first[k] += other.first[k];
        for (std::size_t k = 0; k < 6; ++k)
            second[k] += other.second[k];
    }
};

/// Of the n triangles from `first` on, their corners seen from `centre` and times `scale`. In
/// floats about the first corner, good to about 2^-20 of what they span.
Moments moments_of(const CornerRows& corners, std::size_t first, std::size_t n,
                   const Vec3<double>& centre, double scale);

/// Symmetric matrices side by side: xx, xy, xz, yy, yz, zz.
struct SymmetricRows {
    float* of[6];
};

/// Of each matrix i < n (n a multiple of 16) with a trace of about 1 its eigenvectors, as rows of
/// 9 floats, axes[k][component]; nearly orthonormal, in no order. Cyclic Jacobi rotations, matrices
/// side by side.
void principal_axes(const SymmetricRows& matrices, std::size_t n, float* const (&axes)[9]);

/// The box along `axes` (nearly orthonormal floats) around the corners [first, last), whose bounds
/// are given.
PosedBox box_along(const float (&axes)[9], const CornerRows& corners, std::size_t first,
                   std::size_t last, const Aabb<float>& bounds);

/// At least the distance of the n triangles' corners from `centre`, by less than 2^-20 of it and
/// 2^-60 too much.
double farthest_from(const float (&centre)[3], const CornerRows& corners, std::size_t n);

/// The bounds themselves.
PosedBox box_of(const Aabb<float>& bounds);

} // namespace boxwood::detail
