// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/traversals/packed_pairs.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "trees/traversals/packed_walk.h"
#include "trees/traversals/self_pairs.h"
#include "trees/traversals/tree_pairs.h"

#include <algorithm>
#include <array>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace boxwood::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<float, PackedBlock::width> df;
constexpr hn::RebindToUnsigned<decltype(df)> du;
constexpr std::size_t lanes = hn::MaxLanes(df);
constexpr std::size_t registers = PackedBlock::width / lanes; ///< of a plane

using F = hn::Vec<decltype(df)>;
using U = hn::Vec<decltype(du)>;
using M = hn::Mask<decltype(df)>;

/// One box in every lane.
struct OneBox {
    F min_x, min_y, min_z, max_x, max_y, max_z;

    explicit OneBox(const Box& box)
        : min_x(hn::Set(df, box.min.x)), min_y(hn::Set(df, box.min.y)),
          min_z(hn::Set(df, box.min.z)), max_x(hn::Set(df, box.max.x)),
          max_y(hn::Set(df, box.max.y)), max_z(hn::Set(df, box.max.z)) {}
};

/// Lanes [i, i + lanes) of a block that overlap the box.
HWY_INLINE M Overlap(const OneBox& box, const PackedBlock& block, std::size_t i) {
    const auto plane = [&](std::size_t p) HWY_ATTR { return hn::Load(df, block.plane[p] + i); };
    return hn::And(hn::And(hn::And(hn::Ge(box.max_x, plane(0)), hn::Le(box.min_x, plane(3))),
                           hn::And(hn::Ge(box.max_y, plane(1)), hn::Le(box.min_y, plane(4)))),
                   hn::And(hn::Ge(box.max_z, plane(2)), hn::Le(box.min_z, plane(5))));
}

/// A whole block and its items. Where a register holds sixteen floats they stay in registers.
struct SixteenBoxes {
    F min_x[registers], min_y[registers], min_z[registers];
    F max_x[registers], max_y[registers], max_z[registers];
    U item[registers];

    SixteenBoxes(const PackedBlock& block, const std::uint32_t* items) {
        for (std::size_t r = 0; r < registers; ++r) {
            const auto plane = [&](std::size_t p)
                                   HWY_ATTR { return hn::Load(df, block.plane[p] + r * lanes); };
            min_x[r] = plane(0);
            min_y[r] = plane(1);
            min_z[r] = plane(2);
            max_x[r] = plane(3);
            max_y[r] = plane(4);
            max_z[r] = plane(5);
            item[r] = hn::Load(du, items + r * lanes);
        }
    }
};

/// A block and its items twice in a row: sixteen lanes from lane k on are the block turned by k.
struct TwiceSixteen {
    alignas(64) float plane[6][2 * PackedBlock::width];
    alignas(64) std::uint32_t item[2 * PackedBlock::width];

    void hold(const SixteenBoxes& boxes) {
        for (std::size_t r = 0; r < registers; ++r) {
            const F planes[] = {boxes.min_x[r], boxes.min_y[r], boxes.min_z[r],
                                boxes.max_x[r], boxes.max_y[r], boxes.max_z[r]};
            for (const std::size_t at : {r * lanes, r * lanes + PackedBlock::width}) {
                for (std::size_t p = 0; p < 6; ++p)
                    hn::Store(planes[p], df, plane[p] + at);
                hn::Store(boxes.item[r], du, item + at);
            }
        }
    }
};

/// The lanes of register r that overlap lane `lane` of another block.
HWY_INLINE M Overlap(const SixteenBoxes& boxes, std::size_t r, const PackedBlock& block,
                     std::size_t lane) {
    const auto one = [&](std::size_t p) HWY_ATTR { return hn::Set(df, block.plane[p][lane]); };
    return hn::And(hn::And(hn::And(hn::Le(boxes.min_x[r], one(3)), hn::Ge(boxes.max_x[r], one(0))),
                           hn::And(hn::Le(boxes.min_y[r], one(4)), hn::Ge(boxes.max_y[r], one(1)))),
                   hn::And(hn::Le(boxes.min_z[r], one(5)), hn::Ge(boxes.max_z[r], one(2))));
}
/// The lanes i of register r that overlap lane i + k of their own block.
HWY_INLINE M Overlap(const SixteenBoxes& boxes, std::size_t r, const TwiceSixteen& twice,
                     std::size_t k) {
    const auto turned = [&](std::size_t p)
                            HWY_ATTR { return hn::LoadU(df, twice.plane[p] + r * lanes + k); };
    return hn::And(
        hn::And(hn::And(hn::Le(boxes.min_x[r], turned(3)), hn::Ge(boxes.max_x[r], turned(0))),
                hn::And(hn::Le(boxes.min_y[r], turned(4)), hn::Ge(boxes.max_y[r], turned(1)))),
        hn::And(hn::Le(boxes.min_z[r], turned(5)), hn::Ge(boxes.max_z[r], turned(2))));
}

