/// Which triangles of two meshes share a point, or are near each other.
///
/// First the spheres around all of both, and the boxes, along 15 axes. Then a step takes a pair of
/// blocks and opens both at once. B's eight boxes are moved into A's frame and tested against the
/// box around A's block; each that is left against A's eight boxes. Pairs of leaves: B's corners
/// are moved in doubles, boxes of triangles are compared, and what is left goes to the exact
/// kernel, 64 pairs at a time, or eight where the first hit will do. For near ones all boxes of one
/// side reach so much farther, and the certified distance decides, pair by pair.

// Compiled once per instruction set; the best one is chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trees/world/mesh_collide.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.
#include <hwy/highway.h>

#include "kernels/arithmetic/float_mode.h"
#include "kernels/triangle_distance/certified.h"
#include "kernels/triangle_triangle/guigue_devillers_batch.h"
#include "trees/world/detail/entry_stack.h"
#include "trees/world/detail/leaf_lanes-inl.h"
#include "trees/world/detail/obb_lanes-inl.h"
#include "trees/world/mesh_pairs.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <utility>

#ifndef BOXWOOD_MESH_COLLIDE_ONCE
#define BOXWOOD_MESH_COLLIDE_ONCE
namespace boxwood::detail {

/// Which pairs of triangles are looked for.
enum class Wanted : std::uint8_t { first_touch, touches, near };

} // namespace boxwood::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace boxwood::detail::HWY_NAMESPACE {
namespace {

/// The lanes of eight boxes that one box may overlap, or whose gap is at most `most`, as bits;
/// their greatest gaps if wanted.
template <bool with_gaps, class Centre>
HWY_INLINE std::uint32_t overlapping(const SeenBox& one, const Centre& centre,
                                     const float (&axis)[3][3][8], const float (&half)[3][8],
                                     std::uint32_t count, float most, float* gaps) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 8; i += hn::Lanes(d8)) {
        const F8 gap = greatest_gap(one, CentreOffsets(one, centre, i), axis, half, i);
        if constexpr (with_gaps)
            hn::StoreU(gap, d8, gaps + i);
        std::uint8_t part[8] = {};
        hn::StoreMaskBits(d8, hn::Le(gap, hn::Set(d8, most)), part);
        bits |= static_cast<std::uint32_t>(part[0]) << i;
    }
    return bits & ((1u << count) - 1);
}

