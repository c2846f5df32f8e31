// Once per instruction set: include after <hwy/foreach_target.h>.
#if defined(BOXWOOD_RAY_PACKET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXWOOD_RAY_PACKET_INL_H
#undef BOXWOOD_RAY_PACKET_INL_H
#else
#define BOXWOOD_RAY_PACKET_INL_H
#endif

#include <hwy/cache_control.h>

#include "trees/traversals/rays/coherent_rays.h"
#include "trees/traversals/rays/ray_steps-inl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {

template <class Node> inline constexpr bool takes_packets = false;
template <std::size_t W> inline constexpr bool takes_packets<RayNode<W>> = W == 8;

/// Slabs of a packet side by side, and of one ray that is in front of all of them: its entry into a
/// box is not after any of theirs, its exit not before.
class PacketSlabs {
    static constexpr std::size_t n = packet_size;
    using D = hwy::HWY_NAMESPACE::CappedTag<float, n>;
    using V = hwy::HWY_NAMESPACE::Vec<D>;

  public:
    alignas(64) float t_min[n], t_max[n];

    void set(std::size_t r, const Ray<float>& ray, const FusedSlabs& slabs) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            rdir_[axis][r] = slabs.rdir[axis];
            entry_shift_[axis][r] = slabs.entry_shift[axis];
            exit_shift_[axis][r] = slabs.exit_shift[axis];
        }
        t_min[r] = ray.t_min;
        t_max[r] = ray.t_max;
    }

    /// Once all are set.
    HWY_INLINE FrontSlabs front(const SlabBounds& bounds) {
        namespace hn = hwy::HWY_NAMESPACE;
        const D d;
        FrontSlabs front{};
        is_mixed_ = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const V low = hn::Set(d, bounds.min[axis]), high = hn::Set(d, bounds.max[axis]);
            const V widest = hn::Set(d, bounds.widest[axis]);
            const V infinity = hn::Set(d, no_bound);
            V entry_low = infinity, entry_high = infinity, entry_size = hn::Zero(d);
            V exit_low = hn::Neg(infinity), exit_high = exit_low, exit_size = hn::Zero(d);
            std::size_t negative = 0;
            for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
                const V rdir = hn::Load(d, rdir_[axis] + i);
                const V es = hn::Load(d, entry_shift_[axis] + i);
                const V xs = hn::Load(d, exit_shift_[axis] + i);
                negative += hn::CountTrue(d, hn::Lt(rdir, hn::Zero(d)));
                entry_low = hn::Min(entry_low, hn::MulSub(low, rdir, es));
                entry_high = hn::Min(entry_high, hn::MulSub(high, rdir, es));
                exit_low = hn::Max(exit_low, hn::MulSub(low, rdir, xs));
                exit_high = hn::Max(exit_high, hn::MulSub(high, rdir, xs));
                entry_size = hn::Max(entry_size, hn::MulAdd(hn::Abs(rdir), widest, hn::Abs(es)));
                exit_size = hn::Max(exit_size, hn::MulAdd(hn::Abs(rdir), widest, hn::Abs(xs)));
            }
            const bool one_sign = negative == 0 || negative == n;
            is_mixed_ |= !one_sign;
            // Lines of both signs have no such bound: the axis says nothing.
            const float beyond = one_sign ? 0 : no_bound;
            const BoundingLine entry =
                line_below({bounds.min[axis], bounds.max[axis], least(entry_low), least(entry_high),
                            greatest(entry_size) + beyond, rdir_[axis][0]});
            const BoundingLine exit =
                line_above({bounds.min[axis], bounds.max[axis], greatest(exit_low),
                            greatest(exit_high), greatest(exit_size) + beyond, rdir_[axis][0]});
            front.entry_rdir[axis] = entry.rdir;
            front.entry_shift[axis] = entry.shift;
            front.exit_rdir[axis] = exit.rdir;
            front.exit_shift[axis] = exit.shift;
        }
        return front;
    }

    /// Which rays hit this child, each as NodeClip::hits_of has it.
    template <class Node>
    HWY_INLINE std::uint32_t hits_of(const Node& node, std::size_t child) const {
        return is_mixed_ ? hits<true>(node, child) : hits<false>(node, child);
    }

    /// The rays that do not end before `t`.
    HWY_INLINE std::uint32_t reaching(float t) const {
        namespace hn = hwy::HWY_NAMESPACE;
        const D d;
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < n; i += hn::Lanes(d))
            bits |= lane_bits(d, hn::Ge(hn::Load(d, t_max + i), hn::Set(d, t)), i);
        return bits;
    }

    HWY_INLINE float least_t_min() const { return *std::min_element(t_min, t_min + n); }
    HWY_INLINE float greatest_t_max() const {
        namespace hn = hwy::HWY_NAMESPACE;
        const D d;
        V most = hn::Load(d, t_max);
        for (std::size_t i = hn::Lanes(d); i < n; i += hn::Lanes(d))
            most = hn::Max(most, hn::Load(d, t_max + i));
        return greatest(most);
    }

  private:
    static constexpr float no_bound = std::numeric_limits<float>::infinity();

    static HWY_INLINE float least(V v) {
        namespace hn = hwy::HWY_NAMESPACE;
        return hn::GetLane(hn::MinOfLanes(D(), v));
    }
    static HWY_INLINE float greatest(V v) {
        namespace hn = hwy::HWY_NAMESPACE;
        return hn::GetLane(hn::MaxOfLanes(D(), v));
    }

    template <bool mixed, class Node>
    HWY_INLINE std::uint32_t hits(const Node& node, std::size_t child) const {
        namespace hn = hwy::HWY_NAMESPACE;
        const D d;
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
            V entry = hn::Load(d, t_min + i), exit = hn::Load(d, t_max + i);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const V rdir = hn::Load(d, rdir_[axis] + i);
                V near, far;
                if constexpr (mixed) {
                    const V min = hn::Set(d, node.plane[axis][child]);
                    const V max = hn::Set(d, node.plane[3 + axis][child]);
                    near = hn::IfNegativeThenElse(rdir, max, min);
                    far = hn::IfNegativeThenElse(rdir, min, max);
                } else {
                    const bool negative = std::signbit(rdir_[axis][0]);
                    near = hn::Set(d, node.plane[axis + (negative ? 3 : 0)][child]);
                    far = hn::Set(d, node.plane[axis + (negative ? 0 : 3)][child]);
                }
                entry = hn::Max(entry, hn::MulSub(near, rdir, hn::Load(d, entry_shift_[axis] + i)));
                exit = hn::Min(exit, hn::MulSub(far, rdir, hn::Load(d, exit_shift_[axis] + i)));
            }
            bits |= lane_bits(d, hn::Le(entry, exit), i);
        }
        return bits;
    }

    alignas(64) float rdir_[3][n], entry_shift_[3][n], exit_shift_[3][n];
    bool is_mixed_ = false; ///< directions of both signs on some axis
};

