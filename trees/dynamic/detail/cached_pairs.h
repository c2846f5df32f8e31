#pragma once

#include "trees/dynamic/detail/expiring_pairs.h"
#include "trees/dynamic/detail/moving_tree.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boxwood::detail {

/// The overlapping pairs of boxes that move, kept from frame to frame and looked at again only when
/// motion may have changed them.
///
/// A renewal finds all pairs of boxes widened by a margin m on each side. After it the largest step
/// of each frame, of any face of any kept box, is added up to s; `used` = 2 s. Then
/// - two boxes that did not meet widened were more than 2 m apart on some axis, so while used <= 2
/// m
///   they do not overlap: no pair is missed;
/// - a pair last looked at when u was used, and then g apart on some axis (or overlapping by at
///   least g on all), is as it was while used <= u + g: faces that face each other came closer by
///   at most used - u. ExpiringPairs looks at it again before.
/// Steps and gaps are differences of floats: each is enlarged or reduced by more than its rounding
/// and by some FLT_MIN for flushed denormal numbers, widened boxes by 2^-22 of the coordinate, and
/// sums are rounded up. Decisions are comparisons of the present boxes: the answers are exact.
///
/// An item that steps farther than the others must not use up the margin for all: it becomes
/// restless, its box counts as empty here, and its pairs are found in each frame: in the tree of
/// the widened boxes, and in one of the restless. A renewal calms those that have stopped.
/// Memory: 12 to 24 bytes for each pair within the margin, and as much as three frames.
class CachedPairs {
  public:
    double margin = 0; ///< of the median side of a box, on each side; 0: by the steps observed

    /// Forgets everything but its memory; `expected_step` of the calm, in median sides.
    void start(Boxes boxes, double expected_step);
    /// Finds all pairs anew. The tree is left over the widened boxes. False, and nothing is held,
    /// if they are too many to keep: more than 64 for each item.
    bool renew(MovingTree& tree, Boxes boxes, const Executor& executor);
    /// Takes a frame, as an Updater does, over the tree of the last renewal. False, and nothing is
    /// held, if the pairs have to be found anew.
    bool follow(MovingTree& tree, Boxes boxes, std::span<const std::uint32_t> moved,
                const Executor& executor);
    /// Holds nothing; the tree may go over other boxes.
    void drop() { holds_ = widened_before_ = false; }
    bool holds() const { return holds_; }

    void self_pairs(PairSink& sink) const;
    /// Counts the tests of the newest frame: of pairs examined, and in the trees of the restless.
    Work self_pairs_counted(const MovingTree& tree, PairSink& sink) const;

    /// About how long the newest frame took, and how long finding all pairs anew would, on one
    /// thread, by what was done and never by the clock: nanoseconds of a machine of 2023.
    double spent() const { return spent_; }
    double spent_anew() const;
    /// And how long a renewal.
    double renewal_cost() const;
    /// And a frame on average if in each to come as many items become restless as in each of the
    /// newest two at least: they are more and more until it is best to renew.
    double churn_cost() const;
    /// What a frame would take, renewals shared out, if the next renewal made restless those who
    /// cost less so. Each of these steps stands for `items` of the fastest; `moved` move at all.
    double forecast(std::vector<float> steps, double items, std::size_t moved);
    /// The last of these, of steps seen in the newest frame.
    double forecast() const { return forecast_; }
    /// The median side of the boxes at the start.
    double side() const { return side_; }
    /// The step of the fastest that the next renewal would calm.
    double pace() const { return double{pace_}; }

    std::size_t bytes() const;
    std::string fault() const;

  private:
    /// An item whose box is not among kept_: restless, or absent.
    struct Out {
        std::uint32_t item;
        float step; ///< of the newest frame
        Box box;    ///< Box{} if absent
    };
    class Candidates;
    class AgainstKept;

    // Nanoseconds, on one thread: what the choices go by.
    static constexpr double per_moved = 4, per_examined = 14, per_restless = 800, per_left_out = 2,
                            per_found = 16, per_item_renewed = 10, per_item_anew = 20,
                            per_pair_anew = 2.2;

    double n() const { return static_cast<double>(kept_.size()); }
    std::size_t count_pairs() const;
    double margin_for(double step) const;
    void forecast_by_frame();
    float follow_all(Boxes boxes, const Executor& executor);
    float follow_some(Boxes boxes, std::span<const std::uint32_t> moved);
    void follow_out(Boxes boxes, std::span<const std::uint32_t> moved);
    void leave_out(const Executor& executor);
    void find_restless(MovingTree& tree, const Executor& executor);

    bool holds_ = false, widened_before_ = false;
    double side_ = 1;
    float pace_ = 0;   ///< the step of the fastest that are to be calm
    float most_ = 0;   ///< who steps farther becomes restless
    double used_ = 0;  ///< of the motion since the renewal
    double waste_ = 0; ///< spent since then on the restless who had come to rest
    double spent_ = 0, forecast_ = 0;
    std::size_t fresh_before_ = 0; ///< who became restless in the frame before the newest
    double pairs_ = 0;             ///< when last held
    ExpiringPairs::Reach reach_;
    std::vector<Box> kept_;    ///< by item: the box of the newest frame if calm, else Box{}
    std::vector<Box> widened_; ///< by item: at the renewal
    std::vector<float> steps_; ///< the largest of each sixteen items that moved
    std::vector<std::uint32_t> far_;
    std::vector<Out> out_, fresh_;         ///< by item; those that just became so
    std::vector<std::uint8_t> marks_;      ///< by item, 0 between calls
    std::vector<std::vector<Pair>> found_; ///< at the renewal, by chunk
    std::vector<ExpiringPairs> parts_;
    std::size_t n_parts_ = 0;

    // Of the restless that are present:
    std::vector<Box> restless_;
    std::vector<std::uint32_t> restless_items_;
    PackedLayout restless_tree_;
    std::vector<Pair> restless_pairs_;
    bool searched_ = false;    ///< for their pairs, in the newest frame
    std::size_t examined_ = 0; ///< in the newest frame
};

} // namespace boxwood::detail
