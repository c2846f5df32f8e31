#pragma once

#include "trees/dynamic/detail/gap_codes.h"
#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boxwood::detail {

/// Candidate pairs, each tested again no sooner than motion can have changed whether they overlap.
/// Motion is counted in `used`: twice the most that any face can have moved since `start`. A pair
/// that was last tested when u was used, with a gap that allows for g, is as it was while used <= u
/// + g. So it waits in the bucket of u + g, of `n_buckets` between 0 and `reach`; beyond that it
/// need not be tested any more.
class ExpiringPairs {
  public:
    static constexpr std::size_t n_buckets = GapScale::last;

    /// How much motion is waited for; the state is as it was, and all pairs hold, while
    /// !used_up(used).
    struct Reach {
        double per_used = 0; ///< buckets in a unit of motion
        /// n_buckets for all beyond.
        std::uint32_t bucket(double used) const {
            return static_cast<std::uint32_t>(std::min(used * per_used, double{n_buckets}));
        }
        bool used_up(double used) const { return bucket(used) == n_buckets; }
    };

    /// Forgets what was. The pairs come in several parts.
    void start(std::span<const std::vector<Pair>> parts, const Box* boxes, Reach reach);
    /// Tests again the pairs that `used` may have changed; returns how many.
    std::size_t examine(const Box* boxes, double used);
    /// Takes out the pairs of the items marked 1, whose boxes are empty from now on.
    void leave_out(const std::uint8_t* marks);

    /// The pairs that overlap: those that will until `reach`, and the rest.
    std::span<const Pair> sure() const { return {sure_.data(), n_sure_}; }
    std::span<const Pair> now() const { return {on_.data(), n_on_}; }

    std::size_t bytes() const;
    /// What is wrong, given the boxes last tested; empty if nothing. O(pairs).
    std::string fault(const Box* boxes) const;

  private:
    static constexpr std::uint32_t off = ~std::uint32_t{0};
    /// A pair that waits; 12 bytes.
    struct Unsure {
        Pair pair;
        std::uint32_t id_and_state; ///< id, and the top bit if it overlaps
    };
    static constexpr std::uint32_t on_bit = std::uint32_t{1} << 31;

    void turn_on(Unsure& unsure);
    void turn_off(Unsure& unsure);

    Reach reach_;
    std::size_t bucket_now_ = 0; ///< all below and itself are empty: their pairs are in hot_
    Buffer<Pair> sure_;
    std::size_t n_sure_ = 0;
    Buffer<Pair> on_;
    Buffer<std::uint32_t> on_id_;
    std::size_t n_on_ = 0;
    Buffer<std::uint32_t> place_; ///< id -> place in on_, or off
    std::size_t n_unsure_ = 0;
    std::array<std::vector<Unsure>, n_buckets> waiting_;
    std::vector<std::uint32_t> codes_;
    std::vector<Unsure> hot_, todo_; ///< hot: to be tested whenever anything moves
};

} // namespace boxwood::detail
