#include "trees/layouts/quantised8.h"
#include "trees/layouts/detail/collapse.h"
#include "trees/layouts/detail/model.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxwood {
using namespace detail;
namespace {

/// A step with which 255 steps from `low` reach `high` as QuantisedBlock decodes them. The loop
/// ends: it starts within rounding of the quotient, and each turn adds an ulp to the step.
float step_between(float low, float high) {
    float step = static_cast<float>((static_cast<double>(high) - static_cast<double>(low)) / 255);
    while (low + 255 * step < high)
        step = std::nextafter(step, std::numeric_limits<float>::infinity());
    return step;
}

/// Why a decoded box contains the exact one: on each axis the exact planes x lie between bounds.min
/// and bounds.max of the block, decode(0) = bounds.min <= x and decode(255) >= bounds.max >= x, so
/// from any guess the first loop finds a lower plane decode(q) <= x, and the second an upper one
/// decode(q) >= x, before q runs out. What they compare is what traversals decode: one product, one
/// sum, in floats, which no instruction set rounds differently. Nothing is assumed about the guess
/// or about monotony. A product may overflow: decode is then +inf, which is above every plane.
std::uint8_t steps_below(const QuantisedBlock& block, int axis, float x, double per_step) {
    const double guess =
        (static_cast<double>(x) - static_cast<double>(block.bounds.min[axis])) * per_step;
    auto q = static_cast<std::uint8_t>(std::clamp(guess, 0.0, 255.0));
    while (block.decode(axis, q) > x)
        --q;
    return q;
}
std::uint8_t steps_above(const QuantisedBlock& block, int axis, float x, double per_step) {
    const double guess =
        (static_cast<double>(x) - static_cast<double>(block.bounds.min[axis])) * per_step;
    auto q = static_cast<std::uint8_t>(std::clamp(std::ceil(guess), 0.0, 255.0));
    while (block.decode(axis, q) < x)
        ++q;
    return q;
}

} // namespace

QuantisedBlock quantised(const Box& bounds, std::span<const Box> children) {
    QuantisedBlock block{};
    block.bounds = bounds;
    block.count = static_cast<std::uint32_t>(children.size());
    for (int axis = 0; axis < 3; ++axis) {
        const float step = step_between(bounds.min[axis], bounds.max[axis]);
        block.scale[axis] = step;
        const double per_step = step > 0 ? 1 / static_cast<double>(step) : 0;
        for (std::size_t lane = 0; lane < children.size(); ++lane) {
            const Box& child = children[lane];
            block.plane[axis][lane] = steps_below(block, axis, child.min[axis], per_step);
            block.plane[3 + axis][lane] = steps_above(block, axis, child.max[axis], per_step);
        }
    }
    return block;
}

Quantised8Layout::Quantised8Layout(const Tree& tree, const Executor& executor)
    : size_(tree.size()) {
    const Collapsed collapsed = collapse<width>(tree, executor);
    const Buffer<CollapsedBlock>& from = collapsed.blocks;
    depth_ = collapsed.depth;
    if (tree.empty())
        return;
    // Inner blocks and leaves are numbered apart, each in the order of the collapsed tree.
    Buffer<std::uint32_t> ref(from.size());
    std::uint32_t inner = 0, leaves = 0, slots = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
        ref[i] = from[i].count > 0 ? inner++ : leaf_bit | leaves++;
    root_ = ref[0];
    blocks_ = Buffer<Block>(inner);
    first_slot_ = Buffer<std::uint32_t>(leaves + 1);
    for (std::size_t i = 0; i < from.size(); ++i)
        if (is_leaf(ref[i])) {
            first_slot_[index(ref[i])] = slots;
            slots += tree.nodes[from[i].node].count;
        }
    first_slot_[leaves] = slots;
    const std::size_t end_word = word_of(leaves, slots);
    words_ = Buffer<std::uint32_t>(end_word + 8);
    std::fill(words_.begin() + end_word, words_.end(), 0u);

    const auto fill_leaf = [&](std::uint32_t leaf, std::size_t node) {
        std::uint32_t* to = words_.data() + word_of(leaf, first_slot_[leaf]);
        const std::size_t n = tree.nodes[node].count, end = node + 2 * n - 1;
        for (int k = 0; k < 3; ++k) {
            to[k] = std::bit_cast<std::uint32_t>(tree.nodes[node].box.min[k]);
            to[3 + k] = std::bit_cast<std::uint32_t>(tree.nodes[node].box.max[k]);
        }
        to += 6;
        for (std::size_t i = node; i < end; ++i) {
            if (!tree.is_leaf(i))
                continue;
            for (int k = 0; k < 3; ++k) {
                const auto axis = static_cast<std::size_t>(k);
                to[axis * n] = std::bit_cast<std::uint32_t>(tree.nodes[i].box.min[k]);
                to[(3 + axis) * n] = std::bit_cast<std::uint32_t>(tree.nodes[i].box.max[k]);
            }
            to[6 * n] = tree.item(i);
            ++to;
        }
    };
    constexpr std::size_t chunk = 512;
    executor.for_each((from.size() + chunk - 1) / chunk, [&](std::size_t c) {
        const std::size_t end = std::min(from.size(), (c + 1) * chunk);
        for (std::size_t i = c * chunk; i < end; ++i) {
            if (is_leaf(ref[i])) {
                fill_leaf(index(ref[i]), from[i].node);
                continue;
            }
            Box children[width];
            for (std::uint32_t lane = 0; lane < from[i].count; ++lane)
                children[lane] = tree.nodes[from[from[i].first + lane].node].box;
            Block& block = blocks_[index(ref[i])];
            block = quantised(tree.nodes[from[i].node].box, {children, from[i].count});
            block.items = tree.nodes[from[i].node].count;
            std::copy_n(&ref[from[i].first], from[i].count, block.ref);
        }
    });
}

LayoutEntry quantised8_layout() { return layout_entry<Quantised8Layout>(); }

} // namespace boxwood
