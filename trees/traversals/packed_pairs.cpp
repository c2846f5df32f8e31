// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/packed_pairs.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/queries/filters.h"
#include "trees/queries/self_pairs.h"
#include "trees/queries/tree_pairs.h"
#include "trees/traversals/packed_overlap-inl.h"
#include "trees/traversals/packed_traversal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <bool Self, bool Counted> class PackedTraversal {
  public:
    PackedTraversal(PackedPairs& pairs, const PackedLayout& a, const PackedLayout& b, Work* work)
        : pairs_(pairs), a_(a), b_(b), work_(work) {}

    /// All pairs whose first slot, in `a`, lies below node `node` of level `level`.
    /// The candidates of a node are the blocks of `b` that overlap it, of the same level or as deep
    /// as `b` goes; within one tree only those from the node itself on, which comes first.
    bool run(std::size_t level, std::size_t node) {
        PackedList* list = &lists_[0];
        PackedList* next = &lists_[1];
        std::size_t level_b = b_.depth() - 1;
        list->clear();
        list->push(0);
        for (std::size_t l = a_.depth() - 1; l-- > level;) {
            // The ancestor of `node` on level l, which is a lane of its parent.
            const std::size_t at = node >> (4 * (l - level));
            step(l, at, *list, level_b, *next);
            std::swap(list, next);
        }
        return open(level, node, *list, level_b);
    }
    /// Hands over what is left; false once the sink has had enough.
    bool finish() { return flush(); }

  private:
    static constexpr std::size_t w = PackedBlock::width;

    /// The candidates of node `at` of level l of `a` from those of its parent.
    void step(std::size_t l, std::size_t at, const PackedList& list, std::size_t& level_b,
              PackedList& out) {
        out.clear();
        const OneBox box(a_.level(l + 1)[at / w].lane(at % w));
        if (level_b == 0) {
            // b goes no deeper: the list is of its leaves already.
            out.copy(list);
            return;
        }
        const PackedBlock* const level = b_.level(level_b).data();
        std::size_t first = 0;
        if constexpr (Self) {
            // The parent itself comes first: of its lanes those from `at` on.
            std::uint32_t* const to = out.reserve(w);
            std::size_t n = 0;
            const std::uint32_t bits = bits_of(box, level[at / w]) >> (at % w);
            for (std::uint32_t rest = bits; rest; rest &= rest - 1)
                to[n++] = static_cast<std::uint32_t>(
                    at + static_cast<std::size_t>(std::countr_zero(rest)));
            out.grow(n);
            first = 1;
            if constexpr (Counted) {
                ++work_->node_visits;
                work_->box_tests += w;
            }
        }
        refine<Counted>(level, list, first, box, out, work_);
        --level_b;
    }
    static std::uint32_t bits_of(const OneBox& box, const PackedBlock& block) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < w; i += lanes) {
            std::uint8_t bytes[8] = {};
            hn::StoreMaskBits(df, overlap_lanes(block, i, box), bytes);
            bits |= (std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8) << i;
        }
        return bits;
    }

    /// Opens a node on level 1, or the only block if there is but one level: all its leaves side by
    /// side, in stages: of long loops the processor guesses the end wrong less often.
    bool open(std::size_t level, std::size_t node, const PackedList& list, std::size_t level_b) {
        const bool alone = level == 0;
        const Box box =
            level + 1 == a_.depth() ? a_.bounds() : a_.level(level + 1)[node / w].lane(node % w);
        const PackedList* candidates = &list;
        PackedList *next = &lists_[2], *spare = &lists_[3];
        for (; level_b > level; --level_b) { // b is the deeper tree
            next->clear();
            refine<Counted>(b_.level(level_b).data(), *candidates, 0, OneBox(box), *next, work_);
            candidates = next;
            std::swap(next, spare);
        }
        first_ = alone ? node : node * w;
        const std::size_t count = alone ? 1 : std::min(w, a_.level(0).size() - first_);
        if (alone)
            for (int axis = 0; axis < 3; ++axis) {
                alone_.plane[axis][0] = box.min[axis];
                alone_.plane[3 + axis][0] = box.max[axis];
            }
        above_ = alone ? &alone_ : &a_.level(1)[node];
        near_.n = close_.n = 0;
        for (std::size_t j = Self && alone ? 1 : 0; j < candidates->size(); ++j) {
            const std::uint32_t c = (*candidates)[j];
            if (level_b == 0) {
                if (near_.n + count > near_.max_size && !meet_near())
                    return false;
                for (std::uint32_t i = 0; i < count; ++i)
                    near_.push(c, i);
            } else if (Self && c == node) { // comes first
                for (std::uint32_t i = 0; i < count; ++i)
                    list_near<true>(c, i);
            } else {
                if (close_.n + w > close_.max_size && !list_near())
                    return false;
                list_close(c);
            }
        }
        if (!list_near())
            return false;
        if (!meet_near())
            return false;
        if constexpr (Self) {
            const auto hold = [&](std::size_t i) {
                twice_[i % 2].hold(a_.level(0)[first_ + i], a_.items().data() + (first_ + i) * w);
            };
            hold(0);
            for (std::size_t i = 0; i < count; ++i) {
                if (i + 1 < count)
                    hold(i + 1); // in the cache by the time it is read
                if (!meet_itself(twice_[i % 2]))
                    return false;
            }
        }
        return true;
    }

    /// Of the leaves at hand those that node c of level 1 of `b` overlaps.
    void list_close(std::uint32_t c) {
        const Box box = b_.depth() == 2 ? b_.bounds() : b_.level(2)[c / w].lane(c % w);
        const OneBox one(box);
        std::size_t n = close_.n;
        const Hits hits([&](std::size_t i) HWY_ATTR { return overlap_lanes(*above_, i, one); });
        for (std::size_t i = 0; i < w; i += lanes)
            n += put(hits[i], hn::Iota(du, static_cast<std::uint32_t>(i)), &c, close_.a + n,
                     close_.b + n);
        close_.n = n;
        if constexpr (Counted)
            count_work(1, n);
    }

    /// Leaves of `b` that lie below node c of level 1 and overlap the leaf `at` at hand; below the
    /// node itself those after it.
    template <bool itself> void list_near(std::uint32_t c, std::uint32_t at) {
        const PackedBlock& block = b_.level(1)[c];
        std::size_t n = near_.n;
        const Hits all([&](std::size_t i)
                           HWY_ATTR { return overlap_lanes(block, i, *above_, at); });
        for (std::size_t i = 0; i < w; i += lanes) {
            const auto lane = hn::Iota(du, static_cast<std::uint32_t>(i));
            M hits = all[i];
            if constexpr (itself)
                hits = hn::And(hits, hn::RebindMask(df, hn::Gt(lane, hn::Set(du, at))));
            const auto number = hn::Add(lane, hn::Set(du, static_cast<std::uint32_t>(c * w)));
            n += put(hits, number, &at, near_.a + n, near_.b + n);
        }
        near_.n = n;
        if constexpr (Counted)
            count_work(1, near_.n);
    }
    /// The same of all that `close_` lists; then what is near meets.
    bool list_near() {
        for (std::size_t j = 0; j < close_.n; ++j) {
            if (near_.n + w > near_.max_size && !meet_near())
                return false;
            list_near<false>(close_.b[j], close_.a[j]);
        }
        close_.n = 0;
        return meet_near();
    }

    /// What `near_` lists, in parts whose slots have room: of two leaves the slots of `b` that
    /// overlap the other's bounds; or, if they are many, those of `a` if they are fewer.
    bool meet_near() {
        // Of uniform boxes few leaves list so many, so that the branch is nearly always foreseen.
        constexpr std::size_t part = PackedColumns::max_size / w, many = 11;
        const PackedBlock* const level_a = a_.level(0).data() + first_;
        const PackedBlock* const level_b = b_.level(0).data();
        for (std::size_t j = 0; j < near_.n;) {
            const std::size_t begin = j, end = std::min(near_.n, j + part);
            theirs_.n = ours_.n = 0;
            for (; j < end; ++j) {
                const std::uint32_t c = near_.a[j], at = near_.b[j];
                const std::size_t n = list_slots(level_b[c], c, *above_, at,
                                                 static_cast<std::uint32_t>(first_ + at), theirs_);
                if (n <= many || b_.depth() == 1)
                    continue;
                const std::size_t fewer =
                    list_slots(level_a[at], static_cast<std::uint32_t>(first_ + at),
                               b_.level(1)[c / w], c % w, c, ours_);
                (fewer < n ? theirs_.n : ours_.n) -= fewer < n ? n : fewer;
                if constexpr (Counted)
                    count_work(1, 0);
            }
            if constexpr (Counted)
                count_work(end - begin, theirs_.n + ours_.n);
            if (!meet_slots(theirs_, b_, pairs_.b(), a_, pairs_.a()) ||
                !meet_slots(ours_, a_, pairs_.a(), b_, pairs_.b()))
                return false;
        }
        near_.n = 0;
        return true;
    }

    /// Lists the slots of leaf `number`, which is `block`, that overlap lane `lane` of `above`: the
    /// bounds of leaf `other`. Returns how many there are.
    static HWY_INLINE std::size_t list_slots(const PackedBlock& block, std::uint32_t number,
                                             const PackedBlock& above, std::size_t lane,
                                             std::uint32_t other, PackedColumns& list) {
        std::size_t n = list.n;
        const Hits hits([&](std::size_t i)
                            HWY_ATTR { return overlap_lanes(block, i, above, lane); });
        for (std::size_t i = 0; i < w; i += lanes) {
            const auto slot = hn::Add(hn::Iota(du, static_cast<std::uint32_t>(i)),
                                      hn::Set(du, static_cast<std::uint32_t>(number * w)));
            n += put(hits[i], slot, &other, list.a + n, list.b + n);
        }
        return n - std::exchange(list.n, n);
    }

    /// Each slot listed, of `one`, against all of the leaf of `many` listed with it.
    bool meet_slots(const PackedColumns& list, const PackedLayout& one, std::uint32_t* one_to,
                    const PackedLayout& many, std::uint32_t* many_to) {
        const std::uint32_t* const items_one = one.items().data();
        const std::uint32_t* const items_many = many.items().data();
        const PackedBlock* const level_one = one.level(0).data();
        const PackedBlock* const level_many = many.level(0).data();
        for (std::size_t j = 0; j < list.n;) {
            if (pairs_.free() < w && !flush())
                return false;
            std::size_t n = pairs_.size();
            for (const std::size_t end = std::min(list.n, j + pairs_.free() / w); j < end; ++j) {
                const std::size_t slot = list.a[j], leaf = list.b[j];
                const Hits hits([&](std::size_t i) HWY_ATTR {
                    return overlap_lanes(level_many[leaf], i, level_one[slot / w], slot % w);
                });
                for (std::size_t i = 0; i < w; i += lanes)
                    n += put(hits[i], hn::Load(du, items_many + leaf * w + i), items_one + slot,
                             many_to + n, one_to + n);
            }
            pairs_.resize(n);
        }
        if constexpr (Counted)
            count_work(list.n, 0);
        return true;
    }

    /// A block against itself turned by one to eight lanes, which meets any two lanes once, but
    /// those eight apart twice.
    bool meet_itself(const TwiceSixteen& twice) {
        if (pairs_.free() < w * w / 2 && !flush())
            return false;
        std::uint32_t *const a = pairs_.a(), *const b = pairs_.b();
        std::size_t n = pairs_.size();
        for (std::size_t k = 1; k <= w / 2; ++k)
            for (std::size_t i = 0; i < w; i += lanes) {
                if (k == w / 2 && i >= w / 2)
                    break;
                M hits = twice.overlap(i, k);
                if (k == w / 2)
                    hits = hn::And(hits, hn::FirstN(df, w / 2));
                const auto mask = hn::RebindMask(du, hits);
                hn::StoreU(compressed(du, hn::Load(du, twice.item + i), mask), du, a + n);
                hn::StoreU(compressed(du, hn::LoadU(du, twice.item + i + k), mask), du, b + n);
                n += hn::CountTrue(du, mask);
            }
        pairs_.resize(n);
        if constexpr (Counted)
            count_work(w / 2, 0);
        return true;
    }

    void count_work(std::size_t blocks, std::size_t listed) {
        work_->node_visits += blocks;
        work_->box_tests += w * blocks;
        work_->stack_max = std::max<std::uint64_t>(work_->stack_max, listed);
    }

    /// Makes pairs of the columns.
    bool flush() {
        const auto put = [&](const std::uint32_t* a, const std::uint32_t* b, std::size_t n,
                             Pair* out) HWY_ATTR {
            for (std::size_t i = 0; i < n; i += lanes) {
                const auto x = hn::Load(du, a + i), y = hn::Load(du, b + i);
                hn::StoreInterleaved2(Self ? hn::Min(x, y) : x, Self ? hn::Max(x, y) : y, du,
                                      reinterpret_cast<std::uint32_t*>(out + i));
            }
        };
        return pairs_.flush(put);
    }

    PackedPairs& pairs_;
    const PackedLayout& a_;
    const PackedLayout& b_;
    Work* work_;
    std::array<PackedList, 4> lists_;
    // Of the leaves at hand, from first_ on, whose bounds are the lanes of *above_:
    std::size_t first_ = 0;
    const PackedBlock* above_ = nullptr;
    PackedBlock alone_{};
    PackedColumns close_;  ///< leaves at hand, from first_ on, and nodes of level 1 of `b`
    PackedColumns near_;   ///< leaves of `b`, and which of ours each is near to, from first_ on
    PackedColumns theirs_; ///< slots of `b`, and leaves of `a` they might overlap
    PackedColumns ours_;   ///< slots of `a`, and leaves of `b`
    std::array<TwiceSixteen, 2> twice_;
};

