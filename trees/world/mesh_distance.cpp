/// How far two meshes are apart.
///
/// First straight down to leaves a few times, for an upper bound: by the centres of blocks, then by
/// the bounds of their distances. Then the pair of blocks with the least bound first; depth first,
/// the nearest part on top, where too many wait, and where the first pair that is near enough ends
/// it. A step opens both blocks at once: bounds of the distances of boxes in
/// floats, eight at a time; where rounding leaves it open whether a bound is below what is wanted,
/// the gap in doubles. Pairs of leaves: bounds of the distances of triangles by their boxes and
/// along their normals; what is left is gathered and measured eight pairs at a time. Each measured
/// pair is bounded from below by the gap along the line of its nearest points. Where that does not
/// do, the certified kernel decides, at the end, for what is then still near enough.

// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/world/mesh_distance.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/arithmetic/float_mode.h"
#include "kernels/triangle_distance/features.h"
#include "kernels/triangle_distance/features_batch.h"
#include "trees/world/detail/bound_queue.h"
#include "trees/world/detail/box_gap.h"
#include "trees/world/detail/entry_stack.h"
#include "trees/world/detail/leaf_bounds-inl.h"
#include "trees/world/detail/nearest_candidates.h"
#include "trees/world/mesh_pairs.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

template <bool counted, bool plain> class Search {
  public:
    Search(const MeshTree& a, const MeshTree& b, const Pose& pose, const DistanceGoal& goal,
           Work* work)
        : a_(a), b_(b), frame_(a, b, pose), nearest_(goal, 0x1p18 * frame_.moved),
          stack_(max_entries(a.depth(), b.depth())), ends_at_first_(goal.ends_at_first),
          work_(work) {
        if (goal.options.start)
            measure_start(*goal.options.start);
        else
            descend();
    }

    MeshDistance run() {
        descend_by_bounds();
        if (ends_at_first_)
            go_down(0);
        else if (!stack_.empty() && !nearest_.is_done())
            search_the_rest();
        measure_queue();
        return nearest_.found();
    }

  private:
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    void search_the_rest() {
        BoundQueue waiting(nearest_.wanted_f32());
        for (;;) {
            if (!waiting.has_room_for(stack_.size()))
                go_down(waiting.size());
            if (nearest_.is_done()) // what is left on the stack may not have room
                return;
            while (!stack_.empty())
                waiting.push(stack_.pop());
            if (waiting.empty())
                return;
            const NearEntry next = waiting.pop();
            if (next.bound < nearest_.wanted_f32())
                expand<false>(next, waiting.size());
        }
    }
    /// The parts go on the stack; descending: the nearest of them on top.
    template <bool descending> HWY_INLINE void expand(const NearEntry& open, std::size_t waiting) {
        nearest_part_ = {};
        count_visit(waiting + 1);
        if (is_leaf(open.a) && is_leaf(open.b))
            compare_leaves(open);
        else if (is_leaf(open.a))
            open_b<descending>(open);
        else if (is_leaf(open.b))
            open_a<descending>(open);
        else
            open_both<descending>(open);
        if (nearest_part_.place != none)
            std::swap(*stack_.from(nearest_part_.place), *stack_.from(stack_.size() - 1));
    }
    /// All that is on the stack, to the leaves.
    HWY_NOINLINE void go_down(std::size_t waiting) {
        while (!stack_.empty() && !nearest_.is_done()) {
            const NearEntry open = stack_.pop();
            if (open.bound < nearest_.wanted_f32())
                expand<true>(open, waiting + stack_.size());
        }
    }

    // The descents.

    static constexpr int descents = 2;

    void descend() {
        if (is_leaf(a_.root()) && is_leaf(b_.root()))
            return;              // descend_by_bounds compares them
        std::uint32_t tried = 0; // lanes of a root
        Pair last{~0u, ~0u};
        for (int i = 0; i < descents && !nearest_.is_done(); ++i) {
            Pair at{a_.root(), b_.root()};
            for (bool is_root = true; !is_leaf(at.a) || !is_leaf(at.b); is_root = false) {
                count_visit(0);
                if (!to_nearest_children(at, is_root ? &tried : nullptr))
                    return;
            }
            if (at == last)
                continue;
            count_visit(0);
            compare_leaves({0, at.a, at.b});
            measure_queue();
            last = at;
        }
    }

    /// Straight down once more, to the part with the least bound; the others stay on the stack.
    void descend_by_bounds() {
        if (nearest_.is_done())
            return;
        NearEntry at{0, a_.root(), b_.root()};
        while (!is_leaf(at.a) || !is_leaf(at.b)) {
            const std::size_t before = stack_.size();
            expand<true>(at, before);
            if (stack_.size() == before)
                return;
            at = stack_.pop();
        }
        count_visit(stack_.size() + 1);
        compare_leaves(at);
        measure_queue();
    }

    /// To the lane of B whose centre is nearest to A's, if B is no leaf, then to the lane of A that
    /// is nearest to that. tried: lanes of the first of the two choices that were taken before; no
    /// if there is none left.
    bool to_nearest_children(Pair& at, std::uint32_t* tried) {
        Vec3<double> from_b; // in A's frame
        if (is_leaf(at.b)) {
            const double(&c)[3] = b_.leaf(at.b).own.centre;
            from_b = frame_.pose(Vec3<double>{c[0], c[1], c[2]});
        } else {
            const ObbBlock& b = b_.block(at.b);
            const double(&a)[3] =
                is_leaf(at.a) ? a_.leaf(at.a).own.centre : a_.block(at.a).own.centre;
            // A's centre in B's frame: the inverse of the pose.
            const Vec3<double> t = Vec3<double>{a[0], a[1], a[2]} - frame_.pose.translation;
            const auto& r = frame_.pose.rotation;
            const std::size_t lane = nearest_lane(b, t.x * r[0] + t.y * r[1] + t.z * r[2], tried);
            if (lane == ObbBlock::width)
                return false;
            tried = nullptr;
            from_b = frame_.pose(
                Vec3<double>{b.centre_f64[0][lane], b.centre_f64[1][lane], b.centre_f64[2][lane]});
            at.b = b.ref[lane];
        }
        if (is_leaf(at.a))
            return true;
        const ObbBlock& a = a_.block(at.a);
        const std::size_t lane = nearest_lane(a, from_b, tried);
        if (lane == ObbBlock::width)
            return false;
        at.a = a.ref[lane];
        return true;
    }

    HWY_INLINE void count_visit(std::size_t waiting) {
        if constexpr (counted) {
            ++work_->node_visits;
            work_->stack_max = std::max<std::uint64_t>(work_->stack_max, waiting);
        }
    }

    // A step.

    template <bool with_keys, class Centre>
    HWY_INLINE std::uint32_t bound_lanes(const SeenBox& one, const Centre& centre,
                                         const float (&axis)[3][3][8], const float (&half)[3][8],
                                         std::uint32_t count, float error, float* bounds,
                                         float* keys) {
        std::uint32_t bits = 0;
        const F8 wanted = hn::Set(d8, nearest_.wanted_f32());
        for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
            const CentreOffsets offsets(one, centre, i);
            const F8 bound =
                hn::Max(hn::Sub(distance_bound(one, offsets, axis, half, i), hn::Set(d8, error)),
                        hn::Zero(d8));
            hn::StoreU(bound, d8, bounds + i);
            if constexpr (with_keys)
                hn::StoreU(offsets.squared(), d8, keys + i);
            std::uint8_t part[8] = {};
            hn::StoreMaskBits(d8, hn::Lt(bound, wanted), part);
            bits |= static_cast<std::uint32_t>(part[0]) << i;
        }
        if constexpr (counted)
            work_->box_tests += 8;
        return bits & ((1u << count) - 1);
    }
    /// That with the least bound, of equal ones (many are 0) with the nearest centres.
    struct NearestPart {
        float bound = std::numeric_limits<float>::infinity(), key = bound;
        std::size_t place = none; ///< on the stack
    };
    template <bool descending>
    HWY_INLINE void put(float bound, float key, std::uint32_t a, std::uint32_t b) {
        if constexpr (descending)
            if (std::pair(bound, key) < std::pair(nearest_part_.bound, nearest_part_.key))
                nearest_part_ = {bound, key, stack_.size()};
        stack_.push({bound, a, b});
    }

    /// The bounds, from which `error` was taken, that leave open what doubles might not.
    float ties_from(float error) const {
        return nearest_.wanted_f32() * (1 - 0x1p-18f) - 2 * error;
    }

    template <bool descending> HWY_INLINE void open_both(const NearEntry& open) {
        const ObbBlock& a = a_.block(open.a);
        const ObbBlock& b = b_.block(open.b);
        const Vec3<double> t = frame_.between(a.own.centre, b.own.centre);
        const float error = 2 * frame_.error(t, a.own, b.own), tie = ties_from(error);
        SeenBoxes seen;
        see_lanes(b, frame_, t, seen);
        alignas(64) float bounds[8], keys[8];
        std::uint32_t near = bound_lanes<false>(PairFrame::seen_a(a.own), seen.centre, seen.axis,
                                                b.half, b.count, error, bounds, keys);
        for (; near != 0; near &= near - 1) {
            const auto j = static_cast<std::size_t>(std::countr_zero(near));
            std::uint32_t hits = bound_lanes<descending>(seen.lane(j), a.centre, a.axis, a.half,
                                                         a.count, error, bounds, keys);
            for (; hits != 0; hits &= hits - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(hits));
                if (bounds[i] < tie ||
                    box_gap(BoxF64(a, i), BoxF64(b, j), frame_) < nearest_.wanted())
                    put<descending>(bounds[i], keys[i], a.ref[i], b.ref[j]);
            }
        }
    }
    template <bool descending> HWY_INLINE void open_b(const NearEntry& open) {
        const PosedBox& own = a_.leaf(open.a).own;
        const ObbBlock& b = b_.block(open.b);
        const Vec3<double> t = frame_.between(own.centre, b.own.centre);
        const float error = 2 * frame_.error(t, own, b.own), tie = ties_from(error);
        SeenBoxes seen;
        see_lanes(b, frame_, t, seen);
        alignas(64) float bounds[8], keys[8];
        std::uint32_t near = bound_lanes<descending>(PairFrame::seen_a(own), seen.centre, seen.axis,
                                                     b.half, b.count, error, bounds, keys);
        for (; near != 0; near &= near - 1) {
            const auto j = static_cast<std::size_t>(std::countr_zero(near));
            if (bounds[j] < tie || box_gap(BoxF64(own), BoxF64(b, j), frame_) < nearest_.wanted())
                put<descending>(bounds[j], keys[j], open.a, b.ref[j]);
        }
    }
    template <bool descending> HWY_INLINE void open_a(const NearEntry& open) {
        const ObbBlock& a = a_.block(open.a);
        const PosedBox& own = b_.leaf(open.b).own;
        const Vec3<double> t = frame_.between(a.own.centre, own.centre);
        const float error = 2 * frame_.error(t, a.own, own), tie = ties_from(error);
        alignas(64) float bounds[8], keys[8];
        std::uint32_t near = bound_lanes<descending>(frame_.seen_b(own, t), a.centre, a.axis,
                                                     a.half, a.count, error, bounds, keys);
        for (; near != 0; near &= near - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(near));
            if (bounds[i] < tie || box_gap(BoxF64(a, i), BoxF64(own), frame_) < nearest_.wanted())
                put<descending>(bounds[i], keys[i], a.ref[i], open.b);
        }
    }

    // Leaves.

    HWY_INLINE void compare_leaves(const NearEntry& open) {
        const TriangleLeaf& a = a_.leaf(open.a);
        const TriangleLeaf& b = b_.leaf(open.b);
        if (gap_of_corners(a, b, frame_) >= nearest_.wanted())
            return;
        const LeafPair leaves(a, b, frame_);
        struct Near {
            float bound;
            std::uint32_t lanes; // 8 i + j
        };
        Near found[64];
        std::size_t n = 0;
        for (std::size_t i = 0; i < a.count; ++i) {
            alignas(64) float bounds[8];
            std::uint32_t near =
                leaves.bound_triangles(i, nearest_.wanted_f32(), bounds) & ((1u << b.count) - 1);
            for (; near != 0; near &= near - 1) {
                const auto j = static_cast<std::uint32_t>(std::countr_zero(near));
                found[n++] = {bounds[j], static_cast<std::uint32_t>(8 * i) + j};
            }
        }
        const auto add = [&](const Near& pair) HWY_ATTR {
            queue_.add(a, pair.lanes / 8, b, leaves.moved(), pair.lanes % 8);
        };
        Near* from = found;
        Near* end = found + n;
        while (end - from > 8) { // the nearest first, eight at a time
            Near* const next = from + (8 - queue_.size() % 8);
            std::nth_element(from, next, end,
                             [](const Near& x, const Near& y) { return x.bound < y.bound; });
            for (; from != next; ++from)
                add(*from);
            measure_queue();
            if (nearest_.is_done())
                return;
            end = std::remove_if(from, end,
                                 [&](const Near& x) { return x.bound >= nearest_.wanted_f32(); });
        }
        for (; from != end; ++from)
            add(*from);
        if (queue_.size() >= 8)
            measure_queue();
    }

    // Pairs of triangles.

    HWY_NOINLINE void measure_queue() {
        if (queue_.size() == 0 || nearest_.is_done())
            return;
        queue_.pad();
        const std::size_t n = queue_.size();
        FeaturesF64Batch::distance(queue_.blocks(), {distances_, n});
        if constexpr (counted)
            work_->triangle_tests += n;
        if constexpr (plain) {
            for (std::size_t i = 0; i < n && !nearest_.is_done(); ++i)
                nearest_.offer_plain(distances_[i], queue_.triangles(i));
        } else {
            for (std::size_t begin = 0; begin < n && !nearest_.is_done(); begin += 8)
                judge(begin, std::min<std::size_t>(8, n - begin));
        }
        queue_.clear();
    }

    /// Up to eight measured pairs: lowers the best, and keeps what may still be nearer than it was
    /// measured.
    HWY_INLINE void judge(std::size_t begin, std::size_t count) {
        alignas(64) double way[3][8], lower[8];
        for (std::size_t i = 0; i < 8; ++i) {
            const Distance& found = distances_[begin + std::min(i, count - 1)];
            const Vec3<double> n = found.point_b - found.point_a;
            way[0][i] = n.x, way[1][i] = n.y, way[2][i] = n.z;
        }
        gaps_along(way, queue_.blocks()[begin / 8], frame_.moved, lower);
        for (std::size_t i = 0; i < count && !nearest_.is_done(); ++i) {
            const Distance& found = distances_[begin + i];
            if (found.distance < nearest_.best() || lower[i] < nearest_.wanted())
                nearest_.offer(queue_.triangle(0, begin + i), queue_.triangle(1, begin + i),
                               queue_.triangles(begin + i), found.distance, lower[i]);
        }
    }

    void measure_start(Pair start) {
        if (start.a >= a_.size() || start.b >= b_.size())
            throw std::invalid_argument("the pair of triangles to start with is not there");
        const Triangle<double> a = a_.triangle(start.a, Pose{}),
                               b = b_.triangle(start.b, frame_.pose);
        if constexpr (plain)
            nearest_.offer_plain(FeaturesF64::distance(a, b), start);
        else
            nearest_.offer(a, b, start);
    }

    const MeshTree &a_, &b_;
    PairFrame frame_;
    NearestCandidates nearest_;
    EntryStack<NearEntry> stack_;
    PairBlocks<16> queue_; // seven, and eight more
    Distance distances_[16];
    NearestPart nearest_part_; ///< of those put on the stack in this step
    bool ends_at_first_;       ///< then what is nearest is looked at first, down to the leaves
    Work* work_;
};

