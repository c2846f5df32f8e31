// Compile-only: the least type that satisfies each concept of kernels, and that nothing less does.

#include "kernels/kernels.h"

#include <gtest/gtest.h>

namespace boxwood {
namespace {

struct Described {
    using Real = double;
    static constexpr std::string_view name = "least";
    static constexpr KernelInfo info{"family", name, "says no", Promise::never_false};
};
static_assert(DescribedKernel<Described>);

/// Its promise is not known at compile time.
struct DescribedAtRunTime {
    static constexpr std::string_view name = "late";
    static inline KernelInfo info{"family", name, "says no", Promise::exact};
};
static_assert(!DescribedKernel<DescribedAtRunTime>);
struct Nameless {
    static constexpr KernelInfo info = Described::info;
};
static_assert(!DescribedKernel<Nameless>);

struct Triangles : Described {
    static Decision intersect(const Triangle<double>&, const Triangle<double>&) { return {}; }
};
static_assert(TriangleKernel<Triangles> && !TriangleBatchKernel<Triangles>);
struct BoolTriangles : Described {
    static bool intersect(const Triangle<double>&, const Triangle<double>&) { return false; }
};
static_assert(!TriangleKernel<BoolTriangles> && !TriangleKernel<Described>);
struct UndescribedTriangles {
    using Real = double;
    static Decision intersect(const Triangle<double>&, const Triangle<double>&) { return {}; }
};
static_assert(!TriangleKernel<UndescribedTriangles>);
struct TriangleBatch : Triangles {
    using Triangles::intersect;
    static void intersect(std::span<const TrianglePairBlock<double>>, std::span<Decision>) {}
};
static_assert(TriangleBatchKernel<TriangleBatch>);

template <class A, class B> struct DistanceOf : Described {
    static Distance distance(const A&, const B&) { return {}; }
};
using P = Vec3<double>;
using S = Segment<double>;
using T = Triangle<double>;
static_assert(TriangleDistanceKernel<DistanceOf<T, T>> && SegmentDistanceKernel<DistanceOf<S, S>> &&
              PointTriangleKernel<DistanceOf<P, T>> && PointSegmentKernel<DistanceOf<P, S>>);
static_assert(!TriangleDistanceKernel<DistanceOf<S, S>> && !SegmentDistanceKernel<Described> &&
              !PointTriangleKernel<DistanceOf<P, S>> && !PointSegmentKernel<DistanceOf<P, T>> &&
              !TriangleDistanceBatchKernel<DistanceOf<T, T>>);

struct Rays : Described {
    struct PerRay {};
    static PerRay prepare(const Ray<float>&) { return {}; }
    static bool intersect(PerRay, const Ray<float>&, const Triangle<float>&, float, RayHit&) {
        return false;
    }
};
static_assert(RayKernel<Rays> && !RayKernel<Described>);

struct Slabs : Described {
    explicit Slabs(const Ray<float>&) {}
};
RaySpan clip(const Slabs&, const Aabb<float>&, float t_min, float t_max) { return {t_min, t_max}; }
static_assert(RayBoxKernel<Slabs> && !RayBoxKernel<Described>);

struct Fit : Described {
    static Aabb<double> fit(const RigidTransform<double>&, const Aabb<double>& box) { return box; }
};
static_assert(BoxFitKernel<Fit> && !BoxFitKernel<Described>);

struct Obbs : Described {
    static Decision overlap(const Obb<double>&, const Obb<double>&) { return {}; }
};
static_assert(ObbKernel<Obbs> && !ObbKernel<Described>);

struct Motions {
    static constexpr std::string_view name = "least";
    static constexpr KernelInfo vertex_face_info = Described::info,
                                edge_edge_info = Described::info;
    Impact vertex_face(const LinearMotion&) const { return {}; }
    Impact edge_edge(const LinearMotion&) const { return {}; }
};
static_assert(ContinuousKernel<Motions> && !ContinuousKernel<Described>);

TEST(Contracts, HoldAtCompileTime) {
    EXPECT_EQ(clip(Slabs(Ray<float>{}), {}, 1, 2).exit, 2);
    EXPECT_EQ(Triangles::intersect({}, {}).answer, Answer::no);
}

} // namespace
} // namespace boxwood
