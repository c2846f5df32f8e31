#pragma once

#include "trees/executors/chunks.h"
#include "trees/layouts/packed.h"
#include "trees/traversals/chunk_sink.h"

#include <algorithm>
#include <atomic>

namespace boxwood::detail {

/// A growing list of blocks or slots, uninitialised beyond its end. Most stay where the list itself
/// is, and take no memory from the heap.
class PackedList {
  public:
    PackedList() = default;
    PackedList(const PackedList&) = delete;
    PackedList& operator=(const PackedList&) = delete;

    std::size_t size() const { return size_; }
    const std::uint32_t* data() const { return data_; }
    std::uint32_t operator[](std::size_t i) const { return data_[i]; }
    void clear() { size_ = 0; }
    void push(std::uint32_t x) {
        *reserve(1) = x;
        ++size_;
    }
    void copy(const PackedList& other) {
        std::copy_n(other.data_, other.size_, reserve(other.size_));
        size_ += other.size_;
    }
    /// Where the next entries go, with room for n.
    std::uint32_t* reserve(std::size_t n) {
        if (size_ + n > room_) {
            Buffer<std::uint32_t> larger(2 * (size_ + n));
            std::copy_n(data_, size_, larger.data());
            grown_ = std::move(larger);
            data_ = grown_.data();
            room_ = grown_.size();
        }
        return data_ + size_;
    }
    void grow(std::size_t n) { size_ += n; }

  private:
    std::size_t size_ = 0, room_ = 768;
    alignas(64) std::uint32_t own_[768];
    std::uint32_t* data_ = own_;
    Buffer<std::uint32_t> grown_;
};

/// Two columns of a list of pairs; a store may write a register beyond.
struct PackedColumns {
    static constexpr std::size_t max_size = 512;
    alignas(64) std::uint32_t a[max_size + PackedBlock::width], b[max_size + PackedBlock::width];
    std::size_t n = 0;

    void push(std::uint32_t x, std::uint32_t y) {
        a[n] = x;
        b[n++] = y;
    }
};

/// What one chunk found: two columns of items, made into pairs and handed over when they are full.
class PackedPairs {
  public:
    PackedPairs(PairSink& sink, std::size_t chunk, std::atomic<bool>& stop, Work* work)
        : to_(sink, chunk, stop, work) {}

    std::uint32_t* a() { return a_; }
    std::uint32_t* b() { return b_; }
    std::size_t size() const { return n_; }
    void resize(std::size_t n) { n_ = n; }
    /// Entries that still fit; a store may write a register beyond.
    std::size_t free() const { return batch - n_; }

    /// put(a, b, n, pairs) makes n pairs of the columns, in whole registers. False once the sink
    /// has had enough.
    template <class Put> bool flush(const Put& put) {
        if (n_ == 0)
            return true;
        put(a_, b_, n_, out_);
        const bool more = to_.take({out_, n_});
        n_ = 0;
        return more;
    }

  private:
    /// Columns and pairs fill a third of a 48 KB first-level cache.
    static constexpr std::size_t batch = 1024, room = batch + PackedBlock::width;
    alignas(64) std::uint32_t a_[room], b_[room];
    alignas(64) Pair out_[room];
    std::size_t n_ = 0;
    ChunkSink to_;
};

/// The nodes [begin, end) of a level of `a`, against all of `b`.
struct PackedChunk {
    const PackedLayout &a, &b;
    std::size_t level, begin, end;
};

} // namespace boxwood::detail
