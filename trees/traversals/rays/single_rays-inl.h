// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_SINGLE_RAYS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_SINGLE_RAYS_INL_H
#undef BOXWOOD_SINGLE_RAYS_INL_H
#else
#define BOXWOOD_SINGLE_RAYS_INL_H
#endif

#include "trees/queries/single_rays.h"
#include "trees/traversals/rays/ray_wave-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

/// One ray from the root to its answer. Other than in RayWave nothing hides how long a step takes,
/// from a node's planes to the next node: so a node with one child that is hit has a way of its
/// own, and of more the nearest is known before the others are in order. What will be next after it
/// is fetched meanwhile.
template <class Node, RayKernel K, RayMode mode> class RayAlone {
    static constexpr bool closest = mode == RayMode::closest;
    using Waiting = std::conditional_t<closest, WaitingNode, std::uint32_t>;
    using D = NodeTag<Node>;
    using V = hwy::HWY_NAMESPACE::Vec<D>;

  public:
    /// Deeper trees are not traversed so: room_for<Node>(depth) > room.
    static constexpr std::size_t room = 4096 / sizeof(WaitingNode);

    HWY_INLINE RayAlone(const SingleRayTree& tree, const Ray<float>& ray)
        : tree_(tree), ray_(ray), state_(ray, nullptr, found_) {}

    HWY_INLINE RayHit trace() {
        namespace hn = hwy::HWY_NAMESPACE;
        const D df;
        const FusedSlabs slabs(ray_, tree_.bounds);
        const NodeClip<Node> clip(slabs, state_.t_min());
        V t_max = hn::Set(df, state_.t_max());
        top_ = stack_;
        if constexpr (closest)
            *top_++ = {over, -std::numeric_limits<float>::infinity()};
        else
            *top_++ = over;
        std::uint32_t at = tree_.root;
        for (;;) {
            while (!ray_refs::is_leaf(at)) {
                const Node& node = *reinterpret_cast<const Node*>(tree_.nodes + at * sizeof(Node));
                if (!open(node, clip, t_max, at))
                    goto waiting;
            }
            if (at == over || test(at))
                return state_.result();
            t_max = hn::Set(df, state_.t_max());
        waiting:
            at = next();
        }
    }

  private:
    static constexpr std::uint32_t over = ~std::uint32_t{0}; ///< no ray_refs, but a leaf's bit

    /// The nearest of those that wait, or `over`.
    HWY_INLINE std::uint32_t next() {
        if constexpr (closest) {
            do
                --top_;
            while (top_->entry > state_.t_max());
            return top_->ref;
        } else {
            return *--top_;
        }
    }

    /// To a child that is hit, the nearest for the closest hit, if there is one; the others wait.
    HWY_INLINE bool open(const Node& node, const NodeClip<Node>& clip, V t_max, std::uint32_t& at) {
        namespace hn = hwy::HWY_NAMESPACE;
        const D df;
        const hn::Rebind<std::uint32_t, D> du;
        [[maybe_unused]] alignas(64) float entries[Node::width];
        std::uint32_t bits = 0;
        V entry;
        hn::Mask<D> hit;
        for (std::size_t i = 0; i < Node::width; i += hn::Lanes(df)) {
            hit = clip.hits_of(node, i, t_max, entry);
            bits |= lane_bits(df, hit, i);
            if constexpr (!closest) {
                hn::StoreU(compressed(du, hn::LoadU(du, node.ref + i), hn::RebindMask(du, hit)), du,
                           top_);
                top_ += hn::CountTrue(df, hit);
            } else if constexpr (!in_register<Node>) {
                hn::Store(entry, df, entries + i);
            }
        }
        if (bits == 0)
            return false;
        if constexpr (!closest) {
            --top_;
            at = node.ref[std::bit_width(bits) - 1]; // what is on top, without waiting for it
        } else {
            at = nearest_child(node, bits, entries, entry, hit);
        }
        return true;
    }

    /// entries: of all lanes, or if they are `in_register` in `entry`; those of `hit` are bits.
    HWY_INLINE std::uint32_t nearest_child(const Node& node, std::uint32_t bits,
                                           [[maybe_unused]] const float* entries,
                                           [[maybe_unused]] V entry,
                                           [[maybe_unused]] hwy::HWY_NAMESPACE::Mask<D> hit) {
        const auto first = static_cast<std::uint32_t>(std::countr_zero(bits));
        const std::uint32_t others = bits & (bits - 1);
        if (others == 0)
            return node.ref[first];
#if BOXWOOD_SORTS_EIGHT
        if constexpr (in_register<Node>) {
            namespace hn = hwy::HWY_NAMESPACE;
            const hn::Rebind<std::uint32_t, D> du;
            const auto is_hit = hn::RebindMask(du, hit);
            const auto keys = keys_of(entry);
            const std::uint32_t ref = node.ref[hn::GetLane(min_key(keys, is_hit)) & 7];
            push_sorted_eight(node.ref, hn::IfThenElseZero(is_hit, keys), top_);
            top_ += std::popcount(others); // the nearest stays above the top
            fetch(top_[-1].ref);
            return ref;
        }
#endif
        if ((others & (others - 1)) == 0) {
            // Which is nearer is a coin's toss: no branch.
            const auto waits = [&](std::uint32_t lane) {
                return std::bit_cast<std::uint64_t>(WaitingNode{node.ref[lane], entries[lane]});
            };
            const auto second = static_cast<std::uint32_t>(std::countr_zero(others));
            const std::uint64_t a = waits(first), b = waits(second);
            const bool swap = entries[second] < entries[first];
            *top_ = std::bit_cast<WaitingNode>(swap ? a : b);
            fetch(top_++->ref);
            return std::bit_cast<WaitingNode>(swap ? b : a).ref;
        }
        push_sorted(node, bits, entries, top_);
        top_ += std::popcount(others);
        fetch(top_[-1].ref);
        return top_->ref;
    }

    HWY_INLINE void fetch(std::uint32_t ref) const {
        const bool leaf = ray_refs::is_leaf(ref);
        const std::byte* place =
            (leaf ? tree_.blocks : tree_.nodes) +
            (leaf ? sizeof(RayBlock<Node>) : sizeof(Node)) * std::size_t{ray_refs::index(ref)};
        for (std::size_t line = 0; line < std::max(sizeof(Node), sizeof(RayBlock<Node>));
             line += 64)
            hwy::Prefetch(place + line);
    }

    HWY_INLINE bool test(std::uint32_t at) {
        const auto* blocks = reinterpret_cast<const RayBlock<Node>*>(tree_.blocks);
        return test_leaf<Node, K>(blocks + ray_refs::index(at), at, ray_, state_);
    }

    const SingleRayTree& tree_;
    const Ray<float>& ray_;
    std::vector<RayHit> found_; ///< nothing: of RayMode::all
    RayState<K, mode, false> state_;
    Waiting* top_;
    alignas(64) Waiting stack_[room];
};

template <class Node, RayKernel K>
RayHit closest_alone(const SingleRayTree& tree, const Ray<float>& ray) {
    if (!is_finite(ray.origin) || !is_finite(ray.direction))
        return {};
    return RayAlone<Node, K, RayMode::closest>(tree, ray).trace();
}

template <class Node, RayKernel K>
bool any_alone(const SingleRayTree& tree, const Ray<float>& ray) {
    if (!is_finite(ray.origin) || !is_finite(ray.direction))
        return false;
    return RayAlone<Node, K, RayMode::any>(tree, ray).trace().hit();
}

/// None for an empty tree, nor for one that is too deep.
template <class Node>
SingleRayFunctions single_ray_functions_of(std::size_t depth, std::string_view kernel) {
    using Kernels = std::tuple<MollerTrumbore<float>, MollerTrumbore<double>, Watertight>;
    SingleRayFunctions functions;
    if (depth != 0 && room_for<Node>(depth) <= RayAlone<Node, Watertight, RayMode::closest>::room)
        with_kernel<Kernels>(kernel, [&]<class K>(std::type_identity<K>) {
            functions = {closest_alone<Node, K>, any_alone<Node, K>};
        });
    return functions;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
