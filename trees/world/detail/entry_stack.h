#pragma once

#include "trees/buffer.h"

#include <cstddef>
#include <utility>

namespace boxwood::detail {

/// A stack with room for `max_entries`, on the caller's own stack where they are few.
template <class Entry> class EntryStack {
  public:
    static constexpr std::size_t few = 1024;

    explicit EntryStack(std::size_t max_entries)
        : large_(max_entries > few ? max_entries : 0),
          data_(max_entries > few ? large_.data() : own_) {}
    EntryStack(const EntryStack&) = delete;
    EntryStack& operator=(const EntryStack&) = delete;

    bool empty() const { return top_ == 0; }
    std::size_t size() const { return top_; }
    void push(const Entry& entry) { data_[top_++] = entry; }
    Entry pop() { return data_[--top_]; }
    void clear() { top_ = 0; }
    /// The entries from `first` on, those pushed last.
    Entry* from(std::size_t first) { return data_ + first; }

  private:
    Buffer<Entry> large_;
    Entry own_[few]; // not cleared
    Entry* data_;
    std::size_t top_ = 0;
};

/// The most entries of a traversal that opens two trees at once: each step takes one and leaves up
/// to 64.
constexpr std::size_t max_entries(std::size_t depth_a, std::size_t depth_b) {
    return 64 * (depth_a + depth_b + 2);
}

} // namespace boxwood::detail
