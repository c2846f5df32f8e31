/// Whether two convex shapes share a point.

#include "bench/tasks/detail/kernel_task.h"
#include "bench/truth/judging/verdict_truth.h"
#include "kernels/convex/signed_distance.h"

#include <algorithm>

namespace boxwood::bench {
namespace {

struct ConvexCollide {
    using Real = double;
    static constexpr KernelInfo info{
        "shape_collide",
        "certified",
        "closed forms where there are some, else GJK until yes or no is proven",
        Promise::certified,
        "maybe within rounding of a touch: about 2e-14 of the size of all",
        convex::gjk_epa_info.cost};
};

bool shapes_touch(const ShapePairCase& c) { return c.hi < 0; }
double gap_or_depth(const ShapePairCase& c) {
    return std::max(c.lo, -c.hi) / (size_of(c.a) + size_of(c.b));
}

} // namespace

const Task& shape_collide_task() {
    static const KernelTaskOf<Decision, std::vector<ShapePairCase>> task(
        "shape_collide", "of each case: whether two convex shapes share a point",
        {scalar_kernel<ConvexCollide, ShapePairCase, ShapePairCase>([](const ShapePairCase& c) {
            return convex::collide(c.a.shape, c.a.pose, c.b.shape, c.b.pose);
        })},
        [](const CaseScene& scene) {
            return make_verdict_truth<ShapePairCase>(scene, shapes_touch, nullptr, gap_or_depth);
        });
    return task;
}

} // namespace boxwood::bench
