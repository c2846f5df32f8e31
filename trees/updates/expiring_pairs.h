#pragma once

#include "trees/pairs.h"
#include "trees/tree.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boxwood {

/// How far apart two boxes are, or how deep they overlap: on the axis on which they are farthest
/// apart or nearest to that.
struct Gap {
    bool overlap; ///< as `overlaps`
    /// Whatever the two move in sum, each face of each, up to this leaves `overlap` as it is; +inf
    /// if one of them is the empty box.
    double allowance;
};

/// The differences are of floats, so each is rounded by at most 2^-24 of it (and by FLT_MIN where
/// denormal numbers are flushed); one that overflows is larger than any motion that is waited for.
inline Gap gap_between(const Box& a, const Box& b) {
    const Vec3<float> low = max(a.min, b.min), high = min(a.max, b.max), apart = low - high;
    const float gap = std::max(std::max(apart.x, apart.y), apart.z);
    const bool overlap = (low.x <= high.x) & (low.y <= high.y) & (low.z <= high.z);
    constexpr double rounded = 1 - 0x1p-20, flushed = 4 * double{FLT_MIN};
    return {overlap, std::max(0., double{std::abs(gap)} * rounded - flushed)};
}

/// Candidate pairs, each looked at again no sooner than motion can have changed whether they
/// overlap. Motion is counted in `used`: twice the most that any face can have moved since `start`.
/// A pair that was last looked at when u was used, with a gap that allows for g, is as it was while
/// used <= u + g. So it waits in the bucket of u + g, of `n_buckets` between 0 and `reach`; beyond
/// that it need not be looked at any more.
class ExpiringPairs {
  public:
    static constexpr std::size_t n_buckets = 128;

    /// How much motion is waited for; the state is as it was, and all is kept, while
    /// !used_up(used).
    struct Reach {
        double per_used = 0; ///< buckets in a unit of motion
        bool used_up(double used) const { return used * per_used >= double{n_buckets}; }
        /// Rounded the same way for expiry and motion used: the first is not below the second
        /// unless its bucket is not.
        std::size_t bucket(double used) const { return static_cast<std::size_t>(used * per_used); }
    };

    /// Forgets what was. The pairs come in several parts.
    void start(std::span<const std::vector<Pair>> parts, const Box* boxes, Reach reach);
    /// Looks again at the pairs that `used` may have changed; returns how many.
    std::size_t examine(const Box* boxes, double used);
    /// Takes out the pairs of items whose boxes are now empty.
    void leave_out_empty(const Box* boxes);

    /// The pairs that overlap: those that will until `reach`, and the rest.
    std::span<const Pair> sure() const { return {sure_.data(), n_sure_}; }
    std::span<const Pair> now() const { return {on_.data(), n_on_}; }

    std::size_t bytes() const;
    /// What is wrong, given the boxes last looked at; empty if nothing. O(pairs).
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
    std::vector<Unsure> hot_, todo_; ///< hot: to be looked at whenever anything moves
};

} // namespace boxwood