MeshDistance find_nearest(const MeshTree& a, const MeshTree& b, const Pose& pose,
                          const DistanceGoal& goal, Work* work) {
    const auto run = [&]<bool plain>(std::bool_constant<plain>) HWY_ATTR {
        if (work)
            return Search<true, plain>(a, b, pose, goal, work).run();
        return Search<false, plain>(a, b, pose, goal, nullptr).run();
    };
    return goal.is_plain ? run(std::true_type{}) : run(std::false_type{});
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
namespace detail {
HWY_EXPORT(find_nearest);
} // namespace detail

namespace {

MeshDistance search(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                    const detail::DistanceGoal& goal, Work* work) {
    if (a.empty() || b.empty())
        return {};
    return without_flushing([&] {
        using namespace detail;
        return HWY_DYNAMIC_DISPATCH(find_nearest)(a, b, b_in_a, goal, work);
    });
}

} // namespace

MeshDistance distance(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                      const DistanceOptions& options, Work* work) {
    return search(a, b, b_in_a, detail::goal_of(options), work);
}

MeshDistance plain_distance(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                            const DistanceOptions& options, Work* work) {
    detail::DistanceGoal goal = detail::goal_of(options);
    goal.is_plain = true;
    return search(a, b, b_in_a, goal, work);
}

MeshWithin within(const MeshTree& a, const MeshTree& b, const Pose& b_in_a, double tolerance,
                  Work* work) {
    return without_flushing([&] {
        return detail::within_by(search(a, b, b_in_a, detail::goal_within(tolerance), work),
                                 tolerance);
    });
}

} // namespace boxwood
#endif
