#pragma once

#include "kernels/primitives/sphere.h"
#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/layouts/layouts.h"
#include "trees/queries/sinks.h"
#include "trees/traversals/chunk_sink.h"
#include "trees/tree.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

namespace boxwood::detail {

/// Queries of one kind: the others are empty.
struct RegionQueries {
    std::span<const Vec3<float>> points{};
    std::span<const Box> boxes{};
    std::span<const Sphere<float>> spheres{};

    std::size_t size() const { return points.size() + boxes.size() + spheres.size(); }
};

/// A region as traversals take it: a finite closed box that finite boxes overlap if and only if
/// they share a point with the region. Nothing if no finite box does: a NaN, or min > max.
inline std::optional<Box> finite_region(const Box& region) {
    constexpr float max_float = std::numeric_limits<float>::max();
    Box box = region;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(region.min[axis] <= region.max[axis]) || region.min[axis] > max_float ||
            region.max[axis] < -max_float)
            return std::nullopt;
        box.min[axis] = std::max(region.min[axis], -max_float);
        box.max[axis] = std::min(region.max[axis], max_float);
    }
    return box;
}
inline std::optional<Box> finite_region(Vec3<float> point) {
    return is_finite(point) ? std::optional(Box{point, point}) : std::nullopt;
}
/// Whether a ball holds any point: its centre finite and its radius neither NaN nor below 0.
inline bool is_region(const Sphere<float>& ball) {
    return is_finite(ball.centre) && ball.radius >= 0;
}

/// Queries are answered by so many at a time, whatever runs them.
inline constexpr std::size_t queries_per_chunk = 256;

/// Calls body(chunk, first, last) for the queries [first, last) of each chunk of n.
template <class Body>
void for_query_chunks(std::size_t n, const Executor& executor, const Body& body) {
    executor.for_each((n + queries_per_chunk - 1) / queries_per_chunk, [&](std::size_t chunk) {
        body(chunk, chunk * queries_per_chunk, std::min(n, (chunk + 1) * queries_per_chunk));
    });
}

/// The answers of one chunk on their way to a sink, and the memory that its traversals share.
class RegionTraversal {
  public:
    /// A SIMD store may touch so many entries beyond those that count.
    static constexpr std::size_t spare = 16;

    /// stack_room: the most references that wait on the stack of one traversal.
    RegionTraversal(PairSink& sink, std::size_t chunk, std::size_t stack_room,
                    std::atomic<bool>& stop, Work* work)
        : to_(sink, chunk, stop, work), work_(work), stack_(stack_room + spare) {}

    std::uint32_t* stack() { return stack_.data(); }
    /// Room for `spare` more items.
    std::uint32_t* items_to() {
        if (n_items_ + 2 * spare > items_.size())
            grow();
        return items_.data() + n_items_;
    }
    void found(std::size_t n) { n_items_ += n; }
    /// The items of the query at hand, `spare` of room behind them.
    std::span<std::uint32_t> items() {
        items_to();
        return {items_.data(), n_items_};
    }

    /// Hands over the items of a query, which are in order now, and forgets them; false once the
    /// sink has had enough.
    bool answer(std::uint32_t query) {
        for (std::size_t i = 0; i < n_items_;) {
            const std::size_t n = std::min(n_items_ - i, out_.size() - n_out_);
            for (std::size_t j = 0; j < n; ++j)
                out_[n_out_ + j] = {query, items_[i + j]};
            n_out_ += n;
            i += n;
            if (n_out_ == out_.size() && !flush())
                return false;
        }
        n_items_ = 0;
        return !to_.stopped();
    }

    /// Hands the answers over; false once the sink has had enough.
    bool flush() {
        const bool more = to_.take({out_.data(), n_out_});
        n_out_ = 0;
        return more;
    }

    bool counted() const { return work_ != nullptr; }
    /// One node opened with `box_tests` tests, `stack` references waiting; compiled away unless
    /// Counted.
    template <bool Counted> void count(std::uint64_t box_tests, std::size_t stack) {
        if constexpr (Counted) {
            ++work_->node_visits;
            work_->box_tests += box_tests;
            work_->stack_max = std::max<std::uint64_t>(work_->stack_max, stack);
        }
    }

  private:
    void grow() {
        Buffer<std::uint32_t> larger(2 * items_.size());
        std::copy_n(items_.data(), n_items_, larger.data());
        items_ = std::move(larger);
    }

    ChunkSink to_;
    Work* work_;
    Buffer<std::uint32_t> stack_, items_{1024};
    Buffer<Pair> out_{4096};
    std::size_t n_items_ = 0, n_out_ = 0;
};

/// Runs `traverse(RegionTraversal&, first, last)` on the n queries, chunk by chunk, into the sink.
template <class Traverse>
void run_regions(std::size_t n, std::size_t stack_room, const Executor& executor, PairSink& sink,
                 Work* work, const Traverse& traverse) {
    std::atomic<bool> stop = false;
    sink.begin((n + queries_per_chunk - 1) / queries_per_chunk, executor.threads() == 1);
    for_query_chunks(n, executor, [&](std::size_t chunk, std::size_t first, std::size_t last) {
        if (stop.load(std::memory_order_relaxed))
            return;
        RegionTraversal state(sink, chunk, stack_room, stop, work);
        traverse(state, first, last);
        state.flush();
    });
    sink.end();
}

/// The most references that wait in one traversal: opening a node leaves all but one of its
/// children.
template <class L> std::size_t stack_room(const L& layout) {
    if constexpr (requires { L::width; })
        return layout.depth() * L::width + L::width;
    else
        return 2 * layout.depth() + 2;
}

/// Answers the queries [first, last) of one chunk, over a layout that is not empty.
#define X(name, L)                                                                                 \
    void traverse_regions(const L& layout, const RegionQueries& queries,                           \
                          RegionTraversal& traversal, std::size_t first, std::size_t last);
BOXWOOD_SEARCHED_TREES(X)
#undef X

} // namespace boxwood::detail
