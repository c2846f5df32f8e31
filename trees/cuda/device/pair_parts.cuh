#pragma once

#include "trees/cuda/queries/binary_pairs.cuh"
#include "trees/cuda/queries/packed_pairs.cuh"

#include <algorithm>
#include <vector>

namespace boxwood::cuda {

__global__ void subtract(std::uint64_t* from, std::uint64_t what, std::size_t n) {
    const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
    if (i < n)
        from[i] -= what;
}

/// Leaves in a row, and the pairs before those of the first and after those of the last.
struct PairPart {
    std::uint32_t first_leaf, end_leaf;
    std::uint64_t first_pair, end_pair;
};

/// Parts of at most `room` pairs each, or of one leaf that has more. at[leaf] pairs come before
/// those of the leaf; the last entry is how many there are.
inline std::vector<PairPart> cut_into_parts(std::span<const std::uint64_t> at, std::uint64_t room) {
    std::vector<PairPart> parts;
    for (auto first = at.begin(); first + 1 != at.end();) {
        const auto end = std::max(first + 1, std::upper_bound(first, at.end(), *first + room) - 1);
        parts.push_back({static_cast<std::uint32_t>(first - at.begin()),
                         static_cast<std::uint32_t>(end - at.begin()), *first, *end});
        first = end;
    }
    return parts;
}

/// The pairs of the leaves of one part, each from its place on.
template <bool is_self>
void fill_leaves(const PackedView& a, const PackedView& b, const PairsTo& to, const PairPart& part,
                 Stream stream) {
    launch(stream, blocks_for(part.end_leaf - part.first_leaf, pair_warps), pair_threads,
           packed_pairs<is_self, Pass::fill>, a, b, to, part.first_leaf, part.end_leaf);
}
template <bool is_self>
void fill_leaves(const RadixTreeView& a, const RadixTreeView& b, const PairsTo& to,
                 const PairPart& part, Stream stream) {
    launch(stream, blocks_for(part.end_leaf - part.first_leaf, radix_threads), radix_threads,
           radix_pairs<is_self, Pass::fill, Traversal::stack>, a, b, to, part.first_leaf,
           part.end_leaf);
}
template <bool is_self>
void fill_leaves(const BinaryTree& a, const BinaryTree& b, const PairsTo& to, const PairPart& part,
                 Stream stream) {
    launch(stream, blocks_for(part.end_leaf - part.first_leaf, radix_threads), radix_threads,
           binary_pairs<is_self, Pass::fill>, a, b, to, part.first_leaf, part.end_leaf);
}

/// The pairs of one part, into an array of that many. at[leaf] of its leaves is changed.
template <bool is_self, class View>
void fill_part(const View& a, const View& b, const PairPart& part, std::uint64_t* at, Pair* pairs,
               Stream stream) {
    const std::size_t n = part.end_leaf - part.first_leaf;
    if (part.first_pair > 0)
        launch(stream, blocks_for(n, pair_threads), pair_threads, subtract, at + part.first_leaf,
               part.first_pair, n);
    fill_leaves<is_self>(a, b, PairsTo{at, pairs, 0}, part, stream);
}

} // namespace boxwood::cuda
