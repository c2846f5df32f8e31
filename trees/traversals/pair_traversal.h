#pragma once

#include "trees/buffer.h"
#include "trees/executor.h"
#include "trees/traversals/chunk_sink.h"

#include <algorithm>
#include <atomic>
#include <vector>

namespace boxwood::detail {

/// What one chunk of a traversal for pairs holds: the stack of node pairs still to open (a pair of
/// equal nodes, within one tree, stands for that subtree against itself) and the answers not yet
/// handed over.
class PairTraversal {
  public:
    /// A step opens one pair of nodes and pushes or emits at most this many (16 x 16, or 16 + 120),
    /// and a SIMD store may touch this many more entries beyond.
    static constexpr std::size_t step_room = 256 + 16;

    PairTraversal(PairSink& sink, std::size_t chunk, std::atomic<bool>& stop, Work* work)
        : to_(sink, chunk, stop, work), work_(work) {}

    /// The next pair of nodes, with room made for what its step pushes and emits; false at the
    /// end, or when the sink has had enough.
    bool next(Pair& nodes) {
        if (top_ == 0)
            return false;
        nodes = stack_[--top_];
        if (top_ + step_room > stack_.size())
            grow();
        return n_out_ + step_room <= out_.size() || flush();
    }
    Pair* push_to() { return stack_.data() + top_; }
    void pushed(std::size_t n) {
        top_ += n;
        if (work_)
            work_->stack_max = std::max<std::uint64_t>(work_->stack_max, top_);
    }
    void push(Pair nodes) {
        *push_to() = nodes;
        pushed(1);
    }
    Pair* emit_to() { return out_.data() + n_out_; }
    void emitted(std::size_t n) { n_out_ += n; }
    void emit(Pair items) { out_[n_out_++] = items; }

    /// Hands the answers over; false once the sink has had enough.
    bool flush() {
        const bool more = to_.take({out_.data(), n_out_});
        n_out_ = 0;
        return more;
    }
    /// One node opened with `box_tests` tests; compiled away unless Counted.
    template <bool Counted> void count(std::uint64_t box_tests) {
        if constexpr (Counted) {
            ++work_->node_visits;
            work_->box_tests += box_tests;
        }
    }

  private:
    void grow() {
        Buffer<Pair> larger(2 * stack_.size());
        std::copy_n(stack_.data(), top_, larger.data());
        stack_ = std::move(larger);
    }

    ChunkSink to_;
    Work* work_;
    std::size_t top_ = 0, n_out_ = 0;
    Buffer<Pair> stack_{1024}, out_{4096};
};

/// Splits a traversal that starts at `root` into tasks, by the trees alone: opens the heaviest
/// until there are enough to balance threads even if some are heavier than their items tell, or
/// until all are light. `weight(nodes)` is the number of items below both, 0 for a pair of nodes
/// whose step might emit answers. `open(nodes, tasks)` appends what a step would push.
template <class Weight, class Open>
std::vector<Pair> share_out(Pair root, const Weight& weight, const Open& open) {
    constexpr std::size_t small = 4096; // a traversal of fewer items is not worth sharing out
    constexpr std::size_t light = 128, enough = 256, max_nodes = 8 * enough;
    std::vector<Pair> tasks{root}, next;
    std::size_t heaviest = weight(root);
    if (heaviest < small)
        return tasks;
    while (tasks.size() < enough && heaviest > light) {
        next.clear();
        std::size_t waiting = tasks.size();
        for (const Pair nodes : tasks) {
            if (weight(nodes) > heaviest / 2 && next.size() + waiting < max_nodes)
                open(nodes, next);
            else
                next.push_back(nodes);
            --waiting;
        }
        tasks.swap(next);
        heaviest = 0;
        for (const Pair nodes : tasks)
            heaviest = std::max(heaviest, weight(nodes));
    }
    return tasks;
}

/// Runs `traverse(PairTraversal&)` on each task as one chunk.
template <class Traverse>
void run_tasks(const std::vector<Pair>& tasks, const Executor& executor, PairSink& sink, Work* work,
               const Traverse& traverse) {
    std::atomic<bool> stop = false;
    std::atomic<std::size_t> next = 0; // in order: then a sink can put the pairs in place at once
    sink.begin(tasks.size(), executor.threads() == 1);
    executor.for_each(tasks.size(), [&](std::size_t) {
        const std::size_t chunk = next++;
        if (stop.load(std::memory_order_relaxed))
            return;
        PairTraversal state(sink, chunk, stop, work);
        state.push(tasks[chunk]);
        traverse(state);
        state.flush();
        sink.finish(chunk);
    });
    sink.end();
}

} // namespace boxwood::detail
