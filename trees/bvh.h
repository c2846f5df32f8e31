#pragma once

/// The front door: trees that are made, changed and queried, with good defaults and nothing to look
/// up. Bvh and BvhF64 hold boxes, MeshBvh (mesh_bvh.h) the triangles that rays meet, DynamicBvh
/// (dynamic/dynamic_bvh.h) boxes that come, go and move one at a time. The parts beneath are public
/// (trees.h), and what runs is the same code.

#include "kernels/arithmetic/rounding.h"
#include "trees/builder.h"
#include "trees/builders/hilbert.h"
#include "trees/dynamic/dynamic_bvh.h"
#include "trees/mesh_bvh.h"
#include "trees/queries/box_queries.h"

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace boxwood {

namespace detail {
class MovingTree;
}

/// The defaults are the fastest for pairs. Other queries of many points gain from BinnedSahBuilder
/// and wide8, which take longer to make.
struct BvhOptions {
    BuildFunction builder = HilbertBuilder{};
    LayoutName layout = LayoutName::packed;
    unsigned threads = 1;
    std::shared_ptr<const Executor> executor = nullptr; ///< one of your own, instead of threads
    /// update() builds again once the area of the inner nodes (of packed: of all blocks) over that
    /// of the root is so many times what it was when last built.
    double rebuild_above = 1.35;
};

/// A tree of boxes. Throws InvalidBox for the first box with a NaN, an infinity or min > max,
/// std::length_error for more than max_items boxes, and std::invalid_argument for options that make
/// no sense. Queries and threads: BoxQueries.
class Bvh : public BoxQueries {
  public:
    explicit Bvh(Boxes boxes = {}, const BvhOptions& options = {});
    Bvh(Bvh&&) noexcept;
    Bvh& operator=(Bvh&&) noexcept;
    ~Bvh();

    std::size_t size() const;
    bool empty() const { return size() == 0; }
    const BvhOptions& options() const { return options_; }
    std::size_t bytes() const;

    /// The boxes moved. As many as there were are fitted into the tree as it is, and it is built
    /// again where that made it too loose; of another number it is built again. Input that is
    /// refused changes nothing. After any other exception (no memory; of a builder or executor of
    /// yours) only `rebuild` and assignment make sense.
    void update(Boxes boxes);
    /// The same where only these items moved, ascending: the others' boxes are compared with those
    /// held, and one that differs throws std::invalid_argument, as does a number of boxes other
    /// than size(), an item that is not there or an order that does not ascend.
    void update(Boxes boxes, std::span<const std::uint32_t> moved);
    void rebuild(Boxes boxes);
    /// How often it was built again.
    std::size_t rebuilds() const { return rebuilds_; }

  private:
    bool is_packed() const { return options_.layout == LayoutName::packed; }
    void require_moved(Boxes boxes, std::span<const std::uint32_t> moved) const;
    void fit(Boxes boxes);
    double area_ratio() const;

    BvhOptions options_;
    std::unique_ptr<detail::MovingTree> packed_; ///< holds what layout_ shows, of packed alone
    Tree tree_;                                  ///< of the other layouts
    double built_area_ = 0;
    std::size_t rebuilds_ = 0;
};

/// A tree of boxes in doubles: a Bvh of the float boxes around them finds what may be, and each
/// answer is decided in doubles. Coordinates up to the largest float; beyond it, InvalidBox. Build,
/// update, order of answers and threads are those of Bvh (BoxQueries); a single query may hand its
/// answers to a function, which one thread calls.
class BvhF64 {
  public:
    explicit BvhF64(std::span<const Aabb<double>> boxes = {}, const BvhOptions& options = {});

    std::size_t size() const { return boxes_.size(); }
    bool empty() const { return boxes_.empty(); }
    const BvhOptions& options() const { return around_.options(); }
    std::size_t bytes() const;

    void update(std::span<const Aabb<double>> boxes);
    void update(std::span<const Aabb<double>> boxes, std::span<const std::uint32_t> moved);
    void rebuild(std::span<const Aabb<double>> boxes);
    std::size_t rebuilds() const { return around_.rebuilds(); }

    std::vector<Pair> self_pairs() const;
    void self_pairs(PairSink& sink) const;
    template <Visitor<Pair> F> void self_pairs(F&& visit) const {
        around_.self_pairs(
            of_those<Pair>(visit, [this](Pair p) { return overlaps(boxes_[p.a], boxes_[p.b]); }));
    }
    std::uint64_t self_pair_count() const;
    std::vector<Pair> pairs(const BvhF64& other) const;
    void pairs(const BvhF64& other, PairSink& sink) const;
    template <Visitor<Pair> F> void pairs(const BvhF64& other, F&& visit) const {
        around_.pairs(other.around_, of_those<Pair>(visit, [this, &other](Pair p) {
                          return overlaps(boxes_[p.a], other.boxes_[p.b]);
                      }));
    }
    std::uint64_t pair_count(const BvhF64& other) const;

    std::vector<std::uint32_t> overlapping(const Aabb<double>& box) const;
    template <Visitor<std::uint32_t> F> void overlapping(const Aabb<double>& box, F&& visit) const {
        if (is_region(box)) // around one that is none there may be a box all the same
            around_.overlapping(round_outward(box),
                                of_those<std::uint32_t>(visit, [&](std::uint32_t item) {
                                    return overlaps(boxes_[item], box);
                                }));
    }
    AnswersOf<std::uint32_t> overlapping(std::span<const Aabb<double>> boxes) const;
    std::vector<std::uint32_t> containing(Vec3<double> point) const;
    template <Visitor<std::uint32_t> F> void containing(Vec3<double> point, F&& visit) const {
        if (is_finite(point))
            overlapping({point, point}, std::forward<F>(visit));
    }
    AnswersOf<std::uint32_t> containing(std::span<const Vec3<double>> points) const;
    /// By the squared distance as doubles compute it (box_distance.h), and then by item: what is
    /// nearer than 1e-154 or farther than 1e154 has the same.
    std::vector<Neighbour> nearest(Vec3<double> point, std::size_t k = 1) const;
    /// Of many: k to a point, filled up with no item (Neighbour::none). Throws std::length_error
    /// for more than memory can hold.
    std::vector<Neighbour> nearest(std::span<const Vec3<double>> points, std::size_t k = 1) const;

  private:
    static bool is_region(const Aabb<double>& box) {
        return box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z;
    }
    /// Hands on what is so in doubles; what ends the query still does.
    template <class Found, class F, class IsSo> static auto of_those(F& visit, IsSo is_so) {
        return [&visit, is_so](Found found) {
            if constexpr (std::same_as<std::invoke_result_t<F&, Found>, bool>) {
                return !is_so(found) || visit(found);
            } else {
                if (is_so(found))
                    visit(found);
            }
        };
    }

    std::vector<Aabb<double>> boxes_;
    Bvh around_;
};

} // namespace boxwood
