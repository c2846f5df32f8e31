#include "trees/builders/median.h"
#include "trees/builders/top_down.h"

namespace boxwood {

std::size_t split_median(std::span<Prim> prims) {
    Box centres;
    for (const Prim& p : prims)
        centres.extend(Vec3<float>{p.centre(0), p.centre(1), p.centre(2)});
    // Halved: the spread of finite centres can overflow.
    const Vec3<float> half = centres.max * .5f - centres.min * .5f;
    const int axis = half.x >= half.y && half.x >= half.z ? 0 : half.y >= half.z ? 1 : 2;
    const std::size_t middle = prims.size() / 2;
    std::nth_element(prims.begin(), prims.begin() + static_cast<std::ptrdiff_t>(middle),
                     prims.end(), [axis](const Prim& a, const Prim& b) {
                         const float x = a.centre(axis), y = b.centre(axis);
                         return x < y || (x == y && a.item < b.item);
                     });
    return middle;
}

Tree MedianBuilder::build(Boxes boxes, const Executor& executor) const {
    return build_top_down(boxes, executor, split_median);
}

BuilderEntry median_builder() { return builder_entry<MedianBuilder>(); }

} // namespace boxwood