/// Appends to `out` the lanes (numbered through the level: 16 block + lane) of the listed blocks
/// that overlap the box.
template <bool Counted>
HWY_INLINE void Refine(const PackedBlock* level, const PackedList& list, std::size_t first,
                       const OneBox& box, PackedList& out, Work* work) {
    constexpr std::size_t w = PackedBlock::width;
    std::uint32_t* to = out.reserve((list.size() - first) * w + w);
    const std::uint32_t* const begin = to;
    const auto iota = hn::Iota(du, 0u);
    for (std::size_t j = first; j < list.size(); ++j) {
        const std::uint32_t b = list[j];
        for (std::size_t i = 0; i < w; i += lanes) {
            const auto hits = hn::RebindMask(du, Overlap(box, level[b], i));
            const auto number = hn::Add(iota, hn::Set(du, static_cast<std::uint32_t>(b * w + i)));
            hn::StoreU(hn::Compress(number, hits), du, to);
            to += hn::CountTrue(du, hits);
        }
    }
    out.grow(static_cast<std::size_t>(to - begin));
    if constexpr (Counted) {
        work->node_visits += list.size() - first;
        work->box_tests += w * (list.size() - first);
        work->stack_max = std::max<std::uint64_t>(work->stack_max, out.size());
    }
}

template <bool Self, bool Counted> class Walk {
  public:
    Walk(PackedPairs& pairs, const PackedLayout& a, const PackedLayout& b, Work* work)
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
        Refine<Counted>(level, list, first, box, out, work_);
        --level_b;
    }
    static std::uint32_t bits_of(const OneBox& box, const PackedBlock& block) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < w; i += lanes) {
            std::uint8_t bytes[8] = {};
            hn::StoreMaskBits(df, Overlap(box, block, i), bytes);
            bits |= (std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8) << i;
        }
        return bits;
    }

    /// Opens a node on level 1, or the only block if there is but one level.
    bool open(std::size_t level, std::size_t node, const PackedList& list, std::size_t level_b) {
        if (level == 0)
            return leaf(node, list, level_b);
        const std::size_t end = std::min(a_.level(0).size(), (node + 1) * w);
        PackedList& leaves = lists_[2];
        for (std::size_t at = node * w; at < end; ++at) {
            std::size_t deeper = level_b;
            step(0, at, list, deeper, leaves);
            if (!leaf(at, leaves, deeper))
                return false;
        }
        return true;
    }

    bool leaf(std::size_t at, const PackedList& list, std::size_t level_b) {
        const PackedBlock& block = a_.level(0)[at];
        const OneBox box(a_.depth() == 1 ? a_.bounds() : a_.level(1)[at / w].lane(at % w));
        const PackedList* blocks = &list;
        PackedList *next = &lists_[3], *spare = &lists_[4];
        for (; level_b > 0; --level_b) { // b is the deeper tree
            next->clear();
            Refine<Counted>(b_.level(level_b).data(), *blocks, 0, box, *next, work_);
            blocks = next;
            std::swap(next, spare);
        }
        const SixteenBoxes boxes(block, a_.items().data() + at * w);
        if constexpr (Self)
            twice_.hold(boxes);
        PackedList& slots = lists_[5];
        slots.clear();
        Refine<Counted>(b_.level(0).data(), *blocks, Self ? 1 : 0, box, slots, work_);
        const std::uint32_t* const items = b_.items().data();
        const PackedBlock* const level = b_.level(0).data();
        for (const std::uint32_t *slot = slots.data(), *last = slot + slots.size(); slot < last;) {
            const auto some = std::min(static_cast<std::size_t>(last - slot), pairs_.free() / w);
            meet(boxes, level, items, slot, slot + some);
            slot += some;
            if (pairs_.free() < w && !flush())
                return false;
        }
        if constexpr (Counted) {
            work_->node_visits += slots.size();
            work_->box_tests += w * slots.size();
        }
        if constexpr (Self)
            return meet_itself(boxes);
        return true;
    }

    /// The block against itself turned by one to eight lanes, which meets any two lanes once, those
    /// eight apart twice. After all else of a leaf: what `twice_` holds is in the cache by now.
    bool meet_itself(const SixteenBoxes& boxes) {
        if (pairs_.free() < w * w / 2 && !flush())
            return false;
        std::uint32_t *const a = pairs_.a(), *const b = pairs_.b();
        std::size_t n = pairs_.size();
        for (std::size_t k = 1; k <= w / 2; ++k)
            for (std::size_t r = 0; r < registers; ++r) {
                if (k == w / 2 && r * lanes >= w / 2)
                    break;
                M hits = Overlap(boxes, r, twice_, k);
                if (k == w / 2)
                    hits = hn::And(hits, hn::FirstN(df, w / 2));
                const auto mask = hn::RebindMask(du, hits);
                hn::StoreU(hn::Compress(boxes.item[r], mask), du, a + n);
                hn::StoreU(hn::Compress(hn::LoadU(du, twice_.item + r * lanes + k), mask), du,
                           b + n);
                n += hn::CountTrue(du, mask);
            }
        pairs_.resize(n);
        if constexpr (Counted) {
            ++work_->node_visits;
            work_->box_tests += w * w / 2;
        }
        return true;
    }

    /// The slots [slot, end) of `b` against all of `boxes`: appends to the columns, which have
    /// room.
    HWY_INLINE void meet(const SixteenBoxes& boxes, const PackedBlock* level,
                         const std::uint32_t* items, const std::uint32_t* slot,
                         const std::uint32_t* end) {
        std::uint32_t *const a = pairs_.a(), *const b = pairs_.b();
        std::size_t n = pairs_.size();
        for (; slot < end; ++slot) {
            const auto item = hn::Set(du, items[*slot]);
            const PackedBlock& block = level[*slot / w];
            for (std::size_t r = 0; r < registers; ++r) {
                const auto hits = hn::RebindMask(du, Overlap(boxes, r, block, *slot % w));
                hn::StoreU(hn::Compress(boxes.item[r], hits), du, a + n);
                hn::StoreU(item, du, b + n);
                n += hn::CountTrue(du, hits);
            }
        }
        pairs_.resize(n);
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

  public:
    bool finish() { return flush(); }

  private:
    PackedPairs& pairs_;
    const PackedLayout& a_;
    const PackedLayout& b_;
    Work* work_;
    std::array<PackedList, 6> lists_;
    TwiceSixteen twice_;
};