/// Coherent rays from the root to their answers, sixteen together: a node is read once, the ray in
/// front of all says which children there are to think of and which is nearest, and then all rays
/// are tested against each of those. Each goes only where it would alone. Where few are left in a
/// subtree, they go on alone; in leaves each meets all triangles by itself.
template <class Node, RayKernel K, RayMode mode> class RayPacket {
    static constexpr bool closest = mode == RayMode::closest;
    /// So many rays are sooner through a subtree one by one.
    static constexpr int few = 2;

  public:
    RayPacket(const RayJob& job, const SlabBounds& bounds)
        : job_(job), bounds_(bounds),
          nodes_(reinterpret_cast<const Node*>(job.triangles.nodes.data())),
          blocks_(reinterpret_cast<const RayBlock<Node>*>(job.triangles.blocks.data())),
          waiting_(room_for<Node>(job.depth)), alone_(room_for<Node>(job.depth)) {}

    void trace(std::size_t first) {
        for (std::size_t r = 0; r < packet_size; ++r) {
            const Ray<float>& ray = job_.rays[first + r];
            own_[r] = FusedSlabs(ray, bounds_);
            slabs_.set(r, ray, own_[r]);
            states_[r].emplace(ray, nullptr, found_);
        }
        rays_ = job_.rays.data() + first;
        const NodeClip<Node> front(slabs_.front(bounds_), slabs_.least_t_min());
        t_max_ = slabs_.greatest_t_max();
        constexpr std::uint32_t all = (std::uint32_t{1} << packet_size) - 1;
        Waiting* const bottom = waiting_.data();
        Waiting* top = bottom;
        *top++ = {job_.triangles.root, all, 0};
        while (top != bottom) {
            const Waiting next = *--top;
            const std::uint32_t rays = next.rays & slabs_.reaching(next.entry);
            if (rays == 0)
                continue;
            if (ray_refs::is_leaf(next.ref)) {
                test(next.ref, rays);
            } else if (std::popcount(rays) <= few) {
                for_each_of(rays, [&](std::size_t r) HWY_ATTR { go_alone(r, next.ref); });
                t_max_ = slabs_.greatest_t_max();
            } else {
                top = open(nodes_[next.ref], front, rays, top);
            }
        }
        for (std::size_t r = 0; r < packet_size; ++r)
            job_.hits[first + r] = states_[r]->result();
    }

  private:
    struct Waiting {
        std::uint32_t ref, rays;
        float entry; ///< not after any of the rays'
    };

    template <class F> static HWY_INLINE void for_each_of(std::uint32_t rays, const F& f) {
        for (; rays != 0; rays &= rays - 1)
            f(static_cast<std::size_t>(std::countr_zero(rays)));
    }

    /// Children that a ray hits wait, for the closest hit the farthest first. Gives the new top.
    HWY_INLINE Waiting* open(const Node& node, const NodeClip<Node>& front, std::uint32_t rays,
                             Waiting* top) {
        namespace hn = hwy::HWY_NAMESPACE;
        const NodeTag<Node> df;
        const auto t_max = hn::Set(df, t_max_);
        alignas(64) float entries[Node::width];
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < Node::width; i += hn::Lanes(df)) {
            hn::Vec<decltype(df)> entry;
            bits |= lane_bits(df, front.hits_of(node, i, t_max, entry), i);
            hn::Store(entry, df, entries + i);
        }
        std::size_t n = 0;
        for (; bits != 0; bits &= bits - 1) {
            const auto child = static_cast<std::size_t>(std::countr_zero(bits));
            const std::uint32_t hit = rays & slabs_.hits_of(node, child);
            if (hit == 0)
                continue;
            fetch(node.ref[child]);
            std::size_t place = n++;
            if constexpr (closest)
                for (; place > 0 && top[place - 1].entry < entries[child]; --place)
                    top[place] = top[place - 1];
            top[place] = {node.ref[child], hit, entries[child]};
        }
        return top + n;
    }

    HWY_INLINE void fetch(std::uint32_t ref) const {
        const std::uint32_t index = ray_refs::index(ref);
        const auto* place = ray_refs::is_leaf(ref)
                                ? reinterpret_cast<const std::byte*>(blocks_ + index)
                                : reinterpret_cast<const std::byte*>(nodes_ + index);
        for (std::size_t line = 0; line < sizeof(Node); line += 64)
            hwy::Prefetch(place + line);
    }

    void test(std::uint32_t ref, std::uint32_t rays) {
        bool any_nearer = false;
        for_each_of(rays, [&](std::size_t r) HWY_ATTR { any_nearer |= test_one(r, ref); });
        if (any_nearer)
            t_max_ = slabs_.greatest_t_max();
    }

    /// Whether the ray ends sooner now.
    HWY_INLINE bool test_one(std::size_t r, std::uint32_t ref) {
        const bool done =
            test_leaf<Node, K>(blocks_ + ray_refs::index(ref), ref, rays_[r], *states_[r]);
        const float t_max = done ? -std::numeric_limits<float>::infinity() : states_[r]->t_max();
        const bool nearer = t_max < slabs_.t_max[r];
        slabs_.t_max[r] = t_max;
        return nearer;
    }

    void go_alone(std::size_t r, std::uint32_t ref) {
        const NodeClip<Node> clip(own_[r], slabs_.t_min[r]);
        WaitingNode* const bottom = alone_.data();
        WaitingNode* top = bottom;
        *top++ = {ref, 0};
        while (top != bottom) {
            const WaitingNode next = *--top;
            if (next.entry > slabs_.t_max[r])
                continue;
            if (ray_refs::is_leaf(next.ref))
                test_one(r, next.ref);
            else
                top = push_hit_children<true>(nodes_[next.ref], clip, slabs_.t_max[r], top);
        }
    }

    const RayJob& job_;
    const SlabBounds& bounds_;
    const Node* const nodes_;
    const RayBlock<Node>* const blocks_;
    Buffer<Waiting> waiting_;
    Buffer<WaitingNode> alone_;
    const Ray<float>* rays_ = nullptr;
    float t_max_ = 0; ///< the greatest of all
    PacketSlabs slabs_;
    std::array<FusedSlabs, packet_size> own_;
    std::array<std::optional<RayState<K, mode, false>>, packet_size> states_;
    std::vector<RayHit> found_; ///< nothing: of RayMode::all
};

/// Answers the packets of a job that are coherent.
template <class Node, RayKernel K, RayMode mode>
PacketSet trace_packets(const RayJob& job, const SlabBounds& bounds) {
    PacketSet answered;
    if (job.depth == 0)
        return answered;
    std::optional<RayPacket<Node, K, mode>> packet;
    for (std::size_t i = 0; (i + 1) * packet_size <= job.rays.size(); ++i) {
        if (!are_coherent(job.rays.subspan(i * packet_size, packet_size), bounds))
            continue;
        if (!packet)
            packet.emplace(job, bounds);
        packet->trace(i * packet_size);
        answered.add(i);
    }
    return answered;
}

} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
