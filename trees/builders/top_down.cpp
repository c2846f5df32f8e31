#include "trees/builders/top_down.h"

namespace boxwood {
namespace {

/// The lower half of the centres along an axis goes first; ties by item, so the halves are unique.
template <int axis> std::size_t halve(std::span<Prim> prims) {
    const auto middle = static_cast<std::ptrdiff_t>(prims.size() / 2);
    std::nth_element(prims.begin(), prims.begin() + middle, prims.end(),
                     [](const Prim& a, const Prim& b) {
                         const float x = a.centre(axis), y = b.centre(axis);
                         return x < y || (x == y && a.item < b.item);
                     });
    return static_cast<std::size_t>(middle);
}

} // namespace

std::size_t split_median(std::span<Prim> prims) {
    Box centres;
    for (const Prim& p : prims)
        centres.extend(Vec3<float>{p.centre(0), p.centre(1), p.centre(2)});
    // Halved: the spread of finite centres can overflow.
    const Vec3<float> half = centres.max * .5f - centres.min * .5f;
    const int axis = half.x >= half.y && half.x >= half.z ? 0 : half.y >= half.z ? 1 : 2;
    return axis == 0 ? halve<0>(prims) : axis == 1 ? halve<1>(prims) : halve<2>(prims);
}

} // namespace boxwood
