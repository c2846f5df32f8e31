#pragma once

#include "kernels/continuous/continuous_kernel.h"
#include "kernels/ray_triangle/ray_kernel.h"
#include "kernels/triangle_distance/distance_kernel.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

/// The oracle as kernels, the most accurate of each family. Unlike the kernels it allocates. Finite
/// input of any size gives the truth, in flush-to-zero modes too; NaN or infinity in: maybe, NaN, a
/// miss.
namespace boxwood::oracle {

constexpr KernelInfo rational_kernel(std::string_view family, std::string_view summary) {
    return {family,
            "rational",
            summary,
            Promise::exact,
            "0: whole numbers of any length",
            "rational: microseconds, allocates"};
}

struct RationalTriangles {
    using Real = double;
    static constexpr KernelInfo info =
        rational_kernel("triangle_triangle", "edges against triangles in whole numbers (GMP)");
    static constexpr std::string_view name = info.name;

    static Decision intersect(const Triangle<double>& a, const Triangle<double>& b);
};

/// `distance` is the double nearest to the true one, lo and hi the two around it (all three the
/// same if it is a double), the witnesses each the nearest to a point where it is taken.
struct RationalTriangleDistance {
    using Real = double;
    static constexpr KernelInfo info =
        rational_kernel("triangle_distance",
                        "least of 42 pairs of features in whole numbers, 0 if an edge crosses");
    static constexpr std::string_view name = info.name;

    static Distance distance(const Triangle<double>& a, const Triangle<double>& b);
};
struct RationalSegmentDistance {
    using Real = double;
    static constexpr KernelInfo info =
        rational_kernel("segment_segment", "least of 9 pairs of features in whole numbers");
    static constexpr std::string_view name = info.name;

    static Distance distance(const Segment<double>& a, const Segment<double>& b);
};
struct RationalPointTriangle {
    using Real = double;
    static constexpr KernelInfo info =
        rational_kernel("point_triangle", "least of 7 pairs of features in whole numbers");
    static constexpr std::string_view name = info.name;

    static Distance distance(Vec3<double> a, const Triangle<double>& b);
};
struct RationalPointSegment {
    using Real = double;
    static constexpr KernelInfo info =
        rational_kernel("point_segment", "least of 3 pairs of features in whole numbers");
    static constexpr std::string_view name = info.name;

    static Distance distance(Vec3<double> a, const Segment<double>& b);
};

/// t, u and v are the floats nearest to the true ones; the limits are held against the true t.
struct RationalRays {
    static constexpr KernelInfo info =
        rational_kernel("ray_triangle", "plane and three edges in whole numbers (GMP)");
    static constexpr std::string_view name = info.name;

    struct PerRay {};
    static PerRay prepare(const Ray<float>&) { return {}; }
    static bool intersect(PerRay, const Ray<float>& ray, const Triangle<float>& triangle,
                          float t_max, RayHit& hit);
};

/// The ContinuousKernel that is the truth for the others (continuous.h). NaN or infinity: maybe.
struct ExactContinuous {
    static constexpr std::string_view name = "exact";
    static constexpr KernelInfo vertex_face_info{
        "vertex_face",
        name,
        "coplanarity cubic over the integers, roots isolated, inside test by signs at the roots",
        Promise::exact,
        "no rounding; the touch is bracketed by neighbouring doubles",
        "GMP integers: microseconds, milliseconds where coordinates span hundreds of octaves"};
    static constexpr KernelInfo edge_edge_info{"edge_edge",
                                               name,
                                               vertex_face_info.summary,
                                               vertex_face_info.promise,
                                               vertex_face_info.bound,
                                               vertex_face_info.cost};

    Impact vertex_face(const LinearMotion& motion) const;
    Impact edge_edge(const LinearMotion& motion) const;
};

} // namespace boxwood::oracle