template <bool Self, bool Counted>
void run_chunk(const PackedChunk& chunk, PackedPairs& pairs, Work* work) {
    PackedTraversal<Self, Counted> traversal(pairs, chunk.a, chunk.b, work);
    for (std::size_t node = chunk.begin; node < chunk.end; ++node)
        if (!traversal.run(chunk.level, node))
            return;
    traversal.finish();
}

void packed_chunk_pairs(const PackedChunk& chunk, PackedPairs& pairs, bool self, Work* work) {
    if (self)
        work ? run_chunk<true, true>(chunk, pairs, work)
             : run_chunk<true, false>(chunk, pairs, work);
    else
        work ? run_chunk<false, true>(chunk, pairs, work)
             : run_chunk<false, false>(chunk, pairs, work);
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood::detail {
HWY_EXPORT(packed_chunk_pairs);

namespace {

/// Chunks are ranges of the nodes of level 1 (256 slots each): enough of them to balance threads,
/// few enough that a chunk is worth handing out.
void run(const PackedLayout& a, const PackedLayout& b, bool self, const Executor& executor,
         PairSink& sink, Work* work) {
    if (a.empty() || b.empty()) {
        sink.begin(0, true);
        sink.end();
        return;
    }
    constexpr std::size_t max_size = 128;
    const std::size_t level = std::min<std::size_t>(1, a.depth() - 1);
    const std::size_t nodes = a.level(level).size(), chunks = std::min(nodes, max_size);
    std::atomic<bool> stop = false;
    std::atomic<std::size_t> next = 0; // the sink wants them in order, whatever the executor does
    sink.begin(chunks, executor.threads() == 1);
    executor.for_each(chunks, [&](std::size_t) {
        const std::size_t c = next++;
        if (stop.load(std::memory_order_relaxed))
            return;
        PackedPairs pairs(sink, c, stop, work);
        const ChunkRange range(nodes, chunks, c);
        HWY_DYNAMIC_DISPATCH(packed_chunk_pairs)
        ({a, b, level, range.begin, range.end}, pairs, self, work);
        sink.finish(c);
    });
    sink.end();
}

} // namespace

} // namespace boxwood::detail

namespace boxwood {

void self_pairs(const PackedLayout& tree, const Executor& executor, PairSink& sink, Work* work) {
    detail::run(tree, tree, true, executor, sink, work);
}

/// Chunks are cut from the first tree: where it is much the smaller, from the other.
void tree_pairs(const PackedLayout& a, const PackedLayout& b, const Executor& executor,
                PairSink& sink, Work* work) {
    if (16 * a.size() >= b.size())
        return detail::run(a, b, false, executor, sink, work);
    SwappedPairs swapped(sink);
    detail::run(b, a, false, executor, swapped, work);
}

} // namespace boxwood
#endif
