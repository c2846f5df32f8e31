#pragma once

#include "kernels/ray_triangle/ray_kernel.h"
#include "kernels/triangle_distance/distance_kernel.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

/// The oracle as the last rung of each ladder. Unlike the kernels it allocates. Finite input of any
/// size gives the truth, in flush-to-zero modes too; NaN or infinity in: maybe, NaN, a miss.
namespace boxwood::oracle {

constexpr KernelInfo rational_rung(std::string_view family, std::string_view summary) {
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
        rational_rung("triangle_triangle", "edges against triangles in whole numbers (GMP)");
    static constexpr std::string_view name = info.name;

    static Verdict intersect(const Triangle<double>& a, const Triangle<double>& b);
};

/// `distance` is the double nearest to the true one, lo and hi the two around it (all three the
/// same if it is a double), the witnesses each the nearest to a point where it is taken.
struct RationalTriangleDistance {
    using Real = double;
    static constexpr KernelInfo info =
        rational_rung("triangle_distance",
                      "least of 42 pairs of features in whole numbers, 0 if an edge crosses");
    static constexpr std::string_view name = info.name;

    static Distance distance(const Triangle<double>& a, const Triangle<double>& b);
};
struct RationalSegmentDistance {
    using Real = double;
    static constexpr KernelInfo info =
        rational_rung("segment_segment", "least of 9 pairs of features in whole numbers");
    static constexpr std::string_view name = info.name;

    static Distance distance(const Segment<double>& a, const Segment<double>& b);
};
struct RationalPointTriangle {
    using Real = double;
    static constexpr KernelInfo info =
        rational_rung("point_triangle", "least of 7 pairs of features in whole numbers");
    static constexpr std::string_view name = info.name;

    static Distance distance(Vec3<double> a, const Triangle<double>& b);
};
struct RationalPointSegment {
    using Real = double;
    static constexpr KernelInfo info =
        rational_rung("point_segment", "least of 3 pairs of features in whole numbers");
    static constexpr std::string_view name = info.name;

    static Distance distance(Vec3<double> a, const Segment<double>& b);
};

/// t, u and v are the floats nearest to the true ones, t perhaps infinite; the limits are held
/// against the true t.
struct RationalRays {
    static constexpr KernelInfo info =
        rational_rung("ray_triangle", "plane and three edges in whole numbers (GMP)");
    static constexpr std::string_view name = info.name;

    struct PerRay {};
    static PerRay prepare(const Ray<float>&) { return {}; }
    static bool intersect(PerRay, const Ray<float>& ray, const Triangle<float>& triangle,
                          float t_max, RayHit& hit);
};

} // namespace boxwood::oracle
