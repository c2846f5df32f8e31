// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_RAY_WAVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_RAY_WAVE_INL_H
#undef BOXWOOD_RAY_WAVE_INL_H
#else
#define BOXWOOD_RAY_WAVE_INL_H
#endif

#include <hwy/cache_control.h>

#include "kernels/simd/moller_trumbore_block-inl.h"
#include "kernels/simd/watertight_block-inl.h"
#include "trees/traversals/compress-inl.h"
#include "trees/traversals/node_clip-inl.h"
#include "trees/traversals/ray_traversal.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

using boxwood::HWY_NAMESPACE::intersect_block;

/// Each open node on a path leaves all but one of its children waiting; a whole node is stored
/// beyond them, and one reference below them ends a traversal.
template <class Node> constexpr std::size_t room_for(std::size_t depth) {
    return (depth + 2) * Node::width + 1;
}

/// The closest or any hits of a job's rays, many rays at a time, each with a stack of its own. A
/// step takes one ray through one node or one leaf and fetches what its next step will read; then
/// the other rays have theirs, so that a ray waits neither for memory nor for its own last step.
/// All rays at nodes have their step, then all at leaves: nothing is left to predict but whether
/// triangles are hit and how many waiting nodes are too far. Each ray visits what it would alone.
template <class Node, RayKernel K, RayMode mode, bool Counted> class RayWave {
    static constexpr bool closest = mode == RayMode::closest;

  public:
    using Waiting = std::conditional_t<closest, WaitingNode, std::uint32_t>;

    /// The most rays on their way; with fewer than 16 the memory is not far enough away.
    static constexpr std::size_t width = 16;

    RayWave(const RayJob& job, const SlabBounds& bounds)
        : job_(job),
          bounds_(bounds), places_{{{job.triangles.nodes.data(), sizeof(Node)},
                                    {job.triangles.blocks.data(), sizeof(RayBlock<Node>)}}} {}

    void run() {
        const std::size_t room = room_for<Node>(job_.depth);
        const std::size_t rays =
            std::min({width, job_.rays.size(), std::max<std::size_t>(max_waiting / room, 1)});
        Buffer<Waiting> stacks(room * rays);
        for (std::size_t i = 0; i < rays; ++i) {
            WaveRay& own = wave_[i];
            own.bottom = stacks.data() + i * room;
            if constexpr (closest)
                *own.bottom++ = {over, -std::numeric_limits<float>::infinity()};
            else
                *own.bottom++ = over;
            if (start(own))
                line_up(own);
        }
        while (n_at_[0] + n_at_[1] != 0) {
            for (std::size_t n = std::exchange(n_at_[0], 0), i = 0; i < n; ++i) {
                WaveRay& own = *at_[0][i];
                open(own);
                go_on(own);
            }
            for (std::size_t n = std::exchange(n_at_[1], 0), i = 0; i < n; ++i) {
                WaveRay& own = *at_[1][i];
                test(own);
                go_on(own);
            }
        }
    }

  private:
    static constexpr std::uint32_t over = ~std::uint32_t{0}; ///< no ray_refs
    static constexpr std::size_t max_waiting = 1 << 18;      ///< of several rays together

    struct alignas(64) WaveRay {
        FusedSlabs slabs;
        std::optional<RayState<K, mode, Counted>> state;
        const Ray<float>* ray;
        Waiting *bottom, *top;
        std::uint32_t at;       ///< ray_refs
        const std::byte* place; ///< of the node or the block
    };

    /// The next ray that has to be traced, if there is one; those before it miss.
    bool start(WaveRay& own) {
        for (; next_ < job_.rays.size(); ++next_) {
            const Ray<float>& ray = job_.rays[next_];
            if (job_.depth == 0 || !is_finite(ray.origin) || !is_finite(ray.direction)) {
                job_.hits[next_] = {};
                continue;
            }
            own.slabs = FusedSlabs(ray, bounds_);
            own.state.emplace(ray, job_.work, found_);
            own.ray = &ray;
            own.top = own.bottom;
            own.at = job_.triangles.root;
            ++next_;
            return true;
        }
        return false;
    }

    /// Without a branch on what comes next, which is hard to predict.
    HWY_INLINE void line_up(WaveRay& own) {
        const std::uint32_t leaf = own.at >> 31;
        static_assert(ray_refs::leaf == 1u << 31);
        const auto [first, size] = places_[leaf];
        own.place = first + size * ray_refs::index(own.at);
        // Of the shorter kind more than its own.
        for (std::size_t line = 0; line < std::max(sizeof(Node), sizeof(RayBlock<Node>));
             line += 64)
            hwy::Prefetch(own.place + line);
        at_[0][n_at_[0]] = at_[1][n_at_[1]] = &own;
        n_at_[1] += leaf;
        n_at_[0] += 1 - leaf;
    }

    /// To the nearest node that waits, or to the next ray.
    HWY_INLINE void go_on(WaveRay& own) {
        if constexpr (closest) {
            const float t_max = own.state->t_max();
            do
                --own.top;
            while (own.top->entry > t_max);
            own.at = own.top->ref;
        } else {
            own.at = *--own.top;
        }
        if (own.at == over) [[unlikely]] {
            job_.hits[static_cast<std::size_t>(own.ray - job_.rays.data())] = own.state->result();
            if (!start(own))
                return;
        }
        line_up(own);
    }

    /// Every child that is hit waits: the farthest first for the closest hit, else in no order.
    HWY_INLINE void open(WaveRay& own) {
        namespace hn = hwy::HWY_NAMESPACE;
        const NodeTag<Node> df;
        const hn::Rebind<std::uint32_t, decltype(df)> du;
        const Node& node = *reinterpret_cast<const Node*>(own.place);
        own.state->count(Node::width, static_cast<std::size_t>(own.top - own.bottom));
        const NodeClip<Node> clip(own.slabs, own.state->t_min());
        const auto t_max = hn::Set(df, own.state->t_max());
        [[maybe_unused]] alignas(64) float entries[Node::width];
        [[maybe_unused]] std::uint32_t bits = 0;
        for (std::size_t i = 0; i < Node::width; i += hn::Lanes(df)) {
            hn::Vec<decltype(df)> entry;
            const auto hit = clip.hits_of(node, i, t_max, entry);
            if constexpr (!closest) {
                hn::StoreU(compressed(du, hn::LoadU(du, node.ref + i), hn::RebindMask(du, hit)), du,
                           own.top);
                own.top += hn::CountTrue(df, hit);
            } else {
                bits |= wide_bits(df, hit, i);
                if constexpr (in_register<Node>)
                    push_sorted_eight(node.ref, bits, entry, own.top);
                else
                    hn::Store(entry, df, entries + i);
            }
        }
        if constexpr (closest) {
            if constexpr (!in_register<Node>)
                push_sorted(node, bits, entries, own.top);
            own.top += std::popcount(bits);
        }
    }

    HWY_INLINE void test(WaveRay& own) {
        const auto* block = reinterpret_cast<const RayBlock<Node>*>(own.place);
        const auto* last = block + (Node::width > 8 && (own.at & ray_refs::two));
        BlockHits<ray_lanes<Node>> hits;
        do {
            const std::uint32_t bits = intersect_block(std::type_identity<K>{}, own.state->per_ray,
                                                       *own.ray, *block, own.state->t_max(), hits);
            if (!Counted && bits == 0)
                continue;
            own.state->tested(*block, bits, hits);
            if (own.state->done()) {
                own.top = own.bottom;
                return;
            }
        } while (++block <= last);
    }

    struct Places {
        const std::byte* first;
        std::size_t size;
    };

    const RayJob& job_;
    const SlabBounds& bounds_;
    const std::array<Places, 2> places_; ///< nodes, blocks
    std::size_t next_ = 0;               ///< ray
    std::vector<RayHit> found_;          ///< nothing: of RayMode::all
    /// The rays at nodes and at leaves; one is written beyond those in line.
    std::array<std::array<WaveRay*, width + 1>, 2> at_;
    std::array<std::size_t, 2> n_at_{};
    std::array<WaveRay, width> wave_;
};

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