template <Wanted wanted, bool counted> class Collision {
    static constexpr bool first_hit = wanted == Wanted::first_touch;

  public:
    /// The frame must outlive it. reach: of near ones.
    Collision(const MeshTree& a, const MeshTree& b, const PairFrame& frame, std::size_t limit,
              std::vector<Pair>* pairs, Work* work, double reach = 0)
        : a_(a), b_(b), frame_(frame), stack_(max_entries(a.depth(), b.depth())), limit_(limit),
          pairs_(pairs), work_(work), reach_(reach) {}

    bool run() { return run({a_.root(), b_.root()}) || finish(); }

    /// From these blocks down. True once enough is known.
    bool run(Pair from) {
        stack_.push(from);
        while (!stack_.empty()) {
            const Pair pair = stack_.pop();
            if (!are_leaves(pair))
                open(pair);
            else if (count_visit(); compare_leaves(pair))
                return true;
        }
        return false;
    }
    bool finish() { return queue_.size() > 0 && decide(); }

    /// Pairs of blocks, at least `enough` of them if there are, below which is all that touches.
    std::vector<Pair> front(std::size_t enough) {
        std::vector<Pair> front{{a_.root(), b_.root()}};
        while (front.size() < enough && !std::ranges::all_of(front, are_leaves)) {
            std::vector<Pair> next;
            for (const Pair pair : front) {
                if (are_leaves(pair)) {
                    next.push_back(pair);
                    continue;
                }
                open(pair);
                next.insert(next.end(), stack_.from(0), stack_.from(stack_.size()));
                stack_.clear();
            }
            front = std::move(next);
        }
        return front;
    }

  private:
    static bool are_leaves(Pair pair) { return is_leaf(pair.a) && is_leaf(pair.b); }
    /// How large a gap in floats may be, of boxes of these two.
    HWY_INLINE float most(const Vec3<double>& t, const PosedBox& a, const PosedBox& b) const {
        const float error = frame_.error(t, a, b);
        if constexpr (wanted == Wanted::near)
            return static_cast<float>((double{error} + reach_) * (1 + 0x1p-20));
        return error;
    }

    /// Not two leaves.
    HWY_INLINE void open(Pair pair) {
        count_visit();
        if (is_leaf(pair.a))
            open_b(pair);
        else if (is_leaf(pair.b))
            open_a(pair);
        else
            open_both(pair);
    }
    HWY_INLINE void open_both(Pair open) {
        const ObbBlock& a = a_.block(open.a);
        const ObbBlock& b = b_.block(open.b);
        const Vec3<double> t = frame_.between(a.own.centre, b.own.centre);
        const float most = this->most(t, a.own, b.own);
        SeenBoxes seen;
        see_lanes(b, frame_, t, seen);
        std::uint32_t near = overlapping<false>(PairFrame::seen_a(a.own), seen.centre, seen.axis,
                                                b.half, b.count, most, nullptr);
        count_tests(8);
        const std::size_t first = stack_.size();
        std::size_t deepest = first;
        float least = std::numeric_limits<float>::infinity();
        for (; near != 0; near &= near - 1) {
            const auto j = static_cast<std::size_t>(std::countr_zero(near));
            alignas(32) float gaps[8];
            std::uint32_t hits =
                overlapping<first_hit>(seen.lane(j), a.centre, a.axis, a.half, a.count, most, gaps);
            count_tests(8);
            for (; hits != 0; hits &= hits - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(hits));
                if (first_hit && gaps[i] < least) {
                    least = gaps[i];
                    deepest = stack_.size();
                }
                stack_.push({a.ref[i], b.ref[j]});
            }
        }
        if (first_hit && stack_.size() > first + 1)
            std::swap(*stack_.from(deepest), *stack_.from(stack_.size() - 1));
    }
    /// A's is a leaf.
    HWY_INLINE void open_b(Pair open) {
        const PosedBox& own = a_.leaf(open.a).own;
        const ObbBlock& b = b_.block(open.b);
        const Vec3<double> t = frame_.between(own.centre, b.own.centre);
        SeenBoxes seen;
        see_lanes(b, frame_, t, seen);
        std::uint32_t near = overlapping<false>(PairFrame::seen_a(own), seen.centre, seen.axis,
                                                b.half, b.count, most(t, own, b.own), nullptr);
        count_tests(8);
        for (; near != 0; near &= near - 1)
            stack_.push({open.a, b.ref[static_cast<std::size_t>(std::countr_zero(near))]});
    }
    /// B's is a leaf.
    HWY_INLINE void open_a(Pair open) {
        const ObbBlock& a = a_.block(open.a);
        const PosedBox& own = b_.leaf(open.b).own;
        const Vec3<double> t = frame_.between(a.own.centre, own.centre);
        std::uint32_t near = overlapping<false>(frame_.seen_b(own, t), a.centre, a.axis, a.half,
                                                a.count, most(t, a.own, own), nullptr);
        count_tests(8);
        for (; near != 0; near &= near - 1)
            stack_.push({a.ref[static_cast<std::size_t>(std::countr_zero(near))], open.b});
    }

    /// True once enough is known.
    HWY_INLINE bool compare_leaves(Pair open) {
        const TriangleLeaf& a = a_.leaf(open.a);
        const TriangleLeaf& b = b_.leaf(open.b);
        const MovedLeaf moved(b, frame_.pose);
        const NearCorners near_a(a, a.own.centre), near_b(moved, a.own.centre);
        NearBoxes boxes_a(near_a);
        const NearBoxes boxes_b(near_b);
        if constexpr (wanted == Wanted::near)
            grow(boxes_a, most(frame_.between(a.own.centre, b.own.centre), a.own, b.own));
        const std::uint32_t used = (1u << b.count) - 1;
        for (std::size_t i = 0; i < a.count; ++i) {
            std::uint32_t near = 0;
            for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d8)) {
                auto apart = hn::FirstN(d8, 0);
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const auto low = hn::Load(d8, boxes_b.low[axis] + lane);
                    const auto high = hn::Load(d8, boxes_b.high[axis] + lane);
                    apart = hn::Or(apart, hn::Or(hn::Lt(hn::Set(d8, boxes_a.high[axis][i]), low),
                                                 hn::Gt(hn::Set(d8, boxes_a.low[axis][i]), high)));
                }
                std::uint8_t part[8] = {};
                hn::StoreMaskBits(d8, hn::Not(apart), part);
                near |= static_cast<std::uint32_t>(part[0]) << lane;
            }
            for (near &= used; near != 0; near &= near - 1)
                queue_.add(a, i, b, moved, static_cast<std::size_t>(std::countr_zero(near)));
        }
        // A leaf pair adds up to 64. A block of eight takes no longer than one pair.
        return (first_hit ? queue_.size() >= 8 : !queue_.has_room_for(64)) && decide();
    }

    static void grow(NearBoxes& boxes, float by) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t lane = 0; lane < 8; ++lane) {
                boxes.low[axis][lane] -= by;
                boxes.high[axis][lane] += by;
            }
    }

    HWY_NOINLINE bool decide() {
        if constexpr (wanted == Wanted::near)
            return decide_near();
        queue_.pad();
        const std::size_t n = queue_.size();
        GuigueDevillersExactBatch::intersect(queue_.blocks(), {decisions_, n});
        if constexpr (counted)
            work_->triangle_tests += n;
        bool done = false;
        for (std::size_t i = 0; i < n && !done; ++i)
            if (decisions_[i].answer == Answer::yes) {
                if constexpr (counted)
                    ++work_->answers;
                if constexpr (first_hit) {
                    done = true;
                } else {
                    pairs_->push_back(queue_.triangles(i));
                    done = pairs_->size() >= limit_;
                }
            }
        queue_.clear();
        return done;
    }

    bool decide_near() {
        if constexpr (counted)
            work_->triangle_tests += queue_.size();
        bool done = false;
        for (std::size_t i = 0; i < queue_.size() && !done; ++i)
            if (CertifiedDistance::distance(queue_.triangle(0, i), queue_.triangle(1, i)).lo <=
                reach_) {
                if constexpr (counted)
                    ++work_->answers;
                pairs_->push_back(queue_.triangles(i));
                done = pairs_->size() >= limit_;
            }
        queue_.clear();
        return done;
    }

    HWY_INLINE void count_visit() {
        if constexpr (counted) {
            ++work_->node_visits;
            work_->stack_max = std::max<std::uint64_t>(work_->stack_max, stack_.size() + 1);
        }
    }
    HWY_INLINE void count_tests(std::uint64_t n) {
        if constexpr (counted)
            work_->box_tests += n;
    }

    const MeshTree &a_, &b_;
    const PairFrame& frame_;
    EntryStack<Pair> stack_;
    PairBlocks<128> queue_;
    Decision decisions_[128];
    std::size_t limit_;
    std::vector<Pair>* pairs_;
    Work* work_;
    double reach_;
};

