#pragma once

#include "kernels/features/point_triangle.h"
#include "trees/ordering/detail/code_records.h"
#include "trees/ordering/detail/point_codes.h"
#include "trees/queries/box_distance.h"
#include "trees/queries/nearest.h"
#include "trees/traversals/region_traversal.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace boxwood::detail {

/// The k nearest items of one point so far, in the memory of the answer: in order where there are
/// few, else a heap with the farthest at its front. An item is offered once.
class NearestItems {
  public:
    explicit NearestItems(std::span<Neighbour> out)
        : out_(out), is_sorted_(out.size() <= most_sorted) {}

    /// Nothing farther than this matters.
    double worst() const {
        return n_ < out_.size() ? std::numeric_limits<double>::infinity()
               : is_sorted_     ? out_.back().squared_distance
                                : out_.front().squared_distance;
    }
    void offer(const Neighbour& item) {
        if (is_sorted_)
            insert(item);
        else if (n_ < out_.size()) {
            out_[n_++] = item;
            std::push_heap(out_.begin(), end(), nearer);
        } else if (nearer(item, out_.front())) {
            std::pop_heap(out_.begin(), end(), nearer);
            out_.back() = item;
            std::push_heap(out_.begin(), end(), nearer);
        }
    }
    /// Puts them in order and fills up with no item; returns how many were found.
    std::size_t finish() {
        if (!is_sorted_)
            std::sort_heap(out_.begin(), end(), nearer);
        std::fill(end(), out_.end(), Neighbour{});
        return n_;
    }

    /// By distance, then by item.
    static bool nearer(const Neighbour& a, const Neighbour& b) {
        return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                        : a.item < b.item;
    }

  private:
    static constexpr std::size_t most_sorted = 32;

    void insert(const Neighbour& item) {
        if (n_ == out_.size() && !nearer(item, out_.back()))
            return;
        std::size_t at = n_ < out_.size() ? n_++ : n_ - 1; // else the farthest goes
        for (; at > 0 && nearer(item, out_[at - 1]); --at)
            out_[at] = out_[at - 1];
        out_[at] = item;
    }
    std::span<Neighbour>::iterator end() const {
        return out_.begin() + static_cast<std::ptrdiff_t>(n_);
    }

    std::span<Neighbour> out_;
    bool is_sorted_;
    std::size_t n_ = 0;
};

/// The nearest point of a mesh to one point so far.
class NearestSurface {
  public:
    NearestSurface(Vec3<float> point, const TriangleMesh& mesh) : point_(point), mesh_(mesh) {}

    double worst() const { return best_.squared_distance; }
    Triangle<float> triangle(std::uint32_t i) const { return mesh_.triangle(i); }
    void offer(std::uint32_t triangle) {
        const Triangle<float> t = mesh_.triangle(triangle);
        const auto found = point_triangle::Regions::nearest(
            point_, Triangle<double>{Vec3<double>(t.a), Vec3<double>(t.b), Vec3<double>(t.c)});
        const double squared = dot(found.offset, found.offset);
        if (squared < best_.squared_distance ||
            (squared == best_.squared_distance && triangle < best_.triangle))
            best_ = {Vec3<float>(found.b), triangle, squared};
    }
    const SurfacePoint& result() const { return best_; }

  private:
    Vec3<double> point_;
    const TriangleMesh& mesh_;
    SurfacePoint best_;
};

/// The memory that the traversals of one chunk share, and what they did.
class NearestTraversal {
  public:
    NearestTraversal(std::size_t stack_room, Work* work)
        : stack_(stack_room + RegionTraversal::spare), work_(work) {}

    /// References that wait, each below the bits of a float bound from below of its squared
    /// distance: in order as numbers, they are in order of distance.
    std::uint64_t* stack() { return stack_.data(); }
    static std::uint64_t waiting(float bound, std::uint32_t ref) {
        return std::uint64_t{std::bit_cast<std::uint32_t>(bound)} << 32 | ref;
    }
    static float bound(std::uint64_t waiting) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(waiting >> 32));
    }
    static std::uint32_t ref(std::uint64_t waiting) { return static_cast<std::uint32_t>(waiting); }

    bool counted() const { return work_ != nullptr; }
    template <bool Counted> void count(std::uint64_t box_tests, std::size_t stack) {
        if constexpr (Counted) {
            ++work_->node_visits;
            work_->box_tests += box_tests;
            work_->stack_max = std::max<std::uint64_t>(work_->stack_max, stack);
        }
    }
    template <bool Counted> void count_triangles(std::uint64_t n) {
        if constexpr (Counted)
            work_->triangle_tests += n;
    }
    void answered(std::size_t n) {
        if (work_)
            work_->answers += n;
    }

  private:
    Buffer<std::uint64_t> stack_;
    Work* work_;
};

/// So many points at a time are put in order, which needs 16 bytes of each.
inline constexpr std::size_t points_in_order = std::size_t{1} << 24;

/// Runs `answer(NearestTraversal&, i)` for the points i, chunk by chunk. Many points in a large
/// tree come in order along a curve: neighbours visit much the same nodes, which are at hand then,
/// and whose branches are foreseen.
template <class L, class Answer>
void for_points(const L& layout, std::span<const Vec3<float>> points, const Executor& executor,
                Work* work, const Answer& answer) {
    constexpr std::size_t few_points = 2048, few_items = 8192; // the order would gain nothing
    const std::size_t room = stack_room(layout);
    const auto run = [&](std::size_t n, const auto& point) {
        for_query_chunks(n, executor, [&](std::size_t, std::size_t first, std::size_t last) {
            NearestTraversal state(room, work);
            for (std::size_t i = first; i < last; ++i)
                answer(state, point(i));
        });
    };
    if (points.size() < few_points || layout.size() < few_items)
        return run(points.size(), [](std::size_t i) { return i; });
    const PointGrid grid(layout.bounds());
    for (std::size_t begin = 0; begin < points.size(); begin += points_in_order) {
        const auto some = points.subspan(begin, std::min(points_in_order, points.size() - begin));
        const Buffer<std::uint64_t> records =
            code_records(some.size(), 3 * PointGrid::bits, executor,
                         [&](std::size_t i) { return grid.code(some[i]); });
        run(some.size(),
            [&](std::size_t i) { return begin + static_cast<std::uint32_t>(records[i]); });
    }
}

/// Answers one finite point, over a layout that is not empty.
#define X(name, L)                                                                                 \
    void traverse_nearest(const L& layout, Vec3<float> point, NearestItems& best,                  \
                          NearestTraversal& traversal);                                            \
    void traverse_closest_point(const L& layout, Vec3<float> point, NearestSurface& best,          \
                                NearestTraversal& traversal);
BOXWOOD_SEARCHED_TREES(X)
#undef X

} // namespace boxwood::detail
