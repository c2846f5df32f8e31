#pragma once

#include "bench/tasks/detail/kernel_task.h"
#include "kernels/convex/signed_distance.h"

#include <algorithm>
#include <vector>

namespace boxwood::bench {

/// Our distance of two convex shapes, signed or not, at two tolerances: as it comes, and about the
/// 1e-6 at which FCL, Coal and Bullet end.
template <bool is_signed> struct ShapeDistance {
    using Real = double;
    static constexpr std::string_view family =
        is_signed ? "signed_shape_distance" : "shape_distance";
    static constexpr KernelInfo info{
        family,
        "certified",
        "closed forms where there are some, else GJK, and an expanding polytope for depth",
        Promise::certified,
        convex::gjk_epa_info.bound,
        convex::gjk_epa_info.cost};
    static constexpr convex::Tolerance tolerance{};
};
template <bool is_signed> struct CoarseShapeDistance {
    using Real = double;
    static constexpr KernelInfo info{ShapeDistance<is_signed>::family,
                                     "certified_coarse",
                                     "the same until [lo, hi] is 2^-20 of the distance wide",
                                     Promise::certified,
                                     "lo <= signed distance <= hi, width 2^-20 of hi",
                                     convex::gjk_epa_info.cost};
    static constexpr convex::Tolerance tolerance{0x1p-20, 0};
};

/// Of the two kernels.
template <bool is_signed> std::vector<CaseKernel> shape_distance_kernels() {
    using Kernels = std::tuple<ShapeDistance<is_signed>, CoarseShapeDistance<is_signed>>;
    return all_kernels<Kernels>([]<class K>(std::type_identity<K>) {
        return scalar_kernel<K, ShapePairCase, ShapePairCase>([](const ShapePairCase& c) {
            const convex::SignedDistance d =
                convex::signed_distance(c.a.shape, c.a.pose, c.b.shape, c.b.pose, K::tolerance);
            const auto as_wanted = [](double x) { return is_signed ? x : std::max(x, 0.0); };
            return Distance{
                as_wanted(d.distance), as_wanted(d.lo), as_wanted(d.hi), d.point_a, d.point_b, 0};
        });
    });
}

} // namespace boxwood::bench
