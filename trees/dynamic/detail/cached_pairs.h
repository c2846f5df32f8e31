#pragma once

#include "trees/dynamic/detail/expiring_pairs.h"
#include "trees/dynamic/detail/moving_tree.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boxwood::detail {

/// The overlapping pairs of boxes that move, cached from frame to frame and tested again only when
/// motion may have changed them.
///
/// A rebuild finds all pairs of boxes widened by a margin m on each side. After it the largest step
/// of each frame, of any face of any slow item's box, is added up to s; `used` = 2 s. Then
/// - two boxes that did not meet widened were more than 2 m apart on some axis, so while
///   used <= 2 m they do not overlap: no pair is missed;
/// - a pair last tested when u was used, and then g apart on some axis (or overlapping by at
///   least g on all), is as it was while used <= u + g: faces that face each other came closer by
///   at most used - u. ExpiringPairs tests it again before.
/// Steps and gaps are differences of floats: each is enlarged or reduced by more than its rounding
/// and by some FLT_MIN for flushed denormal numbers, widened boxes by 2^-22 of the coordinate, and
/// sums are rounded up. Decisions are comparisons of the present boxes: the answers are exact.
///
/// An item that steps farther than the others must not use up the margin for all: it counts as
/// fast, its box is empty here, and its pairs are found in each frame, in the tree of the widened
/// boxes and in one of the fast items. After a rebuild those that have stopped are slow again.
/// Memory: 12 to 24 bytes for each pair within the margin, and as much as three frames.
class CachedPairs {
  public:
    double margin = 0; ///< of the median side of a box, on each side; 0: by the steps observed

    /// Forgets everything but its memory; `expected_step` of slow items, in median sides.
    void start(Boxes boxes, double expected_step);
    /// Searches for all pairs. The tree is left over the widened boxes. False, and nothing is held,
    /// if they are too many to cache: more than 64 for each item.
    bool rebuild(MovingTree& tree, Boxes boxes, const Executor& executor);
    /// Takes a frame, as an Updater does, over the tree of the last rebuild. False, and nothing is
    /// held, if the pairs have to be searched for again.
    bool follow(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor);
    /// Holds nothing; the tree may go over other boxes.
    void drop() { holds_ = widened_before_ = false; }
    bool holds() const { return holds_; }

    void self_pairs(PairSink& sink) const;
    /// Counts the tests of the newest frame: of pairs examined, and for the fast items.
    Work self_pairs_counted(const MovingTree& tree, PairSink& sink) const;

    /// About how long the newest frame took, and how long a search for all pairs would, on one
    /// thread, by what was done and never by the clock: nanoseconds of a machine of 2023.
    double spent() const { return spent_; }
    double search_cost() const;
    /// And how long a rebuild.
    double rebuild_cost() const;
    /// And a frame on average if in each to come as many items become fast as in each of the newest
    /// two at least: they are more and more until a rebuild is best.
    double churn_cost() const;
    /// What a frame would take, rebuilds shared out, if the next rebuild counted as fast those
    /// items that cost less so. Each of these steps stands for `items` of the fastest; `moved` move
    /// at all.
    double forecast(std::vector<float> steps, double items, std::size_t moved);
    /// The last of these, of steps seen in the newest frame.
    double forecast() const { return forecast_; }
    /// The median side of the boxes at the start.
    double side() const { return side_; }
    /// The step of the fastest item that the next rebuild would count as slow.
    double pace() const { return double{pace_}; }

    std::size_t bytes() const;
    std::string fault() const;

  private:
    /// An item whose box is not among boxes_: fast, or absent.
    struct Out {
        std::uint32_t item;
        float step; ///< of the newest frame
        Box box;    ///< Box{} if absent
    };
    class Candidates;
    class AgainstSlow;

    // Nanoseconds, on one thread: what the choices go by.
    static constexpr double per_moved = 4, per_examined = 14, per_fast_item = 800, per_left_out = 2,
                            per_found = 16, per_item_rebuilt = 10, per_item_searched = 20,
                            per_pair_searched = 2.2;

    double n() const { return static_cast<double>(boxes_.size()); }
    std::size_t count_pairs() const;
    double margin_for(double step) const;
    void forecast_by_frame();
    float follow_all(Boxes boxes, const Executor& executor);
    float follow_some(Boxes boxes, std::span<const std::uint32_t> moved);
    void follow_out(Boxes boxes, std::span<const std::uint32_t> moved);
    void leave_out(const Executor& executor);
    void find_fast(MovingTree& tree, const Executor& executor);

    bool holds_ = false, widened_before_ = false;
    double side_ = 1;
    float pace_ = 0;          ///< the step of the fastest item that is to be slow
    float max_slow_step_ = 0; ///< what steps farther becomes fast
    double used_ = 0;         ///< of the motion since the rebuild
    double waste_ = 0;        ///< spent since then on the fast who had come to rest
    double spent_ = 0, forecast_ = 0;
    std::size_t fresh_before_ = 0; ///< who became fast in the frame before the newest
    double pairs_ = 0;             ///< when last held
    ExpiringPairs::Reach reach_;
    std::vector<Box> boxes_;   ///< by item: the box of the newest frame if slow, else Box{}
    std::vector<Box> widened_; ///< by item: at the rebuild
    std::vector<float> steps_; ///< the largest of each sixteen items that moved
    std::vector<std::uint32_t> far_;
    std::vector<Out> out_, fresh_;         ///< by item; those that just became so
    std::vector<std::uint8_t> marks_;      ///< by item, 0 between calls
    std::vector<std::vector<Pair>> found_; ///< at the rebuild, by chunk
    std::vector<ExpiringPairs> parts_;
    std::size_t n_parts_ = 0;

    // Of the fast items that are present:
    std::vector<Box> fast_;
    std::vector<std::uint32_t> fast_items_;
    PackedLayout fast_tree_;
    std::vector<Pair> fast_pairs_;
    bool searched_ = false;    ///< for their pairs, in the newest frame
    std::size_t examined_ = 0; ///< in the newest frame
};

} // namespace boxwood::detail
