// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_RAY_WAVE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_RAY_WAVE_INL_H
#undef BOXWOOD_RAY_WAVE_INL_H
#else
#define BOXWOOD_RAY_WAVE_INL_H
#endif

#include <hwy/cache_control.h>

#include "trees/traversals/rays/coherent_rays.h"
#include "trees/traversals/rays/ray_steps-inl.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// The closest, any or all hits of a job's rays, many rays at a time, each with a stack of its own.
/// A step takes one ray through one node or one leaf and fetches what its next step will read; then
/// the other rays have theirs, so that a ray waits neither for memory nor for its own last step.
/// All rays at nodes have their step, then all at leaves: nothing is left to predict but whether
/// triangles are hit and how many waiting nodes are too far. Each ray visits what it would alone.
template <class Node, RayKernel K, RayMode mode, bool Counted> class RayWave {
    static constexpr bool closest = mode == RayMode::closest;

  public:
    using Waiting = std::conditional_t<closest, WaitingNode, std::uint32_t>;

    /// The most rays on their way; with fewer than 16 the memory is not far enough away.
    static constexpr std::size_t width = 16;

    /// But for the rays of the packets that are answered.
    RayWave(const RayJob& job, const SlabBounds& bounds, PacketSet answered)
        : job_(job), bounds_(bounds),
          answered_(answered), places_{{{job.triangles.nodes.data(), sizeof(Node)},
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
        if constexpr (mode == RayMode::all)
            in_all_.resize(job_.rays.size());
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
        if constexpr (mode == RayMode::all)
            hand_over();
    }

  private:
    static constexpr std::uint32_t over = ~std::uint32_t{0}; ///< no ray_refs
    static constexpr std::size_t max_waiting = 1 << 18;      ///< of several rays together

    struct alignas(64) WaveRay {
        FusedSlabs slabs;
        std::optional<RayState<K, mode, Counted>> state;
        std::vector<RayHit> found; ///< of RayMode::all
        const Ray<float>* ray;
        Waiting *bottom, *top;
        std::uint32_t at;       ///< ray_refs
        const std::byte* place; ///< of the node or the block
    };

    /// The next ray that has to be traced, if there is one; those before it miss.
    bool start(WaveRay& own) {
        for (; next_ < job_.rays.size(); ++next_) {
            if (answered_.holds(next_)) {
                next_ += packet_size - 1;
                continue;
            }
            const Ray<float>& ray = job_.rays[next_];
            if (job_.depth == 0 || !is_finite(ray.origin) || !is_finite(ray.direction)) {
                if constexpr (mode != RayMode::all)
                    job_.hits[next_] = {};
                continue;
            }
            own.slabs = FusedSlabs(ray, bounds_);
            own.state.emplace(ray, job_.work, own.found);
            own.ray = &ray;
            own.top = own.bottom;
            own.at = job_.triangles.root;
            ++next_;
            return true;
        }
        return false;
    }

    void answer(WaveRay& own) {
        const auto i = static_cast<std::size_t>(own.ray - job_.rays.data());
        if constexpr (mode != RayMode::all) {
            job_.hits[i] = own.state->result();
        } else {
            sort_distinct(own.found);
            in_all_[i] = {all_.size(), all_.size() + own.found.size()};
            all_.insert(all_.end(), own.found.begin(), own.found.end());
            own.found.clear();
        }
    }

    /// All hits, in the order of the rays.
    void hand_over() {
        for (std::size_t i = 0; i < in_all_.size(); ++i) {
            const auto [begin, end] = in_all_[i];
            if (begin < end &&
                !job_.sink->take(job_.chunk, static_cast<std::uint32_t>(job_.first_ray + i),
                                 std::span(all_).subspan(begin, end - begin))) {
                *job_.stop = true;
                return;
            }
        }
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
            answer(own);
            if (!start(own))
                return;
        }
        line_up(own);
    }

    HWY_INLINE void open(WaveRay& own) {
        const Node& node = *reinterpret_cast<const Node*>(own.place);
        own.state->count(Node::width, static_cast<std::size_t>(own.top - own.bottom));
        own.top = push_hit_children<closest>(node, NodeClip<Node>(own.slabs, own.state->t_min()),
                                             own.state->t_max(), own.top);
    }

    HWY_INLINE void test(WaveRay& own) {
        const auto* block = reinterpret_cast<const RayBlock<Node>*>(own.place);
        if (test_leaf<Node, K>(block, own.at, *own.ray, *own.state))
            own.top = own.bottom;
    }

    struct Places {
        const std::byte* first;
        std::size_t size;
    };

    const RayJob& job_;
    const SlabBounds& bounds_;
    const PacketSet answered_;
    const std::array<Places, 2> places_; ///< nodes, blocks
    std::size_t next_ = 0;               ///< ray
    std::vector<RayHit> all_;            ///< of RayMode::all: the hits of the rays so far
    std::vector<std::array<std::size_t, 2>> in_all_; ///< by ray: from where to where
    /// The rays at nodes and at leaves; one is written beyond those in line.
    std::array<std::array<WaveRay*, width + 1>, 2> at_;
    std::array<std::size_t, 2> n_at_{};
    std::array<WaveRay, width> wave_;
};

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
