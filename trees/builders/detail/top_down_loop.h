#pragma once

#include "trees/executor.h"

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace boxwood::detail {

/// A part of m items to build a subtree of: it fills nodes [node, node + 2 m - 1) and slots
/// [first, first + m), so that subtrees are built in any order, on any thread, with no atomics.
struct Subtree {
    std::uint32_t node, first, count, depth;
};

/// The two parts that a part is split into.
template <class Part> struct Halves { Part left, right; };

/// Those of a part of which `n_left` items go left.
inline Halves<Subtree> children_of(const Subtree& part, std::uint32_t n_left) {
    return {{part.node + 1, part.first, n_left, part.depth + 1},
            {part.node + 2 * n_left, part.first + n_left, part.count - n_left, part.depth + 1}};
}

/// What makes a top-down builder of the loop below: how a part is split, and where that ends.
/// `split` writes the part's node, puts the items of each child where they belong and returns the
/// children; `finish` writes the whole subtree of a part that is not split further; `build` is
/// { build_below(*this, part); }, which compiles the loop for the instruction set of the splitter.
/// `split_level(parts, children)`, if there is one, splits many large parts on all threads.
template <class S>
concept Splitter = std::derived_from<typename S::Part, Subtree> &&
    requires(S splitter, const typename S::Part& part) {
    { splitter.is_split(part) } -> std::same_as<bool>;
    { splitter.split(part) } -> std::same_as<Halves<typename S::Part>>;
    splitter.finish(part);
    splitter.build(part);
};

/// Builds the subtree of a part on this thread.
template <Splitter S>
[[gnu::always_inline]] inline void build_below(S& splitter, const typename S::Part& root) {
    // The smaller child is taken at once and the larger waits, so 32 entries always suffice.
    typename S::Part waiting[32];
    std::size_t n_waiting = 0;
    typename S::Part part = root;
    for (;;) {
        if (splitter.is_split(part)) {
            const auto [left, right] = splitter.split(part);
            if (left.count <= right.count) {
                waiting[n_waiting++] = right;
                part = left;
            } else {
                waiting[n_waiting++] = left;
                part = right;
            }
            continue;
        }
        splitter.finish(part);
        if (n_waiting == 0)
            break;
        part = waiting[--n_waiting];
    }
}

/// The loop of every top-down builder. With several threads the top of the tree is split a level
/// at a time until no part has more than `enough` items or lies deeper than `max_depth`; these
/// parts are then built side by side, the largest first.
template <Splitter S>
void build_by_splitter(S& splitter, const typename S::Part& root, const Executor& executor,
                       std::size_t enough,
                       std::uint32_t max_depth = std::numeric_limits<std::uint32_t>::max()) {
    using Part = typename S::Part;
    std::vector<Part> parts, frontier{root}, large;
    if (executor.threads() == 1)
        parts.swap(frontier);
    std::vector<Halves<Part>> children;
    while (!frontier.empty()) {
        large.clear();
        for (const Part& part : frontier)
            (part.count > enough && part.depth <= max_depth ? large : parts).push_back(part);
        children.resize(large.size());
        if constexpr (requires { splitter.split_level(large, children); })
            splitter.split_level(large, children);
        else
            executor.for_each(large.size(),
                              [&](std::size_t i) { children[i] = splitter.split(large[i]); });
        frontier.clear();
        for (const auto& [left, right] : children) {
            frontier.push_back(left);
            frontier.push_back(right);
        }
    }
    std::ranges::sort(parts, std::ranges::greater{}, &Part::count);
    executor.for_each(parts.size(), [&](std::size_t i) { splitter.build(parts[i]); });
}

} // namespace boxwood::detail
