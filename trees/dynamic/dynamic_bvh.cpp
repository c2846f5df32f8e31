#include "trees/dynamic/dynamic_bvh.h"

#include "kernels/ray_box/slabs.h"
#include "trees/layouts/detail/model.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace boxwood {

DynamicBvh::DynamicBvh(const DynamicBvhOptions& options)
    : BoxQueries(nullptr, detail::executor_of(options.executor, options.threads)),
      tree_(std::make_unique<DynamicTree>()) {
    layout_ = std::make_unique<LayoutModel<DynamicTree, std::reference_wrapper<const DynamicTree>>>(
        *tree_);
}

DynamicBvh::DynamicBvh(Boxes boxes, const DynamicBvhOptions& options) : DynamicBvh(options) {
    require_valid(boxes);
    reserve(boxes.size());
    for (std::uint32_t item = 0; item < boxes.size(); ++item)
        insert(item, boxes[item]);
}

std::vector<std::uint32_t> DynamicBvh::meeting(const Ray<float>& ray) const {
    std::vector<std::uint32_t> items;
    meeting(ray, [&](std::uint32_t item, const Ray<float>& left) {
        items.push_back(item);
        return left.t_max;
    });
    std::ranges::sort(items);
    return items;
}

void DynamicBvh::meeting(const Ray<float>& ray,
                         FunctionRef<float(std::uint32_t, const Ray<float>&)> visit) const {
    if (empty() || !is_finite(ray.origin) || !is_finite(ray.direction))
        return;
    struct Waiting {
        float entry;
        std::uint32_t node;
    };
    std::array<Waiting, 112> stack; // one to a level, of at most 105: DynamicTree::height
    std::size_t top = 0;
    const RaySlabs slabs(ray);
    Ray<float> left = ray;
    const auto wait = [&](const RaySpan& span, std::uint32_t node) {
        if (span.hit())
            stack[top++] = {span.entry, node};
    };
    const auto clipped = [&](std::uint32_t node) {
        return clip(slabs, tree_->bounds(node), left.t_min, left.t_max);
    };
    wait(clipped(0), 0);
    while (top != 0) {
        const auto [entry, node] = stack[--top];
        if (entry > left.t_max)
            continue;
        if (tree_->is_leaf(node)) {
            left.t_max = std::min(left.t_max, visit(tree_->item(node), std::as_const(left)));
            continue;
        }
        const std::uint32_t a = tree_->left(node), b = tree_->right(node);
        const RaySpan span_a = clipped(a), span_b = clipped(b);
        const bool a_first = span_a.entry <= span_b.entry;
        wait(a_first ? span_b : span_a, a_first ? b : a);
        wait(a_first ? span_a : span_b, a_first ? a : b);
    }
}

} // namespace boxwood