/// One test of the boxes around all of both, before eight by eight.
bool roots_parted(const MeshTree& a, const MeshTree& b, const PairFrame& frame, Work* work,
                  double reach = 0) {
    if (work) {
        ++work->node_visits;
        ++work->box_tests;
    }
    return frame.parted(a.own(a.root()), b.own(b.root()), reach);
}

bool first_touch(const MeshTree& a, const MeshTree& b, const Pose& pose, Work* work) {
    const PairFrame frame(a, b, pose);
    if (roots_parted(a, b, frame, work))
        return false;
    if (work)
        return Collision<Wanted::first_touch, true>(a, b, frame, 1, nullptr, work).run();
    return Collision<Wanted::first_touch, false>(a, b, frame, 1, nullptr, nullptr).run();
}
void all_touches(const MeshTree& a, const MeshTree& b, const Pose& pose, std::size_t limit,
                 std::vector<Pair>& pairs, Work* work) {
    const PairFrame frame(a, b, pose);
    if (roots_parted(a, b, frame, work))
        return;
    if (work)
        Collision<Wanted::touches, true>(a, b, frame, limit, &pairs, work).run();
    else
        Collision<Wanted::touches, false>(a, b, frame, limit, &pairs, nullptr).run();
}
void all_near(const MeshTree& a, const MeshTree& b, const Pose& pose, double reach,
              std::size_t limit, std::vector<Pair>& pairs, Work* work) {
    const PairFrame frame(a, b, pose);
    if (roots_parted(a, b, frame, work, reach))
        return;
    Work unused;
    Collision<Wanted::near, true>(a, b, frame, limit, &pairs, work ? work : &unused, reach).run();
}

