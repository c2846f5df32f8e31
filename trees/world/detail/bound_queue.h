#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace boxwood::detail {

/// A pair of blocks that waits, with a bound of its distance.
struct NearEntry {
    float bound;
    std::uint32_t a, b;
};

/// Pairs of blocks, that with the least bound first but for a bucket's width: 64 buckets of equal
/// width, each last in, first out. Push and pop take constant time and allocate nothing.
class BoundQueue {
  public:
    static constexpr std::size_t capacity = 1024;

    /// Buckets from 0 to `greatest`; what is beyond goes into the last. Infinite: a stack.
    explicit BoundQueue(float greatest)
        : per_bound_(static_cast<float>(n_buckets) / std::max(greatest, 0x1p-100f)) {
        std::fill_n(top_, n_buckets, none);
        std::iota(below_, below_ + capacity, std::uint16_t{1});
    }
    BoundQueue(const BoundQueue&) = delete;
    BoundQueue& operator=(const BoundQueue&) = delete;

    bool empty() const { return in_use_ == 0; }
    std::size_t size() const { return size_; }
    bool has_room_for(std::size_t n) const { return size_ + n <= capacity; }

    /// The bound must be finite and not below 0, and there must be room.
    void push(const NearEntry& entry) {
        const float at = std::min(entry.bound * per_bound_, static_cast<float>(n_buckets - 1));
        // To a signed integer, as to an unsigned one of 64 bits takes a branch.
        const auto bucket = static_cast<std::uint32_t>(static_cast<std::int32_t>(at));
        const std::uint16_t place = free_;
        free_ = below_[place];
        entries_[place] = entry;
        below_[place] = top_[bucket];
        top_[bucket] = place;
        in_use_ |= std::uint64_t{1} << bucket;
        ++size_;
    }
    NearEntry pop() {
        const auto bucket = static_cast<std::size_t>(std::countr_zero(in_use_));
        const std::uint16_t place = top_[bucket];
        top_[bucket] = below_[place];
        in_use_ &= ~(std::uint64_t{below_[place] == none} << bucket);
        below_[place] = free_;
        free_ = place;
        --size_;
        return entries_[place];
    }

  private:
    static constexpr std::size_t n_buckets = 64;
    static constexpr std::uint16_t none = 0xffff;

    float per_bound_;
    std::uint64_t in_use_ = 0; ///< buckets, as bits
    std::size_t size_ = 0;
    std::uint16_t free_ = 0;
    std::uint16_t top_[n_buckets];
    std::uint16_t below_[capacity]; ///< the next in the bucket, or of the free places
    NearEntry entries_[capacity];   // not cleared
};

} // namespace boxwood::detail
