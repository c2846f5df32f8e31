#pragma once

#include "bench/grading/node_table.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace boxwood::bench {

/// Of large trees every so many-th item stands for all: 2000 or more of them.
constexpr std::size_t epo_step(std::size_t n_items) { return n_items < 4000 ? 1 : n_items / 2000; }

/// How good a tree is, apart from any clock: the same for anybody's.
struct Grade {
    std::uint64_t n_nodes = 0, depth = 0;
    double items_per_leaf = 0;
    /// Of a random line that meets the box of all items, were that the root: the nodes that it
    /// meets, of those with children, and the items of the nodes that it meets.
    double sah_visits = 0, sah_tests = 0;
    double sah() const { return sah_visits + sah_tests; }
    /// Of all item surface (of every epo_step-th) the part that lies in nodes that the item is not
    /// below, summed over the nodes; Aila, Karras and Laine 2013.
    double epo = 0;
    /// A mean query: nodes whose box is met, and boxes of nodes and items that are compared.
    struct Counted {
        double visits = 0, tests = 0;
    };
    Counted pairs, points, rays;
};

/// Nothing if each node holds what is below it; else which does not.
std::optional<std::string> fault_of(const NodeTable& tree);

/// Of a tree without fault. Points and rays are drawn at random in the box of all items, the same
/// for every tree of them.
Grade grade(const NodeTable& tree, std::uint64_t seed = 1);

} // namespace boxwood::bench
