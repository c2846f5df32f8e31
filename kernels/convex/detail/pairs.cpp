#include "kernels/convex/detail/pairs.h"

namespace boxwood::convex::detail {

SignedDistance no_distance() {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan, {nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan}};
}

SignedDistance of_odd_size(double size, double lack, double radius, const Pose& a) {
    if (!(lack <= max_defect) || !(size >= 0 && size < inf))
        return no_distance();
    if (size == 0)
        return {0, 0, 0, a.translation, a.translation, {0, 0, 1}};
    const double most = 2 * (size + radius);
    return {0, -most, most, a.translation, a.translation, {0, 0, 1}};
}

SignedDistance flats_distance(const HalfSpace& a, bool a_is_plane, const Pose& pose_a,
                              const HalfSpace& b, bool b_is_plane, const Pose& pose_b) {
    const UnitFlat unit_a = unit_flat(a), unit_b = unit_flat(b);
    const V n = times(pose_a.rotation, unit_a.normal);
    const V m = times(pose_b.rotation, unit_b.normal);
    const double lack = defect(pose_a.rotation) + defect(pose_b.rotation);
    const V between = pose_b.translation - pose_a.translation;
    const double size = norm1(between) + std::abs(unit_a.offset) + std::abs(unit_b.offset);
    if (!(lack <= max_defect) || !(size < inf) || !std::isfinite(dot(n, m)))
        return no_distance();
    const bool same_way = dot(n, m) >= 0;
    const double sign = same_way ? 1 : -1;
    const V on_a = pose_a.translation + n * unit_a.offset;
    // b's plane is this far out along n; of the two gaps along n and against it those are finite
    // that neither half-space fills.
    const double height = dot(n, between) + sign * unit_b.offset - unit_a.offset;
    const double up = same_way && !b_is_plane ? -inf : height;
    const double down = !a_is_plane || (!same_way && !b_is_plane) ? -inf : -height;
    const double d = std::max(up, down);
    if (!(d > -inf) || length(n - m * sign) > 64 * u + 2 * lack)
        return {-inf, -inf, -inf, on_a, on_a, n};
    return {d, -inf, d + distance_error(size, lack), on_a, on_a + n * height, up >= down ? n : -n};
}

bool Rods::measure(const Goal& goal, CoreDistance& found) const {
    const NearestPoints<double> near = nearest_on_segments<true>(
        Segment<double>{-half_a, half_a}, Segment<double>{b_from_a - half_b, b_from_a + half_b});
    const V v = near.a - near.b;
    found.hi = length(v);
    if (!(found.hi > touching_size(goal.size)))
        return false;
    const V n = v * (1 / found.hi);
    found.lo = -(std::abs(dot(n, half_a)) + dot(n, b_from_a) + std::abs(dot(n, half_b)));
    found.normal = -n;
    found.between = v;
    found.on_a = near.a;
    return goal.reached(found.lo, found.hi);
}

namespace {

template <std::size_t i> using ShapeAt = std::tuple_element_t<i, ShapeTypes>;

template <std::size_t i, std::size_t j>
SignedDistance distance_entry(const void* a, const Pose& pose_a, const void* b, const Pose& pose_b,
                              const Tolerance& tolerance) {
    if constexpr (i <= j)
        return measure(*static_cast<const ShapeAt<i>*>(a), pose_a,
                       *static_cast<const ShapeAt<j>*>(b), pose_b, tolerance);
    else
        return swapped(distance_entry<j, i>(b, pose_b, a, pose_a, tolerance));
}
template <std::size_t i, std::size_t j>
Decision within_entry(const void* a, const Pose& pose_a, const void* b, const Pose& pose_b,
                      double t) {
    if constexpr (i <= j)
        return decide(*static_cast<const ShapeAt<i>*>(a), pose_a,
                      *static_cast<const ShapeAt<j>*>(b), pose_b, t);
    else
        return within_entry<j, i>(b, pose_b, a, pose_a, t);
}

} // namespace

#define BOXWOOD_ROW(entry, i)                                                                      \
    &entry<i, 0>, &entry<i, 1>, &entry<i, 2>, &entry<i, 3>, &entry<i, 4>, &entry<i, 5>,            \
        &entry<i, 6>, &entry<i, 7>, &entry<i, 8>, &entry<i, 9>
#define BOXWOOD_TABLE(entry)                                                                       \
    BOXWOOD_ROW(entry, 0), BOXWOOD_ROW(entry, 1), BOXWOOD_ROW(entry, 2), BOXWOOD_ROW(entry, 3),    \
        BOXWOOD_ROW(entry, 4), BOXWOOD_ROW(entry, 5), BOXWOOD_ROW(entry, 6),                       \
        BOXWOOD_ROW(entry, 7), BOXWOOD_ROW(entry, 8), BOXWOOD_ROW(entry, 9)
static_assert(shape_kinds == 10);
DistanceOf* const distance_table[shape_kinds * shape_kinds] = {BOXWOOD_TABLE(distance_entry)};
WithinOf* const within_table[shape_kinds * shape_kinds] = {BOXWOOD_TABLE(within_entry)};
#undef BOXWOOD_TABLE
#undef BOXWOOD_ROW

} // namespace boxwood::convex::detail

namespace boxwood::convex {
namespace {

std::size_t entry_of(const Shape& a, const Shape& b) {
    return static_cast<std::size_t>(a.kind()) * shape_kinds + static_cast<std::size_t>(b.kind());
}

} // namespace

SignedDistance signed_distance(const Shape& a, const Pose& pose_a, const Shape& b,
                               const Pose& pose_b, const Tolerance& tolerance) {
    return detail::distance_table[entry_of(a, b)](a.address(), pose_a, b.address(), pose_b,
                                                  tolerance);
}
Decision within(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, double t) {
    return detail::within_table[entry_of(a, b)](a.address(), pose_a, b.address(), pose_b, t);
}
Decision collide(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
    return within(a, pose_a, b, pose_b, 0);
}

} // namespace boxwood::convex