void all_touches_by(const MeshTree& a, const MeshTree& b, const Pose& pose,
                    const Executor& executor, std::vector<Pair>& pairs) {
    constexpr std::size_t enough = 256, in_task = 8;
    constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
    using AllTouches = Collision<Wanted::touches, false>;
    const PairFrame frame(a, b, pose);
    if (roots_parted(a, b, frame, nullptr))
        return;
    const std::vector<Pair> front = AllTouches(a, b, frame, all, nullptr, nullptr).front(enough);
    std::vector<std::vector<Pair>> found((front.size() + in_task - 1) / in_task);
    executor.for_each(found.size(), [&](std::size_t task) {
        without_flushing([&] {
            AllTouches below(a, b, frame, all, &found[task], nullptr);
            const std::size_t end = std::min(front.size(), (task + 1) * in_task);
            for (std::size_t i = task * in_task; i < end; ++i)
                below.run(front[i]);
            below.finish();
        });
    });
    for (const std::vector<Pair>& some : found)
        pairs.insert(pairs.end(), some.begin(), some.end());
}

} // namespace
} // namespace boxwood::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxwood {
namespace detail {
HWY_EXPORT(first_touch);
HWY_EXPORT(all_touches);
HWY_EXPORT(all_near);
HWY_EXPORT(all_touches_by);

namespace {

/// Most pairs of bodies whose boxes along the axes overlap lie apart, and the spheres around them
/// say so, whether denormals are flushed or not: no radius is one.
bool spheres_separated(const MeshTree& a, const MeshTree& b, const Pose& pose, Work* work,
                       double reach = 0) {
    if (a.empty() || b.empty())
        return true;
    if (!are_separated(a.bounding_sphere(), b.bounding_sphere(), pose, reach))
        return false;
    if (work)
        ++work->node_visits;
    return true;
}

} // namespace
} // namespace detail

bool collide(const MeshTree& a, const MeshTree& b, const Pose& b_in_a, Work* work) {
    if (detail::spheres_separated(a, b, b_in_a, work))
        return false;
    return without_flushing([&] {
        using namespace detail;
        return HWY_DYNAMIC_DISPATCH(first_touch)(a, b, b_in_a, work);
    });
}

void touching_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a, std::size_t limit,
                        std::vector<Pair>& pairs, Work* work) {
    pairs.clear();
    if (limit == 0 || detail::spheres_separated(a, b, b_in_a, work))
        return;
    without_flushing([&] {
        using namespace detail;
        HWY_DYNAMIC_DISPATCH(all_touches)(a, b, b_in_a, limit, pairs, work);
    });
}

std::vector<Pair> touching_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                                     std::size_t limit, Work* work) {
    std::vector<Pair> pairs;
    touching_triangles(a, b, b_in_a, limit, pairs, work);
    return pairs;
}

std::vector<Pair> near_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                                 double reach, std::size_t limit, Work* work) {
    if (!(reach >= 0 && reach < 0x1p100))
        throw std::invalid_argument("a reach must be at least 0, and below 2^100");
    std::vector<Pair> pairs;
    if (limit == 0 || detail::spheres_separated(a, b, b_in_a, work, reach))
        return pairs;
    without_flushing([&] {
        using namespace detail;
        HWY_DYNAMIC_DISPATCH(all_near)(a, b, b_in_a, reach, limit, pairs, work);
    });
    return pairs;
}

std::vector<Pair> touching_triangles(const MeshTree& a, const MeshTree& b, const Pose& b_in_a,
                                     const Executor& executor) {
    std::vector<Pair> pairs;
    if (detail::spheres_separated(a, b, b_in_a, nullptr))
        return pairs;
    using namespace detail;
    HWY_DYNAMIC_DISPATCH(all_touches_by)(a, b, b_in_a, executor, pairs);
    return pairs;
}

} // namespace boxwood
#endif
