#pragma once

#include "kernels/detail/concatenated.h"
#include "kernels/predicates/filtered.h"
#include "kernels/predicates/rounded.h"
#include "kernels/triangle_triangle/detail/determinants.h"
#include "kernels/triangle_triangle/detail/interval_test.h"
#include "kernels/triangle_triangle/triangle_kernel.h"

namespace boxwood {
namespace detail {

/// How a pair gets the signs of predicates P: one sign at a time, or by determinants that share
/// their normals.
template <OrientationPredicates P> struct PairSignsOf { using type = Signs<P>; };
template <class Real> struct PairSignsOf<Rounded<Real>> { using type = Determinants<Real>; };

} // namespace detail

/// The interval test by the signs of predicates P, with their promise: 6 determinants place each
/// triangle's corners against the other's plane, 2 compare the intervals that the triangles cut out
/// of the planes' common line. Coplanar and degenerate pairs by rank.
/// Source: Guigue, Devillers 2003, "Fast and Robust Triangle-Triangle Overlap Test Using
/// Orientation Predicates".
template <OrientationPredicates P> struct GuigueDevillers {
  private:
    static constexpr std::string_view name_prefix = "guigue_devillers_";
    static constexpr std::string_view summary_prefix =
        "interval overlap on the common line by orientation signs (2003), degenerate pairs by "
        "rank: ";

  public:
    using Real = typename P::Real;
    static constexpr std::string_view name = Concatenated<name_prefix, P::name>::value;
    static constexpr KernelInfo info{
        "triangle_triangle", name,     Concatenated<summary_prefix, P::summary>::value,
        P::promise,          P::bound, P::cost};

    static Decision intersect(const Triangle<Real>& a, const Triangle<Real>& b) {
        typename detail::PairSignsOf<P>::type signs(a, b);
        return {detail::IntervalTest<decltype(signs)>::meet(signs), P::tier};
    }
};

using GuigueDevillersF32 = GuigueDevillers<Rounded<float>>;
using GuigueDevillersF64 = GuigueDevillers<Rounded<double>>;

/// The interval test on filtered determinants, with shared vertices and the bounding boxes where
/// their first bounds do not decide.
template <> struct GuigueDevillers<Filtered> {
    using Real = double;
    static constexpr std::string_view name = "guigue_devillers_filtered";
    static constexpr KernelInfo info{
        "triangle_triangle",
        name,
        "interval overlap on the common line (2003) by signs that their error bound lets stand; "
        "shared vertices and boxes before the rest",
        Filtered::promise,
        Filtered::bound,
        Filtered::cost};

    static Decision intersect(const Triangle<double>& a, const Triangle<double>& b) {
        detail::FilteredPair pair(a, b);
        return {meet(pair), 0};
    }
    /// `maybe` leaves the pair to finer tests, not always narrowed.
    static Answer meet(detail::FilteredPair& pair) {
        if (pair.parted())
            return Answer::no;
        if ((pair.sides(0).unknown() | pair.sides(1).unknown()) != 0) {
            const auto sums = pair.sums();
            const bool finite = pair.surely_finite(sums);
            if (finite && pair.share_a_vertex(sums))
                return Answer::yes;
            pair.narrow();
            if (pair.boxes_apart())
                return finite ? Answer::no : Answer::maybe;
        }
        return detail::IntervalTest<const detail::FilteredPair>::meet(pair);
    }
};
using GuigueDevillersFiltered = GuigueDevillers<Filtered>;

} // namespace boxwood