template <bool Self, bool Counted>
void RunChunk(const PackedChunk& chunk, PackedPairs& pairs, Work* work) {
    Walk<Self, Counted> walk(pairs, chunk.a, chunk.b, work);
    for (std::size_t node = chunk.begin; node < chunk.end; ++node)
        if (!walk.run(chunk.level, node))
            return;
    walk.finish();
}

void PackedChunkPairs(const PackedChunk& chunk, PackedPairs& pairs, bool self, Work* work) {
    if (self)
        work ? RunChunk<true, true>(chunk, pairs, work) : RunChunk<true, false>(chunk, pairs, work);
    else
        work ? RunChunk<false, true>(chunk, pairs, work)
             : RunChunk<false, false>(chunk, pairs, work);
}

} // namespace boxwood::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
HWY_EXPORT(PackedChunkPairs);

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
    constexpr std::size_t most = 128;
    const std::size_t level = std::min<std::size_t>(1, a.depth() - 1);
    const std::size_t nodes = a.level(level).size(), chunks = std::min(nodes, most);
    std::atomic<bool> stop = false;
    std::atomic<std::size_t> next = 0; // the sink wants them in order, whatever the executor does
    sink.begin(chunks, executor.threads() == 1);
    executor.for_each(chunks, [&](std::size_t) {
        const std::size_t c = next++;
        if (stop.load(std::memory_order_relaxed))
            return;
        PackedPairs pairs(sink, c, stop, work);
        const ChunkRange range(nodes, chunks, c);
        HWY_DYNAMIC_DISPATCH(PackedChunkPairs)
        ({a, b, level, range.begin, range.end}, pairs, self, work);
        sink.finish(c);
    });
    sink.end();
}

} // namespace

void self_pairs(const PackedLayout& tree, const Executor& executor, PairSink& sink) {
    run(tree, tree, true, executor, sink, nullptr);
}
Work self_pairs_counted(const PackedLayout& tree, PairSink& sink) {
    Work work;
    run(tree, tree, true, serial(), sink, &work);
    return work;
}
namespace {

/// Hands on each pair the other way round.
class Swapped final : public PairSink {
  public:
    explicit Swapped(PairSink& sink) : sink_(sink) {}

    void begin(std::size_t chunks, bool in_order) override { sink_.begin(chunks, in_order); }
    bool take(std::size_t chunk, std::span<const Pair> pairs) override {
        std::array<Pair, 256> swapped; // 2 KiB of stack
        for (std::size_t done = 0; done < pairs.size();) {
            const std::size_t n = std::min(swapped.size(), pairs.size() - done);
            for (std::size_t i = 0; i < n; ++i)
                swapped[i] = {pairs[done + i].b, pairs[done + i].a};
            if (!sink_.take(chunk, {swapped.data(), n}))
                return false;
            done += n;
        }
        return true;
    }
    void finish(std::size_t chunk) override { sink_.finish(chunk); }
    void end() override { sink_.end(); }

  private:
    PairSink& sink_;
};

/// Chunks are cut from the first tree: where it is much the smaller, from the other.
void run_two(const PackedLayout& a, const PackedLayout& b, const Executor& executor, PairSink& sink,
             Work* work) {
    if (16 * a.size() >= b.size())
        return run(a, b, false, executor, sink, work);
    Swapped swapped(sink);
    run(b, a, false, executor, swapped, work);
}

} // namespace

void tree_pairs(const PackedLayout& a, const PackedLayout& b, const Executor& executor,
                PairSink& sink) {
    run_two(a, b, executor, sink, nullptr);
}
Work tree_pairs_counted(const PackedLayout& a, const PackedLayout& b, PairSink& sink) {
    Work work;
    run_two(a, b, serial(), sink, &work);
    return work;
}

} // namespace boxwood
#endif
